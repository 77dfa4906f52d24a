"""Linear tables beyond the catalogue's: alternating diagonals, bending of one rectangle."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.mesh import Cells, Mesh
from support.models import COOK as COOK_CORNERS
from support.models import DRILLING, assemble, cell, edge_forces, linear, nearest


def test_cook_membrane_of_triangles_with_alternating_diagonals():
    """OPT; the first diagonal runs from the lower right to the upper left corner."""
    for n, expected in ((2, 20.36), (4, 22.34), (8, 23.33), (16, 23.76)):
        quads = ct.mesh.mapped(COOK_CORNERS, n, n)
        triangles = []
        for k, (a, b, c, d) in enumerate(quads.cells[0].nodes):
            left = (k % n + k // n) % 2 == 0
            triangles += [(a, b, d), (b, c, d)] if left else [(a, b, c), (a, c, d)]
        cells = Cells("tri3", np.array(triangles), np.arange(1, len(triangles) + 1))
        mesh = Mesh(quads.points, [cells], node_sets=quads.node_sets)
        model = ct.Model(mesh)
        model.section("all", element="OPT", material=ct.Elastic(E=1.0, nu=1 / 3))
        model.fix("left")
        model.loads += edge_forces(quads, "right", lambda x: (0.0, 1 / 16))
        found = linear(model).U[nearest(mesh, 48.0, 52.0), 1]
        assert abs(found - expected) <= 0.51e-2, (n, found)


def bending_energy(element, a, b):
    """Energy of one rectangle a x b in pure bending over the exact one."""
    mesh = ct.mesh.rectangle(a, b, 1, 1, cell(element), "right", origin=(-a / 2, -b / 2))
    E, kappa = 1000.0, 0.01
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=0.3))
    x, y = mesh.points.T
    columns = [kappa * x * y, -0.5 * kappa * (x**2 - 0.25 * a**2)]
    if element in DRILLING:
        columns.append(-kappa * x)
    u = np.stack(columns, axis=1)
    force, _ = assemble(model, u, nlgeom=False)
    return 0.5 * force @ u.ravel() / (0.5 * E * b**3 / 12.0 * kappa**2 * a)


BENDING = {
    "Q4": ((1.4835, 2.6374, 7.2527, 25.714, 99.560), 5e-4),
    "Q4I": ((1.0, 1.0, 1.0, 1.0, 1.0), 1e-12),
    "OPT": ((1.0, 1.0, 1.0, 1.0, 1.0), 1e-12),
    "Q4D": ((1.042, 1.025, 1.019, 1.017, 1.017), 6e-4),
}


@pytest.mark.parametrize("element", BENDING)
def test_bending_of_a_rectangle(element):
    row, tolerance = BENDING[element]
    for aspect, expected in zip((1, 2, 4, 8, 16), row, strict=True):
        found = bending_energy(element, float(aspect), 1.0)
        assert abs(found / expected - 1.0) <= tolerance, (aspect, found)
