"""Bloch waves about a state of a cell: ``u(x + a) = exp(2 pi i k . n) u(x)``.

The phases replace the equations of the cell, so that the matrices of one cell serve all wave
vectors. Unknowns inside the cell are condensed once: at a wave vector the stiffness is singular
where that of the border is. Source: N. Triantafyllidis, W. N. Schnaidt, J. Mech. Phys. Solids 41
(1993) 1533-1565; K. Bertoldi, M. C. Boyce, Phys. Rev. B 78 (2008) 184107.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from scipy.sparse.linalg import eigsh

from corota.analysis.equations import System
from corota.analysis.linear.factor import Factor
from corota.analysis.linear.solvers import make_solver
from corota.analysis.terms.inertia import Inertia
from corota.analysis.terms.linearized import Linearized
from corota.errors import InputError, UnsupportedError
from corota.model.steps import Static

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Bools, Complex, Floats
    from corota.cells.states import Cell, State


#: Unknowns up to which all eigenvalues are computed.
DENSE = 600
#: Shift of the iteration for the lowest frequencies, over the highest ones (squares).
SHIFT = 1e-9
#: Distance of a wave vector from one of the reciprocal lattice that is none.
UNIFORM = 1e-12
#: Independent share of a constraint of closed surfaces below which it follows from others.
DEPENDENT = 1e-9


class Waves:
    """Small waves about a state of a periodic body.

    Wave vectors are given in shares of the reciprocal lattice: the phase from one cell to the next
    is ``2 pi k[0]`` along the first vector of the lattice, ``2 pi k[1]`` along the second.

    Parameters
    ----------
    cell : PeriodicCell
    state : State
    mass : {"consistent", "constant", "lumped"}

    Raises
    ------
    UnsupportedError
        If loads have no potential, or are those of a step.
    """

    def __init__(self, cell: Cell, state: State, mass: str = "consistent") -> None:
        if any(not cell.drives(load) for load in state.step.loads):
            raise UnsupportedError("loads in a cell are those of its model, not of a step")
        self.cell, self.mass_kind = cell, mass
        self.system = system = System(cell.around, make_solver("multifrontal"))
        step = Static(nlgeom=state.step.nlgeom, period=state.step.period)
        system.begin(step, 0.0, np.zeros(system.n_dofs), None)
        by_node = state.system.by_node(state.u)[: cell.around.mesh.n_nodes]
        self.u = system.from_nodes(by_node)
        system.constraints.complete(self.u)
        self.lin = Linearized(system, self.u, *state.contact, time=state.time)
        if not self.lin.symmetric:
            raise UnsupportedError("waves about states with follower loads without a potential")
        self._stiffness, self._prevented = self.lin.of_dofs()
        self._number()

    def _number(self) -> None:
        """Unknowns of a period, and the multiples of the lattice to the others."""
        lin, cell, system = self.lin, self.cell, self.system
        own = np.arange(lin.nf)
        position = np.full(system.n_dofs, -1)
        position[lin.free] = own
        node, component = system.node_of_dof[lin.free], system.component[lin.free]
        first = cell.first[node]
        alike = component < system.per_node[first]
        target = np.where(alike, position[system.start[first] + np.where(alike, component, 0)], -2)
        if (target == -1).any():
            bad = cell.around.mesh.node_labels[node[np.flatnonzero(target == -1)[0]]]
            raise UnsupportedError(
                f"a constraint of the cell determines node {bad} or its partner on the border"
            )
        target = np.where(alike, target, own)
        self._shift = cell.shift[node] * alike[:, None]
        _, self._column, count = np.unique(target, return_inverse=True, return_counts=True)
        self._size = len(count)
        shared = count[self._column] > 1
        paired = np.flatnonzero(shared & (target == own))
        #: Unknowns that are not condensed: of the border, and those that closed surfaces hold.
        self._border = shared | (np.diff(self._prevented.tocsr().indptr) > 0)
        start = system.start[node[paired[0]]]
        #: Unknowns whose support excludes uniform motion.
        self._uniform = self._column[position[[start, start + 1]]]

    def _transform(self, wave: ArrayLike) -> tuple[Any, Bools]:
        """All unknowns by those of a period, and which of these are free."""
        k = np.asarray(wave, dtype=np.float64)
        if k.shape != (2,) or not np.isfinite(k).all():
            raise InputError(
                f"a wave vector has two shares of the reciprocal lattice, not {wave!r}"
            )
        phase = np.exp(2j * math.pi * (self._shift @ k))
        shape = (self.lin.nf, self._size)
        whole = sp.csr_array((phase, (np.arange(self.lin.nf), self._column)), shape=shape)
        free = np.ones(self._size, bool)
        if np.abs(k - np.rint(k)).max() <= UNIFORM:
            free[self._uniform] = False
        return whole, free

    @cached_property
    def _condensed(self) -> tuple[Floats, Factor | None, Any]:
        """Stiffness of the border, the factors inside, and the coupling of both."""
        lin, border = self.lin, np.flatnonzero(self._border)
        inside = np.flatnonzero(~self._border)
        k = self._stiffness
        whole: Floats = k[border][:, border].toarray()
        if not len(inside):
            return whole, None, None
        matrix = k[inside][:, inside].tocsc()
        factor = Factor(matrix, True, lin.node[inside], lin.multiplier[inside], 1)
        side = k[inside][:, border].tocsc()
        whole = whole - side.T @ factor.solve(side.toarray())
        return 0.5 * (whole + whole.T), factor, side

    def _on_border(self, wave: ArrayLike) -> tuple[Complex, Any]:
        """Stiffness of the border at a wave vector, and its unknowns by those of a period.

        Closed surfaces leave the motions that keep their gaps.
        """
        whole, free = self._transform(wave)
        at = np.zeros(self._size, bool)
        at[self._column[self._border]] = True
        border = np.flatnonzero(self._border)
        part = whole[border][:, np.flatnonzero(at & free)]
        if self._prevented.shape[1]:
            gaps = (self._prevented[border].T @ part).toarray()
            size = np.linalg.norm(gaps, axis=1, keepdims=True)
            part = part @ scipy.linalg.null_space(gaps / np.where(size, size, 1.0), DEPENDENT)
        stiffness = part.conj().T @ (part.T @ self._condensed[0].T).T
        return np.asarray(stiffness), part

    def least_stiffness(self, wave: ArrayLike) -> float:
        """Smallest eigenvalue of the condensed stiffness: zero where a pattern begins."""
        return float(np.linalg.eigvalsh(self._on_border(wave)[0])[0])

    def negative(self, wave: ArrayLike) -> int:
        """Number of waves of this vector without stability."""
        factor = self._condensed[1]
        inside = 0 if factor is None else max(factor.negative, 0)
        return inside + int((np.linalg.eigvalsh(self._on_border(wave)[0]) < 0.0).sum())

    def softest(self, wave: ArrayLike) -> Complex:
        """Shape of least stiffness in the first cell, shape (n_nodes, 3).

        Its largest displacement is 1. In the cell n, m along the lattice it is multiplied by
        ``exp(2 pi i (k[0] n + k[1] m))``.
        """
        stiffness, part = self._on_border(wave)
        vector = part @ np.linalg.eigh(stiffness)[1][:, 0]
        z = np.zeros(self.lin.nf, np.complex128)
        z[self._border] = vector
        _, factor, side = self._condensed
        if factor is not None:
            right = side @ vector
            z[~self._border] = -(factor.solve(right.real) + 1j * factor.solve(right.imag))
        u = self.lin.expand(z)
        shape = self.system.by_node(u.real) + 1j * self.system.by_node(u.imag)
        shape = shape[: self.cell.base.mesh.n_nodes]
        size = np.abs(shape[:, :2])
        out: Complex = shape / shape[:, :2].ravel()[int(np.argmax(size))]
        return out

    @cached_property
    def _mass(self) -> Any:
        values = Inertia(self.system, self.mass_kind).tangent(self.u)
        return self.lin.reduce(values)

    def frequencies(self, waves: ArrayLike, count: int = 6) -> Floats:
        """Dispersion: lowest frequencies at wave vectors, shape (n, count) [1/time].

        Parameters
        ----------
        waves : array_like, shape (n, 2)
        count : int

        Returns
        -------
        ndarray
            Negative where a wave grows: then its rate of growth over 2 pi.
        """
        if self._prevented.shape[1]:
            raise UnsupportedError("frequencies of waves do not include closed surfaces and ties")
        return np.array([self._lowest(k, count) for k in np.atleast_2d(np.asarray(waves, float))])

    def _lowest(self, wave: Floats, count: int) -> Floats:
        part = self._transform(wave)[0].tocsc()
        k, m = (part.conj().T @ x @ part for x in (self._stiffness, self._mass))
        if not 1 <= count <= self._size:
            raise InputError(f"the cell has {self._size} waves of a vector, not {count}")
        if self._size <= DENSE or count >= self._size - 1:
            squares = scipy.linalg.eigh(
                k.toarray(), m.toarray(), eigvals_only=True, subset_by_index=[0, count - 1]
            )
        else:
            highest = float((abs(k).sum(axis=1) / abs(m.diagonal())).max())
            squares = np.sort(eigsh(k, count, m, sigma=-SHIFT * highest)[0])
        out: Floats = np.sign(squares) * np.sqrt(np.abs(squares)) / (2.0 * math.pi)
        return out
