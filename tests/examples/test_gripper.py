"""The compliant gripper closes as its kinematics say, and its two meshes are one."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from support.newton import solve_quadratically

if TYPE_CHECKING:
    from conftest import Load

#: Half of the last digit of the coordinates in the deck's mesh, nine digits of 100 mm.
DIGITS = 1e-7


@pytest.fixture(scope="module")
def closed(load: Load) -> ct.Results:
    return solve_quadratically(load("gripper/gripper.py").gripper(), ct.Static(increments=10))


def tip(results: ct.Results, name: str) -> np.ndarray:
    return results.frames[-1].U[results.mesh.nodes_of(name)[0]]


def test_jaws_turn_by_many_degrees_and_nearly_meet(closed: ct.Results, load: Load) -> None:
    turn = load("gripper/gripper.py").jaw_rotation(closed)
    # The jaw turns about the middle of its hinge leaf, 10 mm above the link.
    assert turn == pytest.approx(-np.degrees(np.arcsin(3.3 / 10.0)), abs=2.0)
    mesh = closed.mesh
    gap = (mesh.points[mesh.nodes_of("tip_upper")[0], 1] + tip(closed, "tip_upper")[1]) * 2.0
    assert 0.0 < gap < 4.0


def test_the_part_is_symmetric_though_its_mesh_is_not(closed: ct.Results) -> None:
    upper, lower = tip(closed, "tip_upper"), tip(closed, "tip_lower")
    np.testing.assert_allclose(lower * [1.0, -1.0], upper, rtol=2e-4)


def test_bolts_and_pin_are_in_balance(closed: ct.Results) -> None:
    pin = closed.frames[-1].RF[closed.mesh.nodes_of("pin")].sum(axis=0)
    bolts = closed.frames[-1].RF[closed.mesh.nodes_of("bolts")].sum(axis=0)
    scale = abs(pin[0])
    assert scale > 10.0
    np.testing.assert_allclose(pin[:2] + bolts[:2], 0.0, atol=1e-6 * scale)


def test_work_of_the_pin_is_the_strain_energy(closed: ct.Results) -> None:
    """Trapezoidal work over the increments, whose error is of second order in them."""
    force = np.array(closed.history("RF1", at="pin"))
    travel = np.array(closed.history("U1", at="pin"))
    work = float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(travel)))
    energy = float(np.array(closed.history("strain energy"))[-1])
    assert work == pytest.approx(energy, rel=0.01)


def test_strain_stays_small(closed: ct.Results) -> None:
    assert max(float(abs(f.values["E"]).max()) for f in closed.frames[-1].fields) < 0.05
    assert not closed.notes


def test_deck_and_gmsh_file_hold_the_same_mesh(examples: Path) -> None:
    deck = ct.read(examples / "gripper" / "gripper.inp").mesh
    gmsh = ct.mesh.read(ct.examples.path("gripper.msh"))
    np.testing.assert_allclose(deck.points, gmsh.points, atol=DIGITS)
    assert deck.n_cells == gmsh.n_cells
    for name in ("bolts", "pin", "tip_upper", "tip_lower", "grip_upper", "grip_lower"):
        assert set(deck.nodes_of(name)) == set(gmsh.nodes_of(name)), name


def test_deck_gives_the_same_result(examples: Path, closed: ct.Results) -> None:
    results = ct.solve(ct.read(examples / "gripper" / "gripper.inp"), fields=False)
    np.testing.assert_allclose(tip(results, "tip_upper"), tip(closed, "tip_upper"), rtol=1e-6)


@pytest.mark.usefixtures("quick_pictures")
def test_demo_writes_files_and_pictures(load: Load, tmp_path: Path, capsys) -> None:
    load("gripper/gripper.py").main(["--output", str(tmp_path), "--pull", "0.2"])
    said = capsys.readouterr().out
    for name in ("gripper.vtkhdf", "gripper.csv", "gripper.sta", "gripper.png"):
        assert (tmp_path / name).stat().st_size > 0
        assert name in said
