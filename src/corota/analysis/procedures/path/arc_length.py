"""A static step that follows the equilibrium path of a model by arc length or displacement.

Time in such a step is the length of the path, in units in which a linear structure takes one
to the full load; the load factor multiplies what the step changes, while what earlier steps
reached stays.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure, GiveUp
from corota.analysis.increment_loop import Accepted, IncrementLoop, Stepper
from corota.analysis.newton import ResidualNorms, Settings
from corota.analysis.path_system import Point, Tangent
from corota.analysis.procedures.path.branches import BranchTracer
from corota.analysis.procedures.path.controls import Row
from corota.analysis.procedures.path.corrector import tangent_at
from corota.analysis.procedures.path.plan import End, Increment, PathStalled, Plan
from corota.analysis.procedures.stopping import plateau
from corota.analysis.terms.contact.path import path_system
from corota.errors import ConvergenceError, InputError, ModelError, SingularError
from corota.model.dofs import dof_index
from corota.model.paths import ArcLength, CriticalPoint, DisplacementControl, Label
from corota.model.steps import Static

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.analysis.procedures.path.stability import Critical
    from corota.model.paths import Where


def path_step(loop: IncrementLoop, path: ArcLength | DisplacementControl) -> None:
    """Run a step along its path.

    Parameters
    ----------
    loop : IncrementLoop
        Of a static step.

    Raises
    ------
    ConvergenceError
        With the reason, when the path cannot be followed further.
    ModelError
        If the step's loads do not grow with a load factor, or none does.
    """
    loop.system.conditions.check_proportional()
    PathStepper(loop).run(path)


class PathStepper(Stepper):
    """Increments along a path; its tracer attempts them and chooses their sizes.

    Parameters
    ----------
    loop : IncrementLoop
        Of a static step.
    factor : float
        Load factor of the committed state.
    increment : int
        Increments of the step so far.

    Attributes
    ----------
    takes_over : bool
        Whether the step began by load control: its time then stays within the period.
    rates : tuple of float
        Displacement per time in the first increment of load control, and in its last or behind the
        end of the path, for messages.
    stalled : str
        Where and why load control stalled, for messages.
    refused : float
        Load that load control could not add [load factor].
    """

    kind = "path"
    advice = "allow more, or define another end of the path"
    remembered = (
        *("along", "follower", "factor", "taken", "located", "limit"),
        *("rates", "stalled", "begin", "arc", "found"),
    )

    def __init__(self, loop: IncrementLoop, factor: float = 0.0, increment: int = 0) -> None:
        self.loop, self.system, self.state = loop, loop.system, loop.state
        system, state = loop.system, loop.state
        assert isinstance(loop.step, Static)
        self.step = loop.step
        self.factor, self.taken = factor, increment
        self.found: Increment | None = None
        self.takes_over = False
        #: Where the path began, and how far it has gone, in units of the period [time].
        self.begin, self.arc = state.step_time, 0.0
        self.along = path_system(system, state.notes)
        #: The critical point that was found last, as the path and as results know it.
        self.located: tuple[Critical, CriticalPoint] | None = None
        self.rates, self.stalled, self.refused = (0.0, 0.0), "", 0.0
        self.follower: BranchTracer
        self.limit: CriticalPoint | None = None

    def run(self, path: ArcLength | DisplacementControl) -> CriticalPoint | None:
        """Follow the path to its end; returns the limit point at which it ends, if requested.

        Raises
        ------
        ConvergenceError
            With the reason, when the path cannot be followed further.
        ModelError
            If nothing in the step grows with the load factor.
        """
        system, state, period = self.system, self.state, self.step.period
        self.stop_at_limit = bool(getattr(path, "stop_at_limit", False))
        if state.resumes:
            self.follower = self._tracer(Point(state.u, 0.0, None), Plan())
            self.resume()
        else:
            self.follower = self._tracer(self._start(), self._plan(path))
        try:
            self.loop.run(self)
        except PathStalled as stalled:
            if self.follower.begun:
                self.rates = self.rates[0], max(self.rates[1], self._rate_behind())
            raise ConvergenceError(
                f"{self.stopped}: {stalled}. All converged increments are kept"
            ) from None
        except SingularError as error:
            if self.taken:
                raise ConvergenceError(f"{self.stopped}: {error}") from None
            raise
        finally:
            self.loop.count("iterations", self.follower.iterations)
            # The factorization has changed the tangent's prescribed rows in place.
            system.conditions.end_time = self.factor * period
            try:
                self.along.restart()
                z = self.along.start(state.u)
                state.at = self.along.evaluate(z, self.factor * period)
            except ElementFailure as error:
                raise ConvergenceError(f"{self.stopped}: {error}") from None
        return self.limit

    def _rate_behind(self) -> float:
        """Displacement per time behind the end of the path, with the flow of a little more load.

        It is infinite where this flow takes the stability of the tangent: that is the limit load.
        The last point itself may have the tangent without flow, after increments as short as
        rounding.
        """
        way, base, period = self.follower.tangent, self.follower.base, self.step.period
        rate = _rate(way, self.system.n_dofs)
        if way.factor > 0.0 and self.refused:
            u = base.u + self.refused / way.factor * way.u
            behind = Point(u, base.factor + self.refused, None)
            flows = False
            try:
                self.along.restart()
                behind.at = self.along.evaluate(u, behind.factor * period)
                flows = self.system.elements.plastic_increment() > 0.0
                tangent, _ = tangent_at(self.along, behind)
                limit = flows and tangent.negative > max(self.state.negative, 0)
                rate = np.inf if limit else max(rate, _rate(tangent, self.system.n_dofs))
            except SingularError:
                rate = np.inf if flows else rate
            except (ElementFailure, GiveUp):
                pass  # the tangent of the last point is all there is
        return rate / period

    def _start(self) -> Point:
        system, step, state = self.system, self.step, self.state
        start = self.along.start(state.u)
        at = self.along.evaluate(start, self.factor * step.period)
        if self.takes_over and state.at is not None:
            self.along.take_over(at, state.at)
        force, move = system.load_rate(state.u)
        heats = system.free.largest(system.conditions.heating) > 0.0
        if not (np.any(force[~system.conditions.constrained]) or np.any(move) or heats):
            raise ModelError(
                f"step {self.loop.number} follows a path, but nothing in it grows with the load "
                "factor; add a load or a moving support to the step",
                step.where,
            )
        return Point(start, self.factor, at)

    def _tracer(self, start: Point, plan: Plan) -> BranchTracer:
        step = self.step
        settings = Settings(step.tolerance, step.max_iterations + self.along.more_iterations)
        return BranchTracer(
            self.along, start, step.period, settings, plan, self._report, self._cut_back
        )

    # -- increments --------------------------------------------------------------------

    @property
    def finished(self) -> bool:
        return self.found is not None and self.found.last

    @property
    def where(self) -> str:
        return f"load factor {self.factor:.6g}"

    @property
    def stopped(self) -> str:
        """Where the path stopped; after load control the step says at which load."""
        if self.takes_over:
            return f"arc length stopped in increment {self.taken + 1}"
        return (
            f"step {self.loop.number} stopped on its path at {self.where} (increment {self.taken})"
        )

    def advance(self) -> Accepted:
        """Take the next increment of the path.

        Raises
        ------
        PathStalled
            If there is none.
        """
        if self.found is not None and self.found.closed:
            raise PathStalled(
                "the branch is closed: it returned to its bifurcation point without reaching an "
                "end of the path"
            )
        follows = self.system.joined and not self.stop_at_limit  # as what slides, to a stop
        if self.takes_over and not follows and self.follower.flat(2.0 + plateau(self.system)):
            raise PathStalled("the limit load is reached: displacements grow at the same load")
        self.found = self.follower.next()
        return self._accept(self.found)

    def _accept(self, found: Increment) -> Accepted:
        state, system = self.state, self.system
        at, u = found.point.evaluation, found.point.u[: system.n_dofs]
        state.energies.add_quasi_static(u, state.u, at)
        state.u, state.at, state.failed = u, at, None
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
        self.taken += 1
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
                self.loop.number,
                self.taken,
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
        return Accepted(self.taken, self.factor, scalars)

    def _tell_branches(self, critical: Critical, point: CriticalPoint) -> None:
        system = self.system
        point.branches = np.array([system.by_node(b[: system.n_dofs]) for b in critical.branches])
        if len(point.branches) > 1:
            self.state.notes.append(
                f"{len(point.branches)} branches leave the bifurcation point at load factor "
                f"{point.factor:.6g}: branch=1 to {len(point.branches)} selects one of them"
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
        self.loop.iteration(
            self.taken + 1, attempt, iteration, norms, correction, size=size, factor=factor
        )

    def _cut_back(self, attempt: int, reason: str, size: float) -> None:
        self.loop.count("cut-backs")
        self.loop.cut_back(self.taken + 1, attempt, reason, size)

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


def _rate(tangent: Tangent, n_dofs: int) -> float:
    """Largest displacement per load factor along a path."""
    moved = float(np.abs(tangent.u[:n_dofs]).max())
    return moved / abs(tangent.factor) if tangent.factor else np.inf
