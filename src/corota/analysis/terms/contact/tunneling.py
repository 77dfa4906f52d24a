"""Nodes that passed through the opposite surface within one increment.

The core searches no farther than its reach. A node that moved farther may be behind the opposite
surface without contact; such an increment is refused.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.pair import CLOSED, SLIPPING
from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.terms.contact.pair import Pair

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Fraction of the reach that a node may move without this check.
UNSEEN = 0.5
#: Angle of the chords of arcs [rad].
CHORD = math.radians(4.0)


def passed(pair: Pair, old: Floats, new: Floats, state: NDArray[np.int8]) -> Ints:
    """Constraints whose node crossed the other side from outside to inside and is open.

    Parameters
    ----------
    pair : Pair
    old, new : ndarray, shape (n_nodes, 3)
        Positions at both ends of the increment.
    state : ndarray of int, shape (n,)
        States at the end.
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
    eliminated = np.hypot(*(move[nodes] - mean).T) + spread > UNSEEN * pair.reach
    closed = np.isin(nodes, nodes[(state == CLOSED) | (state == SLIPPING)])
    chosen = np.flatnonzero(eliminated & ~closed)
    hit = [
        k for k in chosen if time_of_crossing(first, last, ends, old, new, int(nodes[k])) < math.inf
    ]
    return np.array(hit, np.int64)


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
    first: Floats, last: Floats, ends: Ints, old: Floats, new: Floats, node: int
) -> float:
    """Share of the way after which a node goes through a piece from outside; inf if it does not.

    All move evenly.
    """
    own = (ends == node).any(axis=1)
    before, after = first[~own], last[~own]

    def side(piece: Floats, x: Floats) -> Floats:
        d, r = piece[:, 1] - piece[:, 0], x[:2] - piece[:, 0]
        # The body lies to the left: outside is positive.
        return np.asarray(d[:, 1] * r[:, 0] - d[:, 0] * r[:, 1])

    a, b = side(before, old[node]), side(after, new[node])
    through = (a > 0.0) & (b < 0.0)
    if not through.any():
        return math.inf
    share = a[through] / (a[through] - b[through])
    t = share[:, None]
    p = before[through] + t[:, :, None] * (after[through] - before[through])
    x = old[node, :2] + t * (new[node, :2] - old[node, :2])
    d = p[:, 1] - p[:, 0]
    along = ((x - p[:, 0]) * d).sum(axis=1) / (d * d).sum(axis=1)
    return float(np.min(share[(along >= 0.0) & (along <= 1.0)], initial=math.inf))


__all__ = ["UNSEEN", "other_side", "passed", "time_of_crossing"]
