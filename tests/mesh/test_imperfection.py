"""Imperfections: nodes moved by modes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct


def column() -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(40.0, 1.0, nx=20, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0))
    model.fix("left")
    model.force("right", x=-1.0)
    return model


def test_a_crooked_column_bends_by_the_share_of_its_load() -> None:
    """The bow grows as 1 / (1 - P / P_cr), for a bow in the first mode (Southwell)."""
    straight = column()
    modes = ct.solve(straight, ct.Buckle(modes=2), threads=1).modes[0]
    crooked = column()
    crooked.imperfection(modes, {1: 0.02})
    assert crooked.mesh is not straight.mesh
    share = 0.5
    crooked.loads.clear()
    crooked.force("right", x=-share * modes.factors[0])
    results = ct.solve(crooked, ct.Static(), threads=1)
    sag = abs(results.history("U2", at="right")[-1])
    assert sag == pytest.approx(0.02 * share / (1.0 - share), rel=2e-2)


def test_modes_add_up_and_those_of_other_meshes_are_refused() -> None:
    model = column()
    modes = ct.solve(model, ct.Buckle(modes=2), threads=1).modes[0]
    before = model.mesh.points.copy()
    model.imperfection(modes, [0.1, -0.05])
    expected = 0.1 * modes.shapes[0, :, :2] - 0.05 * modes.shapes[1, :, :2]
    np.testing.assert_allclose(model.mesh.points - before, expected, atol=1e-14)
    with pytest.raises(ct.InputError, match="no mode 3"):
        model.imperfection(modes, {3: 0.1})
    other = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    with pytest.raises(ct.InputError, match="nodes"):
        other.imperfection(modes, [0.1])
