"""Bodies that springs hold by their levers end where their path leads, not whole turns away."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import fsolve

import corota as ct
from corota.mesh import Cells

FORCE, MOMENT = np.array([25.0, -40.0]), 35.0
STIFFNESS = np.array([30.0, 50.0, 20.0])
HOOKS = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]])
CENTER = np.array([1.0, 0.5])


def body(anchors):
    """A rigid plate 2 x 1 on three springs, with its reference node in the middle."""
    mesh = ct.mesh.rectangle(2.0, 1.0, 4, 2)
    n = mesh.n_nodes
    hooks = [int(np.argmin(np.hypot(*(mesh.points - at).T))) for at in HOOKS]
    lines = Cells("line2", np.column_stack([hooks, n + np.arange(3)]), np.arange(9, 12))
    mesh = replace(
        mesh,
        points=np.vstack([mesh.points, anchors, CENTER]),
        node_labels=np.arange(1, n + 5),
        cells=[*mesh.cells, lines],
    )
    model = ct.Model(mesh)
    model.section(np.arange(8), element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    for cell, stiffness in enumerate(STIFFNESS, start=8):
        model.spring([cell], stiffness)
    model.rigid(np.arange(n), n + 3)
    model.fix(n + np.arange(3))
    model.force([n + 3], x=FORCE[0], y=FORCE[1], moment=MOMENT)
    return model, n + 3


def balance(motion, anchors):
    """Force and moment on the plate at a displacement and a rotation."""
    c, s = np.cos(motion[2]), np.sin(motion[2])
    arms = (HOOKS - CENTER) @ np.array([[c, s], [-s, c]])
    along = anchors - (CENTER + motion[:2] + arms)
    length, start = np.hypot(*along.T), np.hypot(*(anchors - HOOKS).T)
    pull = (STIFFNESS * (length - start) / length)[:, None] * along
    moment = np.sum(arms[:, 0] * pull[:, 1] - arms[:, 1] * pull[:, 0])
    return np.array([*(FORCE + pull.sum(axis=0)), MOMENT + moment])


@pytest.mark.parametrize(("shift", "increments"), [(0.3, 1), (0.3, 5), (1.0, 1), (1.0, 5)])
def test_a_moment_turns_a_body_on_springs_to_its_first_equilibrium(shift, increments):
    """The springs nearly meet in the middle and hardly resist its rotation at first.

    One increment turned the plate by 1618 rad, five by 323, both with balanced forces.
    """
    anchors = np.array([[-2.0, -1.0], [4.0, -1.0], [1.0 + shift, 4.0]])
    model, reference = body(anchors)
    frame = ct.solve(model, ct.Static(increments=increments), threads=1).frames[-1]
    found = np.array([*frame.U[reference], frame.UR[reference]])
    exact = fsolve(balance, [0.1, -1.3, 0.97], anchors, xtol=1e-13)
    np.testing.assert_allclose(found, exact, rtol=1e-6)


def test_fixed_increments_say_that_a_turn_is_not_known():
    model, _ = body(np.array([[-2.0, -1.0], [4.0, -1.0], [1.3, 4.0]]))
    step = ct.Static(first_increment=1.0, fixed_increments=True)
    with pytest.raises(ct.ConvergenceError, match=r"reference node 19 turns by .* half a turn"):
        ct.solve(model, step, threads=1)


def test_a_driven_body_and_one_on_a_torsion_spring_turn_as_far_as_they_must():
    """Supports and springs of rotation know whole turns: each in one increment."""
    anchors = np.array([[-2.0, -1.0], [4.0, -1.0], [1.3, 4.0]])
    model, reference = body(anchors)
    model.fix([reference], x=0.0, y=0.0, rotation=7.0)
    frame = ct.solve(model, ct.Static(increments=1), threads=1).frames[-1]
    exact = -balance(np.array([0.0, 0.0, 7.0]), anchors)
    np.testing.assert_allclose(frame.RF[reference], exact, rtol=1e-9)

    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]])
    cells = [
        Cells("quad4", np.array([[0, 1, 2, 3]]), np.array([1])),
        Cells("point1", np.array([[4]]), np.array([2])),
    ]
    free = ct.Model(ct.Mesh(points, cells))
    free.section([0], element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    free.spring([1], 2.0, "rotation")
    free.rigid(np.arange(4), 4)
    free.fix([4], x=0.0, y=0.0)
    free.force([4], moment=20.0)
    frame = ct.solve(free, ct.Static(increments=1), threads=1).frames[-1]
    assert frame.UR[4] == pytest.approx(10.0)
