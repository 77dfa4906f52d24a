"""Nodes that passed through the opposite surface within one increment.

The core searches no farther than its reach, and a penetration deeper than the body is no contact. A
node that moved farther may be behind the opposite surface without contact; such an increment is
refused.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.terms.contact.pair import CLOSED, COVERED, OPEN, SLIPPING
from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.terms.contact.pair import Pair, Terms

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Fraction of the reach that a node may move without this check.
UNSEEN = 0.5
#: Nodes times pieces that are compared at once.
AT_ONCE = 1_000_000
#: Angle of the chords of arcs [rad].
CHORD = math.radians(4.0)


def passed(
    pair: Pair,
    old: Floats,
    new: Floats,
    state: NDArray[np.int8],
    terms: Terms,
    starts: Callable[[], Floats] | None,
) -> Ints:
    """Constraints whose node crossed the other side from outside to inside and is open.

    Parameters
    ----------
    pair : Pair
    old, new : ndarray, shape (n_nodes, 3)
        Positions at both ends of the increment.
    state : ndarray of int, shape (n,)
        States at the end.
    terms : Terms
        Gaps at the end.
    starts : callable or None
        See :func:`outside`; None: on the other side itself.
    """
    if pair.tied:
        return np.zeros(0, np.int64)
    move = new[:, :2] - old[:, :2]
    first, last, ends = other_side(pair, old, new)
    if not len(first):
        return np.zeros(0, np.int64)
    drift = (last - first).reshape(-1, 2)
    mean = drift.mean(axis=0)
    spread = np.hypot(*(drift - mean).T).max()
    nodes = pair.nodes
    moved = np.hypot(*(move[nodes] - mean).T) + spread
    unseen = terms.area <= COVERED * pair.full
    far = (moved > UNSEEN * pair.reach) | (unseen & (moved > pair.depth))
    if not far.any():
        return np.zeros(0, np.int64)
    closed = np.isin(nodes, nodes[(state == CLOSED) | (state == SLIPPING)])
    chosen = np.flatnonzero(far & ~closed)
    start = np.zeros(pair.n) if starts is None else starts()
    near = old[nodes[chosen]], new[nodes[chosen]]
    chosen = chosen[_behind_any(first, last, *near, start[chosen])]
    hit = [
        k
        for k in chosen
        if time_of_crossing(first, last, ends, old, new, int(nodes[k]), start[k]) < math.inf
    ]
    return np.array(hit, np.int64)


def outside(term: Any, k: int, moves: bool) -> Floats:
    """Distance from the other side from which each node of pair `k` starts outside, shape (n,).

    An open node may touch. In motion (`moves`) it may be behind, where a scheme closes gaps after
    the impact. A closed one may leave its surface around a corner.
    """
    pair, committed = term.pairs[k], None if term.at is None else term.at.states
    start = np.full(pair.n, -pair.noise)
    if moves and math.isfinite(pair.depth):
        start[pair.gaps_at(term, k, term.positions(term.u)).gap < 0.0] = -pair.depth
    if committed:
        start[committed[k] != OPEN] = 0.0
    return start


def _behind_any(
    first: Floats, last: Floats, old: Floats, new: Floats, start: Floats
) -> NDArray[np.bool_]:
    """Nodes that change from the outer to the inner side of the line through any piece.

    The outer side begins at a distance for each.
    """
    out = np.zeros(len(old), bool)
    step = max(1, AT_ONCE // len(first))
    for at in range(0, len(old), step):
        part = slice(at, at + step)
        before, after = (
            _side(pieces[None], x[part, None, :2]) for pieces, x in ((first, old), (last, new))
        )
        out[part] = ((before > start[part, None]) & (after < 0.0)).any(axis=1)
    return out


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
        pieces = _chords(master)
        nodes = np.full((len(pieces), 2), -1, np.int64)
        reference = master.reference
        if reference is None or isinstance(reference, tuple):
            return pieces, pieces, nodes
        at = pair.reference[int(reference)]
        return (
            _carried(pieces, at, old[int(reference)]),
            _carried(pieces, at, new[int(reference)]),
            nodes,
        )
    other = pair.slave if pair.master is None else pair.master
    nodes = other.nodes[:, :2]
    return old[nodes][:, :, :2], new[nodes][:, :, :2], nodes


def _chords(curve: RigidCurve) -> Floats:
    """A curve as straight pieces, the rigid body on their left, shape (m, 2, 2)."""
    out = []
    for x0, y0, x1, y1, cx, cy, sweep in curve.backward.tolist():
        if sweep == 0.0:
            out.append([[x0, y0], [x1, y1]])
            continue
        radius, start = math.hypot(x0 - cx, y0 - cy), math.atan2(y0 - cy, x0 - cx)
        angle = start + np.linspace(0.0, sweep, 1 + math.ceil(abs(sweep) / CHORD))
        points = np.column_stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle)])
        out += np.stack([points[:-1], points[1:]], axis=1).tolist()
    return np.array(out)


def _carried(pieces: Floats, reference: Floats, at: Floats) -> Floats:
    """Pieces moved with their reference node."""
    c, s = math.cos(at[2]), math.sin(at[2])
    turned = (pieces - reference[:2]) @ np.array([[c, s], [-s, c]])
    return np.asarray(turned + at[:2])


def time_of_crossing(
    first: Floats,
    last: Floats,
    ends: Ints,
    old: Floats,
    new: Floats,
    node: int,
    start: float = 0.0,
) -> float:
    """Share of the way after which a node goes through a piece from outside; inf if it does not.

    All move evenly. The outer side begins at the distance `start`.
    """
    own = (ends == node).any(axis=1)
    before, after = first[~own], last[~own]
    a, b = _side(before, old[node, :2]), _side(after, new[node, :2])
    through = (a > start) & (b < 0.0)
    if not through.any():
        return math.inf
    share = np.maximum(a[through], 0.0) / (np.maximum(a[through], 0.0) - b[through])
    t = share[:, None]
    p = before[through] + t[:, :, None] * (after[through] - before[through])
    x = old[node, :2] + t * (new[node, :2] - old[node, :2])
    d = p[:, 1] - p[:, 0]
    along = ((x - p[:, 0]) * d).sum(axis=1) / (d * d).sum(axis=1)
    return float(np.min(share[(along >= 0.0) & (along <= 1.0)], initial=math.inf))


__all__ = ["UNSEEN", "other_side", "outside", "passed", "time_of_crossing"]
