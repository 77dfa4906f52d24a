"""Connected parts of meshes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import corota as ct
from corota.mesh.parts import components, part_of_cells, part_of_nodes


@pytest.mark.parametrize("edges", [0, 1, 30, 80, 200])
def test_parts_of_graphs_are_those_of_scipy(edges: int) -> None:
    """Also their numbers: in the order of the first members."""
    rng = np.random.default_rng(edges)
    for _ in range(20):
        a, b = rng.integers(0, 100, (2, edges))
        graph = coo_array((np.ones(edges), (a, b)), shape=(100, 100))
        expected = connected_components(graph, directed=False)[1]
        np.testing.assert_array_equal(components(a, b, 100), expected)


def test_a_long_chain_in_any_order_is_one_part() -> None:
    order = np.random.default_rng(1).permutation(5000)
    assert not components(order[:-1], order[1:], 5000).any()


def test_nodes_without_cells_have_no_part() -> None:
    one = ct.mesh.rectangle(1.0, 1.0, 2, 2)
    points = np.concatenate([one.points, one.points + 3.0, [[9.0, 9.0]]])
    nodes = one.cells[0].nodes
    cells = ct.mesh.Cells("quad4", np.concatenate([nodes, nodes + 9]), np.arange(1, 9))
    mesh = ct.Mesh(points, [cells])
    nodes_part, cells_part = part_of_nodes(mesh), part_of_cells(mesh)
    assert len(set(cells_part[:4])) == len(set(cells_part[4:])) == 1
    assert set(nodes_part[:9]) == {cells_part[0]}
    assert set(nodes_part[9:18]) == {cells_part[4]} != {cells_part[0]}
    assert nodes_part[18] == -1
