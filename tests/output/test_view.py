"""The interactive viewer, drawn without a window."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

pytest.importorskip("pyvista", reason="PyVista is not installed (extra view)")


@pytest.fixture(scope="module")
def results() -> ct.Results:
    model = ct.Model(ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1), name="strip")
    model.units("mm", "N")
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=0.5)
    return ct.solve(model, ct.Static(increments=4), threads=1)


def test_sliders_and_keys_change_what_is_shown(results: ct.Results) -> None:
    from corota.plots.view import Viewer

    viewer = Viewer(results, "S11", off_screen=True)
    viewer.controls()
    assert viewer.frame == 4
    viewer.show_frame(2.2)
    viewer.warp(3.0)
    moved = results.mesh.points + 3.0 * results.frame(2).U
    assert np.asarray(viewer._grid.points)[:, :2] == pytest.approx(moved, abs=1e-6)
    assert np.asarray(viewer._grid.point_data["shown"]) == pytest.approx(results.nodal("S11", 2))
    viewer.show_variable(1)
    assert viewer.name == "S22"
    viewer.toggle_edges()
    viewer.plotter.close()


def test_a_picture_is_written_without_a_window(results: ct.Results, tmp_path: Path) -> None:
    results.view("MISES", path=tmp_path / "view.png")
    assert (tmp_path / "view.png").stat().st_size > 3000


def test_a_section_is_revolved(tmp_path: Path) -> None:
    """Volume by Pappus, displacements that turn with the section, values that repeat."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell="quad8")
    mesh.points[:, 0] += 3.0
    model = ct.Model(mesh, name="ring")
    model.section("all", element="Q8R", material=ct.Elastic(1000.0, 0.3), plane="axisymmetric")
    model.fix("bottom", x=None)
    model.pressure("left", 10.0)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    solid = results.to_pyvista(-1, revolve=270.0)
    sections = 55
    assert solid.n_points == sections * mesh.n_nodes
    exact = 0.75 * np.pi * (25.0 - 9.0) * 1.0
    assert solid.compute_cell_sizes()["Volume"].sum() == pytest.approx(exact, rel=2e-3)
    moved = np.asarray(solid.point_data["displacement"])
    x, z = np.asarray(solid.points)[:, 0], np.asarray(solid.points)[:, 2]
    radial = (moved[:, 0] * x + moved[:, 2] * z) / np.hypot(x, z)
    u = results.frames[-1].U[:, 0]
    np.testing.assert_allclose(radial.reshape(sections, -1), np.tile(u, (sections, 1)), atol=1e-7)
    assert np.asarray(solid.point_data["Mises"])[-1] == pytest.approx(results.nodal("MISES")[-1])
    results.view("S33", revolve=270.0, path=tmp_path / "solid.png")
    assert (tmp_path / "solid.png").stat().st_size > 3000


def test_only_rings_are_revolved(results: ct.Results) -> None:
    with pytest.raises(ct.InputError, match="only axisymmetric models"):
        results.to_pyvista(-1, revolve=270.0)
