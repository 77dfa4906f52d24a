"""Slave surfaces that a plane of symmetry cuts: their ends are guided there."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re

import numpy as np
import pytest

import corota as ct

E, NU, INNER, OUTER, OVERLAP = 210e3, 0.3, 10.0, 20.0, 0.02


def quarter(
    element: str, method: str, n: int, friction: float = 0.0, turns: bool = False
) -> tuple[ct.Results, np.ndarray]:
    """A quarter of a ring on a shaft that is too thick, and the nodes of its bore by angle."""

    def arc(radius: float) -> object:
        def at(t: float) -> tuple[float, float]:
            angle = 0.5 * np.pi * t
            return radius * np.cos(angle), radius * np.sin(angle)

        return at

    def along(t: float) -> float:
        return INNER + (OUTER - INNER) * t

    cell = "quad8" if element.startswith("Q8") else "quad4"
    mesh = ct.mesh.mapped(
        [
            lambda t: (along(t), 0.0),
            arc(OUTER),
            lambda t: (0.0, along(t)),
            arc(INNER),
        ],
        6,
        n,
        cell=cell,
    )
    axle = ct.mesh.add_node(mesh, 0.0, 0.0, "axle")
    model = ct.Model(mesh)
    model.section(element=element, material=ct.Elastic(E=E, nu=NU))
    model.fix("bottom", x=None, y=0.0)
    model.fix("top", x=0.0, y=None)
    model.fix("axle", rotation=not turns)
    shaft = ct.RigidCurve.circle((0.0, 0.0), INNER + OVERLAP, reference=axle)
    model.contact("left", shaft, method=method, friction=friction, name="fit")
    nodes = mesh.nodes_of("left")
    order = np.argsort(np.arctan2(*mesh.points[nodes].T[::-1]))
    return ct.solve(model, ct.Static()), nodes[order]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("friction", [0.0, 0.1])
@pytest.mark.parametrize(
    ("element", "n", "method"),
    [
        ("Q4I", 8, "mortar"),
        ("Q4I", 32, "mortar"),
        ("Q4S", 16, "mortar"),
        ("Q8R", 8, "mortar"),
        ("Q4I", 8, "node_to_segment"),
        ("Q4S", 16, "node_to_segment"),
    ],
)
def test_a_quarter_of_a_press_fit_has_the_pressure_of_lame(
    element: str, n: int, method: str, friction: float
) -> None:
    """p = E d / a / ((b^2 + a^2) / (b^2 - a^2) + nu) everywhere, in plane stress."""
    results, nodes = quarter(element, method, n, friction)
    ratio = (OUTER**2 + INNER**2) / (OUTER**2 - INNER**2)
    exact = E * OVERLAP / INNER / (ratio + NU)
    pressure = results.nodal("CPRESS")[nodes]
    corner = pressure[:: 2 if element == "Q8R" else 1]
    assert corner == pytest.approx(exact, rel=0.02 if n > 8 else 0.04)
    # Of a quarter: the pressure times the radius in both directions.
    force = results.frames[-1].scalars["fit: force x"]
    assert force == pytest.approx(exact * INNER, rel=0.03)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("n", [8, 32])
def test_where_a_drum_may_turn_below_a_rough_arch_the_mean_gap_is_noted(n: int) -> None:
    """The mean gap of the last edge is h^2/12R deeper than those of its nodes."""
    results, _ = quarter("Q4I", "mortar", n, 0.1, turns=True)
    (note,) = (text for text in results.notes if "round, has friction" in text)
    edge = 2.0 * INNER * np.sin(0.25 * np.pi / n)
    found = re.search(r"which is (\S+) deeper", note)
    assert found is not None
    assert float(found[1]) == pytest.approx(edge**2 / (12.0 * INNER), rel=0.02)
    for method, element in (("node_to_segment", "Q4I"), ("mortar", "Q8R")):
        others, _ = quarter(element, method, n, 0.1, turns=True)
        assert not any("round, has friction" in text for text in others.notes)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("role", ["flat", "round"])
def test_half_of_a_block_on_a_cylinder_has_the_pressure_of_the_whole(role: str) -> None:
    """A block that is pressed on a rigid cylinder: pressures under the plane of symmetry."""
    found = []
    for left in (-2.0, 0.0):
        mesh = ct.mesh.rectangle(2.0 - left, 1.0, nx=round(10 * (2.0 - left)), ny=6)
        mesh.points[:, 0] += left
        model = ct.Model(mesh)
        model.section(element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
        curve = (
            ct.RigidCurve.circle((0.0, -3.0), 3.0)
            if role == "round"
            else ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0))
        )
        if left == 0.0:
            model.fix("left", x=0.0, y=None)
        else:
            model.fix(mesh.nodes_of("top")[:1], x=0.0, y=None)
        model.fix("top", x=None, y=-0.01)
        model.contact("bottom", curve, name="press")
        results = ct.solve(model, ct.Static())
        nodes = mesh.nodes_of("bottom")
        nodes = nodes[mesh.points[nodes, 0] > -1e-9]
        nodes = nodes[np.argsort(mesh.points[nodes, 0])]
        found.append(results.nodal("CPRESS")[nodes])
    assert found[1] == pytest.approx(found[0], rel=0.02, abs=0.02 * found[0].max())


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("edges", [16, 40])
def test_half_of_an_arch_below_a_probe_has_the_force_of_the_whole(
    edges: int, friction: float
) -> None:
    """A cosine arch, round on its upper side, whose guided middle a round probe presses."""
    force = []
    for left in (-50.0, 0.0):
        n = round(edges * (50.0 - left) / 50.0)
        mesh = ct.mesh.rectangle(50.0 - left, 1.0, n, 2)
        x = mesh.points[:, 0] + left
        mesh.points[:, 0] = x
        mesh.points[:, 1] += 2.0 * (1.0 + np.cos(np.pi * x / 50.0)) - 1.0
        probe = ct.mesh.add_node(mesh, 0.0, 9.0, "probe")
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=2e3, nu=0.3))
        model.fix("right")
        if left < 0.0:
            model.fix("left")
        model.fix(np.flatnonzero(np.abs(mesh.points[:probe, 0]) < 1e-9), x=0.0, y=None)
        model.fix("probe", y=-1.0, rotation=True)
        circle = ct.RigidCurve.circle((0.0, 9.0), 5.0, reference=probe)
        model.contact("top", circle, friction=friction, name="probe")
        frame = ct.solve(model, ct.Static()).frames[-1]
        force.append(frame.RF[probe, 1] / (50.0 - left))
    assert force[1] == pytest.approx(force[0], rel=1e-6)
