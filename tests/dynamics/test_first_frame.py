"""The frame at the start of a motion has its velocities, accelerations, forces and energies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct

IMPLICIT = ("newmark", "hht", "generalized_alpha", "energy_momentum")
SCHEMES = (*IMPLICIT, "central_difference")


def bar(element: str = "Q4I") -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section(element=element, material=ct.Elastic(E=1000.0, nu=0.0, rho=3.0))
    return model


def step(scheme: str, **given: Any) -> ct.Dynamic:
    return ct.Dynamic(scheme=scheme, period=1e-4, increments=2, **given)


@pytest.mark.parametrize("element", ["Q4I", "Q4D"])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_body_in_flight(scheme: str, element: str) -> None:
    model = bar(element)
    model.velocity(x=2.0, y=-1.0)
    model.gravity(y=-9.81)
    first, second = ct.solve(model, step(scheme)).frames[:2]
    assert first.increment == 0
    assert first.V is not None
    assert first.A is not None
    assert np.allclose(first.V[:, :2], [2.0, -1.0])
    assert np.allclose(first.A[:, :2], [0.0, -9.81], rtol=0.0, atol=1e-9)
    # m v^2 / 2, and as much as in the next frame
    assert first.scalars["ALLKE"] == pytest.approx(0.5 * 6.0 * 5.0, rel=1e-12)
    assert first.scalars["ETOTAL"] == pytest.approx(15.0, rel=1e-12)
    assert second.scalars["ETOTAL"] == pytest.approx(15.0, rel=1e-6)
    if scheme in IMPLICIT:
        assert first.scalars["momentum y"] == pytest.approx(-6.0, rel=1e-12)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_support_carries_what_acts_at_once(scheme: str) -> None:
    model = bar()
    model.fix("left")
    model.force("right", x=7.0)
    first = ct.solve(model, step(scheme)).frames[0]
    # Nothing is strained yet: the force accelerates the mass at the end.
    assert first.F.sum(axis=0)[0] == pytest.approx(7.0)
    assert first.A is not None
    assert first.A[model.mesh.nodes_of("right"), 0].min() > 1.0
    if scheme == "central_difference":
        mass = 3.0 * np.array([0.25, 0.5, 0.25] * 2)
        assert first.A[:, 0] @ mass == pytest.approx(7.0)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_support_in_motion_has_its_rates(scheme: str) -> None:
    model = bar()
    model.amplitudes["go"] = ct.Amplitude([0.0, 1.0], [0.0, 1.0])
    model.fix("left", x=3.0, amplitude="go")
    model.velocity(x=3.0)
    motion = ct.Dynamic(scheme=scheme, period=0.01, increments=20)
    first = ct.solve(model, motion).frames[0]
    assert first.V is not None
    assert np.allclose(first.V[:, 0], 3.0)
    assert first.scalars["ALLKE"] == pytest.approx(0.5 * 6.0 * 9.0, rel=1e-9)


def test_a_static_first_step_has_no_rates() -> None:
    model = bar()
    model.fix("left")
    model.force("right", x=7.0)
    frames = ct.solve(model, [ct.Static(), step("hht")]).frames
    assert [f.increment for f in frames] == [0, 1, 1, 2]
    assert frames[0].V is None
    assert frames[0].scalars["ALLKE"] == 0.0
