"""The partition of elements over processes, and what needs no second process to be tested."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.analysis.linear.matrix import SymmetricPattern
from corota.analysis.parallel.communicator import ALONE, Communicator
from corota.analysis.parallel.partition import bisected, own_blocks, partition
from corota.errors import InputError
from corota.model.blocks import blocks_of


class Pretended(Communicator):
    """One of several processes that never communicates."""

    def __init__(self, rank: int, size: int) -> None:
        self.rank, self.size = rank, size


def strip(nx: int, ny: int) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(float(nx), float(ny), nx=nx, ny=ny))
    model.section("all", element="Q4", material=ct.Elastic(E=1.0, nu=0.3))
    return model


@pytest.mark.parametrize("count", [2, 3, 7, 16])
def test_parts_have_the_same_work_and_short_borders(count: int) -> None:
    model = strip(64, 32)
    part = partition(blocks_of(model), model.mesh.points, count)
    sizes = np.bincount(part, minlength=count)
    assert sizes.max() - sizes.min() <= 0.03 * sizes.mean()
    cells = model.mesh.cells[0].nodes
    shared = sum(len({int(p) for p in part[(cells == n).any(axis=1)]}) > 1 for n in range(65 * 33))
    # Square parts: half their borders, counted once for the two sides.
    assert shared <= 2.0 * np.sqrt(count * 64.0 * 32.0)


def test_a_long_body_is_cut_across() -> None:
    places = np.stack([np.linspace(0.0, 10.0, 40), np.zeros(40)], axis=1)
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    part = bisected(places @ turn.T, np.ones(40), 4)
    groups = np.split(part, 4)
    assert sorted(int(g[0]) for g in groups) == [0, 1, 2, 3]
    assert all((g == g[0]).all() for g in groups)


def test_every_process_gets_an_element_whatever_its_work() -> None:
    work = np.array([1000.0, 1.0, 1.0, 1.0])
    part = bisected(np.stack([np.arange(4.0), np.zeros(4)], axis=1), work, 4)
    assert sorted(part.tolist()) == [0, 1, 2, 3]


def test_blocks_of_all_processes_are_the_whole() -> None:
    model = strip(6, 2)
    blocks = blocks_of(model)
    own = [own_blocks(blocks, model.mesh.points, Pretended(rank, 3))[0] for rank in range(3)]
    cells = np.concatenate([block.cells for each in own for block in each])
    assert sorted(cells.tolist()) == list(range(12))
    assert own_blocks(blocks, model.mesh.points, ALONE)[0] is blocks


def test_more_processes_than_elements_are_refused() -> None:
    model = strip(2, 1)
    with pytest.raises(InputError, match="3 processes for 2 elements"):
        own_blocks(blocks_of(model), model.mesh.points, Pretended(0, 3))


def test_the_first_process_adds_what_all_have_computed() -> None:
    shape = np.array([0, 1, 2]), np.array([0, 1]), np.array([0, 1])
    for rank, expected in ((0, [2.0, 3.0]), (1, [0.0, 0.0])):
        pattern = SymmetricPattern(*shape, communicator=Pretended(rank, 2))
        values = pattern.zeros()
        pattern.add_diagonal(values, np.array([2.0, 3.0]))
        assert values.tolist() == expected
