"""Relations between degrees of freedom: values, derivatives and second derivatives.

Every relation gives some dofs, the dependent ones, as functions of others, its masters. Both
are numbered as in the system; displacements are along the axes of the nodes.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import skew

if TYPE_CHECKING:
    from corota.arrays import Bools, Floats, Ints
    from corota.errors import Location


@dataclass
class Relation(ABC):
    """Interface of all relations.

    Parameters
    ----------
    dependent : ndarray of int, shape (d,)
    masters : ndarray of int, shape (m,)
    what : str
        The relation in a message.
    """

    dependent: Ints
    masters: Ints
    what: str
    where: Location | None

    #: Dof to support in place of a dependent dof.
    instead = "another term of the equation"
    #: Whether the dependents are linear in the masters.
    linear = True
    #: Whether rotations are finite.
    nlgeom = True

    @abstractmethod
    def values(self, u: Floats) -> Floats:
        """Dependents at `u`, shape (d,)."""

    @abstractmethod
    def jacobian(self, u: Floats) -> Floats:
        """Derivative of the dependents by the masters at `u`, shape (d, m)."""

    def near_its_limit(self, u: Floats) -> str:
        """What may prevent convergence at `u`; empty if nothing."""
        return ""

    def geometric_stiffness(self, u: Floats, force: Floats) -> Floats:
        """Second derivative of ``force . dependents`` by the masters, shape (m, m)."""
        return np.zeros((len(self.masters), len(self.masters)))

    def curve(self, u: Floats, v: Floats) -> Floats:
        """Acceleration of the dependents at constant velocity `v` of the masters, shape (d,)."""
        return np.zeros(len(self.dependent))

    def secant(self, begin: Floats, end: Floats) -> Floats:
        """Changes of the dependents by those of the masters, exact, shape (d, m).

        The change of a rotation is ``2 tan(dphi / 2)``, as in the energy-momentum scheme.
        """
        return self.jacobian(end)


def _tangents(change: Floats) -> Floats:
    """``2 tan(dphi / 2) / dphi``."""
    half = 0.5 * change
    return np.where(half == 0.0, 1.0, np.tan(half) / np.where(half == 0.0, 1.0, half))


@dataclass
class LinearRelation(Relation):
    """``dependent = row . masters + constant``: an equation solved for its first term.

    Parameters
    ----------
    row : ndarray, shape (m,)
    rotates : ndarray of bool, shape (1 + m,)
        Whether the dependent, and each master, is a rotation.
    """

    row: Floats
    constant: float
    rotates: Bools

    def values(self, u: Floats) -> Floats:
        return np.array([self.row @ u[self.masters] + self.constant])

    def jacobian(self, u: Floats) -> Floats:
        return self.row[None, :]

    def secant(self, begin: Floats, end: Floats) -> Floats:
        if not (self.nlgeom and self.rotates.any()):
            return self.row[None, :]
        dofs = np.concatenate([self.dependent, self.masters])
        scale = np.where(self.rotates, _tangents((end - begin)[dofs]), 1.0)
        out: Floats = (scale[0] * self.row / scale[1:])[None, :]
        return out


def _turned(v: Floats, angle: float) -> Floats:
    """Vectors rotated by an angle, shape (n, 2)."""
    out: Floats = np.cos(angle) * v + np.sin(angle) * skew(v)
    return out


def _turned_less(v: Floats, angle: float) -> Floats:
    """``(R - I) v`` without cancellation at small angles, shape (n, 2)."""
    out: Floats = -2.0 * np.sin(0.5 * angle) ** 2 * v + np.sin(angle) * skew(v)
    return out


@dataclass
class Follow(Relation):
    """Nodes in rigid motion with a reference node, chosen dofs.

    ``u_s = u_ref + (R(phi) - I) (X_s - X_ref)``, ``phi_s = phi_ref``; the second derivative
    by phi is ``-R (X_s - X_ref)``.

    Parameters
    ----------
    arm : ndarray, shape (d, 2)
        ``X_s - X_ref`` of the node of each dependent [length].
    axis : ndarray, shape (d, 3)
        Component of the dependent: direction of a displacement, or (0, 0, 1).
    axes : ndarray, shape (2, 2)
        Columns: axes of the reference node.
    nlgeom : bool
        Whether rotations are finite.
    """

    arm: Floats
    axis: Floats
    axes: Floats
    nlgeom: bool = True

    instead = "its reference node"
    linear = False

    def values(self, u: Floats) -> Floats:
        x, y, phi = u[self.masters]
        arm = _turned_less(self.arm, phi) if self.nlgeom else phi * skew(self.arm)
        move = arm + self.axes @ np.array([x, y])
        out: Floats = (self.axis[:, :2] * move).sum(axis=1) + self.axis[:, 2] * phi
        return out

    def jacobian(self, u: Floats) -> Floats:
        return self._by(_turned(self.arm, u[self.masters[2]] if self.nlgeom else 0.0))

    def secant(self, begin: Floats, end: Floats) -> Floats:
        """See :class:`Relation`; ``R1 - R0 = 2 tan(dphi / 2) S (R0 + R1) / 2``."""
        if not self.nlgeom:
            return self.jacobian(end)
        phi = self.masters[2]
        return self._by(0.5 * (_turned(self.arm, begin[phi]) + _turned(self.arm, end[phi])))

    def _by(self, arm: Floats) -> Floats:
        lever = skew(arm)
        out = np.empty((len(self.dependent), 3))
        out[:, :2] = self.axis[:, :2] @ self.axes
        out[:, 2] = (self.axis[:, :2] * lever).sum(axis=1) + self.axis[:, 2]
        return out

    def geometric_stiffness(self, u: Floats, force: Floats) -> Floats:
        out = np.zeros((3, 3))
        if self.nlgeom:
            arm = _turned(self.arm, u[self.masters[2]])
            out[2, 2] = -float(force @ (self.axis[:, :2] * arm).sum(axis=1))
        return out

    def curve(self, u: Floats, v: Floats) -> Floats:
        if not self.nlgeom:
            return np.zeros(len(self.dependent))
        phi = self.masters[2]
        out: Floats = -(v[phi] ** 2) * (self.axis[:, :2] * _turned(self.arm, u[phi])).sum(axis=1)
        return out


@dataclass
class Mean(Relation):
    """A reference node that follows the weighted mean motion of nodes.

    The translation is that of the weighted mean, the rotation the best fit
    ``theta = atan2(sum w X x x, sum w X . x)``, whose gradient is ``gamma = w S eta / D`` with
    ``eta = R X`` and D the length of both sums; its second derivative is
    ``-(gamma eps^T + eps gamma^T)`` with ``eps = w eta / D``.

    Parameters
    ----------
    arm : ndarray, shape (n, 2)
        Positions of the nodes from their weighted mean [length].
    weight : ndarray, shape (n,)
        Of sum one.
    offset : ndarray, shape (2,)
        Position of the reference node from that mean [length].
    axis : ndarray, shape (d, 3)
        Component of each dependent, as in :class:`Follow`.
    axes : ndarray, shape (n, 2, 2)
        Columns: axes of each node.
    nlgeom : bool
        Whether rotations are finite.
    """

    arm: Floats
    weight: Floats
    offset: Floats
    axis: Floats
    axes: Floats
    nlgeom: bool = True

    instead = "the nodes that it follows, or make the coupling kinematic,"
    linear = False

    def _fit(self, u: Floats) -> tuple[Floats, float, float]:
        """Displacements in global axes, rotation and D."""
        local = u[self.masters].reshape(-1, 2)
        move: Floats = np.einsum("nij,nj->ni", self.axes, local)
        if not self.nlgeom:
            inertia = float(self.weight @ (self.arm**2).sum(axis=1))
            turn = float(self.weight @ (skew(self.arm) * move).sum(axis=1)) / inertia
            return move, turn, inertia
        now = self.arm + move - self.weight @ move
        along = float(self.weight @ (self.arm * now).sum(axis=1))
        across = float(self.weight @ (skew(self.arm) * now).sum(axis=1))
        return move, float(np.arctan2(across, along)), float(np.hypot(along, across))

    def values(self, u: Floats) -> Floats:
        """See :class:`Relation`; the rotation is the one nearest to that in `u`."""
        move, turn, _ = self._fit(u)
        offset = self.offset[None]
        swing = _turned_less(offset, turn) if self.nlgeom else turn * skew(offset)
        mean = self.weight @ move + swing[0]
        out: Floats = self.axis[:, :2] @ mean
        rotation = self.axis[:, 2] != 0.0
        turns = np.round((u[self.dependent[rotation]] - turn) / (2.0 * np.pi))
        out[rotation] = turn + 2.0 * np.pi * (turns if self.nlgeom else 0.0)
        return out

    def _gradients(self, u: Floats) -> tuple[Floats, Floats, Floats]:
        """``gamma`` and ``eps`` in the nodes' axes, flat, and ``R offset``."""
        _, turn, size = self._fit(u)
        if not self.nlgeom:
            turn = 0.0
        eta = _turned(self.arm, turn) * (self.weight / size)[:, None]
        gamma = np.einsum("nji,nj->ni", self.axes, skew(eta)).ravel()
        eps = np.einsum("nji,nj->ni", self.axes, eta).ravel()
        return gamma, eps, _turned(self.offset[None], turn)[0]

    def jacobian(self, u: Floats) -> Floats:
        gamma, _, offset = self._gradients(u)
        return self._by(gamma, offset)

    def secant(self, begin: Floats, end: Floats) -> Floats:
        """See :class:`Relation`; the rotation by the mean of both rotation matrices."""
        if not self.nlgeom:
            return self.jacobian(end)
        (move0, turn0, _), (move1, turn1, _) = self._fit(begin), self._fit(end)

        def mean(v: Floats) -> Floats:
            return 0.5 * (_turned(v, turn0) + _turned(v, turn1))

        eta = self.weight[:, None] * mean(self.arm)
        middle = self.arm + 0.5 * (move0 + move1)
        middle -= self.weight @ middle
        gamma = np.einsum("nji,nj->ni", self.axes, skew(eta) / (eta * middle).sum()).ravel()
        return self._by(gamma, mean(self.offset[None])[0])

    def _by(self, gamma: Floats, offset: Floats) -> Floats:
        mean = np.einsum("n,nij->inj", self.weight, self.axes).reshape(2, -1)
        swing = self.axis[:, :2] @ np.array([-offset[1], offset[0]]) + self.axis[:, 2]
        out: Floats = self.axis[:, :2] @ mean + np.outer(swing, gamma)
        return out

    def geometric_stiffness(self, u: Floats, force: Floats) -> Floats:
        if not self.nlgeom:
            return np.zeros((len(self.masters), len(self.masters)))
        gamma, eps, offset = self._gradients(u)
        push = force @ self.axis
        couple = push[2] - push[0] * offset[1] + push[1] * offset[0]
        mixed = np.outer(gamma, eps)
        out: Floats = -couple * (mixed + mixed.T)
        out -= (push[:2] @ offset) * np.outer(gamma, gamma)
        return out

    def curve(self, u: Floats, v: Floats) -> Floats:
        if not self.nlgeom:
            return np.zeros(len(self.dependent))
        gamma, eps, offset = self._gradients(u)
        rate = gamma @ v[self.masters]
        growth = -2.0 * rate * (eps @ v[self.masters])
        swing = growth * np.array([-offset[1], offset[0]]) - rate**2 * offset
        out: Floats = self.axis[:, :2] @ swing + growth * self.axis[:, 2]
        return out
