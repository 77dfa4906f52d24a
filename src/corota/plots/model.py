"""The model before the run: mesh, sections, sets, supports and loads."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from os import PathLike
from typing import Any

import numpy as np

from corota.arrays import Floats, Ints
from corota.mesh import EDGES, Mesh
from corota.model.loads import BodyForce, EdgeLoad, NodalForce, applied
from corota.model.model import Model
from corota.model.steps import Step, listed_steps
from corota.plots.figure import COLORS, INK, body_figure, finish, look, plane_axes
from corota.plots.lines import draw_lines
from corota.plots.rigid import draw_rigid, with_rigid
from corota.plots.surface import edge_lines, outline, surface
from corota.results.averaging import section_of_cells

#: Colors of sections, pale enough for symbols above them.
SHADES = ("#dbe7f3", "#fbe6d3", "#dcefe4", "#f3e0ec", "#f8efc9", "#e4e4ea")
#: Spacing of symbols of one kind, relative to the model's diagonal.
APART = 0.022
#: Sets in the legend, at most.
MOST_SETS = 8
#: A set with this share of the nodes is that of all: reference nodes may be missing.
WHOLE = 0.9
#: Triangles of matplotlib whose tip is at the point: by direction, then by side of the model.
CARETS = ((5, 4), (6, 7))
LOAD, SUPPORT, MOVED = "#D55E00", "#0b6e4f", "#7b3fa0"


def model(
    subject: Model | Mesh,
    *,
    steps: Step | Sequence[Step] | None = None,
    sets: bool = True,
    edges: bool | None = None,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw a model: sections in colors, node and edge sets, supports and loads.

    Triangles point along fixed directions, squares fix the rotation, violet arrows are
    prescribed displacements, orange ones loads; lengths compare loads of one kind only. Beams and
    bars
    are heavy lines, springs zigzags, thin lines lead to reference nodes.

    Parameters
    ----------
    subject : Model or Mesh
    steps : Step or sequence of Step, optional
        Whose supports and loads are drawn, as :func:`corota.solve` takes them; by default the
        model's own.
    sets : bool
        Mark node and edge sets, up to eight.
    edges : bool, optional
        Draw the cells' edges; by default in meshes of up to 4,000 cells.
    title : str, optional
    path, ax, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    if isinstance(subject, Mesh):
        subject = Model(subject, "mesh")
    if steps is not None:
        subject = copy(subject)
        subject.steps = listed_steps(steps)
    mesh = subject.mesh
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    size = float(np.linalg.norm(high - low)) or 1.0
    low, high = with_rigid(subject, low, high)
    with look():
        from matplotlib.collections import LineCollection

        margin = 0.1 * size
        figure, ax, _ = body_figure(ax, low - margin, high + margin, path is None)
        _sections(ax, subject)
        if mesh.n_cells <= 4000 if edges is None else edges:
            ax.add_collection(
                LineCollection(
                    edge_lines(mesh, mesh.points), colors="#5b6472", linewidths=0.3, alpha=0.7
                )
            )
        ax.add_collection(LineCollection(outline(mesh, mesh.points), colors=INK, linewidths=0.9))
        draw_rigid(ax, subject)
        draw_lines(ax, subject, size)
        if sets:
            _sets(ax, subject)
        _supports(ax, subject, size)
        _loads(ax, subject, size)
        plane_axes(ax, low, high, margin, subject.unit_system)
        counts = f"{mesh.n_nodes:,} nodes, {mesh.n_cells:,} elements"
        ax.set_title(title if title is not None else f"{subject.name}: {counts}", loc="left")
        handles, labels = ax.get_legend_handles_labels()
        if handles:
            figure.legend(
                handles,
                labels,
                loc="outside lower center",
                ncols=min(4, len(handles)),
                handletextpad=0.4,
                columnspacing=1.2,
            )
        return finish(figure, path, dpi)


def _sections(ax: Any, subject: Model) -> None:
    mesh = subject.mesh
    groups = section_of_cells(subject)
    for number, group in enumerate(np.unique(groups)):
        part = surface(mesh, groups == group)
        if not len(part.triangles):
            continue
        from matplotlib.collections import PolyCollection

        corners = part.values(mesh.points)[part.triangles]
        color = "#eceff3" if group < 0 else SHADES[number % len(SHADES)]
        ax.add_collection(
            PolyCollection(
                list(corners),
                facecolors=color,
                linewidths=0.0,
                antialiaseds=False,
                zorder=0.5,
                rasterized=len(corners) > 20000,
            )
        )


def _sets(ax: Any, subject: Model) -> None:
    from matplotlib.collections import LineCollection

    mesh, shown = subject.mesh, 0
    for name, members in mesh.edge_sets.items():
        if shown == MOST_SETS or not len(members):
            continue
        color = COLORS[shown % len(COLORS)]
        lines = [mesh.points[n[[0, 2, 1]] if len(n) == 3 else n] for n in mesh.edge_nodes(members)]
        ax.add_collection(
            LineCollection(lines, colors=color, linewidths=2.6, alpha=0.8, label=name, zorder=2.5)
        )
        shown += 1
    for name, members in mesh.node_sets.items():
        whole = not 0 < len(members) < WHOLE * mesh.n_nodes
        if shown == MOST_SETS or whole or name in mesh.edge_sets:
            continue
        color = COLORS[shown % len(COLORS)]
        at = mesh.points[members]
        ax.plot(
            at[:, 0],
            at[:, 1],
            "o",
            markersize=3.0,
            color=color,
            markeredgewidth=0.0,
            label=name,
            zorder=2.6,
        )
        shown += 1


def _spread(points: Floats, size: float) -> Ints:
    """Indices of spaced points: one in each square of a grid."""
    square = np.round(points / (APART * size)).astype(np.int64)
    _, first = np.unique(square, axis=0, return_index=True)
    return np.sort(first)


def _supports(ax: Any, subject: Model, size: float) -> None:
    mesh = subject.mesh
    middle = 0.5 * (mesh.points.min(axis=0) + mesh.points.max(axis=0))
    held = [*subject.supports, *(s for step in subject.steps for s in step.supports)]
    drawn: set[tuple[int, int]] = set()
    marker: str | int
    for support in held:
        if support.free:
            continue
        where = support.nodes
        nodes = mesh.node_indices(where)
        nodes = np.unique(nodes)
        for node in nodes[_spread(mesh.points[nodes], size)]:
            if (int(node), support.dof) in drawn:
                continue
            drawn.add((int(node), support.dof))
            x, y = mesh.points[node]
            if support.dof == 2:
                color, marker = SUPPORT, "s"
            elif support.value != 0.0:
                direction = np.eye(2)[support.dof] * np.sign(support.value)
                _arrow(ax, (x, y), direction * 0.09 * size, MOVED, tail=True)
                continue
            else:
                beyond = (x, y)[support.dof] > middle[support.dof]
                color = SUPPORT
                marker = CARETS[support.dof][int(beyond)]
            ax.plot(
                x,
                y,
                marker=marker,
                markersize=6.0 if support.dof < 2 else 4.5,
                color=color,
                markerfacecolor="none" if support.dof == 2 else color,
                markeredgewidth=0.9,
                linestyle="",
                zorder=4,
            )


def _loads(ax: Any, subject: Model, size: float) -> None:
    mesh = subject.mesh
    every = [*subject.loads, *(load for step in subject.steps for load in step.loads)]
    loads = applied(every, mesh)
    forces = [
        float(np.abs(v.value).max()) for v in loads if isinstance(v, NodalForce) and v.dof < 2
    ]
    largest = max(forces, default=1.0) or 1.0
    for load in loads:
        if isinstance(load, NodalForce):
            where = load.nodes
            nodes = mesh.node_indices(where)
            value = float(np.sum(load.value))
            nodes = np.unique(nodes)
            for node in nodes[_spread(mesh.points[nodes], size)]:
                at = mesh.points[node]
                if load.dof == 2:
                    sign = "$\\circlearrowleft$" if value > 0 else "$\\circlearrowright$"
                    ax.plot(*at, marker=sign, markersize=14, color=LOAD, linestyle="", zorder=5)
                    continue
                share = 0.05 + 0.06 * abs(value) / largest
                direction = np.eye(2)[load.dof] * np.sign(value)
                _arrow(ax, at, direction * share * size, LOAD)
        elif isinstance(load, EdgeLoad):
            _edge_load(ax, subject, load, size)
        elif isinstance(load, BodyForce) and load.kind != "centrifugal":
            direction = np.array(load.value[:2])
            length = float(np.linalg.norm(direction))
            if length > 0.0:
                at = mesh.points.mean(axis=0)
                _arrow(ax, at, 0.12 * size * direction / length, "#b8860b", tail=True, wide=True)


def _edge_load(ax: Any, subject: Model, load: EdgeLoad, size: float) -> None:
    mesh = subject.mesh
    where = load.edges
    edges = mesh.edge_sets[where] if isinstance(where, str) else np.asarray(where)
    centers = np.array([mesh.points[n[:2]].mean(axis=0) for n in mesh.edge_nodes(edges)])
    for cell, side in edges[_spread(centers, size)] if len(edges) else ():
        block, row = mesh.locate(int(cell))
        cells = mesh.cells[block]
        first, last = mesh.points[cells.nodes[row, list(EDGES[cells.kind][int(side)][:2])]]
        along = last - first
        length = float(np.linalg.norm(along)) or 1.0
        inward = np.array([-along[1], along[0]]) / length
        if load.kind.endswith("pressure"):
            direction = inward * np.sign(load.value[0])
        elif load.kind == "shear":
            direction = along / length * np.sign(load.value[0])
        elif load.kind == "electrostatic":
            direction = -inward
        else:
            direction = np.array(load.value[:2])
            direction = direction / (float(np.linalg.norm(direction)) or 1.0)
        head = load.kind.endswith("pressure") and load.value[0] > 0.0
        _arrow(ax, 0.5 * (first + last), 0.06 * size * direction, LOAD, tail=not head)


def _arrow(
    ax: Any, at: Any, vector: Any, color: str, tail: bool = False, wide: bool = False
) -> None:
    at, vector = np.asarray(at, dtype=float), np.asarray(vector, dtype=float)
    start, end = (at, at + vector) if tail else (at - vector, at)
    if not tail:  # loads pull or push: show the force where it can be seen, outside
        start, end = at, at + vector
    ax.annotate(
        "",
        xy=end,
        xytext=start,
        zorder=5,
        annotation_clip=False,
        arrowprops={
            "arrowstyle": "-|>",
            "color": color,
            "linewidth": 1.8 if wide else 1.0,
            "shrinkA": 0,
            "shrinkB": 0,
            "mutation_scale": 11 if wide else 8,
        },
    )
    ax.update_datalim([start, end])
