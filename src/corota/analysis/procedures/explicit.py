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

    from corota.analysis.equations import System
    from corota.analysis.observers import Observers
    from corota.analysis.state import State
    from corota.model.steps import Dynamic

    Floats = NDArray[np.float64]

#: Share of the stable increment that automatic increments take.
SAFETY = 0.9
#: Iterations for the largest frequency; its estimate rises to the true value.
POWER = 60
#: Growth of the total energy, relative to the work done, that is taken for instability.
BLOW_UP = 10.0
#: Increments before that is judged.
SETTLE = 10
#: Most frames that are kept of a step unless outputs ask for times.
FRAMES = 200


def diagonal(system: System) -> Floats:
    """Lumped mass by dof, shape (n_dofs,) [mass], [mass*length^2] for rotations."""
    from corota.analysis.procedures.motion import Inertia

    values = Inertia(system, "lumped").matrix
    assert values is not None
    return values[system.indptr[1:].astype(np.int64) - 1]


def stable_increment(system: System, u: Floats, mass: Floats) -> float:
    """Largest stable increment, 2 / (largest frequency) [time]."""
    held = system.conditions.held
    values = system.evaluate(u, 0.0).values
    x = np.random.default_rng(0).standard_normal(system.n_dofs)
    x[held] = 0.0
    largest = 0.0
    for _ in range(POWER):
        x /= np.sqrt(x @ (mass * x))
        y = system.core.multiply(values, x)
        y[held] = 0.0
        largest = float(x @ y)
        x = y / mass
    return 2.0 / float(np.sqrt(largest)) if largest > 0.0 else np.inf


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
        If the asked increment is not stable; the message gives the stable one.
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
    if system.ties is not None:
        raise UnsupportedError(
            "central differences take no constraints and no local axes: eliminated dofs couple "
            "the masses of others, and the mass is no diagonal any more; use an implicit scheme",
            step.where,
        )
    if system.touching is not None:
        raise UnsupportedError(
            "central differences take no contact pairs and no ties; use an implicit scheme "
            "(hht, generalized_alpha, energy_momentum; *DYNAMIC without EXPLICIT)",
            step.where,
        )
    mass = diagonal(system)
    held = system.conditions.held
    stable = stable_increment(system, state.u, mass)
    if step.fixed_increments:
        dt = step.first_increment
        if dt > stable:
            raise ModelError(
                f"the increment {dt:g} is above the stable one of central differences, "
                f"{stable:.4g}; use at most {SAFETY * stable:.3g}, or an implicit scheme",
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
    u = state.u.copy()
    at = system.evaluate(u, 0.0)
    a = np.where(held, 0.0, -at.residual / mass)
    v = state.v + 0.5 * dt * a
    work = internal = 0.0
    first = 0.5 * float(state.v @ (mass * state.v))
    for i in range(1, n + 1):
        time = i * dt
        du = np.where(held, system.conditions.prescribed(time, u) - u, dt * v)
        u = u + du
        new = system.evaluate(u, time)
        system.commit()
        a = np.where(held, 0.0, -new.residual / mass)
        mean_f = 0.5 * (at.external + new.external)
        reaction = np.where(held, 0.5 * (at.residual + new.residual), 0.0)
        work += float((mean_f + reaction) @ du)
        internal += float(0.5 * (at.internal + new.internal) @ du)
        whole = np.where(held, du / dt, v + 0.5 * dt * a)
        v = np.where(held, du / dt, v + dt * a)
        at = new
        kinetic = 0.5 * float(whole @ (mass * whole))
        # The work lags behind by half an increment, which is all of it at first.
        known = first + abs(work) + abs(internal)
        if not np.isfinite(kinetic) or (i > SETTLE and kinetic + internal > BLOW_UP * known):
            raise ConvergenceError(
                f"the motion blows up at step time {time:g}; the stable increment has become "
                f"smaller than {dt:g}: use automatic increments with a smaller first one"
            )
        if i % keep and i != n and i not in wanted:
            continue
        state.u, state.v, state.a, state.at = u, whole, a, new
        state.step_time, state.work = time, work
        save(
            state,
            i,
            time / step.period,
            {
                "dt": dt,
                "iterations": 1.0,
                "external work": work,
                "internal work": internal,
                "kinetic energy": kinetic,
                "energy balance": kinetic - first + internal - work,
            },
        )
        if observers.stop_requested:
            raise Interrupted(
                f"stopped at step {number}, step time {time:g}; everything up to there is kept"
            )
    if keep > 1:
        warnings.warn(
            f"central differences took {n} increments of {dt:.3g} (stable: {stable:.3g}); every "
            f"{keep}th is kept",
            stacklevel=2,
        )
