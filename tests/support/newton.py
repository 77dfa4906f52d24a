"""Records Newton's iterations and judges how they end."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import corota as ct
from corota.results.observer import BaseObserver, Iteration

if TYPE_CHECKING:
    from corota.model.steps import Step

#: Relative residual below which only rounding is left.
ROUNDING = 1e-11


class Residuals(BaseObserver):
    """Residuals of every attempt, by step, increment and attempt."""

    def __init__(self) -> None:
        self.by_attempt: dict[tuple[int, int, int], list[float]] = defaultdict(list)

    def iteration(self, info: Iteration) -> None:
        key = (info.step, info.increment, info.attempt)
        self.by_attempt[key].append(max(info.residual, info.moment_residual))


def solve_quadratically(model: ct.Model, step: Step | None = None) -> ct.Results:
    """Solve, and check that every increment ends with a quadratic iteration.

    Residuals are relative, so that quadratic means ``r_last <= r_before^2`` until rounding. In
    bending the residuals fall in pairs (the second of a pair mends the stretching that
    the first one leaves), so the last one is judged. A linear rate, even of 1/100, fails:
    it ends between the tolerance and a hundredth of it, far above the square.
    """
    watch = Residuals()
    results = ct.solve(model, step, observers=[watch])
    assert watch.by_attempt
    for key, residuals in watch.by_attempt.items():
        before, last = residuals[-2:]
        assert last <= max(before**2, ROUNDING), (key, residuals)
    return results
