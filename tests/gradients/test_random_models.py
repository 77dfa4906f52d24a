"""Gradients of random models beside differences; ``python -m benchmarks.gradients`` has more."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import corota as ct
from benchmarks.gradients import NAMES, Case, compare, draw
from corota import gradients

CASES = [
    ("Q4I", "elastic", "stress", "linear", "pressure", "rigid", "one increment"),
    ("Q8", "orthotropic", "strain", "logarithmic", "traction", "axes", "increments"),
    ("OPT", "elastic", "stress", "green_lagrange", "follower", "equation", "one increment"),
    ("Q4D", "ramberg_osgood", "strain", "logarithmic", "force", "straight", "one increment"),
    ("Q9", "ogden", "stress", "", "force", "axes", "displacement control"),
    ("T6", "neo_hooke", "strain", "", "gravity", "none", "two steps"),
    ("Q4DI", "elastic", "strain", "logarithmic", "temperature", "none", "one increment"),
    ("Q4S", "orthotropic", "stress", "green_lagrange", "centrifugal", "none", "linear"),
    ("Q4I", "mises", "stress", "logarithmic", "force", "none", "increments"),
    ("Q8R", "voce", "strain", "linear", "support", "none", "increments"),
    ("Q4D", "kinematic", "stress", "logarithmic", "traction", "rigid", "two steps"),
    ("T6", "chaboche", "strain", "logarithmic", "force", "none", "displacement control"),
]
KEYS = ("element", "law", "plane", "strain", "load", "constraint", "path")


@pytest.mark.parametrize("choice", CASES, ids=["-".join(c[:2]) for c in CASES])
def test_gradient_is_the_difference(choice: tuple[str, ...]) -> None:
    """Two of the six parameters, which change with the case."""
    seed = CASES.index(choice)
    case = Case(seed, dict(zip(KEYS, choice, strict=True)))
    first = 2 * seed % len(NAMES)
    assert compare(case, [first, first + 1]) < 1e-7


def test_loads_that_turn_on_bodies_that_flow() -> None:
    """The end moments of drilling elements have a stiffness, which no element has."""
    case = draw(13)
    assert (case.choice["element"], case.choice["law"]) == ("Q4D", "kinematic")
    assert compare(case, [0]) < 1e-7


def press(x: np.ndarray, kind: str, method: str = "mortar") -> ct.Model:
    """A curved block on a plate: height, curvature, thickness, and a movement."""
    height, bend, thickness, move = x
    gap = 0.0 if kind == "tie" else 0.01 * bend
    lower = ct.mesh.rectangle(4.0, height, nx=8, ny=2)
    upper = ct.mesh.rectangle(1.5, 0.6, nx=5, ny=2, origin=(1.2, height + gap))
    p = upper.points.copy()
    if kind != "tie":
        up = (p[:, 1] - p[:, 1].min()) / 0.6
        p[:, 1] += 0.25 * bend * (p[:, 0] - 1.95) ** 2 * (1.0 - up)
    model = ct.Model(ct.mesh.assembly(a=lower, b=replace(upper, points=p)))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3), thickness=thickness)
    model.fix("a.bottom")
    model.fix("b.top", x=0.02 * move, y=0.02 if kind == "tie" else -0.06 * move)
    if kind == "tie":
        model.tie("b.bottom", "a.top")
    else:
        model.contact("b.bottom", "a.top", method=method)
    model.steps = [ct.Static(tolerance=1e-13)]
    return model


@pytest.mark.parametrize(
    ("kind", "method"),
    [("contact", "mortar"), ("contact", "node_to_segment"), ("tie", "mortar")],
)
def test_contact_and_ties(kind: str, method: str) -> None:
    """Closed surfaces without friction: multipliers are unknowns of the adjoint state."""
    measures = [gradients.Reaction("b.top", "y"), gradients.Displacement("a.top", "y")]
    function = ct.value_and_grad(lambda x: press(x, kind, method), measures, threads=1)
    x = np.ones(4)
    _, exact = function(x)
    size = np.abs(exact).max(axis=1)
    for k in range(4):
        step = 1e-3 * np.eye(4)[k]
        near = function(x + step)[0] - function(x - step)[0]
        far = function(x + 2.0 * step)[0] - function(x - 2.0 * step)[0]
        difference = (8.0 * near - far) / 12e-3
        assert (np.abs(difference - exact[:, k]) / size).max() < 1e-7
