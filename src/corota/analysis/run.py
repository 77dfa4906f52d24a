"""The analysis as a whole: a model through its steps to results."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import time as clock
import warnings
from copy import copy
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.analysis.checkpoint import Begun, Checkpoint, Resumption, replay, take
from corota.analysis.constraints.none import IDENTITY
from corota.analysis.end_moments import add_end_moments
from corota.analysis.energies import Energies
from corota.analysis.equations import System
from corota.analysis.failure import ElementFailure
from corota.analysis.increment_loop import IncrementLoop
from corota.analysis.linear.solvers import LinearSolver, make_solver
from corota.analysis.memory import require_libraries
from corota.analysis.missed_peaks import NONE, followed, missed_peaks, pair_forces
from corota.analysis.observers import Observers
from corota.analysis.parallel.communicator import ALONE, Communicator
from corota.analysis.procedures.localization import localized
from corota.analysis.state import State
from corota.analysis.state_tree import Reader, arrays_as_built, copies_as_built, dict_of
from corota.analysis.terms.moving_mass import MovingMass, masses_of_steps
from corota.display import brief
from corota.errors import (
    SHORT,
    ConvergenceError,
    CorotaError,
    InputError,
    ResourceError,
    UnsupportedError,
    memory_errors,
)
from corota.model.local_strain import ADVICE, LARGE_STRAIN
from corota.model.steps import Step, in_force
from corota.results.results import Frame, Results

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from corota.analysis.evaluation import Evaluation
    from corota.arrays import Floats
    from corota.model.model import Model
    from corota.results.observer import Observer
    from corota.results.results import PointFields


#: Largest useful number of threads per core, and in total.
THREADS_PER_CORE, LEAST_CAP = 4, 64


def solve(
    model: Model,
    steps: Step | Sequence[Step] | None = None,
    *,
    observers: Iterable[Observer] = (),
    solver: str | LinearSolver = "multifrontal",
    threads: int | None = None,
    keep: Literal["all", "last"] = "all",
    fields: bool = True,
    start: Checkpoint | None = None,
) -> Results:
    """Run the steps of a model.

    Parameters
    ----------
    model : Model
    steps : Step or sequence of Step, optional
        The model's own steps by default, or one ``Static()``.
    observers : iterable of Observer
        Called with every iteration and increment.
    solver : str or LinearSolver
        Name in :data:`corota.analysis.linear.solvers.SOLVERS`, or an object with its three methods.
    threads : int, optional
        All cores by default. Results do not depend on it.
    keep : {"all", "last"}
        Frames kept in memory.
    fields : bool
        Recover stress and strain at the points of every increment.
    start : Checkpoint, optional
        Continue from there instead of the beginning; see :func:`corota.resume`.

    Returns
    -------
    Results
        With `start`, of the increments after it.

    Raises
    ------
    InputError
        If the model cannot be analyzed.
    ConvergenceError
        If an increment cannot be converged; ``error.results`` has everything before it.
    SingularError
        If the structure is not constrained.
    ResourceError
        If the memory does not suffice; ``error.results`` has everything before it.

    Examples
    --------
    >>> import corota as ct
    >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    >>> model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    >>> model.fix("left")
    >>> model.force("right", y=-0.2)
    >>> results = ct.solve(model, ct.Static(), threads=1)
    >>> bool(results.frames[-1].U[:, 1].min() < -0.7)
    True
    """
    with memory_errors():
        run = Analysis(model, steps, observers, solver, threads, keep, fields, start)
    return run.run()


def keep_nlgeom(steps: Sequence[Step], finite: bool = False) -> tuple[list[Step], list[str]]:
    """Steps that keep the large rotations of earlier ones, with notes.

    The linear theory has another displacement under the same loads: a linear step after a
    nonlinear one would jump. With laws that are for finite strain (`finite`) all steps have large
    rotations, as in CalculiX.
    """
    kept: list[Step] = []
    notes: list[str] = []
    nonlinear = 0
    for number, step in enumerate(steps, start=1):
        if step.procedure in ("static", "dynamic"):
            if finite and not (step.nlgeom or nonlinear):
                step = copy(step)
                step.nlgeom = True
                notes.append(
                    f"step {number} is computed with large rotations (nlgeom): a hyperelastic law "
                    "is for finite strain"
                )
            if step.nlgeom and not nonlinear:
                nonlinear = number
            elif nonlinear and not step.nlgeom:
                step = copy(step)
                step.nlgeom = True
                notes.append(
                    f"step {number} keeps the large rotations (nlgeom) of step {nonlinear}: the "
                    "linear theory would jump to another displacement under the same loads"
                )
        kept.append(step)
    return kept, notes


class Analysis:
    """One run of :func:`solve`."""

    def __init__(
        self,
        model: Model,
        steps: Step | Sequence[Step] | None,
        observers: Iterable[Observer],
        solver: str | LinearSolver,
        threads: int | None,
        keep: Literal["all", "last"],
        fields: bool,
        start: Checkpoint | None = None,
    ) -> None:
        from corota.model.model import Model
        from corota.model.steps import Static, listed_steps

        if not isinstance(model, Model):
            raise InputError(f"solve takes a Model, not {brief(model)}")
        if steps is None:
            steps = model.steps or [Static()]
            start = model.start if start is None else start
        if keep not in ("all", "last"):
            raise InputError(f"keep must be 'all' or 'last', not {keep!r}")
        if threads is not None and not (hasattr(threads, "__index__") and threads >= 0):
            raise InputError(f"threads must be a whole number >= 0, not {threads!r}")
        if not isinstance(solver, str):
            for name in ("analyze", "factorize", "solve"):
                if not callable(getattr(solver, name, None)):
                    raise InputError(f"a linear solver needs a method {name}; {solver!r} has none")
        self.steps, notes = keep_nlgeom(
            listed_steps(steps), any(s.material.local_strain for s in model.sections)
        )
        # Groups of cells that leave and join, tables and histories read the steps of the model.
        model = copy(model)
        model.steps = self.steps
        self.model, self.fields = model, fields
        self.observers = Observers(observers)
        self.results = Results(model, keep=keep)
        self.results.steps = self.steps
        self.masses = masses_of_steps(self.steps)
        self.requests = in_force(self.steps)
        for note in notes:
            self.results.notes.append(note)
            warnings.warn(note, stacklevel=3)
        cores = os.cpu_count() or 1
        most = max(LEAST_CAP, THREADS_PER_CORE * cores)
        self.threads = min(threads or cores, most)
        if threads and threads > most:
            self.results.notes.append(
                f"{threads} threads were requested; {most} are used, on {cores} cores"
            )
        if isinstance(solver, str):
            self.solver: LinearSolver = make_solver(solver)
        else:
            self.solver = solver
        #: The processes of this analysis; those of one machine share its cores.
        self.communicator: Communicator = getattr(self.solver, "communicator", ALONE)
        if self.communicator.size > 1 and not threads:
            self.threads = 1
        self.observers.communicator = self.communicator
        if hasattr(self.solver, "threads"):
            self.solver.threads = self.threads
        self.system: System
        self.warned: set[str] = set()
        #: Starts of the steps so far, digests of the system's initial arrays, and the
        #: checkpoint that the run continues from.
        self.begun: list[Begun] = []
        self.as_built: Mapping[str, object] = {}
        self.start = None if start is None else start.part(self.communicator)
        self.resumed = self.start

    def _without_cause(self) -> bool:
        """Whether neither the model nor a step has a load or a moving support."""
        owners = [self.model, *self.steps]
        return not any(o.loads or any(s.value for s in o.supports) for o in owners)

    def run(self) -> Results:
        """Run all steps; observers are always notified of the end."""
        results, begin = self.results, clock.perf_counter()
        error: BaseException | None = None
        stands: State | None = None
        counters: dict[str, int] = {}
        try:
            require_libraries()
            self.system = System(self.model, self.solver, self.threads, self.steps)
            results.info["n_dofs"] = self.system.n_dofs
            results.info["threads"] = self.threads
            results.info["processes"] = self.communicator.size
            self.observers.start(self.model, self.steps)
            if self.observers.takes_checkpoints:
                self.as_built = arrays_as_built({"system": self.system}, self.known(), "")
            state = stands = State(
                np.zeros(self.system.n_dofs),
                counters=counters,
                critical=results.critical_points,
                modes=results.modes,
                notes=results.notes,
                energies=Energies(self.system),
                peaks=[(NONE,) * 4 for _ in self.model.contacts],
            )
            reaction = None
            begin_at = 1 if self.start is None else self.start.step
            for number, step in enumerate(self.steps[begin_at - 1 :], start=begin_at):
                try:
                    reaction = self._step(step, number, state, reaction)
                except ElementFailure as failure:
                    raise ConvergenceError(
                        f"step {number} stopped at step time {state.step_time:g} of "
                        f"{step.period:g}: {failure}. All increments before are kept"
                    ) from None
            self.energies = state.energies
            if remark := state.energies.remark():
                results.notes.append(remark)
                if state.energies.made_by_contact:
                    warnings.warn(remark, stacklevel=3)
            results.notes += missed_peaks(state.peaks, self.model.contacts)
            results.notes += self.system.remarks(state.u, finished=True)
            if not state.u.any() and not results.modes and self._without_cause():
                results.notes.append("nothing moved: no step has a load or a moving support")
        except MemoryError:
            error = ResourceError(f"{SHORT}. All increments before are kept")
            error.results = results
            self.communicator.leave(error, error.exit_code)
            raise error from None
        except CorotaError as caught:
            error = caught
            self.communicator.leave(caught, caught.exit_code)
            if hasattr(caught, "results"):
                caught.results = results
                if stands is not None and stands.failed is not None:
                    self._keep_iterate(stands)
                if stands is not None and isinstance(caught, ConvergenceError):
                    for text in self.system.remarks(stands.u, finished=False):
                        caught.reason += f". At the last increment: {text}"
                    caught.args = (caught.reason,)
            raise
        except BaseException as caught:
            error = caught
            self.communicator.leave(caught)
            raise
        finally:
            info = results.info
            info.update(counters)
            if hasattr(self, "system"):
                info["profile"] = dict(self.system.profile)
            info["seconds"] = clock.perf_counter() - begin
            note = self._large_strain(stands)
            results.notes += note
            self.observers.end(results, error if isinstance(error, Exception) else None)
        for text in note:
            warnings.warn(text, stacklevel=3)
        return results

    def _step(
        self, step: Step, number: int, state: State, reaction: Floats | None
    ) -> Floats | None:
        system = self.system
        if not hasattr(step, "run"):
            raise UnsupportedError(
                f"{type(step).__name__} has no procedure: its class needs `procedure` and `run`",
                step.where,
            )
        self.observers.step(number, step)
        state.loop = None
        if self.start is not None:
            self._resume(self.start, state)
        else:
            self._begin(step, number, state, reaction)
        self.start = None

        save = partial(self._save, number)
        self.observers.requests = self.requests[number - 1]
        # Those of outputs that the step keeps among them.
        times = [o.time_points for o in self.observers.requests if o.time_points]
        stops = [float(t) for name in times for t in self.model.time_points[name]]
        if state.resumption is not None and state.resumption.checkpoint.leave_step:
            self._leave(state)
        else:
            loop = IncrementLoop(system, step, number, state, self.observers, save)
            step.run(loop, step, stops)
            if state.loop is not None and step.restart:
                increment = self.results.frames[-1].increment if self.results.frames else 0
                last = take(self, state, (number, increment), 1.0)
                self.observers.checkpoint(last, f"step-{number}.ckpt")
        assert state.at is not None
        state.time += state.step_time
        state.step_time = 0.0
        if (
            reaction is None
            and step.procedure in ("frequency", "steady state")
            and (self.begun[-1].first)
        ):
            # Nothing was loaded yet: the loads and supports of the model are the next step's.
            return None
        return system.reaction(state.at)

    def _resume(self, start: Checkpoint, state: State) -> None:
        begun = Reader(start.arrays, {}).read(dict_of(start.tree)["begun"])
        built = copies_as_built({"system": self.system}, self.known())
        replay(self, begun)
        self.begun[:] = begun
        state.time, state.step_time = start.time - start.step_time, start.step_time
        state.resumption = Resumption(self, start, built)

    def _leave(self, state: State) -> None:
        """Take the state of a checkpoint as the end of its step."""
        assert state.resumption is not None
        kind = state.resumes
        loop = state.resume(kind)
        system = self.system
        system.conditions.end_time = state.step_time
        if kind == "path":
            system.conditions.end_time = loop["factor"] * system.conditions.factors.period
        if state.energies.scheme == "energy_momentum" and state.v is not None:
            state.carried = (state.u, state.v, loop["now"].v)
        state.reaction = None
        if kind != "static":
            state.at = system.evaluate(state.u, system.conditions.end_time)

    def _large_strain(self, state: State | None) -> list[str]:
        """Note on the local strain of sections with linear strain, if it was large."""
        if state is None:
            return []
        (most, step, increment), (last, *end) = state.strains
        if most <= LARGE_STRAIN:
            return []
        final = "" if end == [step, increment] else f" and is {last:.1%} at the end"
        return [
            f"local strain reaches {most:.1%} in step {step}, increment {increment}{final}, under "
            f"local_strain='linear'. {ADVICE}"
        ]

    def known(self) -> dict[str, object]:
        """Objects stored by reference in checkpoints."""
        found: dict[str, object] = {f"steps/{i}": step for i, step in enumerate(self.steps)}
        found |= {"model": self.model, "observers": self.observers}
        system = self.system
        found |= {"constraints": system.constraints, "pattern": system.pattern}
        found |= {"linear": system.linear, "identity": IDENTITY}
        found |= {"communicator": self.communicator}
        return found

    def mass(self, number: int) -> MovingMass:
        """Mass that gravity acts on in a step."""
        return self.masses[number - 1]

    def _begin(self, step: Step, number: int, state: State, reaction: Floats | None) -> None:
        system = self.system
        kinematics = system.nlgeom, system.about_linear
        system.mass = self.mass(number)
        self.begun.append(Begun(state.time, reaction is None, system.conditions.end_time))
        system.begin(step, state.time, state.u, reaction)
        state.notes += system.conditions.supports.notes
        system.conditions.supports.notes = []
        if step.procedure == "dynamic" and any(
            item.kind == "centrifugal" for item, _ in system.conditions.body_forces()
        ):
            self._warn(
                "coriolis",
                f"step {number}: a motion in a rotating frame (centrifugal load) without Coriolis "
                "forces; frequency steps with complex modes, modal and harmonic steps include them",
            )
        other = kinematics != (system.nlgeom, system.about_linear) or bool(step.element_changes)
        if state.at is None or other:
            state.at = system.evaluate(state.u, 0.0)
        state.energies.begin(step, state.at.internal)
        if number == 1:
            state.notes += [note for term in system.terms for note in term.notes]
            if not step.starts_in_motion:
                self._save(number, state, 0, 0.0, {})

    def _keep_iterate(self, state: State) -> None:
        failed = state.failed
        if failed is None or failed.at is None or not np.isfinite(failed.u).all():
            return
        begun = self.resumed
        if self.results.frames:
            last = self.results.frames[-1]
        elif begun is not None and state.at is not None:
            # A resumed run that stops at once: the state of its checkpoint.
            where = begun.step, begun.increment, begun.time, begun.step_time, begun.factor
            last = self._frame(where, state.u, state.at, state.reaction)
        else:
            return
        where = last.step, last.increment + 1, last.time, last.step_time, last.factor
        iterate = self._frame(where, failed.u, failed.at, None)
        self.results.last_state, self.results.last_iterate = last, iterate

    def _frame(
        self,
        where: tuple[int, int, float, float, float],
        u: Floats,
        at: Evaluation,
        reaction: Floats | None,
    ) -> Frame:
        """Displacements and forces of a state, without fields."""
        system = self.system
        moved = system.by_node(u)
        if reaction is None:
            reaction = system.reaction(at)
        return Frame(
            *where,
            moved[:, :2].copy(),
            moved[:, 2].copy(),
            system.by_node(reaction),
            system.by_node(at.external),
            constraint_force=system.by_node(at.residual - reaction),
        )

    def _localized(self, fields: list[PointFields]) -> tuple[int, str] | None:
        """The first element in which plastic flow localizes, and why it matters."""
        blocks = self.system.own_blocks
        found = (localized(block, own) for block, own in zip(blocks, fields, strict=True))
        own = next((each for each in found if each), None)
        every = [each for each in self.system.communicator.gather(own) if each]
        return self.system.communicator.broadcast(every[0] if every else None)

    def _warn(self, kind: str, note: str) -> None:
        if kind not in self.warned:
            self.warned.add(kind)
            self.results.notes.append(note)
            warnings.warn(note, stacklevel=3)

    def _save(
        self, number: int, state: State, increment: int, factor: float, scalars: dict[str, float]
    ) -> None:
        system = self.system
        assert state.at is not None
        fields: list[PointFields] = []
        elements: dict[str, float] | None = None
        if self.fields:
            with system.timed("recover"):
                step = self.steps[number - 1]
                if state.recover is None:
                    fields, sums = system.recover(state.u)
                    along = getattr(step, "path", None) is not None
                    when = factor * step.period if along else state.step_time
                    add_end_moments(system, fields, state.u, when, state.a)
                else:
                    fields, sums = state.recover()
                elements = dict(sums)
                if state.v is not None and any("ELKE" in out.variables for out in step.outputs):
                    from corota.analysis.terms.inertia import add_kinetic

                    add_kinetic(system, fields, state.u, state.v, step)
            scalars = {**scalars, "strain energy": sums["strain energy"]}
            strain = system.largest_linear_strain, number, increment
            state.strains[:] = max(state.strains[0], strain, key=lambda s: s[0]), strain
            if "flow" not in self.warned and (found := self._localized(fields)):
                label = self.model.mesh.cell_labels[found[0]]
                self._warn(
                    "flow", f"element {label}, step {number}, increment {increment}: " + found[1]
                )
            fields = system.communicator.fields(fields, system.own_numbers)
        kind = self.steps[number - 1].procedure
        if kind == "dynamic" or (kind == "static" and elements is not None):
            state.energies.add_to(scalars, elements, (number, increment))
        outputs = [term.output() for term in system.terms]
        contact = next((out.contact for out in outputs if out.contact is not None), None)
        pairs = {name: table for out in outputs for name, table in out.pairs.items()}
        for out in outputs:
            scalars = {**scalars, **out.scalars}
        scalars |= system.conditions.wetted()
        if self.model.contacts and kind == "static":
            pressure = 0.0 if contact is None else float(np.max(contact[:, 0], initial=0.0))
            forces = pair_forces(self.model.contacts, scalars, pressure)
            state.peaks[:] = (
                followed(peak, (number, state.step_time, force))
                for peak, force in zip(state.peaks, forces, strict=True)
            )
        where = number, increment, state.time + state.step_time, state.step_time, factor
        frame = replace(
            self._frame(where, state.u, state.at, state.reaction),
            fields=fields,
            scalars=scalars,
            V=None if state.v is None else system.by_node(state.v),
            A=None if state.a is None else system.by_node(state.a),
            C=contact,
            pairs=pairs,
            T=system.free.now.copy() if system.free.responds else None,
            H=state.harmonic,
        )
        if self.model.stages:
            with system.timed("stages"):
                if state.stages is None:
                    from corota.analysis.stages import StageRecorder

                    state.stages = StageRecorder(system, self.model)
                reached = factor * self.steps[number - 1].period if kind == "static" else None
                state.stages.add(system, state.u, frame, reached, state.notes)
        self.results.add(frame)
        with system.timed("write"):
            self.observers.increment(frame)
        if state.loop is not None and self.observers.checkpoint_due:
            with system.timed("checkpoint"):
                self.observers.checkpoint(take(self, state, (number, increment), factor))
