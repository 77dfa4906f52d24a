"""Friction and node-to-segment contact in motion."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from benchmarks.studies.impact_table import budget
from corota.verification.impact_models import run_ring, strike

METHODS = ["mortar", "node_to_segment"]
SCHEMES = [
    {"scheme": "hht"},
    {"scheme": "generalized_alpha", "rho_inf": 0.5},
    {"scheme": "energy_momentum"},
]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("scheme", SCHEMES, ids=lambda s: s["scheme"])
def test_sliding_block_stops_where_friction_stops_it(scheme: dict[str, str], method: str) -> None:
    """v = v0 - mu g t until it stops after v0^2 / (2 mu g); there it sticks."""
    mu, g, v0 = 0.4, 10.0, 1.0
    mesh = ct.mesh.rectangle(1.0, 0.5, nx=2, ny=2)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.gravity(y=-g)
    model.velocity(x=v0)
    wall = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
    model.contact("bottom", wall, name="wall", friction=mu, method=method)
    stop = v0 / (mu * g)
    step = ct.Dynamic(period=1.3 * stop, increments=65, **scheme)
    frames = ct.solve(model, step, fields=False).frames[1:]
    time = np.array([f.time for f in frames])
    speed = np.array([f.scalars["momentum x"] for f in frames]) / 0.5
    # The weight acts at once: the block bounces on its own stiffness and takes a few
    # increments to press with it.
    assert speed == pytest.approx(np.maximum(v0 - mu * g * time, 0.0), abs=0.02 * v0)
    way = np.array([f.U[:, 0].mean() for f in frames])
    assert way[-1] == pytest.approx(v0**2 / (2.0 * mu * g), rel=1e-3)
    assert np.ptp(way[time > 1.05 * stop]) < 1e-4 * way[-1]
    taken = np.array([f.scalars["friction energy"] for f in frames])
    assert (np.diff(taken) >= 0.0).all()
    assert taken[-1] == pytest.approx(0.25 * v0**2, rel=0.02)
    if scheme["scheme"] == "energy_momentum":
        assert max(abs(f.scalars["energy balance"]) for f in frames) < 1e-7


@pytest.mark.parametrize("method", METHODS)
def test_oblique_ring_loses_to_friction_what_its_balance_lacks(method: str) -> None:
    """Momenta are those of the wall, friction takes energy and never gives, Coulomb's bound."""
    mu = 0.3
    results = run_ring(
        "Q4I", 24, speed=1.0, sideways=1.0, friction=mu, method=method, increments=120, period=0.6
    )
    found = budget(results)
    size = abs(found.before[1])
    assert (found.after - found.before)[:2] == pytest.approx(found.impulse[:2], abs=1e-9 * size)
    # The moment is reported at the ends of increments, the scheme takes it at their middle.
    assert found.after[2] - found.before[2] == pytest.approx(found.impulse[2], abs=5e-3 * size)
    # Friction of mortar acts along the slave edges, which lie at up to half an edge's angle.
    tilt = math.pi / 24 if method == "mortar" else 0.0
    assert found.ratio <= math.tan(math.atan(mu) + tilt) * (1.0 + 1e-9)
    assert found.ratio > 0.9 * mu
    assert abs(found.impulse[0]) < mu * found.impulse[1]
    assert (np.diff(found.history["friction"]) >= 0.0).all()
    assert found.friction > 0.05
    # The normals of mortar are those of the ring's edges, which roll on: their turn counts.
    allowed = 1e-3 if method == "mortar" else 1e-8
    assert abs(found.energy_error) < allowed
    assert max(abs(f.scalars["energy balance"]) for f in results.frames[1:]) < allowed * size


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_bar_is_the_same_with_both_methods(scheme: str) -> None:
    """Nothing varies along the wall, so weights do not matter."""
    mortar, nodes = (strike("Q4I", scheme, cells=40, method=m) for m in METHODS)
    assert mortar.contacts == nodes.contacts == 1
    assert nodes.history == pytest.approx(mortar.history, abs=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_ring_leaves_with_the_momentum_of_the_wall(method: str) -> None:
    """Straight hit: no energy but in flight and vibration, none lost, nothing along the wall."""
    found = budget(run_ring("Q4I", 24, speed=1.0, method=method, increments=80, period=0.7))
    size = abs(found.before[1])
    assert found.history["force y"][-1] == 0.0
    assert found.after - found.before == pytest.approx(found.impulse, abs=1e-9 * size)
    assert found.after[:1] == pytest.approx(0.0, abs=1e-9 * size)
    assert found.travel + found.spin + found.vibration == pytest.approx(1.0, abs=1e-3)
    # It is the same motion: about 0.8 on fine meshes, with either method.
    assert found.after[1] == pytest.approx(0.8 * size, abs=0.1 * size)


@pytest.mark.parametrize("ramp", [False, True])
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rho_inf", [0.2, 0.5, 0.8])
def test_friction_takes_the_energy_that_a_sliding_block_loses(
    rho_inf: float, method: str, ramp: bool
) -> None:
    """Tractions are those within the increment where the scheme has its equilibrium, not at its
    end: by the mean of two of them, 10 % of the energy were missing, with a warning."""
    mu, g = 0.4, 10.0
    model = ct.Model(ct.mesh.rectangle(1.0, 0.5, nx=2, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.gravity(y=-g)
    model.velocity(x=1.0)
    wall = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
    model.contact("bottom", wall, friction=mu, method=method)
    step = ct.Dynamic(
        period=(0.4 if ramp else 0.2) / mu / g * 4.0,
        increments=20,
        ramp=ramp,
        scheme="generalized_alpha",
        rho_inf=rho_inf,
    )
    results = ct.solve(model, step, fields=False)
    last = results.frames[-1].scalars
    lost = 0.25 - last["momentum x"] ** 2
    assert last["ALLFD"] == pytest.approx(lost, rel=0.01)
    assert not [note for note in results.notes if note.startswith("energy balance")]
