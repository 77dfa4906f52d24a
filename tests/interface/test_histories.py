"""Histories are arrays of numbers with a name."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.results.history import History


@pytest.fixture(scope="module")
def results() -> ct.Results:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 10, 1))
    model.section(element="Q4I", material=ct.Elastic(1e3, 0.3))
    model.fix("left")
    model.force("right", y=-0.1)
    return ct.solve(model, ct.Static(increments=4), threads=1)


def test_arithmetic_gives_histories(results: ct.Results) -> None:
    u, v = results.history("U1", at="right"), results.history("U2", at="right")
    for found, wanted in (
        (u + v, u.values + v.values),
        (2 * v, 2 * v.values),
        (v / 4.0, v.values / 4.0),
        (-v, -v.values),
        (abs(v), np.abs(v.values)),
        (v**2, v.values**2),
        (np.hypot(u, v), np.hypot(u.values, v.values)),
        (v - np.ones(5), v.values - 1.0),
    ):
        assert isinstance(found, History)
        np.testing.assert_array_equal(found.values, wanted)
        assert found.results is results
    assert (2 * v + u).name == "((2 * U2 at right) + U1 at right)"
    assert abs(v).name == "abs(U2 at right)"


def test_comparisons_give_masks(results: ct.Results) -> None:
    v = results.history("U2", at="right")
    mask = v < 0.5 * v[-1]
    assert mask.dtype == bool
    assert v[mask].tolist() == [x for x in v if x < 0.5 * v[-1]]
    assert (v == v).all()


def test_numpy_takes_them(results: ct.Results) -> None:
    v = results.history("U2", at="right")
    assert v.shape == (5,)
    assert np.max(v) == v.max() == max(v) == 0.0
    assert np.argmin(v) == 4
    assert (np.diff(v) < 0.0).all()
    assert np.sum(v) == pytest.approx(v.values.sum())


def test_values_between_increments(results: ct.Results) -> None:
    v = results.history("U2", at="right")
    assert v.at(1.0) == v[-1]
    assert v.at(0.375) == pytest.approx(0.5 * (v[1] + v[2]))
    assert v.at([0.0, 0.5]).tolist() == [v[0], v[2]]
    with pytest.raises(ct.InputError, match=r"known from time 0 to 1, not at 1\.5"):
        v.at(1.5)


def test_combined_histories_are_drawn(results: ct.Results, tmp_path: object) -> None:
    v = results.history("U2", at="right")
    figure = (1e3 * abs(v)).plot(against=results.history("time"))
    assert figure.axes[0].get_ylabel() == "1000 * abs(U2 at right)"


def test_histories_of_different_lengths_are_refused(results: ct.Results) -> None:
    v = results.history("U2", at="right")
    other = History("U2", v.values[:3], results)
    with pytest.raises(ct.InputError, match="3 and 5 increments"):
        v + other
