# SPDX-License-Identifier: BSD-3-Clause
"""Second audit, time integration: schemes step by step, mechanisms, increments, steps in a row.

References: the schemes written here again, Lagrange's equations, closed forms, SciPy.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import corota as ct
from corota.model.loads import Fixed, NodalForce
from support.pairs import quickly
from support.particles import (
    IMPLICIT,
    LIGHT,
    bars,
    chain,
    chain_matrices,
    integrate,
    lagrange,
    network,
    table,
    without_first_support,
)

pytestmark = [
    pytest.mark.filterwarnings("ignore:central differences took"),
    pytest.mark.filterwarnings("ignore:the increment .* is long for the amplitude"),
]


# --- the schemes, written once more --------------------------------------------------------------


def recursion(scheme, option, k, m, c, load, h, n, u, v):
    """Displacement, velocity and acceleration after n increments of a linear system."""
    acceleration = np.linalg.solve(m, load(0.0) - c @ v - k @ u)
    if scheme == "energy_momentum":  # the mid-point rule
        for i in range(n):
            force = load((i + 0.5) * h) - k @ u - c @ v
            rate = np.linalg.solve(2 * m / h + c + 0.5 * h * k, 2 * m @ v / h + force + c @ v)
            u, v, acceleration = u + h * rate, 2 * rate - v, 2 * (rate - v) / h
        return u, v, acceleration
    if scheme == "central_difference":
        for i in range(n):
            half = v + 0.5 * h * acceleration
            u = u + h * half
            acceleration = np.linalg.solve(m, load((i + 1) * h) - k @ u)
            v = half + 0.5 * h * acceleration
        return u, v, acceleration
    am, af = 0.0, 0.0
    if scheme == "hht":
        af = -option
    elif scheme == "bossak":
        am = option
    elif scheme == "generalized_alpha":
        am, af = (2 * option - 1) / (option + 1), option / (option + 1)
    gamma, beta = 0.5 - am + af, 0.25 * (1 - am + af) ** 2
    filtered = acceleration
    for i in range(n):
        # M (1-am) A1 + M am A0 + (1-af) (C v1 + K u1 - f1) + af (C v0 + K u0 - f0) = 0
        old = load(i * h) - c @ v - k @ u
        u0 = u + h * v + h**2 * (0.5 - beta) * filtered
        v0 = v + h * (1 - gamma) * filtered
        matrix = (1 - am) * m + (1 - af) * (gamma * h * c + beta * h**2 * k)
        right = (1 - af) * (load((i + 1) * h) - c @ v0 - k @ u0) + af * old - am * m @ filtered
        filtered = np.linalg.solve(matrix, right)
        u, v = u0 + beta * h**2 * filtered, v0 + gamma * h * filtered
    return u, v, np.linalg.solve(m, load(n * h) - c @ v - k @ u)


STIFFNESS, MASSES = [100.0, 200.0, 50.0], [1.0, 2.0, 0.5]
VARIANTS = [
    ("newmark", 0.0),
    ("hht", -0.05),
    ("hht", -1 / 3),
    ("bossak", -0.05),
    ("bossak", -0.5),
    ("bossak", -1.0),
    ("generalized_alpha", 0.0),
    ("generalized_alpha", 0.5),
    ("generalized_alpha", 1.0),
    ("energy_momentum", 0.0),
    ("central_difference", 0.0),
]


def dynamic(scheme, option=0.0, **rest):
    name = {"hht": "alpha", "bossak": "alpha", "generalized_alpha": "rho_inf"}.get(scheme)
    return ct.Dynamic(scheme=scheme, **({name: option} if name else {}), **rest)


@pytest.mark.parametrize(("scheme", "option"), VARIANTS)
def test_every_scheme_is_its_recursion_on_a_chain(scheme, option):
    # Long increments, so that numerical damping and the filter of accelerations show; a table
    # with corners between increments, initial velocity, Rayleigh damping and a dashpot.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    h, n = 0.06, 11
    explicit = scheme == "central_difference"
    c = np.zeros((3, 3)) if explicit else 0.3 * m + 0.004 * k
    model = chain(STIFFNESS, MASSES)
    if not explicit:
        model.dashpot(1, x=2.0)
        c[0, 0] += 2.0
    corners, values = [0.0, 2.5 * h, 4 * h, 1.0], [0.4, 1.0, -1.0, 0.2]
    table(model, "push", corners, values)
    model.velocity([3], x=0.7)
    model.force([2], x=5.0, amplitude="push")

    def load(t):
        return np.array([0.0, 5.0 * np.interp(t, corners, values), 0.0])

    rayleigh = (0.0, 0.0) if explicit else (0.3, 0.004)
    step = dynamic(scheme, option, period=n * h, increments=n, rayleigh=rayleigh, tolerance=1e-12)
    frame = ct.solve(model, step).frames[-1]
    u, v, a = recursion(scheme, option, k, m, c, load, h, n, np.zeros(3), np.array([0.0, 0.0, 0.7]))
    np.testing.assert_allclose(frame.U[1:, 0], u, rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(frame.V[1:, 0], v, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(frame.A[1:, 0], a, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize(("scheme", "option"), VARIANTS)
def test_every_scheme_under_a_moved_support_is_its_recursion(scheme, option):
    # The support is a force k1 b(t) on the chain, by springs only: its own inertia has no part.
    k, m, to_base = chain_matrices(STIFFNESS, MASSES)
    h, n = 0.05, 9
    c = np.zeros((3, 3))
    times = np.linspace(0.0, n * h, n + 1)
    moves = 0.1 * (1 - np.cos(7.0 * times))
    model = without_first_support(chain(STIFFNESS, MASSES))
    table(model, "base", times, moves)
    model.fix([0], x=1.0, y=None, amplitude="base")

    def load(t):
        return to_base * np.interp(t, times, moves)

    frame = ct.solve(
        model, dynamic(scheme, option, period=n * h, increments=n, tolerance=1e-12)
    ).frames[-1]
    u, v, a = recursion(scheme, option, k, m, c, load, h, n, np.zeros(3), np.zeros(3))
    np.testing.assert_allclose(frame.U[1:, 0], u, rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(frame.V[1:, 0], v, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(frame.A[1:, 0], a, rtol=1e-7, atol=1e-7)
    if scheme != "energy_momentum":
        np.testing.assert_allclose(frame.RF[0, 0], 100.0 * (moves[-1] - u[0]), rtol=1e-8)


@pytest.mark.parametrize("mass", ["consistent", "constant", "lumped"])
@pytest.mark.parametrize("element", ["T3", "Q4", "Q4S", "Q8", "Q9", "T6", "OPT", "Q4D"])
def test_momenta_from_the_first_increment(element, mass):
    # Gravity and a force on a free body at rest: momentum is impulse, and in the first instant
    # angular momentum is the moment of the loads, whatever the element does with its mass.
    cell = {"T3": "tri3", "OPT": "tri3", "T6": "tri6", "Q8": "quad8", "Q9": "quad9"}
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=2, cell=cell.get(element, "quad4"))
    model = ct.Model(mesh)
    material = ct.Elastic(E=5000.0, nu=0.3, rho=3.0)
    model.section("all", element=element, material=material, thickness=0.5)
    model.gravity(x=1.0, y=-2.0)
    model.force("right", x=6.0)
    end = 2e-3
    step = ct.Dynamic(period=end, increments=2, scheme="newmark", mass=mass)
    scalars = ct.solve(model, step).frames[-1].scalars
    coupled = element in ("OPT", "Q4D") and mass == "consistent"  # mass that turns with the frame
    tolerance = 1e-5 if coupled else 1e-9
    np.testing.assert_allclose(scalars["momentum x"], end * (3.0 + 6.0), rtol=tolerance)
    np.testing.assert_allclose(scalars["momentum y"], -end * 6.0, rtol=tolerance)
    moment = 3.0 * (1.0 * -2.0 - 0.5 * 1.0) - 6.0 * 0.5
    np.testing.assert_allclose(scalars["angular momentum"], end * moment, rtol=1e-5)


# --- mechanisms ----------------------------------------------------------------------------------


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "energy_momentum"))
def test_double_pendulum_of_rigid_bodies(scheme):
    # Two rigid bodies, each with a center that carries mass and inertia, hinged by equations
    # between a dependent node and the reference node of the next body. Lagrange by SciPy.
    m1, j1, m2, j2, g = 1.5, 0.2, 0.8, 0.05, 9.81
    arm = np.array([0.7, -0.1])  # hinge of the second body, from the first pivot
    c1, c2 = np.array([0.4, 0.1]), np.array([0.3, 0.2])  # centers, from their pivots

    def turn(angle, d):
        s, c = np.sin(angle), np.cos(angle)
        return np.array([c * d[0] - s * d[1], s * d[0] + c * d[1]])

    def positions(q):  # pairs of particles stand for the inertias
        r1, r2 = math.sqrt(j1 / m1), math.sqrt(j2 / m2)
        first, second = turn(q[0], c1), turn(q[0], arm) + turn(q[1], c2)
        e1, e2 = turn(q[0], [r1, 0.0]), turn(q[1], [r2, 0.0])
        return np.array([first + e1, first - e1, second + e2, second - e2])

    def potential(q):
        return g * (m1 * turn(q[0], c1)[1] + m2 * (turn(q[0], arm) + turn(q[1], c2))[1])

    masses = np.array([m1, m1, m2, m2]) / 2
    end = 0.8
    exact = lagrange(positions, masses, potential, [0.0, 0.0], [1.0, -3.0], end)

    # nodes: pivot 0, center 1, hinge of body one 2, reference of body two 3, its center 4
    points = np.array([[0.0, 0.0], c1, arm, arm, arm + c2])
    model = network(points, [[1, 2], [0, 4]])
    bars(model, [0, 1], 1e-9, 1.0)
    model.rigid([1, 2], 0)
    model.rigid([4], 3)
    for dof in ("x", "y"):
        model.equation((3, dof, 1.0), (2, dof, -1.0))
    model.point_mass([1], m1)
    model.point_mass([4], m2)
    model.point_mass([0], LIGHT, inertia=j1)
    model.point_mass([3], LIGHT, inertia=j2)
    model.force([1], y=-m1 * g)
    model.force([4], y=-m2 * g)
    model.fix([0])
    model.velocity([0], spin=1.0)
    model.velocity([1, 2], spin=1.0)
    hinge = np.array([-arm[1], arm[0]])
    model.velocity([3], x=hinge[0], y=hinge[1], spin=-3.0, about=tuple(arm))
    model.velocity([4], x=hinge[0], y=hinge[1], spin=-3.0, about=tuple(arm))

    def run(n):
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        return np.r_[frame.UR[[0, 3]], frame.V[[0, 3], 2]]

    fine, coarse = run(50), run(25)
    np.testing.assert_allclose((4 * fine - coarse) / 3, exact, rtol=0, atol=2e-2)


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "generalized_alpha", "energy_momentum"))
def test_atwood_machine_with_a_heavy_pulley(scheme):
    # a = (m1 - m2) g / (m1 + m2 + J/R^2), constant, over a turn: Newmark's relations are exact; the
    # conserving step has its rule for angles in equations.
    m1, m2, radius, inertia, g, end = 3.0, 2.0, 0.2, 0.05, 9.81, 1.3
    points = [[0.0, 0.0], [radius, -1.0], [-radius, -1.0], [0.0, radius]]
    model = network(points, [[1, 2], [0, 3]])
    bars(model, [0, 1], 1e-9, 1.0)
    model.rigid([3], 0)
    model.point_mass([0], 1.0, inertia=inertia)
    model.point_mass([1], m1)
    model.point_mass([2], m2)
    model.force([1], y=-m1 * g)
    model.force([2], y=-m2 * g)
    model.fix([1, 2], y=None)
    model.fix([0])
    model.equation((1, "y", 1.0), (0, "rotation", -radius))
    model.equation((2, "y", 1.0), (0, "rotation", radius))

    def run(n):
        frame = ct.solve(model, ct.Dynamic(period=end, increments=n, scheme=scheme)).frames[-1]
        return np.r_[frame.U[1, 1], frame.UR[0], frame.V[2, 1], frame.A[0, 2], frame.RF[0, 1]]

    conserving = scheme == "energy_momentum"
    found = (4 * run(160) - run(80)) / 3 if conserving else run(40)
    fall = (m1 - m2) * g / (m1 + m2 + inertia / radius**2)
    drop = 0.5 * fall * end**2
    exact = [-drop, -drop / radius, fall * end, -fall / radius, 0.0]
    tolerance = 1e-3 if conserving else 1e-7
    np.testing.assert_allclose(found, exact, rtol=tolerance, atol=1e-6)


@pytest.mark.parametrize("rate", [0.5, 2.0])
def test_bead_on_a_driven_arm(rate):
    # r'' = w^2 r on a straight line turned steadily about its end: r0 cosh wt, up to 40 degrees;
    # the start is on the move.
    end = 0.7 / rate
    times = np.linspace(0.0, end, 41)
    model = network([[0.0, 0.0], [3.0, 0.0], [1.0, 0.0]], [[0, 1]])
    bars(model, [0], 1e-9, 3.0)
    model.rigid([1], 0)
    model.straight([2], 0, 1)
    model.point_mass([2], 1.7)
    table(model, "turn", times, rate * times)
    model.fix([0], rotation=1.0, amplitude="turn")
    model.velocity(spin=rate)

    def run(n):
        frame = ct.solve(model, ct.Dynamic(period=end, increments=n), fields=False).frames[-1]
        place = frame.U[2] + [1.0, 0.0]
        return np.r_[np.hypot(*place), math.atan2(place[1], place[0]), frame.RF[0, 2]]

    found = (4 * run(40) - run(20)) / 3
    r = math.cosh(0.7)
    moment = 1.7 * 2 * rate**2 * math.sinh(0.7) * r  # m r 2 w r'
    np.testing.assert_allclose(found, [r, 0.7, moment], rtol=1e-4)


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "newmark"))
def test_ladder_between_a_floor_and_a_springy_wall(scheme):
    # A rigid bar slides on the floor at its foot and leans on a spring at its head: two
    # coordinates, Lagrange by SciPy; the floor carries m (g + y'').
    m, inertia, length, g, stiff, end = 2.0, 0.3, 1.4, 9.81, 400.0, 0.5
    start = math.radians(70.0)
    r = math.sqrt(inertia / m)

    def positions(q):
        center = np.array([q[0] + 0.5 * length * np.cos(q[1]), 0.5 * length * np.sin(q[1])])
        arm = r * np.array([np.cos(q[1]), np.sin(q[1])])
        return np.array([center + arm, center - arm])

    head = length * math.cos(start)

    def potential(q):
        reach = q[0] + length * np.cos(q[1]) - head
        return m * g * 0.5 * length * np.sin(q[1]) + 0.5 * stiff * reach**2

    exact = lagrange(positions, np.array([m, m]) / 2, potential, [0.0, start], [0.0, 0.0], end)
    foot, top = np.array([0.0, 0.0]), length * np.array([math.cos(start), math.sin(start)])
    model = network([foot, 0.5 * top, top], [[0, 2]], [2])
    bars(model, [0], 1e-9, length)
    model.spring([1], stiff, "x")
    model.rigid([1, 2], 0)
    model.point_mass([1], m)
    model.point_mass([0], LIGHT, inertia=inertia)
    model.force([1], y=-m * g)
    model.fix([0], x=None)

    def run(n):
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        floor = frame.RF[0, 1] - (m * (g + frame.A[1, 1]) if scheme != "energy_momentum" else 0.0)
        return np.r_[frame.U[0, 0], frame.UR[0], frame.V[0, [0, 2]], floor]

    found = (4 * run(60) - run(30)) / 3
    exact[1] -= start
    np.testing.assert_allclose(found[:4], exact, rtol=0, atol=4e-3)
    if scheme != "energy_momentum":
        assert abs(found[4]) < 1e-7


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "generalized_alpha"))
def test_spin_dies_by_a_dashpot_on_the_rotation(scheme):
    # J w' = -c w: w0 exp(-c t / J), with the reference node off the center and pinned there; the
    # dashpot takes all energy that goes.
    m, d, inertia, c, spin, end = 2.0, 0.6, 0.4, 1.5, 9.0, 0.9
    model = network([[0.0, 0.0], [d, 0.0], [0.0, d]], [[1, 2]])
    bars(model, [0], 1e-9, d * math.sqrt(2))
    model.rigid([1, 2], 0)
    model.point_mass([1], m)
    model.point_mass([0], 1.0, inertia=inertia)
    model.dashpot(0, rotation=c)
    model.fix([0])
    model.velocity(spin=spin)
    total = inertia + m * d**2

    def run(n):
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step).frames[-1]
        s = frame.scalars
        return np.r_[frame.UR[0], frame.V[0, 2], s["ALLVD"], s["ALLKE"], s["angular momentum"]]

    found = (4 * run(80) - run(40)) / 3
    now = spin * math.exp(-c * end / total)
    kinetic = 0.5 * total * np.array([spin**2, now**2])
    exact = [(spin - now) * total / c, now, kinetic[0] - kinetic[1], kinetic[1], total * now]
    # What the conserving step carries on swings a little: its energies are of that.
    rest = 8e-3 if scheme == "energy_momentum" else 3e-4
    np.testing.assert_allclose(found, exact, rtol=rest)
    np.testing.assert_allclose(found[[0, 1, 4]], np.array(exact)[[0, 1, 4]], rtol=5e-4)


@pytest.mark.parametrize(
    "scheme",
    quickly([*IMPLICIT, "central_difference"], "hht", "energy_momentum", "central_difference"),
)
def test_parallelogram_linkage_of_stiff_bars(scheme):
    # Coupler on two equal cranks: all of its points move alike, so it is one particle on a circle
    # of the cranks' length, whatever the inertia of the coupler. Elastic bars, by Lagrange too.
    g, m, stiff, end = 9.81, 1.0, 4e4, 0.6
    base = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, -0.8], [1.0, -0.8]])
    swing = 2.5

    def rate(_, z):
        x = np.vstack([base[:2], z[:4].reshape(2, 2)])
        force = np.tile([0.0, -m * g], (2, 1))
        for a, b in ((0, 2), (1, 3), (2, 3)):
            d = x[b] - x[a]
            r, rest = np.hypot(*d), np.hypot(*(base[b] - base[a]))
            pull = stiff * (r - rest) * d / r
            if a > 1:
                force[a - 2] += pull
            force[b - 2] -= pull
        return np.r_[z[4:], force.ravel() / m]

    exact = integrate(rate, np.r_[base[2:].ravel(), swing, 0.0, swing, 0.0], end)

    def run(n):
        model = network(base, [[0, 2], [1, 3], [2, 3]])
        for i, length in enumerate((0.8, 0.8, 1.0)):
            bars(model, [i], stiff, length)
        model.point_mass([2, 3], m)
        model.force([2, 3], y=-m * g)
        model.fix([0, 1])
        model.velocity([2, 3], x=swing)
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        return (frame.U[2:] + base[2:]).ravel()

    n = 300 if scheme == "central_difference" else 60
    found = (4 * run(2 * n) - run(n)) / 3
    np.testing.assert_allclose(found, exact[:4], rtol=0, atol=6e-3)


@pytest.mark.parametrize(
    "scheme",
    quickly([*IMPLICIT, "central_difference"], "newmark", "energy_momentum", "central_difference"),
)
def test_particle_between_springs_that_yield_no_more(scheme):
    # A spring of pieces, constant outside: force table against elongation, with a soft middle.
    # Energy of the spring by its table; work of the force in the account.
    pairs = np.array([[-0.4, -30.0], [-0.1, -2.0], [0.1, 2.0], [0.5, 30.0]])
    m, push, end = 1.5, 18.0, 1.4

    def spring(x):
        return np.interp(x, pairs[:, 0], pairs[:, 1])

    # integrate exactly enough by many restarts-free small steps
    def rate(_, z):
        return [z[1], (push - spring(z[0])) / m]

    exact = solve_ivp(rate, (0, end), [0.0, -2.0], rtol=1e-10, atol=1e-12, max_step=1e-3).y[:, -1]

    def run(n):
        model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]], [1])
        bars(model, [0], 1e-9, 1.0)
        model.spring([1], pairs, "x")
        model.point_mass([1], m)
        model.force([1], x=push)
        model.fix([0])
        model.fix([1], x=None)
        model.velocity([1], x=-2.0)
        frame = ct.solve(model, ct.Dynamic(period=end, increments=n, scheme=scheme)).frames[-1]
        s = frame.scalars
        return np.r_[frame.U[1, 0], frame.V[1, 0], s["ALLWK"], s["ALLSE"]]

    found = run(400)
    x = np.linspace(0.0, exact[0], 20001)
    s = spring(x)
    stored = np.sum(0.5 * (s[1:] + s[:-1]) * np.diff(x))
    np.testing.assert_allclose(found, [*exact, push * exact[0], stored], rtol=2e-3, atol=2e-3)


# --- increments and steps ------------------------------------------------------------------------


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_error_of_automatic_increments_follows_the_tolerance(scheme):
    # A pendulum on a spring: a tighter tolerance costs increments and buys accuracy in proportion;
    # half of the points a fixed run would need is the least that is required here.
    k, length, m = 80.0, 1.0, 1.0

    def rate(_, z):
        r = np.hypot(z[0], z[1])
        return [z[2], z[3], *(-k * (r - length) * z[:2] / r / m + np.array([0.0, -9.81]))]

    exact = integrate(rate, [length, 0.0, 0.0, 0.0], 1.5)
    errors, counts = [], []
    for tolerance in (1e-2, 1e-3, 1e-4):
        model = network([[0.0, 0.0], [length, 0.0]], [[0, 1]])
        bars(model, [0], k, length)
        model.point_mass([1], m)
        model.force([1], y=-9.81)
        model.fix([0])
        step = ct.Dynamic(period=1.5, scheme=scheme, error_tolerance=tolerance, max_increments=5000)
        frames = ct.solve(model, step, fields=False).frames
        errors.append(np.abs(frames[-1].U[1] + [length, 0.0] - exact[:2]).max())
        counts.append(len(frames))
    assert counts[0] < counts[1] < counts[2]
    assert errors[2] < errors[1] < errors[0] < 0.2
    assert errors[2] < 5e-3


@pytest.mark.parametrize(("scheme", "option"), quickly(VARIANTS, *VARIANTS[::2]))
def test_a_motion_cut_into_steps(scheme, option):
    # Three steps under held loads are one: to rounding where the scheme has no memory but u, v
    # and a; the filter of accelerations starts again, an error of second order.
    k, length, m = 60.0, 1.0, 2.0

    def run(parts, n):
        model = network([[0.0, 0.0], [length, 0.0]], [[0, 1]])
        bars(model, [0], k, length)
        model.point_mass([1], m)
        model.force([1], y=-m * 9.81)
        model.fix([0])
        model.velocity([1], y=1.0)
        steps = [
            dynamic(scheme, option, period=p, increments=round(p * n), tolerance=1e-12)
            for p in parts
        ]
        frame = ct.solve(model, steps).frames[-1]
        s = frame.scalars
        return np.r_[
            frame.U[1], frame.V[1, :2], frame.A[1, :2], frame.RF[0, :2], s["ALLWK"], s["ALLSE"]
        ]

    once, cut = run([0.8], 100), run([0.2, 0.35, 0.25], 100)
    memory = scheme == "generalized_alpha" or (scheme in ("hht", "bossak") and option != 0.0)
    np.testing.assert_allclose(cut, once, rtol=0, atol=0.05 if memory else 1e-7)
    if memory:
        coarse = np.abs(run([0.2, 0.35, 0.25], 100) - once)[:4].max()
        fine = np.abs(run([0.2, 0.35, 0.25], 200) - run([0.8], 200))[:4].max()
        assert fine < 0.35 * coarse or coarse < 1e-9


@pytest.mark.parametrize("scheme", [*IMPLICIT, "central_difference"])
def test_load_that_ends_with_its_step(scheme):
    # Push for a quarter of the period, then go free: the amplitude of the free vibration is
    # (F/k) 2 sin(w t1 / 2).
    k, m, push = 90.0, 2.5, 4.0
    w = math.sqrt(k / m)
    first, second = 0.25 * 2 * math.pi / w, 1.1
    model = chain([k], [m])
    steps = [
        ct.Dynamic(period=first, increments=60, scheme=scheme, loads=[NodalForce([1], 0, push)]),
        ct.Dynamic(period=second, increments=120, scheme=scheme, new_loads=True),
    ]
    results = ct.solve(model, steps)
    last = results.frames[-1]
    u = push / k * (math.cos(w * second) - math.cos(w * (first + second)))
    np.testing.assert_allclose(last.U[1, 0], u, atol=2e-4)
    energy = last.scalars["ALLKE"] + last.scalars["ALLSE"]
    np.testing.assert_allclose(energy, push**2 / k, rtol=2e-3)
    np.testing.assert_allclose(last.scalars["ALLWK"], push**2 / k, rtol=2e-3)
    # the acceleration jumps with the load at the seam; the frame there holds the state under load
    seam = [f for f in results.frames if f.step == 1][-1]
    if scheme != "energy_momentum":
        np.testing.assert_allclose(seam.A[1, 0], (push - k * seam.U[1, 0]) / m, rtol=1e-6)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_released_support_lets_go(scheme):
    # A stretched spring is let go by a step that takes the support away (`new_supports`): free
    # vibration of two particles about their center.
    k, m1, m2, pull = 70.0, 1.0, 3.0, 0.2
    model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
    bars(model, [0], k, 1.0)
    model.point_mass([0], m1)
    model.point_mass([1], m2)
    end = 0.9
    steps = [
        ct.Static(supports=[Fixed([0, 1], 1), Fixed([0], 0), Fixed([1], 0, pull)]),
        ct.Dynamic(
            period=end,
            increments=120,
            scheme=scheme,
            new_supports=True,
            supports=[Fixed([0, 1], 1)],
        ),
    ]
    frame = ct.solve(model, steps).frames[-1]
    w = math.sqrt(k / m1 + k / m2)
    stretch = pull * math.cos(w * end)
    center = m2 * pull / (m1 + m2)
    exact = [center - m2 * stretch / (m1 + m2), center + m1 * stretch / (m1 + m2)]
    np.testing.assert_allclose(frame.U[:, 0], exact, atol=6e-4)
    np.testing.assert_allclose(frame.scalars["momentum x"], 0.0, atol=1e-8)


def test_stable_increment_of_bars():
    # Lumped mass: w = 2/L sqrt(E/rho) of the highest mode of many equal bars, h = L/c; a given
    # increment above is refused with that number, one below is taken.
    n, length, stiff, rho = 40, 0.25, 4.0, 1.0
    model = network([[i * length, 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)])
    model.truss(list(range(n)), material=ct.Elastic(E=stiff, rho=rho), area=0.3)
    model.fix([0])
    model.fix(list(range(1, n + 1)), x=None)
    limit = length / math.sqrt(stiff / rho)
    model.force([n], x=0.01)
    with pytest.raises(ct.CorotaError) as caught:
        ct.solve(
            model,
            ct.Dynamic(
                period=1.0, increments=round(1 / (1.2 * limit)), scheme="central_difference"
            ),
        )
    assert "stable" in str(caught.value)
    free = ct.solve(model, ct.Dynamic(period=2.0, scheme="central_difference"))
    steps = [f.scalars["dt"] for f in free.frames[1:]]
    assert 0.8 * limit < max(steps) <= limit * 1.001
    # the wave has passed ten bars by 10 L / c: d'Alembert, v = F c / EA behind the front
    exact = 0.01 * 2.0 / (4.0 * 0.3)
    behind = next(f for f in free.frames if f.time > 1.9)
    np.testing.assert_allclose(behind.V[n - 3, 0], exact, rtol=0.1)
