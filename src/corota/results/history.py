"""One quantity over the increments of an analysis: values, plots and tables."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.display import Brief, brief, picture, table

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from corota.results.results import Results

    Floats = NDArray[np.float64]


@dataclass
class History(Brief):
    """A quantity at every kept increment.

    Parameters
    ----------
    name : str
        For labels, with place and way of combining.
    values : ndarray, shape (n_frames,)
    results : Results
        Where it comes from; gives the other axis of a plot.

    Examples
    --------
    >>> import numpy as np
    >>> from corota.results.history import History
    >>> float(History("U2", np.array([0.0, 1.5]), None).max())
    1.5
    """

    name: str
    values: Floats
    results: Results

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Floats:
        return np.array(self.values, dtype=dtype)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, index: Any) -> Any:
        return self.values[index]

    def max(self) -> float:
        """Largest value, of the frames that have one."""
        return float(np.nanmax(self.values))

    def min(self) -> float:
        """Smallest value, of the frames that have one."""
        return float(np.nanmin(self.values))

    def plot(
        self,
        against: str | History = "time",
        *,
        path: str | PathLike[str] | None = None,
        ax: Any = None,
    ) -> Any:
        """Draw the curve; needs matplotlib (``pip install corota[plot]``).

        Parameters
        ----------
        against : str or History
            ``"load factor"``, ``"time"``, ``"increment"``, a scalar of the frames, or another
            history. A load factor or force goes on the upright axis, as engineers draw it.
        path : path-like, optional
            Write PNG, SVG or PDF there.
        ax : matplotlib axes, optional

        Returns
        -------
        matplotlib.figure.Figure
        """
        from corota import plots

        other = against if isinstance(against, History) else self.results.history(against)
        return plots.curve(self, other, path=path, ax=ax)

    def to_dataframe(self) -> Any:
        """One column over the total time, as a ``pandas.DataFrame``.

        Raises
        ------
        ResourceError
            If pandas is not installed (``pip install corota[data]``).
        """
        return self.results.to_dataframe(self)

    def __repr__(self) -> str:
        if not len(self.values):
            return f"History({self.name}: no frames)"
        first, last = float(self.values[0]), float(self.values[-1])
        return (
            f"History({brief(self.name)}: {len(self.values):,} values, {first:g} ... {last:g}, "
            f"smallest {self.min():g}, largest {self.max():g})"
        )

    def _repr_html_(self) -> str:
        drawn = ""
        if self.results is not None and len(self.values) > 1:
            drawn = picture(lambda path: self.plot(path=path))
        rows = {"history": self.name, "values": f"{len(self.values):,}"}
        if len(self.values):
            rows |= {
                "first, last": f"{self.values[0]:g}, {self.values[-1]:g}",
                "smallest, largest": f"{self.min():g}, {self.max():g}",
            }
        return drawn + table(rows)
