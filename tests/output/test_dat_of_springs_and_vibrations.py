"""Print files: force of springs, imaginary part of harmonic responses."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import pytest

from corota.cli import main

HEAD = """*NODE, NSET=N
1, 0., 0.
2, 2., 0.
3, 2., 1.
*ELEMENT, TYPE=SPRINGA, ELSET=LINK
1, 1, 2
*ELEMENT, TYPE=SPRING2, ELSET=BETWEEN
2, 2, 3
*ELEMENT, TYPE=SPRING1, ELSET=GROUND
3, 3
*SPRING, ELSET=LINK

50.
*SPRING, ELSET=BETWEEN
1, 1
30.
*SPRING, ELSET=GROUND
1
20.
*BOUNDARY
1, 1, 2
2, 2
3, 2
"""
STATIC = """*STEP
*STATIC
*CLOAD
2, 1, 10.
*EL PRINT, ELSET={set}
S, E, ENER
*END STEP
"""
VIBRATION = """*ELEMENT, TYPE=MASS, ELSET=BOB
9, 2
*MASS, ELSET=BOB
2.
*ELEMENT, TYPE=DASHPOT1, ELSET=OIL
8, 2
*DASHPOT, ELSET=OIL
1
3.
*BOUNDARY
3, 1
*STEP
*STEADY STATE DYNAMICS, DIRECT
{first}, 2., 2, 1.
*CLOAD
2, 1, 10.
*NODE PRINT, NSET=N
U
*END STEP
"""


@pytest.fixture(autouse=True)
def in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


#: Two squares in a row, joined by equations.
SQUARES = """*NODE, NSET=N
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 2., 0.
6, 3., 0.
7, 3., 1.
8, 2., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
2, 5, 6, 7, 8
*MATERIAL, NAME=M
*DENSITY
.001
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*EQUATION
2
5, 1, 1., 2, 1, -2.
2
8, 1, 1., 3, 1, -2.
*BOUNDARY
N, 2
1, 1
4, 1
2, 1, 1, 0.
3, 1, 1, .01
*STEP, INC=100
*DYNAMIC, DIRECT, ALPHA=0.{explicit}
.1, .5
*CLOAD
6, 1, 1.25
7, 1, 1.25
*NODE PRINT, NSET=N, FREQUENCY=5
U, RF
*END STEP
"""


def printed(path: Path, text: str) -> list[tuple[str, list[list[float]]]]:
    deck = path / "deck.inp"
    deck.write_text(text)
    assert main(["run", str(deck), "--quiet"]) == 0
    found: list[tuple[str, list[list[float]]]] = []
    for line in (path / "deck.dat").read_text().splitlines():
        if re.search(" for set ", line):
            found.append((line.split()[0], []))
        elif line.strip():
            found[-1][1].append([float(v) for v in line.split()])
    return found


@pytest.mark.parametrize(("name", "share"), [("LINK", 25.0 / 31.0), ("BETWEEN", 6.0 / 31.0)])
def test_springs_print_their_force_as_s11(tmp_path: Path, name: str, share: float) -> None:
    """As in Abaqus; CalculiX prints no rows of springs, nor is there a strain here."""
    stress, strain, energy = printed(tmp_path, HEAD + STATIC.format(set=name))
    assert stress[1][0][2] == pytest.approx(10.0 * share, rel=1e-6)
    assert stress[1][0][3:] == [0.0] * 5
    assert strain == ("strains", [])
    assert energy == ("internal", [])


def test_the_imaginary_part_follows_the_real_one(tmp_path: Path) -> None:
    """As CalculiX prints: u = F / (k - m w^2 + i w c) at a mass between two springs."""
    found = printed(tmp_path, HEAD + VIBRATION.format(first="1."))
    assert len(found) == 4
    for k, frequency in enumerate((1.0, 2.0)):
        w = 2.0 * 3.141592653589793 * frequency
        exact = 10.0 / (80.0 - 2.0 * w * w + 3.0j * w)
        (_, real), (_, imaginary) = found[2 * k : 2 * k + 2]
        assert real[1][1] == pytest.approx(exact.real, rel=1e-6)
        assert imaginary[1][1] == pytest.approx(exact.imag, rel=1e-6)


@pytest.mark.parametrize("explicit", ["", ", EXPLICIT"])
def test_forces_in_motion_are_those_of_the_elements(tmp_path: Path, explicit: str) -> None:
    """RF of CalculiX has the share of equations and inertia: what the displacements give."""
    text = SQUARES.format(explicit=explicit)
    if explicit:
        text = text.replace(", DIRECT, ALPHA=0.", "").replace(".1, .5", ".0001, .0005")
    found = printed(tmp_path, text)
    u, rf = (dict((int(row[0]), row[1]) for row in found[k][1]) for k in (-2, -1))
    for low, high in ((1, 2), (4, 3), (5, 6), (8, 7)):
        other = {1: 4, 2: 3, 4: 1, 3: 2, 5: 8, 6: 7, 8: 5, 7: 6}[low]
        across = {2: 3, 3: 2, 6: 7, 7: 6}[high]
        # Bars along x, bilinear across: a third of E (u_high - u_low) and a sixth of the other;
        # shear of the sides adds E / 2 times the differences of u across.
        axial = 1000.0 * ((u[high] - u[low]) / 3.0 + (u[across] - u[other]) / 6.0)
        shear = 500.0 * ((u[high] - u[across]) / 3.0 + (u[low] - u[other]) / 6.0)
        assert rf[high] == pytest.approx(axial + shear, abs=2e-4)
