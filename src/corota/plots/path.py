"""An equilibrium path: stable branches solid, unstable ones dashed, critical points marked."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.plots.figure import COLORS, INK

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.results.source import ResultSource


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


def draw_path(ax: Any, x: Floats, y: Floats, results: ResultSource, *, legend: bool = True) -> None:
    """Draw a path on axes.

    Parameters
    ----------
    ax : matplotlib axes
    x, y : ndarray, shape (n_frames,)
    results : Results
        Their frames contain stability and critical points.
    legend : bool
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
    if legend:
        ax.legend()
