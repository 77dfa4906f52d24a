"""The strip closes to a circle."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from support.newton import solve_quadratically

if TYPE_CHECKING:
    from conftest import Load


def end(results: ct.Results, name: str) -> np.ndarray:
    nodes = results.mesh.nodes_of(name)
    return (results.mesh.points[nodes] + results.frames[-1].U[nodes]).mean(axis=0)


def test_end_comes_back_to_the_start(load: Load) -> None:
    """Exact for a beam without axial strain: the end meets the start; 0.2 % of the length."""
    rollup = load("rollup/rollup.py")
    results = solve_quadratically(rollup.strip(), ct.Static(increments=20))
    miss = float(np.hypot(*(end(results, "right") - [0.0, rollup.HEIGHT / 2.0])))
    assert miss < 0.002 * rollup.LENGTH
    assert results.frames[-1].UR.max() > 6.0  # counted on, not wrapped


def test_deck_is_the_script(load: Load, examples: Path) -> None:
    script = ct.solve(load("rollup/rollup.py").strip(), ct.Static(increments=20))
    deck = ct.solve(ct.read(examples / "rollup" / "rollup.inp"))
    np.testing.assert_allclose(deck.mesh.points, script.mesh.points, atol=1e-9)
    np.testing.assert_allclose(end(deck, "tip"), end(script, "right"), atol=1e-6)


def test_script_runs(load: Load, capsys) -> None:
    results = load("rollup/rollup.py").main()
    assert results.frames[-1].factor == pytest.approx(1.0)
    assert "degrees" in capsys.readouterr().out
