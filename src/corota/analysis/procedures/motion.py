"""Increments of time schemes: rates, weights of the forces at both ends, and their output."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.evaluation import Evaluation
from corota.analysis.rule import Rule
from corota.analysis.terms.inertia import Inertia, MotionState
from corota.analysis.terms.term import StatePoint

if TYPE_CHECKING:
    from corota.analysis.constraints.elimination import Constraints, LinearizedConstraints
    from corota.analysis.equations import System
    from corota.analysis.terms.damping import Damping
    from corota.analysis.terms.elements import Elements
    from corota.arrays import Bools, Floats
    from corota.model.schemes import Scheme


#: Corrections before the first one that is changed: an iteration that converges well ends earlier.
PLAIN = 5
#: Differences of corrections that are combined, at most.
DEPTH = 10
#: Share of the largest singular value below which differences count as dependent.
DEPENDENT = 1e-12


class Acceleration:
    """Combines the last corrections so that, were they linear in the unknowns, the next were zero.

    D. G. Anderson, *Journal of the ACM* 12, 1965, 547-560; for Newton's method with an approximate
    tangent N. N. Carlson & K. Miller, *SIAM Journal on Scientific Computing* 19, 1998, 728-765.

    Parameters
    ----------
    weights : ndarray, shape (n_dofs,)
        Make the unknowns comparable.
    """

    def __init__(self, weights: Floats) -> None:
        self.weights = weights
        self._points: list[Floats] = []
        self._corrections: list[Floats] = []

    def improve(self, u: Floats, du: Floats) -> Floats:
        """The correction to take at `u` in place of `du`, which the tangent gives there."""
        self._points = [*self._points[-DEPTH:], u.copy()]
        self._corrections = [*self._corrections[-DEPTH:], du]
        if len(self._points) <= PLAIN:
            return du
        moved = np.diff(self._points, axis=0).T
        changed = np.diff(self._corrections, axis=0).T
        rows = self.weights[:, None]
        share, *_ = np.linalg.lstsq(rows * changed, self.weights * du, rcond=DEPENDENT)
        out: Floats = du - (moved + changed) @ share
        return out


@dataclass
class Driven:
    """Prescribed dofs at the end of an increment, each shape (n_dofs,).

    Parameters
    ----------
    u, v, a : ndarray
        Displacement, velocity and acceleration, which mean nothing elsewhere.
    """

    constrained: Bools
    u: Floats
    v: Floats
    a: Floats


class Motion(Rule):
    """One increment of a time scheme.

    Parameters
    ----------
    driven : Driven
        Prescribed motion at the end.

    Attributes
    ----------
    end : MotionState
        State of the last evaluation.
    """

    moves = True

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


class NewmarkMotion(Motion):
    """One increment of a scheme with Newmark's relations.

    The equation of motion holds at the end of the increment, with the true acceleration there;
    Newmark's relations take a filtered one, A (Arnold & Bruels 2007):

        (1 - alpha_m) A(n+1) + alpha_m A(n) = (1 - alpha_f) a(n+1) + alpha_f a(n) .

    With a constant mass that is the usual weighted equation. Where inertia depends on the
    configuration, as with constraints that turn, the weighted equation mixes accelerations and
    velocities of different times and is of first order; this one is of second.

    Parameters
    ----------
    system, inertia, start, dt, driven, damping
        As of :class:`Motion`.
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
        super().__init__(system, inertia, start, dt, driven, damping)
        self.scheme = scheme
        # Derivatives of velocity and acceleration by displacement.
        s = scheme
        self.c_v = s.gamma / (s.beta * dt)
        self.c_a = (1.0 - s.alpha_m) / ((1.0 - s.alpha_f) * s.beta * dt * dt)
        # What balances the start: the forces of contact there, and rounding.
        self.begun = s.alpha_f * start.reaction() if s.alpha_f else None
        # Terms of the rates that the start alone determines.
        before = start.a if start.carried is None else start.carried
        self._drift = dt * start.v
        self._before = [f * before for f in (0.5 / s.beta - 1.0, 1.0 - s.gamma, s.alpha_m)]
        self._balance = s.alpha_f * start.a
        self._constrained = driven.constrained.nonzero()[0]
        self._prescribed = [x[self._constrained] for x in (driven.u, driven.v, driven.a)]

    def _rates(self, u: Floats) -> tuple[Floats, Floats, Floats]:
        """Velocity, acceleration and the filtered acceleration."""
        s, dt, b = self.scheme, self.dt, self.start
        carried = (u - b.u - self._drift) / (s.beta * dt * dt) - self._before[0]
        v = b.v + dt * (self._before[1] + s.gamma * carried)
        a = carried
        constrained, eliminated = self._constrained, self.system.constraints.eliminated
        if s.alpha_m or s.alpha_f:
            a = (1.0 - s.alpha_m) * carried + self._before[2] - self._balance
            a /= 1.0 - s.alpha_f
        elif len(constrained) or len(eliminated):
            a = carried.copy()
        if len(constrained):
            # Newton's method moves prescribed dofs in its first correction: until then the rates
            # differ by what the tangent takes them for.
            u_end, v_end, a_end = self._prescribed
            rest = u[constrained] - u_end
            v[constrained] = v_end + self.c_v * rest
            a[constrained] = a_end + self.c_a * rest
        self.system.constraints.complete_rates(u, v, a)
        if len(eliminated):
            carried[eliminated] = a[eliminated]
        carried[constrained] = a[constrained]
        return v, a, carried

    def point(self, u: Floats, step_time: float) -> StatePoint:
        """The end of the increment; its weights are still to be multiplied by that of the end."""
        v, a, self._carried = self._rates(u)
        return StatePoint(u, step_time, v, a, (1.0, self.c_v, self.c_a))

    def close(self, point: StatePoint, at: Evaluation) -> None:
        share = 1.0 - self.scheme.alpha_f
        at.weigh(share)
        point = point._replace(weights=(share, share * self.c_v, share * self.c_a))
        for term in (self.inertia, self.damping):
            term.add(point, at)
        self.inertia.weigh(at, point.u - self.start.u, point.weights[2])
        self.end = end = MotionState.of(point, at, self._carried)
        at.internal = share * (end.internal + end.damping + end.inertia)
        at.external = share * at.external
        if self.begun is not None:
            at.internal += self.begun


class ConservingMotion(Motion):
    """One increment of the energy-momentum scheme.

    Loads are taken at the middle of the increment. The increment that moments do work on is
    ``2 tan(dphi / 2)``, which also carries the rotational velocities.
    """

    def improve(self, du: Floats, driven: bool) -> Floats:
        """A correction that converges faster: the tangent is symmetric, the exact one is not."""
        if self.system.joined or driven:
            return du
        return self._acceleration.improve(self.end.u, du)

    @cached_property
    def _acceleration(self) -> Acceleration:
        """Of this increment; rotations count by the displacements that they give an element."""
        turns = self.system.is_rotation
        return Acceleration(np.where(turns, self.system.cell_size, 1.0))

    def increment(self, u: Floats) -> Floats:
        """Increment that the forces do work on, shape (n_dofs,)."""
        d = u - self.start.u
        turn = self.system.is_rotation
        if self.system.nlgeom:
            d[turn] = 2.0 * np.tan(0.5 * d[turn])
        return d

    def point(self, u: Floats, step_time: float) -> StatePoint:
        b, dt = self.start, self.dt
        d = self._d = self.increment(u)
        v = self._v = 2.0 / dt * d - self._begun
        a = (v - self._begun) / dt
        return StatePoint(
            0.5 * (u + b.u),
            step_time - 0.5 * dt,
            d / dt,
            a,
            weights=(0.5, 1.0 / dt, 2.0 / (dt * dt)),
            between=(b.u, u, dt),
        )

    def add_elements(self, elements: Elements, point: StatePoint, at: Evaluation) -> None:
        """Fill in the forces of the elements and their inertia."""
        self._force = elements.add_conserving(point, self._begun, self.inertia.kind, at)
        self._internal = at.internal.copy()

    def link(self, constraints: Constraints, u: Floats) -> LinearizedConstraints:
        return constraints.secant(self.start.u, u)

    def close(self, point: StatePoint, at: Evaluation) -> None:
        assert point.between is not None
        u, v = point.between[1], self._v
        force = self._force + (at.internal - self._internal)
        force += self.inertia.add_point_masses(point, at)
        self.inertia.weigh(at, self._d, point.weights[2])
        self.damping.add(point, at)
        constrained = self.driven.constrained
        a = point.a
        v[constrained], a[constrained] = self.driven.v[constrained], self.driven.a[constrained]
        at.inertia = force - at.internal
        self.end = end = MotionState.of(point._replace(u=u, v=v), at)
        at.internal = force + end.damping

    @cached_property
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


class EndForces:
    """External forces and reactions at the end of an increment, for every scheme.

    Schemes that weigh the equation between both ends have all forces of the end. The
    energy-momentum scheme has those of the middle: stress and loads are taken again, inertia and
    damping are extrapolated linearly from the last two middles.

    Attributes
    ----------
    at : Evaluation
        Internal and external forces at the end.
    reaction : ndarray, shape (n_dofs,)
        By equilibrium there; zero where nothing is prescribed.
    """

    at: Evaluation
    reaction: Floats

    def __init__(self, system: System) -> None:
        self.system = system
        # Time from the instant of the last known inertia to the end of that increment.
        self._lag = 0.0

    def start(self, now: MotionState, contact: Floats) -> None:
        """Take the forces at the start of a motion, in which contact has a force."""
        internal = now.internal - contact
        self.at = Evaluation(internal, now.external, internal, np.empty(0), None, now.link)
        whole = now.reaction() - now.gathered(contact)
        self.reaction = np.where(self.system.conditions.constrained, whole, 0.0)

    def find(
        self, motion: NewmarkMotion | ConservingMotion, contact: Floats, step_time: float
    ) -> None:
        """Find the forces at the end of an accepted increment, in which contact has a force."""
        system, begin, end = self.system, motion.start, motion.end
        inertia = end.inertia + end.damping
        internal, external, link = end.internal, end.external, end.link
        if hasattr(motion, "increment"):
            half = 0.5 * motion.dt
            share = half / (half + self._lag)
            inertia = inertia + share * (inertia - begin.inertia - begin.damping)
            self._lag = half
            # Forces of the end have their moments about the masters as they lie there.
            own = system.forces(end.u, step_time)
            internal, external, link = own.internal, own.external, own.link
        internal = internal - contact
        self.at = Evaluation(internal, external, internal, np.empty(0), None, link)
        whole = link.gather(internal + inertia - external)
        self.reaction = np.where(system.conditions.constrained, whole, 0.0)
