"""What supports hold carries no contact force, and lets no body through."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct
from corota.model.contact import METHODS


@pytest.mark.parametrize("slave", ["upper", "lower"])
@pytest.mark.parametrize("method", METHODS)
def test_nodes_that_supports_hold_carry_no_contact_force(method: str, slave: str) -> None:
    """Two strips clamped at one end: the tips move together, and half of the load passes."""
    low = ct.mesh.rectangle(4.0, 1.0, 4, 1)
    up = ct.mesh.rectangle(4.0, 1.0, 3, 1, origin=(0.0, 1.0))
    mesh = ct.mesh.assembly(low=low, up=up)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0))
    model.fix("low.left")
    model.fix("up.left")
    both = ["up.bottom", "low.top"]
    model.contact(*(both if slave == "upper" else both[::-1]), method=method, name="strips")
    model.force("up.right", y=-30.0, total=True)
    last = ct.solve(model, ct.Static(), threads=1).frames[-1]
    tips = [last.U[mesh.node_sets[f"{body}.right"], 1].min() for body in ("up", "low")]
    # Two cantilevers of the same stiffness: 15 L^3 / (3 E I) = .384, and .014 by shear.
    assert tips == pytest.approx([-0.38, -0.38], rel=0.06)
    # About half of the load passes, more where nodes near the clamp push and others are open.
    assert 10.0 < abs(last.scalars["strips: force y"]) < 60.0
