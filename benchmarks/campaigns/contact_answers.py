"""What a run in contact found, in numbers that two builds can be compared by.

Forces and momenta come from the frames. How deep one side lies behind the other is computed here,
from positions and the geometry of the problem alone, for all pairs of two surfaces: nodes of the
slave behind the curve or surface of the master, and points of that behind the edges of the slave.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from benchmarks.corpora.contact_problems import RIGID_ON_LEFT, reversed_segments

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from benchmarks.corpora.contact_problems import Problem

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Angle of the chords of arcs [rad].
CHORD = math.radians(2.0)
#: Force over the largest one of the run below which a pair has none.
NO_FORCE = 1e-9
#: Relative difference of displacements and forces of static runs that find the same ...
SAME = 0.01
#: ... and difference of momenta over the first one in dynamics, where increments differ.
SAME_MOMENTUM = 0.05
#: Ratio of the largest depths from which bodies overlap more in one run than in the other.
DEEPER = 1.5
#: Depth in slave edges that is none.
ROUNDING = 1e-6


def answer(given: Problem, results: ct.Results) -> dict[str, float | list[float]]:
    """Forces over the run and at its end, momenta, and depths.

    Returns
    -------
    dict of str to float
        ``largest force`` of a pair over the run, ``end force`` of each pair (x, y),
        ``momentum`` of dynamic runs at their end (x, y) over its first size, ``deepest`` the
        largest depth of a point of one side behind the other over the run, and ``deepest without
        force`` that in increments in which its pair has none, both in slave edges.
    """
    frames, names = results.frames[1:], [pair.name for pair in given.model.contacts]
    force = np.array(
        [[[f.scalars.get(f"{n}: force {a}", 0.0) for a in "xy"] for n in names] for f in frames]
    )
    size = np.hypot(force[..., 0], force[..., 1])
    out: dict[str, Any] = {
        "largest force": float(size.max(initial=0.0)),
        "end force": force[-1].tolist(),
    }
    if not given.static:
        path = np.array([[f.scalars[f"momentum {a}"] for a in "xy"] for f in frames])
        out["momentum"] = (path[-1] / max(float(np.hypot(*path[0])), 1e-300)).tolist()
    deepest = np.zeros(force.shape[:2])
    for k, pair in enumerate(given.model.contacts):
        for i, frame in enumerate(frames):
            deepest[i, k] = _depth(given.model, pair, frame)
    silent = size <= NO_FORCE * max(out["largest force"], 1e-300)
    out["deepest"] = float(deepest.max(initial=0.0))
    out["deepest without force"] = float(deepest[silent].max(initial=0.0))
    return out


def same(old: dict[str, Any], new: dict[str, Any]) -> bool:
    """Whether two finished runs of a problem found the same.

    Statics: the largest displacement, the largest force of a pair and the force at the end.
    Dynamics: the momentum at the end, and the largest displacement.
    """
    far = max(old["moved"], new["moved"])
    apart, (before, after) = abs(old["moved"] - new["moved"]), (old["answer"], new["answer"])
    if "momentum" in after:
        change = np.subtract(before["momentum"], after["momentum"])
        return bool(apart <= SAME_MOMENTUM * far and np.hypot(*change) <= SAME_MOMENTUM)
    top = max(before["largest force"], after["largest force"])
    change = np.subtract(before["end force"], after["end force"])
    return bool(
        apart <= SAME * far
        and abs(before["largest force"] - after["largest force"]) <= SAME * top
        and np.abs(change).max() <= SAME * top
    )


def deeper(row: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether bodies overlap more in a run than in another one of the same problem."""
    return bool(row["answer"]["deepest"] > DEEPER * other["answer"]["deepest"] + ROUNDING)


def _depth(model: ct.Model, pair: Any, frame: Any) -> float:
    """Largest depth of a node or a point of the curve behind the other side, in slave edges."""
    if isinstance(pair.master, str) and pair.master == pair.slave:
        return 0.0  # neighbors on one surface are behind each other
    x = model.mesh.points + frame.U[:, :2]
    slave = _lines(model, pair.slave)
    first = model.mesh.points[slave]
    edge = 2.0 if len(slave) > len(_edges(model, pair.slave)) else 1.0
    edge *= float(np.hypot(*(first[:, 1] - first[:, 0]).T).mean())
    if isinstance(pair.master, ct.RigidCurve):
        pieces = _chords(pair.master)
        node = pair.master.reference
        if isinstance(node, int | np.integer):
            u, at = frame.U[node], model.mesh.points[node]
            c, s = math.cos(frame.UR[node]), math.sin(frame.UR[node])
            pieces = (pieces - at) @ np.array([[c, s], [-s, c]]) + at + u[:2]
    else:
        pieces = x[_lines(model, pair.master)]
    nodes, points = x[np.unique(slave)], pieces.reshape(-1, 2)
    return max(_behind(pieces, nodes), _behind(x[slave], points)) / edge


def _edges(model: ct.Model, edges: Any) -> Any:
    """Cells and sides of a set of edges."""
    return model.mesh.edge_sets[edges] if isinstance(edges, str) else edges


def _lines(model: ct.Model, edges: Any) -> Ints:
    """Ends of straight lines from node to node along edges, the body on their left, (n, 2)."""
    out = []
    for nodes in model.mesh.edge_nodes(_edges(model, edges)):
        along = [nodes[0], *nodes[2:], nodes[1]]
        out += list(zip(along, along[1:], strict=False))
    return np.array(out, np.int64)


def _chords(curve: ct.RigidCurve) -> Floats:
    """A curve as straight pieces with the rigid body on their left, shape (m, 2, 2)."""
    out, segments = [], curve.segments
    if not RIGID_ON_LEFT:
        segments = reversed_segments(segments)
    for x0, y0, x1, y1, cx, cy, sweep in segments.tolist():
        if sweep == 0.0:
            out.append([[x0, y0], [x1, y1]])
            continue
        radius, start = math.hypot(x0 - cx, y0 - cy), math.atan2(y0 - cy, x0 - cx)
        angle = start + np.linspace(0.0, sweep, 1 + math.ceil(abs(sweep) / CHORD))
        points = np.column_stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle)])
        out += np.stack([points[:-1], points[1:]], axis=1).tolist()
    return np.array(out)


def _behind(pieces: Floats, points: Floats) -> float:
    """Largest distance of points behind pieces that have a body on their left [length].

    The nearest piece decides; beside the free end of a chain nothing is behind.
    """
    start, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    square = (along**2).sum(axis=1)
    keep = square > 0.0
    start, along, square = start[keep], along[keep], square[keep]
    scale = float(np.sqrt(square.max()))
    joints = np.concatenate([start, start + along])
    apart = np.hypot(*(joints[:, None] - joints[None]).transpose(2, 0, 1))
    free = (apart <= 1e-9 * scale).sum(axis=1) == 1
    first, last = free[: len(start)], free[len(start) :]
    away = points[:, None] - start
    share = (away * along).sum(axis=2) / square
    foot = np.clip(share, 0.0, 1.0)
    size = np.hypot(*(away - foot[..., None] * along).transpose(2, 0, 1))
    left = (along[:, 0] * away[..., 1] - along[:, 1] * away[..., 0]) / np.sqrt(square)
    beside = ((share < 0.0) & first) | ((share > 1.0) & last)
    # At a corner the piece that sees the point from farther off decides, as for a wedge.
    near = size <= size.min(axis=1, keepdims=True) + 1e-9 * scale
    best = np.where(near, np.abs(left), -1.0).argmax(axis=1)
    rows = np.arange(len(points))
    behind = (left[rows, best] > 0.0) & ~beside[rows, best]
    return float(np.where(behind, size[rows, best], 0.0).max(initial=0.0))


__all__ = ["DEEPER", "answer", "deeper", "same"]
