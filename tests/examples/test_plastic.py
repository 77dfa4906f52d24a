"""The plastic examples claim what they show."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from conftest import Load


def test_perforated_strip_flows_and_thins(load: Load) -> None:
    rows = np.array(load("perforated_strip/perforated_strip.py").run(n=4))
    elongation, force, peeq, thickness = rows.T
    assert elongation[-1] == pytest.approx(3.0)
    assert (np.diff(force) > 0).all()
    assert peeq[-1] > 0.4
    assert np.diff(peeq).max() <= 0.1
    assert thickness[-1] < 0.85


@pytest.mark.filterwarnings("ignore:local strain reaches")
def test_plastic_cook_converges(load: Load) -> None:
    module = load("plastic_cook/plastic_cook.py")
    for element in ("Q4I", "Q8"):
        values = [module.tip(element, n) for n in (4, 8)]
        assert values[0] < values[1]
        assert values[1] == pytest.approx(6.56, rel=0.02)


@pytest.mark.filterwarnings("ignore:local strain reaches")
def test_snap_fit_springs_back_and_keeps_a_set(load: Load) -> None:
    first, second = load("snap_fit/snap_fit.py").run()
    assert abs(first[2]) < 1e-9
    assert first[3] == 0.0
    assert 0.5 < second[2] < 2.0
    assert second[3] > 0.005


def test_cyclic_strip_ratchets(load: Load) -> None:
    module = load("cyclic_strip/cyclic_strip.py")
    found = {name: module.run(law, cycles=3) for name, law in module.materials().items()}
    growth = np.diff(found["two back-stresses"])
    assert (growth > 5e-4).all()
    assert np.abs(np.diff(found["linear kinematic"])).max() < 1e-9


def test_cantilever_reaches_its_limit_load(load: Load) -> None:
    curve, rest = load("limit_load/limit_load.py").run()
    displacement, force = np.array(curve).T
    assert displacement[-1] == pytest.approx(0.5)
    # Beam theory neglects that the clamp holds the width too.
    assert 1.0 < force[-1] < 1.05
    assert force[-1] - force[-2] < 1e-3
    assert rest == pytest.approx(0.5 - 0.1, abs=0.03)
