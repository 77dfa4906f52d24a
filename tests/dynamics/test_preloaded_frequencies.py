"""Frequencies of spinning, loaded and heated parts beside CalculiX's stored answers."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json

import numpy as np
import pytest

from benchmarks.studies.preloaded_frequencies import CASES, STORED, ours

#: Linear states that ``test_linear_state.py`` assembles apart, as here and as in CalculiX.
APART = (
    "spin of 4000 rad/s, linear preload",
    "tension of 20 kN, linear preload",
    "bent by 3 kN across, linear preload",
    "one end moved across by 20, linear preload",
)
THEIRS = json.loads(STORED.read_text(encoding="utf-8"))


@pytest.mark.parametrize("case", [case for case in CASES if case not in APART])
def test_frequencies_of_a_preloaded_part_are_those_of_calculix(case: str) -> None:
    """Of a linear preload to its strain; bent parts to CalculiX's half percent."""
    linear = "linear" in case
    np.testing.assert_allclose(ours(case), THEIRS[case], rtol=1e-3 if linear else 1.2e-4)
    if CASES[case][2] and not linear:
        # The preload changes the first frequency by far more than that.
        assert abs(ours(case)[0] / ours("at rest")[0] - 1.0) > 3e-3
