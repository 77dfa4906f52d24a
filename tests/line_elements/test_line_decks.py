"""Trusses, beams and springs of decks: what they become, and what they carry."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.io.formats import write
from corota.mesh.data import Cells
from support.lines import chain

if TYPE_CHECKING:
    from pathlib import Path

STEEL = "*MATERIAL, NAME=steel\n*ELASTIC\n1000., .25\n"
FRAME = """*NODE, NSET=nall
1, 0., 0.
2, 1., 0.
3, 2., 0.
"""
#: Force and elongation: 2 per unit to 0.1, then 8.
TABLE = "*SPRING, ELSET=s, NONLINEAR\n\n-2., -1.\n0.2, .1\n1., .2\n"
RECT = "*BEAM SECTION, ELSET=beam, MATERIAL=steel, SECTION=RECT\n"
STEP = """*STEP
*STATIC
*CLOAD
3, 2, -0.001
*END STEP
"""


def read(folder: Path, text: str) -> ct.Model:
    path = folder / "deck.inp"
    path.write_text(text)
    return ct.read(path)


def fault(folder: Path, text: str) -> str:
    with pytest.raises(ct.DeckError) as found:
        read(folder, text)
    return str(found.value)


def last(model: ct.Model) -> ct.results.Frame:
    return ct.solve(model, threads=1).frames[-1]


def cantilever(type_: str, section: str) -> str:
    rows = "1, 1, 2\n2, 2, 3\n" if type_[2] != "2" else "1, 1, 2, 3\n"
    return (
        f"{FRAME}*ELEMENT, TYPE={type_}, ELSET=beam\n{rows}{STEEL}{section}"
        f"*BOUNDARY\n1, 1, 6\n{STEP}"
    )


@pytest.mark.parametrize("type_", ["B21", "B31", "B31R", "B32", "B32R", "B22"])
def test_cantilever_of_every_beam_type(tmp_path: Path, type_: str) -> None:
    """Timoshenko's cantilever; beams of three nodes are two of two."""
    section = "*BEAM SECTION, ELSET=beam, MATERIAL=steel, SECTION=RECT\n0.3, 0.2\n0., 0., -1.\n"
    model = read(tmp_path, cantilever(type_, section))
    inertia, area = 0.3 * 0.2**3 / 12.0, 0.06
    expected = -1e-3 * (8.0 / (3.0 * 1000.0 * inertia) + 2.0 / (400.0 * area * 5.0 / 6.0))
    assert last(model).U[2, 1] == pytest.approx(expected, rel=1e-9)
    assert model.mesh.cell_sets["beam"].tolist() == [0, 1]


@pytest.mark.parametrize(
    ("section", "area", "inertia", "shear"),
    [
        ("RECT\n0.3, 0.2\n0., 1., 0.\n", 0.06, 0.2 * 0.3**3 / 12.0, 5.0 / 6.0),
        ("CIRC\n0.4, 0.4\n", np.pi * 0.04, np.pi * 0.2**4 / 4.0, 0.9),
        ("PIPE\n0.2, 0.1\n", np.pi * 0.03, np.pi * (0.2**4 - 0.1**4) / 4.0, 0.5),
    ],
)
def test_cross_sections(
    tmp_path: Path, section: str, area: float, inertia: float, shear: float
) -> None:
    text = f"*BEAM SECTION, ELSET=beam, MATERIAL=steel, SECTION={section}"
    profile = read(tmp_path, cantilever("B21", text)).sections[0].profile
    assert profile == pytest.approx((area, inertia, shear * area))


def test_general_section_has_its_own_moduli(tmp_path: Path) -> None:
    text = "*BEAM GENERAL SECTION, ELSET=beam\n0.5, 0.02, 0., 0.07, 0.01\n0., 0., -1.\n500., 200.\n"
    model = read(tmp_path, cantilever("B21", text))
    assert model.sections[0].profile == (0.5, 0.02, 0.0)
    assert last(model).U[2, 1] == pytest.approx(-1e-3 * 8.0 / (3.0 * 500.0 * 0.02), rel=1e-9)


@pytest.mark.parametrize("type_", ["T2D2", "T3D2"])
def test_truss_with_a_section(tmp_path: Path, type_: str) -> None:
    text = (
        f"*NODE\n1, 0., 0.\n2, 1., 1.\n3, 2., 0.\n*ELEMENT, TYPE={type_}, ELSET=bars\n"
        f"1, 1, 2\n2, 2, 3\n{STEEL}*SOLID SECTION, ELSET=bars, MATERIAL=steel\n0.1\n"
        "*BOUNDARY\n1, 1, 2\n3, 1, 2\n*STEP\n*STATIC\n*CLOAD\n2, 2, -0.01\n*END STEP\n"
    )
    frame = last(read(tmp_path, text))
    assert frame.U[1, 1] == pytest.approx(-0.01 * np.sqrt(2.0) / (1000.0 * 0.1), rel=1e-9)
    assert frame.fields[0].values["N"].ravel() == pytest.approx(-0.005 * np.sqrt(2.0))


def springs(kind: str, elements: str, card: str, load: str = "2, 1, 0.5") -> str:
    return (
        f"*NODE\n1, 0., 0.\n2, 1., 0.\n*ELEMENT, TYPE={kind}, ELSET=s\n{elements}\n{card}"
        "*BOUNDARY\n1, 1, 2\n2, 2\n"
        f"*STEP\n*STATIC\n*CLOAD\n{load}\n*END STEP\n"
    )


@pytest.mark.parametrize(
    ("kind", "elements", "card", "moved"),
    [
        ("SPRINGA", "1, 1, 2", "*SPRING, ELSET=s\n\n10.\n", 0.05),
        ("SPRING1", "1, 2", "*SPRING, ELSET=s\n1\n10.\n", 0.05),
        ("SPRING2", "1, 2, 1", "*SPRING, ELSET=s\n1, 1\n10.\n", 0.05),
        (
            "SPRINGA",
            "1, 1, 2",
            "*SPRING, ELSET=s, NONLINEAR\n\n-2., -1.\n0.2, .1\n1., .2\n",
            0.1375,
        ),
    ],
)
def test_springs(tmp_path: Path, kind: str, elements: str, card: str, moved: float) -> None:
    frame = last(read(tmp_path, springs(kind, elements, card)))
    assert frame.U[1, 0] == pytest.approx(moved, rel=1e-9)


def test_torsion_spring_to_the_ground(tmp_path: Path) -> None:
    text = (
        f"{FRAME}*ELEMENT, TYPE=B21, ELSET=beam\n1, 1, 2\n2, 2, 3\n"
        f"*ELEMENT, TYPE=SPRING1, ELSET=s\n9, 1\n{STEEL}"
        "*BEAM SECTION, ELSET=beam, MATERIAL=steel, SECTION=RECT\n1., 1.\n"
        "*SPRING, ELSET=s\n6\n4.\n*BOUNDARY\n1, 1, 2\n"
        "*STEP\n*STATIC\n*CLOAD\n1, 6, 0.2\n*END STEP\n"
    )
    assert pytest.approx(0.05, rel=1e-9) == last(read(tmp_path, text)).UR


@pytest.mark.parametrize(("type_", "turns"), [("PIN", False), ("TIE", True)])
def test_pin_and_tie_of_two_beams(tmp_path: Path, type_: str, turns: bool) -> None:
    text = (
        "*NODE\n1, 0., 0.\n2, 1., 0.\n12, 1., 0.\n3, 2., 0.\n"
        f"*ELEMENT, TYPE=B21, ELSET=beam\n1, 1, 2\n2, 12, 3\n{STEEL}"
        "*BEAM SECTION, ELSET=beam, MATERIAL=steel, SECTION=RECT\n1., 1.\n"
        f"*MPC\n{type_}, 12, 2\n*BOUNDARY\n1, 1, 6\n3, 2\n"
        "*STEP\n*STATIC\n*CLOAD\n2, 6, 0.2\n*END STEP\n"
    )
    frame = last(read(tmp_path, text))
    assert frame.U[2] == pytest.approx(frame.U[1], abs=1e-15)
    assert (abs(frame.UR[2] - frame.UR[1]) < 1e-12) == turns


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (cantilever("B21", ""), "no *BEAM SECTION"),
        (
            cantilever("B21", "*SOLID SECTION, ELSET=beam, MATERIAL=steel\n1.\n"),
            "take *BEAM SECTION",
        ),
        (
            cantilever("B21", "*BEAM SECTION, ELSET=beam, MATERIAL=steel, SECTION=RECT\n1., -1.\n"),
            "must be > 0",
        ),
        (
            cantilever("B21", RECT + "1., 1.\n1., 0., 1.\n"),
            "first axis",
        ),
        (
            cantilever("B21", "*BEAM SECTION, ELSET=beam, MATERIAL=stel, SECTION=RECT\n1., 1.\n"),
            "no material named 'stel'",
        ),
        (cantilever("B21", RECT.replace("RECT", "CIRC") + "1.\n"), "radius in Abaqus"),
        (springs("SPRING1", "1, 2", "*SPRING, ELSET=s\n7\n10.\n"), "1 to 6"),
        (springs("SPRING1", "1, 2", "*SPRING, ELSET=s\n1\n"), "stiffness"),
        (
            springs("SPRINGA", "1, 1, 2", "*SPRING, ELSET=s, NONLINEAR\n1., 2.\n2., 1.\n"),
            "increasing",
        ),
    ],
)
def test_faults_are_named(tmp_path: Path, text: str, said: str) -> None:
    assert said in fault(tmp_path, text)


def test_lines_are_written_and_read_back(tmp_path: Path) -> None:
    """Every kind of line element beside a plate: the deck gives the same answer."""
    plate = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    n, c = plate.n_nodes, plate.n_cells
    points = np.vstack([plate.points, [[3.0, 1.0], [4.0, 1.0], [3.0, 2.0]]])
    top = int(np.argmin(np.hypot(*(plate.points - [2.0, 1.0]).T)))
    ends = np.array([[top, n], [n, n + 1], [top, n + 2], [n + 2, n], [n + 2, n + 1]])
    lines = Cells("line2", ends, np.arange(c + 1, c + 6))
    ground = Cells("point1", np.array([[n + 1], [n + 2]]), np.arange(c + 6, c + 8))
    mesh = replace(
        plate,
        points=points,
        cells=[*plate.cells, lines, ground],
        node_labels=np.arange(1, len(points) + 1),
        cell_sets={},
    )
    model = ct.Model(mesh)
    steel = ct.Elastic(1000.0, 0.25, expansion=1e-4)
    model.section("all", element="Q4D", material=steel)
    model.beam([c], material=steel, area=0.4, inertia=0.03, shear_area=0.4 * 5.0 / 6.0)
    model.beam([c + 1], material=ct.Elastic(900.0, 0.25), area=0.4, inertia=0.03)
    model.truss([c + 2], material=steel, area=0.2)
    model.spring([c + 3], [[-1.0, -4.0], [0.0, 0.0], [1.0, 9.0]])
    model.spring([c + 4], 3.0, "x y")
    model.spring([c + 5], 2.0, "rotation")
    model.spring([c + 6], 5.0, "y")
    model.fix("left", rotation=True)
    model.force([n + 1], y=-0.2)
    write(model, tmp_path / "out.inp")
    again = ct.read(tmp_path / "out.inp")
    assert {s.element for s in again.sections} == {s.element for s in model.sections}
    one, two = last(model), last(again)
    assert pytest.approx(one.U, rel=1e-9, abs=1e-12) == two.U


def test_a_beam_without_a_card_is_refused(tmp_path: Path) -> None:
    model = ct.Model(chain(1, 1.0))
    model.beam([0], material=ct.Elastic(1.0), area=1.0, inertia=1.0, shear_area=0.3)
    with pytest.raises(ct.UnsupportedError, match="shear area"):
        write(model, tmp_path / "out.inp")
