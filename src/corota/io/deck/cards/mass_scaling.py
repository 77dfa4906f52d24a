"""Mass scaling of explicit steps: sections with scaled density under the same weight."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.io.deck.build.change_sections import change_sections
from corota.io.deck.cards.step import open_step
from corota.io.deck.keywords import keyword
from corota.mesh.kinds import KINDS
from corota.mesh.parts import cells_of
from corota.model.material_table import MaterialTable
from corota.model.steps import Buckle, Static

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.card import Card
    from corota.io.deck.deck import Deck
    from corota.mesh.data import Mesh
    from corota.model.sections import Section

#: How the increment that is wanted changes masses.
TYPES = ("BELOWMIN", "UNIFORM", "SETEQUALDT")


@dataclass(eq=False, repr=False)
class MassScalingDraft:
    """One ``*FIXED MASS SCALING``: a factor of the mass, or an increment that is to be stable."""

    card: Card
    elset: str
    factor: float
    increment: float
    kind: str
    #: Step that it stands in, from 1.
    step: int


@keyword("FIXED MASS SCALING", "ELSET FACTOR DT TYPE", "FREQUENCY NUMBERINTERVAL")
@keyword("VARIABLE MASS SCALING", "ELSET FACTOR DT TYPE", "FREQUENCY NUMBERINTERVAL")
def mass_scaling(deck: Deck, card: Card) -> None:
    """``*FIXED MASS SCALING[, ELSET=][, FACTOR=][, DT=, TYPE=]``: heavier elements."""
    card.no_rows()
    now = open_step(deck, card)
    kind = card.choice("TYPE", TYPES, "BELOWMIN")
    factor, increment = card.number("FACTOR", 1.0, 0.0), card.number("DT", 0.0, 0.0)
    variable = card.keyword == "VARIABLEMASSSCALING"
    if now.options.get("scheme") != "central_difference":
        card.error("mass scaling belongs to *DYNAMIC, EXPLICIT before it in the step")
    elif factor == 0.0:
        card.error("FACTOR must be > 0", "FACTOR")
    elif variable and not increment:
        card.error("DT= is missing: the increment that is to be stable")
    elif factor != 1.0 or increment:
        if variable:
            card.note("masses are scaled once, at the start")
        name, step = card.value("ELSET"), len(deck.steps)
        draft = MassScalingDraft(card, name, factor, increment, kind, step)
        deck.later("sections", scale_masses, draft)


def scale_masses(targets: Targets, drafts: list[MassScalingDraft]) -> None:
    """Give sections the scaled density, and `targets` the factor of the mass of each cell."""
    card = drafts[0].card
    try:
        targets.mass_factor = _factors(targets, drafts)
    except InputError as error:
        card.error(error.message)


def _factors(targets: Targets, drafts: list[MassScalingDraft]) -> Floats:
    deck, model = targets.deck, targets.model
    factor = np.ones(model.mesh.n_cells)
    first = drafts[0].step
    kept = [d for d in drafts if d.step == first]
    early = any((s.make or Static) not in (Static, Buckle) for s in deck.steps[: first - 1])
    said = {_words(d) for d in kept}
    for draft in drafts:
        if early or _words(draft) not in said:
            draft.card.error(
                "masses are the same in all steps, but this one scales others than the first",
                hint="scale them in the first step that has inertia; later steps keep them",
            )
            return factor
    for draft in kept:
        cells = _cells(targets, draft)
        if cells is None:
            return factor
        factor[cells] *= draft.factor
        if draft.increment:
            found = _increments(targets, cells) * np.sqrt(factor[cells])
            ratio = (draft.increment / found) ** 2
            if draft.kind == "UNIFORM":
                ratio = np.full(len(cells), ratio.max())
            factor[cells] *= np.maximum(ratio, 1.0) if draft.kind == "BELOWMIN" else ratio
    change_sections(model, factor, 1.0, _heavier)
    heavier = factor[factor != 1.0]
    if len(heavier):
        deck.note(
            f"{kept[0].card.where}: {kept[0].card.spelled}: {len(heavier)} elements have "
            f"{heavier.min():.3g} to {heavier.max():.3g} times their mass in all steps, and their "
            "own weight"
        )
    return factor


def _words(draft: MassScalingDraft) -> tuple[str, float, float, str]:
    return draft.elset, draft.factor, draft.increment, draft.kind


def _cells(targets: Targets, draft: MassScalingDraft) -> Ints | None:
    if not draft.elset:
        return np.arange(targets.mesh.n_cells)
    view = targets.meshes.views[0]
    found = targets.sets.elements(view, draft.elset, draft.card.at("ELSET"), draft.card)
    return None if found is None else found.cells


def _heavier(section: Section, factor: float) -> Section:
    if isinstance(section.material, MaterialTable):
        raise InputError(
            f"the mass of material {section.material.name}, which depends on the temperature, is "
            "not scaled: scale its *DENSITY"
        )
    material = replace(section.material, rho=section.material.rho * factor)
    return replace(section, material=material)


def _increments(targets: Targets, cells: Ints) -> Floats:
    """Time that an elastic wave takes through each cell, shape (n,)."""
    model, found = targets.model, np.full(targets.mesh.n_cells, math.inf)
    for section in model.sections:
        if section.element.startswith("SPRING") or not section.material.rho:
            continue
        stiff = _stiffness(section)
        for cell in cells_of(model.mesh, section.cells).tolist():
            found[cell] = _height(model.mesh, cell) / math.sqrt(stiff / section.material.rho)
    return found[cells]


def _stiffness(section: Section) -> float:
    """Largest modulus of waves in the plane."""
    soft = section.material.compliance()
    if section.element in ("TRUSS", "BEAM"):
        return float(1.0 / soft[0, 0])
    rows = [0, 1, 3] if section.plane == "stress" else [0, 1, 2, 3]
    modulus = np.linalg.inv(soft[np.ix_(rows, rows)])
    return float(max(modulus[0, 0], modulus[1, 1]))


def _height(mesh: Mesh, cell: int) -> float:
    """Smallest distance of a side from the opposite one or corner; the length of a line."""
    block, row = mesh.locate(cell)
    corners = KINDS[mesh.cells[block].kind].n_corners
    x = mesh.points[mesh.cells[block].nodes[row]]
    if not corners:
        return math.dist(x[0], x[1])
    x = x[:corners]
    along = np.roll(x, -1, axis=0) - x
    area = 0.5 * abs(float((x[:, 0] * np.roll(x[:, 1], -1) - np.roll(x[:, 0], -1) * x[:, 1]).sum()))
    return area * (2.0 if corners == 3 else 1.0) / float(np.hypot(*along.T).max())
