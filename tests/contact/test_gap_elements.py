"""Gap elements: two nodes that keep apart along a direction."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.errors import DeckError
from tests.contact.test_lines import lines

if TYPE_CHECKING:
    from pathlib import Path

#: Second moment of the beams.
INERTIA = 1e-5
#: A square drawn to two fixed nodes.
DECK = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 1.5, 0.
6, 1.5, 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*ELEMENT, TYPE=GAPUNI, ELSET=G
11, 2, 5
12, 3, 6
*GAP, ELSET=G
{gap}
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1
5, 1, 2
6, 1, 2
*STEP, NLGEOM
*STATIC
*CLOAD
2, 1, 20.
3, 1, 20.
*END STEP
"""


def read(tmp_path: Path, gap: str, text: str = DECK) -> ct.Model:
    path = tmp_path / "job.inp"
    path.write_text(text.format(gap=gap), encoding="ascii")
    return ct.read(path)


@pytest.mark.parametrize("gap", [".01, 1., 0., 0.", ".01, 3.", ".01"])
def test_a_deck_has_the_forces_of_calculix(tmp_path: Path, gap: str) -> None:
    """CalculiX 2.20, a C3D8 of unit thickness: 7.462375 at each of two nodes for one here."""
    model = read(tmp_path, gap)
    frame = ct.solve(model, threads=1).frames[-1]
    np.testing.assert_allclose(frame.U[[1, 2], 0], 0.01, rtol=1e-9)
    np.testing.assert_allclose(frame.RF[[4, 5], 0], -14.92475, rtol=1e-6)
    assert frame.scalars["G-11: force x"] == pytest.approx(14.92475, rel=1e-6)


def test_an_open_gap_has_no_force(tmp_path: Path) -> None:
    model = read(tmp_path, ".1, 1., 0., 0.")
    frame = ct.solve(model, threads=1).frames[-1]
    assert np.abs(frame.RF[[4, 5]]).max() == 0.0


@pytest.mark.parametrize("clearance", [0.02, 0.0, -0.01])
@pytest.mark.parametrize("angle", [0.0, 35.0])
def test_two_cantilevers_share_a_load(clearance: float, angle: float) -> None:
    """The force is half of what the gap is short of: (P / k - c) k / 2."""
    chain = np.column_stack([np.linspace(0.0, 1.0, 5), np.zeros(5)])
    mesh = ct.mesh.move(lines(chain, chain - [0.0, 0.3]), angle=angle)
    model = ct.Model(mesh)
    for name in "ab":
        model.beam(name, material=ct.Elastic(E=1e4, nu=0.3), area=1.0, inertia=INERTIA)
    tips = [4, 9]
    model.fix([0, 5], rotation=True)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    n = (s, -c)
    model.contacts.append(ct.gap_element(mesh.points, (tips[0], tips[1]), clearance, n))
    load = 0.02
    model.force([tips[0]], x=load * n[0], y=load * n[1])
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    stiffness = 3.0 * 1e4 * INERTIA
    force = np.hypot(frame.scalars["gap: force x"], frame.scalars["gap: force y"])
    assert force == pytest.approx(0.5 * (load - stiffness * clearance), rel=1e-6)


@pytest.mark.parametrize(
    ("gap", "text", "message"),
    [
        (".01, 0., 0., 1.", DECK, "lies in the plane"),
        (".01, 0., 0., 0.", DECK, "no length"),
        (".01", DECK.replace("5, 1.5, 0.", "5, 1., 0."), "no length"),
        (".01", DECK.replace("*GAP, ELSET=G\n{gap}\n", ""), "gives these elements a value"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, gap: str, text: str, message: str) -> None:
    with pytest.raises(DeckError, match=message):
        read(tmp_path, gap, text)


def test_a_model_is_written_with_its_gaps(tmp_path: Path) -> None:
    model = read(tmp_path, "-.01, 2., 1., 0.")
    ct.write(model, tmp_path / "again.inp")
    again = ct.read(tmp_path / "again.inp")
    both = [ct.solve(m, threads=1).frames[-1].RF for m in (model, again)]
    np.testing.assert_allclose(both[0], both[1], rtol=1e-9, atol=1e-9)
