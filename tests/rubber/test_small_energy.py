"""Energy of rubber and foam at small strain: half of stress times strain, to all digits."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

LAWS = [
    ct.NeoHooke(C10=170.0, D1=0.004),
    ct.MooneyRivlin(C10=100.0, C01=70.0, D1=0.004),
    ct.Yeoh(C10=170.0, C20=20.0, C30=5.0, D1=0.004),
    ct.Ogden(mu=[300.0, 40.0], alpha=[2.0, -2.0], D=[0.004, 0.0]),
    ct.ArrudaBoyce(mu=300.0, limit=3.0, D=0.004),
    ct.Hyperfoam(mu=[300.0], alpha=[6.0], nu=[0.2]),
    ct.Hyperfoam(mu=[300.0], alpha=[6.0], nu=[0.0]),
]
SIZE = 1e-6


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_energy_is_quadratic(law: ct.Material, plane: str) -> None:
    """The mean of a strain and its opposite has no third order; the fourth is 1e-12."""
    one = SIZE * np.array([0.7, -0.4, 0.9])
    moduli = law.respond([np.zeros(3)], plane)["tangent"][0]
    both = law.respond([one, -one], plane)["energy"].mean()
    assert both == pytest.approx(0.5 * one @ moduli @ one, rel=1e-8, abs=0.0)
