"""Paths, limit points and buckling of trusses, links and rings, against closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest
from scipy import linalg

import corota as ct
from corota.model.loads import Fixed, NodalForce
from support.audits import CELL
from support.particles import (
    IMPLICIT,
    LIGHT,
    bars,
    column,
    extrapolated,
    integrate,
    network,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


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
