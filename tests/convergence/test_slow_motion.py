"""Motion however slow is computed: rounding is judged in the norm of the equation of motion.

Closed forms: a free body drifts at its speed; a mass on a spring swings as
``v0 / w sin(w t)``, with the period error of the schemes, second order in the increment.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from corota.model.steps import Dynamic
from support.models import cell
from support.pairs import cover

SCHEMES = ("newmark", "hht", "generalized_alpha", "energy_momentum")


@pytest.mark.parametrize(
    ("element", "scheme", "speed"), cover(["T3", "Q4I", "Q4D", "Q8"], SCHEMES, [1e-2, 1e-4, 1e-6])
)
def test_a_steel_bar_drifts(element, scheme, speed):
    mesh = ct.mesh.rectangle(1.0, 0.05, 20, 1, cell(element))
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=2.1e11, nu=0.3, rho=7800.0), thickness=0.01
    )
    model.velocity(x=speed)
    step = Dynamic(period=0.2, increments=10, scheme=scheme)
    frame = ct.solve(model, step, threads=1, fields=False).frames[-1]
    # Rounding of 1e-16 of the bar's size against the way of an increment.
    rel = max(1e-6, 1e-11 / (0.02 * speed))
    assert frame.U[:, 0].mean() == pytest.approx(0.2 * speed, rel=rel)


@pytest.mark.parametrize(("scheme", "speed", "mass"), cover(SCHEMES, [1e-6, 1.0], [1e-6, 1.0, 1e6]))
def test_a_mass_on_a_spring_swings(scheme, speed, mass):
    model = ct.Model(
        Mesh(
            np.array([[0.0, 0.0], [1.0, 0.0]]),
            [Cells("line2", np.array([[0, 1]]), np.array([1]))],
            np.array([1, 2]),
        )
    )
    model.spring([0], 100.0 * mass)
    model.fix([0])
    model.fix([1], x=None)
    model.point_mass([1], mass)
    model.velocity([1], x=speed)
    step = Dynamic(period=1.0, increments=200, scheme=scheme)
    frames = ct.solve(model, step, threads=1, fields=False).frames
    u = np.array([f.U[1, 0] for f in frames])
    time = np.array([f.time for f in frames])
    exact = speed / 10.0 * np.sin(10.0 * time)
    assert np.abs(u - exact).max() <= 0.02 * speed / 10.0
