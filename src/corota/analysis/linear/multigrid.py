# SPDX-License-Identifier: BSD-3-Clause
"""Conjugate gradients with PETSc's algebraic multigrid, for models too large for a factorization.

The multigrid is GAMG, smoothed aggregation, with the rigid-body motions as near-null space:
P. Vanek, J. Mandel and M. Brezina, Computing 56 (1996) 179-196.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.petsc import Petsc
from corota.errors import UnsupportedError

if TYPE_CHECKING:
    from petsc4py import PETSc

    from corota.analysis.linear.types import Index
    from corota.analysis.parallel.communicator import Communicator
    from corota.arrays import Floats


#: Relative residual of a solution, and iterations after which there is none.
TOLERANCE, MOST = 1e-10, 2000


class PetscMultigrid(Petsc):
    """Conjugate gradients with GAMG in PETSc, for positive definite matrices without multipliers.

    PETSc's own options, in ``PETSC_OPTIONS``, hold over the settings here: ``-ksp_type gmres``,
    ``-ksp_rtol``, ``-pc_gamg_threshold``, ``-ksp_monitor``.

    Parameters
    ----------
    symmetric : bool
        Must be true.

    Attributes
    ----------
    motions : ndarray, shape (n, 3), or None
        Rigid-body motions of the unknowns, rotations included; set before `analyze`.
    iterations : int
        Of the last solution.

    Raises
    ------
    UnsupportedError
        PETSc is not installed, or the matrix is not symmetric.
    """

    both = True

    def __init__(self, symmetric: bool = True, communicator: Communicator | None = None) -> None:
        if not symmetric:
            raise UnsupportedError(
                "the solver 'petsc:gamg' takes symmetric matrices only; use 'petsc'"
            )
        super().__init__(symmetric, communicator)
        self.motions: Floats | None = None
        self.iterations = 0

    def analyze(
        self,
        indptr: Index,
        indices: Index,
        node_of_dof: Index,
        after: Index | None = None,
    ) -> None:
        """Keep the pattern (see `LinearSolver`).

        Raises
        ------
        UnsupportedError
            There are multipliers.
        """
        if after is not None:
            raise UnsupportedError(
                "the solver 'petsc:gamg' does not solve for multipliers of contact and ties; use "
                "'petsc'"
            )
        super().analyze(indptr, indices, node_of_dof)
        counts = np.bincount(np.asarray(node_of_dof, np.int64))
        counts = np.unique(counts[counts > 0])
        #: Unknowns of each node, where all have as many.
        self._block = int(counts[0]) if len(counts) == 1 else 1

    def factorize(self, data: Floats) -> None:
        """Set up the multigrid for values of shape (nnz,); the inertia is not known."""
        self._fill(data)
        if self._solver is None:
            self._solver = self._new_solver(0)
        self._attach_motions()
        self._solver.setOperators(self._matrix)
        try:
            self._solver.setUp()
        except self._petsc.Error as error:
            raise UnsupportedError(f"PETSc could not set up the multigrid: {error}") from None

    def _new_matrix(self, shape: tuple[int, int], csr: tuple[Index, Index, Floats]) -> PETSc.Mat:
        matrix = self._petsc.Mat().createAIJ(
            (shape, shape), bsize=self._block, csr=csr, comm=self._handle
        )
        matrix.setOption(self._petsc.Mat.Option.SYMMETRIC, True)
        return matrix

    def _attach_motions(self) -> None:
        """Give the matrix the rigid-body motions in the scaled unknowns."""
        if self.motions is None or len(self.motions) != self._n:
            return
        rows = self._rows
        basis: list[Floats] = []
        for motion in self.motions.T:
            scaled = motion[rows.order] / self._scale
            for known in basis:
                scaled = scaled - float(known @ scaled) * known
            length = float(np.linalg.norm(scaled))
            if length > 0.0:
                basis.append(scaled / length)
        vectors = []
        for motion in basis:
            own = np.ascontiguousarray(motion[rows.first : rows.last])
            vector = self._matrix.createVecRight()
            vector.setArray(own)
            vectors.append(vector)
        space = self._petsc.NullSpace().create(vectors=vectors, comm=self._handle)
        self._matrix.setNearNullSpace(space)
        for held in (space, *vectors):
            held.destroy()

    def _new_solver(self, share: int) -> PETSc.KSP:
        solver = self._petsc.KSP().create(self._handle)
        solver.setType("cg")
        solver.setTolerances(rtol=TOLERANCE, atol=0.0, max_it=MOST)
        solver.setNormType(self._petsc.KSP.NormType.UNPRECONDITIONED)
        solver.setOperators(self._matrix)
        solver.getPC().setType("gamg")
        solver.setFromOptions()
        return solver

    def _solve_vector(self, right: PETSc.Vec, left: PETSc.Vec) -> None:
        solver = self._solver
        solver.solve(right, left)
        self.iterations = solver.getIterationNumber()
        reason = solver.getConvergedReason()
        if reason > 0:
            return
        kinds = self._petsc.KSP.ConvergedReason
        if reason in (kinds.DIVERGED_INDEFINITE_MAT, kinds.DIVERGED_INDEFINITE_PC):
            raise UnsupportedError(
                "the tangent is not positive definite, and conjugate gradients with multigrid need "
                "that: an unstable state, or a part without support; use the solver 'petsc'"
            )
        raise UnsupportedError(
            f"multigrid did not converge in {self.iterations} iterations (PETSc's reason "
            f"{reason}): use the solver 'petsc', or other settings in PETSC_OPTIONS"
        )

    def _refined(self, x: Floats, b: Floats) -> Floats:
        """The iteration has its own measure of the residual."""
        return x
