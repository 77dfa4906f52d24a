"""An audit of contact, written from the pages alone: trusses, beams, single nodes and gaps, with
friction.

Statically determinate members give exact contact forces; beams are linear in their small
deflections. Default settings, one increment a step.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from tests.support.blocks import METHODS, STIFF, block, chain, reaction, scalar, solve, step_ends

FLOOR = ct.RigidCurve.line((-100.0, 0.0), (100.0, 0.0))
STEEL = ct.Elastic(E=1e7, nu=0.3)


def lines(points: Any, *pairs: tuple[int, int]) -> Mesh:
    cells = Cells("line2", np.array(pairs), np.arange(1, len(pairs) + 1))
    return Mesh(np.array(points, dtype=float), [cells], np.arange(1, len(points) + 1))


@pytest.mark.parametrize("by", ["line", "nodes"])
def test_feet_of_a_two_bar_frame_spread_stick_and_return(by: str) -> None:
    """Bars at 45 degrees under P at their apex, feet on mu, a tie between the feet. Loaded, the
    feet slip outwards: tie T = P/2 (1 - mu). At .8 P they stick, as .8 P/2 (1 + mu) > T: T
    stays. At .4 P they slip inwards: T = .4 P/2 (1 + mu)."""
    mu, load = 0.2, 10.0
    mesh = lines([(0, 1), (-1, 0), (1, 0)], (0, 1), (0, 2), (1, 2))
    mesh.cell_sets["bars"] = np.array([0, 1])
    model = ct.Model(mesh)
    model.truss([0, 1, 2], material=STEEL, area=1.0)
    model.fix([0], x=0.0, y=None)
    model.contact("bars" if by == "line" else [1, 2], FLOOR, friction=mu, name="feet")
    steps = [ct.Static() for _ in range(3)]
    for step, part in zip(steps, (1.0, 0.8, 0.4), strict=True):
        step.force([0], y=-part * load)
    results = solve(model, *steps)
    ends = step_ends(results)[-3:]
    for frame, tie in zip(ends, (0.4, 0.4, 0.24), strict=True):
        assert frame.fields[0].values["N"].ravel()[2] == pytest.approx(tie * load, rel=1e-4)
    for frame, part in zip(ends, (1.0, 0.8, 0.4), strict=True):
        assert frame.scalars["feet: force y"] == pytest.approx(part * load, rel=1e-6)
        assert frame.scalars["feet: force x"] == pytest.approx(0.0, abs=1e-4)
    assert list(ends[0].C[[1, 2], 4]) == [2, 2]
    assert list(ends[1].C[[1, 2], 4]) == [1, 1]


@pytest.mark.parametrize("angle", [50.0, 65.0])
def test_a_ladder_leans_on_a_smooth_wall(angle: float) -> None:
    """A ladder with W in its middle on a rough floor and a smooth wall: the wall bears W / 2
    cot(angle), the floor W and the same force by friction, which mu > cot(angle) / 2 allows."""
    a, length, weight = math.radians(angle), 3.0, 7.0
    mesh = chain(
        [(s * length * math.cos(a), (1 - s) * length * math.sin(a)) for s in (0.0, 0.5, 1.0)]
    )
    model = ct.Model(mesh)
    model.beam("chain", material=STEEL, area=1.0, inertia=1.0)
    model.force([1], y=-weight)
    wall = ct.RigidCurve.line((0.0, 10.0), (0.0, -10.0))
    model.contact([0], wall, name="wall")
    model.contact([2], FLOOR, friction=0.6, name="floor")
    results = solve(model)
    push = weight / 2 / math.tan(a)
    assert scalar(results, "wall: force x") == pytest.approx(push, rel=1e-4)
    assert scalar(results, "floor: force x") == pytest.approx(-push, rel=1e-4)
    assert scalar(results, "floor: force y") == pytest.approx(weight, rel=1e-6)


@pytest.mark.parametrize("surface", ["nodes", "line"])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_frictional_end_of_a_cantilever(surface: str, way: float) -> None:
    """The root of a cantilever rises by d and turns by 2 d / L, so that its end, without the floor,
    would be d below, and then moves along. A node rubs on the axis: N = 3 EI d / L^3. The
    surface of a beam of height h rubs at h/2 below it: the moment mu N h/2 turns the end, N
    (L^3/3 -+ mu h L^2/4) / EI = d, more for a motion away from the root (towards the end)."""
    length, height, mu, modulus, d = 10.0, 1.0, 0.4, 1e6, 0.01
    inertia = height**3 / 12
    lift = height / 2 if surface == "line" else 0.0
    mesh = chain([(x, lift) for x in np.linspace(0.0, length, 6)])
    model = ct.Model(mesh)
    model.beam("chain", material=ct.Elastic(E=modulus, nu=0.3), area=height, inertia=inertia)
    model.contact("chain" if surface == "line" else [5], FLOOR, friction=mu, name="floor")
    lower = ct.Static()
    lower.fix([0], x=0.0, y=d, rotation=-2 * d / length)
    along = ct.Static()
    along.fix([0], x=way * 1.0, y=d, rotation=-2 * d / length)
    results = solve(model, lower, along)
    if surface == "nodes":
        normal = 3 * modulus * inertia * d / length**3
    else:
        normal = modulus * inertia * d / (length**3 / 3 - way * mu * height * length**2 / 4)
    assert scalar(results, "floor: force y") == pytest.approx(normal, rel=3e-3)
    assert reaction(results, [0])[0] == pytest.approx(way * mu * normal, rel=5e-3)


@pytest.mark.parametrize(("first", "gap"), [(1.0, 0.01), (3.0, 0.01), (1.0, -0.01)])
def test_a_gap_element_between_two_cantilevers(first: float, gap: float) -> None:
    """The lower of two cantilevers, k1 and k2 = 3 EI / L^3, is pushed up by F: the gap passes R =
    (F / k1 - g) / (1 / k1 + 1 / k2), also for an overlap g < 0."""
    length, modulus, force = 5.0, 1e6, 100.0
    mesh = lines([(0, 0), (length, 0), (0, 1), (length, 1)], (0, 1), (2, 3))
    model = ct.Model(mesh)
    model.beam([0], material=ct.Elastic(E=modulus, nu=0.3), area=1.0, inertia=first * 0.1)
    model.beam([1], material=ct.Elastic(E=modulus, nu=0.3), area=1.0, inertia=0.1)
    model.fix([0, 2], rotation=True)
    model.force([1], y=force)
    model.contacts.append(ct.gap_element(mesh.points, (1, 3), gap, (0.0, 1.0), "gap"))
    results = solve(model, ct.Static(nlgeom=False))
    k1, k2 = first * 3e5 / length**3, 3e5 / length**3
    passed = (force / k1 - gap) / (1 / k1 + 1 / k2)
    assert scalar(results, "gap: force y") == pytest.approx(passed, rel=1e-9)
    assert reaction(results, [2])[1] == pytest.approx(-passed, rel=1e-9)


@pytest.mark.parametrize("turn", [-60.0, 60.0, 170.0])
def test_a_turning_disc_lifts_a_beam_in_its_middle(turn: float) -> None:
    """A disc pushes a simply supported beam of height h up by d in its middle and turns: F = 48 EI
    d / L^3. Its friction draws along x and, h/2 below the axis, has the moment mu F h/2, which
    the supports bear by mu F h / (2 L), and which does not lift the middle of a beam."""
    length, height, modulus, mu, d = 8.0, 0.5, 1e6, 0.3, 0.004
    inertia = height**3 / 12
    mesh = chain([(x, height / 2) for x in np.linspace(-length / 2, length / 2, 5)])
    disc = ct.mesh.add_node(mesh, 0.0, -1.0, "disc")
    model = ct.Model(mesh)
    model.beam("chain", material=ct.Elastic(E=modulus, nu=0.3), area=height, inertia=inertia)
    model.fix([0])
    model.fix([4], x=None, y=0.0)
    model.fix("disc", x=0.0, y=d, rotation=math.radians(turn))
    model.contact(
        "chain", ct.RigidCurve.circle((0.0, -1.0), 1.0, reference=disc), friction=mu, name="disc"
    )
    results = solve(model)
    force = 48 * modulus * inertia * d / length**3
    sign = -math.copysign(1.0, turn)  # counter-clockwise the top of the disc moves to the left
    assert scalar(results, "disc: force y") == pytest.approx(force, rel=2e-3)
    assert scalar(results, "disc: force x") == pytest.approx(sign * mu * force, rel=2e-3)
    assert reaction(results, [0])[0] == pytest.approx(-sign * mu * force, rel=2e-3)
    # moments about the left support: R L = F L/2 - (mu F)(-h/2) sign ... of the force at (L/2,
    # -h/2)
    right = -(force * length / 2 + sign * mu * force * height / 2) / length
    assert reaction(results, [4])[1] == pytest.approx(right, rel=2e-3)
    assert reaction(results, [disc])[2] == pytest.approx(-sign * mu * force, rel=5e-3)


@pytest.mark.parametrize("method", METHODS)
def test_a_block_drawn_over_a_row_of_beams(method: str) -> None:
    """Beams of height .2, clamped at their nodes, are the master of a block: it rests .1 above
    their line and needs mu P."""
    mu, load = 0.3, 5.0
    mesh = ct.mesh.assembly(
        body=block(2.0, 0.5, 5, 2, (0.0, 0.1)),
        rail=chain([(x, 0.0) for x in np.linspace(-2, 8, 11)]),
    )
    rail = mesh.nodes_of("rail")
    model = ct.Model(mesh)
    model.section("body", element="Q4I", material=STIFF)
    model.beam("rail.chain", material=STEEL, area=0.2, inertia=0.2**3 / 12)
    model.fix(rail, rotation=True)
    model.force("body.top", y=-load)
    model.fix("body.top", x=4.2, y=None)
    model.contact("body.bottom", "rail.chain", friction=mu, method=method, name="rail")
    results = solve(model)
    assert reaction(results, "body.top")[0] == pytest.approx(mu * load, rel=1e-4)
    assert reaction(results, rail)[1] == pytest.approx(load, rel=1e-5)
    assert reaction(results, rail)[0] == pytest.approx(-mu * load, rel=1e-4)


@pytest.mark.parametrize("travel", [0.2, -0.5])
def test_a_strut_locks_one_way_as_a_sprag_does(travel: float) -> None:
    """A strut from the origin to a plate at the height h leans by 20 degrees, mu = .5 > tan 20. The
    plate drags its tip upright: the strut sticks and has EA (1 - l / l0) with l^2 = (x - d)^2 +
    h^2. The other way it leaves the plate, without any force; a soft spring keeps it from
    falling."""
    a, length, stiffness, soft = math.radians(20.0), 2.0, 1e4, 1e-5
    tip = length * np.array([math.sin(a), math.cos(a)])
    mesh = lines([(0, 0), tip, (9, 0), (9, -9)], (0, 1), (2, 1), (3, 1))
    plate = ct.mesh.add_node(mesh, 0.0, 3.0, "plate")
    model = ct.Model(mesh)
    model.truss([0], material=ct.Elastic(E=stiffness, nu=0.3), area=1.0)
    model.spring([1], soft, "x x")
    model.spring([2], soft, "y y")
    model.fix([0, 2, 3])
    lid = ct.RigidCurve.line((50.0, float(tip[1])), (-50.0, float(tip[1])), reference=plate)
    model.contact([1], lid, friction=0.5, name="tip")
    model.fix("plate", x=-travel, y=0.0, rotation=True)
    results = solve(model)
    x = tip[0] - travel
    now = math.hypot(x, tip[1])
    push = stiffness * (1 - now / length) if travel > 0 else 0.0
    assert scalar(results, "tip: force y") == pytest.approx(
        -push * tip[1] / now, rel=1e-5, abs=1e-4
    )
    assert scalar(results, "tip: force x") == pytest.approx(-push * x / now, rel=1e-5, abs=1e-4)


def test_a_row_of_sliders_follows_masings_rule() -> None:
    """Nodes with springs k_i to the ground, pressed by P_i on a plate that moves by D, then back by
    B, then forth: each has min(k_i D, mu P_i), then returns elastically to minus its bound. One
    increment each."""
    mu, stiff, loads = 0.5, np.array([1.0, 2.0, 5.0, 9.0]), np.array([4.0, 2.0, 3.0, 1.0])
    n = len(stiff)
    points = [(float(i), 0.0) for i in range(n)] + [(float(i) - 0.5, 0.0) for i in range(n)]
    mesh = lines(points, *((n + i, i) for i in range(n)))
    plate = ct.mesh.add_node(mesh, 0.0, -1.0, "plate")
    model = ct.Model(mesh)
    for i in range(n):
        model.spring([i], stiff[i], "x x")
        model.force([i], y=-loads[i])
    model.fix(list(range(n, 2 * n)))
    floor = ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0), reference=plate)
    model.contact(list(range(n)), floor, friction=mu, name="plate")
    steps = []
    for d in (0.0, 1.2, 0.3, 0.9):
        step = ct.Static()
        step.fix("plate", x=d, y=0.0, rotation=True)
        steps.append(step)
    results = solve(model, *steps)
    force, before, lost = np.zeros(n), 0.0, 0.0
    for frame, d in zip(step_ends(results)[-4:], (0.0, 1.2, 0.3, 0.9), strict=True):
        trial = force + stiff * (d - before)
        force = np.clip(trial, -mu * loads, mu * loads)
        lost += float(np.sum(mu * loads * np.abs(trial - force) / stiff))
        before = d
        assert -frame.RF[list(range(n, 2 * n)), 0] == pytest.approx(force, rel=1e-6, abs=1e-6)
        assert frame.RF[plate, 0] == pytest.approx(force.sum(), rel=1e-6, abs=1e-6)
        assert frame.scalars["ALLFD"] == pytest.approx(lost, rel=1e-6, abs=1e-9)
