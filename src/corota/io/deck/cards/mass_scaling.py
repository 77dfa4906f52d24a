"""Mass scaling of explicit steps."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.io.deck.cards.step import open_step
from corota.io.deck.drafts import MassScalingDraft
from corota.lazy import lazy

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card

scale_masses = lazy("corota.io.deck.build.mass_scaling:scale_masses")

#: How the increment that is wanted changes masses.
TYPES = ("BELOWMIN", "UNIFORM", "SETEQUALDT")


def mass_scaling(deck: Deck, card: Card) -> None:
    """``*FIXED MASS SCALING[, ELSET=][, FACTOR=][, DT=, TYPE=]``: heavier elements."""
    deck.no_rows(card)
    now = open_step(deck, card)
    kind = deck.choice(card, "TYPE", TYPES, "BELOWMIN")
    factor = deck.parameter_number(card, "FACTOR", 1.0, 0.0)
    increment = deck.parameter_number(card, "DT", 0.0, 0.0)
    if now is None:
        return
    if now.options.get("scheme") != "central_difference":
        deck.error(
            card, card.where, "mass scaling belongs to *DYNAMIC, EXPLICIT before it in the step"
        )
    elif factor == 0.0:
        deck.error(card, card.at("FACTOR"), "FACTOR must be > 0")
    elif card.keyword == "VARIABLEMASSSCALING" and not increment:
        deck.error(card, card.where, "DT= is missing: the increment that is to be stable")
    elif factor != 1.0 or increment:
        if card.keyword == "VARIABLEMASSSCALING":
            deck.note(f"{card.where}: {card.spelled}: masses are scaled once, at the start")
        name, step = card.value("ELSET"), len(deck.steps)
        draft = MassScalingDraft(card, name, factor, increment, kind, step)
        deck.later("sections", scale_masses, draft)
