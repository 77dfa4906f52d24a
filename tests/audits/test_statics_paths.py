"""Paths, limit loads and buckling under heat, pressure and preload, against answers found apart."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from corota.model.loads import Fixed, Temperature
from support.audits import CELL, line_mesh, rotation

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


@pytest.mark.parametrize("preload", [0.0, 1.5])
def test_shallow_truss_with_a_preload_kept(preload: float) -> None:
    """Snap-through of two bars with engineering strain; a dead preload of an earlier step stays.

    F(v) = 2 EA (L - l)/L (h - v)/l; a later load on the same node replaces the preload.
    """
    EA, a, h = 1000.0, 2.0, 0.5
    L = math.hypot(a, h)

    def force(v: float) -> float:
        long = math.hypot(a, h - v)
        return 2 * EA * (L - long) / L * (h - v) / long

    grid = np.linspace(0.0, h, 20001)
    peak = max(force(v) for v in grid)
    mesh = line_mesh([[-a, 0.0], [0.0, h], [a, 0.0]], [(0, 1), (1, 2)])
    model = ct.Model(mesh)
    model.truss([0, 1], material=ct.Elastic(E=EA / 0.5), area=0.5)
    model.fix([0, 2])
    from corota.model.loads import NodalForce

    steps = []
    if preload:
        steps.append(ct.Static(loads=[NodalForce([1], 1, -preload)]))
    path = ct.ArcLength(displacement=([1], "y", -1.2 * h))
    steps.append(
        ct.Static(loads=[NodalForce([1], 0, 0.0), NodalForce([1], 1, -4.0 - preload)], path=path)
    )
    results = ct.solve(model, steps, threads=1)
    first = next(c for c in results.critical_points if c.kind == "limit")
    # The factor leads from the old value to the new.
    assert preload + 4.0 * first.factor == pytest.approx(peak, rel=1e-6)
    for f in results.frames:
        v = -f.U[1, 1]
        if f.increment:
            total = preload * (f.factor if f.step == 1 and preload else 1.0)
            if f.step == len(steps):
                total = preload + 4.0 * f.factor
            assert total == pytest.approx(force(v), rel=1e-6, abs=1e-6)


def test_thermal_buckling_of_a_clamped_beam_with_preload() -> None:
    """alpha T EA + N0 = 4 pi^2 EI/L^2 for beams; a compressive preload lowers the factor.

    Preload by an earlier step that moves an end; the moved end is then held.
    """
    n, L, E, A, inertia, alpha = 80, 2.0, 2e4, 0.01, 1e-6, 1e-5
    x = np.linspace(0, L, n + 1)
    mesh = line_mesh(np.column_stack([x, 0 * x]), [(i, i + 1) for i in range(n)])
    critical = 4 * math.pi**2 * E * inertia / L**2
    for share in (0.0, 0.4):
        model = ct.Model(mesh)
        model.beam(
            list(range(n)), material=ct.Elastic(E=E, expansion=alpha), area=A, inertia=inertia
        )
        model.fix([0], rotation=True)
        model.fix([n], x=None, rotation=True)
        move = -share * critical * L / (E * A)
        steps = [
            ct.Static(supports=[Fixed([n], 0, move)], increments=1),
            ct.Buckle(loads=[Temperature("", 1.0)]),
        ]
        results = ct.solve(model, steps, threads=1)
        want = (1 - share) * critical / (E * A * alpha)
        assert results.modes[0].factors[0] == pytest.approx(want, rel=2e-3)


@pytest.mark.parametrize("element", ["Q8R", "Q4I", "Q4S"])
def test_yield_of_two_thicknesses_in_series_in_a_turned_frame(element: str) -> None:
    """A tension bar of two thicknesses at 55 degrees yields where it is thin.

    Small strain, hardening 1: elongation s1/E + p + s2/E with s1 = sy + p, s2 = s1 t1/t2.
    Equations in the turned axes join them along the bar only, so that both contract freely.
    """
    low = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell=CELL[element])
    high = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell=CELL[element], origin=(1.0, 0.0))
    mesh = ct.mesh.move(ct.mesh.assembly(low=low, high=high), angle=55.0)
    start, ends = mesh.nodes_of("low.left"), mesh.nodes_of("high.right")
    model = ct.Model(mesh)
    steel = ct.Mises(E=1000.0, nu=0.3, yield_stress=2.0, isotropic=1.0)
    model.section("low", element=element, material=steel, thickness=0.5)
    model.section("high", element=element, material=steel, thickness=0.8)
    model.local_axes(np.arange(mesh.n_nodes), angle=math.radians(55.0))
    for n, m in zip(mesh.nodes_of("low.right"), mesh.nodes_of("high.left"), strict=True):
        assert np.allclose(mesh.points[n], mesh.points[m])
        model.equation((int(n), "x", 1.0), (int(m), "x", -1.0))
    model.fix(start, y=None)
    model.fix([int(start[0])])
    model.fix([int(ends[0])], x=None)
    model.fix(ends, x=0.02, y=None)
    frame = ct.solve(model, ct.Static(nlgeom=False, increments=8), threads=1).frames[-1]
    p = (0.02 - 2.0 / 1000.0 * 1.625) / (1 + 1.625 / 1000.0)
    axis = rotation(math.radians(55.0))[:, 0]
    pull = axis @ frame.RF[ends, :2].sum(axis=0)
    assert pull == pytest.approx((2.0 + p) * 0.5, rel=1e-8)
    other = frame.fields[1].values["S"][0, 0]
    assert other[0] == pytest.approx((2.0 + p) * 0.5 / 0.8 * axis[0] ** 2, rel=1e-8)
    assert np.allclose(frame.fields[0].values["PEEQ"], p, rtol=1e-6)
    assert frame.scalars["ALLPD"] == pytest.approx((2.0 * p + p**2 / 2) * 0.5, rel=1e-6)


@pytest.mark.parametrize("dead", [False, True])
def test_ring_buckles_under_pressure(dead: bool) -> None:
    """Thin ring: q = 3 E'I/R^3 for pressure that follows, 4 E'I/R^3 for radial dead load.

    Timoshenko and Gere, art. 7.3, and Bresse. A quarter with symmetry; plane strain, E/(1 - nu^2);
    the load is on the outer radius.
    """
    r, h, E, nu, t = 10.0, 0.2, 1e5, 0.3, 0.5
    a, b = r - h / 2, r + h / 2
    mesh = ct.mesh.annulus(a, b, 1, 16, angle=90.0, cell="quad8")
    model = ct.Model(mesh)
    model.section(
        "all", element="Q8R", material=ct.Elastic(E=E, nu=nu), plane="strain", thickness=t
    )
    model.fix("start", x=None)
    model.fix("end", y=None)
    inertia = h**3 / 12
    if dead:
        # Forces of a uniform pressure, fixed in space: read from a linear step with unit pressure.
        model.pressure("outer", 1.0)
        unit = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1].F
        model.loads.clear()
        for n in mesh.nodes_of("outer"):
            model.force([int(n)], x=float(unit[n, 0]), y=float(unit[n, 1]))
    else:
        model.pressure("outer", 1.0)
    factor = ct.solve(model, [ct.Buckle(modes=1)], threads=1).modes[0].factors[0]
    want = (4.0 if dead else 3.0) * E / (1 - nu**2) * inertia / r**3 * (r / b)
    assert factor == pytest.approx(want, rel=1.5e-2)


def test_heat_drives_a_path_through_snap() -> None:
    """Arc length raises a temperature: two pinned bars rise against a dead load.

    At every increment 2 EA (l/L - 1 - alpha T) y/l balances the load.
    """
    EA, a, h, alpha = 1000.0, 2.0, 0.3, 1e-3
    L = math.hypot(a, h)
    mesh = line_mesh([[-a, 0.0], [0.0, h], [a, 0.0]], [(0, 1), (1, 2)])
    model = ct.Model(mesh)
    model.truss([0, 1], material=ct.Elastic(E=EA / 0.5, expansion=alpha), area=0.5)
    model.fix([0, 2])
    from corota.model.loads import NodalForce

    steps = [
        ct.Static(loads=[NodalForce([1], 1, -0.4)], increments=2),
        ct.Static(loads=[Temperature("", 50.0)], path=ct.ArcLength(factor=1.0)),
    ]
    results = ct.solve(model, steps, threads=1)
    for f in results.frames:
        if f.step == 2 and f.increment:
            y = h + f.U[1, 1]
            long = math.hypot(a, y)
            N = EA * ((long - L) / L - alpha * 50.0 * f.factor)
            assert 2 * N * y / long == pytest.approx(-0.4, rel=1e-6)
    assert results.frames[-1].factor == pytest.approx(1.0, rel=1e-9)


def test_pressure_on_a_line_of_load_control_and_path_agree() -> None:
    """A cantilever under follower pressure: load control and arc length end in one state."""
    ends = []
    for path in (None, ct.ArcLength(factor=1.0), ct.DisplacementControl("right", "y", -1.0)):
        mesh = ct.mesh.rectangle(8.0, 1.0, nx=8, ny=1, cell="quad8")
        model = ct.Model(mesh)
        model.section("all", element="Q8R", material=ct.Elastic(E=900.0, nu=0.3), thickness=0.6)
        model.fix("left")
        model.pressure("top", 0.3)
        step = ct.Static(path=path) if path else ct.Static(increments=4)
        results = ct.solve(model, step, threads=1)
        ends.append(results.frames[-1])
        if isinstance(path, ct.DisplacementControl):
            f = results.frames[-1]
            assert f.U[mesh.nodes_of("right"), 1].mean() == pytest.approx(-1.0, rel=1e-8)
            model.loads.clear()
            model.pressure("top", 0.3 * f.factor)
            again = ct.solve(model, ct.Static(increments=3), threads=1).frames[-1]
            assert np.allclose(again.U, f.U, atol=1e-7)
    assert np.allclose(ends[0].U, ends[1].U, atol=1e-7)
