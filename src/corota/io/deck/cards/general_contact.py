"""Cards of general contact: what takes part, with which interaction, and how it starts."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck.card import Card, key
from corota.io.deck.drafts import GeneralDraft, StartDraft
from corota.io.deck.keywords import keyword

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck


@keyword("CONTACT", ignored="OP")
def general(deck: Deck, card: Card) -> None:
    """``*CONTACT``: opens general contact; its pairs are those of the cards below it."""
    card.no_rows()
    if deck.general is not None:
        card.refuse(
            f"general contact is given in {deck.general.card.where}",
            hint="give all that touches there; pairs may end and begin by *MODEL CHANGE",
        )
    deck.general = GeneralDraft(card, step=len(deck.steps))


@keyword("CONTACT INCLUSIONS", "ALLEXTERIOR")
def inclusions(deck: Deck, card: Card) -> None:
    """``*CONTACT INCLUSIONS[, ALL EXTERIOR]``: what touches; a blank stands for all surfaces."""
    into = _general(deck, card)
    rows = list(card.rows())
    if card.has("ALLEXTERIOR"):
        card.no_rows()
        into.every = True
    elif not rows:
        card.error("ALL EXTERIOR, or a line with two surfaces, is missing")
    for row in rows:
        row.at_most(2)
        if not row.get(0) and not row.get(1):
            into.every = True
        else:
            (into.pairs if row.get(0) else into.included).append(row)


@keyword("CONTACT EXCLUSIONS")
def exclusions(deck: Deck, card: Card) -> None:
    """``*CONTACT EXCLUSIONS``: two surfaces that do not touch; one alone does not touch itself."""
    into = _general(deck, card)
    for row in card.lines("surface, surface"):
        row.at_most(2)
        if not row.get(0) and not row.get(1):
            row.error(0, "a surface is missing", "leave *CONTACT out")
        else:
            into.excluded.append(row)


@keyword("CONTACT PROPERTY ASSIGNMENT")
def property_assignment(deck: Deck, card: Card) -> None:
    """``*CONTACT PROPERTY ASSIGNMENT``: two surfaces, interaction; two blanks for all surfaces."""
    into = _general(deck, card)
    for row in card.rows():
        row.at_most(3)
        if row.get(2) and (row.get(0) or row.get(1)):
            into.properties.append(row)
        elif row.get(2):
            into.interaction, into.where = row.get(2), row.at(2)


@keyword(
    "CONTACT INITIALIZATION DATA",
    "NAME INTERFERENCE SEARCHABOVE INITIALCLEARANCE",
    "SEARCHBELOW",
    place="model",
)
def initialization_data(deck: Deck, card: Card) -> None:
    """``*CONTACT INITIALIZATION DATA, NAME=``: overlaps removed without strain, or an interference.

    ``SEARCH ABOVE`` closes gaps up to a distance; ``INITIAL CLEARANCE`` sets the gap.
    """
    card.no_rows()
    name = card.required("NAME")
    draft = StartDraft(name, card, "ramp" if card.has("INTERFERENCE") else "adjust")
    draft.adjust = card.number("SEARCHABOVE", 0.0, 0.0)
    if card.has("INITIALCLEARANCE"):
        draft.clearance = card.number("INITIALCLEARANCE", 0.0, -math.inf)
    if card.has("INTERFERENCE") and (card.has("SEARCHABOVE") or card.has("INITIALCLEARANCE")):
        text = "an overlap is either an interference or removed without strain"
        hint = "leave INTERFERENCE out, or SEARCH ABOVE and INITIAL CLEARANCE"
        card.error(text, "INTERFERENCE", hint)
    elif name:
        deck.starts[key(name)] = draft


@keyword("CONTACT INITIALIZATION ASSIGNMENT")
def initialization_assignment(deck: Deck, card: Card) -> None:
    """``*CONTACT INITIALIZATION ASSIGNMENT``: two surfaces, name of the data."""
    into = _general(deck, card)
    for row in card.rows():
        row.at_most(3)
        if row.get(2) and key(row.get(2)) not in deck.starts:
            text = f"no *CONTACT INITIALIZATION DATA named {row.get(2)!r} before this"
            row.error(2, text)
        elif row.get(2):
            into.starts.append(row)


@keyword("CONTACT FORMULATION", "TYPE")
@keyword(
    "CONTACT CONTROLS ASSIGNMENT",
    "TYPE CONTACTTHICKNESSREDUCTION AUTOMATICOVERCLOSURERESOLUTION NODALEROSION "
    "SCALEPENALTY STABILIZE SEEDONLY",
)
@keyword("SURFACE PROPERTY ASSIGNMENT", "PROPERTY")
def formulation(deck: Deck, card: Card) -> None:
    """``*CONTACT FORMULATION``, ``*SURFACE PROPERTY ASSIGNMENT``: control of general contact."""
    _general(deck, card)
    deck.note(f"{card.where}: {card.spelled} has no effect: contact is mortar, finite sliding")


def _general(deck: Deck, card: Card) -> GeneralDraft:
    if deck.general is None:
        card.refuse("the card belongs under *CONTACT, but there is none before it")
    return deck.general
