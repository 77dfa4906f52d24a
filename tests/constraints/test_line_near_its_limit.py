"""A straight line that turns to the displacement its node lost: the message names it, axes help.

Source of the expected value: a bead on an arm that turns evenly, r = r0 cosh(w t).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from corota.mesh.data import Cells, Mesh

RATE, START = 2.0, 0.5


def bead(turned: bool, period: float, increments: int) -> ct.Results:
    """A particle on a driven line; its node may have axes of its own."""
    points = np.array([[0.0, 0.0], [2.0, 0.0], [START, 0.0]])
    model = ct.Model(Mesh(points, [Cells("line2", np.array([[0, 1]]), np.array([1]))], [1, 2, 3]))
    model.truss([0], material=ct.Elastic(E=1e3, nu=0.0, rho=0.1), area=1.0)
    t = np.linspace(0.0, period, 201)
    model.amplitudes["x"] = ct.Amplitude(t, 2.0 * np.cos(RATE * t) - 2.0)
    model.amplitudes["y"] = ct.Amplitude(t, 2.0 * np.sin(RATE * t))
    model.fix([0])
    model.fix([1], x=1.0, y=None, amplitude="x")
    model.fix([1], x=None, y=1.0, amplitude="y")
    if turned:
        model.local_axes([2], angle=math.radians(45.0))
    model.straight([2], 0, 1)
    model.point_mass([2], 1.0)
    model.velocity([1, 2], spin=RATE)
    step = ct.Dynamic(period=period, increments=increments, scheme="newmark")
    return ct.solve(model, step, fields=False)


def test_the_message_names_the_line() -> None:
    with pytest.raises(ct.ConvergenceError, match=r"line .* has turned (so far|to within)"):
        bead(False, 0.9, 50)


def test_axes_of_the_node_let_it_go_on() -> None:
    period = 0.9  # 103 degrees
    last = bead(True, period, 200).frames[-1]
    place = last.U[2, :2] + [START, 0.0]
    assert math.hypot(*place) == pytest.approx(START * math.cosh(RATE * period), rel=1e-3)
