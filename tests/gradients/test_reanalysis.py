"""The body of densities with exact contact, beside the same body meshed by hand."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota import gradients
from corota.mesh import Cells, Mesh

LENGTH, HEIGHT, FORCE = 60.0, 14.0, -14.0
#: Slit between both arms, as the filter leaves it.
BELOW, ABOVE, ROOT = 5.5, 8.5, 8.5


def tip(mesh: Mesh) -> int:
    return int(np.argmin(np.hypot(*(mesh.points - (LENGTH, HEIGHT)).T)))


def build(mesh: Mesh, thickness: Any) -> ct.Model:
    """Two arms of nylon, joined at their root; the upper one is pushed onto the lower one."""
    model = ct.Model(mesh)
    element = {"quad4": "Q4I", "tri6": "T6", "quad8": "Q8R"}[mesh.cells[0].kind]
    nylon = ct.Elastic(1800.0, 0.4)
    model.section(
        "all", element=element, material=nylon, thickness=thickness, local_strain="logarithmic"
    )
    model.fix(np.flatnonzero(mesh.points[:, 0] < 1e-6))
    model.force([tip(mesh)], y=FORCE)
    model.steps = [ct.Static(increments=4)]
    return model


def measure(mesh: Mesh) -> gradients.Measure:
    return gradients.Displacement([tip(mesh)], "y")


def by_hand() -> float:
    """Deflection of the arms as a mesh of squares without the cells of the slit."""
    whole = ct.mesh.rectangle(LENGTH, HEIGHT, 120, 28, "quad8")
    table = whole.cells[0].nodes
    x, y = whole.points[table].mean(axis=1).T
    kept = table[~((x > ROOT) & (y > BELOW) & (y < ABOVE))]
    used, numbers = np.unique(kept, return_inverse=True)
    cells = Cells("quad8", numbers.reshape(kept.shape), np.arange(1, len(kept) + 1))
    mesh = Mesh(whole.points[used], [cells])
    model = build(mesh, 5.0)
    edges = mesh.boundary_edges()
    middle = np.array([mesh.points[nodes[:2]].mean(axis=0) for nodes in mesh.edge_nodes(edges)])
    sides = [
        edges[(np.abs(middle[:, 1] - level) < 1e-6) & (middle[:, 0] > ROOT)]
        for level in (ABOVE, BELOW)
    ]
    model.contact(*sides)
    return float(ct.solve(model, threads=1).frames[-1].U[tip(mesh), 1])


def test_arms_that_meet() -> None:
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, nx=60, ny=14)
    x, y = mesh.points.T
    void = np.flatnonzero((x > 8.0) & (np.abs(y - 7.0) < 1.1))
    density = gradients.Density(mesh, 1.4, thickness=5.0, void=void, least=1e-4)
    ones = np.ones(mesh.n_nodes)
    found = gradients.reanalyze(build, density, ones, measure, threads=1)
    assert found.pressed > 0
    wanted = by_hand()
    assert found.body == pytest.approx(wanted, rel=0.02)
    # The densities know no gap, and no contact.
    assert found.error == pytest.approx(found.densities / found.body - 1.0)
    assert f"off by {found.error:+.2%}" in repr(found)
    free = gradients.reanalyze(build, density, ones, measure, contact=False, threads=1)
    assert free.pressed == 0
    assert free.body < 1.2 * found.body
