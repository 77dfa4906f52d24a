"""Cards of materials, sections and orientations."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck.drafts import Draft, MaterialDraft, SectionDraft
from corota.io.deck.lexer import key
from corota.model.local_strain import ALIASES, LOCAL_STRAINS, local_strain

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card, Row

#: Constants of each ``TYPE=`` of ``*ELASTIC``, in the order of the data lines.
ELASTIC_TYPES: dict[str, tuple[str, ...]] = {
    "ISOTROPIC": ("Young's modulus", "Poisson's ratio"),
    "LAMINA": ("E1", "E2", "nu12", "G12", "G13", "G23"),
    "ENGINEERINGCONSTANTS": (
        "E1",
        "E2",
        "E3",
        "nu12",
        "nu13",
        "nu23",
        "G12",
        "G13",
        "G23",
    ),
    "ORTHOTROPIC": (
        "D1111",
        "D1122",
        "D2222",
        "D1133",
        "D2233",
        "D3333",
        "D1212",
        "D1313",
        "D2323",
    ),
}
_OPTIONAL = {"Poisson's ratio": 0.0, "G13": 0.0, "G23": 0.0, "D1313": 0.0, "D2323": 0.0}


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
    found = open_material(deck, card)
    if found is None:
        return
    law = key(card.value("TYPE")) or "ISOTROPIC"
    law = {"ISO": "ISOTROPIC", "ORTHO": "ORTHOTROPIC"}.get(law, law)
    if law not in ELASTIC_TYPES:
        deck.choice(card, "TYPE", ("ISO", "ORTHO", "ENGINEERING CONSTANTS", "LAMINA"), "")
        return
    rows = list(card.rows())
    names = ELASTIC_TYPES[law]
    if not rows:
        deck.error(card, card.where, f"a data line is missing: {', '.join(names)}")
        return
    if found.law:
        deck.error(
            card, card.where, f"material {found.name} already has constants ({found.law_where})"
        )
        return
    found.law, found.law_where, found.law_card = law, rows[0].where, card
    _constants(deck, card, rows, found, names)


def _constants(
    deck: Deck, card: Card, rows: list[Row], found: MaterialDraft, names: tuple[str, ...]
) -> None:
    per_row = 2 if names[0] == "Young's modulus" else 8
    n_rows = -(-len(names) // per_row)
    for index, name in enumerate(names):
        row_number, column = divmod(index, per_row)
        if row_number >= len(rows):
            if name not in _OPTIONAL:
                deck.row_error(card, rows[-1], len(rows[-1]), f"{name} is missing")
                break
            found.constants.append(_OPTIONAL[name])
            continue
        value = deck.real(card, rows[row_number], column, name, _OPTIONAL.get(name))
        if value is None:
            break
        found.constants.append(value)
    if len(found.constants) < len(names):
        found.law_card = None
    if law_depends(rows, n_rows):
        if per_row != 2:
            deck.row_error(
                card,
                rows[n_rows],
                0,
                "only isotropic constants may depend on temperature",
                "give one set of constants",
            )
            return
        for row in rows:
            values = [
                deck.real(card, row, i, name, 0.0)
                for i, name in enumerate((*names, "the temperature"))
            ]
            if None in values:
                return
            found.table.append([float(v or 0.0) for v in values])
        return
    for number, row in enumerate(rows):
        used = per_row if number + 1 < n_rows else len(names) - per_row * (n_rows - 1)
        deck.extra_fields(card, row, used + 1)
        if row.get(used):
            deck.note(f"{row.where}: the temperature {row.get(used)} in *ELASTIC is ignored")


def law_depends(rows: list[Row], n_rows: int) -> bool:
    """Whether there are constants for more than one temperature."""
    return len(rows) > n_rows


def density(deck: Deck, card: Card) -> None:
    """``*DENSITY``: mass per volume."""
    found = open_material(deck, card)
    if found is None:
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: the density")
        return
    value = deck.real(card, rows[0], 0, "the density")
    if value is None:
        return
    if value <= 0.0:
        deck.row_error(card, rows[0], 0, f"the density must be > 0, not {value:g}")
        return
    found.rho = value
    deck.extra_fields(card, rows[0], 2)
    for row in rows[1:]:
        deck.row_error(
            card, row, 0, "a density that depends on temperature is not part of this version"
        )
        return


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
    plane = deck.choice(card, "PLANE", ("STRESS", "STRAIN"), "").lower()
    known = [name.replace("_", "").upper() for name in (*LOCAL_STRAINS, *ALIASES)]
    local = local_strain(deck.choice(card, "LOCALSTRAIN", known, "LINEAR"))
    mean = deck.choice(card, "DILATATION", ("POINT", "MEAN"), "POINT") == "MEAN"
    # What is not positive, and elements without this weight, the section refuses.
    beta0 = deck.parameter_number(card, "BETA0", 0.0, 0.0) if card.has("BETA0") else None
    rows = list(card.rows())
    thickness: float | None = 1.0
    if rows:
        thickness = deck.real(card, rows[0], 0, "the thickness", 1.0)
        if any(rows[0].fields[1:]):
            deck.note(f"{rows[0].at(1)}: {card.spelled}: only the thickness is used")
        for row in rows[1:]:
            deck.row_error(card, row, 0, "one data line is expected, the thickness")
    if (not rows or not rows[0].get(0)) and not card.has("NODALTHICKNESS"):
        deck.note(f"{card.where}: no thickness is given for {elset}; 1 is taken")
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
                local,
                card.value("ORIENTATION"),
                mean,
                beta0,
                card.has("NODALTHICKNESS"),
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


def shell_section(deck: Deck, card: Card) -> None:
    """``*SHELL SECTION``, ``*MEMBRANE SECTION``: a planar part; the thickness is required."""
    if not any(row.get(0) for row in card.rows()) and not card.has("NODALTHICKNESS"):
        deck.error(card, card.where, "a data line is missing: the thickness")
        return
    deck.note(f"{card.where}: {card.spelled} is read as a plane-stress section")
    solid_section(deck, card)


def orientation(deck: Deck, card: Card) -> None:
    """``*ORIENTATION, NAME=``: a point on the first axis and one in the plane."""
    name = deck.required(card, "NAME")
    systems = ("RECTANGULAR", "CYLINDRICAL", "SPHERICAL", "ZRECTANGULAR", "USER")
    if deck.choice(card, "SYSTEM", systems, "RECTANGULAR") != "RECTANGULAR":
        # Whether it matters depends on the material of the section.
        if name:
            deck.scope.orientations[key(name)] = math.nan
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: ax, ay, az, bx, by, bz")
        return
    deck.extra_fields(card, rows[0], 6)
    values = [deck.real(card, rows[0], i, text, 0.0) for i, text in enumerate(("ax", "ay", "az"))]
    other = [
        deck.real(card, rows[0], i + 3, text, 0.0) for i, text in enumerate(("bx", "by", "bz"))
    ]
    if None in values or None in other:
        return
    a = [float(v or 0.0) for v in values]
    b = [float(v or 0.0) for v in other]
    scale = math.hypot(a[0], a[1])
    if scale == 0.0 or abs(a[2]) > 1e-9 * scale or abs(b[2]) > 1e-9 * math.hypot(*b):
        deck.row_error(card, rows[0], 0, "both points must lie in the plane z = 0, off the origin")
        return
    cross = a[0] * b[1] - a[1] * b[0]
    if abs(cross) <= 1e-12 * scale * math.hypot(b[0], b[1]):
        deck.row_error(card, rows[0], 3, "the two points and the origin lie on one line")
        return
    if cross < 0.0:
        deck.row_error(
            card, rows[0], 3, "the third axis would point to -z; give b left of the line to a"
        )
        return
    angle = math.atan2(a[1], a[0])
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
    if name:
        deck.scope.orientations[key(name)] = angle
