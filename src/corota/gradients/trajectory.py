"""The equations of a model along increments that have converged.

The increments come from the frames of a run. Histories of materials are evaluated again from
one increment to the next, so that a run needs no special preparation.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.equations import System
from corota.analysis.linear.solvers import make_solver
from corota.analysis.terms.moving_mass import masses_of_steps
from corota.errors import InputError, UnsupportedError
from corota.gradients.motion import Motion, refuse_motion
from corota.gradients.store import HistoryStore
from corota.gradients.surfaces import Surfaces, add_forces, find, refuse_surfaces, slide
from corota.model.steps import Dynamic, Step
from corota.model.user_material import UserMaterial

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from corota.analysis.evaluation import Evaluation
    from corota.arrays import Floats
    from corota.model.model import Model
    from corota.results.results import Frame, Results


#: Largest residual of a state at free dofs, over the sum of element forces there.
EQUILIBRIUM = 1e-5


@dataclass
class Increment:
    """A converged increment.

    Parameters
    ----------
    frame : int
        Its index in the results.
    step : int
        Index of its step.
    time : float
        Step time of its loads; along a path the load factor times the period.
    factor : float
    by_node : ndarray, shape (n_nodes, 3)
    histories : sequence of ndarray
        Of the elements of each block before the increment; empty where no law has any.
    begun : float
        Step time at which it began.
    """

    frame: int
    step: int
    time: float
    factor: float
    by_node: Floats
    histories: Sequence[Floats] = field(default_factory=list)
    begun: float = 0.0
    #: Whether its load factor was an unknown, and whether it is the last of its step.
    along: bool = False
    last: bool = False
    #: Multipliers of contact and ties, once they are known.
    surfaces: Surfaces | None = None
    #: Velocity and acceleration of a dynamic step, shape (2, n_nodes, 3).
    rates: Floats | None = None

    @property
    def dt(self) -> float:
        """Its length [time]; 0 for the start of a motion."""
        return self.time - self.begun


def increments_of(results: Results) -> list[Increment]:
    """Increments of all steps of a run; of a motion with its start.

    Raises
    ------
    UnsupportedError
        If a step has no states with a gradient.
    InputError
        If frames were not kept.
    """
    if not results.frames:
        raise InputError("results without frames have no gradient; run the model first")
    if results.keep != "all":
        raise InputError("gradients need the frames of all increments: solve with keep='all'")
    found: list[Increment] = []
    for index, frame in enumerate(results.frames):
        step = results.steps[frame.step - 1]
        _require_states(step)
        if frame.increment == 0 and step.procedure != "dynamic":
            continue
        increment = _increment(index, frame, step)
        if found and found[-1].step == increment.step:
            increment.begun = found[-1].time
        found.append(increment)
    for one, two in itertools.pairwise([*found, None]):
        if one is not None and (two is None or two.step > one.step):
            one.last = True
    if not any(results.frames[each.frame].increment for each in found):
        raise InputError("results without increments have no gradient")
    return found


def _require_states(step: Step) -> None:
    if step.procedure not in ("static", "frequency", "dynamic"):
        raise UnsupportedError(
            f"gradients follow static, dynamic and frequency steps; a {step.procedure} step has "
            "none",
            step.where,
        )


def _increment(index: int, frame: Frame, step: Step) -> Increment:
    along = getattr(step, "path", None) is not None or "arc length" in frame.scalars
    if step.procedure == "frequency":
        return Increment(index, frame.step - 1, 0.0, 0.0, np.column_stack([frame.U, frame.UR]))
    time = frame.factor * step.period if along else frame.step_time
    by_node = np.column_stack([frame.U, frame.UR])
    rates = None
    if step.procedure == "dynamic":
        assert frame.V is not None
        assert frame.A is not None
        rates = np.stack([frame.V, frame.A])
    return Increment(index, frame.step - 1, time, frame.factor, by_node, along=along, rates=rates)


@dataclass
class Point:
    """An equilibrium state in the equations of a model.

    Parameters
    ----------
    system : System
        Its elements have the histories before the increment.
    increment : Increment
    u : ndarray, shape (n_dofs,)
    at : Evaluation
        Forces there; without a tangent.
    steps : list of Step
    gaps : ndarray, shape (n_multipliers,)
        Residuals of closed surfaces; empty without contact.
    v : ndarray, shape (n_dofs,)
        Velocity; empty in static steps.
    """

    system: System
    increment: Increment
    u: Floats
    at: Evaluation
    steps: list[Step]
    gaps: Floats = field(default_factory=lambda: np.zeros(0))
    v: Floats = field(default_factory=lambda: np.zeros(0))
    #: Part of the first accelerations that the equation of motion does not have.
    trace: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def reaction(self) -> Floats:
        """Residual with what dependent dofs pass on to their masters, shape (n_dofs,)."""
        return self.at.reaction


class Trajectory:
    """The equations of a model along given increments.

    Parameters
    ----------
    model : Model
    steps : sequence of Step
        With large rotations as in the run.
    threads : int
    store : HistoryStore, optional
        Keeps the histories of the increments.
    kinks : bool
        Allow states without a derivative.

    Raises
    ------
    UnsupportedError
        If the model has a feature whose derivative is not included.
    """

    def __init__(
        self,
        model: Model,
        steps: Sequence[Step],
        threads: int = 1,
        store: HistoryStore | None = None,
        kinks: bool = False,
    ) -> None:
        self.model, self.steps, self.threads = model, list(steps), threads
        self.kinks = kinks
        self.store = HistoryStore() if store is None else store
        refuse(model)
        refuse_motion(model, steps)
        #: Inertia and damping in a dynamic step.
        self.motion: Motion | None = None
        self.system = System(model, make_solver("multifrontal"), threads, self.steps)
        materials = [block.section.material for block in self.system.blocks]
        #: Whether the stress of any material depends on the strain path.
        self.remembers = any(m.remembers for m in materials)
        #: Whether surfaces slip from where they were at the start of an increment.
        self.slides = any(pair.most_friction for pair in model.contacts)

    def walk(self, increments: Sequence[Increment], given: bool = False) -> Iterator[Point]:
        """Equilibrium states, from the first increment on.

        Parameters
        ----------
        increments : sequence of Increment
        given : bool
            Take the histories that the increments have instead of evaluating all increments.

        Notes
        -----
        Unknowns stay those of the increments. Prescribed and dependent dofs are those of this
        model.
        """
        system = self.system
        masses = masses_of_steps(self.steps)
        step, total, reaction = -1, 0.0, None
        u = np.zeros(system.n_dofs)
        for k, increment in enumerate(increments):
            while step < increment.step:
                if step >= 0 and self.steps[step].procedure == "static":
                    total += self.steps[step].period
                step += 1
                system.mass = masses[step]
                system.begin(self.steps[step], total, u, reaction)
                own = self.steps[step]
                self.motion = Motion(system, own) if isinstance(own, Dynamic) else None
                if np.any(system.conditions.fading):
                    dof = int(np.flatnonzero(system.conditions.fading)[0])
                    raise UnsupportedError(
                        f"{system.describe(dof)} is released in step {step + 1}: gradients through "
                        "released supports are not included",
                        self.steps[step].where,
                    )
            if self.remembers:
                if given:
                    system.core.set_histories(list(increment.histories))
                else:
                    increment.histories = self.store.keep(system.core.histories(False))
            point = self.point(increment)
            u, at = point.u, point.at
            if system.n_multipliers:
                if increment.surfaces is None:
                    increment.surfaces = find(system, u, increment.time, at, self.kinks)
                point.gaps = add_forces(system, u, increment.time, at, increment.surfaces)
            yield point
            if increment.rates is not None and not increment.dt:
                continue
            if self.remembers and not given:
                # Others may have been evaluated meanwhile.
                at = system.forces(u, increment.time)
            if self.slides:
                self.slide(u, increment)
            last = k + 1 == len(increments) or increments[k + 1].step > increment.step
            if self.remembers and not given:
                system.commit()
            if last and self.steps[step].procedure == "static":
                system.conditions.end_time = increment.time
                reaction = at.reaction

    def point(self, increment: Increment) -> Point:
        """The state of an increment in the equations of its step, without contact."""
        system, motion = self.system, self.motion
        u = system.from_nodes(increment.by_node)
        u = system.conditions.supports.at(increment.time, u)
        system.constraints.complete(u)
        system.elements.reached = increment.begun
        at = system.forces(u, increment.time)
        found = Point(system, increment, u, at, self.steps)
        if motion is not None:
            assert increment.rates is not None
            v, a = (system.from_nodes(each) for each in increment.rates)
            if not increment.dt:
                v = motion.start(u)
            motion.drive(v, a, increment.time, increment.dt)
            found.trace = motion.add(at, u, v, a, not increment.dt)
            found.v = v
        return found

    def slide(self, u: Floats, increment: Increment) -> None:
        """Let slips of the next increment begin at a displacement."""
        assert increment.surfaces is not None
        slide(self.system, u, increment.surfaces)

    def at_step(self, increments: Sequence[Increment], step: int) -> Trajectory:
        """Equations of the same model with the loads of one of the steps."""
        other = Trajectory(self.model, self.steps, self.threads, self.store)
        ends = {i.step: i for i in increments if i.step < step}
        first = next(i for i in increments if i.step == step)
        for point in other.walk([*ends.values(), first], given=True):
            if point.increment is first:
                break
        return other

    def require_equilibrium(self, point: Point) -> None:
        """Refuse a state that is no equilibrium of these equations.

        Raises
        ------
        UnsupportedError
        """
        system = self.system
        free = ~system.conditions.constrained
        size = max(float(np.abs(point.at.scale).max(initial=0.0)), 1e-300)
        left = float(np.abs(point.reaction[free]).max(initial=0.0))
        if self.motion is not None:
            left = max(left - self.motion.left, 0.0)
        worst = left / size
        if worst > EQUILIBRIUM and not system.scales.stiffest:
            # Bodies without forces have residuals that are rounding of their positions.
            system.return_tangent(system.evaluate(point.u, point.increment.time))
        if worst > EQUILIBRIUM and left > system.scales.zero_force:
            raise UnsupportedError(
                f"frame {point.increment.frame} is no equilibrium of the model's equations "
                f"(residual {worst:.2g} of the element forces): forces acted in the run that "
                "gradients do not include"
            )


def refuse(model: Model) -> None:
    """Refuse models with a feature whose derivative is not included.

    Raises
    ------
    UnsupportedError
    """
    refuse_surfaces(model)
    for section in model.sections:
        if isinstance(section.material, UserMaterial):
            raise UnsupportedError(
                "gradients do not include materials in Python: their derivatives are not known",
                section.where,
            )
