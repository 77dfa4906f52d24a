"""Bodies behind rigid curves: slaves that start there, parts without a pair that went through."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.gaps import SAME
from corota.analysis.terms.contact.messages import NAMED
from corota.analysis.terms.contact.tunneling import AT_ONCE, other_side
from corota.errors import ModelError
from corota.mesh.parts import nodes_of_cells, part_of_nodes, parts_without
from corota.model.contact import RigidCurve, edges_or_nodes
from corota.results.rigid import rigid_curves, rigid_lines

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.contact.pair import Pair
    from corota.model.model import Model

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Check of data: cosine between the normals of slave and curve from which the slave faces away; as
#: far on the other side it faces the curve, and between them neither.
BACK = 0.2


def check_side(system: NumberedModel, pair: Pair, x: Floats) -> None:
    """Refuse a slave surface whose body starts on the wrong side of a rigid curve.

    The body may have its surface on the curve, or reach through it by less than half.

    Parameters
    ----------
    system : NumberedModel
    pair : Pair
    x : ndarray, shape (n_nodes, 3)
        Positions and rotations at the start.

    Raises
    ------
    ModelError
        Naming the pair, the curve and the nearest node.
    """
    curve = getattr(pair.item, "master", None)
    if not isinstance(curve, RigidCurve) or not curve.turns:  # no curve, or a gap element
        return
    mesh = system.model.mesh
    pieces = other_side(pair, x, x)[0]
    if pair.slave.pointwise:
        _check_points(system, pair, pieces, x[:, :2])
        return
    ends = x[pair.slave.nodes[:, :2], :2]
    size = SAME * float(pair.slave.length.max())
    distance, normal, inside = _signed(pieces, ends.mean(axis=1), size)
    along = ends[:, 1] - ends[:, 0]
    outward = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
    turned = (outward * normal).sum(axis=1)
    steep = np.abs(turned) < BACK
    nearest = int(np.argmin(np.where(inside & ~steep, np.abs(distance), np.inf)))
    if not inside[nearest] or turned[nearest] < BACK:
        return
    # The edge faces away: the body is behind, or in front with its back to the curve.
    part = part_of_nodes(mesh)
    body = np.isin(part, part[pair.slave.node_list])
    behind, _, inside = _signed(pieces, x[body, :2], size)
    if not inside.any() or behind[inside].max() >= -behind[inside].min():
        return
    _refuse(system, pair, int(pair.slave.nodes[nearest, 0]), -float(distance[nearest]), size)


def _check_points(system: NumberedModel, pair: Pair, pieces: Floats, x: Floats) -> None:
    """The same for a line or single nodes, which have no outer side of their own."""
    nodes, size = pair.slave.node_list, SAME * float(pair.slave.length.max())
    distance, _, inside = _signed(pieces, x[nodes], size)
    nearest = int(np.argmin(np.where(inside, np.abs(distance), np.inf)))
    if not inside[nearest] or distance[nearest] > size:
        return
    # Springs end where they will, on either side, and a node with springs alone has no side.
    mesh, springs = system.model.mesh, np.zeros(system.model.mesh.n_cells, bool)
    for block in system.blocks:
        springs[block.cells] = block.section.element.startswith("SPRING")
    if not np.isin(nodes, nodes_of_cells(mesh, np.flatnonzero(~springs))).any():
        return
    part = parts_without(mesh, springs)
    body, _, inside = _signed(pieces, x[np.isin(part, part[nodes])], size)
    # What lies on the curve as a whole tells no side.
    if not inside.any() or body[inside].max() >= -body[inside].min() - size:
        return
    _refuse(system, pair, int(nodes[nearest]), -float(distance[nearest]), size)


def _refuse(system: NumberedModel, pair: Pair, node: int, depth: float, size: float) -> None:
    curve = pair.item.master
    assert isinstance(curve, RigidCurve)
    label = system.model.mesh.node_labels[node]
    place = (
        "on it"
        if abs(depth) <= size
        else f"{abs(depth):.4g} {'behind' if depth > 0 else 'through'} it"
    )
    name = f" {curve.name!r}" if curve.name else ""
    raise ModelError(
        f"contact pair {pair.item.name!r}: the slave surface starts on the wrong side of "
        f"the rigid curve{name}: node {label} is nearest, {place}. "
        "The deformable body belongs on the left of the curve's direction of travel; give its "
        "points in the other order (corota plot draws the rigid body shaded)",
        pair.item.where,
    )


def _signed(
    pieces: Floats, points: Floats, same: float
) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Signed distance to the nearest piece, positive in front, and the normal there.

    The last part of the result is whether the nearest point lies on the curve, not at a free end.
    """
    start, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    square = (along**2).sum(axis=1)
    normals = np.column_stack([along[:, 1], -along[:, 0]]) / np.sqrt(square)[:, None]
    first, last = _free_ends(pieces, same)
    distance, best = np.empty(len(points)), np.empty(len(points), np.int64)
    share = np.empty(len(points))
    for own in _parts(len(points), len(pieces)):
        away = points[own, None] - start
        t = (away * along).sum(axis=2) / square
        apart = away - np.clip(t, 0.0, 1.0)[:, :, None] * along
        size = np.hypot(apart[:, :, 0], apart[:, :, 1])
        height = (away * normals).sum(axis=2)
        near = size <= size.min(axis=1, keepdims=True) + same
        # At a corner the piece with the larger distance decides, as for a wedge.
        k = np.where(near, np.abs(height), -1.0).argmax(axis=1)
        rows = np.arange(len(k))
        best[own], share[own] = k, t[rows, k]
        distance[own] = np.copysign(size[rows, k], height[rows, k])
    beyond = ((share < 0.0) & first[best]) | ((share > 1.0) & last[best])
    return distance, normals[best], ~beyond


def _free_ends(pieces: Floats, same: float) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether the first and last ends of pieces are free: no other end is there."""
    joints = np.concatenate([pieces[:, 0], pieces[:, 1]])
    free = np.empty(len(joints), bool)
    for own in _parts(len(joints), len(joints)):
        apart = joints[own, None] - joints
        free[own] = (np.hypot(apart[:, :, 0], apart[:, :, 1]) <= same).sum(axis=1) == 1
    return free[: len(pieces)], free[len(pieces) :]


def _parts(rows: int, width: int) -> Iterator[slice]:
    """Slices of rows of some width that are compared at once."""
    count = max(1, AT_ONCE // max(width, 1))
    return (slice(begin, begin + count) for begin in range(0, rows, count))


def passed_through(model: Model, u: Floats) -> list[str]:
    """Notes on parts of bodies in no pair that lie behind a rigid curve or in another body.

    Parameters
    ----------
    model : Model
    u : ndarray, shape (n_nodes, 3)
        Displacements and rotations at the end.
    """
    mesh, notes = model.mesh, _in_another(model, u)
    part = part_of_nodes(mesh)
    for curve in rigid_curves(model):
        pairs = [pair for pair in model.contacts if pair.master is curve]
        slaves = np.concatenate([_surface_nodes(model, pair.slave) for pair in pairs])
        bodies = np.isin(part, part[slaves]) & (part >= 0)
        bodies[slaves] = False
        nodes = np.flatnonzero(bodies)
        if not len(nodes):
            continue
        before, after = mesh.points[nodes], _seen_from(curve, model, u, nodes)
        way = np.linalg.norm(after - before, axis=1)
        depth = np.where(_depth(curve, before) > 0.0, 0.0, _depth(curve, after))
        depth[depth > way] = 0.0  # it came there around an end
        # What may lie deeper than the slave surface beside it [mean distance of slave nodes].
        shallow = NAMED * float(np.ptp(mesh.points[slaves], axis=0).max()) / len(slaves)
        deepest = int(np.argmax(depth))
        if depth[deepest] > shallow:
            notes.append(
                f"contact pair {pairs[0].name!r}: {int((depth > shallow).sum())} nodes of "
                f"the body that are in no pair with this rigid curve lie behind it, node "
                f"{mesh.node_labels[nodes[deepest]]} by {depth[deepest]:.3g}: they passed through. "
                "Give the slave surface all edges of the body that may meet the curve"
            )
    return notes


def _in_another(model: Model, u: Floats) -> list[str]:
    """Notes on bodies of which a part in no pair lies in the other body of their pair."""
    mesh, notes = model.mesh, []
    part, x = part_of_nodes(mesh), mesh.points + u[:, :2]
    rims = [nodes[:2] for nodes in mesh.edge_nodes(mesh.boundary_edges())]
    edges = np.array(rims, np.int64).reshape(-1, 2)
    surfaces = [s for pair in model.contacts for s in (pair.slave, pair.master)]
    joined = np.concatenate(
        [_surface_nodes(model, s) for s in surfaces if not isinstance(s, RigidCurve)]
    )
    free = np.setdiff1d(edges, joined)
    for pair in model.contacts:
        if isinstance(pair.master, RigidCurve):
            continue
        sides = [np.unique(part[_surface_nodes(model, s)]) for s in (pair.slave, pair.master)]
        for own, other in (sides, sides[::-1]):
            nodes = free[np.isin(part[free], np.setdiff1d(own, other))]
            rim = edges[np.isin(part[edges[:, 0]], np.setdiff1d(other, own))]
            if not len(rim):
                continue
            length = np.hypot(*(x[rim[:, 1]] - x[rim[:, 0]]).T)
            inside = [k for k in nodes if _inside(x, rim, k) and not _inside(mesh.points, rim, k)]
            depth = [_distance(x, rim, k) for k in inside]
            if depth and max(depth) > NAMED * float(length.mean()):
                deepest = int(np.argmax(depth))
                notes.append(
                    f"contact pair {pair.name!r}: boundary nodes that are in no pair lie in the "
                    f"other body ({len(inside)} of them), node "
                    f"{mesh.node_labels[inside[deepest]]} by {depth[deepest]:.3g}. Give the "
                    "surfaces of the pair all edges that may meet"
                )
    return notes


def _inside(x: Floats, rim: Ints, node: int) -> bool:
    """Whether a node is inside closed boundaries (m, 2), by the parity of crossings."""
    (ax, ay), (bx, by) = x[rim[:, 0]].T, x[rim[:, 1]].T
    spans = (ay > x[node, 1]) != (by > x[node, 1])
    rise = np.where(spans, by - ay, 1.0)
    return bool((spans & (ax + (x[node, 1] - ay) / rise * (bx - ax) > x[node, 0])).sum() % 2)


def _distance(x: Floats, rim: Ints, node: int) -> float:
    """Distance of a node from the nearest of some edges (m, 2) [length]."""
    along, to = x[rim[:, 1]] - x[rim[:, 0]], x[node] - x[rim[:, 0]]
    share = np.clip((to * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    return float(np.hypot(*(to - share[:, None] * along).T).min())


def _surface_nodes(model: Model, surface: str | Ints) -> Ints:
    edges, single = edges_or_nodes(model.mesh, surface)
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


__all__ = ["check_side", "passed_through"]
