"""An audit of contact, written from the pages alone: blocks and wedges with friction, rigid floors
and tables.

Every force is a closed form of statics; every run has the default settings, mostly one increment.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from corota.mesh.data import Cells
from tests.support.blocks import METHODS, STIFF, block, reaction, scalar, solve, step_ends
from tests.support.pairs import cover

FLOOR = ct.RigidCurve.line((-100.0, 0.0), (100.0, 0.0))


def dragged(method: str, mu: float, load: float, travel: float, nx: int = 8) -> ct.Model:
    """A stiff block of 4 x 1 on the floor under a load on its top, whose nodes are
    moved along x."""
    model = ct.Model(block(4.0, 1.0, nx, 2))
    model.section("all", element="Q4I", material=STIFF)
    model.force("top", y=-load)
    model.fix("top", x=travel, y=None)
    model.contact("bottom", FLOOR, friction=mu, method=method, name="floor")
    return model


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("travel", [0.3, -25.0])
def test_a_dragged_block_needs_mu_times_its_load(method: str, travel: float) -> None:
    """T = mu P against the motion. Moments about a point of the floor: P acts at the middle x + d
    of the block, T at the height 1, so the floor presses at x + d + mu for a motion to the right,
    and the moment of the floor's force about the origin is P (x + d + mu)."""
    mu, load, sign = 0.3, 5.0, math.copysign(1.0, travel)
    results = solve(dragged(method, mu, load, travel))
    assert reaction(results, "top")[0] == pytest.approx(sign * mu * load, rel=1e-6)
    assert scalar(results, "floor: force x") == pytest.approx(-sign * mu * load, rel=1e-6)
    assert scalar(results, "floor: force y") == pytest.approx(load, rel=1e-6)
    moment = load * (2.0 + travel + sign * mu)
    assert scalar(results, "floor: moment") == pytest.approx(moment, rel=1e-5)
    assert scalar(results, "floor: friction moment") == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_energy_of_a_spring_that_drags_a_block_and_comes_back(method: str) -> None:
    """The end of a spring k moves by D, then back by B. The block slips D - mu P / k, then it stays
    until the spring has turned from +mu P to -mu P, which takes 2 mu P / k: it slips back by B -
    2 mu P / k. Friction takes mu P times each slip. Pressed, drawn and released in one increment
    each."""
    mu, load, k, go, back = 0.4, 10.0, 2.0, 7.0, 6.0
    mesh = block(4.0, 1.0, 8, 2)
    corner = int(np.argmin(np.hypot(mesh.points[:, 0] - 4.0, mesh.points[:, 1] - 0.5)))
    end = ct.mesh.add_node(mesh, 5.0, 0.5, "end")
    mesh.cells.append(Cells("line2", np.array([[end, corner]]), np.array([1000])))
    n = mesh.n_cells - 1
    model = ct.Model(mesh)
    model.section(np.arange(n), element="Q4I", material=STIFF)
    model.spring([n], k, "x x")
    model.force("top", y=-load)
    model.contact("bottom", FLOOR, friction=mu, method=method, name="floor")
    steps = [ct.Static(), ct.Static(), ct.Static()]
    for step, x in zip(steps, (0.0, go, go - back), strict=True):
        step.fix("end", x=x, y=0.0)
    results = solve(model, *steps)
    there, again = step_ends(results)[-2:]
    slip = go - mu * load / k
    assert there.U[corner, 0] == pytest.approx(slip, rel=1e-5)
    assert there.scalars["ALLFD"] == pytest.approx(mu * load * slip, rel=1e-4)
    assert again.U[corner, 0] == pytest.approx(slip - (back - 2 * mu * load / k), rel=1e-5)
    total = mu * load * (slip + back - 2 * mu * load / k)
    assert again.scalars["ALLFD"] == pytest.approx(total, rel=1e-4)
    assert again.RF[end, 0] == pytest.approx(-mu * load, rel=1e-6)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("angle", [15.0, 40.0])
def test_block_on_an_incline_below_the_friction_angle_rests(method: str, angle: float) -> None:
    """mu = tan(angle) + 0.02: the incline carries P cos(a) and P sin(a), in one increment, and the
    block, with no other support, does not move by more than its strain."""
    a, load = math.radians(angle), 3.0
    mesh = block(2.0, 0.5, 6, 2, angle=angle)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=STIFF)
    model.force("top", y=-load)
    far = 50.0 * np.array([math.cos(a), math.sin(a)])
    line = ct.RigidCurve.line(-far, far)
    model.contact("bottom", line, friction=math.tan(a) + 0.02, method=method, name="slope")
    results = solve(model)
    fx, fy = (scalar(results, f"slope: friction {c}") for c in "xy")
    assert fx * math.cos(a) + fy * math.sin(a) == pytest.approx(load * math.sin(a), rel=1e-6)
    assert scalar(results, "slope: force y") == pytest.approx(load, rel=1e-6)
    assert np.abs(results.frames[-1].U).max() < 1e-4


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("up", [True, False])
def test_block_drawn_along_an_incline(method: str, up: bool) -> None:
    """A spring parallel to a slope of 35 degrees carries P (sin a +- mu cos a) when its end has
    drawn the block up, or let it down."""
    a, load, mu, k = math.radians(35.0), 4.0, 0.25, 3.0
    t = np.array([math.cos(a), math.sin(a)])
    mesh = block(2.0, 0.5, 6, 2, angle=35.0)
    corner = int(np.argmax(mesh.points @ t))
    place = mesh.points[corner] + 40.0 * t
    end = ct.mesh.add_node(mesh, *place, "end")
    mesh.cells.append(Cells("line2", np.array([[end, corner]]), np.array([1000])))
    n = mesh.n_cells - 1
    model = ct.Model(mesh)
    model.section(np.arange(n), element="Q4I", material=STIFF)
    model.spring([n], k)
    model.force("top", y=-load)
    model.contact(
        "bottom", ct.RigidCurve.line(-90 * t, 90 * t), friction=mu, method=method, name="s"
    )
    travel = 8.0 if up else -8.0
    model.fix("end", x=travel * t[0], y=travel * t[1])
    results = solve(model)
    pull = float(reaction(results, "end")[:2] @ t)
    sign = 1.0 if up else -1.0
    assert pull == pytest.approx(load * (math.sin(a) + sign * mu * math.cos(a)), rel=1e-4)


@pytest.mark.parametrize(
    ("mu", "role"), cover([0.05, 0.3], ["wedge slave", "block slave"], strength=1)
)
def test_a_wedge_lifts_a_block_and_is_drawn_out(role: str, mu: float) -> None:
    """A wedge of angle a is driven below a block that a wall guides without friction and that
    bears P. With phi = atan(mu), the face passes P at the angle a + phi, the floor at phi: the
    wedge needs P (tan(a + phi) + tan phi). Drawn out, P (tan(a - phi) - tan phi): positive, it
    has to be held back, for a > 2 phi, else it locks itself and has to be pulled."""
    a, load = math.radians(10.0), 100.0
    phi = math.atan(mu)
    rise = math.tan(a)
    wedge = ct.mesh.mapped([(0, 0), (4, 0), (4, 1 + 4 * rise), (0, 1)], 8, 3)
    upper = ct.mesh.mapped(
        [(1, 1 + rise), (3, 1 + 3 * rise), (3, 3), (1, 3)], 6 if role == "block slave" else 3, 3
    )
    model = ct.Model(ct.mesh.assembly(wedge=wedge, upper=upper))
    model.section("all", element="Q4I", material=STIFF)
    model.fix("upper.left", x=0.0, y=None)
    model.force("upper.top", y=-load)
    model.contact("wedge.bottom", FLOOR, friction=mu, name="floor")
    pair = ["wedge.top", "upper.bottom"] if role == "wedge slave" else ["upper.bottom", "wedge.top"]
    model.contact(*pair, friction=mu, name="face")
    first, second = ct.Static(), ct.Static()
    first.fix("wedge.right", x=-0.5, y=None)
    second.fix("wedge.right", x=-0.1, y=None)
    results = solve(model, first, second)
    there, again = step_ends(results)[-2:]
    nodes = results.mesh.nodes_of("wedge.right")
    drive = load * (math.tan(a + phi) + math.tan(phi))
    assert -there.RF[nodes, 0].sum() == pytest.approx(drive, rel=1e-4)
    out = load * (math.tan(a - phi) - math.tan(phi))
    assert -again.RF[nodes, 0].sum() == pytest.approx(out, rel=1e-3, abs=1e-3)


@pytest.mark.parametrize("method", METHODS)
def test_a_block_tips_over_its_edge(method: str) -> None:
    """The upper left corner of a block of 1 x 3 and weight W is pushed until the block has turned
    by 15 degrees about its lower right corner, in one increment: moments about that corner give
    F = W x / y with the arms of the turned block. mu = 1 > F / W, so the corner does not slide."""
    b, h, weight = 1.0, 3.0, 6.0
    phi = math.radians(15.0)
    corner, middle = np.array([-b, h]), np.array([-b / 2, h / 2])
    c, s = math.cos(phi), math.sin(phi)
    turn = np.array([[c, s], [-s, c]])  # clockwise
    mesh = block(b, h, 2, 6)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e7, nu=0.3, rho=weight / (b * h)))
    model.gravity(y=-1.0)
    node = int(np.argmin(mesh.points @ np.array([1.0, -1.0])))
    model.fix([node], x=float((turn @ corner - corner)[0]), y=None)
    model.contact("bottom", FLOOR, friction=1.0, method=method, name="floor")
    results = solve(model)
    push = weight * -(turn @ middle)[0] / (turn @ corner)[1]
    assert reaction(results, [node])[0] == pytest.approx(push, rel=1e-4)
    assert scalar(results, "floor: force x") == pytest.approx(-push, rel=1e-4)
    assert scalar(results, "floor: force y") == pytest.approx(weight, rel=1e-5)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("mu", "moves"), [(0.24, False), (0.26, True)])
def test_a_tall_block_slides_before_it_tips(method: str, mu: float, moves: bool) -> None:
    """Pushed at the height of 2 with W / 4, a block of width 1 on mu < 1/4 slides; with mu > 1/4 it
    would tip, as the resultant leaves its base: W / 4 x 2 = W / 2. Below, it needs mu W at a
    spring, and what is missing in the spring shows whether it slid or tipped."""
    weight, k = 8.0, 50.0
    mesh = block(1.0, 3.0, 4, 12)
    node = int(np.argmin(np.hypot(mesh.points[:, 0], mesh.points[:, 1] - 2.0)))
    end = ct.mesh.add_node(mesh, -1.0, 2.0, "end")
    mesh.cells.append(Cells("line2", np.array([[end, node]]), np.array([1000])))
    n = mesh.n_cells - 1
    model = ct.Model(mesh)
    model.section(np.arange(n), element="Q4I", material=ct.Elastic(E=1e7, nu=0.3, rho=weight / 3.0))
    model.spring([n], k, "x x")
    model.gravity(y=-1.0)
    model.fix("end", x=1.0, y=0.0)
    model.contact("bottom", FLOOR, friction=mu, method=method, name="floor")
    results = solve(model)
    u = results.frames[-1].U
    foot = u[np.argmin(np.hypot(*(mesh.points - [1.0, 0.0]).T))]
    if moves:  # tips about the corner: arms 2 and 1/2 turned by phi
        push = float(reaction(results, "end")[0])
        top = mesh.points[node] + u[node] - [1.0, 0.0]
        mid = np.array([0.5, 1.5])
        center = results.mesh.points[:end].mean(axis=0)
        assert center == pytest.approx(mid)
        arm = 1.0 - (mid[0] + u[:end, 0].mean())
        assert push == pytest.approx(weight * arm / top[1], rel=1e-3)
        assert abs(foot[0]) < 1e-4
    else:
        assert reaction(results, "end")[0] == pytest.approx(mu * weight, rel=1e-5)
        assert foot[0] == pytest.approx(1.0 - mu * weight / k, rel=1e-4)


@pytest.mark.parametrize(("method", "lower_is_slave"), cover(METHODS, [True, False], strength=1))
def test_a_stack_slides_at_its_weakest_joint(method: str, lower_is_slave: bool) -> None:
    """Three blocks of weight W on each other and a floor; the topmost is drawn. Joints bear W, 2 W,
    3 W with mu = .5, .2, .3: bounds of .5 W, .4 W, .9 W, so the second joint slides with .4 W and
    every joint passes that force."""
    w = 2.0
    bodies = {
        n: block(4.0, 0.5, nx, 2, (0.0, 0.5 * i))
        for i, (n, nx) in enumerate(zip("abc", (6, 7, 5), strict=True))
    }
    model = ct.Model(ct.mesh.assembly(**bodies))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e7, nu=0.3, rho=w / 2.0))
    model.gravity(y=-1.0)
    model.fix("c.right", x=0.4, y=None)
    model.contact("a.bottom", FLOOR, friction=0.3, method=method, name="floor")
    for low, high, mu in (("a", "b", 0.2), ("b", "c", 0.5)):
        pair = [f"{low}.top", f"{high}.bottom"]
        model.contact(
            *(pair if lower_is_slave else pair[::-1]), friction=mu, method=method, name=low + high
        )
    results = solve(model)
    sign = 1.0 if lower_is_slave else -1.0
    assert reaction(results, "c.right")[0] == pytest.approx(0.4 * w, rel=1e-5)
    assert scalar(results, "floor: force x") == pytest.approx(-0.4 * w, rel=1e-5)
    assert scalar(results, "floor: force y") == pytest.approx(3 * w, rel=1e-5)
    assert scalar(results, "ab: force x") == pytest.approx(sign * 0.4 * w, rel=1e-5)
    assert scalar(results, "ab: force y") == pytest.approx(-sign * 2 * w, rel=1e-5)
    assert scalar(results, "bc: force y") == pytest.approx(-sign * w, rel=1e-5)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("role", ["block slave", "table slave"])
@pytest.mark.parametrize("travel", [3.3, 4.9])
def test_a_block_drawn_over_the_end_of_a_table_in_one_increment(
    method: str, role: str, travel: float
) -> None:
    """A block of 4 x .5 with the load on its top moves over a table that ends under it. Until half
    of it hangs over, the table bears it all: the force is mu P, at the place that moments give:
    x = 2 + d + mu / 2 for the height .5 of the pull (half of it: the right side is moved)."""
    mu, load = 0.2, 6.0
    table = block(8.0, 1.0, 12, 3, (-1.0, -1.0))  # ends at x = 7
    body = block(4.0, 0.5, 8, 2)
    model = ct.Model(ct.mesh.assembly(table=table, body=body))
    model.section("all", element="Q4I", material=STIFF)
    model.fix("table.bottom")
    model.force("body.top", y=-load)
    model.fix("body.right", x=travel, y=None)
    pair = ["body.bottom", "table.top"]
    model.contact(
        *(pair if role == "block slave" else pair[::-1]), friction=mu, method=method, name="t"
    )
    results = solve(model)
    sign = 1.0 if role == "block slave" else -1.0
    right = results.mesh.nodes_of("body.right")
    frame = results.frames[-1]
    assert frame.RF[right, 0].sum() == pytest.approx(mu * load, rel=1e-4)
    assert sign * scalar(results, "t: force x") == pytest.approx(-mu * load, rel=1e-4)
    assert sign * scalar(results, "t: force y") == pytest.approx(load, rel=1e-4)
    y = results.mesh.points[right, 1] + frame.U[right, 1]
    where = 2.0 + travel + float(frame.RF[right, 0] @ y) / load
    assert sign * scalar(results, "t: moment") == pytest.approx(load * where, rel=1e-3)


@pytest.mark.parametrize("method", METHODS)
def test_a_strip_drawn_out_between_two_plates_that_press(method: str) -> None:
    """A strip between a rigid floor and a rigid plate that P presses on it: 2 mu P, in one
    increment of seven times its thickness."""
    mu, load = 0.35, 20.0
    mesh = block(6.0, 0.5, 6, 2)
    plate = ct.mesh.add_node(mesh, 3.0, 2.0, "plate")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=STIFF)
    lid = ct.RigidCurve.line((60.0, 0.5), (-60.0, 0.5), reference=plate)
    model.contact("bottom", FLOOR, friction=mu, method=method, name="floor")
    model.contact("top", lid, friction=mu, method=method, name="lid")
    model.fix("plate", x=0.0, y=None, rotation=True)
    model.force("plate", y=-load)
    model.fix("right", x=3.5, y=None)
    results = solve(model)
    assert reaction(results, "right")[0] == pytest.approx(2 * mu * load, rel=1e-5)
    assert reaction(results, "plate")[0] == pytest.approx(-mu * load, rel=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_heated_strip_on_a_rough_floor_and_cooled(method: str) -> None:
    """A strip under a uniform pressure q that is heated slips outwards from its middle. A flat
    strip has no curvature, so the moment mu q h/2 per length of friction about its axis is a
    shear force, and its ends press mu q h/2 more: with the distance s from an end N = -mu (q s +
    mu q h/2). Cooled by the same, all of it slips back, since E h alpha dT is more than 2 mu q
    L/2, and the ends press less: N = mu (q s - mu q h/2). Exact at every cut, in one increment
    each."""
    mu, q, length, modulus = 0.3, 1.0, 40.0, 1e7
    model = ct.Model(block(length, 0.5, 40, 1))
    model.section("all", element="Q4I", material=ct.Elastic(E=modulus, nu=0.0, expansion=1e-5))
    model.pressure("top", q)
    middle = int(np.argmin(np.hypot(model.mesh.points[:, 0] - 20.0, model.mesh.points[:, 1])))
    model.fix([middle], x=0.0, y=None)
    model.contact("bottom", FLOOR, friction=mu, method=method, name="floor")
    hot, cold = ct.Static(), ct.Static()
    hot.temperature(10.0)
    cold.temperature(0.0)
    results = solve(model, hot, cold)
    frames = [results.frames.index(f) for f in step_ends(results)[-2:]]
    for x in (5.5, 12.5, 30.5):
        s, end = 20.0 - abs(x - 20.0), mu * q * 0.25
        for frame, sign in zip(frames, (-1.0, 1.0), strict=True):
            cut = results.section((x, -1.0), (x, 1.5), frame=frame)
            assert pytest.approx(sign * mu * (q * s - sign * end), rel=1e-3) == cut.N


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("turn", [60.0, 150.0])
def test_a_pair_held_by_friction_turns_with_its_base(method: str, turn: float) -> None:
    """Pressure on the top and side of an upper block, both following, are carried by friction below
    its bound. When the base turns by any angle, in one increment, the force on the joint turns with
    it, (S, -P) turned, and nothing slips."""
    lower, upper = block(4.0, 1.0, 7, 2, (0.0, -1.0)), block(3.0, 1.0, 6, 2, (0.5, 0.0))
    mesh = ct.mesh.assembly(lower=lower, upper=upper)
    ref = ct.mesh.add_node(mesh, 2.0, -1.5, "ref")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    model.rigid("lower.bottom", ref)
    model.contact("upper.bottom", "lower.top", friction=0.6, method=method, name="joint")
    first, second = ct.Static(), ct.Static()
    first.pressure("upper.top", 2.0)
    first.pressure("upper.left", 1.0)
    first.fix("ref", rotation=0.0)
    second.fix("ref", rotation=math.radians(turn))
    results = solve(model, first, second)
    a, b = step_ends(results)[-2:]
    before = np.array([a.scalars[f"joint: force {c}"] for c in "xy"])
    after = np.array([b.scalars[f"joint: force {c}"] for c in "xy"])
    assert before == pytest.approx([-1.0, 6.0], rel=2e-3)
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    assert after == pytest.approx(np.array([[c, -s], [s, c]]) @ before, rel=1e-6)
    pressed = results.mesh.nodes_of("upper.bottom")
    assert b.C[pressed, 0] == pytest.approx(a.C[pressed, 0], rel=1e-5, abs=1e-6)
    assert b.C[pressed, 1] == pytest.approx(a.C[pressed, 1], rel=1e-5, abs=1e-6)
    assert b.scalars["ALLFD"] == pytest.approx(a.scalars["ALLFD"], abs=1e-9)
