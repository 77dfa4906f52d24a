"""Gradients of random models beside differences; ``python -m benchmarks gradients`` has more."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.gradients import NAMES, Case, compare, draw
from corota import gradients
from support.pairs import quickly

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
    ("Q4I", "elastic", "stress", "logarithmic", "force", "none", "hht"),
    ("OPT", "ramberg_osgood", "stress", "linear", "force", "axes", "generalized_alpha"),
    ("Q4I", "kinematic", "axisymmetric", "linear", "traction", "axes", "newmark"),
    ("Q8R", "neo_hooke", "axisymmetric", "", "pressure", "none", "one increment"),
    ("T6", "hill", "stress", "linear", "force", "none", "increments"),
    ("Q4", "prony", "strain", "linear", "support", "none", "increments"),
    ("Q4I", "norton", "strain", "logarithmic", "force", "none", "increments"),
    ("T3", "cowper_symonds", "stress", "linear", "traction", "none", "increments"),
    ("Q4D", "johnson_cook", "strain", "logarithmic", "force", "none", "increments"),
    ("BEAM", "mises", "stress", "", "force", "none", "increments"),
    ("BEAM", "elastic", "stress", "", "force", "none", "hht"),
    ("TRUSS", "voce", "stress", "", "force", "none", "increments"),
]
KEYS = ("element", "law", "plane", "strain", "load", "constraint", "path")


#: Cases that take more than ten seconds.
LONG = {("BEAM", "mises")}


@pytest.mark.parametrize("second", quickly([False, True], False))
@pytest.mark.parametrize(
    "choice",
    [
        pytest.param(c, marks=[pytest.mark.slow] if c[:2] in LONG else [], id="-".join(c[:2]))
        for c in CASES
    ],
)
def test_gradient_is_the_difference(choice: tuple[str, ...], second: bool) -> None:
    """One or the other of two parameters, which change with the case."""
    seed = CASES.index(choice)
    case = Case(seed, dict(zip(KEYS, choice, strict=True)))
    assert compare(case, [(2 * seed + second) % len(NAMES)]) < 1e-7


def test_loads_that_turn_on_bodies_that_flow() -> None:
    """The end moments of drilling elements have a stiffness, which no element has."""
    names = ("Q4D", "kinematic", "strain", "logarithmic", "force", "axes", "two steps")
    assert compare(Case(13, dict(zip(KEYS, names, strict=True))), [0]) < 1e-7


def test_fibers_that_begin_to_flow_beside_the_state() -> None:
    """A support moves: its forces kink at many fibers, so that differences take short steps."""

    def build(x: np.ndarray) -> ct.Model:
        points = np.column_stack([np.linspace(0.0, 2.0, 5), [0.0, 0.02, 0.05, 0.02, 0.0]])
        chain = np.column_stack([np.arange(4), np.arange(1, 5)])
        mesh = ct.Mesh(points, [ct.Cells("line2", chain, np.arange(1, 5))])
        model = ct.Model(mesh)
        steel = ct.Mises(1000.0, 0.3, yield_stress=5.0, isotropic=50.0)
        model.beam(list(range(4)), material=steel, profile=ct.profiles.rectangle(0.2, 0.3))
        model.fix([0, 4], rotation=True)
        model.fix([2], x=None, y=-0.05 * x[0])
        model.force([1], x=0.02)
        model.steps = [ct.Static(increments=1, fixed_increments=True, tolerance=1e-12)]
        return model

    function = ct.value_and_grad(build, gradients.Displacement([1], "x"), threads=1)
    _, exact = function([1.0])
    step = 1e-6
    near = function([1.0 + step])[0] - function([1.0 - step])[0]
    assert near / (2.0 * step) == pytest.approx(exact[0], rel=1e-6)


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


def test_velocities_at_the_start() -> None:
    """A kicked beam: velocity and displacement by the kick and the density."""

    def build(x: np.ndarray) -> ct.Model:
        model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
        body = ct.Elastic(E=1000.0, nu=0.3, rho=0.1 * x[1])
        model.section("all", element="Q4I", material=body)
        model.fix("left")
        model.velocity("right", y=2.0 * x[0])
        model.steps = [ct.Dynamic(period=0.3, increments=6, tolerance=1e-13)]
        return model

    measures = [gradients.Velocity("right", "y"), gradients.Displacement("right", "y", frame=3)]
    function = ct.value_and_grad(build, measures, threads=1)
    _, exact = function([1.0, 1.0])
    for k in (0, 1):
        step = 1e-3 * np.eye(2)[k]
        near = function(1.0 + step)[0] - function(1.0 - step)[0]
        far = function(1.0 + 2.0 * step)[0] - function(1.0 - 2.0 * step)[0]
        difference = (8.0 * near - far) / 12e-3
        assert difference == pytest.approx(exact[:, k], rel=1e-8)


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


def test_a_reaction_that_is_gone_has_a_gradient() -> None:
    """Rounding of a force that the second step takes away is no kink: a beam by its thickness."""
    assert compare(draw(115), [NAMES.index("thickness")]) < 1e-7
