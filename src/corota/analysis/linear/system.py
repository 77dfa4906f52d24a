"""Linear systems of one analysis, with the last factorization and its pattern."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from corota.analysis.linear.unsymmetric import MaskedLu
from corota.analysis.timer import Timer

if TYPE_CHECKING:
    from corota.analysis.linear.matrix import SymmetricPattern
    from corota.analysis.linear.solvers import Inertia, LinearSolver
    from corota.analysis.linear.types import Sparse
    from corota.arrays import Bools, Floats, Ints


class LinearSystem:
    """A direct solver that orders a new pattern at its first use, and an LU solver beside it.

    Parameters
    ----------
    solver : LinearSolver
        For symmetric matrices.

    Attributes
    ----------
    last : LinearSolver or MaskedLu
        Solver with the last factorization.
    """

    def __init__(self, solver: LinearSolver) -> None:
        self.solver = solver
        self.last: LinearSolver | MaskedLu = solver
        self._timers: defaultdict[str, Timer] = defaultdict(Timer)
        self._lu = MaskedLu()
        self._pattern: SymmetricPattern | None = None

    def timed(self, phase: str) -> Timer:
        """Add the time of a block to the profile."""
        return self._timers[phase]

    @property
    def profile(self) -> dict[str, float]:
        """Seconds by phase."""
        return {phase: timer.seconds for phase, timer in self._timers.items()}

    def factorize(self, pattern: SymmetricPattern, values: Floats) -> Inertia | None:
        """Factorize a symmetric matrix; the inertia, where it is known.

        Raises
        ------
        SingularError
            The matrix is singular to working precision.
        """
        if self._pattern is not pattern:
            with self.timed("order"):
                pattern.analyze(self.solver)
            self._pattern = pattern
        with self.timed("factor"):
            inertia = self.solver.factorize(values)
        self.last = self.solver
        return inertia

    def factorize_unsymmetric(self, matrix: Sparse, constrained: Bools, node: Ints) -> None:
        """Factorize a scipy CSC matrix with diagonal rows and columns of constrained unknowns.

        Raises
        ------
        SingularError
            The matrix is singular to working precision.
        """
        self.last = self._lu
        with self.timed("factor"):
            self._lu.factorize(matrix, constrained, node)

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k), with the last factorization."""
        with self.timed("solve"):
            x: Floats = self.last.solve(rhs)
        return x
