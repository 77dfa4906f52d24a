"""Linear buckling about an equilibrium state.

With the tangent K0 at the state and its derivative K1 along the linear response to the
perturbing load, the factors solve ``(K0 + factor K1) mode = 0``. The derivative is taken of
the whole co-rotational tangent by a central difference: it holds the geometric stiffness of
the added stresses and the change of shape before buckling. Where nothing turns before it
buckles, as in a straight column, this is classical linear buckling; where something does,
it is the path's own first-order prediction. About the state of a geometrically linear step it
is classical linear buckling in any case: stresses act on the reference shape.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.evaluation import Evaluation
from corota.analysis.linear.lanczos import BLOCK, largest
from corota.analysis.procedures.buckling_contact import factors_with_contact
from corota.analysis.procedures.buckling_free import FreeMotions
from corota.analysis.terms.conditions import Conditions
from corota.errors import ConvergenceError, ModelError, UnsupportedError
from corota.model.paths import Modes

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.increment_loop import IncrementLoop
    from corota.arrays import Floats
    from corota.model.steps import Buckle


#: Largest displacement of the difference, as a share of the model's size.
DIFFERENCE = 1e-5
#: Second over first difference of the tangent that shows a jump.
CORNER = 0.1
#: Residual of the modes: the factors' own error is of its square.
RESIDUAL = 1e-4
#: What is noted where loads keep their directions.
DEAD = (
    "pressures that would follow the structure have no potential here and keep their directions, "
    "as in CalculiX; whether they flutter as followers is a matter of dynamics"
)
#: Where the modes are counted: this far behind the last one that was found.
BEHIND = 1e-3


def buckle_step(loop: IncrementLoop, step: Buckle, stops: list[float]) -> None:
    """Find the buckling factors and modes about the committed state.

    Raises
    ------
    ModelError
        If nothing perturbs the state, or the state is unstable by itself.
    UnsupportedError
        If loads without a potential or a tangent that jumps leave no eigenvalue problem.
    """
    system, number, state = loop.system, loop.number, loop.state
    kinematics = system.nlgeom, system.about_linear
    # Without the preload it is the structure at rest that is followed.
    system.set_kinematics(True, about_linear=system.about_linear and step.preload)
    base = state.u
    dead: list[str] | None = [] if step.dead_loads else None
    notes: list[str] = []
    supported = system.conditions.constrained.copy()
    if not step.preload:
        _check_unloaded(system, step)
        base = np.zeros_like(state.u)
    try:
        factors, shapes = _solve(system, step, number, base, dead, notes)
    finally:
        # A perturbation leaves nothing behind.
        system.conditions.constrained[:] = supported
        system.conditions.end_time = 0.0
        system.set_kinematics(*kinematics)
        state.at = system.evaluate(state.u, 0.0)
    by_node = np.array([system.by_node(shape) for shape in shapes.T])
    state.modes.append(Modes("buckling", number, factors, by_node.reshape(len(factors), -1, 3)))
    scalars = {f"buckling factor {k}": float(f) for k, f in enumerate(factors, start=1)}
    listed = ", ".join(f"{f:.6g}" for f in factors)
    state.notes += [f"buckling step {number}: {note}" for note in (dead or []) + notes]
    state.notes.append(f"buckling factors of step {number}: {listed}")
    loop.save(state, 1, 0.0, scalars)


def _check_unloaded(system: System, step: Buckle) -> None:
    """Refuse to leave out a preload that has changed the material."""
    linear = all(block.section.material.linear for block in system.blocks)
    heated = system.free.responds and not system.free.follows(system.free.start)
    if heated or not linear:
        raise UnsupportedError(
            "buckling without the preload needs elastic material at its initial temperature; "
            "keep the preload (*STEP, PERTURBATION; preload=True) or buckle in the first step",
            step.where,
        )


def _solve(
    system: System,
    step: Buckle,
    number: int,
    u: Floats,
    dead: list[str] | None,
    notes: list[str],
) -> tuple[Floats, Floats]:
    force, move, loads = _perturbation(system, step, number, u)
    if system.n_multipliers:
        # With multipliers the stiffness is indefinite.
        factors, shapes = factors_with_contact(system, u, force, move, loads, step.modes)
        return factors, _largest_one(system, shapes)
    base = _symmetric(system, system.evaluate(u, 0.0), dead)
    values = _unknowns(system, base, base.residual)
    motions = FreeMotions(system, base, values, force, move)
    response = motions.response
    if motions.negative > 0:
        raise ModelError(
            f"the state before buckling step {number} is unstable ({motions.negative} negative "
            "pivots): linear buckling needs a stable one; follow its path instead "
            "(path=ArcLength(...))",
            step.where,
        )
    change = _derivative(system, u, values, response, loads, dead)
    if len(motions):
        notes.append(motions.load(change, step, number))
    largest_move = _moved(system, response, loads)
    constrained, free = system.conditions.constrained, system.constraints.free
    pattern = system.constraints.pattern

    def apply(x: Floats) -> Floats:
        out = np.zeros(x.shape, order="F")
        for k in range(x.shape[1]):
            out[free, k] = -pattern.multiply(change, np.ascontiguousarray(x[free, k]))
        out += motions.force(x)
        out[constrained] = 0.0
        return out

    def count(bound: float) -> int:
        """Negative pivots of the tangent at a factor: the modes in front of it."""
        at = values + bound * change
        pattern.mask(at, motions.held[free])
        inertia = system.linear.factorize(pattern, at)
        return -1 if inertia is None else inertia[1] - motions.driven

    start = np.random.default_rng(11).standard_normal((system.n_dofs, BLOCK))
    start[constrained] = 0.0
    wanted = step.modes
    for _ in range(3):
        theta, shapes = largest(
            apply, system.solve_with_last_factor, apply(start), wanted, RESIDUAL
        )
        # A load that would stretch the structure by its own size is not a buckling load.
        theta = theta[theta * system.length > largest_move]
        if not len(theta):
            raise ModelError(
                f"the load of buckling step {number} gives no positive factor; does it cause "
                "tension only?",
                step.where,
            )
        factors, shapes = 1.0 / theta, motions.shapes(shapes)
        if len(theta) < wanted or wanted > step.modes:
            break
        bound = float(factors[-1]) * (1.0 + BEHIND)
        passed = int((factors < bound).sum())
        missed = count(bound) - passed
        if missed <= 0:
            break
        wanted = step.modes + missed
        system.correct(replace(base, values=base.values.copy()), force, move)
    factors, shapes = factors[: step.modes], shapes[:, : min(step.modes, len(factors))]
    return factors, _largest_one(system, shapes)


def _largest_one(system: System, shapes: Floats) -> Floats:
    """Shapes whose largest displacement is 1, in place."""
    for shape in shapes.T:
        moved = np.where(system.counted, shape, 0.0)
        shape /= moved[np.abs(moved).argmax()]
    return shapes


def _unknowns(system: System, at: Evaluation, residual: Floats) -> Floats:
    """Values of the tangent of the unknowns, upper triangle; a copy."""
    return at.link.reduce(at.values.copy(), residual)


def _perturbation(
    system: System, step: Buckle, number: int, u: Floats
) -> tuple[Floats, Floats, Conditions]:
    """Force, prescribed displacements and loads that perturb the state."""
    model = system.model
    own = bool(step.loads) or any(s.value != 0.0 for s in step.supports)
    loads = Conditions(system)
    # As a force adds to the preload, so does what a temperature differs from the initial one.
    loads.temperatures.begin_at(system.free.start)
    with_model = number == 1 or not own
    loads.add_items(
        [*(model.loads if with_model else []), *step.loads],
        [*(model.supports if with_model else []), *step.supports],
    )
    loads.check_proportional()
    force, move = loads.rate(u)
    constrained = system.conditions.constrained
    move = np.where(constrained, move, 0.0)
    if not (np.any(force[~constrained]) or np.any(move) or system.free.largest(loads.heating)):
        raise ModelError(
            f"buckling step {number} has no load: give the step or the model one", step.where
        )
    return force, move, loads


def _moved(system: System, response: Floats, loads: Conditions) -> float:
    """Largest displacement of the response, or what thermal strain would move if it could."""
    moved = float(np.abs(response[system.counted]).max(initial=0.0))
    return max(moved, system.free.largest(loads.heating) * system.length)


def _derivative(
    system: System,
    u: Floats,
    values: Floats,
    response: Floats,
    loads: Conditions,
    dead: list[str] | None = None,
) -> Floats:
    """Derivative of the tangent `values` along the response, by entries of the pattern.

    Where constraints turn (rigid bodies), the forces in them count too: the residual at the
    neighbors is that under the perturbed load.
    """
    largest_move = _moved(system, response, loads)
    if not np.isfinite(largest_move):
        raise ConvergenceError("the perturbing load causes no displacement")
    # Where nothing moves, rigid bodies carry the load: what it does to their stiffness is linear.
    size = DIFFERENCE * system.length / largest_move if largest_move else 1.0

    heating = loads.heating if loads.heating.any() else None
    # Thermal strain is in the internal force of a neighbor already.
    mechanical = loads.external(loads.factors.period, u)[0] - loads.external(0.0, u)[0]

    def neighbor(h: float) -> Floats:
        system.free.offset = None if heating is None else h * heating
        try:
            at = _symmetric(system, system.evaluate(u + h * response, 0.0), dead)
        finally:
            system.free.offset = None
        return _unknowns(system, at, at.residual - h * mechanical)

    ahead, behind = neighbor(size), neighbor(-size)
    change: Floats = ahead - behind
    # A smooth tangent is nearly linear over such a distance; one that jumps has a corner.
    ahead += behind
    ahead -= 2.0 * values
    if np.abs(ahead).max() > CORNER * np.abs(change).max():
        raise UnsupportedError(
            "the tangent changes abruptly at this state (plastic flow, contact), so linear "
            "buckling is not meaningful; follow the path instead (path=ArcLength(...))"
        )
    change /= 2.0 * size
    # Entries of the load stiffness join the full tangent, since constraints reduce them too.
    zero, own = np.zeros(system.n_dofs), system.pattern.zeros()
    _, stiffness = loads.external(loads.factors.period, u, own)
    if stiffness is not None or own.any():
        at = _symmetric(system, Evaluation(zero, zero, zero, own, stiffness), dead)
        change += _unknowns(system, replace(at, link=system.constraints.link(u)), zero)
    if largest_move == 0.0 and not change.any():
        raise ConvergenceError("the perturbing load causes no displacement")
    return change


def _symmetric(system: System, at: Evaluation, dead: list[str] | None) -> Evaluation:
    """The evaluation with the stiffness of its loads in its values.

    Where that has no potential, loads are refused, or keep their directions; `dead` takes a note.
    """
    if at.load_stiffness is None:
        return at
    symmetric, _ = system._add_load_stiffness(at)
    if not symmetric and dead is not None:
        dead[:] = [DEAD]
    elif not symmetric:
        raise UnsupportedError(
            "loads that follow the structure without a potential have no buckling factors "
            "(non-conservative: use dynamics; dead_loads=True keeps their directions)"
        )
    return replace(at, load_stiffness=None)
