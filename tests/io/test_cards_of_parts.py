"""Cards of a part act in each of its instances, turned with it, on its own nodes and elements.

The part is used twice, shifted and turned by 30 degrees, in an assembly whose own nodes have the
same numbers. The second instance must move as the same body in a deck without parts does, whose
coordinates and directions are turned by hand. Abaqus turns *ORIENTATION and *TRANSFORM of a part
with its instances (Analysis User's Guide, nodal transformations); dofs stay global.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from decks import faults, read

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

C, S = math.cos(math.pi / 6.0), 0.5
NODES = {1: (0, 0), 2: (1, 0), 3: (2, 0), 4: (0, 1), 5: (1, 1), 6: (2, 1), 8: (2.5, 0.5)}
NODES |= {11: (0, 1), 12: (1.2, 1), 13: (2, 1), 14: (0, 2), 15: (1.2, 2), 16: (2, 2)}
BODY = """*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 5, 4
2, 2, 3, 6, 5
3, 11, 12, 15, 14
4, 12, 13, 16, 15
*NSET, NSET=L
1, 4
*NSET, NSET=LU
11, 14
*SURFACE, NAME=ABOVE
1, S3
2, S3
*SURFACE, NAME=BELOW
3, S1
4, S1
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
"""
MATERIAL = """*MATERIAL, NAME=M
*ELASTIC
1000., .3
*DENSITY
.1
*EXPANSION
1e-3
*SURFACE INTERACTION, NAME=HARD
"""
FIX = "*BOUNDARY\n@L, 1, 2\n@LU, 1, 2\n"
LOAD = "*CLOAD\n@6, 2, .3\n@6, 1, .5\n@13, 2, -.2\n"
#: Name: cards with directions in braces, and lines of the step in place of those above.
CARDS = {
    "mass": ("*ELEMENT, TYPE=MASS, ELSET=A\n77, 3\n*MASS, ELSET=A\n.5\n", ""),
    "dashpot": ("*ELEMENT, TYPE=DASHPOT1, ELSET=A\n77, 3\n*DASHPOT, ELSET=A\n2\n.5\n", ""),
    "gap": ("*ELEMENT, TYPE=GAPUNI, ELSET=A\n77, 3, 8\n*GAP, ELSET=A\n1e-5, {1, 1}\n", ""),
    "connector": (
        "*ORIENTATION, NAME=O\n{1, 1}, {-1, 1}\n*ELEMENT, TYPE=CONN2D2, ELSET=A\n77, 3, 8\n"
        "*CONNECTOR SECTION, ELSET=A\nSLOT,\nO,\n",
        "",
    ),
    "axes": ("*NSET, NSET=T\n3, 6\n*TRANSFORM, NSET=T\n{1, 2}, {-2, 1}\n", ""),
    "polar axes": (
        "*NSET, NSET=T\n3, 6\n*TRANSFORM, NSET=T, TYPE=C\n[0, 0], 0., [0, 0], 1.\n",
        "",
    ),
    "cut": (
        "*SURFACE, NAME=CUT\n1, S2\n*PRE-TENSION SECTION, SURFACE=CUT, NODE=8\n{1, 1}\n",
        "*CLOAD\n@8, 1, 2.\n@5, 2, 1.\n",
    ),
    "profile": (
        "*SURFACE, NAME=RIGID, TYPE=SEGMENTS\nSTART, [-1, 0]\nLINE, [3, 0]\n*RIGID BODY, "
        "ANALYTICAL SURFACE=RIGID, REF NODE=8\n*SURFACE, NAME=FOOT\n1, S1\n2, S1\n"
        "*CONTACT PAIR, INTERACTION=HARD, TYPE=SURFACE TO SURFACE\nFOOT, RIGID\n",
        "",
    ),
    "pair": (
        "*CONTACT PAIR, INTERACTION=HARD, TYPE=SURFACE TO SURFACE\nBELOW, ABOVE\n",
        "",
    ),
    "tie": ("*TIE, NAME=T, ADJUST=NO\nBELOW, ABOVE\n", ""),
    "support": ("*BOUNDARY\n3, 2\n", ""),
    "temperature": (
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n3, 10.\n",
        "*TEMPERATURE\n@3, 15.\n",
    ),
    "stress": ("*INITIAL CONDITIONS, TYPE=STRESS\n2, 5., 5., 0., 0.\n", ""),
    "velocity": ("*INITIAL CONDITIONS, TYPE=VELOCITY\n3, 2, 1.\n", ""),
    "imperfection": ("*IMPERFECTION\n3, .2, .1\n", ""),
    "nonstructural": ("*NONSTRUCTURAL MASS, ELSET=E, UNITS=TOTAL MASS\n3.\n", ""),
    "embedded": (
        "*ELEMENT, TYPE=T2D2, ELSET=A\n77, 8, 5\n*SOLID SECTION, ELSET=A, MATERIAL=M\n2.\n"
        "*EMBEDDED ELEMENT, HOST ELSET=E, EXTERIOR TOLERANCE=.6\nA\n",
        "",
    ),
}
MOVING = ("mass", "dashpot", "velocity", "nonstructural")
HELD = {"gap": "@8, 1, 2\n", "connector": "@8, 1, 2\n", "cut": "@3, 1, 2\n"}
HELD["profile"] = "@8, 1, 1, -.005\n@8, 2, 2, .00866\n@8, 6\n"


def _turned(x: float, y: float) -> tuple[float, float]:
    return C * x - S * y, S * x + C * y


def _rows(points: dict[int, tuple[float, float]]) -> str:
    return "*NODE\n" + "".join(f"{n}, {x!r}, {y!r}\n" for n, (x, y) in points.items())


def _written(cards: str, *, flat: bool) -> str:
    """Fill in directions ``{x, y}`` and points ``[x, y]``, turned in a flat deck."""

    def filled(match: re.Match[str]) -> str:
        x, y = (float(v) for v in match[0][1:-1].split(","))
        if flat:
            x, y = _turned(x, y + 50.0 * (match[0][0] == "["))
        return f"{x!r}, {y!r}, 0." if match[0][0] == "{" else f"{x!r}, {y!r}"

    return re.sub(r"\{.*?\}|\[.*?\]", filled, cards)


def _steps(name: str, prefixes: tuple[str, ...]) -> str:
    """Supports and loads of each prefix."""
    procedure = "*DYNAMIC, DIRECT\n.01, .03\n" if name in MOVING else "*STATIC\n"
    held = HELD.get(name, "")
    load = CARDS[name][1] or LOAD
    lines = (FIX + held + "*STEP\n" + procedure + load + "*END STEP\n").splitlines(keepends=True)
    return "".join(
        "".join(line.replace("@", p) for p in prefixes) if "@" in line else line for line in lines
    )


def decks(name: str) -> tuple[str, str]:
    """The deck of an assembly, and that of its second instance alone."""
    cards = BODY + CARDS[name][0]
    places = "{}, {}, 0.\n0., 0., 0., 0., 0., 1., 30.\n*END INSTANCE\n"
    own = {n: (90.0 + n, 9.0) for n in NODES}
    assembly = (
        f"*PART, NAME=P\n{_rows(NODES)}{_written(cards, flat=False)}*END PART\n*ASSEMBLY, NAME=A\n"
        f"{_rows(own)}"
        f"*INSTANCE, NAME=I, PART=P\n{places.format(0.0, 0.0)}"
        f"*INSTANCE, NAME=J, PART=P\n{places.format(0.0, 50.0)}"
        f"*END ASSEMBLY\n{MATERIAL}{_steps(name, ('I.', 'J.'))}"
    )
    there = {n: _turned(x, y + 50.0) for n, (x, y) in NODES.items()}
    flat = "** DIALECT: abaqus\n" + _rows(there) + _written(cards, flat=True) + MATERIAL
    return assembly, flat + _steps(name, ("",))


@pytest.mark.parametrize("name", CARDS)
def test_a_card_of_a_part_acts_in_each_instance(tmp_path: Path, name: str) -> None:
    """Displacements of the second instance, and of the body alone: the same to rounding."""
    assembly, flat = (read(tmp_path, text) for text in decks(name))
    alone = ct.solve(flat).frames[-1].U
    both = ct.solve(assembly).frames[-1].U
    rows = assembly.mesh.node_labels.tolist()
    wanted = [rows.index(1000 + n) for n in (3, 6, 13, 16)]
    mine = [flat.mesh.node_labels.tolist().index(n) for n in (3, 6, 13, 16)]
    assert np.abs(alone[mine]).max() > 1e-5
    np.testing.assert_allclose(both[wanted], alone[mine], rtol=0.0, atol=1e-9)


def test_a_point_mass_of_a_part_is_not_at_the_node_of_the_assembly(tmp_path: Path) -> None:
    """Weight 0.5 of a mass at node 3 of the part, with a fixed node 3 of the assembly."""
    deck = (
        f"*PART, NAME=P\n{_rows(NODES)}{BODY}*ELEMENT, TYPE=MASS, ELSET=A\n77, 3\n*MASS, ELSET=A\n"
        ".5\n*END PART\n*ASSEMBLY, NAME=A\n*NODE\n3, 9., 9.\n*NSET, NSET=RP\n3\n*INSTANCE, NAME=I, "
        f"PART=P\n*END INSTANCE\n*END ASSEMBLY\n{MATERIAL}*BOUNDARY\nI.L, 1, 2\nI.LU, 1, 2\nRP, 1, "
        "2\n*STEP\n*STATIC\n*DLOAD\nI.A, GRAV, 1., 0., -1., 0.\n*END STEP\n"
    )
    frame = ct.solve(read(tmp_path, deck)).frames[-1]
    assert frame.RF[:, 1].sum() == pytest.approx(0.5, rel=1e-9)
    assert frame.U[:, 1].min() < -1e-3


def test_connectors_of_a_part_that_is_turned_in_two_ways_are_refused(tmp_path: Path) -> None:
    """One section has one direction."""
    turned = decks("connector")[0].replace("1., 30.", "1., 45.", 1)
    found = faults(tmp_path, turned)
    assert "turned by different angles" in found[0].message
