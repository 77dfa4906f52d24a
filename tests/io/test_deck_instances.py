"""Decks of Abaqus/CAE: orphan meshes, names over the levels, reference points by sets."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from decks import DECK, faults, read

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

#: An orphan mesh as CAE writes it: the part is empty, the instance holds everything.
ORPHAN = """*Heading
** Job name: Job-1 Model name: Model-1
*Preprint, echo=NO, model=NO, history=NO, contact=NO
*Part, name=Part-1
*End Part
*Assembly, name=Assembly
*Instance, name=Part-1-1, part=Part-1
*Node
      1,           0.,           0.
      2,           2.,           0.
      3,           2.,           1.
      4,           0.,           1.
*Element, type=CPS4
1, 1, 2, 3, 4
*Nset, nset="_Set 1", internal, generate
 1,  4,  1
*Elset, elset="_Set 1", internal
 1,
*Solid Section, elset="_Set 1", material="Mild steel"
0.5,
*End Instance
*Node
      1,           2.,          0.5,           0.
*Nset, nset=Point
 1,
*Nset, nset=Left, instance=Part-1-1
 1, 4
*Elset, elset=_Right_S2, internal, instance=Part-1-1
 1,
*Surface, type=ELEMENT, name=Right
_Right_S2, S2
*Coupling, constraint name=Constraint-1, ref node=Point, surface=Right
*Kinematic
*End Assembly
*Material, name="Mild steel"
*Elastic
1000., 0.
*Boundary
Left, 1, 2
*Step, name=Step-1, nlgeom=NO
*Static
1., 1., 1e-05, 1.
*Cload
Point, 1, 3.
*Restart, write, frequency=0
*Output, field, variable=PRESELECT
*Output, history, variable=PRESELECT
*End Step
"""


def test_an_orphan_mesh_runs(tmp_path: Path) -> None:
    u = ct.solve(read(tmp_path, ORPHAN)).frames[-1].U
    # A bar: u = F l / (E A) = 3 * 2 / (1000 * 0.5).
    assert u[2:4, 0] == pytest.approx([0.012, 0.012], rel=1e-9)


def test_names_are_found_across_the_levels(tmp_path: Path) -> None:
    text = ORPHAN.replace("*Nset, nset=Left, instance=Part-1-1\n 1, 4\n", "")
    text = text.replace("*Elset, elset=_Right_S2, internal, instance=Part-1-1\n 1,\n", "")
    text = text.replace(
        "*End Instance\n",
        "*Nset, nset=Left\n1, 4\n*Elset, elset=_Right_S2\n1\n*End Instance\n",
    )
    for old, new in (
        ("", ""),
        ("Left, 1, 2", "Part-1-1.Left, 1, 2"),
        ("*Cload\nPoint", "*Cload\n3"),
    ):
        model = read(tmp_path, text.replace(old, new) if old else text)
        assert model.mesh.node_sets["Part-1-1.Left"].tolist() == [1, 4]
        assert model.mesh.edge_sets["Right"].tolist() == [[0, 1]]
    # The assembly has a node 1 of its own, and no node 3: that is the instance's.
    assert model.steps[0].loads[0].nodes.tolist() == [3]


def test_a_name_of_two_instances_needs_its_prefix(tmp_path: Path) -> None:
    second = ORPHAN.replace("*Nset, nset=Left, instance=Part-1-1\n 1, 4\n", "")
    second = second.replace("*End Instance\n", "*Nset, nset=Left\n1, 4\n*End Instance\n")
    copy = second[
        second.index("*Instance") : second.index("*Node\n      1,           2.,          0.5")
    ]
    text = second.replace(copy, copy + copy.replace("Part-1-1", "Part-1-2"))
    found = faults(tmp_path, text)
    assert len(found) == 1
    assert "no node set named 'Left'" in found[0].message


def test_a_part_ends_where_the_next_block_begins(tmp_path: Path) -> None:
    model = read(tmp_path, ORPHAN.replace("*End Part\n", ""))
    assert any("has no *END PART" in note for note in model.notes)
    assert model.mesh.n_cells == 1


def test_constraints_of_a_part_hold_in_each_instance(tmp_path: Path) -> None:
    text = """*PART, NAME=P
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*NSET, NSET=A
3
*NSET, NSET=B
2
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*EQUATION
2
A, 1, 1., B, 1, -1.
*END PART
*ASSEMBLY, NAME=X
*INSTANCE, NAME=P1, PART=P
*END INSTANCE
*INSTANCE, NAME=P2, PART=P
3., 0., 0.
*END INSTANCE
*END ASSEMBLY
*MATERIAL, NAME=M
*ELASTIC
1., 0.
"""
    model = read(tmp_path, text)
    terms = [[(n, d) for n, d, _ in e.terms] for e in model.constraints]
    assert terms == [[(2, 0), (1, 0)], [(6, 0), (5, 0)]]


def test_one_node_may_be_named_by_a_set(tmp_path: Path) -> None:
    extra = "*NSET, NSET=tip\n3\n*NSET, NSET=top\n5, 6\n"
    card = "*RIGID BODY, NSET=top, REF NODE=nall\n"
    found = faults(tmp_path, DECK.replace("*MATERIAL", extra + card + "*MATERIAL", 1))
    assert any("one node is expected" in d.message for d in found)
    # In equations between sets a single node is in each of them, as in Abaqus.
    card = "*EQUATION\n2\ntip, 1, 1., top, 1, -1.\n"
    model = read(tmp_path, DECK.replace("*MATERIAL", extra + card + "*MATERIAL", 1))
    terms = [[(n, d) for n, d, _ in e.terms] for e in model.constraints]
    assert terms == [[(2, 0), (4, 0)], [(2, 0), (5, 0)]]
    model = read(
        tmp_path,
        DECK.replace("*MATERIAL", extra + "*RIGID BODY, NSET=top, REF NODE=tip\n*MATERIAL", 1),
    )
    assert model.constraints[0].reference == 2


def test_parameters_may_be_abbreviated(tmp_path: Path) -> None:
    text = DECK.replace("*MATERIAL", "*NSET, NSET=a, GEN\n1, 5, 2\n*MATERIAL", 1).replace(
        "*CLOAD", "*NODE PRINT, NSET=a, FREQ=3\nU\n*CLOAD"
    )
    model = read(tmp_path, text)
    assert model.mesh.node_sets["a"].tolist() == [0, 2, 4]
    assert model.steps[0].outputs[0].frequency == 3
    found = faults(tmp_path, DECK.replace("*CLOAD", "*CLOAD, AM=x"))
    assert any("unknown parameter AM" in d.message for d in found)


def test_output_that_is_not_written_is_noted(tmp_path: Path) -> None:
    text = DECK.replace("*CLOAD", "*NODE OUTPUT\nU2, CF, FOO\n*EL PRINT\nMISES, S\n*CLOAD")
    model = read(tmp_path, text)
    assert [(o.kind, o.variables, o.where) for o in model.steps[0].outputs] == [
        ("node file", ("U",), ""), ("el print", ("MISES", "S"), ""),
    ]  # fmt: skip
    assert any("CF, FOO is not written; there are U, UR, RF, V, NT" in note for note in model.notes)


def test_heat_beside_a_mechanical_material_is_noted(tmp_path: Path) -> None:
    heat = "*CONDUCTIVITY\n50.\n*SPECIFIC HEAT\n4.e8\n*SOLID SECTION"
    text = DECK.replace("*SOLID SECTION", heat).replace(
        "*NODE", "*PHYSICAL CONSTANTS, ABSOLUTE ZERO=-273.\n*NODE", 1
    )
    model = read(tmp_path, text)
    # The specific heat belongs to the heat of plastic work.
    assert sum("contains no stresses" in note for note in model.notes) == 2
    assert model.sections[0].material.E == 210000.0


def test_text_after_heading_is_a_title(tmp_path: Path) -> None:
    assert read(tmp_path, "*HEADING a strip\n" + DECK).title == "a strip"


def test_faults_of_a_part_are_told_once(tmp_path: Path) -> None:
    text = ORPHAN.replace("*End Part\n", "*Nset, nset=a\nb\n*End Part\n")
    text = text.replace(
        "*Node\n      1,           2.,          0.5",
        "*Instance, name=P2, part=Part-1\n*End Instance\n"
        "*Node\n      1,           2.,          0.5",
    )
    assert sum("no node set named 'b'" in d.message for d in faults(tmp_path, text)) == 1
