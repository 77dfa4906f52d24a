"""Constraints by elimination: dependent dofs as functions of the others.

With the state ``u = g(v)`` of the independent dofs v, G = dg/dv and Q the rotation from the nodes'
own axes to the global ones, equilibrium is ``G^T r = 0`` and Newton's matrix is
``(Q G)^T K (Q G) + sum_s r_s d2 g_s / dv dv``. Only entries in rows and columns of constrained
dofs change, so a map of positions is built once and applied to the values.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.linear.triplets import Triplets
from corota.errors import Location, ModelError
from corota.model.constraints import local_axes

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.constraints.relations import Relation
    from corota.analysis.linear.matrix import SymmetricPattern
    from corota.analysis.linear.reduction import Rows
    from corota.analysis.linear.types import Kind, Sparse
    from corota.arrays import Floats, Ints
    from corota.model.model import Model


@dataclass(eq=False)
class LinearizedConstraints:
    """The constraints linearized at a state.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    g : sparse array, shape (n_dependent, n_dofs)
        Dependent dofs by independent ones.
    direct : sparse array, shape (n_dependent, n_dofs)
        Dependent dofs by their masters, before substitution.
    curvature : float
        Weight of the second derivatives in the reduced matrix: 0 where it is not a tangent.
    """

    constraints: Constraints
    u: Floats
    g: Any
    direct: Sparse
    curvature: float = 1.0

    #: Whether any dof depends on others or has local axes.
    couples = True

    def gather(self, force: Floats) -> Floats:
        """``G^T`` of forces, in all dofs; zero at dependent ones. Shape as `force`."""
        out: Floats = force.copy()
        out[self.constraints.eliminated] = 0.0
        out += self.g.T @ force[self.constraints.dependent]
        return out

    def gather_sizes(self, size: Floats) -> Floats:
        """``|G|^T`` of sizes of forces, zero at dependent dofs."""
        out: Floats = size.copy()
        out[self.constraints.eliminated] = 0.0
        out += abs(self.g).T @ size[self.constraints.dependent]
        return out

    def move(self, dv: Floats) -> Floats:
        """``G`` of changes of the independent dofs, given in all dofs."""
        out: Floats = dv.copy()
        out[self.constraints.eliminated] = 0.0
        out[self.constraints.dependent] = self.g @ out
        return out

    def unknowns(self, x: NDArray[Kind]) -> NDArray[Kind]:
        """Entries of the unknowns of a vector with one for each dof."""
        return x[self.constraints.free]

    def expand(self, x: Floats) -> Floats:
        """Changes of all dofs from those of the unknowns, shape (n_unknowns, ...)."""
        out = np.zeros((self.constraints.n, *x.shape[1:]), order="F")
        out[self.constraints.free] = x
        return self.move(out)

    def linear(self) -> LinearizedConstraints:
        """These constraints without second derivatives: for matrices that are not tangents."""
        return replace(self, curvature=0.0)

    @cached_property
    def transform(self) -> Sparse:
        """All dofs in global axes by the unknowns, scipy CSC."""
        return self.constraints.reduction.whole(self.constraints.rows_of(self.g))

    def reduce_columns(self, columns: Sparse) -> Sparse:
        """Columns of forces in global axes as those on the unknowns, scipy sparse."""
        return self.transform.T @ columns

    def symmetric_half(self, entries: Triplets) -> Triplets:
        """Upper triangle of the reduced matrix of symmetric entries in global axes."""
        whole = self.reduce_entries(entries, self.constraints.n)
        return Triplets.halves(0.5 * (whole + whole.T))[0]

    def reduce_entries(self, entries: Triplets, n: int) -> Sparse:
        """The reduced matrix of entries of all `n` dofs in global axes, scipy CSR."""
        return self.transform.T @ entries.matrix(n) @ self.transform

    def neighbors(self, dofs: Ints) -> Ints:
        """Unknowns for dofs of a predicted pattern: none."""
        return dofs[:0]

    def geometric_stiffness(self, residual: Floats) -> Floats:
        """Entries of ``sum_s r_s d2 g_s`` of nonlinear relations, in the map's order."""
        constraints = self.constraints
        force = self.curvature * residual[constraints.dependent]
        own = force
        for _ in range(constraints.depth):
            own = force + self.direct[:, constraints.dependent].T @ own
        total = np.zeros(constraints.n)
        total[constraints.dependent] = own
        parts = [
            r.geometric_stiffness(self.u, total[r.dependent])[np.triu_indices(len(r.masters))]
            for r in constraints.bending
        ]
        return np.concatenate(parts) if parts else np.zeros(0)

    def reduce(self, values: Floats, residual: Floats) -> Floats:
        """Values of the reduced matrix, upper triangle."""
        constraints = self.constraints
        return constraints.reduction.reduce(
            values, constraints.rows_of(self.g), self.g, self.geometric_stiffness(residual)
        )

    def reduce_full(self, matrix: Sparse, residual: Floats) -> Sparse:
        """The reduced matrix of an unsymmetric one, scipy CSC."""
        return self.constraints.reduction.reduce_full(
            matrix, self.constraints.rows_of(self.g), self.g, self.geometric_stiffness(residual)
        )


class Constraints:
    """All constraints and local axes of a model.

    Parameters
    ----------
    start : ndarray of int, shape (n_nodes + 1,)
    carried : ndarray of int, shape (n_nodes,)
        Dofs of each node that elements carry.
    matrix : SymmetricPattern
        Of the matrix of all dofs.

    Attributes
    ----------
    dependent : ndarray of int
        Dependent dofs, sorted.
    gone : ndarray of int
        Dofs without an equation: dependent, or with no stiffness and no constraint.
    free : ndarray of int
        The others: the unknowns.
    """

    def __init__(self, model: Model, start: Ints, carried: Ints, matrix: SymmetricPattern) -> None:
        from corota.analysis.constraints.setup import Builder
        from corota.analysis.linear.reduction import Reduction, Rows

        self.n = int(start[-1])
        self._about_reference = False
        self.start = start
        self.axes = local_axes(model.mesh, model.axes)
        self.builder = Builder(model, start, self.axes)
        self.relations = self.builder.build()
        self.owner: dict[int, Relation] = {}
        for relation in self.relations:
            self.owner.update(dict.fromkeys(relation.dependent.tolist(), relation))
        self.dependent = np.array(sorted(self.owner), np.int64)
        self.place = np.full(self.n, -1, np.int64)
        self.place[self.dependent] = np.arange(len(self.dependent))
        used = np.zeros(self.n, bool)
        used[self.dependent] = True
        for relation in self.relations:
            used[relation.masters] = True
        node = np.repeat(np.arange(len(start) - 1), np.diff(start))
        used |= np.arange(self.n) - start[node] < carried[node]
        self.inert = ~used
        eliminated = self.inert.copy()
        eliminated[self.dependent] = True
        self.eliminated = np.flatnonzero(eliminated)
        self.free = np.flatnonzero(~eliminated)
        self.bending = [r for r in self.relations if not r.linear]
        self.depth = self._depth()
        self._turns()
        pattern = self._substituted(lambda r: np.ones((len(r.dependent), len(r.masters))))[0]
        pairs = [
            (r.masters[i], r.masters[j])
            for r in self.bending
            for i, j in [np.triu_indices(len(r.masters))]
        ]
        self.reduction = Reduction(
            matrix,
            self.free,
            self.rows_of(pattern),
            Rows(self.dependent, pattern),
            pairs,
        )
        #: Of the matrix of the unknowns.
        self.pattern = self.reduction.pattern

    def _depth(self) -> int:
        """Longest chain of relations that depend on each other."""
        level: dict[int, int] = {}
        for r in self.relations:
            owners = {id(self.owner[m]) for m in r.masters.tolist() if m in self.owner}
            level[id(r)] = 1 + max((level[o] for o in owners), default=-1)
        return max(level.values(), default=0)

    def _turns(self) -> None:
        """The rotation from the axes of nodes to the global ones."""
        import scipy.sparse as sp

        nodes = np.array([n for n in sorted(self.axes) if self.start[n + 1] > self.start[n]], int)
        self.turned = np.concatenate([self.start[nodes], self.start[nodes] + 1]).astype(np.int64)
        r = np.array([self.axes[int(n)] for n in nodes]).reshape(-1, 2, 2)
        self._q = r
        self._first = self.start[nodes]
        special = np.union1d(self.dependent, self.turned)
        where = {int(d): k for k, d in enumerate(special)}
        rows, columns, values = [], [], []
        turned = set(self.turned.tolist())
        for k, dof in enumerate(special.tolist()):
            if dof not in turned:
                rows.append(k)
                columns.append(k)
                values.append(1.0)
        for block, dof in zip(r, self._first.tolist(), strict=True):
            for i in range(2):
                for j in range(2):
                    rows.append(where[dof + i])
                    columns.append(where[dof + j])
                    values.append(block[i, j])
        m = len(special)
        self.special = special
        self._turn = sp.csr_array((values, (rows, columns)), shape=(m, m))

    # -- axes --------------------------------------------------------------------------

    def to_global(self, u: Floats) -> Floats:
        """A vector along the nodes' axes in global axes, shape (n_dofs,)."""
        return self._turned(u, "nij,nj->ni")

    def to_axes(self, u: Floats) -> Floats:
        """Inverse of :meth:`to_global`."""
        return self._turned(u, "nji,nj->ni")

    def entries_to_axes(
        self, rows: Ints, columns: Ints, values: Floats
    ) -> tuple[Ints, Ints, Floats]:
        """Entries of rows by dofs in global axes, as those by dofs along the nodes' axes."""
        mine = np.isin(columns, self.turned)
        if not mine.any():
            return rows, columns, values
        node = np.searchsorted(self._first, columns[mine], side="right") - 1
        first = self._first[node]
        parts = values[mine, None] * self._q[node, columns[mine] - first]
        key = (rows[mine] * self.n + first)[:, None] + np.arange(2)
        key, place = np.unique(key.ravel(), return_inverse=True)
        total = np.bincount(place, parts.ravel())
        # What is across an axis but for rounding.
        kept = np.abs(total) > 1e-12 * np.bincount(place, np.abs(parts).ravel())
        return (
            np.concatenate([rows[~mine], key[kept] // self.n]),
            np.concatenate([columns[~mine], key[kept] % self.n]),
            np.concatenate([values[~mine], total[kept]]),
        )

    def _turned(self, u: Floats, rule: str) -> Floats:
        if not len(self._first):
            return u
        out: Floats = u.copy()
        pair = np.stack([u[self._first], u[self._first + 1]], axis=1)
        pair = np.einsum(rule, self._q, pair)
        out[self._first], out[self._first + 1] = pair[:, 0], pair[:, 1]
        return out

    # -- state -------------------------------------------------------------------------

    def set_nlgeom(self, nlgeom: bool, about_reference: bool = False) -> None:
        """Let rotations be finite, or infinitesimal.

        With `about_reference` displacements are those of the linear theory, dependent dofs among
        them, and relations are linearized about the reference, their second derivatives there too.
        """
        self._about_reference = about_reference
        for relation in self.relations:
            relation.nlgeom = nlgeom

    def _shape(self, u: Floats) -> Floats:
        """The displacement about which relations are linearized."""
        return np.zeros_like(u) if self._about_reference else u

    def complete(self, u: Floats) -> None:
        """Set the dependent dofs of `u` from the others, in place."""
        if self._about_reference:
            return
        for relation in self.relations:
            u[relation.dependent] = relation.values(u)

    def complete_rates(self, u: Floats, v: Floats, a: Floats | None = None) -> None:
        """Set velocities and accelerations of the dependent dofs at `u`, in place."""
        u = self._shape(u)
        v[self.inert] = 0.0
        for relation in self.relations:
            j = relation.jacobian(u)
            v[relation.dependent] = j @ v[relation.masters]
            if a is not None:
                a[relation.dependent] = j @ a[relation.masters] + relation.curve(u, v)

    def near_their_limit(self, u: Floats) -> str:
        """What may prevent convergence at `u`; empty if nothing."""
        return next(filter(None, (r.near_its_limit(u) for r in self.relations)), "")

    def link(self, u: Floats) -> LinearizedConstraints:
        """Linearize at `u`."""
        u = self._shape(u)
        g, direct = self._substituted(lambda r: r.jacobian(u))
        return LinearizedConstraints(self, u, g, direct)

    def secant(self, begin: Floats, end: Floats) -> LinearizedConstraints:
        """The exact discrete derivatives between two states, for the energy-momentum scheme."""
        g, direct = self._substituted(lambda r: r.secant(begin, end))
        # Forces at the middle: half of the geometric stiffness of a change at the end.
        return LinearizedConstraints(self, end, g, direct, 0.5)

    def _substituted(self, jacobian: Callable[[Relation], Floats]) -> tuple[Sparse, Sparse]:
        import scipy.sparse as sp

        rows, columns, values = [np.zeros(0, int)], [np.zeros(0, int)], [np.zeros(0)]
        for r in self.relations:
            d, m = len(r.dependent), len(r.masters)
            rows.append(np.repeat(self.place[r.dependent], m))
            columns.append(np.tile(r.masters, d))
            values.append(jacobian(r).ravel())
        entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
        direct = sp.csr_array(entries, shape=(len(self.dependent), self.n))
        g = direct
        if self.depth:
            keep = np.ones(self.n)
            keep[self.dependent] = 0.0
            outside = direct @ sp.diags_array(keep)
            inside = direct[:, self.dependent]
            g = outside
            for _ in range(self.depth):
                g = outside + inside @ g
        return g.tocsr(), direct

    def rows_of(self, g: Sparse) -> Rows:
        """Rows of ``Q G`` that are not those of the identity."""
        import scipy.sparse as sp

        from corota.analysis.linear.reduction import Rows

        m = len(self.special)
        chosen = self.place[self.special]
        own = np.flatnonzero(chosen < 0)
        identity = sp.csr_array((np.ones(len(own)), (own, self.special[own])), shape=(m, self.n))
        put = np.flatnonzero(chosen >= 0)
        spread = sp.csr_array(
            (np.ones(len(put)), (put, chosen[put])), shape=(m, len(self.dependent))
        )
        return Rows(self.special, (self._turn @ (identity + spread @ g)).tocsr())

    # -- questions ---------------------------------------------------------------------

    def refuse_constrained(self, dofs: Ints, where: Location | None) -> None:
        """Refuse supports at dependent dofs.

        Raises
        ------
        ModelError
            Naming the dof, the support and the constraint.
        """
        for dof in dofs[self.place[dofs] >= 0].tolist():
            relation = self.owner[dof]
            place = f" ({relation.where})" if relation.where is not None else ""
            raise ModelError(
                f"{self.builder.name(dof)} is supported, but {relation.what}{place} determines "
                f"it already; support {relation.instead} instead",
                where,
            )

    def refuse_loaded(self, dofs: Ints, where: Location | None) -> None:
        """Refuse forces at dofs without elements and constraints."""
        for dof in dofs[self.inert[dofs]].tolist():
            raise ModelError(
                f"{self.builder.name(dof)} belongs to no element and no constraint, so it cannot "
                "carry a force",
                where,
            )
