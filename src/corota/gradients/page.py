"""A page of an optimization: its history, and the shapes of its designs, one below the other."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.plots.palette import LINES

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Sequence

    from corota.arrays import Floats
    from corota.gradients.optimization import Design, Optimum
    from corota.mesh import Mesh
    from corota.model.model import Model


#: Size of a picture, and its margins [px].
WIDTH, HEIGHT, LEFT, EDGE = 760.0, 220.0, 70.0, 24.0
#: Shapes of a page.
SHAPES = 6
STYLE = (
    "body{font:14px/1.5 system-ui,sans-serif;max-width:800px;margin:24px auto;padding:0 16px;"
    "background:#f6f7f9;color:#1c2430}svg{background:#fff;border:1px solid #d6dbe2;width:100%}"
    "table{border-collapse:collapse}td,th{padding:2px 12px 2px 0;text-align:right}"
)


def write_page(
    found: Optimum,
    path: str | os.PathLike[str],
    build: Callable[[Floats], Model] | None = None,
    names: Sequence[str] = (),
) -> None:
    """Write a page (HTML) with the history of all measures and the shapes of some designs.

    Parameters
    ----------
    found : Optimum
    path : path-like
    build : callable, optional
        That of the optimization; shapes are left out without it.
    names : sequence of str
        Of the parameters.

    Raises
    ------
    InputError
        If there is no design, or the names do not fit.
    """
    good = [d for d in found.history if not d.error]
    if not good:
        raise InputError("an optimization without designs has no page")
    count = len(good[0].x)
    titles = list(names) or [f"x{k + 1}" for k in range(count)]
    if len(titles) != count:
        raise InputError(f"{len(titles)} names for {count} parameters")
    failed = len(found.history) - len(good)
    parts = [f"<h1>Optimization</h1><p>{escape(str(found))}</p>"]
    if failed:
        parts.append(f"<p>{failed} designs could not be analyzed.</p>")
    parts.append(_curve("objective", found.history, 0))
    for k in range(1, len(good[0].values)):
        parts.append(_curve(f"constraint {k}", found.history, k))
    parts.append(_table(titles, np.array(good[0].x), found.x))
    if build is not None:
        steps = np.unique(np.linspace(0, len(good) - 1, SHAPES - 1).round().astype(int))
        shown = [(f"design {found.history.index(good[k]) + 1}", good[k].x) for k in steps]
        parts.append(_shapes(build, [*shown, ("best", found.x.tolist())]))
    text = (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Optimization</title>'
        f"<style>{STYLE}</style>{''.join(parts)}</html>\n"
    )
    Path(path).write_text(text, encoding="utf-8")


def _curve(title: str, history: Sequence[Design], k: int) -> str:
    """History of a value; designs that failed have no point."""
    points = [(n, d.values[k]) for n, d in enumerate(history, 1) if not d.error]
    number, value = np.array(points).T
    low, high = float(value.min()), float(value.max())
    span = high - low or abs(high) or 1.0
    x = LEFT + (number - 1.0) / max(len(history) - 1, 1) * (WIDTH - LEFT - EDGE)
    y = HEIGHT - EDGE - (value - low) / span * (HEIGHT - 2.0 * EDGE)
    way = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
    dots = "".join(
        f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3"><title>design {int(n)}: {v:.6g}</title></circle>'
        for a, b, n, v in zip(x, y, number, value, strict=True)
    )
    labels = (
        f'<text x="4" y="{EDGE:.0f}">{high:.4g}</text>'
        f'<text x="4" y="{HEIGHT - EDGE:.0f}">{low:.4g}</text>'
        f'<text x="{WIDTH - 90:.0f}" y="{HEIGHT - 6:.0f}">{len(history)} designs</text>'
    )
    return (
        f'<h2>{escape(title)}</h2><svg viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}" role="img" '
        f'aria-label="{escape(title)} by design" font-size="12">{labels}'
        f'<polyline points="{way}" fill="none" stroke="{LINES[0]}" stroke-width="2"/>'
        f'<g fill="{LINES[0]}">{dots}</g></svg>'
    )


def _table(names: Sequence[str], first: Floats, best: Floats) -> str:
    rows = "".join(
        f"<tr><td>{escape(n)}</td><td>{a:.6g}</td><td>{b:.6g}</td></tr>"
        for n, a, b in zip(names, first, best, strict=True)
    )
    return f"<h2>Parameters</h2><table><tr><th></th><th>first</th><th>best</th></tr>{rows}</table>"


def _shapes(build: Callable[[Floats], Model], designs: Sequence[tuple[str, list[float]]]) -> str:
    """Outlines of designs, all to one scale."""
    meshes = [(title, build(np.array(x)).mesh) for title, x in designs]
    every = np.concatenate([mesh.points for _, mesh in meshes])
    low, size = every.min(axis=0), np.ptp(every, axis=0)
    scale = min((WIDTH - 2.0 * EDGE) / max(size[0], 1e-300), 2.0 * HEIGHT / max(size[1], 1e-300))
    return "<h2>Shapes</h2>" + "".join(_outline(t, m, low, size, scale) for t, m in meshes)


def _outline(title: str, mesh: Mesh, low: Floats, size: Floats, scale: float) -> str:
    height = scale * size[1] + 2.0 * EDGE

    def place(p: Floats) -> str:
        x, y = EDGE + scale * (p[0] - low[0]), height - EDGE - scale * (p[1] - low[1])
        return f"{x:.1f},{y:.1f}"

    edges = [e[:2] for e in mesh.edge_nodes(mesh.boundary_edges())]
    for cells in mesh.cells:
        if cells.kind == "line2":
            edges += list(cells.nodes)
    lines = "".join(f"M{place(mesh.points[a])}L{place(mesh.points[b])}" for a, b in edges)
    return (
        f'<p>{escape(title)}</p><svg viewBox="0 0 {WIDTH:.0f} {height:.0f}" role="img" '
        f'aria-label="{escape(title)}"><path d="{lines}" fill="none" stroke="{LINES[6]}"/></svg>'
    )
