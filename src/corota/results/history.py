"""One quantity over the increments of an analysis: values, plots and tables."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from corota.display import Brief, brief, picture, table
from corota.errors import InputError
from corota.lazy import lazy

if TYPE_CHECKING:
    from collections.abc import Iterator
    from os import PathLike

    from numpy.typing import ArrayLike

    from corota.arrays import Floats
    from corota.results.extremes import Extreme
    from corota.results.source import ResultSource


# A convenience: a function of a higher layer, which loads at its first call.
draw_curve = lazy("corota.plots:curve")


#: How labels show what was done with histories.
_SIGNS = {"add": "+", "subtract": "-", "multiply": "*", "divide": "/", "power": "**"}


@dataclass(eq=False, repr=False)
class History(Brief, NDArrayOperatorsMixin):
    """A quantity at every kept increment; an array of numbers with a name.

    ``h1 + h2``, ``2 * h``, ``abs(h)``, ``np.sqrt(h)`` are histories again, and so are plotted;
    comparisons give masks, as those of arrays do.

    Parameters
    ----------
    name : str
        For labels, with place and reducer.
    values : ndarray, shape (n_frames,)
    results : Results
        Source of the history; gives the other axis of a plot.
    places : tuple of (Extreme or None)
        Node, or element and point, and current position of the value of each increment, where
        ``combine`` picks it from one place; empty for sums, means and scalars.

    Examples
    --------
    >>> import numpy as np
    >>> from corota.results.history import History
    >>> deflection = History("U2", np.array([0.0, 1.5]), None)
    >>> float(deflection.max())
    1.5
    >>> 2.0 * deflection - deflection
    History('((2 * U2) - U2)': 2 values, 0 ... 1.5, smallest 0, largest 1.5)
    """

    name: str
    values: Floats
    results: ResultSource
    places: tuple[Extreme | None, ...] = ()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Floats:
        return np.array(self.values, dtype=dtype)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        if options.get("out"):
            return NotImplemented
        lengths = {len(part) for part in inputs if isinstance(part, History)}
        if len(lengths) > 1:
            raise InputError(
                f"histories of {' and '.join(map(str, sorted(lengths)))} increments cannot be "
                "combined; take values at the same times: h.at(times)"
            )
        plain = [part.values if isinstance(part, History) else part for part in inputs]
        found = getattr(ufunc, method)(*plain, **options)
        if not isinstance(found, np.ndarray) or found.shape != self.values.shape:
            return found
        if found.dtype == np.bool_:
            return found
        return History(_combined(ufunc.__name__, inputs), found, self.results)

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[Any]:
        return iter(self.values)

    def __getitem__(self, index: Any) -> Any:
        return self.values[index]

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the values, (n_frames,)."""
        return self.values.shape

    def at(self, time: ArrayLike) -> Any:
        """Value at a total time [time], linear between the increments.

        Parameters
        ----------
        time : float or array_like

        Returns
        -------
        float, or ndarray with the shape of `time`

        Raises
        ------
        InputError
            If there is no increment before or after the time.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
        >>> model.fix("left")
        >>> model.fix("right", x=0.1, y=None)
        >>> results = ct.solve(model, ct.Static(increments=2), threads=1)
        >>> round(results.history("U1", at="right").at(0.75), 6)
        0.075
        """
        times = np.asarray(self.results.times, dtype=np.float64)
        wanted_times = np.asarray(time, dtype=np.float64)
        if len(times) == 0 or (np.diff(times) < 0.0).any():
            raise InputError(f"{self.name}: its increments are in no order of time; take h[i]")
        slack = 1e-9 * max(abs(float(times[0])), abs(float(times[-1])))
        if not ((wanted_times >= times[0] - slack) & (wanted_times <= times[-1] + slack)).all():
            raise InputError(
                f"{self.name} is known from time {times[0]:g} to {times[-1]:g}, not at "
                f"{brief(wanted_times) if wanted_times.ndim else f'{float(wanted_times):g}'}"
            )
        found = np.interp(wanted_times, times, self.values)
        return found if wanted_times.ndim else float(found)

    def max(self, axis: None = None, out: None = None) -> float:
        """Largest value, of the frames that have one; the arguments are those of ``np.max``."""
        return float(np.nanmax(self.values))

    def min(self, axis: None = None, out: None = None) -> float:
        """Smallest value, of the frames that have one; the arguments are those of ``np.min``."""
        return float(np.nanmin(self.values))

    def plot(
        self,
        against: str | History = "",
        *,
        path: str | PathLike[str] | None = None,
        ax: Any = None,
    ) -> Any:
        """Draw the curve; needs matplotlib (``pip install corota[plot]``).

        Parameters
        ----------
        against : str or History
            ``"load factor"``, ``"time"``, ``"increment"``, a scalar of the frames, or another
            history; by default the time, or the frequency of a harmonic response. A load factor or
            force goes on the vertical axis.
        path : path-like, optional
            Write PNG, SVG or PDF there.
        ax : matplotlib axes, optional

        Returns
        -------
        matplotlib.figure.Figure
        """
        curve, other = self, against
        if not isinstance(other, History):
            other = self.results.history(other or self._abscissa)
            if other.name == "frequency":
                inside = other.values > 0.0  # frames of other steps have none
                curve = History(self.name, np.where(inside, self.values, np.nan), self.results)
                other = History(other.name, np.where(inside, other.values, np.nan), self.results)
        return draw_curve(curve, other, path=path, ax=ax)

    @property
    def _abscissa(self) -> str:
        """What a curve is drawn over: the time, or the frequency of a harmonic response."""
        frames = self.results.frames
        return "frequency" if frames and "frequency" in frames[-1].scalars else "time"

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


def _combined(name: str, inputs: tuple[Any, ...]) -> str:
    """Label of what a function of arrays made."""
    parts = [
        part.name if isinstance(part, History) else f"{part:g}" if np.ndim(part) == 0 else "array"
        for part in inputs
    ]
    if name in _SIGNS and len(parts) == 2:
        return f"({parts[0]} {_SIGNS[name]} {parts[1]})"
    if name == "negative":
        return f"(-{parts[0]})"
    return f"{'abs' if name == 'absolute' else name}({', '.join(parts)})"
