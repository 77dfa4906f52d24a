"""Meshes by way of meshio, and universal files: planes, groups, quadratic cells, faults."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError
from corota.io.meshio_bridge import from_meshio

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])


def given(points: np.ndarray, **more: object) -> SimpleNamespace:
    block = SimpleNamespace(type="quad", data=np.array([[0, 1, 2, 3]]))
    return SimpleNamespace(points=points, cells=[block], **more)


@pytest.mark.parametrize(("plane", "axes"), [("xy", (0, 1)), ("xz", (0, 2)), ("yz", (1, 2))])
def test_a_mesh_in_another_plane_is_turned(plane: str, axes: tuple[int, int]) -> None:
    points = np.full((4, 3), 7.0)
    points[:, axes] = SQUARE
    mesh = from_meshio(given(points), "part.vtu")
    assert np.array_equal(mesh.points, SQUARE)
    assert any(f"lies in the {plane} plane" in note for note in mesh.notes) == (plane != "xy")
    assert any("= 7 of all nodes" in note for note in mesh.notes)


def test_a_tilted_mesh_is_refused() -> None:
    points = np.column_stack([SQUARE, SQUARE[:, 0]])
    with pytest.raises(InputError, match="one plane normal to an axis"):
        from_meshio(given(points), "part.vtu")


def test_groups_of_med_and_numbers_of_properties() -> None:
    cells = [
        SimpleNamespace(type="quad", data=np.array([[0, 1, 2, 3]])),
        SimpleNamespace(type="line", data=np.array([[0, 1], [1, 2]])),
    ]
    found = SimpleNamespace(
        points=SQUARE,
        cells=cells,
        cell_data={
            "cell_tags": [np.array([-1]), np.array([-2, -3])],
            "nastran:ref": [np.array([5]), np.array([0, 0])],
        },
        cell_tags={-1: ["body"], -2: ["low", "rim"], -3: ["rim"]},
        point_data={"point_tags": np.array([2, 0, 0, 2])},
        point_tags={2: ["left"]},
    )
    mesh = from_meshio(found, "part.med")
    assert mesh.cell_sets["body"].tolist() == [0]
    assert mesh.cell_sets["PID5"].tolist() == [0]
    assert mesh.edge_sets["low"].tolist() == [[0, 0]]
    assert sorted(mesh.edge_sets["rim"].tolist()) == [[0, 0], [0, 1]]
    assert mesh.node_sets["left"].tolist() == [0, 3]


UNV = """    -1
  2411
{nodes}    -1
    -1
  2412
        10        95         1         1         7         8
         1         2         3         4         5         6         7         8
        11        24         0         1         7         3
         0         1         1
         1         2         3
    -1
    -1
  2467
         1         0         0         0         0         0         0         2
body
         8        10         0         0         8        11         0         0
         2         0         0         0         0         0         0         3
left
         7         1         0         0         7         7         0         0
         7         8         0         0
    -1
"""
#: Around the outline: corner, middle, corner, ...
ROUND = [(0, 0), (1, 0), (2, 0), (2, 0.5), (2, 1), (1, 1), (0, 1), (0, 0.5)]


def unv(tmp_path: Path, old: str = "", new: str = "") -> Path:
    nodes = "".join(
        f"{n:10d}         1         1        11\n {x:.16E} {y:.16E} 0.0D+00\n".replace("E", "D")
        for n, (x, y) in enumerate(ROUND, 1)
    )
    text = UNV.format(nodes=nodes)
    assert old in text
    path = tmp_path / "part.unv"
    path.write_text(text.replace(old, new, 1) if old else text)
    return path


def test_a_universal_file_with_quadratic_cells_and_groups(tmp_path: Path) -> None:
    mesh = ct.mesh.read(unv(tmp_path))
    (cells,) = mesh.cells
    assert (cells.kind, cells.labels.tolist()) == ("quad8", [10])
    assert mesh.points[cells.nodes[0]].tolist() == [
        list(map(float, ROUND[i])) for i in (0, 2, 4, 6, 1, 3, 5, 7)
    ]
    assert mesh.node_sets["left"].tolist() == [0, 6, 7]
    assert mesh.cell_sets["body"].tolist() == [0]
    assert mesh.edge_sets["body"].tolist() == [[0, 0]]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("    -1\n  2412", "  2412", "two lines of -1"),
        (
            "         1         2         3         4         5         6         7         8\n",
            "",
            "nodes",
        ),
        (
            "         7         8\n        11",
            "         7        80\n        11",
            "node 80 is not defined",
        ),
        ("        10        95", "        10       111", "no triangles or quadrilaterals"),
        (
            "         2         1         1        11",
            "         1         1         1        11",
            "twice",
        ),
        ("0.0D+00", "x", "part.unv:3"),
        ("         0         2\nbody", "         0         9\nbody", "damaged"),
    ],
)
def test_faults_of_universal_files(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(InputError, match=said.replace(".", r"\.")):
        ct.mesh.read(unv(tmp_path, old, new))


def test_the_plane_of_six_node_triangles_of_meshio_is_asked_for(tmp_path: Path) -> None:
    text = (
        "*HEADING\nAbaqus DataFile Version 6.14\nwritten by meshio v5.3.5\n*NODE\n"
        "1, 0., 0.\n2, 2., 0.\n3, 0., 2.\n4, 1., 0.\n5, 1., 1.\n6, 0., 1.\n"
        "*ELEMENT, TYPE=CPE6, ELSET=E\n1, 1, 2, 3, 4, 5, 6\n"
        "*MATERIAL, NAME=M\n*ELASTIC\n1., .3\n*SOLID SECTION, ELSET=E, MATERIAL=M{}\n"
    )
    path = tmp_path / "a.inp"
    path.write_text(text.format(""))
    with pytest.raises(ct.DeckError, match="meshio writes this name"):
        ct.read(path)
    for plane in ("stress", "strain"):
        path.write_text(text.format(f", PLANE={plane.upper()}"))
        assert ct.read(path).sections[0].plane == plane
    path.write_text(text.format("").replace("written by meshio", "written by hand:"))
    assert ct.read(path).sections[0].plane == "strain"
