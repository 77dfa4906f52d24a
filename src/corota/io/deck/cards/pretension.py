"""``*PRE-TENSION SECTION``: a cut through a bolt whose faces a node pulls together."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck.drafts import Draft, PretensionDraft

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
from corota.io.deck.card import Card


def pretension(deck: Deck, card: Card) -> None:
    """``*PRE-TENSION SECTION, SURFACE=, NODE=``: components of the normal."""
    if card.has("ELEMENT"):
        text = "a section in a beam or truss is not part of this version"
        hint = "shorten it by *EXPANSION and *TEMPERATURE, or cut planar elements: SURFACE="
        card.refuse(text, "ELEMENT", hint)
    surface, node = card.required("SURFACE"), card.required("NODE")
    rows = list(card.rows())
    if len(rows) > 1:
        rows[1].error(0, "one data line is expected")
    if not surface or not node:
        return
    found = PretensionDraft(card, surface, Draft("node", card.row_of("NODE"), node, (0.0,)))
    if rows and any(rows[0].fields):
        rows[0].at_most(3)
        x, y, z = rows[0].reals(("the normal x", "the normal y", "the normal z"), 0.0)
        size = math.hypot(x, y)
        if size == 0.0 or z != 0.0:
            rows[0].refuse(0, "the normal must lie in the plane: x, y, 0")
        found.normal = (x / size, y / size)
    deck.pretensions.append(found)
