# SPDX-License-Identifier: BSD-3-Clause
"""Lemke's method against enumeration of all bases (Cottle, Pang and Stone 2009, ch. 1.1).

Unilateral constraints with friction: the same solution about every state and from every one.
"""

import itertools
from time import perf_counter

import numpy as np
import pytest

from corota._core import unilateral


def lemke(c, m, start=None):
    """``y = c + m x``, both positive or zero, as constraints without friction."""
    n = len(c)
    normal = np.zeros((n, 1 + 2 * n))
    normal[:, 0], normal[:, 1::2] = c, m
    states = None if start is None else start.astype(np.int8)
    none = np.zeros((0, 1 + 2 * n))
    given = np.zeros(n, np.int8), np.ones(n), np.zeros(n), np.zeros(n, bool), normal, none
    found = unilateral(*given, states)
    return None if found is None else (found[3], found[1] == 1)


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


def test_from_a_singular_basis_the_solution_is_that_without_it():
    m = np.array([[0.0, 1.0], [-1.0, 0.0]])
    x, _ = lemke(np.array([-1.0, 1.0]), m, np.array([True, False]))
    np.testing.assert_allclose(x, 1.0)


def test_from_a_basis_singular_to_rounding_no_wrong_solution_comes():
    """Two equal rows whose elimination leaves a pivot of rounding."""
    m = 1.1 * np.array([[2.0, 1.0, 1.0], [1.0, 3.0, 3.0], [1.0, 3.0, 3.0]])
    c = np.array([-1.0, -0.3, -0.31])
    x, _ = lemke(c, m, np.ones(3, bool))
    assert np.abs(np.minimum(x, c + m @ x)).max() < 1e-9


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


def frictional(rng, n):
    """Compliance of n constraints by p and q, their gaps and slips without forces, friction."""
    g = rng.normal(size=(2 * n, 2 * n + 4))
    matrix = g @ g.T / (2 * n)
    return matrix, rng.normal(size=2 * n), rng.uniform(0.05, 0.2, n)


def about(states, directions, mu, matrix, free):
    """Constraints linearized about states: p and q are eliminated where their gaps and slips are
    given, and q = mu d p + an input where they slip."""
    n = len(states)
    closed, stuck = states != 0, states == 1
    # Forces z = start + inputs; what is closed or stuck has its gap or slip as an input.
    follow = np.eye(2 * n)
    slips = np.flatnonzero(states == 2)
    follow[n + slips, slips] = mu[slips] * directions[slips]
    unknown = np.concatenate([closed, stuck])
    a = matrix @ follow
    z = np.zeros((2 * n, 1 + 2 * n))
    column = 1 + np.concatenate([2 * np.arange(n), 2 * np.arange(n) + 1])
    z[~unknown, column[~unknown]] = 1.0
    right = np.zeros((2 * n, 1 + 2 * n))
    right[unknown, column[unknown]] = 1.0
    right[:, 0] = -free
    right -= a[:, ~unknown] @ z[~unknown]
    z[unknown] = np.linalg.solve(a[np.ix_(unknown, unknown)], right[unknown])
    moved = a @ z
    moved[:, 0] += free
    tractions = follow @ z
    return (
        np.where(closed[:, None], z[:n], moved[:n]),
        np.where(stuck[:, None], tractions[n:], moved[n:]),
    )


@pytest.mark.parametrize("seed", range(12))
def test_constraints_with_friction_have_one_solution_about_every_state(seed):
    """With little friction it is unique; it is checked by the conditions themselves."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 7))
    matrix, free, mu = frictional(rng, n)
    for start in (None, *(rng.integers(0, 3, n).astype(np.int8) for _ in range(3))):
        states = rng.integers(0, 3, n).astype(np.int8)
        directions = np.where(rng.random(n) < 0.5, 1.0, -1.0)
        normal, tangent = about(states, directions, mu, matrix, free)
        rubs = np.ones(n, bool)
        found = unilateral(states, directions, mu, rubs, normal, tangent, start)
        assert found is not None
        _, after, senses, p, q = found
        gap, slip = np.split(free + matrix @ np.append(p, q), 2)
        size = 1e-9 * (1.0 + np.abs(np.append(p, q)).max())
        assert (p >= -size).all()
        assert (gap >= -size).all()
        assert np.abs(gap[after != 0]).max(initial=0.0) < size
        assert (p[after == 0] == 0.0).all()
        assert (q[after == 0] == 0.0).all()
        assert (np.abs(q) <= mu * p + size).all()
        assert np.abs(slip[after == 1]).max(initial=0.0) < size
        slips = after == 2
        assert np.abs(q - senses * mu * p)[slips].max(initial=0.0) < size
        assert (slip * senses)[slips].max(initial=0.0) < size


def test_far_from_the_solution_the_sets_are_given_up():
    """From states at random, sets may change for minutes before one comes back: here for 14 s."""
    rng = np.random.default_rng(4)
    n = 120
    a = rng.normal(size=(2 * n, 2 * n + 4))
    matrix, free = a @ a.T / (2 * n), rng.normal(size=2 * n)
    given = [np.zeros(n, np.int8), np.ones(n), np.full(n, 0.2), np.ones(n, bool)]
    table = np.column_stack([free, matrix.reshape(2 * n, 2, n).swapaxes(1, 2).reshape(2 * n, -1)])
    whole = unilateral(*given, table[:n], table[n:])
    begun = perf_counter()
    near = unilateral(*given, table[:n], table[n:], rng.integers(0, 3, n).astype(np.int8))
    assert perf_counter() - begun < 3.0
    for found, expected in zip(near, whole, strict=True):
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9)
