"""Cards of viscoelasticity: ``*VISCOELASTIC, TIME=PRONY`` and ``*TRS``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.errors import InputError
from corota.io.deck.cards.material import open_material
from corota.io.deck.lexer import Card, key
from corota.model.material_table import MaterialTable
from corota.model.viscoelastic import WLF, Viscoelastic

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.model.materials import Material


def viscoelastic(deck: Deck, card: Card) -> None:
    """``*VISCOELASTIC, TIME=PRONY``: g, k and tau of each term."""
    found = open_material(deck, card)
    if key(card.value("TIME")) != "PRONY":
        deck.error(
            card,
            card.at("TIME") if card.has("TIME") else card.where,
            "viscoelasticity is given by TIME=PRONY",
            hint="fit a Prony series to other data: rows of g, k, tau",
        )
        return
    rows = []
    for row in card.rows():
        values = [deck.real(card, row, i, name, 0.0) for i, name in enumerate(("g", "k"))]
        tau = deck.real(card, row, 2, "tau")
        if None in values or tau is None:
            return
        deck.extra_fields(card, row, 3)
        rows.append((float(values[0] or 0.0), float(values[1] or 0.0), tau))
    if found is None:
        return
    if not rows:
        deck.error(card, card.where, "a data line is missing: g, k, tau")
    elif found.prony_card is not None:
        deck.error(card, card.where, f"material {found.name} already has a {card.spelled}")
    else:
        found.prony, found.prony_card = rows, card


def trs(deck: Deck, card: Card) -> None:
    """``*TRS[, DEFINITION=WLF]``: the temperature of the times, C1, C2."""
    found = open_material(deck, card)
    deck.choice(card, "DEFINITION", ("WLF",), "WLF")
    rows = list(card.rows())
    if found is None:
        return
    if len(rows) != 1:
        deck.error(card, card.where, "one data line is expected: T0, C1, C2")
        return
    names = ("the temperature of the times", "C1", "C2")
    values = [deck.real(card, rows[0], i, name) for i, name in enumerate(names)]
    if any(v is None for v in values):
        return
    at, c1, c2 = (float(v or 0.0) for v in values)
    try:
        found.shift = WLF(c1, c2, at)
    except InputError as error:
        deck.row_error(card, rows[0], 1, error.message)


def build_viscoelastic(
    draft: MaterialDraft, parent: Material, temperature: float | None
) -> Viscoelastic:
    """The relaxing material of a draft with the constants of its other cards.

    Raises
    ------
    InputError
        With the place, where it does not go with the other cards, or a number is outside its range.
    """
    assert draft.prony_card is not None
    where = draft.prony_card.where
    if isinstance(parent, MaterialTable):
        raise InputError("a viscoelastic material has constants at one temperature", where)
    if draft.shift is not None and temperature is None:
        raise InputError(
            "*TRS follows one temperature of the whole model, by *INITIAL CONDITIONS, and none "
            "that changes in the steps",
            where,
        )
    return Viscoelastic(
        parent,
        draft.prony,
        "long term" if draft.moduli == "LONGTERM" else "instantaneous",
        draft.shift,
        temperature if draft.shift is not None else None,
        rho=parent.rho,
        rayleigh=parent.rayleigh,
        name=parent.name,
        where=where,
    )
