"""A static step that follows the equilibrium path of a model by arc length or displacement.

Time in such a step is the length of the path, in units in which a linear structure takes one
to the full load; the load factor multiplies what the step changes, while what earlier steps
reached stays.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.newton import ElementFailure, Settings
from corota.analysis.path_system import Point
from corota.analysis.procedures.path.controls import Row
from corota.analysis.procedures.path.tracer import End, PathStalled, PathTracer, Plan
from corota.analysis.terms.contact.path import path_system
from corota.errors import ConvergenceError, InputError, Interrupted, ModelError, SingularError
from corota.model.dofs import dof_index
from corota.model.paths import ArcLength, CriticalPoint, DisplacementControl, Label
from corota.results.observer import Iteration

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.newton import ResidualNorms
    from corota.analysis.observers import Observers
    from corota.analysis.procedures.path.stability import Critical
    from corota.analysis.procedures.path.tracer import Increment
    from corota.analysis.state import State
    from corota.model.paths import Where
    from corota.model.steps import Static

    Floats = NDArray[np.float64]
    Save = Callable[[State, int, float, dict[str, float]], None]


def path_step(
    system: System,
    step: Static,
    number: int,
    state: State,
    observers: Observers,
    save: Save,
    path: ArcLength | DisplacementControl,
    *,
    factor: float = 0.0,
    increment: int = 0,
    takes_over: bool = False,
    rates: tuple[float, float] = (0.0, 0.0),
) -> CriticalPoint | None:
    """Run a step, or the rest of one, along its path.

    Parameters
    ----------
    path : ArcLength or DisplacementControl
    factor : float
        Load factor of the committed state.
    increment : int
        Increments of the step so far.
    takes_over : bool
        Whether the step began by load control: its time then stays within the period.
    rates : tuple of float
        Displacement per time of load control before, for messages.

    Returns
    -------
    CriticalPoint or None
        The limit point at which the path was asked to end.

    Raises
    ------
    ConvergenceError
        With the reason, when the path cannot be followed further.
    ModelError
        If the step's loads do not grow with a load factor, or none does.
    """
    system.conditions.check_proportional()
    run = PathStep(system, step, number, state, observers, save, factor, increment)
    run.takes_over = takes_over
    run.rates = rates
    return run.run(path)


class PathStep:
    """One run of :func:`path_step`."""

    def __init__(
        self,
        system: System,
        step: Static,
        number: int,
        state: State,
        observers: Observers,
        save: Save,
        factor: float,
        increment: int,
    ) -> None:
        self.system, self.step, self.number, self.state = system, step, number, state
        self.observers, self.save = observers, save
        self.factor, self.increment = factor, increment
        self.takes_over = False
        #: Where the path began, and how far it has gone, in units of the period [time].
        self.begin, self.arc = state.step_time, 0.0
        self.along = path_system(system, state.notes)
        #: The critical point that was found last, as the path and as results know it.
        self.located: tuple[Critical, CriticalPoint] | None = None
        self.rates = (0.0, 0.0)
        self.follower: PathTracer
        self.limit: CriticalPoint | None = None

    def run(self, path: ArcLength | DisplacementControl) -> CriticalPoint | None:
        """Follow the path to its end."""
        system, step, state = self.system, self.step, self.state
        period = step.period
        self.stop_at_limit = bool(getattr(path, "stop_at_limit", False))
        last: Increment | None = None
        if state.resumes:
            last = self._resume()
        else:
            self.follower = self._tracer(self._start(), self._plan(path))
        follower = self.follower
        try:
            if last is not None:
                self._check(last)
            if last is None or not last.last:
                for found in follower:
                    self._accept(found)
                    self._check(found)
        except PathStalled as stalled:
            raise ConvergenceError(
                f"step {self.number} stopped on its path at load factor {self.factor:.6g} "
                f"(increment {self.increment}): {stalled}. All converged increments are kept"
            ) from None
        except SingularError as error:
            if self.increment:
                raise ConvergenceError(
                    f"step {self.number} stopped on its path at load factor "
                    f"{self.factor:.6g}: {error}"
                ) from None
            raise
        finally:
            counters = state.counters
            counters["iterations"] = counters.get("iterations", 0) + follower.iterations
            # The factorisation has changed the tangent's held rows in place.
            system.conditions.end_time = self.factor * period
            try:
                self.along.restart()
                z = self.along.start(state.u)
                state.at = self.along.plain(self.along.evaluate(z, self.factor * period))
            except ElementFailure as error:
                raise ConvergenceError(
                    f"step {self.number} stopped on its path at load factor {self.factor:.6g}: "
                    f"{error}"
                ) from None
        return self.limit

    def _start(self) -> Point:
        """The committed state as the start of the path."""
        system, step, state = self.system, self.step, self.state
        start = self.along.start(state.u)
        at = self.along.evaluate(start, self.factor * step.period)
        force, move = system.load_rate(state.u)
        heats = system.free.largest(system.conditions.heating) > 0.0
        if not (np.any(force[~system.conditions.constrained]) or np.any(move) or heats):
            raise ModelError(
                f"step {self.number} follows a path, but nothing in it grows with the load "
                "factor: give it a load or a moving support of its own",
                step.where,
            )
        return Point(start, self.factor, at)

    def _tracer(self, start: Point, plan: Plan) -> PathTracer:
        step = self.step
        settings = Settings(step.tolerance, step.max_iterations + self.along.more_iterations)
        return PathTracer(
            self.along, start, step.period, settings, plan, self._report, self._cut_back
        )

    def _resume(self) -> Increment:
        """Take the state of a checkpoint; returns the increment that it was taken after."""
        self.follower = self._tracer(Point(self.state.u, 0.0, None), Plan())
        loop = self.state.resume("path", along=self.along, tracer=self.follower)
        self.factor, self.increment = loop["factor"], loop["increment"]
        self.located, self.limit, self.rates = loop["located"], loop["limit"], loop["rates"]
        self.begin, self.arc = loop["begin"], loop["arc"]
        found: Increment = loop["found"]
        return found

    # -- increments --------------------------------------------------------------------

    def _accept(self, found: Increment) -> None:
        state, system = self.state, self.system
        at, u = self.along.plain(found.point.at), found.point.u[: system.n_dofs]
        assert state.energies is not None
        state.energies.add_quasi_static(u, state.u, at)
        state.u, state.at = u, at
        before, period = state.step_time, self.step.period
        self.arc += found.size * period
        state.step_time = self.begin + self.arc
        if self.takes_over:
            # The rest of the period, whatever the length of the path.
            rest = period - self.begin
            ends = found.last and found.point.factor >= 1.0 - 1e-9
            share = 1.0 if ends else self.arc / (rest + self.arc)
            state.step_time = self.begin + share * rest
        state.negative = found.negative
        self.factor = found.point.factor
        self.increment += 1
        scalars = {
            "dt": state.step_time - before,
            "iterations": float(found.iterations),
            "attempts": float(found.attempts),
            "residual": system.residual_norms(at, u).size,
            "external work": state.energies.work,
            "negative pivots": float(found.negative),
        }
        if self.takes_over:
            scalars["arc length"] = 1.0
        if found.negative < 0 and self.along.not_conservative not in state.notes:
            state.notes.append(self.along.not_conservative)
        if found.negative >= 0:
            scalars["stable"] = float(found.negative == 0)
        critical = None
        if found.critical is not None:
            assert found.critical.kind != "kink"
            kind = found.critical.kind
            scalars[f"{kind} point"] = 1.0
            critical = CriticalPoint(
                kind,
                self.number,
                self.increment,
                self.factor,
                system.by_node(found.critical.mode[: system.n_dofs]),
                found.critical.projection,
                found.critical.negative,
            )
            state.critical.append(critical)
            state.notes.append(str(critical))
        if found.control == "mode" and self.located is not None:
            self._tell_branches(*self.located)
        if found.critical is not None and critical is not None:
            self.located = (found.critical, critical)
        if found.last and self.stop_at_limit:
            self.limit = critical
        state.loop = {
            "kind": "path",
            "along": self.along,
            "tracer": self.follower,
            "factor": self.factor,
            "increment": self.increment,
            "located": self.located,
            "limit": self.limit,
            "rates": self.rates,
            "begin": self.begin,
            "arc": self.arc,
            "found": found,
        }
        self.save(state, self.increment, self.factor, scalars)

    def _tell_branches(self, critical: Critical, point: CriticalPoint) -> None:
        """Give a bifurcation point its branches."""
        system = self.system
        point.branches = np.array([system.by_node(b[: system.n_dofs]) for b in critical.branches])
        if len(point.branches) > 1:
            self.state.notes.append(
                f"{len(point.branches)} branches leave the bifurcation point at load factor "
                f"{point.factor:.6g}: branch=1 to {len(point.branches)} takes each of them"
            )

    def _check(self, found: Increment) -> None:
        """End for reasons that are not of the path."""
        if found.closed and not found.last:
            raise PathStalled(
                "the branch is closed: it has come back to the bifurcation point where it began "
                "without an end of the path on it"
            )
        if self.observers.stop_requested:
            raise Interrupted(
                f"stopped at step {self.number}, load factor {self.factor:.6g}; everything up "
                "to there is kept"
            )
        if not found.last and self.increment >= self.step.max_increments:
            raise ConvergenceError(
                f"step {self.number} used its {self.step.max_increments} increments at load "
                f"factor {self.factor:.6g}; allow more, or name another end of the path"
            )

    def _report(
        self,
        attempt: int,
        iteration: int,
        norms: ResidualNorms,
        correction: float,
        factor: float,
        size: float,
    ) -> None:
        system = self.system
        self.observers.iteration(
            Iteration(
                self.number,
                self.increment + 1,
                attempt,
                iteration,
                norms.force,
                norms.moment,
                correction,
                int(system.node_of_dof[norms.worst]),
                int(system.component[norms.worst]),
                "",
                size,
                factor,
            )
        )

    def _cut_back(self, attempt: int, reason: str, size: float) -> None:
        counters = self.state.counters
        counters["cut-backs"] = counters.get("cut-backs", 0) + 1
        self.observers.cut_back(self.number, self.increment + 1, attempt, reason, size)

    # -- plan --------------------------------------------------------------------------

    def _plan(self, path: ArcLength | DisplacementControl) -> Plan:
        step, period = self.step, self.step.period
        plan = Plan(
            step.first_increment / period,
            step.smallest_increment / period,
            step.largest_increment / period,
            step.fixed_increments,
            locate=path.locate,
        )
        if isinstance(path, DisplacementControl):
            row = self._row(path.terms)
            left = path.target - row.of(self.state.u)
            if left == 0.0:
                raise InputError(
                    f"the controlled displacement is at its target {path.target:g} already",
                    step.where,
                )
            row.value = left / path.increments
            plan.row = row
            plan.ends.append(End(path.target, row))
            return plan
        if path.factor is not None:
            plan.ends.append(End(path.factor))
        if path.displacement is not None:
            where, dof, value = path.displacement
            plan.ends.append(End(value, self._row([(where, dof, 1.0)])))
        plan.increments = path.increments or 0
        plan.spherical = path.shape == "spherical"
        plan.switch, plan.side, plan.branch = path.switch, path.side, path.branch
        plan.stop_at_limit = path.stop_at_limit
        return plan

    def _row(self, terms: Sequence[tuple[Where, str | int, float]]) -> Row:
        """Means over sets as one combination of dofs."""
        dofs: list[int] = []
        weights: list[float] = []
        mesh = self.system.model.mesh
        for where, name, weight in terms:
            if isinstance(where, Label):
                nodes = np.flatnonzero(mesh.node_labels == where)
                if not nodes.size:
                    raise InputError(f"no node {where} to control or end a path")
            else:
                nodes = mesh.node_indices(where)
            dof = dof_index(name)
            found = self.system.dofs(nodes, dof)
            if (found < 0).any():
                label = mesh.node_labels[nodes[found < 0][0]]
                raise InputError(f"node {label} has no {name} to control or end a path")
            dofs += found.tolist()
            weights += [weight / len(nodes)] * len(nodes)
        return Row(np.array(dofs), np.array(weights), 0.0)


__all__ = ["path_step"]
