"""A body in free flight that passes a wall within one increment is stopped by it.

Nothing acts before the touch, so forces of rounding size are the measure: a penetration must not
pass as rounding.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from support.pairs import cover

CELL = {"Q4I": "quad4", "Q4D": "quad4", "OPT": "tri3", "Q8": "quad8", "Q9": "quad9"}


@pytest.mark.filterwarnings("ignore:energy balance")  # Newmark gains some, as it says
@pytest.mark.parametrize(
    ("element", "scheme", "method"),
    cover(
        list(CELL),
        ["hht", "newmark", "generalized_alpha", "energy_momentum"],
        ["mortar", "node_to_segment"],
    ),
)
def test_no_frame_lies_behind_the_wall(element: str, scheme: str, method: str) -> None:
    mesh = ct.mesh.rectangle(1.0, 0.1, nx=12, ny=2, cell=CELL[element])  # type: ignore[arg-type]
    # A round underside: one node touches first.
    mesh.points[:, 1] += 0.2 * (mesh.points[:, 0] - 0.5) ** 2
    model = ct.Model(mesh)
    model.section(element=element, material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.velocity(y=-1.0)
    low = mesh.points[:, 1].min()
    wall = ct.RigidCurve.line((-9.0, low - 0.001), (9.0, low - 0.001))
    model.contact("bottom", wall, method=method, name="wall")  # type: ignore[arg-type]
    step = ct.Dynamic(scheme=scheme, period=0.012, first_increment=0.003, largest_increment=0.003)
    step.error_tolerance = 1.0
    results = ct.solve(model, step, threads=1)
    force = np.asarray(results.history("wall: force y"))
    assert np.abs(force).max() > 0.1, "it touches"
    nodes = mesh.nodes_of("bottom")
    for frame in results.frames[1:]:
        gap = mesh.points[nodes, 1] + frame.U[nodes, 1] - (low - 0.001)
        # Mortar keeps the average over an edge outside; the energy-momentum scheme stops the
        # rate of what was closed at the start of an increment.
        least = -1e-9 if method == "node_to_segment" else -1e-3
        if scheme != "energy_momentum":
            assert gap.min() > least
        assert frame.scalars["residual"] < 1e-6


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
def test_a_layer_that_comes_within_the_search_distance_does_not_act(method):
    """Energy-momentum in fixed increments: a block swings towards a layer that it does not reach.

    The gap enters the search open; it had been taken for one that begins with the first pressure.
    """
    length, angle = 2.0, 0.6
    x, y = length * math.sin(angle), -length * math.cos(angle)
    bob = ct.mesh.rectangle(0.4, 0.4, 2, 2, origin=(x, y))
    links = [
        ct.mesh.line([(s, h), (x + s, y + h)], 1, f"link{k}")
        for k, (s, h) in enumerate([(0.0, 0.4), (0.4, 0.4)])
    ]
    mesh = ct.mesh.merge(bob, *links)
    mesh.cell_sets["bob"] = np.arange(4)
    model = ct.Model(mesh)
    model.section("bob", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3, rho=1.0))
    for k in (0, 1):
        model.truss(f"link{k}", material=ct.Elastic(E=1e6, rho=1e-6), area=0.1)
        model.fix(f"link{k}.start")
    model.gravity(y=-5.0, cells="bob")
    wall = ct.RigidCurve.line((0.0, 5.0), (0.0, -9.0))
    model.contact("left", wall, law=ct.PressureLaw("linear", 200.0), method=method, name="stop")
    swing = ct.Dynamic(period=0.6, increments=120, scheme="energy_momentum")
    results = ct.solve(model, swing, threads=1)
    np.testing.assert_array_equal(results.history("stop: force x"), 0.0)
    assert abs(results.frames[-1].scalars["energy balance"]) < 1e-6
