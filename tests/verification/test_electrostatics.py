"""Electrostatic attraction: plates on a spring, clamped beams, pull-in."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.optimize import brentq

import corota as ct
from corota.model.loading import VACUUM

#: Spring, area and gap of the plates; voltage of pull-in in closed form.
K, AREA, GAP = 1.0, 20.0, 1.0
PULL_IN = float(np.sqrt(8.0 * K * GAP**3 / (27.0 * VACUUM * AREA)))


def plates(voltage: float, both: bool = False, angle: float = 0.0) -> ct.Model:
    """A stiff block on two springs above a line, or above another block."""
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1)
    if both:
        lower = ct.mesh.move(ct.mesh.rectangle(12.0, 1.0, nx=6, ny=1), (-1.0, -2.0))
        mesh = ct.mesh.assembly(up=mesh, low=lower)
    n = mesh.n_cells
    mesh.cells += [ct.Cells("point1", np.array([[0], [4]]), np.array([1000, 1001]))]
    model = ct.Model(mesh)
    model.section(np.arange(n), element="Q4", material=ct.Elastic(E=1e9, nu=0.0), thickness=2.0)
    model.spring(np.arange(n, n + 2), K / 2.0, "y")
    upper = "up." if both else ""
    model.fix(upper + "left", x=0.0, y=None)
    if both:
        model.fix("low.bottom")
        model.electrostatic("up.bottom", "low.top", voltage)
    else:
        model.electrostatic("bottom", [(0.0, -1.0), (10.0, -1.0)], voltage)
    model.stage("plate", upper + "top", axis=(0.0, -1.0))
    return model


@pytest.mark.parametrize("both", [False, True])
def test_plates_below_pull_in(both: bool) -> None:
    """In one increment, quadratically; the axis stiffness is k - 2 k x / (g - x)."""
    voltage = 0.8 * PULL_IN
    results = ct.solve(plates(voltage, both), ct.Static(), threads=1)
    x = brentq(lambda x: K * x * (GAP - x) ** 2 - 0.5 * VACUUM * voltage**2 * AREA, 0.0, 1 / 3)
    assert results.history("travel")[-1] == pytest.approx(x, rel=1e-6)
    wanted = K - 2.0 * K * x / (GAP - x)
    assert results.history("axis stiffness")[-1] == pytest.approx(wanted, rel=1e-5)
    assert results.history("iterations")[-1] <= 5
    if both:  # what attracts is attracted
        assert results.history("RF2", at="low.bottom")[-1] == pytest.approx(-K * x, rel=1e-6)


@pytest.mark.parametrize("both", [False, True])
def test_pull_in_of_plates_is_a_limit_point_at_a_third_of_the_gap(both: bool) -> None:
    step = ct.Static(increments=8, path=ct.ArcLength(stop_at_limit=True))
    results = ct.solve(plates(1.2 * PULL_IN, both), step, threads=1)
    (point,) = results.critical_points
    assert point.kind == "limit"
    assert 1.2 * np.sqrt(point.factor) == pytest.approx(1.0, rel=1e-6)
    assert results.history("travel")[-1] == pytest.approx(GAP / 3.0, rel=1e-4)


def clamped(voltage: float) -> ct.Model:
    """Left half of a silicon beam 350 x 3 x 50 um over a gap of 1 um; um, uN, V."""
    model = ct.Model(ct.mesh.rectangle(175.0, 3.0, nx=35, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=169e3, nu=0.06), thickness=50.0)
    model.fix("left")
    model.fix("right", x=0.0, y=None)
    ground = [(0.0, -1.0), (175.0, -1.0)]
    model.electrostatic("bottom", ground, voltage, permittivity=VACUUM * 1e6)
    return model


def test_pull_in_of_a_clamped_beam() -> None:
    """20.1 to 20.3 V in the literature; and the beam equation with stretching."""
    results = ct.solve(
        clamped(25.0), ct.Static(increments=8, path=ct.ArcLength(stop_at_limit=True)), threads=1
    )
    found = 25.0 * np.sqrt(results.critical_points[0].factor)
    assert 20.0 < found < 20.4
    assert found == pytest.approx(beam_equation(), rel=5e-3)


def beam_equation() -> float:
    """Largest voltage over the deflection: E I w'''' - N w'' = eps b V^2 / (2 (g - w)^2)."""
    length, h, b, young, eps = 350.0, 3.0, 50.0, 169e3, VACUUM * 1e6
    bending, area = young * b * h**3 / 12.0, b * h
    x = np.linspace(0.0, 0.5 * length, 41)
    squares, depths = [], np.linspace(0.3, 0.5, 5)
    guess = np.zeros((5, len(x)))
    guess[0] = 0.3 * np.sin(np.pi * x / length) ** 2
    unknown = np.array([300.0, 0.0])
    for depth in depths:

        def rates(x, y, p):
            load = 0.5 * eps * b * p[0] / (1.0 - y[0]) ** 2
            return np.stack([y[1], y[2], y[3], (load + p[1] * y[2]) / bending, 0.5 * y[1] ** 2])

        def ends(a, c, p, depth=depth):
            stretch = p[1] - young * area * c[4] / (0.5 * length)
            return np.array([a[0], a[1], a[4], c[1], c[3], c[0] - depth, stretch / 1e3])

        found = solve_bvp(rates, ends, x, guess, p=unknown, tol=1e-6)
        assert found.success
        unknown, guess = found.p, found.sol(x)
        squares.append(found.p[0])
    curve = np.polynomial.Polynomial.fit(depths, squares, 3)
    return float(np.sqrt(curve(np.linspace(0.3, 0.5, 401)).max()))


@pytest.mark.parametrize("element", ["Q4I", "Q8", "T6", "Q4D"])
def test_derivative_is_that_of_the_force(element: str) -> None:
    """On curved and turned edges, against central differences; forces sum up over a pair."""
    from corota.analysis.equations import System
    from corota.analysis.linear.solvers import make_solver

    kind = {"Q8": "quad8", "T6": "tri6"}.get(element, "quad4")
    upper, lower = (ct.mesh.rectangle(w, 1.0, nx=3, ny=1, cell=kind) for w in (3.0, 4.0))
    both = ct.mesh.assembly(up=upper, low=ct.mesh.move(lower, (-0.5, -1.3)))
    mesh = ct.mesh.move(both, angle=25.0)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e3, nu=0.3), thickness=0.7)
    model.fix("low.bottom")
    model.electrostatic("up.bottom", "low.top", 1.0, permittivity=0.3)
    system = System(model, make_solver("multifrontal"))
    step = ct.Static()
    system.begin(step, 0.0, np.zeros(system.n_dofs), None)
    rng = np.random.default_rng(3)
    u = 0.02 * rng.standard_normal(system.n_dofs)
    force, (rows, columns, values) = system.conditions.external(1.0, u)
    matrix = np.zeros((system.n_dofs, system.n_dofs))
    np.add.at(matrix, (rows, columns), values)
    assert np.abs(matrix - matrix.T).max() < 1e-12 * np.abs(matrix).max()
    way = rng.standard_normal(system.n_dofs)
    h = 1e-6
    ahead, behind = (system.conditions.external(1.0, u + s * h * way)[0] for s in (1.0, -1.0))
    assert matrix @ way == pytest.approx((ahead - behind) / (2 * h), abs=1e-7)
    across = np.array([-np.sin(np.radians(25.0)), np.cos(np.radians(25.0))])
    assert np.abs(system.by_node(force)[:, :2].sum(axis=0) @ across) < 1e-12


def test_load_of_zero_ends_it() -> None:
    first, second, third = ct.Static(), ct.Static(), ct.Static()
    model = plates(0.5 * PULL_IN)
    second.electrostatic("bottom")
    third.electrostatic("bottom", [(0.0, -1.0), (10.0, -1.0)], 0.5 * PULL_IN)
    results = ct.solve(model, [first, second, third], threads=1)
    travel = results.history("travel").values
    assert travel[1] > 0.01
    assert abs(travel[2]) < 1e-12
    assert travel[3] == pytest.approx(travel[1])
    again = ct.Static()
    again.remove("electrostatic", "bottom")
    assert abs(ct.solve(model, [first, again], threads=1).history("travel")[-1]) < 1e-12


def test_what_makes_no_sense_is_refused(tmp_path) -> None:
    with pytest.raises(ct.InputError, match="opposite electrode"):
        ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1)).electrostatic("bottom", voltage=3.0)
    model = plates(1.0)
    model.electrostatic("top", [(0.0, 1.0), (10.0, 1.0)], 3.0)
    with pytest.raises(ct.ModelError, match="no gap"):
        ct.solve(model, threads=1)
    model = plates(1.0, both=True)
    model.electrostatic("low.top", "up.bottom", 3.0)
    with pytest.raises(ct.ModelError, match="reaches beyond"):
        ct.solve(model, threads=1)
    with pytest.raises(ct.CorotaError, match="no electrostatic loads"):
        ct.write(plates(1.0), tmp_path / "plates.inp")
    with pytest.raises(ct.ConvergenceError, match=r"limit point at load factor 0\.111111"):
        ct.solve(plates(3.0 * PULL_IN), ct.Static(increments=4), threads=1)
