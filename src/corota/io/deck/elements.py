"""Element names of decks and what stands for them here."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass

from corota.model import elements


@dataclass(frozen=True, slots=True)
class DeckElement:
    """Cell kind, element name, and the plane state if the deck's name says it."""

    kind: str
    element: str
    plane: str = ""
    #: What the name says to the letter, where another element stands for it.
    literal: str = ""


#: Elements under their own names; plane stress unless the section says otherwise.
OWN = {name: elements.find(name).cell for name in elements.names()}

#: CalculiX and Abaqus names, without the prefix CPS (plane stress) or CPE (plane strain).
ALIASES = {
    "3": "T3",
    "4": "Q4",
    "4I": "Q4I",
    "4R": "Q4I",
    "6": "T6",
    "8": "Q8",
    "8R": "Q8R",
}

#: What reduced integration means to the letter; the element above is the default, see the page
#: of keywords.
LITERAL = {"4R": "Q4R"}

ELEMENTS: dict[str, DeckElement] = {
    **{
        prefix + suffix: DeckElement(OWN[name], name, plane, LITERAL.get(suffix, ""))
        for prefix, plane in (("CPS", "stress"), ("CPE", "strain"))
        for suffix, name in ALIASES.items()
    },
    # FreeCAD and Gmsh write faces of a planar part as shells.
    **{
        shell: DeckElement(OWN[name], name, "stress", LITERAL.get(shell[1:], ""))
        for shell, name in {
            "S3": "T3",
            "S4": "Q4",
            "S4R": "Q4I",
            "S6": "T6",
            "S8": "Q8",
            "S8R": "Q8R",
        }.items()
    },
    **{name: DeckElement(kind, name) for name, kind in OWN.items()},
}

#: Elements that have rotations at their nodes.
DRILLING = tuple(name for name in OWN if elements.find(name).drilling)

#: Line elements that mesh generators write for curves, with their number of nodes; trusses
#: where a section names them.
LINES = {"T3D2": 2, "T3D3": 3, "T2D2": 2, "T2D3": 3}


@dataclass(frozen=True, slots=True)
class LineElement:
    """Kind of the cells, number of nodes in the deck, and the section it takes."""

    kind: str
    n_nodes: int
    role: str


#: Beams and springs; beams of three nodes become two of two.
LINE_ELEMENTS: dict[str, LineElement] = {
    **dict.fromkeys(("B21", "B23", "B31", "B31R", "B33"), LineElement("line2", 2, "beam")),
    **dict.fromkeys(("B22", "B32", "B32R"), LineElement("line2", 3, "beam")),
    **dict.fromkeys(("SPRINGA", "SPRING2"), LineElement("line2", 2, "spring")),
    "SPRING1": LineElement("point1", 1, "spring"),
}

_AXI = "axisymmetric models are not part of this version"
_SOLID = "only planar models are computed; use CPS* or CPE* elements"
UNSUPPORTED_ELEMENTS: dict[str, str] = {
    **dict.fromkeys(("CAX3", "CAX4", "CAX4R", "CAX4I", "CAX6", "CAX8", "CAX8R"), _AXI),
    **dict.fromkeys(
        ("C3D4", "C3D6", "C3D8", "C3D8R", "C3D8I", "C3D10", "C3D15", "C3D20", "C3D20R"), _SOLID
    ),
    **dict.fromkeys(("M3D3", "M3D4", "M3D4R", "M3D6", "M3D8", "M3D8R"), _SOLID),
    **dict.fromkeys(
        ("DASHPOT1", "DASHPOT2", "GAPUNI", "DCOUP3D", "ROTARYI"),
        "of dashpots this version has DASHPOTA, of masses MASS, and no gaps",
    ),
    **dict.fromkeys(
        ("CPS4H", "CPE4H", "CPE4RH", "CPE4IH", "CPE8H", "CPE8RH", "CPE3H", "CPE6H"),
        "hybrid elements are not part of this version; use CPE4I or CPE8R",
    ),
    **dict.fromkeys(
        ("CPS6M", "CPE6M"), "modified triangles are not part of this version; use CPS6 or CPE6"
    ),
}
