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


def pressed_half(x: Any, element: str, method: Any, plane: Any) -> ct.Model:
    """Half of a block under a rough cylinder, or a cylinder under a sphere, by depth and radius."""
    mesh = ct.mesh.rectangle(4.0, 2.0, 4, 2, cell="quad8" if element == "Q8R" else "quad4")
    tip = ct.mesh.add_node(mesh, 0.0, 2.0 + x[1], "tip")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(3.0, 0.3), plane=plane)
    model.fix("bottom")
    model.fix("left", x=0.0, y=None)
    rest = {} if plane == "axisymmetric" else {"rotation": 0.0}
    model.fix("tip", x=None if plane == "axisymmetric" else 0.0, y=-x[0], **rest)
    round_ = ct.RigidCurve.circle((0.0, 2.0 + x[1]), x[1], reference=tip)
    model.contact("top", round_, friction=0.2, method=method)
    return model


@pytest.mark.parametrize("plane", ["strain", "axisymmetric"])
@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
@pytest.mark.parametrize("element", ["Q4I", "Q8R"])
def test_a_rough_node_at_a_plane_of_symmetry(element: str, method: str, plane: str) -> None:
    """Its shear traction goes to the support and moves nothing: there is no equation for it."""

    def made(x: Any) -> ct.Model:
        return pressed_half(x, element, method, plane)

    def force(x: Any) -> float:
        return float(ct.solve(made(x), fields=False, threads=1).frames[-1].RF[-1, 1])

    x = np.array([0.31, 3.03])
    value, found = ct.value_and_grad(made, gradients.Reaction("tip", "y"), threads=1)(x)
    assert value == pytest.approx(force(x), rel=1e-8)
    for k, step in enumerate(np.diag(1e-4 * x)):
        wanted = 8.0 * (force(x + step) - force(x - step))
        wanted -= force(x + 2.0 * step) - force(x - 2.0 * step)
        assert found[k] == pytest.approx(wanted / (12.0 * step[k]), rel=1e-6), k
