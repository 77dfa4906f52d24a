"""Drives by friction in one default increment: a turned press fit, a planet, a wedge, a hill."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from corota.model.contact import METHODS

STIFF = ct.Elastic(E=1e6, nu=0.3)


@pytest.mark.parametrize("slave", ["shaft", "hub"])
def test_shaft_turned_in_its_hub(slave: str) -> None:
    """Two meshed rings on rigid walls (Lame): the torque is 2 pi b^2 mu p, by any angle.

    With node to segment the facets of the meshed master count as overlap, see the page.
    """
    inner, b, outer, E, nu, overlap, friction, turn = 1.0, 2.0, 3.5, 1e5, 0.3, 0.02, 0.2, 1.5
    shaft = ct.mesh.annulus(inner, b + overlap, 3, 48)
    mesh = ct.mesh.assembly(shaft=shaft, hub=ct.mesh.annulus(b, outer, 4, 60))
    axis = ct.mesh.add_node(mesh, 0.0, 0.0, "axis")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=E, nu=nu))
    sides = ["shaft.outer", "hub.inner"]
    model.contact(*(sides if slave == "shaft" else sides[::-1]), friction=friction, name="fit")
    model.rigid("shaft.inner", axis)
    model.fix("hub.outer")
    fit, drive = ct.Static(), ct.Static()
    fit.fix("axis", rotation=0.0)
    drive.fix("axis", rotation=turn)
    last = ct.solve(model, [fit, drive], threads=1).frames[-1]

    def stiffness(wall: float) -> float:
        """Pressure at b over its displacement, with no displacement at the wall."""
        stress = E / (1.0 - nu**2) * (1.0 + nu + (1.0 - nu) * wall**2 / b**2)
        return abs(stress / (b - wall**2 / b))

    p = overlap / (1.0 / stiffness(inner) + 1.0 / stiffness(outer))
    torque = 2.0 * math.pi * b**2 * friction * p
    assert last.RF[axis, 2] == pytest.approx(torque, rel=0.02)
    assert last.scalars["friction energy"] == pytest.approx(torque * turn, rel=0.03)


@pytest.mark.parametrize("method", METHODS)
def test_planet_goes_round_its_sun(method: str) -> None:
    """Between a sun that turns by t and a ring at rest, it goes round by t Rs / 2 (Rs + Rp)."""
    sun_radius, radius, overlap, turn = 3.0, 1.5, 0.02, 0.8
    at = sun_radius + radius
    mesh = ct.mesh.annulus(0.7, radius, 2, 96, center=(at, 0.0))
    sun = ct.mesh.add_node(mesh, 0.0, 0.0, "sun")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    circle = ct.RigidCurve.circle((0.0, 0.0), sun_radius + overlap, reference=sun)
    wall = ct.RigidCurve.circle((0.0, 0.0), at + radius - overlap, inside=True)
    for name, curve in (("sun", circle), ("ring", wall)):
        model.contact("outer", curve, friction=0.2, method=method, name=name)
    inside = mesh.nodes_of("inner")
    hold = [int(inside[np.argmax(mesh.points[inside, 0])])]
    press, drive = ct.Static(), ct.Static()
    press.fix("sun", rotation=0.0)
    press.fix(hold, x=None)
    drive.fix("sun", rotation=turn)
    drive.release(hold, x=False)
    last = ct.solve(model, [press, drive], threads=1).frames[-1]
    x, y = (mesh.points + last.U[:, :2])[inside].mean(axis=0)
    assert math.atan2(y, x) == pytest.approx(turn * sun_radius / (2.0 * at), rel=0.01)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("method", METHODS)
def test_wedge_lifts_a_guided_load(method: str, swapped: bool) -> None:
    """On a floor, under a load W: it takes W (tan(a + f) + tan f), and W (f - a) on the way out."""
    slope, friction, weight, way = math.radians(15.0), 0.1, 10.0, 0.4
    wedge = ct.mesh.rectangle(4.0, 1.0, 16, 2)
    wedge.points[:, 1] *= 0.4 + wedge.points[:, 0] * math.tan(slope)
    block = ct.mesh.rectangle(1.5, 1.0, 5, 3, origin=(1.0, 0.0))
    low = 0.4 + block.points[:, 0] * math.tan(slope)
    block.points[:, 1] = low + block.points[:, 1] * (3.0 - low)
    floor = ct.mesh.rectangle(10.0, 0.5, 20, 1, origin=(-4.0, -0.5))
    mesh = ct.mesh.assembly(wedge=wedge, block=block, floor=floor)
    head = ct.mesh.add_node(mesh, 1.75, 3.0, "head")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=STIFF)
    model.rigid("block.top", head)
    model.fix("floor.bottom")
    model.fix("head", x=0.0, y=None, rotation=0.0)
    model.force("head", y=-weight)
    for pair in (["block.bottom", "wedge.top"], ["wedge.bottom", "floor.top"]):
        model.contact(*(pair[::-1] if swapped else pair), friction=friction, method=method)
    rest = ct.Static()
    rest.fix("wedge.right", x=0.0, y=None)
    angle = math.atan(friction)
    for sign in (1.0, -1.0):
        drive = ct.Static()
        drive.fix("wedge.right", x=-sign * way, y=None)
        last = ct.solve(model, [rest, drive], threads=1).frames[-1]
        force = -last.RF[mesh.nodes_of("wedge.right"), 0].sum()
        exact = weight * (math.tan(slope + sign * angle) + sign * friction)
        assert force == pytest.approx(exact, rel=0.01)
        assert last.U[head, 1] == pytest.approx(sign * way * math.tan(slope), rel=0.01)


@pytest.mark.parametrize("end", [2.6, 3.5, 4.4])
@pytest.mark.parametrize("method", METHODS)
def test_round_nose_is_drawn_over_a_hill(method: str, end: float) -> None:
    """Up, on top and down of flanks of 20 degrees: height, W tan(slope + f) and friction energy."""
    radius, weight, friction, begin, steep = 0.6, 5.0, 0.2, 1.0, math.tan(math.radians(20.0))
    corners, heights = [2.0, 3.0, 4.0, 5.0], [0.0, steep, steep, 0.0]
    mesh = ct.mesh.rectangle(6.0, 0.5, 120, 1)
    x, y = mesh.points.T
    mesh.points[:, 1] = y * (1.0 + 2.0 * np.interp(x, corners, heights))
    ground = np.linspace(0.0, 6.0, 6001)
    level = 0.5 + np.interp(ground, corners, heights)

    def center(at: float) -> float:
        """Height of the center of a nose that lies on the ground."""
        near = np.abs(ground - at) < radius
        return float((level[near] + np.sqrt(radius**2 - (ground[near] - at) ** 2)).max())

    nose = ct.mesh.add_node(mesh, begin, center(begin), "nose")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=STIFF)
    model.fix("bottom")
    circle = ct.RigidCurve.circle((begin, center(begin)), radius, reference=nose)
    model.contact("top", circle, friction=friction, method=method, name="nose")
    model.force("nose", y=-weight)
    press, draw = ct.Static(), ct.Static()
    press.fix("nose", y=None, rotation=0.0)
    draw.fix("nose", x=end - begin, y=None, rotation=0.0)
    last = ct.solve(model, [press, draw], threads=1).frames[-1]
    way = np.linspace(begin, end, 401)
    slopes = np.arctan(np.gradient([center(at) for at in way], way))
    normal = weight / (np.cos(slopes) - friction * np.sin(slopes))
    work = float(np.trapezoid(friction * normal / np.cos(slopes), way))
    assert last.U[nose, 1] == pytest.approx(center(end) - center(begin), abs=2e-3)
    # Nodes lift the nose in turn: its force has a sawtooth of half an edge over the radius.
    drag = weight * math.tan(slopes[-1] + math.atan(friction))
    assert last.RF[nose, 0] == pytest.approx(drag, abs=weight * 0.025 / radius)
    assert last.scalars["friction energy"] == pytest.approx(work, rel=0.03)
