"""What supports hold carries no contact force, and lets no body through."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

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


@pytest.mark.parametrize("element", ["Q4I", "Q8"])
@pytest.mark.parametrize("friction", [0.1, 0.3])
@pytest.mark.parametrize("slope", [10.0, 20.0, 30.0])
@pytest.mark.parametrize("method", METHODS)
def test_what_a_support_drives_along_a_cone_slips(
    method: str, slope: float, friction: float, element: str
) -> None:
    """A thin ring driven into a cone that it touches, by F = C tan(slope + angle of friction).

    The support and the gap of its corner leave that node nowhere to stick. C is the radial force
    of the hoop, 2 pi E A u / R.
    """
    angle, height, thick, way = math.radians(slope), 2.0, 0.5, 0.2
    cell = "quad8" if element == "Q8" else "quad4"
    mesh = ct.mesh.rectangle(thick, height, 2, 4, cell=cell, origin=(19.5, 0.0))
    mesh.points[:, 0] += (mesh.points[:, 1] - height) * math.tan(angle)
    model = ct.Model(mesh)
    steel = ct.Elastic(E=1e5, nu=0.0)
    model.section("all", element=element, material=steel, plane="axisymmetric")
    x, y = 9.0 * math.sin(angle), 9.0 * math.cos(angle)
    cone = ct.RigidCurve.line((20.0 - x, height - y), (20.0 + x, height + y))
    model.contact("right", cone, friction=friction, method=method, name="cone")
    model.fix("top", x=None, y=-way)
    results = ct.solve(model, ct.Static(), threads=1)
    radius = mesh.points[:, 0].mean()
    hoop = 2.0 * math.pi * 1e5 * thick * height * way * math.tan(angle) / radius
    force = -results.frames[-1].RF[mesh.nodes_of("top"), 1].sum()
    assert force == pytest.approx(hoop * math.tan(angle + math.atan(friction)), rel=0.01)
    assert results.frames[-1].increment == 1
    assert not results.notes
