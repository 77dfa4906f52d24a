"""One contact pair or tie: gaps, states, rows of its constraints."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from corota.analysis.terms.contact.discrete_gradient import discrete_gradient, mean_pressure
from corota.analysis.terms.contact.gaps import COVERED, Terms
from corota.analysis.terms.contact.setup import contact_core, tie_core
from corota.arrays import distinct
from corota.model.contact import ContactPair, Tie

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.numbered_model import NumberedModel

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: States of a constraint.
OPEN, CLOSED, SLIPPING = 0, 1, 2
#: Deformations below this fraction of the model's size are rounding.
NONE = 1e-8
#: Covered fraction of its area below which a node passes its part to a neighbor.
WEAK = 0.2
EPS = float(np.finfo(float).eps)


class Pair:
    """One contact pair or tie.

    Parameters
    ----------
    system : NumberedModel
    item : ContactPair or Tie

    Attributes
    ----------
    n : int
        Constraints.
    nodes : ndarray of int, shape (n,)
        Their slave nodes; of a facet that may meet a rounded corner, its first node.
    of_nodes : int
        Constraints of nodes; those of facets come behind.
    width : int
        Multipliers of the pair: n, or 2 n with friction and in ties.
    """

    def __init__(self, system: NumberedModel, item: ContactPair | Tie) -> None:
        self.item = item
        self.tied = isinstance(item, Tie)
        self.friction = 0.0 if isinstance(item, Tie) else item.friction
        self.law = None if isinstance(item, Tie) else item.law
        build: Any = tie_core if self.tied else contact_core
        self.core, self.slave, self.master, self.reach = build(system, item)
        self.nodes = np.asarray(self.core.nodes, np.int64)
        self.n = len(self.nodes)
        self.of_nodes = len(distinct(self.nodes))
        self.full = np.asarray(self.core.full_area, float)
        self.two = self.tied or self.friction > 0.0
        self.width = self.n * (2 if self.two else 1)
        self.first = 0
        self.reference = np.column_stack([system.model.mesh.points, np.zeros(len(system.per_node))])
        self.on_slave = np.zeros(len(system.per_node), bool)
        self.on_slave[self.slave.node_list] = True
        self.fixed: Terms | None = None  # of geometrically linear steps
        self.fixed_offset: Floats = np.zeros(0)  # the offset that they were made with
        self.area = self.full.copy()  # areas of pressure laws, kept within an increment
        #: Gaps and areas of the committed state where gaps must not fall below those.
        self.start: tuple[Floats, Floats] | None = None
        self.overlap = self.base = np.zeros(self.n)  # of the start, and offset of the gap
        self.first_gap = np.zeros(self.n)  # before the first increment
        self.owner = np.arange(self.n)  # constraint that owns a node's part
        self.frozen = False  # whether the owners are final for the increment
        self.beside: tuple[Ints, Ints] | None = None
        if isinstance(item, ContactPair) and item.method == "mortar":
            place = np.full(len(system.per_node) + 1, -1, np.int64)
            place[self.nodes] = np.arange(self.n)
            ends = place[self.slave.nodes[:, :2]]
            left, right = np.full(self.n, -1, np.int64), np.full(self.n, -1, np.int64)
            right[ends[:, 0]], left[ends[:, 1]] = ends[:, 1], ends[:, 0]
            self.beside = (left, right)
        self.slid = np.zeros(self.n)  # slip so far [length]
        self.friction_work = 0.0
        self.seen = False  # whether the surfaces have been near each other
        self.surface = _surfaces(self.slave.nodes, self.nodes)  # whose node it is
        self.stiffness = np.ones(self.n)  # pressure per gap for the choice of the set
        self.size = system.length
        far = float(np.abs(system.model.mesh.points).max())
        self.noise = 32.0 * EPS * (system.length + far)  # gaps that are rounding [length]
        self.name = item.name

    # -- evaluation --------------------------------------------------------------------

    def evaluate(self, x: Floats, old: Floats, nlgeom: bool) -> Terms:
        """Gaps at positions `x`, slips since the committed positions `old`; shapes (n_nodes, 3)."""
        if not nlgeom:
            return self._since(self._linear(x, old))
        before = old if self.friction else None
        middle = None
        if self.start is not None and x is not old:
            x_middle = 0.5 * (x + old)
            self.core.search(x_middle)
            middle = self.core.evaluate(x_middle, before)
        self.core.search(x)
        terms = self._read(self.core.evaluate(x, before))
        if middle is not None:
            terms.between = discrete_gradient(
                terms,
                self._shared(middle),
                self.gap_of_start(),
                self.full,
                (old, x),
                getattr(self.item, "master", None),
                NONE * self.size,
            )
        return self._since(terms)

    def gaps_at(self, term: Any, number: int, x: Floats) -> Terms:
        """Gaps of the committed state, at positions `x`, without conditions on their rates."""
        if term.at is not None:
            terms: Terms = term.at.terms[number]
        else:
            terms = self.evaluate(x, x, term.system.nlgeom)
        return terms.bare or terms

    def apart(self, terms: Terms, states: NDArray[np.int8] | None) -> NDArray[np.bool_]:
        """Constraints of slave surfaces on which none is closed at a committed state."""
        seen = terms.area > COVERED * self.full
        closed = seen & (terms.gap <= self.noise * self.full)
        if states is not None:
            closed |= states != OPEN
        met = np.zeros(self.surface.max(initial=0) + 1, bool)
        met[self.surface[closed]] = True
        out: NDArray[np.bool_] = ~met[self.surface]
        return out

    def let_go(self) -> None:
        """Reset the masters of the nodes, which they would otherwise keep for some time."""
        if getattr(self.item, "method", "") != "node_to_segment":
            return
        places, masters, offset = self.core.state()
        masters[1 : 1 + self.of_nodes] = -1
        self.core.restore_state(places, masters, offset)

    def _since(self, terms: Terms) -> Terms:
        """Gaps of the persistency condition (Laursen & Chawla 1997).

        Contact acts only if the gap is closed at the start of the increment, and may not get
        deeper. A pair
        with a pressure law may get deeper.
        """
        if self.start is None or self.law is not None:
            return terms
        start, far = self.begun()
        gap = terms.gap - np.where(far, 0.0, np.minimum(start, 0.0))
        return replace(terms, gap=gap, area=np.where(far, 0.0, terms.area), bare=terms)

    def begun(self) -> tuple[Floats, NDArray[np.bool_]]:
        """Gaps that the increment began with, and where they were open."""
        assert self.start is not None
        gap, area = (np.zeros(self.n) + np.bincount(self.owner, t, self.n) for t in self.start)
        return gap, (gap > self.noise * self.full) | (area <= COVERED * self.full)

    def persist(self, terms: Terms) -> None:
        """Take the gaps of a state for the start of an increment."""
        self.start = terms.parts

    def gap_of_start(self) -> Floats:
        """Weighted gaps that the increment began with, shape (n,).

        Where a pressure law had no opposite surface, it begins with its first pressure.
        """
        assert self.start is not None
        gap, area = (np.zeros(self.n) + np.bincount(self.owner, t, self.n) for t in self.start)
        if self.law is None:
            return gap
        return np.where(area > COVERED * self.full, gap, -self.law.start * self.area)

    def _read(self, raw: dict[str, Any]) -> Terms:
        self.seen = self.seen or bool(len(raw["constraint"]))
        if self.beside is not None and not self.frozen:
            self.owner = self._owners(raw["total_area"])
        return self._shared(raw)

    def _shared(self, raw: dict[str, Any]) -> Terms:
        """Terms in which weak parts belong to their owners."""
        gap, slip, area = raw["total_gap"], raw["total_slip"], raw["total_area"]
        parts = (gap, area)
        constraint = raw["constraint"]
        if (self.owner != np.arange(self.n)).any():
            gap, slip, area = (np.bincount(self.owner, t, self.n) for t in (gap, slip, area))
            constraint = self.owner[constraint]
        return Terms(
            gap,
            slip,
            area,
            constraint,
            raw["pair"],
            raw["variables"],
            raw["gap_gradient"],
            raw["slip_gradient"],
            parts,
        )

    def _owners(self, area: Floats) -> Ints:
        """Constraint that each node's part belongs to: its own, or a neighbour's.

        At the end of the opposite surface a slave edge is partly covered. The node beyond would
        have
        a constraint on a negligible area, with any pressure; its neighbor's pressure acts there.
        """
        own = np.arange(self.n)
        assert self.beside is not None
        cover = area / self.full
        weak = cover < WEAK
        if not weak.any():
            return own
        left, right = self.beside
        a, b = (np.where(side >= 0, cover[side], 0.0) for side in (left, right))
        best, which = np.maximum(a, b), np.where(a >= b, left, right)
        return np.where(weak & (best >= WEAK), which, own)

    def _linear(self, x: Floats, old: Floats) -> Terms:
        """The pair as it is in the reference configuration, linear in displacement."""
        offset = self.core.offset
        if self.fixed is None or not np.array_equal(offset, self.fixed_offset):
            self.fixed, self.fixed_offset = self._frozen(offset), offset
        at = self.fixed

        def rise(gradient: Floats, since: Floats) -> Floats:
            moved = (x - since).ravel()[at.variables]
            out = np.zeros(self.n)
            np.add.at(out, at.constraint, (gradient * moved).sum(axis=1))
            return out

        gap = at.gap + rise(at.gap_gradient, self.reference)
        slip = rise(at.slip_gradient, self.reference if self.tied else old)
        return Terms(
            gap,
            slip,
            at.area,
            at.constraint,
            at.pair,
            at.variables,
            at.gap_gradient,
            at.slip_gradient,
            (gap, at.area),
        )

    def _frozen(self, offset: Floats) -> Terms:
        """Gaps of the reference configuration, and their gradients on the pairing there.

        The gradients are taken with the gap closed: the ends of what is covered move with the
        displacement, and with an open gap that would count, though it is of second order.
        """
        self.core.search(self.reference)
        open_ = self._read(self.core.evaluate(self.reference, self.reference))
        if self.tied:
            return open_
        gap, area = open_.parts
        seen = area > COVERED * self.full
        self.core.offset = offset + np.where(seen, gap / np.where(seen, area, 1.0), 0.0)
        closed = self._read(self.core.evaluate(self.reference, self.reference))
        self.core.offset = offset
        return replace(closed, gap=open_.gap, parts=open_.parts)

    # -- states ------------------------------------------------------------------------

    def trial(self, terms: Terms, p: Floats) -> tuple[Floats, Floats]:
        """Gap [length] and trial pressure of each constraint; not covered: infinitely open."""
        seen = terms.area > COVERED * self.full
        if self.law is not None:
            # The areas of the law are those of the increment's start: its tangent is exact.
            gap = np.where(seen, terms.gap / self.area, np.inf)
            least = gap
            if self.start is not None:  # its pressure is a mean over the increment
                least = np.minimum(gap, self.gap_of_start() / self.area)
            return gap, np.where(seen, -least - self.law.start, -np.inf)
        gap = np.where(seen, terms.gap / np.where(seen, terms.area, 1.0), np.inf)
        return gap, np.where(seen, p - self.stiffness * np.where(seen, gap, 0.0), -np.inf)

    def states(
        self, terms: Terms, p: Floats, q: Floats, last: NDArray[np.int8] | None = None
    ) -> NDArray[np.int8]:
        """State of each constraint by its gap, slip and tractions, shape (n,).

        Closed constraints have no linearized gap after a correction: their pressure alone
        decides. The remaining gap is a nonlinear remainder, which in a slender body
        corresponds to many times the pressure.
        """
        if self.tied:
            return np.where(terms.area > COVERED * self.full, CLOSED, OPEN).astype(np.int8)
        _, push = self.trial(terms, p)
        # What is closed without pressure stays, or nothing would hold a body that just rests.
        rounding = self.noise if self.law is not None else self.stiffness * self.noise
        shear = self.shear(terms, q)
        if last is not None and self.law is None:
            seen = terms.area > COVERED * self.full
            push = np.where((last != OPEN) & seen, np.maximum(p, push), push)
            shear = np.where(last == CLOSED, q, shear)
        state = np.where(push > -rounding, CLOSED, OPEN).astype(np.int8)
        if self.friction:
            bound = self.friction * (p if self.law is not None else push)
            if last is not None:
                # Slipping constraints continue to slip unless they reverse: at the bound rounding
                # would decide.
                bound = np.where(last == SLIPPING, (1.0 - 1e-6) * bound, bound)
            slips = (state == CLOSED) & (np.abs(shear) > bound)
            if last is not None:
                # Constraints that reverse stick first.
                slips &= (last != SLIPPING) | (shear * q >= 0.0)
            state[slips] = SLIPPING
        return state

    def slip_direction(self, terms: Terms, q: Floats) -> Floats:
        """Sign of the shear traction if it slips, shape (n,)."""
        return np.where(self.shear(terms, q) > 0.0, 1.0, -1.0)

    def shear(self, terms: Terms, q: Floats) -> Floats:
        """Trial shear traction, shape (n,)."""
        seen = terms.area > COVERED * self.full
        slip: Floats = terms.slip / np.where(seen, terms.area, 1.0)
        return q - self.stiffness * np.where(seen, slip, 0.0)

    def violation(self, terms: Terms, p: Floats, q: Floats) -> Floats:
        """Contact residual as a force by constraint, shape (n,)."""
        seen = terms.area > COVERED * self.full
        area = np.where(seen, terms.area, self.full)

        def beyond(length: Floats) -> Floats:
            return np.sign(length) * np.maximum(np.abs(length) - self.noise, 0.0)

        gap = beyond(terms.gap / area)
        slip = beyond(terms.slip / area)
        c = self.stiffness
        if self.tied:
            return np.where(seen, area * c * np.hypot(gap, slip), self.full * np.hypot(p, q))
        if self.law is None:
            complementarity = np.abs(np.minimum(c * gap, p))
        else:
            complementarity = np.abs(p - self._law_now(terms.gap / self.area)[0])
        complementarity = np.where(seen, complementarity, np.abs(p))
        if self.friction:
            bound = self.friction * np.maximum(p, 0.0)
            complementarity += np.abs(q - np.where(seen, np.clip(q - c * slip, -bound, bound), 0.0))
        return area * complementarity

    def pressure(self, gap: Floats) -> tuple[Floats, Floats, Floats]:
        """The law at gaps: pressure, slope, energy per area; zero where it does not act."""
        assert self.law is not None
        begun = -gap > self.law.start
        p, slope, energy = self.law(np.where(begun, -gap, self.law.start))
        return (np.where(begun, p, 0.0), np.where(begun, slope, 0.0), np.where(begun, energy, 0.0))

    def _law_now(self, gap: Floats) -> tuple[Floats, Floats]:
        """Pressure of the law in this increment, which ends with gaps, and its slope."""
        if self.start is None:
            return self.pressure(gap)[:2]
        return mean_pressure(self.pressure, self.gap_of_start() / self.area, gap)

    def law_energy(self, terms: Terms) -> float:
        """Energy of the pressure law [force*length]."""
        if self.law is None:
            return 0.0
        seen = terms.area > COVERED * self.full
        gap = np.where(seen, terms.gap / self.area, -self.law.start)
        return float((self.pressure(gap)[2] * self.area)[seen].sum())

    def rows(
        self, terms: Terms, state: NDArray[np.int8], p: Floats, q: Floats, slip_direction: Floats
    ) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """The linearized constraints: diagonals and right-hand sides of p and q, and the slope.

        A closed row reads ``-dG du + d dp = rhs``; an open one ``d dp = rhs`` alone. `sense` is
        the sign of slipping tractions.

        Returns
        -------
        diagonal_p, rhs_p, diagonal_q, rhs_q, follow : ndarray, shape (n,)
            ``follow`` is dq / dp of slipping rows.
        """
        own = self.full / self.stiffness  # of the size of a row
        closed = state != OPEN
        dp = np.where(closed, 0.0, own)
        rp = np.where(closed, terms.gap, -own * p)
        if self.law is not None and closed.any():
            area = self.area
            if self.start is None:
                value, slope, _ = self.law(np.maximum(-terms.gap / area, self.law.start))
            else:
                value, slope = self._law_now(terms.gap / area)
            weight = area / np.where(slope > 0.0, slope, self.stiffness)
            dp = np.where(closed, -weight, dp)
            rp = np.where(closed, weight * (p - value), rp)
        if not self.two:
            return dp, rp, dp[:0], dp[:0], dp[:0]
        sticks = state == CLOSED
        dq = np.where(sticks, 0.0, own)
        follow = np.where(state == SLIPPING, self.friction * slip_direction, 0.0)
        rq = np.where(sticks, terms.slip, 0.0)
        return dp, rp, dq, rq, follow

    # -- increments --------------------------------------------------------------------

    def commit(self, terms: Terms, q: Floats, before: Floats, stuck: NDArray[np.bool_]) -> None:
        """Accept a state.

        Parameters
        ----------
        q, before : ndarray, shape (n,)
            Shear tractions, and those of the committed state.
        stuck : ndarray of bool, shape (n,)
            Sticking constraints.
        """
        self.core.commit()
        self.frozen = False
        seen = terms.area > COVERED * self.full
        self.area = np.where(seen, terms.area, self.full)
        if self.friction:
            slip = np.where(seen, terms.slip / np.where(seen, terms.area, 1.0), 0.0)
            self.slid += np.where(q != 0.0, slip, 0.0)
            # Constraints that stuck or reversed slid after their traction had grown. With
            # rate conditions the traction of the end acts over the whole slip.
            whole = stuck | (before * q < 0.0) | (self.start is not None)
            mean = np.where(whole, q, 0.5 * (before + q))
            # Constraints that opened may have slid back without traction.
            self.friction_work += float(np.maximum(-mean * terms.slip, 0.0).sum())


def _surfaces(edges: Ints, nodes: Ints) -> Ints:
    """Number of the connected piece of surface that each of the nodes lies on."""
    pairs = np.concatenate([edges[:, :2], edges[:, ::2][edges[:, 2] >= 0]])
    ids, ends = np.unique(pairs, return_inverse=True)
    ends = ends.reshape(-1, 2)
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), (len(ids), len(ids)))
    number = connected_components(graph, directed=False)[1]
    out: Ints = number[np.searchsorted(ids, nodes)].astype(np.int64)
    return out


__all__ = ["CLOSED", "COVERED", "OPEN", "SLIPPING", "Pair", "Terms"]
