"""Inertia of elements and point masses, and the state of motion that it makes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.constraints.none import IDENTITY
from corota.analysis.terms.attachments import Attachments
from corota.analysis.terms.redistribution import set_moving_mass
from corota.analysis.terms.term import StatePoint, Term

if TYPE_CHECKING:
    from corota.analysis.constraints.elimination import LinearizedConstraints
    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.arrays import Bools, Floats
    from corota.model.steps import Step
    from corota.results.results import PointFields


@dataclass
class MotionState:
    """State of motion at the end of an increment.

    Parameters
    ----------
    u, v, a : ndarray, shape (n_dofs,)
    internal, external, inertia, damping : ndarray, shape (n_dofs,)
        Forces at `u`, each with the sign of the residual's first term but `external`.
    link : LinearizedConstraints
        The linearized constraints for these forces.
    carried : ndarray, shape (n_dofs,), or None
        Acceleration that Newmark's relations continue with; None where that is `a`.
    """

    u: Floats
    v: Floats
    a: Floats
    internal: Floats
    external: Floats
    inertia: Floats
    damping: Floats
    link: LinearizedConstraints = IDENTITY
    carried: Floats | None = None

    @classmethod
    def of(cls, point: StatePoint, at: Evaluation, carried: Floats | None = None) -> MotionState:
        """The state of a point with the forces of an evaluation."""
        assert at.inertia is not None
        assert at.damping is not None
        forces = at.internal, at.external, at.inertia, at.damping
        return cls(point.u, point.v, point.a, *forces, at.link, carried)

    def gathered(self, force: Floats) -> Floats:
        """A force with what dependent dofs pass on to their masters."""
        return self.link.gather(force)

    def reaction(self) -> Floats:
        """Force that supports carry, at prescribed dofs."""
        return self.gathered(self.internal + self.damping + self.inertia - self.external)


class Inertia(Term):
    """Inertia of a model: the constant matrix where there is one, else by element.

    Parameters
    ----------
    kind : {"consistent", "constant", "lumped"}
    massless : ndarray of bool, shape (n_nodes,), optional
        Nodes whose mass the other nodes of their elements carry.

    Attributes
    ----------
    massless : ndarray of bool, shape (n_dofs,)
        Displacements without mass.
    remark : str
        Message on the redistribution of mass, or empty.
    """

    name = "inertia"

    def __init__(self, system: System, kind: str, massless: Bools | None = None) -> None:
        self.system, self.kind = system, kind
        self.attached = Attachments(system)
        self.remark = set_moving_mass(system, kind, massless)
        system.conditions.set_mass(kind)
        self.massless = np.zeros(system.n_dofs, bool)
        if massless is not None:
            self.massless = massless[system.node_of_dof] & ~system.is_rotation
            self.massless &= self.attached.mass == 0.0
        self._turns = bool(system.is_rotation.any())
        coupled = kind == "consistent" and self._turns
        zero = np.zeros(system.n_dofs)
        values = self._evaluate(zero, zero, zero, (0.0, 0.0, 1.0), True)[2]
        self.matrix: Floats | None = None if coupled else values
        self._own = np.abs(system.pattern.diagonal_of(values))
        # Elements of such nodes alone keep their mass.
        self.massless &= self._own == 0.0
        moves = self._own[~system.is_rotation]
        self._largest = float(moves.max(initial=0.0))

    def weigh(self, at: Evaluation, du: Floats, weight: float) -> None:
        """Set the sizes of inertia of an evaluation: `weight` times the mass of a change `du`."""
        at.inertial_stiffness = weight * self._largest
        terms = weight * self._own * np.abs(du)
        if self._turns:
            terms[self.system.is_rotation] /= self.system.length
        at.momentum = float(terms.max(initial=0.0))

    def settle(self, begin: MotionState, end: MotionState, dt: float) -> None:
        """Give displacements without mass the mean velocity of the increment, in place.

        They follow quasi-statically; the velocities of the scheme for them are noise.
        """
        if self.massless.any():
            end.v[self.massless] = (end.u - begin.u)[self.massless] / dt
            end.a[self.massless] = 0.0
            if end.carried is not None:
                end.carried[self.massless] = 0.0

    def force(self, u: Floats, v: Floats, a: Floats) -> Floats:
        """Inertia force [force]."""
        if self.matrix is not None:
            return self.system.product(self.matrix, a)
        return self._evaluate(u, v, a, (0.0, 0.0, 0.0), False)[0]

    def add(self, point: StatePoint, at: Evaluation) -> None:
        """Set the inertia of `at`; add its size and the derivatives by all rates."""
        if self.matrix is not None:
            at.values += point.weights[2] * self.matrix
            at.inertia = self.force(point.u, point.v, point.a)
            at.scale += np.abs(at.inertia)
            return
        force, scale, values = self._evaluate(point.u, point.v, point.a, point.weights, True)
        at.values += values
        at.scale += scale
        at.inertia = force

    def add_point_masses(self, point: StatePoint, at: Evaluation) -> Floats:
        """Force of the point masses alone; size and derivative are added."""
        mass = self.attached.mass
        force = mass * point.a
        at.scale += np.abs(force)
        self.system.pattern.add_diagonal(at.values, point.weights[2] * mass)
        return force

    def tangent(self, u: Floats) -> Floats:
        """Mass matrix at a displacement, upper triangle."""
        if self.matrix is not None:
            return np.array(self.matrix)
        zero = np.zeros_like(u)
        _, _, values = self._evaluate(u, zero, zero, (0.0, 0.0, 1.0), True)
        return values

    def _evaluate(
        self, u: Floats, v: Floats, a: Floats, weights: tuple[float, float, float], tangent: bool
    ) -> tuple[Floats, Floats, Floats]:
        system = self.system
        force, scale = np.zeros(system.n_dofs), np.zeros(system.n_dofs)
        values = np.zeros(system.pattern.nnz if tangent else 0)
        with system.timed("assemble"):
            x, rate, growth = (system.in_space(x) for x in (u, v, a))
            system.core.inertia(x, rate, growth, self.kind, list(weights), force, scale, values)
        own = self.attached.mass * a
        if tangent:
            system.pattern.add_diagonal(values, weights[2] * self.attached.mass)
        force, scale = system.communicator.sum(force), system.communicator.sum(scale)
        return system.at_nodes(force) + own, scale + np.abs(own), values

    def momenta(self, u: Floats, v: Floats, carried: bool) -> Floats:
        """Kinetic energy, linear and angular momentum and mass, shape (5,)."""
        x, rate = (self.system.in_space(x) for x in (u, v))
        own = np.array(self.system.core.momenta(x, rate, self.kind, carried))
        core = self.system.communicator.sum(own)
        return core + self.attached.momenta(u, v) if self.attached.mass.any() else core


def add_kinetic(
    system: System, fields: list[PointFields], u: Floats, v: Floats, step: Step
) -> None:
    """Give fields the kinetic energy of their elements, per volume."""
    kind, scheme = (getattr(step, name, "") for name in ("mass", "scheme"))
    x, rate = system.in_space(u), system.in_space(v)
    for number, block in enumerate(fields):
        carried = scheme == "energy_momentum"
        each = system.core.kinetic(number, x, rate, kind or "consistent", carried)
        volume = block.volume.sum(axis=1)
        density = np.divide(each, volume, out=np.zeros_like(each), where=volume > 0.0)
        block.values["EKEDEN"] = np.repeat(density[:, None], block.volume.shape[1], axis=1)
