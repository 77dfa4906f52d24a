"""Trusses, beams and springs of a model as cards of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import UnsupportedError
from corota.io.deck.drafts import PLANAR
from corota.model.materials import Elastic
from corota.profiles import RECTANGLE, rectangle

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.model.sections import Section


#: Element types of decks by our names.
LINE_TYPES = {
    "TRUSS": "T2D2",
    "BEAM": "B21",
    "SPRING": "SPRINGA",
    "SPRING1": "SPRING1",
    "SPRING1R": "SPRING1",
    "SPRING2": "SPRING2",
    "SPRING2R": "SPRING2",
}
_DOFS = {index: dof for dof, index in PLANAR.items()}


def line_cards(section: Section, elset: str, material: str) -> str:
    """The card of a section of line elements.

    Raises
    ------
    UnsupportedError
        If no card holds the cross-section of a beam.
    """
    if section.element == "TRUSS":
        return f"*SOLID SECTION, ELSET={elset}, MATERIAL={material}\n{section.profile[0]!r}\n"
    if section.element == "BEAM":
        return _beam(section, elset, material)
    text = f"*SPRING, ELSET={elset}{', NONLINEAR' if section.table else ''}\n"
    if section.element != "SPRING":
        ends = [_DOFS[int(i)] for i in section.profile[1:]]
        used = ends[:1] if section.element.startswith("SPRING1") else ends
        text += ", ".join(map(str, used)) + "\n"
    else:
        text += "\n"
    if section.table:
        return text + "".join(f"{force!r}, {way!r}\n" for way, force in section.table)
    return text + f"{section.profile[0]!r}\n"


def _beam(section: Section, elset: str, material: str) -> str:
    area, inertia, shear = (float(v) for v in section.profile)
    depth = math.sqrt(12.0 * inertia / area)
    # An elastic beam is known by its numbers, a plastic one by its fibers.
    fibers = np.array(section.fibers)
    known = section.material.linear or _alike(fibers, rectangle(area / depth, depth).fibers)
    if known and math.isclose(shear, RECTANGLE * area, rel_tol=1e-12):
        head = f"*BEAM SECTION, ELSET={elset}, MATERIAL={material}, SECTION=RECT\n"
        return head + f"{area / depth!r}, {depth!r}\n0., 0., -1.\n"
    law = section.material
    if shear == 0.0 and isinstance(law, Elastic) and not law.expansion:
        density = f", DENSITY={law.rho!r}" if law.rho else ""
        shear_modulus = law.E / (2.0 * (1.0 + law.nu))
        return (
            f"*BEAM GENERAL SECTION, ELSET={elset}, SECTION=GENERAL{density}\n"
            f"{area!r}, {inertia!r}, 0., {inertia!r}, {inertia!r}\n0., 0., -1.\n"
            f"{law.E!r}, {shear_modulus!r}\n"
        )
    raise UnsupportedError(
        f"a beam with area {area:g}, second moment {inertia:g} and shear area {shear:g} has no "
        "card in a deck: take a shear area of 5/6 of the area, or none, or keep the model in Python"
        if section.material.linear
        else "of plastic beams decks take rectangles without initial stress, in the default "
        "layers, with their shear area: keep the model in Python"
    )


def _alike(one: Floats, other: Floats) -> bool:
    return one.shape == other.shape and np.allclose(one, other, rtol=1e-9, atol=0.0)
