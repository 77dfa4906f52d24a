"""First iterate of an increment in which supports turn bodies far.

A correction of Newton's method is linear in the rotation: of a body that its supports carry round
by a quarter turn it would make another shape. Bodies therefore start turned as their supports turn
them, all of them where the motion of the first one carries them; how they move relative to it is
left to the corrections. So an increment with a superposed rotation is that without it, seen from
a frame that turns. Where no equilibrium is found from there, the committed state is tried.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.mesh.parts import part_of_nodes

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.arrays import Bools, Floats, Ints


#: Rotation in an increment [rad] from which bodies are carried, and displacement over the size of
#: the model from which one looks.
FAR, FAR_AWAY = 0.2, 0.1
#: What a rigid motion of a body may leave of that of its supports: over the size of the body, and
#: over their motion by the rotation, where that alone says how far the body turns.
DEFORMS = 0.2


def carried_bodies(system: System, u: Floats, prescribed: Floats) -> Floats | None:
    """Displacements with bodies turned by their supports; None where none turns far.

    Bodies without a support that says how they turn take the motion of the first that has one, if
    the supports that they have go along: a lever on a pin does not turn with the drum it brakes.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
        At the beginning of the increment.
    prescribed : ndarray, shape (n_dofs,)
        Target of the prescribed dofs at its end, `u` elsewhere.
    """
    points = system.model.mesh.points
    nodes = np.arange(len(points))
    dofs = np.column_stack([system.dofs(nodes, dof) for dof in range(3)])
    given = (dofs >= 0) & system.conditions.supports.constrained[dofs]
    change = np.where(given, (prescribed - u)[dofs], 0.0)
    size = float(np.ptp(points, axis=0).max())
    moves = np.abs(change[:, 2]).max() > FAR or np.abs(change[:, :2]).max() > FAR_AWAY * size
    if not moves or len(system.constraints.axes):
        return None
    x = points + np.where(dofs[:, :2] >= 0, u[dofs[:, :2]], 0.0)
    y = x + change[:, :2]
    body = _bodies(system)
    members = [np.flatnonzero(body == b) for b in range(body.max() + 1)]
    motions = [_motion(x[m], y[m], change[m, 2], given[m]) for m in members]
    known = [motion for motion in motions if motion is not None]
    # Elastic bodies are numbered before reference nodes, which may turn against each other: which
    # of them carries a body that all of them touch is not known then.
    whole = known[0] if known else None
    elastic = [len(mine) > 1 for mine in members]
    supported = any(m is not None and e for m, e in zip(motions, elastic, strict=True))
    agree = all(abs(m[0] - known[0][0]) <= FAR for m in known)
    if whole is None or not (supported or agree):
        return None
    turns = [abs((m or whole)[0]) > FAR for m in motions]
    if not any(e and t for e, t in zip(elastic, turns, strict=True)):
        return None
    angle, center, to = whole
    common = to + _turned(x - center, angle)
    for mine, motion in zip(members, motions, strict=True):
        pinned = mine[given[mine, :2].any(axis=1)] if motion is None else mine[:0]
        off = np.where(given[pinned, :2], common[pinned] - y[pinned], 0.0)
        extent = float(np.ptp(x[mine], axis=0).max())
        if np.abs(off).max(initial=0.0) > DEFORMS * extent + 1e-9 * size:
            return None  # its supports do not let the body take part
    out: Floats = u.copy()
    for mine, motion in zip(members, motions, strict=True):
        # What has no elements takes part in the common motion, and moves relative to it later.
        own, middle = (angle, center) if motion is None or len(mine) == 1 else motion[:2]
        place = to + _turned(middle - center, angle) + _turned(x[mine] - middle, own)
        for dof, values in enumerate((*(place - x[mine]).T, np.full(len(mine), own))):
            at = dofs[mine, dof]
            out[at[at >= 0]] += values[at >= 0]
    system.constraints.complete(out)
    return out


def _bodies(system: System) -> Ints:
    """Number of the body of each node: parts of the mesh, and what constraints join."""
    body = part_of_nodes(system.model.mesh)
    single = body < 0
    body[single] = body.max(initial=-1) + 1 + np.arange(int(single.sum()))
    for relation in system.constraints.relations:
        joined = np.concatenate([relation.dependent, relation.masters])
        numbers = np.unique(body[system.node_of_dof[joined]])
        if len(numbers) > 1:
            body[np.isin(body, numbers)] = numbers[0]
    return np.unique(body, return_inverse=True)[1].astype(np.int64)


def _motion(
    x: Floats, y: Floats, turn: Floats, given: Bools
) -> tuple[float, Floats, Floats] | None:
    """Rotation and centers of the rigid motion that supports prescribe, if they prescribe one."""
    placed = given[:, 0] & given[:, 1]
    if not placed.any():
        return None
    center, to = x[placed].mean(axis=0), y[placed].mean(axis=0)
    before, after = x[placed] - center, y[placed] - to
    extent = float(np.abs(before).max())
    if given[:, 2].any():
        angle = float(turn[given[:, 2]].mean())
        if np.abs(turn[given[:, 2]] - angle).max() > DEFORMS * abs(angle):
            return None
    elif extent > 0.0:
        along = float((before * after).sum())
        across = float((before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]).sum())
        angle = float(np.arctan2(across, along))
    else:
        return None
    left = float(np.abs(after - _turned(before, angle)).max())
    most = float(np.ptp(x, axis=0).max())
    if not given[:, 2].any():
        most = min(most, abs(angle) * extent)
    if left > DEFORMS * most + 1e-9 * extent:
        return None
    return angle, center, to


def _turned(arm: Floats, angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    out: Floats = arm @ np.array([[c, s], [-s, c]])
    return out
