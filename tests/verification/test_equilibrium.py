"""What is called converged is in equilibrium, by a check of its own."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.analysis.newton import ResidualNorms
from corota.errors import ConvergenceError
from corota.model.steps import Static
from support import continuum
from support.models import DRILLING, ELEMENTS, ISOPARAMETRIC, assemble, boundary, cell, cook, linear

E, NU = 1000.0, 0.3
#: Largest residual over the largest internal force at a node; Newton's own tolerance is 1e-9.
EQUILIBRIUM = 1e-8


def random_model(seed):
    """A clamped strip with dead forces, 0.1 to 10 times what bends it well."""
    random = np.random.default_rng(seed)
    element = ELEMENTS[seed % len(ELEMENTS)]
    local_strain = ("linear", "green_lagrange")[(seed // len(ELEMENTS)) % 2]
    mesh = ct.mesh.rectangle(5.0, 1.0, 8, 2, cell(element), "alternate")
    mesh = ct.mesh.distort(mesh, 0.25, seed=seed)
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=E, nu=NU), local_strain=local_strain
    )
    model.fix("left", rotation=True)
    loads = np.zeros((mesh.n_nodes, 3))
    scale = 10.0 ** random.uniform(-1.0, 1.0)
    free = np.setdiff1d(boundary(mesh), mesh.node_sets["left"])
    corners = np.intersect1d(free, mesh.cells[0].nodes[:, :3])
    for node in random.choice(corners, 4, replace=False):
        force = scale * random.uniform(-3.0, 3.0, 2)
        model.force([int(node)], x=force[0], y=force[1])
        loads[node, :2] += force
        if element in DRILLING:
            moment = scale * random.uniform(-0.5, 0.5)
            model.force([int(node)], moment=moment)
            loads[node, 2] += moment
    return model, element, local_strain, loads


def internal_force(model, element, local_strain, frame):
    """Force and moment of the elements at each node, shape (n_nodes, 3)."""
    mesh, out = model.mesh, np.zeros((model.mesh.n_nodes, 3))
    if element in ISOPARAMETRIC and local_strain == "green_lagrange":
        nodes = mesh.cells[0].nodes
        law, c = continuum.saint_venant_kirchhoff, continuum.moduli(E, NU)
        rule = continuum.RULE[element]
        f, _ = continuum.element(mesh.points[nodes], frame.U[nodes], law, c, rule)
        part = np.zeros((mesh.n_nodes, 2))
        np.add.at(part, nodes, f)
        out[:, :2] = part
        return out
    width = 3 if element in DRILLING else 2
    u = np.column_stack([frame.U, frame.UR])[:, :width]
    out[:, :width] = assemble(model, u)[0].reshape(-1, width)
    return out


@pytest.mark.filterwarnings("ignore:.*local strain:UserWarning")
def test_random_loads_never_converge_without_equilibrium():
    converged, given_up = 0, 0
    for seed in range(54):
        model, element, local_strain, loads = random_model(seed)
        try:
            results = ct.solve(model, Static(max_increments=60), threads=1, fields=False)
            assert results.frames[-1].factor == 1.0
            converged += 1
        except ConvergenceError as error:
            results = error.results
            given_up += 1
        assert results is not None
        held = np.zeros(model.mesh.n_nodes, bool)
        held[model.mesh.node_sets["left"]] = True
        for frame in results.frames[1:]:
            force = internal_force(model, element, local_strain, frame)
            residual = (force - frame.factor * loads)[~held]
            size = np.abs(force[:, :2]).max()
            assert np.abs(residual).max() <= EQUILIBRIUM * size, (seed, element, local_strain)
    assert converged >= 30, (converged, given_up)


def test_a_moment_that_is_no_number_is_no_convergence():
    assert not ResidualNorms(1e-12, float("nan"), 0.0, 0).size <= 1e-9
    assert not ResidualNorms(float("nan"), 1e-12, 0.0, 0).size <= 1e-9


def test_small_moments_do_not_excuse_large_forces():
    """Where there are no moments to compare with, their rounding says nothing of forces."""
    assert ResidualNorms(1e-13, 1e-6, 1e-13, 0, 1e-6).rounding(1e-9)
    assert not ResidualNorms(1e-6, 0.0, 1e-13, 0, 1e-6).rounding(1e-9)


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("element", ["Q8", "Q4I", "Q4D"])
def test_small_loads_on_slender_parts_are_not_lost(element, nlgeom):
    """A ruler of 1000 x 1: its stiffness against stretching is 1e10 times that in bending."""
    mesh = ct.mesh.rectangle(1000.0, 1.0, 100, 1, cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=2e5, nu=0.0))
    model.fix("left", rotation=True)
    stiffness = 3.0 * 2e5 / 12.0 / 1000.0**3
    for deflection in (1e-6, 0.5):
        model.loads.clear()
        model.traction("right", y=deflection * stiffness)
        frame = ct.solve(model, Static(nlgeom=nlgeom), threads=1).frames[-1]
        found = frame.U[mesh.node_sets["right"], 1].mean()
        # Q4D is a little stiff in bending, one cell through the thickness.
        assert abs(found / deflection - 1.0) <= (0.02 if element == "Q4D" else 2e-3)


def test_loads_of_any_size_are_carried():
    displacement = []
    for force in (1e-60, 1.0, 1e60):
        model, tip = cook("Q4I", 2, force=force)
        displacement.append(linear(model).U[tip, 1] / force)
    assert np.ptp(displacement) <= 1e-12 * displacement[1]
