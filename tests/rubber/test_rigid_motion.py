"""Nearly incompressible rubber that moves as a body: rounding must not stop internal modes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct


@pytest.mark.parametrize("element", ["Q4S", "Q4I", "Q4R", "Q8R"])
@pytest.mark.parametrize("bulk", [100.0, 1e4, 1e6])
def test_no_stress(element: str, bulk: float) -> None:
    kind = "quad8" if element == "Q8R" else "quad4"
    mesh = ct.mesh.annulus(3.2, 4.0, 2, 12, 120.0, kind)  # type: ignore[arg-type]
    model = ct.Model(mesh)
    model.section(element=element, material=ct.NeoHooke(C10=0.8, D1=2.0 / bulk), plane="strain")
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    way = mesh.points @ (turn - np.eye(2)).T + [0.3, -0.2]
    held = np.unique(np.concatenate([mesh.nodes_of("inner"), mesh.nodes_of("outer")]))
    for node in held:
        model.fix([node], x=way[node, 0], y=way[node, 1])
    results = ct.solve(model, ct.Static(increments=1, ramp=False))
    assert np.abs(results.frames[-1].U - way).max() < 1e-9
    assert abs(results.extremes("MISES").largest.value) < 1e-9 * bulk
