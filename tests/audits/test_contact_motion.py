"""An audit of contact, written from the pages alone: impact and sliding in time, against closed
forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from tests.support.blocks import METHODS, block, scalar, solve

FLOOR = ct.RigidCurve.line((-100.0, 0.0), (100.0, 0.0))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("slave", ["short", "long"])
def test_a_short_bar_that_hits_a_long_one_stops(slave: str, method: str) -> None:
    """Bars of one section, 1 and 2 long, the short one with v: two waves of rho c v / 2 run apart,
    after 2 L1 / c the short bar is at rest and without stress, and the long one has all the
    momentum m v: restitution 1/2, force rho c A v / 2."""
    v, c = 0.1, 10.0
    a, b = block(1.0, 0.1, 12, 1), block(2.0, 0.1, 24, 1, (1.005, 0.0))
    model = ct.Model(ct.mesh.assembly(short=a, long=b))
    model.section("all", element="Q4I", material=ct.Elastic(E=c * c, nu=0.0, rho=1.0))
    model.velocity("short", x=v)
    pair = ["short.right", "long.left"] if slave == "short" else ["long.left", "short.right"]
    model.contact(*pair, friction=0.3, method=method, name="hit")
    step = ct.Dynamic(period=0.35, increments=90, scheme="energy_momentum")
    results = solve(model, step)
    frame = results.frames[-1]
    assert frame.V is not None
    speed = frame.V[results.mesh.nodes_of("short"), 0].mean()
    assert abs(speed) < 0.04 * v
    force = np.abs(results.history("hit: force x"))
    impulse = float(np.sum(force[1:] * np.diff(results.history("time"))))
    assert impulse == pytest.approx(0.1 * v, rel=3e-2)
    assert np.median(force[force > 0.2 * force.max()]) == pytest.approx(c * 0.1 * v / 2, rel=5e-2)
    assert scalar(results, "momentum x") == pytest.approx(0.1 * v, rel=1e-9)
    assert abs(scalar(results, "energy balance error")) < 1e-8


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_a_belt_that_starts_picks_up_a_block(scheme: str) -> None:
    """A block rests on a belt that suddenly runs with V: it gains mu g t until V, by t = V / (mu
    g). Friction takes m V^2 / 2, as much as the block gains, and the belt works m V^2."""
    mu, g, speed, period = 0.2, 10.0, 1.0, 0.8
    mesh = block(2.0, 0.5, 6, 3)
    belt = ct.mesh.add_node(mesh, 0.0, -1.0, "belt")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.2, rho=2.0))
    model.gravity(y=-g)
    line = ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0), reference=belt)
    model.contact("bottom", line, friction=mu, name="belt")
    model.amplitudes["run"] = ct.Amplitude(np.array([0.0, period]), np.array([0.0, 1.0]))
    rest = ct.Static()
    rest.fix("belt", x=0.0, y=0.0, rotation=True)
    run = ct.Dynamic(period=period, increments=80, scheme=scheme)
    run.fix("belt", x=speed * period, y=None, amplitude="run")
    results = solve(model, rest, run)
    mass = 2.0
    assert scalar(results, "momentum x") == pytest.approx(mass * speed, rel=2e-2)
    assert scalar(results, "ALLFD") == pytest.approx(mass * speed**2 / 2, rel=4e-2)
    times, momentum = results.history("step time"), results.history("momentum x")
    middle = int(
        np.argmin(
            np.abs(np.asarray(times) - 0.3) + 10.0 * (np.asarray(results.history("step")) < 2)
        )
    )
    assert momentum[middle] == pytest.approx(mass * mu * g * 0.3, rel=4e-2)


@pytest.mark.parametrize("scheme", ["energy_momentum", "hht", "central_difference"])
@pytest.mark.parametrize("method", METHODS)
def test_friction_of_an_oblique_impact(scheme: str, method: str) -> None:
    """A block lands flat with (1.5, -1) and never stops sliding: each force is mu times the other,
    so the change of the momentum along the floor is -mu times that across."""
    mu = 0.2
    model = ct.Model(block(1.0, 1.0, 3, 3, (0.0, 0.01)))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.2, rho=1.0))
    model.velocity(x=1.5, y=-1.0)
    model.contact("bottom", FLOOR, friction=mu, method=method, name="floor")
    step = ct.Dynamic(period=0.05, increments=100, scheme=scheme)
    results = solve(model, step)
    gained = scalar(results, "momentum y") + 1.0
    lost = 1.5 - scalar(results, "momentum x")
    assert gained > 1.5
    assert lost == pytest.approx(mu * gained, rel=1e-5 if scheme == "energy_momentum" else 1e-3)
    work = scalar(results, "ALLFD")
    assert 0.5 * lost * 1.5 < work < 1.05 * lost * 1.5


@pytest.mark.parametrize("scheme", ["energy_momentum", "newmark", "hht"])
def test_a_block_bounces_on_a_linear_layer(scheme: str) -> None:
    """A stiff block of mass 1 meets a layer of k = 100 with v = 1: half a period, pi / 10, force up
    to v sqrt(k m) = 10, back with v."""
    model = ct.Model(block(1.0, 1.0, 3, 3))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.velocity(y=-1.0)
    model.contact("bottom", FLOOR, law=ct.PressureLaw("linear", [100.0]), name="layer")
    results = solve(model, ct.Dynamic(period=0.36, increments=72, scheme=scheme))
    assert scalar(results, "momentum y") == pytest.approx(1.0, rel=1e-2)
    force = np.asarray(results.history("layer: force y"))
    assert force.max() == pytest.approx(10.0, rel=1e-2)
    area = float(np.trapezoid(force, results.history("time")))
    assert area == pytest.approx(2.0, rel=2e-2)


@pytest.mark.parametrize("method", METHODS)
def test_a_block_slides_down_an_incline(method: str) -> None:
    """From rest on 30 degrees with mu = .3 < tan 30: the distance is g (sin a - mu cos a) t^2 / 2,
    friction takes mu m g cos a times it."""
    a, mu, g, t = math.radians(30.0), 0.3, 10.0, 0.5
    model = ct.Model(block(2.0, 0.5, 6, 3, angle=30.0))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.2, rho=1.0))
    model.gravity(y=-g)
    way = np.array([math.cos(a), math.sin(a)])
    model.contact(
        "bottom", ct.RigidCurve.line(-50 * way, 50 * way), friction=mu, method=method, name="slope"
    )
    results = solve(model, ct.Dynamic(period=t, increments=50))
    speed = -(scalar(results, "momentum x") * way[0] + scalar(results, "momentum y") * way[1])
    pull = g * (math.sin(a) - mu * math.cos(a))
    assert speed == pytest.approx(pull * t, rel=2e-2)
    slid = -float((results.frames[-1].U @ way).mean())
    assert slid == pytest.approx(pull * t * t / 2, rel=2e-2)
    assert scalar(results, "ALLFD") == pytest.approx(mu * g * math.cos(a) * slid, rel=2e-2)
