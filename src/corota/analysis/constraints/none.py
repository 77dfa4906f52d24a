"""A model without constraints: every dof is an unknown; no transformation."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.constraints.elimination import Constraints, LinearizedConstraints

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.linear.matrix import SymmetricPattern
    from corota.analysis.linear.triplets import Triplets
    from corota.analysis.linear.types import Kind, Sparse
    from corota.arrays import Floats, Ints
    from corota.model.model import Model


class Identity(LinearizedConstraints):
    """Identity constraints: forces, changes and matrices are returned without copies."""

    couples = False

    def __init__(self) -> None:
        pass

    def __repr__(self) -> str:
        return "Identity()"

    def gather(self, force: Floats) -> Floats:
        return force

    def gather_sizes(self, size: Floats) -> Floats:
        return size

    def move(self, dv: Floats) -> Floats:
        return dv

    def unknowns(self, x: NDArray[Kind]) -> NDArray[Kind]:
        return x

    def expand(self, x: Floats) -> Floats:
        return x

    def linear(self) -> LinearizedConstraints:
        return self

    def reduce(self, values: Floats, residual: Floats) -> Floats:
        return values

    def reduce_full(self, matrix: Sparse, residual: Floats) -> Sparse:
        return matrix

    def reduce_columns(self, columns: Sparse) -> Sparse:
        return columns

    def reduce_entries(self, entries: Triplets, n: int) -> Sparse:
        return entries.matrix(n)

    def symmetric_half(self, entries: Triplets) -> Triplets:
        return entries.keep(entries.rows <= entries.columns)

    def neighbors(self, dofs: Ints) -> Ints:
        return dofs


#: The one linearization of no constraints.
IDENTITY = Identity()


class NoConstraints(Constraints):
    """See :class:`Constraints`; empty, at no cost.

    Parameters
    ----------
    start : ndarray of int, shape (n_nodes + 1,)
    matrix : SymmetricPattern
        Of the matrix of all dofs, which is that of the unknowns.
    """

    def __init__(self, start: Ints, matrix: SymmetricPattern) -> None:
        self.n, self.start, self.pattern = int(start[-1]), start, matrix
        self.axes, self.relations, self.owner, self.bending = {}, [], {}, []
        self.depth = 0
        self.free = np.arange(self.n)
        self.dependent = self.eliminated = np.zeros(0, np.int64)
        self.place = np.full(self.n, -1, np.int64)
        self.inert = np.zeros(self.n, bool)

    def to_global(self, u: Floats) -> Floats:
        return u

    def to_axes(self, u: Floats) -> Floats:
        return u

    def entries_to_axes(
        self, rows: Ints, columns: Ints, values: Floats
    ) -> tuple[Ints, Ints, Floats]:
        return rows, columns, values

    def complete(self, u: Floats) -> None:
        pass

    def complete_rates(self, u: Floats, v: Floats, a: Floats | None = None) -> None:
        pass

    def link(self, u: Floats) -> LinearizedConstraints:
        return IDENTITY

    def secant(self, begin: Floats, end: Floats) -> LinearizedConstraints:
        return IDENTITY


def constraints_of(
    model: Model, start: Ints, carried: Ints, matrix: SymmetricPattern
) -> Constraints:
    """The constraints and local axes of a model; parameters as for :class:`Constraints`."""
    if model.constraints or model.axes:
        return Constraints(model, start, carried, matrix)
    return NoConstraints(start, matrix)
