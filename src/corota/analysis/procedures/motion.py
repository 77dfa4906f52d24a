"""A system in motion: what Newton's method sees of an increment of a time scheme.

It offers the same methods as the static system, with the inertia and the weights of the
scheme put into residual and tangent; so there is one Newton's method.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.constraints.none import IDENTITY
from corota.analysis.equations import failure
from corota.analysis.evaluation import Evaluation
from corota.analysis.terms.attachments import Attachments

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.constraints.elimination import LinearizedConstraints
    from corota.analysis.equations import System
    from corota.analysis.newton import ResidualNorms
    from corota.analysis.terms.viscous import ViscousElements
    from corota.model.schemes import Scheme
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


@dataclass
class Driven:
    """Prescribed dofs at the end of an increment, each shape (n_dofs,).

    Parameters
    ----------
    constrained : ndarray of bool
    u, v, a : ndarray
        Displacement, velocity and acceleration, which mean nothing elsewhere.
    """

    constrained: NDArray[np.bool_]
    u: Floats
    v: Floats
    a: Floats


class NewmarkMotion:
    """One increment of a scheme with Newmark's relations, for Newton's method.

    The equation of motion holds at the end of the increment, with the true acceleration there;
    Newmark's relations take a filtered one, A (Arnold & Bruels 2007):

        (1 - alpha_m) A(n+1) + alpha_m A(n) = (1 - alpha_f) a(n+1) + alpha_f a(n) .

    With a constant mass that is the usual weighted equation. Where inertia depends on the
    configuration, as with constraints that turn, the weighted equation mixes accelerations and
    velocities of different times and is of first order; this one is of second.

    Parameters
    ----------
    system : System
    inertia : Inertia
    scheme : Scheme
    start : MotionState
    dt : float
    driven : Driven
        Prescribed motion at the end.
    damping : Damping
    """

    def __init__(
        self,
        system: System,
        inertia: Inertia,
        scheme: Scheme,
        start: MotionState,
        dt: float,
        driven: Driven,
        damping: Damping,
    ) -> None:
        self.system, self.inertia, self.scheme = system, inertia, scheme
        self.start, self.dt, self.driven = start, dt, driven
        self.damping = damping
        self.end = start
        # Derivatives of velocity and acceleration by displacement.
        s = scheme
        self.c_v = s.gamma / (s.beta * dt)
        self.c_a = (1.0 - s.alpha_m) / ((1.0 - s.alpha_f) * s.beta * dt * dt)
        # What balances the start: the forces of contact there, and rounding.
        self.begun = s.alpha_f * start.reaction() if s.alpha_f else None

    def _rates(self, u: Floats) -> tuple[Floats, Floats, Floats]:
        """Velocity, acceleration and the filtered acceleration."""
        s, dt, b, driven = self.scheme, self.dt, self.start, self.driven
        before = b.a if b.carried is None else b.carried
        carried = (u - b.u - dt * b.v) / (s.beta * dt * dt) - (0.5 / s.beta - 1.0) * before
        v = b.v + dt * ((1.0 - s.gamma) * before + s.gamma * carried)
        a = carried
        if s.alpha_m or s.alpha_f:
            a = (1.0 - s.alpha_m) * carried + s.alpha_m * before - s.alpha_f * b.a
            a /= 1.0 - s.alpha_f
        elif driven.constrained.any() or len(self.system.constraints.eliminated):
            a = carried.copy()
        constrained = driven.constrained
        if constrained.any():
            # Newton's method moves held dofs in its first correction: until then the rates differ
            # by what the tangent takes them for.
            rest = (u - driven.u)[constrained]
            v[constrained] = driven.v[constrained] + self.c_v * rest
            a[constrained] = driven.a[constrained] + self.c_a * rest
        eliminated = self.system.constraints.eliminated
        self.system.constraints.complete_rates(u, v, a)
        carried[eliminated] = a[eliminated]
        carried[constrained] = a[constrained]
        return v, a, carried

    def evaluate(self, u: Floats, step_time: float) -> Evaluation:
        """Residual and effective tangent of the equation of motion."""
        share = 1.0 - self.scheme.alpha_f
        at = self.system.evaluate(u, step_time)
        v, a, carried = self._rates(u)
        internal, external = at.internal, at.external
        at.values *= share
        if at.load_stiffness is not None:
            rows, columns, values = at.load_stiffness
            at.load_stiffness = (rows, columns, share * values)
        weights = (share, share * self.c_v, share * self.c_a)
        force = self.inertia.add(at, u, v, a, weights)
        self.inertia.weigh(at, u - self.start.u, weights[2])
        damping = self.inertia.damping(at, u, v, share * self.c_v, self.damping)
        self.end = MotionState(u, v, a, internal, external, force, damping, at.link, carried)
        at.internal = share * (internal + damping + force)
        at.external = share * external
        if self.begun is not None:
            at.internal += self.begun
        return at

    def predict(self, at: Evaluation, du_prescribed: Floats) -> tuple[Floats, int]:
        """Newton correction."""
        return self.system.predict(at, du_prescribed)

    def residual_norms(self, at: Evaluation, u: Floats) -> ResidualNorms:
        """Size of the residual."""
        return self.system.residual_norms(at, u)

    def return_tangent(self, at: Evaluation) -> None:
        """Take the memory of a tangent back."""
        self.system.return_tangent(at)


class ConservingMotion:
    """One increment of the energy-momentum scheme.

    Loads are taken at the middle of the increment. The increment that moments do work on is
    ``2 tan(dphi / 2)``, which also carries the rotational velocities.
    """

    def __init__(
        self,
        system: System,
        inertia: Inertia,
        start: MotionState,
        dt: float,
        driven: Driven,
        damping: Damping,
    ) -> None:
        self.system, self.inertia = system, inertia
        self.start, self.dt, self.driven = start, dt, driven
        self.damping = damping
        self.end = start

    def increment(self, u: Floats) -> Floats:
        """Increment that the forces do work on, shape (n_dofs,)."""
        d = u - self.start.u
        turn = self.system.is_rotation
        if self.system.nlgeom:
            d[turn] = 2.0 * np.tan(0.5 * d[turn])
        return d

    def evaluate(self, u: Floats, step_time: float) -> Evaluation:
        """Residual and tangent of the mid-point equation of motion."""
        system, b, dt = self.system, self.start, self.dt
        n = system.n_dofs
        force, internal, scale = np.empty(n), np.empty(n), np.empty(n)
        values = system.borrow_tangent()
        system.constraints.complete(u)
        d = self.increment(u)
        begun = self._begun()
        x1, x0, v0 = (system.in_space(x) for x in (u, b.u, begun))
        system.set_temperatures(step_time - 0.5 * dt)

        def assemble() -> None:
            system.core.conserving(
                x1, x0, v0, dt, self.inertia.kind, system.nlgeom, force, internal, scale, values
            )

        try:
            with system.timed("assemble"):
                system.user.assemble(x1, system.nlgeom, assemble, between=True)
                if system.user.blocks:
                    system.user.linearize(assemble, values)
        except RuntimeError as error:
            raise failure(system._labels(error.args[1]), error.args[0]) from None
        force, internal = system.at_nodes(force), system.at_nodes(internal)
        middle = 0.5 * (u + b.u)
        external, stiffness = system.conditions.external(
            step_time - 0.5 * dt, u, values, share=0.5, start=b.u
        )
        v = 2.0 / dt * d - begun
        a = (v - begun) / dt
        attached = self.inertia.attached
        hung = attached.mass * a
        force += hung
        scale += np.abs(hung)
        values[system.pattern.diagonal] += 2.0 / (dt * dt) * attached.mass
        link = system.constraints.secant(b.u, u)
        at = Evaluation(force, external, scale, values, stiffness, link)
        self.inertia.weigh(at, d, 2.0 / (dt * dt))
        damping = self.inertia.damping(at, middle, d / dt, 1.0 / dt, self.damping, (b.u, u, dt))
        at.internal = force + damping
        constrained = self.driven.constrained
        v[constrained], a[constrained] = self.driven.v[constrained], self.driven.a[constrained]
        self.end = MotionState(u, v, a, internal, external, force - internal, damping, link)
        return at

    def _begun(self) -> Floats:
        """Velocities that the mid-point rule starts from, shape (n_dofs,).

        Those of the start; at prescribed dofs what makes the change of velocity over the increment
        the prescribed one, since the rule would swing about it for ever.
        """
        constrained = self.driven.constrained
        if not constrained.any():
            return self.start.v
        out: Floats = self.start.v.copy()
        mean = self.increment(self.driven.u)[constrained] / self.dt
        out[constrained] = mean - 0.5 * (self.driven.v - self.start.v)[constrained]
        return out

    def predict(self, at: Evaluation, du_prescribed: Floats) -> tuple[Floats, int]:
        """Newton correction."""
        return self.system.predict(at, du_prescribed)

    def residual_norms(self, at: Evaluation, u: Floats) -> ResidualNorms:
        """Size of the residual."""
        return self.system.residual_norms(at, u)

    def return_tangent(self, at: Evaluation) -> None:
        """Take the memory of a tangent back."""
        self.system.return_tangent(at)


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
