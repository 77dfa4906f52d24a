"""Sequences of steps, tables over them and their energies."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest
from scipy import linalg

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from corota.model.loads import BodyForce, Fixed, NodalForce
from support.audits import CELL
from support.pairs import cover, quickly
from support.particles import (
    IMPLICIT,
    LIGHT,
    MASSES,
    STIFFNESS,
    bars,
    chain,
    chain_matrices,
    extrapolated,
    integrate,
    linear_motion,
    network,
    table,
    wheel,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "hht", "energy_momentum"))
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


@pytest.mark.parametrize(
    ("element", "mass"),
    cover(["Q4", "Q4I", "Q8", "Q9", "T6", "OPT", "Q4D"], ["consistent", "lumped"], strength=1),
)
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


@pytest.mark.parametrize(
    ("between", "scheme"),
    cover(
        ["frequency", "steady"], ["newmark", "energy_momentum", "central_difference"], strength=1
    ),
)
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


@pytest.mark.parametrize(
    ("first", "second"),
    cover([*IMPLICIT, "central_difference"], ["central_difference", *IMPLICIT], strength=1),
)
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


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "generalized_alpha", "energy_momentum"))
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


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "newmark", "energy_momentum"))
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
