# SPDX-License-Identifier: BSD-3-Clause
"""MUMPS by way of PETSc behind the interface of the linear solvers, if installed."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import ResourceError, SingularError, UnsupportedError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Inertia = tuple[int, int, int]
    Floats = NDArray[np.float64]

#: Controls of MUMPS: memory above the estimate [percent], detection of null pivots, vector of the
#: null space to solve for, parallel factorization of the root, which hides the inertia (1: none).
_MEMORY, _NULL_PIVOTS, _NULL_SPACE, _ROOT = 14, 24, 25, 13
#: Share of memory to begin with, and what it is raised to where pivoting needs more [percent].
_SHARES = (30, 100, 400)
#: Answers of MUMPS: the error, its detail; null pivots that were found.
_ERROR, _FOUND_NULL = 1, 28
#: Errors of MUMPS that more memory above the estimate mends, of memory, of a singular matrix.
_TOO_SMALL, _NO_MEMORY, _SINGULAR = (-8, -9, -14, -17, -20), (-13, -7), (-10, -6)
#: Backward error above which a solution is refused.
_REFUSE_ABOVE = 1e-9
#: Growth of a random right-hand side above which soft motions are computed.
_SUSPECT_GROWTH = 1e8
#: Energy over squared length, relative to the norm, that is no more than rounding: as in the core.
_SINGULAR_BELOW = 4e-16
#: Steps of inverse iteration towards the softest motion.
_STEPS = 3
#: Most null vectors that a refusal holds.
_MOST = 6


def load_petsc() -> Any:
    """The module ``petsc4py.PETSc``, initialized.

    Raises
    ------
    UnsupportedError
        It is not installed, or was built without MUMPS or for complex numbers.
    """
    try:
        # PETSc's handlers would replace those that end a run after its increment.
        import_module("petsc4py").init(["corota", "-no_signal_handler"])
        petsc = import_module("petsc4py.PETSc")
    except ImportError:
        raise UnsupportedError(
            "the solver 'petsc' needs petsc4py and PETSc with MUMPS: scripts/install_petsc.sh "
            "installs them on Debian, or use 'multifrontal'"
        ) from None
    if np.dtype(petsc.ScalarType).kind != "f":
        raise UnsupportedError("the solver 'petsc' needs a PETSc built for real numbers")
    return petsc


class Petsc:
    """MUMPS in PETSc, on this process: LDLᵀ with inertia, or LU if not symmetric.

    Parameters
    ----------
    symmetric : bool
        Whether the matrix comes as an upper triangle; then with inertia.

    Raises
    ------
    UnsupportedError
        PETSc is not installed.
    """

    def __init__(self, symmetric: bool = True) -> None:
        self._petsc = load_petsc()
        self._symmetric = symmetric
        self._n = 0
        self._matrix: Any = None
        self._solver: Any = None

    def analyze(
        self,
        indptr: NDArray[Any],
        indices: NDArray[Any],
        node_of_dof: NDArray[Any],
        after: NDArray[Any] | None = None,
    ) -> None:
        """Keep the pattern (see `LinearSolver`); MUMPS orders it with the first factorization."""
        import scipy.sparse as sp

        self._release()
        n = self._n = len(indptr) - 1
        # Rows instead of columns, with every diagonal entry: PETSc needs both.
        starts: NDArray[np.int64] = np.asarray(indptr, dtype=np.int64)
        columns = np.repeat(np.arange(n), starts[1:] - starts[:-1])
        rows, every = np.asarray(indices, np.int64), np.arange(n)
        number = np.concatenate([np.arange(1, len(rows) + 1), np.zeros(n, np.int64)])
        where = np.concatenate([rows, every]), np.concatenate([columns, every])
        place = sp.coo_array((number, where), shape=(n, n)).tocsr()
        place.sort_indices()
        self._place = place.data  # 0: an entry that the caller does not have
        kind = self._petsc.IntType
        self._rows = place.indptr.astype(kind), place.indices.astype(kind)
        self._row = np.repeat(every, np.diff(place.indptr).astype(np.int64))
        self._column = place.indices.astype(np.int64)

    def factorize(self, data: Floats) -> Inertia | None:
        """Factorize values of shape (nnz,); returns the inertia if symmetric.

        Raises
        ------
        SingularError
            A pivot vanished; MUMPS does not tell where.
        ResourceError
            MUMPS has not enough memory.
        """
        if not np.all(np.isfinite(data)):
            raise SingularError("the matrix has entries that are not finite")
        values = np.concatenate([[0.0], data])[self._place]
        self._scale = self._scale_of(values) if self._symmetric else np.ones(self._n)
        values = self._values = values * self._scale[self._row] * self._scale[self._column]
        if self._matrix is None:
            make = self._petsc.Mat()
            make = make.createSBAIJ if self._symmetric else make.createAIJ
            shape, block = (self._n, self._n), ((1,) if self._symmetric else ())
            own = self._petsc.COMM_SELF
            self._matrix = make(shape, *block, csr=(*self._rows, values), comm=own)
        else:
            self._matrix.setValuesCSR(*self._rows, values)
            self._matrix.assemble()
        factor = self._factorized()
        if found := factor.getMumpsInfog(_FOUND_NULL):
            motions = [self._null_vector(factor, k + 1) for k in range(min(found, _MOST))]
            raise self._singular(f"{found} pivot(s) vanished", motions)
        if not self._symmetric:
            return None
        self._refuse_singular()
        negative, zero, positive = (int(count) for count in factor.getInertia())
        return positive, negative, zero

    def _factorized(self) -> Any:
        """The factor of the matrix as it stands, with as much memory as pivoting needs."""
        for share in _SHARES:
            if self._solver is None:
                self._solver = self._new_solver(share)
            factor = self._solver.getPC().getFactorMatrix()
            try:
                self._solver.setOperators(self._matrix)
                self._solver.setUp()
                error = factor.getMumpsInfog(_ERROR)
            except self._petsc.Error as caught:
                if caught.ierr == 55:  # PETSC_ERR_MEM
                    raise ResourceError("PETSc has not enough memory") from None
                error = factor.getMumpsInfog(_ERROR) or -1
            if error >= 0:
                return factor
            self._solver.destroy()
            self._solver = None
            if error not in _TOO_SMALL:
                break
        if error in _SINGULAR:
            raise SingularError("matrix is singular: a pivot vanished")
        if error in _TOO_SMALL + _NO_MEMORY:
            raise ResourceError("MUMPS has not enough memory for the factorization")
        raise SingularError(f"MUMPS stopped with error {error}")

    def _new_solver(self, share: int) -> Any:
        solver = self._petsc.KSP().create(self._petsc.COMM_SELF)
        solver.setType("preonly")
        solver.setOperators(self._matrix)
        factorization = solver.getPC()
        factorization.setType("cholesky" if self._symmetric else "lu")
        try:
            factorization.setFactorSolverType("mumps")
            factorization.setFactorSetUpSolverType()
        except self._petsc.Error:
            raise UnsupportedError("the solver 'petsc' needs a PETSc with MUMPS") from None
        factor = factorization.getFactorMatrix()
        factor.setMumpsIcntl(_MEMORY, share)
        factor.setMumpsIcntl(_NULL_PIVOTS, 1)
        factor.setMumpsIcntl(_ROOT, 1)
        return solver

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k).

        Raises
        ------
        SingularError
            The residual is not that of a solution.
        """
        b = (np.asarray(rhs, dtype=float).T * self._scale).T
        x = self._solve_scaled(b)
        self._check_growth(x, b)
        scaled: Floats = (x.T * self._scale).T
        return scaled

    def _scale_of(self, values: Floats) -> Floats:
        """Powers of two that bring the diagonal, or the largest coupling, of equations near one.

        So singular and soft are told apart in any system of units.
        """
        diagonal, size = np.zeros(self._n), np.abs(values)
        on = self._row == self._column
        diagonal[self._row[on]] = size[on]
        scale = np.where(diagonal > 0.0, _inverse_power(np.sqrt(diagonal)), 0.0)
        bare = scale == 0.0
        if bare.any():
            coupling = np.zeros(self._n)
            np.maximum.at(coupling, self._row, size * scale[self._column])
            np.maximum.at(coupling, self._column, size * scale[self._row])
            scale[bare] = _inverse_power(coupling[bare])
        return scale

    def _refuse_singular(self) -> None:
        """Refuse a matrix that lets a motion go at no cost beyond rounding."""
        motion = np.random.default_rng(1).uniform(-1.0, 1.0, self._n)
        norm = float(np.abs(self._values).max(initial=0.0))
        for step in range(_STEPS):
            before = float(np.abs(motion).max(initial=0.0))
            motion = self._solve_scaled(motion)
            size = float(np.abs(motion).max(initial=0.0))
            if not np.isfinite(size):
                raise SingularError("matrix is singular: the solution is not finite")
            if step == 0 and size * norm <= _SUSPECT_GROWTH * before:
                return
            motion /= size
        energy = abs(float(motion @ self._product(motion))) / float(motion @ motion)
        if energy <= _SINGULAR_BELOW * norm:
            raise self._singular("a motion costs no energy", [motion])

    def _null_vector(self, factor: Any, number: int) -> Floats:
        """Vector that a matrix with vanished pivots takes to zero, from 1 to their number."""
        factor.setMumpsIcntl(_NULL_SPACE, number)
        try:
            return self._solve_scaled(np.zeros(self._n))
        finally:
            factor.setMumpsIcntl(_NULL_SPACE, 0)

    def _singular(self, why: str, motions: list[Floats]) -> SingularError:
        """The refusal, with motions of the scaled equations that cost nothing."""
        modes = np.array(motions) * self._scale
        modes /= np.abs(modes).max(axis=1, initial=1e-300)[:, None]
        equation = int(np.argmax(np.abs(modes[0])))
        return SingularError(f"matrix is singular: {why}", equation, modes[0], modes)

    def _solve_scaled(self, b: Floats) -> Floats:
        b = np.array(b, dtype=float, order="F")
        x = np.zeros_like(b, order="F")
        own = self._petsc.COMM_SELF
        for given, found in zip(b.reshape(self._n, -1).T, x.reshape(self._n, -1).T, strict=True):
            right = self._petsc.Vec().createWithArray(given, comm=own)
            left = self._petsc.Vec().createWithArray(found, comm=own)
            self._solver.solve(right, left)
            left.destroy()
            right.destroy()
        return x

    def _product(self, x: Floats) -> Floats:
        """Scaled matrix times vectors of shape (n,) or (n, k)."""
        import scipy.sparse as sp

        starts, columns = self._rows
        matrix = sp.csr_array((self._values, columns, starts), shape=(self._n, self._n))
        product: Floats = matrix @ x
        if self._symmetric:
            product += matrix.T @ x
            product -= (matrix.diagonal() * x.T).T
        return product

    def _check_growth(self, x: Floats, b: Floats) -> None:
        product = self._product(x)
        largest = np.max(np.abs(self._values), initial=0.0)
        size = largest * np.max(np.abs(x), initial=0.0) + np.max(np.abs(b), initial=0.0)
        if not np.max(np.abs(b - product), initial=0.0) <= _REFUSE_ABOVE * size:
            raise SingularError("matrix is singular: the residual of the solution is too large")

    def _release(self) -> None:
        for held in (self._solver, self._matrix):
            if held is not None:
                held.destroy()
        self._solver = self._matrix = None


def _inverse_power(size: Floats) -> Floats:
    """Power of two next to the inverse of sizes; 1 for what is zero."""
    known = size > 0.0
    return np.where(known, np.exp2(-np.round(np.log2(np.where(known, size, 1.0)))), 1.0)


__all__ = ["Petsc", "load_petsc"]
