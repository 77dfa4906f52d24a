"""Nodes that passed through the opposite surface within one increment.

The core searches no farther than its reach, and a penetration deeper than the body is no contact. A
node that moved farther may be behind the opposite surface without contact, and one that moved
across a body may be outside again on its other side; such an increment is refused.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.terms.contact.gaps import CLOSED, OPEN, SAME, SLIPPING, covered
from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from corota.analysis.terms.contact.pair import Pair, Terms

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Search radius: fraction of the reach, and of the width of a body, that a node may move without
#: this check; in relaxation, fraction of the shortest slave edge from a position to the next.
UNSEEN = 0.5
#: Complementarity tolerance: depth over the reach up to which a node touches: a rest of Newton's
#: method, as where a node of the other side carries both.
TOUCHES = 1e-8
#: Angle up to which an arc counts as straight: the way of a side that turns in an increment, and a
#: piece of a rigid curve [rad].
STRAIGHT = 0.1
#: Nodes times pieces that are compared at once (memory alone).
AT_ONCE = 1_000_000


def passed(
    pair: Pair,
    old: Floats,
    new: Floats,
    states: Callable[[], NDArray[np.int8]],
    terms: Terms,
    starts: Callable[[], Floats],
) -> Ints:
    """Constraints whose node crossed the other side from outside to inside and is open.

    Parameters
    ----------
    pair : Pair
    old, new : ndarray, shape (n_nodes, 3)
        Positions at both ends of the increment.
    states : callable
        Finds the states at the end, shape (n,).
    terms : Terms
        Gaps at the end.
    starts : callable
        See :func:`outside`.
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
    common = abs(_turn_between(*turns)) <= STRAIGHT < abs(turns[0])
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
            first, end, ends, old, seen, nodes[through], start, TOUCHES * pair.reach
        )
        through = through[share < math.inf]
    return through


def _turn(old: Floats, new: Floats) -> float:
    """Angle by which points turn about their center in the mean [rad]."""
    before, after = old - old.mean(axis=0), new - new.mean(axis=0)
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return math.atan2(float(across.sum()), float((before * after).sum()))


def _turn_between(one: float, other: float) -> float:
    """Difference of two angles, up to half a turn [rad]."""
    return math.remainder(one - other, math.tau)


def outside(term: Any, k: int, moves: bool) -> Floats:
    """Distance from the other side from which each node of pair `k` starts outside, shape (n,).

    A node may touch. In motion (`moves`) an open one may be behind, where a scheme closes gaps
    after the impact.
    """
    pair, committed = term.pairs[k], None if term.at is None else term.at.states
    start = np.full(pair.n, -TOUCHES * pair.reach)
    if moves and math.isfinite(pair.depth):
        behind = pair.gaps_at(term, k, term.positions(term.u)).gap < 0.0
        if committed:
            behind &= committed[k] == OPEN
        start[behind] = -pair.depth
    return start


def _width(pieces: Floats) -> float:
    """Least extent of a body that pieces go round; infinite where they end or go round a hole."""
    (x, y), size = pieces.reshape(-1, 2).T, np.ptp(pieces.reshape(-1, 2), axis=0)
    starts, stops = (np.round(pieces[:, end] / (SAME * size.max())) for end in (0, 1))
    closed = np.array_equal(np.unique(starts, axis=0), np.unique(stops, axis=0))
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
        reference = master.reference
        if reference is None or isinstance(reference, tuple):
            return pieces, pieces, nodes
        at = pair.reference[int(reference)]
        follows = np.array([1.0, 1.0, float(master.turns)])
        return (
            _carried(pieces, at, follows * old[int(reference)]),
            _carried(pieces, at, follows * new[int(reference)]),
            nodes,
        )
    other = pair.slave if pair.master is None else pair.master
    nodes = other.nodes[:, :2]
    if other.two_sided:
        nodes = np.concatenate([nodes, nodes[:, ::-1]])
    return old[nodes][:, :, :2], new[nodes][:, :, :2], nodes


def _chords(curve: RigidCurve) -> Floats:
    """A curve as straight pieces, the rigid body on their left, shape (m, 2, 2)."""
    out = []
    for x0, y0, x1, y1, cx, cy, sweep in curve.backward.tolist():
        if sweep == 0.0:
            out.append([[x0, y0], [x1, y1]])
            continue
        radius, start = math.hypot(x0 - cx, y0 - cy), math.atan2(y0 - cy, x0 - cx)
        angle = start + np.linspace(0.0, sweep, 1 + math.ceil(abs(sweep) / STRAIGHT))
        points = np.column_stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle)])
        out += np.stack([points[:-1], points[1:]], axis=1).tolist()
    return np.array(out)


def _carried(pieces: Floats, reference: Floats, at: Floats) -> Floats:
    """Pieces moved with their reference node."""
    c, s = math.cos(at[2]), math.sin(at[2])
    turned = (pieces - reference[:2]) @ np.array([[c, s], [-s, c]])
    return np.asarray(turned + at[:2])


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
        Positions at both ends of the increment.
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


def _beside(pieces: Floats, x: Floats) -> NDArray[np.bool_]:
    """Whether the feet of points on the lines through pieces lie on these."""
    d = pieces[:, 1] - pieces[:, 0]
    along = ((x - pieces[:, 0]) * d).sum(axis=1) / (d * d).sum(axis=1)
    return np.asarray((along >= 0.0) & (along <= 1.0))


__all__ = ["UNSEEN", "other_side", "outside", "passed", "times_of_crossing"]
