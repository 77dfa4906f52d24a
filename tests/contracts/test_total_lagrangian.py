"""`green_lagrange` is the total-Lagrangian Saint Venant-Kirchhoff solid for isoparametric elements.

The comparison is the small independent program in ``tests/support/continuum.py``.
"""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.loads import EdgeLoad
from corota.model.steps import Static
from support import continuum
from support.models import ISOPARAMETRIC, assemble, cell, cook, edge_forces, single

ELEMENT, PROBLEM = 1e-11, 1e-10
E, NU, THICKNESS = 7.0, 0.3, 1.3


def random_state(n, random):
    """A distorted cell and a displacement with large rotation and strain."""
    nodes = (continuum.TRIANGLE if n in (3, 6) else continuum.QUAD)[:n]
    corners = 3 if n in (3, 6) else 4
    x = nodes + 0.0
    move = random.uniform(-0.15, 0.15, (corners, 2))
    weight, _ = continuum.shape(corners, nodes)
    x += weight @ move
    x[corners:] += random.uniform(-0.03, 0.03, (n - corners, 2))
    f = np.eye(2) + random.uniform(-0.25, 0.25, (2, 2))
    angle = random.uniform(-10.0, 10.0)
    r = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    u = x @ (r @ f).T - x + random.uniform(-0.06, 0.06, (n, 2)) + [3.0, -2.0]
    return x, u


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ISOPARAMETRIC)
def test_force_and_tangent_of_random_large_states(element, plane):
    n = {"T3": 3, "T6": 6, "Q4": 4, "Q8": 8, "Q8R": 8, "Q9": 9}[element]
    random = np.random.default_rng(17)
    for _ in range(50):
        x, u = random_state(n, random)
        force, tangent = assemble(
            single(
                element,
                x,
                E=E,
                nu=NU,
                plane=plane,
                local_strain="green_lagrange",
                thickness=THICKNESS,
            ),
            u,
        )
        expected, slope = continuum.element(
            x[None],
            u[None],
            continuum.saint_venant_kirchhoff,
            continuum.moduli(E, NU, plane),
            continuum.RULE[element],
            THICKNESS,
        )
        slope = slope.reshape(2 * n, 2 * n)
        assert np.abs(force - expected.ravel()).max() <= ELEMENT * np.abs(expected).max()
        assert np.abs(tangent - slope).max() <= ELEMENT * np.abs(slope).max()


def nodal(mesh, name, total):
    load = np.zeros((mesh.n_nodes, 2))
    for item in edge_forces(mesh, name, lambda x: (0.0, total)):
        load[item.nodes[0], item.dof] += item.value
    return load


@pytest.mark.parametrize("element", ISOPARAMETRIC)
def test_cook_membrane_in_large_strain(element):
    """Every node, to rounding; the loads reach strains of a third."""
    model, _ = cook(element, 4, local_strain="green_lagrange")
    model.loads.clear()
    forces = (0.1, 0.3, 0.6, 1.0)
    steps = [
        Static(loads=[EdgeLoad("right", "traction", (0.0, f / 16.0))], tolerance=1e-12)
        for f in forces
    ]
    results = ct.solve(model, steps, threads=1, fields=False)
    mesh = model.mesh
    held = np.zeros((mesh.n_nodes, 2), bool)
    held[mesh.node_sets["left"]] = True
    expected = continuum.solve(
        mesh.points,
        mesh.cells[0].nodes,
        continuum.saint_venant_kirchhoff,
        continuum.moduli(1.0, 1 / 3),
        continuum.RULE[element],
        [nodal(mesh, "right", f / 16.0) for f in forces],
        held,
    )
    for step, u in enumerate(expected, start=1):
        frame = [f for f in results.frames if f.step == step][-1]
        assert np.abs(frame.U - u).max() <= PROBLEM * np.abs(u).max()


def test_linear_is_the_biot_continuum_on_square_cells():
    """The limit of linear local strain: both programs converge to the same displacement."""
    errors = []
    for n in (2, 4, 8):
        mesh = ct.mesh.rectangle(4.0, 1.0, 4 * n, n, cell("Q8"))
        model = ct.Model(mesh)
        model.section("all", element="Q8", material=ct.Elastic(E=100.0, nu=0.3))
        model.fix("left")
        model.traction("right", y=2.0)
        frame = ct.solve(model, Static(increments=2), threads=1, fields=False).frames[-1]
        held = np.zeros((mesh.n_nodes, 2), bool)
        held[mesh.node_sets["left"]] = True
        u = continuum.solve(
            mesh.points,
            mesh.cells[0].nodes,
            continuum.biot_linear,
            continuum.moduli(100.0, 0.3),
            continuum.RULE["Q8"],
            [nodal(mesh, "right", 1.0), nodal(mesh, "right", 2.0)],
            held,
        )[-1]
        errors.append(np.abs(frame.U - u).max() / np.abs(u).max())
    assert errors[0] <= 2e-3
    # The clamped corners are singular, so the order stays below two.
    assert errors[2] <= 0.4 * errors[1] <= 0.16 * errors[0]
