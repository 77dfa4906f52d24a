"""From the contact pairs and ties of a deck to those of a model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from corota.errors import InputError
from corota.io.deck import numerals
from corota.io.deck.build.general_contact import add_general
from corota.io.deck.build.mesh import View, placed, views_in
from corota.io.deck.card import Card, Refused, key, nearest
from corota.io.deck.cards.contact import interaction_of
from corota.model.contact import ContactPair, PressureLaw, RigidCurve, Tie
from corota.model.steps import Buckle, Frequency, Visco

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.drafts import Draft, InteractionDraft, PairDraft, Surface, SurfaceRow
    from corota.mesh.data import Mesh

#: Procedures without velocities; ``None`` is a static step.
AT_REST = (None, Visco, Buckle, Frequency)


def build_contacts(targets: Targets) -> None:
    """Add the deck's contact pairs and ties to the model; reference nodes get a rotation."""
    builder, deck = _Builder(targets), targets.deck
    add_general(deck, targets.model, targets.sets)
    for pair in deck.pairs:
        for view in builder.views(pair.row.card):
            try:
                with targets.inside(view), suppress(Refused):
                    builder.add(pair)
            except InputError as error:
                deck.error(pair.row.card, pair.row.where, error.message, text=pair.row.text)
    builder.unused()


class _Builder:
    def __init__(self, targets: Targets) -> None:
        self.targets, self.deck, self.model = targets, targets.deck, targets.model
        self.sets, self.rotating = targets.sets, targets.rotating
        self.curves: dict[str, RigidCurve] = {}
        self.carriers: dict[str, tuple[Card, Draft | None, View]] = {}
        for card, draft in self.deck.carriers:
            shown = card.value("ANALYTICALSURFACE")
            for view in self.views(card):
                full = self.sets.full_name(self.sets.surfaces, view, shown)
                self.carriers[full or key(shown)] = (card, draft, view)

    def add(self, pair: PairDraft) -> None:
        """Build one pair; errors are recorded in the deck."""
        interaction = None if pair.tied else interaction_of(self.deck, pair)
        itself, sides = key(pair.slave) == key(pair.master), []
        for index in (0,) if itself else (0, 1):
            with suppress(Refused):
                sides.append(self._surface(pair, index))
        if len(sides) < 2 - itself or (interaction is None and not pair.tied):
            return
        slave, master = sides[0], sides[-1]
        if isinstance(slave, RigidCurve):
            text = f"{pair.slave} is a rigid profile and cannot be the slave"
            pair.row.refuse(0, text, "name the deformable surface first, the rigid one second")
        name = self.targets.at.prefix + (pair.name or f"{pair.slave}-{pair.master}")
        if pair.tied or (interaction is not None and interaction.law == "TIED"):
            if isinstance(master, RigidCurve):
                text = "nothing can be tied to a rigid profile"
                pair.row.refuse(1, text, "use *RIGID BODY, NSET=")
            self.model.ties.append(Tie(slave, master, pair.adjust, name, pair.row.where))
            return
        assert interaction is not None
        smooth = pair.smooth
        if smooth and (itself or isinstance(master, RigidCurve)):
            self.deck.note(
                f"{pair.row.where}: SMOOTH is not used: only a master of element edges, other than "
                "the slave, is smoothed"
            )
            smooth = False
        count = len(self.deck.steps)
        for held, steps in interaction.spans(count, pair.acts(count)):
            later = bool(steps and self.model.contacts and self.model.contacts[-1].name == name)
            self.model.contacts.append(
                ContactPair(
                    slave,
                    master,
                    cast("Literal['mortar', 'node_to_segment']", pair.method),
                    held.friction,
                    self._law(held),
                    pair.clearance,
                    cast("Literal['keep', 'adjust', 'ramp']", pair.start),
                    pair.stabilize > 0,
                    stabilize_from=max(pair.stabilize, 1),
                    name=f"{name} from step {steps[0]}" if later and steps else name,
                    where=pair.row.where,
                    adjust=pair.adjust,
                    adjust_nodes=self._adjusted(pair),
                    smooth=smooth,
                    shear_limit=held.shear_limit if held.rubs else None,
                    separates=held.separates,
                    steps=steps,
                    friction_steps=held.friction_steps,
                    friction_ramps=held.friction_ramps or not held.friction_steps,
                )
            )

    def _adjusted(self, pair: PairDraft) -> str | Ints | None:
        """Nodes of ``ADJUST=set``."""
        if not pair.adjust_set:
            return None
        name = self.sets.mesh_name(self.model.mesh.node_sets, self.targets.at, pair.adjust_set)
        if not name:
            hint = nearest(pair.adjust_set, self.model.mesh.node_sets)
            hint = hint or "or give the distance up to which gaps are closed without strain"
            text = f"no node set named {numerals.shown(pair.adjust_set)}"
            pair.row.card.error(text, "ADJUST", hint)
        return name or None

    def _law(self, draft: InteractionDraft) -> PressureLaw | None:
        card, draft.damping = draft.damping, None  # said once
        if card is not None and all(step.make in AT_REST for step in self.deck.steps):
            card.note("contact is damped in dynamic steps only")
        elif (
            card is not None and draft.law == "HARD" and "FRACTION" in key(card.value("DEFINITION"))
        ):
            # Coefficients are the default of Abaqus/Standard and may act before surfaces touch.
            text = "hard contact has no spring that could swing, so none is damped"
            self.deck.note(f"{card.where}: {card.spelled} is ignored: {text}")
        elif card is not None:
            text = "damping of contact is not part of this version in steps with motion"
            hint = "damp the bodies by *DAMPING, or leave the card out"
            card.error(text, hint=hint)
        if draft.law in ("HARD", "TIED") or not draft.pressure:
            return None
        try:
            return PressureLaw(
                draft.law.lower(), np.array(draft.pressure), np.array(draft.overclosure)
            )
        except InputError as error:
            self.deck.error(draft.card, draft.law_where, error.message)
            draft.pressure.clear()  # said once
            return None

    def _surface(self, pair: PairDraft, index: int) -> str | Ints | RigidCurve:
        """A surface of a pair: name of edges, edges, or a rigid curve."""
        name = (pair.slave, pair.master)[index]
        full = self.sets.full_name(self.sets.surfaces, self.targets.at, name)
        found = self.sets.surfaces.get(full)
        index = min(index, len(pair.row) - 1)
        if found is None:
            known = [view.prefix + s.name for view, s in self.sets.surfaces.values()]
            hint = nearest(name, known)
            pair.row.refuse(index, f"no surface named {numerals.shown(name)}", hint)
        view, surface = found
        if key(surface.card.value("TYPE")) == "SEGMENTS":
            return self._curve(full, surface)
        sides = [] if surface.nodes else self.sets.rigid_sides(view, surface)
        if sides:
            return self._rigid_sides(full, view, surface, sides)
        full = view.prefix + surface.name
        if surface.nodes:
            nodes = self.model.mesh.node_sets[full]
            edges = _edges_of_nodes(self.model.mesh, nodes)
            what = "no outer element edge has both ends in it"
            if pair.slave == name and len(nodes):
                covered = self.model.mesh.edge_set_nodes(edges)
                if not np.isin(nodes, covered).all():
                    return full  # single nodes, without edges between them
        else:
            edges, what = self.model.mesh.edge_sets[full], "it has no edges"
        if not len(edges):
            if self.deck.n_errors:
                raise Refused
            hint = "contact acts on edges: give the surface by elements and faces"
            pair.row.refuse(index, f"surface {name} cannot be used for contact: {what}", hint)
        return edges if surface.nodes else full

    def views(self, card: Card) -> list[View]:
        """Name spaces of a card; the assembly for one of a part without instances."""
        return views_in(self.sets.views, self.deck, card.scope) or self.sets.views[:1]

    def _curve(self, name: str, surface: Surface) -> RigidCurve:
        if surface.profile is None:
            raise Refused  # its errors are reported already
        if name in self.curves:
            return self.curves[name]
        view = self.sets.surfaces[name][0]
        rows = surface.profile.copy()
        for columns in (slice(0, 2), slice(2, 4), slice(4, 6)):
            rows[:, columns] = placed(rows[:, columns], view.instance)
        reference: int | None = None
        card, draft, at = self.carriers.get(name, (surface.card, None, view))
        if draft is not None:
            with self.targets.inside(at):
                reference = self.targets.one_node(draft)
            self.rotating[reference] = True
        else:
            missing = "REF NODE" if name in self.carriers else "*RIGID BODY"
            text = f"rigid profile {surface.name} has no {missing}, so it stays where it is"
            self.deck.note(f"{card.where}: {text}")
        self.curves[name] = curve = _made(rows, surface.fillet, reference)
        curve.name = view.prefix + surface.name
        return curve

    def _rigid_sides(
        self, name: str, view: View, surface: Surface, sides: list[tuple[SurfaceRow, Ints]]
    ) -> RigidCurve:
        """Sides of a rigid body (R2D2) as a curve, carried by its reference node."""
        if name in self.curves:
            return self.curves[name]
        ways, lines = [], []
        for row, own in sides:
            if row.face not in ("SPOS", "SNEG"):
                row.refuse(
                    "sides of a rigid body need SPOS (the surface is on the left of the "
                    "direction from the first to the second node) or SNEG"
                )
            lines += own.tolist()
            ends = np.array([self.sets.line_nodes[i][:2] for i in own])
            ways.append(ends if row.face == "SPOS" else ends[:, ::-1])
        chain = _chain(np.concatenate(ways))
        if chain is None:
            text = f"the sides of {surface.name} do not follow each other in one line"
            hint = "give each chain of sides its own surface, all in one direction"
            surface.card.refuse(text, hint=hint)
        reference = self._body_of(surface, set(lines))
        points = self.model.mesh.points[chain]
        rows = np.zeros((len(chain) - 1, 7))
        rows[:, :2], rows[:, 2:4] = points[:-1], points[1:]
        self.rotating[reference] = True
        self.curves[name] = curve = RigidCurve(rows, reference)
        curve.name = view.prefix + surface.name
        return curve

    def _body_of(self, surface: Surface, lines: set[int]) -> int:
        """Reference node of the rigid body that holds the lines of a surface."""
        for tie in self.deck.ties:
            if tie.kind != "kinematic" or not tie.elset:
                continue
            for view in views_in(self.sets.views, self.deck, tie.card.scope):
                full = self.sets.full_name(self.sets.elsets, view, tie.elset)
                found = self.sets.element_set(full) if full else None
                if found is not None and lines <= set(found.lines.tolist()):
                    with self.targets.inside(view):
                        return self.targets.one_node(tie.terms[0])
        surface.card.refuse(f"the sides of {surface.name} belong to no *RIGID BODY, ELSET=")

    def unused(self) -> None:
        """Report rigid bodies of undefined profiles, and unused definitions."""
        for name, (card, _, _) in self.carriers.items():
            if name not in self.sets.surfaces:
                shown = card.value("ANALYTICALSURFACE")
                hint = nearest(shown, [s.name for _, s in self.sets.surfaces.values()])
                card.error(f"no surface named {numerals.shown(shown)}", "ANALYTICALSURFACE", hint)
            elif key(self.sets.surfaces[name][1].card.value("TYPE")) != "SEGMENTS":
                text = "the surface is not a rigid profile (TYPE=SEGMENTS); use NSET= or ELSET="
                card.error(text, "ANALYTICALSURFACE")
        named = {key(p.interaction) for p in self.deck.pairs}
        for name, draft in self.deck.interactions.items():
            if name not in named:
                self.deck.note(f"{draft.card.where}: interaction {draft.name} is not used")


def _made(rows: Floats, fillet: float, reference: int | None) -> RigidCurve:
    if fillet <= 0.0:
        return RigidCurve(rows, reference)
    points = np.concatenate([rows[:1, :2], rows[:, 2:4]])
    closed = bool(np.array_equal(points[0], points[-1]))
    points = points[:-1] if closed else points
    return RigidCurve.polyline(points, closed=closed, fillet=fillet, reference=reference)


def _chain(ways: Ints) -> list[int] | None:
    """Nodes of directed sides in their order; ``None`` where they are not one line."""
    after = dict(ways.tolist())
    starts = set(after) - set(after.values())
    if len(after) != len(ways) or len(set(after.values())) != len(ways) or len(starts) > 1:
        return None
    chain = [starts.pop() if starts else int(ways[0, 0])]
    for _ in ways:
        if chain[-1] not in after:
            return None
        chain.append(after[chain[-1]])
    return chain


def _edges_of_nodes(mesh: Mesh, nodes: Ints) -> Ints:
    """Outer edges whose two ends are in a set of nodes."""
    free = mesh.boundary_edges()
    inside = np.zeros(mesh.n_nodes, bool)
    inside[nodes] = True
    chosen = [bool(inside[ends[:2]].all()) for ends in mesh.edge_nodes(free)]
    return np.asarray(free[np.array(chosen, bool)])
