"""The reduced system: its tangent is the derivative of its residual, its inertia is right."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from corota.analysis.equations import System
from corota.analysis.evaluation import Evaluation
from support.tied import KINDS, constrained, system_of

TRIALS = [(k, e) for k in KINDS for e in ("Q4I", "Q4D")]


def dense(system: System, at: Evaluation) -> np.ndarray:
    """The reduced matrix."""
    values = at.link.reduce(at.values, at.residual)
    return system.constraints.reduction.pattern.full(values).toarray()


def trial(system: System, seed: int) -> np.ndarray:
    return 0.1 * np.random.default_rng(seed).standard_normal(system.n_dofs)


@pytest.mark.parametrize(("kind", "element"), TRIALS)
def test_tangent_is_the_derivative_of_the_residual(kind: str, element: str) -> None:
    model, _ = constrained(kind, element)
    system = system_of(model)
    constraints = system.constraints
    u = trial(system, 3)
    at = system.evaluate(u, 0.0)
    k = dense(system, at)

    def residual(column: int, h: float) -> np.ndarray:
        moved = u.copy()
        moved[constraints.free[column]] += h
        there = system.evaluate(moved, 0.0)
        return system.reaction(there)[constraints.free]

    h = 1e-6
    for column in range(len(constraints.free)):
        slope = (residual(column, h) - residual(column, -h)) / (2.0 * h)
        assert np.abs(slope - k[:, column]).max() < 1e-8 * np.abs(k).max()


@pytest.mark.parametrize(("kind", "element"), TRIALS)
def test_full_and_symmetric_reductions_agree(kind: str, element: str) -> None:
    model, _ = constrained(kind, element)
    system = system_of(model)
    at = system.evaluate(trial(system, 5), 0.0)
    full = system.pattern.full(at.values).tocsc()
    k = dense(system, at)
    other = at.link.reduce_full(full, at.residual).toarray()
    assert np.abs(other - k).max() <= 1e-13 * np.abs(k).max()


@pytest.mark.parametrize("kind", KINDS)
def test_inertia_counts_the_reduced_matrix(kind: str) -> None:
    model, reference = constrained(kind)
    model.fix("left", rotation=True)
    if kind == "kinematic x":
        model.fix([reference], x=None)
    system = system_of(model)
    from corota.model.steps import Static

    negative = set()
    for seed in range(6):
        system.begin(Static(), 0.0, np.zeros(system.n_dofs), None)
        u = trial(system, seed)
        at = system.evaluate(u, 0.0)
        free = ~system.conditions.constrained[system.constraints.free]
        k = dense(system, at)[np.ix_(free, free)]
        zero = np.zeros(system.n_dofs)
        _, count = system.correct(at, zero, zero)
        assert count == int((np.linalg.eigvalsh(k) < 0.0).sum())
        negative.add(count)
    assert negative != {0}


@pytest.mark.parametrize("kind", KINDS)
def test_corrections_satisfy_the_linearized_constraints(kind: str) -> None:
    from corota.model.steps import Static

    model, reference = constrained(kind)
    model.fix("left", rotation=True)
    if kind == "kinematic x":
        model.fix([reference], x=None)
    system = system_of(model)
    system.begin(Static(), 0.0, np.zeros(system.n_dofs), None)
    at = system.evaluate(trial(system, 8), 1.0)
    u = at.link.u  # type: ignore[union-attr]
    du, _ = system.predict(at, np.zeros(system.n_dofs))
    h = 1e-7 / np.abs(du).max()
    one, two = u + h * du, u - h * du
    system.constraints.complete(one)
    system.constraints.complete(two)
    assert np.abs((one - two) / (2.0 * h) - du).max() < 1e-6 * np.abs(du).max()
