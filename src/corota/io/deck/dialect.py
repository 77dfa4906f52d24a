"""The program that a deck was written for, from cards that only one of them has."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from collections.abc import Iterable

from corota.io.deck.card import Card, key

#: Cards that Abaqus has and CalculiX has not.
OF_ABAQUS = frozenset(
    {
        "PART",
        "ASSEMBLY",
        "INSTANCE",
        "PREPRINT",
        "PARAMETER",
        "NGEN",
        "NFILL",
        "NCOPY",
        "ELGEN",
        "ELCOPY",
        "SYSTEM",
        "RELEASE",
        "CONNECTORSECTION",
        "SECTIONCONTROLS",
        "HOURGLASSSTIFFNESS",
        "TRANSVERSESHEARSTIFFNESS",
        "ENERGYOUTPUT",
        "BULKVISCOSITY",
        "MONITOR",
        "EMBEDDEDELEMENT",
        "CONTACT",
        "CONTACTINCLUSIONS",
        "MULLINSEFFECT",
        "VISCOELASTIC",
        "CONNECTORBEHAVIOR",
        "PRESSUREPENETRATION",
        "CONTACTINTERFERENCE",
    }
)
#: Types of elements that Abaqus has and CalculiX has not: hybrid ones, those with incompatible
#: modes, cubic and quadratic planar beams, rigid sides and connectors.
ELEMENTS_OF_ABAQUS = re.compile(
    r"CP[ES]\d(R?H|IH?|M|MH)|B2[23]H?|B33H?|PIPE2[12]H?|T2D3H?|R2D2|CONN2D2|DCOUP2D"
)
#: Parameters that Abaqus has and CalculiX has not, by card.
PARAMETERS_OF_ABAQUS = {
    "OUTPUT": ("FIELD", "HISTORY"),
    "BEAMSECTION": ("TEMPERATURE", "POISSON"),
    "BOUNDARY": ("TYPE",),
    "STEP": ("NAME",),
    "STATIC": ("RIKS", "STABILIZE"),
    "DYNAMIC": ("APPLICATION",),
    "RIGIDBODY": ("ANALYTICALSURFACE", "PINNSET", "TIENSET"),
}


#: Elements that CalculiX has and Abaqus has not.
ELEMENTS_OF_CALCULIX = re.compile(r"B3[12]R")
#: Parameters that CalculiX has and Abaqus has not, by card.
PARAMETERS_OF_CALCULIX = {"NODEFILE": "OUTPUT", "ELFILE": "OUTPUT", "STATIC": "SOLVER"}


def is_of_calculix(cards: Iterable[Card]) -> bool:
    """Whether a card, parameter or element is of CalculiX alone."""
    return any(
        card.has(PARAMETERS_OF_CALCULIX.get(card.keyword, "-"))
        or (
            card.keyword == "ELEMENT"
            and ELEMENTS_OF_CALCULIX.fullmatch(key(card.value("TYPE"))) is not None
        )
        for card in cards
    )


def find_dialect(cards: Iterable[Card]) -> str:
    """``"abaqus"`` if a card, parameter or element is of Abaqus alone, otherwise ``"calculix"``."""
    for card in cards:
        if card.keyword in OF_ABAQUS:
            return "abaqus"
        if card.keyword == "ELEMENT" and ELEMENTS_OF_ABAQUS.fullmatch(key(card.value("TYPE"))):
            return "abaqus"
        if card.keyword == "SURFACE" and key(card.value("TYPE")) == "SEGMENTS":
            return "abaqus"
        if any(card.has(name) for name in PARAMETERS_OF_ABAQUS.get(card.keyword, ())):
            return "abaqus"
    return "calculix"
