"""Connectors of two nodes in the plane: what they join, springs and dampers in them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.io.deck.card import Card, Refused, Row, complete, key, nearest
from corota.io.deck.cards.attachments import add_dashpot, damping_rows, named
from corota.io.deck.cards.release import add_twin, point_of
from corota.io.deck.cards.step import open_step
from corota.io.deck.cards.supports import RATES
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import (
    PLANAR,
    AttachedDraft,
    BehaviorDraft,
    ConnectorDraft,
    Draft,
    ElementBlock,
    Entry,
    LineDraft,
    NamedSet,
    Scope,
)
from corota.io.deck.elements import LINE_ELEMENTS
from corota.io.deck.keywords import keyword
from corota.model.constraints import Coupling
from corota.model.contact import gap_element
from corota.model.loads import Fixed

if TYPE_CHECKING:
    from corota.arrays import Ints
    from corota.errors import Location
    from corota.io.deck.build.targets import Targets

#: Components of the relative motion that a connection leaves free, of 1, 2 and 6. Others are
#: joined, but those of LINK (the distance) and BEAM (all, at a distance).
FREE: dict[str, tuple[int, ...]] = {
    "JOIN": (6,),
    "HINGE": (6,),
    "WELD": (),
    "BEAM": (),
    "LINK": (6,),
    "AXIAL": (1, 6),
    "CARTESIAN": (1, 2, 6),
    "SLOT": (1, 6),
    "TRANSLATOR": (1,),
    "ROTATION": (1, 2, 6),
    "ALIGN": (1, 2),
}
#: Connections that need no second word, and pairs of words for one.
PAIRS: dict[tuple[str, ...], str] = {
    ("JOIN", "ALIGN"): "WELD",
    ("SLOT", "ALIGN"): "TRANSLATOR",
    ("JOIN", "REVOLUTE"): "HINGE",
    ("JOIN", "ROTATION"): "JOIN",
    ("AXIAL", "ROTATION"): "AXIAL",
    ("CARTESIAN", "ROTATION"): "CARTESIAN",
    ("SLOT", "ROTATION"): "SLOT",
    ("CARTESIAN", "ALIGN"): "CARTESIAN, ALIGN",
    ("AXIAL", "ALIGN"): "AXIAL, ALIGN",
}
FREE |= {"CARTESIAN, ALIGN": (1, 2), "AXIAL, ALIGN": (1,)}
#: Share of the size of the model within which two nodes are at one place.
CLOSE = 1e-6


@keyword("CONNECTOR SECTION", "ELSET BEHAVIOR", "CONTROLS", place="model")
def connector_section(deck: Deck, card: Card) -> None:
    """``*CONNECTOR SECTION, ELSET=[, BEHAVIOR=]``: kinds; orientation of the first node."""
    if card.required("ELSET"):
        deck.connectors.append(ConnectorDraft(card, card.lines("the kind of the connection")))


def link(deck: Deck, card: Card, row: Row) -> None:
    """``LINK`` of ``*MPC``: two nodes whose distance stays."""
    row.at_most(3)
    numbers = complete([deck.node(row, i, "the node") for i in (1, 2)])
    draft = AttachedDraft("CONN2D2", "", card, scope=deck.scope)
    draft.numbers.append(numbers)
    draft.nodes.append([Draft("node", row, row.get(i), ()) for i in (1, 2)])
    draft.connector = ConnectorDraft(card, [row], ("LINK",))
    deck.attached.append(draft)
    deck.connectors.append(draft.connector)


@keyword("CONNECTOR BEHAVIOR", "NAME", "INTEGRATION EXTRAPOLATION", place="model")
def connector_behavior(deck: Deck, card: Card) -> None:
    """``*CONNECTOR BEHAVIOR, NAME=``: opens a behavior."""
    card.no_rows()
    name = card.required("NAME")
    deck.behavior = BehaviorDraft(name, card)
    if key(name) in deck.behaviors:
        card.error(f"behavior {name} is already defined", "NAME")
    deck.behaviors[key(name)] = deck.behavior


@keyword(
    "CONNECTOR ELASTICITY",
    "COMPONENT NONLINEAR RIGID",
    "REGULARIZE RTOL EXTRAPOLATION",
    place="model",
)
def connector_elasticity(deck: Deck, card: Card) -> None:
    """``*CONNECTOR ELASTICITY, COMPONENT=[, NONLINEAR][, RIGID]``: stiffness, or force and way."""
    into = _behavior(deck, card)
    if card.has("RIGID"):
        with suppress(Refused):
            if card.has("COMPONENT"):
                into.rigid.add(_component(card))
                return
        listed = [row.integer(i, "the component") for row in card.rows() for i in range(len(row))]
        into.rigid |= {i for i in listed if i} or {1, 2, 6}
        return
    component = _component(card)
    rows = card.lines("the stiffness")
    if component in into.elastic:
        card.refuse(f"component {component} is elastic already")
    into.elastic[component] = rows


@keyword(
    "CONNECTOR DAMPING", "COMPONENT NONLINEAR", "TYPE REGULARIZE RTOL EXTRAPOLATION", place="model"
)
def connector_damping(deck: Deck, card: Card) -> None:
    """``*CONNECTOR DAMPING, COMPONENT=[, NONLINEAR]``: damping, or force and velocity."""
    into = _behavior(deck, card)
    if key(card.value("TYPE")) not in ("", "VISCOUS"):
        card.refuse("the damping of connectors is viscous", "TYPE")
    into.damped[_component(card)] = card


@keyword("CONNECTOR STOP", "COMPONENT", "REGULARIZE", place="model")
def connector_stop(deck: Deck, card: Card) -> None:
    """``*CONNECTOR STOP, COMPONENT=``: smallest, largest relative position."""
    rows, into, component = list(card.rows()), _behavior(deck, card), _component(card)
    if component == 6:
        text = "stops of a rotation are not part of this version"
        card.refuse(text, "COMPONENT", hint="let an arm meet a *GAP")
    if len(rows) != 1 or not any(rows[0].fields[:2]):
        card.refuse("a data line is expected: smallest, largest position")
    low, high = rows[0].reals(("the stop", "the stop"), math.nan)
    if low > high:
        rows[0].refuse(0, f"the stops cross: {low:g} > {high:g}")
    into.stops[component] = (low, high)


@keyword("CONNECTOR MOTION", "AMPLITUDE OP TYPE", place="step")
def connector_motion(deck: Deck, card: Card) -> None:
    """``*CONNECTOR MOTION[, TYPE=]``: element or set, component, value."""
    order = RATES[card.choice("TYPE", RATES, "DISPLACEMENT")]
    _drive(deck, card, "fixed", order)


@keyword("CONNECTOR LOAD", "AMPLITUDE OP", place="step")
def connector_load(deck: Deck, card: Card) -> None:
    """``*CONNECTOR LOAD``: element or set, component, force or moment."""
    _drive(deck, card, "force", 0)


def _drive(deck: Deck, card: Card, kind: str, order: int) -> None:
    open_step(deck, card)
    if card.choice("OP", ("MOD", "NEW"), "MOD") == "NEW":
        text = f"OP=NEW of {card.spelled} is not part of this version"
        card.refuse(text, "OP", hint="give the components that change")
    for row in card.rows():
        row.at_most(3)
        component, value = row.integer(1, "the component"), row.real(2, "the value", 0.0)
        if component is not None and value is not None and component not in PLANAR:
            row.error(1, f"expected component 1, 2 or 6 (rotation), found {component}")
        elif component is not None and value is not None:
            draft = Draft(kind, row, row.get(0), (value,), component, order=order)
            deck.drives.append((len(deck.steps) - 1, draft))


def _behavior(deck: Deck, card: Card) -> BehaviorDraft:
    if deck.behavior is None:
        card.refuse("the card belongs under a *CONNECTOR BEHAVIOR, but there is none before it")
    return deck.behavior


def _component(card: Card) -> int:
    if not card.has("COMPONENT"):
        card.refuse("COMPONENT= is missing: components that act on each other are not supported")
    component = card.integer("COMPONENT", 1, 1)
    if component not in PLANAR:
        text = f"expected component 1, 2 or 6 (rotation), found {component}"
        card.refuse(text, "COMPONENT")
    return component


def prepare_connectors(deck: Deck) -> None:
    """Give connectors their sections, springs and nodes, before the mesh is made."""
    for section in deck.connectors:
        if section.kinds:  # of *MPC
            for draft in deck.attached:
                if draft.connector is section:
                    _pins(deck, draft, section)
            continue
        name = section.card.value("ELSET")
        mine = named(deck, section.card, "CONN2D2")
        if not mine:
            names = [d.name for d in deck.attached if d.type == "CONN2D2"]
            text = f"no *ELEMENT, TYPE=CONN2D2 with the set {name!r}"
            section.card.error(text, "ELSET", hint=nearest(name, names))
        for draft in mine:
            with suppress(Refused):
                if draft.connector is not None:
                    section.card.refuse(f"{name} already has its section", "ELSET")
                draft.connector = section
                _read(deck, draft, section)
                with suppress(Refused):
                    _springs(draft, section)
                _pins(deck, draft, section)
    with suppress(Refused):
        _controls(deck)


def _controls(deck: Deck) -> None:
    """Give each driven component a node, whose dof 1 is the relative motion.

    Motions and loads of the component become those of the node.
    """
    made: dict[tuple[int, int], Draft] = {}
    scopes = [deck.root, *deck.parts.values()]
    for step, drive in deck.drives:
        wanted, found = key(drive.target), False
        for draft in (d for d in deck.attached if d.type == "CONN2D2"):
            for place, label in enumerate(draft.labels):
                if wanted not in (key(draft.name), str(label)):
                    continue
                found = True
                at = drive.row.where
                if draft.scope is not deck.root:
                    text = "connectors of a part cannot be driven"
                    deck.error(drive.card, at, text, hint="give them in *ASSEMBLY")
                    raise Refused
                node = made.get((label, drive.index))
                if node is None:
                    point = next(b.points[:1] for scope in scopes for b in scope.nodes)
                    own = deck.root.add_node(point, at, scopes)
                    made[label, drive.index] = node = Draft("node", drive.row, str(own), (0.0,))
                    draft.controls.append((place, drive.index, drive, node))
                now = deck.steps[step]
                into = now.supports if drive.kind == "fixed" else now.loads
                into.append(replace(drive, target=node.target, index=0))
        if not found:
            names = [d.name for d in deck.attached if d.type == "CONN2D2"]
            text = f"no element or set of *ELEMENT, TYPE=CONN2D2 named {drive.target!r}"
            deck.error(drive.card, drive.row.where, text, hint=nearest(drive.target, names))


def _read(deck: Deck, draft: AttachedDraft, section: ConnectorDraft) -> None:
    """Fill in kind, behavior and angle of a section."""
    card, row = section.card, section.rows[0]
    words = tuple(key(word) for word in row.fields if word)
    kind = PAIRS.get(words, words[0] if len(words) == 1 else "")
    if kind not in FREE:
        known = ", ".join(k for k in FREE if "," not in k)
        hint = f"there are {known}, some with ALIGN or ROTATION"
        row.refuse(0, f"connection {row.text.strip()!r} is not part of this version", hint)
    section.kinds = (kind, *words[1:])
    if len(section.rows) > 1 and section.rows[1].get(0):
        name = section.rows[1].get(0)
        angles = deck.root.orientations
        if draft.scope is not deck.root:
            angles = angles | _turned(deck, draft.scope, section.rows[1])
        angle = angles.get(key(name))
        if angle is None:
            section.rows[1].refuse(0, f"no orientation named {name!r}")
        if math.isnan(angle):
            section.rows[1].refuse(0, f"{name} is not rectangular")
        section.angle = angle
    if card.has("BEHAVIOR"):
        behavior = section.behavior = deck.behaviors.get(key(card.value("BEHAVIOR")))
        if behavior is None:
            card.refuse(f"no *CONNECTOR BEHAVIOR named {card.value('BEHAVIOR')!r}", "BEHAVIOR")
        given = {*behavior.elastic, *behavior.damped, *behavior.stops}
        wrong = sorted(given - _components(section.kinds))
        if wrong:
            text = f"component {wrong[0]} of a connection {kind} has no spring, damper or stop"
            behavior.card.refuse(text)


def _turned(deck: Deck, scope: Scope, row: Row) -> dict[str, float]:
    """Orientations of a part in the assembly."""
    placed = [i for i in deck.instances.values() if scope in (i.scope, deck.parts[i.part])]
    angles = {instance.angle for instance in placed} or {0.0}
    if len(angles) > 1:
        text = "the instances of the part are turned by different angles"
        row.refuse(0, text, "give the connectors in *ASSEMBLY")
    found = {**(deck.parts[placed[0].part].orientations if placed else {}), **scope.orientations}
    return {name: angle + sum(angles) for name, angle in found.items()}


def _components(kinds: tuple[str, ...]) -> set[int]:
    """Components of a connection that move and can have springs, dampers and drives."""
    kind, *words = kinds
    found = {1, 2}
    if kind in ("AXIAL", "AXIAL, ALIGN", "SLOT", "TRANSLATOR"):
        found = {1}
    elif kind in ("JOIN", "HINGE", "ROTATION"):
        found = {6}
    elif kind == "ALIGN":
        found = set()
    return (found | ({6} if "ROTATION" in words else set())) & {*FREE[kind]}


def _directions(section: ConnectorDraft, component: int) -> tuple[int, bool]:
    """Dof (1, 2, 6) of a component, and whether it points the other way."""
    if component == 6:
        return 6, False
    turned = section.angle / (0.5 * math.pi) + (component == 2)
    quarter = round(turned)
    if abs(turned - quarter) > 1e-6:
        text = "springs and dampers of connectors act along x and y, not along an orientation"
        section.card.refuse(f"{text} between", hint="give AXIAL, or SPRINGA")
    return (1, 2)[quarter % 2], quarter % 4 in (2, 3)


def _springs(draft: AttachedDraft, section: ConnectorDraft) -> None:
    """Make a spring element of each elastic component."""
    behavior = section.behavior
    for component, rows in (behavior.elastic if behavior else {}).items():
        along = section.kinds[0].startswith("AXIAL") and component == 1
        type_, turned, lead, card = "SPRINGA", False, [], rows[0].card
        if not along:
            type_, (dof, turned) = "SPRING2", _directions(section, component)
            lead = [card.row(f"{dof}, {dof}", rows[0].where)]
        for label, numbers, nodes in zip(draft.labels, draft.numbers, draft.nodes, strict=True):
            if len(numbers) == 1 and along:
                nodes[0].row.refuse(1, "AXIAL to the ground has no line: give it two nodes")
            name = f"_CONNECTOR-{label}-{component}"
            ends = numbers if along or turned else numbers[::-1]  # SPRING2 takes first less second
            known = [int(b.labels.max(initial=0)) for b in draft.scope.elements]
            own, at = np.array([1 + max([*known, *draft.labels])], np.int64), nodes[0].row.where
            draft.scope.elements.append(
                ElementBlock(
                    draft.card,
                    "SPRING1" if len(numbers) == 1 else type_,
                    own,
                    np.array([ends], np.int64),
                    at.file,
                    np.array([at.line], np.int64),
                )
            )
            draft.scope.elsets[key(name)] = NamedSet(name, at, [Entry(at, own)])
            draft.scope.lines.append(LineDraft("spring", card, name, rows=[*lead, *rows]))


def _pins(deck: Deck, draft: AttachedDraft, section: ConnectorDraft) -> None:
    """Give rigid links between two beams a node at their first end, about which they turn."""
    locked = section.behavior.rigid if section.behavior else ()
    if section.kinds[0] != "LINK" and not (section.kinds[0].startswith("AXIAL") and 1 in locked):
        return
    beams = [b for b in draft.scope.elements if b.type in LINE_ELEMENTS]
    hinged = np.concatenate([np.zeros(0, np.int64), *(b.nodes.ravel() for b in beams)])
    for numbers, nodes in zip(draft.numbers, draft.nodes, strict=True):
        point = point_of(draft.scope, numbers[0])
        if np.isin(numbers, hinged).all() and point is not None:
            nodes.append(add_twin(deck, draft.scope, nodes[0], point))


def connect(targets: Targets, draft: AttachedDraft) -> None:
    """Add constraints and dashpots of the connectors of a set to the model."""
    section = draft.connector
    if section is None:
        text = f"no *CONNECTOR SECTION, ELSET={draft.name} says what these elements join"
        draft.card.error(text, "ELSET")
        return
    for place, drafts in enumerate(draft.nodes):
        found = [targets.nodes(d) for d in drafts]
        nodes = [int(n[0]) for n in found if n is not None and not isinstance(n, str)]
        if len(nodes) == len(drafts) and section.kinds:
            one = _Connector(targets, section, drafts[0].row.where, nodes)
            held = _held(targets)
            one.join(held)
            with suppress(Refused):
                one.damp()
            name = f"{targets.at.prefix}{draft.name}-{draft.labels[place]}" if draft.labels else ""
            one.stop(name)
            for at, component, drive, control in draft.controls:
                node = targets.nodes(control) if at == place else None
                if node is not None and not isinstance(node, str):
                    one.drive(component, drive, int(node[0]), held)


def _held(targets: Targets) -> Ints:
    """Nodes with supports."""
    deck = targets.deck
    drafts = [*deck.supports, *(d for step in deck.steps for d in step.supports)]
    with targets.inside(targets.meshes.views[0]):
        found = [targets.nodes(d) for d in drafts]
    parts = [targets.mesh.node_indices(n) for n in found if n is not None]
    return np.unique(np.concatenate([np.zeros(0, np.int64), *parts]))


class _Connector:
    """One connector in the model: its nodes, the pin of a link behind them."""

    def __init__(
        self, targets: Targets, section: ConnectorDraft, where: Location, nodes: list[int]
    ) -> None:
        self.deck, self.model, self.rotating = targets.deck, targets.model, targets.rotating
        self.targets = targets
        self.section, self.where, self.nodes = section, where, nodes
        self.kind = section.kinds[0]
        points = self.model.mesh.points[nodes]
        self.line = points[1] - points[0] if len(nodes) > 1 else np.zeros(2)
        self.apart = float(np.hypot(*self.line)) > CLOSE * float(
            np.ptp(self.model.mesh.points, axis=0).max()
        )

    def error(self, text: str, hint: str = "") -> None:
        self.deck.error(self.section.card, self.where, text, hint=hint)

    def join(self, held: Ints) -> None:
        """Add the constraints."""
        behavior, kind = self.section.behavior, self.kind
        joined = {1, 2, 6} - {*FREE[kind]}
        if behavior is not None:
            joined |= behavior.rigid & {*FREE[kind]} & {*self._usable()}
        if kind.startswith("AXIAL"):
            joined -= {2}
        if kind in ("ROTATION", "ALIGN"):
            joined -= {1, 2}
        if len(self.nodes) == 1:
            if joined:
                self.error(f"connection {kind} to the ground: hold the node by *BOUNDARY")
            return
        first, second = self.nodes[:2]
        if first in held:
            first, second = second, first  # a node that supports hold leads
        if kind == "BEAM":
            self._couple([first], second, (0, 1, 2))
        elif kind == "LINK" or (kind.startswith("AXIAL") and 1 in joined):
            self._link(held)
        else:
            self._equations(joined, first, second)
        if kind.startswith("AXIAL") and 6 in joined:
            self._equations({6}, first, second)

    def _usable(self) -> tuple[int, ...]:
        """Components that behavior may lock."""
        if self.kind in ("JOIN", "HINGE", "LINK", "ROTATION"):
            return (6,)
        if self.kind.startswith("CARTESIAN"):
            return (1, 2)
        return (1,)

    def _couple(self, nodes: list[int], reference: int, dofs: tuple[int, ...]) -> None:
        self.model.constraints.append(
            Coupling(np.array(nodes), reference, dofs=dofs, where=self.where)
        )
        self.rotating[reference] = True

    def _link(self, held: Ints) -> None:
        """A rigid bar that turns at both ends: its rotation is that of a node without another."""
        if not self.apart:
            self.error("the nodes of a LINK are at one place", "use JOIN")
            return
        first, second = self.nodes[:2]
        pins = [(second, first), (first, second)]
        if len(self.nodes) > 2:
            pins.append((second, self.nodes[2]))
        for node, reference in pins:
            if not self.rotating[reference] and node not in held:
                self._couple([node], reference, (0, 1))
                return
        self.error(
            "a LINK between two nodes that turn, the second of them with supports",
            "name the node with supports first",
        )

    def _equations(self, joined: set[int], first: int, second: int) -> None:
        if self.kind in ("JOIN", "HINGE", "WELD") and self.apart:
            labels = self.model.mesh.node_labels[self.nodes[:2]]
            away = float(np.hypot(*self.line))
            text = f"nodes {labels[0]} and {labels[1]} of a connection {self.kind}"
            self.error(f"{text} are {away:g} apart", "give them one place, or use BEAM")
            return
        if self.kind == "WELD" and self.rotating[[first, second]].any():
            self.rotating[[first, second]] = True
        if joined == {1, 2} or ({1, 2} <= joined and not self.apart):
            self.targets.equations([(first, 1.0), (second, -1.0)], self.where)
            joined = joined - {1, 2}
        for component in sorted(joined):
            if component == 6:
                if self.rotating[[first, second]].all():
                    self._equation([(first, 2, 1.0), (second, 2, -1.0)])
                continue
            self._equation(self._along(component, first, second, turns=True))

    def _axis(self, component: int) -> np.ndarray:
        """Unit vector of component 1 or 2: along the line of AXIAL, else by the orientation."""
        if self.kind.startswith("AXIAL"):
            return np.asarray(self.line / np.hypot(*self.line))
        angle = self.section.angle + (0.5 * math.pi if component == 2 else 0.0)
        normal = np.array([np.cos(angle), np.sin(angle)])
        normal[np.abs(normal) < 1e-12] = 0.0
        return normal

    def _along(
        self, component: int, first: int, second: int, *, turns: bool
    ) -> list[tuple[int, int, float]]:
        """Terms of the motion of one node relative to the other, the direction may turn."""
        normal = self._axis(component)
        lead = int(np.argmax(np.abs(normal)))
        terms = [(first, lead, normal[lead]), (second, lead, -normal[lead])]
        if normal[1 - lead]:
            terms += [
                (first, 1 - lead, normal[1 - lead]),
                (second, 1 - lead, -normal[1 - lead]),
            ]
        begin = self.nodes[0]
        if self.rotating[begin] and turns:
            self._small_turn(terms, normal, begin, first)
        return terms

    def drive(self, component: int, drive: Draft, control: int, held: Ints) -> None:
        """Let dof 1 of a node be the relative motion of a component."""

        def refuse(text: str, hint: str) -> None:
            self.deck.error(drive.card, drive.row.where, text, hint=hint)

        if component not in _components(self.section.kinds):
            refuse(f"component {component} of a connection {self.kind} does not move", "")
            return
        if len(self.nodes) == 1:
            refuse("the connection leads to the ground", "give *BOUNDARY or *CLOAD at its node")
            return
        along = self.kind.startswith("AXIAL") and component == 1
        if along and any(step.nlgeom for step in self.deck.steps):
            refuse(
                "the line of a connection AXIAL turns under NLGEOM",
                "give a truss between the nodes and heat it, or use CARTESIAN or TRANSLATOR",
            )
            return
        first, second = self.nodes[:2]
        if first in held:
            first, second = second, first
        if component == 6:
            if not self.rotating[[first, second]].all():
                refuse("a node of the connection has no rotation", "join elements with rotations")
                return
            terms = [(first, 2, 1.0), (second, 2, -1.0)]
        else:
            terms = self._along(component, first, second, turns=not along)
        terms.append((control, 0, 1.0 if first == self.nodes[0] else -1.0))
        self._equation(terms)
        self.model.supports.append(Fixed(np.array([control]), 1, 0.0, "", self.where))

    def stop(self, name: str) -> None:
        """Add the gaps of its stops."""
        behavior = self.section.behavior
        for component, (low, high) in (behavior.stops if behavior else {}).items():
            if len(self.nodes) == 1 or self.kind.startswith("AXIAL"):
                text = f"stops of a connection {self.kind}"
                text += " to the ground" if len(self.nodes) == 1 else ", whose line turns,"
                hint = "give two nodes and CARTESIAN, SLOT or TRANSLATOR, or contact"
                self.error(f"{text} are not part of this version", hint)
                return
            if self.rotating[self.nodes[0]]:
                label = self.model.mesh.node_labels[self.nodes[0]]
                text = f"the direction of stops turns with node {label}"
                self.error(text, "name a node without rotation first")
                return
            normal = self._axis(component)
            at = float(normal @ self.line)
            both = (self.nodes[0], self.nodes[1])
            for end, way, word in ((low, 1.0, "low"), (high, -1.0, "high")):
                if math.isfinite(end):
                    x, y = (way * normal).tolist()
                    gap = gap_element(
                        self.model.mesh.points,
                        both,
                        way * (at - end),
                        (x, y),
                        f"{name}-{component}-{word}",
                        self.where,
                    )
                    self.model.contacts.append(gap)

    def _small_turn(
        self, terms: list[tuple[int, int, float]], normal: np.ndarray, begin: int, first: int
    ) -> None:
        """Let the direction turn with its first node, by small rotations."""
        if any(step.nlgeom for step in self.deck.steps):
            self.error(
                f"the direction of a connection {self.kind} turns with node "
                f"{self.model.mesh.node_labels[begin]} under NLGEOM",
                "name a node without rotation first, or use *MPC, SLIDER",
            )
            return
        # n . (x2 - x1) stays: n . (u2 - u1) + (rotation x n) . line = 0, less the first.
        arm = float(normal[1] * self.line[0] - normal[0] * self.line[1])
        if arm:
            terms.append((begin, 2, arm if first == begin else -arm))

    def _equation(self, terms: list[tuple[int, int, float]]) -> None:
        self.targets.equation(terms, self.where)

    def damp(self) -> None:
        """Add the dashpots; check what springs and they cannot follow."""
        behavior = self.section.behavior
        if behavior is None:
            return
        moving = {*behavior.elastic, *behavior.damped} & {1, 2}
        if moving and not self.kind.startswith("AXIAL") and self.rotating[self.nodes[0]]:
            large = any(step.nlgeom for step in self.deck.steps)
            if (large or self.apart) and len(self.nodes) > 1:
                self.error(
                    f"the directions of a connection {self.kind} turn with node "
                    f"{self.model.mesh.node_labels[self.nodes[0]]}",
                    "name a node without rotation first, or use AXIAL",
                )
                return
        for component, card in behavior.damped.items():
            table = damping_rows(card, list(card.rows()))
            value: tuple[float, ...] = (table[0][1],)
            nodes = self.nodes[:2]
            if not (self.kind.startswith("AXIAL") and component == 1):
                dof, turned = _directions(self.section, component)
                value += (float(PLANAR[dof]),)
                nodes = nodes if turned else nodes[::-1]  # its velocity is first less second
            curve = table if card.has("NONLINEAR") else ()
            add_dashpot(self.deck, self.model, card, self.where, nodes, value, curve)
