"""Couplings and multi-point constraints of decks: what CalculiX does with them, and what not."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

#: A cantilever of four elements; the load acts at a node one length beyond its end.
BEAM = """*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 3., 0.
5, 4., 0.
6, 0., 1.
7, 1., 1.
8, 2., 1.
9, 3., 1.
10, 4., 1.
50, 5., .5
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 7, 6
2, 2, 3, 8, 7
3, 3, 4, 9, 8
4, 4, 5, 10, 9
*MATERIAL, NAME=M
*ELASTIC
1.E3, 0.
*SOLID SECTION, ELSET=EALL, MATERIAL=M
1.
*SURFACE, NAME=RS
4, S2
{cards}*BOUNDARY
1, 1, 2
6, 1, 2
*STEP{nlgeom}
*STATIC
{load}*END STEP
"""
OLD = "*ELEMENT, TYPE={}, ELSET=DC\n100, 50\n*DISTRIBUTING COUPLING, ELSET=DC\n5, 1.\n10, 1.\n"
NEW = "*COUPLING, REF NODE=50, SURFACE=RS, CONSTRAINT NAME=C\n*DISTRIBUTING\n{}"
FORCE = "*CLOAD\n50, 2, 1.\n"


def read(path: Path, cards: str, load: str = FORCE, nlgeom: str = "") -> ct.Model:
    deck = path / "deck.inp"
    deck.write_text(BEAM.format(cards=cards, load=load, nlgeom=nlgeom))
    return ct.read(deck)


#: Axial force, moment, shear force at the middle of the end: displacement of its lower corner.
#: ``F l/EA``, ``M l h/2 EI``, Timoshenko's beam; CalculiX: ``F (l - a)/EA`` with edges ``a``.
ENDS = {
    "50, 1, 1.\n": (0, 0.004, 1e-9),
    "50, 6, 1.\n": (0, 0.024, 1e-9),
    "50, 2, 1.\n": (1, 0.256 + 1.2 * 4.0 / 500.0, 0.022),
}


@pytest.mark.parametrize("load", ENDS)
@pytest.mark.parametrize("kind", ["*DISTRIBUTING\n", "*KINEMATIC\n", "*KINEMATIC\n1, 6\n"])
def test_the_end_of_one_point_elements_moves_as_a_beam(
    kind: str, load: str, tmp_path: Path
) -> None:
    """One row of CPS4R; the bending is exact, the shear that of a coarse mesh."""
    component, wanted, tolerance = ENDS[load]
    cards = "*COUPLING, REF NODE=50, SURFACE=RS, CONSTRAINT NAME=C\n" + kind
    deck = tmp_path / "deck.inp"
    text = BEAM.format(cards=cards, load="*CLOAD\n" + load, nlgeom="")
    text = text.replace("CPS4", "CPS4R").replace("50, 5., .5", "50, 4., .5")
    deck.write_text(text)
    for as_written in (False, True):
        u = ct.solve(ct.read(deck, as_written=as_written), threads=1).frames[-1].U
        assert u[4, component] == pytest.approx(wanted, rel=tolerance)
        assert u[-1, :2] == pytest.approx(0.5 * (u[4] + u[9])[:2], rel=1e-9, abs=1e-12)


def solve(path: Path, cards: str, load: str = FORCE) -> ct.Results:
    return ct.solve(read(path, cards, load), threads=1)


def test_the_old_card_takes_the_mean_displacement_as_calculix_does(tmp_path: Path) -> None:
    """Displacements of CalculiX 2.20; the force acts as at the end, without the moment 1 x 1."""
    frame = solve(tmp_path, OLD.format("DCOUP3D")).frames[-1]
    wanted = [[0.014, 0.016], [0.032, 0.176], [0.0, 0.176]]
    np.testing.assert_allclose(frame.U[[1, 4, 10], :2], wanted, rtol=1e-9, atol=1e-12)
    assert frame.RF[[0, 5], 0].sum() == pytest.approx(0.0, abs=1e-12)
    model = read(tmp_path, OLD.format("DCOUP3D"))
    assert any("gives no moment" in note for note in model.notes)
    moved = "*BOUNDARY\n50, 2, 2, .0176\n"
    frame = solve(tmp_path, OLD.format("DCOUP3D"), moved).frames[-1]
    assert frame.U[4, 1] == pytest.approx(0.0176)


@pytest.mark.parametrize("cards", [OLD.format("DCOUP2D"), NEW.format(""), NEW.format("1, 6\n")])
def test_others_balance_the_moment(tmp_path: Path, cards: str) -> None:
    """Moment 5 at the clamp from a force at x = 5."""
    rf = solve(tmp_path, cards).frames[-1].RF
    assert rf[5, 0] - rf[0, 0] == pytest.approx(2.0 * 5.0)


def test_a_moment_on_a_rotation_that_is_not_coupled_is_refused_at_once(tmp_path: Path) -> None:
    load = FORCE + "50, 6, .5\n"
    with pytest.raises(ct.DeckError, match="leaves out the rotation") as caught:
        read(tmp_path, NEW.format("1, 3\n"), load)
    assert "couple dofs 1 to 6" in str(caught.value)
    rf = solve(tmp_path, NEW.format("1, 6\n"), load).frames[-1].RF
    assert rf[5, 0] - rf[0, 0] == pytest.approx(2.0 * 5.5)


def test_a_straight_line_turns_large_rotations_on_as_in_calculix(tmp_path: Path) -> None:
    line = "*MPC\nSTRAIGHT, 2, 3, 4\n"
    assert read(tmp_path, line, "").steps[0].nlgeom
    assert not read(tmp_path, line, "", ", NLGEOM=NO").steps[0].nlgeom
    assert not read(tmp_path, "*PREPRINT\n" + line, "").steps[0].nlgeom
