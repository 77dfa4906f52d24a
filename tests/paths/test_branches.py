"""Branches: ends, closed ones, several at a point, and paths on which nothing moves."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.lines import lines

YOUNG, AREA, SECOND, HEAT = 1e7, 0.01, 6.666666666666667e-07, 1e-5


def held_beam(n=20):
    """A slender beam, clamped at both ends and heated to 1.5 times its critical temperature."""
    critical = 4.0 * np.pi**2 * SECOND / (AREA * HEAT)
    mesh = lines([(i / n, 0.0) for i in range(n + 1)], ("line2", [[i, i + 1] for i in range(n)]))
    model = ct.Model(mesh)
    steel = ct.Elastic(E=YOUNG, expansion=HEAT)
    model.beam(list(range(n)), material=steel, area=AREA, inertia=SECOND)
    model.fix([0, n], rotation=True)
    model.temperature(1.5 * critical)
    return model


def held_strip(n=16):
    """The same of solid elements, which bulge as they heat up."""
    model = ct.Model(ct.mesh.rectangle(1.0, 0.02, nx=n, ny=1, cell="quad8"))
    steel = ct.Elastic(E=YOUNG, nu=0.3, expansion=HEAT)
    model.section("all", element="Q8", material=steel)
    model.fix("left")
    model.fix("right")
    model.temperature(1.5 * 4.0 * np.pi**2 * 0.02**2 / 12.0 / HEAT)
    return model


@pytest.mark.parametrize(("build", "rel"), [(held_beam, 0.01), (held_strip, 0.03)])
@pytest.mark.parametrize("switch", [False, True])
def test_a_heated_beam_reaches_the_end_of_the_step_on_either_branch(build, rel, switch):
    """Euler: T = 4 pi^2 I / (A a L^2); the step ends at the load factor 1, as it says.

    A bar that is held all round has no displacement before it buckles. Behind it, the compressive
    force stays at Euler's load: the mid-deflection w has (pi w / 2 L)^2 = a (T - Tc) L / L.
    """
    model = build()
    results = ct.solve(model, ct.Static(path=ct.ArcLength(switch=switch)), threads=1, fields=False)
    (point,) = results.critical_points
    assert point.kind == "bifurcation"
    assert point.factor == pytest.approx(1.0 / 1.5, rel=rel)
    last = results.frames[-1]
    assert last.factor == pytest.approx(1.0, abs=1e-9)
    assert len(results.frames) < 20
    moved = np.abs(last.U[:, 1]).max()
    if not switch:
        assert moved < 1e-4
        return
    critical = 4.0 * np.pi**2 * (SECOND / AREA if build is held_beam else 0.02**2 / 12.0) / HEAT
    strain = HEAT * critical * 1.5 * (1.0 - point.factor)
    assert moved == pytest.approx(2.0 / np.pi * np.sqrt(strain), rel=0.05)


def columns(n=6):
    """Two equal columns side by side under equal loads of 1.6 times the critical one."""
    points = [(x, i / n) for x in (0.0, 2.0) for i in range(n + 1)]
    cells = [[s + i, s + i + 1] for s in (0, n + 1) for i in range(n)]
    model = ct.Model(lines(points, ("line2", cells)))
    model.beam(list(range(2 * n)), material=ct.Elastic(E=1e4), area=0.1, inertia=1e-4)
    model.fix([0, n + 1], rotation=True)
    model.force([n, 2 * n + 1], y=-4.0)
    return model


def test_a_double_bifurcation_offers_the_branches_of_its_null_space():
    """Two columns that know nothing of each other: one buckles, the other, or both, either way.

    The branching equations are a l x + b x^3 = 0 and a l y + b y^3 = 0, with the solutions (x, 0),
    (0, y), (x, y) and (x, -y).
    """
    found = set()
    for branch in range(1, 5):
        path = ct.ArcLength(switch=True, branch=branch)
        results = ct.solve(columns(), ct.Static(path=path), threads=1, fields=False)
        (point,) = results.critical_points
        assert point.negative == (0, 2)
        assert point.branches.shape == (4, 14, 3)
        assert any("4 branches" in note for note in results.notes)
        last = results.frames[-1]
        assert last.factor == pytest.approx(1.0)
        tips = last.U[[6, 13], 0]
        size = np.abs(tips).max()
        bent = np.round(tips / size).astype(int)
        assert np.abs(tips - size * bent).max() < 1e-6 * size
        found.add(tuple((bent * (bent[np.flatnonzero(bent)[0]])).tolist()))
    assert found == {(1, 0), (0, 1), (1, 1), (1, -1)}


def test_a_branch_that_does_not_exist_is_refused_with_their_number():
    path = ct.ArcLength(switch=True, branch=5)
    with pytest.raises(ct.ConvergenceError, match="4 leave"):
        ct.solve(columns(), ct.Static(path=path), threads=1, fields=False)


def test_a_closed_branch_is_not_followed_round_and_round():
    """The steep truss of two bars sways aside between two bifurcation points and comes back.

    The end, a load factor that no state of the branch has, is not on it.
    """
    mesh = lines([(-1.0, 0.0), (0.0, 5.0), (1.0, 0.0)], ("line2", [[0, 1], [1, 2]]))
    model = ct.Model(mesh)
    model.truss([0, 1], material=ct.Elastic(E=1.0), area=1.0)
    model.fix([0, 2])
    model.force([1], y=-1.0)
    step = ct.Static(
        path=ct.ArcLength(factor=100.0, switch=True), largest_increment=0.3, max_increments=400
    )
    with pytest.raises(ct.ConvergenceError, match="closed") as caught:
        ct.solve(model, step, threads=1, fields=False)
    assert len(caught.value.results.frames) < 200
