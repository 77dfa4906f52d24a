# SPDX-License-Identifier: BSD-3-Clause
"""PARDISO of Intel's oneMKL behind the interface of the linear solvers, if installed."""

from __future__ import annotations

import ctypes
import ctypes.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import ResourceError, SingularError, UnsupportedError

if TYPE_CHECKING:
    from corota.analysis.linear.types import Index
    from corota.arrays import Floats

    Inertia = tuple[int, int, int]

#: Matrix types of PARDISO: real symmetric indefinite, real unsymmetric.
_SYMMETRIC, _UNSYMMETRIC = -2, 11
_ANALYZE, _FACTORIZE, _SOLVE, _RELEASE = 11, 22, 33, -1
#: Backward error above which a solution is refused.
_REFUSE_ABOVE = 1e-9


def find_mkl() -> Path | None:
    """Path of oneMKL's single library: in this environment, or on the system's search path."""
    prefix = Path(sys.prefix)
    for folder, pattern in (("lib", "libmkl_rt.*"), ("Library/bin", "mkl_rt*.dll")):
        found = sorted((prefix / folder).glob(pattern))
        if found:
            return found[-1]
    name = ctypes.util.find_library("mkl_rt")
    return Path(name) if name else None


class Pardiso:
    """Intel oneMKL PARDISO: the package ``mkl`` has to be installed.

    Parameters
    ----------
    symmetric : bool
        Whether the matrix comes as an upper triangle; then with inertia.

    Raises
    ------
    UnsupportedError
        oneMKL is not installed.
    """

    def __init__(self, symmetric: bool = True) -> None:
        path = find_mkl()
        if path is None:
            raise UnsupportedError(
                "the solver 'pardiso' needs Intel oneMKL: pip install 'corota[pardiso]', "
                "or use 'multifrontal'"
            )
        self._mkl = ctypes.CDLL(str(path))
        self._symmetric = symmetric
        self._handle = np.zeros(64, dtype=np.int64)
        self._options = np.zeros(64, dtype=np.int32)
        self._n = 0
        self._threads = 0

    @property
    def threads(self) -> int:
        """Threads to use, 0 for all the machine has."""
        return self._threads

    @threads.setter
    def threads(self, count: int) -> None:
        self._threads = count

    def analyze(
        self,
        indptr: Index,
        indices: Index,
        node_of_dof: Index,
        after: Index | None = None,
    ) -> None:
        """Order and prepare for a pattern (see `LinearSolver`); the nodes are not used."""
        import scipy.sparse as sp

        self._release()
        n = self._n = len(indptr) - 1
        # Rows instead of columns, every diagonal entry there: PARDISO needs both.
        starts = np.asarray(indptr, dtype=np.int64)
        columns = np.repeat(np.arange(n), starts[1:] - starts[:-1])
        rows = np.asarray(indices, np.int64)
        every = np.arange(n)
        number = np.concatenate([np.arange(1, len(rows) + 1), np.zeros(n, np.int64)])
        place = sp.coo_array(
            (number, (np.concatenate([rows, every]), np.concatenate([columns, every]))),
            shape=(n, n),
        ).tocsr()
        place.sort_indices()
        self._place = place.data  # 0: an entry missing in the caller's pattern
        self._indptr = place.indptr.astype(np.int32)
        self._indices = place.indices.astype(np.int32)
        self._values = np.zeros(len(self._place))
        options = self._options
        options[:] = 0
        options[0] = 1  # no defaults
        options[1] = 2  # nested dissection
        options[7] = 2  # steps of refinement
        options[9] = 8 if self._symmetric else 13  # pivots below 10^-8 (-13) are perturbed
        options[20] = 1  # pivots of one and two columns
        options[34] = 1  # indices from 0
        self._call(_ANALYZE)

    def factorize(self, data: Floats) -> Inertia | None:
        """Factorize values of shape (nnz,); returns the inertia if symmetric.

        Raises
        ------
        SingularError
            A pivot vanished; PARDISO does not report which.
        """
        if not np.all(np.isfinite(data)):
            raise SingularError("the matrix has entries that are not finite")
        np.copyto(self._values, np.concatenate([[0.0], data])[self._place])
        self._call(_FACTORIZE)
        perturbed = int(self._options[13])
        if perturbed:
            raise SingularError(f"matrix is singular: {perturbed} pivot(s) vanished")
        if not self._symmetric:
            return None
        positive, negative = int(self._options[21]), int(self._options[22])
        return positive, negative, self._n - positive - negative

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k).

        Raises
        ------
        SingularError
            The residual is not that of a solution.
        """
        b = np.array(rhs, dtype=float, order="F")
        x = np.zeros_like(b, order="F")
        self._call(_SOLVE, b, x)
        self._check_growth(x, b)
        return x

    def _check_growth(self, x: Floats, b: Floats) -> None:
        import scipy.sparse as sp

        matrix = sp.csr_array((self._values, self._indices, self._indptr), shape=(self._n,) * 2)
        product = matrix @ x
        if self._symmetric:
            product += matrix.T @ x
            product -= (matrix.diagonal() * x.T).T
        largest = np.max(np.abs(self._values), initial=0.0)
        size = largest * np.max(np.abs(x), initial=0.0) + np.max(np.abs(b), initial=0.0)
        if not np.max(np.abs(b - product), initial=0.0) <= _REFUSE_ABOVE * size:
            raise SingularError("matrix is singular: the residual of the solution is too large")

    def _call(self, phase: int, b: Floats | None = None, x: Floats | None = None) -> None:
        def integer(value: int) -> object:
            return ctypes.byref(ctypes.c_int32(value))

        def array(values: Index | Floats | None) -> ctypes.c_void_p | None:
            return None if values is None else ctypes.c_void_p(values.ctypes.data)

        previous = self._mkl.MKL_Set_Num_Threads_Local(self._threads)
        error = ctypes.c_int32(0)
        self._mkl.pardiso(
            array(self._handle),
            integer(1),
            integer(1),
            integer(_SYMMETRIC if self._symmetric else _UNSYMMETRIC),
            integer(phase),
            integer(self._n),
            array(self._values),
            array(self._indptr),
            array(self._indices),
            None,
            integer(1 if b is None or b.ndim == 1 else b.shape[1]),
            array(self._options),
            integer(0),
            array(b),
            array(x),
            ctypes.byref(error),
        )
        self._mkl.MKL_Set_Num_Threads_Local(previous)
        if error.value == -2:
            raise ResourceError("PARDISO has not enough memory for the factorization")
        if error.value == -4:
            raise SingularError("matrix is singular: a pivot vanished")
        if error.value:
            raise SingularError(f"PARDISO stopped with error {error.value}")

    def _release(self) -> None:
        if np.any(self._handle):
            self._call(_RELEASE)
            self._handle[:] = 0

    def __del__(self) -> None:
        if hasattr(self, "_values"):
            self._release()
