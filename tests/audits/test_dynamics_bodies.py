"""Continua and beams in motion, against closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest

import corota as ct
from corota.model.loads import Fixed, NodalForce
from support.audits import CELL
from support.pairs import cover, quickly
from support.particles import (
    IMPLICIT,
    LIGHT,
    bars,
    extrapolated,
    integrate,
    network,
    table,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


@pytest.mark.parametrize(
    ("element", "mass"), cover(list(CELL), ["consistent", "constant", "lumped"], strength=1)
)
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


@pytest.mark.parametrize(
    ("element", "scheme"), cover(["Q4", "Q8", "OPT", "Q4D"], IMPLICIT, strength=1)
)
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


@pytest.mark.parametrize(
    ("element", "mass"),
    cover(
        ["T3", "T6", "Q4", "Q4I", "Q8", "Q9", "OPT", "Q4D"], ["consistent", "lumped"], strength=1
    ),
)
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


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "newmark"))
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


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "generalized_alpha", "energy_momentum"))
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
