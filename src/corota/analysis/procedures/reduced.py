"""A model reduced to its modes: what modal and harmonic procedures superpose.

With modes Phi of unit mass, the displacement is ``u = u0 + Phi q + Psi s(t)``, where Psi holds the
static responses to moves of the supports. In the coordinates ``p = q + Phi^T M Psi s`` of the
absolute motion no acceleration of a support is needed:

    p'' + Cr (p' - b s') + Kr (p - b s) = Phi^T (f - C Psi s'),   b = Phi^T M Psi

Cr and Kr are full: dashpots and loads that follow couple modes.

Source: R. W. Clough and J. Penzien, *Dynamics of Structures* (1993), ch. 13 and 26; residual modes:
J. M. Dickens, J. M. Nakagawa and M. J. Wittbrodt, Computers & Structures 62 (1997) 985-998.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.linear.eigen import shifted_factor
from corota.analysis.terms.linearized import LinearMotion, spin
from corota.errors import ModelError

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.state import State
    from corota.arrays import Floats
    from corota.model.paths import Modes
    from corota.model.steps import ModalDamping, ModalDynamic, SteadyState, Step


#: Part of a vector, relative to the largest so far, that makes no pattern of its own.
NEW = 1e-10
#: Share of a gram matrix's largest eigenvalue under which directions are dependent.
DEPENDENT = 1e-10
#: Share of the static response to a load that modes may miss without a note.
MISSED = 0.05


class Patterns:
    """Vectors that come one after the other, as combinations of few orthonormal ones."""

    def __init__(self, n: int) -> None:
        self.n = n
        self.vectors: list[Floats] = []
        self._rows: list[Floats] = []
        self._largest = 0.0

    def add(self, vector: Floats) -> None:
        """Take the next vector."""
        left = vector.copy()
        own = np.zeros(len(self.vectors))
        for _ in range(2):
            for k, base in enumerate(self.vectors):
                share = float(base @ left)
                own[k] += share
                left -= share * base
        self._largest = max(self._largest, float(np.linalg.norm(vector)))
        size = float(np.linalg.norm(left))
        if size > NEW * self._largest:
            self.vectors.append(left / size)
            own = np.append(own, size)
        self._rows.append(own)

    @property
    def matrix(self) -> Floats:
        """The patterns as columns, shape (n, k)."""
        found: Floats = np.array(self.vectors).reshape(-1, self.n).T
        return found

    @property
    def coefficients(self) -> Floats:
        """Of the vectors so far, shape (number of vectors, k)."""
        out = np.zeros((len(self._rows), len(self.vectors)))
        for row, own in zip(out, self._rows, strict=True):
            row[: len(own)] = own
        return out


class Reduced:
    """The modes of the last frequency step with loads and moves of one step.

    Parameters
    ----------
    forces : ndarray, shape (n_dofs, nf)
        Patterns of the loads.
    moves : ndarray, shape (n_dofs, ns)
        Patterns of the displacements of prescribed dofs, 0 elsewhere.

    Attributes
    ----------
    shapes : ndarray, shape (n_active, m)
        Basis of unit mass: modes, then residual modes.
    stiffness, damping : ndarray, shape (m, m)
    load : ndarray, shape (m, nf)
    static : ndarray, shape (n_unknowns, ns)
        Responses Psi to moves of the supports.
    carried, dragged : ndarray, shape (m, ns)
        ``Phi^T M Psi`` and ``Phi^T C Psi``.

    Raises
    ------
    ModelError
        If there are no modes, or they belong to other supports.
    """

    def __init__(
        self,
        system: System,
        state: State,
        step: ModalDynamic | SteadyState,
        number: int,
        forces: Floats,
        moves: Floats,
    ) -> None:
        modes, lin = last_modes(system, state, step, number)
        self.lin, self.state, self.step = lin, state, step
        self.omega = np.hypot(2.0 * math.pi * modes.factors, modes.growth)
        real = np.array([system.from_nodes(shape) for shape in modes.shapes]).T
        basis = lin.pressed(lin.restrict(real))[lin.active]
        complex_ones = modes.imaginary is not None
        self._mass = lin.sub(lin.mass)
        if modes.imaginary is not None:
            other = np.array([system.from_nodes(shape) for shape in modes.imaginary]).T
            basis = self._orthonormal(
                np.hstack([basis, lin.pressed(lin.restrict(other))[lin.active]])
            )
        # The response of a model that rotates has Coriolis forces, whatever its modes have.
        lin.turns = spin(system) > 0.0
        c = lin.damping(step.rayleigh)
        self._factor, self._shift = shifted_factor(lin)
        constrained = lin.restrict(moves)
        self.static = constrained.copy()
        if constrained.shape[1]:
            self.static[lin.active] = -self._factor.solve(
                np.asfortranarray(lin.coupled(lin.stiffness, constrained))
            )
        f = lin.gather(forces)
        inertia, drag = (lin.coupled(m, self.static) for m in (lin.mass, c))
        own = basis.shape[1]
        if step.residual:
            basis = self._with_residuals(basis, np.hstack([f, inertia]))
        self.shapes = basis
        self.stiffness = basis.T @ (lin.sub(lin.stiffness) @ basis)
        self.damping = basis.T @ (lin.sub(c) @ basis) + self._modal(
            step.damping, own, complex_ones, number
        )
        self.load = basis.T @ f
        self.carried, self.dragged = basis.T @ inertia, basis.T @ drag
        if not step.residual and f.shape[1]:
            self._tell_missed(f, number)

    def _orthonormal(self, x: Floats) -> Floats:
        gram = x.T @ (self._mass @ x)
        values, axes = np.linalg.eigh(0.5 * (gram + gram.T))
        keep = values > DEPENDENT * values.max(initial=0.0)
        found: Floats = x @ (axes[:, keep] / np.sqrt(values[keep]))
        return found

    def _with_residuals(self, basis: Floats, forces: Floats) -> Floats:
        """The basis with the static responses to forces that it does not contain."""
        x = self._factor.solve(np.asfortranarray(forces))
        size = np.sqrt(np.einsum("ij,ij->j", x, self._mass @ x))
        x = x[:, size > 0.0] / size[size > 0.0]
        for _ in range(2):
            x = x - basis @ (basis.T @ (self._mass @ x))
        gram = x.T @ (self._mass @ x)
        values, axes = np.linalg.eigh(0.5 * (gram + gram.T))
        keep = values > DEPENDENT
        x = x @ (axes[:, keep] / np.sqrt(values[keep]))
        k = x.T @ (self.lin.sub(self.lin.stiffness) @ x)
        _, turn = np.linalg.eigh(0.5 * (k + k.T))
        return np.hstack([basis, x @ turn])

    def _modal(self, given: ModalDamping, own: int, complex_ones: bool, number: int) -> Floats:
        """Damping by critical fractions of each mode; residual modes have that of the last."""
        m = self.shapes.shape[1]
        ratio = damping_ratios(given, own)
        if complex_ones and ratio.any():
            raise ModelError(
                f"step {number} uses fractions of critical damping, which complex modes do not "
                "support: give damping by rayleigh= or dashpots",
                self.step.where,
            )
        whole = np.append(ratio, np.full(m - own, ratio[-1] if own else 0.0))
        omega = np.sqrt(np.maximum(np.diag(self.stiffness), 0.0))
        return np.diag(2.0 * whole * omega)

    def _tell_missed(self, f: Floats, number: int) -> None:
        """Note where the modes miss much of the static response to a load."""
        x = self._factor.solve(np.asfortranarray(f))
        constrained = (
            np.linalg.solve(self.stiffness + self._shift * np.eye(len(self.stiffness)), self.load)
            if self._regular()
            else np.zeros_like(self.load)
        )
        whole, own = (f * x).sum(axis=0), (self.load * constrained).sum(axis=0)
        missed = float((1.0 - own / np.where(whole > 0.0, whole, np.inf)).max(initial=0.0))
        if self._regular() and missed > MISSED:
            self.state.notes.append(
                f"the modes of step {number} miss {missed:.0%} of the work of the static response "
                "to its loads: request more modes, or residual modes (residual=True)"
            )

    def _regular(self) -> bool:
        k = self.stiffness + self._shift * np.eye(len(self.stiffness))
        return bool(np.linalg.cond(k) < 1e14)

    def displacement(self, q: Any, s: Any) -> Any:
        """Change of all dofs for coordinates of modes and supports, shape (n_dofs,)."""
        return self.lin.expand(self.unknowns(q, s))

    def unknowns(self, q: Any, s: Any) -> Any:
        """Change of all unknowns, with the multipliers of contact and ties; as `displacement`."""
        found = self.lin.from_active(self.shapes @ q)
        return found + self.static @ s

    def project(self, change: Floats) -> Floats:
        """Coordinates p of a change of all dofs, shape (m,)."""
        moved = self.lin.coupled(self.lin.mass, self.lin.restrict(change))
        out: Floats = self.shapes.T @ moved
        return out


def last_modes(system: System, state: State, step: Step, number: int) -> tuple[Modes, LinearMotion]:
    """The modes of the last frequency step and the matrices that they belong to.

    Raises
    ------
    ModelError
        If there are none, or the supports have changed.
    """
    found = [m for m in state.modes if m.kind == "frequency"]
    lin = state.linear
    if not found or lin is None:
        raise ModelError(
            f"step {number} superposes modes, but no frequency step (*FREQUENCY) came before it",
            step.where,
        )
    constrained = system.conditions.constrained[lin.free]
    if not np.array_equal(constrained, lin.constrained[: lin.nf]):
        dof = int(lin.free[np.flatnonzero(constrained != lin.constrained[: lin.nf])[0]])
        raise ModelError(
            f"the supports of step {number} are not those of the modes ({system.describe(dof)}): "
            "fix the same dofs in the frequency step, with the value 0 where they move later",
            step.where,
        )
    return found[-1], lin


def damping_ratios(given: ModalDamping, count: int) -> Floats:
    """Share of critical damping of each mode, from one number or (first, last, share) ranges."""
    out = np.zeros(count)
    if isinstance(given, int | float):
        out[:] = float(given)
        return out
    for first, last, share in given:
        out[int(first) - 1 : int(last)] = float(share)
    return out
