# SPDX-License-Identifier: BSD-3-Clause
"""Second audit, stability: linear buckling, paths and branches.

References: characteristic equations of beams, closed forms of bars and rigid links.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import linalg
from scipy.optimize import brentq

import corota as ct
from corota.model.loads import Fixed, NodalForce
from support.particles import bars, network


def polyline(points, n, springs=()):
    """Beams of EI = 1, EA = 1e6 along straight legs of n each; corners at multiples of n."""
    points = np.asarray(points, float)
    nodes = [points[0]]
    for a, b in zip(points, points[1:], strict=False):
        nodes += [a + (b - a) * (i + 1) / n for i in range(n)]
    count = len(nodes) - 1
    model = network(nodes, [[i, i + 1] for i in range(count)], list(springs))
    return model, count


def flexible(model, cells, bending=1.0, stretch=1e6):
    model.beam(cells, material=ct.Elastic(E=stretch), area=1.0, inertia=bending / stretch)


def extrapolated(run, n):
    return (4 * run(2 * n) - run(n)) / 3


def factor(model, modes=1):
    return ct.solve(model, ct.Buckle(modes=modes)).modes[-1].factors


# --- columns -------------------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", [2.0, 4.0])
@pytest.mark.parametrize("share", [0.25, 0.5])
def test_stepped_column(ratio, share):
    # Clamped below with EI `ratio`, on top EI 1: tan(k1 a) tan(k2 b) = k2 / k1 ... (Timoshenko and
    # Gere, 2.14): k1 tan-free form EI1 k1 tan(...)= derived with w = d (1 - cos k1 x) below.
    def run(n):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0]], n)
        lower = round(n * share)
        flexible(model, list(range(lower)), bending=ratio)
        flexible(model, list(range(lower, count)))
        model.fix([0], rotation=True)
        model.force([n], y=-1.0)
        return factor(model)[0]

    def condition(p):
        # below: w = d (1 - cos k1 x); above: w = d - B sin(k2 (1 - x)); w and w' at x = share
        k1, k2 = math.sqrt(p / ratio), math.sqrt(p)
        a, b = share, 1 - share
        return k1 * math.sin(k1 * a) * math.sin(k2 * b) - k2 * math.cos(k1 * a) * math.cos(k2 * b)

    grid = np.linspace(0.1, 12.0, 500)
    values = [condition(p) for p in grid]
    i = next(i for i in range(499) if values[i] * values[i + 1] < 0)
    np.testing.assert_allclose(
        extrapolated(run, 8), brentq(condition, grid[i], grid[i + 1]), rtol=2e-4
    )


@pytest.mark.parametrize("stiff", [5.0, 50.0])
def test_column_with_a_lateral_spring_on_top(stiff):
    # Clamped below, elastic support at the top: tan kL = kL (1 - P / (c L)).
    def run(n):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0]], n, [n])
        flexible(model, list(range(count)))
        model.spring([count], stiff, "x")
        model.fix([0], rotation=True)
        model.force([n], y=-1.0)
        return factor(model)[0]

    def condition(k):
        return math.sin(k) - k * (1 - k**2 / stiff) * math.cos(k)

    grid = np.linspace(1.0, 4.49, 400)
    values = [condition(k) for k in grid]
    i = next(i for i in range(399) if values[i] * values[i + 1] < 0)
    exact = brentq(condition, grid[i], grid[i + 1]) ** 2
    np.testing.assert_allclose(extrapolated(run, 8), exact, rtol=2e-4)


@pytest.mark.parametrize("stiff", [2.0, 20.0])
def test_column_on_a_rotational_spring(stiff):
    # Elastic foot, free top: k tan k = c L / EI.
    def run(n):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0]], n, [0])
        flexible(model, list(range(count)))
        model.spring([count], stiff, "rotation")
        model.fix([0])
        model.force([n], y=-1.0)
        return factor(model)[0]

    exact = brentq(lambda k: k * math.tan(k) - stiff, 1e-3, math.pi / 2 - 1e-9) ** 2
    np.testing.assert_allclose(extrapolated(run, 8), exact, rtol=2e-4)


@pytest.mark.parametrize("stiff", [100.0, 300.0])
def test_column_braced_in_the_middle(stiff):
    # Pinned at both ends, spring in the middle: symmetric mode below 16 pi^2 EI/L^3, else two half
    # waves; the symmetric one by w = A sin kx + B x: c = 4 P / L (1 - ...): Ritz in sines.
    def run(n):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0]], n, [n // 2])
        flexible(model, list(range(count)))
        model.spring([count], stiff, "x")
        model.fix([0])
        model.fix([n], y=None)
        model.force([n], y=-1.0)
        return factor(model)[0]

    k = np.arange(1, 600) * math.pi
    sines = np.sin(k / 2)
    values = linalg.eigh(
        np.diag(0.5 * k**4) + stiff * np.outer(sines, sines),
        np.diag(0.5 * k**2),
        eigvals_only=True,
        subset_by_index=[0, 0],
    )
    np.testing.assert_allclose(extrapolated(run, 8), values[0], rtol=4e-4)


def test_column_over_two_unequal_spans():
    # Pinned at 0, 0.4 and 1: three moments, the stability functions of both spans.
    def run(n):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0]], n)
        flexible(model, list(range(count)))
        model.fix([0])
        model.fix([round(0.4 * n), n], y=None)
        model.force([n], y=-1.0)
        return factor(model)[0]

    def condition(p):
        k = math.sqrt(p)

        def turn(length):  # rotation at the joint by a unit moment there
            b = k * length
            return (1 / length - k / math.tan(b)) / p

        return turn(0.4) + turn(0.6)

    grid = np.linspace(10.0, 60.0, 4000)
    values = np.array([condition(p) for p in grid])
    i = next(i for i in range(3999) if values[i] * values[i + 1] < 0 and abs(values[i]) < 1.0)
    exact = brentq(condition, grid[i], grid[i + 1])
    np.testing.assert_allclose(extrapolated(run, 10), exact, rtol=5e-4)


@pytest.mark.parametrize("slender", [0.3, 0.1])
def test_column_that_shears(slender):
    # Pinned: 1 / P = 1 / P_Euler + 1 / kGA (Engesser 1889), where the shear force is across the
    # turned axis, or P (1 + P / kGA) = P_Euler (Haringx 1942), where across the turned section. The
    # frame of these beams is their chord: Engesser.
    young, nu, depth = 1e4, 0.0, slender
    area, inertia, kappa = depth, depth**3 / 12, 5 / 6

    def run(n):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0]], n)
        material = ct.Elastic(E=young, nu=nu)
        model.beam(
            list(range(count)),
            material=material,
            area=area,
            inertia=inertia,
            shear_area=kappa * area,
        )
        model.fix([0])
        model.fix([n], y=None)
        model.force([n], y=-1.0)
        return factor(model)[0]

    euler, shear = math.pi**2 * young * inertia, kappa * young / 2 * area
    exact = euler / (1 + euler / shear)
    strain = exact / (young * area)
    np.testing.assert_allclose(extrapolated(run, 10), exact, rtol=1e-3 + 2.5 * strain)


def test_two_columns_side_by_side_have_a_double_factor():
    # Two equal cantilevers under one load each: multiplicity two; a third, shorter one follows.
    n = 8
    points, cells = [], []
    for i, height in enumerate((1.0, 1.0, 0.8)):
        first = len(points)
        points += [[float(i), height * j / n] for j in range(n + 1)]
        cells += [[first + j, first + j + 1] for j in range(n)]
    model = network(points, cells)
    flexible(model, list(range(3 * n)))
    model.fix([0, n + 1, 2 * n + 2], rotation=True)
    model.force([n, 2 * n + 1, 3 * n + 2], y=-1.0)
    found = factor(model, 4)
    exact = (math.pi / 2) ** 2
    np.testing.assert_allclose(found[0], found[1], rtol=1e-8)
    np.testing.assert_allclose(found[:3], [exact, exact, exact / 0.64], rtol=4e-3)
    np.testing.assert_allclose(found[3], 9 * exact, rtol=3e-2)


def test_column_pressed_on_a_rigid_wall_with_friction():
    # A strip stands against a wall that holds its end by friction alone: clamped and guided by the
    # press: 4 pi^2 EI/L^2 between both, about the preloaded state, as far as the wall stays shut.
    thin, n = 0.02, 40
    mesh = ct.mesh.rectangle(1.0, thin, nx=n, ny=1, cell="quad8")
    model = ct.Model(mesh)
    model.section("all", element="Q8", material=ct.Elastic(E=1e6, nu=0.0))
    wall = ct.RigidCurve.line((1.0, -5.0), (1.0, 5.0))
    model.contact("right", wall, friction=0.8, name="wall")
    model.fix("left", y=None)
    model.fix([int(np.argmin(np.hypot(*(mesh.points - [0.0, thin / 2]).T)))], x=None)
    euler = 4 * math.pi**2 * 1e6 * thin**3 / 12
    shorten = 0.5 * euler / (1e6 * thin)
    steps = [
        ct.Static(supports=[Fixed("left", 0, shorten)]),
        ct.Buckle(modes=1, supports=[Fixed("left", 0, shorten)]),
    ]
    found = ct.solve(model, steps).modes[-1].factors[0]
    # half of the load is there; each further unit of the factor adds another half
    np.testing.assert_allclose(found, 1.0, rtol=0.02)


# --- frames --------------------------------------------------------------------------------------


@pytest.mark.parametrize("feet", ["clamped", "pinned"])
@pytest.mark.parametrize("sway", [True, False])
def test_square_portal_frame(feet, sway):
    # Slope deflection with stability functions: legs with P, a beam of the same EI and length.
    def stability(p):  # s, c s of a leg of unit length under p
        k = math.sqrt(p)
        d = 2 * (1 - math.cos(k)) - k * math.sin(k)
        s = k * (math.sin(k) - k * math.cos(k)) / d
        sc = k * (k - math.sin(k)) / d
        return s, sc

    def determinant(p):
        s, sc = stability(p)
        if not sway:  # joints turn against each other: beam 2 EI/L
            if feet == "clamped":
                return s + 2.0
            return s - sc**2 / s + 2.0
        # joints turn alike: beam 6 EI/L; sway t: leg moments s a - (s + sc) t
        if feet == "clamped":
            a = np.array([[s + 6.0, -(s + sc)], [-(s + sc), 2 * (s + sc) - p]])
            return np.linalg.det(a)
        full = np.array(
            [
                [s, sc, -(s + sc)],
                [sc, s + 6.0, -(s + sc)],
                [-(s + sc), -(s + sc), 2 * (s + sc) - p],
            ]
        )
        return np.linalg.det(full)

    low, high = {
        ("clamped", True): (2.0, 9.8),
        ("pinned", True): (0.5, 2.4),
        ("clamped", False): (20.3, 38.0),
        ("pinned", False): (10.0, 19.0),
    }[feet, sway]
    exact = brentq(determinant, low, high)

    def run(n):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]], n)
        flexible(model, list(range(count)))
        model.fix([0, 3 * n], rotation=True if feet == "clamped" else None)
        model.force([n, 2 * n], y=-1.0)
        if not sway:
            model.fix([n], y=None)
        return factor(model)[0]

    np.testing.assert_allclose(extrapolated(run, 6), exact, rtol=1e-3)


def test_triangle_of_hinged_bars_buckles_in_its_strut():
    # A truss of beams whose joints are pinned by equations: the strut's Euler load by statics.
    n = 8
    # legs: strut from the origin to the top along the diagonal, tie from the right to the top
    points = [[i / n, i / n] for i in range(n + 1)] + [[1.0, i / n] for i in range(n + 1)]
    cells = [[i, i + 1] for i in range(n)] + [[n + 1 + i, n + 2 + i] for i in range(n)]
    model = network(points, cells)
    flexible(model, list(range(2 * n)))
    for dof in ("x", "y"):
        model.equation((2 * n + 1, dof, 1.0), (n, dof, -1.0))
    model.fix([0, n + 1])
    # the load pushes the joint so that the tie has no force: along the strut
    model.force([n], x=-math.sqrt(0.5), y=-math.sqrt(0.5))
    np.testing.assert_allclose(factor(model)[0], math.pi**2 / 2, rtol=1.5e-2)


# --- paths ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["arc", "displacement", "follow"])
def test_link_on_an_inclined_spring_is_asymmetric(kind):
    # A rigid link of length 1 held by a spring at 45 degrees from its top (Koiter): on one side the
    # load falls from the critical k / 2, on the other it rises.  P sin f = spring's moment.
    k, length = 20.0, 1.0

    def load(f):
        top = np.array([math.sin(f), math.cos(f)])
        anchor = np.array([-1.0, 0.0])
        d = top - anchor
        r = np.hypot(*d)
        force = -k * (r - math.sqrt(2)) * d / r
        # moment about the pivot of load and spring
        moment = top[0] * force[1] - top[1] * force[0]
        return moment / top[0]

    model = network([[0.0, 0.0], [0.0, 1.0], [-1.0, 0.0]], [[2, 1], [0, 1]])
    bars(model, [0], k, math.sqrt(2))
    bars(model, [1], 1e-9, 1.0)
    model.rigid([1], 0)
    model.fix([0, 2])
    model.force([1], y=-1.0)
    end = 0.3 if kind == "arc" else -0.3
    path = ct.ArcLength(displacement=([1], "x", end), switch=True, side=1 if end > 0 else -1)
    if kind != "arc":
        path = ct.ArcLength(displacement=([1], "x", end), switch=True, side=-1, shape="spherical")
    results = ct.solve(model, ct.Static(path=path, max_increments=200))
    first = results.critical_points[0]
    assert first.kind == "bifurcation"
    np.testing.assert_allclose(first.factor, k / 2 * length, rtol=1e-6)
    last = results.frames[-1]
    np.testing.assert_allclose(last.U[1, 0], end, rtol=1e-8)
    np.testing.assert_allclose(last.factor, load(math.asin(end)), rtol=1e-6)


@pytest.mark.parametrize("element", ["beam", "Q8"])
def test_clamped_shallow_arch_snaps(element):
    # A clamped circular arch under a point load at its crown: Schreyer and Masur (1966) give
    # closed forms; here the energy method with the buckled shapes as a check of symmetry only: both
    # limit points by an own Ritz series for the shallow arch, w' in the strain to second order.
    rise, half, depth = 0.05, 1.0, 0.02
    young = 1e6
    area, inertia = depth, depth**3 / 12
    span = 2 * half

    # own: y0 = rise (1 - (x/half)^2), clamped Ritz functions 1 - cos 2 j pi (x + half) / span
    count = 12
    x = np.linspace(-half, half, 4001)
    j = np.arange(1, count + 1)[:, None]
    arg = 2 * j * np.pi * (x + half) / span
    slopes = 2 * j * np.pi / span * np.sin(arg)
    bends = (2 * j * np.pi / span) ** 2 * np.cos(arg)
    radius = (half**2 + rise**2) / (2 * rise)
    base = -x / np.sqrt(radius**2 - x**2)
    weight = np.full(len(x), x[1] - x[0])
    weight[[0, -1]] /= 2
    kb = young * inertia * (bends * weight) @ bends.T
    ks = (slopes * weight) @ slopes.T
    g = (slopes * weight) @ base
    crown = 1 - np.cos(2 * j[:, 0] * np.pi * half / span)

    def state(v):  # load and thrust at the deflection v of the crown, by elimination of the rest
        a = np.zeros(count)
        thrust, load = 0.0, 0.0
        for _ in range(200):
            strain = (a @ g + 0.5 * a @ ks @ a) / span
            thrust = young * area * strain
            grad = g + ks @ a
            residual = kb @ a + thrust * grad - load * crown
            k = kb + thrust * ks + young * area / span * np.outer(grad, grad)
            matrix = np.block([[k, -crown[:, None]], [crown[None, :], np.zeros((1, 1))]])
            step = np.linalg.solve(matrix, np.r_[-residual, -v - crown @ a])
            a, load = a + step[:-1], load + step[-1]
            if np.abs(step[:-1]).max() < 1e-13:
                break
        return -load

    drops = np.linspace(0.002, 0.1, 99)
    loads = np.array([state(v) for v in drops])
    upper, lower = loads[: len(loads) // 2].max(), loads[20:].min()

    angle = math.asin(half / radius)
    n = 24
    theta = np.linspace(-angle, angle, n + 1)
    if element == "beam":
        points = np.c_[radius * np.sin(theta), radius * np.cos(theta) - (radius - rise)]
        model = network(points, [[i, i + 1] for i in range(n)])
        material = ct.Elastic(E=young)
        model.beam(list(range(n)), material=material, area=area, inertia=inertia)
        model.fix([0, n], rotation=True)
        model.fix([n // 2], x=0.0, y=None)
        crown_node = n // 2
    else:
        mesh = ct.mesh.rectangle(1.0, 1.0, nx=n, ny=1, cell="quad8")
        t = angle * (2 * mesh.points[:, 0] - 1)
        r = radius + depth * (mesh.points[:, 1] - 0.5)
        mesh = replace(mesh, points=np.c_[r * np.sin(t), r * np.cos(t) - (radius - rise)])
        model = ct.Model(mesh)
        model.section("all", element="Q8", material=ct.Elastic(E=young, nu=0.0))
        model.fix("left")
        model.fix("right")
        high = mesh.points - [0.0, rise + depth / 2]
        crown_node = int(np.argmin(np.hypot(*high.T)))
        model.fix([crown_node], x=0.0, y=None)
    model.force([crown_node], y=-1.0)
    path = ct.ArcLength(displacement=([crown_node], "y", -0.1))
    results = ct.solve(model, ct.Static(path=path, max_increments=200))
    found = [p.factor for p in results.critical_points if p.kind == "limit"]
    assert len(found) == 2
    np.testing.assert_allclose(found, [upper, lower], rtol=0.03)


def test_roorda_frame_asymmetric_branch():
    # Two equal legs at a right angle, hinged feet, load on the corner: the critical load of
    # linear buckling with stability functions, s(P) s'' + 3 = 0: 1.4063 pi^2 EI/L^2... and the
    # path of the frame under a slight moment stays below on one side and goes above on the other.
    def stiff(p):
        k = math.sqrt(p)
        d = 2 * (1 - math.cos(k)) - k * math.sin(k)
        s, sc = k * (math.sin(k) - k * math.cos(k)) / d, k * (k - math.sin(k)) / d
        return s - sc**2 / s + 3.0

    exact = brentq(stiff, 10.5, 19.0)

    def run(n):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]], n)
        flexible(model, list(range(count)))
        model.fix([0, count])
        model.force([n], y=-1.0)
        return factor(model)[0]

    np.testing.assert_allclose(exact / math.pi**2, 1.406, atol=1e-3)
    np.testing.assert_allclose(extrapolated(run, 8), exact, rtol=1.5e-3)
    loads = {}
    for moment in (0.05, -0.05):
        model, count = polyline([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]], 8)
        flexible(model, list(range(count)))
        model.fix([0, count])
        steps = [
            ct.Static(loads=[NodalForce([8], 2, moment)]),
            ct.Static(
                path=ct.ArcLength(displacement=([8], "y", -0.06), increments=60),
                loads=[NodalForce([8], 1, -1.0)],
                max_increments=100,
            ),
        ]
        frames = ct.solve(model, steps).frames
        loads[moment] = max(f.factor for f in frames if f.step == 2)
    low, high = sorted(loads.values())
    assert low < 0.99 * exact
    assert high > 1.02 * exact


def test_lee_frame_beside_the_exact_beam():
    # Lee, Manuel and Rossow 1968, here 10 beams a leg: limit points 1.8545 and -0.93925 of the
    # exact extensible beam (docs); load at a fifth of the upper leg.
    size, young, area, inertia = 120.0, 720.0, 6.0, 2.0
    n = 20
    model, count = polyline([[0.0, 0.0], [0.0, size], [size, size]], n)
    model.beam(list(range(count)), material=ct.Elastic(E=young), area=area, inertia=inertia)
    model.fix([0, count])
    node = n + n // 5
    model.force([node], y=-1.0)
    path = ct.ArcLength(displacement=([node], "y", -90.0))
    results = ct.solve(model, ct.Static(path=path, max_increments=300))
    limits = [p.factor for p in results.critical_points if p.kind == "limit"]
    np.testing.assert_allclose(limits, [1.8545, -0.93925], rtol=1e-2)


def test_truss_tower_with_two_bifurcations_before_its_limit():
    # von Mises truss free to sway, steep: bifurcation before the limit point on the fundamental
    # path; without switching the path goes through both, pivots tell the instability.
    height, half, k = 2.0, 1.0, 500.0
    model = network([[-half, 0.0], [0.0, height], [half, 0.0]], [[0, 1], [1, 2]])
    length = math.hypot(half, height)
    bars(model, [0, 1], k, length)
    model.fix([0, 2])
    model.force([1], y=-1.0)
    path = ct.ArcLength(displacement=([1], "y", -2.2 * height))
    results = ct.solve(model, ct.Static(path=path, max_increments=400))

    def load(v):
        rise = height - v
        now = math.hypot(half, rise)
        return 2 * k * (length - now) * rise / now

    def sway(v):
        rise = height - v
        now = math.hypot(half, rise)
        return half**2 - (length - now) / now * rise**2

    now = (length * half**2) ** (1 / 3)
    rise = math.sqrt(now**2 - half**2)
    limit = 2 * k * (length - now) * rise / now
    grid = np.linspace(0, 2 * height, 4001)
    values = np.array([sway(v) for v in grid])
    at = np.flatnonzero(values[1:] * values[:-1] < 0)
    roots = [brentq(sway, grid[i], grid[i + 1]) for i in at]
    exact = sorted(
        [("bifurcation", v, load(v)) for v in roots]
        + [("limit", height - rise, limit), ("limit", height + rise, -limit)],
        key=lambda row: row[1],
    )
    found = [(p.kind, p.factor) for p in results.critical_points]
    assert [f[0] for f in found] == [e[0] for e in exact]
    np.testing.assert_allclose([f[1] for f in found], [e[2] for e in exact], rtol=1e-5)
    for frame in results.frames[1:]:
        v = -frame.U[1, 1]
        if min(abs(v - e[1]) for e in exact) < 1e-3:
            continue
        stable = sway(v) > 0 and not height - rise < v < height + rise
        assert bool(frame.scalars["stable"]) == stable
