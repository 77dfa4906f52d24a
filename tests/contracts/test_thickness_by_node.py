"""Constant stress where the thickness varies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import corota as ct
from corota.model import elements

#: Elements with an area whose constant stress is exact under any thickness of nodes.
EXACT = [n for n in elements.names() if elements.find(n).cell[:4] in ("tri3", "tri6", "quad")]


def strip(element: str, rows: int, skew: float, strain: str = "linear") -> ct.Model:
    """Strip with a thickness linear across, of cells that are distorted inside."""
    mesh = ct.mesh.rectangle(3.0, 2.0, nx=2 * rows, ny=rows, cell=elements.find(element).cell)
    if skew:
        x, y = mesh.points.T
        bump = skew * np.sin(np.pi * x / 3.0) * np.sin(np.pi * y / 2.0)
        mesh = replace(mesh, points=mesh.points + np.stack([bump, -0.5 * bump], axis=1))
    model = ct.Model(mesh)
    model.section(
        element=element,
        material=ct.Elastic(E=1000.0, nu=0.0),
        thickness=0.5 + 0.2 * mesh.points[:, 1],
        local_strain=strain,
    )
    model.fix([0])
    far = int(np.argmin(np.hypot(mesh.points[:, 0] - 3.0, mesh.points[:, 1])))
    model.fix([far], x=None)
    model.traction("left", x=-1.0)
    model.traction("right", x=1.0)
    return model


@pytest.mark.parametrize("rows", [1, 2, 4])
@pytest.mark.parametrize("element", EXACT)
def test_constant_stress_is_exact(element: str, rows: int) -> None:
    """The stress 1 along x, with a thickness that varies across it (Q4R: 4.2, OPT: 6.5 %)."""
    results = ct.solve(strip(element, rows, 0.0), ct.Static(nlgeom=False), threads=1)
    stress = results.frames[-1].fields[0].values["S"][..., [0, 1, 3]]
    assert np.allclose(stress, [1.0, 0.0, 0.0], atol=1e-9)


@pytest.mark.parametrize("element", ["Q4", "Q4R", "OPT"])
def test_constant_stress_is_exact_in_distorted_cells(element: str) -> None:
    frame = ct.solve(strip(element, 4, 0.15), ct.Static(nlgeom=False), threads=1).frames[-1]
    stress = frame.fields[0].values["S"][..., [0, 1, 3]]
    assert np.allclose(stress, [1.0, 0.0, 0.0], atol=1e-9)


def test_the_tangent_of_reduced_integration_is_exact_there() -> None:
    """One large increment converges as Newton's method does; the axial force is that of T6."""
    pulls = []
    for element in ("Q4R", "T6"):
        model = strip(element, 4, 0.15, "logarithmic")
        model.loads.clear()
        model.supports.clear()
        model.fix("left")
        model.fix("right", x=0.6, y=0.5)
        frame = ct.solve(model, ct.Static(increments=1), threads=1).frames[-1]
        assert frame.scalars["iterations"] <= 7
        pulls.append(frame.RF[model.mesh.nodes_of("right"), 0].sum())
    assert pulls[0] == pytest.approx(pulls[1], rel=0.02)
