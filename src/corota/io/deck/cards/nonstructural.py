"""``*NONSTRUCTURAL MASS``: added to the density of the material of its elements."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.io.deck.build.mesh import views_in
from corota.io.deck.build.targets import Targets
from corota.io.deck.keywords import keyword
from corota.mesh.parts import cells_of
from corota.mesh.shape_functions import shape_functions, shape_gradients
from corota.model.material_table import MaterialTable

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.io.deck.card import Card, Row
    from corota.io.deck.deck import Deck
    from corota.mesh.data import Mesh
    from corota.model.sections import Section

#: Elements without a mass of their own.
_MASSLESS = "SPRING"
#: Values of ``UNITS=`` of ``*NONSTRUCTURAL MASS``.
NONSTRUCTURAL = ("TOTALMASS", "MASSPERVOLUME", "MASSPERAREA", "MASSPERLENGTH")


@dataclass(eq=False, repr=False)
class NonstructuralDraft:
    """One ``*NONSTRUCTURAL MASS``: a mass in the elements of a set, without stiffness.

    ``units`` says what the value is per; a total is shared by mass, or ``by_volume``.
    """

    row: Row
    elset: str
    value: float
    units: str
    by_volume: bool = False


@keyword("NONSTRUCTURAL MASS", "ELSET UNITS DISTRIBUTION", place="model")
def nonstructural_mass(deck: Deck, card: Card) -> None:
    """``*NONSTRUCTURAL MASS, ELSET=, UNITS=[, DISTRIBUTION=]``: the mass, or its density."""
    elset = card.required("ELSET")
    units = card.required("UNITS") and card.choice("UNITS", NONSTRUCTURAL, "")
    kinds = ("MASSPROPORTIONAL", "VOLUMEPROPORTIONAL")
    share = card.choice("DISTRIBUTION", kinds, kinds[0])
    row = card.one_line("the mass", counted=True)
    row.at_most(1)
    value = row.number(0, "the mass")
    if not elset or not units:
        return
    if value < 0.0:
        row.refuse(0, f"a mass must be >= 0, not {value:g}")
    draft = NonstructuralDraft(row, elset, value, units, share == kinds[1])
    deck.later("sections", add_nonstructural, draft)


def add_nonstructural(targets: Targets, drafts: list[NonstructuralDraft]) -> None:
    """Give the cells of each ``*NONSTRUCTURAL MASS`` sections with more density."""
    deck = targets.deck
    for draft in drafts:
        card = draft.row.card
        for view in views_in(targets.meshes.views, deck, card.scope):
            found = targets.sets.elements(view, draft.elset, card.at("ELSET"), card)
            if found is None or not len(found.cells):
                continue
            try:
                _add(targets, draft, found.cells)
            except InputError as error:
                deck.error(card, card.where, error.message, text=draft.row.text)


def _add(targets: Targets, draft: NonstructuralDraft, cells: Ints) -> None:
    model, mesh = targets.model, targets.mesh
    mine: list[tuple[Section, Ints, Floats]] = []
    rest: list[Section] = []
    for section in model.sections:
        own = cells_of(mesh, section.cells)
        inside = np.isin(own, cells)
        if not inside.any() or section.element.startswith(_MASSLESS):
            rest.append(section)
            continue
        if isinstance(section.material, MaterialTable):
            raise InputError(
                f"material {section.material.name} depends on the temperature: add the mass to "
                "its *DENSITY"
            )
        if not inside.all():
            rest.append(replace(section, cells=own[~inside]))
        mine.append((section, own[inside], _volumes(mesh, section, own[inside])))
    if not mine:
        raise InputError(f"{draft.elset} holds no elements with a mass")
    total = sum(float(volume.sum()) for _, _, volume in mine)
    heavy = sum(s.material.rho * float(volume.sum()) for s, _, volume in mine)
    model.sections = rest
    for section, own, _ in mine:
        # A total is shared in proportion to the volume or to the mass that is there.
        if draft.units == "TOTALMASS" and draft.by_volume:
            extra = draft.value / total
        elif draft.units == "TOTALMASS":
            if heavy == 0.0:
                raise InputError("the elements have no mass: give DISTRIBUTION=VOLUME PROPORTIONAL")
            extra = draft.value * section.material.rho / heavy
        else:
            extra = _per_volume(draft, section)
        material = replace(section.material, rho=section.material.rho + extra)
        model.sections.append(replace(section, cells=own, material=material))


def _per_volume(draft: NonstructuralDraft, section: Section) -> float:
    """Density of a mass per volume, per area of a sheet, or per length of a line."""
    line = section.element in ("TRUSS", "BEAM")
    if draft.units == "MASSPERVOLUME":
        return draft.value
    if line != (draft.units == "MASSPERLENGTH"):
        what = "lines" if line else "sheets"
        wanted = "LENGTH" if line else "AREA"
        raise InputError(f"the elements are {what}: give UNITS=MASS PER {wanted} or VOLUME")
    if section.nodal_thickness is not None or section.axisymmetric:
        raise InputError("the elements have no one thickness: give UNITS=MASS PER VOLUME")
    return draft.value / (section.profile[0] if line else section.thickness)


def _volumes(mesh: Mesh, section: Section, cells: Ints) -> Floats:
    """Volumes of cells of one section, shape (n,); of solids of revolution of the circumference."""
    line = section.element in ("TRUSS", "BEAM")
    found = np.zeros(len(cells))
    for i, cell in enumerate(cells.tolist()):
        block, row = mesh.locate(cell)
        kind, nodes = mesh.cells[block].kind, mesh.cells[block].nodes[row]
        x = mesh.points[nodes]
        if line:
            found[i] = section.profile[0] * math.dist(x[0], x[1])
            continue
        at, weight = _points(kind)
        shape = shape_functions(kind, at)
        a, b = (shape_gradients(kind, at) @ x).swapaxes(0, 1)
        depth = np.full(len(at), section.thickness)
        if section.nodal_thickness is not None:
            depth = shape @ section.nodal_thickness[nodes]
        if section.axisymmetric:
            depth = 2.0 * math.pi * (shape @ x[:, 0])
        found[i] = weight @ (depth * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))
    return found


def _points(kind: str) -> tuple[Floats, Floats]:
    """Quadrature points of a cell kind and their weights."""
    t, w = np.polynomial.legendre.leggauss(4)
    x, y = (part.ravel() for part in np.meshgrid(t, t))
    weight = np.outer(w, w).ravel()
    if not kind.startswith("tri"):
        return np.stack([x, y], axis=1), weight
    # The square folded onto the triangle.
    u, v = 0.5 * (1.0 + x), 0.5 * (1.0 + y)
    return np.stack([u, v * (1.0 - u)], axis=1), 0.25 * weight * (1.0 - u)
