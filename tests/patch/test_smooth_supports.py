"""Edges of drilling elements on smooth supports and rigid curves, rotations free."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

#: Cells of the elements whose rotations bend their edges.
DRILLING = {"Q4D": "quad4", "Q4DI": "quad4", "OPT": "tri3"}


def block(element: str, n: int) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, n, n, cell=DRILLING[element]))
    model.section(element=element, material=ct.Elastic(E=1000.0, nu=0.3))
    return model


def stress(results: ct.Results) -> np.ndarray:
    """Normal stresses in global axes, shape (points, 2)."""
    return np.concatenate(
        [f.values["S"][..., :2].reshape(-1, 2) for f in results.frames[-1].fields]
    )


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("n", [1, 2, 5])
@pytest.mark.parametrize("element", list(DRILLING))
def test_uniform_stress_between_smooth_supports(element: str, n: int, turned: bool) -> None:
    """Pulled by 0.01 between rollers of the model and of a step: ``s = E e``, on any mesh."""
    model = block(element, n)
    if turned:  # the same supports in axes of the nodes
        model.local_axes("left", angle=np.pi / 2)
        model.fix("left", x=None, y=0.0)
    else:
        model.fix("left", y=None)
    model.fix([0], x=0.0 if turned else None, y=None if turned else 0.0)
    step = ct.Static(nlgeom=False)
    step.fix("right", x=0.01, y=None)
    results = ct.solve(model, step, threads=1)
    np.testing.assert_allclose(stress(results), [[10.0, 0.0]] * len(stress(results)), atol=1e-9)


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
@pytest.mark.parametrize("element", list(DRILLING))
def test_uniform_stress_on_a_smooth_floor(element: str, method: str) -> None:
    """Pressed by 10 on a rigid line without friction: contact at nodes leaves edges straight."""
    model = block(element, 2)
    model.contact("bottom", ct.RigidCurve.line((-1.0, 0.0), (2.0, 0.0)), method=method)
    model.fix([0], y=None)
    model.traction("top", y=-10.0)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    np.testing.assert_allclose(stress(results), [[0.0, -10.0]] * len(stress(results)), atol=1e-8)


def test_a_set_of_slave_nodes_leaves_edges_straight() -> None:
    """Mortar contact of single nodes: constant stress under a rigid line, as with its edges."""
    model = block("OPT", 3)
    nodes = model.mesh.nodes_of("bottom")
    model.contact(nodes, ct.RigidCurve.line((-1.0, 0.0), (2.0, 0.0)))
    model.fix([0], y=None)
    model.fix("top", x=None, y=-0.01)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    np.testing.assert_allclose(stress(results), [[0.0, -10.0]] * len(stress(results)), atol=1e-8)


@pytest.mark.parametrize("element", list(DRILLING))
def test_contact_does_not_stiffen_slender_parts(element: str) -> None:
    """A strip of one cell lifted off the floor bends as without it (up to 3 times too stiff)."""
    tips = []
    for floor in (False, True):
        model = ct.Model(ct.mesh.rectangle(8.0, 0.5, 6, 1, cell=DRILLING[element]))
        model.section(element=element, material=ct.Elastic(E=1e5, nu=0.3))
        model.fix("left", rotation=True)
        model.force("right", y=0.1)
        if floor:
            line = ct.RigidCurve.line((-1.0, 0.0), (9.0, 0.0))
            model.contact("bottom", line, method="node_to_segment")
        results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
        tips.append(float(results.history("U2", at="right", combine="mean")[-1]))
    assert tips[1] == pytest.approx(tips[0], rel=0.02)


@pytest.mark.parametrize("element", ["Q4D", "OPT"])
def test_a_disc_bends_a_strip_of_one_cell(element: str) -> None:
    """Force of Q9 with 64 x 8 cells: 86.5; straight edges had three times as much."""
    mesh = ct.mesh.rectangle(10.0, 0.5, 8, 1, DRILLING[element], "alternate")
    disc = ct.mesh.add_node(mesh, 8.0, 1.5, "disc")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0e6, nu=0.3))
    model.fix("left", rotation=True)
    model.fix([disc], x=0.0, y=-1.4, rotation=0.0)
    curve = ct.RigidCurve.circle((8.0, 1.5), 1.0, reference=disc)
    model.contact("top", curve, method="node_to_segment", name="pair")
    results = ct.solve(model, ct.Static(increments=20), threads=1)
    assert abs(results.frames[-1].scalars["pair: force y"]) == pytest.approx(86.5, rel=0.08)


def test_clamped_edges_keep_their_share() -> None:
    """A clamp with free rotations is that of the literature: Cook's membrane, 20.5644."""
    from corota.verification.models import cook, linear

    model, node = cook("OPT", 2, diagonal="left")
    assert linear(model).U[node, 1] == pytest.approx(20.5644, abs=5e-5)
