"""Taylor's impact beside two explicit programs, and by two schemes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest


@pytest.mark.filterwarnings("ignore:central differences took")
def test_both_schemes_have_the_same_bar(load) -> None:
    """A coarse mesh, by central differences and by the energy-momentum scheme; energy kept.

    With 100, 200, 400 increments the strain is 1.353, 1.307, 1.300; by central differences 1.298.
    """
    example = load("taylor_bar/taylor_bar.py")
    explicit = example.strike("central_difference", 2, 12, 700)
    conserving = example.strike("energy_momentum", 2, 12, 100)
    one, two = (np.array(example.figures(r)) for r in (explicit, conserving))
    np.testing.assert_allclose(two, one, rtol=0.05)
    assert abs(conserving.frames[-1].scalars["energy balance error"]) < 1e-8
    # The work that heats is nine tenths of the plastic one, most of the kinetic energy.
    frame = conserving.frames[-1]
    begun = conserving.frames[0].scalars["kinetic energy"]
    assert 0.9 * begun < frame.scalars["ALLPD"] < begun
    assert one[0] == pytest.approx(26.54, rel=0.01)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:central differences took")
@pytest.mark.parametrize("scheme", ["central_difference", "energy_momentum"])
def test_taylor_bar_beside_two_programs(load, scheme: str) -> None:
    """Their mesh of 5 x 50 cells: 26.52 to 26.56, 11.15 to 11.16, 582 to 591, 1.78 to 1.81."""
    example = load("taylor_bar/taylor_bar.py")
    length, diameter, heat, strain = example.figures(example.strike(scheme))
    assert length == pytest.approx(26.54, rel=3e-3)
    assert diameter == pytest.approx(11.155, rel=3e-3)
    assert heat == pytest.approx(586.5, rel=0.02)
    assert strain == pytest.approx(1.795, rel=0.02)
