"""Cards of trusses, beams and springs, and their sections."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota import profiles
from corota.arrays import Ints, distinct
from corota.errors import InputError
from corota.io.deck.drafts import LineDraft, SectionDraft
from corota.io.deck.elements import LINE_ELEMENTS
from corota.io.deck.lexer import Card, Row, key
from corota.model.materials import Elastic, Material
from corota.model.sections import Section

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from corota.io.deck.build.mesh import MeshBuilder
    from corota.io.deck.build.sets import Sets
    from corota.io.deck.deck import Deck
    from corota.model.model import Model
    from corota.profiles import Profile

#: Degrees of freedom of decks in the plane, and their index here.
PLANAR = {1: 0, 2: 1, 6: 2}


#: Sizes of the sections of ``*BEAM SECTION``.
SIZES: dict[str, tuple[str, ...]] = {
    "RECT": ("the size along the first axis", "the size along the second axis"),
    "CIRC": ("the first diameter", "the second diameter"),
    "PIPE": ("the outer radius", "the thickness"),
    "BOX": ("the width", "the height", "wall 1", "wall 2", "wall 3", "wall 4"),
    "I": (
        "the place of the node",
        "the height",
        "the lower width",
        "the upper width",
        "the lower thickness",
        "the upper thickness",
        "the thickness of the web",
    ),
}


def _numbers(deck: Deck, card: Card, row: Row, names: Iterable[str]) -> list[float] | None:
    """Positive numbers of a row; ``None`` after an error."""
    found = []
    for index, name in enumerate(names):
        value = deck.real(card, row, index, name)
        if value is None:
            return None
        if value <= 0.0:
            deck.row_error(card, row, index, f"{name} must be > 0, not {value:g}")
            return None
        found.append(value)
    return found


def _out_of_plane(deck: Deck, card: Card, rows: list[Row]) -> float | None:
    """Component of the first axis of the section normal to the plane; ``None`` after an error.

    With -1, the default, the second axis points to the left of the way from the first to the second
    node; with 0 the first axis lies in the plane.
    """
    if len(rows) < 2:
        return -1.0
    names = ("nx", "ny", "nz")
    values = [deck.real(card, rows[1], i, name, 0.0) for i, name in enumerate(names)]
    if None in values:
        return None
    x, y, z = (float(v or 0.0) for v in values)
    flat, size = math.hypot(x, y), abs(z)
    if min(flat, size) > 1e-6 * max(flat, size) or max(flat, size) == 0.0:
        deck.row_error(card, rows[1], 0, "the first axis must lie in the plane or be normal to it")
        return None
    return math.copysign(1.0, z) if size > flat else 0.0


def _common(deck: Deck, card: Card, most: int) -> list[Row] | None:
    for name in ("OFFSET1", "OFFSET2"):
        if deck.parameter_number(card, name, 0.0, -math.inf) != 0.0:
            deck.error(
                card,
                card.at(name),
                "the axis of a beam passes through its nodes; use a rigid link (*MPC, BEAM) for "
                "an offset",
            )
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: the sizes of the cross-section")
        return None
    for row in rows[most:]:
        deck.row_error(card, row, 0, f"at most {most} data lines are expected")
    return rows


def beam_section(deck: Deck, card: Card) -> None:
    """``*BEAM SECTION, ELSET=, MATERIAL=, SECTION=RECT, CIRC or PIPE``: sizes; first axis."""
    elset, material = deck.required(card, "ELSET"), deck.required(card, "MATERIAL")
    kind = _kind(deck, card)
    rows = _common(deck, card, 3)
    if rows is None or not kind:
        if not kind and not card.has("SECTION"):
            deck.error(card, card.where, f"SECTION= is missing: {', '.join(SIZES)}")
        return
    for name in ("TEMPERATURE", "POISSON"):
        if card.has(name):
            deck.note(f"{card.where}: {card.spelled}: {name} is ignored: sections keep their shape")
    normal = _out_of_plane(deck, card, rows)
    if normal is None:
        return
    row = rows[0]
    sizes = _sizes(deck, card, row, kind)
    if sizes is None:
        return
    profile = _profile(deck, card, row, kind, sizes, normal)
    if elset and material and profile is not None:
        deck.scope.lines.append(_beam(card, elset, kind, profile, material))


def _kind(deck: Deck, card: Card) -> str:
    """Kind of a cross-section, by its first four letters, as in CalculiX; empty after an error."""
    word = key(card.value("SECTION"))[:4]
    return word if word in SIZES else deck.choice(card, "SECTION", SIZES, "")


def _sizes(deck: Deck, card: Card, row: Row, kind: str) -> list[float] | None:
    """Sizes of a cross-section; ``None`` after an error."""
    names = SIZES[kind]
    if kind == "CIRC" and not row.get(1) and deck.dialect == "abaqus":
        deck.note(f"{row.where}: one number of a circle is its radius, as in Abaqus")
        radius = _numbers(deck, card, row, ("the radius",))
        return None if radius is None else [2.0 * radius[0], 2.0 * radius[0]]
    if kind == "CIRC" and not row.get(1) and deck.of_calculix:
        deck.note(f"{row.where}: one number of a circle is its diameter, as in CalculiX")
        diameter = _numbers(deck, card, row, ("the diameter",))
        return None if diameter is None else 2 * diameter
    if kind == "CIRC" and not row.get(1):
        deck.row_error(
            card,
            row,
            0,
            "one number is the radius in Abaqus and the diameter in CalculiX",
            "give both diameters: d, d; or say ** DIALECT: calculix or abaqus on a line of its own",
        )
        return None
    deck.extra_fields(card, row, len(names))
    return _numbers(deck, card, row, names)


def _beam(
    card: Card,
    elset: str,
    kind: str,
    profile: Profile,
    material: str = "",
    elastic: Elastic | None = None,
) -> LineDraft:
    """Section of a beam with a cross-section of known shape."""
    return LineDraft(
        "beam",
        card,
        elset,
        material,
        elastic,
        profile=(profile.area, profile.inertia, profile.shear_area),
        fibers=profile.rows,
        # The height of a rectangle follows from its numbers.
        height=0.0 if kind == "RECT" else profile.height,
        fiber=profile.fiber if kind in ("RECT", "CIRC", "PIPE") else 0.0,
    )


def _profile(
    deck: Deck, card: Card, row: Row, kind: str, sizes: list[float], normal: float
) -> Profile | None:
    """Cross-section of ``*BEAM SECTION``; ``None`` after an error."""
    if kind in ("RECT", "CIRC"):
        across, depth = sizes if normal else sizes[::-1]
        if kind == "RECT":
            return profiles.rectangle(across, depth)
        return profiles.circle(depth, width=across)
    if kind == "PIPE":
        if sizes[1] > sizes[0]:
            deck.row_error(card, row, 1, "the thickness exceeds the radius")
            return None
        return profiles.pipe(*sizes)
    # Rectangles by width, height and center along the two axes.
    if kind == "BOX":
        # Walls right, top, left, bottom of a box of width a and height b.
        a, b, right, top, left, bottom = sizes
        if a <= left + right or b <= top + bottom:
            deck.row_error(card, row, 2, "the walls fill the box")
            return None
        inside, middle = a - left - right, 0.5 * (left - right)
        walls = [
            (right, b, 0.5 * (a - right), 0.0),
            (left, b, 0.5 * (left - a), 0.0),
            (inside, top, middle, 0.5 * (b - top)),
            (inside, bottom, middle, 0.5 * (bottom - b)),
        ]
    else:
        # Height, then width of the lower and the upper flange and the three thicknesses.
        at, tall, low, high, t_low, t_high, web = sizes
        if tall <= t_low + t_high:
            deck.row_error(card, row, 1, "the flanges fill the height")
            return None
        mid = tall - t_low - t_high
        walls = [
            (low, t_low, 0.0, 0.5 * t_low),
            (high, t_high, 0.0, tall - 0.5 * t_high),
            (web, mid, 0.0, t_low + 0.5 * mid),
        ]
        center = sum(w * h * y for w, h, _, y in walls) / sum(w * h for w, h, _, _ in walls)
        if abs(at - center) > 1e-6 * tall:
            deck.row_error(
                card,
                row,
                0,
                "the axis of a beam passes through its nodes: the node must be at the center, "
                f"{center:g}",
            )
            return None
    # The second axis points to the left, unless the first points out of the plane.
    side = 1.0 if normal <= 0.0 else -1.0
    parts = [(w, side * y, h) if normal else (h, x, w) for w, h, x, y in walls]
    return profiles.of_rectangles([(w, y - 0.5 * h, y + 0.5 * h) for w, y, h in parts])


def beam_general_section(deck: Deck, card: Card) -> None:
    """``*BEAM GENERAL SECTION``: area, I11, I12, I22, J, or sizes; first axis; E, G."""
    elset = deck.required(card, "ELSET")
    kind = deck.choice(card, "SECTION", ("GENERAL", *SIZES), "GENERAL")
    rho = deck.parameter_number(card, "DENSITY", 0.0, 0.0)
    rows = _common(deck, card, 3)
    if rows is None:
        return
    if len(rows) < 3:
        deck.error(
            card,
            card.where,
            "three lines are expected: area, I11, I12, I22, J, or the sizes of the SECTION; the "
            "first axis; E, G",
        )
        return
    normal = _out_of_plane(deck, card, rows)
    if kind in SIZES:
        sizes = _sizes(deck, card, rows[0], kind)
        pair = _numbers(deck, card, rows[2], ("Young's modulus", "the shear modulus"))
        if normal is None or sizes is None or pair is None or not elset:
            return
        profile = _profile(deck, card, rows[0], kind, sizes, normal)
        if profile is None:
            return
        e, g = pair
        try:
            elastic = Elastic(e, 0.5 * e / g - 1.0, rho=rho, where=card.where)
        except InputError as error:
            deck.error(card, rows[2].where, error.message)
            return
        deck.scope.lines.append(_beam(card, elset, kind, profile, elastic=elastic))
        return
    area = _numbers(deck, card, rows[0], ("the area",))
    column = 3 if normal == 0.0 else 1
    inertia = deck.real(card, rows[0], column, "the second moment of area")
    moduli = _numbers(deck, card, rows[2], ("Young's modulus", "the shear modulus"))
    if normal is None or area is None or inertia is None or moduli is None:
        return
    if inertia <= 0.0:
        deck.row_error(card, rows[0], column, f"the second moment must be > 0, not {inertia:g}")
        return
    elastic = Elastic(moduli[0], rho=rho, where=card.where)
    if elset:
        # No shear deformation: the card gives no shear area.
        draft = LineDraft("beam", card, elset, elastic=elastic, profile=(area[0], inertia, 0.0))
        deck.scope.lines.append(draft)


def shear_stiffness(deck: Deck, card: Card) -> None:
    """``*TRANSVERSE SHEAR STIFFNESS``: G times the shear area of the beam section before it."""
    beams = [line for line in deck.scope.lines if line.role == "beam"]
    rows = list(card.rows())
    if not beams:
        text = "the card belongs under a *BEAM SECTION, but there is none before it"
        deck.error(card, card.where, text)
        return
    if len(rows) != 1:
        deck.error(card, card.where, f"one data line is expected, found {len(rows)}")
        return
    first = _numbers(deck, card, rows[0], ("the shear stiffness",))
    other = deck.real(card, rows[0], 1, "the other shear stiffness", first[0] if first else 0.0)
    if first is None or other is None:
        return
    if other != first[0]:
        deck.note(
            f"{rows[0].where}: {card.spelled}: the first stiffness is that of shear in the plane"
        )
    if rows[0].get(2):
        deck.note(
            f"{rows[0].at(2)}: {card.spelled}: slender elements need no compensation: it is ignored"
        )
    beams[-1].shear_stiffness = first[0]


def spring(deck: Deck, card: Card) -> None:
    """``*SPRING, ELSET=[, NONLINEAR]``: dofs (SPRING1, SPRING2); stiffness, or force and way."""
    elset = deck.required(card, "ELSET")
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: the stiffness")
    elif elset:
        deck.scope.lines.append(LineDraft("spring", card, elset, rows=rows))


def build_lines(
    deck: Deck,
    model: Model,
    meshes: MeshBuilder,
    sets: Sets,
    materials: Mapping[str, Material | None],
    rotating: np.ndarray[tuple[int], np.dtype[np.bool_]],
    owner: Ints,
) -> None:
    """Add the sections of beams and springs; ``owner`` gets -2 at their cells."""
    for view in meshes.views:
        for draft in view.scope.lines:
            card = draft.card
            found = sets.elements(view, draft.elset, card.at("ELSET"), card)
            if found is None:
                continue
            types = np.array([meshes.types[i] for i in meshes.cell_type[found.cells]], dtype=str)
            for name in distinct(types):
                cells = found.cells[types == name]
                if name not in LINE_ELEMENTS or LINE_ELEMENTS[name].role != draft.role:
                    deck.error(
                        card, card.at("ELSET"), f"elements of type {name} take another section"
                    )
                    continue
                if (owner[cells] != -1).any():
                    label = model.mesh.cell_labels[cells[np.argmax(owner[cells] != -1)]]
                    deck.error(card, card.where, f"element {label} already has a section")
                    continue
                owner[cells] = -2
                section = _section(deck, draft, name, cells, materials)
                if section is None:
                    continue
                model.sections.append(section)
                if section.element == "BEAM" or section.element.endswith("R"):
                    for cell in cells.tolist():
                        block, row = model.mesh.locate(cell)
                        rotating[model.mesh.cells[block].nodes[row]] = True
            if not len(found.cells):
                deck.error(card, card.at("ELSET"), f"{draft.elset} holds no beams or springs")


def truss_section(
    deck: Deck, draft: SectionDraft, cells: Ints, material: Material
) -> Section | None:
    """Trusses of a ``*SOLID SECTION``, whose number is their area."""
    if not material.for_lines:
        deck.error(
            draft.card,
            draft.card.at("MATERIAL"),
            "trusses take isotropic *ELASTIC material, with *PLASTIC, only",
        )
        return None
    area = draft.thickness
    return Section(cells, "TRUSS", material, area, where=draft.card.where, profile=(area, 0.0, 0.0))


def _section(
    deck: Deck, draft: LineDraft, type_: str, cells: Ints, materials: Mapping[str, Material | None]
) -> Section | None:
    card = draft.card
    if draft.role == "spring":
        return _spring(deck, draft, type_, cells)
    material: Material | None = draft.elastic
    if material is None:
        if key(draft.material) not in materials:
            deck.error(card, card.at("MATERIAL"), f"no material named {draft.material!r}")
            return None
        material = materials[key(draft.material)]
    if material is None:
        return None
    if not material.for_lines:
        deck.error(
            card, card.at("MATERIAL"), "beams take isotropic *ELASTIC material, with *PLASTIC, only"
        )
        return None
    area, inertia, shear = draft.profile
    if draft.shear_stiffness:
        shear = draft.shear_stiffness * float(material.compliance()[3, 3])
    if type_ in ("B23", "B33"):
        shear = 0.0
    profile = (area, inertia, shear)
    return Section(
        cells,
        "BEAM",
        material,
        area,
        where=card.where,
        profile=profile,
        fibers=draft.fibers,
        height=draft.height,
        fiber=draft.fiber,
    )


def _spring(deck: Deck, draft: LineDraft, type_: str, cells: Ints) -> Section | None:
    card, rows = draft.card, draft.rows
    element, ends = "SPRING", (0, 0)
    if type_ != "SPRINGA":
        count = 1 if type_ == "SPRING1" else 2
        dofs = [deck.integer(card, rows[0], i, "the degree of freedom") for i in range(count)]
        if None in dofs:
            return None
        for index, dof in enumerate(dofs):
            if dof not in (1, 2, 3, 4, 5, 6):
                deck.row_error(
                    card, rows[0], index, f"expected a degree of freedom 1 to 6, found {dof}"
                )
                return None
        if any(dof not in PLANAR for dof in dofs):
            deck.note(f"{card.where}: springs in dofs {dofs} act out of the plane and are ignored")
            return None
        ends = (PLANAR[dofs[0] or 0], PLANAR[dofs[-1] or 0])
        element = type_ + ("R" if 2 in ends else "")
        rows = rows[1:]
    nonlinear = card.has("NONLINEAR")
    if not rows or (len(rows) > 1 and not nonlinear):
        where = rows[1] if rows else draft.rows[-1]
        deck.row_error(card, where, 0, "one line with the stiffness must follow the dofs")
        return None
    names = ("the force", "the elongation") if nonlinear else ("the stiffness",)
    pairs = []
    for row in rows:
        values = [deck.real(card, row, i, name) for i, name in enumerate(names)]
        if None in values:
            return None
        pairs.append([float(v or 0.0) for v in values])
    profile = (0.0 if nonlinear else pairs[0][0], float(ends[0]), float(ends[1]))
    table = tuple((e, f) for f, e in pairs) if nonlinear else ()
    try:
        return Section(cells, element, Elastic(1.0), where=card.where, profile=profile, table=table)
    except InputError as error:
        deck.error(card, rows[0].where, error.message)
        return None
