"""``*BOUNDARY``: fixed and moved nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from corota.io.deck.cards.step import renews
from corota.io.deck.deck import Deck, nearest
from corota.io.deck.drafts import Draft
from corota.io.deck.lexer import Card, Row, key

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


def boundary(deck: Deck, card: Card) -> None:
    """``*BOUNDARY[, OP=][, AMPLITUDE=][, TYPE=][, FIXED]``: target, first dof[, last[, value]]."""
    if renews(deck, deck.step, card, "support") and deck.step is not None:
        deck.step.new_supports = True
    kind = deck.choice(card, "TYPE", RATES, "DISPLACEMENT")
    into = deck.step.supports if deck.step is not None else deck.supports
    keep = card.has("FIXED")
    if deck.step is None and (keep or RATES[kind]):
        name = "FIXED" if keep else "TYPE"
        text = f"{card.parameters[name].name} belongs in a step"
        deck.error(card, card.at(name), text, hint="put the card between *STEP and *END STEP")
        return
    for row in card.rows():
        deck.extra_fields(card, row, 4)
        found = _supports(deck, card, row)
        for draft in found:
            draft.order, draft.keep = RATES[kind], keep
        into.extend(found)


def _supports(deck: Deck, card: Card, row: Row) -> list[Draft]:
    amplitude = card.value("AMPLITUDE")
    named = key(row.get(1))
    if not row.get(0):
        deck.row_error(card, row, 0, "a node number or a set is missing")
        return []
    if named and not named.lstrip("+-")[:1].isdigit():
        if named not in NAMED_SUPPORTS:
            deck.row_error(
                card,
                row,
                1,
                f"expected a degree of freedom 1 to 6, found {row.get(1)!r}",
                nearest(named, NAMED_SUPPORTS),
            )
            return []
        dofs, value = NAMED_SUPPORTS[named], 0.0
    else:
        first = dof_of(deck, card, row, 1)
        last = dof_of(deck, card, row, 2) if row.get(2) else first
        number = deck.real(card, row, 3, "the value", 0.0)
        if first is None or last is None or number is None:
            return []
        if last < first:
            deck.row_error(card, row, 2, f"the last dof {last} is below the first, {first}")
            return []
        dofs, value = tuple(range(first, last + 1)), number
    found = []
    turned = deck.turned(row.get(0))
    if turned is not None:
        return _turns(deck, card, row, turned, dofs, value)
    for dof in dofs:
        if dof in (1, 2, 6):
            index = {1: 0, 2: 1, 6: 2}[dof]
            wide = len(dofs) > 1 and value == 0.0
            found.append(
                Draft("fixed", card, row, row.get(0), (value,), index, amplitude, silent=wide)
            )
        elif value != 0.0:
            deck.row_error(card, row, 3, f"dof {dof} of a planar model is zero and cannot be moved")
            return []
    if not found:
        found.append(Draft("nothing", card, row, row.get(0), (0.0,)))
    return found


def _turns(
    deck: Deck, card: Card, row: Row, target: str, dofs: tuple[int, ...], value: float
) -> list[Draft]:
    """Supports of a rotation node: its dof 3 is the rotation of the reference node."""
    if value != 0.0 and any(dof != 3 for dof in dofs):
        deck.row_error(card, row, 3, "only dof 3 of a rotation node turns in the plane")
        return []
    kind = "fixed" if 3 in dofs else "nothing"
    return [Draft(kind, card, row, target, (value,), 2, card.value("AMPLITUDE"))]


def dof_of(deck: Deck, card: Card, row: Row, index: int) -> int | None:
    """Degree of freedom in a field, from 0; ``None`` after an error."""
    dof = deck.integer(card, row, index, "the degree of freedom")
    if dof is None:
        return None
    if dof == 11:
        deck.row_error(
            card,
            row,
            index,
            "dof 11 belongs to heat conduction",
            "give temperatures by *TEMPERATURE",
        )
        return None
    if not 1 <= dof <= 6:
        deck.row_error(
            card,
            row,
            index,
            f"expected a degree of freedom 1 to 6, found {dof}",
            "1 = x, 2 = y, 6 = drilling rotation",
        )
        return None
    return dof
