"""Elastoplastic bodies in motion: nothing is gained by yielding, and the balance closes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import numpy as np
import pytest

import corota as ct
from tests.dynamics.test_schemes import column, run
from tests.support.models import cell
from tests.support.pairs import cover

IMPLICIT = {
    "hht": {"alpha": 0.0},
    "newmark": {},
    "generalized_alpha": {"rho_inf": 1.0},
    "energy_momentum": {},
}


def struck(element, free=False):
    """A bar that a pulse bends beyond yield."""
    model = ct.Model(ct.mesh.rectangle(4.0, 0.5, nx=8, ny=2, cell=cell(element)))
    material = ct.Mises(E=1e4, nu=0.3, yield_stress=20.0, isotropic=100.0, rho=1.0)
    model.section("all", element=element, material=material, local_strain="logarithmic")
    if not free:
        model.fix("left", rotation=True)
    time = np.linspace(0.0, 0.4, 41)
    model.amplitudes["pulse"] = ct.Amplitude(time, np.sin(np.pi * time / 0.4) ** 2)
    model.traction("right", y=2.0, amplitude="pulse")
    return model


@pytest.mark.parametrize(("element", "scheme"), cover(["Q4I", "Q4D", "Q8"], IMPLICIT, strength=1))
def test_yielding_takes_energy_and_never_gives_it_back(element, scheme):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        step = ct.Dynamic(
            period=1.0, increments=200, scheme=scheme, max_iterations=40, **IMPLICIT[scheme]
        )
        results = ct.solve(struck(element), step, threads=1)
    work = np.abs(column(results, "external work")).max()
    lost = column(results, "internal work") - column(results, "strain energy")
    assert lost[-1] > 0.05 * work
    assert np.diff(lost).min() > -2e-3 * work
    assert np.abs(column(results, "energy balance")).max() < 2e-3 * work


def test_free_body_that_yields_keeps_its_momenta():
    model = struck("Q4I", free=True)
    results = run(
        model,
        period=1.0,
        increments=200,
        scheme="energy_momentum",
        max_iterations=40,
        tolerance=1e-11,
    )
    late = np.array([f.time for f in results.frames[1:]]) > 0.41
    size = np.sqrt(2.0 * column(results, "kinetic energy").max() * 2.0)
    for name in ("momentum x", "momentum y", "angular momentum"):
        assert np.ptp(column(results, name)[late]) <= 1e-10 * size


def test_explicit_motion_yields_too():
    results = run(struck("Q4I"), period=0.6, scheme="central_difference")
    work = column(results, "external work")
    assert np.abs(column(results, "energy balance")).max() < 1e-2 * np.abs(work).max()
    assert column(results, "internal work")[-1] > 0.0


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_moving_support_does_the_work(scheme):
    model = ct.Model(ct.mesh.rectangle(4.0, 0.5, nx=8, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    # Every increment ends at a point of the table: between them its chords have kinks.
    time = np.linspace(0.0, 1.0, 2001)
    model.amplitudes["sway"] = ct.Amplitude(time, 0.1 * np.sin(2.0 * np.pi * time) ** 2)
    model.fix("left", x=None, y=1.0, amplitude="sway")
    model.fix("left", x=0.0, y=None)
    results = run(model, period=1.0, increments=400, scheme=scheme, alpha=0.0)
    work = np.abs(column(results, "external work")).max()
    assert np.abs(column(results, "energy balance")).max() < 1e-3 * work
    root = model.mesh.nodes_of("left")[0]
    t = np.array([f.time for f in results.frames])[1:]
    speed = np.array([f.V[root, 1] for f in results.frames[1:]])
    exact = 0.1 * 2.0 * np.pi * np.sin(4.0 * np.pi * t)
    assert np.abs(speed - exact).max() < 0.02 * np.abs(exact).max()


def test_pressure_in_motion_follows_the_edge():
    # A free plate pushed by pressure on one short edge while it spins: the impulse turns with it.
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3, rho=1.0))
    model.velocity(spin=np.pi, about=(1.0, 0.5))
    model.pressure("left", 1.0)
    results = run(model, period=1.0, increments=200, scheme="newmark")
    last = results.frames[-1].scalars
    # Over half a turn: the force (cos, sin) of pi t integrates to (0, 2 / pi).
    assert last["momentum y"] == pytest.approx(2.0 / np.pi, rel=2e-2)
    assert abs(last["momentum x"]) < 2e-2


@pytest.mark.parametrize("element", ["Q4D", "Q4DI"])
def test_energy_momentum_finds_a_coarse_increment_of_plastic_drilling_elements(element):
    """The tangent of the scheme is symmetric, the exact one is not: 175 iterations without help.

    That is of the linear local strain, which is named: the count jumps between neighboring speeds.
    """
    model = ct.Model(ct.mesh.rectangle(4.0, 0.8, nx=4, ny=1))
    material = ct.Mises(E=2e3, nu=0.3, yield_stress=6.0, isotropic=40.0, kinematic=30.0, rho=1.0)
    model.section("all", element=element, material=material, local_strain="linear")
    model.velocity(x=0.3, spin=1.2, about=(1.0, 0.3))
    model.velocity("right", y=6.0)
    step = ct.Dynamic(period=0.045, increments=3, scheme="energy_momentum")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the size of the strain
        results = ct.solve(model, step, threads=1)
    assert column(results, "iterations").max() <= 16
    assert results.frames[-1].scalars["ALLPD"] > 0.0
    assert abs(results.frames[-1].scalars["energy balance error"]) < 1e-9


@pytest.mark.parametrize("strain", ["linear", "logarithmic"])
def test_energy_momentum_takes_fixed_increments_of_isotropic_hardening(strain):
    """It stopped in 38 to 43 of .6, and neighbors differed by the sum of two points of the path.

    The dissipation of increments between .0136 and .0158 is then within 2 %.
    """
    material = ct.Mises(E=2e3, nu=0.3, yield_stress=6.0, isotropic=40.0, rho=1.0)
    dissipated = []
    for increments in (38, 40, 41, 44):
        model = ct.Model(ct.mesh.rectangle(4.0, 0.8, nx=4, ny=1))
        model.section("all", element="Q4D", material=material, local_strain=strain)
        model.velocity(x=0.3, spin=1.2, about=(1.0, 0.3))
        model.velocity("right", y=6.0)
        step = ct.Dynamic(period=0.6, increments=increments, scheme="energy_momentum")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of the size of the strain
            results = ct.solve(model, step, threads=1)
        assert column(results, "iterations").max() <= 11
        assert abs(results.frames[-1].scalars["energy balance error"]) < 1e-9
        dissipated.append(results.frames[-1].scalars["ALLPD"])
    assert np.ptp(dissipated) < 0.02 * dissipated[0]
