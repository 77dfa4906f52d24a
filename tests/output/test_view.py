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
