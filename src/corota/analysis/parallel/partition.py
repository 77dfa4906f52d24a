"""Partition of the elements over processes by recursive inertial bisection.

Groups of elements are cut in two across their longest principal axis, so that both halves have
the work that their numbers of processes require. In the plane the cuts are short: their length
grows with the square root of the number of elements.

Source: H. D. Simon, Computing Systems in Engineering 2 (1991) 135-148.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.model import elements
from corota.model.blocks import BlockOfCells, blocks_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.analysis.parallel.communicator import Communicator
    from corota.arrays import Floats, Ints
    from corota.model.model import Model


def own_blocks(
    blocks: list[BlockOfCells], points: Floats, communicator: Communicator
) -> tuple[list[BlockOfCells], list[int]]:
    """Blocks of the elements of this process, and the numbers of the blocks they belong to.

    Raises
    ------
    InputError
        If there are more processes than elements.
    """
    if communicator.size == 1:
        return blocks, list(range(len(blocks)))
    count = sum(len(block.cells) for block in blocks)
    if count < communicator.size:
        raise InputError(
            f"{communicator.size} processes for {count} elements: each process needs an element"
        )
    part = partition(blocks, points, communicator.size)
    own, numbers, first = [], [], 0
    for number, block in enumerate(blocks):
        rows = np.flatnonzero(part[first : first + len(block.cells)] == communicator.rank)
        first += len(block.cells)
        if len(rows):
            own.append(block.part(rows))
            numbers.append(number)
    return own, numbers


def partition(blocks: Sequence[BlockOfCells], points: Floats, count: int) -> Ints:
    """Process of every element, blocks one after the other, shape (n_elements,)."""
    places, work = [], []
    for block in blocks:
        facts = elements.find(block.section.element)
        places.append(points[block.nodes].mean(axis=1))
        # Stiffness matrices dominate: a product of operators at each point.
        entries = (block.nodes.shape[1] * facts.dofs_per_node) ** 2
        work.append(np.full(len(block.cells), float(entries * facts.n_points)))
    return bisected(np.concatenate(places), np.concatenate(work), count)


def process_of_cells(model: Model, count: int) -> Ints:
    """Process of every cell of a model, 0 for those without a section; shape (n_cells,)."""
    blocks = blocks_of(model)
    found = np.zeros(model.mesh.n_cells, np.int64)
    cells = np.concatenate([block.cells for block in blocks])
    found[cells] = partition(blocks, model.mesh.points, count)
    return found


def bisected(places: Floats, work: Floats, count: int) -> Ints:
    """Groups of points with about the same work, shape (n,).

    Parameters
    ----------
    places : ndarray, shape (n, 2)
    work : ndarray, shape (n,)
    count : int
        Groups, at most n; each gets a point.
    """
    part = np.zeros(len(places), np.int64)
    waiting = [(np.arange(len(places)), 0, count)]
    while waiting:
        rows, first, groups = waiting.pop()
        if groups == 1:
            part[rows] = first
            continue
        left = groups // 2
        arm = places[rows] - places[rows].mean(axis=0)
        (xx, xy), (_, yy) = np.einsum("ni,nj->ij", arm, arm)
        angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
        along = arm[:, 0] * np.cos(angle) + arm[:, 1] * np.sin(angle)
        order = rows[np.argsort(along, kind="stable")]
        done = np.cumsum(work[order])
        cut = int(np.searchsorted(done, done[-1] * left / groups, side="left")) + 1
        cut = min(max(cut, left), len(order) - (groups - left))
        # In the order of the model again, so that sums keep it.
        waiting.append((np.sort(order[:cut]), first, left))
        waiting.append((np.sort(order[cut:]), first + left, groups - left))
    return part
