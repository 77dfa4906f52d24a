"""Nodes with a rotation, and the message for a support of a missing one."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.mesh.parts import cells_of
from corota.model import elements
from corota.model.constraints import Coupling
from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from corota.arrays import Bools
    from corota.mesh import Mesh
    from corota.model.loads import Fixed
    from corota.model.model import Model


def rotating_nodes(model: Model) -> Bools:
    """Whether an element gives a node a rotation, shape (n_nodes,)."""
    mesh = model.mesh
    has = np.zeros(mesh.n_nodes, bool)
    for section in model.sections:
        if elements.find(section.element).dofs_per_node < 3:
            continue
        cells, offsets = cells_of(mesh, section.cells), mesh.offsets
        for number, block in enumerate(mesh.cells):
            inside = (cells >= offsets[number]) & (cells < offsets[number + 1])
            has[block.nodes[cells[inside] - offsets[number]]] = True
    return has


def reference_nodes(model: Model) -> list[int]:
    """Nodes that have a rotation because of attached bodies, curves or constraints."""
    found = [c.reference for c in model.constraints if isinstance(c, Coupling)]
    curves = [pair.master for pair in model.contacts if isinstance(pair.master, RigidCurve)]
    return found + [c.turning_node for c in curves if c.turning_node is not None]


def without_rotation(mesh: Mesh, support: Fixed) -> str:
    """Message on a supported rotation where no element has one."""
    nodes = mesh.node_indices(support.nodes)
    place = f"node {mesh.node_labels[nodes[0]]}"
    if isinstance(support.nodes, str):
        place = repr(support.nodes)
    elif len(nodes) > 1:
        place += f" and {len(nodes) - 1} others"
    known = ", ".join(n for n in elements.names() if elements.find(n).drilling)
    return (
        f"rotation={support.value:g} of {place} has no effect: the nodes of its elements have no "
        f"rotation. Nodes of {known} and of beams have one, and reference nodes; other bodies "
        "are clamped by holding two nodes"
    )
