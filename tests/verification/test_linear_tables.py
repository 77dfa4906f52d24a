"""Linear tables beyond the catalogue's: alternating diagonals."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np

import corota as ct
from corota.mesh import Cells, Mesh
from support.models import COOK as COOK_CORNERS
from support.models import edge_forces, linear, nearest


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
