"""Point masses, rotary inertias, dashpots and gaps of decks: elements, and their values."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError, Location
from corota.io.deck.build.mesh import attached_in, turned
from corota.io.deck.card import Card, Refused, Row, complete, key, nearest
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import PLANAR, AttachedDraft, Draft
from corota.io.deck.elements import ATTACHED
from corota.io.deck.keywords import keyword
from corota.lazy import lazy
from corota.model.attachments import Dashpot, PointMass
from corota.model.contact import gap_element

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.build.targets import Targets
    from corota.model.model import Model

connect = lazy("corota.io.deck.cards.connectors:connect")

#: The card that gives the value of each.
CARDS = {
    "MASS": "MASS",
    "ROTARYI": "ROTARY INERTIA",
    "DASHPOTA": "DASHPOT",
    "DASHPOT1": "DASHPOT",
    "DASHPOT2": "DASHPOT",
    "GAPUNI": "GAP",
}


def elements(deck: Deck, card: Card, type_: str) -> None:
    """``*ELEMENT, TYPE=`` one of :data:`ATTACHED`: label, nodes.

    The set names them. A connector without its first node goes to the ground.
    """
    name = card.required("ELSET")
    draft = AttachedDraft(type_, name, card, scope=deck.scope)
    count = ATTACHED[type_]
    for row in card.rows():
        row.at_most(count + 1)
        ground = type_ == "CONN2D2" and row.get(1) in ("", "0")
        ends = [*range(2 if ground else 1, count + 1)]
        with suppress(Refused):
            numbers = [row.integer(0, "the element number")]
            label, *nodes = complete(numbers + [deck.node(row, i, f"node {i}") for i in ends])
            if len({row.get(i) for i in ends}) < len(ends):
                row.refuse(2, f"node {nodes[0]} occurs twice")
            draft.labels.append(label)
            draft.numbers.append(nodes)
            draft.nodes.append([Draft("node", row, row.get(i), ()) for i in ends])
    if name:
        deck.attached.append(draft)


@keyword("MASS", "ELSET", place="model")
def mass(deck: Deck, card: Card) -> None:
    """``*MASS, ELSET=``: the mass at each node of the set."""
    _later(deck, card, lambda: _value(deck, card, "MASS", "the mass"))


@keyword("ROTARY INERTIA", "ELSET", place="model")
def rotary_inertia(deck: Deck, card: Card) -> None:
    """``*ROTARY INERTIA, ELSET=``: I11, I22 and that about the normal of the plane, I33."""
    what = "the inertia about the normal of the plane"
    _later(deck, card, lambda: _value(deck, card, "ROTARYI", what, 2))


@keyword("DASHPOT", "ELSET NONLINEAR", "RTOL REGULARIZE", place="model")
def dashpot(deck: Deck, card: Card) -> None:
    """``*DASHPOT, ELSET=[, NONLINEAR]``: an empty line or dofs; force per velocity, or a table."""
    _later(deck, card, lambda: _dashpot(deck, card))


def _later(deck: Deck, card: Card, read: Callable[[], None]) -> None:
    """Read a card when all elements are known: CAE writes it before or behind them."""
    if card.required("ELSET"):
        deck.properties.append(read)


def _dashpot(deck: Deck, card: Card) -> None:
    rows = list(card.rows())
    type_ = next((d.type for d in named(deck, card, "DASHPOT")), "DASHPOTA")
    dofs: list[int | None] = []
    if type_ != "DASHPOTA":
        if not rows:
            card.refuse("two data lines are expected, the dofs and the damping")
        count = 1 if type_ == "DASHPOT1" or not rows[0].get(1) else 2
        dofs = [rows[0].integer(i, "the degree of freedom") for i in range(count)]
        for i, dof in enumerate(dofs):
            if dof is not None and dof not in PLANAR:
                rows[0].error(i, f"expected 1, 2 or 6 (rotation), found {dof}")
        rows = rows[1:]
        if not all(dof in PLANAR for dof in dofs):
            return
    table = damping_rows(card, rows)
    places = tuple(float(PLANAR[dof]) for dof in complete(dofs))
    for draft in _assign(deck, card, type_, (table[0][1], *places)):
        draft.table = table if card.has("NONLINEAR") else ()


def damping_rows(card: Card, rows: list[Row]) -> tuple[tuple[float, float], ...]:
    """Velocities and forces of ``NONLINEAR``, else 1 and the damping.

    Raises
    ------
    Refused
        After an error.
    """
    if not rows:
        card.refuse("a data line is missing: the damping")
    nonlinear = card.has("NONLINEAR")
    names = ("the force", "the velocity") if nonlinear else ("the damping",)
    pairs = []
    for row in rows:
        force, velocity = (*row.reals(names), 1.0)[:2]
        pairs.append((velocity, force))
        if any(row.fields[len(names) :]):
            text = f"the temperature or frequency {row.get(len(names))} is ignored"
            card.deck.note(f"{row.where}: {text}")
    if nonlinear:
        return tuple(pairs)
    if len(set(pairs)) > 1:
        text = "one damping is expected, which depends on no temperature and no frequency"
        rows[1].refuse(0, text)
    if not pairs[0][1] >= 0.0:
        rows[0].refuse(0, f"the damping must be >= 0, not {pairs[0][1]:g}")
    return (pairs[0],)


def _value(deck: Deck, card: Card, type_: str, what: str, place: int = 0) -> None:
    rows = card.lines(what)
    value = rows[0].real(place, what)
    if len(rows) > 1:
        rows[1].refuse(0, f"one data line is expected, {what}, constant in time")
    if rows[0].get(1) and not place:
        deck.note(f"{rows[0].where}: the temperature or frequency {rows[0].get(1)} is ignored")
    if value is not None and not value >= 0.0:
        rows[0].error(place, f"{what} must be >= 0, not {value:g}")
    elif value is not None:
        _assign(deck, card, type_, (value,))


@keyword("GAP", "ELSET", place="model")
def gap(deck: Deck, card: Card) -> None:
    """``*GAP, ELSET=``: clearance, direction from the first node to the second.

    Without a direction it is that of the line through the nodes.
    """
    _later(deck, card, lambda: _gap(deck, card))


def _gap(deck: Deck, card: Card) -> None:
    row = card.one_line("", counted=True)
    given = [i for i in (1, 2, 3) if row.get(i)]
    clearance = row.real(0, "the clearance")
    direction = [row.real(i, "the direction") if i in given else 0.0 for i in (1, 2, 3)]
    size, x, y, z = complete([clearance, *direction])
    if z != 0.0:
        row.refuse(3, f"the direction of a gap lies in the plane, not along z = {z}")
    if given and x == y == 0.0:
        row.refuse(1, "the direction of a gap has no length")
    if any(row.fields[4:]):
        row.note("area, stiffness and tension are not used: a gap closes exactly")
    _assign(deck, card, "GAPUNI", (size, x, y))


def named(deck: Deck, card: Card, type_: str) -> list[AttachedDraft]:
    """Elements of a type in the set that a card names: those beside it, else those anywhere."""
    name = key(card.value("ELSET"))
    mine = [d for d in deck.attached if d.type.startswith(type_) and key(d.name) == name]
    return [d for d in mine if d.scope is card.scope] or mine


def _assign(deck: Deck, card: Card, type_: str, value: tuple[float, ...]) -> list[AttachedDraft]:
    """Give the elements of a set their value; returns them."""
    name = card.value("ELSET")
    mine = named(deck, card, type_)
    for draft in mine:
        if draft.value:
            card.refuse(f"{name} already has its value", "ELSET")
        draft.value = value
    if not mine:
        names = [d.name for d in deck.attached if d.type == type_]
        text = f"no *ELEMENT, TYPE={type_} with the set {name!r}"
        card.error(text, "ELSET", nearest(name, names))
    return mine


def build_attachments(targets: Targets) -> None:
    """Add the deck's point masses, dashpots, connectors and gaps to the model."""
    deck, model = targets.deck, targets.model
    for read in deck.properties:
        with suppress(Refused):
            read()
    number = -1
    for view, draft in attached_in(targets.meshes.views, deck):
        targets.at = view
        if draft.type == "CONN2D2":
            number += len(draft.labels)
            connect(targets, draft)
            continue
        if not draft.value:
            draft.card.error(
                f"no *{CARDS[draft.type]}, ELSET={draft.name} gives these elements a value", "ELSET"
            )
            continue
        for label, drafts in zip(draft.labels, draft.nodes, strict=True):
            number += 1
            found = [targets.nodes(d) for d in drafts]
            nodes = [int(n[0]) for n in found if n is not None and not isinstance(n, str)]
            if len(nodes) < len(drafts):
                continue
            where = drafts[0].row.where
            if draft.type in ("MASS", "ROTARYI"):
                deck.masses[number] = len(model.point_masses)
                (value,), turns = draft.value, draft.type == "ROTARYI"
                mass, inertia = (0.0, value) if turns else (value, 0.0)
                model.point_masses.append(PointMass(np.array(nodes), mass, inertia, where))
            elif draft.type.startswith("DASHPOT"):
                add_dashpot(deck, model, draft.card, where, nodes, draft.value, draft.table)
            else:
                points, (clearance, *given) = model.mesh.points, draft.value
                line = points[nodes[1]] - points[nodes[0]]
                x, y = turned(np.array(given), view.instance) if any(given) else line
                direction = (float(x), float(y))
                both, name = (nodes[0], nodes[1]), f"{view.prefix}{draft.name}-{label}"
                try:
                    found_gap = gap_element(points, both, clearance, direction, name, where)
                except InputError as error:
                    deck.error(draft.card, where, f"{error.message}; give it by *GAP")
                    continue
                model.contacts.append(found_gap)
    targets.at = targets.meshes.views[0]


def add_dashpot(
    deck: Deck,
    model: Model,
    card: Card,
    where: Location | None,
    nodes: list[int],
    value: tuple[float, ...],
    table: tuple[tuple[float, float], ...],
) -> None:
    """Add a dashpot at one node or two: its damping and, unless along the line, its dofs."""
    c, *places = value
    dofs = (int(places[0]), int(places[-1])) if places else None
    second = nodes[1] if len(nodes) > 1 else None
    try:
        if second is None and not table and dofs is not None:
            x, y, turn = (c * (i == dofs[0]) for i in range(3))
            item = Dashpot(nodes[0], to_ground=(x, y, turn), where=where)
        else:
            item = Dashpot(
                nodes[0], second, 0.0 if table else c, dofs=dofs, table=table, where=where
            )
        model.dashpots.append(item)
    except InputError as error:
        deck.error(card, where, error.message)
