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


def test_displacements_of_all_nodes_are_shapes() -> None:
    model = column()
    field = np.column_stack([0.0 * model.mesh.points, np.ones(model.mesh.n_nodes)])
    field[:, 1] = model.mesh.points[:, 0] ** 2
    before = model.mesh.points.copy()
    model.imperfection(field, [1e-3])
    np.testing.assert_allclose(model.mesh.points - before, 1e-3 * field[:, :2], atol=1e-15)
    for bad in (np.zeros(3), np.full((model.mesh.n_nodes, 2), np.nan)):
        with pytest.raises(ct.InputError, match="shapes of an imperfection"):
            model.imperfection(bad, [1.0])


def test_random_fields_have_their_spread_and_correlation() -> None:
    """Mean of products over draws at distances r: exp(-r^2 / (2 l^2)) within 4 deviations."""
    mesh = ct.mesh.rectangle(3.0, 2.0, nx=3, ny=2)
    length, draws = 1.5, 400
    fields = np.array([ct.mesh.random_field(mesh, length, seed=s) for s in range(draws)])
    distance = np.hypot(*(mesh.points[:, None] - mesh.points[None]).transpose(2, 0, 1))
    expected = np.exp(-0.5 * (distance / length) ** 2)
    for component in range(2):
        measured = np.einsum("sn,sm->nm", *[fields[:, :, component]] * 2) / draws
        assert np.abs(measured - expected).max() < 4.0 * np.sqrt(2.0 / draws)
    across = np.einsum("sn,sm->nm", fields[:, :, 0], fields[:, :, 1]) / draws
    assert np.abs(across).max() < 4.0 / np.sqrt(draws)


def test_random_fields_do_not_depend_on_the_mesh() -> None:
    coarse, fine = (ct.mesh.rectangle(3.0, 2.0, nx=3 * k, ny=2 * k) for k in (1, 2))
    shared = [int(np.argmin(np.hypot(*(fine.points - p).T))) for p in coarse.points]
    one, two = (ct.mesh.random_field(m, 0.7, seed=5) for m in (coarse, fine))
    np.testing.assert_allclose(one, two[shared], atol=1e-13)
    with pytest.raises(ct.InputError, match="correlation length"):
        ct.mesh.random_field(coarse, 0.0)
