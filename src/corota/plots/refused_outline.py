"""Picture of an outline that is refused, with the places."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from corota.plots.figure import INK, figure_of, finish, look

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from corota.arrays import Floats

    class Line(Protocol):
        """Interface of a curve for pictures."""

        points: Floats

    class Refused(Protocol):
        """Interface of the error for pictures."""

        curves: Sequence[Line]
        places: Floats


def refused_outline(
    error: Refused, *, path: str | PathLike[str] | None = None, ax: Any = None, dpi: float = 150.0
) -> Any:
    """Draw the curves of an outline, and circles at the places where it is wrong.

    Parameters
    ----------
    path, ax, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    with look():
        figure, ax = figure_of(ax, 5.2, 4.2, shown=path is None)
        for curve in error.curves:
            ax.plot(*curve.points.T, color=INK, linewidth=0.8)
        ax.plot(*error.places.T, "o", markersize=14, fillstyle="none", color="tab:red")
        for number, (x, y) in enumerate(error.places[:50], start=1):
            ax.annotate(str(number), (x, y), (8, 8), textcoords="offset points")
        ax.set_aspect("equal")
        ax.set_xlabel("x")
        ax.set_ylabel("y")
        return finish(figure, path, dpi)
