"""Onset of the pattern of holes beside an independent program, on the same mesh."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

from benchmarks.studies.holes_onset import by_numpy, by_package, mesh_of


@pytest.mark.parametrize("both", [pytest.param(False, marks=pytest.mark.slow), True])
def test_onset_is_that_of_elements_of_numpy_alone(both: bool) -> None:
    mesh = mesh_of(4)
    assert by_package(mesh, both) == pytest.approx(by_numpy(mesh, both), rel=1e-7)
