"""Decks as other programs write them, includes, assemblies, sparse numbers."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from decks import DECK, MESH, SECTION, STEP, SUPPORT, faults, read

import corota as ct

GMSH = """*Heading
 plate
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
******* E L E M E N T S *************
*ELEMENT, type=T3D2, ELSET=Line1
1, 1, 2
*ELEMENT, type=T3D2, ELSET=Line3
2, 3, 4
*ELEMENT, type=CPS3, ELSET=Surface1
10, 1, 2, 3
11, 1, 3, 4
*ELSET,ELSET=foot
1,
*ELSET,ELSET=face
10, 11,
"""


def test_gmsh_lines_become_edges_and_nodes(tmp_path: Path) -> None:
    text = (
        GMSH
        + SECTION.replace("eall", "Surface1")
        + ("*BOUNDARY\nfoot, 1, 2\n*STEP\n*STATIC\n*DSLOAD\nLine3, P, 2.\n*END STEP\n")
    )
    model = read(tmp_path, text)
    assert model.mesh.n_cells == 2
    assert model.mesh.edge_sets["foot"].tolist() == [[0, 0]]
    assert model.mesh.edge_sets["Line3"].tolist() == [[1, 1]]
    assert model.mesh.node_sets["foot"].tolist() == [0, 1]
    assert "foot" not in model.mesh.cell_sets
    assert model.mesh.cell_sets["face"].tolist() == [0, 1]
    assert any("2 line elements are not computed" in note for note in model.notes)
    assert model.supports[0].nodes == "foot"


def test_a_set_of_lines_with_a_section_is_a_truss(tmp_path: Path) -> None:
    text = (
        GMSH
        + SECTION.replace("eall", "Surface1")
        + ("*SOLID SECTION, ELSET=foot, MATERIAL=steel\n0.5\n")
    )
    model = read(tmp_path, text)
    assert [(s.element, s.profile[0]) for s in model.sections[1:]] == [("TRUSS", 0.5)]
    assert model.mesh.cell_sets["foot"].tolist() == [0]
    assert model.mesh.edge_sets["Line3"].tolist() == [[2, 1]]


def test_freecad_style(tmp_path: Path) -> None:
    text = (
        DECK.replace("CPS4", "S4")
        .replace("*SOLID SECTION", "*SHELL SECTION")
        .replace("4, 0., 1.", "4, 1.7302535485473438E-26, 1.00000000000000000000, 1e-14")
        .replace("1, 1, 2\n", "1,1\n1,2\n1,3\n1,4\n1,5\n1,6\n")
    )
    model = read(tmp_path, text)
    assert [s.dof for s in model.supports] == [0, 1, 0]
    assert any("z coordinates" in note for note in model.notes)
    assert any("SHELL SECTION" in note for note in model.notes)


def test_a_part_out_of_the_plane_is_refused(tmp_path: Path) -> None:
    found = faults(tmp_path, DECK.replace("4, 0., 1.", "4, 0., 1., .5"))
    assert "z = 0.5" in found[0].message
    assert found[0].where.line == 5


def test_prepomax_style(tmp_path: Path) -> None:
    text = DECK.replace(
        "*CLOAD\n",
        "*Boundary, op=New\n1, 1, 2, 0\n4, 1, 1, 0\n*Cload, op=New\n*Dload, op=New\n*Cload\n",
    ).replace("*STATIC\n", "*Static, Solver=Pardiso\n")
    model = read(tmp_path, text)
    assert model.steps[0].new_supports
    assert model.steps[0].new_loads
    assert any("Solver is ignored" in note for note in model.notes)


ABAQUS = """*Heading
** a part used twice
*Part, name=Block
*Node
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*Element, type=CPS4R
1, 1, 2, 3, 4
*Nset, nset=Left
1, 4
*Elset, elset=All, generate
1, 1, 1
*Orientation, name=Ori
1., 0., 0., 0., 1., 0.
*Solid Section, elset=All, material=Steel, orientation=Ori
,
*End Part
*Assembly, name=Assembly
*Instance, name=Block-1, part=Block
*End Instance
*Instance, name=Block-2, part=Block
2., 0., 0.
2., 0., 0., 2., 0., 1., 90.
*End Instance
*Nset, nset=Held, instance=Block-1
2, 3
*Nset, nset=Both
Block-1.Left, Block-2.Left, Block-2.3
*Elset, elset=Second, instance=Block-2
1,
*Surface, type=ELEMENT, name=Top
Second, S3
*End Assembly
*Material, name=Steel
*Elastic
210000., 0.3
*Boundary
Held, 1, 2
Block-2.Left, ENCASTRE
*Step, name=Step-1, nlgeom=YES
*Static
0.1, 1., 1e-05, 1.
*Cload
Block-1.4, 1, 5.
*Dsload
Top, P, 2.
*Restart, write, frequency=0
*Output, field, variable=PRESELECT
*End Step
"""


def test_instances_are_placed_and_named(tmp_path: Path) -> None:
    model = read(tmp_path, ABAQUS)
    mesh = model.mesh
    assert mesh.n_nodes == 8
    assert mesh.n_cells == 2
    # Shifted by (2, 0), then turned by 90 degrees about (2, 0).
    assert np.allclose(mesh.points[4:], [[2, 0], [2, 1], [1, 1], [1, 0]])
    assert mesh.node_sets["Block-2.Left"].tolist() == [4, 7]
    assert mesh.node_sets["Held"].tolist() == [1, 2]
    assert mesh.node_sets["Both"].tolist() == [0, 3, 4, 7, 6]
    assert mesh.cell_sets["Block-1.All"].tolist() == [0]
    assert mesh.edge_sets["Top"].tolist() == [[1, 2]]
    assert [s.cells for s in model.sections] == ["Block-1.All", "Block-2.All"]
    assert [s.orientation for s in model.sections] == pytest.approx([0.0, np.pi / 2])
    assert [s.nodes for s in model.supports][2:] == ["Block-2.Left"] * 2
    assert model.steps[0].loads[0].nodes.tolist() == [3]
    assert len(set(mesh.node_labels.tolist())) == 8


def test_faults_of_assemblies(tmp_path: Path) -> None:
    for old, new, text in (
        ("part=Block\n*End", "part=Blok\n*End", "no part named 'Blok'"),
        ("Block-2.3", "Block-2.33", "no node set named 'Block-2.33'"),
        ("instance=Block-1\n", "instance=Block-7\n", "no instance named Block-7"),
        ("0., 2., 0., 1., 90.", "0., 2., 1., 1., 90.", "normal to the plane"),
        ("*End Assembly\n", "", "no *End Assembly"),
    ):
        assert old in ABAQUS
        found = faults(tmp_path, ABAQUS.replace(old, new))
        assert any(text.lower() in str(d).lower() for d in found), (text, found)


def test_includes_stand_anywhere(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts/mesh.inp").write_text("*INCLUDE, INPUT=nodes.txt\n" + MESH[126:])
    nodes, elements = MESH.split("*ELEMENT")
    (tmp_path / "parts/nodes.txt").write_text("\n".join(nodes.splitlines()[1:]))
    (tmp_path / "parts/mesh.inp").write_text(
        "*NODE, NSET=nall\n*INCLUDE, INPUT=nodes.txt\n*ELEMENT" + elements
    )
    model = read(tmp_path, "*include,input = parts/mesh.inp\n" + SECTION + SUPPORT + STEP)
    assert model.mesh.n_nodes == 6
    assert model.mesh.n_cells == 2


def test_faults_in_included_files_name_that_file(tmp_path: Path) -> None:
    (tmp_path / "mesh.inp").write_text(MESH.replace("3, 2., 0.", "3, two, 0."))
    found = faults(tmp_path, "*INCLUDE, INPUT=mesh.inp\n" + SECTION + SUPPORT + STEP)
    assert found[0].where.file.endswith("mesh.inp")
    assert (found[0].where.line, found[0].where.column) == (4, 4)


def test_includes_stay_in_the_folder(tmp_path: Path) -> None:
    (tmp_path / "out.inp").write_text("*HEADING\n")
    deck = tmp_path / "deck"
    deck.mkdir()
    (deck / "link.inp").symlink_to(tmp_path / "out.inp")
    for name in ("../out.inp", str(tmp_path / "out.inp"), "link.inp", "/dev/zero"):
        found = faults(deck, f"*INCLUDE, INPUT={name}\n" + DECK)
        assert "outside the folder" in found[0].message
        assert "allow-include" in found[0].hint
    model = read(deck, "*INCLUDE, INPUT=../out.inp\n" + DECK, allow_include=True)
    assert model.mesh.n_nodes == 6
    found = faults(deck, "*INCLUDE, INPUT=/dev/zero\n" + DECK, allow_include=True)
    assert "not a regular file" in found[0].message


def test_pipes_folders_and_missing_files_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    for name, text in (("pipe", "regular file"), ("folder", "folder"), ("gone", "No such file")):
        found = faults(tmp_path, f"*INCLUDE, INPUT={name}\n" + DECK)
        assert text in found[0].message


def test_circular_and_deep_includes_are_refused(tmp_path: Path) -> None:
    found = faults(tmp_path, "*INCLUDE, INPUT=deck.inp\n" + DECK)
    assert "includes itself" in found[0].message
    (tmp_path / "a.inp").write_text("*INCLUDE, INPUT=b.inp\n")
    (tmp_path / "b.inp").write_text("*INCLUDE, INPUT=a.inp\n")
    found = faults(tmp_path, "*INCLUDE, INPUT=a.inp\n" + DECK)
    assert "a.inp -> b.inp -> a.inp" in found[0].message
    for level in range(20):
        (tmp_path / f"d{level}.inp").write_text(f"*INCLUDE, INPUT=d{level + 1}.inp\n")
    found = faults(tmp_path, "*INCLUDE, INPUT=d0.inp\n" + DECK)
    assert "nested more than 16 levels deep" in found[0].message


def test_sparse_numbers_cost_nothing(tmp_path: Path) -> None:
    text = DECK
    for node in (6, 5, 4, 3, 2, 1):
        for a, b in ((f"\n{node},", f"\n{node}00000000{node},"),):
            text = text.replace(a, b)
    nodes, rest = DECK.split("*ELEMENT")
    big = 2**31 - 1
    nodes = nodes.replace("6, 2., 1.", f"{big}, 2., 1.").replace("5, 1., 1.", "1000000000, 1., 1.")
    rest = rest.replace("1, 1, 2, 5, 4", "1, 1, 2, 1000000000, 4")
    rest = rest.replace("2, 2, 3, 6, 5", f"999999999, 2, 3, {big}, 1000000000")
    tracemalloc.start()
    model = read(tmp_path, nodes + "*ELEMENT" + rest)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 10_000_000  # less than a byte for each number up to the largest
    assert model.mesh.node_labels.tolist() == [1, 2, 3, 4, 1000000000, big]
    assert model.mesh.cells[0].labels.tolist() == [1, 999999999]


def test_many_sets_and_long_lines(tmp_path: Path) -> None:
    sets = "".join(f"*NSET, NSET=s{i}\n{1 + i % 6}\n" for i in range(3000))
    long = "*NSET, NSET=long\n" + ",".join(["1"] * 300_000) + "\n"
    model = read(tmp_path, MESH + sets + long)
    assert len(model.mesh.node_sets) == 3002
    assert model.mesh.node_sets["long"].tolist() == [0]


def test_lenient_reading_warns_instead(tmp_path: Path) -> None:
    text = DECK.replace("*STATIC", "*FANCY\n1, 2\n*STATIC, FAST=YES")
    with pytest.warns(UserWarning, match=r"unknown") as caught:
        read(tmp_path, text, lenient=True)
    assert len(caught) == 2
    assert len(faults(tmp_path, text)) == 2


def test_a_missing_deck(tmp_path: Path) -> None:
    with pytest.raises(ct.errors.FileError, match=r"none.inp: No such file"):
        ct.read(tmp_path / "none.inp")
    (tmp_path / "folder.inp").mkdir()
    with pytest.raises(ct.errors.FileError, match="folder"):
        ct.read(tmp_path / "folder.inp")
    with pytest.raises(ct.UnsupportedError, match="no reader"):
        ct.read(tmp_path / "deck.bdf")
