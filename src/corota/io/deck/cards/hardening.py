"""Initial equivalent plastic strain: yield curves that begin further on."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.io.deck.build.change_sections import change_sections
from corota.io.deck.card import complete
from corota.io.deck.drafts import Draft
from corota.model.plasticity import Mises, Voce

if TYPE_CHECKING:
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.card import Card
    from corota.io.deck.deck import Deck
    from corota.model.sections import Section


def initial_hardening(deck: Deck, card: Card) -> None:
    """Element or set, equivalent plastic strain; back-stresses must be zero."""
    for row in card.rows():
        values = [row.real(1, "the equivalent plastic strain")]
        values += [row.real(i, "the back-stress", 0.0) for i in range(2, len(row))]
        strain, *back = complete(values)
        if any(back):
            row.error(2, "initial back-stresses are not part of this version")
        elif strain < 0.0:
            row.error(1, f"it must be >= 0, not {strain:g}")
        elif not row.get(0):
            row.error(0, "an element number or a set is missing")
        else:
            deck.later("sections", harden, Draft("hardening", row, row.get(0), (strain,)))


def harden(targets: Targets, drafts: list[Draft]) -> None:
    """Give cells with an initial plastic strain the yield curve from there on."""
    deck, strain = targets.deck, np.zeros(targets.mesh.n_cells)
    for draft in drafts:
        found = targets.cells_of(draft)
        if found is not None:
            strain[found.cells] = draft.value[0]
    card = drafts[0].card
    try:
        change_sections(targets.model, strain, 0.0, _hardened)
    except InputError as error:
        card.error(error.message)
    deck.note(f"{card.where}: {card.spelled}, TYPE=HARDENING: PEEQ is without the initial one")


def _hardened(section: Section, strain: float) -> Section:
    material = section.material
    if (
        not isinstance(material, Mises)
        or material.kinematic
        or material.chaboche
        or material.rate is not None
    ):
        raise InputError(
            f"initial hardening of material {material.name or section.element} needs *PLASTIC with "
            "isotropic hardening, without rate or temperature"
        )
    if material.yield_curve is not None:
        stress, plastic = np.array(material.yield_curve, float).T
        first = float(np.interp(strain, plastic, stress))
        later = plastic > strain
        curve = [(first, 0.0)]
        curve += [(s, p - strain) for s, p in zip(stress[later], plastic[later], strict=True)]
        return replace(section, material=replace(material, yield_curve=curve, rows=()))
    start, law = float(material.yield_stress or 0.0), material.isotropic
    if isinstance(law, Voce):
        left = math.exp(-law.b * strain)
        start += law.Q * (1.0 - left)
        law = replace(law, Q=law.Q * left)
    else:
        start += law * strain
    return replace(section, material=replace(material, yield_stress=start, isotropic=law))
