# SPDX-License-Identifier: BSD-3-Clause
"""Checks of motion, modes, buckling and paths against answers derived outside the program.

Reference values are closed forms, integrations by SciPy, small programs written here, or numbers
of other programs, which are stored here with their source.
"""

import math

import numpy as np
import pytest
from scipy import linalg
from scipy.integrate import solve_ivp

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from corota.model.loads import BodyForce, Fixed, NodalForce
from support.particles import (
    LIGHT,
    bars,
    chain,
    chain_matrices,
    extrapolated,
    integrate,
    lagrange,
    linear_motion,
    modal_damping,
    network,
    table,
    without_first_support,
)

IMPLICIT = ["newmark", "hht", "generalized_alpha", "energy_momentum"]
pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


# --- particles and springs in large motion ------------------------------------------------------


@pytest.mark.parametrize("scheme", [*IMPLICIT, "central_difference"])
def test_spring_pendulum_that_loops(scheme):
    # Newton's law of a particle on a linear spring, EA/L = 50, that goes round with a slack
    # spring in between; SciPy DOP853.
    k, length, m, g = 50.0, 1.0, 2.0, 9.81

    def rate(_, z):
        r = np.hypot(z[0], z[1])
        return [z[2], z[3], *(-k * (r - length) * z[:2] / r / m + np.array([0.0, -g]))]

    exact = integrate(rate, [0.0, -length, 9.0, 0.0], 2.0)

    def run(n):
        model = network([[0.0, 0.0], [0.0, -length]], [[0, 1]])
        bars(model, [0], k, length)
        model.point_mass([1], m)
        model.fix([0])
        model.force([1], y=-m * g)
        model.velocity([1], x=9.0)
        step = ct.Dynamic(period=2.0, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        reaction = frame.RF[0, :2]
        return np.r_[frame.U[1] + [0.0, -length], frame.V[1, :2], reaction]

    found = extrapolated(run, 120)
    np.testing.assert_allclose(found[:4], exact, rtol=0, atol=2e-4)
    r = np.hypot(*exact[:2])
    np.testing.assert_allclose(found[4:], -k * (r - length) * exact[:2] / r, rtol=0, atol=2e-2)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_pendulum_on_a_support_moved_by_a_table_with_corners(scheme):
    # The support moves by straight pieces, the first of which starts with a jump of velocity; the
    # particle feels the spring alone, so the corners need no pulse in the reference.
    k, length, m, g = 200.0, 0.8, 1.5, 9.81
    t, x, y = [0.0, 0.3, 0.6, 1.2], [0.0, 0.15, 0.15, -0.3], [0.0, 0.0, 0.2, 0.1]

    def rate(now, z):
        d = z[:2] - [np.interp(now, t, x), np.interp(now, t, y)]
        r = np.hypot(*d)
        return [z[2], z[3], *(-k * (r - length) * d / r / m + np.array([0.0, -g]))]

    exact = integrate(rate, [0.0, -length, 0.0, 0.0], 1.2, t)

    def run(n):
        model = network([[0.0, 0.0], [0.0, -length]], [[0, 1]])
        bars(model, [0], k, length)
        model.point_mass([1], m)
        table(model, "x", t, x)
        table(model, "y", t, y)
        model.fix([0], x=1.0, y=None, amplitude="x")
        model.fix([0], x=None, y=1.0, amplitude="y")
        model.force([1], y=-m * g)
        step = ct.Dynamic(period=1.2, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        return np.r_[frame.U[1] + [0.0, -length], frame.V[1, :2]]

    np.testing.assert_allclose(extrapolated(run, 120), exact, rtol=0, atol=1e-3)


@pytest.mark.parametrize("scheme", [*IMPLICIT, "central_difference"])
def test_support_that_starts_with_a_jump_of_velocity(scheme):
    # m x'' = k (v t - x): x = v t - v/w sin wt. The force of the support is k (v t - x), without
    # mass there; its work is v times the impulse of that force, m v x'.
    k, m, v = 30.0, 2.0, 0.7
    w, end = math.sqrt(k / m), 1.7

    def run(n):
        model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
        bars(model, [0], k, 1.0)
        model.point_mass([1], m)
        table(model, "move", [0.0, 10.0], [0.0, 10.0])
        model.fix([0], x=v, y=0.0, amplitude="move")
        model.fix([1], x=None)
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step).frames[-1]
        return np.r_[frame.U[1, 0], frame.V[1, 0], frame.RF[0, 0], frame.scalars["ALLWK"]]

    rate = v - v * math.cos(w * end)
    force = k * v / w * math.sin(w * end)
    exact = [v * end - v / w * math.sin(w * end), rate, force, m * v * rate]
    np.testing.assert_allclose(extrapolated(run, 100), exact, rtol=0, atol=2e-3)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_spinning_spring_with_a_dashpot_in_line(scheme):
    # Two particles joined by a spring and a dashpot fly and spin: the dashpot acts on the rate of
    # the length alone. Its dissipation is the integral of c (dr/dt)^2.
    k, length, c, m1, m2 = 40.0, 1.0, 3.0, 1.0, 2.0

    def rate(_, z):
        d, v = z[2:4] - z[:2], z[6:8] - z[4:6]
        r = np.hypot(*d)
        e = d / r
        pull = (k * (r - length) + c * (v @ e)) * e
        return np.r_[z[4:8], pull / m1, -pull / m2, c * (v @ e) ** 2]

    spin, drift = 4.0, np.array([0.5, -1.0])
    start = [0.0, 0.0, 1.0, 0.0, *drift, drift[0], drift[1] + spin, 0.0]
    exact = integrate(rate, start, 2.5)

    def run(n):
        model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
        bars(model, [0], k, length)
        model.point_mass([0], m1)
        model.point_mass([1], m2)
        model.dashpot(0, 1, c=c)
        model.velocity(x=drift[0], y=drift[1], spin=spin)
        frame = ct.solve(model, ct.Dynamic(period=2.5, increments=n, scheme=scheme)).frames[-1]
        place = np.add(frame.U, [[0.0, 0.0], [1.0, 0.0]]).ravel()
        return np.r_[place, frame.V[:, :2].ravel(), frame.scalars["ALLVD"]]

    np.testing.assert_allclose(extrapolated(run, 80), exact, rtol=0, atol=2e-3)


@pytest.mark.parametrize("scheme", ["newmark", "energy_momentum", "central_difference"])
def test_hanging_chain_of_three_particles(scheme):
    # A chain of three springs thrown sideways; Newton's laws by SciPy.
    k, m, g = np.array([300.0, 200.0, 150.0]), np.array([1.0, 0.5, 0.8]), 9.81
    base = np.array([[0.0, 0.0], [0.6, 0.0], [1.2, 0.0], [1.8, 0.0]])

    def rate(_, z):
        x = np.vstack([[0.0, 0.0], z[:6].reshape(3, 2)])
        d = np.diff(x, axis=0)
        r = np.linalg.norm(d, axis=1)
        pull = (k * (r - 0.6) / r)[:, None] * d
        force = -pull + np.vstack([pull[1:], [[0.0, 0.0]]])
        return np.r_[z[6:], (force / m[:, None] + [0.0, -g]).ravel()]

    start = np.r_[base[1:].ravel(), np.zeros(6)]
    exact = integrate(rate, start, 0.6)[:6].reshape(3, 2)

    def run(n):
        model = network(base, [[0, 1], [1, 2], [2, 3]])
        for i in range(3):
            bars(model, [i], k[i], 0.6)
            model.point_mass([i + 1], m[i])
            model.force([i + 1], y=-m[i] * g)
        model.fix([0])
        step = ct.Dynamic(period=0.6, increments=n, scheme=scheme)
        return ct.solve(model, step, fields=False).frames[-1].U[1:] + base[1:]

    np.testing.assert_allclose(extrapolated(run, 80), exact, rtol=0, atol=2e-4)


# --- rigid bodies, couplings and equations in motion --------------------------------------------


def wheel(where=((0.5, 0.0), (-0.2, 0.4), (0.1, -0.3)), masses=(1.0, 2.0, 0.5), inertia=0.0):
    """Three particles rigidly joined to a reference node in the origin, off their center."""
    points = np.vstack([[0.0, 0.0], where])
    model = network(points, [[1, 2], [2, 3]])
    bars(model, [0, 1], 1.0, 1.0)
    for i, m in enumerate(masses):
        model.point_mass([i + 1], m)
    if inertia:
        model.point_mass([0], LIGHT, inertia=inertia)
    model.rigid([1, 2, 3], 0)
    return model, points[1:], np.asarray(masses)


@pytest.mark.parametrize("scheme", IMPLICIT)
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


@pytest.mark.parametrize("scheme", ["newmark", "generalized_alpha"])
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


@pytest.mark.parametrize("scheme", IMPLICIT[:3])
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


@pytest.mark.parametrize("scheme", IMPLICIT)
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


@pytest.mark.parametrize("scheme", IMPLICIT)
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


@pytest.mark.parametrize("scheme", IMPLICIT)
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


# --- bodies -------------------------------------------------------------------------------------

CELL = {
    "T3": "tri3", "T6": "tri6", "Q4": "quad4", "Q4I": "quad4", "Q4R": "quad4", "Q4S": "quad4",
    "Q8": "quad8", "Q8R": "quad8", "Q9": "quad9", "OPT": "tri3", "Q4D": "quad4", "Q4DI": "quad4",
}  # fmt: skip


@pytest.mark.parametrize("mass", ["consistent", "constant", "lumped"])
@pytest.mark.parametrize("element", list(CELL))
def test_free_fall_of_two_materials_in_thickness(element, mass):
    # u = g t^2/2 without stress, work m g h; thickness 2.5, two densities, distorted mesh. Units
    # are N-mm-t-s: g = 9810.
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2, cell=CELL[element]), 0.2)
    model = ct.Model(mesh)
    n = mesh.n_cells
    half = np.arange(n)[: n // 2]
    rest = np.arange(n)[n // 2 :]
    steel = ct.Elastic(E=210000.0, nu=0.3, rho=7.8e-9)
    alu = ct.Elastic(E=70000.0, nu=0.3, rho=2.7e-9)
    model.section(half, element=element, material=steel, thickness=2.5)
    model.section(rest, element=element, material=alu, thickness=2.5)
    model.gravity(y=-9810.0)
    end = 1e-2
    for scheme in ("hht", "energy_momentum"):
        step = ct.Dynamic(period=end, increments=10, scheme=scheme, mass=mass)
        frame = ct.solve(model, step).frames[-1]
        drop = 0.5 * 9810.0 * end**2
        np.testing.assert_allclose(frame.U[:, 1], -drop, rtol=1e-6)
        np.testing.assert_allclose(frame.V[:, 1], -9810.0 * end, rtol=1e-6)
        assert max(np.abs(f.values["S"]).max() for f in frame.fields) < 1e-5
        ratio = frame.scalars["ALLKE"] / (0.5 * (9810.0 * end) ** 2)
        area = sum(f.volume.sum(axis=1) @ np.ones(len(f.cells)) for f in frame.fields)
        assert 2.7e-9 * area < ratio < 7.8e-9 * area
        np.testing.assert_allclose(frame.scalars["ALLWK"], frame.scalars["ALLKE"], rtol=1e-6)


# --- frequencies and complex modes --------------------------------------------------------------


def test_chain_modes_masses_and_participation():
    # Generalized eigenproblem of three particles by LAPACK; unit modal mass; participation
    # phi^T M 1 and its square over the total mass.
    stiffness, masses = [100.0, 200.0, 50.0], [1.0, 2.0, 0.5]
    k, m, _ = chain_matrices(stiffness, masses)
    squares, modes = linalg.eigh(k, m)
    results = ct.solve(chain(stiffness, masses), ct.Frequency(modes=3))
    found = results.modes[-1]
    np.testing.assert_allclose(2 * np.pi * found.factors, np.sqrt(squares), rtol=1e-9)
    shapes = found.shapes[:, 1:, 0]
    np.testing.assert_allclose(
        np.abs(np.einsum("ij,jk->ik", shapes @ m, modes)), np.eye(3), atol=1e-7
    )
    for i in range(3):
        factor = modes[:, i] @ masses
        scalars = results.frames[-1].scalars
        np.testing.assert_allclose(abs(scalars[f"participation x {i + 1}"]), abs(factor), rtol=1e-7)
        np.testing.assert_allclose(scalars[f"effective mass x {i + 1}"], factor**2 / 3.5, rtol=1e-7)


def test_complex_modes_of_damping_that_couples_and_overdamps():
    # s^2 M + s C + K: a dashpot to the ground, one between two particles and Rayleigh damping; the
    # companion matrix by LAPACK. Shapes fulfil the quadratic eigenproblem themselves.
    stiffness, masses = [100.0, 200.0, 50.0], [1.0, 2.0, 0.5]
    k, m, _ = chain_matrices(stiffness, masses)
    c = 0.3 * m + 0.004 * k
    c[2, 2] += 4.0
    c[:2, :2] += 6.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    model = chain(stiffness, masses)
    model.dashpot(3, x=4.0)
    model.dashpot(1, 2, c=6.0)
    step = ct.Frequency(modes=3, complex_modes=True, rayleigh=(0.3, 0.004))
    found = ct.solve(model, step).modes[-1]
    companion = np.block(
        [[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(m, k), -np.linalg.solve(m, c)]]
    )
    roots = np.linalg.eigvals(companion)
    roots = roots[roots.imag > 0]
    roots = roots[np.argsort(np.abs(roots))]
    s = found.growth + 2j * np.pi * found.factors
    np.testing.assert_allclose(s[np.argsort(np.abs(s))], roots, rtol=1e-8)
    for i, root in enumerate(s):
        shape = (found.shapes + 1j * found.imaginary)[i, 1:, 0]
        rest = (root**2 * m + root * c + k) @ shape
        assert np.abs(rest).max() < 1e-7 * np.abs(k @ shape).max()


def test_aperiodic_modes_of_an_overdamped_particle():
    # m s^2 + c s + k with c above critical: two real rates, no frequency.
    model = chain([100.0], [1.0])
    model.dashpot(0, 1, c=50.0)
    found = ct.solve(model, ct.Frequency(modes=2, complex_modes=True)).modes[-1]
    np.testing.assert_allclose(found.factors, 0.0, atol=1e-12)
    np.testing.assert_allclose(
        np.sort(found.growth), np.sort(np.roots([1.0, 50.0, 100.0])), rtol=1e-8
    )


@pytest.mark.parametrize("omega", [3.0, 12.0])
def test_particle_on_two_pairs_of_springs_in_a_turning_frame(omega):
    # (kx - m W^2 + m s^2)(ky - m W^2 + m s^2) + 4 m^2 W^2 s^2 = 0: whirl forward and backward at 3,
    # divergence where W^2 lies between kx/m and ky/m.
    kx, ky = 60.0, 200.0
    model = network([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]], [[0, 1], [0, 2], [0, 3], [0, 4]])
    model.truss([0, 1], material=ct.Elastic(E=kx / 2, rho=0.5), area=1.0)
    model.truss([2, 3], material=ct.Elastic(E=ky / 2, rho=0.5), area=1.0)
    model.fix([1, 2, 3, 4])
    model.centrifugal(omega)
    mass = 1.0
    a, b = kx / mass - omega**2, ky / mass - omega**2
    squares = np.roots([1.0, a + b + 4 * omega**2, a * b])
    step = ct.Frequency(modes=2, complex_modes=True, mass="lumped")
    steps = [ct.Static(), step]
    if a * b < 0:
        with pytest.warns(UserWarning, match="divergence"):
            found = ct.solve(model, steps).modes[-1]
    else:
        found = ct.solve(model, steps).modes[-1]
    s = np.sort_complex(np.sqrt(squares.astype(complex)))
    own = found.growth + 2j * np.pi * found.factors
    if a * b > 0:
        np.testing.assert_allclose(np.sort(own.imag), np.sort(np.abs(s.imag)), rtol=1e-7)
        np.testing.assert_allclose(own.real, 0.0, atol=1e-6)
    else:
        np.testing.assert_allclose(found.growth.max(), np.abs(s.real).max(), rtol=1e-7)


def test_growth_of_an_overloaded_pendulum():
    # A bar under the dead weight P stands on its support, a spring holds its top sideways:
    # m w^2 = k - P/l with the shortened length l; above P = k l it falls at that rate.
    k, stiff, m, length = 10.0, 1e4, 2.0, 1.0
    for weight in (4.0, 25.0):
        model = network([[0, 0], [0, length], [-1000.0, length]], [[0, 1], [1, 2]])
        bars(model, [0], stiff, length)
        bars(model, [1], k, 1000.0)
        model.point_mass([1], m)
        model.fix([0, 2])
        model.force([1], y=-weight)
        short = length - weight / stiff
        square = (k - weight / short) / m
        steps = [ct.Static(), ct.Frequency(modes=1)]
        if square > 0:
            found = ct.solve(model, steps).modes[-1]
            np.testing.assert_allclose(2 * np.pi * found.factors[0], math.sqrt(square), rtol=1e-5)
        else:
            with pytest.warns(UserWarning, match="divergence"):
                found = ct.solve(model, steps).modes[-1]
            np.testing.assert_allclose(found.growth[0], math.sqrt(-square), rtol=1e-5)
            assert found.factors[0] == 0.0


@pytest.mark.parametrize("push", [5.0, 40.0])
def test_rigid_plate_on_springs_under_a_following_force(push):
    # A plate of mass m with its center at (sx, 0) from the reference node, on springs kx, ky, kt
    # there, pushed by a pressure on its right side: the pressure turns with the plate and adds
    # P theta to y. Frequencies of the unsymmetric 2 x 2 problem; at 40 they meet: flutter.
    kx, ky, kt = 500.0, 50.0, 20.0
    mesh = ct.mesh.rectangle(1.0, 0.5, nx=2, ny=1, origin=(-0.2, -0.25))
    pivot = ct.mesh.add_node(mesh, 0.0, 0.0, name="pivot")
    points, cells = mesh.points, list(mesh.cells)
    cells.append(Cells("point1", np.array([[pivot]] * 3), np.array([11, 12, 13])))
    mesh = Mesh(points, cells, mesh.node_labels, mesh.node_sets, mesh.cell_sets, mesh.edge_sets)
    model = ct.Model(mesh)
    model.section([0, 1], element="Q4", material=ct.Elastic(E=1e5, rho=8.0), thickness=0.5)
    model.spring([2], kx, "x")
    model.spring([3], ky, "y")
    model.spring([4], kt, "rotation")
    model.rigid(np.arange(6), pivot)
    model.pressure("right", push / (0.5 * 0.5))
    m, s = 8.0 * 0.5 * 0.5, 0.3
    inertia = m * (1.0 + 0.25) / 12 + m * s**2
    mass = np.array([[m, m * s], [m * s, inertia]])
    stiff = np.array([[ky, push], [0.0, kt]])
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiff)).astype(complex)
    flutter = abs(squares.imag).max() > 1e-9
    assert flutter == (push > 20.0)
    roots = np.sqrt(-squares)
    steps = [ct.Static(), ct.Frequency(modes=3)]
    if flutter:
        with pytest.warns(UserWarning, match="flutter"):
            found = ct.solve(model, steps).modes[-1]
        i = int(np.argmax(found.growth))
        np.testing.assert_allclose(found.growth[i], abs(roots.real).max(), rtol=1e-6)
        np.testing.assert_allclose(2 * np.pi * found.factors[i], abs(roots.imag).max(), rtol=1e-6)
    else:
        found = ct.solve(model, steps).modes[-1]
        exact = np.sort(np.r_[abs(roots.imag), math.sqrt(kx / m)])
        np.testing.assert_allclose(np.sort(2 * np.pi * found.factors), exact, rtol=1e-6)


def test_twelve_modes_within_a_millionth():
    # Twelve equal particles on equal springs, joined to their neighbours by springs 1e-7 as stiff:
    # all are found, in order, and their shapes are M-orthonormal.
    n, k, weak = 12, 100.0, 1e-5
    points = [[float(i), 0.0] for i in range(n)] + [[float(i), 1.0] for i in range(n)]
    model = network(points, [[i, n + i] for i in range(n)], [])
    bars(model, list(range(n)), k, 1.0)
    for i in range(n):
        model.point_mass([i], 2.0)
        model.fix([i], y=None)
        model.fix([n + i])
    matrix = k * np.eye(n)
    frames = ct.solve(model, ct.Frequency(modes=n))
    found = frames.modes[-1]
    np.testing.assert_allclose(2 * np.pi * found.factors, math.sqrt(k / 2.0), rtol=1e-9)
    shapes = found.shapes[:, :n, 1]
    np.testing.assert_allclose(2.0 * shapes @ shapes.T, np.eye(n), atol=1e-9)
    # The same with the weak springs: vertical differences by fixed directions.
    lines = [[i, n + i] for i in range(n)] + [[i, i + 1] for i in range(n - 1)]
    model = network(points, lines)
    bars(model, list(range(n)), k, 1.0)
    model.spring(list(range(n, 2 * n - 1)), weak, "y y")
    for i in range(n):
        model.point_mass([i], 2.0)
        model.fix([i], y=None)
        model.fix([n + i])
    for i in range(n - 1):
        matrix[i : i + 2, i : i + 2] += weak * np.array([[1.0, -1.0], [-1.0, 1.0]])
    exact = np.sqrt(np.linalg.eigvalsh(matrix) / 2.0)
    found = ct.solve(model, ct.Frequency(modes=n)).modes[-1]
    np.testing.assert_allclose(2 * np.pi * found.factors - exact, 0.0, atol=1e-10 * exact[0])


@pytest.mark.parametrize("way", ["stretch", "initial stress"])
def test_taut_string_of_particles(way):
    # n particles on a string under the tension T at the spacing a: w_j = 2 sqrt(T/(m a)) sin(j pi /
    # (2(n+1))); along it 2 sqrt(k/m) sin(...). Without NLGEOM the frequency step sees no tension.
    n, k, m, a, tension = 9, 1e4, 0.2, 0.5, 30.0
    points = [[i * a, 0.0] for i in range(n + 2)]
    model = network(points, [[i, i + 1] for i in range(n + 1)])
    bars(model, list(range(n + 1)), k, a)
    model.point_mass(list(range(1, n + 1)), m)
    model.fix([0])
    spacing, inner = a, list(range(1, n + 1))
    first, second = ct.Static(), ct.Frequency(modes=2 * n)
    if way == "stretch":
        # The slack string is held sideways until it is taut; the frequency step lets it go.
        ends = [Fixed([0], 0), Fixed([0], 1), Fixed([n + 1], 1)]
        pulled = Fixed([n + 1], 0, (n + 1) * tension / k)
        first = ct.Static(supports=[*ends, pulled, Fixed(inner, 1)])
        second = ct.Frequency(modes=2 * n, new_supports=True, supports=[*ends, pulled])
        model.supports.clear()
        spacing = a + tension / k
    else:
        model.fix([n + 1])
        model.initial_stress(xx=tension)
    found = ct.solve(model, [first, second]).modes[-1]
    share = np.sin(np.arange(1, n + 1) * math.pi / (2 * (n + 1)))
    exact = np.r_[2 * math.sqrt(tension / (m * spacing)) * share, 2 * math.sqrt(k / m) * share]
    np.testing.assert_allclose(2 * np.pi * found.factors, np.sort(exact), rtol=1e-7)


def test_gears_on_a_torsion_spring():
    # phi2 = -3 phi1 by an equation: w^2 = kt / (I1 + 9 I2), also about a turned state.
    kt, i1, i2 = 40.0, 2.0, 0.5
    model = network([[0, 0], [3, 0]], [[0, 1]], [0, 1])
    model.spring([0], 1.0)
    model.spring([1], kt, "rotation")
    model.spring([2], 1e-9, "rotation")
    model.point_mass([0], 1.0, inertia=i1)
    model.point_mass([1], 1.0, inertia=i2)
    model.fix([0, 1])
    model.equation((1, "rotation", 1.0), (0, "rotation", 3.0))
    model.force([1], moment=5.0)
    results = ct.solve(model, [ct.Static(), ct.Frequency(modes=1)])
    np.testing.assert_allclose(results.frames[-1].UR, [-15.0 / kt, 45.0 / kt], rtol=1e-7)
    exact = math.sqrt(kt / (i1 + 9 * i2))
    np.testing.assert_allclose(2 * np.pi * results.modes[-1].factors[0], exact, rtol=1e-7)


def test_rotating_cantilever_beam():
    # First flapping frequency of a cantilever that rotates at eta = W L^2 sqrt(rho A / EI), hub of
    # radius 0: 3.6817, 5.5850, 11.2023 at 1, 4, 10 (Wright et al., J. Appl. Mech. 49, 1982); in the
    # plane of rotation the square is less by eta^2, Coriolis forces left out.
    n, length, rho, area, inertia = 40, 1.0, 1.0, 1.0, 1e-6
    young = 1.0 / inertia
    for eta, flap in ((1.0, 3.6817), (4.0, 5.5850), (10.0, 11.2023)):
        model = network(
            [[i * length / n, 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)]
        )
        model.beam(
            list(range(n)), material=ct.Elastic(E=young, rho=rho), area=area, inertia=inertia
        )
        model.fix([0], rotation=True)
        model.centrifugal(eta)
        found = ct.solve(model, [ct.Static(), ct.Frequency(modes=1)]).modes[-1]
        exact = math.sqrt(flap**2 - eta**2)
        np.testing.assert_allclose(2 * np.pi * found.factors[0], exact, rtol=2e-3)


def test_compressed_beam_and_its_buckling_load():
    # Pinned beam under a dead force P: w^2 = w0^2 (1 - P/Pcr), w0 = pi^2 sqrt(EI/(rho A L^4)). The
    # chords of 64 beams leave (pi/64)^2/12 of P/Pcr, which 1 - P/Pcr magnifies.
    n, length, area, inertia, young, rho = 64, 2.0, 1.0, 1e-6, 2e5, 0.03
    critical = math.pi**2 * young * inertia / length**2
    for share in (-1.0, 0.5, 0.9):
        model = network(
            [[i * length / n, 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)]
        )
        model.beam(
            list(range(n)), material=ct.Elastic(E=young, rho=rho), area=area, inertia=inertia
        )
        model.fix([0])
        model.fix([n], x=None)
        model.force([n], x=-share * critical)
        found = ct.solve(model, [ct.Static(), ct.Frequency(modes=1)]).modes[-1]
        first = math.pi**2 * math.sqrt(young * inertia / (rho * area * length**4))
        np.testing.assert_allclose(
            2 * np.pi * found.factors[0], first * math.sqrt(1 - share), rtol=1.5e-3
        )


@pytest.mark.parametrize("element", ["T3", "Q4", "Q4I", "Q4R", "Q4S"])
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_dispersion_of_a_row_of_cells(element, mass):
    # A bar of equal linear cells, nu = 0, free to move along x only: consistent mass gives
    # w^2 = (6 c^2/h^2)(1 - cos kh)/(2 + cos kh), lumped 2 c^2/h^2 (1 - cos kh), fixed-fixed.
    n, h, c = 10, 0.3, 7.0
    mesh = ct.mesh.rectangle(n * h, 0.2, nx=n, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=c**2 * 4.0, rho=4.0), thickness=3.0)
    model.fix("left")
    model.fix("right")
    model.fix("bottom", x=None)
    model.fix("top", x=None)
    low, high = mesh.nodes_of("bottom"), mesh.nodes_of("top")
    for a, b in zip(low[1:-1], high[1:-1], strict=True):
        model.equation((int(b), "x", 1.0), (int(a), "x", -1.0))
    found = ct.solve(model, ct.Frequency(modes=n - 1, mass=mass)).modes[-1]
    co = np.cos(np.arange(1, n) * math.pi / n)
    square = 6 * (1 - co) / (2 + co) if mass == "consistent" else 2 * (1 - co)
    np.testing.assert_allclose(2 * np.pi * found.factors, c / h * np.sqrt(square), rtol=1e-8)


@pytest.mark.parametrize("element", ["Q8", "Q9", "Q8R", "T6"])
def test_free_ring(element):
    # A free ring has three rigid motions and pairs of inextensional modes, w^2 = EI/(rho A R^4)
    # n^2 (n^2-1)^2 / (n^2+1); thickness of the wall R/40, pairs agree to 1e-6.
    mesh = ct.mesh.annulus(0.9875, 1.0125, n_radial=1, n_around=108, cell=CELL[element])
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=1e6, nu=0.3, rho=2.0), thickness=0.1
    )
    found = ct.solve(model, ct.Frequency(modes=9)).modes[-1]
    w = 2 * np.pi * found.factors
    h = 0.025
    n = np.array([2, 3, 4])
    exact = np.sqrt(1e6 * h**2 / 12 / 2.0 * n**2 * (n**2 - 1) ** 2 / (n**2 + 1))
    assert np.all(w[:3] < 0.05)
    np.testing.assert_allclose(w[3:8:2], exact, rtol=1e-2)
    np.testing.assert_allclose(w[3:8:2], w[4:9:2], rtol=1e-6)


# --- modal procedures ---------------------------------------------------------------------------


STIFFNESS, MASSES = [100.0, 200.0, 50.0], [1.0, 2.0, 0.5]
CORNERS, SHIFTS = [0.0, 0.25, 0.5, 1.0, 2.0], [0.0, 0.1, 0.1, -0.2, 0.0]


@pytest.mark.parametrize("damping", ["modal", "rayleigh", "dashpot"])
def test_modal_dynamics_of_a_base_moved_by_a_table_with_corners(damping):
    # Velocity jumps at every corner. Modal shares damp the motion relative to the base, Rayleigh's
    # per mass the absolute one, a dashpot between support and first particle their approach.
    k, m, to_base = chain_matrices(STIFFNESS, MASSES)
    model = without_first_support(chain(STIFFNESS, MASSES))
    table(model, "base", CORNERS, SHIFTS)
    slopes = np.diff(SHIFTS) / np.diff(CORNERS)
    options = {}
    if damping == "modal":
        c, options = modal_damping(k, m, 0.03), {"damping": 0.03}
        moved = c.sum(axis=1)
    elif damping == "rayleigh":
        c, options = 0.4 * m + 0.002 * k, {"rayleigh": (0.4, 0.002)}
        moved = 0.002 * to_base
    else:
        c = np.diag([3.0, 0.0, 0.0])
        model.dashpot(0, 1, c=3.0)
        moved = np.array([3.0, 0.0, 0.0])

    def load(t):
        piece = min(max(np.searchsorted(CORNERS, t, side="left") - 1, 0), 3)
        return to_base * np.interp(t, CORNERS, SHIFTS) + moved * slopes[piece]

    exact = linear_motion(k, m, c, load, 2.0, CORNERS)
    steps = [
        ct.Frequency(modes=3, supports=[Fixed([0], 0)]),
        ct.ModalDynamic(
            period=2.0, increments=40, supports=[Fixed([0], 0, 1.0, "base")], **options
        ),
    ]
    frame = ct.solve(model, steps).frames[-1]
    np.testing.assert_allclose(frame.U[1:, 0], exact[:3], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(frame.V[1:, 0], exact[3:], rtol=1e-6, atol=1e-8)


def test_modal_dynamics_goes_on_from_direct_integration():
    # Half a second by the trapezoidal rule under a force, then by modes without it: free vibration
    # from the state reached, by the matrix exponential.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    model = chain(STIFFNESS, MASSES)
    first = ct.Dynamic(
        nlgeom=False, period=0.5, increments=400, scheme="newmark", loads=[NodalForce([3], 0, 2.0)]
    )
    second = ct.ModalDynamic(nlgeom=False, period=1.0, increments=10, new_loads=True)
    results = ct.solve(model, [first, ct.Frequency(modes=3, nlgeom=False), second])
    reached = [f for f in results.frames if f.step == 1][-1]
    matrix = np.block([[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(m, k), np.zeros((3, 3))]])
    start = np.r_[reached.U[1:, 0], reached.V[1:, 0]]
    exact = linalg.expm(matrix) @ start
    last = results.frames[-1]
    np.testing.assert_allclose(last.U[1:, 0], exact[:3], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(last.V[1:, 0], exact[3:], rtol=1e-6, atol=1e-9)


def test_modal_dynamics_about_a_taut_string():
    # The middle of a taut string of five particles is plucked by a force that is let go over one
    # increment: modes about the taut state, with the linear stiffness T/a.
    n, k, m, a, tension = 5, 1e4, 0.2, 0.5, 30.0
    model = network([[i * a, 0.0] for i in range(n + 2)], [[i, i + 1] for i in range(n + 1)])
    bars(model, list(range(n + 1)), k, a)
    model.point_mass(list(range(1, n + 1)), m)
    model.initial_stress(xx=tension)
    model.fix([0, n + 1])
    table(model, "pluck", [0.0, 0.1, 0.105], [1.0, 1.0, 0.0])
    steps = [
        ct.Static(),
        ct.Frequency(modes=2 * n),
        ct.ModalDynamic(period=0.4, increments=80, loads=[NodalForce([3], 1, 0.05, "pluck")]),
    ]
    frame = ct.solve(model, steps).frames[-1]
    matrix = tension / a * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))

    def load(t):
        return np.array([0.0, 0.0, 0.05, 0.0, 0.0]) * np.interp(t, [0.1, 0.105], [1.0, 0.0])

    exact = linear_motion(matrix, m * np.eye(n), np.zeros((n, n)), load, 0.4, [0.1, 0.105])
    np.testing.assert_allclose(frame.U[1:-1, 1], exact[:n], atol=1e-5 * abs(exact[:n]).max())


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_response_to_forces_out_of_phase_with_dashpots(direct):
    # (K - w^2 M + i w C) u = f1 + i f2, with a dashpot that couples modes; a frame holds Re u in U
    # and -w Im u in V. Through resonance, modal and direct.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    c = 0.2 * m + np.diag([0.0, 0.0, 1.5])
    model = chain(STIFFNESS, MASSES)
    model.dashpot(3, x=1.5)
    steady = ct.SteadyState(
        lowest=0.5,
        highest=3.0,
        points=7,
        direct=direct,
        rayleigh=(0.2, 0.0),
        loads=[NodalForce([1], 0, 2.0)],
        imaginary_loads=[NodalForce([3], 0, -1.0)],
    )
    results = ct.solve(model, [ct.Frequency(modes=3), steady])
    frames = [f for f in results.frames if f.step == 2]
    assert len(frames) == 19
    for frame in frames:
        w = 2 * np.pi * frame.time
        exact = np.linalg.solve(k - w**2 * m + 1j * w * c, [2.0, 0.0, -1j])
        size = np.abs(exact).max()
        np.testing.assert_allclose(frame.U[1:, 0], exact.real, atol=1e-6 * size)
        np.testing.assert_allclose(frame.V[1:, 0], -w * exact.imag, atol=1e-6 * w * size)


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_motion_of_a_base_in_two_phases(direct):
    # The base moves by Re (1 + 0.5 i) b exp(i w t); Rayleigh damping per stiffness acts on the
    # approach to the base. Reaction of the base: k1 (1 + i w beta) (ub - u1).
    k, m, to_base = chain_matrices(STIFFNESS, MASSES)
    beta, move = 0.003, 0.01
    model = without_first_support(chain(STIFFNESS, MASSES))
    steady = ct.SteadyState(
        lowest=0.6,
        highest=2.5,
        points=5,
        direct=direct,
        rayleigh=(0.0, beta),
        supports=[Fixed([0], 0, move)],
        imaginary_supports=[Fixed([0], 0, 0.5 * move)],
    )
    steps = [ct.Frequency(modes=3, supports=[Fixed([0], 0)]), steady]
    frames = [f for f in ct.solve(model, steps).frames if f.step == 2]
    for frame in frames:
        w = 2 * np.pi * frame.time
        complex_k = 1 + 1j * w * beta
        base = (1 + 0.5j) * move
        exact = np.linalg.solve(complex_k * k - w**2 * m, complex_k * to_base * base)
        size = np.abs(exact).max()
        np.testing.assert_allclose(frame.U[1:, 0], exact.real, atol=1e-6 * size)
        np.testing.assert_allclose(frame.V[1:, 0], -w * exact.imag, atol=1e-6 * w * size)
        reaction = complex_k * 100.0 * (base - exact[0])
        np.testing.assert_allclose(frame.RF[0, 0], reaction.real, atol=1e-5 * abs(reaction))


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_force_where_a_dead_load_acts(direct):
    # The amplitude is that of the step, whatever load the state carries at the same place; U holds
    # the displacement of the state, too. The static step after it goes on under the dead load.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    steps = [
        ct.Static(loads=[NodalForce([3], 0, 1.0)]),
        ct.Frequency(modes=3),
        ct.SteadyState(
            lowest=0.3,
            highest=0.7,
            points=2,
            direct=direct,
            loads=[NodalForce([3], 0, 2.0)],
            imaginary_loads=[NodalForce([3], 0, 0.5)],
            rayleigh=(0.1, 0.0),
        ),
        ct.Static(),
    ]
    frames = ct.solve(chain(STIFFNESS, MASSES), steps).frames
    rest = np.linalg.solve(k, [0.0, 0.0, 1.0])
    for frame in frames:
        if frame.step == 3:
            w = 2 * math.pi * frame.scalars["frequency"]
            exact = np.linalg.solve(k + (0.1j * w - w**2) * m, [0.0, 0.0, 2.0 + 0.5j])
            np.testing.assert_allclose(frame.U[1:, 0], rest + exact.real, rtol=1e-7)
            np.testing.assert_allclose(frame.V[1:, 0], -w * exact.imag, rtol=1e-6)
    np.testing.assert_allclose(frames[-1].U[1:, 0], rest, rtol=1e-9)


def test_shares_of_damping_by_ranges_of_modes():
    # Modes 1 and 3 have their own shares, mode 2 none: decay of each from its own start, u =
    # shape (cos wd t + z w/wd sin wd t) exp(-z w t), started by a static force K phi.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    squares, modes = linalg.eigh(k, m)
    shares = [0.1, 0.0, 0.02]
    for i in range(3):
        model = chain(STIFFNESS, MASSES)
        force = k @ modes[:, i] * 1e-3
        steps = [
            ct.Static(nlgeom=False, loads=[NodalForce([j + 1], 0, force[j]) for j in range(3)]),
            ct.Frequency(modes=3, nlgeom=False),
            ct.ModalDynamic(
                nlgeom=False,
                period=0.7,
                increments=7,
                damping=[(1, 1, shares[0]), (3, 3, shares[2])],
                new_loads=True,
            ),
        ]
        frame = ct.solve(model, steps).frames[-1]
        w, z = math.sqrt(squares[i]), shares[i]
        wd = w * math.sqrt(1 - z**2)
        q = (math.cos(wd * 0.7) + z * w / wd * math.sin(wd * 0.7)) * math.exp(-z * w * 0.7)
        np.testing.assert_allclose(frame.U[1:, 0], 1e-3 * q * modes[:, i], atol=1e-9)


def test_one_mode_with_residual_modes_is_static_at_rest():
    # A force that grows slowly from zero: one mode alone misses the static answer, with residual
    # modes it is K^-1 f.
    k, _, _ = chain_matrices(STIFFNESS, MASSES)
    model = chain(STIFFNESS, MASSES)
    table(model, "slow", [0.0, 50.0], [0.0, 1.0])
    steps = [
        ct.Frequency(modes=1),
        ct.ModalDynamic(
            period=50.0,
            increments=500,
            damping=0.3,
            residual=True,
            loads=[NodalForce([1], 0, 3.0, "slow")],
        ),
    ]
    frame = ct.solve(model, steps).frames[-1]
    np.testing.assert_allclose(frame.U[1:, 0], np.linalg.solve(k, [3.0, 0.0, 0.0]), rtol=5e-3)


# --- steps, energies and tables -----------------------------------------------------------------


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_motion_rest_motion(scheme):
    # A particle swings for a while, a static step brings it to equilibrium under a force, which
    # the last step takes away: it swings about the origin with that amplitude from rest. ETOTAL
    # loses the kinetic energy of the first motion and nothing else.
    k, m, force = 50.0, 2.0, 5.0
    model = chain([k], [m])
    model.velocity([1], x=1.0)
    steps = [
        ct.Dynamic(period=0.37, increments=100, scheme=scheme),
        ct.Static(loads=[NodalForce([1], 0, force)], increments=50),
        ct.Dynamic(period=0.9, increments=300, scheme=scheme, new_loads=True),
    ]
    results = ct.solve(model, steps)
    w = math.sqrt(k / m)
    ends = [[f for f in results.frames if f.step == i][-1] for i in (1, 2, 3)]
    np.testing.assert_allclose(ends[0].U[1, 0], math.sin(w * 0.37) / w, rtol=1e-3)
    np.testing.assert_allclose(ends[1].U[1, 0], force / k, rtol=1e-9)
    np.testing.assert_allclose(ends[2].U[1, 0], force / k * math.cos(w * 0.9), atol=5e-4)
    np.testing.assert_allclose(
        ends[2].scalars["ALLKE"] + ends[2].scalars["ALLSE"], force**2 / k / 2, rtol=2e-3
    )
    assert abs(ends[2].scalars["energy balance error"]) < 5e-3


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_table_of_total_time_over_two_dynamic_steps(scheme):
    # A force that grows over 1.5 by total time goes on in the second step, in which the motion is
    # continued: m x'' + k x = f t.
    k, m, rate = 50.0, 2.0, 4.0
    model = chain([k], [m])
    table(model, "grow", [0.0, 10.0], [0.0, 10.0], total_time=True)
    steps = [
        ct.Dynamic(
            period=0.7, increments=140, scheme=scheme, loads=[NodalForce([1], 0, rate, "grow")]
        ),
        ct.Dynamic(period=0.8, increments=160, scheme=scheme),
    ]
    frame = ct.solve(model, steps).frames[-1]
    w, t = math.sqrt(k / m), 1.5
    np.testing.assert_allclose(frame.time, t)
    exact = [rate / k * (t - math.sin(w * t) / w), rate / k * (1 - math.cos(w * t))]
    np.testing.assert_allclose([frame.U[1, 0], frame.V[1, 0]], exact, rtol=3e-3)


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8", "Q9", "T6", "OPT", "Q4D"])
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_spinning_preload_is_a_steady_spin(element, mass):
    # A static step under the centrifugal load of W stretches a free ring (held against turning by
    # one point); released with the spin W it must go on turning without vibration: the radius of
    # every node stays within 1e-4 of its growth, over a tenth of a turn, in N-mm-t-s.
    mesh = ct.mesh.annulus(40.0, 50.0, n_radial=1, n_around=24, cell=CELL[element])
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=70000.0, nu=0.3, rho=2.7e-9), thickness=2.0
    )
    omega = 2 * math.pi * 400.0
    model.velocity(spin=omega)
    pole = int(np.argmin(np.hypot(mesh.points[:, 0] - 50.0, mesh.points[:, 1])))
    other = int(np.argmin(np.hypot(mesh.points[:, 0] + 50.0, mesh.points[:, 1])))
    spin = BodyForce("", "centrifugal", (omega**2, 0.0, 0.0))
    holds = [Fixed([pole], 1), Fixed([other], 1)]
    top = int(np.argmin(np.hypot(mesh.points[:, 0], mesh.points[:, 1] - 50.0)))
    holds.append(Fixed([top], 0))
    period = 0.1 / 400.0
    steps = [
        ct.Static(loads=[spin], supports=holds),
        ct.Dynamic(
            period=period,
            increments=40,
            scheme="energy_momentum",
            mass=mass,
            new_loads=True,
            new_supports=True,
        ),
    ]
    frames = ct.solve(model, steps, fields=False).frames
    still = [f for f in frames if f.step == 1][-1]
    r0 = np.hypot(*(mesh.points + still.U).T)
    growth = (r0 - np.hypot(*mesh.points.T)).max()
    assert growth > 5e-3
    for frame in frames:
        if frame.step == 2:
            r = np.hypot(*(mesh.points + frame.U).T)
            assert np.abs(r - r0).max() < 2e-3 * growth


# --- paths and buckling -------------------------------------------------------------------------


def toggle(height, half, stiffness=1000.0, sway=False):
    """Two bars over the span 2 b; the apex is node 1."""
    model = network([[-half, 0.0], [0.0, height], [half, 0.0]], [[0, 1], [1, 2]])
    length = math.hypot(half, height)
    bars(model, [0, 1], stiffness, length)
    model.fix([0, 2])
    if not sway:
        model.fix([1], y=None)
    return model, length


def toggle_load(drop, height, half, stiffness, length):
    rise = height - drop
    now = np.hypot(half, rise)
    return 2 * stiffness * (length - now) * rise / now


@pytest.mark.parametrize("shape", ["cylindrical", "spherical"])
def test_toggle_through_both_limit_points(shape):
    # P = 2 k (L - l)(h - v)/l; turning points at l^3 = L b^2, of equal and opposite load.
    height, half, k = 0.6, 1.0, 1000.0
    model, length = toggle(height, half, k)
    model.force([1], y=-1.0)
    now = (length * half**2) ** (1 / 3)
    limit = 2 * k * (length - now) * math.sqrt(now**2 - half**2) / now
    path = ct.ArcLength(displacement=([1], "y", -2.4 * height), shape=shape)
    results = ct.solve(model, ct.Static(path=path, max_increments=400))
    points = [p for p in results.critical_points if p.kind == "limit"]
    np.testing.assert_allclose([p.factor for p in points], [limit, -limit], rtol=1e-6)
    for frame in results.frames[1:]:
        exact = toggle_load(-frame.U[1, 1], height, half, k, length)
        np.testing.assert_allclose(frame.factor, exact, atol=1e-6 * limit)
    np.testing.assert_allclose(results.frames[-1].U[1, 1], -2.4 * height, rtol=1e-6)


def test_toggle_under_a_soft_spring_snaps_back():
    # The load acts through a spring in series that is softer than the steepest descent of the
    # toggle: the load point's displacement v + P/ks turns back. Every state lies on the curve.
    height, half, k, soft = 0.5, 1.0, 1000.0, 60.0
    points = [[-half, 0.0], [0.0, height], [half, 0.0], [0.0, height + 3.0]]
    model = network(points, [[0, 1], [1, 2], [1, 3]])
    length = math.hypot(half, height)
    bars(model, [0, 1], k, length)
    model.spring([2], soft, "y y")
    model.fix([0, 2])
    model.fix([1, 3], y=None)
    model.force([3], y=-1.0)
    control = ct.DisplacementControl([3], "y", -1.3, increments=20)
    results = ct.solve(model, ct.Static(path=control, max_increments=500))
    now = (length * half**2) ** (1 / 3)
    limit = 2 * k * (length - now) * math.sqrt(now**2 - half**2) / now
    factors = [p.factor for p in results.critical_points if p.kind == "limit"]
    np.testing.assert_allclose(factors, [limit, -limit], rtol=1e-6)
    back = np.diff([f.U[3, 1] for f in results.frames])
    assert (back > 0).any()
    for frame in results.frames[1:]:
        exact = toggle_load(-frame.U[1, 1], height, half, k, length)
        np.testing.assert_allclose(frame.factor, exact, atol=1e-6 * limit)
        np.testing.assert_allclose(frame.U[3, 1], frame.U[1, 1] - exact / soft, atol=1e-6)


@pytest.mark.parametrize("side", [1, -1])
def test_steep_toggle_sways_before_its_limit(side):
    # The sideways stiffness 2 k (b^2/l^2 - (L-l)/l (h-v)^2/l^2) vanishes first. On the branch the
    # bars have forces that balance the load in any sway: both components are checked.
    height, half, k = 3.0, 1.0, 1000.0
    model, length = toggle(height, half, k, sway=True)
    model.force([1], y=-1.0)

    def stiffness(drop):
        rise = height - drop
        now = math.hypot(half, rise)
        return half**2 - (length - now) / now * rise**2

    low, high = 0.0, height / 2
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stiffness(middle) > 0 else (low, middle)
    critical = toggle_load(low, height, half, k, length)
    path = ct.ArcLength(displacement=([1], "y", -1.2), switch=True, side=side)
    results = ct.solve(model, ct.Static(path=path, max_increments=300))
    first = results.critical_points[0]
    assert first.kind == "bifurcation"
    np.testing.assert_allclose(first.factor, critical, rtol=1e-6)
    last = results.frames[-1]
    assert abs(last.U[1, 0]) > 0.1
    for frame in results.frames[1:]:
        apex = np.array([0.0, height]) + frame.U[1]
        force = np.zeros(2)
        for foot in (-half, half):
            d = apex - [foot, 0.0]
            r = math.hypot(*d)
            force += k * (r - length) * d / r
        np.testing.assert_allclose(force, [0.0, -frame.factor], atol=1e-6 * critical)


def link(spring):
    """A rigid link of length 1 that stands on its pivot, node 0, with its top at node 1."""
    model = network([[0.0, 0.0], [0.0, 1.0], [5.0, 1.0]], [[1, 2]], [spring[0]])
    bars(model, [0], LIGHT, 5.0)
    model.fix([0])
    model.fix([2])
    model.rigid([1], 0)
    model.spring([1], spring[1], spring[2])
    return model


@pytest.mark.parametrize("side", [1, -1])
def test_rigid_link_with_a_torsion_spring_beyond_its_load(side):
    # P L = k phi / sin phi, a stable symmetric bifurcation at k/L.
    model = link((0, 12.0, "rotation"))
    model.force([1], y=-1.0)
    path = ct.ArcLength(factor=20.0, switch=True, side=side)
    results = ct.solve(model, ct.Static(path=path, max_increments=300))
    first = results.critical_points[0]
    assert first.kind == "bifurcation"
    np.testing.assert_allclose(first.factor, 12.0, rtol=1e-6)
    last = results.frames[-1]
    phi = abs(last.UR[0])
    np.testing.assert_allclose(phi / math.sin(phi), 20.0 / 12.0, rtol=1e-6)
    assert last.scalars["stable"] == 1.0
    np.testing.assert_allclose(abs(last.U[1, 0]), math.sin(phi), rtol=1e-8)


def test_rigid_link_with_a_sideways_spring_beyond_its_load():
    # P = k L cos phi, an unstable symmetric bifurcation at k L: the load falls on the branch.
    model = link((1, 12.0, "x"))
    model.force([1], y=-1.0)
    path = ct.ArcLength(displacement=([1], "y", -0.3), switch=True)
    results = ct.solve(model, ct.Static(path=path, max_increments=300))
    np.testing.assert_allclose(results.critical_points[0].factor, 12.0, rtol=1e-6)
    last = results.frames[-1]
    np.testing.assert_allclose(last.factor, 12.0 * math.cos(last.UR[0]), rtol=1e-6)
    np.testing.assert_allclose(last.factor, 12.0 * 0.7, rtol=1e-6)
    assert last.scalars["stable"] == 0.0


def test_linear_buckling_of_a_rigid_link():
    # k/L, also where nothing at all moves before: pivot held.
    model = link((0, 12.0, "rotation"))
    model.force([1], y=-1.0)
    found = ct.solve(model, ct.Buckle(modes=1)).modes[-1]
    np.testing.assert_allclose(found.factors, [12.0], rtol=1e-8)


def test_two_rigid_links_buckle_at_the_golden_section():
    # Links of length 1 on torsion springs k: P = k (3 -+ sqrt 5)/2. The second link hangs on the
    # end of the first by equations, so constraints depend on constraints. The frequencies without
    # load, with particles at both ends, are those of M = [[2,1],[1,1]] m, K = [[2,-1],[-1,1]] k.
    k, m = 8.0, 1.5
    points = [[0, 0], [0, 1], [0, 1], [0, 2], [9, 2], [9, 1]]
    model = network(points, [[3, 4], [1, 5], [0, 2]], [0, 0])
    bars(model, [0, 1], LIGHT, 9.0)
    model.fix([0], y=None)
    model.spring([4], 1e6, "y")
    model.fix([4, 5])
    model.rigid([1], 0)
    model.rigid([3], 2)
    model.equation((2, "x", 1.0), (1, "x", -1.0))
    model.equation((2, "y", 1.0), (1, "y", -1.0))
    model.spring([2], k, "rotation rotation")
    model.spring([3], k, "rotation")
    model.point_mass([1, 3], m)
    model.force([3], y=-1.0)
    buckle = ct.Buckle(modes=2)
    found = ct.solve(model, [ct.Frequency(modes=2), buckle])
    exact = k * (3 + math.sqrt(5) * np.array([-1.0, 1.0])) / 2
    np.testing.assert_allclose(found.modes[-1].factors, exact, rtol=1e-5)
    squares = linalg.eigvalsh(
        k * np.array([[2.0, -1.0], [-1.0, 1.0]]), m * np.array([[2.0, 1.0], [1.0, 1.0]])
    )
    np.testing.assert_allclose(2 * np.pi * found.modes[0].factors, np.sqrt(squares), rtol=1e-7)


def column(n, length, young, inertia, area=1.0, rho=1.0):
    model = network([[i * length / n, 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)])
    model.beam(list(range(n)), material=ct.Elastic(E=young, rho=rho), area=area, inertia=inertia)
    return model


@pytest.mark.parametrize("preload", [-0.6, 0.4])
def test_buckling_factor_beyond_a_dead_preload(preload):
    # Pinned column, preload N0 (tension negative): N0 + factor N1 = pi^2 EI/L^2.
    n, length, young, inertia = 40, 2.0, 2e5, 1e-6
    critical = math.pi**2 * young * inertia / length**2
    model = column(n, length, young, inertia)
    model.fix([0])
    model.fix([n], x=None)
    steps = [
        ct.Static(loads=[NodalForce([n], 0, -preload * critical)]),
        ct.Buckle(modes=1, loads=[NodalForce([n], 0, -0.25 * critical)]),
    ]
    found = ct.solve(model, steps).modes[-1]
    np.testing.assert_allclose(found.factors[0], (1 - preload) / 0.25, rtol=2e-3)


def test_column_on_an_elastic_foundation():
    # P_m = EI (m pi/L)^2 + beta (L/(m pi))^2 with springs beta h at the nodes: the third mode is
    # the first here, then the fourth and second.
    n, length, young, inertia = 60, 3.0, 1e5, 1e-6
    ei = young * inertia
    beta = ei * (3.2 * math.pi / length) ** 4
    points = [[i * length / n, 0.0] for i in range(n + 1)]
    model = network(points, [[i, i + 1] for i in range(n)], list(range(1, n)))
    model.beam(list(range(n)), material=ct.Elastic(E=young), area=1.0, inertia=inertia)
    model.spring(list(range(n, 2 * n - 1)), beta * length / n, "y")
    model.fix([0])
    model.fix([n], x=None)
    model.force([n], x=-1.0)
    found = ct.solve(model, ct.Buckle(modes=4)).modes[-1]
    m = np.arange(1, 9) * math.pi / length
    exact = ei * m**2 + beta / m**2
    order = np.argsort(exact)[:4]
    assert order[0] == 2
    np.testing.assert_allclose(found.factors, exact[order], rtol=8e-3)
    for shape, mode in zip(found.shapes, order, strict=True):
        wave = np.sin((mode + 1) * math.pi * np.linspace(0, 1, n + 1))
        cosine = abs(shape[:, 1] @ wave) / np.linalg.norm(shape[:, 1]) / np.linalg.norm(wave)
        assert cosine > 0.9999


def test_swaying_portal_frame():
    # Hinged feet, a force on each column: kL tan kL = 6 (Ib/b)/(Ic/L) for sway (Timoshenko and
    # Gere, Theory of Elastic Stability). Axially stiff; N and mm.
    n, height, span, young = 20, 3000.0, 5000.0, 2.1e5
    ic, ib = 4e6, 9e6
    left = [[0.0, i * height / n] for i in range(n + 1)]
    beam = [[i * span / n, height] for i in range(1, n)]
    right = [[span, height - i * height / n] for i in range(n + 1)]
    points = left + beam + right
    last = len(points) - 1
    model = network(points, [[i, i + 1] for i in range(last)])
    steel = ct.Elastic(E=young, nu=0.3)
    model.beam(list(range(n)), material=steel, area=1e7, inertia=ic)
    model.beam(list(range(n, 2 * n)), material=steel, area=1e7, inertia=ib)
    model.beam(list(range(2 * n, last)), material=steel, area=1e7, inertia=ic)
    model.fix([0, last])
    model.force([n, 2 * n], y=-1000.0)
    ratio = 6 * (ib / span) / (ic / height)
    low, high = 1e-6, math.pi / 2 - 1e-9
    for _ in range(200):
        x = 0.5 * (low + high)
        low, high = (x, high) if x * math.tan(x) < ratio else (low, x)
    exact = low**2 * young * ic / height**2 / 1000.0
    found = ct.solve(model, ct.Buckle(modes=1)).modes[-1]
    np.testing.assert_allclose(found.factors[0], exact, rtol=2e-3)


@pytest.mark.parametrize("element", ["Q8", "Q9"])
def test_ring_under_pressure_that_follows(element):
    # Plane strain tube under external pressure p R^3/(E' I) = 3, twice (any direction of the oval);
    # h/R = 1/50, thickness 2.
    h = 0.02
    mesh = ct.mesh.annulus(1 - h / 2, 1 + h / 2, n_radial=1, n_around=96, cell=CELL[element])
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=1e6, nu=0.3), thickness=2.0, plane="strain"
    )
    for x, y, dof in ((1.0, 0.0, 1), (-1.0, 0.0, 1), (0.0, 1.0, 0)):
        r = 1 + h / 2
        at = int(np.argmin(np.hypot(mesh.points[:, 0] - r * x, mesh.points[:, 1] - r * y)))
        model.supports.append(Fixed([at], dof))
    model.pressure("outer", 1.0)
    exact = 3 * 1e6 / (1 - 0.09) * h**3 / 12
    found = ct.solve(model, ct.Buckle(modes=2)).modes[-1]
    np.testing.assert_allclose(found.factors, exact, rtol=2.5e-2)
    np.testing.assert_allclose(found.factors[0], found.factors[1], rtol=1e-4)


def test_ring_under_loads_of_fixed_direction():
    # Dead radial forces on a ring of beams: q R^3/(EI) = 4 (forces keep their direction). A quarter
    # with its symmetries held; the whole ring would turn first.
    n, ei = 48, 50.0
    angle = np.linspace(0.0, math.pi / 2, n + 1)
    points = np.c_[np.cos(angle), np.sin(angle)]
    model = network(points, [[i, i + 1] for i in range(n)])
    model.beam(list(range(n)), material=ct.Elastic(E=1e6), area=10.0, inertia=ei / 1e6)
    for i in range(n + 1):
        side = math.pi / 2 / n * (0.5 if i in (0, n) else 1.0)
        model.force([i], x=-side * points[i, 0], y=-side * points[i, 1])
    model.fix([0], x=None, rotation=True)
    model.fix([n], y=None, rotation=True)
    found = ct.solve(model, ct.Buckle(modes=1)).modes[-1]
    np.testing.assert_allclose(found.factors[0], 4 * ei, rtol=5e-3)


@pytest.mark.parametrize("load", [0.3, 0.6, 0.9])
def test_frequency_on_the_way_to_the_limit_point(load):
    # m w^2 = dP/dv of the toggle at the state that the load has reached.
    height, half, k, m = 0.6, 1.0, 1000.0, 2.0
    model, length = toggle(height, half, k)
    now = (length * half**2) ** (1 / 3)
    limit = 2 * k * (length - now) * math.sqrt(now**2 - half**2) / now
    model.point_mass([1], m)
    model.force([1], y=-load * limit)
    results = ct.solve(model, [ct.Static(increments=4), ct.Frequency(modes=1)])
    drop = -[f for f in results.frames if f.step == 1][-1].U[1, 1]
    rise = height - drop
    r = math.hypot(half, rise)
    slope = 2 * k * (rise**2 / r**2 - (length - r) / r * half**2 / r**2)
    np.testing.assert_allclose(
        2 * np.pi * results.modes[-1].factors[0], math.sqrt(slope / m), rtol=1e-6
    )


@pytest.mark.parametrize("scheme", [*IMPLICIT, "central_difference"])
def test_toggle_snaps_through_under_a_sudden_load(scheme):
    # m v'' = P - P(v): a load below the static limit that carries it through at once.
    height, half, k, m = 0.4, 1.0, 1000.0, 2.0
    model, length = toggle(height, half, k)
    now = (length * half**2) ** (1 / 3)
    limit = 2 * k * (length - now) * math.sqrt(now**2 - half**2) / now
    load, end = 0.9 * limit, 0.6
    model.point_mass([1], m)
    model.force([1], y=-load)

    def rate(_, z):
        return [z[1], (load - toggle_load(z[0], height, half, k, length)) / m]

    exact = integrate(rate, [0.0, 0.0], end)

    def run(n):
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        return np.array([-frame.U[1, 1], -frame.V[1, 1]])

    assert exact[0] > height
    np.testing.assert_allclose(extrapolated(run, 200), exact, rtol=0, atol=5e-3)


def test_path_after_a_preload_by_a_prescribed_support():
    # A bar of the toggle is shortened first by moving its foot; the path of the vertical load then
    # starts from that state: the same curve with feet at -b and b - d.
    height, half, k, move = 0.6, 1.0, 1000.0, 0.05
    model, length = toggle(height, half, k, sway=True)
    first = ct.Static(supports=[Fixed([2], 0, -move)])
    path = ct.ArcLength(displacement=([1], "y", -2.0 * height))
    second = ct.Static(path=path, loads=[NodalForce([1], 1, -1.0)], max_increments=300)
    results = ct.solve(model, [first, second])
    near = half - move / 2
    frames = [f for f in results.frames if f.step == 2]
    for frame in frames:
        np.testing.assert_allclose(frame.U[1, 0], -move / 2, atol=1e-9)
        rise = height + frame.U[1, 1]
        now = math.hypot(near, rise)
        np.testing.assert_allclose(frame.factor, 2 * k * (length - now) * rise / now, atol=1e-4)


# --- beside other programs, and decks -----------------------------------------------------------

LONG_PLATE = """*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE=CPE8, ELSET=E
{elements}
*NSET, NSET=L
{left}
*MATERIAL, NAME=M
*ELASTIC
210000., .3
*DENSITY
7.8e-9
*SOLID SECTION, ELSET=E, MATERIAL=M{options}
3.
*BOUNDARY
L, 1, 2
"""


def plate_deck(options=""):
    """Cantilever of 100 x 10 mm and 3 mm, 8 x 2 serendipity cells; numbers row by row."""
    label, nodes = {}, []
    for j in range(5):
        for i in range(17):
            if not (i % 2 and j % 2):
                label[i, j] = len(label) + 1
                nodes.append(f"{label[i, j]}, {100 * i / 16}, {10 * j / 4}")
    order = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    elements = []
    for j in range(2):
        for i in range(8):
            own = [label[2 * i + p, 2 * j + q] for p, q in order]
            elements.append(", ".join(map(str, [len(elements) + 1, *own])))
    left = ", ".join(str(label[0, j]) for j in range(5))
    return LONG_PLATE.format(
        nodes="\n".join(nodes), elements="\n".join(elements), left=left, options=options
    )


def run_deck(text, folder, name="job"):
    path = folder / f"{name}.inp"
    path.write_text(text)
    return ct.solve(ct.read(path))


def test_frequencies_beside_calculix(tmp_path):
    # CalculiX 2.20, the same deck.
    results = run_deck(plate_deck() + "*STEP\n*FREQUENCY\n6\n*END STEP\n", tmp_path)
    calculix = [879.0976, 5269.234, 13650.02, 13882.01, 25299.30, 38868.63]
    np.testing.assert_allclose(results.modes[-1].factors, calculix, rtol=2e-6)


def test_spinning_preload_beside_calculix(tmp_path):
    # CalculiX 2.20: static NLGEOM step under CENTRIF, then *STEP, PERTURBATION, *FREQUENCY. Its
    # material is linear in Green-Lagrange strain, so the same is asked for here.
    spin = "*DLOAD\nE, CENTRIF, 4.e6, 0., 5., 0., 0., 0., 1.\n"
    text = plate_deck(", LOCAL STRAIN=GREEN LAGRANGE") + (
        f"*STEP, NLGEOM\n*STATIC\n{spin}*END STEP\n*STEP, PERTURBATION\n*FREQUENCY\n6\n*END STEP\n"
    )
    calculix = [890.2048, 5320.437, 13658.29, 13940.71, 25365.30, 38941.18]
    found = run_deck(text, tmp_path).modes[-1].factors
    np.testing.assert_allclose(found, calculix, rtol=2e-6)


def test_buckling_beside_calculix(tmp_path):
    # CalculiX 2.20, force on the middle of the free end; it takes the stresses of the linear
    # response alone, which is the same to the first order of the strain.
    text = plate_deck(", LOCAL STRAIN=GREEN LAGRANGE") + (
        "*STEP\n*BUCKLE\n3\n*CLOAD\n43, 1, -1.\n*END STEP\n"
    )
    found = run_deck(text, tmp_path).modes[-1].factors
    np.testing.assert_allclose(found, [14235.46, 120136.7, 298042.2], rtol=5e-3)
    np.testing.assert_allclose(found[0], 14235.46, rtol=3e-4)


def test_first_frequency_under_a_following_tension(tmp_path):
    # A tension that follows the free end: Beck's frequency equation p^2 + 2 w^2 (1 + ch a cos b) +
    # p w sh a sin b = 0 with p = -P L^2/EI lowers the first frequency by 6.85 %.
    pull = "*DLOAD\n8, P2, -400.\n16, P2, -400.\n"
    text = plate_deck() + (
        f"*STEP, NLGEOM\n*STATIC\n{pull}*END STEP\n*STEP, PERTURBATION\n*FREQUENCY\n2\n*END STEP\n"
    )

    def first(p):
        def value(w):
            r = math.sqrt(p * p / 4 + w * w)
            a, b = math.sqrt(r - p / 2), math.sqrt(r + p / 2)
            even = 2 * w * w * (1 + math.cosh(a) * math.cos(b))
            return p * p + even + p * w * math.sinh(a) * math.sin(b)

        low, high = 1.0, 5.0
        for _ in range(100):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if value(low) * value(middle) > 0 else (low, middle)
        return low

    p = -400.0 * 30 * 100.0**2 / (210000 / 0.91 * 250)
    found = run_deck(text, tmp_path).modes[-1].factors[0]
    np.testing.assert_allclose(found / 879.0976, first(p) / first(0.0), rtol=2e-3)


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8", "T6", "T3"])
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_coriolis_forces_of_a_continuum(element, mass):
    # All real modes give the mass, M = (Phi Phi^T)^-1; C = 2 W M J. Eigenvalues by LAPACK.
    mesh = ct.mesh.rectangle(100.0, 10.0, nx=5, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    steel = ct.Elastic(E=210000.0, nu=0.3, rho=7.8e-9)
    model.section("all", element=element, material=steel, thickness=3.0, plane="strain")
    model.fix("left")
    spin = 2000.0
    model.centrifugal(spin, about=(0.0, 5.0))
    free = np.setdiff1d(np.arange(mesh.n_nodes), mesh.nodes_of("left"))
    n = 2 * len(free)
    steps = [
        ct.Static(),
        ct.Frequency(modes=n, mass=mass),
        ct.Frequency(modes=4, mass=mass, complex_modes=True),
    ]
    real, found = ct.solve(model, steps).modes
    phi = real.shapes[:, free, :2].reshape(n, n).T
    matrix = np.linalg.inv(phi @ phi.T)
    turn = np.kron(np.eye(len(free)), [[0.0, -1.0], [1.0, 0.0]])
    half = spin * matrix @ turn
    modal = phi.T @ (half - half.T) @ phi
    squares = (2 * np.pi * real.factors) ** 2
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(squares), -modal]])
    roots = np.linalg.eigvals(companion)
    exact = np.sort(roots.imag[roots.imag > 0])[:4] / (2 * np.pi)
    np.testing.assert_allclose(found.factors, exact, rtol=1e-8)
    np.testing.assert_allclose(found.growth, 0.0, atol=1e-6 * exact[0])


CHAIN_DECK = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 3., 0.
*NSET, NSET=TIP
4
*ELEMENT, TYPE=SPRINGA, ELSET=S1
1, 1, 2
*ELEMENT, TYPE=SPRINGA, ELSET=S2
2, 2, 3
*ELEMENT, TYPE=SPRINGA, ELSET=S3
3, 3, 4
*SPRING, ELSET=S1

100.
*SPRING, ELSET=S2

200.
*SPRING, ELSET=S3

50.
*ELEMENT, TYPE=MASS, ELSET=M1
11, 2
*ELEMENT, TYPE=MASS, ELSET=M2
12, 3
*ELEMENT, TYPE=MASS, ELSET=M3
13, 4
*MASS, ELSET=M1
1.
*MASS, ELSET=M2
2.
*MASS, ELSET=M3
.5
*ELEMENT, TYPE=DASHPOTA, ELSET=D
21, 2, 3
*DASHPOT, ELSET=D

6.
*AMPLITUDE, NAME=A
0., 0., 0.25, 1., 0.5, 1., 1., -2.
2., 0.
*BOUNDARY
1, 1, 2
2, 2
3, 2
4, 2
"""
COUPLED = 6.0 * np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])


def table_rows(text, name):
    """Tables of a .dat file under headings that hold `name`: time to rows."""
    found, rows = {}, None
    for line in text.splitlines():
        if "time" in line:
            rows = found.setdefault(float(line.split()[-1]), []) if name in line else None
        elif line.strip() and rows is not None:
            try:
                rows.append([float(word) for word in line.split()])
            except ValueError:
                rows = None
    return found


def solve_to_files(text, folder):
    path = folder / "job.inp"
    path.write_text(text)
    results = ct.solve(ct.read(path), observers=[ct.JobFiles(str(folder))])
    return results, (folder / "job.dat").read_text()


def test_deck_of_modal_dynamics_with_a_dashpot(tmp_path):
    # Forces by a table, dashpot between two particles, table of displacements in .dat.
    steps = (
        "*STEP\n*FREQUENCY\n3\n*END STEP\n"
        "*STEP\n*MODAL DYNAMIC\n0.05, 1.5\n*CLOAD, AMPLITUDE=A\n4, 1, 3.\n"
        "*NODE PRINT, NSET=TIP\nU\n*END STEP\n"
    )
    results, text = solve_to_files(CHAIN_DECK + steps, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    corners = [0.0, 0.25, 0.5, 1.0, 2.0]

    def load(t):
        return np.array([0.0, 0.0, 3.0 * np.interp(t, corners, [0.0, 1.0, 1.0, -2.0, 0.0])])

    exact = linear_motion(k, m, COUPLED, load, 1.5, corners)
    np.testing.assert_allclose(results.frames[-1].U[1:, 0], exact[:3], rtol=1e-7)
    rows = table_rows(text, "TIP")
    np.testing.assert_allclose(rows[max(rows)][-1][1], exact[2], rtol=1e-5)


def test_deck_of_steady_state_with_two_load_cases(tmp_path):
    # LOAD CASE=2 acts a quarter of a period ahead; the dashpot couples the modes.
    steps = (
        "*STEP\n*FREQUENCY\n3\n*END STEP\n"
        "*STEP\n*STEADY STATE DYNAMICS\n0.5, 2.5, 5\n"
        "*CLOAD, LOAD CASE=1\n2, 1, 2.\n*CLOAD, LOAD CASE=2\n4, 1, -1.\n*END STEP\n"
    )
    results, _ = solve_to_files(CHAIN_DECK + steps, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    frames = [f for f in results.frames if f.step == 2]
    assert len(frames) == 13
    for frame in frames:
        w = 2 * math.pi * frame.time
        exact = np.linalg.solve(k - w**2 * m + 1j * w * COUPLED, [2.0, 0.0, -1j])
        np.testing.assert_allclose(frame.U[1:, 0], exact.real, atol=1e-7 * abs(exact).max())
        np.testing.assert_allclose(
            frame.V[1:, 0], -w * exact.imag, atol=1e-7 * w * abs(exact).max()
        )


def test_deck_of_complex_frequencies(tmp_path):
    # Eigenvalues of the quadratic problem in the result and in the table.
    steps = "*STEP\n*FREQUENCY\n3\n*END STEP\n*STEP\n*COMPLEX FREQUENCY, CORIOLIS\n3\n*END STEP\n"
    results, text = solve_to_files(CHAIN_DECK + steps, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    companion = np.block(
        [[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(m, k), -np.linalg.solve(m, COUPLED)]]
    )
    roots = np.linalg.eigvals(companion)
    roots = roots[roots.imag > 0]
    roots = roots[np.argsort(roots.imag)]
    found = results.modes[-1]
    np.testing.assert_allclose(2 * np.pi * found.factors, roots.imag, rtol=1e-8)
    np.testing.assert_allclose(found.growth, roots.real, rtol=1e-8)
    rows = [line.split() for line in text.splitlines() if line.split()[:1] == ["1"]]
    assert any(
        len(row) == 4
        and math.isclose(float(row[1]), roots[0].imag, rel_tol=1e-6)
        and math.isclose(abs(float(row[3])), abs(roots[0].real), rel_tol=1e-6)
        for row in rows
    )


def test_deck_of_direct_dynamics_and_its_histories(tmp_path):
    # Trapezoidal rule (ALPHA=0) with a dashpot and a table: displacement in .dat,
    # dissipation of the dashpot and kinetic energy in .csv.
    steps = (
        "*STEP, INC=10000\n*DYNAMIC, DIRECT, ALPHA=0.\n0.005, 1.5\n*CLOAD, AMPLITUDE=A\n"
        "4, 1, 3.\n*NODE PRINT, NSET=TIP, FREQUENCY=100\nU\n*END STEP\n"
    )
    _, text = solve_to_files(CHAIN_DECK + steps, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    corners = [0.0, 0.25, 0.5, 1.0, 2.0]

    def rate(t, z):
        force = np.array([0.0, 0.0, 3.0 * np.interp(t, corners, [0.0, 1.0, 1.0, -2.0, 0.0])])
        v = z[3:6]
        return np.r_[
            v, np.linalg.solve(m, force - k @ z[:3] - COUPLED @ v), v @ COUPLED @ v, force @ v
        ]

    exact = integrate(rate, np.zeros(8), 1.5, corners)
    rows = table_rows(text, "TIP")
    np.testing.assert_allclose(rows[max(rows)][-1][1], exact[2], rtol=1e-3)
    lines = (tmp_path / "job.csv").read_text().splitlines()
    names = lines[0].split(",")
    last = dict(zip(names, lines[-1].split(","), strict=True))
    np.testing.assert_allclose(float(last["ALLVD"]), exact[6], rtol=1e-3)
    np.testing.assert_allclose(float(last["ALLWK"]), exact[7], rtol=1e-3)
    np.testing.assert_allclose(float(last["ALLKE"]), 0.5 * exact[3:6] @ m @ exact[3:6], rtol=2e-3)


# --- bodies in motion ---------------------------------------------------------------------------


@pytest.mark.parametrize("scheme", IMPLICIT)
@pytest.mark.parametrize("element", ["Q4", "Q8", "OPT", "Q4D"])
def test_rayleigh_damping_of_a_spinning_flight(element, scheme):
    # Damping per mass alone slows flight and spin by exp(-alpha t); damping per stiffness does not
    # act on a rigid motion. A stiff plate, large spin.
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=1e7, nu=0.3, rho=2.0), thickness=0.5
    )
    model.velocity(x=1.0, y=-2.0, spin=3.0, about=(1.0, 0.5))
    alpha, end = 0.8, 1.0
    step = ct.Dynamic(period=end, increments=100, scheme=scheme, rayleigh=(alpha, 1e-3))
    scalars = ct.solve(model, step, fields=False).frames[-1]
    left = math.exp(-alpha * end)
    flown = (1 - left) / alpha
    middle = scalars.U[[int(i) for i in np.lexsort(mesh.points.T)[[0, -1]]]].mean(axis=0)
    np.testing.assert_allclose(middle, [flown, -2.0 * flown], rtol=2e-3)
    d = (mesh.points + scalars.U)[np.lexsort(mesh.points.T)[[0, -1]]]
    angle = math.atan2(*(d[1] - d[0])[::-1]) - math.atan2(1.0, 2.0)
    np.testing.assert_allclose(angle, 3.0 * flown, rtol=2e-3)


@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q9", "OPT", "Q4D"])
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_what_rests_under_gravity_stays_at_rest(element, mass):
    # A static step under gravity, with large deflection, a rigid end that carries a particle with
    # its weight, then motion under the same loads: nothing moves.
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=6, ny=1, cell=CELL[element])
    handle = ct.mesh.add_node(mesh, 11.0, 0.5)
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=1e4, nu=0.3, rho=0.5), thickness=2.0
    )
    model.fix("left", rotation=True if element in ("OPT", "Q4D") else None)
    model.rigid("right", handle)
    model.point_mass([handle], 0.5, inertia=0.2)
    model.gravity(y=-9.81)
    model.force([handle], y=-0.5 * 9.81)
    steps = [
        ct.Static(increments=3),
        ct.Dynamic(period=2.0, increments=5, mass=mass, scheme="newmark"),
    ]
    frames = ct.solve(model, steps, fields=False).frames
    still = [f for f in frames if f.step == 1][-1]
    assert abs(still.U[:, 1]).max() > 0.5
    for frame in frames:
        if frame.step == 2:
            np.testing.assert_allclose(frame.U, still.U, atol=1e-6)
            assert abs(frame.V).max() < 1e-5


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_compound_pendulum_of_a_rigid_plate(scheme):
    # A plate of cells that are all rigid hangs on one corner: I phi'' = -m g times the arm,
    # I = m (a^2 + b^2)/3 about the corner, with consistent mass exactly. Half a turn and more.
    a, b, g, end = 1.2, 0.5, 9.81, 1.1
    mesh = ct.mesh.rectangle(a, b, nx=2, ny=1)
    pivot = ct.mesh.add_node(mesh, 0.0, 0.0)
    model = ct.Model(mesh)
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3, rho=3.0), thickness=0.7)
    model.rigid(np.arange(pivot), pivot)
    model.fix([pivot])
    model.gravity(y=-g)

    def rate(_, z):
        arm = 0.5 * (a * math.cos(z[0]) - b * math.sin(z[0]))
        return [z[1], -g * arm / ((a**2 + b**2) / 3)]

    exact = integrate(rate, [0.0, 0.0], end)

    def run(n):
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        return np.array([frame.UR[pivot], frame.V[pivot, 2]])

    np.testing.assert_allclose(extrapolated(run, 50), exact, rtol=0, atol=2e-3)


def test_wave_in_a_bar_struck_by_its_support():
    # The left end starts at the speed v: a front of stress -E v/c runs at c.
    # At the stable increment central differences with lumped mass carry it exactly; the work is
    # that of the force A E v/c.
    n, h, c, v, area = 40, 0.05, 10.0, 0.02, 0.3
    young, rho = 500.0, 5.0
    points = [[i * h, 0.0] for i in range(n + 1)]
    model = network(points, [[i, i + 1] for i in range(n)])
    model.truss(list(range(n)), material=ct.Elastic(E=young, rho=rho), area=area)
    model.fix(list(range(n + 1)), x=None)
    table(model, "strike", [0.0, 1.0], [0.0, v])
    model.fix([0], x=1.0, y=None, amplitude="strike")
    step = ct.Dynamic(nlgeom=False, period=0.1, increments=20 * 5, scheme="central_difference")
    frame = ct.solve(model, step).frames[-1]
    front = c * 0.1
    exact = np.maximum(v * (0.1 - np.arange(n + 1) * h / c), 0.0)
    np.testing.assert_allclose(frame.U[:, 0], exact, atol=0.03 * v * 0.1)
    np.testing.assert_allclose(frame.scalars["ALLWK"], area * young * v / c * v * 0.1, rtol=3e-2)
    np.testing.assert_allclose(frame.scalars["ALLKE"], 0.5 * rho * area * front * v**2, rtol=6e-2)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_vibration_seen_from_a_frame_at_constant_velocity(scheme):
    # A beam whose support moves steadily, started with that velocity, beside one at rest: relative
    # displacements, stresses and reactions are the same, also with Rayleigh damping per stiffness.
    def run(speed):
        mesh = ct.mesh.rectangle(4.0, 0.5, nx=4, ny=1)
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
        table(model, "go", [0.0, 10.0], [0.0, 10.0])
        model.fix("left", x=speed[0], y=speed[1], amplitude="go")
        if any(speed):
            model.velocity(x=speed[0], y=speed[1])
        model.traction("right", y=5.0)
        step = ct.Dynamic(period=1.5, increments=60, scheme=scheme, rayleigh=(0.0, 1e-3))
        frame = ct.solve(model, step).frames[-1]
        relative = frame.U - np.asarray(speed) * 1.5
        reaction = frame.RF[mesh.nodes_of("left"), :2]
        return relative, reaction, frame.fields[0].values["S"]

    still, moving = run((0.0, 0.0)), run((3.0, -7.0))
    for one, other in zip(still, moving, strict=True):
        np.testing.assert_allclose(other, one, atol=1e-7 * abs(one).max())


@pytest.mark.parametrize("scheme", [*IMPLICIT, "central_difference"])
def test_support_that_goes_on_at_its_speed_in_the_next_step(scheme):
    # Two dynamic steps, each with its own table by step time: the speed of the support is the same
    # in both, so there is no pulse where they meet. m x'' = k (s - x) as if there were one step.
    k, m, v = 30.0, 2.0, 0.7
    w, end = math.sqrt(k / m), 1.6

    def run(n):
        model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
        bars(model, [0], k, 1.0)
        model.point_mass([0], 1.0)
        model.point_mass([1], m)
        model.fix([1], x=None)
        model.fix([0], x=None)
        model.velocity([0], x=v)
        table(model, "one", [0.0, 0.8], [0.0, 0.8 * v])
        table(model, "two", [0.0, 0.8], [0.8 * v, 1.6 * v])
        steps = [
            ct.Dynamic(
                period=0.8,
                increments=n,
                scheme=scheme,
                supports=[Fixed([0], 0, 1.0, amplitude=name)],
            )
            for name in ("one", "two")
        ]
        results = ct.solve(model, steps)
        last = results.frames[-1]
        pulse = next(f.RF[0, 0] for f in results.frames if f.step == 2)
        return np.array([last.U[1, 0], last.V[1, 0], last.RF[0, 0], pulse])

    exact = [
        v * end - v / w * math.sin(w * end),
        v - v * math.cos(w * end),
        k * v / w * math.sin(w * end),
    ]
    np.testing.assert_allclose(extrapolated(run, 60)[:3], exact, rtol=0, atol=2e-3)
    t = 0.8 * (1 + 1 / 60)
    np.testing.assert_allclose(run(60)[3], k * v / w * math.sin(w * t), rtol=0, atol=0.1)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_work_of_a_ground_dashpot_on_a_driven_rotation(scheme):
    # A disc turned at constant rate against a rotational dashpot: moment c W, dissipation c W^2 t.
    model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
    model.beam([0], material=ct.Elastic(E=1e-6, rho=LIGHT), area=LIGHT, inertia=LIGHT)
    model.point_mass([0], 1.0, inertia=0.7)
    model.dashpot(0, rotation=0.4)
    model.fix([1], rotation=True)
    table(model, "turn", [0.0, 10.0], [0.0, 30.0])
    model.fix([0], rotation=1.0, amplitude="turn")
    model.velocity([0], spin=3.0)
    frame = ct.solve(model, ct.Dynamic(period=5.0, increments=200, scheme=scheme)).frames[-1]
    # Energy-momentum works on 2 tan(dphi/2) for dphi: second order.
    close = {"rtol": 1e-3 if scheme == "energy_momentum" else 1e-6}
    np.testing.assert_allclose(frame.UR[0], 15.0, rtol=1e-12)
    np.testing.assert_allclose(frame.RF[0, 2], 1.2, **close)
    np.testing.assert_allclose(frame.scalars["ALLVD"], 0.4 * 9.0 * 5.0, **close)
    np.testing.assert_allclose(frame.scalars["ALLWK"], 0.4 * 9.0 * 5.0, **close)


def test_equation_with_a_right_hand_side_in_motion():
    # x1 - x2 = 0.3 holds at the start of the analysis: in the static step before it stretches the
    # springs, the motion after it (force on both) keeps the distance.
    k, m = [40.0, 60.0], [1.0, 2.0]
    model = network([[0, 0], [1, 0], [2, 0], [3, 0]], [[0, 1], [2, 3]])
    bars(model, [0], k[0], 1.0)
    bars(model, [1], k[1], 1.0)
    for i in (1, 2):
        model.point_mass([i], m[i - 1])
        model.fix([i], x=None)
    model.fix([0, 3])
    model.equation((1, "x", 1.0), (2, "x", -1.0), rhs=0.3)
    push = 2.0
    second = ct.Dynamic(period=0.9, increments=300, loads=[NodalForce([2], 0, push)])
    frames = ct.solve(model, [ct.Static(), second], fields=False).frames
    rest = -k[0] * 0.3 / sum(k)
    still = [f for f in frames if f.step == 1][-1]
    np.testing.assert_allclose(still.U[2, 0], rest, rtol=1e-9)
    w = math.sqrt(sum(k) / sum(m))
    exact = rest + push / sum(k) * (1 - math.cos(w * 0.9))
    np.testing.assert_allclose(frames[-1].U[2, 0], exact, rtol=1e-3)
    np.testing.assert_allclose(frames[-1].U[1, 0] - frames[-1].U[2, 0], 0.3, rtol=1e-12)


# --- sequences of procedures and constraints in modes -------------------------------------------


@pytest.mark.parametrize("between", ["frequency", "steady"])
@pytest.mark.parametrize("scheme", ["newmark", "energy_momentum", "central_difference"])
def test_linear_procedures_between_do_not_end_a_motion(between, scheme):
    # x = sin(w t)/w v goes on through a frequency or harmonic step: only static steps
    # end a motion, and a harmonic force is no load of a transient.
    k, m = 50.0, 2.0
    model = chain([k], [m])
    model.velocity([1], x=1.0)
    linear = {
        "frequency": [ct.Frequency(modes=1)],
        "steady": [
            ct.Frequency(modes=1),
            ct.SteadyState(lowest=0.1, highest=0.2, points=2, loads=[NodalForce([1], 0, 1.0)]),
        ],
    }[between]
    motion = [ct.Dynamic(period=0.4, increments=200, scheme=scheme) for _ in range(2)]
    steps = [motion[0], *linear, motion[1]]
    last = ct.solve(model, steps, fields=False).frames[-1]
    w = math.sqrt(k / m)
    exact = [math.sin(w * 0.8) / w, math.cos(w * 0.8)]
    np.testing.assert_allclose([last.U[1, 0], last.V[1, 0]], exact, atol=1e-4)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_direct_integration_goes_on_from_modal_dynamics(scheme):
    # Modal motion under a ramp of force for half a second, then direct integration without it.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    model = chain(STIFFNESS, MASSES)
    steps = [
        ct.Frequency(modes=3),
        ct.ModalDynamic(period=0.5, increments=20, loads=[NodalForce([3], 0, 0.2)]),
        ct.Dynamic(period=0.5, increments=400, scheme=scheme, new_loads=True),
    ]
    last = ct.solve(model, steps, fields=False).frames[-1]

    def load(t):
        return np.array([0.0, 0.0, 0.2 * (t < 0.5)])

    exact = linear_motion(k, m, np.zeros((3, 3)), load, 1.0, [0.5])
    np.testing.assert_allclose(last.U[1:, 0], exact[:3], atol=1e-3 * abs(exact[:3]).max())
    np.testing.assert_allclose(last.V[1:, 0], exact[3:], atol=5e-3 * abs(exact[3:]).max())


@pytest.mark.parametrize("second", [*IMPLICIT, "central_difference"])
@pytest.mark.parametrize("first", [*IMPLICIT, "central_difference"])
def test_schemes_follow_each_other(first, second):
    # A spring pendulum in large motion changes its scheme half way.
    k, length, m, g = 50.0, 1.0, 2.0, 9.81

    def rate(_, z):
        r = np.hypot(z[0], z[1])
        return [z[2], z[3], *(-k * (r - length) * z[:2] / r / m + np.array([0.0, -g]))]

    exact = integrate(rate, [0.0, -length, 4.0, 0.0], 1.0)
    model = network([[0.0, 0.0], [0.0, -length]], [[0, 1]])
    bars(model, [0], k, length)
    model.point_mass([1], m)
    model.fix([0])
    model.force([1], y=-m * g)
    model.velocity([1], x=4.0)
    steps = [ct.Dynamic(period=0.5, increments=100, scheme=s) for s in (first, second)]
    frame = ct.solve(model, steps, fields=False).frames[-1]
    found = np.r_[frame.U[1] + [0.0, -length], frame.V[1, :2]]
    np.testing.assert_allclose(found, exact, rtol=0, atol=3e-3)


@pytest.mark.parametrize("turned", [0.0, 1.1])
def test_frequency_of_a_rigid_pendulum_about_a_turned_state(turned):
    # Dead weights at the particles: w^2 I = g times the height of the pivot over the center, as it
    # stands; a torsion spring on the pivot holds the turned body in equilibrium.
    model, x, m = wheel(masses=(1.0, 2.0, 0.5))
    points, cells = model.mesh.points, list(model.mesh.cells)
    cells.append(Cells("point1", np.array([[0]]), np.array([9])))
    model = ct.Model(Mesh(points, cells, model.mesh.node_labels))
    bars(model, [0, 1], 1.0, 1.0)
    g, kt = 9.81, 60.0
    for i in range(3):
        model.point_mass([i + 1], m[i])
    model.rigid([1, 2, 3], 0)
    model.spring([2], kt, "rotation")
    model.fix([0])

    def at(phi):
        return x @ [[math.cos(phi), math.sin(phi)], [-math.sin(phi), math.cos(phi)]]

    moment = kt * turned + g * m @ at(turned)[:, 0]
    loads = [NodalForce([i + 1], 1, -m[i] * g) for i in range(3)]
    loads.append(NodalForce([0], 2, moment))
    results = ct.solve(model, [ct.Static(increments=10, loads=loads), ct.Frequency(modes=1)])
    np.testing.assert_allclose(results.frames[-1].UR[0], turned, atol=1e-8)
    square = (kt - g * m @ at(turned)[:, 1]) / (m @ (x**2).sum(axis=1))
    found = 2 * np.pi * results.modes[-1].factors[0]
    np.testing.assert_allclose(found, math.sqrt(square), rtol=1e-6)


def test_harmonic_turning_of_a_rigid_base():
    # A rigid arm turns by theta exp(i w t) about its pivot; a particle hangs on its end by a spring
    # across: m x'' = k (a theta - x). The moment on the pivot is k a times the
    # lengthening of the spring.
    a, k, m, theta = 0.8, 40.0, 1.5, 0.01
    model = network([[0, 0], [0, a], [1, a], [0, 0.5 * a]], [[1, 2], [1, 3]])
    bars(model, [0], k, 1.0)
    bars(model, [1], 1.0, 1.0)
    model.rigid([1, 3], 0)
    model.point_mass([2], m)
    model.fix([0])
    model.fix([2], x=None)
    table_free = ct.Frequency(modes=1, supports=[Fixed([0], 2)])
    steady = ct.SteadyState(
        lowest=0.2,
        highest=0.7,
        points=5,
        supports=[Fixed([0], 2, theta)],
    )
    frames = [f for f in ct.solve(model, [table_free, steady]).frames if f.step == 2]
    for frame in frames:
        w = 2 * math.pi * frame.time
        # The arm points up: a positive turn moves its end to the left.
        exact = -k * a * theta / (k - m * w**2)
        np.testing.assert_allclose(frame.U[2, 0], exact, rtol=1e-6)
        np.testing.assert_allclose(frame.RF[0, 2], k * a * (a * theta + exact), rtol=1e-5)


def test_buckling_by_heating_and_by_moving_a_support():
    # A clamped-clamped beam buckles at the strain 4 pi^2 I/(A L^2): by alpha dT, or by a support
    # that moves by strain times length.
    n, length, young, inertia, area, alpha = 40, 2.0, 2e5, 1e-6, 1e-2, 1.2e-5
    strain = 4 * math.pi**2 * inertia / (area * length**2)
    for heated in (True, False):
        points = [[i * length / n, 0.0] for i in range(n + 1)]
        model = network(points, [[i, i + 1] for i in range(n)])
        model.beam(
            list(range(n)),
            material=ct.Elastic(E=young, expansion=alpha),
            area=area,
            inertia=inertia,
        )
        if heated:
            model.fix([0, n], rotation=True)
            model.temperature(10.0)
            unit = alpha * 10.0
        else:
            model.fix([0], rotation=True)
            model.fix([n], x=-1e-5, rotation=True)
            unit = 1e-5 / length
        found = ct.solve(model, ct.Buckle(modes=1)).modes[-1]
        np.testing.assert_allclose(found.factors[0] * unit, strain, rtol=8e-3)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_sudden_heating_of_a_bar(scheme):
    # k = EA/L and a particle: heated at once, x = alpha dT L (1 - cos w t); the account is closed.
    k, m, alpha, heat, length = 50.0, 2.0, 1e-3, 30.0, 1.0
    model = network([[0.0, 0.0], [length, 0.0]], [[0, 1]])
    model.truss([0], material=ct.Elastic(E=k * length, rho=LIGHT, expansion=alpha), area=1.0)
    model.point_mass([1], m)
    model.fix([0])
    model.fix([1], x=None)
    model.temperature(heat)
    frame = ct.solve(model, ct.Dynamic(period=1.1, increments=400, scheme=scheme)).frames[-1]
    w = math.sqrt(k / m)
    np.testing.assert_allclose(
        frame.U[1, 0], alpha * heat * length * (1 - math.cos(w * 1.1)), rtol=3e-3
    )
    assert abs(frame.scalars["energy balance error"]) < 5e-3


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_automatic_increments_see_a_short_pulse(scheme):
    # A pulse of 5 ms within a second, increments free: the particle leaves with the impulse.
    m, force = 2.0, 400.0
    model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
    bars(model, [0], 1e-9, 1.0)
    model.fix([1])
    model.point_mass([0], m)
    table(model, "pulse", [0.0, 0.5, 0.502, 0.505, 0.507], [0.0, 0.0, 1.0, 1.0, 0.0])
    model.force([0], x=0.0, y=force, amplitude="pulse")
    results = ct.solve(model, ct.Dynamic(period=1.0, scheme=scheme), fields=False)
    impulse = force * 0.005
    np.testing.assert_allclose(results.frames[-1].V[0, 1], impulse / m, rtol=1e-2)
    np.testing.assert_allclose(results.frames[-1].U[0, 1], impulse / m * 0.4965, rtol=1e-2)


def test_mode_of_a_mass_on_a_distributing_coupling():
    # The reference node with mass M follows the mean of two particles on springs k1, k2, at its
    # middle: u_r = (u1 + u2)/2 across the line.
    k, m, heavy = [30.0, 70.0], [1.0, 1.5], 2.5
    model = network([[0, 0], [2, 0], [0, 1], [2, 1], [1, 0]], [[0, 2], [1, 3], [0, 1]])
    bars(model, [0], k[0], 1.0)
    bars(model, [1], k[1], 1.0)
    bars(model, [2], 10.0, 2.0)
    model.point_mass([0], m[0])
    model.point_mass([1], m[1])
    model.point_mass([4], heavy)
    model.couple([0, 1], 4, kind="distributing")
    model.fix([0, 1], y=None)
    model.fix([2, 3])
    found = ct.solve(model, ct.Frequency(modes=2)).modes[-1]
    mass = np.diag(m) + heavy / 4 * np.ones((2, 2))
    exact = np.sqrt(linalg.eigvalsh(np.diag(k), mass))
    np.testing.assert_allclose(2 * np.pi * found.factors, exact, rtol=1e-7)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_rigid_rotor_on_springs_whirls_by_its_unbalance(scheme):
    # A disc of mass m and inertia I on springs k has an off-center particle mu at r and spins
    # freely from W: Lagrange's equations of x, y and phi.
    k, m, inertia, mu, r, spin, end = 300.0, 4.0, 0.5, 0.3, 0.4, 12.0, 1.2

    def rate(_, z):
        x, v = z[:3], z[3:]
        c, s = math.cos(x[2]), math.sin(x[2])
        matrix = np.array(
            [
                [m + mu, 0.0, -mu * r * s],
                [0.0, m + mu, mu * r * c],
                [-mu * r * s, mu * r * c, inertia + mu * r**2],
            ]
        )
        w2 = v[2] ** 2
        force = np.array([-k * x[0] + mu * r * w2 * c, -k * x[1] + mu * r * w2 * s, 0.0])
        return np.r_[v, np.linalg.solve(matrix, force)]

    exact = integrate(rate, [0.0, 0.0, 0.0, 0.0, 0.0, spin], end)
    points = [[0.0, 0.0], [r, 0.0], [9.0, 9.0]]
    model = network(points, [[1, 2]], [0, 0])
    bars(model, [0], LIGHT, 10.0)
    model.spring([1], k, "x")
    model.spring([2], k, "y")
    model.fix([2])
    model.point_mass([0], m, inertia=inertia)
    model.point_mass([1], mu)
    model.rigid([1], 0)
    model.velocity([0, 1], spin=spin)

    def run(n):
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        return np.r_[frame.U[0], frame.UR[0], frame.V[0]]

    found = extrapolated(run, 60)
    np.testing.assert_allclose(found[:3], exact[:3], rtol=0, atol=1e-2)
    np.testing.assert_allclose(found[3:], exact[3:], rtol=0, atol=1e-1)


@pytest.mark.parametrize("element", ["Q4", "Q8", "Q4D"])
def test_tie_of_unlike_meshes_in_modes(element):
    # Two halves of a bar (roller supports, nu = 0) tied at unlike cells: c/(4 L) for one fixed end.
    kind = CELL[element]
    left = ct.mesh.rectangle(1.0, 0.5, nx=16, ny=2, cell=kind)
    right = ct.mesh.rectangle(1.0, 0.5, nx=18, ny=3, cell=kind, origin=(1.0, 0.0))
    mesh = ct.mesh.assembly(a=left, b=right)
    model = ct.Model(mesh)
    rubber = ct.Elastic(E=400.0, nu=0.0, rho=4.0)
    model.section(np.arange(mesh.n_cells), element=element, material=rubber, thickness=0.5)
    model.tie("b.left", "a.right")
    model.fix("a.left", rotation=True if element == "Q4D" else None)
    for side in ("a.bottom", "b.bottom"):
        model.fix(side, x=None)
    found = ct.solve(model, ct.Frequency(modes=3)).modes[-1]
    along = [f for f, s in zip(found.factors, found.shapes, strict=True) if np.ptp(s[:, 0]) > 0.5]
    assert any(math.isclose(f, 10.0 / 8.0, rel_tol=2e-3) for f in along)


# --- more constraints, loads that follow, and stored numbers ------------------------------------


@pytest.mark.parametrize("scheme", IMPLICIT)
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


@pytest.mark.parametrize("scheme", IMPLICIT)
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


@pytest.mark.parametrize("scheme", IMPLICIT)
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


@pytest.mark.parametrize("scheme", IMPLICIT)
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
