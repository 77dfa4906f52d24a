"""Contact pairs and ties during an analysis: gaps, forces and their multipliers.

With the weighted gap G_k(x) of a slave node k and its pressure p_k, the Lagrangian is ``Pi - sum_k
p_k G_k``. A shear traction q_k acts along the relative tangential velocity B_k(x) of the surfaces,
which is the derivative of the slip S_k where it sticks. G, S, B and the derivatives of both
directions come from the core.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota._core import OPEN, SLIPPING
from corota.analysis.terms.contact.gaps import ContactState, Terms, covered, mean
from corota.analysis.terms.term import NO_NODES, NONE, Term
from corota.errors import ModelError, UnsupportedError
from corota.lazy import lazy
from corota.model.contact import ContactPair, Tie

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.linear.saddle_point import SaddlePointSystem
    from corota.analysis.numbered_model import NumberedModel, Role
    from corota.analysis.terms.contact.gaps import Kink, States
    from corota.analysis.terms.contact.pair import Pair
    from corota.analysis.terms.term import StatePoint
    from corota.arrays import Bools, Floats, Ints
    from corota.model.steps import Step

    #: A pair, its gaps and slips, and its tractions p and q.
    Each = tuple[Pair, Terms, tuple[Floats, Floats]]

# Parts that models without contact do not need.
check_side = lazy("corota.analysis.terms.contact.setup:check_side")
guided_round_note = lazy("corota.analysis.terms.contact.output:guided_round_note")
make_pair = lazy("corota.analysis.terms.contact.pair:Pair")
near_side = lazy("corota.analysis.terms.contact.kinks:near_side")
passed_through = lazy("corota.analysis.terms.contact.output:passed_through")
start_notes = lazy("corota.analysis.terms.contact.output:start_notes")
sunk_between = lazy("corota.analysis.terms.contact.output:sunk_between")

#: Damping of stabilized surfaces per stiffness of their nodes and period.
STABILIZE = 1e-3


class ContactTerm(Term):
    """All contact pairs and ties of a model; empty in models without them.

    Parameters
    ----------
    system : NumberedModel
    """

    name = "contact"
    #: Values at slave nodes, and sums of the pairs.
    output = lazy("corota.analysis.terms.contact.output:output")
    #: Whether a body slides or tips beyond the committed state.
    gives_way = lazy("corota.analysis.terms.contact.output:gives_way")
    #: The sharp corner of a master that is wedged in a slave surface.
    wedges = lazy("corota.analysis.terms.contact.output:sunk_corner")

    def __init__(self, system: NumberedModel) -> None:
        self.system = system
        model = system.model
        items: list[ContactPair | Tie] = [*model.ties, *model.contacts]
        # Dof of each variable 3 node + component, -1 where there is none.
        dofs = np.full(3 * len(system.per_node) + 1, -1, np.int64)
        dofs[3 * system.node_of_dof + system.component] = np.arange(system.n_dofs)
        self.pairs: list[Pair] = [make_pair(system, item, dofs) for item in items]
        self.n, names = 0, [item.name for item in items]
        for k, pair in enumerate(self.pairs):
            count = names[: k + 1].count(pair.item.name)
            pair.name = pair.item.name + (f" ({count})" if count > 1 else "")
            pair.first = self.n
            self.n += pair.width
        #: Multipliers in the committed state, n of all pairs, and its displacement.
        self.committed = np.zeros(self.n)
        self.u = np.zeros(system.n_dofs)
        #: Displacement that slips are measured from within an increment, if not the committed one:
        #: the last position of a relaxation.
        self.slip_start: Floats | None = None
        self.at: ContactState | None = None
        #: Message alone: which friction forces exceeded in an attempt from load zero, or ''.
        self.overcome = ""
        self.period, self.number = 1.0, 0
        #: Time of a static step over which initial overlaps are removed at once.
        self.first = 0.0
        self.time = 0.0
        self.notes: list[str] = []
        #: Damping and stiffness of each dof, the latter of the start.
        self.damped = self.nodal = np.zeros(0)
        #: Force of pairs that ended with the step, at its start.
        self.fading = np.zeros(system.n_dofs)
        #: Whether stabilizing damping acts; not on paths, which have no time.
        self.damps, self.persistent = True, False
        #: Weight of the end of an increment in the forces of pressure laws, and their force at its
        #: start.
        self.law_share, self.law_force = 1.0, np.zeros(0)
        self.damping_work = 0.0
        self._damping_force = np.zeros(0)
        #: Work of the pressures in static increments on gaps that change, less the energy that laws
        #: store; none where surfaces stay closed.
        self.pressure_work = 0.0
        #: Work of what drives the slip in static increments, beyond that of the trapezoidal rule.
        self.late_work = 0.0
        self._pressure = np.zeros(system.n_dofs)
        #: The kink of the surfaces at which the committed equilibrium lies, and that at which the
        #: bodies may rest in the increment.
        self.kink: Kink | None = None
        self.trial_kink: Kink | None = None
        #: Displacements and contact of the last evaluation.
        self.last = self.u, ContactState()
        #: Stiffness at each dof and displacements of springs that relaxation attaches.
        self.springs: tuple[Floats, Floats] | None = None
        #: Dropped constraints that were reported, and whether an unconstrained body was.
        self.reported_constraints: set[int] = set()
        self.reported_loose = False
        #: Linear algebra with the multipliers, made when needed.
        self.border: SaddlePointSystem | None = None

    # -- facts -------------------------------------------------------------------------

    @property
    def joins(self) -> bool:
        """Whether there is any pair or tie."""
        return bool(self.pairs)

    @property
    def opens(self) -> bool:
        """Whether any surfaces may open and close."""
        return any(not pair.tied for pair in self.pairs)

    @property
    def fades(self) -> bool:
        """Whether the step stabilizes any surfaces."""
        return bool(self.damped.any())

    @property
    def unknowns(self) -> int:  # type: ignore[override]
        """Multipliers of all pairs."""
        return self.n

    def multiplier_force(self, u: Floats | None = None, values: Floats = NONE) -> Floats | None:
        """Force of the committed tractions, in the committed state or at a displacement."""
        if u is not None:
            return self.evaluate(u, self.committed, 0.0, values).force
        return None if self.at is None else self.at.force_at_end

    def nodes(self, role: Role) -> Ints:
        """Nodes of ties, or of slaves or masters of contact."""
        pairs = [pair for pair in self.pairs if pair.tied == (role == "tied")]
        sides = [NO_NODES]
        if role != "master":
            sides += [pair.slave.node_list for pair in pairs]
        if role != "slave":
            sides += [pair.master.node_list for pair in pairs if pair.master is not None]
        return np.concatenate(sides)

    def remarks(self, u: Floats, finished: bool) -> list[str]:
        """Remarks on what went through a surface that no pair describes, or sank in between."""
        if not self.opens:
            return []
        notes: list[str] = passed_through(self.system.model, self.system.by_node(u))
        return notes + (sunk_between(self) if finished else [])

    def keeps(self, at: Evaluation, states: States, tolerance: float) -> bool:
        """Whether `states` have pressures, gaps and friction of an equilibrium; none slips."""
        contact = at.contact_state
        most = tolerance * max(float(np.abs(contact.multipliers).max(initial=0.0)), 1e-300)
        each = zip(self.each(contact.terms, contact.multipliers), states, strict=True)
        for (pair, terms, (p, q)), own in each:
            if pair.tied:
                continue
            deep = terms.gap < -tolerance * self.system.length * pair.full
            bad = (own == OPEN) & covered(terms.area, pair.full) & deep
            bad |= (own != OPEN) & (p < -most)
            if pair.rubs:
                bad |= (own == SLIPPING) | (np.abs(q) > pair.friction * p + most)
            if bad.any():
                return False
        return True

    def law_multipliers(self) -> Ints:
        """Multipliers that are pressures of laws."""
        laws = [p.first + np.arange(p.n) for p in self.pairs if p.law is not None]
        return np.concatenate([np.zeros(0, np.int64), *laws])

    # -- steps -------------------------------------------------------------------------

    def begin(self, step: Step, time: float, u: Floats, reaction: Floats | None) -> None:
        """Start a step.

        Raises
        ------
        UnsupportedError
            If it does not have the conditions of a pair.
        """
        self.number += 1
        self.period, self.time = step.period, 0.0
        self.damps = step.procedure == "static"
        stays = self.damps and getattr(step, "path", None) is None
        self.first = min(step.first_increment, step.period) if stays else 0.0
        scheme = getattr(step, "scheme", "")
        self.persistent = scheme == "energy_momentum"
        self._check_pairs(step, scheme)
        #: Whether loads of the step grow, and with them what changes in coefficients of friction.
        self.rubs = self.damps and bool(getattr(step, "ramp", False))
        for pair, (p, _) in zip(self.pairs, self.parts(self.committed), strict=True):
            pair.rub(self.number, self._changed(0.0), p)
        self._enter(scheme == "central_difference")
        if len(self.nodal):
            self._damp()
        held = self.system.constrained.copy()
        for relation in self.system.constraints.relations:
            # What moves with a body that supports move is held as well.
            if held[relation.masters].all():
                held[relation.dependent] = True
        constrained = self.system.by_node(held.astype(float))
        self.law_share = 1.0
        if scheme:
            from corota.model.schemes import SCHEMES

            # Laws of pressure are weighed as the scheme weighs forces.
            if scheme in SCHEMES:
                self.law_share -= SCHEMES[scheme](step.alpha, step.rho_inf).alpha_f  # type: ignore[attr-defined]
        x, mesh = self.positions(self.u), self.system.model.mesh
        for pair in self.pairs:
            pair.fixed = pair.start = None
            pair.end_share = 1.5 - self.law_share
            pair.share = 1.0 if pair.law is None else self.law_share
            pair.hold(constrained, self.persistent)
            if pair.law is not None and pair.active and pair.entered == self.number:
                pair.measure(x)
            if self.number == 1 and pair.guided_ends.any():
                note = guided_round_note(pair, mesh.points, mesh.node_labels)
                self.notes += [note] if note else []
            if self.persistent and not pair.tied:
                pair.start = pair.evaluate(x, x, self.system.nlgeom).parts
        if self.damps and self.opens:
            self._pressure = self._pressures()
        self._keep_law_force()

    def _check_pairs(self, step: Step, scheme: str) -> None:
        """Refuse pairs whose conditions a step does not have."""
        path = getattr(step, "path", None) is not None
        how = "path control" if path else f"scheme={scheme!r}"
        simple = path or scheme in ("central_difference", "energy_momentum")
        for pair in self.pairs:
            adheres, why = not pair.tied and not pair.separates, ""
            if path and isinstance(pair.item, ContactPair) and pair.item.varies:
                why = (
                    "friction that depends on slip rate or pressure is not part of path control, "
                    "which has no time; use steps under loads"
                )
            elif simple and (adheres or pair.shear_limit < np.inf):
                what = "that do not separate" if adheres else "with a largest shear traction"
                why = (
                    f"surfaces {what} are not part of {how}; use static steps under loads, or "
                    "implicit ones"
                )
            if why:
                raise UnsupportedError(f"contact pair {pair.name!r}: {why}", pair.item.where)

    def _enter(self, explicit: bool) -> None:
        """Let pairs begin and end with the step; what those that end pressed fades."""
        self.fading = np.zeros(self.system.n_dofs)
        for k, (pair, (p, q)) in enumerate(
            zip(self.pairs, self.parts(self.committed), strict=True)
        ):
            steps = None if isinstance(pair.item, Tie) else pair.item.steps
            before, pair.active = pair.active, steps is None or self.number in steps
            if pair.active and (self.number == 1 or not before):
                pair.entered = self.number
                self._start_pair(pair, self.positions(self.u), explicit)
            elif before and not pair.active and self.rubs and self.at is not None:
                force = np.zeros(self.system.n_dofs)
                pair.add_forces(self.at.acting[k], p, q, force)
                self.fading += self.system.at_nodes(force)

    def _start_pair(self, pair: Pair, x: Floats, explicit: bool) -> None:
        """Check the initial gaps of a pair: report, adjust or ramp them."""
        item, mesh = pair.item, self.system.model.mesh
        if isinstance(item, ContactPair):
            check_side(self.system, item, pair.slave, x)
            if pair.slave.pointwise:
                # Lines keep the side that the other body is on at the start.
                pair.core.search(x)
                pair.core.evaluate(x, None)
                pair.core.commit()
        pair.core.search(x)
        raw = pair.core.evaluate(x, x)
        area = raw["total_area"]
        seen = covered(area, pair.full)
        if isinstance(item, Tie):
            self._check_tie(pair, seen)
            return
        gap = mean(raw["total_gap"], area, pair.full)
        if item.clearance is not None:
            pair.core.offset = np.where(seen, gap - item.clearance, 0.0)
            gap = np.where(seen, item.clearance, 0.0)
        pair.overlap = np.minimum(gap, 0.0)
        pair.base = pair.core.offset
        moved = np.full(pair.n, item.start == "adjust")
        if item.start == "adjust":
            within = seen & (gap <= item.adjust)
            if item.adjust_nodes is not None:
                moved = np.isin(pair.nodes, mesh.node_indices(item.adjust_nodes))
                within = seen & moved
            near = np.where(within, np.maximum(gap, 0.0), 0.0)
            pair.core.offset = pair.core.offset + np.where(moved, pair.overlap, 0.0) + near
        at_first = area if self.number == 1 else None
        self.notes += start_notes(pair, mesh, at_first, x[:, :2], gap, moved, explicit)
        adjusted_gap = gap - (pair.core.offset - pair.base)
        pair.first_gap = np.where(seen, adjusted_gap, pair.reach)
        if not pair.separates:
            # What touches at the start has met.
            pair.closed = seen & (adjusted_gap <= pair.noise)

    def _check_tie(self, pair: Pair, seen: Bools) -> None:
        if not seen.any():
            raise ModelError(
                f"tie {pair.name!r}: no edge of {pair.slave.name!r} lies on {pair.item.master!r} "
                "within its tolerance; raise it (tolerance=, POSITION TOLERANCE=)",
                pair.item.where,
            )
        if not seen.all():
            labels = self.system.model.mesh.node_labels[pair.nodes[~seen]]
            self.notes.append(
                f"tie {pair.name!r}: {len(labels)} nodes of {pair.slave.name!r} are out of "
                f"tolerance and stay free: {few(labels)}"
            )

    # -- evaluation --------------------------------------------------------------------

    def positions(self, u: Floats) -> Floats:
        """Positions and rotations of all nodes at a displacement, shape (n_nodes, 3)."""
        x = self.system.by_node(u)
        x[:, :2] += self.system.model.mesh.points
        return x

    def parts(self, multipliers: Floats) -> list[tuple[Floats, Floats]]:
        """Tractions p and q of each pair."""
        out = []
        for pair in self.pairs:
            p = multipliers[pair.first : pair.first + pair.n]
            q = multipliers[pair.first + pair.n : pair.first + pair.width]
            out.append((p, q if pair.two else np.zeros(pair.n)))
        return out

    def each(self, terms: list[Terms], multipliers: Floats) -> Iterator[Each]:
        """Each pair with its terms and tractions p and q."""
        return zip(self.pairs, terms, self.parts(multipliers), strict=True)

    def states(self, terms: list[Terms], multipliers: Floats, last: States | None = None) -> States:
        """States of the constraints of all pairs; see :meth:`Pair.states`."""
        before: Sequence[NDArray[np.int8] | None] = last or [None] * len(self.pairs)
        each = zip(self.each(terms, multipliers), before, strict=True)
        return [pair.states(own, p, q, old) for (pair, own, (p, q)), old in each]

    def add(self, point: StatePoint, at: Evaluation) -> None:
        """Add the forces for given multipliers, and their gaps and slips."""
        kink, state = self.trial_kink, None
        if kink is not None:
            state = near_side(self, point, kink)
        if state is None:
            self.trial_kink = None
            state = self.evaluate(point.u, point.multipliers, point.time, at.values)
        at.contact_state, state.time = state, point.time
        self.last = point.u, state
        at.internal = at.internal - state.force
        at.scale = at.scale + state.size
        if state.damping is not None:
            at.add_spring(state.damping, point.u - self.u)
        if self.springs is not None:
            stiffness, since = self.springs
            at.add_spring(stiffness, point.u - since)

    def evaluate(
        self, u: Floats, multipliers: Floats, step_time: float, values: Floats
    ) -> ContactState:
        """All pairs at a trial state.

        `values` (nnz,) are the tangent of the elements, from which the stiffness of the nodes is
        found at first; empty where it is not needed.
        """
        system, since = self.system, self.slip_start
        if len(values) and not len(self.nodal):
            self._measure(values)
        x, old = (self.positions(v) for v in (u, self.u if since is None else since))
        force, size = np.zeros(system.n_dofs), np.zeros(system.n_dofs)
        found, changed = [], self._changed(step_time)
        for pair, (p, q) in zip(self.pairs, self.parts(multipliers), strict=True):
            with system.timed("contact"):
                pair.core.offset = self.offset_at(pair, step_time)
                terms = pair.evaluate(x, old, system.nlgeom, bool(p.any() or q.any()))
                pair.slide(terms, step_time - self.time)
                pair.rub(self.number, changed, p)
            found.append(terms)
            pair.add_forces(terms.acting, pair.share * p, q, force, size)
        damping = self._damping(step_time)
        state = ContactState(found, system.at_nodes(force), size, multipliers, damping)
        state.force = state.force + self._left(step_time) * self.fading
        if len(self.law_force):
            now = self.forces(found, multipliers, shears=False, laws=True)[0]
            state.of_end = state.force + (1.0 - self.law_share) * now
            state.force = state.force + (1.0 - self.law_share) * self.law_force
        return state

    def forces(
        self, terms: list[Terms], multipliers: Floats, shears: bool = True, laws: bool = False
    ) -> tuple[Floats, Floats]:
        """Forces of the tractions on the nodes, and the sizes of their parts, shape (n_dofs,).

        Without `shears` those of pressures between surfaces that may open alone; with `laws` those
        of pressure laws alone.
        """
        force, size = np.zeros(self.system.n_dofs), np.zeros(self.system.n_dofs)
        for pair, own, (p, q) in self.each(terms, multipliers):
            if shears or not (pair.tied or (laws and pair.law is None)):
                q = q if shears else np.zeros(pair.n)
                pair.add_forces(own, p, q, force, size)
        return self.system.at_nodes(force), size

    def _pressures(self) -> Floats:
        """Pressures of all pairs on the nodes in the committed state, shape (n_dofs,).

        With what is left of the forces of pairs that ended with the step.
        """
        if self.at is None:
            return np.zeros(self.system.n_dofs)
        acting = np.repeat([p.active for p in self.pairs], [p.width for p in self.pairs])
        force = self.forces(self.at.acting, self.committed * acting, shears=False)[0]
        return force + self._left(self.time) * self.fading

    def _left(self, step_time: float) -> float:
        """Share of the forces of pairs that ended with the step which is left at a time of it."""
        return max(1.0 - step_time / self.period, 0.0)

    def _keep_law_force(self) -> None:
        """Keep the forces of pressure laws that the next increment begins with."""
        self.law_force = np.zeros(0)
        if self.law_share != 1.0 and any(pair.law is not None for pair in self.pairs):
            self.law_force = np.zeros(self.system.n_dofs)
            if self.at is not None:
                self.law_force = self.forces(self.at.terms, self.committed, False, laws=True)[0]

    def _changed(self, step_time: float) -> float:
        """Share of the change of ramped friction that a step has made at a time of it."""
        return min(step_time / self.period, 1.0) if self.rubs else 1.0

    def offset_at(self, pair: Pair, step_time: float) -> Floats:
        """Offsets of the gaps of a pair at a time of the step, shape (n,)."""
        item = pair.item
        if isinstance(item, ContactPair) and self.number == pair.entered:
            # A first increment that is cut removes its part.
            period = {"ramp": self.period, "keep": self.first}.get(item.start, 0.0)
            if period > 0.0:
                left = max(1.0 - step_time / period, 0.0)
                return np.asarray(pair.base + pair.overlap * left)
        return np.asarray(pair.core.offset)

    def _measure(self, values: Floats) -> None:
        """Pressure per gap of each node: stiffness of the node over its area."""
        system = self.system
        diagonal = self.nodal = np.abs(system.pattern.diagonal_of(values))
        by_node = np.zeros((len(system.per_node), 3))
        by_node[system.node_of_dof, system.component] = diagonal
        nodal = by_node[:, :2].mean(axis=1)
        top = float(nodal.max()) or 1.0
        for pair in self.pairs:
            k = nodal[pair.nodes]
            pair.stiffness = np.where(k > 0.0, k, top) / pair.full
        self._damp()

    def _damp(self) -> None:
        """Damp the surfaces that this step stabilizes."""
        self.damped = np.zeros(self.system.n_dofs)
        for pair in self.pairs:
            item = pair.item
            if isinstance(item, ContactPair) and item.stabilize:
                sides = (pair.slave, pair.master) if self.number >= item.stabilize_from else ()
                for side in filter(None, sides):
                    dofs = np.ravel([self.system.dofs(side.node_list, i) for i in (0, 1)])
                    self.damped[dofs] = STABILIZE * self.nodal[dofs]

    def _damping(self, step_time: float) -> Floats | None:
        if not self.damps or not self.damped.any():
            return None
        dt = step_time - self.time
        left = 1.0 - step_time / self.period
        if dt <= 0.0 or left <= 0.0:
            return None
        return self.damped * (left * self.period / dt)

    # -- increments --------------------------------------------------------------------

    def accept(self, u: Floats, contact_state: ContactState, step_time: float) -> None:
        """Accept a state."""
        moved = u - self.u
        none = [np.full(pair.n, OPEN, np.int8) for pair in self.pairs]
        states = none if self.at is None else self.at.states
        each = self.each(contact_state.terms, contact_state.multipliers)
        for (pair, terms, (p, q)), begun, state in zip(
            each, self.parts(self.committed), states, strict=True
        ):
            late = pair.beyond_trapezoid
            pair.commit(terms, p, q, begun, state)
            if self.damps:
                self.late_work += pair.beyond_trapezoid - late
        # The equations of both ends have these forces, and so has the work of the loads.
        before, self._damping_force = self._damping_force, np.zeros(0)
        if contact_state.damping is not None:
            self._damping_force = contact_state.damping * moved
            both = self._damping_force + (before if len(before) else 0.0)
            self.damping_work += 0.5 * float(both @ moved)
        self.slip_start, self.overcome, law = None, "", self.energies()["ALLCL"]
        contact_state.where = self.positions(0.5 * (self.u + u) if self.persistent else u)
        self.u, self.committed, self.time = u.copy(), contact_state.multipliers.copy(), step_time
        contact_state.states = self.states(contact_state.terms, self.committed)
        contact_state.acting = [terms.acting for terms in contact_state.terms]
        each = self.each(contact_state.terms, self.committed)
        for i, (pair, terms, tractions) in enumerate(each):
            state = contact_state.states[i]
            # Rounding leaves small tractions on open constraints.
            for part in tractions if not pair.tied else ():
                part[state == OPEN] = 0.0
            pair.keep_closed(state)
            if pair.start is not None:
                pair.start = terms.parts
            contact_state.terms[i] = replace(terms.bare or terms, between=None)
        self.at = contact_state
        self._keep_law_force()
        if self.damps and self.opens:
            before, self._pressure = self._pressure, self._pressures()
            self.pressure_work += 0.5 * float((before + self._pressure) @ moved)
            self.pressure_work += self.energies()["ALLCL"] - law

    def revert(self) -> None:
        """Go back to the committed state."""
        for pair in self.pairs:
            pair.core.restore()
            pair.frozen = False
            pair.rate = pair.committed_rate
        self.slip_start = self.springs = self.trial_kink = None

    def energies(self) -> dict[str, float]:
        """Energy that contact has dissipated and that its laws store [force*length]."""
        terms = [] if self.at is None else self.at.terms
        return {
            "ALLFD": float(sum(pair.friction_work for pair in self.pairs)),
            "ALLSD": self.damping_work,
            "ALLPW": self.pressure_work,
            "ALLWK": self.late_work,
            "ALLCL": float(sum(p.law_energy(t) for p, t in zip(self.pairs, terms, strict=False))),
        }

    def label(self, pair: Pair, constraint: int) -> int:
        """The user's number of the slave node of a constraint, or of the corner."""
        return int(self.system.model.mesh.node_labels[pair.named[constraint]])


def few(labels: Sequence[int] | Ints, most: int = 5) -> str:
    """The first labels of a list."""
    shown = ", ".join(str(n) for n in labels[:most])
    return shown + (", ..." if len(labels) > most else "")
