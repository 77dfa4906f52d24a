"""Measures of a sweep over its parameters."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from corota.errors import InputError
from corota.plots.figure import chart, figure_of, finish, look

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from corota.arrays import Floats

    class Table(Protocol):
        """Interface of a sweep for pictures."""

        parameters: list[str]
        measures: list[str]

        def __getitem__(self, name: str) -> NDArray[Any]: ...
        def column(self, name: str) -> Floats: ...


#: Most lines of one picture.
MOST_LINES = 12


def sweep(
    table: Table,
    x: str,
    y: str,
    by: str = "",
    *,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw a measure of a sweep over a parameter.

    Parameters
    ----------
    table : Sweep
    x, y : str
        Columns along and upright.
    by : str
        A line for each value of this column. Without it rows are points, joined where no other
        parameter varies.
    path, ax, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If a column is unknown or holds no numbers, or `by` has too many values.
    """
    across, up = table.column(x), table.column(y)
    groups = table[by] if by else np.zeros(len(across))
    values = list(dict.fromkeys(groups.tolist()))
    if len(values) > MOST_LINES:
        raise InputError(f"{by!r} has {len(values)} values; a picture shows up to {MOST_LINES}")
    varying = [p for p in table.parameters if p not in (x, by) and len(set(table[p].tolist())) > 1]
    with look():
        figure, ax = figure_of(ax, 5.2, 3.7, shown=path is None)
        for value in values:
            mine = groups == value
            order = np.argsort(across[mine], kind="stable")
            ax.plot(
                across[mine][order],
                up[mine][order],
                marker="o",
                markersize=3.2,
                markerfacecolor="white",
                markeredgewidth=0.9,
                linewidth=0.0 if varying else 1.4,
                label=f"{by} = {value:g}" if by and isinstance(value, float | int) else str(value),
                clip_on=False,
                zorder=3,
            )
        ax.set_xlabel(x)
        ax.set_ylabel(y)
        if by:
            ax.legend()
        ax.margins(0.03)
        chart(ax, zero=False, powers="")
        return finish(figure, path, dpi)
