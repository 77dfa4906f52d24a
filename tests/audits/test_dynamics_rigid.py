"""Rigid bodies, couplings and equations in motion, against closed forms and integrations."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest

import corota as ct
from corota.model.loads import Fixed, NodalForce
from support.pairs import quickly
from support.particles import (
    IMPLICIT,
    LIGHT,
    bars,
    extrapolated,
    integrate,
    lagrange,
    network,
    table,
    wheel,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "energy_momentum"))
def test_free_rigid_body_of_particles_over_three_turns(scheme):
    # The center of mass flies straight on, the body turns steadily about it; the reference node
    # lies off the center and moves along a trochoid.
    model, x, m = wheel()
    center = m @ x / m.sum()
    spin, end = 6.0, 3.2
    model.velocity(x=1.0, y=0.3, spin=spin, about=tuple(center))
    angle = spin * end
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    exact = np.add(center, [end, 0.3 * end]) - turn @ center

    def run(n):
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        return np.r_[frame.U[0], frame.UR[0]]

    found = extrapolated(run, 50)
    np.testing.assert_allclose(found, [*exact, angle], rtol=0, atol=2e-3)


@pytest.mark.parametrize("scheme", quickly(["newmark", "generalized_alpha"], "generalized_alpha"))
def test_driven_unbalanced_rotor_over_three_turns(scheme):
    # A rotor turned at constant rate by its reference node: the bearing force is minus the
    # centripetal force of the unbalance, the driving moment vanishes.
    model, x, m = wheel()
    spin, end = 5.0, 4.0
    table(model, "turn", [0.0, 10.0], [0.0, 10.0])
    model.fix([0], rotation=spin, amplitude="turn")
    model.velocity(spin=spin)
    results = ct.solve(model, ct.Dynamic(period=end, increments=320, scheme=scheme), fields=False)
    angle = spin * results.frames[-1].time
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    force = -(spin**2) * turn @ (m @ x)
    np.testing.assert_allclose(results.frames[-1].RF[0], [*force, 0.0], rtol=0, atol=2e-2)
    np.testing.assert_allclose(results.frames[-1].UR[0], angle, rtol=1e-12)


@pytest.mark.parametrize("scheme", quickly(IMPLICIT[:-1], "hht"))
def test_rotor_run_up_by_a_parabolic_table(scheme):
    # Angle a t^2/2 given by 201 points: the driving moment is I a and its work the kinetic energy.
    model, x, m = wheel(inertia=0.3)
    a, end = 7.0, 2.0
    t = np.linspace(0.0, end, 201)
    table(model, "up", t, 0.5 * a * t**2)
    model.fix([0], rotation=1.0, amplitude="up")
    inertia = 0.3 + m @ (x**2).sum(axis=1)
    step = ct.Dynamic(period=end, increments=200, scheme=scheme)
    frames = ct.solve(model, step).frames
    np.testing.assert_allclose(frames[-1].RF[0, 2], inertia * a, rtol=2e-3)
    np.testing.assert_allclose(frames[100].RF[0, 2], inertia * a, rtol=2e-3)
    np.testing.assert_allclose(
        frames[-1].scalars["ALLKE"], 0.5 * inertia * (a * end) ** 2, rtol=5e-3
    )
    np.testing.assert_allclose(frames[-1].scalars["ALLWK"], frames[-1].scalars["ALLKE"], rtol=5e-3)


def test_moment_on_a_driven_rotor_by_energy_momentum():
    # The same moment I a, at four increments a radian in the end: its error is of second order.
    a, end = 7.0, 2.0
    error = []
    for n in (100, 200):
        model, _, _ = wheel(inertia=0.3)
        t = np.linspace(0.0, end, n + 1)
        table(model, "up", t, 0.5 * a * t**2)
        model.fix([0], rotation=1.0, amplitude="up")
        step = ct.Dynamic(period=end, increments=n, scheme="energy_momentum")
        frames = ct.solve(model, step, fields=False).frames
        error.append([f.RF[0, 2] - a for f in (frames[n // 2], frames[n])])
    assert np.all(np.abs(error[0]) > 3.5 * np.abs(error[1]))
    assert np.abs(error[1]).max() < 0.05 * a


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "newmark", "energy_momentum"))
def test_rigid_pendulum_released_from_a_turned_position(scheme):
    # A static step turns the body by 2.5 rad, the motion starts there: I phi'' = moment of the
    # weights.
    model, x, m = wheel()
    g, angle0, end = 9.81, 2.5, 1.5
    first = ct.Static(supports=[Fixed([0], 0), Fixed([0], 1), Fixed([0], 2, angle0)], increments=5)

    def moment(phi):
        turned = x @ np.array([[math.cos(phi), math.sin(phi)], [-math.sin(phi), math.cos(phi)]])
        return -g * m @ turned[:, 0]

    inertia = m @ (x**2).sum(axis=1)
    exact = integrate(lambda _, z: [z[1], moment(z[0]) / inertia], [angle0, 0.0], end)

    def run(n):
        second = ct.Dynamic(
            period=end,
            increments=n,
            scheme=scheme,
            new_supports=True,
            supports=[Fixed([0], 0), Fixed([0], 1)],
            loads=[NodalForce([i + 1], 1, -m[i] * g) for i in range(3)],
        )
        frame = ct.solve(model, [first, second], fields=False).frames[-1]
        return np.r_[frame.UR[0], frame.V[0, 2]]

    np.testing.assert_allclose(extrapolated(run, 30), exact, rtol=0, atol=1e-3)


def test_spin_of_a_body_that_a_static_step_has_turned():
    # Initial velocities mean the body as it lies: after a quarter turn about the origin and a
    # spin of 2 about it, particle i moves with 2 S R x.
    model, x, _ = wheel()
    model.velocity(spin=2.0)
    first = ct.Static(supports=[Fixed([0], 0), Fixed([0], 1), Fixed([0], 2, math.pi / 2)])
    second = ct.Dynamic(
        period=1e-3,
        increments=1,
        scheme="newmark",
        new_supports=True,
        supports=[Fixed([0], 0), Fixed([0], 1)],
    )
    frame = ct.solve(model, [first, second], fields=False).frames[-1]
    angle = math.pi / 2 + 2e-3
    turned = x @ [[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]]
    np.testing.assert_allclose(frame.V[1:, :2], 2.0 * np.c_[-turned[:, 1], turned[:, 0]], atol=1e-5)


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "hht"))
def test_rack_and_pinion(scheme):
    # x = -r phi by an equation: a constant moment gives phi'' = M / (I + m r^2), which Newmark's
    # relations integrate exactly over several turns; the guide force of the rack is zero.
    m, inertia, r, moment, end = 2.0, 0.5, 0.4, 3.0, 5.0
    model = network([[0.0, 0.0], [0.0, -1.0], [1.0, -1.0]], [[0, 1], [1, 2]])
    model.beam([0], material=ct.Elastic(E=LIGHT, rho=LIGHT), area=LIGHT, inertia=LIGHT)
    model.beam([1], material=ct.Elastic(E=LIGHT, rho=LIGHT), area=LIGHT, inertia=LIGHT)
    model.point_mass([0], m, inertia=inertia)
    model.point_mass([1], m)
    model.equation((1, "x", 1.0), (0, "rotation", r))
    model.fix([0])
    model.fix([1], x=None, rotation=True)
    model.fix([2], rotation=True)
    model.force([0], moment=moment)
    step = ct.Dynamic(period=end, increments=200, scheme=scheme)
    frame = ct.solve(model, step, fields=False).frames[-1]
    rate = moment / (inertia + m * r**2)
    # Energy-momentum works on 2 tan(dphi/2) for dphi: second order.
    close = {"rtol": 2e-2 if scheme == "energy_momentum" else 1e-6}
    np.testing.assert_allclose(frame.UR[0], 0.5 * rate * end**2, **close)
    np.testing.assert_allclose(frame.U[1, 0], -r * 0.5 * rate * end**2, **close)
    np.testing.assert_allclose(frame.V[0, 2], rate * end, **close)
    np.testing.assert_allclose(frame.V[1, 0], -r * rate * end, **close)


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "energy_momentum"))
def test_mass_on_the_arm_of_a_distributing_coupling(scheme):
    # The reference node rides on the line of two particles: x = mean + (a e + b e_perp). Lagrange's
    # equations of the three particles in the four coordinates of the two.
    k, a, b = 60.0, 0.3, 0.5
    masses = np.array([1.0, 2.0, 0.7])
    place = np.array([[0.0, 0.0], [1.0, 0.0], [0.5 + a, b]])

    def positions(q):
        d = q[2:] - q[:2]
        e = d / np.sqrt(d @ d)
        return np.array([q[:2], q[2:], 0.5 * (q[:2] + q[2:]) + a * e + b * np.array([-e[1], e[0]])])

    def potential(q):
        d = q[2:] - q[:2]
        return 0.5 * k * (np.sqrt(d @ d) - 1.0) ** 2

    start_rate = np.array([0.0, 1.0, 0.5, 6.0])
    end = 1.5
    exact = lagrange(positions, masses, potential, place[:2].ravel(), start_rate, end)

    def run(n):
        model = network(place, [[0, 1]])
        bars(model, [0], k, 1.0)
        for i in range(3):
            model.point_mass([i], masses[i])
        model.couple([0, 1], 2, kind="distributing")
        model.velocity([0], x=0.0, y=1.0)
        model.velocity([1], x=0.5, y=6.0)
        spin = 5.0
        mean = 0.5 * (start_rate[:2] + start_rate[2:])
        model.velocity([2], x=mean[0] - spin * b, y=mean[1] + spin * a)
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        return (ct.solve(model, step, fields=False).frames[-1].U + place)[:2].ravel()

    np.testing.assert_allclose(extrapolated(run, 40), exact[:4], rtol=0, atol=2e-3)


def test_bead_on_a_line_between_two_particles():
    # A bead slides without friction on the straight line through two particles that a spring
    # joins: coordinates of the two and the bead's share s of the line.
    k = 80.0
    masses = np.array([1.0, 1.5, 0.6])
    place = np.array([[0.0, 0.0], [1.0, 0.0], [0.6, 0.0]])

    def positions(q):
        return np.array([q[:2], q[2:4], q[:2] + q[4] * (q[2:4] - q[:2])])

    def potential(q):
        d = q[2:4] - q[:2]
        return 0.5 * k * (np.sqrt(d @ d) - 1.0) ** 2

    end = 0.35
    exact = lagrange(
        positions, masses, potential, [0.0, 0.0, 1.0, 0.0, 0.6], [0.0, -1.0, 0.0, 1.0, 0.3], end
    )
    final = positions(exact[:5])

    def run(n, scheme):
        model = network(place, [[0, 1]])
        bars(model, [0], k, 1.0)
        for i in range(3):
            model.point_mass([i], masses[i])
        model.straight([2], 0, 1)
        model.velocity([0], y=-1.0)
        model.velocity([1], y=1.0)
        model.velocity([2], x=0.3, y=0.2)
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        return ct.solve(model, step, fields=False).frames[-1].U + place

    for scheme in ("newmark", "hht", "energy_momentum"):
        found = extrapolated(lambda n, s=scheme: run(n, s), 20)
        np.testing.assert_allclose(found, final, rtol=0, atol=1e-4)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_mass_on_an_inclined_guide(scheme):
    # Local axes turned by 0.5 rad with the second direction held: u = 1/2 g sin(0.5) t^2 down
    # the guide, the reaction is m g cos(0.5) normal to it, and does no work.
    angle, m, g, end = 0.5, 3.0, 9.81, 1.2
    model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
    bars(model, [0], LIGHT, 1.0)
    model.point_mass([0], m)
    model.local_axes([0], angle=-angle)
    model.fix([0], x=None)
    model.fix([1])
    # Forces are meant in the local axes, too.
    model.force([0], x=m * g * math.sin(angle), y=-m * g * math.cos(angle))
    step = ct.Dynamic(period=end, increments=12, scheme=scheme)
    frame = ct.solve(model, step).frames[-1]
    s = 0.5 * g * math.sin(angle) * end**2
    np.testing.assert_allclose(frame.U[0], [s * math.cos(angle), -s * math.sin(angle)], rtol=1e-8)
    push = m * g * math.cos(angle)
    np.testing.assert_allclose(
        frame.RF[0, :2], [push * math.sin(angle), push * math.cos(angle)], rtol=1e-8
    )
    np.testing.assert_allclose(frame.scalars["ALLWK"], m * g * math.sin(angle) * s, rtol=1e-8)
