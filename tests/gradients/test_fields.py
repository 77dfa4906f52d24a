"""Gradients by all nodes and elements, and by data of a model, beside gradients by few numbers."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import corota as ct
from corota import gradients
from corota.model import elements


def plate(element: str = "Q4I", law: object = None, **options: object) -> ct.Model:
    cell = {"Q8": "quad8", "OPT": "tri3"}.get(element, "quad4")
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=cell))
    material = law or ct.Elastic(E=1000.0, nu=0.3, rho=2.0)
    model.section("all", element=element, material=material, thickness=0.7, **options)
    model.fix("left")
    # At the nodes: what an edge spreads depends on its nodes and its thickness.
    model.force(model.mesh.node_sets["right"], y=-0.3, x=0.2)
    model.steps = [ct.Static(increments=3, fixed_increments=True, tolerance=1e-13)]
    return model


FLOWS = ct.Mises(1000.0, 0.3, yield_stress=5.0, isotropic=60.0)
CASES = [
    ("Q4I", None, {}),
    ("Q8", None, {"local_strain": "green_lagrange"}),
    ("OPT", None, {"plane": "strain"}),
    ("Q4D", None, {"local_strain": "logarithmic"}),
    ("Q4I", FLOWS, {}),
    ("Q8", ct.NeoHooke(C10=170.0, D1=0.004), {}),
]
TIP = [gradients.Displacement("right", "y"), gradients.Reaction("left", "y")]


@pytest.mark.parametrize(("element", "law", "options"), CASES)
def test_positions_are_the_sum_of_shapes(element: str, law: object, options: dict) -> None:
    """Duals of the elements against varied models, along three random motions of the nodes."""
    results = ct.solve(plate(element, law, **options), threads=1)
    n = results.mesh.n_nodes
    motions = np.random.default_rng(3).standard_normal((3, n, 2)) * 0.1
    by_node, by_shape = ct.gradient(results, TIP, [gradients.Positions(), gradients.Shape(motions)])
    assert by_node.shape == (2, n, 2)
    expected = np.einsum("mni,kni->mk", by_node, motions)
    np.testing.assert_allclose(by_shape, expected, rtol=1e-7, atol=1e-8)


@pytest.mark.parametrize(("element", "law", "options"), CASES)
def test_thickness_by_element_node_and_section(element: str, law: object, options: dict) -> None:
    results = ct.solve(plate(element, law, **options), threads=1)

    def write(model: ct.Model, values: np.ndarray) -> None:
        model.sections[0] = replace(model.sections[0], thickness=float(values))

    whole = gradients.Attribute(lambda model: model.sections[0].thickness, write)
    kinds = ["element", "section"] + ["node"] * (element != "OPT")
    fields = [gradients.Thickness(by) for by in kinds]
    *found, exact = ct.gradient(results, TIP[0], [*fields, whole])
    assert found[0].shape == (results.mesh.n_cells,)
    for field in found:
        assert field.sum() == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4S", "Q4D", "Q4I", "Q8", "Q8R", "Q9"])
def test_thickness_of_single_nodes(element: str) -> None:
    """Along a random change of the nodes, beside differences: a sum over nodes hides the slopes."""
    cell = elements.find(element).cell
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=cell)
    rng = np.random.default_rng(1)
    start, change = 0.7 + 0.1 * rng.random(mesh.n_nodes), rng.standard_normal(mesh.n_nodes)

    def run(step: float) -> ct.Results:
        model = ct.Model(mesh)
        law = ct.Elastic(E=1000.0, nu=0.3)
        model.section("all", element=element, material=law, thickness=start + step * change)
        model.fix("left")
        model.force(mesh.node_sets["right"], y=-0.3, x=0.2)
        return ct.solve(model, ct.Static(increments=2, tolerance=1e-13), threads=1)

    slope = ct.gradient(run(0.0), TIP[0], gradients.Thickness("node")) @ change
    ends = [run(h).history("U2", at="right")[-1] for h in (1e-5, -1e-5)]
    assert slope == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=1e-6)


def test_constants_orientation_and_loads() -> None:
    """Stiffness is proportional to the moduli: their gradients and that of the load cancel."""
    law = ct.Orthotropic(1000.0, 500.0, 700.0, 0.25, 0.2, 0.3, 250.0)
    model = plate(law=law, orientation=0.3)
    results = ct.solve(model, threads=1)
    names = ("E1", "E2", "E3", "G12")
    moduli = [gradients.Constant(name) for name in names]

    def write(varied: ct.Model, values: np.ndarray) -> None:
        varied.loads[:] = [
            replace(load, value=float(v)) for load, v in zip(varied.loads, values, strict=True)
        ]

    force = gradients.Attribute(lambda m: [load.value for load in m.loads], write)
    *by_modulus, by_angle, by_force = ct.gradient(
        results, TIP[0], [*moduli, gradients.Orientation(), force]
    )
    sizes = [getattr(law, name) for name in names]
    total = np.dot(np.array(by_modulus), sizes)
    given = np.array([load.value for load in model.loads])
    assert total == pytest.approx(-np.sum(np.asarray(by_force) * given), rel=1e-8)
    turned = [
        ct.solve(plate(law=law, orientation=0.3 + h), threads=1).history("U2", at="right")[-1]
        for h in (1e-3, -1e-3)
    ]
    assert float(by_angle) == pytest.approx((turned[0] - turned[1]) / 2e-3, rel=1e-5)


def test_measures_combine_and_take_other_frames() -> None:
    results = ct.solve(plate(), threads=1)
    tip = gradients.Displacement("right", "y")
    before = gradients.Displacement("right", "y", frame=1)
    modulus = gradients.Constant("E")
    parts = ct.gradient(results, [tip, before, 2.0 * tip / before - 1.0, tip**2.0], modulus)
    u = results.history("U2", at="right")
    quotient = 2.0 * (parts[0] / u[1] - parts[1] * u[-1] / u[1] ** 2)
    assert parts[2] == pytest.approx(quotient, rel=1e-12)
    assert parts[3] == pytest.approx(2.0 * u[-1] * parts[0], rel=1e-12)


def test_fields_on_the_way_back_equal_those_of_another_walk() -> None:
    """Two steps, two measures, one of them in the middle of the path."""
    model = plate("Q4I", FLOWS)
    back = ct.Static(increments=2, fixed_increments=True, tolerance=1e-13)
    back.force(model.mesh.node_sets["right"], y=0.2)
    model.steps.append(back)
    results = ct.solve(model, threads=1)
    measures = [*TIP, gradients.Displacement("right", "x", frame=2)]
    fields = [gradients.Positions(), gradients.Thickness("element")]
    back_way = gradients.runs.Run(results, measures, fields=fields)
    walked = gradients.runs.Run(results, measures)
    for each in fields:
        expected = walked.by(each)
        size = np.abs(expected).max()
        np.testing.assert_allclose(back_way.by(each), expected, rtol=0.0, atol=1e-12 * size)
