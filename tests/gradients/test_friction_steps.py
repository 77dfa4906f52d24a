"""Friction through several steps: pressed, dragged, and dragged back, against differences."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota import gradients
from corota.gradients.runs import Run

#: The second is that of a state in which a part of the surface slips, in the second step.
MEASURES = [
    gradients.Reaction("top", "x"),
    gradients.Reaction("top", "x", frame=5),
    gradients.Displacement("bottom", "x"),
]


def build(x: Any) -> ct.Model:
    """By coefficient of friction, depth, way and modulus."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 6, 2))
    material = ct.Elastic(1000.0 * x[3], 0.3)
    model.section("all", element="Q4", material=material, plane="strain")
    floor = ct.RigidCurve.line((-5.0, 0.0), (15.0, 0.0))
    model.contact("bottom", floor, friction=0.3 * x[0])
    press = ct.Static(increments=3, fixed_increments=True)
    press.fix("top", x=0.0, y=-0.05 * x[1])
    drag = ct.Static(increments=3, fixed_increments=True)
    drag.fix("top", x=0.08 * x[2], y=-0.05 * x[1])
    back = ct.Static(increments=3, fixed_increments=True)
    back.fix("top", x=0.02, y=-0.06 * x[1])
    model.steps = [press, drag, back]
    return model


def values(x: Any) -> np.ndarray:
    results = ct.solve(build(x), fields=False, threads=1)
    return Run(results, MEASURES, adjoint=False).values


def test_three_steps() -> None:
    x = np.ones(4)
    _, found = ct.value_and_grad(build, MEASURES, threads=1)(x)
    h = 1e-4
    for k, step in enumerate(h * np.eye(4)):
        wanted = (8.0 * (values(x + step) - values(x - step))) / (12.0 * h)
        wanted -= (values(x + 2.0 * step) - values(x - 2.0 * step)) / (12.0 * h)
        assert found[:, k] == pytest.approx(wanted, rel=1e-7, abs=1e-8), k
