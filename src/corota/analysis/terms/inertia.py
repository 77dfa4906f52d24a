"""Inertia and viscous damping: what a motion adds to residual and tangent."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.constraints.none import IDENTITY
from corota.analysis.terms.attachments import Attachments

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.constraints.elimination import LinearizedConstraints
    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.viscous import ViscousElements
    from corota.model.steps import Step
    from corota.results.results import PointFields

    Floats = NDArray[np.float64]


@dataclass
class MotionState:
    """State of motion at the end of an increment.

    Parameters
    ----------
    u, v, a : ndarray, shape (n_dofs,)
    internal, external, inertia, damping : ndarray, shape (n_dofs,)
        Forces at `u`, each with the sign of the residual's first term but `external`.
    link : LinearizedConstraints
        What the constraints make of these forces.
    carried : ndarray, shape (n_dofs,), or None
        Acceleration that Newmark's relations go on with; None where that is `a`.
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

    def gathered(self, force: Floats) -> Floats:
        """A force with what dependent dofs pass on to their masters."""
        return self.link.gather(force)

    def reaction(self) -> Floats:
        """What supports and nothing else must carry, at held dofs."""
        return self.gathered(self.internal + self.damping + self.inertia - self.external)


@dataclass
class Damping:
    """Rayleigh damping of a step.

    Parameters
    ----------
    per_mass : float
        Of the whole model [1/time].
    mass : ndarray or None
        Damping of materials per mass, upper triangle.
    elements : ViscousElements or None
        Damping per stiffness.
    """

    per_mass: float = 0.0
    mass: Floats | None = None
    elements: ViscousElements | None = None


class Inertia:
    """Inertia of a model: the constant matrix where there is one, else by element.

    Parameters
    ----------
    system : System
    kind : {"consistent", "constant", "lumped"}
    massless : ndarray of bool, shape (n_nodes,), optional
        Nodes whose mass the other nodes of their elements carry.

    Attributes
    ----------
    massless : ndarray of bool, shape (n_dofs,)
        Displacements without mass.
    """

    def __init__(
        self, system: System, kind: str, massless: NDArray[np.bool_] | None = None
    ) -> None:
        self.system, self.kind = system, kind
        self.attached = Attachments(system)
        flags = np.zeros(0, bool) if massless is None else np.ascontiguousarray(massless)
        system.core.set_massless(flags)
        system.conditions.set_mass(kind)
        self.massless = np.zeros(system.n_dofs, bool)
        if massless is not None:
            self.massless = massless[system.node_of_dof] & ~system.is_rotation
            self.massless &= self.attached.mass == 0.0
        coupled = kind == "consistent" and bool(system.is_rotation.any())
        zero = np.zeros(system.n_dofs)
        values = self._evaluate(zero, zero, zero, (0.0, 0.0, 1.0), True)[2]
        self.matrix: Floats | None = None if coupled else values
        self._own = np.abs(values[system.pattern.diagonal])
        moves = self._own[~system.is_rotation]
        self._largest = float(moves.max(initial=0.0))

    def weigh(self, at: Evaluation, du: Floats, weight: float) -> None:
        """Tell an evaluation the sizes of inertia: `weight` times the mass of a change `du`."""
        at.heft = weight * self._largest
        terms = weight * self._own * np.abs(du)
        turn = self.system.is_rotation
        at.momentum = float(terms[~turn].max(initial=0.0))
        if turn.any():
            at.momentum = max(at.momentum, float(terms[turn].max()) / self.system.length)

    def settle(self, begin: MotionState, end: MotionState, dt: float) -> None:
        """Give displacements without mass the mean velocity of the increment, in place.

        They follow quasi-statically; what the scheme carries on for them is noise.
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

    def add(
        self, at: Evaluation, u: Floats, v: Floats, a: Floats, weights: tuple[float, float, float]
    ) -> Floats:
        """Add the tangent to `at` and the size to its scale; returns the force."""
        if self.matrix is not None:
            at.values += weights[2] * self.matrix
            force = self.force(u, v, a)
            at.scale += np.abs(force)
            return force
        force, scale, values = self._evaluate(u, v, a, weights, True)
        at.values += values
        at.scale += scale
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
            values[system.pattern.diagonal] += weights[2] * self.attached.mass
        return system.at_nodes(force) + own, scale + np.abs(own), values

    def momenta(self, u: Floats, v: Floats, carried: bool) -> Floats:
        """Kinetic energy, linear and angular momentum and mass, shape (5,)."""
        x, rate = (self.system.in_space(x) for x in (u, v))
        core = np.array(self.system.core.momenta(x, rate, self.kind, carried))
        return core + self.attached.momenta(u, v) if self.attached.mass.any() else core

    def damping(
        self,
        at: Evaluation,
        u: Floats,
        v: Floats,
        weight: float,
        damping: Damping,
        between: tuple[Floats, Floats, float] | None = None,
    ) -> Floats:
        """Rayleigh damping and dashpots; `weight` times the derivative by velocity goes to `at`.

        `between` gives the two states and the time over which `v` is the mean rate.
        """
        values = at.values
        per_mass = damping.per_mass
        force = np.zeros_like(v)
        if per_mass:
            mass = self.tangent(u)
            force += per_mass * self.system.product(mass, v)
            values += weight * per_mass * mass
        if damping.mass is not None:
            force += self.system.product(damping.mass, v)
            values += weight * damping.mass
        if damping.elements is not None and damping.elements.blocks:
            begin, end, dt = between or (u, u, 0.0)
            force += damping.elements.add(begin, end, v, dt, weight, values)
        if self.attached.dampers:
            damped, triplets = self.attached.damp(u, v, values, weight)
            force += damped
            if triplets is not None:
                # Derivatives of external forces have the other sign.
                rows, columns, products = triplets
                products = -products
                if at.load_stiffness is not None:
                    rows = np.concatenate([at.load_stiffness[0], rows])
                    columns = np.concatenate([at.load_stiffness[1], columns])
                    products = np.concatenate([at.load_stiffness[2], products])
                at.load_stiffness = (rows, columns, products)
        return force


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


__all__ = ["Damping", "Inertia", "MotionState", "add_kinetic"]
