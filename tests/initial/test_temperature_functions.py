"""Temperature fields by functions of x and y and by tables."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator

import corota as ct


def strip() -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(20.0, 1.0, nx=20, ny=2))
    material = ct.Elastic(E=1e5, nu=0.0, expansion=1e-5)
    model.section("all", element="Q4I", material=material)
    model.fix("left", y=None)
    model.fix([0])
    return model


def test_a_gradient_bends_a_strip() -> None:
    """T = 100 y: the fiber y = 0 keeps its length and bends to a radius of 1000, no stress."""
    model = strip()
    model.temperature(lambda x, y: 100.0 * y)
    results = ct.solve(model, threads=1)
    assert results.history("U2", at=ct.near(20, 0))[-1] == pytest.approx(
        -1000.0 * (1.0 - np.cos(0.02)), rel=1e-3
    )
    assert abs(results.history("S11")[-1]) < 1e-4 * 1e5 * 1e-5 * 100.0


def test_a_table_gives_what_its_function_gives() -> None:
    corners = np.array([(0.0, -1.0), (30.0, -1.0), (30.0, 2.0), (0.0, 2.0)])
    table = LinearNDInterpolator(corners, 100.0 * corners[:, 1])
    tips = []
    for field in (table, lambda x, y: 100.0 * y):
        model = strip()
        model.temperature(field, "all")
        tips.append(ct.solve(model, threads=1).history("U2", at="right")[-1])
    assert tips[0] == pytest.approx(tips[1], rel=1e-9)


def test_outside_of_its_table_and_in_steps_a_field_is_refused() -> None:
    model = strip()
    small = LinearNDInterpolator([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], [1.0, 2.0, 3.0])
    with pytest.raises(ct.InputError, match="finite"):
        model.temperature(small)
    with pytest.raises(ct.InputError, match="a step has no mesh"):
        ct.Static().temperature(lambda x, y: x)
