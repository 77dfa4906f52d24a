"""Central differences: explicit time integration with the lumped mass."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.damping import material_pairs
from corota.errors import ConvergenceError, InputError, Interrupted, ModelError, UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.equations import Evaluation, System
    from corota.analysis.observers import Observers
    from corota.analysis.state import State
    from corota.model.steps import Dynamic

    Floats = NDArray[np.float64]

#: Share of the stable increment that automatic increments take.
SAFETY = 0.9
#: Iterations for the largest frequency; its estimate rises to the true value.
POWER = 60
#: Total energy, relative to the energy put in, that may be a blow-up.
BLOW_UP = 10.0
#: Moves within an increment, relative to the model's size, that are as good as none.
ROUND_OFF = 1e-12
#: Unbalanced force at dofs without mass, relative to the largest force, that is none.
BALANCED = 1e-9
#: Most frames that are kept of a step unless outputs ask for times.
FRAMES = 200


def diagonal(system: System) -> Floats:
    """Lumped mass by dof, shape (n_dofs,) [mass], [mass*length^2] for rotations."""
    from corota.analysis.procedures.motion import Inertia

    values = Inertia(system, "lumped").matrix
    assert values is not None
    return values[system.pattern.diagonal]


def stable_increment(system: System, u: Floats, mass: Floats) -> float:
    """Largest stable increment, 2 / (largest frequency) [time].

    Only dofs that are free and have mass count: held ones follow their supports, with or without
    mass. It is infinite if none of those has stiffness.

    Raises
    ------
    ModelError
        If a free dof has stiffness but no mass, or if the frequency is not finite.
    """
    free = ~system.conditions.constrained
    moving = free & (mass > 0.0)
    values = system.evaluate(u, 0.0).values
    idle = free & ~moving
    if idle.any():
        # What the free dofs without mass feel, whichever dof moves.
        felt = system.pattern.largest_by_row(values)
        _refuse_idle(system, idle & (felt > 0.0), "has stiffness but no mass")
    if not moving.any():
        return np.inf
    inverse = np.divide(1.0, mass, out=np.zeros_like(mass), where=moving)
    x = np.where(moving, np.random.default_rng(0).standard_normal(system.n_dofs), 0.0)
    largest = 0.0
    for _ in range(POWER):
        x /= np.sqrt(x @ (mass * x))
        y = np.where(moving, system.pattern.multiply(values, x), 0.0)
        largest = float(x @ y)
        x = inverse * y
        if not x.any():
            return np.inf
    if not np.isfinite(largest):
        raise ModelError(
            "the largest frequency is not finite, so central differences have no stable "
            "increment: check stiffness and mass, or use an implicit scheme"
        )
    return 2.0 / float(np.sqrt(largest)) if largest > 0.0 else np.inf


def _refuse_idle(system: System, idle: NDArray[np.bool_], what: str) -> None:
    """Refuse the first of some free dofs without mass."""
    if idle.any():
        raise ModelError(
            f"{system.describe(int(np.flatnonzero(idle)[0]))} {what}: central differences cannot "
            "move it; add a point mass, hold it, or use an implicit scheme"
        )


def explicit_step(
    system: System,
    step: Dynamic,
    number: int,
    state: State,
    observers: Observers,
    save: Callable[[State, int, float, dict[str, float]], None],
    stops: list[float],
) -> None:
    """Run a step with central differences.

    Raises
    ------
    InputError
        If there is damping, which this scheme leaves out.
    UnsupportedError
        If there are constraints or contact.
    ModelError
        If the asked increment is not stable; the message gives the stable one. If a free dof
        with stiffness or load has no mass, or if there is no stiffness to find an increment from.
    ConvergenceError
        If the motion blows up all the same.
    """
    from corota.analysis.procedures.dynamic import initial_velocity

    if system.model.dashpots or any(step.rayleigh) or material_pairs(system):
        raise InputError(
            "central differences take no damping: use an implicit scheme, or remove dashpots and "
            "rayleigh",
            step.where,
        )
    if system.link.couples:
        raise UnsupportedError(
            "central differences take no constraints and no local axes: eliminated dofs couple "
            "the masses of others, and the mass is no diagonal any more; use an implicit scheme",
            step.where,
        )
    system.contact_term.check_explicit(step)
    mass = diagonal(system)
    constrained = system.conditions.constrained
    resumes = bool(state.resumes)
    stable = np.inf if resumes else stable_increment(system, state.u, mass)
    if resumes:
        dt = step.period  # the checkpoint knows it
    elif step.fixed_increments:
        dt = step.first_increment
        if dt > stable:
            raise ModelError(
                f"the increment {dt:g} is above the stable one of central differences, "
                f"{stable:.4g}; use at most {SAFETY * stable:.3g}, or an implicit scheme",
                step.where,
            )
    elif not np.isfinite(stable):
        raise ModelError(
            "nothing that is free to move has stiffness at the start, so there is no stable "
            "increment to take: give increments, or use an implicit scheme",
            step.where,
        )
    else:
        dt = min(SAFETY * stable, step.largest_increment)
    n = max(int(np.ceil(step.period / dt * (1.0 - 1e-12))), 1)
    dt = step.period / n
    keep = max(n // FRAMES, 1)
    wanted = {round(s / dt) for s in stops}
    state.counters["stable increment"] = stable  # type: ignore[assignment]
    if state.v is None:
        state.v = initial_velocity(system, state.u)
    rates = system.conditions.support_rates(0.0, dt)[0]
    state.v[constrained] = rates[constrained]
    u = state.u.copy()
    at = system.evaluate(u, 0.0)
    moving = ~constrained & (mass > 0.0)
    idle = ~constrained & ~moving
    inverse = np.divide(1.0, mass, out=np.zeros_like(mass), where=moving)
    if not resumes:
        _refuse_pushed(system, idle, at)
    a = -inverse * at.residual
    account = state.energies
    assert account is not None
    account.drive(at.external, at.residual)
    begin = account.work
    v = state.v + 0.5 * dt * a
    work = internal = told = 0.0
    first = 0.5 * float(state.v @ (mass * state.v))
    known = Known(system, mass, first, dt)
    account.set_kinetic(first)
    driven = 0.5 * float((mass * state.v**2)[constrained].sum())
    done = 0
    if resumes:
        loop = state.resume("explicit", known=known)
        done, n, keep, wanted = loop["done"], loop["n"], loop["keep"], loop["wanted"]
        dt, stable, u, v, at = loop["dt"], loop["stable"], loop["u"], loop["v"], loop["at"]
        begin, work, internal, told = loop["begin"], loop["work"], loop["internal"], loop["told"]
        driven = loop["driven"]
    for i in range(done + 1, n + 1):
        time = i * dt
        du = np.where(constrained, system.conditions.prescribed(time, u) - u, dt * v)
        u = u + du
        new = system.evaluate(u, time)
        system.commit()
        _refuse_pushed(system, idle, new)
        a = -inverse * new.residual
        account.add_work(du, new.external, new.residual)
        internal += float(0.5 * (at.internal + new.internal) @ du)
        # Prescribed dofs have the rates of their amplitude, as in the implicit schemes.
        given_v, given_a = system.conditions.support_rates(time, dt)
        whole = np.where(constrained, given_v, v + 0.5 * dt * a)
        # Supports accelerate the mass that moves with them.
        moved = 0.5 * float((mass * whole**2)[constrained].sum())
        account.work += moved - driven
        worked = account.work - begin - work
        driven, work = moved, account.work - begin
        v = np.where(constrained, given_v, v + dt * a)
        stiff = float(np.where(moving, new.internal - at.internal, 0.0) @ du)
        inert = float(np.where(moving, mass * du, 0.0) @ du)
        at = new
        kinetic = 0.5 * float(whole @ (mass * whole))
        pending = float((new.external + np.where(constrained, new.residual, 0.0)) @ whole) * dt
        allowed = BLOW_UP * known.energy(worked, internal, pending)
        # The frequency of the increment itself is above the stable one, and energy comes of it.
        unstable = stiff * dt**2 > 4.0 * inert and kinetic + internal > allowed
        if unstable or not np.isfinite(kinetic + internal):
            raise ConvergenceError(
                f"the motion blows up at step time {time:g}; the stable increment has become "
                f"smaller than {dt:g}: use automatic increments with a smaller first one"
            )
        if i % keep and i != n and i not in wanted:
            continue
        state.u, state.v, state.at = u, whole, new
        state.a = np.where(constrained, given_a, a)
        state.step_time, account.kinetic = time, kinetic
        account.internal += internal - told
        told = internal
        state.reaction = np.where(constrained, new.residual + mass * given_a, 0.0)
        state.loop = {
            "kind": "explicit",
            "known": known,
            "done": i,
            "n": n,
            "keep": keep,
            "wanted": wanted,
            "dt": dt,
            "stable": stable,
            "u": u,
            "v": v,
            "at": at,
            "begin": begin,
            "work": work,
            "internal": internal,
            "told": told,
            "driven": driven,
        }
        save(
            state,
            i,
            time / step.period,
            {
                "dt": dt,
                "iterations": 1.0,
                "external work": account.work,
                "internal work": account.internal,
                "kinetic energy": kinetic,
            },
        )
        if observers.stop_requested:
            raise Interrupted(
                f"stopped at step {number}, step time {time:g}; everything up to there is kept"
            )
    state.reaction = None
    if keep > 1:
        warnings.warn(
            f"central differences took {n} increments of {dt:.3g} (stable: {stable:.3g}); every "
            f"{keep}th is kept",
            stacklevel=2,
        )


class Known:
    """Energy that a motion can have: what it started with, what was put in and set free.

    Parameters
    ----------
    system : System
    mass : ndarray, shape (n_dofs,)
    first : float
        Kinetic energy at the start [force*length].
    dt : float
        Increment [time].
    """

    def __init__(self, system: System, mass: Floats, first: float, dt: float) -> None:
        # A body at rest has no energy to compare with but that of rounded displacements.
        speed = ROUND_OFF * np.where(system.is_rotation, 1.0, system.length) / dt
        self.first = first + 0.5 * float(mass @ speed**2)
        self.worked = self.freed = 0.0

    def energy(self, worked: float, internal: float, pending: float) -> float:
        """Energy after an increment [force*length].

        Parameters
        ----------
        worked : float
            Work of loads and supports in the increment.
        internal : float
            Internal work since the start; what was stored before makes it negative.
        pending : float
            Work of the next increment: kinetic energy is ahead of the work by half of one.
        """
        self.worked += abs(worked)
        self.freed = max(self.freed, -internal)
        return self.first + self.worked + self.freed + abs(pending)


def _refuse_pushed(system: System, idle: NDArray[np.bool_], at: Evaluation) -> None:
    """Refuse forces at free dofs without mass, which would follow at once."""
    if idle.any():
        largest = max(float(at.scale.max()), float(np.abs(at.external).max()))
        pushed = idle & (np.abs(at.residual) > BALANCED * largest)
        _refuse_idle(system, pushed, "has a force on it but no mass")
