"""Adjoint states of a path of equilibria, from its last increment to its first.

With the residual ``r(u, h, p)`` of an increment at the histories ``h`` before it, and the new
histories ``h+ = s(u, h, p)``, a measure J of states has the derivative

    dJ/dp = dJ/dp + sum over increments of  z . dr/dp + y . ds/dp

where y, the derivative of J by the new histories, comes from the increment after, and z from

    (dr/du)^T z = -dJ/du - (ds/du)^T y,      y- = dJ/dh + (dr/dh)^T z + (ds/dh)^T y

(Michaleris, Tortorelli & Vidal, Int. J. Numer. Meth. Engng 37 (1994) 2471-2499). At prescribed dofs
z is the weight of their reactions in J. Along a path whose load factor is an unknown one more
multiplier makes the state fixed in what the path prescribes.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import UnsupportedError
from corota.gradients import friction
from corota.gradients.differences import derivative
from corota.gradients.measures import Measure, SpecialMeasure
from corota.gradients.motion import Rates
from corota.gradients.surfaces import evaluate, slide
from corota.gradients.surfaces import solve as solve_with_surfaces
from corota.model.dofs import dof_index
from corota.model.paths import DisplacementControl

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.analysis.equations import System
    from corota.arrays import Floats
    from corota.gradients.trajectory import Increment, Point, Trajectory
    from corota.model.steps import Step


#: Largest change of an adjoint state by its last correction, over its size, and where it does not
#: fall any more.
ADJOINT, ROUNDED = 1e-12, 1e-8
#: Corrections of an adjoint state with a tangent that is not exact.
CORRECTIONS = 20


@dataclass
class Adjoint:
    """Adjoint states of some measures at one increment.

    Parameters
    ----------
    increment : Increment
    measures : list of (int, Measure)
        Those of this frame, with their columns.
    forces : ndarray, shape (n_dofs, m)
        Weights z of the residual.
    histories : sequence of sequence of ndarray
        Weights y of the new histories, by measure; empty where there are none.
    """

    increment: Increment
    measures: list[tuple[int, Measure]]
    forces: Floats
    histories: Sequence[Sequence[Floats]] = field(default_factory=list)
    #: Weights of what a path prescribes, by column, and its value; None by load control.
    control: tuple[Floats, float] | None = None
    #: Weights of the gaps of closed surfaces, shape (n_multipliers, m); None without contact.
    multipliers: Floats | None = None
    #: Weights of residuals that must not depend on a parameter, shape (n_dofs, m).
    vanishing: Floats | None = None
    #: Weights of the velocity at the start of a motion, shape (n_dofs, m).
    velocity: Floats | None = None
    #: Weights of what the equation of motion does not have there, shape (n_dofs, m).
    trace: Floats | None = None

    @property
    def weights(self) -> Floats:
        """Those of the measures, then those that vanish, shape (n_dofs, 2 m)."""
        zero = np.zeros_like(self.forces) if self.vanishing is None else self.vanishing
        return np.concatenate([self.forces, zero], axis=1)


class Field(ABC):
    """Many numbers of the elements at once, by derivatives of the core."""

    @abstractmethod
    def wanted(self) -> str:
        """Derivative of the core that it takes."""

    @abstractmethod
    def gather(self, trajectory: Trajectory, found: dict[str, Any]) -> Floats:
        """Gradient from derivatives of the elements."""

    @abstractmethod
    def require(self, trajectory: Trajectory, adjoint: Adjoint) -> None:
        """Refuse what depends on the parameter beside the elements.

        Raises
        ------
        UnsupportedError
        """


@dataclass
class FieldSums:
    """Gradients of measures by fields, summed over the increments.

    Parameters
    ----------
    fields : sequence of Field
    """

    fields: Sequence[Field]
    #: By field, shape (n_measures, ...); empty before the first increment.
    rows: list[Any] = field(default_factory=list)

    def add(
        self, trajectory: Trajectory, adjoint: Adjoint, found: Sequence[dict[str, Any]]
    ) -> None:
        """Add derivatives of the elements at an increment, one for each measure.

        Raises
        ------
        UnsupportedError
            If more than the elements depends on a field.
        """
        own = []
        for each in self.fields:
            each.require(trajectory, adjoint)
            for _, leaf in adjoint.measures:
                if not leaf.state_only:
                    raise UnsupportedError(
                        f"{leaf!r} depends on {each.wanted()} itself: take gradients.Attribute or "
                        "Shape"
                    )
            own.append(np.stack([each.gather(trajectory, one) for one in found]))
        self.rows = [a + b for a, b in zip(self.rows, own, strict=True)] if self.rows else own


def adjoints(
    trajectory: Trajectory,
    increments: Sequence[Increment],
    leaves: Sequence[Measure],
    wanted: bool = True,
    sums: FieldSums | None = None,
) -> tuple[list[float], list[Adjoint]]:
    """Values of simple measures, and their adjoint states in the order of the increments.

    Parameters
    ----------
    trajectory : Trajectory
        Of the model of the run.
    increments : sequence of Increment
        All of the run; those of materials with history get their histories.
    leaves : sequence of Measure
    wanted : bool
        Without it the values alone.
    sums : FieldSums, optional
        Takes derivatives of the elements on the way back, where materials have histories and
        nothing moves.

    Raises
    ------
    UnsupportedError
        If the derivative of a measure is not included.
    """
    values = [0.0] * len(leaves)
    at_frame: dict[int, list[tuple[int, Measure]]] = {}
    frames = {i.frame for i in increments if i.rates is None or i.dt}
    last_frame = max(frames)
    moves = increments[-1].rates is not None
    if moves and any(isinstance(leaf, SpecialMeasure) for leaf in leaves):
        raise UnsupportedError("critical loads and frequencies belong to static steps")
    if trajectory.remembers and any(isinstance(leaf, SpecialMeasure) for leaf in leaves):
        raise UnsupportedError(
            "critical loads and frequencies of materials with history have no gradient: their "
            "tangent jumps where a point begins to flow"
        )
    if trajectory.system.joined:
        _refuse_with_surfaces(trajectory, leaves)
    for column, leaf in enumerate(leaves):
        frame = leaf.frame if leaf.frame >= 0 else last_frame + 1 + leaf.frame
        if frame not in frames:
            raise UnsupportedError(
                f"measure {leaf!r}: frame {leaf.frame} is no converged increment"
            )
        at_frame.setdefault(frame, []).append((column, leaf))
    reverse: list[Adjoint] = []
    if trajectory.slides:
        return values, _sliding(trajectory, increments, at_frame, values, wanted)
    if not trajectory.remembers and not moves:
        for point in trajectory.walk(_needed(increments, at_frame)):
            own = at_frame.get(point.increment.frame, [])
            plain = [(c, leaf) for c, leaf in own if not isinstance(leaf, SpecialMeasure)]
            if not wanted:
                for column, leaf in plain:
                    values[column] = leaf.value(point)
            elif plain:
                reverse.append(_single(trajectory, point, plain, values, len(leaves)))
            for column, leaf in own:
                if isinstance(leaf, SpecialMeasure):
                    reverse.append(_special(trajectory, point, column, leaf, values))
        return values, reverse
    # Histories first, then the adjoint states backwards, on the same equations.
    for point in trajectory.walk(increments):
        for column, leaf in at_frame.get(point.increment.frame, []):
            values[column] = leaf.value(point)
    if not wanted:
        return values, []
    y: list[list[Floats]] = [[] for _ in leaves]
    final = max(at_frame)
    step = increments[-1].step
    later = None
    if moves:
        later = Rates(*np.zeros((4, trajectory.system.n_dofs, len(leaves))))
        sums = None
    for k in range(len(increments) - 1, -1, -1):
        if increments[k].frame > final:
            continue
        if increments[k].step != step:
            step = increments[k].step
            trajectory = trajectory.at_step(increments, step)
        reverse.append(_backward(trajectory, increments[k], at_frame, y, len(leaves), later, sums))
    return values, reverse[::-1]


def _refuse_with_surfaces(trajectory: Trajectory, leaves: Sequence[Measure]) -> None:
    """Refuse what adjoint states with contact do not include."""
    why = ""
    if trajectory.remembers:
        why = "materials with history"
    elif any(isinstance(leaf, SpecialMeasure) for leaf in leaves):
        why = "critical loads and frequencies"
    elif any(getattr(step, "path", None) is not None for step in trajectory.steps):
        why = "paths (arc length, displacement control); prescribe the displacement at a support"
    if why:
        raise UnsupportedError(f"gradients with contact or ties do not include {why}")


def _needed(
    increments: Sequence[Increment], at_frame: dict[int, list[tuple[int, Measure]]]
) -> list[Increment]:
    """Increments of the measures, and the last of each step before."""
    final = max(at_frame)
    ends = {increment.step: increment.frame for increment in increments}
    wanted = {*at_frame, *ends.values()}
    return [i for i in increments if i.frame in wanted and i.frame <= final]


def _single(
    trajectory: Trajectory,
    point: Point,
    own: list[tuple[int, Measure]],
    values: list[float],
    count: int,
) -> Adjoint:
    """Adjoint states at an increment without histories."""
    trajectory.require_equilibrium(point)
    system = trajectory.system
    rhs, moved = np.zeros((2, system.n_dofs, count))
    for column, leaf in own:
        values[column] = leaf.value(point)
        rhs[:, column] = -leaf.by_displacement(point)
        moved[:, column] = leaf.by_reaction(point)
    surfaces = point.increment.surfaces
    if surfaces is not None:
        time = point.increment.time
        z, y = solve_with_surfaces(system, point.u, time, surfaces, rhs, moved)
        return Adjoint(point.increment, own, z, multipliers=y)
    adjoint = Adjoint(point.increment, own, _solve(trajectory, point, rhs, moved))
    _at_fixed_control(trajectory, point, own, adjoint)
    return adjoint


def _sliding(
    trajectory: Trajectory,
    increments: Sequence[Increment],
    at_frame: dict[int, list[tuple[int, Measure]]],
    values: list[float],
    wanted: bool,
) -> list[Adjoint]:
    """Adjoint states with friction, backwards, on the states of one way forward."""
    system, count = trajectory.system, len(values)
    points: list[Point] = []
    for point in trajectory.walk(increments):
        trajectory.require_equilibrium(point)
        points.append(point)
        for column, leaf in at_frame.get(point.increment.frame, []):
            values[column] = leaf.value(point)
    if not wanted:
        return []
    reverse: list[Adjoint] = []
    later = np.zeros((system.n_dofs, count))
    final = max(at_frame)
    points = [point for point in points if point.increment.frame <= final]
    step = increments[-1].step
    for k in range(len(points) - 1, -1, -1):
        point = points[k]
        if point.increment.step != step:
            step = point.increment.step
            trajectory = trajectory.at_step(increments, step)
            system = trajectory.system
        _return_to(trajectory, points, k)
        rhs, moved = -later, np.zeros((system.n_dofs, count))
        own = at_frame.get(point.increment.frame, [])
        for column, leaf in own:
            rhs[:, column] -= leaf.by_displacement(point)
            moved[:, column] = leaf.by_reaction(point)
        time, surfaces = point.increment.time, point.increment.surfaces
        assert surfaces is not None
        z, y = friction.solve(system, point.u, time, surfaces, rhs, moved)
        later = friction.by_start(system, point.u, time, surfaces, z, y)
        reverse.append(Adjoint(point.increment, own, z, multipliers=y))
    return reverse[::-1]


def _return_to(trajectory: Trajectory, points: Sequence[Point], k: int) -> None:
    """Let slips begin where increment k begins."""
    if k > 0:
        before = points[k - 1]
        assert before.increment.surfaces is not None
        evaluate(
            trajectory.system,
            before.u,
            before.increment.surfaces.multipliers,
            before.increment.time,
        )
        trajectory.slide(before.u, before.increment)
        return
    slide(trajectory.system)


def _special(
    trajectory: Trajectory,
    point: Point,
    column: int,
    leaf: SpecialMeasure,
    values: list[float],
) -> Adjoint:
    """Adjoint state of a measure that finds it itself, about a state that it may improve."""
    trajectory.require_equilibrium(point)
    own = replace(point, increment=replace(point.increment))
    z = np.zeros((trajectory.system.n_dofs, len(values)))
    z[:, column] = leaf.adjoint(trajectory, own)
    values[column] = leaf.value(own)
    vanishing = None
    if (weights := leaf.vanishing(own)) is not None:
        vanishing = np.zeros_like(z)
        vanishing[:, column] = weights
    return Adjoint(own.increment, [(column, leaf)], z, vanishing=vanishing)


def _backward(
    trajectory: Trajectory,
    increment: Increment,
    at_frame: dict[int, list[tuple[int, Measure]]],
    y: list[list[Floats]],
    count: int,
    later: Rates | None,
    sums: FieldSums | None,
) -> Adjoint:
    """Adjoint states at an increment; `y` and `later` are taken to the increment before."""
    system = trajectory.system
    core = system.core
    if trajectory.remembers:
        core.set_histories(list(increment.histories))
    point = trajectory.point(increment)
    trajectory.require_equilibrium(point)
    here, nothing = system.in_space(point.u), np.zeros(system.n_dofs)
    rhs, moved = np.zeros((2, system.n_dofs, count))
    own = at_frame.get(increment.frame, [])
    motion = trajectory.motion
    if later is not None:
        assert motion is not None
        for column, leaf in own:
            later.v[:, column] += leaf.by_velocity(point)
        rhs -= motion.by_end_state(later, increment.dt)
        if not increment.dt:
            z = _solve(trajectory, point, rhs, moved)
            passed = np.zeros_like(z)
            if later.weights is not None:
                passed = motion.begun * later.weights
            return Adjoint(increment, own, z + passed, velocity=later.v.copy(), trace=-passed)
    for column, leaf in own:
        rhs[:, column] -= leaf.by_displacement(point)
        moved[:, column] = leaf.by_reaction(point)
    # Whether the tangent may differ from the derivative: not known before the laws are met.
    correct = trajectory.remembers
    for column in range(count):
        if y[column]:
            found = core.differentiate(here, system.nlgeom, nothing, y[column], ["displacements"])
            rhs[:, column] -= system.at_nodes(found["displacements"])
            correct = not found["exact"]
    z = _solve(trajectory, point, rhs, moved, correct)
    adjoint = Adjoint(increment, own, z, [trajectory.store.keep(each) for each in y])
    _at_fixed_control(trajectory, point, own, adjoint, correct)
    if later is not None:
        assert motion is not None
        vars(later).update(vars(motion.before(later, z, increment.dt)))
    if not trajectory.remembers:
        return adjoint
    fields = sums.fields if sums is not None else ()
    inputs, derivatives = ["state", *(each.wanted() for each in fields)], []
    for column in range(count):
        force = np.ascontiguousarray(system.in_space(z[:, column]))
        if not (force.any() or y[column] or own or fields):
            continue
        found = core.differentiate(here, system.nlgeom, force, y[column], inputs)
        y[column] = [np.array(each) for each in found["state"]]
        derivatives.append(found)
    if sums is not None:
        sums.add(trajectory, adjoint, derivatives)
    for column, leaf in own:
        direct = leaf.by_histories(point)
        if direct is not None:
            before = y[column] or [np.zeros(len(h)) for h in increment.histories]
            y[column] = [a + b for a, b in zip(before, direct, strict=True)]
    return adjoint


def _solve(
    trajectory: Trajectory, point: Point, rhs: Floats, moved: Floats, correct: bool = False
) -> Floats:
    """Solve ``(dr/du)^T z = rhs`` with given z at prescribed dofs.

    With `correct` the elements have their differentiated forces: some laws have a symmetric
    tangent that is not quite their derivative.
    """
    system = trajectory.system
    at = system.evaluate(point.u, point.increment.time)
    if trajectory.motion is not None:
        trajectory.motion.stiffen(at, point.increment.dt)
    tangent = _of_elements(point) if correct else None
    z = system.correct_adjoint(at, rhs, moved)
    if tangent is None:
        return z
    first, previous = z, np.inf
    size = float(np.abs(z).max(initial=0.0))
    for _ in range(CORRECTIONS):
        parts = [_missing(point, tangent, column) for column in z.T]
        if all(exact for _, exact in parts):
            return z
        force = np.stack([part for part, _ in parts], axis=1)
        force[system.conditions.constrained] = 0.0
        new = first + system.solve_with_last_factor(force)
        change = float(np.abs(new - z).max(initial=0.0))
        z = new
        if change <= ADJOINT * size or (change > 0.5 * previous and change <= ROUNDED * size):
            return z
        if change > 2.0 * previous:
            break
        previous = change
    raise UnsupportedError(
        f"frame {point.increment.frame}: the adjoint state does not converge: the tangent of a "
        "material is far from its derivative there"
    )


def _of_elements(point: Point) -> Floats:
    """Tangent of the elements alone, upper triangle: that of an evaluation contains loads."""
    system = point.system
    force, scale = np.zeros((2, system.n_dofs))
    values: Floats = system.pattern.zeros()
    here = system.in_space(point.u)
    system.core.assemble(here, system.nlgeom, force, scale, values, system.about_linear)
    return values


def _missing(point: Point, tangent: Floats, z: Floats) -> tuple[Floats, bool]:
    """Product of the tangent of the elements with z, less that of their derivative.

    Returns
    -------
    difference : ndarray, shape (n_dofs,)
    exact : bool
        Whether the tangents of all laws are derivatives, so that it is rounding.
    """
    system = point.system
    here, weights = system.in_space(point.u), np.ascontiguousarray(system.in_space(z))
    found = system.core.differentiate(here, system.nlgeom, weights, [], ["displacements"])
    product = system.product(tangent, np.ascontiguousarray(z))
    return product - system.at_nodes(found["displacements"]), found["exact"]


def _at_fixed_control(
    trajectory: Trajectory,
    point: Point,
    own: list[tuple[int, Measure]],
    adjoint: Adjoint,
    correct: bool = False,
) -> None:
    """Correct adjoint states where the load factor is an unknown and a displacement is prescribed.

    Raises
    ------
    UnsupportedError
        If nothing that a parameter leaves alone defines the state on its path.
    """
    system, increment, z = trajectory.system, point.increment, adjoint.forces
    needed = bool(own) or trajectory.remembers
    terms = controlled(trajectory.steps[increment.step], increment, needed)
    if terms is None:
        if any(leaf.by_factor(point) for _, leaf in own):
            raise UnsupportedError(
                "a load factor has a gradient at a given displacement (DisplacementControl); by "
                "load control it is given"
            )
        return
    if trajectory.remembers and (
        np.any(system.conditions.supports.change()) or system.conditions.heating.any()
    ):
        raise UnsupportedError(
            "gradients of materials with history along a path include forces alone, no moving "
            "supports and temperatures"
        )
    row = control_row(system, terms)
    none = np.zeros((system.n_dofs, 1))
    y = _solve(trajectory, point, row[:, None], none, correct)[:, 0]
    rate = factor_rate(point)
    weights = np.zeros(z.shape[1])
    factors = {column: leaf.by_factor(point) for column, leaf in own}
    for column in range(z.shape[1]):
        missing = factors.get(column, 0.0) + z[:, column] @ rate
        weights[column] = missing / (y @ rate)
        z[:, column] -= weights[column] * y
    adjoint.control = weights, float(row @ point.u)


def controlled(step: Step, increment: Increment, needed: bool) -> list[Any] | None:
    """Terms of the displacement that defines a state on a path; None where its load does.

    Raises
    ------
    UnsupportedError
        If it is defined by a length along the path.
    """
    path = getattr(step, "path", None)
    if isinstance(path, DisplacementControl):
        return path.terms
    if path is None and not increment.along:
        return None
    factor = 1.0 if path is None else path.factor
    if factor is not None and abs(increment.factor - factor) <= 1e-9 * max(1.0, abs(factor)):
        return None
    if path is not None and path.displacement is not None and increment.last:
        where, dof, _ = path.displacement
        return [(where, dof, 1.0)]
    if not needed:
        return None
    raise UnsupportedError(
        f"frame {increment.frame} lies at an arc length, which parameters change: take the end of "
        "the path, at a load factor or a displacement, or DisplacementControl"
    )


def control_row(system: System, terms: Sequence[Any]) -> Floats:
    """Weights by dof of a controlled displacement, along the axes of the nodes."""
    row = np.zeros(system.n_dofs)
    for where, dof, weight in terms:
        nodes = np.atleast_1d(system.model.mesh.node_indices(where))
        np.add.at(row, system.dofs(nodes, dof_index(dof)), weight / len(nodes))
    return row


def factor_rate(point: Point) -> Floats:
    """Derivative of the residual by the load factor at fixed unknowns, shape (n_dofs,)."""
    system, increment = point.system, point.increment
    period = system.conditions.factors.period

    def residual(offset: float) -> tuple[Floats, Floats]:
        time = increment.time + offset * period
        u = system.conditions.supports.at(time, point.u)
        system.constraints.complete(u)
        at = system.forces(u, time)
        return at.reaction, at.scale

    slope, _ = derivative(residual, max(abs(increment.factor), 1.0))
    return slope
