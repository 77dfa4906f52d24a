"""An annular snap-fit beside shell theory and CalculiX, and a strip in plane strain."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest


def test_snap_fit_is_pushed_on_and_pulled_off(load) -> None:
    """Land: mu N of the shell within 5 %; largest forces within 10 % of its slopes.

    CalculiX with increments of .02: 1425 at 2.98, 592 on the land, 1482 of retention.
    """
    example = load("snap_fit/annular.py")
    land, insertion = example.estimates()
    stages = example.pushed(*example.snap_fit("axisymmetric"), *example.STAGES)
    assert stages[2][-1, 1] == pytest.approx(land, rel=0.05)
    assert float(np.interp(2.98, *stages[1].T)) == pytest.approx(1425.0, rel=0.02)
    assert stages[2][-1, 1] == pytest.approx(592.4, rel=0.02)
    assert stages[1][:, 1].max() == pytest.approx(insertion, rel=0.1)
    # Off again over the same lip: the wall turns the other way about.
    assert -stages[5][:, 1].min() == pytest.approx(1482.0, rel=0.03)
    assert stages[3][-1, 1] == pytest.approx(0.0, abs=1e-6)


def test_plane_strain_says_nothing_of_a_snap_fit(load) -> None:
    """A cantilever of the same section and depth, 3 E I / (1 - nu^2) L^3, has no hoop."""
    example = load("snap_fit/annular.py")
    land = example.pushed(*example.snap_fit("strain"), *example.STAGES[:3])[2][-1, 1]
    assert land == pytest.approx(example.cantilever(), rel=0.1)
    assert land < 0.02 * 579.0
