"""Increments that are cut to a share of themselves."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct
from corota.analysis.increments import Increments


@pytest.mark.parametrize(("size", "smallest"), [(0.54, 0.017), (0.59, 0.084), (0.5, 0.1)])
def test_a_cut_to_the_smallest_increment_is_not_below_it_by_rounding(
    size: float, smallest: float
) -> None:
    control = Increments(ct.Static(first_increment=size, smallest_increment=smallest))
    assert control.cut(size, smallest / size) == ""
    assert control.size == pytest.approx(smallest)
    assert "smallest increment" in control.cut(smallest, 0.5)
