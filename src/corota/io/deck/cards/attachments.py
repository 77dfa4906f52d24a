"""Point masses, rotary inertias and dashpots of decks: elements, and their values."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.io.deck.deck import nearest
from corota.io.deck.drafts import AttachedDraft, Draft
from corota.io.deck.elements import ATTACHED
from corota.io.deck.lexer import key
from corota.model.attachments import Dashpot, PointMass

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card
    from corota.mesh.data import Ints
    from corota.model.model import Model

    Find = Callable[[Draft], str | Ints | None]

#: The card that gives the value of each.
CARDS = {"MASS": "MASS", "ROTARYI": "ROTARY INERTIA", "DASHPOTA": "DASHPOT"}


def elements(deck: Deck, card: Card, type_: str) -> None:
    """``*ELEMENT, TYPE=MASS``, ``ROTARYI`` or ``DASHPOTA``: label, nodes; the set names them."""
    name = deck.required(card, "ELSET")
    draft = AttachedDraft(type_, name, card)
    count = ATTACHED[type_]
    for row in card.rows():
        deck.extra_fields(card, row, count + 1)
        numbers = [deck.integer(card, row, 0, "the element number")]
        numbers += [deck.node(card, row, i, f"node {i}") for i in range(1, count + 1)]
        if None in numbers:
            continue
        if len({row.get(i) for i in range(1, count + 1)}) < count:
            deck.row_error(card, row, 2, f"node {numbers[1]} occurs twice")
            continue
        draft.labels.append(int(numbers[0] or 0))
        draft.nodes.append([Draft("node", card, row, row.get(i), ()) for i in range(1, count + 1)])
    if name:
        deck.attached.append(draft)


def mass(deck: Deck, card: Card) -> None:
    """``*MASS, ELSET=``: the mass at each node of the set."""
    _value(deck, card, "MASS", "the mass")


def rotary_inertia(deck: Deck, card: Card) -> None:
    """``*ROTARY INERTIA, ELSET=``: I11, I22 and that about the normal of the plane, I33."""
    _value(deck, card, "ROTARYI", "the inertia about the normal of the plane", 2)


def dashpot(deck: Deck, card: Card) -> None:
    """``*DASHPOT, ELSET=``: an empty line, then force per velocity along the line."""
    _value(deck, card, "DASHPOTA", "the damping")


def _value(deck: Deck, card: Card, type_: str, what: str, place: int = 0) -> None:
    name = deck.required(card, "ELSET")
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, f"a data line is missing: {what}")
        return
    value = deck.real(card, rows[0], place, what)
    for row in rows[1:]:
        deck.row_error(card, row, 0, f"one data line is expected, {what}, constant in time")
        return
    if rows[0].get(1) and not place:
        deck.note(f"{rows[0].where}: the temperature or frequency {rows[0].get(1)} is ignored")
    if value is None or not name:
        return
    if not value >= 0.0:
        deck.row_error(card, rows[0], place, f"{what} must be >= 0, not {value:g}")
        return
    mine = [d for d in deck.attached if d.type == type_ and key(d.name) == key(name)]
    for draft in mine:
        if draft.value is not None:
            deck.error(card, card.at("ELSET"), f"{name} already has its value")
            return
        draft.value = value
    if not mine:
        names = [d.name for d in deck.attached if d.type == type_]
        deck.error(
            card,
            card.at("ELSET"),
            f"no *ELEMENT, TYPE={type_} with the set {name!r} before this card",
            hint=nearest(name, names),
        )


def build_attachments(deck: Deck, model: Model, find: Find) -> None:
    """Add the deck's point masses and dashpots to the model."""
    number = -1
    for draft in deck.attached:
        if draft.value is None:
            deck.error(
                draft.card,
                draft.card.at("ELSET"),
                f"no *{CARDS[draft.type]}, ELSET={draft.name} gives these elements a value",
            )
            continue
        for drafts in draft.nodes:
            number += 1
            found = [find(d) for d in drafts]
            nodes = [int(n[0]) for n in found if n is not None and not isinstance(n, str)]
            if len(nodes) < len(drafts):
                continue
            where = drafts[0].row.where
            if draft.type in ("MASS", "ROTARYI"):
                deck.masses[number] = len(model.point_masses)
                turns = draft.type == "ROTARYI"
                mass, inertia = (0.0, draft.value) if turns else (draft.value, 0.0)
                model.point_masses.append(PointMass(np.array(nodes), mass, inertia, where))
            else:
                model.dashpots.append(Dashpot(nodes[0], nodes[1], draft.value, where=where))


__all__ = ["AttachedDraft", "build_attachments", "dashpot", "elements", "mass", "rotary_inertia"]
