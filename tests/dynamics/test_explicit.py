"""Central differences: stable increment with and without mass, quiet starts, blow-ups."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from tests.support.models import cell

STIFFNESS, MASS, FORCE = 50.0, 2.0, 4.0


def run(model, **keys):
    with warnings.catch_warnings():
        # A division by a mass of zero would be a warning.
        warnings.simplefilter("error", RuntimeWarning)
        warnings.simplefilter("ignore", UserWarning)
        return ct.solve(model, ct.Dynamic(scheme="central_difference", **keys), threads=1)


def chain(*masses):
    """Springs along x from a held ground node; `masses` by node, ground first."""
    n = len(masses)
    points = np.array([[float(i), 0.0] for i in range(n)])
    lines = np.array([[i, i + 1] for i in range(n - 1)])
    model = ct.Model(Mesh(points, [Cells("line2", lines, np.arange(1, n))], np.arange(1, n + 1)))
    model.spring(list(range(n - 1)), STIFFNESS)
    model.fix([0])
    model.fix(list(range(1, n)), x=None, y=0.0)
    for node, mass in enumerate(masses):
        if mass:
            model.point_mass([node], mass)
    return model


@pytest.mark.parametrize("ground", [0.0, 1.0])
@pytest.mark.parametrize("increments", [0, 50])
def test_held_nodes_need_no_mass(ground, increments):
    """Closed form of a suddenly loaded mass on a spring: u = F/k (1 - cos wt)."""
    model = chain(ground, MASS)
    model.force([1], x=FORCE)
    keys = {"increments": increments} if increments else {"largest_increment": 0.01}
    frames = run(model, period=0.5, **keys).frames
    assert len(frames) == 51
    exact = FORCE / STIFFNESS * (1.0 - np.cos(5.0 * 0.5))
    assert frames[-1].U[1, 0] == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("ground", [0.0, 1.0])
def test_a_long_increment_is_refused_with_and_without_mass_at_the_ground(ground):
    """The stable increment is 2 / 5, whatever the mass of the held node."""
    model = chain(ground, MASS)
    model.force([1], x=FORCE)
    with pytest.raises(ct.ModelError, match=r"above the stable one of central differences, 0\.4;"):
        run(model, period=20.0, increments=40)


@pytest.mark.parametrize("keys", [{}, {"increments": 10}])
@pytest.mark.parametrize("masses", [(0.0, 0.0, MASS), (1.0, MASS, 0.0)])
def test_a_free_dof_with_stiffness_but_no_mass_is_named(masses, keys):
    model = chain(*masses)
    node = 1 + max(i for i, mass in enumerate(masses) if not mass)
    with pytest.raises(ct.ModelError, match=rf"node {node} .*no mass"):
        run(model, period=1.0, **keys)


def test_a_force_on_a_free_dof_without_mass_is_named():
    """Across a spring without tension there is no stiffness, and nothing to hold the force."""
    model = chain(0.0, MASS, 0.0)
    model.supports.clear()
    model.fix([0])
    model.fix([1], x=0.0, y=0.0)
    model.fix([2], x=0.0, y=None)
    model.force([2], y=1.0)
    with pytest.raises(ct.ModelError, match=r"node 3 .*no mass"):
        run(model, period=1.0, increments=10)


def test_no_stiffness_makes_no_increment():
    """A mass across a slack spring: free fall with given increments, no guess without."""
    with pytest.raises(ct.ModelError, match="no stable increment"):
        run(string(1.0), period=0.1)
    frames = run(string(1.0), period=0.01, increments=10).frames
    assert frames[-1].U[1, 1] == pytest.approx(0.01, rel=1e-4)


def beam(element, time, value):
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell=cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=100.0, nu=0.3, rho=1.0))
    model.fix("left")
    model.amplitudes["late"] = ct.Amplitude(np.array(time), np.array(value))
    model.force("right", y=0.5, amplitude="late", per_node=True)
    return model


@pytest.mark.parametrize("element", ["T3", "Q4", "Q4I", "Q4D", "OPT", "Q8"])
def test_a_quiet_start_only_delays_the_motion(element):
    """A body at rest until 0.2 then moves as one that is loaded from the start."""
    late = run(beam(element, [0.2, 0.4], [0.0, 1.0]), period=0.4, increments=160).frames[-1]
    soon = run(beam(element, [0.0, 0.2], [0.0, 1.0]), period=0.2, increments=80).frames[-1]
    size = np.abs(soon.U).max()
    assert size > 1e-4
    assert np.abs(late.U - soon.U).max() <= 1e-7 * size


@pytest.mark.parametrize("ground", [0.0, 1.0])
def test_a_pulse_after_a_quiet_start(ground):
    """Ramp f t from time 0.2: u = f/k (t - sin(wt)/w), the closed form."""
    model = chain(ground, MASS)
    model.amplitudes["late"] = ct.Amplitude(np.array([0.2, 1.2]), np.array([0.0, 1.0]))
    model.force([1], x=FORCE, amplitude="late")
    frames = run(model, period=1.0, increments=200).frames
    exact = FORCE / STIFFNESS * (0.8 - np.sin(5.0 * 0.8) / 5.0)
    assert frames[-1].U[1, 0] == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("share", [0.5, 0.99])
def test_a_stable_increment_is_never_taken_for_a_blow_up(share):
    """Close to the stable increment energies of a linear body swing, but stay bounded."""
    model = chain(0.0, MASS)
    model.force([1], x=FORCE)
    frames = run(model, period=100.0, increments=round(100.0 / (share * 0.4))).frames
    assert max(np.abs(f.U).max() for f in frames) < 0.5


def string(velocity):
    """A mass that flies across a slack spring, which tightens on the way."""
    model = chain(0.0, MASS)
    model.supports.clear()
    model.fix([0])
    model.fix([1], x=0.0, y=None)
    model.velocity(y=velocity)
    return model


@pytest.mark.parametrize("velocity", [4.0, -8.0, 20.0])
def test_a_blow_up_is_refused(velocity):
    """The tight spring's stable increment is 2 / 5; at the start any one is stable."""
    with pytest.raises(ct.ConvergenceError, match="diverges"):
        run(string(velocity), period=50.0, increments=100)
    frames = run(string(velocity), period=5.0, increments=500).frames
    kinetic = 0.5 * MASS * velocity**2
    assert max(abs(f.scalars["energy balance"]) for f in frames[1:]) < 0.01 * kinetic


@pytest.mark.parametrize("element", ["T3", "Q4", "Q4I"])
def test_elements_that_stiffen_are_refused(element):
    """Stretched fourfold, a body of Green-Lagrange strain is far stiffer than at the start.

    Its increment, stable at the start, is not any more.
    """
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2, cell=cell(element)))
    material = ct.Elastic(E=100.0, nu=0.0, rho=1.0)
    model.section("all", element=element, material=material, local_strain="green_lagrange")
    model.fix("left")
    model.amplitudes["pull"] = ct.Amplitude(np.array([0.0, 3.0]), np.array([0.0, 1.0]))
    model.fix("right", x=3.0, y=0.0, amplitude="pull")
    with pytest.raises(ct.ModelError) as caught:
        run(model, period=3.0, increments=3)
    stable = float(str(caught.value).split("differences, ")[1].split(";")[0])
    with pytest.raises(ct.ConvergenceError, match=r"diverges|inverted"):
        run(model, period=3.0, increments=int(np.ceil(3.0 / (0.98 * stable))))


def heated(period, cycles):
    """A body between walls whose temperature oscillates while it grows."""
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1)
    model = ct.Model(mesh)
    model.section("all", element="Q4", material=ct.Elastic(1e3, 0.3, rho=1.0, expansion=1e-3))
    model.fix("left", y=None)
    model.fix("right", y=None)
    model.fix([0], x=None)
    time = np.linspace(0.0, period, 40 * cycles + 1)
    share = time / period
    wave = share + 0.5 * np.sin(2.0 * np.pi * cycles * share)
    model.amplitudes["wave"] = ct.Amplitude(time, wave if cycles > 1 else share)
    model.temperature(10.0, amplitude="wave")
    return model


@pytest.mark.parametrize("period", [20.0, 40.0])
def test_heat_is_never_taken_for_a_blow_up(period):
    """It changes forces without motion: the frequency of an increment is that of the motion."""
    frame = run(heated(period, 1), period=period).frames[-1]
    assert frame.scalars["ALLIE"] == pytest.approx(0.5 * 4.0 * 1000.0 * 0.01**2, rel=2e-2)


def test_the_work_of_heat_counts_increments_that_are_not_shown():
    """Slow heat stores all its work; it was summed over frames, 23 % too little here."""
    results = run(heated(160.0, 37), period=160.0)
    frame = results.frames[-1]
    assert len(results.frames) < 0.1 * frame.increment
    assert frame.scalars["ALLTH"] == pytest.approx(0.5 * 4.0 * 1000.0 * 0.01**2, rel=1e-2)
