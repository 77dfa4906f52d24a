"""Fifty outlines in dialects of CAD programs: area, loops, lengths of sets, or a reason."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError
from outline.drawings import CORPUS, DIALECTS, REFUSED, SHAPES

pytest.importorskip("gmsh", reason="the extra mesh: make test-mesh", exc_type=ImportError)
pytest.importorskip("ezdxf", reason="the extra mesh: make test-mesh")


def covered(mesh: ct.Mesh) -> float:
    """Area of the cells."""
    total = 0.0
    for block in mesh.cells:
        corners = mesh.points[block.nodes[:, : 3 if block.kind.startswith("tri") else 4]]
        x, y = corners[..., 0], corners[..., 1]
        total += 0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum()
    return total


def boundary(mesh: ct.Mesh) -> list[tuple[int, int]]:
    """Sides of one cell only."""
    sides: dict[tuple[int, int], int] = {}
    for block in mesh.cells:
        for cell in block.nodes.tolist():
            for a, b in zip(cell, [*cell[1:], cell[0]], strict=True):
                key = (min(a, b), max(a, b))
                sides[key] = sides.get(key, 0) + 1
    return [side for side, count in sides.items() if count == 1]


def loops(mesh: ct.Mesh) -> int:
    """Closed loops of the boundary."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    ends = np.array(boundary(mesh))
    graph = coo_array((np.ones(len(ends)), ends.T), shape=(mesh.n_nodes,) * 2)
    _, owner = connected_components(graph, directed=False)
    return len(np.unique(owner[ends]))


@pytest.mark.parametrize(("name", "dialect"), CORPUS)
def test_outline(tmp_path: Path, name: str, dialect: str) -> None:
    shape, path = SHAPES[name], tmp_path / f"{name}.dxf"
    DIALECTS[dialect](shape, path, np.random.default_rng(5))
    mesh = ct.mesh.outline(path, through=2)
    assert covered(mesh) == pytest.approx(shape.area, rel=1e-2)
    assert loops(mesh) == len(shape.loops)
    assert len(mesh.cell_sets) == shape.parts
    assert set(mesh.edge_sets) == set(shape.lengths)
    for layer, length in shape.lengths.items():
        ends = np.array([nodes[:2] for nodes in mesh.edge_nodes(mesh.edge_sets[layer])])
        found = np.hypot(*(mesh.points[ends[:, 1]] - mesh.points[ends[:, 0]]).T).sum()
        assert found == pytest.approx(length, rel=1e-2), layer
    quads = sum(len(c) for c in mesh.cells if c.kind == "quad4")
    assert quads >= 0.9 * mesh.n_cells


@pytest.mark.parametrize("name", REFUSED)
def test_refused(tmp_path: Path, name: str) -> None:
    write, message = REFUSED[name]
    write(tmp_path / "a.dxf")
    with pytest.raises(InputError, match=message):
        ct.mesh.outline(tmp_path / "a.dxf")


def test_the_corpus_has_fifty_outlines() -> None:
    assert len(CORPUS) + len(REFUSED) >= 50
