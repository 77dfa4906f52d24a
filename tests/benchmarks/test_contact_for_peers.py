"""Contact problems for other programs: the data hold the same problem."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from benchmarks.corpora.contact_for_peers import chosen, data, sheared
from benchmarks.corpora.contact_problems import Problem
from benchmarks.peers.contact_ccx import deck
from benchmarks.peers.contact_data import ContactData, mean
from benchmarks.peers.contact_kratos import STRIDE, increments

COUNT = 8  # with a round tool, one that moves, two bodies, two steps and a traction


@pytest.fixture(scope="module")
def problems() -> list[Problem]:
    return chosen(COUNT, 0.5)


def test_linear_problems_are_the_same_ones(problems: list[Problem]) -> None:
    linear = chosen(COUNT, 0.5, linear=True)
    assert [p.name for p in linear] == [p.name for p in problems]
    assert {p.model.sections[0].element for p in linear} <= {"Q4", "T3"}
    assert "Q8" in {p.model.sections[0].element for p in problems}


def test_data_survive_saving(problems: list[Problem], tmp_path: Path) -> None:
    for given in problems:
        made = data(given)
        made.save(tmp_path / "data.json")
        read = ContactData.load(tmp_path / "data.json")
        assert deck(read, "SURFACE TO SURFACE") == deck(made, "SURFACE TO SURFACE")


def test_faces_have_their_material_on_the_left(problems: list[Problem]) -> None:
    for given in problems:
        made = data(given)
        points = np.array(made.points)
        cells = [*made.cells, *(cell for tool in made.tools for cell in tool.cells)]
        for pair in made.pairs:
            for face in (pair.slave, pair.master):
                for (cell, _), (a, b) in zip(face.sides, face.edges, strict=True):
                    assert {a, b} <= set(cells[cell])
                    along, inward = points[b] - points[a], points[cells[cell]].mean(0) - points[a]
                    assert along[0] * inward[1] - along[1] * inward[0] > 0.0


def test_tools_follow_their_reference_node(problems: list[Problem]) -> None:
    given = next(p for p in problems if p.name.startswith("indent"))
    made = data(given)
    down = min(s.value for s in given.model.supports if s.dof == 1)
    driven = {(node, dof): value for node, dof, value in made.stages[0].driven}
    for node in made.tools[0].nodes:
        assert driven[node, 0] == 0.0
        assert driven[node, 1] == down
    assert made.watched == made.tools[0].nodes


def test_supports_stay_where_the_next_step_does_not_move_them(problems: list[Problem]) -> None:
    given = next(p for p in problems if p.name.startswith("press"))
    first, second = (
        {(node, dof): value for node, dof, value in stage.driven} for stage in data(given).stages
    )
    moved = {key for key in first if first[key] != second[key]}
    assert moved
    assert {dof for _, dof in moved} == {0}
    assert min(first.values()) == -0.03


def test_deck_of_the_data_is_the_same_problem(tmp_path: Path) -> None:
    given = sheared()
    model, step = given.model, given.steps[0]
    made = data(given)
    np.testing.assert_allclose(np.sum(made.forces, axis=0)[1:], [6.0, 1.8])
    (tmp_path / "job.inp").write_text(deck(made, "SURFACE TO SURFACE"))
    read = ct.read(tmp_path / "job.inp")
    read.sections[0].element, read.sections[0].local_strain = "Q4", "green_lagrange"
    reactions = [
        frames[-1].RF[made.watched][:, :2].sum(axis=0)
        for frames in (ct.solve(model, step).frames, ct.solve(read, step_of(read)).frames)
    ]
    assert math.hypot(*reactions[0]) > 50.0
    np.testing.assert_allclose(reactions[1], reactions[0], rtol=1e-6)


def step_of(read: ct.Model) -> ct.Static:
    """The step of a deck, in two increments."""
    (step,) = read.steps
    step.increments = 2
    return step


def test_increments_of_kratos_are_short_beside_the_edges(problems: list[Problem]) -> None:
    given = next(p for p in problems if p.name.startswith("clip"))
    made = data(given)
    points = np.array(made.points)
    shortest = min(
        math.dist(points[a], points[b])
        for cell in made.cells
        for a, b in zip(cell, [*cell[1:], cell[0]], strict=True)
    )
    (count,) = increments(made, [3])
    assert 0.8 / count <= STRIDE * shortest < 0.8 / (count - 1)
    assert increments(made, [100_000]) == [100_000]


def test_mean_of_forces_begins_with_none() -> None:
    assert mean([(0.5, 2.0), (2.0, 2.0)], 2.0) == pytest.approx(1.75)
