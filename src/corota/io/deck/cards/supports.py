"""``*BOUNDARY``: fixed and moved nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import suppress

from corota.io.deck.card import Card, Refused, Row, complete, key, nearest
from corota.io.deck.cards.step import renews
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import PLANAR, Draft
from corota.io.deck.keywords import keyword

#: Names of Abaqus for groups of degrees of freedom (numbers from 1).
NAMED_SUPPORTS = {
    "ENCASTRE": (1, 2, 3, 4, 5, 6),
    "PINNED": (1, 2, 3),
    "XSYMM": (1, 5, 6),
    "YSYMM": (2, 4, 6),
    "ZSYMM": (3, 4, 5),
    "XASYMM": (2, 3, 4),
    "YASYMM": (1, 3, 5),
    "ZASYMM": (1, 2, 6),
}


#: Prescribed quantity of a support, and the number of integrations to a displacement.
RATES = {"DISPLACEMENT": 0, "VELOCITY": 1, "ACCELERATION": 2}


@keyword("BOUNDARY", "OP AMPLITUDE TYPE LOADCASE FIXED REAL IMAGINARY", "REGIONTYPE")
def boundary(deck: Deck, card: Card) -> None:
    """``*BOUNDARY[, OP=][, AMPLITUDE=][, TYPE=][, FIXED]``: target, first dof[, last[, value]]."""
    if renews(deck.step, card, "support") and deck.step is not None:
        deck.step.new_supports = True
    order = RATES[card.choice("TYPE", RATES, "DISPLACEMENT")]
    into = deck.step.supports if deck.step is not None else deck.supports
    keep = card.has("FIXED")
    if deck.step is None and (keep or order):
        name = "FIXED" if keep else "TYPE"
        text = f"{card.parameters[name].name} belongs in a step"
        card.refuse(text, name, "put the card between *STEP and *END STEP")
    for row in card.rows():
        row.at_most(4)
        with suppress(Refused):
            for draft in _supports(deck, row):
                draft.order, draft.keep = order, keep
                into.append(draft)


def _supports(deck: Deck, row: Row) -> list[Draft]:
    named, target = key(row.get(1)), row.get(0)
    if not target:
        row.refuse(0, "a node number or a set is missing")
    if named and not named.lstrip("+-")[:1].isdigit():
        if named not in NAMED_SUPPORTS:
            text = f"expected a degree of freedom 1 to 6, found {row.get(1)!r}"
            row.refuse(1, text, nearest(named, NAMED_SUPPORTS))
        dofs, value = NAMED_SUPPORTS[named], 0.0
    else:
        first = dof_of(row, 1)
        ends, number = (
            [first, dof_of(row, 2) if row.get(2) else first],
            row.real(3, "the value", 0.0),
        )
        (low, high), (value,) = complete(ends), complete([number])
        if high < low:
            row.refuse(2, f"the last dof {high} is below the first, {low}")
        dofs = tuple(range(low, high + 1))
    turned = deck.turned(target)
    if turned is not None:
        # Dof 3 of a rotation node is the rotation of the reference node.
        if value != 0.0 and any(dof != 3 for dof in dofs):
            row.refuse(3, "only dof 3 of a rotation node turns in the plane")
        return [Draft("fixed" if 3 in dofs else "nothing", row, turned, (value,), 2)]
    found = []
    for dof in dofs:
        if dof in PLANAR:
            wide = len(dofs) > 1 and value == 0.0
            found.append(Draft("fixed", row, target, (value,), PLANAR[dof], silent=wide))
        elif value != 0.0:
            row.refuse(3, f"dof {dof} of a planar model is zero and cannot be moved")
    return found or [Draft("nothing", row, target, (0.0,))]


def dof_of(row: Row, index: int) -> int | None:
    """Degree of freedom in a field, from 0; ``None`` after an error."""
    dof = row.integer(index, "the degree of freedom")
    if dof == 11:
        row.error(index, "dof 11 belongs to heat conduction", "give temperatures by *TEMPERATURE")
        return None
    if dof is not None and not 1 <= dof <= 6:
        text = f"expected a degree of freedom 1 to 6, found {dof}"
        row.error(index, text, "1 = x, 2 = y, 6 = drilling rotation")
        return None
    return dof
