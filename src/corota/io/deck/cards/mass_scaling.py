"""Mass scaling of explicit steps."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.io.deck.cards.step import open_step
from corota.io.deck.drafts import MassScalingDraft
from corota.lazy import lazy

if TYPE_CHECKING:
    from corota.io.deck.card import Card
    from corota.io.deck.deck import Deck

scale_masses = lazy("corota.io.deck.build.mass_scaling:scale_masses")

#: How the increment that is wanted changes masses.
TYPES = ("BELOWMIN", "UNIFORM", "SETEQUALDT")


def mass_scaling(deck: Deck, card: Card) -> None:
    """``*FIXED MASS SCALING[, ELSET=][, FACTOR=][, DT=, TYPE=]``: heavier elements."""
    card.no_rows()
    now = open_step(deck, card)
    kind = card.choice("TYPE", TYPES, "BELOWMIN")
    factor, increment = card.number("FACTOR", 1.0, 0.0), card.number("DT", 0.0, 0.0)
    variable = card.keyword == "VARIABLEMASSSCALING"
    if now.options.get("scheme") != "central_difference":
        card.error("mass scaling belongs to *DYNAMIC, EXPLICIT before it in the step")
    elif factor == 0.0:
        card.error("FACTOR must be > 0", "FACTOR")
    elif variable and not increment:
        card.error("DT= is missing: the increment that is to be stable")
    elif factor != 1.0 or increment:
        if variable:
            card.note("masses are scaled once, at the start")
        name, step = card.value("ELSET"), len(deck.steps)
        draft = MassScalingDraft(card, name, factor, increment, kind, step)
        deck.later("sections", scale_masses, draft)
