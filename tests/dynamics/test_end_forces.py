"""Frames of a motion show the forces of their own instant; steps of rest between motions."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.io.tables.csv_history import Histories
from support.particles import IMPLICIT as SCHEMES


def strip(rho: float = 1.0) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3, rho=rho))
    return model


@pytest.mark.parametrize("scheme", SCHEMES)
def test_forces_of_the_frames_instant(scheme: Any) -> None:
    """A slow ramp on a light strip: F is the amplitude's value, RF balances it (statics)."""
    model = strip(rho=1e-6)
    model.fix("left")
    model.amplitudes["up"] = ct.Amplitude([0.0, 1.0], [0.0, 1.0])
    model.traction("right", x=6.0, amplitude="up")
    options = {"alpha": -0.3} if scheme == "hht" else {}
    results = ct.solve(
        model,
        ct.Dynamic(period=1.0, increments=10, scheme=scheme, nlgeom=False, **options),
        threads=1,
    )
    for frame in results.frames[1:]:
        load = 6.0 * frame.time
        assert frame.F[:, 0].sum() == pytest.approx(load, rel=1e-12)
        assert frame.RF[:, 0].sum() == pytest.approx(-load, rel=2e-3)
        assert not np.any(frame.RF[model.mesh.nodes_of("right")])


@pytest.mark.parametrize("scheme", SCHEMES)
def test_reactions_converge_to_the_change_of_momentum(scheme: Any) -> None:
    """Rate of momentum = loads + reactions at the same instant; errors fall with the increment."""
    errors = []
    for n in (50, 200):
        model = strip()
        model.fix("left")
        time = np.linspace(0.0, 2.0, 401)
        model.amplitudes["wave"] = ct.Amplitude(time, np.sin(2.0 * time) ** 2)
        model.traction("right", x=5.0, amplitude="wave")
        step = ct.Dynamic(period=2.0, increments=n, scheme=scheme, nlgeom=False)
        results = ct.solve(model, step, threads=1)
        t, p = results.times[1:], np.array(results.history("momentum x"))[1:]
        force = np.array([(f.RF + f.F)[:, 0].sum() for f in results.frames[1:]])
        rate = np.gradient(p, t, edge_order=2)[2:-2]
        errors.append(np.abs(force[2:-2] - rate).max() / np.abs(force).max())
    assert errors[1] < 0.03
    assert errors[1] < 0.4 * errors[0]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_static_step_ends_motion(scheme: Any) -> None:
    """A strip flies, a static step holds it, and it is let go: it stays where it is."""
    model = strip()
    model.velocity("", x=2.0)
    fly = ct.Dynamic(period=0.1, increments=5, scheme=scheme)
    hold = ct.Static(supports=[ct.model.Fixed("left", 0), ct.model.Fixed("left", 1)])
    let_go = ct.Dynamic(period=0.1, increments=5, scheme=scheme, new_supports=True)
    results = ct.solve(model, [fly, hold, let_go], threads=1)
    x = np.array([f.U[:, 0].mean() for f in results.frames])
    assert x[5] == pytest.approx(0.2, rel=1e-9)
    np.testing.assert_allclose(x[6:], 0.0, atol=1e-12)


def test_total_moment_of_a_support() -> None:
    """A clamp under a transverse tip force carries P L about its own centroid, whatever the
    element, and a node its own moment; the column names the point."""
    for element in ("Q4I", "Q4D"):
        model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2))
        model.section("all", element=element, material=ct.Elastic(E=1e3, nu=0.3))
        model.fix("left")
        model.traction("right", y=-0.5)
        steps = [ct.Static(nlgeom=False)]
        results = ct.solve(model, steps, threads=1)
        row = Histories(model, steps).row(results.frames[-1])
        assert row["RM3 left about (0 0.5)"] == pytest.approx(0.5 * 4.0, rel=1e-9)
