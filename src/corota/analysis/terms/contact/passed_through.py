"""Nodes of no contact pair that went through a rigid curve, in silence but for this note."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.mesh.parts import part_of_nodes
from corota.model.contact import edges_or_nodes
from corota.results.rigid import rigid_curves, rigid_lines

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.model.contact import RigidCurve
    from corota.model.model import Model

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Depth, relative to the distance of slave nodes, that a neighbor of the slave surface may have.
SHALLOW = 0.1


def passed_through(model: Model, u: Floats) -> list[str]:
    """Notes on bodies of which a part without a pair lies behind their rigid curve.

    Parameters
    ----------
    model : Model
    u : ndarray, shape (n_nodes, 3)
        Displacements and rotations at the end.
    """
    mesh, notes = model.mesh, []
    part = part_of_nodes(mesh)
    for curve in rigid_curves(model):
        pairs = [pair for pair in model.contacts if pair.master is curve]
        slaves = np.concatenate([_slave_nodes(model, pair.slave) for pair in pairs])
        bodies = np.isin(part, part[slaves]) & (part >= 0)
        bodies[slaves] = False
        nodes = np.flatnonzero(bodies)
        if not len(nodes):
            continue
        before, after = mesh.points[nodes], _seen_from(curve, model, u, nodes)
        way = np.linalg.norm(after - before, axis=1)
        depth = np.where(_depth(curve, before) > 0.0, 0.0, _depth(curve, after))
        depth[depth > way] = 0.0  # it came there around an end
        shallow = SHALLOW * float(np.ptp(mesh.points[slaves], axis=0).max()) / len(slaves)
        deepest = int(np.argmax(depth))
        if depth[deepest] > shallow:
            notes.append(
                f"contact pair {pairs[0].name!r}: {int((depth > shallow).sum())} nodes of "
                f"the body that are in no pair with this rigid curve lie behind it, node "
                f"{mesh.node_labels[nodes[deepest]]} by {depth[deepest]:.3g}: they passed through. "
                "Give the slave surface all edges of the body that may meet the curve"
            )
    return notes


def _slave_nodes(model: Model, slave: str | Ints) -> Ints:
    edges, single = edges_or_nodes(model.mesh, slave)
    return single if len(single) else model.mesh.edge_set_nodes(edges)


def _seen_from(curve: RigidCurve, model: Model, u: Floats, nodes: Ints) -> Floats:
    """Places of nodes relative to a curve that moved with its reference node."""
    places = model.mesh.points[nodes] + u[nodes, :2]
    reference = curve.reference
    if not isinstance(reference, int | np.integer):
        return np.asarray(places)
    origin, turn = model.mesh.points[reference], float(u[reference, 2])
    back = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    return np.asarray((places - origin - u[reference, :2]) @ back + origin)


def _depth(curve: RigidCurve, points: Floats) -> Floats:
    """Depth of points behind a curve, 0 before it and beyond its ends [length]."""
    nearest, depth = np.full(len(points), np.inf), np.zeros(len(points))
    for line in rigid_lines(curve):
        for start, end in zip(line[:-1], line[1:], strict=True):
            along = end - start
            length = float(np.hypot(*along))
            along = along / length
            to = points - start
            s, out = to @ along, to @ np.array([-along[1], along[0]])
            beside = np.clip(s, 0.0, length)
            distance = np.hypot(s - beside, out)
            closer = distance < nearest
            nearest[closer] = distance[closer]
            behind = np.where((s > 0.0) & (s < length), np.maximum(-out, 0.0), 0.0)
            depth[closer] = behind[closer]
    return depth


__all__ = ["passed_through"]
