"""Where Newton's method starts in an increment of a motion, and the rigid part of a motion.

The start for an unconstrained body is its rigid motion: its iterations are then the same whether it
rests or flies. Other bodies start from where they are.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Floats, distinct, skew
from corota.mesh.parts import part_of_nodes

if TYPE_CHECKING:
    from corota.analysis.equations import System


#: A body that turns by more in an increment starts from where it is [rad].
LARGEST_TURN = 1.0


class FreeFlight:
    """Bodies without supports and constraints."""

    def __init__(self, system: System) -> None:
        self.system = system
        part = part_of_nodes(system.model.mesh)
        held = system.conditions.constrained.copy()
        link = system.constraints.link(np.zeros(system.n_dofs))
        if link.couples:
            bound = system.constraints.dependent
            held[bound] = True
            held[distinct(link.direct.tocoo().col)] = True
        nodes = np.zeros(len(part), bool)
        nodes[system.node_of_dof[held]] = True
        nodes |= system.nodes_of_terms("tied")
        bound_parts = np.zeros(part.max(initial=-1) + 2, bool)
        bound_parts[part[nodes]] = True
        bound_parts[-1] = True  # nodes without elements
        #: Nodes of free bodies, and the number of the body of each.
        self.nodes = np.flatnonzero(~bound_parts[part])
        bodies = part[self.nodes]
        self.body = np.searchsorted(distinct(bodies), bodies)
        self.count = np.bincount(self.body).astype(float)

    def guess(self, u: Floats, v: Floats, dt: float) -> Floats:
        """Displacement after a time, with rigid motion of free bodies, shape (n_dofs,)."""
        if not len(self.nodes):
            return u
        system, body = self.system, self.body
        moved, rates = system.by_node(u), system.by_node(v)
        x = system.model.mesh.points[self.nodes].copy()
        if system.nlgeom:
            x += moved[self.nodes, :2]
        rate = rates[self.nodes, :2]

        def mean(values: Floats) -> Floats:
            out = np.empty((len(self.count), 2))
            for i in (0, 1):
                out[:, i] = np.bincount(body, values[:, i]) / self.count
            return out

        travel = mean(rate)
        arm = x - mean(x)[body]
        inertia = np.bincount(body, (arm**2).sum(axis=1))
        lever = np.empty(arm.shape)
        lever[:, 0], lever[:, 1] = -arm[:, 1], arm[:, 0]
        spin = np.bincount(body, (lever * rate).sum(axis=1)) / np.where(inertia > 0, inertia, 1.0)
        turn = spin * dt
        goes = np.abs(turn) <= LARGEST_TURN
        turn, travel = np.where(goes, turn, 0.0), np.where(goes[:, None], travel, 0.0)
        angle = turn[body][:, None]
        if system.nlgeom:
            change = np.sin(angle) * lever - 2.0 * np.sin(0.5 * angle) ** 2 * arm
        else:
            change = angle * lever
        flown = np.zeros_like(moved)
        flown[self.nodes, :2] = dt * travel[body] + change
        flown[self.nodes, 2] = turn[body]
        return u + system.from_nodes(flown)


def rigid_rates(x: Floats, rates: Floats) -> Floats:
    """Rigid velocity field that is nearest to given rates at points, shapes (n, 2)."""
    arm = x - x.mean(axis=0)
    mean = rates.mean(axis=0)
    inertia = float((arm * arm).sum())
    lever = skew(arm)
    spin = float((lever * rates).sum()) / inertia if inertia > 0.0 else 0.0
    out: Floats = mean + spin * lever
    return out


def deformation(reference: Floats, x: Floats, finite: bool = True) -> Floats:
    """Displacements less the nearest rigid motion, finite or infinitesimal, shape (n, 2)."""
    if not finite:
        return x - reference - rigid_rates(reference, x - reference)
    before, now = reference - reference.mean(axis=0), x - x.mean(axis=0)
    along, across = float((before * now).sum()), float((skew(before) * now).sum())
    size = np.hypot(along, across) or 1.0
    out: Floats = now - (along * before + across * skew(before)) / size
    return out
