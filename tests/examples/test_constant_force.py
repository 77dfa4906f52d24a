"""The constant-force flexure: a few designs lower the unevenness of its force."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest


@pytest.mark.filterwarnings("ignore:increment")  # designs on the way snap
def test_force_becomes_even(load) -> None:
    example = load("constant_force/constant_force.py")
    found = example.optimum(most=6, cells=4, threads=1)
    first, best = found.history[0].values[0], found.value
    assert best < 0.3 * first
