"""Faces of shells and membranes: the sides of the plane first, then the edges, as in CalculiX."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

DECK = """*NODE, NSET=NALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*ELEMENT, TYPE={type}, ELSET=EALL
1, {nodes}
*SURFACE, NAME=SIDE
EALL, {face}
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*{card} SECTION, ELSET=EALL, MATERIAL=M
2.
*BOUNDARY
1, 1, 2
4, 1, 2
*STEP
*STATIC
{load}
*END STEP
"""
PRESSURE = "*DSLOAD\nSIDE, P, -10."


def read(path: Path, type_: str = "S4", face: str = "S4", load: str = PRESSURE, turn: bool = False):
    card = {"S": "SHELL", "M": "MEMBRANE", "C": "SOLID"}[type_[0]]
    nodes = "1, 4, 3, 2" if turn else "1, 2, 3, 4"
    deck = path / "deck.inp"
    deck.write_text(DECK.format(type=type_, nodes=nodes, face=face, card=card, load=load))
    return ct.read(deck)


@pytest.mark.parametrize("type_", ["S4", "M3D4", "S4R"])
@pytest.mark.parametrize(("face", "side"), [("S3", 0), ("S4", 1), ("S5", 2), ("S6", 3), ("E2", 1)])
def test_edges_are_the_faces_from_the_third_on(tmp_path, type_, face, side):
    """CalculiX 2.20: a pressure on S4 of an S4 or M3D4 moves its edge 2-3."""
    model = read(tmp_path, type_, face)
    assert model.mesh.edge_sets["SIDE"].tolist() == [[0, side]]


@pytest.mark.parametrize(("type_", "face"), [("S4", "S4"), ("M3D4", "S4"), ("CPS4", "S2")])
def test_pull_on_the_edge_gives_the_stretch_of_calculix(tmp_path, type_, face):
    """u = p l / E = .02 (CalculiX: 2.000000E-02)."""
    frame = ct.solve(read(tmp_path, type_, face), threads=1).frames[-1]
    np.testing.assert_allclose(frame.U[1:3], [[0.02, 0.0]] * 2, atol=1e-12)


def test_a_clockwise_shell_keeps_its_faces(tmp_path):
    """Face S5 of 1, 4, 3, 2 is the edge 3-2."""
    frame = ct.solve(read(tmp_path, "S4", "S5", turn=True), threads=1).frames[-1]
    np.testing.assert_allclose(frame.U[1:3], [[0.02, 0.0]] * 2, atol=1e-12)


def test_pressure_by_number_on_a_membrane(tmp_path):
    """CalculiX 2.20 takes P4 of an M3D4 as its edge 2-3."""
    frame = ct.solve(read(tmp_path, "M3D4", "S4", "*DLOAD\n1, P4, -10."), threads=1).frames[-1]
    np.testing.assert_allclose(frame.U[1:3], [[0.02, 0.0]] * 2, atol=1e-12)


@pytest.mark.parametrize(
    ("type_", "face", "load", "said"),
    [
        ("S4", "S1", PRESSURE, "side of its plane"),
        ("S4", "S2", PRESSURE, "side of its plane"),
        ("S4", "S7", PRESSURE, "no face 7"),
        ("S4", "SPOS", PRESSURE, "expected S3 to S6"),
        ("CPS4", "E1", PRESSURE, "an edge of a shell"),
        ("CPS4", "S5", PRESSURE, "no face 5"),
        ("M3D4", "S4", "*DLOAD\n1, P1, -10.", "side of its plane"),
        ("S4", "S4", "*DLOAD\n1, P3, -10.", "normal to its plane"),
        ("S4", "S4", "*DLOAD\n1, EDNOR2, -10.", "EDNOR2"),
    ],
)
def test_what_acts_out_of_the_plane_is_refused(tmp_path, type_, face, load, said):
    with pytest.raises(ct.DeckError) as caught:
        read(tmp_path, type_, face, load)
    assert said in str(caught.value)
