"""GMRES for a factorized matrix and entries beside it: the dense solution, or none."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from corota.analysis.linear.gmres import gmres
from corota.analysis.linear.triplets import Triplets


def _problem(value: float) -> tuple[np.ndarray, Triplets]:
    rng = np.random.default_rng(4)
    matrix = rng.normal(size=(12, 12)) + 12.0 * np.eye(12)
    rows, columns = np.array([0, 3, 11, 7]), np.array([5, 2, 0, 7])
    return matrix, Triplets(rows, columns, np.full(4, value))


@pytest.mark.parametrize("value", [0.0, 1e-6, 1.0, 50.0])
def test_the_dense_solution(value: float) -> None:
    matrix, rest = _problem(value)
    b = np.arange(1.0, 13.0)
    whole = matrix.copy()
    np.add.at(whole, (rest.rows, rest.columns), rest.values)
    x, _ = gmres(lambda v: np.linalg.solve(matrix, v), rest, b, 8)
    assert x is not None
    np.testing.assert_allclose(x, np.linalg.solve(whole, b), rtol=1e-7)


@pytest.mark.parametrize("value", [1e200, 1e300, np.inf, np.nan])
def test_none_where_numbers_overflow(value: float) -> None:
    matrix, rest = _problem(value)
    with np.errstate(all="ignore"):
        x, _ = gmres(lambda v: np.linalg.solve(matrix, v), rest, np.ones(12), 8)
    assert x is None
    with np.errstate(all="ignore"):
        x, _ = gmres(lambda v: np.linalg.solve(matrix, v), rest, np.full(12, value), 8)
    assert x is None
