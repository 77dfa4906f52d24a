"""The guide moves as beam theory says, and its spring takes its share."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import corota as ct

if TYPE_CHECKING:
    from conftest import Load


def test_stage_against_beam_theory(load: Load) -> None:
    guide = load("guide/guide.py")
    model, stage = guide.guide(force=1.0)
    frame = ct.solve(model, ct.Static(nlgeom=False)).frames[-1]
    inertia = 5.0 * guide.HEIGHT**3 / 12.0
    stiffness = 2.0 * 12.0 * guide.YOUNG * inertia / guide.LENGTH**3 + guide.SPRING
    # The stage turns a little by the stretch of the leaves.
    assert frame.U[stage, 0] == pytest.approx(1.0 / stiffness, rel=2e-3)


def test_stage_comes_down_as_it_moves_across(load: Load) -> None:
    guide = load("guide/guide.py")
    model, stage = guide.guide()
    results = ct.solve(model, ct.Static(increments=10))
    last = results.frames[-1]
    across, down = last.U[stage]
    assert down == pytest.approx(-0.6 * across**2 / guide.LENGTH, rel=0.02)
    assert abs(last.UR[stage]) < 1e-3
    reaction = last.RF[model.mesh.nodes_of("feet"), 0].sum()
    assert reaction + 20.0 == pytest.approx(guide.SPRING * across, rel=1e-8)
