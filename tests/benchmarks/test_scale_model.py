"""The model of cost: fronts of a dissected square, and what processes share."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from benchmarks.speed import scale_model
from benchmarks.speed.scale_model import FREE, Sides, cut, share, tree

Box = tuple[int, int, int, int]


def pieces(box: Box, sides: Sides) -> list[tuple[list[tuple[int, int]], int]]:
    """Nodes of all fronts in the order of elimination, and the size of each border."""
    x, y, w, h = box
    front, parts = cut(w, h, sides)
    if not parts:
        return [([(i, j) for i in range(x, x + w) for j in range(y, y + h)], front.border)]
    (one, *_, first), (two, *_, second) = ((p[0], p[1], p[2]) for p in parts)
    found = []
    if w >= h:
        found += pieces((x, y, one, h), first) + pieces((x + one + 1, y, two, h), second)
        line = [(x + one, j) for j in range(y, y + h)]
    else:
        below, above = parts[0][1], parts[1][1]
        found += pieces((x, y, w, below), first) + pieces((x, y + below + 1, w, above), second)
        line = [(i, y + below) for i in range(x, x + w)]
    return [*found, (line, front.border)]


@pytest.mark.parametrize("n", [5, 9, 14, 23, 32, 45])
def test_fronts_hold_what_elimination_fills(n: int) -> None:
    """By elimination on the graph of the mesh, node by node, in the same order.

    The model has whole sides in borders, of which the last fronts do not reach the ends: a share
    that falls with the size.
    """
    order = [node for nodes, _ in pieces((0, 0, n, n), FREE) for node in nodes]
    assert sorted(order) == [(i, j) for i in range(n) for j in range(n)]
    near = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    place = {node: k for k, node in enumerate(order)}
    links = [{place[i + a, j + b] for a, b in near if (i + a, j + b) in place} for i, j in order]
    for nodes, _ in pieces((0, 0, n, n), FREE):  # fronts are dense
        for node in nodes:
            links[place[node]] |= {place[other] for other in nodes}
    entries = 0.0
    for k in range(len(order)):
        later = {m for m in links[k] if m > k}
        entries += 3.0 + 4.0 * len(later)  # a block of two dofs, and full blocks beside it
        for m in later:
            links[m] |= later
    assert 1.0 <= tree(n, n).entries / entries <= 1.0 + 1.5 / n


def test_growth_is_that_of_nested_dissection() -> None:
    sizes = np.array([100, 200, 400, 800, 1600])
    found = [tree(int(n), int(n)) for n in sizes]
    operations = np.log2([t.operations for t in found])
    assert np.diff(operations)[-1] == pytest.approx(3.0, abs=0.05)
    per_dof = [t.entries / (2.0 * n * n) for t, n in zip(found, sizes, strict=True)]
    growth = np.diff(per_dof)
    assert growth == pytest.approx(growth.mean(), rel=0.1), "n log n"


def test_one_process_has_all_and_the_busiest_of_many_more_than_its_share() -> None:
    whole, alone = tree(500, 500), share(500, 1)
    assert (alone.entries, alone.operations) == (whole.entries, whole.operations)
    assert alone.values == 0.0
    for processes in (2, 16, 256):
        busiest = share(500, processes)
        assert 1.0 <= processes * busiest.entries / whole.entries < 1.6
        assert 1.0 <= processes * busiest.operations / whole.operations < 1.6


def test_the_page_has_its_table() -> None:
    text = scale_model.PAGE.read_text(encoding="utf-8")
    assert all(word in text for word in (*scale_model.HEAD, "1.0e+09"))
