"""Pseudo-rigid bodies and tables of springs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from support.flexures import bar_load, snap_through


def cantilever(load: float, n: int = 30) -> ct.Model:
    """A leaf of length and EI one along x, with a dead force across its end."""
    x = np.linspace(0.0, 1.0, n + 1)
    cells = ct.Cells("line2", np.column_stack([np.arange(n), np.arange(1, n + 1)]),
                     np.arange(1, n + 1))  # fmt: skip
    model = ct.Model(ct.Mesh(np.column_stack([x, 0.0 * x]), [cells]))
    depth = 1e-3
    leaf = ct.Elastic(E=12.0 / depth**3, nu=0.0)
    model.beam(np.arange(n), material=leaf, area=depth, inertia=depth**3 / 12.0)
    model.fix([0], rotation=True)
    model.force([n], y=load)
    model.stage("tip", [n], axis="y")
    return model


def test_pseudo_rigid_body_of_a_cantilever() -> None:
    """Howell, Compliant Mechanisms (2001), table 5.1, force across the end: n = 0."""
    # His stiffness holds up to 58.5 degrees.
    results = ct.solve(cantilever(5.3), ct.Static(increments=20), threads=1)
    found = results.stage("tip").pseudo_rigid_body(along=(1.0, 0.0))
    assert 57.0 < np.degrees(found.angle[-1]) < 60.0
    assert found.radius == pytest.approx(0.8517, rel=0.01)
    assert found.pivot == pytest.approx([1.0 - found.radius, 0.0], abs=1e-12)
    assert found.stiffness == pytest.approx(0.8517 * 2.65, rel=0.02)
    assert found.rotation_ratio == pytest.approx(1.2385, rel=0.01)
    assert found.path_error < 0.005
    assert found.moment_error < 0.03


def test_pseudo_rigid_body_of_a_rigid_link_is_exact() -> None:
    """A link of length 2 on a pin at (1, 1) with a spring of 3."""
    cells = ct.Cells("line2", np.array([[0, 1]]), np.array([1]))
    mesh = ct.Mesh(np.array([[1.0, 1.0], [1.0, 3.0]]), [cells])
    mesh.cells.append(ct.Cells("point1", np.array([[0]]), np.array([2])))
    model = ct.Model(mesh)
    model.beam([0], material=ct.Elastic(E=1e9, nu=0.0), area=1.0, inertia=1.0)
    model.spring([1], 3.0, "rotation")
    model.fix([0])
    model.force([1], x=-2.0)
    model.stage("end", [1], axis="x")
    results = ct.solve(model, ct.Static(increments=5), threads=1)
    found = results.stage().pseudo_rigid_body()
    assert found.pivot == pytest.approx([1.0, 1.0], abs=1e-6)
    assert found.radius == pytest.approx(2.0, rel=1e-6)
    assert found.stiffness == pytest.approx(3.0, rel=1e-6)
    assert found.rotation_ratio == pytest.approx(1.0, rel=1e-6)
    assert max(found.path_error, found.moment_error) < 1e-6


def test_motion_on_a_line_has_no_circle() -> None:
    model = snap_through()
    model.fix("apex", y=-0.5, x=None)
    model.stage("apex", axis=(0.0, -1.0))
    results = ct.solve(model, ct.Static(increments=3), threads=1)
    with pytest.raises(ct.InputError, match="moves on no circle"):
        results.stage().pseudo_rigid_body()
    with pytest.raises(ct.InputError, match="stages are apex"):
        results.stage("hub")


DECK = """*HEADING
a spring from a table
*PARAMETER
stage = 7
*NODE, NSET=APEX
7, 10., 2.
*INCLUDE, INPUT=apex.inp
*BOUNDARY
7, 1
7, 6
*STEP, NLGEOM
*STATIC, DIRECT
.25, 1.
*BOUNDARY
7, 2, 2, -1.5
*END STEP
"""


def test_table_of_a_spring(tmp_path: Path) -> None:
    """The snap of two bars, from the frames to a deck with a nonlinear spring."""
    model = snap_through()
    model.fix("apex", y=-4.0, x=None)
    model.stage("apex", axis=(0.0, -1.0))
    results = ct.solve(model, ct.Static(increments=16), threads=1)
    stage = results.stage("apex")
    with ct.read_results(results.write(tmp_path / "a.vtkhdf")) as read:
        assert np.array_equal(read.stage("apex").stiffness, stage.stiffness)
        assert np.array_equal(read.stage("apex").motion, stage.motion)
    table = np.genfromtxt(stage.write(tmp_path / "apex.csv"), delimiter=",", names=True)
    assert table["force_y"] == pytest.approx(-bar_load(-table["motion_y"]), abs=1e-9)
    assert table["stiffness_yy"][0] == pytest.approx(1000.0 * 4.0 / np.hypot(10, 2) ** 3, rel=1e-9)
    stage.write(tmp_path / "apex.inp")
    (tmp_path / "deck.inp").write_text(DECK, encoding="ascii")
    again = ct.solve(ct.read(tmp_path / "deck.inp"), threads=1)
    depths = np.linspace(0.0, 1.5, 5)
    found = np.interp(depths, -stage.motion[:, 1], -stage.force[:, 1])
    assert -again.history("RF2", at="APEX").values == pytest.approx(found, abs=1e-9)
    with pytest.raises(ct.InputError, match=r".csv or .inp"):
        stage.write(tmp_path / "apex.txt")
