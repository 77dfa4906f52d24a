"""The portal frame beside its mechanism: load, places and rotations of the hinges."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest


def test_portal(load) -> None:
    portal = load("portal/portal.py")
    results = portal.push(False)
    # Axial forces take a little of the plastic moments: at most N / (9 mm x 170 mm x 235 MPa) of
    # the web, squared, in the right column, which carries 3/4 of V + H.
    assert 0.994 < results.frames[-1].factor / portal.COLLAPSE < 1.0
    found = np.array(portal.hinges(results))
    assert found[:, :2].tolist() == [[0, 0], [4000, 4000], [8000, 4000], [8000, 0]]
    # Once it is a mechanism, the hinges turn by the sway over the height, the inner ones twice.
    earlier = np.array(portal.hinges(portal.push(False, 200.0)))
    turned = np.abs(found[:, 2] - earlier[:, 2])
    assert turned == pytest.approx(100.0 / portal.A * np.array([1.0, 2.0, 2.0, 1.0]), rel=0.03)
    assert np.abs(found[:, 3:]) == pytest.approx(portal.YIELD, rel=1e-6)
