"""Cards of materials, sections and orientations."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck import numerals
from corota.io.deck.cards.distribution import plane_angle
from corota.io.deck.cards.step import turns_nlgeom_on
from corota.io.deck.drafts import Draft, MaterialDraft, NonstructuralDraft, SectionDraft
from corota.io.deck.laws import LAWS, DeckLaw
from corota.io.deck.lexer import Card, Row, key
from corota.lazy import lazy
from corota.model.local_strain import ALIASES, LOCAL_STRAINS, local_strain

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck

add_nonstructural = lazy("corota.io.deck.build.nonstructural:add_nonstructural")

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
#: Values of ``UNITS=`` of ``*NONSTRUCTURAL MASS``.
NONSTRUCTURAL = ("TOTALMASS", "MASSPERVOLUME", "MASSPERAREA", "MASSPERLENGTH")


def material(deck: Deck, card: Card) -> None:
    """``*MATERIAL, NAME=``: opens a material for the cards below it."""
    name = deck.required(card, "NAME")
    deck.no_rows(card)
    if not name:
        name = f"unnamed material of line {card.where.line}"
    if key(name) in deck.materials:
        first = deck.materials[key(name)].card.where
        deck.error(card, card.at("NAME"), f"material {name} is already defined in {first}")
    deck.material = MaterialDraft(name, card)
    deck.materials.setdefault(key(name), deck.material)


def elastic(deck: Deck, card: Card) -> None:
    """``*ELASTIC[, TYPE=]``: the constants of the law."""
    law = ELASTIC_TYPES.get(key(card.value("TYPE")))
    if law is None:
        deck.choice(card, "TYPE", ("ISO", "ORTHO", "ENGINEERING CONSTANTS", "LAMINA"), "")
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
    kind = deck.choice(card, "MODULI", ("LONGTERM", "INSTANTANEOUS"), "LONGTERM")
    if deck.material is not None:
        deck.material.moduli = kind


def constants(deck: Deck, card: Card, law: str) -> None:
    """The constants of a law of :data:`LAWS`, for the open material."""
    found = open_material(deck, card)
    if found is None:
        return
    rows, entry = list(card.rows()), LAWS[law]
    if not rows:
        deck.error(card, card.where, f"a data line is missing: {', '.join(entry.constants)}")
        return
    if found.law:
        deck.error(
            card, card.where, f"material {found.name} already has constants ({found.law_where})"
        )
        return
    found.law, found.law_where, found.law_card = law, rows[0].where, card
    if law == "DEFORMATIONPLASTICITY":
        turns_nlgeom_on(deck, card.spelled)
    _constants(deck, card, rows, found, entry)


def _constants(deck: Deck, card: Card, rows: list[Row], found: MaterialDraft, law: DeckLaw) -> None:
    """Sets of constants: some rows each, with the temperature after the last constant."""
    count, per_row = len(law.constants), law.per_row
    n_rows, needed = -(-count // per_row), count - law.optional
    if len(rows) > n_rows and len(rows) % n_rows:
        deck.row_error(
            card,
            rows[-1],
            0,
            f"{len(rows)} data lines: each temperature takes {n_rows}",
        )
        found.law_card = None
        return
    used = count - per_row * (n_rows - 1)
    for first in range(0, len(rows), n_rows):
        mine = rows[first : first + n_rows]
        values: list[float] = []
        for index, name in enumerate(law.constants):
            row_number, column = divmod(index, per_row)
            if row_number >= len(mine):
                if index < needed:
                    deck.row_error(card, mine[-1], len(mine[-1]), f"{name} is missing")
                    found.law_card = None
                    return
                values.append(0.0)
                continue
            value = deck.real(card, mine[row_number], column, name, None if index < needed else 0.0)
            if value is None:
                found.law_card = None
                return
            values.append(value)
        temperature = 0.0
        for number, row in enumerate(mine):
            last = number + 1 == n_rows
            deck.extra_fields(card, row, (used if last else per_row) + 1)
            if last and row.get(used):
                at = deck.real(card, row, used, "the temperature")
                if at is None:
                    found.law_card = None
                    return
                temperature = at
        found.constants.append((temperature, values))
    _only_temperature(deck, card, rows[-1] if len(rows) == n_rows else None, used)
    _refuse_twice(deck, card, [t for t, _ in found.constants])


def _only_temperature(deck: Deck, card: Card, row: Row | None, column: int) -> None:
    """Note that the temperature of the only set does not matter."""
    if row is not None and row.get(column):
        deck.note(f"{row.where}: the temperature {row.get(column)} in {card.spelled} is ignored")


def _refuse_twice(deck: Deck, card: Card, temperatures: list[float]) -> None:
    """Refuse a temperature that has two sets of numbers."""
    seen: set[float] = set()
    for at in temperatures:
        if at in seen:
            deck.error(
                card,
                card.where,
                f"the temperature {at:g} is given twice",
                hint="each set of numbers needs its own temperature, after the last number",
            )
            return
        seen.add(at)


def density(deck: Deck, card: Card) -> None:
    """``*DENSITY``: mass per volume, temperature."""
    found = open_material(deck, card)
    if found is None:
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: the density")
    for row in rows:
        value = deck.real(card, row, 0, "the density")
        at = deck.real(card, row, 1, "the temperature", 0.0)
        if value is None or at is None:
            return
        if value <= 0.0:
            deck.row_error(card, row, 0, f"the density must be > 0, not {value:g}")
            return
        deck.extra_fields(card, row, 2)
        found.rho = value
        found.densities.append((at, value))
    _refuse_twice(deck, card, [t for t, _ in found.densities])


def open_material(deck: Deck, card: Card) -> MaterialDraft | None:
    """The material that the card belongs to; ``None`` after an error."""
    if deck.material is None:
        deck.error(
            card,
            card.where,
            "the card belongs to a material, but there is no *MATERIAL right before it",
        )
    return deck.material


def solid_section(deck: Deck, card: Card) -> None:
    """``*SOLID SECTION, ELSET=, MATERIAL=``: thickness (default 1)."""
    elset = deck.required(card, "ELSET")
    name = deck.required(card, "MATERIAL")
    plane = deck.choice(card, "PLANE", ("STRESS", "STRAIN", "AXISYMMETRIC"), "").lower()
    known = [name.replace("_", "").upper() for name in (*LOCAL_STRAINS, *ALIASES)]
    local = deck.choice(card, "LOCALSTRAIN", known, "")
    mean = deck.choice(card, "DILATATION", ("POINT", "MEAN"), "POINT") == "MEAN"
    # The section refuses values that are not positive, and elements without this weight.
    beta0 = deck.parameter_number(card, "BETA0", 0.0, 0.0) if card.has("BETA0") else None
    rows = list(card.rows())
    thickness: float | None = 1.0
    if rows:
        thickness = deck.real(card, rows[0], 0, "the thickness", 1.0)
        if any(rows[0].fields[1:]):
            deck.note(f"{rows[0].at(1)}: {card.spelled}: only the thickness is used")
        for row in rows[1:]:
            deck.row_error(card, row, 0, "one data line is expected, the thickness")
    given = bool(rows and rows[0].get(0)) or card.has("NODALTHICKNESS")
    given = given or card.has("SHELLTHICKNESS")
    if thickness is not None and thickness <= 0.0:
        deck.row_error(card, rows[0], 0, f"the thickness must be > 0, not {thickness:g}")
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


def nodal_thickness(deck: Deck, card: Card) -> None:
    """``*NODAL THICKNESS``: node or set, thickness."""
    for row in card.rows():
        value = deck.real(card, row, 1, "the thickness")
        if value is None:
            continue
        if value <= 0.0:
            deck.row_error(card, row, 1, f"the thickness must be > 0, not {value:g}")
        elif row.get(0):
            deck.thicknesses.append(Draft("thickness", card, row, row.get(0), (value,)))


def nonstructural_mass(deck: Deck, card: Card) -> None:
    """``*NONSTRUCTURAL MASS, ELSET=, UNITS=[, DISTRIBUTION=]``: the mass, or its density."""
    elset = deck.required(card, "ELSET")
    units = deck.required(card, "UNITS") and deck.choice(card, "UNITS", NONSTRUCTURAL, "")
    kinds = ("MASSPROPORTIONAL", "VOLUMEPROPORTIONAL")
    share = deck.choice(card, "DISTRIBUTION", kinds, kinds[0])
    rows = list(card.rows())
    if len(rows) != 1:
        deck.error(card, card.where, f"one data line is expected: the mass, found {len(rows)}")
        return
    deck.extra_fields(card, rows[0], 1)
    value = deck.real(card, rows[0], 0, "the mass")
    if value is None or not elset or not units:
        return
    if value < 0.0:
        deck.row_error(card, rows[0], 0, f"a mass must be >= 0, not {value:g}")
        return
    by_volume = share == kinds[1]
    draft = NonstructuralDraft(card, rows[0], elset, value, units, by_volume)
    deck.later("sections", add_nonstructural, draft)


def shell_section(deck: Deck, card: Card) -> None:
    """``*SHELL SECTION``, ``*MEMBRANE SECTION``: a planar part; the thickness is required."""
    by_set = card.has("NODALTHICKNESS") or card.has("SHELLTHICKNESS")
    if not any(row.get(0) for row in card.rows()) and not by_set:
        deck.error(card, card.where, "a data line is missing: the thickness")
        return
    deck.note(f"{card.where}: {card.spelled} is read as a plane-stress section")
    solid_section(deck, card)


def orientation(deck: Deck, card: Card) -> None:
    """``*ORIENTATION, NAME=``: points on the first axis and in the plane, or a distribution."""
    name = deck.required(card, "NAME")
    systems = ("RECTANGULAR", "CYLINDRICAL", "SPHERICAL", "ZRECTANGULAR", "USER")
    if deck.choice(card, "SYSTEM", systems, "RECTANGULAR") != "RECTANGULAR":
        # Its effect depends on the material of the section.
        if name:
            deck.scope.orientations[key(name)] = math.nan
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: ax, ay, az, bx, by, bz")
        return
    source = rows[0].get(0)
    named = source and not rows[0].get(1) and not numerals.is_number(source)
    angle = 0.0 if named else plane_angle(deck, card, rows[0])
    if angle is None:
        return
    if len(rows) > 1:
        axis = deck.integer(card, rows[1], 0, "the axis", 3)
        turn = deck.real(card, rows[1], 1, "the angle", 0.0)
        if axis is None or turn is None:
            return
        if axis != 3 and turn != 0.0:
            deck.row_error(card, rows[1], 0, "only a rotation about axis 3 stays in the plane")
            return
        angle += math.radians(turn)
    for row in rows[2:]:
        deck.row_error(card, row, 0, "at most two data lines are expected")
        return
    if name and named:
        deck.scope.axes_by_element[key(name)] = (card, source, angle)
        deck.scope.orientations[key(name)] = math.nan
    elif name:
        deck.scope.orientations[key(name)] = angle
