"""Materials of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.io.deck.cards.plastic import build_mises
from corota.io.deck.laws import LAWS
from corota.io.deck.lexer import key

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.model.materials import Material


def build_material(deck: Deck, draft: MaterialDraft) -> Material | None:
    """Material of a draft; ``None`` after an error."""
    if not draft.law:
        deck.error(draft.card, draft.card.where, f"material {draft.name} has no *ELASTIC below it")
        return None
    if draft.law_card is None:
        return None
    try:
        found = _law(draft) if draft.plastic is None else build_mises(deck, draft)
        if found is not None:
            found.expansion = draft.expansion
        return found
    except InputError as error:
        # Constants of a plastic material are checked with its curve, on the card of the curve.
        plastic = draft.plastic
        card = draft.law_card if plastic is None else plastic.card or plastic.cyclic_card
        deck.error(card, error.where or draft.law_where, error.message)
        return None


def _law(draft: MaterialDraft) -> Material:
    return LAWS[draft.law].make(
        *draft.constants,
        rho=draft.rho,
        rayleigh=draft.damping,
        name=draft.name,
        where=draft.law_where,
    )


def settle_temperature(deck: Deck, temperature: float | None) -> None:
    """Evaluate temperature-dependent constants at the uniform temperature of the model.

    Where it differs (``None``), such constants are refused.
    """
    for draft in deck.materials.values():
        if not draft.table or draft.law_card is None:
            continue
        if temperature is None:
            deck.error(
                draft.law_card,
                draft.law_where,
                "constants that depend on temperature need one temperature in the whole model; "
                "this deck changes it",
                hint="give one set of constants at a mean temperature",
            )
            draft.law_card = None
            continue
        table = np.array(sorted(draft.table, key=lambda row: row[-1]))
        draft.constants = [
            float(np.interp(temperature, table[:, -1], column)) for column in table[:, :-1].T
        ]
        deck.note(
            f"{draft.law_where}: the constants of {draft.name} are those at the temperature "
            f"{temperature:g}, which the whole model has"
        )


def share_damping(deck: Deck) -> None:
    """Damping that all used materials share becomes that of the model.

    Point masses then take part, as in CalculiX, which has one damping for the whole model.
    """
    scopes = [deck.root, *deck.parts.values()]
    names = {key(s.material) for scope in scopes for s in scope.sections}
    used = [m for name, m in deck.materials.items() if name in names]
    pairs = {m.damping for m in used}
    if len(pairs) != 1:
        if len(pairs) > 1:
            deck.note(
                "materials differ in *DAMPING: each damps its own elements (CalculiX takes the "
                "last pair for the whole model)"
            )
        return
    pair = pairs.pop()
    if pair == (0.0, 0.0):
        return
    for material in used:
        material.damping = (0.0, 0.0)
    for step in deck.steps:
        if step.options.get("rayleigh") == deck.damping:
            step.options["rayleigh"] = tuple(a + b for a, b in zip(pair, deck.damping, strict=True))
