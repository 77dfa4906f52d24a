"""Extrapolation, averaging and invariants."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from corota.errors import InputError
from corota.mesh.kinds import KINDS, PLANAR
from corota.mesh.shape_functions import shape_functions, shape_gradients
from corota.model.materials import Elastic
from corota.results import invariants
from corota.results.averaging import extrapolation, section_of_cells

ROUNDOFF = 1e-12


@pytest.mark.parametrize("kind", PLANAR)
@pytest.mark.parametrize("points", [1, 3, 4, 6, 9])
def test_extrapolation_keeps_linear_fields(kind, points):
    """Enough points give back a linear field at the nodes; too few give back a constant."""
    rng = np.random.default_rng(points)
    at = rng.uniform(0.05, 0.45, (points, 2))
    nodes = np.array(KINDS[kind].natural)
    matrix = extrapolation(kind, shape_functions(kind, at))
    assert matrix @ np.full(points, 7.0) == pytest.approx(np.full(len(nodes), 7.0), abs=1e-10)
    if points >= 3:
        values = 2.0 + 3.0 * at[:, 0] - 5.0 * at[:, 1]
        wanted = 2.0 + 3.0 * nodes[:, 0] - 5.0 * nodes[:, 1]
        assert matrix @ values == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("kind", PLANAR)
def test_drawn_shape_functions_are_one_at_their_node(kind):
    nodes = np.array(KINDS[kind].natural)
    assert shape_functions(kind, nodes) == pytest.approx(np.eye(len(nodes)), abs=ROUNDOFF)


@pytest.mark.parametrize("kind", PLANAR)
def test_gradients_of_shape_functions_are_their_derivatives(kind):
    """Central differences are exact for polynomials of second order in each coordinate."""
    at = np.random.default_rng(1).uniform(0.0, 0.5, (7, 2))
    for axis, shift in enumerate(np.eye(2)):
        ahead, behind = (shape_functions(kind, at + sign * shift) for sign in (1.0, -1.0))
        found = shape_gradients(kind, at)[:, axis]
        assert found == pytest.approx(0.5 * (ahead - behind), abs=ROUNDOFF)


def test_nodal_average_of_a_linear_field_is_exact(results):
    x, y = results.mesh.points.T
    assert results.nodal("S11") == pytest.approx(1.0 + x, abs=ROUNDOFF)
    assert results.nodal("sxy", 2) == pytest.approx(0.5 * y, abs=ROUNDOFF)


def test_mises_is_taken_from_averaged_components(results):
    x, y = results.mesh.points.T
    wanted = np.sqrt((1.0 + x) ** 2 + 3.0 * y**2)
    assert results.nodal("Mises") == pytest.approx(wanted, abs=ROUNDOFF)


def test_mises_counts_the_stress_through_the_thickness():
    assert invariants.mises(np.array([2.0, 2.0, 2.0, 0.0])) == pytest.approx(0.0, abs=ROUNDOFF)
    assert invariants.mises(np.array([0.0, 0.0, -3.0, 0.0])) == pytest.approx(3.0)


def test_principal_values_come_largest_first_and_keep_the_trace():
    tensor = np.array([3.0, -1.0, 0.5, 2.0])
    values = invariants.principal(tensor)
    matrix = np.array([[3.0, 2.0, 0.0], [2.0, -1.0, 0.0], [0.0, 0.0, 0.5]])
    assert values == pytest.approx(np.linalg.eigvalsh(matrix)[::-1])
    assert invariants.principal(np.array([0.0, 0.0, 0.0, 0.5])) == pytest.approx([0.5, 0.0, -0.5])


def test_averages_do_not_cross_sections(model, fake):
    model.sections.clear()
    model.section([0], element="Q4I", material=Elastic(E=1000.0, nu=0.3), thickness=0.1)
    model.section([1], element="Q4I", material=Elastic(E=2000.0, nu=0.3), thickness=0.1)
    results = fake.play(model)
    block = results.frames[-1].fields[0]
    block.values["S"][0, :, 0], block.values["S"][1, :, 0] = 1.0, 5.0
    shared = int(np.flatnonzero(results.mesh.points[:, 0] == 1.0)[0])
    assert results.nodal("S11", section=0)[shared] == pytest.approx(1.0)
    assert results.nodal("S11", section=1)[shared] == pytest.approx(5.0)
    assert results.nodal("S11")[shared] == pytest.approx(5.0)  # the larger by size


def test_equal_sections_of_different_cell_kinds_are_one_group(model):
    model.section([1], element="Q4", material=Elastic(E=1000.0, nu=0.3), thickness=0.1)
    assert section_of_cells(model).tolist() == [0, 0]


def test_unknown_variable_names_the_nearest_and_lists_all(results):
    with pytest.raises(InputError, match=r"no result variable named 'MISSES'; did you mean MISES"):
        results.nodal("MISSES")
    with pytest.raises(InputError, match="U1, U2, U, UR3"):
        results.history("nonsense")


def test_history_combines_forces_by_sum_and_displacements_by_mean(results):
    U2 = results.history("U2", at="RIGHT")
    assert U2.values == pytest.approx(0.2 * np.linspace(0.0, 1.0, 5))
    total = results.history("RF2", at="LEFT")
    assert total.values == pytest.approx(np.linspace(0.0, 1.0, 5))
    assert results.history("load factor").values == pytest.approx(np.linspace(0.0, 1.0, 5))
    assert results.history("strain energy")[-1] == pytest.approx(1.0)
    assert results.history("MISES").max() == pytest.approx(
        invariants.mises(results.frames[-1].fields[0].values["S"]).max()
    )


def test_last_only_keeps_one_frame(model, fake):
    from corota.results.results import Results

    results = Results(model, keep="last")
    for i in range(3):
        results.add(fake.state(model, 1, i, float(i), float(i)))
    assert [f.increment for f in results.frames] == [2]


def test_notebook_table_escapes_names(results):
    results.model.name = "<b>"
    results.notes.append("a < b")
    text = results._repr_html_()
    assert "&lt;b&gt;" in text
    assert "a &lt; b" in text
