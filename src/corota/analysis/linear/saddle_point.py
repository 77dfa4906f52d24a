"""Linear systems with multipliers: the tangent with the constraints of contact as borders.

Unknowns are the free dofs and then the multipliers. The pattern holds every coupling that was
seen so far and those next to them, so that it, the ordering and the symbolic factorization remain
valid while contact moves. The unsymmetric part of slipping friction and follower loads is kept
separate: the symmetric part is factorized, and a few steps of GMRES, preconditioned with it,
include the rest; where they do not converge, an LU factorization of the whole matrix is used.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from corota.analysis.linear.gmres import gmres
from corota.analysis.linear.matrix import SymmetricPattern
from corota.analysis.linear.reduction import _union
from corota.analysis.linear.triplets import Triplets
from corota.analysis.parallel.communicator import ALONE, Communicator
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.constraints.elimination import LinearizedConstraints
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.linear.coupling import Coupling
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats, Ints


#: Independent fraction of a constraint below which it is dropped, and the largest number of
#: constraints for this test.
DEPENDENT, MOST_DENSE = 1e-9, 2000
#: Fraction of a gradient at dofs that can move below which supports fix the constraint: its gap
#: changes by less than a millionth of any displacement.
FIXED = 1e-6
#: Relative size of a product that consists of rounding errors only.
NULL = 1e-10
#: Right-hand sides beyond which a factorization of the whole matrix costs less than GMRES.
MOST_COLUMNS = 8


class SaddlePointSystem:
    """Solves the saddle-point systems of a model.

    Parameters
    ----------
    n : int
        Multipliers.
    kept : int
        The first of these belong to constraints that are never dropped in favor of others: ties.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"_resolve", "_link"})

    #: Processes whose values add up to the matrix.
    communicator: Communicator = ALONE

    def __init__(self, system: NumberedModel, n: int, kept: int = 0) -> None:
        self.system, self.n, self.kept = system, n, kept
        if system.constraints.pattern.communicator is not ALONE:
            self.communicator = system.constraints.pattern.communicator
        self.free, base = system.constraints.free, system.constraints.pattern
        self.nf = len(self.free)
        self.size = self.nf + n
        self._base = base.columns * self.size + base.rows
        self.node = np.concatenate(
            [system.node_of_dof[self.free], len(system.per_node) + np.arange(n)]
        )
        self.after = self.nf + np.arange(n)
        self.keys = np.zeros(0, np.int64)
        self._held: Bools | None = None
        #: The last system solved: its prescribed unknowns, constraints and solver.
        self._at_rest = np.zeros(self.size, bool)
        self._link: LinearizedConstraints = system.link
        self._resolve: Callable[[Floats], Floats] = system.linear.solver.solve
        #: Steps of GMRES so far and fall-backs to LU, for reports.
        self.steps = self.whole = 0
        #: Multipliers of redundant constraints.
        self.dropped: set[int] = set()
        #: Distance by which supports violate each constraint that they fix, after the last
        #: correction [length].
        self.left: Floats = np.zeros(n)
        #: The same of constraints that were dropped since others and supports fix them together.
        self.left_by_others: Floats = np.zeros(n)

    # -- pattern -----------------------------------------------------------------------

    def _place(self, rows: Ints, columns: Ints, spare: Callable[[], Ints]) -> Ints:
        """Positions of entries of the upper triangle; missing ones are added to the pattern."""
        wanted = columns * self.size + rows
        if len(self.keys):
            at = np.minimum(np.searchsorted(self.keys, wanted), len(self.keys) - 1)
            if self.communicator.all(np.array_equal(self.keys[at], wanted)):
                return at
        self._grow(np.concatenate([wanted, spare()]))
        return np.searchsorted(self.keys, wanted)

    def _grow(self, more: Ints) -> None:
        if not len(self.keys):
            every = np.arange(self.nf, self.size)
            more = np.concatenate([every * self.size + every, more])
            self.keys = _union(self._base, more)
        else:
            self.keys = _union(self.keys, more)
        self._target = np.searchsorted(self.keys, self._base)
        self.rows = self.keys % self.size
        self.columns = self.keys // self.size
        counts = np.bincount(self.columns, minlength=self.size)
        start = np.concatenate([[0], np.cumsum(counts)])
        self.pattern = SymmetricPattern(start, self.rows, self.node, self.after, self.communicator)
        self.diagonal, self._border_begins = self.pattern.diagonal, start[self.nf]
        self._held = None

    def _mask(self, constrained: Bools) -> Ints:
        """Positions of the off-diagonal entries of prescribed unknowns."""
        if self._held is None or not np.array_equal(constrained, self._held):
            self._held = constrained.copy()
            off = (constrained[self.rows] | constrained[self.columns]) & (self.rows != self.columns)
            self._masked = np.flatnonzero(off)
        return self._masked

    # -- solution ----------------------------------------------------------------------

    def solve(
        self,
        at: Evaluation,
        coupling: Coupling,
        force: Floats,
        rhs: Floats,
        release: Floats,
        du_prescribed: Floats,
    ) -> tuple[Floats, Floats, int]:
        """Corrections of displacements and multipliers.

        Constraints that supports fix are taken out, and their tractions become zero. Where a
        constraint follows from others it is taken out, too, but its traction stays: with the next
        contact states it may be independent, and zero would be a jump of the forces.

        Parameters
        ----------
        force : ndarray, shape (n_dofs, k)
            Right-hand sides of equilibrium.
        rhs : ndarray, shape (n, k)
            And of the constraints.
        release : ndarray, shape (n, k)
            Changes of the multipliers that make them zero.
        du_prescribed : ndarray, shape (n_dofs, k)
            Prescribed changes at constrained dofs, 0 elsewhere.

        Returns
        -------
        du : ndarray, shape (n_dofs, k)
        dp : ndarray, shape (n, k)
        negative : int
            Negative pivots, -1 if unknown.
        """
        system, link = self.system, at.link
        if at.load_stiffness is not None and not (
            system.free_motion_excluded or at.inertial_stiffness
        ):
            # Follower loads give a free motion a stiffness that does not constrain it.
            bare = replace(at, load_stiffness=None)
            none = np.zeros_like(rhs)
            self.solve(bare, coupling, np.zeros_like(force), none, none, 0.0 * du_prescribed)
            system.free_motion_excluded = True
        system.link = link
        constrained = np.zeros(self.size, bool)
        constrained[: self.nf] = system.constrained[self.free]
        with system.timed("border"):
            values = link.reduce(at.values, at.residual)
            upper, rest = self._entries(coupling, self._load(at), link)
            b = np.concatenate([link.unknowns(link.gather(force)), rhs])
            places = self._place(upper.rows, upper.columns, lambda: self._spare(coupling, link))
            data = np.zeros(len(self.keys))
            data[self._target] = values
            if self.communicator.first:
                np.add.at(data, places, upper.values)
            moved = np.zeros_like(b)
            moved[: self.nf] = du_prescribed[self.free]
            for column, move in zip(b.T, moved.T, strict=True):
                if move.any():
                    column -= self._multiply(data, move)
                    np.subtract.at(column, rest.rows, rest.values * move[rest.columns])
            data[self._mask(constrained)] = 0.0
            fixed, length = self._fixed(coupling, data)
            self.left = np.zeros(self.n)
            self.left[fixed] = b[fixed + self.nf, 0] / length
            self.left = self.communicator.broadcast(self.left)
            self.left_by_others = np.zeros(self.n)
            self._take_out(fixed, data, b, release)
            on = self.diagonal[constrained]
            # Rounding, as of a rigid circle that turns about its center, is no pivot.
            size, most = np.abs(data[on]), float(np.abs(data[self.diagonal]).max(initial=0.0))
            data[on] = np.where(size <= NULL * most, most or 1.0, size)
            b[constrained] = 0.0
            rest = rest.keep(~constrained[rest.rows] & ~constrained[rest.columns])
        try:
            x, negative = self._solve(data, rest, b)
        except SingularError as error:
            # The first process has their rows.
            dropped = self.communicator.broadcast(self._dependent(data))
            if not len(dropped):
                raise self._named(error) from None
            rows, sides = data.copy(), b[dropped + self.nf, 0]
            self._take_out(dropped, data, b, np.zeros_like(release))
            fixed = np.concatenate([fixed, dropped])
            try:
                x, negative = self._solve(data, rest, b)
            except SingularError as again:
                raise self._named(again) from None
            self.left_by_others[dropped] = self._violated(dropped, rows, sides, x[:, 0])
        self.dropped.update(fixed.tolist())
        if negative >= 0:
            negative += len(fixed)  # each would have given one
        x[constrained] = moved[constrained]
        self._at_rest, self._link = constrained, link
        return self._spread(x), x[self.nf :], negative

    def correct_with_last_factor(self, force: Floats) -> tuple[Floats, Floats]:
        """Corrections for one more force, shape (n_dofs,), with the last factorization.

        Prescribed dofs and constraints do not change.
        """
        b = np.zeros((self.size, 1))
        b[: self.nf, 0] = self._link.unknowns(self._link.gather(force))
        b[self._at_rest] = 0.0
        x = self._resolve(b)
        x[self._at_rest] = 0.0
        return self._spread(x)[:, 0], x[self.nf :, 0]

    def _spread(self, x: Floats) -> Floats:
        return self._link.expand(x[: self.nf])

    def _fixed(self, coupling: Coupling, data: Floats) -> tuple[Ints, Floats]:
        """Multipliers of constraints whose gradients vanish at all dofs that can move.

        Returns
        -------
        multipliers : ndarray of int
        lengths : ndarray of float
            Of their gradients at all dofs.
        """
        whole = np.bincount(coupling.rows.columns, coupling.rows.values**2, self.n)
        # Keys are sorted by columns: those of multipliers are the last, their diagonal behind them.
        border = np.arange(self._border_begins, len(self.keys))
        border = border[self.rows[border] < self.nf]
        left = np.bincount(self.columns[border] - self.nf, data[border] ** 2, self.n)
        left = self.communicator.sum(left)
        fixed = np.flatnonzero((whole > 0.0) & (left <= FIXED**2 * whole))
        out: Ints = self.communicator.broadcast(fixed)
        length = np.sqrt(whole[out])
        return out, np.where(length > 0.0, length, 1.0)

    def _violated(self, dropped: Ints, data: Floats, sides: Floats, x: Floats) -> Floats:
        """Distances by which a solution violates constraints that were taken out of a matrix."""
        place = np.full(self.size, -1, np.int64)
        place[dropped + self.nf] = np.arange(len(dropped))
        border = np.flatnonzero((place[self.columns] >= 0) & (self.rows < self.nf))
        column, row = place[self.columns[border]], self.rows[border]
        met, square = np.zeros((2, len(dropped)))
        np.add.at(met, column, data[border] * x[row])
        np.add.at(square, column, data[border] ** 2)
        met, square = self.communicator.sum(met), self.communicator.sum(square)
        out: Floats = (sides - met) / np.sqrt(np.where(square > 0.0, square, 1.0))
        return self.communicator.broadcast(out)

    def _take_out(self, multipliers: Ints, data: Floats, b: Floats, release: Floats) -> None:
        """Remove constraints from a matrix and its right-hand sides, in place."""
        if len(multipliers):
            data[np.isin(self.columns, multipliers + self.nf)] = 0.0
            data[self.diagonal[multipliers + self.nf]] = 1.0
            b[multipliers + self.nf] = release[multipliers]

    def _dependent(self, data: Floats) -> Ints:
        """Multipliers of constraints that follow from others."""
        import scipy.linalg

        own = self.columns >= self.nf
        inner = np.flatnonzero(own & (self.rows < self.nf) & (data != 0.0))
        bare = data[self.diagonal[self.nf :]] == 0.0
        chosen = np.flatnonzero(bare)
        if not len(chosen) or len(chosen) > MOST_DENSE:
            return np.zeros(0, np.int64)
        place = np.full(self.n, -1, np.int64)
        place[chosen] = np.arange(len(chosen))
        column = place[self.columns[inner] - self.nf]
        inner, column = inner[column >= 0], column[column >= 0]
        used, row = np.unique(self.rows[inner], return_inverse=True)
        table = np.zeros((max(len(used), 1), len(chosen)))
        table[row, column] = data[inner]
        length = np.sqrt((table**2).sum(axis=0))
        table /= np.where(length > 0.0, length, 1.0)
        out, basis = [], np.zeros((len(table), 0))
        for part in (chosen < self.kept, chosen >= self.kept):
            # What the constraints before it fix already is no part of a constraint.
            rest = table[:, part] - basis @ (basis.T @ table[:, part])
            q, r, order = scipy.linalg.qr(rest, mode="economic", pivoting=True)
            size = np.zeros(rest.shape[1])
            size[: min(r.shape)] = np.abs(np.diag(r))
            out.append(chosen[part][order[size <= DEPENDENT]])
            basis = np.column_stack([basis, q[:, : int((size > DEPENDENT).sum())]])
        return np.concatenate(out)

    def _named(self, error: SingularError) -> SingularError:
        equation, mode = error.equation, error.mode
        if not 0 <= equation < self.nf and mode is not None:
            # A multiplier is named by the dof that moves most.
            moved = np.abs(np.asarray(mode).reshape(self.size, -1)[: self.nf, 0])
            equation = int(np.argmax(moved)) if moved.any() else equation
        if not 0 <= equation < self.nf:
            return SingularError("the constraints of contact depend on each other")
        own = None if mode is None else np.asarray(mode).reshape(self.size, -1)[: self.nf]
        every = None if error.modes is None else np.asarray(error.modes)[:, : self.nf]
        return self.system.singular(SingularError(str(error), equation, own, every))

    def _load(self, at: Evaluation) -> Triplets:
        """Minus the derivative of the external force."""
        if at.load_stiffness is None:
            return Triplets.join([])
        rows, columns, values = at.load_stiffness
        return Triplets(np.asarray(rows, np.int64), np.asarray(columns, np.int64), -values)

    def _entries(
        self, c: Coupling, load: Triplets, link: LinearizedConstraints
    ) -> tuple[Triplets, Triplets]:
        """Upper triangle of the contributions of contact and loads, and the unsymmetric part."""
        n, own = self.system.n_dofs, np.arange(self.n) + self.nf
        upper, rest = [link.symmetric_half(c.geometric_stiffness)], []
        if len(load.values):
            even, odd = Triplets.halves(link.reduce_entries(load, n))
            upper.append(even)
            rest.append(odd)
        if len(c.skew.values):
            rest.append(Triplets.of(link.reduce_entries(c.skew, n)) if link.couples else c.skew)
        upper += [self._border(c.rows, link), Triplets(own, own, c.diagonal)]
        return Triplets.join(upper), Triplets.join([*rest, self._border(c.follow, link)])

    def _border(self, x: Triplets, link: LinearizedConstraints) -> Triplets:
        """Entries of dofs by multipliers as those of unknowns."""
        if link.couples:
            x = Triplets.of(link.reduce_columns(x.matrix(self.system.n_dofs, self.n)))
        return Triplets(x.rows, x.columns + self.nf, x.values)

    def _spare(self, c: Coupling, link: LinearizedConstraints) -> Ints:
        """Keys of couplings that may be needed soon, possibly repeated."""
        keys = [np.zeros(0, np.int64)]
        for dofs, own in c.near():
            dofs = link.neighbors(dofs)
            if not len(dofs):
                continue
            every = np.concatenate([dofs, np.where(own >= 0, own + self.nf, -1)], axis=1)
            i, j = np.triu_indices(every.shape[1])
            a, b = every[:, i].ravel(), every[:, j].ravel()
            good = (a >= 0) & (b >= 0)
            # Multipliers of one pair do not couple with each other.
            good &= (np.minimum(a, b) < self.nf) | (a == b)
            a, b = a[good], b[good]
            keys.append(np.maximum(a, b) * self.size + np.minimum(a, b))
        return np.concatenate(keys)

    def _multiply(self, data: Floats, x: Floats) -> Floats:
        """Product of the symmetric matrix with a vector that is mostly zero."""
        hit = np.flatnonzero((x[self.columns] != 0.0) | (x[self.rows] != 0.0))
        r, c, v = self.rows[hit], self.columns[hit], data[hit]
        out = np.zeros(self.size)
        np.add.at(out, r, v * x[c])
        off = r != c
        np.add.at(out, c[off], v[off] * x[r[off]])
        return self.communicator.sum(out)

    def _solve(self, data: Floats, rest: Triplets, b: Floats) -> tuple[Floats, int]:
        linear = self.system.linear
        try:
            inertia = linear.factorize(self.pattern, data)
            if not len(rest.values):
                self._resolve = linear.solver.solve
                return linear.solve(b), -1 if inertia is None else inertia[1]
            x = None
            if b.shape[1] <= MOST_COLUMNS or self.communicator.size > 1:
                with linear.timed("solve"):
                    x = self._gmres_all(rest, b)
            if x is not None:
                self._resolve = lambda more: self._resolved(data, rest, more)
                return x, -1
        except SingularError as error:
            # The test for motions without stiffness uses the energy, which multipliers make
            # vanish also for other motions.
            if not len(rest.values) and self._is_null(data, error.mode):
                raise
        with linear.timed("factor"):
            return self._by_lu(data, rest, b), -1

    def _is_null(self, data: Floats, mode: Floats) -> bool:
        """Whether the matrix maps a vector to rounding errors only."""
        if mode is None:
            return True
        v = np.asarray(mode, float).reshape(self.size, -1)[:, 0]
        size = np.zeros(self.size)
        r, c = self.rows, self.columns
        np.add.at(size, r, np.abs(data * v[c]))
        np.add.at(size, c, np.abs(data * v[r]))
        size = self.communicator.sum(size)
        left = np.abs(self._multiply(data, v))
        return bool((left <= NULL * size.max()).all())

    def _resolved(self, data: Floats, rest: Triplets, b: Floats) -> Floats:
        x = self._gmres_all(rest, b)
        return self._by_lu(data, rest, b) if x is None else x

    def _gmres_all(self, rest: Triplets, b: Floats) -> Floats | None:
        """Solution by GMRES for all columns; none if one of them stalls."""
        out = np.empty_like(b)
        for k in range(b.shape[1]):
            x, steps = gmres(self.system.linear.solver.solve, rest, b[:, k], self.nf)
            self.steps += steps
            if x is None:
                return None
            out[:, k] = x
        return out

    def _by_lu(self, data: Floats, rest: Triplets, b: Floats) -> Floats:
        import scipy.sparse as sp

        from corota.analysis.linear.solvers import Multifrontal

        self.whole += 1
        shape = (self.size, self.size)
        extra = sp.coo_array((rest.values, (rest.rows, rest.columns)), shape=shape)
        # Without this the choice of pivots would depend on the unit of length.
        scale = self._scale(data)
        by = sp.diags_array(scale)
        matrix = (by @ (self.pattern.full(data) + extra) @ by).tocsc()
        matrix.sort_indices()
        lu = Multifrontal(symmetric=False)
        lu.analyze(matrix.indptr, matrix.indices, self.node)
        lu.factorize(matrix.data)
        self.system.linear.last = lu

        def solve(more: Floats) -> Floats:
            return np.asarray(scale[:, None] * lu.solve(scale[:, None] * more))

        self._resolve = solve
        return solve(b)

    def _scale(self, data: Floats) -> Floats:
        """A power of two for all multipliers that makes their rows as large as the tangent."""
        scale = np.ones(self.size)
        inner = self.columns < self.nf
        borders = ~inner & (self.rows < self.nf)
        tangent = self.communicator.greatest(float(np.abs(data[inner]).max(initial=0.0)))
        border = self.communicator.greatest(float(np.abs(data[borders]).max(initial=0.0)))
        if min(tangent, border) > 0.0:
            scale[self.nf :] = 2.0 ** round(math.log2(tangent / border))
        return scale
