"""An O-ring under a fluid that seeks its way: it seals, and its forces balance."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest


def test_the_sealing_pressure_stays_above_that_of_the_fluid(load) -> None:
    """By about the pressure of the squeeze: rubber passes pressure on like a fluid."""
    example = load("o_ring/o_ring.py")
    pressures = (1.0, 4.0)
    results = example.run(pressures)
    squeezed = example.sealing(results, 1)
    for step, p in enumerate(pressures, start=2):
        found = example.sealing(results, step)
        assert min(found.values()) > p
        for name in ("floor", "lid"):
            assert found[name] == pytest.approx(p + squeezed[name], rel=0.1)
    whole = 2.0 * np.pi * 0.5 * example.CORD
    assert 0.25 * whole < results.frames[-1].scalars["wetted length"] < 0.5 * whole


def test_the_wall_carries_the_fluid_between_its_fronts(load) -> None:
    """Plane strain: pressure times the height between the fronts, on the deformed ring."""
    example = load("o_ring/o_ring.py")
    results = example.run((2.0,), plane="strain")
    frame = results.frames[-1]
    place = results.mesh.points[: len(frame.U)] + frame.U
    loaded = np.flatnonzero(np.hypot(*frame.F[:, :2].T) > 0.0)
    middle = place[loaded, 1].mean()
    fronts = [loaded[side][place[loaded[side], 0].argmax()]
              for side in (place[loaded, 1] > middle, place[loaded, 1] < middle)]  # fmt: skip
    height = float(np.subtract(*place[fronts, 1]))
    assert frame.F[:, 0].sum() == pytest.approx(2.0 * height, rel=1e-9)
    forces = [frame.scalars[f"{name}: force x"] for name in example.JOINTS]
    assert sum(forces) == pytest.approx(-2.0 * height, rel=1e-6)
