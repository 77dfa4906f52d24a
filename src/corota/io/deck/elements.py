"""Element names of decks and the corresponding elements."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass

from corota.model import elements


@dataclass(frozen=True)
class DeckElement:
    """Cell kind, element name, and the plane state if the deck's name says it."""

    kind: str
    element: str
    plane: str = ""
    #: Literal element, where another one is used for it.
    literal: str = ""
    #: Note where this element replaces another formulation.
    note: str = ""
    #: Why a section of it must say the plane state.
    ask: str = ""


#: Elements under their own names; plane stress unless the section says otherwise.
OWN = {name: elements.find(name).cell for name in elements.names()}

#: CalculiX and Abaqus names, without the prefix.
ALIASES = {"3": "T3", "4": "Q4", "4I": "Q4I", "4R": "Q4I", "6": "T6", "8": "Q8", "8R": "Q8R"}

#: Prefix of these names, and the state of the plane.
PREFIXES = (("CPS", "stress"), ("CPE", "strain"), ("CAX", "axisymmetric"))

#: Literal elements of reduced integration; the element above is the default, see the page
#: of keywords.
LITERAL = {"4R": "Q4R"}

#: Formulations against locking, and the elements used for them.
MIXED = {
    "3H": "T3",
    "4H": "Q4I",
    "4IH": "Q4I",
    "4RH": "Q4I",
    "6H": "T6",
    "6M": "T6",
    "6MH": "T6",
    "8H": "Q8",
    "8RH": "Q8R",
}

#: Shells and membranes, which programs write for a planar part; membranes without the prefix M3D.
SHELLS = {
    "S3": "T3",
    "S3R": "T3",
    "STRI3": "T3",
    "S4": "Q4",
    "S4R": "Q4I",
    "S4R5": "Q4I",
    "S4RS": "Q4I",
    "S6": "T6",
    "STRI65": "T6",
    "S8": "Q8",
    "S8R": "Q8R",
    "S8R5": "Q8R",
    "S9R5": "Q9",
}
MEMBRANES = {"3": "T3", "4": "Q4", "4R": "Q4I", "6": "T6", "8": "Q8", "8R": "Q8R", "9": "Q9"}

#: Elements whose faces 1 and 2 are the sides of the plane, as in CalculiX; the edge from node 1 to
#: node 2 is face 3.
WITH_SIDES = frozenset((*SHELLS, *("M3D" + suffix for suffix in MEMBRANES)))

#: Names that meshio writes for any triangle and quadrilateral.
MESHIO = {"R3D3": "T3", "CAX4P": "Q4"}
#: Names with a plane that meshio writes for any cell too; its heading says that it did.
WRITTEN_BY_MESHIO = ("CPE6",)
ASK = (
    "meshio writes this name for every cell of the shape: say which plane is meant by PLANE=STRESS "
    "or STRAIN on the section"
)


def _displacement(element: str) -> str:
    large = " (Q4S at large strain)" if element == "Q4I" else ""
    return f"is taken as {element}{large}, which has no pressure or stress of its own"


ELEMENTS: dict[str, DeckElement] = {
    **{
        prefix + suffix: DeckElement(OWN[name], name, plane, LITERAL.get(suffix, ""))
        for prefix, plane in PREFIXES
        for suffix, name in ALIASES.items()
    },
    **{
        prefix + suffix: DeckElement(OWN[name], name, plane, note=_displacement(name))
        for prefix, plane in PREFIXES
        for suffix, name in MIXED.items()
        if plane != "stress" or suffix == "6M"
    },
    **{
        shell: DeckElement(
            OWN[name],
            name,
            "stress",
            "Q4R" if shell.startswith("S4R") else "",
            "is taken in plane stress: a planar part has no bending",
        )
        for shell, name in SHELLS.items()
    },
    **{
        "M3D" + suffix: DeckElement(OWN[name], name, "stress", LITERAL.get(suffix, ""))
        for suffix, name in MEMBRANES.items()
    },
    **{name: DeckElement(kind, name) for name, kind in OWN.items()},
    **{name: DeckElement(OWN[own], own, ask=ASK) for name, own in MESHIO.items()},
}


def collapsed(type_: str) -> str:
    """Name of the triangle that a quadrilateral with a side of one node is."""
    quadratic = ELEMENTS[type_].kind != "quad4"
    prefix = {plane: name for name, plane in PREFIXES}.get(ELEMENTS[type_].plane, "T")
    return prefix + ("6" if quadratic else "3")


#: Elements that have rotations at their nodes.
DRILLING = tuple(name for name in OWN if elements.find(name).drilling)

#: Line elements that mesh generators write for curves, with their number of nodes; trusses
#: where a section names them.
#: Sides of a rigid body (R2D2) name its nodes and its boundary.
LINES = {"T3D2": 2, "T3D3": 3, "T2D2": 2, "T2D3": 3, "T2D2H": 2, "T3D2H": 2, "R2D2": 2}

#: Point masses, rotary inertias, dashpots and gaps, with their number of nodes.
ATTACHED = {
    "MASS": 1,
    "ROTARYI": 1,
    "DASHPOTA": 2,
    "DASHPOT1": 1,
    "DASHPOT2": 2,
    "GAPUNI": 2,
    "CONN2D2": 2,
}


@dataclass(frozen=True)
class LineElement:
    """Kind of the cells, number of nodes in the deck, and the section it takes."""

    kind: str
    n_nodes: int
    role: str


#: Beams and springs; beams of three nodes become two of two.
LINE_ELEMENTS: dict[str, LineElement] = {
    **dict.fromkeys(
        ("B21", "B23", "B31", "B31R", "B33", "PIPE21", "PIPE31"), LineElement("line2", 2, "beam")
    ),
    **dict.fromkeys(("B22", "B32", "B32R"), LineElement("line2", 3, "beam")),
    **dict.fromkeys(("SPRINGA", "SPRING2"), LineElement("line2", 2, "spring")),
    "SPRING1": LineElement("point1", 1, "spring"),
}

_SHELL = "axisymmetric shells and membranes are not part of this version; use CAX* through the wall"
_SOLID = "only planar and axisymmetric models are computed; use CPS*, CPE* or CAX* elements"
UNSUPPORTED_ELEMENTS: dict[str, str] = {
    **dict.fromkeys(
        ("C3D4", "C3D6", "C3D8", "C3D8R", "C3D8I", "C3D10", "C3D15", "C3D20", "C3D20R"), _SOLID
    ),
    **dict.fromkeys(
        ("JOINT2D", "JOINT3D", "JOINTC"),
        "give CONN2D2 with *CONNECTOR SECTION, or *SPRING and *DASHPOT between the two nodes",
    ),
    **dict.fromkeys(
        ("GAPCYL", "GAPSPHER"), "of gaps this version has GAPUNI; use that or *CONTACT PAIR"
    ),
}

#: Families of elements by the beginning of their names, and what to do instead.
UNSUPPORTED_FAMILIES: dict[str, str] = {
    "CAXA": "loads that vary around the axis are not part of this version; use CAX*",
    "CGAX": "torsion of axisymmetric models is not part of this version; use CAX*",
    "SAX": _SHELL,
    "MAX": _SHELL,
    "C3D": _SOLID,
    "SC": _SOLID,
    "F3D": "fluids are not part of this version",
    "DC": "heat conduction is not part of this version; give temperatures by *TEMPERATURE",
    "COH": "cohesive elements are not part of this version; join the parts by *TIE",
    "CIN": "infinite elements are not part of this version; fix the outer nodes by *BOUNDARY",
    "CONN": "of connectors this version has CONN2D2; use *MPC, *EQUATION or *COUPLING",
    "CPEG": "generalized plane strain is not part of this version; use CPE*",
    "R3D": _SOLID,
    "RAX": "give a rigid ring as *SURFACE, TYPE=SEGMENTS, or as *RIGID BODY of CAX* elements",
    "U": "user elements are not part of this version; use CPS* or CPE*",
}
#: Ends of names of planar elements with more than displacements at their nodes.
UNSUPPORTED_FIELDS = {
    "T": "heat conduction is not part of this version; give temperatures by *TEMPERATURE",
    "P": "pore pressure is not part of this version; use CPS* or CPE*",
    "E": "electric potentials are not part of this version; use CPS* or CPE*",
}


def why_unsupported(type_: str) -> str:
    """Why a known element type cannot be computed, and what to do; empty if it is unknown."""
    if type_ in UNSUPPORTED_ELEMENTS:
        return UNSUPPORTED_ELEMENTS[type_]
    if type_[:3] in ("CPS", "CPE", "CAX") and type_[-1:] in UNSUPPORTED_FIELDS:
        return UNSUPPORTED_FIELDS[type_[-1]]
    for family, why in UNSUPPORTED_FAMILIES.items():
        rest = type_[len(family) :]
        if type_.startswith(family) and (rest[:1].isdigit() or family in ("CONN", "CPEG", "COH")):
            return why
    return ""
