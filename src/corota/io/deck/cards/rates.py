"""Cards of materials that depend on the time: ``*RATE DEPENDENT``, ``*CREEP``, heat; ``*VISCO``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.errors import InputError
from corota.io.deck.card import Card, key
from corota.io.deck.cards.material import open_material
from corota.io.deck.cards.step import open_procedure, step_times
from corota.io.deck.keywords import keyword
from corota.model.johnson_cook import JohnsonCook
from corota.model.rates import CowperSymonds, Norton, YieldRatio
from corota.model.steps import Visco

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.model.materials import Material

#: Values of ``TYPE=`` of ``*RATE DEPENDENT``.
RATE_TYPES = ("POWERLAW", "YIELDRATIO", "JOHNSONCOOK")
#: Values of ``LAW=`` of ``*CREEP``, and the hardening they mean.
CREEP_LAWS = {"NORTON": "time", "TIME": "time", "STRAIN": "strain"}
#: Names of the constants of ``*PLASTIC, HARDENING=JOHNSON COOK``.
JOHNSON_COOK = ("A", "B", "n", "m", "the melting temperature", "the transition temperature")


def _rows(card: Card, names: Sequence[str], required: int) -> list[list[float]]:
    """Numbers of all data lines, the last of them optional."""
    found = []
    for row in card.lines(", ".join(names)):
        found.append(row.reals(names, 0.0, required=required))
        row.at_most(len(names))
    return found


def _one(card: Card, names: Sequence[str], required: int) -> list[float]:
    """Numbers of the one data line."""
    rows = _rows(card, names, required)
    if len(rows) > 1:
        list(card.rows())[1].refuse(0, "one data line is expected")
    return rows[0]


def _set_rate(deck: Deck, card: Card, make: Callable[[], Any]) -> None:
    """Give the open material a rate, which it may have once."""
    found = open_material(deck, card)
    if found.rate_card is not None:
        card.refuse(f"material {found.name} already has a {found.rate_card.spelled}")
    found.rate_card = card
    found.rate = make()


@keyword("RATE DEPENDENT", "TYPE", place="model")
def rate_dependent(deck: Deck, card: Card) -> None:
    """``*RATE DEPENDENT[, TYPE=]``: D and n; ratios and rates; or C and a rate."""
    kind = card.choice("TYPE", RATE_TYPES, "POWERLAW")
    if kind == "YIELDRATIO":
        rows = _rows(card, ("the ratio", "the rate"), 1)
        _set_rate(deck, card, lambda: YieldRatio([(r, p) for r, p in rows]))
    elif kind == "JOHNSONCOOK":
        pair = tuple(_one(card, ("C", "the rate"), 2))
        _set_rate(deck, card, lambda: pair)
    else:
        rate, exponent, _ = _one(card, ("D", "n", "the temperature"), 2)
        _set_rate(deck, card, lambda: CowperSymonds(rate, exponent))


@keyword("CREEP", "LAW", place="model")
def creep(deck: Deck, card: Card) -> None:
    """``*CREEP[, LAW=]``: A, n, m, temperature."""
    law = CREEP_LAWS[card.choice("LAW", tuple(CREEP_LAWS), "NORTON")]
    rows = _rows(card, ("A", "n", "m", "the temperature"), 2)
    found = open_material(deck, card)
    if any(row[2] for row in rows) and not card.has("LAW"):
        deck.note(
            f"{card.where}: {card.spelled} without LAW= hardens with the time, as in CalculiX"
        )
    if len({row[3] for row in rows}) != len(rows):
        hint = "each set of A, n and m needs its own temperature, after m"
        card.refuse("a temperature is given twice", hint=hint)

    def make() -> Norton:
        laws = [(t, Norton(a, n, m, law)) for a, n, m, t in rows]  # type: ignore[arg-type]
        found.creep = sorted(laws, key=lambda row: row[0])
        return laws[0][1]

    _set_rate(deck, card, make)


def johnson_cook(deck: Deck, card: Card) -> None:
    """``*PLASTIC, HARDENING=JOHNSON COOK``: A, B, n, m and two temperatures."""
    found, numbers = open_material(deck, card), _one(card, JOHNSON_COOK, 3)
    if found.johnson_cook is not None or found.plastic is not None:
        card.refuse(f"material {found.name} already has a *PLASTIC")
    found.johnson_cook, found.johnson_cook_card = numbers, card


@keyword("SPECIFIC HEAT", place="model")
def specific_heat(deck: Deck, card: Card) -> None:
    """``*SPECIFIC HEAT``: heat by mass and temperature; for adiabatic heating."""
    found = open_material(deck, card)
    rows = _rows(card, ("the specific heat", "the temperature"), 1)
    if len(rows) > 1:
        card.note(f"the first of {len(rows)} values is used")
    found.specific_heat = rows[0][0]


@keyword("INELASTIC HEAT FRACTION", place="model")
def heat_fraction(deck: Deck, card: Card) -> None:
    """``*INELASTIC HEAT FRACTION``: share of the plastic work that heats, by default 0.9."""
    found, row = open_material(deck, card), next(card.rows(), None)
    found.heat_fraction = 0.9 if row is None else row.number(0, "the fraction", 0.9)


@keyword("VISCO", "DIRECT CETOL", "SOLVER")
def visco(deck: Deck, card: Card) -> None:
    """``*VISCO[, CETOL=][, DIRECT]``: first increment, period, smallest and largest increment."""
    now = open_procedure(deck, card)
    now.make, now.direct = Visco, card.has("DIRECT")
    step_times(card, now)
    tolerance = card.number("CETOL", 0.0, 0.0) if card.has("CETOL") else None
    # Without AMPLITUDE=RAMP the loads of such a step act at once.
    ramp = key(now.card.value("AMPLITUDE")) == "RAMP"
    now.options = {"ramp": ramp, "creep_tolerance": tolerance, **deck.controls}


def build_johnson_cook(
    draft: MaterialDraft, elastic: tuple[float, float], heated: bool, **common: Any
) -> Material:
    """The material of ``*PLASTIC, HARDENING=JOHNSON COOK``.

    Parameters
    ----------
    elastic : tuple of float
        Young's modulus and Poisson's ratio.
    heated : bool
        Whether the model has temperatures.
    **common
        What all materials have.

    Raises
    ------
    InputError
        With the place, where a number is outside its range.
    """
    assert draft.johnson_cook is not None
    assert draft.johnson_cook_card is not None
    if draft.law != "ISOTROPIC":
        raise InputError(
            "*PLASTIC needs isotropic constants in *ELASTIC", draft.johnson_cook_card.where
        )
    a, b, n, m, melting, transition = draft.johnson_cook
    options: dict[str, Any] = {}
    if m and melting > transition:
        options = {"m": m, "melting": melting, "transition": transition}
        options |= {"heat_fraction": draft.heat_fraction, "specific_heat": draft.specific_heat}
    if draft.rate_card is not None:
        if not isinstance(draft.rate, tuple):
            raise InputError(
                "Johnson-Cook hardening goes with *RATE DEPENDENT, TYPE=JOHNSON COOK",
                draft.rate_card.where,
            )
        options |= {"C": draft.rate[0], "rate": draft.rate[1]}
    common["where"] = draft.johnson_cook_card.where
    e, nu = elastic
    found = JohnsonCook(e, nu, A=a, B=b, n=n, rho=draft.rho, **options, **common)
    return found.with_temperatures() if heated and found.melting is not None else found
