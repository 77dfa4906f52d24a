"""How a motion starts: densities, velocities, accelerations."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.rule import AtVelocity
from corota.analysis.terms.damping import Damping
from corota.analysis.terms.inertia import Inertia, MotionState
from corota.analysis.terms.term import StatePoint
from corota.errors import ModelError
from corota.mesh.parts import nodes_of
from corota.model import elements

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.state import State
    from corota.analysis.terms.viscous import ViscousElements
    from corota.arrays import Floats
    from corota.model.steps import Dynamic


#: Share of the increment whose square weighs the stiffness in the first accelerations.
TRACE = 1e-3
#: Initial velocities may break constraints by this share of the largest.
UNEQUAL = 1e-9


def check_density(system: System) -> None:
    """Refuse materials without mass."""
    for block in system.blocks:
        material = block.section.material
        if material.rho <= 0.0 and not elements.find(block.section.element).spring:
            raise ModelError(
                f"material {material.name or material.law!r} has no density, which dynamics "
                "needs; add one (*DENSITY, rho=)",
                material.where or block.section.where,
            )


def start_motion(
    system: System, step: Dynamic, state: State, inertia: Inertia, viscous: ViscousElements
) -> MotionState:
    """Velocities and accelerations at the start of a step."""
    zero = np.zeros(system.n_dofs)
    if state.v is None:
        state.v = initial_velocity(system, state.u)
    support_a = _start_supports(system, step, state)
    u, v = state.u, state.v
    last = state.carried
    goes_on = last is not None and last[0] is u and last[1] is v
    goes_on = goes_on and step.scheme == "energy_momentum"
    if goes_on and last is not None:
        v = np.where(system.conditions.constrained, v, last[2])
    # Dependent dofs accelerate as they turn, before their masters do. Where the scheme goes on
    # they keep their own velocities, which are those of its mid-point relations.
    system.constraints.complete_rates(u, v.copy() if goes_on else v, zero)
    at = system.evaluate(u, 0.0, AtVelocity(v))
    force = inertia.force(u, v, zero)
    # Bodies may rest on each other from a step before.
    resting = system.multiplier_force(u, at.values)
    Damping(inertia, step.rayleigh[0], viscous, u).add(StatePoint(u, 0.0, v), at)
    assert at.damping is not None
    internal, external, damping = at.internal, at.external, at.damping
    # M a = f_ext - f_int - f_I(v) - damping, where supports have their own accelerations.
    trace = _weigh_as_mass(system, step, inertia, at, u)
    at.internal = internal + force + damping - resting
    link = at.link
    at.link = link.linear()
    solved = system.predict(at, support_a)[0]
    if inertia.massless.any():
        # What nodes without mass need for their balance is a jump of their place, which they pass
        # on to their neighbors, and no acceleration: solved again for the momenta of the first
        # solution, M a = M a1, nothing jumps.
        solved -= system.solve_with_last_factor(system.product(trace, solved))
        solved[inertia.massless & ~system.conditions.constrained] = 0.0
    # Dependent dofs have their centripetal accelerations besides.
    a = zero + solved
    state.a = a
    if not goes_on:
        system.core.start_motion(system.in_space(u), system.in_space(v))
    now = MotionState(u, v, a, internal, external, inertia.force(u, v, a), damping, link)
    if inertia.massless.any():
        # Schemes that weigh both ends of an increment find nothing out of balance at its start.
        loose = ~system.conditions.constrained
        loose[system.constraints.eliminated] = False
        now.inertia[loose] -= (now.reaction() - link.gather(resting))[loose]
    return now


def admissible_velocity(
    system: System, step: Dynamic, inertia: Inertia, now: MotionState, step_time: float
) -> Floats:
    """The velocity that constraints allow and that has the momenta of the one given.

    The mid-point rule holds constraints over increments; the velocities that it carries on swing
    about those at their ends, by as much as speeds change within an increment. What they have in
    the motions that constraints leave free is exact: ``G^T M G w = G^T M v``.
    """
    u, v = now.u, now.v
    if not len(system.constraints.eliminated):
        return v
    found: Floats = v.copy()
    zero = np.zeros_like(v)
    system.constraints.complete_rates(u, found, zero.copy())
    if not (found - v).any():
        return v
    at = system.evaluate(u, step_time)
    momentum = inertia.force(u, zero, v - found)
    _weigh_as_mass(system, step, inertia, at, u)
    at.internal, at.external = -momentum, zero
    at.link = at.link.linear()
    found += system.predict(at, zero)[0]
    return found


def _weigh_as_mass(
    system: System, step: Dynamic, inertia: Inertia, at: Evaluation, u: Floats
) -> Floats:
    """Put the mass in the place of the tangent, in place; returns what it has of the tangent.

    The consistent mass of drilling elements has none for a uniform drilling rotation, which
    follows quasi-statically, as nodes do whose mass others carry; a trace of the stiffness decides
    it.
    """
    share = 0.0
    if system.is_rotation.any() or inertia.massless.any():
        share = TRACE * (step.period if not step.fixed_increments else step.first_increment)
    trace: Floats = share**2 * at.values
    at.values[:] = inertia.tangent(u) + trace
    at.load_stiffness = None
    return trace


def resting(system: System) -> MotionState:
    """No motion at all."""
    return MotionState(*np.zeros((7, system.n_dofs)))


def _start_supports(system: System, step: Dynamic, state: State) -> Floats:
    """Set the velocity of prescribed dofs; returns their acceleration, shape (n_dofs,).

    Both are evaluated over the first increment.
    """
    assert state.v is not None
    constrained = system.conditions.constrained
    whole = not step.fixed_increments and step.first_increment >= step.period
    window = step.period / 100.0 if whole else step.first_increment
    v, a = system.conditions.supports.rates(0.0, window)
    state.v[constrained] = v[constrained]
    for name, time in system.conditions.supports.kinks():
        state.notes.append(
            f"the amplitude {name!r} of a support changes its velocity at once at step time "
            f"{time:.4g}: acceleration and reaction have a pulse there, whose height depends on "
            "the increment; smooth the amplitude if that is not intended"
        )
    return a


def initial_velocity(system: System, u: Floats | None = None) -> Floats:
    """The model's initial velocities by dof; a spin is that of the displaced body."""
    out = np.zeros((len(system.per_node), 3))
    points = system.model.mesh.points
    u = np.zeros(system.n_dofs) if u is None else u
    if system.nlgeom:
        points = points + system.by_node(u)[:, :2]
    for item in system.model.velocities:
        nodes = nodes_of(system.model.mesh, item.nodes)
        if item.dof is not None:
            out[nodes, item.dof] = item.value[0]
            continue
        vx, vy, spin, x0, y0 = (*item.value, 0.0, 0.0, 0.0)[:5]
        out[nodes, 0] = vx - spin * (points[nodes, 1] - y0)
        out[nodes, 1] = vy + spin * (points[nodes, 0] - x0)
        out[nodes, 2] = spin
    v = system.from_nodes(out)
    _follow_constraints(system, u, v)
    return v


def _follow_constraints(system: System, u: Floats, v: Floats) -> None:
    """Give dependent dofs the velocity that follows from the others, in place.

    Raises
    ------
    ModelError
        If another one was given.
    """
    given = v.copy()
    system.constraints.complete_rates(u, v)
    off = (given != 0.0) & (np.abs(given - v) > UNEQUAL * np.abs(v).max(initial=0.0))
    if off.any():
        dof = int(np.flatnonzero(off)[0])
        raise ModelError(
            f"the initial velocity of {system.describe(dof)}, {given[dof]:g}, breaks the "
            f"constraint that determines it, which gives {v[dof]:g}: give the velocity to the "
            "nodes it depends on too (a reference node has a rotation, dof 6 in decks)",
            next((item.where for item in system.model.velocities if item.where), None),
        )
