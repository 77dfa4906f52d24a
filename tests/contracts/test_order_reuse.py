"""The order of elimination of a large mesh: from coordinates, and computed once per process."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota import _core
from corota.analysis.linear.solvers import Multifrontal


def bracket(length: float) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(length, 1.0, nx=200, ny=30))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=1e-4)
    return model


def test_a_second_run_of_a_mesh_does_not_order_again() -> None:
    before = _core.computed_orders()
    first = ct.solve(bracket(9.0), ct.Static(nlgeom=False), threads=1)
    assert _core.computed_orders() == before + 1
    second = ct.solve(bracket(9.0), ct.Static(nlgeom=False), threads=2)
    assert _core.computed_orders() == before + 1
    assert np.array_equal(first.frame().U, second.frame().U)
    ct.solve(bracket(8.0), ct.Static(nlgeom=False), threads=1)
    assert _core.computed_orders() == before + 2


def test_coordinates_give_no_more_fill_than_the_graph_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sizes = []
    analyze = Multifrontal.analyze

    def watched(self: Multifrontal, *pattern: object) -> None:
        for points in (np.zeros((0, 2)), model.mesh.points):
            self.place_nodes(points)
            analyze(self, *pattern)  # type: ignore[arg-type]
            sizes.append(_core.factor_size(self._core))

    monkeypatch.setattr(Multifrontal, "analyze", watched)
    model = bracket(10.0)
    ct.solve(model, ct.Static(nlgeom=False), threads=1)
    (entries, work), (placed_entries, placed_work) = sizes
    assert placed_entries <= 1.02 * entries
    assert placed_work <= 1.02 * work
