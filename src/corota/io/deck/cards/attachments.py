"""Point masses, rotary inertias, dashpots and gaps of decks: elements, and their values."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError, Location
from corota.io.deck.cards.tie import PLANAR
from corota.io.deck.deck import Deck, nearest
from corota.io.deck.drafts import AttachedDraft, Draft
from corota.io.deck.elements import ATTACHED
from corota.io.deck.lexer import Card, Row, key
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
    name = deck.required(card, "ELSET")
    draft = AttachedDraft(type_, name, card, scope=deck.scope)
    count = ATTACHED[type_]
    for row in card.rows():
        deck.extra_fields(card, row, count + 1)
        ground = type_ == "CONN2D2" and row.get(1) in ("", "0")
        ends = [*range(2 if ground else 1, count + 1)]
        numbers = [deck.integer(card, row, 0, "the element number")]
        numbers += [deck.node(card, row, i, f"node {i}") for i in ends]
        if None in numbers:
            continue
        if len({row.get(i) for i in ends}) < len(ends):
            deck.row_error(card, row, 2, f"node {numbers[1]} occurs twice")
            continue
        draft.labels.append(int(numbers[0] or 0))
        draft.numbers.append([int(n or 0) for n in numbers[1:]])
        draft.nodes.append([Draft("node", card, row, row.get(i), ()) for i in ends])
    if name:
        deck.attached.append(draft)


def mass(deck: Deck, card: Card) -> None:
    """``*MASS, ELSET=``: the mass at each node of the set."""
    _later(deck, card, lambda rows: _value(deck, card, rows, "MASS", "the mass"))


def rotary_inertia(deck: Deck, card: Card) -> None:
    """``*ROTARY INERTIA, ELSET=``: I11, I22 and that about the normal of the plane, I33."""
    what = "the inertia about the normal of the plane"
    _later(deck, card, lambda rows: _value(deck, card, rows, "ROTARYI", what, 2))


def dashpot(deck: Deck, card: Card) -> None:
    """``*DASHPOT, ELSET=[, NONLINEAR]``: an empty line or dofs; force per velocity, or a table."""
    _later(deck, card, lambda rows: _dashpot(deck, card, rows))


def _later(deck: Deck, card: Card, read: Callable[[list[Row]], None]) -> None:
    """Read a card when all elements are known: CAE writes it before or behind them."""
    rows = list(card.rows())
    if deck.required(card, "ELSET"):
        deck.properties.append(lambda: read(rows))


def _dashpot(deck: Deck, card: Card, rows: list[Row]) -> None:
    name = key(card.value("ELSET"))
    type_ = next(
        (d.type for d in deck.attached if d.type.startswith("DASHPOT") and key(d.name) == name),
        "DASHPOTA",
    )
    dofs: list[int | None] = []
    if type_ != "DASHPOTA":
        if not rows:
            deck.error(card, card.where, "two data lines are expected, the dofs and the damping")
            return
        count = 1 if type_ == "DASHPOT1" or not rows[0].get(1) else 2
        dofs = [deck.integer(card, rows[0], i, "the degree of freedom") for i in range(count)]
        for i, dof in enumerate(dofs):
            if dof is not None and dof not in PLANAR:
                deck.row_error(card, rows[0], i, f"expected 1, 2 or 6 (rotation), found {dof}")
        rows = rows[1:]
        if not all(dof in PLANAR for dof in dofs):
            return
    table = damping_rows(deck, card, rows)
    if table is None:
        return
    places = tuple(float(PLANAR[dof or 0]) for dof in dofs)
    for draft in _assign(deck, card, type_, (table[0][1], *places)):
        draft.table = table if card.has("NONLINEAR") else ()


def damping_rows(deck: Deck, card: Card, rows: list[Row]) -> tuple[tuple[float, float], ...] | None:
    """Velocities and forces of ``NONLINEAR``, else 1 and the damping; ``None`` after an error."""
    if not rows:
        deck.error(card, card.where, "a data line is missing: the damping")
        return None
    nonlinear = card.has("NONLINEAR")
    names = ("the force", "the velocity") if nonlinear else ("the damping",)
    pairs = []
    for row in rows:
        values = [deck.real(card, row, i, name) for i, name in enumerate(names)]
        if None in values:
            return None
        pairs.append((float(values[1] or 0.0) if nonlinear else 1.0, float(values[0] or 0.0)))
        if any(row.fields[len(names) :]):
            text = f"the temperature or frequency {row.get(len(names))} is ignored"
            deck.note(f"{row.where}: {text}")
    if nonlinear:
        return tuple(pairs)
    if len(set(pairs)) > 1:
        text = "one damping is expected, which depends on no temperature and no frequency"
        deck.row_error(card, rows[1], 0, text)
        return None
    if not pairs[0][1] >= 0.0:
        deck.row_error(card, rows[0], 0, f"the damping must be >= 0, not {pairs[0][1]:g}")
        return None
    return (pairs[0],)


def _value(deck: Deck, card: Card, rows: list[Row], type_: str, what: str, place: int = 0) -> None:
    if not rows:
        deck.error(card, card.where, f"a data line is missing: {what}")
        return
    value = deck.real(card, rows[0], place, what)
    for row in rows[1:]:
        deck.row_error(card, row, 0, f"one data line is expected, {what}, constant in time")
        return
    if rows[0].get(1) and not place:
        deck.note(f"{rows[0].where}: the temperature or frequency {rows[0].get(1)} is ignored")
    if value is None:
        return
    if not value >= 0.0:
        deck.row_error(card, rows[0], place, f"{what} must be >= 0, not {value:g}")
        return
    _assign(deck, card, type_, (value,))


def gap(deck: Deck, card: Card) -> None:
    """``*GAP, ELSET=``: clearance, direction from the first node to the second.

    Without a direction it is that of the line through the nodes.
    """
    _later(deck, card, lambda rows: _gap(deck, card, rows))


def _gap(deck: Deck, card: Card, rows: list[Row]) -> None:
    if len(rows) != 1:
        deck.error(card, card.where, f"one data line is expected, found {len(rows)}")
        return
    row = rows[0]
    clearance = deck.real(card, row, 0, "the clearance")
    given = [i for i in (1, 2, 3) if row.get(i)]
    direction = [deck.real(card, row, i, "the direction") if i in given else 0.0 for i in (1, 2, 3)]
    if clearance is None or None in direction:
        return
    x, y, z = (float(v or 0.0) for v in direction)
    if z != 0.0:
        deck.row_error(card, row, 3, f"the direction of a gap lies in the plane, not along z = {z}")
        return
    if given and x == y == 0.0:
        deck.row_error(card, row, 1, "the direction of a gap has no length")
        return
    if any(row.fields[4:]):
        text = "area, stiffness and tension are not used: a gap closes exactly"
        deck.note(f"{row.where}: {card.spelled}: {text}")
    _assign(deck, card, "GAPUNI", (clearance, x, y))


def _assign(deck: Deck, card: Card, type_: str, value: tuple[float, ...]) -> list[AttachedDraft]:
    """Give the elements of a set their value; returns them."""
    name = card.value("ELSET")
    mine = [d for d in deck.attached if d.type == type_ and key(d.name) == key(name)]
    for draft in mine:
        if draft.value:
            deck.error(card, card.at("ELSET"), f"{name} already has its value")
            return []
        draft.value = value
    if not mine:
        names = [d.name for d in deck.attached if d.type == type_]
        deck.error(
            card,
            card.at("ELSET"),
            f"no *ELEMENT, TYPE={type_} with the set {name!r}",
            hint=nearest(name, names),
        )
    return mine


def build_attachments(targets: Targets) -> None:
    """Add the deck's point masses, dashpots, connectors and gaps to the model."""
    deck, model = targets.deck, targets.model
    for read in deck.properties:
        read()
    number = -1
    for draft in deck.attached:
        if draft.type == "CONN2D2":
            number += len(draft.labels)
            connect(targets, draft)
            continue
        if not draft.value:
            deck.error(
                draft.card,
                draft.card.at("ELSET"),
                f"no *{CARDS[draft.type]}, ELSET={draft.name} gives these elements a value",
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
                points, (clearance, x, y) = model.mesh.points, draft.value
                direction = (x, y) if x or y else tuple(points[nodes[1]] - points[nodes[0]])
                both, name = (nodes[0], nodes[1]), f"{draft.name}-{label}"
                try:
                    found_gap = gap_element(points, both, clearance, direction, name, where)
                except InputError as error:
                    deck.error(draft.card, where, f"{error.message}; give it by *GAP")
                    continue
                model.contacts.append(found_gap)


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
