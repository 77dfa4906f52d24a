"""Linear transient about a state by superposition of its modes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.evaluation import Evaluation
from corota.analysis.failure import ElementFailure
from corota.analysis.increment_loop import Accepted, IncrementLoop, Stepper
from corota.analysis.procedures.linear_fields import LinearFields
from corota.analysis.procedures.motion_start import initial_velocity
from corota.analysis.procedures.reduced import Patterns, Reduced, last_modes
from corota.analysis.terms.complex_stiffness import relaxing_note

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.state import State
    from corota.analysis.terms.linearized import LinearMotion
    from corota.arrays import Floats
    from corota.model.steps import ModalDynamic


#: Two times closer than this share of the period are the same.
SAME_TIME = 1e-9
#: Share of the start that modes may miss without a note.
LOST = 0.05


def modal_step(loop: IncrementLoop, step: ModalDynamic, stops: list[float]) -> None:
    """Linear transient: exact for loads and moves that vary linearly within an increment.

    It starts from the displacement and velocity of the steps before, or the model's initial
    velocity.

    Raises
    ------
    ModelError
        If there are no modes.
    """
    system, state = loop.system, loop.state
    if note := relaxing_note(system):
        state.notes.append(f"modal step {loop.number}: {note}; a Dynamic step relaxes them")
    loop.run(ModalStepper(loop, step, stops))
    state.recover = None
    leave(system, state, step.period)


class ModalStepper(Stepper):
    """Increments of the modal coordinates, exact for inputs that are linear in time."""

    advice = "allow more (INC=), or take larger increments"

    def __init__(self, loop: IncrementLoop, step: ModalDynamic, stops: list[float]) -> None:
        self.system, self.state, self.step = loop.system, loop.state, step
        system, state, number = loop.system, loop.state, loop.number
        _, lin = last_modes(system, state, step, number)
        self.lin = lin
        self.n = n = max(round(step.period / step.first_increment), 1)
        self.dt = dt = step.period / n
        # Central differences of the last increment that may be taken need those behind it.
        loads, moves = _courses(system, lin, min(n, step.max_increments + 2), dt)
        self.c, self.s = loads.coefficients, moves.coefficients
        self.model = model = Reduced(system, state, step, number, loads.matrix, moves.matrix)
        self.propagator = _advance(model, dt)
        self.slope_s = np.diff(self.s, axis=0) / dt
        self.rates, self.bends = rates_of_moves(self.s, dt)
        start = initial_velocity(system, state.u) if state.v is None else state.v.copy()
        constrained = system.conditions.constrained
        start[constrained] = (moves.matrix @ self.rates[0])[constrained]
        p, v = model.project(state.u - lin.u), model.project(start)
        q = p - model.carried @ self.s[0]
        _tell_lost(system, state, number, state.u - lin.u, model.displacement(q, self.s[0]))
        self.fields = LinearFields(system, lin.u)
        self.x = np.concatenate([p, v])
        grid = [s for s in stops if 0.0 < s < step.period]
        #: Requested times within increments.
        self.between = sorted(
            {s for s in grid if abs(s / dt - round(s / dt)) * dt > SAME_TIME * step.period}
        )

    @property
    def finished(self) -> bool:
        return self.taken >= self.n

    @property
    def where(self) -> str:
        return f"step time {self.taken * self.dt:g} of {self.step.period:g}"

    def advance(self) -> Accepted:
        """Take one increment, or the part of it up to a requested time."""
        system, state, model, lin, dt = self.system, self.state, self.model, self.lin, self.dt
        i = self.taken
        lag = self.between[0] - i * dt if self.between else dt
        slope_c = (self.c[i + 1] - self.c[i]) / dt
        inputs = np.concatenate([self.c[i], self.s[i], slope_c, self.slope_s[i]])
        inside = 0.0 < lag < dt * (1.0 - SAME_TIME)
        propagator = _advance(model, lag) if inside else self.propagator
        x = propagator @ np.concatenate([self.x, inputs])
        if inside:
            self.between.pop(0)
        else:
            self.taken, self.x, lag = i + 1, x, dt
        share, time = lag / dt, i * dt + lag
        c, s, rate, bend = (
            (1.0 - share) * f[i] + share * f[i + 1]
            for f in (self.c, self.s, self.rates, self.bends)
        )
        p, v = np.split(x, 2)
        q, q_rate = p - model.carried @ s, v - model.carried @ rate
        a = model.load @ c - model.stiffness @ q - model.damping @ q_rate - model.dragged @ rate
        z = model.unknowns(q, s)
        change = lin.expand(z)
        state.u = lin.u + change
        state.v = model.displacement(q_rate, rate)
        state.a = model.displacement(a - model.carried @ bend, bend)
        external = system.conditions.external(time, lin.u)[0]
        state.at = linear_evaluation(model, z, state.v, state.a, external)
        state.step_time = time
        state.recover = lambda: self.fields.at(change)
        strain = 0.5 * float(q @ (model.stiffness @ q))
        inertia = lin.mass @ lin.restrict(state.v)
        kinetic = 0.5 * float(lin.restrict(state.v) @ inertia)
        scalars = {"dt": lag, "kinetic energy": kinetic, "modal strain energy": strain}
        if inside:
            scalars["between increments"] = 1.0
        return Accepted(i + 1, time / self.step.period, scalars)


def leave(system: System, state: State, step_time: float) -> None:
    """Give the next step the forces of the system itself, if they exist there."""
    try:
        state.at = system.evaluate(state.u, step_time)
    except ElementFailure:
        # A linear response may be so large that elements fold; what follows will say so.
        state.notes.append("the linear response is too large to evaluate the elements")


def _courses(system: System, lin: LinearMotion, n: int, dt: float) -> tuple[Patterns, Patterns]:
    """Loads and moves of supports at the ends of the first n increments, as few patterns."""
    loads, moves = Patterns(system.n_dofs), Patterns(system.n_dofs)
    conditions = system.conditions
    for i in range(n + 1):
        loads.add(conditions.external(i * dt, lin.u)[0] - lin.at.internal)
        moves.add(
            np.where(conditions.constrained, conditions.supports.at(i * dt, lin.u) - lin.u, 0.0)
        )
    return loads, moves


def rates_of_moves(s: Floats, dt: float) -> tuple[Floats, Floats]:
    """Velocity and acceleration of the supports at the ends of all increments.

    Central differences, and one-sided ones at both ends of the step. Both are of second order
    in the increment, as those that direct integration takes (:meth:`Amplitude.derivatives`).

    Parameters
    ----------
    s : ndarray, shape (n + 1, ns)
        Coefficients of the moves [length].
    dt : float
        Increment [time].

    Returns
    -------
    rates, bends : ndarray, shape (n + 1, ns)
    """
    n = len(s) - 1
    rates: Floats = np.gradient(s, dt, axis=0, edge_order=2 if n > 1 else 1)
    bends = np.zeros_like(s)
    if n > 1:
        bends[1:-1] = np.diff(s, 2, axis=0) / dt**2
        # Two increments have but one second difference.
        bends[0], bends[-1] = bends[1], bends[-2]
    if n > 2:
        bends[0], bends[-1] = 2.0 * bends[1] - bends[2], 2.0 * bends[-2] - bends[-3]
    return rates, bends


def _advance(model: Reduced, dt: float) -> Floats:
    """Exact step of (p, p') for inputs (loads, moves) that are linear in time.

    Returns
    -------
    ndarray, shape (2 m, 2 m + 2 k)
        On (p, p', inputs at the start, their rates).
    """
    from scipy.linalg import expm

    m, nf, ns = len(model.stiffness), model.load.shape[1], model.static.shape[1]
    k = nf + ns
    a = np.zeros((2 * m + 2 * k, 2 * m + 2 * k))
    a[:m, m : 2 * m] = np.eye(m)
    a[m : 2 * m, :m] = -model.stiffness
    a[m : 2 * m, m : 2 * m] = -model.damping
    a[m : 2 * m, 2 * m : 2 * m + nf] = model.load
    a[m : 2 * m, 2 * m + nf : 2 * m + k] = model.stiffness @ model.carried
    a[m : 2 * m, 2 * m + k + nf :] = model.damping @ model.carried - model.dragged
    a[2 * m : 2 * m + k, 2 * m + k :] = np.eye(k)
    return expm(dt * a)[: 2 * m]


def linear_evaluation(
    model: Reduced, z: Floats, v: Floats, a: Floats, external: Floats
) -> Evaluation:
    """Forces of the linear response; supports carry what is left, and nothing else does.

    Parameters
    ----------
    z : ndarray, shape (n_unknowns,)
        Change of the dofs, with the multipliers of contact and ties.
    """
    lin, step = model.lin, model.step
    forces = (
        lin.stiffness @ z
        + lin.damping(step.rayleigh) @ lin.restrict(v)
        + lin.mass @ lin.restrict(a)
    )
    return supported(lin, forces, external)


def supported(lin: LinearMotion, forces: Floats, external: Floats) -> Evaluation:
    """An evaluation whose residual is the reaction of the prescribed dofs alone.

    Parameters
    ----------
    forces : ndarray, shape (n_unknowns,)
        Stiffness, damping and inertia of the response.
    external : ndarray, shape (n_dofs,)
    """
    system = lin.system
    base = lin.at.internal - external
    reaction = np.array(lin.link.gather(base))
    reaction[lin.free] += forces[: lin.nf]
    # Closed surfaces and ties pass on what reaches them.
    reaction[lin.free] += lin.tractions(reaction[lin.free])
    internal = external + np.where(system.conditions.constrained, reaction, 0.0)
    return Evaluation(internal, external, np.abs(internal), system.pattern.zeros())


def _tell_lost(system: System, state: State, number: int, start: Floats, kept: Floats) -> None:
    """Note where the modes cannot hold the displacement that the step starts from."""
    counted = system.counted
    size = float(np.abs(start[counted]).max(initial=0.0))
    lost = float(np.abs((start - kept)[counted]).max(initial=0.0))
    if size > 0.0 and lost > LOST * size:
        state.notes.append(
            f"the modes hold all but {lost / size:.0%} of the displacement that step {number} "
            "starts from: request more modes"
        )
