"""Nodes on the wrong side: at the start, after an increment, and at the end of a run.

The core searches no farther than its reach, and a penetration deeper than the body is no contact. A
node that moved farther may be behind the opposite surface without contact, and one that moved
across a body may be outside again on its other side; such an increment is refused. A slave that
starts behind a rigid curve is refused as well, and parts without a pair that went through are
noted.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.terms.contact.gaps import AT_ONCE, CLOSED, OPEN, SAME, SLIPPING, SMALL, covered
from corota.analysis.terms.contact.setup import outward
from corota.errors import ModelError
from corota.mesh.parts import nodes_of_cells, part_of_nodes, parts_without
from corota.model.contact import ContactPair, RigidCurve, edges_or_nodes
from corota.results.rigid import rigid_curves, rigid_lines

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.contact.pair import Pair, Terms
    from corota.arrays import Bools, Floats, Ints
    from corota.model.model import Model


#: Search radius: fraction of the reach, and of the width of a body, that a node may move without
#: this check; in relaxation, fraction of the shortest slave edge from a position to the next.
UNSEEN = 0.5
#: Angle up to which an arc counts as straight, of the way of a side that turns in an increment; and
#: between a slave edge and the normal of a rigid curve up to which it faces neither side [rad].
STRAIGHT = 0.1
#: Notes alone: depth of a penetration [edges], or height of facets over an overlap, from which it
#: is reported; half of it where a pair does not press at all.
NAMED = 0.05


def passed(
    pair: Pair,
    old: Floats,
    new: Floats,
    states: Callable[[], NDArray[np.int8]],
    terms: Terms,
    starts: Callable[[], Floats],
) -> Ints:
    """Constraints whose node crossed the other side from outside to inside and is open.

    `old` and `new` are positions at both ends of the increment, shape (n_nodes, 3), `terms` the
    gaps at its end, `states` finds the states there, `starts` the outer sides (`outside`).
    """
    if pair.tied:
        return np.zeros(0, np.int64)
    first, last, ends = other_side(pair, old, new)
    if not len(first):
        return np.zeros(0, np.int64)
    if pair.width_across is None:
        itself = getattr(pair.item, "itself", False)
        pieces = other_side(pair, pair.reference, pair.reference)[0]
        pair.width_across = math.inf if itself else _width(pieces)
    least = min(pair.reach, pair.width_across)
    nodes, state = pair.nodes, None
    through = np.arange(len(nodes))
    unseen = ~covered(terms.area, pair.full)
    # Bodies that turn together go along arcs: who passes goes through seen from either of them.
    sides = (old[nodes, :2], new[nodes, :2]), (first.reshape(-1, 2), last.reshape(-1, 2))
    turns = [_turn(*side) for side in sides]
    common = abs(math.remainder(turns[0] - turns[1], math.tau)) <= STRAIGHT < abs(turns[0])
    for turn in sorted(set(turns)) if common else [0.0]:
        c, s = math.cos(turn), math.sin(turn)
        back = np.array([[c, -s], [s, c]])
        seen, end = np.column_stack([new[:, :2] @ back, new[:, 2]]), last @ back
        mean, spread = np.zeros(2), 0.0
        if first is not last:
            drift = (end - first).reshape(-1, 2)
            mean = drift.mean(axis=0)
            spread = np.hypot(*(drift - mean).T).max()
        moved = np.hypot(*(seen[nodes, :2] - old[nodes, :2] - mean).T) + spread
        far = (moved > UNSEEN * least) | (unseen & (moved > pair.depth))
        through = through[far[through]]
        if not len(through):
            break
        state = states() if state is None else state
        closed = np.isin(nodes, nodes[(state == CLOSED) | (state == SLIPPING)])
        through = through[~closed[through]]
        start = starts()[through]
        share = times_of_crossing(
            first, end, ends, old, seen, nodes[through], start, SMALL * pair.edge
        )
        through = through[share < math.inf]
    return through


def _turn(old: Floats, new: Floats) -> float:
    """Angle by which points turn about their center in the mean [rad]."""
    before, after = old - old.mean(axis=0), new - new.mean(axis=0)
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return math.atan2(float(across.sum()), float((before * after).sum()))


def outside(term: Any, k: int, moves: bool) -> Floats:
    """Distance from the other side from which each node of pair `k` starts outside, shape (n,).

    A node may touch. In motion (`moves`) an open one may be behind, where a scheme closes gaps
    after the impact.
    """
    pair, committed = term.pairs[k], None if term.at is None else term.at.states
    start = np.full(pair.n, -SMALL * pair.edge)
    if moves and math.isfinite(pair.depth):
        behind = pair.gaps_at(term, k, term.positions(term.u)).gap < 0.0
        if committed:
            behind &= committed[k] == OPEN
        start[behind] = -pair.depth
    return start


def _width(pieces: Floats) -> float:
    """Least extent of a body that pieces go round; infinite where they end or go round a hole."""
    points = pieces.reshape(-1, 2)
    (x, y), size = points.T, np.ptp(points, axis=0)
    closed = not alone(points, SAME * float(size.max())).any()
    twice = float((x[::2] * y[1::2] - x[1::2] * y[::2]).sum())
    return float(size.min()) if closed and twice > SAME * size.max() ** 2 else math.inf


def _side(pieces: Floats, x: Floats) -> Floats:
    """Distances of points from lines, positive outside: on the right."""
    d, r = pieces[..., 1, :] - pieces[..., 0, :], x - pieces[..., 0, :]
    length = np.hypot(d[..., 0], d[..., 1])
    return np.asarray((d[..., 1] * r[..., 0] - d[..., 0] * r[..., 1]) / length)


def other_side(pair: Pair, old: Floats, new: Floats) -> tuple[Floats, Floats, Ints]:
    """Straight pieces of the other side at both ends: (m, 2, 2) twice, and their nodes."""
    item = pair.item
    master = getattr(item, "master", None)
    if isinstance(master, RigidCurve):
        if pair.chords is None:
            pair.chords = _chords(master)
        pieces = pair.chords
        nodes = np.full((len(pieces), 2), -1, np.int64)
        node = master.reference
        if not isinstance(node, int | np.integer):
            return pieces, pieces, nodes
        first, last = (
            _turned(pieces, master.turns * x[node, 2], pair.reference[node, :2], x[node, :2])
            for x in (old, new)
        )
        return first, last, nodes
    other = pair.slave if pair.master is None else pair.master
    nodes = other.nodes[:, :2]
    if other.two_sided:
        nodes = np.concatenate([nodes, nodes[:, ::-1]])
    return old[nodes][:, :, :2], new[nodes][:, :, :2], nodes


def _chords(curve: RigidCurve) -> Floats:
    """A curve as straight pieces, the rigid body on their left, shape (m, 2, 2)."""
    lines = rigid_lines(curve)
    return np.concatenate([np.stack([line[1:], line[:-1]], axis=1) for line in lines])


def _turned(x: Floats, turn: float, about: Floats, to: Floats) -> Floats:
    """Points turned about one point by an angle and moved to another."""
    c, s = math.cos(turn), math.sin(turn)
    return np.asarray((x - about) @ np.array([[c, s], [-s, c]]) + to)


def times_of_crossing(
    first: Floats,
    last: Floats,
    ends: Ints,
    old: Floats,
    new: Floats,
    nodes: Ints,
    start: Floats,
    depth: float = 0.0,
) -> Floats:
    """Shares of the way after which nodes go through a piece from outside; inf if they do not.

    All move evenly.

    Parameters
    ----------
    first, last, ends : ndarray
        See :func:`other_side`.
    old, new : ndarray, shape (n_nodes, 3)
    nodes : ndarray of int, shape (k,)
    start : ndarray, shape (k,)
        Distance at which the outer side begins for each.
    depth : float
        Distance from a piece, at the start and at the end, that is none.
    """
    out = np.full(len(nodes), math.inf)
    x, y = old[nodes, :2], new[nodes, :2]
    for k, piece in _near(first, last, x, y, np.maximum(-start, 0.0)):
        a, b = _side(first[piece], x[k]), _side(last[piece], y[k])
        through = (a > start[k]) & (b < -depth) & (ends[piece] != nodes[k, None]).all(axis=1)
        k, piece, a, b = k[through], piece[through], a[through], b[through]
        a[a <= depth] = 0.0
        share = a / (a - b)
        t = share[:, None]
        met = first[piece] + t[:, :, None] * (last[piece] - first[piece])
        hit = _beside(met, x[k] + t * (y[k] - x[k]))
        # A node that starts on a piece may leave it around a corner.
        hit &= (share > 0.0) | _beside(last[piece], y[k])
        np.minimum.at(out, k[hit], share[hit])
    return out


def _near(
    first: Floats, last: Floats, x: Floats, y: Floats, margin: Floats
) -> Iterator[tuple[Ints, Ints]]:
    """Nodes and pieces whose ways may meet, by boxes that move with the mean of the pieces."""
    if not len(x):
        return
    mean = (last - first).mean(axis=(0, 1))
    last, y = last - mean, y - mean
    low = np.minimum(first.min(axis=1), last.min(axis=1))
    high = np.maximum(first.max(axis=1), last.max(axis=1))
    below, above = np.minimum(x, y) - margin[:, None], np.maximum(x, y) + margin[:, None]
    axis = int(np.argmax(np.ptp(low, axis=0)))
    order = np.argsort(low[:, axis])
    sorted_low, widest = low[order, axis], (high - low)[:, axis].max()
    begin = np.searchsorted(sorted_low, below[:, axis] - widest)
    count = np.searchsorted(sorted_low, above[:, axis], side="right") - begin
    part = np.cumsum(count) // AT_ONCE
    for number in range(int(part[-1]) + 1):
        own = np.flatnonzero(part == number)
        k = np.repeat(own, count[own])
        before = np.cumsum(count[own]) - count[own]
        piece = order[np.arange(len(k)) + np.repeat(begin[own] - before, count[own])]
        meet = (low[piece] <= above[k]).all(axis=1) & (high[piece] >= below[k]).all(axis=1)
        yield k[meet], piece[meet]


def _beside(pieces: Floats, x: Floats) -> Bools:
    """Whether the feet of points on the lines through pieces lie on these."""
    d = pieces[:, 1] - pieces[:, 0]
    along = ((x - pieces[:, 0]) * d).sum(axis=1) / (d * d).sum(axis=1)
    return np.asarray((along >= 0.0) & (along <= 1.0))


def check_side(system: NumberedModel, pair: Pair, x: Floats) -> None:
    """Refuse a slave surface whose body starts on the wrong side of a rigid curve.

    The body may have its surface on the curve, or reach through it by less than half. Positions and
    rotations `x` at the start have the shape (n_nodes, 3).

    Raises
    ------
    ModelError
        Naming the pair, the curve and the nearest node.
    """
    curve = getattr(pair.item, "master", None)
    if not isinstance(curve, RigidCurve) or not curve.turns:  # no curve, or a gap element
        return
    mesh, slave, size = system.model.mesh, pair.slave, SAME * float(pair.slave.length.max())
    pieces = other_side(pair, x, x)[0]
    if slave.pointwise:
        # Lines and single nodes have no outer side of their own.
        nodes, least = slave.node_list, size
        distance, _, beside = signed_distances(pieces, x[nodes, :2], size)
    else:
        nodes, least = slave.nodes[:, 0], 0.0
        ends = x[slave.nodes[:, :2], :2]
        distance, best, beside = signed_distances(pieces, ends.mean(axis=1), size)
        turned = (outward(ends) * outward(pieces)[best]).sum(axis=1)
        beside &= np.abs(turned) >= STRAIGHT
    nearest = int(np.argmin(np.where(beside, np.abs(distance), np.inf)))
    # An edge that faces away is behind, or in front with its back to the curve.
    away = distance[nearest] <= size if slave.pointwise else turned[nearest] >= STRAIGHT
    if not beside[nearest] or not away:
        return
    part = part_of_nodes(mesh)
    if slave.pointwise:
        # Springs end where they will, on either side, and a node with springs alone has no side.
        springs = np.zeros(mesh.n_cells, bool)
        for block in system.blocks:
            springs[block.cells] = block.section.element.startswith("SPRING")
        if not np.isin(nodes, nodes_of_cells(mesh, np.flatnonzero(~springs))).any():
            return
        part = parts_without(mesh, springs)
    body, _, inside = signed_distances(pieces, x[np.isin(part, part[slave.node_list]), :2], size)
    # What lies on the curve as a whole tells no side.
    if not inside.any() or body[inside].max() >= -body[inside].min() - least:
        return
    depth = -float(distance[nearest])
    place = f"{abs(depth):.4g} {'behind' if depth > 0 else 'through'} it"
    name = f" {curve.name!r}" if curve.name else ""
    raise ModelError(
        f"contact pair {pair.item.name!r}: the slave surface starts on the wrong side of "
        f"the rigid curve{name}: node {mesh.node_labels[nodes[nearest]]} is nearest, "
        f"{'on it' if abs(depth) <= size else place}. "
        "The deformable body belongs on the left of the curve's direction of travel; give its "
        "points in the other order (corota plot draws the rigid body shaded)",
        pair.item.where,
    )


def alone(points: Floats, same: float) -> Bools:
    """Which points have no other one of the list in their place."""
    places = np.round(points / same)
    _, which, count = np.unique(places, axis=0, return_inverse=True, return_counts=True)
    return np.asarray(count[which.ravel()] == 1)


def signed_distances(pieces: Floats, points: Floats, same: float) -> tuple[Floats, Ints, Bools]:
    """Signed distance to the nearest piece, positive to its right, and which piece this is.

    The last part of the result is whether the nearest point lies on the curve, not at a free end.
    """
    start, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    square, normals = (along**2).sum(axis=1), outward(pieces)
    first, last = np.split(alone(np.concatenate([pieces[:, 0], pieces[:, 1]]), same), 2)
    distance, best = np.empty(len(points)), np.empty(len(points), np.int64)
    share = np.empty(len(points))
    count = max(1, AT_ONCE // len(pieces))
    for own in (slice(begin, begin + count) for begin in range(0, len(points), count)):
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
    return distance, best, ~beyond


def passed_through(model: Model, u: Floats) -> list[str]:
    """Notes on parts of bodies in no pair that lie behind a rigid curve or in another body.

    `u` has the displacements and rotations of all nodes at the end, shape (n_nodes, 3).
    """
    mesh, part, notes = model.mesh, part_of_nodes(model.mesh), []
    points, x = mesh.points, mesh.points + u[:, :2]

    def note(pair: ContactPair, nodes: Ints, depth: Floats, least: float, where: str) -> None:
        deepest = int(np.argmax(depth))
        if depth[deepest] > least:
            notes.append(
                f"contact pair {pair.name!r}: nodes that are in no pair {where} "
                f"({int((depth > least).sum())} of them), "
                f"node {mesh.node_labels[nodes[deepest]]} by {depth[deepest]:.3g}: "
                "they passed through. Give the surfaces of the pair all edges that may meet"
            )

    def entered(before: Floats, after: Floats, first: Floats, last: Floats) -> Floats:
        """Depth of points behind pieces at the end, of those that were before them [length]."""
        same = SAME * float(np.ptp(points))
        start, _, beside = signed_distances(first, before, same)
        end, _, inside = signed_distances(last, after, same)
        return np.where(inside & ~(beside & (start < -same)), np.maximum(-end, 0.0), 0.0)

    rims = [nodes[:2] for nodes in mesh.edge_nodes(mesh.boundary_edges())]
    edges = np.array(rims, np.int64).reshape(-1, 2)
    surfaces = [s for pair in model.contacts for s in (pair.slave, pair.master)]
    bodies = [_surface_nodes(model, s) for s in surfaces if not isinstance(s, RigidCurve)]
    free = np.setdiff1d(edges, np.concatenate(bodies))
    for pair in model.contacts:
        if isinstance(pair.master, RigidCurve):
            continue
        sides = [np.unique(part[_surface_nodes(model, s)]) for s in (pair.slave, pair.master)]
        for own, other in (sides, sides[::-1]):
            nodes = free[np.isin(part[free], np.setdiff1d(own, other))]
            rim = edges[np.isin(part[edges[:, 0]], np.setdiff1d(other, own))]
            if len(rim) and len(nodes):
                depth = entered(points[nodes], x[nodes], points[rim], x[rim])
                length = np.hypot(*(x[rim[:, 1]] - x[rim[:, 0]]).T)
                least = NAMED * float(length.mean())
                note(pair, nodes, depth, least, "lie in the other body")
    for curve in rigid_curves(model):
        pairs = [pair for pair in model.contacts if pair.master is curve]
        slaves = np.concatenate([_surface_nodes(model, pair.slave) for pair in pairs])
        chosen = np.isin(part, part[slaves]) & (part >= 0)
        chosen[slaves] = False
        nodes = np.flatnonzero(chosen)
        if not len(nodes):
            continue
        # Seen from a curve that moved with its reference node.
        before, after, node = points[nodes], x[nodes], curve.reference
        if isinstance(node, int | np.integer):
            after = _turned(after, -curve.turns * u[node, 2], x[node], points[node])
        pieces = _chords(curve)
        depth = entered(before, after, pieces, pieces)
        depth[depth > np.linalg.norm(after - before, axis=1)] = 0.0  # it came there around an end
        # What may lie deeper than the slave surface beside it [mean distance of slave nodes].
        least = NAMED * float(np.ptp(points[slaves], axis=0).max()) / len(slaves)
        note(pairs[0], nodes, depth, least, "with this rigid curve lie behind it")
    return notes


def _surface_nodes(model: Model, surface: str | Ints) -> Ints:
    edges, single = edges_or_nodes(model.mesh, surface)
    return single if len(single) else model.mesh.edge_set_nodes(edges)
