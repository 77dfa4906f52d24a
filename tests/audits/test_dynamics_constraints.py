"""Loads that follow, couplings and reactions in motion, against closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import corota as ct
from corota.model.loads import Fixed
from support.pairs import quickly
from support.particles import (
    IMPLICIT,
    LIGHT,
    bars,
    column,
    extrapolated,
    integrate,
    lagrange,
    network,
    table,
    wheel,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "hht", "energy_momentum"))
def test_thrust_that_turns_with_a_spinning_plate(scheme):
    # Pressure on one side of a stiff free plate that spins at W: M x'' = F (cos Wt, sin Wt).
    mesh = ct.mesh.rectangle(1.0, 0.4, nx=2, ny=2)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.3, rho=5.0), thickness=0.5)
    model.pressure("left", 10.0)
    model.velocity(spin=2.0, about=(0.5, 0.2))
    thrust, mass, spin, end = 10.0 * 0.4 * 0.5, 5.0 * 0.4 * 0.5, 2.0, 1.5
    middle = int(np.argmin(np.hypot(*(mesh.points - [0.5, 0.2]).T)))
    step = ct.Dynamic(period=end, increments=150, scheme=scheme)
    frame = ct.solve(model, step, fields=False).frames[-1]
    size, angle = thrust / mass / spin**2, spin * end
    exact = [size * (1 - math.cos(angle)), size * (angle - math.sin(angle))]
    np.testing.assert_allclose(frame.U[middle], exact, rtol=2e-3)


@pytest.mark.parametrize("scheme", [*IMPLICIT, "central_difference"])
def test_particle_on_a_spring_with_a_gap(scheme):
    # k = 100 in compression, nothing up to 0.5, then 400: SciPy; the account closes.
    def rate(_, z):
        force = 400.0 * (z[0] - 0.5) if z[0] > 0.5 else min(100.0 * z[0], 0.0)
        return [z[1], -force]

    exact = solve_ivp(rate, (0, 0.6), [0, 3.0], rtol=1e-10, atol=1e-11, max_step=2e-3).y[:, -1]
    model = network([[0, 0], [1, 0]], [[0, 1]])
    model.spring([0], [[-1.0, -100.0], [0.0, 0.0], [0.5, 0.0], [1.0, 200.0]])
    model.point_mass([1], 1.0)
    model.fix([0])
    model.fix([1], x=None)
    model.velocity([1], x=3.0)
    step = ct.Dynamic(period=0.6, increments=300, scheme=scheme)
    frame = ct.solve(model, step).frames[-1]
    np.testing.assert_allclose([frame.U[1, 0], frame.V[1, 0]], exact, rtol=1e-3)
    assert abs(frame.scalars["energy balance error"]) < 5e-4


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "newmark", "energy_momentum"))
def test_pendulum_of_beams(scheme):
    # A stiff rod on a hinge, J = rho A L^3/3 + rho I L with the inertia of its cross-section.
    n, end = 4, 1.2
    model = column(n, 1.0, 1e6, 1e-2, area=0.5, rho=2.0)
    model.fix([0])
    model.gravity(y=-9.81)
    inertia = 2.0 * 0.5 / 3 + 2.0 * 1e-2
    exact = integrate(lambda _, z: [z[1], -9.81 * 0.5 * math.cos(z[0]) / inertia], [0, 0], end)

    def run(count):
        step = ct.Dynamic(period=end, increments=count, scheme=scheme)
        return ct.solve(model, step, fields=False).frames[-1].UR[n]

    np.testing.assert_allclose(extrapolated(run, 60), exact[0], rtol=5e-4)


def test_spinning_bar_on_a_path():
    # Half of a bar's radius grows as k (r - L) = f m r, m = rho A L/3 of the consistent mass; the
    # load factor multiplies W^2. Linear buckling: f m = k.
    model = network([[0, 0], [1, 0]], [[0, 1]])
    model.truss([0], material=ct.Elastic(E=100.0, rho=4.0), area=1.0)
    model.fix([0])
    model.fix([1], x=None)
    model.centrifugal(1.0)
    results = ct.solve(model, ct.Static(path=ct.ArcLength(factor=10.0)))
    exact = 1 / (1 - 10.0 * 4.0 / 3 / 100.0) - 1
    np.testing.assert_allclose(results.frames[-1].U[1, 0], exact, rtol=1e-7)
    found = ct.solve(model, ct.Buckle(modes=1)).modes[-1]
    np.testing.assert_allclose(found.factors, [75.0], rtol=1e-7)


def test_tension_has_no_buckling_factor():
    # Said in one message, not answered by a number.
    model = column(10, 2.0, 2e5, 1e-6)
    model.fix([0])
    model.fix([10], x=None)
    model.force([10], x=1.0)
    with pytest.raises(ct.ModelError, match="no positive factor"):
        ct.solve(model, ct.Buckle(modes=1))


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "energy_momentum"))
def test_force_and_moment_on_a_distributing_coupling(scheme):
    # A stiff dumbbell takes a dead force at the reference node off its line and a moment there:
    # I phi'' = M - F b sin phi.
    moment, force, b, end = 0.5, 1.0, 0.3, 2.0
    model = network([[0, 0], [1, 0], [0.5, b]], [[0, 1]])
    bars(model, [0], 1e4, 1.0)
    model.point_mass([0, 1], 1.0)
    model.couple([0, 1], 2, kind="distributing")
    model.force([2], y=force, moment=moment)
    exact = integrate(lambda _, z: [z[1], (moment - force * b * math.sin(z[0])) / 0.5], [0, 0], end)
    step = ct.Dynamic(period=end, increments=150, scheme=scheme)
    frame = ct.solve(model, step, fields=False).frames[-1]
    np.testing.assert_allclose(frame.UR[2], exact[0], rtol=1e-3)
    middle = frame.U[:2].mean(axis=0)
    np.testing.assert_allclose(middle, [0.0, 0.5 * force / 2 * end**2], atol=2e-3)


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "hht", "energy_momentum"))
def test_kinematic_coupling_of_one_direction(scheme):
    # Only x follows the reference node: u_x = x -+ sin(phi)/2. Lagrange's equations of x and phi
    # with two particles, the reference node's mass 0.5 and inertia 0.1.
    model = network([[0, 0], [0, 1], [1, 0], [1, 1], [0, 0.5]], [[0, 2], [1, 3]])
    bars(model, [0], 30.0, 1.0)
    bars(model, [1], 70.0, 1.0)
    model.point_mass([0], 1.0)
    model.point_mass([1], 2.0)
    model.point_mass([4], 0.5, inertia=0.1)
    model.couple([0, 1], 4, kind="kinematic", dofs="x")
    model.fix([2, 3])
    model.fix([0, 1, 4], x=None)
    model.force([4], x=5.0)

    def positions(q):
        half = 0.5 * np.sin(q[1])
        along = np.array([q[0] + half, q[0] - half, q[0], math.sqrt(0.1) * q[1]])
        return np.stack([along, 0.0 * along], axis=1)

    def potential(q):
        x = positions(q)[:, 0]
        return 15.0 * x[0] ** 2 + 35.0 * x[1] ** 2 - 5.0 * q[0]

    exact = lagrange(positions, np.array([1.0, 2.0, 0.5, 1.0]), potential, [0, 0], [0, 0], 1.0)
    step = ct.Dynamic(period=1.0, increments=150, scheme=scheme)
    frame = ct.solve(model, step, fields=False).frames[-1]
    np.testing.assert_allclose(frame.U[[0, 1, 4], 0], positions(exact[:2])[:3, 0], rtol=3e-3)
    np.testing.assert_allclose(frame.UR[4], exact[1], rtol=3e-3)


def test_modal_dynamics_of_a_rigid_arm_turned_by_a_table():
    # m x'' = k (-a phi(t) - x) with phi in straight pieces, and the reactions on the pivot.
    a, k, m = 0.8, 40.0, 1.5
    t, phi = [0.0, 0.3, 0.6, 1.0], [0.0, 0.01, 0.01, -0.02]
    model = network([[0, 0], [0, a], [1, a], [0, 0.5 * a]], [[1, 2], [1, 3]])
    bars(model, [0], k, 1.0)
    bars(model, [1], 1.0, 1.0)
    model.rigid([1, 3], 0)
    model.point_mass([2], m)
    model.fix([2], x=None)
    table(model, "turn", t, phi)
    hold = [Fixed([0], 0), Fixed([0], 1)]
    steps = [
        ct.Frequency(modes=1, supports=[*hold, Fixed([0], 2)]),
        ct.ModalDynamic(
            period=1.0, increments=20, supports=[*hold, Fixed([0], 2, 1.0, amplitude="turn")]
        ),
    ]
    frame = ct.solve(model, steps).frames[-1]
    exact = integrate(
        lambda now, z: [z[1], k * (-a * np.interp(now, t, phi) - z[0]) / m], [0, 0], 1.0, t
    )
    np.testing.assert_allclose([frame.U[2, 0], frame.V[2, 0]], exact, rtol=1e-6)
    pull = k * (-a * phi[-1] - exact[0])
    np.testing.assert_allclose(frame.RF[0], [pull, 0.0, -a * pull], rtol=1e-6, atol=1e-9)


def test_modal_dynamics_of_a_support_moved_in_local_axes():
    # A support moves along axes turned by 0.6 rad: the particle follows its x component only.
    k, m, turn, speed = 100.0, 2.0, 0.6, 0.01
    model = network([[0, 0], [1, 0], [0, 1]], [[0, 1], [0, 2]])
    bars(model, [0], k, 1.0)
    bars(model, [1], 60.0, 1.0)
    model.point_mass([0], m)
    model.fix([2])
    model.local_axes([1], angle=turn)
    table(model, "move", [0.0, 1.0], [0.0, speed])
    model.fix([1], x=1.0, y=0.0, amplitude="move")
    hold = [Fixed([1], 0), Fixed([1], 1)]
    steps = [ct.Frequency(modes=2, supports=hold), ct.ModalDynamic(period=1.0, increments=20)]
    frame = ct.solve(model, steps).frames[-1]
    w, v = math.sqrt(k / m), speed * math.cos(turn)
    x = v - v / w * math.sin(w)
    np.testing.assert_allclose(frame.U[0], [x, 0.0], rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(frame.U[1], [v, speed * math.sin(turn)], rtol=1e-9)
    np.testing.assert_allclose(frame.RF[1], [k * (v - x), 0.0, 0.0], rtol=1e-6, atol=1e-9)


def test_frequency_of_a_bead_on_a_lever():
    # A bead held along a line that turns about its first point: the far end of mass m1 and spring
    # 0, the bead at the share s with mass m2 and spring k: w^2 = k s^2/(m1 + m2 s^2).
    s, k, m1, m2 = 0.4, 30.0, 1.0, 2.0
    model = network([[0, 0], [1, 0], [s, 0], [s, 1.0]], [[0, 1], [2, 3]])
    bars(model, [0], 100.0, 1.0)
    bars(model, [1], k, 1.0)
    model.point_mass([1], m1)
    model.point_mass([2], m2)
    model.straight([2], 0, 1)
    model.fix([0, 3])
    model.fix([1, 2], y=None)
    found = ct.solve(model, ct.Frequency(modes=1)).modes[-1]
    exact = math.sqrt(k * s**2 / (m1 + m2 * s**2))
    np.testing.assert_allclose(2 * np.pi * found.factors, [exact], rtol=1e-8)


def test_momenta_of_an_unbalanced_body_with_inertia():
    # Linear momentum and angular momentum about the origin, I W and the body's flight.
    model, x, m = wheel(inertia=0.3)
    model.velocity(x=1.0, y=2.0, spin=3.0)
    step = ct.Dynamic(period=0.5, increments=40, scheme="energy_momentum")
    scalars = ct.solve(model, step, fields=False).frames[-1].scalars
    first = m @ x
    inertia = m @ (x**2).sum(axis=1) + 0.3
    np.testing.assert_allclose(scalars["momentum x"], m.sum() - 3.0 * first[1], rtol=1e-8)
    np.testing.assert_allclose(scalars["momentum y"], 2.0 * m.sum() + 3.0 * first[0], rtol=1e-8)
    angular = 3.0 * inertia + 2.0 * first[0] - first[1]
    np.testing.assert_allclose(scalars["angular momentum"], angular, rtol=1e-8)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_reaction_of_a_support_moved_by_a_smooth_table(scheme):
    # A particle moved by 0.1 sin 3t needs -0.9 m sin 3t, in every frame up to the last of the step.
    n = 100
    model = network([[0, 0], [1, 0]], [[0, 1]])
    bars(model, [0], LIGHT, 1.0)
    model.point_mass([0], 2.0)
    t = np.linspace(0.0, 1.0, n + 1)
    table(model, "wave", t, 0.1 * np.sin(3.0 * t))
    model.fix([0], x=1.0, y=0.0, amplitude="wave")
    model.fix([1])
    frames = ct.solve(model, ct.Dynamic(period=1.0, increments=n, scheme=scheme)).frames
    found = [f.RF[0, 0] for f in frames[1:]]
    exact = [-1.8 * math.sin(3.0 * f.time) for f in frames[1:]]
    np.testing.assert_allclose(found, exact, atol=2e-3)
