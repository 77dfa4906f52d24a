"""The equation of motion in adjoint states: Newmark's relations from the last increment back.

With the residual ``r = f_int(u) + C v + M a - f_ext`` at the end of each increment and the linear
relations of the scheme between displacement, velocity and both accelerations (see
:mod:`corota.model.schemes`), the multipliers of these relations go from an increment to the one
before in closed form, and z solves the transposed effective tangent
(D. A. Tortorelli, P. Michaleris, Design sensitivity analysis: overview and review, Inverse Problems
in Engineering 1 (1994) 71-105).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.procedures.motion_start import TRACE, initial_velocity
from corota.analysis.terms.damping import mass_damping
from corota.analysis.terms.inertia import Inertia
from corota.analysis.terms.viscous import ViscousElements
from corota.errors import UnsupportedError
from corota.model.schemes import SCHEMES
from corota.model.steps import Dynamic, Step

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.arrays import Floats
    from corota.model.model import Model


def refuse_motion(model: Model, steps: Sequence[Step]) -> None:
    """Refuse dynamic steps whose derivative is not included.

    Raises
    ------
    UnsupportedError
    """
    for step in steps:
        if not isinstance(step, Dynamic):
            continue
        what = ""
        if len(steps) > 1:
            what = "a dynamic step beside other steps"
        elif step.scheme not in SCHEMES:
            what = f"the scheme {step.scheme!r}: take one of {', '.join(map(repr, SCHEMES))}"
        elif model.constraints:
            what = "constraints in dynamic steps"
        elif model.contacts or model.ties:
            what = "contact and ties in dynamic steps"
        if what:
            raise UnsupportedError(f"gradients do not include {what}", step.where)


@dataclass
class Rates:
    """Derivatives of measures by what an increment begins with, each shape (n_dofs, m).

    Parameters
    ----------
    u, v, a : ndarray
        By displacement, velocity and acceleration.
    carried : ndarray
        By the acceleration that Newmark's relations continue with.
    """

    u: Floats
    v: Floats
    a: Floats
    carried: Floats
    #: Weights of the equation of the increment after, which starts from the forces of this one.
    weights: Floats | None = None


class Motion:
    """Inertia and damping of a dynamic step, linear in the rates.

    Parameters
    ----------
    system : System
        In this step.
    step : Dynamic

    Raises
    ------
    UnsupportedError
        If they are not linear.
    """

    def __init__(self, system: System, step: Dynamic) -> None:
        self.system, self.step = system, step
        self.inertia = Inertia(system, step.mass)
        what = ""
        if self.inertia.matrix is None:
            what = (
                "the consistent mass of elements with rotations, which depends on the state: take "
                "mass='constant' or 'lumped'"
            )
        elif ViscousElements(system, step.rayleigh[1]).any:
            what = "damping per stiffness"
        elif self.inertia.attached.dampers:
            what = "dashpots"
        elif system.terms[2:-1]:
            what = "user-defined terms, which may depend on velocities"
        if self.inertia.matrix is None or what:
            raise UnsupportedError(f"gradients of dynamic steps do not include {what}", step.where)
        self.mass: Floats = self.inertia.matrix
        self.damping = step.rayleigh[0] * self.mass
        more = mass_damping(system, np.zeros(system.n_dofs), step.mass)
        if more is not None:
            self.damping = self.damping + more
        scheme = SCHEMES[step.scheme](step.alpha, step.rho_inf)
        self.beta, self.gamma = scheme.beta, scheme.gamma
        #: The acceleration of the equation of motion by both filtered ones and its predecessor.
        share = 1.0 - scheme.alpha_f
        self.by_end = (1.0 - scheme.alpha_m) / share
        self.by_begin, self.by_before = scheme.alpha_m / share, -scheme.alpha_f / share
        #: What an increment takes over of the forces out of balance at its start.
        self.begun = scheme.alpha_f / share
        #: Share of the stiffness in the first accelerations, and the force it leaves there.
        self.trace, self.left = 0.0, 0.0
        if system.is_rotation.any():
            first = step.first_increment if step.fixed_increments else step.period
            self.trace = (TRACE * first) ** 2

    def start(self, u: Floats) -> Floats:
        """Velocity at the start of the step."""
        return initial_velocity(self.system, u)

    def drive(self, v: Floats, a: Floats, time: float, dt: float) -> None:
        """Set the rates of prescribed dofs, in place; a `dt` of 0 is the start."""
        step, constrained = self.step, self.system.conditions.constrained
        if not dt:
            whole = not step.fixed_increments and step.first_increment >= step.period
            dt = step.period / 100.0 if whole else step.first_increment
        its_v, its_a = self.system.conditions.supports.rates(time, dt)
        v[constrained], a[constrained] = its_v[constrained], its_a[constrained]

    def add(self, at: Evaluation, u: Floats, v: Floats, a: Floats, start: bool) -> Floats:
        """Add the forces of the rates to an evaluation.

        Returns
        -------
        ndarray, shape (n_dofs,)
            The part of the first accelerations that the equation of motion does not have.
        """
        force = self.system.product(self.mass, a) + self.system.product(self.damping, v)
        more = np.zeros(len(force))
        if start and self.trace:
            tangent = self.system.evaluate(u, 0.0)
            more = self.trace * self.system.product(tangent.values, a)
            self.system.return_tangent(tangent)
            self.left = float(np.abs(more).max(initial=0.0))
        at.internal = at.internal + force + more
        at.scale = at.scale + np.abs(force)
        return more

    def stiffen(self, at: Evaluation, dt: float) -> None:
        """Make a tangent that of an increment, or of the start, which finds accelerations."""
        if not dt:
            at.values *= self.trace
            at.values += self.mass
            at.load_stiffness = None
        else:
            at.values += self.weights(dt)[1] * self.mass + self.weights(dt)[0] * self.damping
        at.inertial_stiffness = 1.0

    def weights(self, dt: float) -> tuple[float, float, float]:
        """Derivatives of velocity and both accelerations by the displacement at the end."""
        carried = 1.0 / (self.beta * dt * dt)
        return self.gamma * dt * carried, self.by_end * carried, carried

    def by_end_state(self, later: Rates, dt: float) -> Floats:
        """Derivative by the displacement at the end of an increment, the others following it.

        At the start it is that by the acceleration.
        """
        if not dt:
            out = later.a + later.carried
            if later.weights is not None:
                out = out + self.begun * self._product(self.mass, later.weights)
            return out
        v, a, carried = self.weights(dt)
        return later.u + v * later.v + a * later.a + carried * later.carried

    def before(self, later: Rates, z: Floats, dt: float) -> Rates:
        """Derivatives by what an increment begins with; prescribed dofs do not depend on it."""
        a = later.a + self._product(self.mass, z)
        v = later.v + self._product(self.damping, z)
        carried = later.carried + dt * self.gamma * v + self.by_end * a
        found = Rates(
            -carried / (self.beta * dt * dt),
            v - carried / (self.beta * dt),
            self.by_before * a,
            (1.0 - 0.5 / self.beta) * carried + dt * (1.0 - self.gamma) * v + self.by_begin * a,
        )
        # z is the weight of the forces out of balance, in this equation and in the next one.
        found.weights = z - self.begun * later.weights if later.weights is not None else z.copy()
        for each in (found.u, found.v, found.a, found.carried, found.weights):
            each[self.system.conditions.constrained] = 0.0
        return found

    def _product(self, matrix: Floats, z: Floats) -> Floats:
        columns = [self.system.product(matrix, np.ascontiguousarray(c)) for c in z.T]
        return np.stack(columns, axis=1)
