"""``CENT``, whose size contains the density, and damping of contact that has no effect."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import corota as ct
from corota.errors import DeckError

if TYPE_CHECKING:
    from pathlib import Path

#: A bar of two materials, densities 2 and 5, which turns about its left end.
BAR = """*NODE
1, 0., 0.
2, 1., 0.
3, 3., 0.
4, 0., 1.
5, 1., 1.
6, 3., 1.
*ELEMENT, TYPE=CPS4, ELSET=A
1, 1, 2, 5, 4
*ELEMENT, TYPE=CPS4, ELSET=B
2, 2, 3, 6, 5
*MATERIAL, NAME=LIGHT
*ELASTIC
1000., 0.
*DENSITY
2.
*MATERIAL, NAME=HEAVY
*ELASTIC
1000., 0.
*DENSITY
{density}
*SOLID SECTION, ELSET=A, MATERIAL=LIGHT
1.
*SOLID SECTION, ELSET=B, MATERIAL=HEAVY
1.
*BOUNDARY
1, 1, 2
4, 1, 2
*STEP
*STATIC
*DLOAD
{load}
*END STEP
"""


def reaction(path: Path, load: str, density: float = 5.0) -> float:
    (path / "a.inp").write_text(BAR.format(load=load, density=density))
    model = ct.read(path / "a.inp")
    return float(ct.solve(model).frames[-1].RF[:, 0].sum())


def test_size_with_the_density(tmp_path: Path) -> None:
    # The same force per volume and radius in both: 12 (1/2 + (9 - 1) / 2) = 54.
    both = "A, CENT, 12., 0., 0., 0., 0., 0., 1.\nB, CENT, 12., 0., 0., 0., 0., 0., 1."
    assert reaction(tmp_path, both) == pytest.approx(-54.0, rel=1e-12)
    square = "A, CENTRIF, 6., 0., 0., 0., 0., 0., 1.\nB, CENTRIF, 2.4, 0., 0., 0., 0., 0., 1."
    assert reaction(tmp_path, square) == pytest.approx(-54.0, rel=1e-12)


def test_a_set_of_two_densities(tmp_path: Path) -> None:
    text = BAR.replace("*BOUNDARY", "*ELSET, ELSET=AB\nA, B\n*BOUNDARY", 1)
    load = "AB, CENT, 12., 0., 0., 0., 0., 0., 1."
    (tmp_path / "a.inp").write_text(text.format(load=load, density=5.0))
    found = ct.solve(ct.read(tmp_path / "a.inp")).frames[-1].RF[:, 0].sum()
    assert float(found) == pytest.approx(-54.0, rel=1e-12)


@pytest.mark.parametrize(
    "lines", ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n100.", "*SURFACE BEHAVIOR"]
)
@pytest.mark.parametrize("moves", [False, True])
@pytest.mark.parametrize("definition", ["CRITICAL DAMPING FRACTION", "DAMPING COEFFICIENT"])
def test_damping_of_contact(tmp_path: Path, lines: str, moves: bool, definition: str) -> None:
    contact = f"""*SURFACE, NAME=S
A, S1
*SURFACE, TYPE=SEGMENTS, NAME=FLOOR
START, -9., 0.
LINE, 9., 0.
*SURFACE INTERACTION, NAME=I
{lines}
*CONTACT DAMPING, DEFINITION={definition}
0.03
*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE
S, FLOOR
*BOUNDARY"""
    text = BAR.replace("*BOUNDARY", contact, 1).format(load="A, P3, 1.", density=5.0)
    if moves:
        text = text.replace("*STATIC", "*DYNAMIC\n.1, 1.")
    (tmp_path / "a.inp").write_text(text)
    hard = "LINEAR" not in lines
    if moves and not (hard and "FRACTION" in definition):
        with pytest.raises(DeckError, match="damping of contact"):
            ct.read(tmp_path / "a.inp")
        return
    said = "hard contact has no spring" if moves else "damped in dynamic steps only"
    notes = ct.read(tmp_path / "a.inp").notes
    assert any(said in note for note in notes)
