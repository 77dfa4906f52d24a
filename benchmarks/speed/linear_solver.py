"""Numeric factorization and solve of Q4 elasticity matrices by all direct solvers here.

Rows are ratios inside one run. The refactorization is timed: the pattern is known,
the values are new, as in every Newton iteration.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
import time
from functools import partial
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp

from benchmarks.common import interleaved, report
from corota.analysis.linear import pardiso
from corota.analysis.linear.petsc import Petsc
from corota.analysis.linear.solvers import Multifrontal, SuperLU

if TYPE_CHECKING:
    from collections.abc import Callable

#: Elements along a side: about 400, 10 thousand, 250 thousand and a million equations.
SIDES = (14, 70, 353, 706)
#: SuperLU orders again and fills more: it is left out above this number of equations.
SUPERLU_LIMIT = 100_000


def element_matrix(nu: float = 0.3) -> np.ndarray[Any, Any]:
    """Stiffness of the bilinear unit square in plane stress, E = 1."""
    material = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]]) / (1 - nu**2)
    stiffness = np.zeros((8, 8))
    for x in (-1, 1) / np.sqrt(3):
        for y in (-1, 1) / np.sqrt(3):
            dx = np.array([y - 1, 1 - y, 1 + y, -1 - y]) / 2
            dy = np.array([x - 1, -1 - x, 1 + x, 1 - x]) / 2
            strain = np.zeros((3, 8))
            strain[0, 0::2] = strain[2, 1::2] = dx
            strain[1, 1::2] = strain[2, 0::2] = dy
            stiffness += strain.T @ material @ strain / 4
    return stiffness


def square(side: int) -> tuple[sp.csc_array, np.ndarray[Any, Any]]:
    """Upper triangle of a square of side x side elements, clamped left; node of each dof."""
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(side), np.arange(side), indexing="ij"))
    first = i * (side + 1) + j
    nodes = np.stack([first, first + side + 1, first + side + 2, first + 1], axis=1)
    dofs = np.stack([2 * nodes, 2 * nodes + 1], axis=2).reshape(-1, 8)
    rows, columns = np.repeat(dofs, 8, axis=1).ravel(), np.tile(dofs, (1, 8)).ravel()
    values = np.tile(element_matrix().ravel(), len(nodes))
    upper = rows <= columns
    n = 2 * (side + 1) ** 2
    matrix = sp.coo_array((values[upper], (rows[upper], columns[upper])), shape=(n, n)).tocsc()
    held = 2 * (side + 1)
    matrix = sp.csc_array(matrix[held:, held:])
    matrix.sort_indices()
    return matrix, np.arange(held, n) // 2


def contenders(n: int) -> dict[str, Callable[[], Any]]:
    """Solvers by name of the table's column."""

    def threaded(kind: Callable[[], Any], threads: int) -> Callable[[], Any]:
        def make() -> Any:
            solver = kind()
            solver.threads = threads
            return solver

        return make

    found: dict[str, Callable[[], Any]] = {
        "corota 1": threaded(Multifrontal, 1),
        "corota 2": threaded(Multifrontal, 2),
    }
    if pardiso.find_mkl() is not None:
        found["PARDISO 1"] = threaded(pardiso.Pardiso, 1)
        found["PARDISO 2"] = threaded(pardiso.Pardiso, 2)
    if find_spec("petsc4py") is not None:
        found["MUMPS 1"] = Petsc
    if n < SUPERLU_LIMIT:
        found["SuperLU"] = SuperLU
    return found


def main() -> None:
    sides = [int(word) for word in sys.argv[1:]] or SIDES
    rows = []
    for side in sides:
        matrix, node = square(side)
        n = matrix.shape[0]
        rhs = np.random.default_rng(1).normal(size=n)
        solvers: dict[str, Any] = {}
        ordering: dict[str, float] = {}
        for name, make in contenders(n).items():
            solvers[name] = make()
            start = time.perf_counter()
            solvers[name].analyze(matrix.indptr, matrix.indices, node)
            ordering[name] = time.perf_counter() - start
        repeats = 3 if n > 500_000 else 5 if n > 100_000 else 15
        factor = interleaved(
            {k: partial(s.factorize, matrix.data) for k, s in solvers.items()}, repeats
        )
        solve = interleaved({k: partial(s.solve, rhs) for k, s in solvers.items()}, repeats)
        answers = {name: solver.solve(rhs) for name, solver in solvers.items()}
        expected = answers["corota 1"]
        for name in solvers:
            error = np.abs(answers[name] - expected).max() / np.abs(expected).max()
            rows.append(
                (
                    n,
                    name,
                    ordering[name],
                    factor[name],
                    factor["corota 1"] / factor[name],
                    solve[name],
                    solve["corota 1"] / solve[name],
                    f"{error:.0e}",
                )
            )
        same = np.array_equal(answers["corota 1"], answers["corota 2"])
        gain = factor["corota 1"] / factor["corota 2"]
        rows.append((n, f"two threads: x {gain:.2f}, bits equal: {same}", *[""] * 6))
        solvers.clear()
    head = ("dofs", "solver", "analyze s", "factor s", "gain", "solve s", "gain", "differs")
    report("Direct solvers, Q4 plane stress", head, rows)


if __name__ == "__main__":
    main()
