"""Tables of ``*CONTACT PRINT``: CalculiX's layout, and its numbers on one deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.io.tables.dat import dat_blocks
from corota.model.steps import Output

DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 2., 0.
6, 2., 1.
11, -.5, 1.
12, 2.5, 1.
13, 2.5, 2.
14, -.5, 2.
*ELEMENT, TYPE=CPS4, ELSET=LOW
1, 1, 2, 3, 4
2, 2, 5, 6, 3
*ELEMENT, TYPE=CPS4, ELSET=UP
3, 11, 12, 13, 14
*NSET, NSET=BOTTOM
1, 2, 5
*NSET, NSET=TOP
13, 14
*SURFACE, NAME=S
LOW, S3
*SURFACE, NAME=M
UP, S1
*MATERIAL, NAME=A
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=LOW, MATERIAL=A
1.
*SOLID SECTION, ELSET=UP, MATERIAL=A
1.
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
50000.
*FRICTION
.3, 10000.
*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE
S, M
*BOUNDARY
BOTTOM, 1, 2
*STEP, NLGEOM
*STATIC
1., 1.
*BOUNDARY
TOP, 1, 1, .001
TOP, 2, 2, -.01
*CONTACT PRINT, SLAVE=S, MASTER=M
CDIS, CSTR, CNUM, CELS, CF, CFN, CFS
*END STEP
"""
#: What CalculiX 2.20 prints for this deck (node to surface: rows; surface to surface: pair).
CCX = """
 relative contact displacement (slave node,normal,tang1,tang2) for all contact elements and time 0.1000000E+01

         3 -4.353672E-05 -7.197159E-06  2.710535E-20
         4 -2.063008E-05 -1.351133E-05  0.000000E+00
         6 -1.992458E-05  7.441331E-06  6.776197E-21

 contact stress (slave node,press,tang1,tang2) for all contact elements and time 0.1000000E+01

         3  2.162552E+00 -7.197159E-02  2.710535E-16
         4  1.017227E+00 -1.351133E-01  0.000000E+00
         6  9.819528E-01  7.441331E-02  6.776197E-17

 total number of contact elements for time  0.1000000E+01

                3

 total contact spring energy for time  0.1000000E+01

        2.112789E-04
"""  # noqa: E501
CCX_PAIR = """
 statistics for slave set S, master set M and time  0.1000000E+01

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

    3.927171E-01 -1.241917E+01  2.081668E-17 -1.889461E-13 -2.942091E-15 -1.271507E+01

   center of gravity and mean normal

    1.000578E+00  9.941447E-01 -1.734723E-18  0.000000E+00  1.000000E+00  1.047920E-17

   moment about the center of gravity(mx,my,mz)

   -1.889452E-13 -2.920581E-15  1.016972E-01

   area,  normal force (+ = tension) and shear force (size)

    2.000000E+00 -1.241917E+01  3.927171E-01
"""
NUMBER = re.compile(r" *-?\d+(\.\d+E[-+]\d+)?")


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> tuple[ct.Model, ct.Results]:
    path = Path(tmp_path_factory.mktemp("deck")) / "pressed.inp"
    path.write_text(DECK)
    model = ct.read(path)
    return model, ct.solve(model, threads=1)


def text(solved: tuple[ct.Model, ct.Results], *names: str) -> str:
    model, results = solved
    return dat_blocks(model, [Output("contact print", names, "S-M")], results.frame())


def layout(text: str) -> list[str]:
    return [NUMBER.sub("#", line) for line in text.splitlines()]


def numbers(text: str) -> np.ndarray:
    lines = [line for line in text.splitlines() if re.match(r" +-?\d\.", line)]
    return np.array([list(map(float, line.split())) for line in lines if len(line.split()) == 6])


def test_rows_have_the_layout_of_calculix(solved: tuple[ct.Model, ct.Results]) -> None:
    assert layout(text(solved, "CDIS", "CSTR", "CNUM", "CELS")) == layout(CCX)


def test_statistics_have_the_layout_of_calculix(solved: tuple[ct.Model, ct.Results]) -> None:
    assert layout(text(solved, "CF")) == layout(CCX_PAIR)


@pytest.mark.parametrize(
    ("friction", "theirs"),
    [(".3, 1e7", (0.4068357, -14.39057)), ("", (0.0, -14.23977))],
)
def test_resultant_is_that_of_calculix(
    tmp_path: Path, friction: str, theirs: tuple[float, float]
) -> None:
    """CalculiX 2.20 in plane strain; in plane stress its bricks are held across by 3e-3.

    Its stick slope is 1e7 here, since sticking is exact in Corota; the force across is only
    rounding without friction, of the size of the turn of the surface times the force.
    """
    card = f"*FRICTION\n{friction}\n" if friction else ""
    deck = DECK.replace("*FRICTION\n.3, 10000.\n", card).replace("CPS4", "CPE4")
    (tmp_path / "deck.inp").write_text(deck)
    model = ct.read(tmp_path / "deck.inp", element_map={"CPE4": "Q4"})
    scalars = ct.solve(model, threads=1).frame().scalars
    found = np.abs([scalars["S-M: force x"], scalars["S-M: force y"]])
    assert found == pytest.approx(np.abs(theirs), rel=5e-4, abs=1e-4)


def test_resultant_balances_the_reaction(solved: tuple[ct.Model, ct.Results]) -> None:
    model, results = solved
    force = numbers(text(solved, "CF"))[0]
    reaction = results.frame().RF[model.mesh.nodes_of("BOTTOM")]
    np.testing.assert_allclose(force[:2], -reaction.sum(axis=0)[:2], atol=1e-5)


def test_parts_add_up_and_friction_acts_along_the_surface(
    solved: tuple[ct.Model, ct.Results],
) -> None:
    both, normal, shear = (numbers(text(solved, name)) for name in ("CF", "CFN", "CFS"))
    np.testing.assert_allclose(both[0], normal[0] + shear[0], atol=1e-5)
    # The surface is nearly flat: its slope is below a thousandth.
    assert abs(normal[0, 0]) < 2e-3 * abs(normal[0, 1])
    assert abs(shear[0, 1]) < 5e-3 * abs(shear[0, 0])


def test_open_pairs_print_empty_tables(solved: tuple[ct.Model, ct.Results]) -> None:
    model, results = solved
    start = results.frame(0)
    start.increment = 1
    said = dat_blocks(model, [Output("contact print", ("CSTR", "CNUM"), "S-M")], start)
    assert said.splitlines()[-1].split() == ["0"]
