"""Cards of trusses, beams and springs, and their sections."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from corota import profiles
from corota.arrays import Ints, distinct
from corota.errors import InputError
from corota.io.deck.card import Card, Refused, Row, key
from corota.io.deck.drafts import PLANAR, LineDraft, SectionDraft
from corota.io.deck.elements import LINE_ELEMENTS
from corota.io.deck.keywords import keyword
from corota.model.materials import Elastic, Material
from corota.model.sections import Section

if TYPE_CHECKING:
    from collections.abc import Mapping

    from corota.io.deck.build.mesh import MeshBuilder
    from corota.io.deck.build.sets import Sets
    from corota.io.deck.deck import Deck
    from corota.model.model import Model
    from corota.profiles import Profile

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


def _out_of_plane(rows: list[Row]) -> float:
    """Component of the first axis of the section normal to the plane.

    With -1, the default, the second axis points to the left of the way from the first to the second
    node; with 0 the first axis lies in the plane.
    """
    if len(rows) < 2:
        return -1.0
    x, y, z = rows[1].reals(("nx", "ny", "nz"), 0.0)
    flat, size = math.hypot(x, y), abs(z)
    if min(flat, size) > 1e-6 * max(flat, size) or max(flat, size) == 0.0:
        rows[1].refuse(0, "the first axis must lie in the plane or be normal to it")
    return math.copysign(1.0, z) if size > flat else 0.0


def _common(card: Card, most: int) -> list[Row]:
    text = "the axis of a beam passes through its nodes; use a rigid link (*MPC, BEAM) for"
    for name in ("OFFSET1", "OFFSET2"):
        if card.number(name, 0.0, -math.inf) != 0.0:
            card.error(f"{text} an offset", name)
    rows = card.lines("the sizes of the cross-section")
    for row in rows[most:]:
        row.error(0, f"at most {most} data lines are expected")
    return rows


@keyword(
    "BEAM SECTION",
    "ELSET MATERIAL SECTION OFFSET1 OFFSET2 TEMPERATURE POISSON",
    "LUMP ROTARYINERTIA CONTROLS ORIENTATION",
    place="model",
)
def beam_section(deck: Deck, card: Card) -> None:
    """``*BEAM SECTION, ELSET=, MATERIAL=, SECTION=RECT, CIRC or PIPE``: sizes; first axis."""
    elset, material = card.required("ELSET"), card.required("MATERIAL")
    # By its first four letters, as in CalculiX.
    word = key(card.value("SECTION"))[:4]
    kind = word if word in SIZES else card.choice("SECTION", SIZES, "")
    if not kind and not card.has("SECTION"):
        card.error(f"SECTION= is missing: {', '.join(SIZES)}")
    rows = _common(card, 3)
    if not kind:
        return
    for name in ("TEMPERATURE", "POISSON"):
        if card.has(name):
            card.note(f"{name} is ignored: sections keep their shape")
    profile = _profile(deck, rows[0], kind, _out_of_plane(rows))
    if elset and material:
        deck.scope.lines.append(_beam(card, elset, kind, profile, material))


def _sizes(deck: Deck, row: Row, kind: str) -> list[float]:
    """Sizes of a cross-section."""
    names = SIZES[kind]
    if kind != "CIRC" or row.get(1):
        row.at_most(len(names))
        return row.positive(names)
    if deck.dialect == "abaqus":
        deck.note(f"{row.where}: one number of a circle is its radius, as in Abaqus")
        return 2 * [2.0 * row.positive(("the radius",))[0]]
    if deck.of_calculix:
        deck.note(f"{row.where}: one number of a circle is its diameter, as in CalculiX")
        return 2 * row.positive(("the diameter",))
    row.refuse(
        0,
        "one number is the radius in Abaqus and the diameter in CalculiX",
        "give both diameters: d, d; or say ** DIALECT: calculix or abaqus on a line of its own",
    )


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


def _profile(deck: Deck, row: Row, kind: str, normal: float) -> Profile:
    """Cross-section of ``*BEAM SECTION``."""
    sizes = _sizes(deck, row, kind)
    if kind in ("RECT", "CIRC"):
        across, depth = sizes if normal else sizes[::-1]
        if kind == "RECT":
            return profiles.rectangle(across, depth)
        return profiles.circle(depth, width=across)
    if kind == "PIPE":
        if sizes[1] > sizes[0]:
            row.refuse(1, "the thickness exceeds the radius")
        return profiles.pipe(*sizes)
    # Rectangles by width, height and center along the two axes.
    if kind == "BOX":
        # Walls right, top, left, bottom of a box of width a and height b.
        a, b, right, top, left, bottom = sizes
        if a <= left + right or b <= top + bottom:
            row.refuse(2, "the walls fill the box")
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
            row.refuse(1, "the flanges fill the height")
        mid = tall - t_low - t_high
        walls = [
            (low, t_low, 0.0, 0.5 * t_low),
            (high, t_high, 0.0, tall - 0.5 * t_high),
            (web, mid, 0.0, t_low + 0.5 * mid),
        ]
        center = sum(w * h * y for w, h, _, y in walls) / sum(w * h for w, h, _, _ in walls)
        if abs(at - center) > 1e-6 * tall:
            text = "the axis of a beam passes through its nodes: the node must be at the center"
            row.refuse(0, f"{text}, {center:g}")
    # The second axis points to the left, unless the first points out of the plane.
    side = 1.0 if normal <= 0.0 else -1.0
    parts = [(w, side * y, h) if normal else (h, x, w) for w, h, x, y in walls]
    return profiles.of_rectangles([(w, y - 0.5 * h, y + 0.5 * h) for w, y, h in parts])


@keyword(
    "BEAM GENERAL SECTION",
    "ELSET SECTION DENSITY OFFSET1 OFFSET2",
    "POISSON LUMP ROTARYINERTIA ZERO",
    place="model",
)
def beam_general_section(deck: Deck, card: Card) -> None:
    """``*BEAM GENERAL SECTION``: area, I11, I12, I22, J, or sizes; first axis; E, G."""
    elset = card.required("ELSET")
    kind = card.choice("SECTION", ("GENERAL", *SIZES), "GENERAL")
    rho = card.number("DENSITY", 0.0, 0.0)
    rows = _common(card, 3)
    if len(rows) < 3:
        card.refuse(
            "three lines are expected: area, I11, I12, I22, J, or the sizes of the SECTION; the "
            "first axis; E, G"
        )
    normal = _out_of_plane(rows)
    e, g = rows[2].positive(("Young's modulus", "the shear modulus"))
    if kind in SIZES:
        profile = _profile(deck, rows[0], kind, normal)
        try:
            elastic = Elastic(e, 0.5 * e / g - 1.0, rho=rho, where=card.where)
        except InputError as error:
            deck.error(card, rows[2].where, error.message)
            return
        draft = _beam(card, elset, kind, profile, elastic=elastic)
    else:
        (area,), column = rows[0].positive(("the area",)), 3 if normal == 0.0 else 1
        inertia = rows[0].number(column, "the second moment of area")
        if inertia <= 0.0:
            rows[0].refuse(column, f"the second moment must be > 0, not {inertia:g}")
        # No shear deformation: the card gives no shear area.
        elastic = Elastic(e, rho=rho, where=card.where)
        draft = LineDraft("beam", card, elset, elastic=elastic, profile=(area, inertia, 0.0))
    if elset:
        deck.scope.lines.append(draft)


@keyword("TRANSVERSE SHEAR STIFFNESS", place="model")
def shear_stiffness(deck: Deck, card: Card) -> None:
    """``*TRANSVERSE SHEAR STIFFNESS``: G times the shear area of the beam section before it."""
    beams = [line for line in deck.scope.lines if line.role == "beam"]
    if not beams:
        card.refuse("the card belongs under a *BEAM SECTION, but there is none before it")
    row = card.one_line("", counted=True)
    (first,) = row.positive(("the shear stiffness",))
    if row.number(1, "the other shear stiffness", first) != first:
        row.note("the first stiffness is that of shear in the plane")
    if row.get(2):
        text = "slender elements need no compensation: it is ignored"
        deck.note(f"{row.at(2)}: {card.spelled}: {text}")
    beams[-1].shear_stiffness = first


@keyword("SPRING", "ELSET NONLINEAR", place="model")
def spring(deck: Deck, card: Card) -> None:
    """``*SPRING, ELSET=[, NONLINEAR]``: dofs (SPRING1, SPRING2); stiffness, or force and way."""
    elset, rows = card.required("ELSET"), card.lines("the stiffness")
    if elset:
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
                    card.error(f"elements of type {name} take another section", "ELSET")
                    continue
                if (owner[cells] != -1).any():
                    label = model.mesh.cell_labels[cells[np.argmax(owner[cells] != -1)]]
                    card.error(f"element {label} already has a section")
                    continue
                owner[cells] = -2
                with suppress(Refused):
                    section = _section(deck, draft, name, cells, materials)
                    model.sections.append(section)
                    if section.element == "BEAM" or section.element.endswith("R"):
                        for cell in cells.tolist():
                            block, row = model.mesh.locate(cell)
                            rotating[model.mesh.cells[block].nodes[row]] = True
            if not len(found.cells):
                card.error(f"{draft.elset} holds no beams or springs", "ELSET")


def truss_section(draft: SectionDraft, cells: Ints, material: Material) -> Section:
    """Trusses of a ``*SOLID SECTION``, whose number is their area.

    Raises
    ------
    Refused
        After an error.
    """
    if not material.for_lines:
        text = "trusses take isotropic *ELASTIC material, with *PLASTIC, only"
        draft.card.refuse(text, "MATERIAL")
    area = draft.thickness
    return Section(cells, "TRUSS", material, area, where=draft.card.where, profile=(area, 0.0, 0.0))


def _section(
    deck: Deck, draft: LineDraft, type_: str, cells: Ints, materials: Mapping[str, Material | None]
) -> Section:
    card = draft.card
    if draft.role == "spring":
        return _spring(deck, draft, type_, cells)
    material: Material | None = draft.elastic
    if material is None:
        if key(draft.material) not in materials:
            card.refuse(f"no material named {draft.material!r}", "MATERIAL")
        material = materials[key(draft.material)]
    if material is None:
        raise Refused
    if not material.for_lines:
        card.refuse("beams take isotropic *ELASTIC material, with *PLASTIC, only", "MATERIAL")
    area, inertia, shear = draft.profile
    if draft.shear_stiffness:
        shear = draft.shear_stiffness * float(material.compliance()[3, 3])
    if type_ in ("B23", "B33"):
        shear = 0.0
    return Section(
        cells,
        "BEAM",
        material,
        area,
        where=card.where,
        profile=(area, inertia, shear),
        fibers=draft.fibers,
        height=draft.height,
        fiber=draft.fiber,
    )


def _spring(deck: Deck, draft: LineDraft, type_: str, cells: Ints) -> Section:
    card, rows = draft.card, draft.rows
    element, ends = "SPRING", (0, 0)
    if type_ != "SPRINGA":
        count = 1 if type_ == "SPRING1" else 2
        dofs = rows[0].integers(["the degree of freedom"] * count)
        for index, dof in enumerate(dofs):
            if dof not in (1, 2, 3, 4, 5, 6):
                rows[0].refuse(index, f"expected a degree of freedom 1 to 6, found {dof}")
        if any(dof not in PLANAR for dof in dofs):
            deck.note(f"{card.where}: springs in dofs {dofs} act out of the plane and are ignored")
            raise Refused
        ends = (PLANAR[dofs[0]], PLANAR[dofs[-1]])
        element = type_ + ("R" if 2 in ends else "")
        rows = rows[1:]
    nonlinear = card.has("NONLINEAR")
    if not rows or (len(rows) > 1 and not nonlinear):
        where = rows[1] if rows else draft.rows[-1]
        where.refuse(0, "one line with the stiffness must follow the dofs")
    names = ("the force", "the elongation") if nonlinear else ("the stiffness",)
    pairs = [row.reals(names) for row in rows]
    profile = (0.0 if nonlinear else pairs[0][0], float(ends[0]), float(ends[1]))
    table = tuple((e, f) for f, e in pairs) if nonlinear else ()
    try:
        return Section(cells, element, Elastic(1.0), where=card.where, profile=profile, table=table)
    except InputError as error:
        deck.error(card, rows[0].where, error.message)
        raise Refused from None
