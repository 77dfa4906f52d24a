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
from corota.model.loads import Amplitude, Fixed, NodalForce

IMPLICIT = ["newmark", "hht", "generalized_alpha", "energy_momentum"]
pytestmark = pytest.mark.filterwarnings("ignore:central differences took")
LIGHT = 1e-13  # density of lines that carry point masses


def network(points, lines=(), dots=()):
    """Model of two-node lines and single points, by node indices."""
    points = np.asarray(points, float)
    cells = []
    if len(lines):
        cells.append(Cells("line2", np.asarray(lines, np.int64), np.arange(1, len(lines) + 1)))
    if len(dots):
        numbers = np.arange(len(lines) + 1, len(lines) + len(dots) + 1)
        cells.append(Cells("point1", np.asarray(dots, np.int64).reshape(-1, 1), numbers))
    return ct.Model(Mesh(points, cells, np.arange(1, len(points) + 1)))


def bars(model, cells, stiffness, length, density=LIGHT):
    """Trusses with the axial stiffness EA/L."""
    model.truss(cells, material=ct.Elastic(E=stiffness * length, rho=density), area=1.0)


def table(model, name, time, value, **options):
    model.amplitudes[name] = Amplitude(np.asarray(time, float), np.asarray(value, float), **options)


def extrapolated(run, increments):
    """Richardson's extrapolation of a result of second order."""
    return (4.0 * run(2 * increments) - run(increments)) / 3.0


def integrate(rate, state, end, breaks=()):
    """State at the end, with restarts where the right-hand side is not smooth."""
    times = [0.0, *[t for t in breaks if 0.0 < t < end], end]
    for start, stop in zip(times, times[1:], strict=False):
        state = solve_ivp(rate, (start, stop), state, method="DOP853", rtol=1e-11, atol=1e-12).y[
            :, -1
        ]
    return state


def lagrange(positions, masses, potential, q, qd, end):
    """Integrate Lagrange's equations of particles x(q) under V(q), by complex steps."""
    q, n = np.asarray(q, float), len(q)
    masses = np.repeat(masses, 2)

    def jacobian(at):
        h = 1e-30
        return np.array([positions(at + 1j * h * e).ravel().imag / h for e in np.eye(n)]).T

    def rate(_, z):
        at, v = z[:n], z[n:]
        jac = jacobian(at)
        h = 1e-6
        turned = (jacobian(at + h * v) - jacobian(at - h * v)) @ v / (2 * h)
        force = -np.array([potential(at + 1e-30j * e).imag / 1e-30 for e in np.eye(n)])
        matrix = jac.T @ (masses[:, None] * jac)
        return np.r_[v, np.linalg.solve(matrix, force - jac.T @ (masses * turned))]

    return integrate(rate, np.r_[q, qd], end)


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

    found = extrapolated(run, 100)
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

    np.testing.assert_allclose(extrapolated(run, 60), exact, rtol=0, atol=1e-3)


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
    model.equation((1, "x", 1.0), (0, "theta", r))
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

    np.testing.assert_allclose(extrapolated(run, 80), exact[:4], rtol=0, atol=2e-3)


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
        found = extrapolated(lambda n, s=scheme: run(n, s), 30)
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


def chain(stiffness, masses):
    """Particles on the x axis, each joined to the one before it, the first to a support."""
    n = len(masses)
    model = network([[float(i), 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)])
    for i in range(n):
        bars(model, [i], stiffness[i], 1.0)
        model.point_mass([i + 1], masses[i])
        model.fix([i + 1], x=None)
    model.fix([0])
    return model


def chain_matrices(stiffness, masses):
    k = np.zeros((len(masses) + 1,) * 2)
    for i, s in enumerate(stiffness):
        k[i : i + 2, i : i + 2] += s * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return k[1:, 1:], np.diag(masses), -k[1:, 0]


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
    model.spring([4], kt, "theta")
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
    model.spring([1], kt, "theta")
    model.spring([2], 1e-9, "theta")
    model.point_mass([0], 1.0, inertia=i1)
    model.point_mass([1], 1.0, inertia=i2)
    model.fix([0, 1])
    model.equation((1, "theta", 1.0), (0, "theta", 3.0))
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
