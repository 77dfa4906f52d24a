"""Cards of user subroutines: ``*USER MATERIAL`` and ``*DEPVAR``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.errors import InputError
from corota.io.deck.cards.material import open_material
from corota.io.deck.keywords import keyword
from corota.model.compiled import Umat

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.card import Card
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.model.materials import Material

#: Constants on a data line.
PER_ROW = 8


@keyword("USER MATERIAL", "CONSTANTS TYPE", "UNSYMM", place="model")
def user_material(deck: Deck, card: Card) -> None:
    """``*USER MATERIAL, CONSTANTS=``: ``PROPS`` of the subroutine UMAT."""
    open_material(deck, card)
    card.choice("TYPE", ("MECHANICAL",), "MECHANICAL")
    count = card.integer("CONSTANTS", 0, 0)
    values: list[float] = []
    for row in card.rows():
        for column in range(min(PER_ROW, count - len(values))):
            values.append(row.number(column, f"constant {len(values) + 1}", 0.0))
        row.at_most(PER_ROW)
    found = open_material(deck, card, new_law=True)
    found.law, found.law_where = "USERMATERIAL", card.where
    if not card.has("CONSTANTS") or len(values) < count:
        text = "CONSTANTS= is the number of constants on the data lines; there are"
        card.refuse(f"{text} {len(values)}")
    if deck.library is None:
        card.refuse(
            f"material {found.name} is the code of a library, and no deck loads code by itself",
            hint="name a library that you trust: --allow-library PATH (Python: library=PATH)",
        )
    found.law_card, found.constants = card, [(0.0, values)]


@keyword("DEPVAR", ignored="DELETE", place="model")
def depvar(deck: Deck, card: Card) -> None:
    """``*DEPVAR``: number of solution-dependent state variables."""
    # Further lines are names for output.
    found, row = open_material(deck, card), card.lines("the number of state variables")[0]
    count = row.number(0, "the number of state variables")
    if count < 0 or count != int(count):
        row.refuse(0, f"a whole number >= 0 is expected, not {count:g}")
    found.states = int(count)


def build_umat(deck: Deck, draft: MaterialDraft, common: dict[str, Any]) -> Material:
    """The material of a draft with ``*USER MATERIAL``.

    Raises
    ------
    InputError
        If another card of the material does not go with it.
    """
    other = (draft.plastic, draft.rate_card, draft.prony_card, draft.johnson_cook)
    if any(part is not None for part in other) or draft.expansion:
        raise InputError(
            "*USER MATERIAL stands alone: its subroutine gives the whole stress", draft.law_where
        )
    assert deck.library is not None
    return Umat(deck.library, draft.constants[0][1], draft.states, **common)


def user_material_cards(material: Umat, number: Callable[[float], str]) -> str:
    """The cards of a UMAT; the library is named on the command line."""
    values = [number(v) for v in material.constants]
    rows = [values[i : i + PER_ROW] for i in range(0, len(values), PER_ROW)]
    text = f"*USER MATERIAL, CONSTANTS={len(values)}\n"
    text += "".join(", ".join(row) + "\n" for row in rows)
    return text + (f"*DEPVAR\n{material.states}\n" if material.states else "")
