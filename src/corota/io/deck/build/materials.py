"""Materials of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.io.deck.cards.plastic import build_mises
from corota.io.deck.lexer import key
from corota.model.materials import Elastic, Orthotropic

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
        # Constants of a plastic material are judged with its curve, on the card of the curve.
        plastic = draft.plastic
        card = draft.law_card if plastic is None else plastic.card or plastic.cyclic_card
        deck.error(card, error.where or draft.law_where, error.message)
        return None


def _law(draft: MaterialDraft) -> Material:
    c = draft.constants
    common = _common(draft)
    if draft.law == "ISOTROPIC":
        return Elastic(c[0], c[1], **common)
    if draft.law == "LAMINA":
        # A lamina says nothing of the third direction: it is taken as the second one.
        values = [c[0], c[1], c[1], c[2], c[2], 0.0, c[3]]
    elif draft.law == "ENGINEERINGCONSTANTS":
        values = c[:7]
    else:
        values = _from_stiffness(draft)
    return Orthotropic(*values, **common)


def _common(draft: MaterialDraft) -> dict[str, Any]:
    """What a draft says that all materials have."""
    return {
        "rho": draft.rho,
        "rayleigh": draft.damping,
        "name": draft.name,
        "where": draft.law_where,
    }


def settle_temperature(deck: Deck, temperature: float | None) -> None:
    """Take constants that depend on temperature at the one that the whole model has.

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
    """Damping that all used materials have alike becomes that of the model.

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


def _from_stiffness(draft: MaterialDraft) -> list[float]:
    """Engineering constants from D1111, D1122, D2222, D1133, D2233, D3333, D1212."""
    d11, d12, d22, d13, d23, d33, g12 = draft.constants[:7]
    stiffness = np.array([[d11, d12, d13], [d12, d22, d23], [d13, d23, d33]])
    if not np.all(np.linalg.eigvalsh(stiffness) > 0.0):
        raise InputError("the stiffness is not positive definite", draft.law_where)
    s = np.linalg.inv(stiffness)
    e1, e2, e3 = 1.0 / np.diag(s)
    return [e1, e2, e3, -s[0, 1] * e1, -s[0, 2] * e1, -s[1, 2] * e2, g12]
