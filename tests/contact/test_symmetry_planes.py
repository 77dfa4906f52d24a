"""Slave surfaces that a plane of symmetry cuts: their ends are guided there."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re

import numpy as np
import pytest

import corota as ct

E, NU, INNER, OUTER, OVERLAP = 210e3, 0.3, 10.0, 20.0, 0.02


def quarter(element: str, method: str, n: int) -> tuple[ct.Results, np.ndarray]:
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
    model = ct.Model(mesh)
    model.section(element=element, material=ct.Elastic(E=E, nu=NU))
    model.fix("bottom", x=None, y=0.0)
    model.fix("top", x=0.0, y=None)
    shaft = ct.RigidCurve.circle((0.0, 0.0), INNER + OVERLAP)
    model.contact("left", shaft, method=method, name="fit")
    nodes = mesh.nodes_of("left")
    order = np.argsort(np.arctan2(*mesh.points[nodes].T[::-1]))
    return ct.solve(model, ct.Static()), nodes[order]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("element", "n", "method"),
    [
        ("Q8R", 8, "mortar"),
        ("Q4I", 8, "node_to_segment"),
        ("Q4S", 16, "node_to_segment"),
    ],
)
def test_a_quarter_of_a_press_fit_has_the_pressure_of_lame(
    element: str, n: int, method: str
) -> None:
    """p = E d / a / ((b^2 + a^2) / (b^2 - a^2) + nu) everywhere, in plane stress."""
    results, nodes = quarter(element, method, n)
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
def test_straight_edges_of_a_round_at_a_plane_of_symmetry_are_noted_with_mortar(n: int) -> None:
    """The mean gap of the last edge is h^2/12R deeper than those of its nodes."""
    results, _ = quarter("Q4I", "mortar", n)
    (note,) = (text for text in results.notes if "round and a support guides" in text)
    edge = 2.0 * INNER * np.sin(0.25 * np.pi / n)
    found = re.search(r"which is (\S+) deeper", note)
    assert found is not None
    assert float(found[1]) == pytest.approx(edge**2 / (12.0 * INNER), rel=0.02)
    assert "node_to_segment" in note
    for method, element in (("node_to_segment", "Q4I"), ("mortar", "Q8R")):
        others, _ = quarter(element, method, n)
        assert not any("round and a support guides" in text for text in others.notes)
