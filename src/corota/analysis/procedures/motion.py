"""The equations of an increment of a time scheme, for Newton's method.

It offers the same methods as the static system, with the inertia and the weights of the
scheme put into residual and tangent; so there is one Newton's method.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.acceleration import Acceleration
from corota.analysis.terms.inertia import MotionState
from corota.analysis.terms.term import StatePoint

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import ResidualNorms
    from corota.analysis.terms.damping import Damping
    from corota.analysis.terms.inertia import Inertia
    from corota.model.schemes import Scheme

    Floats = NDArray[np.float64]


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


class Motion:
    """One increment of a time scheme: what Newton's method needs besides an evaluation.

    Parameters
    ----------
    system : System
    inertia : Inertia
    start : MotionState
    dt : float
    driven : Driven
        Prescribed motion at the end.
    damping : Damping

    Attributes
    ----------
    end : MotionState
        State of the last evaluation.
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

    def predict(self, at: Evaluation, du_prescribed: Floats) -> tuple[Floats, int]:
        """Newton correction."""
        return self.system.predict(at, du_prescribed)

    def residual_norms(self, at: Evaluation, u: Floats) -> ResidualNorms:
        """Size of the residual."""
        return self.system.residual_norms(at, u)

    def return_tangent(self, at: Evaluation) -> None:
        """Take the memory of a tangent back."""
        self.system.return_tangent(at)


class NewmarkMotion(Motion):
    """One increment of a scheme with Newmark's relations, for Newton's method.

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
    scheme : Scheme
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

    def evaluate(self, u: Floats, step_time: float) -> Evaluation:
        """Residual and effective tangent of the equation of motion."""
        share = 1.0 - self.scheme.alpha_f
        at = self.system.evaluate(u, step_time)
        at.weigh(share)
        v, a, carried = self._rates(u)
        point = StatePoint(u, step_time, v, a, (share, share * self.c_v, share * self.c_a))
        for term in (self.inertia, self.damping):
            term.add(point, at)
        self.inertia.weigh(at, u - self.start.u, point.weights[2])
        self.end = end = MotionState.of(point, at, carried)
        at.internal = share * (end.internal + end.damping + end.inertia)
        at.external = share * at.external
        if self.begun is not None:
            at.internal += self.begun
        return at


class ConservingMotion(Motion):
    """One increment of the energy-momentum scheme.

    Loads are taken at the middle of the increment. The increment that moments do work on is
    ``2 tan(dphi / 2)``, which also carries the rotational velocities.
    """

    def predict(self, at: Evaluation, du_prescribed: Floats) -> tuple[Floats, int]:
        """Newton correction; the tangent is symmetric, which the exact one is not."""
        du, negative = super().predict(at, du_prescribed)
        if not (self.system.joined or du_prescribed.any()):
            du = self._acceleration.improve(self.end.u, du)
        return du, negative

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

    def evaluate(self, u: Floats, step_time: float) -> Evaluation:
        """Residual and tangent of the mid-point equation of motion."""
        system, b, dt = self.system, self.start, self.dt
        at = system.blank(system.borrow_tangent())
        system.constraints.complete(u)
        d, begun = self.increment(u), self._begun
        v = 2.0 / dt * d - begun
        a = (v - begun) / dt
        point = StatePoint(
            0.5 * (u + b.u),
            step_time - 0.5 * dt,
            d / dt,
            a,
            weights=(0.5, 1.0 / dt, 2.0 / (dt * dt)),
            between=(b.u, u, dt),
        )
        force = system.elements.add_conserving(point, begun, self.inertia.kind, at)
        internal = at.internal.copy()
        system.add_others(point, at)
        force += at.internal - internal
        force += self.inertia.add_point_masses(point, at)
        at.link = system.constraints.secant(b.u, u)
        self.inertia.weigh(at, d, point.weights[2])
        self.damping.add(point, at)
        constrained = self.driven.constrained
        v[constrained], a[constrained] = self.driven.v[constrained], self.driven.a[constrained]
        at.inertia = force - at.internal
        self.end = end = MotionState.of(point._replace(u=u, v=v), at)
        at.internal = force + end.damping
        return at

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
