"""A factorized matrix of dofs and multipliers, symmetric or not."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from corota.analysis.linear.solvers import Multifrontal
from corota.errors import SingularError

if TYPE_CHECKING:
    from corota.analysis.linear.types import Sparse
    from corota.arrays import Bools, Floats, Ints


#: Relative size of a product that consists of rounding errors only.
NULL = 1e-9


class Factor:
    """A factorized matrix of the active unknowns.

    Parameters
    ----------
    matrix : scipy CSC array, shape (n, n)
    node : ndarray of int, shape (n,)
        Node of each unknown; unknowns of one node are contiguous.
    multiplier : ndarray of bool, shape (n,)

    Attributes
    ----------
    negative : int
        Negative pivots beyond one for each multiplier; -1 where unknown.

    Raises
    ------
    SingularError
        If the matrix is singular.
    """

    def __init__(
        self,
        matrix: Sparse,
        symmetric: bool,
        node: Ints,
        multiplier: Bools,
        threads: int,
    ) -> None:
        self.negative = -1
        if symmetric:
            try:
                self._symmetric(matrix, node, multiplier, threads)
                return
            except SingularError as error:
                # The test for motions without stiffness uses the energy, which multipliers make
                # vanish also for other motions.
                if not multiplier.any() or _is_null(matrix, error.mode):
                    raise
        solver = Multifrontal(symmetric=False)
        solver.threads = threads
        matrix = matrix.tocsc()
        matrix.sort_indices()
        solver.analyze(matrix.indptr, matrix.indices, node)
        solver.factorize(matrix.data)
        self._solver = solver

    def _symmetric(self, matrix: Sparse, node: Ints, multiplier: Bools, threads: int) -> None:
        upper = sp.triu(matrix).tocsc()
        upper.sort_indices()
        solver = Multifrontal()
        solver.threads = threads
        after = np.flatnonzero(multiplier) if multiplier.any() else None
        solver.analyze(upper.indptr, upper.indices, node, after)
        inertia = solver.factorize(upper.data)
        if inertia is not None:
            self.negative = inertia[1] - int((matrix.diagonal()[multiplier] < 0.0).sum())
        self._solver = solver

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k)."""
        return self._solver.solve(rhs)


def _is_null(matrix: Sparse, mode: Floats) -> bool:
    """Whether a symmetric matrix maps a vector to rounding errors only."""
    if mode is None:
        return True
    v = np.asarray(mode, float).reshape(matrix.shape[0], -1)[:, 0]
    left, size = np.abs(matrix @ v), abs(matrix) @ np.abs(v)
    return bool(left.max() <= NULL * size.max())
