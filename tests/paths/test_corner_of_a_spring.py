"""Paths through the corner of a nonlinear spring, also where the load falls before it.

Source of the expected values: closed form of a von Mises truss whose apex meets a spring.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from support.particles import bars, network


@pytest.mark.parametrize("stop", [500.0, 5.0, -200.0])
@pytest.mark.parametrize("how", ["arc", "control"])
def test_toggle_meets_a_stop(how: str, stop: float) -> None:
    """A toggle snaps until its apex meets a spring: stiff, soft or negative."""
    height, half, stiffness, gap = 0.4, 1.0, 800.0, 0.25
    model = network([[-half, 0.0], [0.0, height], [half, 0.0]], [[0, 1], [1, 2]], [1])
    length = math.hypot(half, height)
    bars(model, [0, 1], stiffness, length)
    pairs = np.array([[-1.0, -stop * (1.0 - gap)], [-gap, 0.0], [0.0, 0.0], [1.0, 0.0]])
    model.spring([2], pairs, "y")
    model.fix([0, 2])
    model.fix([1], y=None)
    model.force([1], y=-1.0)
    path: ct.ArcLength | ct.DisplacementControl
    if how == "arc":
        path = ct.ArcLength(displacement=([1], "y", -0.9))
    else:
        path = ct.DisplacementControl([1], "y", -0.9, increments=30)
    results = ct.solve(model, ct.Static(path=path, max_increments=400))
    drops = -np.array([frame.U[1, 1] for frame in results.frames[1:]])
    assert drops[-1] == pytest.approx(0.9, rel=1e-9)
    assert (np.diff(drops) > 0.0).all()
    for drop, frame in zip(drops, results.frames[1:], strict=True):
        rise = height - drop
        now = math.hypot(half, rise)
        exact = 2 * stiffness * (length - now) * rise / now + stop * max(drop - gap, 0.0)
        assert frame.factor == pytest.approx(exact, rel=1e-6, abs=1e-6)


def test_a_bifurcation_is_no_corner() -> None:
    """A perfect column stays straight: its path is not left for the branch."""
    mesh = ct.mesh.rectangle(10.0, 0.2, nx=40, ny=1)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0))
    model.fix("left")
    model.force("right", x=-1.0)
    euler = math.pi**2 * 1e4 * 0.2**3 / 12.0 / (4.0 * 100.0)
    path = ct.ArcLength(factor=3.0 * euler)
    results = ct.solve(model, ct.Static(path=path, max_increments=60))
    assert max(np.abs(f.U[:, 1]).max() for f in results.frames) < 1e-6
