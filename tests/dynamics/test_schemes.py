"""Time integration: what is conserved, how accurate it is, what is refused."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import numpy as np
import pytest

import corota as ct
from corota.verification.motion_models import column, flyer
from corota.verification.problems import time_order
from tests.support.models import ELEMENTS, cell
from tests.support.pairs import cover


def run(model, **keys):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(model, ct.Dynamic(**keys), threads=1, fields=False)


@pytest.mark.parametrize(
    ("element", "strain", "mass"),
    cover(ELEMENTS, ["linear", "green_lagrange"], ["consistent", "constant", "lumped"]),
)
def test_energy_momentum_scheme_conserves_energy_and_momenta(element, strain, mass):
    results = run(
        flyer(element, strain),
        period=2.0,
        increments=40,
        scheme="energy_momentum",
        mass=mass,
        tolerance=1e-11,
    )
    kinetic, angular = column(results, "kinetic energy"), column(results, "angular momentum")
    assert np.ptp(column(results, "energy balance")) <= 1e-11 * kinetic.max()
    assert np.ptp(angular) <= 1e-12 * np.abs(angular).max()
    for axis in "xy":
        momentum = column(results, f"momentum {axis}")
        assert np.ptp(momentum) <= 1e-12 * kinetic.max()
    # It moves: the energy goes to and fro between motion and strain.
    assert np.ptp(kinetic) > 1e-5 * kinetic.max()


@pytest.mark.parametrize(
    ("element", "rigid"), cover(["Q4I", "Q4D", "OPT"], [False, True], strength=1)
)
def test_a_second_step_of_the_conserving_scheme_goes_on(element, rigid):
    """Momenta of drilling elements and of constrained nodes are carried, not made again."""
    ends = []
    for periods in ([1.0], [0.5, 0.5]):
        model = flyer(element, "green_lagrange")
        tip = int(model.mesh.nodes_of("right")[0])
        if rigid:
            model.rigid(np.setdiff1d(model.mesh.nodes_of("right"), tip), tip)
        # What starts rotations that hardly have a mass makes velocities that alternate.
        if rigid or element != "Q4I":
            model.force([tip], moment=5.0)
        steps = [
            ct.Dynamic(
                period=p,
                increments=round(100 * p),
                scheme="energy_momentum",
                tolerance=1e-12,
                max_iterations=40,
            )
            for p in periods
        ]
        results = ct.solve(model, steps, threads=1, fields=False)
        last = results.frames[-1]
        ends.append((last.U, [last.scalars[f"momentum {axis}"] for axis in "xy"]))
    assert np.abs(ends[1][0] - ends[0][0]).max() <= 1e-8
    assert ends[1][1] == pytest.approx(ends[0][1], abs=1e-9)
    assert ends[1][1] == pytest.approx([-0.8, 4.0], abs=1e-9)


@pytest.mark.parametrize("element", ["Q4", "Q4D"])
def test_stored_energy_is_what_the_internal_forces_worked(element):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(
            flyer(element, "green_lagrange"),
            ct.Dynamic(period=2.0, increments=40, scheme="energy_momentum", tolerance=1e-11),
            threads=1,
        )
    strain, work = column(results, "strain energy"), column(results, "internal work")
    assert np.abs(strain - work).max() <= 1e-9 * strain.max()


SCHEMES = time_order.SCHEMES


def test_schemes_are_of_second_order():
    for value in time_order.measure():
        assert value.ok, value


def test_hht_dissipates_and_the_trapezoidal_rule_loses_angular_momentum():
    drift = {}
    for scheme in SCHEMES:
        results = run(flyer("Q4I"), period=3.0, increments=60, scheme=scheme, tolerance=1e-11)
        angular = column(results, "angular momentum")
        drift[scheme] = np.ptp(angular) / np.abs(angular).max()
    assert drift["energy_momentum"] < 1e-12
    assert drift["newmark"] > 1e-6


@pytest.mark.parametrize("element", ["Q4I", "Q4D", "OPT"])
def test_pendulum_swings_with_its_period(element):
    # Uniform rod of length 1 released horizontally, g = 9.81: period 1.933334854 s.
    period = 1.933334854
    model = ct.Model(ct.mesh.rectangle(1.0, 0.02, nx=10, ny=1, cell=cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=1e7, nu=0.0, rho=1.0))
    pivot = np.argmin(np.hypot(*(model.mesh.points - [0.0, 0.0]).T))
    model.fix([pivot])
    model.gravity(y=-9.81)
    results = run(model, period=period, increments=400, scheme="energy_momentum", tolerance=1e-10)
    tip = model.mesh.nodes_of("right")
    # After a period it is back, at rest.
    u = results.frames[-1].U[tip]
    assert np.abs(u).max() < 0.02
    half = results.frames[200].U[tip, 0].mean()
    assert half == pytest.approx(-2.0, abs=0.02)
    balance = column(results, "energy balance")
    assert np.ptp(balance) <= 1e-8 * column(results, "kinetic energy").max()


def test_load_acts_at_once_and_doubles_the_static_deflection():
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.fix("left")
    model.force("right", y=-0.5, per_node=True)
    static = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1].U[:, 1].min()
    first = ct.solve(model, ct.Frequency(modes=1), threads=1).modes[-1].factors[0]
    results = run(model, period=1.0 / first, increments=200, scheme="newmark", nlgeom=False)
    lowest = min(f.U[:, 1].min() for f in results.frames)
    # 2 in one mode; a little more with the others.
    assert lowest / static == pytest.approx(2.0, abs=0.06)


def test_motion_starts_from_a_static_state():
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.fix("left")
    pull = ct.Static(loads=[ct.model.NodalForce("right", 1, -2.0)])
    hold = ct.Dynamic(period=1.0, increments=20)
    release = ct.Dynamic(period=20.0, increments=100, new_loads=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(model, [pull, hold, release], threads=1, fields=False)
    tip = model.mesh.nodes_of("right")
    frames = {n: [f for f in results.frames if f.step == n] for n in (1, 2, 3)}
    start = frames[1][-1].U[tip, 1].mean()
    assert start < -0.5
    assert frames[2][-1].U[tip, 1].mean() == pytest.approx(start, rel=1e-6)
    assert max(f.U[tip, 1].mean() for f in frames[3]) > 0.5 * abs(start)


def test_central_differences_name_the_stable_increment():
    model = flyer("Q4", E=1e4)
    with pytest.raises(ct.ModelError, match="stable one") as caught:
        run(model, period=1.0, increments=10, scheme="central_difference")
    assert "use at most" in str(caught.value)
    results = run(model, period=1.0, scheme="central_difference")
    kinetic = column(results, "kinetic energy")
    assert np.ptp(column(results, "energy balance")) <= 1e-2 * kinetic.max()
    # The increment is stable but not needlessly small: twice as long blows up.
    from corota.analysis.equations import System
    from corota.analysis.linear.solvers import Multifrontal
    from corota.analysis.procedures.explicit import diagonal, stable_increment
    from corota.analysis.procedures.explicit_constraints import mass_of

    system = System(model, Multifrontal())
    system.begin(ct.Dynamic(), 0.0, np.zeros(system.n_dofs), None)
    mass = diagonal(system)
    rest = np.zeros(system.n_dofs)
    stable = stable_increment(system, rest, mass_of(system, mass, rest))
    at = system.evaluate(np.zeros(system.n_dofs), 0.0)
    dense = np.zeros((system.n_dofs, system.n_dofs))
    columns = np.repeat(np.arange(system.n_dofs), np.diff(system.pattern.indptr.astype(int)))
    dense[system.pattern.indices, columns] = at.values
    dense += np.triu(dense, 1).T
    largest = np.linalg.eigvals(dense / mass[:, None]).real.max()
    assert stable == pytest.approx(2.0 / np.sqrt(largest), rel=0.02)


def test_density_is_needed():
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1.0, nu=0.3))
    with pytest.raises(ct.ModelError, match="no density"):
        run(model, period=1.0, increments=2)


def test_automatic_increments_follow_the_motion():
    model = flyer("Q4I", E=300.0)
    loose = run(model, period=2.0, error_tolerance=1e-2)
    tight = run(model, period=2.0, error_tolerance=1e-3)
    exact = run(model, period=2.0, increments=2000, scheme="newmark").frames[-1].U
    errors = [np.abs(r.frames[-1].U - exact).max() for r in (loose, tight)]
    assert len(tight.frames) > len(loose.frames)
    assert errors[1] < errors[0]
