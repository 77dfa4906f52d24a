"""What two versions of a contact run are compared by: depths from geometry, and when two agree."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from copy import deepcopy

import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.contact_answers import answer, deeper, same
from benchmarks.corpora.contact_problems import Problem


def _block(method: str, way: float) -> tuple[Problem, ct.Results]:
    """A fillet that is narrower than an edge, pushed into a block or left above it."""
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2)
    tool = ct.mesh.add_node(mesh, 2.25, 2.0, "tool")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("bottom")
    model.fix("tool", x=0.0, y=-way, rotation=True)
    curve = ct.RigidCurve.circle((2.25, 1.1), 0.1, reference=tool)
    model.contact("top", curve, name="tool", method=method)
    step = ct.Static(increments=2)
    return Problem("block-0", "", model, [step]), ct.solve(model, step, threads=1)


def test_a_curve_above_the_body_lies_in_nothing() -> None:
    found = answer(*_block("mortar", -0.01))
    assert found["deepest"] == 0.0
    assert found["largest force"] == 0.0


def test_depth_between_two_nodes_is_that_of_the_curve() -> None:
    given, results = _block("node_to_segment", 0.02)
    assert answer(given, results)["deepest"] < 1e-6
    # Without the reaction of the block the disc is as deep as it was pushed.
    for frame in results.frames:
        frame.U[given.model.mesh.nodes_of("top")] = 0.0
    assert answer(given, results)["deepest"] == pytest.approx(0.02 / 0.5, rel=1e-3)


def test_two_runs_agree_within_a_percent_and_the_deeper_one_is_known() -> None:
    given, results = _block("node_to_segment", 0.02)
    row = {"moved": float(np.abs(results.frames[-1].U).max()), "answer": answer(given, results)}
    other = deepcopy(row)
    assert same(row, other)
    assert not deeper(row, other)
    other["answer"]["largest force"] *= 1.02
    other["answer"]["deepest"] = 0.1
    assert not same(row, other)
    assert deeper(other, row)
