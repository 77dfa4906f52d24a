"""A static step: increments of Newton's method until the end of the step."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import math
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure
from corota.analysis.increment_loop import (
    Accepted,
    Attempt,
    IncrementLoop,
    NewtonStepper,
    solve_increment,
)
from corota.analysis.increments import CUT, SAME
from corota.analysis.newton import Outcome, ResidualNorms, Settings
from corota.analysis.procedures.carried_bodies import carried_bodies
from corota.errors import ConvergenceError, ModelError, SingularError
from corota.lazy import lazy
from corota.model.material_table import MaterialTable
from corota.model.viscoelastic import Viscoelastic

if TYPE_CHECKING:
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.increment_loop import ContactIncrement, Report
    from corota.analysis.state import State
    from corota.analysis.terms.contact.equations import ContactEquations
    from corota.arrays import Floats
    from corota.model.materials import Material
    from corota.model.steps import Static


# What a step without difficulties does not need.
at_limit = lazy("corota.analysis.procedures.stopping:at_limit")
collapse = lazy("corota.analysis.procedures.stopping:collapse")
relax = lazy("corota.analysis.terms.contact.relaxation:relax")
driven = lazy("corota.analysis.procedures.stopping:driven")
explanation = lazy("corota.analysis.procedures.stopping:explanation")
passed = lazy("corota.analysis.procedures.stopping:passed")
unstable = lazy("corota.analysis.procedures.stopping:unstable")
remedies = lazy("corota.analysis.procedures.stopping:remedies")
path_step = lazy("corota.analysis.procedures.path.arc_length:path_step")
path_stepper = lazy("corota.analysis.procedures.path.arc_length:PathStepper")
by_relaxation = lazy("corota.analysis.procedures.static_relaxation:by_relaxation")

#: Failed attempts with increasing negative pivots before a limit point is searched.
STALLED = 3
#: Residual after a first iteration with the elastic tangent up to which an increment unloads.
ELASTIC = 0.01
#: Change of a force, relative to the largest, that is none.
UNCHANGED = 1e-9
#: Error of the creep strain in an increment over the largest elastic strain, by default.
CREEP_ERROR = 0.003
#: Share of the increment that would have the allowed error of creep, and limits of its change.
CREEP_SAFETY, LEAST_SHARE, MOST_GROWTH = 0.9, 1e-3, 4.0
#: Growth of the rate of displacements over the slowest one that is creep without end.
RUNAWAY = 10.0
#: Error over the allowed one that is none, and one that gives a note.
LEAST_EXCESS, MUCH_EXCESS = 1e-12, 10.0
#: Note of the iterations of such an attempt.
UNLOADING = "line search from the elastic tangent"
#: And of those that begin with bodies turned by their supports.
TURNED = "bodies turned with their supports"


def static_step(loop: IncrementLoop, step: Static, stops: list[float]) -> None:
    """Run a static step from the committed state.

    Raises
    ------
    ConvergenceError
        With the reason, when no smaller increment helps.
    SingularError
        If the structure is not constrained.
    """
    state = loop.state
    if not state.resumes:
        state.step_time = 0.0
        state.stand_still()
    if step.path is not None:
        path_step(loop, step.path)
        return
    stepper = StaticStepper(loop, step, stops)
    if state.resumes == "path":
        stepper.go_along_path()
        return
    if state.resumes:
        stepper.resume()
    loop.run(stepper)


class StaticStepper(NewtonStepper):
    """Increments of load control."""

    kind = "static"
    remembered = ("control", "rates", "moved", "creep_error", "creep_excess", "elastic")

    def __init__(self, loop: IncrementLoop, step: Static, stops: list[float]) -> None:
        super().__init__(loop, step, stops)
        self.step = step
        self.settings = Settings(step.tolerance, step.max_iterations)
        #: Displacement per time, of the first increment (of creep: the slowest) and the last.
        self.rates = (0.0, 0.0)
        #: Displacement over the last increment, if any material remembers it.
        self.moved: np.ndarray[tuple[int], np.dtype[np.float64]] | None = None
        #: Growth of the plastic strain in the last attempt.
        self.grown = 0.0
        #: Largest error of the creep strain that is allowed, if any; none: by the elastic strain.
        self.creep_tolerance: float | None = getattr(step, "creep_tolerance", 0.0)
        if step.fixed_increments:
            self.creep_tolerance = self.creep_tolerance or 0.0
        #: Error of the creep strain in the last attempt, and over the allowed one.
        self.erred, self.excess = 0.0, 0.0
        #: The largest error of the increments so far, and over the allowed one.
        self.creep_error, self.creep_excess = 0.0, 0.0
        self.path_took_over = False
        #: Step times between which the last attempt lost stability.
        self.passed: tuple[float, float] | None = None
        #: Whether a warning said that the equilibrium is unstable.
        self.warned = False
        #: Where and why load control stalled.
        self.stalled = ""
        blocks = loop.system.blocks
        #: Whether the stress of any material depends on the strain path.
        self.remembers = any(block.section.material.remembers for block in blocks)
        #: Whether the error of creep is compared to elastic strains, and the largest of these.
        self.measures = self.creep_tolerance is None and any(
            _creeps(_law(block.section.material)) for block in blocks
        )
        self.elastic = 0.0
        self.creeps = step.lasting and loop.system.creeps
        if self.measures and not self.state.resumes:
            self.measure_creep()

    @property
    def finished(self) -> bool:
        """Whether the step is at its end, by load control or along its path."""
        return self.path_took_over or super().finished

    # -- attempts ----------------------------------------------------------------------

    def solve(self, target: float) -> Attempt:
        """Newton's method, and reasons to refuse an equilibrium state."""
        system, state, step = self.system, self.state, self.step
        known = self.known(target)
        may_unload = self.remembers and self.control.attempt == 1
        turns = may_unload and self.load_may_turn(target)
        contact: ContactIncrement | None = None
        outcome = Outcome(False, state.u, None, reason="not begun")
        before = 0
        if step.nlgeom:
            prescribed = system.conditions.supports.at(target, state.u)
            carried = carried_bodies(system, state.u, prescribed)
            if carried is not None:
                outcome, contact = self.equilibrium(target, None, begin=carried)
                before = outcome.iterations
        if turns and outcome.reason:
            # The first correction with the tangent of flow would lead far away, and from there to
            # another equilibrium path.
            outcome, contact = self.equilibrium(target, None, ELASTIC, before)
            outcome.iterations += before
            before = outcome.iterations
        if outcome.reason:
            outcome, contact = self.equilibrium(target, known, before=before)
            outcome.iterations += before
        if outcome.reason and may_unload:
            # While the load grows and an increment can be cut, only elastic unloading is worth a
            # second attempt: a long increment of a softening body may end on another equilibrium
            # path.
            first = math.inf if turns or step.fixed_increments else ELASTIC
            again, its_contact = self.equilibrium(target, None, first, outcome.iterations)
            if again.reason:
                outcome.iterations += again.iterations
            else:
                again.iterations += outcome.iterations
                outcome, contact = again, its_contact
        self.grown = self.erred = self.excess = 0.0
        share = CUT
        if outcome.converged and not outcome.reason and step.lasting:
            outcome.reason, share = self.check_creep(target)
        if outcome.converged and not outcome.reason and step.plastic_increment:
            self.grown = system.elements.plastic_increment()
            if self.grown > step.plastic_increment:
                outcome.reason = (
                    f"the equivalent plastic strain grew by {self.grown:.3g}, "
                    f"{step.plastic_increment:g} is allowed in one increment"
                )
        if outcome.converged and not outcome.reason:
            self.check_stability(outcome, target)
        outcome.converged = outcome.converged and not outcome.reason
        reason = "" if outcome.converged else outcome.reason or "no convergence"
        return Attempt(target, outcome, contact, reason, share)

    def check_creep(self, target: float) -> tuple[str, float]:
        """Why the increment is too long for creep, if it is, and the share of it to try next.

        The default tolerance does not cut what would leave too few increments for the step.
        """
        self.erred = self.system.elements.creep_error()
        allowed, control = self.creep_tolerance, self.control
        if allowed is None:
            allowed = CREEP_ERROR * self.elastic
        if not allowed:
            return "", CUT
        self.excess = max(self.erred / allowed, LEAST_EXCESS)
        dt = target - control.time
        least = control.shortest if self.creep_tolerance is None else 0.0
        if self.excess <= 1.0 or dt <= least * (1.0 + SAME):
            return "", CUT
        share = max(CREEP_SAFETY / math.sqrt(self.excess), LEAST_SHARE, least / dt)
        return (
            f"the creep strain of the increment has an error of {self.erred:.3g}, "
            f"{allowed:.3g} is allowed"
        ), share

    def measure_creep(self) -> None:
        """Find the strain of the committed state to which errors of creep are compared.

        It is the elastic one, where stress relaxes the whole: a body that recovers has no stress.
        """
        system = self.system
        fields, _ = system.recover(self.state.u)
        self.elastic = 0.0
        for block, found in zip(system.own_blocks, fields, strict=True):
            material = _law(block.section.material)
            if not _creeps(material):
                continue
            if isinstance(material, Viscoelastic):
                strain = float(np.abs(found.values["E"]).max(initial=0.0))
            else:
                stress = found.values["S"]
                mean = stress[..., :3].mean(axis=-1, keepdims=True)
                square = np.sum((stress[..., :3] - mean) ** 2, axis=-1) + 2.0 * stress[..., 3] ** 2
                soft = float(material.compliance()[0, 0])
                strain = soft * math.sqrt(1.5 * float(square.max(initial=0.0)))
            self.elastic = max(self.elastic, strain)
        self.elastic = system.communicator.greatest(self.elastic)

    def target(self) -> float:
        """Target step time of the next attempt [time]; short where creep begins without stress."""
        control = self.control
        if self.measures and not self.elastic and control.number == 0:
            control.size = min(control.size, self.step.smallest_increment)
        return super().target()

    def known(self, target: float) -> Evaluation | None:
        """The evaluation of the committed state, if its force is that at another time as well.

        Of laws that may depend on time this is tried: a committed state of flow without rates is
        on its yield surface, where an evaluation has the elastic tangent.
        """
        system, state = self.system, self.state
        if state.at is None or system.holds(target):
            return state.at
        with contextlib.suppress(ElementFailure):  # which Newton's method reports
            change = np.abs(system.forces(state.u, target).internal - state.at.internal)
            if change.max(initial=0.0) <= UNCHANGED * state.at.scale.max(initial=0.0):
                return state.at
        return None

    def load_may_turn(self, target: float) -> bool:
        """Whether the change of the load works against the last increment.

        Of the first increment of a later step it is not known.
        """
        if self.moved is None:
            return self.loop.number > 1
        conditions, u = self.system.conditions, self.state.u
        now, then = (conditions.external(t, u)[0] for t in (self.control.time, target))
        return bool((then - now) @ self.moved < 0.0)

    def check_stability(self, outcome: Outcome, target: float) -> None:
        """Refuse an unstable equilibrium behind a stable one, unless the step only warns of it.

        The inertia is that of the last tangent of Newton's method, which belongs to the iterate
        before. After one iteration that is the start, and a negative pivot may come from an iterate
        far from the equilibrium. Then the tangent of the end is factorized too.
        """
        system, step = self.system, self.step
        suspected = outcome.iterations == 1 or outcome.negative > 0 >= self.state.negative
        if suspected and step.nlgeom and not system.joined:
            try:
                still = np.zeros(system.n_dofs)
                _, outcome.negative = system.predict(system.evaluate(outcome.u, target), still)
            except SingularError:
                outcome.negative = 1  # at a critical point
        if outcome.negative > 0 >= self.state.negative and step.at_bifurcation != "warn":
            self.passed = (self.control.time, target)
            outcome.reason = passed(self.loop.number, self.passed, outcome.negative)
        elif self.creeps:
            # Where creep accelerates without end, a long increment may find an equilibrium behind
            # the end: that of a bar which has turned round.
            moved = float(np.abs(outcome.u - self.state.u).max(initial=0.0))
            slowest = self.rates[0] * (target - self.control.time)
            if moved > system.length and 0.0 < RUNAWAY * slowest < moved:
                outcome.reason = "the creep of the increment has no bound"

    def equilibrium(
        self,
        target: float,
        known: Evaluation | None,
        first: float | None = None,
        before: int = 0,
        begin: Floats | None = None,
    ) -> tuple[Outcome, ContactIncrement | None]:
        """Newton's method from the committed state.

        Parameters
        ----------
        target : float
            Step time at the end of the increment [time].
        known : Evaluation or None
            At that state, with the tangent of the first iteration; None for that of unloading.
        first : float, optional
            Residual after the first iteration up to which an attempt with line search goes on;
            without one there is no line search.
        before : int, optional
            Iterations of the attempts before, for the log.
        begin : ndarray, shape (n_dofs,), optional
            First iterate, in place of that state.

        Returns
        -------
        outcome : Outcome
            With a reason if it is no acceptable equilibrium.
        contact : ContactIncrement or None
            None where nothing was solved.

        Notes
        -----
        After plastic flow the tangent of the last iteration is that of further loading. When the
        load of a body that flows everywhere turns, it is far too soft, and the first correction far
        too large. A committed state is on the yield surface and has the elastic tangent.
        """
        system, state = self.system, self.state
        settings, report, contact = self.settings, self.report, None
        self.passed = None
        begin = state.u if begin is None else begin
        if first is not None:
            settings = replace(settings, search=True, first=first)
        if first is not None or before or begin is not state.u:
            how = TURNED if begin is not state.u else UNLOADING if first is not None else ""
            report = _continued(report, before, how)
        try:
            outcome, contact = solve_increment(
                system,
                begin,
                system.conditions.supports.at(target, begin),
                target,
                settings,
                report,
                known=known,
                last_chance=self.step.fixed_increments,
            )
        except SingularError as error:
            if self.loop.number == 1 and self.control.number == 0:
                raise
            outcome = Outcome(False, state.u, None, reason=f"the tangent is singular: {error}")
        if outcome.converged:
            outcome.reason = system.scales.implausible_displacement(outcome.u, begin)
        elif not outcome.reason:
            outcome.reason = "no convergence"
        return outcome, contact

    def relax(self, target: float, nearby: bool) -> tuple[Outcome, ContactEquations]:
        """An increment to a step time from the committed state by relaxation; see `relax`."""
        system, u = self.system, self.state.u
        prescribed = system.conditions.supports.at(target, u)
        found: tuple[Outcome, ContactEquations] = relax(
            system,
            u,
            prescribed,
            target,
            self.settings,
            self.report,
            nearby=nearby,
        )
        return found

    def rescue(self, failed: Attempt, end: str) -> Attempt | None:
        """The increment by relaxation, or the rest of the step along the path."""
        control, outcome = self.control, failed.outcome
        if self.passed is not None:
            if self.step.at_bifurcation == "follow" and not self.step.fixed_increments:
                self.path_took_over = self.go_along_path(switch=True)
            return None
        if end:
            relaxed = by_relaxation(self)
            if isinstance(relaxed, Attempt):
                return relaxed
            outcome.reason += relaxed
        softer = outcome.negative > max(self.state.negative, 0)
        # A snap under moving supports is solved by relaxation, once no increment is short enough.
        softer = softer and not (self.step.at_limit == "stop" and self.may_relax())
        fixed = self.step.fixed_increments and self.step.at_limit == "stop"
        if not fixed and (end or (softer and control.attempt > STALLED)):
            where = control.time / self.step.period
            self.stalled = f". Load control stalled at load factor {where:.6g}: {outcome.reason}"
            self.path_took_over = self.go_along_path()
        return None

    def refusal(self, failed: Attempt, end: str) -> str:
        if self.passed is not None:
            return (
                f"{passed(self.loop.number, self.passed, failed.outcome.negative)}. All increments "
                "before are kept; to continue, "
                f"{remedies(driven(self.system, self.step, self.state))}"
            )
        text: str = explanation(
            self.system,
            self.loop.number,
            self.control,
            failed.outcome,
            self.state,
            end,
            self.rates,
        )
        return text

    def accept(self, attempt: Attempt) -> Accepted:
        system, state, control, outcome = self.system, self.state, self.control, attempt.outcome
        assert attempt.contact is not None
        assert outcome.at is not None
        state.notes += attempt.contact.accept(outcome.u, attempt.target)
        dt = attempt.target - control.time
        moved = outcome.u - state.u
        rate = float(np.abs(moved).max(initial=0.0)) / dt
        slowest = min(self.rates[0] or rate, rate) if self.creeps else self.rates[0] or rate
        self.rates = slowest, rate
        self.moved = moved if self.remembers else None
        state.energies.add_quasi_static(outcome.u, state.u, outcome.at)
        if state.at is not None:
            system.return_tangent(state.at)
        system.commit()
        state.u, state.at, state.failed = outcome.u, outcome.at, None
        state.step_time = attempt.target
        if outcome.negative > 0 >= state.negative:
            between = (attempt.target - dt, attempt.target)
            text = (
                f"increment {control.number + 1}: "
                + passed(self.loop.number, between, outcome.negative)
                + ". From here on the equilibrium is unstable: a real structure snaps or buckles. "
                "at_bifurcation='stop' or 'follow', path=ArcLength() or DisplacementControl(...) "
                "find the stable path; 'stable' in the history marks the stable frames"
            )
            if not self.warned:
                warnings.warn(text, stacklevel=2)
                self.warned = True
            state.notes.append(text)
        state.negative = outcome.negative
        attempts = control.attempt
        control.accept(attempt.target, outcome.iterations)
        if self.grown > 0.0 and not self.step.fixed_increments:
            control.size = min(control.size, dt * self.step.plastic_increment / self.grown)
        self.creep_error = max(self.creep_error, self.erred)
        if control.number > 1:  # what acts at once has no error
            self.creep_excess = max(self.creep_excess, self.excess)
        if self.creep_error and self.finished:
            state.notes += self.creep_notes()
        if self.measures and not self.finished:
            self.measure_creep()
        if self.excess and not self.step.fixed_increments:
            # The error grows with the square of the increment.
            factor = min(MOST_GROWTH, CREEP_SAFETY / math.sqrt(self.excess))
            least = control.shortest if self.measures else 0.0
            size = min(max(dt * factor, least), self.step.largest_increment)
            control.size = size if not self.grown else min(size, control.size)
        scalars: dict[str, float] = {
            "dt": dt,
            "iterations": float(outcome.iterations),
            "attempts": float(attempts),
            "residual": outcome.sizes[-1],
            "external work": state.energies.work,
        }
        if outcome.negative >= 0:
            scalars["negative pivots"] = float(outcome.negative)
            scalars["stable"] = float(outcome.negative == 0)
        return Accepted(control.number, attempt.target / self.step.period, scalars)

    def creep_notes(self) -> list[str]:
        """Note on increments that were too long for creep."""
        if self.creep_excess > MUCH_EXCESS:
            return [
                f"increments of step {self.loop.number} are too long for creep: an error is "
                f"{self.creep_excess:.2g} times the allowed one; allow more increments (INC=) or "
                "shorter ones"
            ]
        fields, _ = self.system.recover(self.state.u)
        strains = (np.abs(block.values["E"]).max(initial=0.0) for block in fields)
        strain = self.system.communicator.greatest(float(max(strains, default=0.0)))
        if self.creep_error <= strain:
            return []
        return [
            f"creep by the stress at the start of an increment of step {self.loop.number} differs "
            f"from that of the increment by {self.creep_error:.2g}, with strains of {strain:.2g}: "
            "stress that relaxes is wrong by several percent or more; take smaller increments, or "
            f"creep_tolerance={0.003 * strain:.1g} (CETOL)"
        ]

    # -- where load control ends -------------------------------------------------------

    def may_relax(self) -> bool:
        """Whether supports alone drive contact: relaxation may find the next equilibrium."""
        if not self.system.joined:
            return False
        return not np.any(self.system.load_rate(self.state.u)[0])

    def go_along_path(self, switch: bool = False) -> bool:
        """Continue by arc length from where load control stalls; False where that does not help.

        Parameters
        ----------
        switch : bool
            Whether load control is left before a bifurcation, to follow the branch that leaves it.

        Raises
        ------
        ConvergenceError
            At the limit point, unless the step is to follow the path beyond it.
        """
        system, step, state, control = self.system, self.step, self.state, self.control
        number, observers, save = self.loop.number, self.loop.observers, self.loop.save
        if any(term.fades for term in system.terms):
            return False  # damping needs a time
        try:
            system.conditions.check_proportional()
        except ModelError:
            return False
        from corota.model.paths import ArcLength

        stops = step.at_limit == "stop" and not switch
        path = ArcLength(factor=1.0, switch=switch, stop_at_limit=stops)
        along = replace(
            step,
            path=path,
            increments=0,
            first_increment=max(control.size, step.smallest_increment),
            largest_increment=0.0,
            fixed_increments=False,
        )
        before, here = control.number, state.u
        kept = [control.time / step.period]
        resumed = state.resumption
        if resumed is not None:
            kept = [resumed.checkpoint.factor] * 2  # the note is in those of the state

        def keep(state: State, increment: int, factor: float, scalars: dict[str, float]) -> None:
            if len(kept) == 1:
                what = "the equilibrium loses its stability behind" if switch else "stalls at"
                text = (
                    f"load control: {what} load factor {kept[0]:.6g}; arc length takes over "
                    f"from increment {before + 1} (column 'arc length' of the histories): from "
                    "there the load factor is an unknown, and step time only counts the "
                    "increments within the period"
                )
                state.notes.append(f"step {number}: {text}")
                observers.note(number, text)
            kept.append(factor)
            save(state, increment, factor, scalars)

        loop = IncrementLoop(system, along, number, state, observers, keep)
        stepper = path_stepper(loop, control.time / step.period, before)
        stepper.takes_over, stepper.rates, stepper.stalled = True, self.rates, self.stalled
        stepper.refused = step.smallest_increment / step.period
        try:
            limit = stepper.run(path)
        except (ConvergenceError, SingularError, ModelError) as error:
            if state.u is not here:
                # The states that the path found are kept: there the step stops.
                factor = kept[-1]
                said = str(error).removesuffix(". All converged increments are kept")
                moves, way = driven(system, step, state), system.gives_way()
                fails = "" if moves else collapse(system, step, number, factor, stepper.rates, said)
                raise ConvergenceError(
                    f"{fails + '. ' if fails else ''}step {number} stopped at step time "
                    f"{factor * step.period:g} of {step.period:g} (load factor {factor:.6g}): "
                    f"{way and f'{way}; '}{said}{stepper.stalled}{unstable(state)}. All converged "
                    f"increments are kept; to continue, {remedies(moves)}"
                ) from None
            return False
        state.counters["arc length took over"] = 1
        if limit is None:
            return True
        raise ConvergenceError(at_limit(system, step, number, limit.factor, state))


def _law(material: Material) -> Material:
    """The first material of a table."""
    return material.first if isinstance(material, MaterialTable) else material


def _creeps(material: Material) -> bool:
    """Whether a material creeps, without end or until its stress has relaxed."""
    return material.creeps or isinstance(material, Viscoelastic)


def _continued(report: Report | None, before: int, how: str) -> Report | None:
    """A report of the iterations of a later attempt, which follow those of the ones before."""
    if report is None:
        return None

    def continued(iteration: int, norms: ResidualNorms, correction: float, note: str) -> None:
        report(before + iteration, norms, correction, "; ".join(filter(None, [how, note])))

    return continued
