"""Cards of viscoelasticity: ``*VISCOELASTIC, TIME=PRONY`` and ``*TRS``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.errors import InputError
from corota.io.deck.card import Card, complete, key
from corota.io.deck.cards.material import open_material
from corota.io.deck.keywords import keyword
from corota.model.material_table import MaterialTable
from corota.model.viscoelastic import WLF, Viscoelastic

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.model.materials import Material


@keyword("VISCOELASTIC", "TIME", place="model")
def viscoelastic(deck: Deck, card: Card) -> None:
    """``*VISCOELASTIC, TIME=PRONY``: g, k and tau of each term."""
    found = open_material(deck, card)
    if key(card.value("TIME")) != "PRONY":
        hint = "fit a Prony series to other data: rows of g, k, tau"
        card.refuse("viscoelasticity is given by TIME=PRONY", "TIME", hint)
    rows = []
    for row in card.lines("g, k, tau"):
        pair = [row.real(i, name, 0.0) for i, name in enumerate(("g", "k"))]
        g, k, tau = complete([*pair, row.real(2, "tau")])
        row.at_most(3)
        rows.append((g, k, tau))
    if found.prony_card is not None:
        card.refuse(f"material {found.name} already has a {card.spelled}")
    found.prony, found.prony_card = rows, card


@keyword("TRS", "DEFINITION", place="model")
def trs(deck: Deck, card: Card) -> None:
    """``*TRS[, DEFINITION=WLF]``: the temperature of the times, C1, C2."""
    found = open_material(deck, card)
    card.choice("DEFINITION", ("WLF",), "WLF")
    row = card.one_line("T0, C1, C2")
    at, c1, c2 = row.reals(("the temperature of the times", "C1", "C2"))
    try:
        found.shift = WLF(c1, c2, at)
    except InputError as error:
        row.error(1, error.message)


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
