"""Boundary sets of merged meshes are those of the merged body."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from corota import mesh


def halves(kind: str = "quad4") -> list[mesh.Mesh]:
    return [mesh.rectangle(1.0, 1.0, 2, 2, kind, origin=(x, 0.0)) for x in (0.0, 1.0)]


@pytest.mark.parametrize("kind", ["quad4", "quad8", "tri3", "tri6"])
def test_sides_are_those_of_one_rectangle(kind: str) -> None:
    joined = mesh.merge(*halves(kind))
    whole = mesh.rectangle(2.0, 1.0, 4, 2, kind)
    for name in ("left", "right", "bottom", "top"):
        for nodes, other in (
            (joined.node_sets[name], whole.node_sets[name]),
            (joined.edge_set_nodes(joined.edge_sets[name]), whole.node_sets[name]),
        ):
            places = {tuple(p) for p in joined.points[nodes].round(9).tolist()}
            assert places == {tuple(p) for p in whole.points[other].round(9).tolist()}


def test_every_edge_of_the_sides_is_an_outer_one() -> None:
    joined = mesh.merge(*halves())
    outer = {tuple(e) for e in joined.boundary_edges().tolist()}
    for edges in joined.edge_sets.values():
        assert {tuple(e) for e in edges.tolist()} <= outer


def test_what_left_a_set_is_told_and_an_empty_set_is_gone() -> None:
    a, b = halves()
    a.edge_sets["joint"] = a.edge_sets["right"].copy()
    joined = mesh.merge(a, b)
    assert "joint" not in joined.edge_sets
    assert any("'joint', which is empty and gone" in note for note in joined.notes)
    assert any("2 edges lie inside" in note and "'right'" in note for note in joined.notes)


def test_sets_that_were_inside_before_stay() -> None:
    a, b = halves()
    a.edge_sets["middle"] = np.array([[0, 1], [2, 1]])
    a.node_sets["points"] = a.node_sets["right"][:1]
    joined = mesh.merge(a, b)
    assert len(joined.edge_sets["middle"]) == 2
    assert len(joined.node_sets["points"]) == 1


def test_bodies_that_touch_nowhere_keep_all() -> None:
    far = mesh.rectangle(1.0, 1.0, 2, 2, origin=(5.0, 0.0))
    joined = mesh.merge(halves()[0], far)
    assert len(joined.edge_sets["right"]) == 4
    assert not joined.notes
