"""Variables along a line through the body."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.plots.figure import chart, figure_of, finish, look
from corota.results.variables import described, labeled

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from corota.results.probe import Line


def along(
    line: Line,
    variables: Sequence[str],
    *,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw variables over the distance along a line.

    Parameters
    ----------
    line : Line
        Of :meth:`corota.results.Results.along`.
    variables : sequence of str
    path, ax, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    units = line.results.model.unit_system
    names = [name.upper() for name in variables or ("U1", "U2")]
    with look():
        figure, ax = figure_of(ax, 5.2, 3.7, shown=path is None)
        for name in names:
            ax.plot(line.distance, line.values(name), linewidth=1.4, label=name, zorder=3)
        ax.set_xlabel(labeled("distance along the line", units, "length"))
        if len(names) == 1:
            ax.set_ylabel(f"{names[0]}: {described(names[0], units)}")
        else:
            of = {labeled(name, units).partition(" [")[2] for name in names}
            ax.set_ylabel(f"[{of.pop()}" if len(of) == 1 and of != {""} else "")
            ax.legend()
        ax.margins(x=0.0)
        chart(ax)
        ax.set_title(line.results.model.name, loc="left")
        return finish(figure, path, dpi)
