"""A dynamic step: increments of a time scheme until the end of the step."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import warnings
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.energies import Balance
from corota.analysis.increment_loop import (
    Accepted,
    Attempt,
    IncrementLoop,
    NewtonStepper,
    solve_increment,
)
from corota.analysis.increments import CUT, SAME
from corota.analysis.newton import Settings
from corota.analysis.procedures.explicit import explicit_step
from corota.analysis.procedures.free_flight import FreeFlight, deformation, rigid_rates
from corota.analysis.procedures.motion import ConservingMotion, Driven, EndForces, NewmarkMotion
from corota.analysis.procedures.motion_start import (
    admissible_velocity,
    check_density,
    resting,
    start_motion,
)
from corota.analysis.terms.contact.motion import Approach
from corota.analysis.terms.contact.relaxation import relax
from corota.analysis.terms.damping import Damping
from corota.analysis.terms.inertia import Inertia, MotionState
from corota.analysis.terms.redistribution import massless_nodes
from corota.analysis.terms.viscous import ViscousElements
from corota.model import elements
from corota.model.schemes import SCHEMES

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.state import State
    from corota.arrays import Bools, Floats
    from corota.model.loads import Amplitude
    from corota.model.steps import Dynamic


#: An automatic increment aims at this share of the allowed local error.
AIM = 0.7
#: Increments that a wave of a load needs at least, and those that follow it well.
LEAST_PER_WAVE, PER_WAVE = 4.0, 20.0
#: Displacements below this share of the model's radius are as good as none.
REST = 2e-5
#: Automatic increments may miss the straight line of an amplitude by this share of its size.
LOAD_ERROR = 0.05
#: It shrinks or grows at most by these factors.
LEAST, MOST = 0.25, 1.5


def dynamic_step(loop: IncrementLoop, step: Dynamic, stops: list[float]) -> None:
    """Run a dynamic step from the committed state.

    Raises
    ------
    ModelError
        If a material has no density.
    ConvergenceError
        With the reason, when no smaller increment helps.
    """
    system, state = loop.system, loop.state
    check_density(system)
    if step.scheme == "central_difference":
        explicit_step(loop, step, stops)
        return
    warn_of_long_increments(system, step, state)
    stepper = DynamicStepper(loop, step, stops)
    loop.run(stepper)
    if step.scheme == "energy_momentum" and state.v is not None:
        state.carried = (state.u, state.v, stepper.now.v)
    state.reaction = None
    # A static step that follows needs the static equation at this displacement.
    state.at = system.evaluate(state.u, step.period)


class DynamicStepper(NewtonStepper):
    """Increments of an implicit time scheme."""

    kind = "dynamic"
    remembered = ("control", "energy_balance", "ends", "approach", "now", "removed_turns")

    def __init__(self, loop: IncrementLoop, step: Dynamic, stops: list[float]) -> None:
        super().__init__(loop, step, stops)
        self.step = step
        system, state, control = self.system, self.state, self.control
        self.inertia = Inertia(system, step.mass, massless_nodes(system, step.redistribute))
        if self.inertia.remark and self.inertia.remark not in state.notes:
            state.notes.append(self.inertia.remark)
        self.viscous = ViscousElements(system, step.rayleigh[1])
        self.flight = FreeFlight(system)
        self.approach = Approach(system, self.inertia.massless)
        resumes = bool(state.resumes)
        self.now = (
            resting(system)
            if resumes
            else start_motion(system, step, state, self.inertia, self.viscous)
        )
        self.energy_balance = Balance(system, step, self.now, self.inertia, state.energies)
        self.ends = EndForces(system)
        if not step.fixed_increments and step.first_increment >= step.period:
            control.size = step.period / 100.0
        again = system.correct_with_last_factor
        self.settings = Settings(step.tolerance, step.max_iterations, again)
        #: Whole turns that were taken off the rotations [rad].
        self.removed_turns: Floats | float = 0.0
        #: Of the last attempt: its motion, and its local error over the allowed one.
        self.motion: NewmarkMotion | ConservingMotion
        self.error = 0.0
        if resumes:
            self.resume()
            return
        now = self.now
        scalars: dict[str, float] = {}
        self.ends.start(now, system.multiplier_force())
        state.u, state.v, state.a = now.u, now.v, now.a
        state.at, state.reaction = self.ends.at, self.ends.reaction
        self.energy_balance.add_to(scalars)
        loop.show_start(scalars)

    @cached_property
    def _judged(self) -> tuple[Bools, Bools, Bools]:
        """Dofs without a local error, nodes with one, and nodes whose motion it is relative to."""
        system, massless = self.system, self.inertia.massless
        known = massless | system.conditions.constrained
        there = system.per_node > 0
        moves = system.by_node((~known & ~system.is_rotation).astype(float))[:, :2].any(axis=1)
        counts = ~system.by_node(massless.astype(float))[:, :2].any(axis=1)
        return known, there & moves, there & counts

    def target(self) -> float:
        target = super().target()
        if self.step.fixed_increments:
            return target
        target = _not_over_a_load(self.system, self.step, self.control.time, target)
        dt = target - self.control.time
        within = self.approach.within(self.now, dt, self.step.smallest_increment)
        return target if within >= dt else self.control.time + within

    def solve(self, target: float) -> Attempt:
        """Newton's method; automatic increments are refused where the local error is too large."""
        system, step, now = self.system, self.step, self.now
        dt = target - self.control.time
        guess = self.flight.guess(now.u, now.v, dt)
        prescribed = system.conditions.supports.at(target, guess)
        driven = _driven(system, prescribed, target, dt)
        self.motion = _motion(system, step, self.inertia, now, dt, driven, self.viscous)
        outcome, contact = solve_increment(
            system,
            guess,
            prescribed,
            target,
            self.settings,
            self.report,
            last_chance=step.fixed_increments,
            rule=self.motion,
        )
        reason = "" if outcome.converged else outcome.reason or "no convergence"
        self.error = 0.0
        if outcome.converged and not step.fixed_increments:
            self.error = _local_error(system, self.motion, step, *self._judged)
            # What no increment is short enough for is taken as it is.
            shorter = CUT * dt >= step.smallest_increment
            if shorter:
                begin, end, energy_balance = self.motion.start, self.motion.end, self.energy_balance
                energy = max(energy_balance.energy, energy_balance.driven(end))
                missed = self.approach.impact_error(
                    contact.contact_state, end.u - begin.u, energy, step.error_tolerance
                )
                self.error = max(self.error, missed)
            if self.error > 1.0 and CUT * dt >= self.control.shortest:
                reason = f"local error {self.error:.2g} times the allowed one"
        return Attempt(target, outcome, contact, reason)

    def _note_error(self) -> None:
        """Tell once that the increments are too long for the motion."""
        begin = f"step {self.loop.number} takes longer increments than the motion needs"
        if any(note.startswith(begin) for note in self.state.notes):
            return
        note = (
            f"{begin}: at {self.where} the local error is {self.error:.2g} times the allowed one; "
            "allow more increments (INC=) or shorter ones, or ramp what acts at once"
        )
        self.state.notes.append(note)
        warnings.warn(note, stacklevel=2)

    def rescue(self, failed: Attempt, end: str) -> Attempt | None:
        """The increment by relaxation, where contact stops it and none shorter may be tried."""
        system = self.system
        if not end or not system.joined or failed.outcome.converged:
            return None
        target = failed.target
        guess = self.now.u
        prescribed = system.conditions.supports.at(target, guess)
        outcome, contact = relax(
            system, guess, prescribed, target, self.settings, self.report, self.motion
        )
        if outcome.converged:
            return Attempt(target, outcome, contact)
        failed.reason += f"; {outcome.reason}"
        return None

    def refusal(self, failed: Attempt, end: str) -> str:
        return (
            f"step {self.loop.number} stopped at {self.where}: {end}; last attempt: "
            f"{failed.reason}. All converged increments are kept"
        )

    def accept(self, attempt: Attempt) -> Accepted:
        """Commit an increment; automatic ones take their next size from its local error."""
        system, state, step, control = self.system, self.state, self.step, self.control
        outcome, contact, target, motion = (
            attempt.outcome,
            attempt.contact,
            attempt.target,
            self.motion,
        )
        assert contact is not None
        dt = target - control.time
        # An increment that meets a surface is short for that alone.
        size = control.size if self.approach.limited else dt
        self.approach.follow(self.now.u, motion.end.u, dt)
        system.commit()
        self.inertia.settle(self.now, motion.end, dt)
        state.notes += contact.accept(outcome.u, target)
        self.energy_balance.accept(motion, contact.force)
        now = self.now = motion.end
        self.ends.find(motion, contact.force, target)
        state.u, state.v, state.a = now.u + self.removed_turns, now.v, now.a
        if step.scheme == "energy_momentum":
            state.v = admissible_velocity(system, step, self.inertia, now, target)
        if (more := _whole_turns(system, now.u)) is not None:
            now.u = now.u - more
            self.removed_turns = self.removed_turns + more
        state.at, state.reaction = self.ends.at, self.ends.reaction
        state.step_time = target
        attempts = control.attempt
        control.accept(target, outcome.iterations)
        if not step.fixed_increments:
            grown = AIM * dt * math.sqrt(1.0 / max(self.error, 1e-6))
            size = max(min(max(grown, LEAST * size), MOST * size), self.control.shortest)
            control.size = min(size, step.largest_increment)
            if self.error > 1.0 and not system.opens:
                self._note_error()
        scalars = {
            "dt": dt,
            "iterations": float(outcome.iterations),
            "attempts": float(attempts),
            "residual": outcome.sizes[-1],
            "external work": self.energy_balance.external,
        }
        self.energy_balance.add_to(scalars)
        return Accepted(control.number, target / step.period, scalars)


def _whole_turns(system: System, u: Floats) -> Floats | None:
    """Whole turns that all rotations have made, or None; what is computed is the same without.

    Rotations of many turns are rounded accordingly, and momenta with them. Line elements,
    supports and constraints may know the number of turns.
    """
    mask = system.is_rotation
    known = system.link.couples or system.joined
    if known or not (mask.any() and system.nlgeom):
        return None
    turns = np.round(float(u[mask].mean()) / (2.0 * np.pi))
    lines = any(elements.find(b.section.element).line for b in system.blocks)
    if turns == 0.0 or lines or system.conditions.constrained[mask].any():
        return None
    return np.where(mask, 2.0 * np.pi * turns, 0.0)


def warn_of_long_increments(system: System, step: Dynamic, state: State) -> None:
    """Warn where a fixed increment steps over a load's wave; names the increment to use.

    The period of an amplitude is twice the shortest time between its turning points.
    """
    if not step.fixed_increments:
        return
    for name, amplitude in _amplitudes(system, step):
        slope = np.diff(amplitude.value)
        moving = np.flatnonzero(slope)
        turns = moving[1:][np.sign(slope[moving[1:]]) != np.sign(slope[moving[:-1]])]
        if len(turns) < 2:
            continue
        wave = 2.0 * float(np.diff(amplitude.time[turns]).min())
        if step.first_increment > wave / LEAST_PER_WAVE:
            note = (
                f"the increment {step.first_increment:g} is long for the amplitude {name!r}, which "
                f"has a period of {wave:.3g}: use at most {wave / PER_WAVE:.2g}"
            )
            state.notes.append(note)
            warnings.warn(note, stacklevel=2)


def _amplitudes(system: System, step: Dynamic) -> list[tuple[str, Amplitude]]:
    model = system.model
    items = [*model.loads, *model.supports, *step.loads, *step.supports]
    names = sorted({item.amplitude for item in items if item.amplitude})
    return [(name, model.amplitudes[name]) for name in names]


def _not_over_a_load(system: System, step: Dynamic, time: float, target: float) -> float:
    """The target, or an earlier point of an amplitude that an increment would step over.

    Between both ends of an increment the schemes see a straight line. A body at rest has no
    local error: its increments grow, and a pulse could pass between two of them.
    """
    for _, amplitude in _amplitudes(system, step):
        start = system.conditions.factors.time if amplitude.total_time else 0.0
        points = np.asarray(amplitude.time) - start
        inside = points[(points > time + SAME * step.period) & (points < target)]
        ends = np.array([amplitude(start + t) for t in (time, target)])
        size = np.abs(amplitude.value).max()
        for point in inside:
            line = np.interp(point, (time, target), ends)
            if abs(amplitude(start + point) - line) > LOAD_ERROR * size:
                target = float(inside[0])
                break
    return target


def _motion(
    system: System,
    step: Dynamic,
    inertia: Inertia,
    now: MotionState,
    dt: float,
    driven: Driven,
    viscous: ViscousElements,
) -> NewmarkMotion | ConservingMotion:
    damping = Damping(inertia, step.rayleigh[0], viscous, now.u)
    if step.scheme == "energy_momentum":
        return ConservingMotion(system, inertia, now, dt, driven, damping)
    scheme = SCHEMES[step.scheme](step.alpha, step.rho_inf)
    return NewmarkMotion(system, inertia, scheme, now, dt, driven, damping)


def _driven(system: System, prescribed: Floats, time: float, dt: float) -> Driven:
    """Motion that the step prescribes at a time, also of dependents of constrained dofs only."""
    conditions, constraints = system.conditions, system.constraints
    constrained = conditions.constrained
    v, a = conditions.supports.rates(time, dt)
    if not (len(constraints.dependent) and constrained.any()):
        return Driven(constrained, prescribed, v, a)
    u = prescribed.copy()
    constraints.complete(u)
    constraints.complete_rates(u, v, a)
    free = abs(constraints.link(u).g) @ (~constrained).astype(float)
    constrained = constrained.copy()
    constrained[constraints.dependent[free == 0.0]] = True
    return Driven(constrained, u, v, a)


def _local_error(
    system: System,
    motion: NewmarkMotion | ConservingMotion,
    step: Dynamic,
    known: Bools,
    moves: Bools,
    counts: Bools,
) -> float:
    """Local error of displacement over the allowed one (Zienkiewicz & Xie 1991).

    Two measures that a uniform velocity does not change: the error of the rigid motion, relative
    to displacements less the mean one, and what else there is, relative to the deformation.
    Prescribed dofs have no error.
    """
    begin, end, dt = motion.start, motion.end, motion.dt
    beta = motion.scheme.beta if isinstance(motion, NewmarkMotion) else 0.25
    before, after = (m.a if m.carried is None else m.carried for m in (begin, end))
    change = system.by_node(np.where(known, 0.0, after - before))[:, :2]
    if not moves.any():
        return 0.0
    reference = system.model.mesh.points
    x = reference + system.by_node(end.u)[:, :2]
    v = system.by_node(end.v)[:, :2]
    rigid = rigid_rates(x[moves], change[moves])
    other = change[moves] - rigid
    travel, speed = x[counts] - reference[counts], v[counts]
    least = REST * _largest(reference[counts] - reference[counts].mean(axis=0))
    if least > 0.0:  # nodes at one place move against the ground
        travel, speed = travel - travel.mean(axis=0), speed - speed.mean(axis=0)
    strain = deformation(reference[counts], x[counts], system.nlgeom)
    rate = v[counts] - rigid_rates(x[counts], v[counts])
    worst = 0.0
    pairs = ((rigid, travel, speed), (other, strain, rate))
    for wrong, moved, moving in pairs:
        size = max(_largest(moved), dt * _largest(moving), least)
        worst = max(worst, _largest(wrong) / size if size else 0.0)
    # No increment is short enough for the relative error of a motion out of rest.
    return abs(beta - 1.0 / 6.0) * dt * dt * worst / step.error_tolerance


def _largest(vectors: Floats) -> float:
    """Largest length of the vectors of nodes, whatever the axes."""
    return float(np.hypot(*vectors.T).max())
