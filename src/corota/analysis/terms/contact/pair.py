"""One contact pair or tie: gaps, states, rows of its constraints; what passed through it.

The core searches no farther than its reach, and a penetration deeper than the body is no contact. A
node that moved farther may be behind the opposite surface without contact, and one that moved
across a body may be outside again on its other side; such an increment is refused.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import corota._core as _core
from corota._core import CLOSED, OPEN, SLIPPING
from corota.analysis.linear.triplets import Triplets
from corota.analysis.terms.contact.gaps import SAME, SMALL, WAITED, Terms, covered, mean
from corota.analysis.terms.contact.setup import (
    STRAIGHT,
    alone,
    chords,
    curve_at,
    make_core,
    rotated,
)
from corota.arrays import distinct
from corota.mesh.parts import components
from corota.model.contact import METHODS, ContactPair, RigidCurve, Tie

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.linear.coupling import Coupling
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats, Ints

#: Proximal term of dependent constraints: change of the pressure of a corner beside a closed node
#: per error of its gap, relative to its stiffness. That of the first correction; a tenth in each
#: that follows, its square at last. It keeps dependent constraints solvable. If it stayed large, a
#: corner that is almost at the node would take over its pressure in many corrections; it is zero in
#: what they converge to.
REDUNDANT = 1e-4
#: Discretization at the ends of the master: covered fraction of its area below which a node passes
#: its part to a neighbor, and twice that from which it takes it back for good.
WEAK = 0.2
#: Search radius: fraction of the reach, and of the width of a body, that a node may move without
#: this check; in relaxation, fraction of the shortest slave edge from a position to the next.
UNSEEN = 0.5


class Pair:
    """One contact pair or tie.

    Parameters
    ----------
    system : NumberedModel
    item : ContactPair or Tie
    dofs : ndarray of int, shape (3 n_nodes + 1,)
        Dof of each variable ``3 node + component``, -1 for none, of which the last has none.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"_dofs"})

    def __init__(self, system: NumberedModel, item: ContactPair | Tie, dofs: Ints) -> None:
        self.item, self._dofs = item, dofs
        self.tied = isinstance(item, Tie)
        self.law = None if isinstance(item, Tie) else item.law
        #: Largest shear traction of friction [force/length^2].
        limit = None if isinstance(item, Tie) else item.shear_limit
        self.shear_limit = np.inf if limit is None else limit
        #: Whether what is closed may open again.
        self.separates = isinstance(item, ContactPair) and item.separates
        #: Whether it acts in the step, and the number of the step in which it began to.
        self.active, self.entered = True, 0
        self.core, self.slave, self.master, self.reach, self.depth = make_core(system, item)
        self.on_slave = np.zeros(len(system.per_node), bool)
        self.on_slave[self.slave.node_list] = True
        #: Slave nodes of the n constraints; of a facet that may meet a rounded corner, its first
        #: node; of a sharp corner, the nearest one at the start. Those of nodes come first, then
        #: those of facets, then those of corners.
        self.nodes = np.asarray(self.core.nodes, np.int64)
        self.n = len(self.nodes)
        #: Whether friction acts, in some step at least, and its coefficients now.
        self.rubs = isinstance(item, ContactPair) and item.most_friction > 0.0
        self.friction = np.zeros(self.n)
        #: Slip rates [length/time] now and at the committed state.
        self.rate = self.committed_rate = np.zeros(self.n)
        self.of_nodes = len(distinct(self.nodes))
        #: Nodes of the corners, -1 for those of a rigid body.
        self.corners = np.asarray(self.core.corners, np.int64)
        self.of_surfaces = self.n - len(self.corners)
        #: Nodes in messages: of a sharp corner of the mesh, itself.
        self.named = self.nodes.copy()
        self.named[self.of_surfaces :][self.corners >= 0] = self.corners[self.corners >= 0]
        #: Constraint of each node, -1 for none.
        self.place = np.full(len(system.per_node) + 1, -1, np.int64)
        self.place[self.nodes[: self.of_nodes]] = np.arange(self.of_nodes)
        self.full = np.asarray(self.core.full_area, float)
        #: Whether shear tractions are unknowns, in some step at least.
        self.two = self.tied or self.rubs
        #: Multipliers of the pair, and the first of them.
        self.width = self.n * (2 if self.two else 1)
        self.first = 0
        self.reference = np.column_stack([system.model.mesh.points, np.zeros(len(system.per_node))])
        #: Of geometrically linear steps, and the offset that they were made with.
        self.fixed: tuple[Terms, Floats] | None = None
        self.area = self.full.copy()  # areas of pressure laws, kept within an increment
        #: Constraints that were closed in the committed state.
        self.closed: Bools = np.zeros(self.n, bool)
        #: Gaps and areas of the committed state where gaps must not fall below those.
        self.start: tuple[Floats, Floats] | None = None
        self.overlap = self.base = np.zeros(self.n)  # of the start, and offset of the gap
        self.first_gap = np.zeros(self.n)  # before the first increment
        self.owner = np.arange(self.n)  # constraint that owns a node's part
        self.redundant = REDUNDANT  # softness of dependent constraints
        self.frozen = False  # whether the owners are final for the increment
        self.beside: tuple[Ints, Ints] | None = None
        self.held_ends = np.zeros(self.n, bool)  # fixed ends of the slave
        self.guided_ends = self.held_ends  # those that a support guides
        #: Guided ends whose other side is held along the same direction: constraint, node of the
        #: other side (-1 for a fixed curve) and direction.
        self.planes: list[tuple[int, int, Floats]] = []
        self.resting = self.held_ends  # those of these that nothing draws along the plane
        integrates = isinstance(item, ContactPair) and METHODS[item.method]["integrates"]
        if integrates and not self.slave.pointwise:
            edges, bent = self.slave.nodes, self.slave.nodes[:, 2] >= 0
            parts = [edges[~bent, :2], edges[bent][:, [0, 2]], edges[bent][:, [2, 1]]]
            begin, end = self.place[np.concatenate(parts)].T
            left, right = np.full(self.n, -1, np.int64), np.full(self.n, -1, np.int64)
            right[begin], left[end] = end, begin
            self.beside = (left, right)
        self.slid = np.zeros(self.n)  # slip so far [length]
        self.friction_work = 0.0
        self.end_share = 0.5  # of the tractions at the end of an increment in their mean
        self.share = 1.0  # of those in the equation of the increment
        #: What of it the trapezoidal rule misses, of tractions that grew before the surfaces slid.
        self.beyond_trapezoid = 0.0
        self.edge = float(self.slave.length.max())
        self.stiffness = np.ones(self.n)  # pressure per gap for the choice of the set
        self.size = system.length
        far = float(np.abs(system.model.mesh.points).max())
        #: Gaps that are rounding [length].
        self.noise = 32.0 * float(np.finfo(float).eps) * (system.length + far)
        self.conditions = self._conditions()
        self.name = item.name

    def rub(self, step: int, share: float, pressure: Floats) -> None:
        """Take the coefficients of friction of a step, at a share of its change in it.

        They are those at the present slip rates and the given pressures, shape (n,).
        """
        if isinstance(self.item, ContactPair) and self.rubs:
            share = share if self.item.friction_ramps else 1.0
            found = self.item.friction_at(step, share, self.rate, np.maximum(pressure, 0.0))
            # Tractions stay unknowns where a coefficient is zero for a time.
            self.friction = np.maximum(found, SAME)

    def _conditions(self) -> _core.ContactLaw:
        """The law of the constraints: what gaps, slips and tractions owe each other."""
        if self.tied:
            return _core.ContactLaw.joined(noise=self.noise)
        kind, pressure, overclosure = ("hard", [], []) if self.law is None else self.law.constants
        along = ("coulomb", [self.shear_limit]) if self.rubs else ("frictionless", [])
        return _core.ContactLaw(kind, pressure, overclosure, *along, noise=self.noise)

    def slide(self, terms: Terms, dt: float) -> None:
        """Take the slip rates of a trial state, an increment of time after the committed one.

        Where nothing has moved yet, those of the increment before stay.
        """
        if self.rubs and dt > 0.0 and terms.slip.any():
            self.rate = np.abs(mean(terms.slip, terms.area * dt, self.full * dt))

    # -- evaluation --------------------------------------------------------------------

    @cached_property
    def surface(self) -> Ints:
        """Number of the connected piece of slave surface of each constraint, shape (n,)."""
        edges = self.slave.nodes
        ends = np.concatenate([edges[:, :2], edges[:, ::2][edges[:, 2] >= 0]])
        return components(ends[:, 0], ends[:, 1], len(self.reference))[self.nodes]

    def evaluate(self, x: Floats, old: Floats, nlgeom: bool, acts: bool = True) -> Terms:
        """Gaps at positions `x`, slips since the committed positions `old`; shapes (n_nodes, 3).

        The gradients of an increment are not made if no traction `acts` and none can.
        """
        if not self.active:
            return self._nothing()
        if not nlgeom:
            return self._at_planes(self._since(self._linear(x, old)), x)
        before = old if self.rubs else None
        middle = None
        if self.start is not None and x is not old and (acts or self._may_act()):
            x_middle = 0.5 * (x + old)
            self.core.search(x_middle)
            middle = self.core.evaluate(x_middle, before, self.closed)
        self.core.search(x)
        terms = self._read(self.core.evaluate(x, before, self.closed))
        if middle is not None:
            # Terms that exist only at the end act along the gradient there.
            half = self._shared(middle)
            known, rise = covered(half.area, self.full), terms.gap - self.gap_of_start(terms)
            between = self.core.discrete_gradient(
                half, terms, known, rise, old, x, SAME * self.size
            )
            terms.between = replace(terms, **between)
            terms.slip = terms.between.slip
        return self._at_planes(self._since(terms), x)

    def _at_planes(self, terms: Terms, x: Floats) -> Terms:
        """The terms without slip where a plane of symmetry cuts a rough slave.

        Nothing slides across the plane, and a shear traction there goes to the support: it is zero.
        With tangents of edges, which are inclined to the plane, the node would seem to slip.
        """
        if not self.planes:
            return terms
        moved = x - self.reference
        self.resting = np.zeros(self.n, bool)
        for k, other, along in self.planes:
            way = moved[self.nodes[k]].copy()
            if other >= 0:
                way -= moved[other]
            turns = abs(way[2]) * self.size if other >= 0 and self.master is None else 0.0
            self.resting[k] = max(abs(float(way[:2] @ along)), turns) <= self.noise
        slides = ~self.resting
        gradient = np.where(slides[terms.constraint, None], terms.slip_gradient, 0.0)
        return replace(terms, slip=np.where(slides, terms.slip, 0.0), slip_gradient=gradient)

    def measure(self, x: Floats) -> None:
        """Take the areas of a pressure law at the start, weak parts with those of their owners."""
        self.core.search(x)
        area = self._read(self.core.evaluate(x, x)).area
        self.area = np.where(covered(area, self.full), area, self.full)

    def gaps_at(self, term: Any, number: int, x: Floats) -> Terms:
        """Gaps of the committed state, at positions `x`, without conditions on their rates."""
        if term.at is not None:
            terms: Terms = term.at.terms[number]
        else:
            terms = self.evaluate(x, x, term.system.nlgeom)
        return terms.bare or terms

    def hold(self, constrained: Floats, moves: bool) -> None:
        """Find the ends of the slave that supports hold in a step, and tell the core.

        A fixed end gives its part to its neighbor. An end that is guided tips nothing: the core
        weighs gaps and slips there as inside the surface, or with the shape functions where it
        keeps means. Of a rough surface, an end of a quadratic edge counts as fixed: a traction at
        that node alone would move nothing.

        `constrained` (n_nodes, 3) are sums of the unit vectors along which supports prescribe
        displacements; `moves` says whether slips are those of the energy-momentum scheme.
        """
        if self.beside is None:
            return
        left, right = self.beside
        ends = (left < 0) | (right < 0)
        count = np.round((constrained[self.nodes, :2] ** 2).sum(axis=1))
        self.held_ends = ends & (count == 2)
        self.guided_ends = ends & (count == 1)
        if self.two:
            middle = np.isin(np.where(right < 0, left, right), self.place[self.slave.nodes[:, 2]])
            self.held_ends |= self.guided_ends & middle
            self.guided_ends &= ~middle
        self.planes, self.resting = [], np.zeros(self.n, bool)
        for k in np.flatnonzero(self.guided_ends).tolist() if self.rubs and not moves else ():
            along = constrained[self.nodes[k], :2]
            other = self._across(k, along, constrained)
            if other is None:
                self.planes = []
                break
            self.planes.append((k, other, along))
        self.core.hold(self.guided_ends.tolist(), self.keeps_means)

    @property
    def keeps_means(self) -> bool:
        """Whether guided ends of a rough slave keep their mean gaps.

        With the slip of the end node alone a traction along the support would move nothing and
        could take any size, unless the other side is held as well.
        """
        return self.two and not self.planes

    def _across(self, k: int, along: Floats, constrained: Floats) -> int | None:
        """Node of the other side that supports hold along the same direction as a guided end.

        That of a rigid curve, -1 for a fixed one; of a body the nearest one on the plane across the
        direction. None if there is none.
        """
        curve = self.item.master
        if isinstance(curve, RigidCurve):
            node = curve.reference
            if not isinstance(node, int | np.integer):
                return -1
            turns = curve.turns and not constrained[node, 2]
            fixed = abs(abs(float(constrained[node, :2] @ along)) - 1.0) < SAME
            return int(node) if fixed and not turns else None
        nodes = self.slave.node_list if self.master is None else self.master.node_list
        nodes = nodes[nodes != self.nodes[k]]
        apart = self.reference[nodes, :2] - self.reference[self.nodes[k], :2]
        same = np.abs(np.abs(constrained[nodes, :2] @ along) - 1.0) < SAME
        found = np.flatnonzero(same & (np.abs(apart @ along) <= SAME * self.size))
        if not len(found):
            return None
        return int(nodes[found[np.argmin(np.hypot(*apart[found].T))]])

    def apart(self, terms: Terms, states: NDArray[np.int8] | None) -> Bools:
        """Constraints of slave surfaces on which none is closed at a committed state."""
        seen = covered(terms.area, self.full)
        closed = seen & (terms.gap <= self.noise * self.full)
        if states is not None:
            closed |= states != OPEN
        met = np.zeros(self.surface.max(initial=0) + 1, bool)
        met[self.surface[closed]] = True
        return np.asarray(~met[self.surface])

    def _nothing(self) -> Terms:
        """Terms of a step in which the surfaces do not meet."""
        none, flat = np.zeros(self.n), np.zeros(0, np.int64)
        variables, gradient = np.zeros((0, 0), np.int64), np.zeros((0, 0))
        return Terms(none, none, none, flat, flat, variables, gradient, gradient, (none, none))

    def _since(self, terms: Terms) -> Terms:
        """Gaps of the persistency condition (Laursen & Chawla 1997).

        Contact acts only if the gap is closed at the start of the increment, and may not get
        deeper. A pair with a pressure law may get deeper.
        """
        if self.start is None or self.law is not None:
            return terms
        start, area = self.begun()
        far = (start > self.noise * self.full) | ~covered(area, self.full)
        gap = terms.gap - np.where(far, 0.0, np.minimum(start, 0.0))
        return replace(terms, gap=gap, area=np.where(far, 0.0, terms.area), bare=terms)

    def _may_act(self) -> bool:
        """Whether any gap may have been closed at the start of the increment.

        A gap that is the sum of several parts is open if they all are.
        """
        assert self.start is not None
        gap, area = self.start
        apart = gap > 2.0 * self.noise * float(self.full.max())
        apart |= (gap == 0.0) & ~covered(area, self.full)
        return self.law is not None or not bool(apart.all())

    def begun(self) -> tuple[Floats, Floats]:
        """Weighted gaps and areas that the increment began with."""
        assert self.start is not None
        return self._owned(self.start[0]), self._owned(self.start[1])

    def gap_of_start(self, terms: Terms) -> Floats:
        """Weighted gaps that the increment began with, shape (n,).

        Where a pressure law had no opposite surface, it begins with its first pressure, or with the
        gap of the end if it is open then.
        """
        gap, area = self.begun()
        if self.law is None:
            return gap
        first = np.maximum(-self.conditions.start * self.area, terms.gap)
        return np.where(covered(area, self.full), gap, first)

    def _read(self, raw: _core._Gaps) -> Terms:
        """Terms at a state, for which the owner of each node's part is found.

        At the end of the opposite surface a slave edge is partly covered. The node beyond would
        have a constraint on a negligible area, with any pressure; its neighbor's pressure acts
        there. So it does at a fixed end of the slave: a traction there would not move the slave,
        and could take any size.
        """
        own, area = np.arange(self.n), raw["total_area"]
        if self.beside is not None and self.frozen:
            # An iterate far from the end of the increment may have seen little.
            ample = (area >= 2.0 * WEAK * self.full) & ~self.held_ends
            self.owner = np.where(ample, own, self.owner)
        elif self.beside is not None:
            left, right = self.beside
            cover = area / self.full
            weak = (cover < WEAK) | self.held_ends
            a, b = (np.where(side >= 0, cover[side], 0.0) for side in (left, right))
            best, which = np.maximum(a, b), np.where(a >= b, left, right)
            self.owner = np.where(weak & (best >= WEAK), which, own)
        return self._shared(raw)

    def _shared(self, raw: _core._Gaps) -> Terms:
        """Terms in which weak parts belong to their owners."""
        parts = raw["total_gap"], raw["total_area"]
        gap, area = (self._owned(part) for part in parts)
        gradients = raw["gap_gradient"], raw["slip_gradient"]
        of_terms = self.owner[raw["constraint"]], raw["pair"], raw["variables"]
        return Terms(gap, self._owned(raw["total_slip"]), area, *of_terms, *gradients, parts)

    def _owned(self, parts: Floats) -> Floats:
        """Sums of the parts of nodes by the constraints that own them."""
        return np.bincount(self.owner, parts, self.n).astype(float)

    def _linear(self, x: Floats, old: Floats) -> Terms:
        """The pair as it is in the reference configuration, linear in displacement."""
        offset = self.core.offset
        if self.fixed is None or not np.array_equal(offset, self.fixed[1]):
            self.fixed = self._frozen(offset), offset
        at = self.fixed[0]

        def rise(gradient: Floats, since: Floats) -> Floats:
            moved = (gradient * (x - since).ravel()[at.variables]).sum(axis=1)
            return np.bincount(at.constraint, moved, self.n).astype(float)

        gap = at.gap + rise(at.gap_gradient, self.reference)
        slip = rise(at.slip_gradient, self.reference if self.tied else old)
        return replace(at, gap=gap, slip=slip, parts=(gap, at.area))

    def _frozen(self, offset: Floats) -> Terms:
        """Gaps of the reference configuration, and their gradients on the pairing there.

        The gradients are taken with the gap closed: the ends of what is covered move with the
        displacement, and with an open gap that would count, though it is of second order.
        """
        self.core.search(self.reference)
        open_ = self._read(self.core.evaluate(self.reference, self.reference))
        if self.tied:
            return open_
        self.core.offset = offset + mean(*open_.parts, self.full)
        closed = self._read(self.core.evaluate(self.reference, self.reference))
        self.core.offset = offset
        return replace(closed, gap=open_.gap, parts=open_.parts)

    # -- states ------------------------------------------------------------------------

    def _at(self, terms: Terms, q: Floats | None = None) -> _core._Constraints:
        """The constraints as arrays, as the law takes them.

        A slip changes a shear traction `q` by the stiffness of the node. Where this is nothing
        beside the traction, which would move it by an edge, as of a node that a support draws
        along, the sign of the slip decides.
        """
        begin = None if self.start is None or self.law is None else self.gap_of_start(terms)
        stiffness = self.stiffness
        if q is not None and self.rubs:
            by_sign = np.abs(q) / (SMALL * self.edge)
            stiffness = np.where(stiffness * self.edge < np.abs(q), by_sign, stiffness)
        own = self.full, self.area, stiffness, begin, self.adhering
        friction = self.friction if self.rubs else None
        return terms.gap, terms.slip, terms.area, *own, friction

    @property
    def adhering(self) -> Bools | None:
        """Constraints that do not open: those of surfaces that do not separate and had met."""
        if self.separates or self.tied:
            return None
        # A corner leaves what it slides off.
        return self.closed & (np.arange(self.n) < self.of_surfaces)

    def trial(self, terms: Terms, p: Floats) -> tuple[Floats, Floats]:
        """Gap [length] and trial pressure of each constraint; not covered: infinitely open."""
        return self.conditions.trial(self._at(terms), p)

    def states(
        self, terms: Terms, p: Floats, q: Floats, last: NDArray[np.int8] | None = None
    ) -> NDArray[np.int8]:
        """State of each constraint by its gap, slip and tractions, shape (n,).

        Closed constraints have no linearized gap after the `last` correction: their pressure alone
        decides.
        """
        at = self._at(terms, q)
        if self.rubs:
            # What begins to touch sticks: rounding alone is no slip.
            rests = (p == 0.0) & (q == 0.0) & (np.abs(terms.slip) <= self.noise * self.full)
            at = at[0], np.where(rests, 0.0, terms.slip), *at[2:]
        found: NDArray[np.int8] = self.conditions.states(at, p, q, last)
        adhering = self.adhering
        if adhering is not None and self.rubs:
            # Under tension there is no friction, whichever way the surfaces slide.
            found[adhering & (found == CLOSED) & (p <= 0.0)] = SLIPPING
        if len(self.corners):
            # Where the constraints of the surfaces keep a corner out, it has nothing to do.
            was = p > 0.0 if last is None else last != OPEN
            idle = ~was & (terms.gap >= -self.noise * self.full)
            idle[: self.of_surfaces] = False
            found[idle] = OPEN
        return found

    def slip_direction(self, terms: Terms, q: Floats) -> Floats:
        """Sign of the shear traction if it slips, shape (n,)."""
        return np.where(self.conditions.shear(self._at(terms, q), q) > 0.0, 1.0, -1.0)

    def violation(self, terms: Terms, p: Floats, q: Floats) -> Floats:
        """Contact residual as a force by constraint, shape (n,)."""
        return self.conditions.residual(self._at(terms, q), p, q)

    def keep_closed(self, states: NDArray[np.int8]) -> None:
        """Take the states of a committed state: slips are measured from where surfaces touched."""
        self.closed = states[self.owner] != OPEN

    def law_energy(self, terms: Terms) -> float:
        """Energy of the pressure law [force*length]."""
        if self.law is None:
            return 0.0
        seen = covered(terms.area, self.full)
        return float(self.conditions.energy(self._at(terms))[seen].sum())

    def freeze(self, corrections: int) -> None:
        """Prepare for a correction, of this number in the attempt."""
        # The owners of partly covered nodes may alternate.
        self.frozen = corrections > WAITED
        self.redundant = REDUNDANT * max(0.1 ** (corrections - 1), REDUNDANT)

    def rows(
        self, terms: Terms, state: NDArray[np.int8], p: Floats, q: Floats, slip_direction: Floats
    ) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """The linearized constraints: diagonals and right-hand sides of p and q, and the slope.

        A closed row reads ``-dG du + d dp = rhs``; an open one ``d dp = rhs`` alone. All shapes are
        (n,): diagonal_p, rhs_p, diagonal_q, rhs_q, follow, level. ``follow`` is dq / dp of slipping
        rows, ``level`` their q at no pressure; without shear tractions they are zero.
        """
        found = self.conditions.rows(self._at(terms), p, q, state, slip_direction)
        less, backed = self.redundant * self.full / self.stiffness, self.backed(terms, state)
        # The constraints may depend on each other: the pressure of the corner stays.
        found[0][backed] -= less[backed]
        # So does the shear traction of what sticks there, and of what rests, where nothing uses it.
        for own in (backed, np.flatnonzero(self.resting)):
            stuck = own[state[own] == CLOSED]
            found[2][stuck] -= less[stuck]
        return tuple(found)  # type: ignore[return-value]

    def linearize(
        self,
        terms: Terms,
        state: NDArray[np.int8],
        p: Floats,
        q: Floats,
        slip_direction: Floats,
        added: Coupling,
    ) -> tuple[Floats, Floats]:
        """Add the constraints linearized about their states; all arrays have the shape (n,).

        Returns ``follow`` and ``level`` of :meth:`rows`.
        """
        first, second, end = self.first, self.first + self.n, self.first + self.width
        dp, rp, dq, rq, ratio, level = self.rows(terms, state, p, q, slip_direction)
        closed, sticks, share = state != OPEN, state == CLOSED, self.share
        added.diagonal[first:second], added.rhs[first:second] = share * dp, share * rp
        added.expected += int(closed.sum())
        acting = terms.acting
        to_rows = self.dofs(terms.variables)
        to_acting = to_rows if acting is terms else self.dofs(acting.variables)

        # A gradient at the end in rows and columns; forces may act along another.
        parts = [("gap_gradient", first, closed, share), ("slip_gradient", second, sticks, 1.0)]
        for name, start, chosen, weight in parts[: 1 + self.two]:
            k, own = terms.constraint, weight * getattr(terms, name)
            added.rows.add(_columns(to_rows, start + k, -own, chosen[k]))
            if acting is not terms:
                added.follow.add(_columns(to_rows, start + k, own, chosen[k]))
                k, own = acting.constraint, weight * getattr(acting, name)
                added.follow.add(_columns(to_acting, start + k, -own, chosen[k]))
        # Tractions that are known after the correction go to the right-hand side.
        known, shear = np.where(closed, 0.0, -share * p), np.zeros(self.n)
        if self.two:
            added.diagonal[second:end], added.rhs[second:end] = dq, rq
            added.expected += int(sticks.sum())
            shear = np.where(sticks, 0.0, ratio * p + level - q)
            k = acting.constraint
            slope = -ratio[k, None] * acting.slip_gradient
            added.follow.add(_columns(to_acting, first + k, slope, state[k] == SLIPPING))
        self.add_forces(acting, known, shear, added.force)
        return ratio, level

    def backed(self, terms: Terms, state: NDArray[np.int8]) -> Ints:
        """Closed constraints of corners beside which a slave node is closed as well."""
        own = terms.constraint >= self.of_surfaces
        corner, nodes = terms.constraint[own], terms.variables[own][:, :6:2] // 3
        beside = self.place[nodes]
        closed = (beside >= 0) & (state[self.owner[beside]] != OPEN)
        return np.asarray(corner[closed.any(axis=1) & (state[corner] != OPEN)])

    def dofs(self, variables: Ints) -> Ints:
        """Dofs of variables of the core, -1 for none."""
        return self._dofs[variables]

    def add_forces(
        self, terms: Terms, p: Floats, q: Floats, force: Floats, size: Floats | None = None
    ) -> None:
        """Add the forces of tractions along the gradients of some terms, and their sizes, in place.

        `force` and `size` have the shape (n_dofs,).
        """
        if not len(terms.constraint):
            return
        dofs, gap, slip = self.dofs(terms.variables), terms.gap_gradient, terms.slip_gradient
        shear = q if self.two else None
        _core.add_contact_forces(terms.constraint, dofs, gap, slip, p, shear, force, size)

    def bound(self, p: Floats) -> Floats:
        """Largest shear traction of all constraints under their pressures."""
        return np.asarray(np.minimum(self.friction * p, self.shear_limit))

    # -- passing through ---------------------------------------------------------------

    def passed(
        self,
        term: Any,
        number: int,
        ends: tuple[Floats, Floats],
        terms: Terms,
        tractions: tuple[Floats, Floats],
        moves: bool,
    ) -> Ints:
        """Constraints whose node crossed the other side from outside to inside and is open.

        The pair has this `number` in the term. `ends` are positions at both ends of an increment,
        shape (n_nodes, 3), `terms` and `tractions` those of the last; `moves` says if it is one of
        motion.
        """
        old, new = ends
        first, last, between = self.other_side(old, new)
        if self.tied or not len(first):
            return np.zeros(0, np.int64)
        least = min(self.reach, self.width_across)
        nodes, through, start = self.nodes, np.arange(self.n), None
        unseen = ~covered(terms.area, self.full)
        # Bodies that turn together go along arcs: who passes goes through seen from either of them.
        sides = (old[nodes, :2], new[nodes, :2]), (first.reshape(-1, 2), last.reshape(-1, 2))
        turns = [_turn(*side) for side in sides]
        common = abs(math.remainder(turns[0] - turns[1], math.tau)) <= STRAIGHT < abs(turns[0])
        for turn in sorted(set(turns)) if common else [0.0]:
            seen, end = new.copy(), rotated(last, -turn)
            seen[:, :2] = rotated(new[:, :2], -turn)
            drift = (end - first).reshape(-1, 2)
            center = drift.mean(axis=0)
            spread = np.hypot(*(drift - center).T).max()
            moved = np.hypot(*(seen[nodes, :2] - old[nodes, :2] - center).T) + spread
            far = (moved > UNSEEN * least) | (unseen & (moved > self.depth))
            through = through[far[through]]
            if not len(through):
                break
            if start is None:
                start = self._outside(term, number, moves)
                closed = np.isin(nodes, nodes[self.states(terms, *tractions) != OPEN])
            through = through[~closed[through]]
            share = _core.times_of_crossing(
                first, end, between, old, seen, nodes[through], start[through], SMALL * self.edge
            )
            through = through[share < math.inf]
        return through

    def other_side(self, old: Floats, new: Floats) -> tuple[Floats, Floats, Ints]:
        """Straight pieces of the other side at both ends: (m, 2, 2) twice, and their nodes."""
        master = self.item.master
        if isinstance(master, RigidCurve):
            first, last = (curve_at(master, self.chords, self.reference, x) for x in (old, new))
            return first, last, np.full((len(first), 2), -1, np.int64)
        other = self.slave if self.master is None else self.master
        nodes = np.ascontiguousarray(other.nodes[:, :2])
        if other.two_sided:
            nodes = np.concatenate([nodes, nodes[:, ::-1]])
        return old[nodes][:, :, :2], new[nodes][:, :, :2], nodes

    @cached_property
    def chords(self) -> Floats:
        """A rigid curve as straight pieces in the reference configuration, shape (m, 2, 2)."""
        assert isinstance(self.item.master, RigidCurve)
        return chords(self.item.master)

    @cached_property
    def width_across(self) -> float:
        """Least extent of a body that the other side goes round.

        Infinite where its surface ends, goes round a hole, or meets itself.
        """
        points = self.other_side(self.reference, self.reference)[0].reshape(-1, 2)
        (x, y), size = points.T, np.ptp(points, axis=0)
        closed = not alone(points, SAME * float(size.max())).any()
        twice = float((x[::2] * y[1::2] - x[1::2] * y[::2]).sum())
        body = closed and twice > SAME * size.max() ** 2 and not getattr(self.item, "itself", False)
        return float(size.min()) if body else math.inf

    def _outside(self, term: Any, number: int, moves: bool) -> Floats:
        """Distance from the other side from which each node starts outside, shape (n,).

        A node may touch. In motion an open one may be behind, where a scheme closes gaps after the
        impact.
        """
        committed = None if term.at is None else term.at.states
        start = np.full(self.n, -SMALL * self.edge)
        if moves and math.isfinite(self.depth):
            behind = self.gaps_at(term, number, term.positions(term.u)).gap < 0.0
            if committed:
                behind &= committed[number] == OPEN
            start[behind] = -self.depth
        return start

    # -- increments --------------------------------------------------------------------

    def commit(
        self,
        terms: Terms,
        p: Floats,
        q: Floats,
        before: tuple[Floats, Floats],
        states: NDArray[np.int8],
    ) -> None:
        """Accept a state with tractions p, q; `before` and `states` are those of the last one."""
        self.core.commit()
        self.frozen = False
        seen = covered(terms.area, self.full)
        was, self.area = self.area, np.where(seen, terms.area, self.full)
        self.committed_rate = self.rate
        if self.rubs:
            slip = mean(terms.slip, terms.area, self.full)
            self.slid += np.where(q != 0.0, slip, 0.0)
            areas = np.where(states != OPEN, was, 0.0), np.where(seen, terms.area, 0.0)
            self._rub(slip, areas, before, q, (q != 0.0) | (self.states(terms, p, q) != OPEN))

    def _rub(
        self,
        slip: Floats,
        areas: tuple[Floats, Floats],
        before: tuple[Floats, Floats],
        q: Floats,
        closed: Bools,
    ) -> None:
        """Add the friction work of an increment, with a mean of the tractions at its ends.

        In dynamics a traction is that of the instant at which a scheme has its equilibrium; with
        `end_share` the mean is that of the middle.

        What slides does so from the start: its traction was at the bound then, though a constraint
        that stuck or slid back before had another. Contact that moves along the slave leaves
        `areas` and comes to others: what it leaves slid as far as the rest. With rate conditions,
        and where a sliding body turns back, the traction of the end acts over the whole slip.
        """
        was, now = areas
        p, last = before
        bound = self.bound(p)
        limited = np.isfinite(bound)
        total = float((now * np.abs(q)).sum())
        # Where a body turns back that slid with most of its friction, that turns at once.
        slid = float((was * last).sum())
        whole = float((was * np.where(limited, bound, np.abs(last))).sum())
        turns = slid * float((now * q).sum()) < 0.0 and 2.0 * abs(slid) > whole
        rates = turns or self.start is not None
        stays = np.where(closed | (total == 0.0), np.minimum(was, now), 0.0)
        begin = q if rates else np.where((q != 0.0) & limited, np.sign(q) * bound, last)
        # Constraints that opened may have slid back without traction.
        end = self.end_share
        work = stays * np.maximum(-((1.0 - end) * begin + end * q) * slip, 0.0)
        comes = float(((now - stays) * np.maximum(-q * slip, 0.0)).sum())
        self.friction_work += float(work.sum()) + (1.0 if rates else end) * comes
        late = stays * np.maximum(0.5 * (last - begin) * slip, 0.0)
        self.beyond_trapezoid += float(late.sum())
        if total > 0.0 and self.start is None:
            way = float((now * np.maximum(-q * slip, 0.0)).sum()) / total
            leaves = was - stays
            at_first = np.sign(float((now * q).sum())) * last
            left = 0.0 if turns else float((leaves * np.where(limited, bound, at_first)).sum())
            grown = left - float((leaves * at_first).sum())
            self.friction_work += (1.0 - end) * max(left, 0.0) * way
            self.beyond_trapezoid += 0.5 * max(grown, 0.0) * way + (0.5 * comes if turns else 0.0)


def _columns(where: Ints, column: Ints, gradient: Floats, rows: Bools) -> Triplets:
    """Gradients of some terms as columns."""
    flat, values = where[rows].ravel(), gradient[rows].ravel()
    columns = np.repeat(column[rows], where.shape[1])
    return Triplets(flat, columns, values).keep((flat >= 0) & (values != 0.0))


def _turn(old: Floats, new: Floats) -> float:
    """Angle by which points turn about their center in the mean [rad]."""
    before, after = old - old.mean(axis=0), new - new.mean(axis=0)
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return math.atan2(float(across.sum()), float((before * after).sum()))


__all__ = ["Pair", "Terms"]
