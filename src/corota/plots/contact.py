"""Contact along a surface: pressure, shear traction, and the state of every node."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.model.contact import ContactPair, edges_or_nodes
from corota.plots.contour import frame_title
from corota.plots.figure import (
    COLORS,
    INK,
    PALE,
    body_figure,
    chart,
    figure_of,
    finish,
    look,
    plane_axes,
)
from corota.plots.rigid import draw_rigid
from corota.plots.surface import outline

if TYPE_CHECKING:
    from os import PathLike

    from corota.arrays import Floats, Ints
    from corota.results.results import Results


#: Names and colors of the states of nodes.
STATES = (("open", PALE), ("closed", COLORS[0]), ("slipping", COLORS[1]))


def contact_line(
    results: Results,
    pair: str = "",
    *,
    frame: int = -1,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw pressure, and shear traction if there is any, along the slave surface of a pair.

    The abscissa is the length along the undeformed surface, the body on the left; the closed part
    is shown, with a tenth more on either side.

    Parameters
    ----------
    results : Results
    pair : str
        Name of a contact pair; the first one by default.
    frame : int
        The last by default.
    title : str, optional
    path, ax, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such pair or frame.
    """
    chosen = _pair(results, pair)
    state = results.frame(frame)
    assert state.C is not None
    contact = state.pairs.get(chosen.name, state.C)
    runs = _contours(results, chosen)
    with look():
        figure, ax = figure_of(ax, 6.0, 3.6, shown=path is None)
        low, high = np.inf, -np.inf
        for nodes, way in runs:
            pressure, shear, _, _, status = contact[nodes].T
            closed = status > 0.0
            if closed.any():
                low = min(low, float(way[closed].min()))
                high = max(high, float(way[closed].max()))
            first = way is runs[0][1]
            _curve(ax, way, pressure, COLORS[0], "pressure" if first else "")
            if np.any(shear != 0.0):
                _curve(ax, way, shear, COLORS[1], "shear traction" if first else "")
            for value, (name, color) in enumerate(STATES):
                at = status == value
                if at.any() and value:
                    ax.plot(
                        way[at],
                        np.zeros(int(at.sum())),
                        "|",
                        color=color,
                        markersize=7.0,
                        label=name if first else "",
                    )
        if high >= low:
            pad = 0.1 * (high - low) or 0.1 * float(runs[0][1][-1])
            ax.set_xlim(low - pad, high + pad)
        ax.axhline(0.0, color=INK, linewidth=0.6, zorder=1)
        units = results.model.unit_system
        length, stress = (units.label(d) or d for d in ("length", "force/length^2"))
        ax.set_xlabel(f"along the slave surface [{length}]")
        ax.set_ylabel(f"traction [{stress}]")
        chart(ax, zero=False)
        ax.legend()
        at_time = f"{chosen.name}: step {state.step}, time {state.time:.6g}"
        ax.set_title(title if title is not None else at_time, loc="left")
        return finish(figure, path, dpi)


def status(
    results: Results,
    *,
    frame: int = -1,
    scale: float = 1.0,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw the deformed outline, rigid curves, and the state of every slave node.

    Parameters
    ----------
    results : Results
    frame : int
        The last by default.
    scale : float
        Factor of the drawn displacements.
    title, path, ax, dpi
        As for :func:`contact_line`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    _pair(results, "")
    state = results.frame(frame)
    assert state.C is not None
    mesh = results.mesh
    used = np.unique(np.concatenate([c.nodes.ravel() for c in mesh.cells]))
    positions = mesh.points + scale * state.U
    low, high = positions[used].min(axis=0), positions[used].max(axis=0)
    with look():
        from matplotlib.collections import LineCollection

        figure, ax, _ = body_figure(ax, low, high, path is None)
        drawn = outline(mesh, positions)
        drawn += [ends for c in mesh.cells if c.kind == "line2" for ends in positions[c.nodes]]
        ax.add_collection(LineCollection(drawn, colors=INK, linewidths=0.8))
        draw_rigid(ax, results.model, state, scale)
        every = [n for p in results.model.contacts for n, _ in _contours(results, p)]
        nodes = np.unique(np.concatenate(every))
        for value, (name, color) in enumerate(STATES):
            at = nodes[state.C[nodes, 4] == value]
            size = 2.0 if value == 0 else 4.0
            if len(at):
                ax.plot(*positions[at].T, "o", color=color, markersize=size, label=name, zorder=3)
        pad = 0.06 * float((high - low).max())
        plane_axes(ax, low, high, pad, results.model.unit_system)
        ax.legend(loc="best")
        ax.set_title(title if title is not None else frame_title(results, frame, scale), loc="left")
        return finish(figure, path, dpi)


def _curve(ax: Any, way: Floats, values: Floats, color: str, name: str) -> None:
    ax.plot(
        way,
        values,
        color=color,
        linewidth=1.4,
        marker="o" if len(way) < 120 else "",
        markersize=3.0,
        markerfacecolor="white",
        markeredgewidth=0.8,
        label=name,
    )


def _pair(results: Results, name: str) -> ContactPair:
    pairs = results.model.contacts
    if not pairs:
        raise InputError("the results hold no contact pair")
    found = next((p for p in pairs if name in ("", p.name)), None)
    if found is None:
        known = ", ".join(p.name for p in pairs)
        raise InputError(f"no contact pair named {name!r}; there are: {known}")
    return found


def _contours(results: Results, pair: ContactPair) -> list[tuple[Ints, Floats]]:
    """Nodes of the slave surface in order, and the length along it; one for each contour."""
    mesh = results.mesh
    edges, single = edges_or_nodes(mesh, pair.slave)
    if len(single):
        # Single nodes stand along the longer side of the box around them.
        points = mesh.points[single]
        axis = int(np.argmax(np.ptp(points, axis=0)))
        single = single[np.argsort(points[:, axis], kind="stable")]
        return [(single, mesh.points[single, axis] - mesh.points[single[0], axis])]
    chain: dict[int, tuple[int, ...]] = {}
    for nodes in mesh.edge_nodes(edges):
        a, b, *middle = nodes.tolist()
        chain[a] = (*middle, b)
    ends = {chain[a][-1] for a in chain}
    runs: list[tuple[Ints, Floats]] = []
    left = dict(chain)
    for start in [*(a for a in chain if a not in ends), *chain]:
        if start not in left:
            continue
        order = [start]
        while order[-1] in left:
            order += left.pop(order[-1])
        points = mesh.points[order]
        way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        runs.append((np.array(order, np.int64), way))
    return runs
