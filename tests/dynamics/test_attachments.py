"""Point masses, dashpots and Rayleigh damping against oscillators in closed form."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError, ModelError
from tests.dynamics.test_schemes import column, run
from tests.support.models import cell
from tests.support.pairs import cover

SCHEMES = ("hht", "newmark", "generalized_alpha", "energy_momentum")


def bar(element="Q4I", rho=1e-9):
    """A nearly massless square held on the left: a spring of stiffness 100 along x."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell=cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=100.0, nu=0.0, rho=rho))
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    model.fix("top", x=None)
    return model


def test_point_masses_give_the_frequency_of_an_oscillator():
    model = bar()
    model.point_mass("right", 2.0)
    # One mode along the bar, one in shear.
    found = ct.solve(model, ct.Frequency(modes=2), threads=1).modes[-1].factors
    assert found.max() == pytest.approx(np.sqrt(100.0 / 4.0) / (2.0 * np.pi), rel=1e-6)


def oscillator(scheme, c=0.0, rayleigh=(0.0, 0.0), between=False, n=200):
    model = bar()
    model.point_mass("right", 2.0)
    model.force("right", x=0.05, per_node=True)
    points = model.mesh.points
    for node in model.mesh.nodes_of("right"):
        if c and between:
            level = points[model.mesh.nodes_of("left"), 1] == points[node, 1]
            model.dashpot(int(model.mesh.nodes_of("left")[level][0]), int(node), c=0.5 * c)
        elif c:
            model.dashpot(int(node), x=0.5 * c)
    results = run(
        model,
        period=1.0,
        increments=n,
        scheme=scheme,
        rayleigh=rayleigh,
        alpha=0.0,
        rho_inf=1.0,
        tolerance=1e-11,
    )
    tip = model.mesh.nodes_of("right")[0]
    return np.array([f.U[tip, 0] for f in results.frames[1:]]), results


def exact(time, zeta, omega=5.0, static=0.001):
    damped = omega * np.sqrt(1.0 - zeta**2)
    decay = np.exp(-zeta * omega * time)
    wave = np.cos(damped * time) + zeta * omega / damped * np.sin(damped * time)
    return static * (1.0 - decay * wave)


TIME = np.linspace(0.0, 1.0, 201)[1:]


@pytest.mark.parametrize(
    ("scheme", "keys"),
    cover(
        SCHEMES,
        [
            {},
            {"c": 8.0},
            {"c": 8.0, "between": True},
            {"rayleigh": (2.0, 0.0)},
            {"rayleigh": (0.0, 0.08)},
        ],
        strength=1,
    ),
)
def test_step_response_of_a_damped_oscillator(scheme, keys):
    zeta = 0.2 if keys else 0.0
    found, results = oscillator(scheme, **keys)
    assert np.abs(found - exact(TIME, zeta)).max() <= 2e-3 * 0.002
    lost = column(results, "damping energy")
    assert (np.diff(lost) >= -1e-15).all()
    assert (lost[-1] > 1e-6) == (zeta > 0.0)
    size = np.abs(column(results, "external work")).max()
    assert np.abs(column(results, "energy balance")).max() <= 1e-6 * size


@pytest.mark.parametrize("element", ["Q4I", "Q4D"])
def test_free_body_with_masses_and_a_dashpot_keeps_its_momenta(element):
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1, cell=cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    model.velocity(spin=1.0, x=0.3, about=(1.0, 0.0))
    corner = model.mesh.nodes_of("right")
    model.point_mass([corner[0]], 3.0)
    model.dashpot(int(corner[0]), int(corner[1]), c=5.0)
    results = run(model, period=2.0, increments=40, scheme="energy_momentum", tolerance=1e-11)
    kinetic = column(results, "kinetic energy").max()
    for name in ("momentum x", "momentum y", "angular momentum"):
        assert np.ptp(column(results, name)) <= 1e-11 * kinetic
    assert np.ptp(column(results, "energy balance")) <= 1e-10 * kinetic
    assert column(results, "damping energy")[-1] > 0.0


def test_dashpot_between_nodes_far_apart():
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.0, rho=1.0))
    model.fix("left")
    model.force("right", x=1.0, per_node=True)
    far = int(model.mesh.nodes_of("right")[0])
    near = int(model.mesh.nodes_of("left")[0])
    model.dashpot(near, far, c=2.0)
    results = run(model, period=2.0, increments=50, scheme="energy_momentum")
    balance = column(results, "energy balance")
    assert np.abs(balance).max() <= 1e-8 * column(results, "external work").max()
    assert column(results, "damping energy")[-1] > 0.0
    assert column(results, "iterations").max() <= 6


def test_explicit_motion_has_point_masses_and_refuses_dashpots():
    model = bar(rho=1.0)
    model.point_mass("right", 2.0)
    model.force("right", x=0.05, per_node=True)
    results = run(model, period=0.6, scheme="central_difference")
    tip = model.mesh.nodes_of("right")[0]
    assert max(f.U[tip, 0] for f in results.frames) == pytest.approx(0.002, rel=0.01)
    model.dashpot(int(tip), x=1.0)
    with pytest.raises(InputError, match="implicit"):
        run(model, period=0.6, scheme="central_difference")


def test_wrong_attachments_are_refused():
    model = bar()
    with pytest.raises(InputError, match=">= 0"):
        model.point_mass("right", -1.0)
    with pytest.raises(InputError, match="takes c"):
        model.dashpot(0, 1, x=1.0)
    model.dashpot(0, rotation=1.0)
    with pytest.raises(ModelError, match="drilling"):
        run(model, period=1.0, increments=2)
