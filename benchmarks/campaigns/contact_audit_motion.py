"""Checks of contact in motion, with every scheme; see contact_audit."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import corota as ct
from benchmarks.campaigns.contact_audit_solids import last
from benchmarks.campaigns.contact_audit_statics import Row, box, check, variants

SCHEMES: dict[str, dict[str, Any]] = {
    "hht": {"scheme": "hht"},
    "generalized alpha": {"scheme": "generalized_alpha"},
    "energy-momentum": {"scheme": "energy_momentum"},
    "explicit": {"scheme": "central_difference"},
}
IMPLICIT = tuple(list(SCHEMES)[:3])


def block(element: str, lx: float, ly: float, nx: int, ny: int, E: float = 1e4) -> ct.Model:
    """A block of density 1 on y = 0."""
    model = ct.Model(box(element, lx, ly, nx, ny))
    model.section("all", element=element, material=ct.Elastic(E=E, nu=0.3, rho=1.0))
    return model


@check(friction=True)
def forced_oscillator_with_dry_friction() -> Iterator[Row]:
    """Amplitude of Den Hartog's oscillator from an integration with events."""
    k, mu, g, size, time = 2.0, 0.2, 2.0, 1.0, 12.0
    mass, omega, force = 0.5, 3.0, 1.0
    bound = mu * mass * g

    def rate(t: float, y: Any) -> Any:
        return [
            y[1],
            (force * math.cos(omega * t) - k * y[0] - bound * np.tanh(y[1] / 1e-4)) / mass,
        ]

    path = solve_ivp(
        rate, (0.0, time), [0.0, 0.0], rtol=1e-7, atol=1e-9, max_step=0.01, method="LSODA"
    )
    peak, end = float(np.abs(path.y[0]).max()), float(path.y[0][-1])
    times = np.linspace(0.0, time, 1201)
    for method, scheme in variants(IMPLICIT):
        mesh = ct.mesh.merge(
            box("Q4I", size, 0.5, 4, 2), ct.mesh.line([(1.0, 0.25), (3.0, 0.25)], 1, "spring")
        )
        mesh.cell_sets["block"] = np.arange(mesh.n_cells - 1)
        model = ct.Model(mesh)
        model.section("block", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
        model.spring("spring", k)
        model.fix("spring.end")
        floor = ct.RigidCurve.line((-5.0, 0.0), (8.0, 0.0))
        model.contact("bottom", floor, friction=mu, method=method, name="floor")
        model.gravity(y=-g)
        model.amplitudes["wave"] = ct.Amplitude(times, np.cos(omega * times))
        shake = ct.Dynamic(period=time, increments=600, **SCHEMES[scheme])
        shake.force("bottom", x=force, amplitude="wave")
        results = ct.solve(model, [ct.Static(), shake])
        moved = results.history("U1", at="top", combine="mean")
        yield f"{method} {scheme} peak", float(np.abs(moved).max()), peak, 0.02
        yield f"{method} {scheme} end", (float(moved[-1]) - end) / peak, 0.0, 0.05


@check(friction=True)
def block_thrown_up_a_slope_and_back() -> Iterator[Row]:
    """It comes back with v sqrt((sin b - mu cos b) / (sin b + mu cos b)); g leans."""
    b, mu, g, v = math.radians(35.0), 0.3, 5.0, 2.0
    up, down = (g * (math.sin(b) + s * mu * math.cos(b)) for s in (1.0, -1.0))
    way = v**2 / (2.0 * up)
    time = v / up + math.sqrt(2.0 * way / down)
    for method, scheme in variants(("hht", "explicit")):
        model = block("Q4I", 1.0, 0.3, 4, 3, E=1e3)
        floor = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
        model.contact("bottom", floor, friction=mu, method=method, name="floor")
        model.velocity(x=v)
        press, fly = ct.Static(), ct.Dynamic(period=time, **SCHEMES[scheme])
        press.gravity(y=-g * math.cos(b))
        press.fix("left", x=0.0, y=None)
        fly.release("left", y=False)
        fly.gravity(x=-g * math.sin(b))
        results = ct.solve(model, [press, fly])
        moved = results.history("U1", at="top", combine="mean")
        yield f"{method} {scheme} way", float(moved.max()), way, 0.02
        yield f"{method} {scheme} back", float(moved[-1]) / way, 0.0, 0.03


@check(friction=True)
def plate_braked_between_two_pads() -> Iterator[Row]:
    """Two pads stop it after m v^2 / 4 mu P."""
    mu, press, v = 0.25, 4.0, 1.5
    mass = 2.0 * 0.2
    way = mass * v**2 / (4.0 * mu * press)
    for method, scheme, swapped in variants(("hht", "energy-momentum", "explicit"), (False, True)):
        mesh = ct.mesh.assembly(
            lower=box("Q4I", 0.5, 0.2, 3, 2, (0.0, -0.2)),
            plate=box("Q4I", 2.0, 0.2, 12, 2, (-1.2, 0.0)),
            upper=box("Q4I", 0.5, 0.2, 3, 2, (0.0, 0.2)),
        )
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
        for pad, face, side in (("lower", "top", "bottom"), ("upper", "bottom", "top")):
            pair = [f"{pad}.{face}", f"plate.{side}"]
            if swapped:
                pair.reverse()
            model.contact(*pair, friction=mu, method=method, name=pad)
        model.fix("lower.bottom")
        model.fix("upper.top", x=0.0, y=None)
        model.force("upper.top", y=-press)
        model.velocity("plate", x=v)
        hold = ct.Static()
        hold.fix("plate.left", x=0.0, y=None)
        brake = ct.Dynamic(period=1.3 * 2.0 * way / v, **SCHEMES[scheme])
        brake.release("plate.left", y=False)
        results = ct.solve(model, [hold, brake])
        moved = results.history("U1", at="plate.left", combine="mean")
        name = f"{method} {scheme}{' swapped' if swapped else ''}"
        yield name, float(moved[-1]), way, 0.02


@check(friction=True)
def block_rocks_about_its_corner() -> Iterator[Row]:
    """Housner: it falls back from the tilt t0 after arcosh(a / (a - t0)) / p, p^2 = 3 g / 4 r."""
    wide, high, g, tilt = 0.4, 1.2, 5.0, 0.12
    r, alpha = 0.5 * math.hypot(wide, high), math.atan(wide / high)

    def rate(t: float, y: Any) -> Any:
        return [y[1], -0.75 * g / r * math.sin(alpha - y[0])]

    def lands(t: float, y: Any) -> float:
        return float(y[0])

    lands.terminal = True  # type: ignore[attr-defined]
    exact = solve_ivp(rate, (0.0, 9.0), [tilt, 0.0], events=lands, rtol=1e-9).t[-1]
    for method, scheme in variants(IMPLICIT):
        mesh = ct.mesh.move(ct.mesh.rectangle(wide, high, 4, 12), angle=math.degrees(-tilt))
        # Turned clockwise about its right corner, which is then at the origin of the floor.
        corner = mesh.points[np.argmin(mesh.points[:, 1])]
        mesh.points -= corner
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3, rho=1.0))
        floor = ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0))
        model.contact("bottom", floor, friction=1.0, method=method, name="floor")
        model.gravity(y=-g)
        results = ct.solve(model, ct.Dynamic(period=1.3 * exact, **SCHEMES[scheme]))
        foot = wide * np.array([math.cos(tilt), -math.sin(tilt)])
        left = int(np.argmin(np.hypot(*(mesh.points + foot).T)))
        height = mesh.points[left, 1] + results.history("U2", at=[left])
        time = results.times
        k = int(np.argmax(height < 1e-4))
        yield f"{method} {scheme}", float(time[k]), exact, 0.04


@check(friction=True)
def bead_slides_in_a_rough_bowl() -> Iterator[Row]:
    """A point mass in a round bowl with friction: its first turn and the way back by an ODE."""
    R, g, mu, start = 1.0, 5.0, 0.15, math.radians(70.0)

    def rate(t: float, y: Any) -> Any:
        normal = g * math.cos(y[0]) + R * y[1] ** 2
        return [y[1], -g / R * math.sin(y[0]) - mu * normal / R * np.sign(y[1])]

    def stops(t: float, y: Any) -> float:
        return float(y[1])

    stops.terminal, stops.direction = True, 1.0  # type: ignore[attr-defined]
    path = solve_ivp(rate, (0.0, 9.0), [start, -1e-9], events=stops, rtol=1e-9, atol=1e-12)
    turn, time = float(path.y[0][-1]), float(path.t[-1])
    for method, scheme in variants(IMPLICIT):
        place = (R * math.sin(start), -R * math.cos(start))
        mesh = ct.mesh.line([place, (place[0], place[1] + 1.0)], n=1)
        bead = int(mesh.node_sets["start"][0])
        model = ct.Model(mesh)
        model.spring("all", 1e-9, "x")
        model.fix("end")
        model.point_mass([bead], 1.0)
        bowl = ct.RigidCurve.circle((0.0, 0.0), R, inside=True)
        model.contact([bead], bowl, friction=mu, method=method, name="bowl")
        model.gravity(y=-g)
        results = ct.solve(model, ct.Dynamic(period=time, increments=200, **SCHEMES[scheme]))
        U = results.frames[-1].U[bead]
        angle = math.atan2(place[0] + U[0], -(place[1] + U[1]))
        yield f"{method} {scheme}", angle, turn, 0.02


@check(friction=True)
def stack_on_an_accelerated_table() -> Iterator[Row]:
    """Each block follows with the least of the accelerations that the joints below allow."""
    g, a, time = 10.0, 6.0, 0.5
    friction = (0.5, 0.2, 0.3)
    # Masses 1, 1, 1: the second joint slides at .2 g; the third holds; the first: f = .2 * 2 g + a1
    # <= .5 * 3 g, so the lowest block goes with the table if a + .4 g <= 1.5 g.
    exact = (a, 2.0, 2.0)
    for method, scheme in variants(IMPLICIT):
        bodies = {name: box("Q4I", 2.0, 0.1, 16, 2, (0.0, 0.1 * k)) for k, name in enumerate("abc")}
        bodies["table"] = box("Q4I", 6.0, 0.3, 18, 2, (-2.0, -0.3))
        model = ct.Model(ct.mesh.assembly(**bodies))
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
        for k, (upper, lower) in enumerate((("a", "table"), ("b", "a"), ("c", "b"))):
            pair = f"{upper}.bottom", f"{lower}.top"
            model.contact(*pair, friction=friction[k], method=method, name=upper)
        times = np.linspace(0.0, time, 101)
        model.amplitudes["way"] = ct.Amplitude(times, 0.5 * a * times**2)
        model.gravity(y=-g)
        rest, move = ct.Static(), ct.Dynamic(period=time, **SCHEMES[scheme])
        rest.fix("table.bottom")
        move.fix("table.bottom", x=1.0, y=0.0, amplitude="way")
        results = ct.solve(model, [rest, move])
        for name, value in zip("abc", exact, strict=True):
            way = last(results, "U1", f"{name}.right")
            yield f"{method} {scheme} {name}", way, 0.5 * value * time**2, 0.03


@check(friction=True)
def two_weights_over_a_heavy_pulley() -> Iterator[Row]:
    """Atwood: (m1 - m2) g / (m1 + m2 + J / R^2), the rope turns the pulley by friction alone."""
    g, light, heavy, J, time = 5.0, 1.0, 1.4, 0.8, 0.6
    exact = 0.5 * (heavy - light) * g / (heavy + light + J) * time**2
    for method, scheme in variants(IMPLICIT):
        angles = np.radians(np.linspace(180.0, 0.0, 25))
        arc = list(np.column_stack((np.cos(angles), np.sin(angles))))
        mesh = ct.mesh.line([(-1.0, -1.0), *arc, (1.0, -1.0)], n=[8, *[1] * 24, 8])
        ct.mesh.add_node(mesh, 0.0, 0.0, "axle")
        model = ct.Model(mesh)
        model.beam("all", material=ct.Elastic(E=1e6, rho=1e-3), area=1e-3, inertia=1e-10)
        pulley = ct.RigidCurve.circle((0.0, 0.0), 1.0, reference="axle")
        model.contact("all", pulley, friction=0.4, method=method, name="pulley")
        model.fix("axle")
        model.point_mass("axle", 1.0, inertia=J)
        model.point_mass("start", light)
        model.point_mass("end", heavy)
        model.fix("start", x=0.0, y=None)
        model.fix("end", x=0.0, y=None)
        rest, fall = ct.Static(), ct.Dynamic(period=time, **SCHEMES[scheme])
        # At rest both ends carry the light weight.
        rest.force("start", y=-light * g)
        rest.force("end", y=-light * g)
        fall.force("start", y=-light * g)
        fall.force("end", y=-heavy * g)
        results = ct.solve(model, [rest, fall])
        start = last(results, "U2", "end", 1)
        yield f"{method} {scheme}", start - last(results, "U2", "end"), exact, 0.03


@check(friction=False)
def pendulum_meets_a_soft_stop() -> Iterator[Row]:
    """A block on two links swings against a layer: its path by an ODE."""
    length, g, k, start = 2.0, 5.0, 200.0, 0.6
    mass = 0.16

    def rate(t: float, y: Any) -> Any:
        deep = max(-length * math.sin(y[0]), 0.0)
        push = k * 0.4 * deep
        return [y[1], -g / length * math.sin(y[0]) + push * math.cos(y[0]) / (mass * length)]

    time = 2.2
    path = solve_ivp(rate, (0.0, time), [start, 0.0], rtol=1e-9, max_step=1e-3)
    for method, scheme in variants(IMPLICIT):
        # Two parallel links keep the block upright.
        x, y = length * math.sin(start), -length * math.cos(start)
        bob = ct.mesh.rectangle(0.4, 0.4, 2, 2, origin=(x, y))
        links = [
            ct.mesh.line([(0.4 * s, h), (x + 0.4 * s, y + h)], 1, f"link{s}")
            for s, h in ((0, 0.4), (1, 0.4))
        ]
        mesh = ct.mesh.merge(bob, *links)
        mesh.cell_sets["bob"] = np.arange(4)
        model = ct.Model(mesh)
        model.section("bob", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3, rho=1.0))
        for s in (0, 1):
            model.truss(f"link{s}", material=ct.Elastic(E=1e6, rho=1e-6), area=0.1)
            model.fix(f"link{s}.start")
        model.gravity(y=-g, cells="bob")
        wall = ct.RigidCurve.line((0.0, 5.0), (0.0, -9.0))
        layer = ct.PressureLaw("linear", [k])
        model.contact("left", wall, law=layer, method=method, name="stop")
        results = ct.solve(model, ct.Dynamic(period=time, increments=440, **SCHEMES[scheme]))
        moved = x + last(results, "U1", "link0.end")
        yield f"{method} {scheme}", moved, length * math.sin(path.y[0][-1]), 0.05


@check(friction=False)
def block_caught_by_a_cantilever() -> Iterator[Row]:
    """A light cantilever stops a block on its tip after v sqrt(m / k), k = 3 EI / L^3."""
    length, v, EI = 10.0, 1.0, 1e4 / 12.0
    k, mass = 3.0 * EI / length**3, 1.0
    exact = v * math.sqrt(mass / k)
    for method, scheme in variants(IMPLICIT):
        beam = ct.mesh.line([(0.0, -0.5), (length, -0.5)], n=20, name="beam")
        drop = ct.mesh.rectangle(1.0, 1.0, 4, 4, origin=(length - 0.5, 0.02))
        model = ct.Model(ct.mesh.assembly(arm=beam, drop=drop))
        model.section("drop", element="Q4I", material=ct.Elastic(E=1e5, rho=1.0))
        model.beam("arm", material=ct.Elastic(E=1e4, rho=1e-6), area=1.0, inertia=1.0 / 12.0)
        model.fix("arm.beam.start", rotation=True)
        round_tip = model.mesh.node_sets["arm.beam.end"]
        model.contact(round_tip, "drop.bottom", method=method, clearance=0.02, name="tip")
        model.fix("drop.left", x=0.0, y=None)
        model.fix("drop.right", x=0.0, y=None)
        model.velocity("drop", y=-v)
        period = 0.02 / v + 0.5 * math.pi * math.sqrt(mass / k)
        results = ct.solve(model, ct.Dynamic(period=1.3 * period, **SCHEMES[scheme]))
        tip = results.history("U2", at=round_tip)
        yield f"{method} {scheme}", -float(tip.min()), exact, 0.03


@check(friction=False)
def rod_slides_down_a_wall_and_leaves_it() -> Iterator[Row]:
    """It leaves the smooth wall where its head is at two thirds of its first height."""
    length, g, start = 2.0, 5.0, math.radians(65.0)
    for method, scheme in variants(IMPLICIT):
        foot, head = (length * math.cos(start), 0.0), (0.0, length * math.sin(start))
        model = ct.Model(ct.mesh.line([foot, head], n=8))
        model.beam("all", material=ct.Elastic(E=1e6, rho=1.0), area=0.1, inertia=1e-4)
        floor = ct.RigidCurve.line((-1.0, 0.0), (9.0, 0.0))
        wall = ct.RigidCurve.line((0.0, 9.0), (0.0, -1.0))
        ends = model.mesh.node_sets
        model.contact(ends["start"], floor, method=method, name="floor")
        model.contact(ends["end"], wall, method=method, name="wall")
        model.gravity(y=-g)
        step = ct.Dynamic(period=1.6, increments=320, **SCHEMES[scheme])
        results = ct.solve(model, step)
        force = results.history("wall: force x")
        height = head[1] + results.history("U2", at="end")
        free = np.flatnonzero(np.convolve(force <= 1e-6, np.ones(20), "valid") == 20)
        found = float(height[free[free > 5][0]]) if len(free[free > 5]) else 0.0
        yield f"{method} {scheme}", found / head[1], 2.0 / 3.0, 0.03


@check(friction=False)
def block_slides_down_a_dome_and_leaves_it() -> Iterator[Row]:
    """A small block leaves a smooth dome at cos t = 2 / 3 (from rest at the top), nearly."""
    R, g, size, start = 10.0, 5.0, 0.3, 0.2
    exact = math.degrees(math.acos(2.0 / 3.0 * math.cos(start)))
    for method, scheme in variants(IMPLICIT):
        mesh = ct.mesh.rectangle(size, 0.1, 3, 2, origin=(-size / 2.0, R + size**2 / 8 / R))
        mesh = ct.mesh.move(mesh, angle=-math.degrees(start))
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
        dome = ct.RigidCurve.circle((0.0, 0.0), R)
        model.contact("bottom", dome, method=method, name="dome")
        model.gravity(y=-g)
        results = ct.solve(model, ct.Dynamic(period=5.0, increments=1000, **SCHEMES[scheme]))
        force = np.hypot(results.history("dome: force x"), results.history("dome: force y"))
        middle = mesh.points.mean(axis=0)
        x = middle[0] + results.history("U1", at="all", combine="mean")
        y = middle[1] + results.history("U2", at="all", combine="mean")
        angle = np.degrees(np.arctan2(x, y))
        k = int(np.flatnonzero(force > 1e-6)[-1])
        yield f"{method} {scheme}", float(angle[k]), exact, 0.02
