"""Cards of hyperelastic laws: constants, or tests that they are fitted to."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.io.deck.cards.material import constants, moduli, open_material
from corota.model import hyperelastic as rubber

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.io.deck.lexer import Card

#: Class of each kind.
CLASSES: dict[str, Any] = {
    "NEOHOOKE": rubber.NeoHooke,
    "MOONEY-RIVLIN": rubber.MooneyRivlin,
    "YEOH": rubber.Yeoh,
    "ARRUDA-BOYCE": rubber.ArrudaBoyce,
    "POLYNOMIAL": rubber.Polynomial,
    "REDUCEDPOLYNOMIAL": rubber.Polynomial,
    "OGDEN": rubber.Ogden,
    "HYPERFOAM": rubber.Hyperfoam,
}
#: Largest number of terms, where there are several.
MOST = {"POLYNOMIAL": 3, "REDUCEDPOLYNOMIAL": 3, "OGDEN": rubber.MAX_TERMS}
MOST["HYPERFOAM"] = rubber.MAX_TERMS


def hyperelastic(deck: Deck, card: Card) -> None:
    """``*HYPERELASTIC, kind[, N=][, TEST DATA INPUT[, POISSON=]]``."""
    given = [kind for kind in CLASSES if card.has(kind)]
    if len(given) > 1:
        deck.error(card, card.at(given[1]), f"{given[0]} and {given[1]} are both given")
        return
    kind = given[0] if given else "POLYNOMIAL"
    _law(deck, card, kind)


def hyperfoam(deck: Deck, card: Card) -> None:
    """``*HYPERFOAM[, N=][, TEST DATA INPUT[, POISSON=]]``."""
    _law(deck, card, "HYPERFOAM")


def _law(deck: Deck, card: Card, kind: str) -> None:
    moduli(deck, card)
    most = MOST.get(kind, 0)
    count = deck.parameter_integer(card, "N", 1, 1) if most else 0
    if count > most:
        deck.error(card, card.at("N"), f"{kind} has at most {most} terms, not {count}")
        return
    name = f"{kind}{count or ''}"
    if not card.has("TESTDATAINPUT"):
        if card.has("POISSON"):
            deck.error(card, card.at("POISSON"), "POISSON= goes with TEST DATA INPUT")
            return
        constants(deck, card, name)
        return
    deck.no_rows(card)
    found = open_material(deck, card)
    if found is None:
        return
    if found.law:
        deck.error(
            card, card.where, f"material {found.name} already has constants ({found.law_where})"
        )
        return
    found.law, found.law_where, found.law_card = name, card.where, card
    ratio = deck.parameter_number(card, "POISSON", 0.0, 0.0)
    if ratio >= 0.5:
        deck.error(card, card.at("POISSON"), f"POISSON= must be less than 0.5, not {ratio:g}")
        return
    found.fit = (kind, count, ratio)


def test_data(deck: Deck, card: Card, test: str) -> None:
    """``*UNIAXIAL TEST DATA``, ``*BIAXIAL ...``, ``*PLANAR ...``: nominal stress and strain."""
    found = open_material(deck, card)
    rows = []
    for row in card.rows():
        deck.extra_fields(card, row, 2)
        stress = deck.real(card, row, 0, "the nominal stress")
        strain = deck.real(card, row, 1, "the nominal strain")
        if stress is None or strain is None:
            return
        rows.append((stress, strain))
    if not rows:
        deck.error(card, card.where, "data lines are missing: nominal stress, nominal strain")
    elif found is not None and found.fit is None:
        deck.error(
            card,
            card.where,
            "test data belong below *HYPERELASTIC or *HYPERFOAM with TEST DATA INPUT",
        )
    elif found is not None:
        found.tests.setdefault(test, []).extend(rows)


def fitted(draft: MaterialDraft, common: dict[str, Any]) -> rubber.Hyperelastic:
    """The law that a material's tests give.

    Raises
    ------
    InputError
        If there are no data, or no constants fit them.
    """
    assert draft.fit is not None
    kind, count, ratio = draft.fit
    more = dict(common)
    if count:
        more["terms"] = count
    if kind == "HYPERFOAM":
        more["nu"] = ratio
    elif kind.endswith("POLYNOMIAL"):
        more["reduced"] = kind.startswith("REDUCED")
    law: rubber.Hyperelastic = CLASSES[kind].fit(**draft.tests, **more)
    return law.with_ratio(ratio) if ratio and kind != "HYPERFOAM" else law


__all__ = ["fitted", "hyperelastic", "hyperfoam", "test_data"]
