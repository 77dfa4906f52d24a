# SPDX-License-Identifier: BSD-3-Clause
"""Lemke's method against enumeration of all bases (Cottle, Pang and Stone 2009, ch. 1.1)."""

import itertools

import numpy as np
import pytest

from corota._core import lemke


def enumerated(c, m):
    """All solutions: every choice of which x is in the basis."""
    n, found = len(c), []
    for chosen in itertools.product([False, True], repeat=n):
        basic = np.array(chosen)
        x = np.zeros(n)
        try:
            x[basic] = np.linalg.solve(m[np.ix_(basic, basic)], -c[basic])
        except np.linalg.LinAlgError:
            continue
        if min(x.min(initial=0.0), (c + m @ x).min(initial=0.0)) > -1e-10:
            found.append(x)
    return found


@pytest.mark.parametrize("seed", range(20))
def test_the_solution_of_a_positive_matrix_is_that_of_enumeration(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 9))
    a = rng.normal(size=(n, n))
    m, c = a @ a.T + 0.01 * np.eye(n) + 0.3 * (a - a.T), rng.normal(size=n)
    x, basic = lemke(c, m)
    (only,) = enumerated(c, m)
    np.testing.assert_allclose(x, only, atol=1e-8 * (1.0 + np.abs(only).max()))
    assert (x[~basic] == 0.0).all()


@pytest.mark.parametrize("seed", range(20))
def test_from_any_basis_the_solution_is_the_same(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 30))
    a = rng.normal(size=(n, n))
    m, c = a @ a.T + 0.1 * np.eye(n) + 0.3 * (a - a.T), rng.normal(size=n)
    x, basic = lemke(c, m)
    again, same = lemke(c, m, rng.random(n) < 0.5)
    np.testing.assert_allclose(again, x, atol=1e-8 * (1.0 + x.max()))
    assert (same == basic).all()


def test_from_a_singular_basis_there_is_none():
    m = np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert lemke(np.array([-1.0, 1.0]), m, np.array([True, False])) is None


def test_from_a_basis_singular_to_rounding_no_wrong_solution_comes():
    """Two equal rows whose elimination leaves a pivot of rounding."""
    m = 1.1 * np.array([[2.0, 1.0, 1.0], [1.0, 3.0, 3.0], [1.0, 3.0, 3.0]])
    c = np.array([-1.0, -0.3, -0.31])
    found = lemke(c, m, np.ones(3, bool))
    assert found is None or np.abs(np.minimum(found[0], c + m @ found[0])).max() < 1e-9


def friction(c, m, mu):
    """Klarbring's matrix of a contact point with pressure, traction bound and slip."""
    (a, b), (_, d) = m
    # y = gap, slip against the traction, other side of the bound; x = pressure, slack, slip.
    big = np.array(
        [[a + mu * b, -b, 0.0], [-(b + mu * d), d, 1.0], [2.0 * mu, -1.0, 0.0]],
    )
    return np.array([c[0], -c[1], 0.0]), big


@pytest.mark.parametrize("slide", [-3.0, -0.1, 0.0, 0.1, 3.0])
def test_a_point_with_friction_sticks_or_slips(slide):
    """A spring-held point pressed by 1: it sticks while the force along is below mu."""
    c, m = friction((-1.0, slide), ((1.0, 0.0), (0.0, 1.0)), mu=0.5)
    x, _ = lemke(c, m)
    traction = 0.5 * x[0] - x[1]
    assert x[0] == pytest.approx(1.0)
    assert traction == pytest.approx(np.clip(-slide, -0.5, 0.5), abs=1e-12)


def test_where_there_is_no_solution_none_is_given():
    assert lemke(np.array([-1.0]), np.array([[-1.0]])) is None
    assert lemke(np.array([-1.0, -1.0]), np.array([[0.0, 1.0], [-1.0, 0.0]])) is None


def test_ties_of_a_symmetric_problem_end():
    n = 12
    m = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    c = -np.ones(n)
    c[0] = c[-1] = 0.0
    x, _ = lemke(c, m)
    np.testing.assert_allclose(x, x[::-1], atol=1e-12)
    assert (c + m @ x).min() > -1e-12
