"""Curves of one history against another, and equilibrium paths with their stability."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.model.units import Units
from corota.plots.figure import COLORS, INK, PALE, chart, figure_of, finish, look
from corota.results.variables import described, dimension, labeled

if TYPE_CHECKING:
    from os import PathLike

    from corota.arrays import Floats
    from corota.results.history import History
    from corota.results.source import ResultSource


#: Quantities that are always drawn on the vertical axis.
_UPRIGHT = ("load factor", "RF", "F1", "F2", "M3", "RM3")


def curve(
    y: History | Sequence[History],
    x: History,
    *,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw histories against another.

    A single history against the load factor or a force has the usual axes: load
    vertical, displacement horizontal. Of an equilibrium path the stable branches are solid, the
    unstable ones dashed, and limit and bifurcation points are marked.

    Parameters
    ----------
    y : History or sequence of History
    x : History
    path, ax, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    many = list(y) if isinstance(y, Sequence) else [y]
    if len(many) == 1 and x.name.startswith(_UPRIGHT) and not many[0].name.startswith(_UPRIGHT):
        many, x = [x], many[0]
    units = x.results.model.unit_system if x.results is not None else Units()
    with look():
        figure, ax = figure_of(ax, 5.2, 3.7, shown=path is None)
        across = np.asarray(x.values)
        marked = len(across) <= 60
        as_path = len(many) == 1 and has_stability(x.results)
        if as_path:
            draw_path(ax, across, np.asarray(many[0].values), x.results)
        for one in [] if as_path else many:
            ax.plot(
                across,
                one.values,
                marker="o" if marked else "",
                markersize=3.2,
                markerfacecolor="white",
                markeredgewidth=0.9,
                linewidth=1.4,
                label=one.name,
                clip_on=False,
                zorder=3,
            )
        ax.axvline(0.0, color=PALE, linewidth=0.6, zorder=1)
        ax.set_xlabel(axis_label(x.name, units))
        if len(many) == 1:
            ax.set_ylabel(axis_label(many[0].name, units))
        else:
            ax.set_ylabel(shared_label([one.name for one in many], units))
            ax.legend()
        ax.margins(0.03)
        chart(ax)
        ax.set_title(x.results.model.name, loc="left")
        return finish(figure, path, dpi)


def shared_label(names: Sequence[str], units: Units) -> str:
    """The unit that all histories share, for the axis of several; else nothing."""
    shared = {units.label(dimension(name)) for name in names}
    unit = shared.pop() if len(shared) == 1 else ""
    return f"[{unit}]" if unit else ""


def axis_label(name: str, units: Units | None = None) -> str:
    """Name of a history with its meaning and unit; a factor stands before it."""
    multiple = re.fullmatch(r"\((-|-?[\d.e+-]+ \* )([^()]+(?:\([^()]*\))?)\)", name)
    if multiple:
        return multiple[1] + axis_label(multiple[2], units)
    named_units = units or Units()
    variable, _, place = name.partition(" at ")
    what = described(variable, named_units)
    if not what:
        return labeled(name, named_units)
    # A place by its coordinates has all their digits in its name.
    place = re.sub(r"\d+\.\d{4,}", lambda number: f"{float(number[0]):.4g}", place)
    return f"{variable}: {what}" + (f", at {place}" if place else "")


#: Marks of critical points: the scalar of their frames, the symbol, the name in the legend.
MARKS = (("limit point", "o", "limit point"), ("bifurcation point", "D", "bifurcation point"))


def has_stability(results: ResultSource | None) -> bool:
    """Whether any frame is known to be unstable or critical."""
    if results is None:
        return False
    return any(
        f.scalars.get("stable") == 0.0 or any(f.scalars.get(n) == 1.0 for n, _, _ in MARKS)
        for f in results.frames
    )


def draw_path(ax: Any, x: Floats, y: Floats, results: ResultSource) -> None:
    """Draw a path on axes.

    Parameters
    ----------
    ax : matplotlib axes
    x, y : ndarray, shape (n_frames,)
    results : Results
        Their frames contain stability and critical points.
    """
    stable = np.array([f.scalars.get("stable", 1.0) != 0.0 for f in results.frames])
    named: set[bool] = set()
    # A piece has the stability of its end: critical points close the branch before them.
    pieces = groupby(range(1, len(x)), key=lambda i: bool(stable[i]))
    for is_stable, group in pieces:
        ends = list(group)
        part = slice(ends[0] - 1, ends[-1] + 1)
        name = "stable" if is_stable else "unstable"
        ax.plot(
            x[part],
            y[part],
            linestyle="-" if is_stable else (0, (3.5, 2.0)),
            color=COLORS[0],
            linewidth=1.5,
            zorder=3,
            clip_on=False,
            label=name if is_stable not in named else "_nolegend_",
        )
        named.add(is_stable)
    for scalar, symbol, name in MARKS:
        at = [i for i, f in enumerate(results.frames) if f.scalars.get(scalar) == 1.0]
        if at:
            ax.plot(
                x[at],
                y[at],
                linestyle="",
                marker=symbol,
                markersize=6.0,
                markeredgecolor=INK,
                markerfacecolor=COLORS[1],
                markeredgewidth=0.8,
                zorder=4,
                clip_on=False,
                label=name,
            )
    ax.legend()
