"""The reader of .msh files against files that Gmsh writes, and against damaged ones."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from corota import mesh
from corota.errors import FileError, InputError, UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

gmsh = pytest.importorskip("gmsh", reason="writes the files that are read here")

KINDS = {
    ("triangles", 1): ("tri3", 3),
    ("triangles", 2): ("tri6", 6),
    ("squares", 1): ("quad4", 4),
    ("squares", 2): ("quad9", 9),
    ("serendipity", 2): ("quad8", 8),
}


@pytest.fixture
def session() -> Iterator[None]:
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield
    gmsh.finalize()


def plate(shape: str, order: int) -> None:
    """A plate 2 x 1 of two faces ``one`` and ``two``, with ``left``, ``top``, ``corner``."""
    geo = gmsh.model.geo
    points = [geo.addPoint(x, y, 0) for y in (0, 1) for x in (0, 1, 2)]
    lines = [
        geo.addLine(points[a], points[b])
        for a, b in ((0, 1), (1, 2), (2, 5), (5, 4), (4, 3), (3, 0), (1, 4))
    ]
    a, b, c, d, e, f, g = lines
    one = geo.addPlaneSurface([geo.addCurveLoop([a, g, e, f])])
    two = geo.addPlaneSurface([geo.addCurveLoop([b, c, d, -g])])
    if shape != "triangles":
        for line in lines:
            geo.mesh.setTransfiniteCurve(line, 4)
        for surface in (one, two):
            geo.mesh.setTransfiniteSurface(surface)
            geo.mesh.setRecombine(2, surface)
    geo.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", int(shape == "serendipity"))
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    for dimension, tags, name in (
        (2, [one], "one"),
        (2, [two], "two"),
        (2, [one, two], "both"),
        (1, [f], "left side"),
        (1, [d, e], "top"),
        (1, [g], "seam"),
        (0, [points[5]], "corner"),
    ):
        gmsh.model.addPhysicalGroup(dimension, tags, name=name)
    gmsh.model.mesh.generate(2)


@pytest.mark.parametrize("binary", [0, 1])
@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.parametrize("case", KINDS)
def test_physical_groups_become_sets(
    tmp_path: Path, session: None, case: tuple[str, int], version: float, binary: int
) -> None:
    plate(*case)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(str(tmp_path / "plate.msh"))
    found = mesh.read(tmp_path / "plate.msh")
    kind, size = KINDS[case]
    assert [c.kind for c in found.cells] == [kind]
    assert found.cells[0].nodes.shape == (found.n_cells, size)
    assert sorted(found.cell_sets) == ["both", "one", "two"]
    assert len(found.cell_sets["both"]) == found.n_cells
    assert len(np.intersect1d(found.cell_sets["one"], found.cell_sets["two"])) == 0
    center = found.points[found.cells[0].nodes].mean(axis=1)
    assert (center[found.cell_sets["one"], 0] < 1.0).all()
    assert (center[found.cell_sets["two"], 0] > 1.0).all()
    assert np.allclose(found.points[found.node_sets["left side"], 0], 0.0)
    assert np.allclose(found.points[found.node_sets["corner"]], [[2.0, 1.0]])
    top = found.edge_nodes(found.edge_sets["top"])
    length = sum(np.linalg.norm(np.subtract(*found.points[edge[:2]])) for edge in top)
    assert length == pytest.approx(2.0)
    assert len(found.edge_sets["seam"]) > 0
    from corota.mesh.quality import jacobians

    assert (jacobians(kind, found.points[found.cells[0].nodes]) > 0.0).all()
    assert jacobians("tri3", found.points[found.cells[0].nodes[:, :3]]).min() > 0.0


def test_node_and_element_numbers_are_those_of_the_file(tmp_path: Path, session: None) -> None:
    plate("triangles", 1)
    gmsh.write(str(tmp_path / "plate.msh"))
    tags, points, _ = gmsh.model.mesh.getNodes()
    found = mesh.read(tmp_path / "plate.msh")
    by_tag = dict(zip(tags, points.reshape(-1, 3), strict=True))
    for label, point in zip(found.node_labels, found.points, strict=True):
        assert np.allclose(by_tag[label][:2], point, atol=1e-12)


SQUARE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
2
7 1 2 5 1 1 2
8 3 2 6 1 1 2 3 4
$EndElements
"""


def test_unnamed_groups_get_the_names_that_gmsh_gives(tmp_path: Path) -> None:
    (tmp_path / "a.msh").write_text(SQUARE)
    found = mesh.read(tmp_path / "a.msh")
    assert list(found.cell_sets) == ["PhysicalSurface6"]
    assert found.edge_sets["PhysicalLine5"].tolist() == [[0, 0]]
    assert found.cells[0].labels.tolist() == [8]


def test_clockwise_cells_are_turned_and_noted(tmp_path: Path) -> None:
    (tmp_path / "a.msh").write_text(SQUARE.replace("1 2 3 4\n$End", "1 4 3 2\n$End"))
    found = mesh.read(tmp_path / "a.msh")
    assert found.cells[0].nodes.tolist() == [[0, 1, 2, 3]]
    assert found.edge_sets["PhysicalLine5"].tolist() == [[0, 0]]
    assert "clockwise" in found.notes[0]


@pytest.mark.parametrize(
    ("old", "new", "line", "text"),
    [
        ("1 1 0\n4", "1 one 0\n4", 8, "expected a number, found 'one'"),
        ("1 1 0\n4", "1 nan 0\n4", 8, "'nan' is not accepted"),
        ("1 1 0\n4", "1 1e400 0\n4", 8, "too large"),
        ("1 1 0\n4", "1 1e-310 0\n4", 8, "smallest normal number"),
        ("$Nodes\n4", "$Nodes\n5", 6, "ends early"),
        ("$Nodes\n4", "$Nodes\n3", 9, "more numbers"),
        ("$Nodes\n4", "$Nodes\n999999999999999", 6, "ends early"),
        ("$Elements\n2", "$Elements\n1.5", 12, "whole number"),
        ("$EndNodes\n", "", 4, "no $EndNodes"),
        ("2.2 0 8", "1 0 8", 2, "version 1"),
        ("8 3 2", "8 5 2", 14, "element type 5"),
        ("4 0 1 0", "3 0 1 0", 5, "node 3 occurs twice"),
    ],
)
def test_a_damaged_file_is_refused_with_its_line(
    tmp_path: Path, old: str, new: str, line: int, text: str
) -> None:
    assert old in SQUARE
    (tmp_path / "a.msh").write_text(SQUARE.replace(old, new))
    with pytest.raises(InputError) as caught:
        mesh.read(tmp_path / "a.msh")
    assert text in str(caught.value)
    assert caught.value.where is not None
    assert abs(caught.value.where.line - line) <= 1


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("1 2 3 4\n$End", "1 2 3 9\n$End", "node 9 is not defined"),
        ("1 2 3 4\n$End", "1 3 2 4\n$End", "folded"),
        ("3 1 1 0", "3 1 1 2", "z = 2"),
        ("8 3 2 6 1 1 2 3 4", "8 1 2 6 1 1 2", "no triangles"),
    ],
)
def test_a_bad_mesh_is_refused_with_its_element(
    tmp_path: Path, old: str, new: str, text: str
) -> None:
    (tmp_path / "a.msh").write_text(SQUARE.replace(old, new))
    with pytest.raises(InputError, match=text):
        mesh.read(tmp_path / "a.msh")


def test_a_truncated_binary_file_never_fails_otherwise(tmp_path: Path, session: None) -> None:
    plate("triangles", 1)
    for version in (2.2, 4.1):
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.write(str(tmp_path / "plate.msh"))
        data = (tmp_path / "plate.msh").read_bytes()
        for cut in range(0, len(data) - 14, max(1, len(data) // 60)):
            (tmp_path / "cut.msh").write_bytes(data[:cut])
            with pytest.raises(InputError):
                mesh.read(tmp_path / "cut.msh")


def test_missing_files_and_unknown_names(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"nothing.msh"):
        mesh.read(tmp_path / "nothing.msh")
    with pytest.raises((UnsupportedError, FileError)):
        mesh.read(tmp_path / "nothing.med")
