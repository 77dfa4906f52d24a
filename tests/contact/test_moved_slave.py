"""Slave nodes that supports move over the other surface slip, whatever their constraint says."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh import Cells, Mesh

CELLS = {"Q4I": "quad4", "Q8R": "quad8", "T6": "tri6"}
WEIGHT, FRICTION = 3.0, 0.2


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
@pytest.mark.parametrize("element", CELLS)
@pytest.mark.parametrize("part", ["bottom", "left"])
def test_a_block_moved_by_its_slave_nodes(part: str, element: str, method: str) -> None:
    """Forward, back and forward again, one increment a step unless it needs more.

    The load grows with the first motion, so friction takes half of its work in this step.
    """
    mesh = ct.mesh.rectangle(2.0, 0.5, 4, 1, cell=CELLS[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e5, nu=0.3))
    model.force("top", y=-WEIGHT)
    floor = ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0))
    model.contact("bottom", floor, friction=FRICTION, method=method)
    steps = [ct.Static() for _ in range(3)]
    for step, x in zip(steps, (0.5, 0.2, 0.3), strict=True):
        step.fix(part, x=x, y=None)
    results = ct.solve(model, steps, threads=1)
    ends = [next(f for f in reversed(results.frames) if f.step == k) for k in (1, 2, 3)]
    force = [f.RF[mesh.nodes_of(part), 0].sum() for f in ends]
    bound = FRICTION * WEIGHT
    np.testing.assert_allclose(force, [bound, -bound, bound], rtol=1e-6)
    energy = [f.scalars["ALLFD"] for f in ends]
    np.testing.assert_allclose(energy, bound * np.array([0.25, 0.55, 0.65]), rtol=1e-4)
    work = [f.scalars["ALLWK"] for f in ends]
    np.testing.assert_allclose(work, energy, rtol=2e-4)
    assert not any("energy balance" in note for note in results.notes)


def moved_node(curve: ct.RigidCurve, x: float, friction: float) -> ct.Results:
    """One node with a weight, moved along a rigid curve in one increment."""
    nodes = np.array([[0.0, 0.0], [0.0, 2.0]])
    model = ct.Model(Mesh(nodes, [Cells("line2", np.array([[1, 0]]), np.array([1]))]))
    model.spring([0], 1e-9, "x x")
    model.fix([1])
    model.force([0], y=-WEIGHT)
    model.contact([0], curve, friction=friction)
    model.fix([0], x=x, y=None)
    return ct.solve(model, threads=1)


def test_a_node_moved_over_a_floor() -> None:
    results = moved_node(ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0)), 0.5, FRICTION)
    frame = results.frames[-1]
    assert frame.RF[0, 0] == pytest.approx(FRICTION * WEIGHT)
    assert frame.scalars["ALLFD"] == pytest.approx(0.5 * FRICTION * WEIGHT * 0.5)
    assert not any("redundant" in note for note in results.notes)


@pytest.mark.parametrize("friction", [0.0, 0.2])
@pytest.mark.parametrize("x", [0.5, 1.2])
def test_a_node_moved_up_a_bowl(x: float, friction: float) -> None:
    """``H = W tan(slope + angle of friction)`` on a circle of radius 2."""
    results = moved_node(ct.RigidCurve.circle((0.0, 2.0), 2.0, inside=True), x, friction)
    frame = results.frames[-1]
    exact = WEIGHT * math.tan(math.asin(x / 2.0) + math.atan(friction))
    assert frame.RF[0, 0] == pytest.approx(exact)
    assert frame.U[0, 1] == pytest.approx(2.0 - math.sqrt(4.0 - x * x))


@pytest.mark.parametrize("path", [(1.2, 0.6), (0.5, -0.25, -0.3)])
@pytest.mark.parametrize("stiffness", [1e-9, 1e-3])
def test_a_node_without_stiffness_that_is_drawn_back(stiffness: float, path: Any) -> None:
    """``H = W tan(slope +- angle of friction) + k x``: friction turns round with the motion."""
    nodes = np.array([[0.0, 0.0], [0.0, 2.0]])
    model = ct.Model(Mesh(nodes, [Cells("line2", np.array([[1, 0]]), np.array([1]))]))
    model.spring([0], stiffness, "x x")
    model.fix([1])
    model.force([0], y=-WEIGHT)
    bowl = ct.RigidCurve.circle((0.0, 2.0), 2.0, inside=True)
    model.contact([0], bowl, friction=FRICTION)
    steps = []
    for x in path:
        step = ct.Static()
        step.fix([0], x=x, y=None)
        steps.append(step)
    results = ct.solve(model, steps, threads=1)
    at = 0.0
    for number, x in enumerate(path, 1):
        frame = next(f for f in reversed(results.frames) if f.step == number)
        way = math.copysign(math.atan(FRICTION), x - at)
        exact = WEIGHT * math.tan(math.asin(x / 2.0) + way) + stiffness * x
        assert frame.RF[0, 0] == pytest.approx(exact, rel=1e-6)
        at = x


def test_a_spring_may_end_behind_a_rigid_curve() -> None:
    """A node on a floor, drawn aside by a spring to a point below it: ``k d = mu W`` of the way of
    the point is left when the node slides."""
    nodes = np.array([[0.0, 0.0], [0.0, -2.0]])
    model = ct.Model(Mesh(nodes, [Cells("line2", np.array([[1, 0]]), np.array([1]))]))
    model.spring([0], 5.0, "x x")
    model.fix([1], x=1.0, y=0.0)
    model.force([0], y=-WEIGHT)
    floor = ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0))
    model.contact([0], floor, friction=FRICTION)
    frame = ct.solve(model, threads=1).frames[-1]
    assert frame.U[0, 0] == pytest.approx(1.0 - FRICTION * WEIGHT / 5.0)
    assert frame.RF[1, 0] == pytest.approx(FRICTION * WEIGHT)


def test_a_wedge_is_driven_under_a_block() -> None:
    """Node to segment: ``H = P (tan(a + phi) + tan phi)`` with friction on both faces."""
    slope, angle, load = math.tan(math.radians(10.0)), math.atan(0.05), 100.0
    wedge = ct.mesh.mapped([(0, 0), (4, 0), (4, 1 + 4 * slope), (0, 1)], 8, 3)
    block = ct.mesh.mapped([(1, 1 + slope), (3, 1 + 3 * slope), (3, 3), (1, 3)], 3, 3)
    mesh = ct.mesh.assembly(wedge=wedge, block=block)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e7, nu=0.3))
    floor = ct.RigidCurve.line((-100.0, 0.0), (100.0, 0.0))
    for slave, master in (("wedge.bottom", floor), ("wedge.top", "block.bottom")):
        model.contact(slave, master, friction=0.05, method="node_to_segment")
    model.fix("block.left", x=0.0, y=None)
    model.force("block.top", y=-load)
    model.fix("wedge.right", x=-0.5, y=None)
    results = ct.solve(model, threads=1)
    push = -results.frames[-1].RF[mesh.nodes_of("wedge.right"), 0].sum()
    exact = load * (math.tan(math.radians(10.0) + angle) + math.tan(angle))
    assert push == pytest.approx(exact, rel=1e-4)
