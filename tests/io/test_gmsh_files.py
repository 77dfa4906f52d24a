"""Files that Gmsh wrote, with its own counts: all versions, orders, encodings, partitions."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import struct
from pathlib import Path

import pytest

from benchmarks.corpora.gmsh_files import FOLDER, Facts, differences, read
from corota.errors import InputError, UnsupportedError

FACTS = json.loads((FOLDER / "facts.json").read_text(encoding="utf-8"))
TEXT = next(FOLDER / name for name in sorted(FACTS) if "v4.1-o1-txt" in name)


@pytest.mark.parametrize("name", sorted(FACTS))
def test_counts_groups_and_orientation_are_those_of_gmsh(name: str) -> None:
    assert differences(read(FOLDER / name), Facts(**FACTS[name])) == []


def test_what_differs_is_told() -> None:
    name, facts = next(iter(FACTS.items()))
    wrong = Facts(**{**facts, "nodes": facts["nodes"] + 1, "area": -facts["area"]})
    assert len(differences(read(FOLDER / name), wrong)) == 2


def test_text_before_the_format_is_a_comment(tmp_path: Path) -> None:
    path = tmp_path / "comment.msh"
    path.write_bytes(b"made by hand\n$Comments\n costs 5 $\n$EndComments\n" + TEXT.read_bytes())
    assert read(path) == read(TEXT)


def test_third_order_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "cubic.msh"
    nodes = "".join(f"{n} {x} {y} 0\n" for n, (x, y) in enumerate([(0, 0), (1, 0), (0, 1)], 1))
    path.write_text(
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n{nodes}$EndNodes\n"
        "$Elements\n1\n1 21 2 0 1 1 2 3 1 2 3 1 2 3 1\n$EndElements\n"
    )
    with pytest.raises(UnsupportedError, match="third or higher order"):
        read(path)


def test_a_part_in_no_plane_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "tilted.msh"
    nodes = "1 0 0 0\n2 1 0 1\n3 0 1 0\n"
    path.write_text(
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n{nodes}$EndNodes\n"
        "$Elements\n1\n1 2 0 1 2 3\n$EndElements\n"
    )
    with pytest.raises(InputError, match="no plane normal to an axis"):
        read(path)


@pytest.mark.parametrize("binary", [False, True])
def test_parametric_nodes_are_nodes(tmp_path: Path, binary: bool) -> None:
    """Coordinates on curves (1) and surfaces (2) follow the place of a node."""
    rows = [(1, 0, 0, 0, 1), (2, 1, 0, 1, 1, 0.5), (3, 0, 1, 2, 1, 0.25, 0.75)]
    path = tmp_path / "parametric.msh"
    if binary:
        nodes = b"".join(
            struct.pack("<i3d2i", n, x, y, 0.0, dim, tag) + struct.pack(f"<{len(rest)}d", *rest)
            for n, x, y, dim, tag, *rest in rows
        )
        cell = struct.pack("<3i", 2, 1, 0) + struct.pack("<4i", 1, 1, 2, 3)
        head = b"$MeshFormat\n2.2 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n"
    else:
        nodes = "".join(f"{n} {x} {y} 0 " + " ".join(map(str, r)) + "\n" for n, x, y, *r in rows)
        nodes, cell = nodes.encode(), b"1 2 0 1 2 3"
        head = b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    path.write_bytes(
        head
        + b"$ParametricNodes\n3\n"
        + nodes
        + b"\n$EndParametricNodes\n"
        + b"$Elements\n1\n"
        + cell
        + b"\n$EndElements\n"
    )
    facts = read(path)
    assert (facts.nodes, facts.cells, facts.area) == (3, {"tri3": 1}, 0.5)
