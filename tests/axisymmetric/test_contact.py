"""Contact of solids of revolution: weights of the circumference in both methods."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.verification.contact_models import FORCE, NU, RADIUS, YOUNG, measured, quarter

METHODS = ["mortar", "node_to_segment"]


@pytest.mark.parametrize("element", ["Q4", "Q8"])
@pytest.mark.parametrize("inner", [0.0, 3.0])
def test_uniform_pressure_passes_an_interface_of_other_nodes(element: str, inner: float) -> None:
    """Mortar: two discs or rings with three and four cells on one another, free at the sides."""
    cell = "quad8" if element == "Q8" else "quad4"
    low = ct.mesh.rectangle(6.0, 2.0, 4, 2, cell=cell)
    top = ct.mesh.rectangle(6.0, 2.0, 3, 2, cell=cell)
    for mesh, up in ((low, 0.0), (top, 2.0)):
        mesh.points[:] += [inner, up]
    model = ct.Model(ct.mesh.assembly(low=low, top=top))
    steel = ct.Elastic(E=1000.0, nu=0.3)
    model.section("all", element=element, material=steel, plane="axisymmetric")
    model.fix("low.bottom", x=None)
    model.contact("top.bottom", "low.top", method="mortar")
    model.pressure("top.top", 10.0)
    frame = ct.solve(model, ct.Static(nlgeom=False, increments=1), threads=1).frames[-1]
    for fields in frame.fields:
        np.testing.assert_allclose(fields.values["S"][..., 1], -10.0, atol=1e-9)
        np.testing.assert_allclose(fields.values["S"][..., [0, 2, 3]], 0.0, atol=1e-9)
    area = np.pi * ((inner + 6.0) ** 2 - inner**2)
    support = frame.RF[model.mesh.node_sets["low.bottom"], 1].sum()
    assert support == pytest.approx(10.0 * area, rel=1e-10)


@pytest.mark.parametrize("method", METHODS)
def test_press_fit_of_rings_in_one_increment(method: str) -> None:
    """Rings 20/40.005 and 40/60 (diameters), E = 196000: 5.74 by Lame's solution."""
    young, inner, middle, outer, gap = 196000.0, 10.0, 20.0, 30.0, 0.0025
    pin = ct.mesh.rectangle(middle - inner + gap, 5.0, 8, 4, cell="quad8")
    hub = ct.mesh.rectangle(outer - middle, 5.0, 8, 3, cell="quad8")
    pin.points[:, 0] += inner
    hub.points[:, 0] += middle
    model = ct.Model(ct.mesh.assembly(pin=pin, hub=hub))
    steel = ct.Elastic(E=young, nu=0.3)
    model.section("all", element="Q8", material=steel, plane="axisymmetric")
    for name in ("pin.bottom", "hub.bottom"):
        model.fix(name, x=None)
    model.contact("pin.right", "hub.left", method=method)
    frame = ct.solve(model, ct.Static(increments=1), threads=1).frames[-1]
    a, b, c = inner**2, outer**2, middle**2
    pressure = gap * young / middle / ((b + c) / (b - c) + (c + a) / (c - a))
    assert pressure == pytest.approx(5.74, abs=0.005)
    exact = 2.0 * pressure * c * outer / (young * (b - c))
    moved = frame.U[model.mesh.node_sets["hub.right"], 0]
    np.testing.assert_allclose(moved, exact, rtol=5e-4)


@pytest.mark.parametrize("method", METHODS)
def test_sphere_on_a_rigid_plane(method: str) -> None:
    """Hertz: R = 8, E = 200, nu = .3, force 10: radius of contact .6487154, pressure 11.345743."""
    model = ct.Model(quarter(RADIUS, 32, "Q4I"))
    rubber = ct.Elastic(E=YOUNG, nu=NU)
    model.section("all", element="Q4I", material=rubber, plane="axisymmetric")
    floor = ct.RigidCurve.line((-0.5 * RADIUS, -RADIUS), (0.5 * RADIUS, -RADIUS))
    model.contact("bottom", floor, method=method)
    model.traction("top", y=-FORCE / (np.pi * RADIUS**2))
    results = ct.solve(model, ct.Static(nlgeom=False, increments=1), threads=1)
    radius, peak = measured(results)
    assert radius == pytest.approx(0.6487154, rel=0.02)
    assert peak == pytest.approx(11.345743, rel=0.02)


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
@pytest.mark.parametrize("element", ["Q4I", "Q8R"])
def test_a_sleeve_is_pushed_along_a_rigid_bore(element: str, method: str) -> None:
    """Pressed outward by p, with nu = 0: N = 2 pi b L (2 p a^2 / (a^2 + b^2)); drawn with mu N."""
    cell = "quad8" if element == "Q8R" else "quad4"
    mesh = ct.mesh.rectangle(10.0, 10.0, nx=6, ny=6, cell=cell)
    mesh.points[:, 0] += 10.0
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(1e6, 0.0), plane="axisymmetric")
    bore = ct.RigidCurve.line((20.0, -40.0), (20.0, 40.0))
    model.contact("right", bore, friction=0.2, method=method, name="bore")  # type: ignore[arg-type]
    model.fix("left", x=None, y=0.0)
    model.pressure("left", 10.0)
    drawn = ct.Static()
    drawn.fix("left", x=None, y=-1.0)
    results = ct.solve(model, [ct.Static(), drawn], threads=1)
    normal, along = (results.history(f"bore: force {axis}")[-1] for axis in "xy")
    exact = 2.0 * np.pi * 20.0 * 10.0 * (2.0 * 10.0 * 100.0 / 500.0)
    assert abs(normal) == pytest.approx(exact, rel=1e-2)
    assert abs(along / normal) == pytest.approx(0.2, rel=1e-3)


def cone(element: str, outwards: bool, nx: int = 8) -> tuple[ct.Mesh, int]:
    """A conical ring with a free lower edge, outside or inside, and the node at that edge."""
    cell = "tri3" if element == "T3" else "quad4"
    mesh = ct.mesh.rectangle(12.0, 1.25, nx, 2, cell=cell)
    s, t = mesh.points.T.copy()
    c, d = np.cos(0.1), np.sin(0.1 if outwards else -0.1)
    mesh.points[:] = np.stack([13.0 + c * s + d * t, c * t - d * s], axis=1)
    return mesh, int(np.argmin(mesh.points[:, 1]))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4S", "Q4R", "T3"])
@pytest.mark.parametrize("outwards", [True, False])
def test_the_edge_of_a_lip_lies_on_a_plate(outwards: bool, element: str, method: str) -> None:
    """A plate that lifts the edge of a clamped cone: the same as a support of its last node.

    The section turns about the edge. Pressed far down and back in one increment each.
    """
    forces = []
    for plated in (True, False):
        mesh, edge = cone(element, outwards)
        low = float(mesh.points[edge, 1])
        plate = ct.mesh.add_node(mesh, 0.0, low - 1.0, "plate")
        model = ct.Model(mesh)
        model.section(
            "all", element=element, material=ct.Elastic(E=1000.0, nu=0.3), plane="axisymmetric"
        )
        model.fix("left" if outwards else "right")
        if plated:
            floor = ct.RigidCurve.line((0.0, low), (60.0, low), reference=plate)
            model.contact("bottom", floor, method=method)
        steps = []
        for up in (0.3, 0.1):
            step = ct.Static()
            step.fix("plate" if plated else [edge], x=None, y=up)
            steps.append(step)
        frames = ct.solve(model, steps, threads=1).frames[-2:]
        for frame, up in zip(frames, (0.3, 0.1), strict=True):
            assert frame.U[edge, 1] == pytest.approx(up, abs=1e-9)
        forces.append([frame.RF[plate if plated else edge, 1] for frame in frames])
    np.testing.assert_allclose(forces[0], forces[1], rtol=1e-7)
