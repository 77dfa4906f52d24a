"""The notch hinge follows beam theory, in both drilling elements and as a deck."""

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


@pytest.mark.parametrize("element", ["Q4D", "OPT"])
def test_hinge_turns_as_beam_theory_says(load: Load, element: str) -> None:
    """Paros and Weisbord (1965); a notch of radius six necks is not quite a beam: 2 %."""
    flexure = load("flexure/flexure.py")
    results = solve_quadratically(flexure.hinge(element), ct.Static(increments=5))
    expected = flexure.beam_rotation(flexure.MOMENT)
    assert flexure.rotation(results) == pytest.approx(expected, rel=0.02)


def test_moment_is_carried_to_the_support(load: Load) -> None:
    flexure = load("flexure/flexure.py")
    results = ct.solve(flexure.hinge("Q4D"), ct.Static(increments=5))
    held = results.mesh.nodes_of("left")
    place, force = results.mesh.points[held], results.frames[-1].RF[held]
    moment = float(np.sum(place[:, 0] * force[:, 1] - place[:, 1] * force[:, 0] + force[:, 2]))
    assert moment == pytest.approx(-flexure.MOMENT, rel=1e-7)


def test_deck_is_the_script(load: Load, examples: Path) -> None:
    flexure = load("flexure/flexure.py")
    model = flexure.hinge("Q4D")
    script = ct.solve(model, ct.Static(increments=10))
    deck = ct.solve(ct.read(examples / "flexure" / "flexure.inp"))
    np.testing.assert_allclose(deck.mesh.points, model.mesh.points, atol=1e-7)
    np.testing.assert_allclose(deck.frames[-1].U, script.frames[-1].U, atol=1e-6)


def test_script_runs(load: Load, capsys) -> None:
    found = load("flexure/flexure.py").main()
    assert set(found) == {"Q4D", "OPT"}
    assert "beam theory" in capsys.readouterr().out
