"""Reading a card by its entry in the table of keywords, or saying why it is not read."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from corota.errors import InputError
from corota.io.deck.card import Card, Refused, key, nearest
from corota.io.deck.deck import Deck
from corota.io.deck.fields import pick_rows
from corota.io.deck.keywords import KEYWORDS, SPELLED
from corota.io.deck.refused import (
    HEAT,
    IGNORED,
    LABELS,
    PLASTIC,
    PROCEDURE,
    REFUSED_PARAMETERS,
    UNSUPPORTED,
    WITHOUT_EFFECT,
)


def interpret(deck: Deck, card: Card) -> None:
    """Read one card into the deck."""
    card.deck, card.scope = deck, deck.scope
    if card.keyword not in KEYWORDS:
        _unknown(deck, card)
        return
    entry = KEYWORDS[card.keyword]
    known = set(entry.parameters.split())
    ignored = set(entry.ignored.split())
    refused = {
        name for keyword, name in (*REFUSED_PARAMETERS, *WITHOUT_EFFECT) if keyword == card.keyword
    }
    _spell_out(card, known | ignored | refused)
    for name, parameter in card.parameters.items():
        if name in known or (card.keyword, name) in LABELS:
            continue
        if name in ignored or _same(parameter.value, WITHOUT_EFFECT.get((card.keyword, name))):
            card.note(f"{parameter.name} is ignored")
            continue
        place = type(card.where)(card.where.file, card.where.line, parameter.column)
        reason = REFUSED_PARAMETERS.get((card.keyword, name))
        if reason:
            deck.error(card, place, f"{parameter.name} is not supported", hint=reason)
        elif deck.lenient:
            text = f"unknown parameter {parameter.name} is ignored"
            deck.error(card, place, text, severity="warning")
        else:
            hint = nearest(name, known | ignored)
            deck.error(card, place, f"unknown parameter {parameter.name}", hint=hint)
    if entry.place == "model" and deck.step is not None:
        card.error(f"{card.spelled} inside a step", hint="model data stand before the first *STEP")
        return
    if "DEPENDENCIES" in known and card.has("DEPENDENCIES"):
        pick_rows(deck, card)
    try:
        entry.function(deck, card)
    except Refused:
        return
    except InputError as error:
        card.error(error.message)


def _same(given: str, value: str | None) -> bool:
    """Whether a value of a parameter is `value`, as a number or a name."""
    if value is None:
        return False
    try:
        return float(given) == float(value)
    except ValueError:
        return key(given) == value


def _spell_out(card: Card, words: set[str]) -> None:
    """Give abbreviated parameters (``GEN``, ``FREQ``) their full names, where one fits."""
    for name in [n for n in card.parameters if n not in words and len(n) > 2]:
        fits = sorted((w for w in words if w.startswith(name)), key=len)
        if fits and all(w.startswith(fits[0]) for w in fits) and fits[0] not in card.parameters:
            card.parameters[fits[0]] = card.parameters.pop(name)


def _unknown(deck: Deck, card: Card) -> None:
    if card.keyword.startswith("HEADING"):
        deck.heading.append(card.text.strip()[len("*HEADING") :].strip())
        KEYWORDS["HEADING"].function(deck, card)
        return
    if card.keyword in IGNORED:
        deck.note(f"{card.where}: {card.spelled} is ignored: {IGNORED[card.keyword]}")
        return
    if card.keyword in UNSUPPORTED:
        _answered(deck, card, UNSUPPORTED[card.keyword])
        card.error("the card is not supported", hint=UNSUPPORTED[card.keyword])
        return
    # A card that is read comes before one that is refused.
    hint = nearest(card.keyword, [*KEYWORDS, "INCLUDE"]) or nearest(
        card.keyword, [*IGNORED, *UNSUPPORTED]
    )
    if deck.lenient:
        text = f"unknown keyword {card.spelled} is ignored"
        deck.error(card, card.where, text, hint=hint, severity="warning")
    else:
        card.error(f"unknown keyword {card.spelled[:60]}", hint=_pretty(hint))


def _answered(deck: Deck, card: Card, why: str) -> None:
    """Mark the data of a refused card: it is not reported as missing again."""
    if deck.material is not None and why == PLASTIC and not deck.material.law:
        deck.material.law = "REFUSED"
    if deck.step is not None and why in (PROCEDURE, HEAT) and deck.step.procedure is None:
        deck.step.procedure = card


def _pretty(hint: str) -> str:
    """Hint with the usual spelling: ``*END STEP`` for ``ENDSTEP``."""
    for plain in (*KEYWORDS, *IGNORED, *UNSUPPORTED, "INCLUDE"):
        if hint == f"did you mean {plain}?":
            return f"did you mean *{SPELLED.get(plain, plain)}?"
    return hint
