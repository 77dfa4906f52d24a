"""The bistable switch: forces, travel and stability."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from pathlib import Path


def test_the_switch_is_bistable_with_the_estimated_travel(load) -> None:
    """The formulas are for rises small against the span; here it is 8 %."""
    example = load("switch/switch.py")
    results, node = example.follow(cells=12)
    push, pull, travel = example.summary(results, node)
    rough = example.estimate()
    assert travel == pytest.approx(rough[2], rel=0.01)
    assert push == pytest.approx(rough[0], rel=0.15)
    assert pull == pytest.approx(rough[1], rel=0.25)
    # Both positions of rest are stable, the one between them is not.
    factor = results.history("load factor").values
    stable = results.history("stable").values
    rest = np.flatnonzero(factor[:-1] * factor[1:] < 0.0)
    assert [bool(stable[i]) for i in rest] == [False, True]


def test_forces_approach_the_formulas_for_flat_flexures(load, monkeypatch) -> None:
    """A quarter of rise and depth: the largest push within 3 %."""
    example = load("switch/switch.py")
    for name in ("RISE", "DEPTH", "GAP"):
        monkeypatch.setattr(example, name, getattr(example, name) / 4.0)
    results, node = example.follow(cells=24)
    push, _, travel = example.summary(results, node)
    rough = example.estimate()
    assert push == pytest.approx(rough[0], rel=0.03)
    assert travel == pytest.approx(rough[2], rel=0.01)


def test_the_picture_of_the_path_is_drawn(load, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    example = load("switch/switch.py")
    results, node = example.follow(cells=8)
    results.history("U2", at=[node]).plot("load factor", path=tmp_path / "switch.png")
    assert (tmp_path / "switch.png").stat().st_size > 5000
