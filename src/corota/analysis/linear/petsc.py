# SPDX-License-Identifier: BSD-3-Clause
"""MUMPS by way of PETSc behind the interface of the linear solvers, if installed."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.rows import Rows
from corota.analysis.parallel.communicator import ALONE, Communicator
from corota.analysis.parallel.mpi import processes
from corota.errors import ResourceError, SingularError, UnsupportedError

if TYPE_CHECKING:
    from types import ModuleType

    from petsc4py import PETSc

    from corota.analysis.linear.types import Index
    from corota.arrays import Floats

    Inertia = tuple[int, int, int]

#: Controls of MUMPS: memory above the estimate [percent], detection of null pivots, vector of the
#: null space to solve for, parallel factorization of the root, which hides the inertia (1: none).
_MEMORY, _NULL_PIVOTS, _NULL_SPACE, _ROOT = 14, 24, 25, 13
#: Ordering (2: approximate minimum fill), scaling (0: none, as symmetric matrices come scaled).
_ORDERING, _SCALING = (7, 2), (8, 0)
#: Unknowns up to which several processes minimize fill. One orders while the others wait, and
#: MUMPS's own choice takes four times as long, for about as many operations up to this size. With
#: four million unknowns minimum fill takes twice as many.
_MOST_ORDERED = 1_500_000
#: Option for right-hand sides (0: on one process), which the search for null vectors needs.
_RIGHT_SIDES = "mat_mumps_icntl_20"
#: Share of memory to begin with, and what it is raised to where pivoting needs more [percent].
_SHARES = (30, 100, 400)
#: Answers of MUMPS: the error, its detail; null pivots that were found.
_ERROR, _FOUND_NULL = 1, 28
#: Errors of MUMPS that more memory above the estimate mends, of memory, of a singular matrix.
_TOO_SMALL, _NO_MEMORY, _SINGULAR = (-8, -9, -14, -17, -20), (-13, -7), (-10, -6)
#: Backward error above which one step of refinement is made, as in the core.
_REFINE_ABOVE = 1e-14
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


def load_petsc() -> ModuleType:
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
    """MUMPS in PETSc: LDLᵀ with inertia, or LU if not symmetric; on all processes together.

    With several processes each gives the values of its own elements; see
    :class:`corota.analysis.linear.rows.Rows`. Right-hand sides and solutions are whole on each.

    Parameters
    ----------
    symmetric : bool
        Whether the matrix comes as an upper triangle; then with inertia.
    communicator : Communicator, optional
        By default that of all processes that were started together.

    Raises
    ------
    UnsupportedError
        PETSc is not installed.
    """

    #: Whether PETSc gets both triangles of a symmetric matrix.
    both = False

    def __init__(self, symmetric: bool = True, communicator: Communicator | None = None) -> None:
        self._petsc = load_petsc()
        if communicator is None:
            communicator = ALONE if self._petsc.COMM_WORLD.getSize() == 1 else processes()
        self.communicator = communicator
        self._symmetric = symmetric
        self._n = 0
        self._matrix: PETSc.Mat = None
        self._solver: PETSc.KSP = None

    @property
    def _handle(self) -> PETSc.Comm:
        if self.communicator.size > 1:
            return self.communicator.handle  # type: ignore[attr-defined]
        return self._petsc.COMM_SELF

    def analyze(
        self,
        indptr: Index,
        indices: Index,
        node_of_dof: Index,
        after: Index | None = None,
    ) -> None:
        """Keep the pattern (see `LinearSolver`); MUMPS orders it with the first factorization."""
        self._release()
        self._n = len(indptr) - 1
        self._rows = Rows(
            self.communicator, indptr, indices, node_of_dof, self._symmetric, self.both
        )
        kind = self._petsc.IntType
        self._starts = self._rows.indptr.astype(kind)
        self._columns = self._rows.indices.astype(kind)
        self._diagonal = np.flatnonzero(self._rows.rows == self._rows.indices)

    def factorize(self, data: Floats) -> Inertia | None:
        """Factorize values of shape (nnz,); returns the inertia if symmetric.

        Raises
        ------
        SingularError
            A pivot vanished; MUMPS does not tell where.
        ResourceError
            MUMPS has not enough memory.
        """
        self._fill(data)
        factor = self._factorized()
        if found := factor.getMumpsInfog(_FOUND_NULL):
            motions = [self._null_vector(factor, k + 1) for k in range(min(found, _MOST))]
            raise self._singular(f"{found} pivot(s) vanished", motions)
        if not self._symmetric:
            return None
        self._refuse_singular()
        negative, zero, positive = (int(count) for count in factor.getInertia())
        return positive, negative, zero

    def _fill(self, data: Floats) -> None:
        """Put values into the matrix, scaled if it is symmetric.

        Raises
        ------
        SingularError
            There is a value that is not finite.
        """
        if self.communicator.any(not np.all(np.isfinite(data))):
            raise SingularError("the matrix has entries that are not finite")
        rows = self._rows
        values = rows.values(data)
        self._scale = np.ones(self._n)
        if self._symmetric:
            self._scale = self._scale_of(values)
            values *= self._scale[rows.rows]
            values *= self._scale[rows.indices]
        self._values = values
        largest = max(values.max(initial=0.0), -values.min(initial=0.0))
        #: Largest entry of the matrix.
        self._norm = self.communicator.greatest(float(largest))
        csr = self._starts, self._columns, values
        if self._matrix is None:
            self._matrix = self._new_matrix((rows.last - rows.first, self._n), csr)
        else:
            self._matrix.setValuesCSR(*csr)
            self._matrix.assemble()

    def _new_matrix(self, shape: tuple[int, int], csr: tuple[Index, Index, Floats]) -> PETSc.Mat:
        make = self._petsc.Mat()
        make = make.createSBAIJ if self._symmetric else make.createAIJ
        block = (1,) if self._symmetric else ()
        return make((shape, shape), *block, csr=csr, comm=self._handle)

    def _factorized(self) -> PETSc.Mat:
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

    def _new_solver(self, share: int) -> PETSc.KSP:
        solver = self._petsc.KSP().create(self._handle)
        solver.setType("preonly")
        solver.setOperators(self._matrix)
        options = self._petsc.Options()
        if not options.hasName(_RIGHT_SIDES):
            options[_RIGHT_SIDES] = 0
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
        if self.communicator.size > 1 and self._n <= _MOST_ORDERED:
            factor.setMumpsIcntl(*_ORDERING)
        if self._symmetric:
            factor.setMumpsIcntl(*_SCALING)
        return solver

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k).

        Raises
        ------
        SingularError
            The residual is not that of a solution.
        """
        order = self._rows.order
        b = (np.asarray(rhs, dtype=float)[order].T * self._scale).T
        x = self._refined(self._solve_scaled(b), b)
        out = np.empty_like(x)
        out[order] = (x.T * self._scale).T
        return out

    def _scale_of(self, values: Floats) -> Floats:
        """Powers of two that bring the diagonal, or the largest coupling, of equations near one.

        So singular and soft differ in any system of units.
        """
        rows, communicator = self._rows, self.communicator
        diagonal = rows.whole(np.abs(values[self._diagonal]))
        scale = np.where(diagonal > 0.0, _inverse_power(np.sqrt(diagonal)), 0.0)
        bare = scale == 0.0
        if bare.any():
            size, coupling = np.abs(values), np.zeros(self._n)
            np.maximum.at(coupling, rows.rows, size * scale[rows.indices])
            np.maximum.at(coupling, rows.indices, size * scale[rows.rows])
            scale[bare] = _inverse_power(communicator.largest(coupling)[bare])
        return scale

    def _refuse_singular(self) -> None:
        """Refuse a matrix that lets a motion go at no cost beyond rounding."""
        motion = np.random.default_rng(1).uniform(-1.0, 1.0, self._n)
        norm = self._norm
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

    def _null_vector(self, factor: PETSc.Mat, number: int) -> Floats:
        """Vector that a matrix with vanished pivots takes to zero, from 1 to their number."""
        factor.setMumpsIcntl(_NULL_SPACE, number)
        try:
            return self._solve_scaled(np.zeros(self._n))
        finally:
            factor.setMumpsIcntl(_NULL_SPACE, 0)

    def _singular(self, why: str, motions: list[Floats]) -> SingularError:
        """The refusal, with motions of the scaled equations that cost nothing."""
        modes = np.empty((len(motions), self._n))
        modes[:, self._rows.order] = np.array(motions) * self._scale
        modes /= np.abs(modes).max(axis=1, initial=1e-300)[:, None]
        equation = int(np.argmax(np.abs(modes[0])))
        return SingularError(f"matrix is singular: {why}", equation, modes[0], modes)

    def _solve_scaled(self, b: Floats) -> Floats:
        rows, handle = self._rows, self._handle
        x = np.zeros_like(b, order="F")
        for given, found in zip(_columns(b), _columns(x), strict=True):
            own = np.array(given[rows.first : rows.last])
            result = np.zeros_like(own)
            right = self._petsc.Vec().createWithArray(own, (len(own), self._n), comm=handle)
            left = self._petsc.Vec().createWithArray(result, (len(own), self._n), comm=handle)
            self._solve_vector(right, left)
            left.destroy()
            right.destroy()
            found[:] = rows.whole(result)
        return x

    def _solve_vector(self, right: PETSc.Vec, left: PETSc.Vec) -> None:
        try:
            self._solver.solve(right, left)
        except self._petsc.Error as caught:
            error = self._solver.getPC().getFactorMatrix().getMumpsInfog(_ERROR)
            raise SingularError(f"MUMPS could not solve: error {error}") from caught

    def _product(self, x: Floats) -> Floats:
        """Scaled matrix times vectors of shape (n,) or (n, k)."""
        import scipy.sparse as sp

        rows = self._rows
        shape = rows.last - rows.first, self._n
        matrix = sp.csr_array((self._values, self._columns, self._starts), shape=shape)
        own = slice(rows.first, rows.last)
        product = np.zeros_like(x)
        product[own] = matrix @ x
        if self._symmetric and not self.both:
            product += matrix.T @ x[own]
            product[own] -= (matrix.diagonal(rows.first) * x[own].T).T
        return self.communicator.sum(product)

    def _refined(self, x: Floats, b: Floats) -> Floats:
        """A solution judged by its residual, after one step of refinement if it needs that."""
        largest = self._norm
        for step in range(2):
            rest = b - self._product(x)
            size = largest * np.max(np.abs(x), initial=0.0) + np.max(np.abs(b), initial=0.0)
            error = np.max(np.abs(rest), initial=0.0)
            # All processes have the same bits, so all take this branch.
            if error <= _REFINE_ABOVE * size or not np.isfinite(error) or step == 1:
                break
            x = x + self._solve_scaled(rest)
        if not error <= _REFUSE_ABOVE * size:
            raise SingularError("matrix is singular: the residual of the solution is too large")
        return x

    def _release(self) -> None:
        for held in (self._solver, self._matrix):
            if held is not None:
                held.destroy()
        self._solver = self._matrix = None


def _columns(x: Floats) -> list[Floats]:
    return [x] if x.ndim == 1 else list(x.T)


def _inverse_power(size: Floats) -> Floats:
    """Power of two next to the inverse of sizes; 1 for what is zero."""
    known = size > 0.0
    return np.where(known, np.exp2(-np.round(np.log2(np.where(known, size, 1.0)))), 1.0)
