"""Statistics of ``*SECTION PRINT`` in the layout of CalculiX's ``.dat`` file.

CalculiX integrates stresses extrapolated to the surface. Here the force is that of the nodes of the
surface on its elements: it is in equilibrium with loads and reactions.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Floats, Ints, distinct
from corota.errors import UnsupportedError
from corota.io.tables.dat_numbers import statistics
from corota.model.sections import thickness_at

if TYPE_CHECKING:
    from collections.abc import Iterator

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
    """Force of the surface's nodes on its elements, and its moment about the origin."""
    mesh = model.mesh
    inside = np.zeros(mesh.n_nodes, bool)
    inside[mesh.edge_set_nodes(edges)] = True
    cells = distinct(edges[:, 0])
    force, moment, count = np.zeros(2), 0.0, 0
    for block in frame.fields:
        mine = np.flatnonzero(np.isin(block.cells, cells))
        if not len(mine):
            continue
        if block.forces is None:
            raise UnsupportedError(
                "*SECTION PRINT: these results contain no forces of the elements; print it in the "
                "run itself"
            )
        count += len(mine)
        for row in mine.tolist():
            where, local = mesh.locate(int(block.cells[row]))
            nodes = mesh.cells[where].nodes[local]
            on = inside[nodes]
            f, at = block.forces[row][on], x[nodes[on]]
            force = force + f[:, :2].sum(axis=0)
            moment += float((at[:, 0] * f[:, 1] - at[:, 1] * f[:, 0]).sum())
            if f.shape[1] > 2:
                moment += float(f[:, 2].sum())
    return force, moment


def _geometry(model: Model, edges: Ints, x: Floats) -> tuple[float, Floats, Floats]:
    """Area of a surface, its center and its mean outward normal, in the current state."""
    ends = np.array([nodes[:2] for nodes in model.mesh.edge_nodes(edges)])
    chord = x[ends[:, 1]] - x[ends[:, 0]]
    thickness = thickness_at(model.mesh, model.sections, edges[:, 0], ends)
    weight = 0.5 * thickness * np.hypot(*chord.T)[:, None]
    area = float(weight.sum())
    center = np.einsum("ij,ijk->k", weight, x[ends]) / area
    normal = np.array([chord[:, 1], -chord[:, 0]]) @ thickness.mean(axis=1)
    return area, center, normal / (math.hypot(*normal) or 1.0)
