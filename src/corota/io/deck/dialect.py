"""The program that a deck was written for, from cards that only one of them has."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from corota.io.deck.lexer import Card

#: Cards that Abaqus has and CalculiX has not.
OF_ABAQUS = frozenset({"PART", "ASSEMBLY", "INSTANCE", "PREPRINT"})
#: Parameters that Abaqus has and CalculiX has not, by card.
PARAMETERS_OF_ABAQUS = {
    "OUTPUT": ("FIELD", "HISTORY"),
    "BEAMSECTION": ("TEMPERATURE", "POISSON"),
}


def find_dialect(cards: Iterable[Card]) -> str:
    """``"abaqus"`` if a card or parameter is of Abaqus alone, otherwise ``"calculix"``."""
    for card in cards:
        if card.keyword in OF_ABAQUS:
            return "abaqus"
        if any(card.has(name) for name in PARAMETERS_OF_ABAQUS.get(card.keyword, ())):
            return "abaqus"
    return "calculix"
