"""Nodes that constraints, ties and contact connect to others."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.model.constraints import Coupling, Equation
from corota.model.contact import RigidCurve, edges_or_nodes

if TYPE_CHECKING:
    from corota.arrays import Bools
    from corota.model.model import Model


def constrained_nodes(model: Model) -> Bools:
    """Whether a constraint or a rigid curve has a node, shape (n_nodes,)."""
    mesh = model.mesh
    has = np.zeros(mesh.n_nodes, bool)
    for constraint in model.constraints:
        if isinstance(constraint, Equation):
            has[[node for node, *_ in constraint.terms]] = True
            continue
        has[mesh.node_indices(constraint.nodes)] = True
        ends = (
            [constraint.reference]
            if isinstance(constraint, Coupling)
            else [constraint.first, constraint.last]
        )
        has[ends] = True
    for pair in model.contacts:
        curve = pair.master
        if isinstance(curve, RigidCurve) and isinstance(curve.reference, int | np.integer):
            has[int(curve.reference)] = True
    return has


def joined_nodes(model: Model) -> Bools:
    """Whether a node is in a constraint, or on an edge of a tie or a contact pair."""
    has, mesh = constrained_nodes(model), model.mesh
    sides: list[object] = [side for tie in model.ties for side in (tie.slave, tie.master)]
    sides += [side for pair in model.contacts for side in (pair.slave, pair.master)]
    for side in sides:
        if not isinstance(side, RigidCurve):
            edges, nodes = edges_or_nodes(mesh, side)  # type: ignore[arg-type]
            has[nodes] = True
            has[mesh.edge_set_nodes(edges)] = True
    return has
