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
