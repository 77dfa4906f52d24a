"""Decks that only Abaqus reads: what tells them apart, and what the same cards mean there."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import pytest

import corota as ct

ROW = """*NODE, NSET=NALL
1,0,0
2,4,0
3,4,1
4,0,1
*ELEMENT, TYPE={type}, ELSET=EA
1,1,2,3,4
*MATERIAL, NAME=M
*ELASTIC
1000.,0.
*SOLID SECTION, ELSET=EA, MATERIAL=M
1.
*BOUNDARY
1,1,2
4,1
{more}*STEP, NLGEOM
*STATIC
1., 1.
*BOUNDARY
2,1,1,.4
3,1,1,.4
*END STEP
"""
#: 20 bars in a row from (0, 0) to (1, 0) under an initial stress of 100.
STRING = """*NODE
1,0.,0.
21,1.,0.
*NGEN, NSET=NALL
1,21
*ELEMENT, TYPE=T2D2
1,1,2
*ELGEN, ELSET=T
1,20
*SOLID SECTION, ELSET=T, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
1.E8
*DENSITY
1.
*INITIAL CONDITIONS, TYPE=STRESS
T,100.
*BOUNDARY
1,1,2
21,1,2
*STEP{nlgeom}
*STATIC
*END STEP
*STEP
*FREQUENCY
1
*END STEP
"""


def read(path: Path, text: str) -> ct.Model:
    deck = path / "deck.inp"
    deck.write_text(text)
    return ct.read(deck)


@pytest.mark.parametrize("type_", ["CPE4H", "CPS4I", "CPE4IH", "CPE4RH"])
def test_elements_of_abaqus_alone_take_its_strain(tmp_path: Path, type_: str) -> None:
    assert {s.local_strain for s in read(tmp_path, ROW.format(type=type_, more="")).sections} == {
        "logarithmic"
    }


@pytest.mark.parametrize("type_", ["CPS4", "CPS4R", "CPE4", "CPE4R"])
def test_elements_of_both_keep_the_strain_of_calculix(tmp_path: Path, type_: str) -> None:
    assert {s.local_strain for s in read(tmp_path, ROW.format(type=type_, more="")).sections} == {
        "green_lagrange"
    }


def test_a_card_of_abaqus_alone_takes_its_strain(tmp_path: Path) -> None:
    model = read(tmp_path, ROW.format(type="CPS4", more="*SYSTEM\n0.,0.\n"))
    assert {s.local_strain for s in model.sections} == {"logarithmic"}
    force = ct.solve(model).frames[-1].RF[1:3, 0].sum()
    # The stress times the change of volume is E ln(stretch).
    assert force == pytest.approx(1000.0 * math.log(1.1) / 1.1, rel=1e-9)


def test_a_frequency_step_keeps_the_preload_of_a_step_with_nlgeom(tmp_path: Path) -> None:
    # A string: f = sqrt(T / mu) / (2 L).
    model = read(tmp_path, STRING.format(nlgeom=", NLGEOM"))
    assert ct.solve(model).frames[-1].scalars["frequency 1"] == pytest.approx(5.0, rel=5e-3)


def test_sets_inside_a_step(tmp_path: Path) -> None:
    text = ROW.format(type="CPS4", more="").replace(
        "2,1,1,.4\n3,1,1,.4\n", "*NSET, NSET=TIP\n2,3\n*BOUNDARY\nTIP,1,1,.4\n"
    )
    model = read(tmp_path, text)
    assert sorted(model.mesh.node_sets["TIP"]) == [1, 2]
    assert ct.solve(model).frames[-1].U[1, 0] == pytest.approx(0.4)


def test_a_beam_section_with_numbers_of_points(tmp_path: Path) -> None:
    # Tip of a cantilever, B22: P L^3 / 3 E I with a pipe of radius .05, wall .005; shear below 1 %.
    text = """*NODE
1,0.,0.
2,.5,0.
3,1.,0.
4,1.5,0.
5,2.,0.
*ELEMENT, TYPE=B22, ELSET=B
1,1,2,3
2,3,4,5
*BEAM SECTION, SECTION=PIPE, ELSET=B, MATERIAL=M
.05,.005
0.,0.,-1.
9,9
*MATERIAL, NAME=M
*ELASTIC
2.E11,.3
*BOUNDARY
1,ENCASTRE
*STEP
*STATIC
*CLOAD
5,2,-100.
*END STEP
"""
    inertia = math.pi / 4.0 * (0.05**4 - 0.045**4)
    tip = ct.solve(read(tmp_path, text)).frames[-1].U[4, 1]
    assert tip == pytest.approx(-100.0 * 8.0 / (3.0 * 2e11 * inertia), rel=1e-2)


@pytest.mark.parametrize(
    ("more", "step"),
    [
        ("*SURFACE, TYPE=SEGMENTS, NAME=DIE\nSTART, 0., -1.\nLINE, 9., -1.\n", ""),
        ("*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n", ""),
        ("", ", NAME=Step-1"),
    ],
)
def test_cards_and_parameters_of_abaqus_alone(tmp_path: Path, more: str, step: str) -> None:
    text = ROW.format(type="CPS4", more=more).replace("*STEP", "*STEP" + step)
    assert {s.local_strain for s in read(tmp_path, text).sections} == {"logarithmic"}
    said = read(tmp_path, "** DIALECT: calculix\n" + text)
    assert {s.local_strain for s in said.sections} == {"green_lagrange"}
    ct.write(said, tmp_path / "written.inp")
    assert [s.local_strain for s in ct.read(tmp_path / "written.inp").sections] == [
        "green_lagrange"
    ]
