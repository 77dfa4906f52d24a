"""Paths of two-bar trusses, whose load is a formula of their displacement."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

import corota as ct
from corota.analysis.procedures.path.controls import Row
from corota.analysis.procedures.path.tracer import End, PathStalled
from support.trusses import Truss, exact_load, von_mises

#: Newton's tolerance, with room for the scale of the residual.
NEWTON = 1e-8
APEX = Row(np.array([3]), np.ones(1), 0.0)


def apex(value):
    return End(value, APEX)


def test_shallow_limit_load_is_the_textbook_one(follow):
    """.3849 EA (a/L)^3 as a/L goes to zero."""
    rise, half, stiffness = 0.002, 1.0, 3.0
    system = von_mises(rise, half, stiffness)
    system.load = system.load * stiffness * rise**3
    path = follow(system, ends=[apex(-2.2 * rise)])
    limit = next(i for i in path if i.critical)
    load = limit.point.factor * stiffness * rise**3
    assert load == pytest.approx(0.3849002 * stiffness * (rise / half) ** 3, rel=2e-5)


@pytest.mark.parametrize("shape", [False, True])
@pytest.mark.parametrize("first", [1.0, 0.1, 0.001])
def test_the_path_is_the_exact_one_whatever_the_first_increment(follow, first, shape):
    rise = 0.1
    system = von_mises(rise)
    system.load = system.load * 1e-3
    path = follow(system, first=first, spherical=shape, ends=[apex(-2.2 * rise)])
    for increment in path:
        exact = exact_load(rise, -increment.point.u[3]) / 1e-3
        assert increment.point.factor == pytest.approx(exact, abs=NEWTON)
    best = minimize_scalar(
        lambda w: -exact_load(rise, w),
        bounds=(0, rise),
        method="bounded",
        options={"xatol": 1e-13},
    )
    points = [i for i in path if i.critical]
    assert [i.critical.kind for i in points] == ["limit", "limit"]
    assert points[0].point.factor == pytest.approx(-best.fun / 1e-3, rel=NEWTON)
    assert points[1].point.factor == pytest.approx(best.fun / 1e-3, rel=NEWTON)
    assert points[0].point.u[3] == pytest.approx(-best.x, rel=1e-5)
    assert [i.critical.negative for i in points] == [(0, 1), (1, 0)]
    assert path[-1].point.u[3] == pytest.approx(-2.2 * rise, rel=1e-12)


def test_meters_and_millimeters_give_the_same_path(follow):
    """Lengths in another unit: the same increments, to rounding."""
    paths = []
    for size in (1.0, 1e3):
        system = von_mises(0.1, size=size)
        system.load = system.load * 1e-3
        paths.append(follow(system, ends=[apex(-0.22 * size)]))
    assert len(paths[0]) == len(paths[1])
    for one, other in zip(*paths, strict=True):
        assert 1e3 * one.point.u == pytest.approx(other.point.u, rel=1e-7, abs=1e-9)
        assert one.point.factor == pytest.approx(other.point.factor, rel=1e-7)


def test_steep_truss_bifurcates_where_its_sideways_stiffness_vanishes(follow):
    rise = 4.0
    length = np.hypot(1.0, rise)

    def sideways(drop):
        now = np.hypot(1.0, rise - drop)
        c, s = 1.0 / now, (rise - drop) / now
        return c * c / length + (now - length) / length / now * s * s

    drop = brentq(sideways, 0.0, 1.0, xtol=1e-14)
    path = follow(von_mises(rise), ends=[apex(-0.6)])
    points = [i for i in path if i.critical]
    assert len(points) == 1
    critical = points[0].critical
    assert critical.kind == "bifurcation"
    assert critical.negative == (0, 1)
    assert abs(critical.projection) < 1e-9
    assert points[0].point.factor == pytest.approx(exact_load(rise, drop), rel=1e-7)
    assert np.abs(critical.mode) == pytest.approx([0, 0, 1, 0, 0, 0], abs=1e-6)


@pytest.mark.parametrize("side", [1, -1])
def test_the_other_branch_is_entered_to_the_side_asked_for(follow, side):
    """On the branch one bar swings about its foot: equilibrium without symmetry."""
    system = von_mises(4.0)
    path = follow(system, increments=12, switch=True, side=side)
    entered = next(k for k, i in enumerate(path) if i.control == "mode")
    assert path[entered - 1].critical.kind == "bifurcation"
    assert np.sign(path[entered].point.u[2]) == side
    for increment in path[entered:]:
        state = system.evaluate(increment.point.u, increment.point.factor)
        assert np.abs(state.residual[2:4]).max() < NEWTON
        assert abs(increment.point.u[2]) > 1e-3


def test_negative_pivots_are_the_negative_eigenvalues(follow):
    """Random trusses pushed through their limit points."""
    rng = np.random.default_rng(3)
    events = 0
    for _ in range(10):
        n = 5
        joints = np.stack([np.linspace(-1, 1, n), 0.3 - 0.3 * np.linspace(-1, 1, n) ** 2], 1)
        joints += 0.03 * rng.standard_normal((n, 2))
        bars = [(i, i + 1, 1.0) for i in range(n - 1)] + [(i, i + 2, 0.1) for i in range(n - 2)]
        load = np.zeros(2 * n)
        load[5] = -0.01
        system = Truss(joints, bars, [0, 1, 2 * n - 2, 2 * n - 1], load)
        for increment in follow(system, increments=25):
            free = ~system.constrained
            matrix = system.evaluate(increment.point.u, increment.point.factor).matrix
            values = np.linalg.eigvalsh(matrix[np.ix_(free, free)])
            if increment.critical is None:
                assert increment.negative == (values < 0.0).sum()
                continue
            events += 1
            assert np.abs(values).min() < 1e-5 * np.abs(values).max()
            after, before = increment.critical.negative[1], increment.critical.negative[0]
            assert abs(after - before) <= 1
    assert events > 5


def test_moving_supports_are_scaled_by_the_factor(follow):
    """The foot of one bar moves instead of a load; the exact state follows by symmetry."""
    rise = 0.3
    move = np.array([1.0, 0, 0, 0, -1.0, 0])
    joints = [[-1.0, 0.0], [0.0, rise], [1.0, 0.0]]
    system = Truss(joints, [(0, 1, 1.0), (1, 2, 1.0)], [0, 1, 4, 5], np.zeros(6), 0.2 * move)
    for increment in follow(system, ends=[End(1.0)]):
        gap = 1.0 - 0.2 * increment.point.factor
        height = np.sqrt(1.0 + rise**2 - gap**2)
        assert increment.point.u[3] == pytest.approx(height - rise, abs=NEWTON)
    assert increment.point.u[0] == pytest.approx(0.2)


def test_displacement_control_passes_the_limit_point(follow):
    rise = 0.1
    system = von_mises(rise)
    system.load = system.load * 1e-3
    row = Row(np.array([3]), np.ones(1), -0.2 * rise)
    path = follow(system, row=row, ends=[apex(-2.0 * rise)])
    drops = [-i.point.u[3] for i in path if i.critical is None]
    assert np.allclose(np.round(np.diff(drops[-3:]), 12), 0.2 * rise, rtol=1e-6)
    assert path[-1].point.u[3] == pytest.approx(-2.0 * rise)
    for increment in path:
        exact = exact_load(rise, -increment.point.u[3]) / 1e-3
        assert increment.point.factor == pytest.approx(exact, abs=NEWTON)


def soft_column(spring=0.02):
    """Truss loaded through a soft bar: the loaded joint snaps back."""
    joints = [[-1.0, 0.0], [0.0, 0.3], [1.0, 0.0], [0.0, 1.3]]
    bars = [(0, 1, 1.0), (1, 2, 1.0), (1, 3, spring)]
    return Truss(joints, bars, [0, 1, 4, 5, 2, 6], [0, 0, 0, 0, 0, 0, 0, -0.01])


def test_snap_back_is_followed(follow):
    """Load and loaded displacement turn back: the exact path is the sum of two formulas."""
    top = Row(np.array([7]), np.ones(1), 0.0)
    path = follow(soft_column(), ends=[End(-1.5, top)])
    moved = np.array([i.point.u[7] for i in path])
    assert (np.diff(moved) > 1e-3).any()
    for increment in path:
        drop = -increment.point.u[3]
        load = exact_load(0.3, drop)
        assert 0.01 * increment.point.factor == pytest.approx(load, abs=NEWTON)
        assert increment.point.u[7] == pytest.approx(-drop - load / 0.02, abs=1e-6)


def test_displacement_control_hands_over_to_arc_length_at_a_snap_back(follow):
    top = Row(np.array([7]), np.ones(1), -0.1)
    path = follow(soft_column(), row=top, ends=[End(-1.5, top)])
    assert {"displacement", "arc"} <= {i.control for i in path}
    assert path[-1].point.u[7] == pytest.approx(-1.5)
    for increment in path:
        load = exact_load(0.3, -increment.point.u[3])
        assert 0.01 * increment.point.factor == pytest.approx(load, abs=NEWTON)


def test_iterations_converge_quadratically(follow):
    """The last residuals of an increment fall with order two."""
    from corota.analysis.newton import Settings
    from corota.analysis.path_system import Point
    from corota.analysis.procedures.path.controls import Arc
    from corota.analysis.procedures.path.corrector import correct

    system = soft_column()
    base = follow(system, increments=2)[-1]
    size = 0.5
    u = base.point.u + size * base.tangent.u
    factor = base.point.factor + size * base.tangent.factor
    radius = float(np.linalg.norm(size * base.tangent.u))
    start = Point(base.point.u, base.point.factor, None)
    arc = Arc(radius, system.counted)
    guess = Point(u, factor, None)
    done = correct(system, start, guess, 1.0, arc, Settings(tolerance=1e-13))
    sizes = np.array([s for s in done.sizes if s > 1e-12])
    orders = np.log(sizes[2:] / sizes[1:-1]) / np.log(sizes[1:-1] / sizes[:-2])
    assert len(sizes) >= 3
    assert orders[-1] > 1.7


def test_a_failed_attempt_leaves_nothing_behind(follow):
    """Attempts are committed once, when they are accepted."""
    system = von_mises(0.1)
    system.load = system.load * 1e-3
    path = follow(system, first=5.0, ends=[apex(-0.22)])
    assert any(i.attempts > 1 for i in path)
    assert system.commits == len(path)


def test_fixed_increments_are_not_cut(follow):
    system = von_mises(0.1)
    system.load = system.load * 1e-3
    evaluate = system.evaluate

    def broken(u, time):
        state = evaluate(u, time)
        if abs(u[3]) > 0.03:
            state.internal[:] = np.nan
        return state

    system.evaluate = broken
    with pytest.raises(PathStalled, match="DIRECT"):
        follow(system, fixed=True, first=0.2, ends=[apex(-0.22)])


ENDS = [{"stop_at_limit": True}, {"displacement": ("corner_1", "y", -1.5)}, {"increments": 40}]


@pytest.mark.parametrize("end", ENDS)
def test_a_path_with_a_named_end_passes_the_load_of_the_step(end):
    """A third of the limit load of two bars, 2 EA (1 - cos a / cos t) sin t at cos^3 t = cos a."""
    rise, half = 1.5, 10.0
    model = ct.Model(ct.mesh.line([(-half, 0.0), (0.0, rise), (half, 0.0)], 1))
    model.truss("all", material=ct.Elastic(E=1000.0), area=1.0)
    model.fix("start")
    model.fix("end")
    limit = 2000.0 * (1.0 - np.cos(np.arctan(rise / half)) ** (2.0 / 3.0)) ** 1.5
    model.force("corner_1", y=-limit / 3.0)
    results = ct.solve(model, ct.Static(path=ct.ArcLength(**end)), threads=1)
    point = next(p for p in results.critical_points if p.kind == "limit")
    assert point.factor == pytest.approx(3.0, rel=1e-6)
    if "stop_at_limit" in end:
        assert results.frames[-1].factor == point.factor
