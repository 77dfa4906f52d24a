# SPDX-License-Identifier: BSD-3-Clause
"""Second audit, contact in motion: friction, impact, pressure laws, modes, other frames.

References: laws of rigid bodies and of waves in bars, integrations by SciPy, another frame.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

import corota as ct
from corota.mesh.data import Cells
from support.models import cell
from support.pairs import cover, quickly
from support.particles import table

IMPLICIT = ["newmark", "hht", "generalized_alpha", "energy_momentum"]
DAMPED = ["hht", "generalized_alpha", "energy_momentum"]
pytestmark = [
    pytest.mark.filterwarnings("ignore:.*energy"),
    pytest.mark.filterwarnings("ignore:the increment .* is long for the amplitude"),
]


def turned(mesh, angle, shift=(0.0, 0.0)):
    s, c = math.sin(angle), math.cos(angle)
    return replace(mesh, points=mesh.points @ np.array([[c, s], [-s, c]]) + shift)


def floor(angle=0.0, **options):
    s, c = math.sin(angle), math.cos(angle)
    return ct.RigidCurve.line((-50 * c, -50 * s), (90 * c, 90 * s), **options)


def block(element="Q4I", angle=0.0, width=2.0, height=0.5, nx=2, ny=2, springs=0.0, **material):
    """A block of unit density on the x axis, turned about the origin; springs to the ground."""
    mesh = turned(ct.mesh.rectangle(width, height, nx=nx, ny=ny, cell=cell(element)), angle)
    n = mesh.n_cells
    middle = np.flatnonzero(np.abs(mesh.points[:, 1] - height / 2) < 1e-9)
    if springs:
        dots = Cells("point1", middle.reshape(-1, 1), np.arange(101, 101 + len(middle)))
        mesh = replace(mesh, cells=[*mesh.cells, dots])
    model = ct.Model(mesh)
    options = {"E": 1e5, "nu": 0.0, "rho": 1.0, **material}
    model.section(list(range(n)), element=element, material=ct.Elastic(**options))
    if springs:
        model.spring(list(range(n, n + len(middle))), springs / len(middle), "x")
    return model


def center_x(frame):
    return frame.U[:, 0].mean()


# --- friction ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("element", "scheme"), cover(["Q4I", "Q8", "T3", "Q4D"], DAMPED, strength=1)
)
def test_braking_block(scheme, element):
    # While all of the sole slips, momentum along is that of the start less mu times the impulse
    # of the floor, m g t + p_y, whatever the block's vibration. It stops after v^2 / (2 mu g).
    mu, g, v = 0.4, 10.0, 1.2
    model = block(element)
    model.contact("bottom", floor(), friction=mu, name="floor")
    model.gravity(y=-g)
    model.velocity(x=v)
    stop = v / (mu * g)
    frames = ct.solve(model, ct.Dynamic(period=1.4 * stop, increments=56, scheme=scheme)).frames
    for frame in frames[1:]:
        if frame.time < 0.8 * stop:
            s = frame.scalars
            exact = v - mu * (g * frame.time + s["momentum y"])
            np.testing.assert_allclose(s["momentum x"], exact, atol=0.01 * v)
    last = frames[-1]
    np.testing.assert_allclose(center_x(last), v**2 / (2 * mu * g), rtol=0.03)
    assert abs(last.scalars["momentum x"]) < 0.03 * v
    np.testing.assert_allclose(last.scalars["ALLFD"], 0.5 * v**2, rtol=0.04)


@pytest.mark.parametrize(
    ("scheme", "slope"), cover(DAMPED, [(0.3, 0.1), (0.3, 0.5), (-0.4, 0.2)], strength=1)
)
def test_block_on_an_incline(scheme, slope):
    # Slides with g (sin - mu cos), or stays.
    (angle, mu), g, end = slope, 10.0, 0.4
    model = block(angle=angle)
    model.contact("bottom", floor(angle), friction=mu, name="floor")
    model.gravity(y=-g)
    frame = ct.solve(model, ct.Dynamic(period=end, increments=60, scheme=scheme)).frames[-1]
    along = frame.U @ [math.cos(angle), math.sin(angle)]
    drive = abs(math.sin(angle)) - mu * math.cos(angle)
    exact = 0.5 * g * max(drive, 0.0) * end**2 * -math.copysign(1.0, angle)
    np.testing.assert_allclose(along.mean(), exact, atol=0.01)


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_block_on_a_shaken_table(scheme):
    # The table accelerates at a for a while; the block follows at mu g until both are equally fast.
    mu, g, a, until, end = 0.3, 10.0, 5.0, 0.2, 0.4
    mesh = ct.mesh.rectangle(2.0, 0.5, nx=2, ny=2)
    carrier = ct.mesh.add_node(mesh, 0.0, -1.0, "table")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0, rho=1.0))
    line = ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0), reference=carrier)
    model.contact("bottom", line, friction=mu, name="table")
    model.gravity(y=-g)
    times = np.linspace(0.0, end, 81)
    place = np.where(times < until, 0.5 * a * times**2, a * until * (times - 0.5 * until))
    table(model, "shake", times, place)
    model.fix("table", x=1.0, y=0.0, rotation=True, amplitude="shake")
    frames = ct.solve(model, ct.Dynamic(period=end, increments=80, scheme=scheme)).frames
    for frame in frames[1:]:
        fast = min(mu * g * frame.time, a * until)
        np.testing.assert_allclose(frame.scalars["momentum x"], fast, atol=0.03)
    together = a * until / (mu * g)
    way = 0.5 * mu * g * together**2 + a * until * (end - together)
    np.testing.assert_allclose(frames[-1].U[:-1, 0].mean(), way, rtol=0.02)


@pytest.mark.parametrize("scheme", quickly(DAMPED, "hht"))
def test_oscillator_with_coulomb_friction(scheme):
    # Half swings of m x'' = -k x - mu N sign(x') lose 2 mu N / k each; then it sticks.
    mu, preload, k, start = 0.25, 8.0, 60.0, 0.2
    model = block(springs=k)
    model.contact("bottom", floor(), friction=mu, name="floor")
    model.force("top", y=-preload)
    model.velocity(x=start * math.sqrt(k))
    loss = mu * preload / k
    peaks = [math.sqrt(start**2 + loss**2) - loss]
    while peaks[-1] > loss:
        peaks.append(peaks[-1] - 2 * loss)
    frames = ct.solve(model, ct.Dynamic(period=1.9, increments=190, scheme=scheme)).frames
    x = np.array([center_x(f) for f in frames])
    rise = np.sign(np.diff(np.r_[x, x[-1]]))
    turns = np.flatnonzero(rise[1:] * rise[:-1] < 0) + 1
    found = np.abs(x[turns])
    assert len(peaks) == 4
    np.testing.assert_allclose(found[:3], np.abs(peaks[:3]), atol=0.015 * start)
    np.testing.assert_allclose(abs(x[-1]), abs(peaks[3]), atol=0.015 * start)


@pytest.mark.parametrize("scheme", quickly(DAMPED, "energy_momentum"))
def test_block_on_a_belt_sticks_and_slips(scheme):
    # It rides until k x = mu N; then x = mu N / k + (v / w) sin w t, which touches the speed of
    # the belt once a period, and slips on.
    mu, preload, k, v = 0.3, 10.0, 80.0, 0.4
    w, hold = math.sqrt(k), mu * preload / k
    mesh = ct.mesh.rectangle(2.0, 0.5, nx=2, ny=2)
    middle = np.flatnonzero(np.abs(mesh.points[:, 1] - 0.25) < 1e-9)
    n = mesh.n_cells
    mesh = replace(mesh, cells=[*mesh.cells, Cells("point1", middle.reshape(-1, 1), 101 + middle)])
    carrier = ct.mesh.add_node(mesh, 0.0, -1.0, "belt")
    model = ct.Model(mesh)
    model.section(list(range(n)), element="Q4I", material=ct.Elastic(E=1e5, nu=0.0, rho=1.0))
    model.spring(list(range(n, n + len(middle))), k / len(middle), "x")
    line = ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0), reference=carrier)
    model.contact("bottom", line, friction=mu, name="belt")
    model.force("top", y=-preload)
    table(model, "run", [0.0, 10.0], [0.0, 10.0])
    model.fix("belt", x=v, y=0.0, rotation=True, amplitude="run")
    body = np.arange(mesh.n_nodes - 1)
    model.velocity(x=v)
    ride = hold / v
    end = ride + 1.6 * math.pi / w
    frames = ct.solve(model, ct.Dynamic(period=end, increments=150, scheme=scheme)).frames
    for frame in frames[1:]:
        t = frame.time
        x = v * t if t < ride else hold + v / w * math.sin(w * (t - ride))
        np.testing.assert_allclose(frame.U[body, 0].mean(), x, atol=0.02 * hold)
    # the belt's work: mu N v after the ride, k x v before
    work = 0.5 * k * hold**2 + mu * preload * v * (end - ride)
    last = frames[-1].scalars
    pressed = last["belt: force y"]
    np.testing.assert_allclose(last["belt: friction x"], mu * pressed, rtol=1e-3)
    np.testing.assert_allclose(last["ALLWK"], work, rtol=0.06)


# --- impact --------------------------------------------------------------------------------------


def two_bars(first, second, n, gap, friction=0.0, method="mortar", stretch=1600.0):
    """Two bars of the height 0.2 end to end with a gap, the first flies at 1; c = 40."""
    height = 0.2
    a = turned(ct.mesh.rectangle(first, height, nx=n, ny=1), 0.0, (-first - gap, 0.0))
    b = ct.mesh.rectangle(second, height, nx=round(n * second / first), ny=1)
    mesh = ct.mesh.assembly(a=a, b=b)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=stretch, nu=0.0, rho=1.0))
    model.contact("a.right", "b.left", method=method, friction=friction, name="hit")
    left = np.flatnonzero(mesh.points[:, 0] < -0.5 * gap)
    model.velocity(left, x=1.0)
    return model, left


@pytest.mark.parametrize(
    ("scheme", "method"), cover(IMPLICIT, ["mortar", "node_to_segment"], strength=1)
)
def test_collision_of_equal_bars(scheme, method):
    # Waves: both bars exchange their speeds, without vibration, after 2 L / c = 0.05.
    model, left = two_bars(1.0, 1.0, 30, 0.002, method=method)
    results = ct.solve(model, ct.Dynamic(period=0.07, increments=84, scheme=scheme))
    last = results.frames[-1]
    right = np.setdiff1d(np.arange(len(last.U)), left)
    np.testing.assert_allclose(last.scalars["momentum x"], 0.2, rtol=1e-8)
    np.testing.assert_allclose(last.V[left, 0].mean(), 0.0, atol=0.05)
    np.testing.assert_allclose(last.V[right, 0].mean(), 1.0, atol=0.05)
    force = np.array([abs(f.scalars["hit: force x"]) for f in results.frames[1:]])
    times = np.array([f.time for f in results.frames[1:]])
    closed = times[force > 1e-6]
    np.testing.assert_allclose(closed[-1] - closed[0], 0.05, atol=0.006)
    # the force is rho c A v / 2 on the way
    np.testing.assert_allclose(np.median(force[force > 1e-6]), 40.0 * 0.2 / 2, rtol=0.05)
    if scheme == "energy_momentum":
        np.testing.assert_allclose(last.scalars["ETOTAL"], 0.1, rtol=1e-4)


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_collision_of_a_short_bar_with_a_long_one(scheme):
    # The short bar rests after 2 L1 / c, the long one leaves with the momentum: the coefficient of
    # restitution of waves is L1 / L2.
    model, left = two_bars(1.0, 2.0, 24, 0.002)
    frames = ct.solve(model, ct.Dynamic(period=0.07, increments=78, scheme=scheme)).frames
    last = frames[-1]
    right = np.setdiff1d(np.arange(len(last.U)), left)
    np.testing.assert_allclose(last.V[left, 0].mean(), 0.0, atol=0.04)
    np.testing.assert_allclose(last.V[right, 0].mean(), 0.5, atol=0.03)
    np.testing.assert_allclose(last.scalars["momentum x"], 0.2, rtol=1e-8)


@pytest.mark.parametrize("scheme", quickly(DAMPED, "hht", "energy_momentum"))
def test_oblique_collision_keeps_momenta(scheme):
    # Two blocks, one turned, meet with friction in free flight: linear momentum to rounding in
    # all schemes, angular momentum too in the conserving one; energy only goes into friction.
    a = turned(ct.mesh.rectangle(1.0, 0.6, nx=3, ny=2), 0.4, (0.3, 0.75))
    b = ct.mesh.rectangle(2.0, 0.5, nx=6, ny=2)
    model = ct.Model(ct.mesh.assembly(a=a, b=b))
    model.section("all", element="Q4I", material=ct.Elastic(E=500.0, nu=0.3, rho=1.0))
    model.contact("a.bottom", "b.top", friction=0.3, name="hit")
    upper = np.arange(len(a.points))
    model.velocity(upper, x=0.8, y=-2.0, spin=-1.0, about=(0.7, 1.2))
    results = ct.solve(model, ct.Dynamic(period=0.35, increments=70, scheme=scheme), fields=False)
    first, last = results.frames[1].scalars, results.frames[-1].scalars
    assert any(f.scalars["hit: force y"] > 1.0 for f in results.frames[1:])
    for name in ("momentum x", "momentum y"):
        np.testing.assert_allclose(last[name], first[name], rtol=1e-8)
    tolerance = 1e-9 if scheme == "energy_momentum" else 2e-2
    np.testing.assert_allclose(
        last["angular momentum"], first["angular momentum"], atol=tolerance * 2.0
    )
    assert last["ALLFD"] > 0
    if scheme == "energy_momentum":
        np.testing.assert_allclose(last["ETOTAL"], first["ETOTAL"], rtol=1e-8)


@pytest.mark.parametrize("scheme", ["energy_momentum", "hht"])
def test_bar_that_falls_and_rebounds(scheme):
    # The bar falls by h and turns in T = 2 L / c under the force rho c A (v + g t): it leaves with
    # the speed it came with, its center g T^2 / 6 lower. The instants of contact are those of the
    # increments, so the rest is of first order: two increments' force at most.
    length, g, h, c = 1.0, 10.0, 0.2, 40.0
    mesh = turned(ct.mesh.rectangle(0.2, length, nx=1, ny=24), 0.0, (0.0, h))
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=c**2, nu=0.0, rho=1.0))
    model.contact("bottom", floor(), name="floor")
    model.gravity(y=-g)
    turn, fall = 2 * length / c, math.sqrt(2 * h / g)
    end, n = 2 * fall + turn, 450
    step = ct.Dynamic(period=end, increments=n, scheme=scheme)
    frames = ct.solve(model, step, fields=False).frames
    mass = np.ones(mesh.n_nodes)
    mass[:2] = mass[-2:] = 0.5
    height = mass @ frames[-1].U[:, 1] / mass.sum()
    late = 2 * c / length * math.sqrt(2 * g * h) * end / n  # loss of speed, two increments' force
    np.testing.assert_allclose(height, -g * turn**2 / 6, atol=fall * late)
    force = [f.scalars["floor: force y"] for f in frames[1:]]
    shut = np.array([f.time for f in frames[1:]])[np.array(force) > 1e-6]
    np.testing.assert_allclose(shut[-1] - shut[0], turn, atol=3 * end / n)
    if scheme == "energy_momentum":
        np.testing.assert_allclose(frames[-1].scalars["energy balance"], 0.0, atol=1e-7)


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "newmark", "energy_momentum"))
def test_bounce_on_a_soft_layer(scheme):
    # Pressure law of stiffness K: half a period of m y'' = -K A y in contact; energy in ALLCL.
    width, height, soft, v = 2.0, 0.5, 300.0, 1.0
    model = block(width=width, height=height, E=1e6)
    law = ct.PressureLaw("linear", soft)
    model.contact("bottom", floor(), law=law, name="floor")
    model.velocity(y=-v)
    m = width * height
    w = math.sqrt(soft * width / m)
    duration = math.pi / w
    frames = ct.solve(model, ct.Dynamic(period=1.5 * duration, increments=90, scheme=scheme)).frames
    closed = [f for f in frames[1:] if f.time < duration]
    for frame in closed:
        deep = -v / w * math.sin(w * frame.time)
        np.testing.assert_allclose(frame.U[:, 1].mean(), deep, atol=0.03 * v / w)
    stored = max(f.scalars["ALLCL"] for f in frames)
    np.testing.assert_allclose(stored, 0.5 * m * v**2, rtol=0.02)
    np.testing.assert_allclose(frames[-1].scalars["momentum y"], m * v, rtol=0.02)


# --- modes and harmonic motion over contact ------------------------------------------------------


def resting(friction, law=None):
    model = block(width=2.0, height=1.0, nx=4, ny=2, nu=0.3, E=1000.0)
    model.contact("bottom", floor(), friction=friction, law=law, name="floor")
    return model


def test_modes_over_a_floor_that_holds_by_friction():
    # Closed and sticking: the modes of the block clamped at its sole.
    model = resting(0.6)
    press = ct.Static(loads=[])
    press.force("top", y=-0.02)
    found = ct.solve(model, [press, ct.Frequency(modes=4)]).modes[-1].factors
    clamped = block(width=2.0, height=1.0, nx=4, ny=2, nu=0.3, E=1000.0)
    clamped.fix("bottom")
    exact = ct.solve(clamped, ct.Frequency(modes=4)).modes[-1].factors
    np.testing.assert_allclose(found, exact, rtol=1e-3)


def test_modes_over_a_smooth_floor():
    # Closed without friction: one free motion, along; the others are those of a sole on rollers.
    model = resting(0.0)
    model.fix([0], y=None)
    press = ct.Static()
    press.force("top", y=-0.02)
    rollers = block(width=2.0, height=1.0, nx=4, ny=2, nu=0.3, E=1000.0)
    rollers.fix("bottom", x=None)
    rollers.fix([0], y=None)
    found = ct.solve(model, [press, ct.Frequency(modes=4)]).modes[-1].factors
    exact = ct.solve(rollers, ct.Frequency(modes=4)).modes[-1].factors
    np.testing.assert_allclose(found, exact, rtol=1e-3)


@pytest.mark.parametrize("layer", ["hard", "soft"])
@pytest.mark.parametrize("procedure", ["modes", "direct", "time"])
def test_reaction_of_the_carrier_of_a_floor(layer, procedure):
    # A block stands on a floor by friction, the floor on a held node: that node has the reactions
    # of a block that is clamped.
    def model(kind):
        mesh = ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2)
        carrier = ct.mesh.add_node(mesh, 0.0, -1.0, "carrier") if kind else -1
        m = ct.Model(mesh)
        m.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
        if kind:
            line = ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0), reference=carrier)
            law = ct.PressureLaw("linear", 1e7) if kind == "soft" else None
            m.contact("bottom", line, friction=0.6, law=law, name="floor")
            m.fix("carrier", rotation=True)
        else:
            m.fix("bottom")
        return m

    press = ct.Static()
    press.force("top", y=-0.02)
    if procedure == "time":
        table_of = np.linspace(0.0, 0.4, 41)
        last = ct.ModalDynamic(period=0.4, increments=40)
        last.force("top", x=0.01, amplitude="push")
    else:
        direct = procedure == "direct"
        last = ct.SteadyState(lowest=0.5, highest=0.6, points=2, direct=direct)
        last.force("top", x=0.01)

    def reaction(kind):
        m = model(kind)
        if procedure == "time":
            table(m, "push", table_of, np.sin(4.0 * table_of) ** 2)
        frame = ct.solve(m, [press, ct.Frequency(modes=20), last]).frames[-1]
        return frame.RF[-1, :2] if kind else frame.RF.sum(axis=0)[:2]

    # in time the load across is let go, which rings with the layer
    components = slice(0, 1) if procedure == "time" else slice(0, 2)
    found, exact = reaction(layer)[components], reaction("")[components]
    np.testing.assert_allclose(found, exact, rtol=2e-3)


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_force_on_a_block_over_a_soft_layer(direct):
    # Stiff block on a pressure law and dashpots: F / (K A - m w^2 + i c w).
    width, height, soft, c = 2.0, 0.5, 300.0, 3.0
    model = block(width=width, height=height, E=1e7)
    model.contact("bottom", floor(), law=ct.PressureLaw("linear", soft), name="floor")
    mesh = model.mesh
    for node in np.flatnonzero(np.abs(mesh.points[:, 1] - height) < 1e-9):
        model.dashpot(int(node), y=c / 3)
    model.fix([0], y=None)
    press = ct.Static()
    press.force("top", y=-5.0)
    steady = ct.SteadyState(lowest=2.0, highest=6.0, points=5, direct=direct, loads=[])
    steady.force("top", y=1.0)
    frames = ct.solve(model, [press, ct.Frequency(modes=6), steady]).frames
    frames = [f for f in frames if f.step == 3]
    m, k = width * height, soft * width
    assert len(frames) > 4
    rest = -5.0 / k
    for frame in frames:
        w = 2 * math.pi * frame.scalars["frequency"]
        exact = 1.0 / (k - m * w**2 + 1j * c * w)
        np.testing.assert_allclose(frame.U[:, 1].mean(), rest + exact.real, atol=5e-3 * abs(exact))
        rate = -w * exact.imag
        np.testing.assert_allclose(frame.V[:, 1].mean(), rate, atol=5e-3 * w * abs(exact))


# --- other frames --------------------------------------------------------------------------------


#: Every element with every scheme, one mass for each; quick: every element with one of them.
FRAMES = [
    pytest.param(
        scheme,
        element,
        ["consistent", "constant", "lumped"][(i + j) % 3],
        marks=[pytest.mark.slow] if (i + j) % 4 else [],
    )
    for i, scheme in enumerate(IMPLICIT)
    for j, element in enumerate(
        ["T3", "T6", "Q4", "Q4I", "Q4S", "Q4R", "Q8R", "Q9", "Q4DI", "Q4D", "OPT", "Q8"]
    )
]


@pytest.mark.parametrize(("scheme", "element", "mass"), FRAMES)
def test_rubbing_bodies_seen_from_another_frame(scheme, element, mass):
    # Two blocks pressed together slide on each other with friction, a point mass and damping, in
    # free flight; the same seen from a frame that is turned and drifts.
    def run(angle, drift):
        s, c = math.sin(angle), math.cos(angle)
        q = np.array([[c, -s], [s, c]])
        kind = cell(element)
        a = ct.mesh.rectangle(1.0, 0.5, nx=2, ny=1, cell=kind)
        a = replace(a, points=np.add(a.points, [0.2, 0.5]))
        b = ct.mesh.rectangle(1.5, 0.5, nx=2, ny=1, cell=kind)
        mesh = ct.mesh.assembly(a=a, b=b)
        mesh = replace(mesh, points=mesh.points @ q.T)
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=300.0, nu=0.3, rho=1.0))
        model.contact("a.bottom", "b.top", friction=0.2, name="rub")
        model.point_mass([0], 0.3)
        down, along = q @ [0.0, -6.0], q @ [0.6, 0.1]
        model.force("a.top", x=down[0], y=down[1])
        model.force("b.bottom", x=-down[0], y=-down[1])
        upper = np.arange(len(a.points))
        lower = np.arange(len(a.points), mesh.n_nodes)
        model.velocity(upper, x=along[0] + drift[0], y=along[1] + drift[1])
        still = q @ [0.0, 0.1]
        model.velocity(lower, x=still[0] + drift[0], y=still[1] + drift[1])
        step = ct.Dynamic(
            period=0.1,
            increments=10,
            scheme=scheme,
            mass=mass,
            rayleigh=(0.0, 1e-3),
            tolerance=1e-12,
            max_iterations=30,
        )
        frame = ct.solve(model, step, fields=False).frames[-1]
        u, v = frame.U - np.multiply(drift, 0.1), frame.V[:, :2] - drift
        s = frame.scalars
        return np.r_[(u @ q).ravel(), (v @ q).ravel(), s["ALLFD"], s["ALLVD"], s["rub: area"]]

    here, there = run(0.0, np.zeros(2)), run(0.7, np.array([2.0, -1.0]))
    np.testing.assert_allclose(there, here, rtol=0, atol=1e-8)
    assert here[-3] > 1e-4
