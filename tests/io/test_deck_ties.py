"""Cards of constraints: what they put into the model, and what is wrong with them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from decks import MESH, SECTION, STEP, SUPPORT, read

import corota as ct
from corota.model.constraints import Coupling, Equation, StraightLine

LOOSE = "*NODE\n20, 3., 0.5\n21, 3., 0.5\n"
EDGE = "*SURFACE, NAME=END\n2, S2\n"


def deck(lines: str, support: str = SUPPORT, step: str = STEP) -> str:
    return MESH + LOOSE + EDGE + SECTION + lines + support + step


def test_equation(tmp_path: Path) -> None:
    lines = "*EQUATION\n3\n3, 1, 1., 6, 1, -2.,\n2, 2, .5\n2\n6, 2, 1., 3, 2, -1.\n"
    model = read(tmp_path, deck(lines))
    first, second = model.constraints
    assert isinstance(first, Equation)
    assert isinstance(second, Equation)
    assert first.terms == [(2, 0, 1.0), (5, 0, -2.0), (1, 1, 0.5)]
    assert second.terms == [(5, 1, 1.0), (2, 1, -1.0)]


def test_equation_leaves_out_what_is_zero_in_the_plane(tmp_path: Path) -> None:
    model = read(tmp_path, deck("*EQUATION\n2\n3, 3, 1., 6, 3, -1.\n"))
    assert model.constraints == []


def test_rigid_body_with_a_rotation_node(tmp_path: Path) -> None:
    lines = "*NSET, NSET=END\n3, 6\n*RIGID BODY, NSET=END, REF NODE=20, ROT NODE=21\n"
    support = SUPPORT + "*BOUNDARY\n20, 1, 2\n21, 1, 2\n21, 3, 3, 0.25\n"
    model = read(tmp_path, deck(lines, support))
    body = model.constraints[0]
    assert isinstance(body, Coupling)
    assert (body.nodes, body.reference, body.kind) == ("END", 6, "kinematic")
    turned = [s for s in model.supports if s.dof == 2]
    assert len(turned) == 1
    assert turned[0].value == 0.25
    assert np.asarray(turned[0].nodes).tolist() == [6]


@pytest.mark.parametrize("kind", ["kinematic", "distributing"])
def test_coupling(tmp_path: Path, kind: str) -> None:
    lines = f"*COUPLING, REF NODE=20, SURFACE=END, CONSTRAINT NAME=C1\n*{kind.upper()}\n1, 2\n"
    model = read(tmp_path, deck(lines))
    found = model.constraints[0]
    assert isinstance(found, Coupling)
    assert found.kind == kind
    assert found.dofs == (0, 1)
    assert np.asarray(found.nodes).tolist() == [2, 5]
    if kind == "distributing":
        assert found.weights is not None
        assert found.weights.tolist() == [0.5, 0.5]


def test_mpc_beam(tmp_path: Path) -> None:
    model = read(tmp_path, deck("*MPC\nBEAM, 6, 20\n"))
    found = model.constraints[0]
    assert isinstance(found, Coupling)
    assert np.asarray(found.nodes).tolist() == [5]
    assert found.reference == 6


@pytest.mark.parametrize("rows", ["STRAIGHT, 1, 3, 0\n2", "SLIDER, 2, 1, 3"])
def test_mpc_line(tmp_path: Path, rows: str) -> None:
    model = read(tmp_path, deck(f"*MPC\n{rows}\n"))
    found = model.constraints[0]
    assert isinstance(found, StraightLine)
    assert (found.first, found.last) == (0, 2)
    assert np.asarray(found.nodes).tolist() == [1]


def test_transform(tmp_path: Path) -> None:
    lines = (
        "*NSET, NSET=R\n3\n*TRANSFORM, NSET=R\n1., 1., 0., -1., 1., 0.\n"
        "*TRANSFORM, NSET=R, TYPE=C\n5., 6., 0., 5., 6., 1.\n"
    )
    straight, round_ = read(tmp_path, deck(lines)).axes
    assert straight.angle == pytest.approx(math.pi / 4)
    assert straight.center is None
    assert round_.center == (5.0, 6.0)


def test_a_deck_with_a_rigid_end_bends_like_the_model(tmp_path: Path) -> None:
    lines = "*NSET, NSET=END\n3, 6\n*RIGID BODY, NSET=END, REF NODE=20\n"
    model = read(tmp_path, deck(lines, "*BOUNDARY\n1, 1, 2\n4, 1, 2\n"))
    frame = ct.solve(model).frames[-1]
    arm = model.mesh.points[[2, 5]] + frame.U[[2, 5]] - model.mesh.points[6] - frame.U[6]
    c, s = math.cos(frame.UR[6]), math.sin(frame.UR[6])
    before = model.mesh.points[[2, 5]] - model.mesh.points[6]
    assert arm == pytest.approx(before @ np.array([[c, s], [-s, c]]), abs=1e-12)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("*EQUATION\n2\n3, 1, 1., 6, 1\n", "2 terms need 6 numbers, 5 follow"),
        ("*EQUATION\n0\n", "the number of terms, at least 1"),
        ("*EQUATION\n1\n3, 9, 1.\n", "expected a degree of freedom 1 to 6, found 9"),
        ("*EQUATION\n1\n99, 1, 1.\n", "node 99 is not defined"),
        ("*EQUATION\n2\n3, 1, 0., 6, 1, 1.\n", "must not be zero"),
        ("*RIGID BODY, NSET=NOPE, REF NODE=20\n", "no node set named"),
        ("*RIGID BODY, REF NODE=20\n", "either NSET= or ELSET="),
        ("*RIGID BODY, ELSET=EALL\n", "REFNODE= is missing"),
        ("*COUPLING, REF NODE=20, SURFACE=END\n", "*KINEMATIC or *DISTRIBUTING is missing"),
        ("*COUPLING, REF NODE=20, SURFACE=NO\n*KINEMATIC\n", "no surface named NO"),
        ("*COUPLING, REF NODE=20, SURFACE=END\n*KINEMATIC\n3, 4\n", "no dof of the plane"),
        ("*KINEMATIC\n1, 2\n", "belongs to a *COUPLING"),
        ("*MPC\nSTRAIGHT, 1, 2\n", "at least three nodes"),
        ("*MPC\nMEANROT, 1, 2, 3\n", "MPC type 'MEANROT' is not supported"),
        ("*MPC\nBEAM, 1\n", "two nodes are expected"),
        ("*TRANSFORM, NSET=END\n1., 0., 0., -1., 0., 0.\n", "b left of it"),
        (
            "*NSET, NSET=R\n3\n*TRANSFORM, NSET=R, TYPE=C\n0.,0.,0.,1.,0.,0.\n",
            "normal to the plane",
        ),
    ],
)
def test_errors(tmp_path: Path, lines: str, message: str) -> None:
    with pytest.raises(ct.DeckError) as caught:
        read(tmp_path, deck(lines))
    assert message in str(caught.value)
