"""Statistics of ``*SECTION PRINT`` in the layout of CalculiX's ``.dat`` file.

CalculiX integrates stresses extrapolated to the surface. Here the force is that of the nodes of the
surface on the elements behind it: it is in equilibrium with loads and reactions.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Floats, Ints
from corota.errors import UnsupportedError
from corota.io.tables.dat_numbers import statistics
from corota.model.sections import thickness_at

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.model.steps import Output
    from corota.results.results import Frame


#: Variables of sections that are printed, all in one block.
VARIABLES = ("SOF", "SOM", "SOAREA")


def section_tables(model: Model, output: Output, frame: Frame) -> Iterator[str]:
    """Text of one request at a frame.

    Raises
    ------
    UnsupportedError
        If the forces of the elements are not known.
    """
    edges = model.mesh.edge_pairs(output.where)
    if not frame.increment or not frame.fields:
        return
    # Linear steps are in equilibrium in the undeformed state.
    linear = any(not getattr(s, "nlgeom", True) for s in model.steps[frame.step - 1 : frame.step])
    x = model.mesh.points + (0.0 if linear else frame.U)
    force, moment = _resultant(model, frame, edges, x)
    area, center, normal = _geometry(model, edges, x)
    yield statistics(
        f"surface set {output.where.upper()}",
        frame.time,
        "",
        (*force, moment),
        (area, center, normal),
        "area, normal force (+ = tension), shear force (size), torque and bending moment (size)",
        bends=True,
    )


def _resultant(model: Model, frame: Frame, edges: Ints, x: Floats) -> tuple[Floats, float]:
    """Force of the surface's nodes on the elements behind it, and its moment about the origin."""
    mesh = model.mesh
    behind: dict[int, list[int]] = {}
    for node, some in _behind(mesh, edges).items():
        for cell in some:
            behind.setdefault(cell, []).append(node)
    force, moment = np.zeros(2), 0.0
    for block in frame.fields:
        mine = np.flatnonzero(np.isin(block.cells, list(behind)))
        if not len(mine):
            continue
        if block.forces is None:
            raise UnsupportedError(
                "*SECTION PRINT: these results contain no forces of the elements; print it in the "
                "run itself"
            )
        for row in mine.tolist():
            cell = int(block.cells[row])
            where, local = mesh.locate(cell)
            nodes = mesh.cells[where].nodes[local]
            on = np.isin(nodes, behind[cell])
            f, at = block.forces[row][on], x[nodes[on]]
            force = force + f[:, :2].sum(axis=0)
            moment += float((at[:, 0] * f[:, 1] - at[:, 1] * f[:, 0]).sum())
            if f.shape[1] > 2:
                moment += float(f[:, 2].sum())
    return force, moment


def _behind(mesh: Mesh, edges: Ints) -> dict[int, set[int]]:
    """Cells behind a surface at each of its nodes: also those that only touch it with a corner.

    They are reached around the node from the cells of the surface, not through the surface. Where
    it ends within the body this leads to its other side; there its own cells count alone.
    """
    inside = np.zeros(mesh.n_nodes, bool)
    inside[mesh.edge_set_nodes(edges)] = True
    meeting = np.concatenate([inside[cells.nodes].any(axis=1) for cells in mesh.cells])
    keys, pairs = mesh.cell_edges()
    near = meeting[pairs[:, 0]]
    faces = set(map(tuple, edges.tolist()))
    of_edge: dict[int, list[tuple[int, int]]] = {}
    for key, (cell, side) in zip(keys[near].tolist(), pairs[near].tolist(), strict=True):
        of_edge.setdefault(key, []).append((cell, side))
    found: dict[int, set[int]] = {}
    beyond: dict[int, set[int]] = {}
    around: dict[int, list[set[int]]] = {}
    for members in of_edge.values():
        cells = {cell for cell, _ in members}
        own = {member[0] for member in members if member in faces}
        for node in mesh.edge_nodes(members[:1])[0].tolist():
            if own:
                found.setdefault(node, set()).update(own)
                beyond.setdefault(node, set()).update(cells - own)
            elif inside[node]:
                around.setdefault(node, []).append(cells)
    for node, own in found.items():
        reached, links = set(own), around.get(node, [])
        while grown := [cells for cells in links if cells & reached and cells - reached]:
            reached.update(*grown)
        if not reached & beyond[node]:
            found[node] = reached
    return found


def _geometry(model: Model, edges: Ints, x: Floats) -> tuple[float, Floats, Floats]:
    """Area of a surface, its center and its mean outward normal, in the current state."""
    ends = np.array([nodes[:2] for nodes in model.mesh.edge_nodes(edges)])
    chord = x[ends[:, 1]] - x[ends[:, 0]]
    thickness = thickness_at(model.mesh, model.sections, edges[:, 0], ends, x)
    # Those of the ends where the thickness is linear between them.
    weight = np.hypot(*chord.T)[:, None] * (thickness + thickness.sum(axis=1, keepdims=True)) / 6.0
    area = float(weight.sum())
    center = np.einsum("ij,ijk->k", weight, x[ends]) / area
    normal = np.array([chord[:, 1], -chord[:, 0]]) @ thickness.mean(axis=1)
    return area, center, normal / (math.hypot(*normal) or 1.0)
