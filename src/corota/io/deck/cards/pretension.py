"""``*PRE-TENSION SECTION``: a cut through a bolt whose faces a node pulls together."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck.cards.tie import parameter_row
from corota.io.deck.drafts import Draft, PretensionDraft

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
from corota.io.deck.lexer import Card


def pretension(deck: Deck, card: Card) -> None:
    """``*PRE-TENSION SECTION, SURFACE=, NODE=``: components of the normal."""
    if card.has("ELEMENT"):
        deck.error(
            card,
            card.at("ELEMENT"),
            "a section in a beam or truss is not part of this version",
            hint="shorten it by *EXPANSION and *TEMPERATURE, or cut planar elements: SURFACE=",
        )
        return
    surface, node = deck.required(card, "SURFACE"), deck.required(card, "NODE")
    rows = list(card.rows())
    if len(rows) > 1:
        deck.row_error(card, rows[1], 0, "one data line is expected")
    if not surface or not node:
        return
    found = PretensionDraft(
        card, surface, Draft("node", card, parameter_row(card, "NODE"), node, (0.0,))
    )
    if rows and any(rows[0].fields):
        deck.extra_fields(card, rows[0], 3)
        x = deck.real(card, rows[0], 0, "the normal x", 0.0)
        y = deck.real(card, rows[0], 1, "the normal y", 0.0)
        z = deck.real(card, rows[0], 2, "the normal z", 0.0)
        if x is None or y is None or z is None:
            return
        size = math.hypot(x, y)
        if size == 0.0 or z != 0.0:
            deck.row_error(card, rows[0], 0, "the normal must lie in the plane: x, y, 0")
            return
        found.normal = (x / size, y / size)
    deck.pretensions.append(found)
