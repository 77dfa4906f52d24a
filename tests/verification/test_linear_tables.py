"""Published linear tables: Cook's membrane, short cantilever, straight and curved beams, bending.

Element rows were computed by an independent implementation, to the digits given; drilling
rotations are free at clamps unless a row says otherwise. "left" diagonals run from the lower
right to the upper left corner, "right" ones the other way, "alternate" in turn.
"""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.mesh import Cells, Mesh
from support.models import COOK as COOK_CORNERS
from support.models import DRILLING, assemble, cell, cook, edge_forces, linear, nearest

COOK = [
    ("Q4", "right", False, [11.8452, 18.2992, 22.0792, 23.4304, 23.8176]),
    ("Q4I", "right", False, [21.0503, 23.0164, 23.6888, 23.8833, 23.9398]),
    ("Q8", "right", False, [22.7177, 23.7083, 23.8837, 23.9346, 23.9551]),
    ("Q9", "right", False, [23.2887, 23.8397, 23.9254, 23.9494, 23.9608]),
    ("Q4D", "right", False, [22.27, 23.36, 23.77, 23.90]),
    ("Q4D", "right", True, [21.40, 23.07, 23.63]),
    ("OPT", "left", False, [20.5644, 22.4495, 23.4323, 23.7987, 23.9115]),
    ("OPT", "left", True, [19.49]),
]


@pytest.mark.parametrize(("element", "diagonal", "clamp", "row"), COOK)
def test_cook_membrane(element, diagonal, clamp, row):
    """Vertical displacement at (48, 52); the converged value is 23.9664."""
    digits = 4 if any(round(v, 2) != v for v in row) else 2
    for k, expected in enumerate(row):
        model, tip = cook(element, 2 ** (k + 1), diagonal=diagonal, clamp=clamp)
        found = linear(model).U[tip, 1]
        assert abs(found - expected) <= 0.51 * 10.0**-digits, (2 ** (k + 1), found)


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


SHORT = [
    ("Q4", "right", [0.24242, 0.31620, 0.34470, 0.35301, 0.35525]),
    ("Q4I", "right", [0.34933, 0.35167, 0.35455, 0.35557, 0.35591]),
    ("Q4D", "right", [0.34022, 0.37132, 0.36043, 0.35723, 0.35637]),
    ("OPT", "left", [0.37370, 0.36302, 0.35739, 0.35620, 0.35604]),
    ("Q8", "right", [0.34955, 0.35482, 0.35569, 0.35594, 0.35602]),
    ("Q9", "right", [0.35208, 0.35533, 0.35586, 0.35600, 0.35605]),
]


@pytest.mark.parametrize(("element", "diagonal", "row"), SHORT)
def test_short_cantilever(element, diagonal, row):
    """Parabolic end shear of 40 on 48 x 12; work-average of the tip displacement."""
    for k, expected in enumerate(row):
        nx, ny = 4 * 2**k, 2**k
        mesh = ct.mesh.rectangle(48.0, 12.0, nx, ny, cell(element), diagonal, origin=(0.0, -6.0))
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=30000.0, nu=0.25))
        model.fix("left")
        model.loads += edge_forces(mesh, "right", lambda x: (0.0, 5.0 * (1 - (x[1] / 6) ** 2)))
        frame = linear(model)
        found = float((frame.F[:, 1] * frame.U[:, 1]).sum() / 40.0)
        assert abs(found - expected) <= 0.51e-5, (nx, found)


def slanted(kind, shift, kind_of_cell):
    """Six cells of MacNeal and Harder's straight beam, 6 x 0.2."""
    mesh = ct.mesh.rectangle(6.0, 0.2, 6, 1, kind_of_cell, "right")
    for n, (x, y) in enumerate(mesh.points):
        i = round(x)
        if 0 < i < 6:
            side = 1.0 if y > 0.1 else -1.0
            sign = 1.0 if kind == "parallelogram" or i % 2 else -1.0
            mesh.points[n, 0] += shift * side * sign * (kind != "rectangle")
    return mesh


STRAIGHT = [
    # shift, clamped rotations, rows by element: rectangle, trapezoid, parallelogram
    (0.2, {"Q4": (0.0933, 0.0172, 0.0197), "Q4I": (0.9929, 0.0262, 0.6175),
           "Q4D": (0.9754, 0.6022, 0.6339), "OPT": (1.0517, 0.1606, 0.1660)}),
    (0.1, {"Q4": (0.0933, 0.0269, 0.0342), "Q4I": (0.9929, 0.0515, 0.6323),
           "Q4D": (0.9754, 0.8563, 0.8733), "OPT": (1.0517, 0.5122, 0.5302)}),
]  # fmt: skip


@pytest.mark.parametrize(
    ("shift", "element", "row"), [(s, e, r) for s, rows in STRAIGHT for e, r in rows.items()]
)
def test_straight_beam_of_six_elements(shift, element, row):
    """Tip over the published 0.1081 (beam theory 0.1080936) under unit end shear.

    Rotations are clamped; diagonals "right".
    """
    shapes = ("rectangle", "trapezoid", "parallelogram")
    for shape, expected in zip(shapes, row, strict=True):
        mesh = slanted(shape, shift, cell(element))
        model = ct.Model(mesh)
        material = ct.Elastic(E=1e7, nu=0.3)
        model.section("all", element=element, material=material, thickness=0.1)
        model.fix("left", rotation=True)
        model.traction("right", y=1.0 / 0.02)
        found = linear(model).U[mesh.node_sets["right"], 1].mean() / 0.1081
        assert abs(found - expected) <= 0.51e-4, (shape, found)


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


@pytest.mark.parametrize(
    ("element", "radial", "around"),
    [("Q4I", 4, 64), ("Q8", 2, 24), ("Q8R", 2, 24), ("Q9", 2, 24), ("T6", 2, 24),
     ("Q4D", 4, 64), ("OPT", 4, 64)],
)  # fmt: skip
def test_curved_beam(element, radial, around):
    """MacNeal and Harder's curved beam under unit tip shear: 0.0886 on fine meshes.

    Source: S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed., section 33:
    0.08856553 with the clamp of elasticity, 0.08860200 by beam theory with shear.
    """
    mesh = ct.mesh.annulus(4.12, 4.32, radial, around, angle=90.0, cell=cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e7, nu=0.25), thickness=0.1)
    model.fix("end", rotation=True)
    model.traction("start", x=1.0 / 0.02)
    frame = linear(model)
    tip = mesh.node_sets["start"]
    assert abs(abs(frame.U[tip, 0].mean()) / 0.0886 - 1.0) <= 0.005
