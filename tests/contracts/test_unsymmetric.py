"""Unsymmetric tangents: the full matrix, held dofs, and one ordering for a pattern."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest
import scipy.sparse as sp

from corota.analysis.linear.matrix import SymmetricPattern
from corota.analysis.linear.unsymmetric import FullMatrix, MaskedLu
from corota.errors import SingularError


def upper_triangle(n, rng):
    """Random symmetric matrix with a strong diagonal, and its upper triangle by columns."""
    full = sp.random_array((n, n), density=0.2, rng=rng).toarray()
    full = full + full.T + 4.0 * np.eye(n)
    return full, sp.triu(sp.csc_array(full)).tocsc()


def pattern_of(upper):
    return SymmetricPattern(upper.indptr, upper.indices, np.arange(upper.shape[0]))


def test_full_matrix_adds_entries_to_both_triangles_and_keeps_its_pattern():
    rng = np.random.default_rng(3)
    full, upper = upper_triangle(12, rng)
    matrices = FullMatrix(pattern_of(upper))
    rows, columns = np.array([0, 11, 0, 5]), np.array([11, 0, 11, 5])
    more = np.array([2.0, 3.0, 0.5, 1.0])
    built = matrices.build(upper.data, rows, columns, more)
    expected = full.copy()
    np.add.at(expected, (rows, columns), more)
    assert np.array_equal(built.toarray(), expected)
    # An entry that vanishes in one state keeps its place.
    again = matrices.build(upper.data, rows[3:], columns[3:], more[3:])
    assert np.array_equal(again.indices, built.indices)
    full[5, 5] += 1.0
    assert np.array_equal(again.toarray(), full)


def test_masked_solution_is_that_of_the_free_equations_and_orders_once(monkeypatch):
    rng = np.random.default_rng(4)
    lu, held = MaskedLu(), np.zeros(12, bool)
    held[[2, 7]] = True
    analyzed = []
    analyze = lu._solver.analyze
    monkeypatch.setattr(lu._solver, "analyze", lambda *a: (analyzed.append(1), analyze(*a)))
    upper = upper_triangle(12, rng)[1]
    matrices = FullMatrix(pattern_of(upper))
    for skew in (0.5, 1.5):
        entry = (np.array([1]), np.array([3]), np.array([skew]))
        matrix = matrices.build(upper.data, *entry)
        rhs = np.where(held, 0.0, rng.normal(size=12))
        lu.factorize(matrix, held, np.arange(12))
        free = np.flatnonzero(~held)
        expected = np.linalg.solve(matrix.toarray()[np.ix_(free, free)], rhs[free])
        assert lu.solve(rhs)[free] == pytest.approx(expected, rel=1e-12, abs=1e-12)
    assert len(analyzed) == 1


def test_held_equation_without_a_diagonal_entry_gets_one():
    matrix = sp.csc_array(np.array([[0.0, 1.0, 0.0], [2.0, 3.0, 1.0], [0.0, 0.5, 2.0]]))
    matrix.eliminate_zeros()
    lu, held = MaskedLu(), np.array([True, False, False])
    lu.factorize(matrix, held, np.arange(3))
    x = lu.solve(np.array([0.0, 1.0, 1.0]))
    expected = np.linalg.solve(matrix.toarray()[1:, 1:], [1.0, 1.0])
    assert x == pytest.approx([0.0, *expected], rel=1e-14)


def test_singular_matrix_is_refused():
    matrix = sp.csc_array(np.array([[1.0, 2.0], [2.0, 4.0]]))
    lu = MaskedLu()
    lu.factorize(matrix, np.zeros(2, bool), np.arange(2))
    with pytest.raises(SingularError):
        lu.solve(np.array([1.0, 0.0]))
