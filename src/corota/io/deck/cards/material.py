"""Cards of materials, sections and orientations."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from contextlib import suppress
from typing import TYPE_CHECKING

from corota.io.deck import numerals
from corota.io.deck.card import Card, Refused, Row, both, key
from corota.io.deck.cards.distribution import plane_angle
from corota.io.deck.cards.step import turns_nlgeom_on
from corota.io.deck.drafts import Draft, MaterialDraft, SectionDraft
from corota.io.deck.keywords import keyword
from corota.io.deck.laws import LAWS, DeckLaw
from corota.model.local_strain import ALIASES, LOCAL_STRAINS, local_strain

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck

#: Values of ``TYPE=`` of ``*ELASTIC``, and their laws.
ELASTIC_TYPES = {
    "": "ISOTROPIC",
    "ISO": "ISOTROPIC",
    "ISOTROPIC": "ISOTROPIC",
    "ORTHO": "ORTHOTROPIC",
    "ORTHOTROPIC": "ORTHOTROPIC",
    "ENGINEERINGCONSTANTS": "ENGINEERINGCONSTANTS",
    "LAMINA": "LAMINA",
}

#: Poisson's ratio that stands for the constant volume of hybrid elements of Abaqus: a bulk modulus
#: of 10^4 times the shear modulus.
HYBRID_RATIO = 29998.0 / 60002.0


@keyword("MATERIAL", "NAME", place="model")
def material(deck: Deck, card: Card) -> None:
    """``*MATERIAL, NAME=``: opens a material for the cards below it."""
    name = card.required("NAME") or f"unnamed material of line {card.where.line}"
    card.no_rows()
    if key(name) in deck.materials:
        first = deck.materials[key(name)].card.where
        card.error(f"material {name} is already defined in {first}", "NAME")
    deck.material = MaterialDraft(name, card)
    deck.materials.setdefault(key(name), deck.material)


@keyword("ELASTIC", "TYPE MODULI DEPENDENCIES", place="model")
def elastic(deck: Deck, card: Card) -> None:
    """``*ELASTIC[, TYPE=]``: the constants of the law."""
    law = ELASTIC_TYPES.get(key(card.value("TYPE")))
    if law is None:
        card.choice("TYPE", ("ISO", "ORTHO", "ENGINEERING CONSTANTS", "LAMINA"), "")
        return
    moduli(deck, card)
    constants(deck, card, law)
    if law == "ISOTROPIC" and deck.dialect == "abaqus" and deck.material is not None:
        for _, values in deck.material.constants:
            if values[1] == 0.5:
                values[1] = HYBRID_RATIO
                deck.note(f"{card.where}: Poisson's ratio 0.5 is taken as {HYBRID_RATIO:.5g}")


def moduli(deck: Deck, card: Card) -> None:
    """``MODULI=``: whether constants are those at once, or after a viscoelastic body relaxed."""
    kind = card.choice("MODULI", ("LONGTERM", "INSTANTANEOUS"), "LONGTERM")
    if deck.material is not None:
        deck.material.moduli = kind


def constants(deck: Deck, card: Card, law: str) -> None:
    """The constants of a law of :data:`LAWS`, for the open material."""
    open_material(deck, card)
    rows = card.lines(", ".join(LAWS[law].constants))
    found = open_material(deck, card, new_law=True)
    found.law, found.law_where = law, rows[0].where
    if law == "DEFORMATIONPLASTICITY":
        turns_nlgeom_on(deck, card.spelled)
    _constants(deck, card, rows, found, LAWS[law])
    found.law_card = card


def _constants(deck: Deck, card: Card, rows: list[Row], found: MaterialDraft, law: DeckLaw) -> None:
    """Sets of constants: some rows each, with the temperature after the last constant."""
    count, per_row = len(law.constants), law.per_row
    n_rows, needed = -(-count // per_row), count - law.optional
    if len(rows) > n_rows and len(rows) % n_rows:
        rows[-1].refuse(0, f"{len(rows)} data lines: each temperature takes {n_rows}")
    used = count - per_row * (n_rows - 1)
    for first in range(0, len(rows), n_rows):
        mine = rows[first : first + n_rows]
        values: list[float] = []
        for index, name in enumerate(law.constants):
            row_number, column = divmod(index, per_row)
            if row_number < len(mine):
                default = None if index < needed else 0.0
                values.append(mine[row_number].number(column, name, default))
            elif index < needed:
                mine[-1].refuse(len(mine[-1]), f"{name} is missing")
            else:
                values.append(0.0)
        temperature = 0.0
        for number, row in enumerate(mine, 1):
            row.at_most((used if number == n_rows else per_row) + 1)
            if number == n_rows and row.get(used):
                temperature = row.number(used, "the temperature")
        found.constants.append((temperature, values))
    if len(rows) == n_rows and rows[-1].get(used):
        text = f"the temperature {rows[-1].get(used)} in {card.spelled} is ignored"
        deck.note(f"{rows[-1].where}: {text}")
    _refuse_twice(card, [t for t, _ in found.constants])


def _refuse_twice(card: Card, temperatures: list[float]) -> None:
    """Refuse a temperature that has two sets of numbers."""
    seen: set[float] = set()
    for at in temperatures:
        if at in seen:
            card.error(
                f"the temperature {at:g} is given twice",
                hint="each set of numbers needs its own temperature, after the last number",
            )
            return
        seen.add(at)


@keyword("DENSITY", "DEPENDENCIES", place="model")
def density(deck: Deck, card: Card) -> None:
    """``*DENSITY``: mass per volume, temperature."""
    found = open_material(deck, card)
    for row in card.lines("the density"):
        value, at = row.reals(("the density", "the temperature"), 0.0, required=1)
        if value <= 0.0:
            row.refuse(0, f"the density must be > 0, not {value:g}")
        row.at_most(2)
        found.rho = value
        found.densities.append((at, value))
    _refuse_twice(card, [t for t, _ in found.densities])


def open_material(deck: Deck, card: Card, new_law: bool = False) -> MaterialDraft:
    """The material that the card belongs to.

    Raises
    ------
    Refused
        If there is none, or it should have no constants yet (`new_law`) and has some.
    """
    found = deck.material
    if found is None:
        card.refuse("the card belongs to a material, but there is no *MATERIAL right before it")
    if new_law and found.law:
        card.refuse(f"material {found.name} already has constants ({found.law_where})")
    return found


@keyword(
    "SOLID SECTION",
    "ELSET MATERIAL ORIENTATION PLANE LOCALSTRAIN DILATATION BETA0 NODALTHICKNESS",
    "CONTROLS OFFSET REFNODE STACKDIRECTION SYMMETRIC LAYUP",
    place="model",
)
def solid_section(deck: Deck, card: Card) -> None:
    """``*SOLID SECTION, ELSET=, MATERIAL=``: thickness (default 1)."""
    elset = card.required("ELSET")
    name = card.required("MATERIAL")
    plane = card.choice("PLANE", ("STRESS", "STRAIN", "AXISYMMETRIC"), "").lower()
    known = [name.replace("_", "").upper() for name in (*LOCAL_STRAINS, *ALIASES)]
    local = card.choice("LOCALSTRAIN", known, "")
    mean = card.choice("DILATATION", ("POINT", "MEAN"), "POINT") == "MEAN"
    # The section refuses values that are not positive, and elements without this weight.
    beta0 = card.number("BETA0", 0.0, 0.0) if card.has("BETA0") else None
    rows = list(card.rows())
    thickness: float | None = 1.0
    if rows:
        thickness = rows[0].real(0, "the thickness", 1.0)
        if any(rows[0].fields[1:]):
            deck.note(f"{rows[0].at(1)}: {card.spelled}: only the thickness is used")
        for row in rows[1:]:
            row.error(0, "one data line is expected, the thickness")
    given = bool(rows and rows[0].get(0)) or card.has("NODALTHICKNESS")
    given = given or card.has("SHELLTHICKNESS")
    if thickness is not None and thickness <= 0.0:
        rows[0].error(0, f"the thickness must be > 0, not {thickness:g}")
        thickness = None
    if elset and name and thickness is not None:
        deck.scope.sections.append(
            SectionDraft(
                card,
                elset,
                name,
                thickness,
                plane,
                local_strain(local) if local else "",
                card.value("ORIENTATION"),
                mean,
                beta0,
                card.has("NODALTHICKNESS"),
                given,
                card.value("SHELLTHICKNESS"),
            )
        )


@keyword("NODAL THICKNESS", place="model")
def nodal_thickness(deck: Deck, card: Card) -> None:
    """``*NODAL THICKNESS``: node or set, thickness."""
    for row in card.rows():
        with suppress(Refused):
            value = tuple(row.positive(("the thickness",), 1))
            if row.get(0):
                deck.thicknesses.append(Draft("thickness", row, row.get(0), value))


@keyword(
    "SHELL SECTION",
    "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS SHELLTHICKNESS",
    "OFFSET CONTROLS POISSON SECTIONINTEGRATION TEMPERATURE DENSITY THICKNESSMODULUS ZERO "
    "STACKDIRECTION SYMMETRIC LAYUP",
    place="model",
)
@keyword(
    "MEMBRANE SECTION",
    "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS",
    "OFFSET CONTROLS POISSON",
    place="model",
)
def shell_section(deck: Deck, card: Card) -> None:
    """``*SHELL SECTION``, ``*MEMBRANE SECTION``: a planar part; the thickness is required."""
    by_set = card.has("NODALTHICKNESS") or card.has("SHELLTHICKNESS")
    if not any(row.get(0) for row in card.rows()) and not by_set:
        card.refuse("a data line is missing: the thickness")
    deck.note(f"{card.where}: {card.spelled} is read as a plane-stress section")
    solid_section(deck, card)


@keyword("ORIENTATION", "NAME SYSTEM", "DEFINITION", place="model")
def orientation(deck: Deck, card: Card) -> None:
    """``*ORIENTATION, NAME=``: points on the first axis and in the plane, or a distribution."""
    name = card.required("NAME")
    systems = ("RECTANGULAR", "CYLINDRICAL", "SPHERICAL", "ZRECTANGULAR", "USER")
    if card.choice("SYSTEM", systems, "RECTANGULAR") != "RECTANGULAR":
        # Its effect depends on the material of the section.
        if name:
            deck.scope.orientations[key(name)] = math.nan
        return
    rows = card.lines("ax, ay, az, bx, by, bz")
    source = rows[0].get(0)
    named = source and not rows[0].get(1) and not numerals.is_number(source)
    angle = 0.0 if named else plane_angle(rows[0])
    if len(rows) > 1:
        axis, turn = both(rows[1].integer(0, "the axis", 3), rows[1].real(1, "the angle", 0.0))
        if axis != 3 and turn != 0.0:
            rows[1].refuse(0, "only a rotation about axis 3 stays in the plane")
        angle += math.radians(turn)
    if len(rows) > 2:
        rows[2].refuse(0, "at most two data lines are expected")
    if name and named:
        deck.scope.axes_by_element[key(name)] = (card, source, angle)
    if name:
        deck.scope.orientations[key(name)] = math.nan if named else angle
