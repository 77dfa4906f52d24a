"""The frame on a plate: balance, and a foot that does not depend on the mesh."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct


def test_the_frame_stands_in_the_plate(load, capsys, monkeypatch) -> None:
    example = load("frame_on_plate/frame_on_plate.py")
    monkeypatch.setattr("sys.argv", ["frame_on_plate.py"])
    results = example.main()
    assert "on a rigid base" in capsys.readouterr().out
    model, last = results.model, results.frames[-1]
    bottom = model.mesh.nodes_of("bottom")
    force = last.RF[bottom].sum(axis=0)
    assert force[:2] == pytest.approx([-300.0, 0.0], abs=1e-6)
    # Moment about the origin of the loads and of what holds the plate.
    x = model.mesh.points + last.U
    total = last.RF + last.F
    moment = (x[:, 0] * total[:, 1] - x[:, 1] * total[:, 0] + total[:, 2]).sum()
    assert abs(moment) < 1e-6 * 300.0 * 60.0


def test_the_sway_depends_on_the_plate_and_hardly_on_its_mesh(load) -> None:
    example = load("frame_on_plate/frame_on_plate.py")
    sways = []
    for fine, rigid in ((1, True), (1, False), (2, False)):
        model, head = example.frame(fine=fine, rigid=rigid)
        frame = ct.solve(model, ct.Static(nlgeom=False)).frames[-1]
        sways.append(frame.U[head, 0])
    assert 1.01 < sways[1] / sways[0] < 1.5
    assert sways[2] == pytest.approx(sways[1], rel=1e-2)
    assert np.isfinite(sways).all()
