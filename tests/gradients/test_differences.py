"""Differences beside kinks: each point that begins to flow leaves one."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np

from corota.gradients.differences import derivative, step_between_kinks


def test_first_step_stays_before_the_next_of_many_points_that_begin_to_flow():
    # 100 thousand points with five variables each begin to flow one after the other: the sum has a
    # slope of one, and a kink at each of them.
    points = 100_000
    kinks = (2.0 + np.arange(points)) / points

    def total(change):
        return np.array([change + np.maximum(change - kinks, 0.0).sum() / points]), np.ones(1)

    slope, rough = derivative(total, 1.0, step_between_kinks(5 * points))
    assert abs(slope[0] - 1.0) < 1e-9
    assert rough[0] == 0.0
    # Longer steps are smooth by what they see, and wrong.
    slope, rough = derivative(total, 1.0)
    assert rough[0] < 1e-5
    assert abs(slope[0] - 1.0) > 1e-6


def test_few_points_have_the_long_step():
    assert step_between_kinks(0) == step_between_kinks(1000) == 1e-3
