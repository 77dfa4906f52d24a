"""Linear response about a state by superposition of its modes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.damping import damping_matrix
from corota.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.observers import Observers
    from corota.analysis.state import State
    from corota.model.steps import ModalDynamic, SteadyState

    Floats = NDArray[np.float64]


class Basis:
    """The modes of the last frequency step with their damping.

    Shapes have unit modal mass.
    """

    def __init__(
        self, system: System, state: State, step: ModalDynamic | SteadyState, number: int
    ) -> None:
        found = [m for m in state.modes if m.kind == "frequency"]
        if not found:
            raise ModelError(
                f"step {number} superposes modes, but no frequency step (*FREQUENCY) came "
                "before it",
                step.where,
            )
        modes = found[-1]
        self.omega = 2.0 * math.pi * modes.factors
        self.shapes = np.array([system.from_nodes(shape) for shape in modes.shapes]).T
        a, b = step.rayleigh
        with np.errstate(divide="ignore", invalid="ignore"):
            rayleigh = np.where(self.omega > 0.0, 0.5 * (a / self.omega + b * self.omega), 0.0)
            matrix = damping_matrix(system, state.u)
            if matrix is not None:
                # Of each mode alone: what couples modes is left out.
                own = [shape @ system.product(matrix, shape) for shape in self.shapes.T]
                rayleigh += np.where(self.omega > 0.0, 0.5 * np.array(own) / self.omega, 0.0)
        self.damping = step.damping + rayleigh


def modal_step(
    system: System,
    step: ModalDynamic,
    number: int,
    state: State,
    observers: Observers,
    save: Callable[[State, int, float, dict[str, float]], None],
    stops: list[float],
) -> None:
    """Linear transient: exact for loads that vary linearly within an increment.

    Raises
    ------
    ModelError
        If there are no modes.
    """
    basis = Basis(system, state, step, number)
    u0 = state.u.copy()
    internal = system.evaluate(u0, 0.0).internal
    n = max(round(step.period / step.first_increment), 1)
    dt = step.period / n
    count = len(basis.omega)
    q, v = np.zeros(count), np.zeros(count)
    step_of = [_advance(w, z, dt) for w, z in zip(basis.omega, basis.damping, strict=True)]
    before = basis.shapes.T @ (system.conditions.external(0.0, u0)[0] - internal)
    for i in range(1, n + 1):
        time = i * dt
        after = basis.shapes.T @ (system.conditions.external(time, u0)[0] - internal)
        for m, (a, b) in enumerate(step_of):
            q[m], v[m] = a @ (q[m], v[m]) + b @ (before[m], after[m])
        before = after
        state.u, state.v = u0 + basis.shapes @ q, basis.shapes @ v
        state.at = system.evaluate(state.u, time)
        state.step_time = time
        strain = 0.5 * float((basis.omega**2) @ q**2)
        kinetic = 0.5 * float(v @ v)
        save(
            state,
            i,
            time / step.period,
            {"dt": dt, "kinetic energy": kinetic, "modal strain energy": strain},
        )


def _advance(omega: float, zeta: float, dt: float) -> tuple[Floats, Floats]:
    """Exact step of ``q'' + 2 zeta omega q' + omega^2 q = p(t)``, p linear in the step.

    Returns
    -------
    a : ndarray, shape (2, 2)
        On (q, q') at the start.
    b : ndarray, shape (2, 2)
        On p at the start and at the end.
    """
    from scipy.linalg import expm

    # State (q, q', p, p'): p grows linearly.
    m = np.zeros((4, 4))
    m[0, 1] = 1.0
    m[1] = (-(omega**2), -2.0 * zeta * omega, 1.0, 0.0)
    m[2, 3] = 1.0
    e = expm(dt * m)
    slope = e[:2, 3] / dt
    return e[:2, :2], np.stack([e[:2, 2] - slope, slope], axis=1)


def steady_state_step(
    system: System,
    step: SteadyState,
    number: int,
    state: State,
    observers: Observers,
    save: Callable[[State, int, float, dict[str, float]], None],
    stops: list[float],
) -> None:
    """Harmonic response to the step's loads over a range of frequencies.

    Each frame is one frequency: its time is the frequency, displacements are amplitudes in
    phase with the load at the state, and the scalars hold the largest amplitude.

    Raises
    ------
    ModelError
        If there are no modes, or an undamped mode is hit.
    """
    basis = Basis(system, state, step, number)
    u0, at0 = state.u.copy(), state.at
    base = system.evaluate(u0, 0.0)
    load = system.conditions.external(step.period, u0)[0] - base.internal
    p = basis.shapes.T @ load
    moves = ~system.is_rotation
    for i, f in enumerate(step.sweep(basis.omega / (2.0 * math.pi)), start=1):
        w = 2.0 * math.pi * f
        denominator = basis.omega**2 - w**2 + 2j * basis.damping * basis.omega * w
        if (np.abs(denominator) <= 1e-12 * np.maximum(basis.omega**2, w**2)).any():
            raise ModelError(
                f"frequency {f:g} hits an undamped mode in step {number}: give a damping",
                step.where,
            )
        response = basis.shapes @ (p / denominator)
        state.u = u0 + response.real
        state.step_time = f
        state.at = base
        size = np.abs(response)
        save(
            state,
            i,
            1.0,
            {
                "frequency": f,
                "largest amplitude": float(size[moves].max(initial=0.0)),
                "phase at largest": float(
                    np.angle(response[int(np.where(moves, size, 0).argmax())])
                ),
            },
        )
    state.u, state.at = u0, at0
    state.step_time = 0.0
