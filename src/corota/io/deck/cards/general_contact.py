"""Cards of general contact: what takes part, with which interaction, and how it starts."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck.drafts import GeneralDraft, StartDraft
from corota.io.deck.lexer import Card, key

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck


def general(deck: Deck, card: Card) -> None:
    """``*CONTACT``: opens general contact; its pairs are those of the cards below it."""
    deck.no_rows(card)
    if deck.general is not None:
        deck.error(
            card,
            card.where,
            f"general contact is given in {deck.general.card.where}",
            hint="give all that touches there; pairs may end and begin by *MODEL CHANGE",
        )
        return
    deck.general = GeneralDraft(card, step=len(deck.steps))


def inclusions(deck: Deck, card: Card) -> None:
    """``*CONTACT INCLUSIONS[, ALL EXTERIOR]``: what touches; a blank stands for all surfaces."""
    into = _general(deck, card)
    if into is None:
        return
    rows = list(card.rows())
    if card.has("ALLEXTERIOR"):
        deck.no_rows(card)
        into.every = True
    elif not rows:
        deck.error(card, card.where, "ALL EXTERIOR, or a line with two surfaces, is missing")
    for row in rows:
        deck.extra_fields(card, row, 2)
        if not row.get(0) and not row.get(1):
            into.every = True
        elif not row.get(0):
            into.included.append((card, row))
        else:
            into.pairs.append((card, row))


def exclusions(deck: Deck, card: Card) -> None:
    """``*CONTACT EXCLUSIONS``: two surfaces that do not touch; one alone does not touch itself."""
    into = _general(deck, card)
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: surface, surface")
    for row in rows:
        deck.extra_fields(card, row, 2)
        if not row.get(0) and not row.get(1):
            deck.row_error(card, row, 0, "a surface is missing", "leave *CONTACT out")
        elif into is not None:
            into.excluded.append((card, row))


def property_assignment(deck: Deck, card: Card) -> None:
    """``*CONTACT PROPERTY ASSIGNMENT``: two surfaces, interaction; two blanks for all surfaces."""
    into = _general(deck, card)
    for row in card.rows():
        deck.extra_fields(card, row, 3)
        if into is None or not row.get(2):
            continue
        if row.get(0) or row.get(1):
            into.properties.append((card, row))
        else:
            into.interaction, into.where = row.get(2), row.at(2)


def initialization_data(deck: Deck, card: Card) -> None:
    """``*CONTACT INITIALIZATION DATA, NAME=``: overlaps removed without strain, or an interference.

    ``SEARCH ABOVE`` closes gaps up to a distance; ``INITIAL CLEARANCE`` sets the gap.
    """
    deck.no_rows(card)
    name = deck.required(card, "NAME")
    draft = StartDraft(name, card)
    if card.has("INTERFERENCE"):
        draft.start = "ramp"
    draft.adjust = deck.parameter_number(card, "SEARCHABOVE", 0.0, 0.0)
    if card.has("INITIALCLEARANCE"):
        draft.clearance = deck.parameter_number(card, "INITIALCLEARANCE", 0.0, -math.inf)
    if card.has("INTERFERENCE") and (card.has("SEARCHABOVE") or card.has("INITIALCLEARANCE")):
        deck.error(
            card,
            card.at("INTERFERENCE"),
            "an overlap is either an interference or removed without strain",
            hint="leave INTERFERENCE out, or SEARCH ABOVE and INITIAL CLEARANCE",
        )
    elif name:
        deck.starts[key(name)] = draft


def initialization_assignment(deck: Deck, card: Card) -> None:
    """``*CONTACT INITIALIZATION ASSIGNMENT``: two surfaces, name of the data."""
    into = _general(deck, card)
    for row in card.rows():
        deck.extra_fields(card, row, 3)
        if into is None or not row.get(2):
            continue
        if key(row.get(2)) not in deck.starts:
            deck.row_error(
                card, row, 2, f"no *CONTACT INITIALIZATION DATA named {row.get(2)!r} before this"
            )
            continue
        into.starts.append((card, row))


def formulation(deck: Deck, card: Card) -> None:
    """``*CONTACT FORMULATION``, ``*SURFACE PROPERTY ASSIGNMENT``: control of general contact."""
    if _general(deck, card) is not None:
        deck.note(f"{card.where}: {card.spelled} has no effect: contact is mortar, finite sliding")


def _general(deck: Deck, card: Card) -> GeneralDraft | None:
    if deck.general is None:
        deck.error(card, card.where, "the card belongs under *CONTACT, but there is none before it")
    return deck.general
