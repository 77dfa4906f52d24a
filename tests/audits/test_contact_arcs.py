"""An audit of contact, written from the pages alone: belts, drums, cams, rollers, with friction, in
one increment.

Closed forms are those of the chain of straight elements where there is one (Eytelwein's formula for
a polygon), so that tolerances are those of the stretch.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from tests.support.blocks import METHODS, STIFF, block, chain, reaction, scalar, solve
from tests.support.pairs import cover


def belt(angle: float, n: int, radius: float = 1.0, straight: float = 2.0) -> np.ndarray:
    """Points of a belt over the top of a drum: a straight end, n chords around, a straight end."""
    half = math.radians(angle) / 2
    around = np.linspace(half, -half, n + 1)  # from the left over the top to the right
    arc = radius * np.column_stack([-np.sin(around), np.cos(around)])
    left, right = (
        np.array([math.cos(half), math.sin(half)]),
        np.array([math.cos(half), -math.sin(half)]),
    )
    return np.vstack([arc[0] - straight * left, arc, arc[-1] + straight * right])


def polygon_ratio(angle: float, n: int, mu: float) -> float:
    """Ratio of the tensions: (cos + mu sin) / (cos - mu sin) of half the turn at each node between
    two chords; at the first and last node the tangent has half a turn to the chord, and the
    normal is that of the drum."""
    half = math.radians(angle) / n / 2
    c, s = math.cos(half), math.sin(half)
    step = (c + mu * s) / (c - mu * s)
    return float(step**n)


@pytest.mark.parametrize(
    ("angle", "n"),
    [(30.0, 4)]
    + [pytest.param(*far, marks=pytest.mark.slow) for far in ((90.0, 8), (180.0, 12), (210.0, 14))],
)
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_capstan_that_turns_below_a_chain_of_trusses(angle: float, n: int, sense: float) -> None:
    """A drum turns by a radian in one increment below a rope that is fixed at its left end and
    drawn by T at its right: its left end bears T exp(-mu angle) or T exp(mu angle), in a polygon
    the product of (cos h + mu sin h) / (cos h - mu sin h) with half the turn of a chord, h,
    since each node passes from one tangent of half a chord to the next. The drum's moment is the
    difference times its radius."""
    mu, pull = 0.25, 1.0
    points = belt(angle, n)
    mesh = chain(points)
    drum = ct.mesh.add_node(mesh, 0.0, 0.0, "drum")
    model = ct.Model(mesh)
    model.truss("chain", material=ct.Elastic(E=1e6, nu=0.3), area=1.0)
    end = points[-1] - points[-2]
    end /= np.hypot(*end)
    model.fix([0])
    model.fix("drum", rotation=sense * 1.0)
    model.force([len(points) - 1], x=pull * end[0], y=pull * end[1])
    model.contact(
        "chain", ct.RigidCurve.circle((0, 0), 1.0, reference=drum), friction=mu, name="drum"
    )
    results = solve(model)
    left = math.hypot(*reaction(results, [0])[:2])
    # a drum that turns counter-clockwise draws the rope to the left: away from the pull
    ratio = polygon_ratio(angle, n, mu) ** -sense
    assert left == pytest.approx(pull * ratio, rel=1e-4)
    assert reaction(results, [drum])[2] == pytest.approx(pull - left, rel=1e-3)
    assert scalar(results, "drum: moment") == pytest.approx(pull - left, rel=1e-3)


@pytest.mark.parametrize("mu", [0.1, 0.4])
def test_capstan_holds_what_is_below_its_bound(mu: float) -> None:
    """A rope over 180 degrees with a force of 1 at one end and T at the other end, held by friction
    alone: T = exp(.8 mu pi) < exp(mu pi) rests, and the drum bears 1 + T and the moment T - 1."""
    n = 18
    points = belt(180.0, n)
    mesh = chain(points)
    model = ct.Model(mesh)
    model.truss("chain", material=ct.Elastic(E=1e6, nu=0.3), area=1.0)
    big = math.exp(0.8 * mu * math.pi)
    last = len(points) - 1
    model.fix([0, last], x=0.0, y=None)
    model.force([0], y=-1.0)
    model.force([last], y=-big)
    model.contact("chain", ct.RigidCurve.circle((0, 0), 1.0), friction=mu, name="drum")
    results = solve(model)
    assert scalar(results, "drum: force y") == pytest.approx(1 + big, rel=1e-6)
    assert scalar(results, "drum: moment") == pytest.approx(big - 1, rel=1e-4)
    assert np.abs(results.frames[-1].U).max() < 1e-4


@pytest.mark.parametrize(
    ("method", "turn"), cover(METHODS, [30.0, 90.0, 180.0, -180.0], strength=1)
)
def test_torque_of_a_pad_on_a_turning_drum_in_one_increment(turn: float, method: str) -> None:
    """A narrow stiff pad, guided by its sides, is pressed by P on top of a drum of radius R: mu P
    R, against the turn; a pad half as wide as .1 R changes it by (b/R)^2 / 6 < 1e-3."""
    mu, load, radius = 0.4, 10.0, 5.0
    mesh = block(0.5, 0.5, 4, 4, (-0.25, radius))
    drum = ct.mesh.add_node(mesh, 0.0, 0.0, "drum")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.0))
    model.fix("left", x=0.0, y=None)
    model.fix("right", x=0.0, y=None)
    model.force("top", y=-load)
    circle = ct.RigidCurve.circle((0, 0), radius, reference=drum)
    model.contact("bottom", circle, friction=mu, method=method, name="pad")
    press, rotate = ct.Static(), ct.Static()
    press.fix("drum", rotation=0.0)
    rotate.fix("drum", rotation=math.radians(turn))
    results = solve(model, press, rotate)
    torque = float(results.frames[-1].RF[drum, 2])
    assert torque == pytest.approx(math.copysign(mu * load * radius, turn), rel=4e-3)
    assert scalar(results, "pad: force y") == pytest.approx(load, rel=1e-6)
    work = mu * load * radius * abs(math.radians(turn))
    assert scalar(results, "ALLFD") == pytest.approx(work, rel=2e-2)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("mu", [0.2, 0.5])
def test_short_shoe_brake_helps_or_hinders_itself(sense: float, mu: float) -> None:
    """A lever with its pivot at the origin has a shoe node at (a, -c) on top of a drum and is
    pressed by F at (b, 0): moments about the pivot, N a - sense mu N c = F b (Shigley). The drum
    turns by 90 degrees in one increment; its torque is mu N R."""
    a, b, c, radius, force = 2.0, 5.0, 0.5, 1.0, 3.0
    points = [(0.0, 0.0), (a, 0.0), (b, 0.0), (a, -c)]
    mesh = Mesh(
        np.array(points),
        [Cells("line2", np.array([[0, 1], [1, 2], [1, 3]]), np.arange(1, 4))],
        np.arange(1, 5),
    )
    drum = ct.mesh.add_node(mesh, a, -c - radius, "drum")
    model = ct.Model(mesh)
    model.beam([0, 1, 2], material=ct.Elastic(E=1e8, nu=0.3), area=1.0, inertia=1.0)
    model.fix([0])
    model.fix("drum", rotation=sense * math.pi / 2)
    model.force([2], y=-force)
    circle = ct.RigidCurve.circle((a, -c - radius), radius, reference=drum)
    model.contact([3], circle, friction=mu, name="shoe")
    results = solve(model)
    # counter-clockwise the top of the drum drags the shoe to the left: at (a, -c) this turns the
    # lever by -mu N * (-c) * (-1): moment x*fy - y*fx = a N + c * (-sense mu N)
    normal = force * b / (a - sense * mu * c)
    assert scalar(results, "shoe: force y") == pytest.approx(normal, rel=1e-5)
    assert reaction(results, [drum])[2] == pytest.approx(sense * mu * normal * radius, rel=1e-5)
    assert results.frames[-1].C[3, 0] == pytest.approx(normal, rel=1e-5)  # a node has the area 1


@pytest.mark.parametrize(("method", "mu", "turn"), cover(METHODS, [0.0, 0.3], [30.0, 90.0, 150.0]))
def test_flat_follower_on_an_eccentric_cam(method: str, mu: float, turn: float) -> None:
    """A disc of radius R turns about a point e below its center: a flat follower rises by e
    cos(turn), the contact lies e sin(turn) to the left for a turn to the left, and the cam needs
    the moment P x - mu P y about its axis with the place of the contact (x, y) = (-e sin, R + e
    cos), a node here."""
    e, radius, load = 0.5, 2.0, 8.0
    t = math.radians(turn)
    mesh = block(2.0, 0.5, 8, 2, (-1.0, e + radius))
    axis = ct.mesh.add_node(mesh, 0.0, 0.0, "axis")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.3))
    model.fix("left", x=0.0, y=None)
    model.fix("right", x=0.0, y=None)
    model.force("top", y=-load)
    model.fix("axis", rotation=t)
    cam = ct.RigidCurve.circle((0.0, e), radius, reference=axis)
    model.contact("bottom", cam, friction=mu, method=method, name="cam")
    results = solve(model)
    x, y = -e * math.sin(t), radius + e * math.cos(t)
    assert scalar(results, "cam: force y") == pytest.approx(load, rel=1e-6)
    assert scalar(results, "cam: force x") == pytest.approx(-mu * load, rel=1e-2, abs=2e-3)
    rise = results.frames[-1].U[results.mesh.nodes_of("top"), 1].mean()
    assert rise == pytest.approx(e * (math.cos(t) - 1.0), abs=2e-3)
    # force on the cam (mu P, -P) at (x, y); the axis holds against it
    torque = -(x * -load - y * mu * load)
    assert reaction(results, [axis])[2] == pytest.approx(torque, abs=1e-2 * load)


@pytest.mark.parametrize("travel", [0.2, -0.6])
def test_a_disc_rolls_between_two_plates_without_resistance(travel: float) -> None:
    """A rigid disc between a fixed lower and a driven upper plate, both stiff, rolls: it moves by
    half the travel of the plate and turns by travel / (2 R); the plate needs no force though mu
    P = 5."""
    radius, load = 1.0, 10.0
    lower, upper = block(2.0, 0.2, 20, 1, (-0.5, -0.2)), block(3.0, 0.2, 30, 1, (-2.0, 2.0))
    mesh = ct.mesh.assembly(lower=lower, upper=upper)
    disc = ct.mesh.add_node(mesh, 0.0, radius, "disc")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=STIFF)
    model.fix("lower.bottom")
    model.force("upper.top", y=-load)
    model.fix("upper.left", x=travel, y=None)
    circle = ct.RigidCurve.circle((0.0, radius), radius, reference=disc)
    model.contact("lower.top", circle, friction=0.5, name="low")
    model.contact("upper.bottom", circle, friction=0.5, name="high")
    results = solve(model)
    frame = results.frames[-1]
    assert frame.U[disc, 0] == pytest.approx(travel / 2, rel=5e-3)
    assert frame.UR[disc] == pytest.approx(-travel / 2 / radius, rel=5e-3)
    assert abs(scalar(results, "high: force x")) < 1e-3 * load


@pytest.mark.parametrize("turn", [-0.5, -2.5])
def test_a_driven_wheel_rolls_until_its_friction_is_used_up(turn: float) -> None:
    """A rigid wheel, pressed by P on a bed, is turned in one increment; a spring k along x holds
    its axle. While k R turn < mu P it rolls: x = -R turn, and its moment is k x R; beyond, it
    spins in place at x = mu P / k with the moment mu P R. The bed yields by a contact of half
    width .15, six edges, so that no single node carries the wheel; creep is then mu a / R times
    the used share, below 3 %."""
    radius, load, mu, k = 1.0, 10.0, 0.3, 4.0
    mesh = block(3.0, 0.3, 60, 3, (-1.0, -0.3))
    axle = ct.mesh.add_node(mesh, 0.0, radius, "axle")
    ground = ct.mesh.add_node(mesh, 0.0, 3.0, "ground")
    mesh.cells.append(Cells("line2", np.array([[ground, axle]]), np.array([1000])))
    n = mesh.n_cells - 1
    model = ct.Model(mesh)
    model.section(np.arange(n), element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.spring([n], k, "x x")
    model.fix("ground")
    model.fix("bottom")
    circle = ct.RigidCurve.circle((0.0, radius), radius, reference=axle)
    model.contact("top", circle, friction=mu, name="bed")
    press, drive = ct.Static(), ct.Static()
    press.force("axle", y=-load)
    press.fix("axle", x=None, y=None, rotation=0.0)
    drive.fix("axle", x=None, y=None, rotation=turn)
    results = solve(model, press, drive)
    frame = results.frames[-1]
    x = min(-radius * turn, mu * load / k)
    assert frame.U[axle, 0] == pytest.approx(x, rel=4e-2)
    assert frame.RF[axle, 2] == pytest.approx(-k * x * radius, rel=4e-2)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("turn", [20.0, 120.0])
def test_torque_capacity_of_a_ring_shrunk_on_a_rigid_shaft(method: str, turn: float) -> None:
    """A ring a = 1, b = 2, held at its outside, on a shaft that is larger by d. Lame with u = C (r
    - b^2 / r) for the fixed outside: u(a) = d gives p = -sigma_r(a) in plane stress. Slipping,
    mu p acts along: torque mu p 2 pi a^2."""
    a, b, d, mu, modulus, nu = 1.0, 2.0, 1e-3, 0.2, 1e4, 0.3
    mesh = ct.mesh.annulus(a, b, 8, 96)
    shaft = ct.mesh.add_node(mesh, 0.0, 0.0, "shaft")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=modulus, nu=nu))
    model.fix("outer")
    circle = ct.RigidCurve.circle((0, 0), a + d, reference=shaft)
    model.contact("inner", circle, friction=mu, method=method, name="fit")
    fit, rotate = ct.Static(), ct.Static()
    fit.fix("shaft", rotation=0.0)
    rotate.fix("shaft", rotation=math.radians(turn))
    results = solve(model, fit, rotate)
    k = d / (a - b * b / a)
    p = -modulus / (1 - nu**2) * k * ((1 + b * b / a**2) + nu * (1 - b * b / a**2))
    frame = results.frames[-1]
    pressed = frame.C[results.mesh.nodes_of("inner"), 0]
    assert pressed.mean() == pytest.approx(p, rel=1e-2)
    assert frame.RF[shaft, 2] == pytest.approx(mu * p * 2 * math.pi * a * a, rel=1e-2)
