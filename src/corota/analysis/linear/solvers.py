# SPDX-License-Identifier: BSD-3-Clause
"""Linear solvers behind one interface of three methods, and the list of them.

An object with ``analyze``, ``factorize`` and ``solve`` as in `LinearSolver` can
be passed to the procedures; those of `SOLVERS` can also be requested by name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

import corota._core as _core
from corota.analysis.linear.forks import unforked
from corota.errors import InputError, SingularError
from corota.lazy import lazy

if TYPE_CHECKING:
    from collections.abc import Callable

    from scipy.sparse.linalg import SuperLU as Factors

    from corota.analysis.linear.types import Index
    from corota.arrays import Floats

    Inertia = tuple[int, int, int]


@runtime_checkable
class LinearSolver(Protocol):
    """Interface of a direct solver.

    Matrices come in compressed columns with increasing rows. A symmetric matrix is
    given by its upper triangle (row <= column), an unsymmetric one in full; a
    solver is made for one of the two kinds.
    """

    def analyze(
        self,
        indptr: Index,
        indices: Index,
        node_of_dof: Index,
        after: Index | None = None,
    ) -> None:
        """Order and prepare for a pattern.

        Parameters
        ----------
        indptr : ndarray of int, shape (n + 1,)
            Start of each column.
        indices : ndarray of int, shape (nnz,)
            Row of each entry.
        node_of_dof : ndarray of int, shape (n,)
            Node of each equation; equations of one node are contiguous.
        after : ndarray of int, optional
            Equations of multipliers, to be eliminated after what they connect.
        """

    def factorize(self, data: Floats) -> Inertia | None:
        """Factorize values of shape (nnz,).

        Returns
        -------
        tuple of int or None
            Numbers of positive, negative and zero pivots where known.

        Raises
        ------
        SingularError
            The matrix is singular to working precision.
        """

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k); `rhs` is kept."""


class Multifrontal:
    """The built-in solver: LDLᵀ with inertia, or LU if not symmetric.

    Parameters
    ----------
    symmetric : bool
        Whether the matrix comes as an upper triangle.
    """

    def __init__(self, symmetric: bool = True) -> None:
        self._core: _core.Ldlt | _core.Lu = _core.Ldlt() if symmetric else _core.Lu()

    @property
    def threads(self) -> int:
        """Threads to use, 0 for all the machine has; results do not depend on it."""
        return self._core.threads

    @threads.setter
    def threads(self, count: int) -> None:
        self._core.threads = count

    def place_nodes(self, points: Floats) -> None:
        """Set coordinates of nodes, shape (n_nodes, 2), by the numbers that patterns give them.

        The order of elimination of a symmetric matrix is then found from them; without them it is
        found from its edges alone, which takes half as long again.
        """
        if isinstance(self._core, _core.Ldlt):
            _core.place_nodes(self._core, np.ascontiguousarray(points[:, :2], dtype=float))

    def analyze(
        self,
        indptr: Index,
        indices: Index,
        node_of_dof: Index,
        after: Index | None = None,
    ) -> None:
        """Order and prepare for a pattern (see `LinearSolver`)."""
        starts = np.ascontiguousarray(indptr, np.uintp)
        rows, nodes = (np.ascontiguousarray(i, np.uint32) for i in (indices, node_of_dof))
        last = None if after is None else np.ascontiguousarray(after, np.uint32)
        with unforked:
            self._core.analyze(starts, rows, nodes, last)

    def factorize(self, data: Floats) -> Inertia | None:
        """Factorize values of shape (nnz,); returns the inertia if symmetric."""
        return self._core.factorize(np.ascontiguousarray(data, dtype=float))

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k)."""
        x = np.array(rhs, dtype=float, order="F")
        self._core.solve_in_place(x)
        return x


class SuperLU:
    """SciPy's SuperLU: slow, always available, the reference of the tests.

    Parameters
    ----------
    symmetric : bool
        Whether the matrix comes as an upper triangle.
    """

    def __init__(self, symmetric: bool = True) -> None:
        self._symmetric = symmetric
        self._indptr = np.zeros(1, dtype=np.int32)
        self._indices = np.zeros(0, dtype=np.int32)
        self._lu: Factors | None = None

    def analyze(
        self,
        indptr: Index,
        indices: Index,
        node_of_dof: Index,
        after: Index | None = None,
    ) -> None:
        """Keep the pattern; SuperLU computes an ordering with each factorization."""
        self._indptr = np.asarray(indptr, dtype=np.int32)
        self._indices = np.asarray(indices, dtype=np.int32)

    def factorize(self, data: Floats) -> Inertia | None:
        """Factorize values of shape (nnz,); the inertia is not known."""
        import scipy.sparse as sp  # takes longer to import than a small job to solve
        import scipy.sparse.linalg as spla

        n = len(self._indptr) - 1
        matrix = sp.csc_array((data, self._indices, self._indptr), shape=(n, n))
        if self._symmetric:
            matrix = (matrix + sp.triu(matrix, 1).T).tocsc()
        try:
            self._lu = spla.splu(matrix)
        except RuntimeError as error:
            raise SingularError(f"matrix is singular: {error}") from error
        return None

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k)."""
        assert self._lu is not None
        x: Floats = self._lu.solve(np.asarray(rhs, dtype=float))
        if not np.all(np.isfinite(x)):
            raise SingularError("matrix is singular: the solution is not finite")
        return x


SOLVERS: dict[str, Callable[..., LinearSolver]] = {
    "multifrontal": Multifrontal,
    "superlu": SuperLU,
    "pardiso": lazy("corota.analysis.linear.pardiso:Pardiso"),
    "petsc": lazy("corota.analysis.linear.petsc:Petsc"),
    "petsc:gamg": lazy("corota.analysis.linear.multigrid:PetscMultigrid"),
}


def make_solver(name: str = "multifrontal", symmetric: bool = True) -> LinearSolver:
    """New solver by name.

    Raises
    ------
    InputError
        The name is not in `SOLVERS`.
    """
    try:
        return SOLVERS[name](symmetric)
    except KeyError:
        known = ", ".join(sorted(SOLVERS))
        raise InputError(f"no linear solver '{name}'; there are: {known}") from None
