"""Tangent stiffness of a stage, beside differences of reactions under prescribed motion."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.flexures import cross_spring, parallelogram

#: Motion of the central differences, relative to the length of the model.
STEP = 2e-5


def rigid(points, about, motion):
    """Displacements of a rigid motion about a place."""
    cos, sin = np.cos(motion[2]), np.sin(motion[2])
    arm = points - about
    return arm @ (np.array([[cos, -sin], [sin, cos]]).T - np.eye(2)) + motion[:2]


def reactions(build, nodes, state, place, motion):
    """Force on the nodes and moment about the moved place, where they are moved rigidly.

    `state` is the frame about which they move, with its loads.
    """
    model = build()
    start = model.mesh.points[nodes] + state.U[nodes]
    u = state.U[nodes] + rigid(start, place, motion)
    drills = model.mesh.n_nodes == len(state.UR) and state.UR.any()
    for node, (x, y) in zip(nodes, u, strict=True):
        model.fix([node], x=float(x), y=float(y))
        if drills:
            model.fix([node], x=None, y=None, rotation=float(state.UR[node] + motion[2]))
    step = ct.Static(increments=8, tolerance=1e-13)
    step.max_iterations = 30
    frame = ct.solve(model, step, threads=1).frames[-1]
    force = frame.RF[nodes]
    arm = model.mesh.points[nodes] + frame.U[nodes] - place - motion[:2]
    moment = arm[:, 0] @ force[:, 1] - arm[:, 1] @ force[:, 0] + force[:, 2].sum()
    return np.array([*force[:, :2].sum(axis=0), moment])


def differences(build, nodes, state, place, length):
    """Matrix of central differences of fourth order, shape (3, 3)."""
    columns = []
    for k in range(3):
        h = np.zeros(3)
        h[k] = STEP * (length if k < 2 else 1.0)
        f = [reactions(build, nodes, state, place, s * h) for s in (-2.0, -1.0, 1.0, 2.0)]
        columns.append((f[0] - 8.0 * f[1] + 8.0 * f[2] - f[3]) / (12.0 * h[k]))
    return np.stack(columns, axis=1)


def matrix(results, name, what="stiffness", frame=-1):
    return np.array(
        [[results.frames[frame].scalars[f"{name}: {what} {a}{b}"] for b in "xyr"] for a in "xyr"]
    )


def agree(found, wanted, length, rel=1e-8):
    """Whether matrices agree relative to their largest entries, moments by a length."""
    by = np.diag([1.0, 1.0, 1.0 / length])
    found, wanted = by @ found @ by, by @ wanted @ by
    assert np.abs(found - wanted).max() <= rel * np.abs(wanted).max()


def test_reference_node_of_a_turned_pivot():
    def build():
        model = cross_spring(depth=0.05, n=6)
        model.force(["hub"], x=0.3, y=-0.2)
        return model

    model = build()
    model.force(["hub"], moment=0.8)
    model.stage("hub", axis="rotation")
    results = ct.solve(model, ct.Static(increments=4, tolerance=1e-13), threads=1)
    state = results.frames[-1]
    node = model.mesh.nodes_of("hub")
    place = model.mesh.points[node[0]] + state.U[node[0]]
    assert state.UR[node[0]] > 0.3
    found = matrix(results, "hub")
    agree(found, differences(build, node, state, place, 1.0), 1.0)
    agree(found, found.T, 1.0, 1e-10)
    # The same body by the ends of its leaves, about the same point.
    model.stage("ends", [6, 13], axis="rotation", point=(0.0, 0.0))
    both = ct.solve(model, ct.Static(increments=4, tolerance=1e-13), threads=1)
    agree(matrix(both, "ends"), found, 1.0)
    assert matrix(both, "ends", "compliance") @ matrix(both, "ends") == pytest.approx(
        np.eye(3), abs=1e-8
    )


@pytest.mark.parametrize("element", ["Q4I", "Q4D"])
def test_group_of_elastic_nodes_that_loads_move(element):
    def build():
        model = parallelogram(element)
        model.force("stage", x=0.1, y=-0.02)
        return model

    model = build()
    model.stage("stage", axis="x")
    results = ct.solve(model, ct.Static(increments=4, tolerance=1e-13), threads=1)
    state, nodes = results.frames[-1], model.mesh.nodes_of("stage")
    place = model.stages[0].place(model.mesh) + results.body_motion("stage").translation[-1]
    assert abs(state.U[nodes]).max() > 0.2
    agree(matrix(results, "stage"), differences(build, nodes, state, place, 10.0), 10.0)


def test_group_that_supports_move():
    def build():
        return parallelogram("Q4I")

    model = build()
    model.fix("stage", x=0.4, y=None)
    model.stage("stage", axis="x")
    results = ct.solve(model, ct.Static(increments=2, tolerance=1e-13), threads=1)
    state, nodes = results.frames[-1], model.mesh.nodes_of("stage")
    place = model.stages[0].place(model.mesh) + results.body_motion("stage").translation[-1]
    agree(matrix(results, "stage"), differences(build, nodes, state, place, 10.0), 10.0)
    # The force on the stage is the reaction of its supports.
    assert results.history("load", at="stage")[-1] == pytest.approx(
        results.history("RF1", at="stage")[-1], rel=1e-12
    )


def test_load_that_follows_is_part_of_it():
    def build():
        model = parallelogram("Q4I")
        model.pressure(ct.on_line((0.0, 0.0), (0.0, 10.0)), 0.5)
        return model

    model = build()
    model.stage("stage", axis="x")
    results = ct.solve(model, ct.Static(increments=2, tolerance=1e-13), threads=1)
    state, nodes = results.frames[-1], model.mesh.nodes_of("stage")
    place = model.stages[0].place(model.mesh) + results.body_motion("stage").translation[-1]
    agree(matrix(results, "stage"), differences(build, nodes, state, place, 10.0), 10.0)


def test_relative_to_another_body():
    """The pivot between two bodies that turn together is that of a fixed one."""
    fixed = cross_spring(n=6, depth=0.05)
    fixed.force(["hub"], moment=0.5)
    fixed.stage("hub", axis="rotation")
    step = ct.Static(increments=4, tolerance=1e-13)
    alone = ct.solve(fixed, step, threads=1)

    moved = cross_spring(n=6, depth=0.05, based=True)
    base = moved.mesh.nodes_of("base")[0]
    moved.fix([base], x=0.2, y=-0.1, rotation=0.6)
    moved.force(["hub"], moment=0.5)
    moved.stage("frame", [base], axis="x", stiffness=False)
    moved.stage("hub", axis="rotation", against="frame")
    together = ct.solve(moved, step, threads=1)
    for name in ("rotation", "motion x", "motion y", "moment", "axis stiffness", "stiffness xy"):
        assert together.history(name, at="hub")[-1] == pytest.approx(
            alone.history(name, at="hub")[-1], rel=1e-6, abs=1e-9
        ), name
    agree(matrix(together, "hub"), matrix(alone, "hub"), 1.0, 1e-7)


def test_closed_contact_stays_closed():
    """A block on a floor: along the normal it is as stiff as a bar of its height."""
    model = ct.Model(ct.mesh.rectangle(4.0, 2.0, nx=4, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.0))
    floor = ct.RigidCurve.polyline([(-2.0, 0.0), (6.0, 0.0)])
    model.contact("bottom", floor)
    model.fix("left", y=None)
    model.fix("top", x=None, y=-0.01)
    model.stage("top", axis="y")
    results = ct.solve(model, ct.Static(increments=2, nlgeom=False), threads=1)
    assert matrix(results, "top")[1, 1] == pytest.approx(1e3 * 4.0 / 2.0, rel=1e-6)


def test_what_cannot_move_as_one_body_is_refused():
    model = parallelogram("Q4I")
    top = model.mesh.nodes_of("stage")
    model.equation((int(top[0]), "x", 1.0), (int(top[-1]), "y", 0.5), rhs=0.0)
    model.stage("stage", axis="x")
    with pytest.raises(ct.InputError, match="cannot move as one body"):
        ct.solve(model, threads=1)
