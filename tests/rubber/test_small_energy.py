"""Energy of rubber and foam at small strain: half of stress times strain, to all digits."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.laws import RUBBER

LAWS = [*RUBBER.values(), ct.Hyperfoam(mu=[300.0], alpha=[6.0], nu=[0.0])]
SIZE = 1e-6


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_energy_is_quadratic(law: ct.Material, plane: str) -> None:
    """The mean of a strain and its opposite has no third order; the fourth is 1e-12."""
    one = SIZE * np.array([0.7, -0.4, 0.9])
    moduli = law.respond([np.zeros(3)], plane)["tangent"][0]
    both = law.respond([one, -one], plane)["energy"].mean()
    assert both == pytest.approx(0.5 * one @ moduli @ one, rel=1e-8, abs=0.0)
