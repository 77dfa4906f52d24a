"""Edges of bodies and convex facets: where a contact surface ends, and where it is round.

A body tips when the resultant passes its last point; a convex polygon lies on a plane with its
corners.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota._core import Contact
from corota.errors import ConvergenceError
from corota.model.contact import METHODS
from support.pairs import cover
from tests.contracts.test_contact_gaps import LENGTHS, chain


@pytest.mark.parametrize("kind", ["linear", "quadratic"])
@pytest.mark.parametrize("method", METHODS)
def test_the_gap_of_a_node_on_a_plane_is_its_distance(method: str, kind: str) -> None:
    """Of a polygon at all nodes, of parabolas between two equal edges."""
    along = np.linspace(0.0, 1.8, 6)
    points = np.column_stack([along, 0.05 * (along - 1.1) ** 2 + 0.1])
    x, edges, bulge = chain(kind, points, 0, 0.0075)
    floor = np.array([[3.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0]])
    contact = Contact.rigid(
        x, edges, bulge, np.ones(len(edges)), floor, -1, (0.0, 0.0), method=method, **LENGTHS
    )
    contact.search(x)
    found = contact.evaluate(x, None)
    n = len(set(contact.nodes.tolist()))
    gap = found["total_gap"][:n] / found["total_area"][:n]
    # A quadratic edge at the end of the surface takes a gap for linear, as it tips about its end.
    inside = slice(2, -2) if kind == "quadratic" and method == "mortar" else slice(None)
    # Along the normal of the slave with mortar, along that of the master with the other.
    exact = x[contact.nodes[:n], 1]
    np.testing.assert_allclose(gap[inside], exact[inside], rtol=0.02)


def tilted(n: int, method: str, floor: str, element: str = "Q4I") -> float:
    """Horizontal over vertical gravity at which a block of width .5 and height 1 tips."""
    cell = "quad8" if element == "Q8R" else "quad4"
    block = ct.mesh.rectangle(0.5, 1.0, n, 2 * n, cell)
    surfaces: list[Any]
    if floor == "rigid":
        mesh = block
        surfaces, body = ["bottom", ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))], "all"
    else:
        table = ct.mesh.rectangle(3.0, 0.5, 11, 2, cell, origin=(-1.03, -0.5))
        mesh = ct.mesh.assembly(block=block, table=table)
        surfaces, body = ["block.bottom", "table.top"], "block"
    if floor == "slave":
        surfaces = surfaces[::-1]
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e7, nu=0.0, rho=1.0))
    if floor != "rigid":
        model.fix("table.bottom")
    model.contact(*surfaces, friction=0.9, method=method, name="floor")
    weight, tilt = ct.Static(name="weight"), ct.Static(name="tilt")
    weight.gravity(y=-1.0, cells=body)
    tilt.gravity(x=1.0, cells=body)
    with pytest.raises(ConvergenceError) as stopped:
        ct.solve(model, [weight, tilt], threads=1)
    return float(stopped.value.results.frames[-1].step_time)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("friction", "way"), [(0.9, "tips about it"), (0.3, "slides")])
def test_a_step_that_stops_tells_tipping_from_sliding(
    method: str, friction: float, way: str
) -> None:
    """A block that tips at .5, or slides at its friction."""
    block = ct.mesh.rectangle(0.5, 1.0, 2, 4)
    model = ct.Model(block)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e7, nu=0.0, rho=1.0))
    line = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
    model.contact("bottom", line, friction=friction, method=method, name="floor")
    weight, tilt = ct.Static(), ct.Static()
    weight.gravity(y=-1.0)
    tilt.gravity(x=1.0)
    with pytest.raises(ConvergenceError, match=way) as stopped:
        ct.solve(model, [weight, tilt], threads=1)
    other = {"slides", "tips about it"} - {way}
    assert other.pop() not in str(stopped.value)
    reached = float(stopped.value.results.frames[-1].step_time)
    assert reached == pytest.approx(min(0.5, friction), rel=0.01)


@pytest.mark.parametrize(
    ("method", "floor"), cover(METHODS, ["rigid", "master", "slave"], strength=1)
)
def test_a_block_tips_about_its_edge(method: str, floor: str) -> None:
    assert tilted(1, method, floor) == pytest.approx(0.5, rel=0.01)


def test_a_block_of_quadratic_elements_tips_about_its_edge() -> None:
    assert tilted(2, "mortar", "rigid", "Q8R") == pytest.approx(0.5, rel=0.01)


@pytest.mark.parametrize("element", ["Q4I", "Q8R"])
@pytest.mark.parametrize("method", METHODS)
def test_a_ring_squeezed_between_plates(method: str, element: str) -> None:
    """A slender ring: F = delta E I / (.14878 R^3), with edges of a 13th of the radius."""
    radius, t, young, squeeze = 10.0, 0.4, 1e5, 0.05
    cell = "quad8" if element == "Q8R" else "quad4"
    mesh = ct.mesh.annulus(radius - t / 2, radius + t / 2, 2, 80, cell=cell)
    plate = ct.mesh.add_node(mesh, 0.0, 12.0, "plate")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=young, nu=0.0))
    top = radius + t / 2
    upper = ct.RigidCurve.line((30.0, top), (-30.0, top), reference=plate)
    model.contact("outer", upper, friction=0.3, method=method, name="upper")
    lower = ct.RigidCurve.line((-30.0, -top), (30.0, -top))
    model.contact("outer", lower, friction=0.3, method=method, name="lower")
    model.fix("plate", x=0.0, y=-squeeze, rotation=True)
    results = ct.solve(model, ct.Static(), threads=1)
    force = squeeze * young * t**3 / 12.0 / (0.14878 * radius**3)
    assert -results.frames[-1].scalars["upper: force y"] == pytest.approx(force, rel=0.01)
    assert not any("energy balance" in note for note in results.notes)


def squeezed(method: str, radius: float, side: str) -> float:
    """Force on a slender ring of Q4I between two rounds, over that of the thin ring.

    The rounds are convex with a radius > 0, else hollow; rigid, or stiff bodies that are the master
    or the slave (`side`).
    """
    size, t, young, squeeze, top = 10.0, 0.4, 1e5, 0.05, 10.2
    ring = ct.mesh.annulus(size - t / 2, size + t / 2, 2, 80)
    center, around = top + radius, abs(radius)
    if side == "rigid":
        mesh = ring
        hold = ct.mesh.add_node(mesh, 0.0, 12.0, "tool")
        first, sweep = (330.0, -120.0) if radius > 0.0 else (30.0, 120.0)
        upper = ct.RigidCurve.arc((0.0, center), around, first, sweep, reference=hold)
        lower = ct.RigidCurve.arc((0.0, -center), around, first + 180.0, sweep)
        model = ct.Model(mesh)
        model.contact("outer", upper, friction=0.3, method=method, name="upper")
        model.contact("outer", lower, friction=0.3, method=method, name="lower")
        model.fix("tool", x=0.0, y=-squeeze, rotation=True)
    else:
        angle = float(np.degrees(6.0 / around))
        inner, face = (around - 1.0, "outer") if radius > 0.0 else (around, "inner")
        tools = {}
        for name, sign in (("upper", 1.0), ("lower", -1.0)):
            middle = -90.0 * sign if radius > 0.0 else 90.0 * sign
            part = ct.mesh.annulus(inner, inner + 1.0, 2, 80, angle=angle, start=middle - angle / 2)
            tools[name] = ct.mesh.move(part, (0.0, sign * center))
        mesh = ct.mesh.assembly(ring=ring, **tools)
        model = ct.Model(mesh)
        model.section("upper", element="Q4I", material=ct.Elastic(E=1e9, nu=0.0))
        model.section("lower", element="Q4I", material=ct.Elastic(E=1e9, nu=0.0))
        for name in tools:
            pair = ["ring.outer", f"{name}.{face}"]
            surfaces = pair if side == "master" else pair[::-1]
            model.contact(*surfaces, friction=0.3, method=method, name=name)
        for name, moves in (("upper", -squeeze), ("lower", 0.0)):
            model.fix(mesh.nodes_of(name), x=0.0, y=moves)
    cells = "all" if side == "rigid" else "ring"
    model.section(cells, element="Q4I", material=ct.Elastic(E=young, nu=0.0))
    last = ct.solve(model, ct.Static(), threads=1).frames[-1].scalars
    sign = -1.0 if side == "slave" else 1.0
    thin = squeeze * young * t**3 / 12.0 / (0.14878 * size**3)
    return -sign * float(last["upper: force y"]) / thin


@pytest.mark.parametrize(
    ("method", "radius", "side"), cover(METHODS, [-15.0, 15.0], ["rigid", "master", "slave"])
)
def test_a_ring_squeezed_between_rounds(method: str, radius: float, side: str) -> None:
    """The force does not depend on the rounds: their facets and those of the ring are arcs."""
    assert squeezed(method, radius, side) == pytest.approx(1.0, rel=0.01)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("n", [40, 80])
def test_a_ring_between_meshed_plates_does_not_roll(method: str, n: int) -> None:
    """It touches with gaps of some 1e-16 of either sign, which must not say that it slips."""
    ring = ct.mesh.annulus(9.8, 10.2, 2, 80)
    plates = {
        "upper": ct.mesh.rectangle(6.0, 1.0, n, 2, origin=(-3.0, 10.2)),
        "lower": ct.mesh.rectangle(6.0, 1.0, n, 2, origin=(-3.0, -11.2)),
    }
    mesh = ct.mesh.assembly(ring=ring, **plates)
    model = ct.Model(mesh)
    model.section("ring", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0))
    for name, face, moves in (("upper", "bottom", -0.05), ("lower", "top", 0.0)):
        model.section(name, element="Q4I", material=ct.Elastic(E=1e9, nu=0.0))
        model.contact("ring.outer", f"{name}.{face}", friction=0.3, method=method, name=name)
        model.fix(mesh.nodes_of(name), x=0.0, y=moves)
    results = ct.solve(model, ct.Static(), threads=1)
    thin = 0.05 * 1e5 * 0.4**3 / 12.0 / (0.14878 * 10.0**3)
    assert -results.frames[-1].scalars["upper: force y"] == pytest.approx(thin, rel=0.01)
    assert np.abs(results.frames[-1].U).max() < 0.1


@pytest.mark.parametrize("method", METHODS)
def test_blocks_that_overhang_by_less_than_the_harmonic_limit_stand(method: str) -> None:
    """At 97 % of it: the joints carry the weight above them, and nothing pulls sideways."""
    length, height, count = 1.0, 0.25, 4
    steps = [0.97 * length / (2.0 * (count - i)) for i in range(1, count)]
    left = np.cumsum([0.0, *steps])
    blocks = {
        f"b{i}": ct.mesh.rectangle(length, height, 8, 2, origin=(x, i * height))
        for i, x in enumerate(left)
    }
    model = ct.Model(ct.mesh.assembly(**blocks))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.fix("b0.bottom")
    for i in range(1, count):
        below = f"b{i - 1}.top"
        model.contact(f"b{i}.bottom", below, friction=0.5, method=method, name=f"joint {i}")
    step = ct.Static()
    step.gravity(y=-1.0)
    last = ct.solve(model, step, threads=1).frames[-1].scalars
    for i in range(1, count):
        assert last[f"joint {i}: force y"] == pytest.approx((count - i) * length * height)
        assert last[f"joint {i}: force x"] == pytest.approx(0.0, abs=1e-3)


def test_two_leaves_with_friction_bend_in_one_increment() -> None:
    """Tip force on a two-leaf spring with friction .4; CalculiX takes 31 iterations."""
    low = ct.mesh.rectangle(40.0, 1.0, 80, 2)
    up = ct.mesh.rectangle(40.0, 1.0, 70, 2, origin=(0.0, 1.0))
    model = ct.Model(ct.mesh.assembly(low=low, up=up))
    model.section("all", element="Q4", material=ct.Elastic(E=1e4, nu=0.0))
    model.fix("low.left")
    model.fix("up.left")
    model.contact("up.bottom", "low.top", friction=0.4)
    points = model.mesh.points
    tip = int(np.flatnonzero((points[:, 0] == 40.0) & (points[:, 1] == 2.0))[0])
    model.force([tip], y=-0.05)
    results = ct.solve(model, ct.Static(), threads=1)
    assert len(results.frames) == 2
    assert sum(results.history("iterations").values) < 35
    assert not any("supported by contact" in note for note in results.notes)
