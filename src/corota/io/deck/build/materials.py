"""Materials of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.io.deck.card import key
from corota.io.deck.cards.hyperelastic import build_mullins, fitted
from corota.io.deck.laws import LAWS
from corota.lazy import lazy
from corota.model.material_table import MaterialTable
from corota.model.plasticity import Mises
from corota.model.rates import Norton, Rate, RateCurves

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.model.materials import Material

build_mises = lazy("corota.io.deck.cards.plastic:build_mises")
build_viscoelastic = lazy("corota.io.deck.cards.viscoelastic:build_viscoelastic")
build_umat = lazy("corota.io.deck.cards.user_material:build_umat")
build_johnson_cook = lazy("corota.io.deck.cards.rates:build_johnson_cook")


#: Law of a draft whose material is a subroutine.
USER_LAW = "USERMATERIAL"


def build_material(deck: Deck, draft: MaterialDraft, temperature: float | None) -> Material | None:
    """Material of a draft; ``None`` after an error.

    Constants by temperature are taken at the one `temperature` that the whole model has, if it has
    one.
    """
    if not draft.law:
        draft.card.error(f"material {draft.name} has no *ELASTIC below it")
        return None
    if draft.law_card is None:
        return None
    if (draft.specific_heat or draft.heat_fraction) and draft.johnson_cook is None:
        deck.note(
            f"{draft.card.where}: the heat of material {draft.name} has no effect: plastic work "
            "heats *PLASTIC, HARDENING=JOHNSON COOK alone, and there is no conduction"
        )
    try:
        if draft.law == USER_LAW:
            common = {"name": draft.name, "where": draft.law_where, "rho": draft.rho}
            return build_umat(deck, draft, common | {"rayleigh": draft.damping})  # type: ignore[no-any-return]
        found = _by_temperature(draft)
        if draft.softening_card is not None and found is not None:
            return build_mullins(draft, found)
        if draft.prony_card is not None and found is not None:
            relaxing: Material = build_viscoelastic(draft, found, temperature)
            return relaxing
        if found is None or not isinstance(found, MaterialTable) or temperature is None:
            return found
        deck.note(
            f"{draft.law_where}: the constants of {draft.name} are those at the temperature "
            f"{temperature:g}, which the whole model has"
        )
        return found.at(temperature)
    except InputError as error:
        # Constants of a plastic material are checked with its curve, on the card of the curve.
        plastic = draft.plastic
        card = draft.law_card if plastic is None else plastic.card or plastic.cyclic_card
        card = draft.johnson_cook_card or draft.softening_card or draft.prony_card or card
        deck.error(card, error.where or draft.law_where, error.message)
        return None


def _by_temperature(draft: MaterialDraft) -> Material | None:
    """The material, or its table over the temperatures at which any of its cards has numbers."""
    common: dict[str, Any] = {
        "rayleigh": draft.damping,
        "name": draft.name,
        "where": draft.law_where,
        "expansion": draft.expansion,
    }
    if draft.fit is not None:
        return fitted(draft, common | {"rho": draft.rho})
    law = LAWS[draft.law]
    sets = sorted(draft.constants)
    given = [t for t, _ in sets]
    columns = np.array([values for _, values in sets]).T

    def constants(at: float) -> list[float]:
        return [float(np.interp(at, given, column)) for column in columns]

    if draft.johnson_cook is not None:
        e, nu = constants(given[0])[:2]
        johnson: Material = build_johnson_cook(draft, (e, nu), True, **common)
        return johnson
    rate_of = _rate(draft)
    if draft.potential_card is not None and draft.plastic is None:
        raise InputError(
            "*POTENTIAL needs *PLASTIC in the same material", draft.potential_card.where
        )
    if draft.plastic is None and rate_of is not None:
        rows: list[tuple[float, Material]] = [
            (t, Mises(constants(t)[0], constants(t)[1], rate=rate_of(t), **common)) for t in given
        ]
    elif draft.plastic is None:
        # Interpolated stiffnesses do not give linearly interpolated constants.
        fine = [t for a, b in pairwise(given) for t in np.linspace(a, b, law.pieces + 1)[:-1]]
        temperatures = [float(t) for t in (*fine, *given[-1:])]
        rows = [(t, law.make(*constants(t), **common)) for t in temperatures]
    else:
        plastic = build_mises(draft, lambda at: (constants(at)[0], constants(at)[1]), **common)
        if plastic is None:
            return None
        rows = list(plastic)
        if rate_of is not None:
            rows = [(t, replace(m, rate=rate_of(t))) for t, m in plastic]
    density = sorted(draft.densities)
    every = set(given if len(given) > 1 else ())
    every |= {t for t, _ in density} if len(density) > 1 else set()
    every |= {t for t, _ in rows} if len(rows) > 1 else set()
    every |= {t for t, _ in draft.creep} if len(draft.creep) > 1 else set()
    if not every:
        return replace(rows[0][1], rho=draft.rho)
    table = MaterialTable(rows, **common)
    whole: list[tuple[float, Material]] = []
    for t in sorted(every):
        own: dict[str, Any] = {"rho": draft.rho}
        if len(density) > 1:
            own["rho"] = float(np.interp(t, *np.array(density).T))
        if rate_of is not None:
            own["rate"] = rate_of(t)
        if draft.plastic is not None or rate_of is not None:
            own |= dict(zip(("E", "nu"), constants(t), strict=True))
        whole.append((t, replace(table.at(t), **own)))
    return MaterialTable(whole, **common)


def _rate(draft: MaterialDraft) -> Callable[[float], Rate] | None:
    """Rate of the plastic flow or creep at a temperature; ``None`` where there is none.

    Raises
    ------
    InputError
        If it does not go with the other cards of the material.
    """
    rated = sorted(draft.plastic.rated) if draft.plastic is not None else []
    card = draft.rate_card
    if card is None:
        if not rated:
            return None
        # The lowest curve is that of smaller rates too.
        curves = RateCurves(rated[1:] if rated[0][0] == 0.0 else rated)
        return lambda _: curves
    if rated:
        raise InputError("the curves of *PLASTIC, RATE= have the rate already", card.where)
    if draft.law != "ISOTROPIC":
        raise InputError(f"{card.spelled} needs isotropic constants in *ELASTIC", card.where)
    if isinstance(draft.rate, tuple):
        raise InputError("TYPE=JOHNSON COOK goes with *PLASTIC, HARDENING=JOHNSON COOK", card.where)
    if draft.plastic is None and not draft.creep:
        raise InputError(f"{card.spelled} needs *PLASTIC in the same material", card.where)
    if not draft.creep:
        constant: Rate = draft.rate
        return lambda _: constant
    first = draft.creep[0][1]
    temperatures = [t for t, _ in draft.creep]
    columns = np.array([(law.A, law.n, law.m) for _, law in draft.creep]).T

    def creep(at: float) -> Norton:
        a, n, m = (float(np.interp(at, temperatures, column)) for column in columns)
        return Norton(a, n, m, first.hardening)

    return creep


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
