"""Harmonic response over a range of frequencies: by modes, or of the whole model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from corota.analysis.increment_loop import Accepted, IncrementLoop, Stepper
from corota.analysis.linear.factor import Factor
from corota.analysis.procedures.linear_fields import LinearFields
from corota.analysis.procedures.modal import supported
from corota.analysis.procedures.reduced import Patterns, Reduced, last_modes
from corota.analysis.terms.complex_stiffness import ComplexStiffness
from corota.analysis.terms.conditions import Conditions
from corota.analysis.terms.linearized import LinearMotion, spin
from corota.errors import ModelError, SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.equations import System
    from corota.analysis.state import State
    from corota.arrays import Complex, Floats
    from corota.model.steps import SteadyState, Step

    Answer = Callable[[float, Complex, Complex], Complex]

#: An undamped system whose matrix is as small as this at a frequency is in resonance.
RESONANCE = 1e-12


def steady_state_step(loop: IncrementLoop, step: SteadyState, stops: list[float]) -> None:
    """Harmonic response to the step's loads and moves of supports, frequency by frequency.

    Each frame is one frequency, which is its step time. Displacement, velocity, acceleration,
    reaction and stress are those of the instant at which loads in phase are largest: ``U`` holds
    the displacement of the state and the real part of the complex amplitude, ``-V`` over the
    circular frequency the imaginary part. Amplitudes and phases are variables of their own.

    Raises
    ------
    ModelError
        If there are no modes, or an undamped mode is hit.
    """
    state = loop.state
    u0, at0 = state.u.copy(), state.at
    v0, a0 = state.v, state.a
    loop.run(HarmonicStepper(loop, step))
    state.u, state.at, state.v, state.a = u0, at0, v0, a0
    state.recover = state.harmonic = None
    state.step_time = 0.0


class HarmonicStepper(Stepper):
    """One frequency after the other."""

    def __init__(self, loop: IncrementLoop, step: SteadyState) -> None:
        self.system, self.state, self.step = loop.system, loop.state, step
        system, state, number = loop.system, loop.state, loop.number
        own = np.zeros(0)
        if step.direct:
            lin = LinearMotion(system, state.u.copy(), step.mass)
            found = [m for m in state.modes if m.kind == "frequency"]
            if found and state.linear is not None:
                own = found[-1].factors
            lin.turns = spin(system) > 0.0
        else:
            modes, lin = last_modes(system, state, step, number)
            own = modes.factors
        self.lin, self.frequencies, self.own = lin, step.sweep(own), own
        self.loads, self.moves = _amplitudes(system, lin, step, number, self.frequencies)
        rates = 2.0 * math.pi * np.asarray(self.frequencies)
        self.relaxed = ComplexStiffness(lin, rates)
        self.answer: Answer
        if step.direct:
            self.answer = _direct(lin, step, number, self.relaxed)
        else:
            self.answer = _by_modes(
                system, state, step, number, self.loads, self.moves, self.relaxed
            )
        if self.relaxed:
            state.notes.append(
                f"in harmonic step {number} viscoelastic materials have their complex moduli; "
                "stress and energy of the elements are those of the instantaneous ones"
            )
        self.fields = LinearFields(system, lin.u)

    @property
    def finished(self) -> bool:
        return self.taken >= len(self.frequencies)

    @property
    def where(self) -> str:
        return f"frequency {self.frequencies[self.taken - 1]:g}"

    def _next_answer(self) -> tuple[float, Complex, Complex]:
        """Frequency, load and response; frequencies of undamped modes have none: left out."""
        while True:
            f, load, move = (x[self.taken] for x in (self.frequencies, self.loads, self.moves))
            self.taken += 1
            try:
                return float(f), load, self.answer(2.0 * math.pi * f, load, move)
            except _Resonance as error:
                if f not in self.own:
                    raise
                self.state.notes.append(f"{error.message}; this frequency is left out")

    def advance(self) -> Accepted:
        """Find the response at the next frequency."""
        state, step, lin = self.state, self.step, self.lin
        f, load, z = self._next_answer()
        w = 2.0 * math.pi * f
        response = lin.expand(z)
        state.u = lin.u + response.real
        state.v, state.a = (1j * w * response).real, -(w**2) * response.real
        forces = (lin.stiffness - w**2 * lin.mass) @ z + 1j * w * (lin.damping(step.rayleigh) @ z)
        if self.relaxed:
            forces = forces + self.relaxed.at(w) @ z
        state.at = supported(lin, forces.real, lin.at.external + load.real)
        state.step_time = f
        reaction = _reaction(lin, forces, load)
        # Sizes and phases do not turn as vectors do: along the global axes first.
        of_node = lin.system.by_node
        u, r = ((of_node(p.real) + 1j * of_node(p.imag))[:, :2] for p in (response, reaction))
        state.harmonic = np.hstack([np.abs(u), np.angle(u), np.abs(r)])
        state.recover = lambda: self.fields.over_period(response)
        largest = u.ravel()[np.abs(u).argmax()]
        scalars = {
            "frequency": f,
            "largest amplitude": float(np.abs(largest)),
            "phase at largest": float(np.angle(largest)),
        }
        return Accepted(self.taken, 1.0, scalars)


def _reaction(lin: LinearMotion, forces: Complex, load: Complex) -> Complex:
    """Complex amplitude of the reactions of the prescribed dofs, shape (n_dofs,)."""
    parts = []
    for force, external in ((forces.real, load.real), (forces.imag, load.imag)):
        found = np.array(lin.link.gather(-external))
        found[lin.free] += force[: lin.nf]
        found[lin.free] += lin.tractions(found[lin.free])
        parts.append(np.where(lin.system.conditions.constrained, found, 0.0))
    return parts[0] + 1j * parts[1]


def _amplitudes(
    system: System, lin: LinearMotion, step: SteadyState, number: int, frequencies: Floats
) -> tuple[Complex, Complex]:
    """Complex loads and prescribed displacements at each frequency, shapes (k, n_dofs).

    Amplitudes of loads are tables over the frequency here.
    """
    conditions, waves = system.conditions, system.conditions.harmonic
    assert waves is not None
    behind = Conditions(system)
    behind.factors.ramp = False
    behind.reset_mass()
    behind.add_items(step.imaginary_loads, step.imaginary_supports)
    loose = behind.constrained & ~conditions.constrained
    if loose.any():
        raise ModelError(
            f"{system.describe(int(np.flatnonzero(loose)[0]))} is moved out of phase in step "
            f"{number}, but has no support in phase: give it one with the value 0",
            step.where,
        )
    shape = (len(frequencies), system.n_dofs)
    loads, moves = np.zeros(shape, complex), np.zeros(shape, complex)
    none = np.zeros(system.n_dofs)
    for k, f in enumerate(frequencies):
        for phase, of in ((1.0, waves), (1.0j, behind)):
            loads[k] += phase * of.external(f, lin.u)[0]
            moves[k] += phase * of.supports.at(f, none)
    return loads, moves


def _by_modes(
    system: System,
    state: State,
    step: SteadyState,
    number: int,
    loads: Complex,
    moves: Complex,
    relaxed: ComplexStiffness,
) -> Answer:
    """Response by superposition of the modes of the last frequency step."""
    patterns = [Patterns(system.n_dofs), Patterns(system.n_dofs)]
    for found, vectors in zip(patterns, (loads, moves), strict=True):
        for vector in vectors:
            found.add(vector.real.copy())
            found.add(vector.imag.copy())
    forces, constrained = (found.matrix for found in patterns)
    model = Reduced(system, state, step, number, forces, constrained)
    one = np.eye(len(model.stiffness))

    def answer(w: float, load: Complex, move: Complex) -> Complex:
        matrix = model.stiffness - w**2 * one + 1j * w * model.damping
        scale = np.maximum(np.abs(np.diag(model.stiffness)), w**2)
        c, s = forces.T @ load, constrained.T @ move
        rhs = model.load @ c + (w**2 * model.carried - 1j * w * model.dragged) @ s
        if relaxed:
            change = relaxed.at(w)
            matrix = matrix + model.shapes.T @ (model.lin.sub(change) @ model.shapes)
            rhs = rhs - model.shapes.T @ (model.lin.coupled(change, model.static) @ s)
        if (np.abs(np.diag(matrix)) <= RESONANCE * scale).any():
            raise _resonance(step, number, w)
        try:
            q = np.linalg.solve(matrix, rhs)
        except np.linalg.LinAlgError:
            raise _resonance(step, number, w) from None
        found: Complex = model.unknowns(q, s)
        return found

    return answer


def _direct(lin: LinearMotion, step: SteadyState, number: int, relaxed: ComplexStiffness) -> Answer:
    """Response of the whole model: a real system of twice the size at each frequency."""
    c = lin.damping(step.rayleigh)
    k, m, damping = (lin.sub(x) for x in (lin.stiffness, lin.mass, c))
    damped = bool(damping.nnz) and bool(np.any(damping.data))
    symmetric = lin.symmetric and abs(damping - damping.T).max() <= 1e-12 * abs(damping).max()
    n = len(lin.active)
    # Real and imaginary parts of an unknown stand together.
    order = np.arange(2 * n).reshape(2, n).T.ravel()
    node = np.repeat(lin.node[lin.active], 2)
    multiplier = np.repeat(lin.multiplier[lin.active], 2)
    threads = getattr(lin.system.linear.solver, "threads", 1)

    def answer(w: float, load: Complex, move: Complex) -> Complex:
        h = lin.restrict(move)
        z: Complex = h.copy()
        dynamic = lin.stiffness - w**2 * lin.mass
        lossy, loss = damped, w * damping
        if relaxed:
            change = relaxed.at(w)
            dynamic = dynamic + change
            part = lin.sub(change)
            lossy, loss = True, loss + part.imag
        rhs = lin.gather(load.real) + 1j * lin.gather(load.imag)
        rhs = rhs - (dynamic @ h + 1j * w * (c @ h))[lin.active]
        a = k - w**2 * m
        if relaxed:
            a = a + part.real
        try:
            if not lossy or w == 0.0:
                factor = lin.factor(a, lin.symmetric)
                both = factor.solve(np.asfortranarray(np.stack([rhs.real, rhs.imag], axis=1)))
                x = both[:, 0] + 1j * both[:, 1]
            else:
                whole = sp.block_array([[a, -loss], [-loss, -a]], format="csr")
                whole = whole[order][:, order].tocsc()
                factor = Factor(whole, symmetric, node, multiplier, threads)
                both = factor.solve(np.concatenate([rhs.real, -rhs.imag])[order])
                x = both[0::2] + 1j * both[1::2]
        except SingularError:
            raise _resonance(step, number, w) from None
        z[lin.active] = x
        return z

    return answer


class _Resonance(ModelError):
    """Response without bounds at the frequency of an undamped mode."""


def _resonance(step: Step, number: int, w: float) -> _Resonance:
    return _Resonance(
        f"frequency {w / (2.0 * math.pi):g} is that of an undamped mode in step {number}: give a "
        "damping",
        step.where,
    )
