"""Cards of hyperelastic laws: constants, or tests that they are fitted to."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.errors import InputError
from corota.io.deck.cards.material import constants, moduli, open_material
from corota.io.deck.keywords import keyword
from corota.model import hyperelastic as rubber
from corota.model.mullins import Mullins

if TYPE_CHECKING:
    from corota.io.deck.card import Card
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.model.materials import Material

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


@keyword(
    "HYPERELASTIC",
    "NEOHOOKE MOONEY-RIVLIN YEOH ARRUDA-BOYCE POLYNOMIAL REDUCEDPOLYNOMIAL OGDEN N "
    "TESTDATAINPUT POISSON MODULI",
    place="model",
)
def hyperelastic(deck: Deck, card: Card) -> None:
    """``*HYPERELASTIC, kind[, N=][, TEST DATA INPUT[, POISSON=]]``."""
    given = [kind for kind in CLASSES if card.has(kind)]
    if len(given) > 1:
        card.refuse(f"{given[0]} and {given[1]} are both given", given[1])
    _law(deck, card, given[0] if given else "POLYNOMIAL")


@keyword("HYPERFOAM", "N TESTDATAINPUT POISSON MODULI", place="model")
def hyperfoam(deck: Deck, card: Card) -> None:
    """``*HYPERFOAM[, N=][, TEST DATA INPUT[, POISSON=]]``."""
    _law(deck, card, "HYPERFOAM")


def _law(deck: Deck, card: Card, kind: str) -> None:
    moduli(deck, card)
    most = MOST.get(kind, 0)
    count = card.integer("N", 1, 1) if most else 0
    if count > most:
        card.refuse(f"{kind} has at most {most} terms, not {count}", "N")
    name = f"{kind}{count or ''}"
    if not card.has("TESTDATAINPUT"):
        if card.has("POISSON"):
            card.refuse("POISSON= goes with TEST DATA INPUT", "POISSON")
        constants(deck, card, name)
        return
    card.no_rows()
    found = open_material(deck, card, new_law=True)
    found.law, found.law_where, found.law_card = name, card.where, card
    ratio = card.number("POISSON", 0.0, 0.0)
    if ratio >= 0.5:
        card.refuse(f"POISSON= must be less than 0.5, not {ratio:g}", "POISSON")
    found.fit = (kind, count, ratio)


@keyword("UNIAXIAL TEST DATA", place="model")
@keyword("BIAXIAL TEST DATA", place="model")
@keyword("PLANAR TEST DATA", place="model")
def test_data(deck: Deck, card: Card) -> None:
    """``*UNIAXIAL TEST DATA``, ``*BIAXIAL ...``, ``*PLANAR ...``: nominal stress and strain."""
    found = open_material(deck, card)
    rows = []
    for row in card.rows():
        row.at_most(2)
        stress, strain = row.reals(("the nominal stress", "the nominal strain"))
        rows.append((stress, strain))
    if not rows:
        card.error("data lines are missing: nominal stress, nominal strain")
    elif found.fit is None:
        card.error("test data belong below *HYPERELASTIC or *HYPERFOAM with TEST DATA INPUT")
    else:
        found.tests.setdefault(card.keyword.removesuffix("TESTDATA").lower(), []).extend(rows)


@keyword("MULLINS EFFECT", place="model")
def mullins_effect(deck: Deck, card: Card) -> None:
    """``*MULLINS EFFECT``: r, m and beta of the softening of the open hyperelastic material."""
    found = open_material(deck, card)
    row = card.one_line("r, m, beta")
    row.at_most(3)
    r, m, beta = row.reals(("r", "m", "beta"), 0.0, required=2)
    if found.softening_card is not None:
        card.refuse(f"material {found.name} already has a {card.spelled}")
    found.softening, found.softening_card = (r, m, beta), card


def build_mullins(draft: MaterialDraft, parent: Material) -> Mullins:
    """The softening material of a draft with the constants of its other cards.

    Raises
    ------
    InputError
        With the place, where it does not go with the other cards, or a number is outside its range.
    """
    from corota.model.material_table import MaterialTable

    assert draft.softening is not None
    assert draft.softening_card is not None
    where = draft.softening_card.where
    if draft.prony_card is not None:
        raise InputError("a material that softens does not relax: use one of both cards", where)
    if isinstance(parent, MaterialTable):
        raise InputError("a material that softens has constants at one temperature", where)
    if not isinstance(parent, rubber.Hyperelastic):
        raise InputError("it belongs below *HYPERELASTIC or *HYPERFOAM", where)
    return Mullins(
        parent,
        *draft.softening,
        rho=parent.rho,
        expansion=parent.expansion,
        rayleigh=parent.rayleigh,
        name=parent.name,
        where=where,
    )


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
