# SPDX-License-Identifier: BSD-3-Clause
"""Cells pressed beyond their height: internal modes must not hide that nodes fold them."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import corota as ct


@pytest.mark.parametrize("strain", ["linear", "green_lagrange", "logarithmic"])
@pytest.mark.parametrize(("element", "cell"), [("Q4I", "quad4"), ("Q4D", "quad4"), ("OPT", "tri3")])
def test_no_folded_cell_is_kept(element: str, cell: str, strain: str) -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2, cell))
    model.section(
        "all", element=element, material=ct.Elastic(E=1000.0, nu=0.3), local_strain=strain
    )
    model.fix("bottom")
    model.fix(np.setdiff1d(model.mesh.nodes_of("left"), model.mesh.nodes_of("top")))
    model.fix("top", y=-1.2)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(ct.ConvergenceError) as stopped:
            ct.solve(model, ct.Static(increments=10), threads=1)
    results = stopped.value.results
    assert results is not None
    assert len(results.frames) > 1
    for frame in results.frames:
        x = model.mesh.points + frame.U
        for cells in model.mesh.cells:
            corner = x[cells.nodes]
            after, before = np.roll(corner, -1, axis=1), np.roll(corner, 1, axis=1)
            area = 0.5 * np.sum(
                corner[..., 0] * after[..., 1] - corner[..., 1] * after[..., 0], axis=1
            )
            assert (area > 0.0).all()
            if cells.kind == "tri3":
                continue
            # At the points of integration, a share of .58 of the way to the corners.
            a, b = (after - corner), (before - corner)
            turn = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
            mean = turn.mean(axis=1, keepdims=True)
            assert (mean + 0.577 * (turn - mean) > 0.0).all()
