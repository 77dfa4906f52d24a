"""Curves of one history against another."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.model.units import Units
from corota.plots.figure import PALE, chart, figure_of, finish, look
from corota.plots.path import draw_path, has_stability
from corota.results.variables import described, dimension, labeled

if TYPE_CHECKING:
    from os import PathLike

    from corota.results.history import History

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
