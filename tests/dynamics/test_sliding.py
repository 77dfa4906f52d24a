"""A block that slides: friction is mu times a normal force that rings."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_speed_follows_the_normal_impulse(scheme: str) -> None:
    """While the base slides, ``v = v0 - mu (g t + w)`` with the vertical speed w of the center.

    Balance of momentum in both directions, eliminated for the normal force; default increments.
    """
    friction, g, v0 = 0.3, 10.0, 1.0
    model = ct.Model(ct.mesh.rectangle(1.0, 0.5, 2, 1))
    model.section(element="Q4", material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    model.contact("bottom", ct.RigidCurve.line((-5.0, 0.0), (9.0, 0.0)), friction=friction)
    model.gravity(y=-g)
    model.velocity(x=v0)
    results = ct.solve(model, ct.Dynamic(period=0.15, scheme=scheme), threads=1)
    mass = 0.5
    t = results.times
    v, w = (np.array([f.scalars[f"momentum {a}"] for f in results.frames]) / mass for a in "xy")
    assert np.abs(w).max() > 0.03  # it rings
    np.testing.assert_allclose(v, v0 - friction * (g * t + w), rtol=0.0, atol=2e-4)
