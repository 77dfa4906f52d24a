"""Inertia of single elements and of rigid bodies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota import _core
from tests.support.models import DRILLING, ELEMENTS, cell

VECTORS = json.loads((Path(__file__).parents[1] / "data" / "element_vectors.json").read_text())
MASSES = ("consistent", "constant", "lumped")


def one_element(item):
    points = np.array(item["X"], float)
    block = {
        "element": item["element"],
        "law": "elastic",
        "parameters": [1.0, 0.3],
        "plane": "stress",
        "local_strain": "linear",
        "thickness": item["thickness"],
        "rho": item["density"],
        "nodes": np.arange(len(points), dtype=np.uint32),
    }
    return _core.Problem(points, [block], np.zeros(0, np.uint8))


def inertia(core, u, v, a, weights):
    n = core.n_dofs
    force, scale, values = np.zeros(n), np.zeros(n), np.zeros(len(core.indices))
    core.inertia(u, v, a, "consistent", list(weights), force, scale, values)
    dense = np.zeros((n, n))
    column = np.repeat(np.arange(n), np.diff(core.indptr.astype(int)))
    dense[core.indices, column] = values
    return force, dense + np.triu(dense, 1).T


@pytest.mark.parametrize("item", VECTORS["inertia"], ids=lambda i: i["element"])
def test_force_and_energy_equal_those_of_an_independent_code(item):
    core = one_element(item)
    u, v, a = (np.array(item[k], float).ravel() for k in ("u", "velocity", "acceleration"))
    force, _ = inertia(core, u, v, a, (0, 0, 0))
    expected = np.array(item["inertia_force"])
    assert np.abs(force - expected).max() <= 1e-12 * np.abs(expected).max()
    kinetic = core.momenta(u, v, "consistent", False)[0]
    assert kinetic == pytest.approx(item["kinetic_energy"], rel=1e-12)


@pytest.mark.parametrize("item", VECTORS["inertia"], ids=lambda i: i["element"])
def test_tangent_is_the_symmetric_part_of_the_derivative(item):
    core = one_element(item)
    u, v, a = (np.array(item[k], float).ravel() for k in ("u", "velocity", "acceleration"))
    weights = np.array([1.0, 0.7, 1.3])
    _, tangent = inertia(core, u, v, a, weights)
    h, n = 1e-5, core.n_dofs
    numeric = np.zeros((n, n))
    for j in range(n):
        d = [w * h * np.eye(n)[j] for w in weights]
        ahead = inertia(core, u + d[0], v + d[1], a + d[2], (0, 0, 0))[0]
        behind = inertia(core, u - d[0], v - d[1], a - d[2], (0, 0, 0))[0]
        numeric[:, j] = (ahead - behind) / (2.0 * h)
    symmetric = 0.5 * (numeric + numeric.T)
    assert np.abs(tangent - symmetric).max() <= 1e-8 * np.abs(symmetric).max()


@pytest.mark.parametrize("item", VECTORS["inertia"], ids=lambda i: i["element"])
def test_force_follows_from_lagranges_equations(item):
    # f = d/dt (dT/dv) - dT/du, with T from the momenta and derivatives by differences.
    core = one_element(item)
    u, v, a = (np.array(item[k], float).ravel() for k in ("u", "velocity", "acceleration"))
    n, h = core.n_dofs, 1e-4

    def kinetic(u, v):
        return core.momenta(u, v, "consistent", False)[0]

    def impulse(u, v):
        # T is quadratic in v: the central difference is exact.
        steps = np.eye(n)
        return np.array([(kinetic(u, v + e) - kinetic(u, v - e)) / 2.0 for e in steps])

    t = 1e-4
    ahead = impulse(u + t * v + 0.5 * t * t * a, v + t * a)
    behind = impulse(u - t * v + 0.5 * t * t * a, v - t * a)
    rate = (ahead - behind) / (2.0 * t)
    slope = np.array(
        [(kinetic(u + h * e, v) - kinetic(u - h * e, v)) / (2.0 * h) for e in np.eye(n)]
    )
    force, _ = inertia(core, u, v, a, (0, 0, 0))
    assert np.abs(force - (rate - slope)).max() <= 1e-6 * np.abs(force).max()


def block(element):
    mesh = ct.mesh.rectangle(3.0, 1.0, nx=3, ny=2, cell=cell(element))
    rng = np.random.default_rng(5)
    inner = np.setdiff1d(np.arange(mesh.n_nodes), mesh.nodes_of("left"))
    if cell(element) in ("tri3", "quad4"):
        mesh.points[inner] += rng.uniform(-0.05, 0.05, (len(inner), 2))
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=1e4, nu=0.3, rho=2.5), thickness=0.4
    )
    return model


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("element", ELEMENTS)
def test_rigid_spin_has_the_kinetic_energy_of_the_body(element, mass):
    from corota.analysis.equations import System
    from corota.analysis.linear.solvers import Multifrontal
    from corota.analysis.procedures.motion_start import initial_velocity

    model = block(element)
    omega, velocity = 1.7, (0.3, -0.4)
    model.velocity(x=velocity[0], y=velocity[1], spin=omega)
    system = System(model, Multifrontal())
    v = initial_velocity(system)
    u = np.zeros(system.n_dofs)
    kinetic, px, py, angular, mass_all = system.core.momenta(u, v, mass, False)
    # The same sums for the mass points that the option stands for: its own matrix.
    x = model.mesh.points
    zero = np.zeros(system.n_dofs)
    _, matrix = inertia_matrix(system, mass, zero)
    at = system.from_nodes(np.column_stack([x, np.zeros(len(x))]))
    one = np.where(system.component == 0, 1.0, 0.0)
    two = np.where(system.component == 1, 1.0, 0.0)
    turned = system.from_nodes(np.column_stack([-x[:, 1], x[:, 0], np.ones(len(x))]))
    polar = turned @ matrix @ turned
    total = one @ matrix @ one
    center = np.array([one @ matrix @ at, two @ matrix @ at]) / total
    assert mass_all == pytest.approx(total, rel=1e-12)
    v_center = np.array(velocity) + omega * np.array([-center[1], center[0]])
    about_center = polar - total * (center @ center)
    expected = 0.5 * total * (v_center @ v_center) + 0.5 * about_center * omega**2
    assert kinetic == pytest.approx(expected, rel=1e-12)
    assert (px, py) == pytest.approx(tuple(total * v_center), rel=1e-12)
    assert angular == pytest.approx(
        total * (center[0] * v_center[1] - center[1] * v_center[0]) + about_center * omega,
        rel=1e-12,
    )
    if mass != "lumped":
        # The matrices from shape functions carry the body's own polar moment.
        assert polar == pytest.approx(polar_moment(model), rel=1e-12)


def inertia_matrix(system, kind, u):
    n = system.n_dofs
    force, scale, values = np.zeros(n), np.zeros(n), np.zeros(len(system.pattern.indices))
    system.core.inertia(u, 0 * u, 0 * u, kind, [0.0, 0.0, 1.0], force, scale, values)
    dense = np.zeros((n, n))
    column = np.repeat(np.arange(n), np.diff(system.pattern.indptr.astype(int)))
    dense[system.pattern.indices, column] = values
    return force, dense + np.triu(dense, 1).T


def polar_moment(model):
    """Integral of rho t r^2 over straight-sided cells, by corners' triangles."""
    points = model.mesh.points
    section = model.sections[0]
    total = 0.0
    for cells in model.mesh.cells:
        corners = 3 if cells.kind.startswith("tri") else 4
        for nodes in cells.nodes[:, :corners]:
            for b, c in zip(nodes[1:-1], nodes[2:], strict=True):
                p = points[[nodes[0], b, c]]
                area = 0.5 * abs(np.cross(*(np.append(q - p[0], 0.0) for q in p[1:]))[2])
                # Exact for quadratics: the mid-sides.
                middles = 0.5 * (p + np.roll(p, -1, axis=0))
                total += area / 3.0 * (middles**2).sum()
    return section.material.rho * section.thickness * total


@pytest.mark.parametrize("element", DRILLING)
def test_steady_spin_needs_the_centripetal_force_of_the_body(element):
    from corota.analysis.equations import System
    from corota.analysis.linear.solvers import Multifrontal

    system = System(block(element), Multifrontal())
    omega = 2.0
    x = system.model.mesh.points
    v = system.from_nodes(omega * np.column_stack([-x[:, 1], x[:, 0], np.ones(len(x))]))
    a = system.from_nodes(-(omega**2) * np.column_stack([x, np.zeros(len(x))]))
    zero = np.zeros(system.n_dofs)
    force, _, _ = np.zeros(system.n_dofs), None, None
    scale = np.zeros(system.n_dofs)
    system.core.inertia(zero, v, a, "consistent", [0.0, 0.0, 0.0], force, scale, np.zeros(0))
    centripetal = np.zeros(system.n_dofs)
    system.core.body_force(
        "centrifugal",
        [omega**2, 0.0, 0.0],
        "consistent",
        [np.ones(system.model.mesh.n_cells, bool)],
        zero,
        np.zeros(0),
        0.0,
        centripetal,
        np.zeros(0),
    )
    assert np.abs(force + centripetal).max() <= 1e-12 * np.abs(force).max()
