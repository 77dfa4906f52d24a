"""Nodes and elements made from others, parameters, collapsed quadrilaterals, element names."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from decks import DECK, MESH, SECTION, STEP, SUPPORT, faults, read

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

#: The mesh of :data:`decks.MESH`, generated.
GENERATED = """*NODE
1, 0., 0.
3, 2., 0.
4, 0., 1.
6, 2., 1.
*NGEN, NSET=low
1, 3
*NGEN, NSET=high
4, 6, 1
*ELEMENT, TYPE=CPS4
1, 1, 2, 5, 4
*ELGEN, ELSET=eall
1, 2, 1, 1
"""


def points(model: ct.Model) -> dict[int, list[float]]:
    mesh = model.mesh
    return {int(n): p.tolist() for n, p in zip(mesh.node_labels, mesh.points, strict=True)}


def test_a_generated_mesh_is_the_written_one(tmp_path: Path) -> None:
    made, written = read(tmp_path, GENERATED + SECTION), read(tmp_path, MESH + SECTION)
    assert points(made) == points(written)
    assert made.mesh.cell_labels.tolist() == [1, 2]
    cells = [made.mesh.node_labels[c.nodes].tolist() for c in made.mesh.cells]
    assert cells == [[[1, 2, 5, 4], [2, 3, 6, 5]]]
    assert made.mesh.node_labels[made.mesh.node_sets["high"]].tolist() == [4, 5, 6]


def test_nfill_joins_two_lines(tmp_path: Path) -> None:
    text = GENERATED.replace("4, 0., 1.\n6, 2., 1.", "21, 0., 1.\n23, 2., 1.").replace(
        "4, 6, 1", "21, 23, 1\n*NFILL, NSET=all\nlow, high, 2, 10"
    )
    text = text.replace("1, 1, 2, 5, 4", "1, 1, 2, 12, 11").replace(
        "1, 2, 1, 1", "1, 2, 1, 1, 2, 10, 2"
    )
    model = read(tmp_path, text + SECTION)
    assert points(model)[12] == [1.0, 0.5]
    assert model.mesh.cell_labels.tolist() == [1, 2, 3, 4]
    assert len(model.mesh.node_sets["all"]) == 9
    biased = read(tmp_path, text.replace("*NFILL,", "*NFILL, BIAS=0.5,") + SECTION)
    # The first of two intervals is half of the second.
    assert points(biased)[12] == pytest.approx([1.0, 1.0 / 3.0])


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("*NGEN, LINE=C\n1, 3, 1, 9", [np.sqrt(0.5), np.sqrt(0.5)]),
        ("*NGEN, LINE=C\n1, 3, 1, , 0., 0., 0., 0., 0., -1.", [-np.sqrt(0.5), -np.sqrt(0.5)]),
        ("*NGEN, LINE=P\n1, 3, 1, 8", [0.6, 0.6]),
        ("*NGEN\n1, 3", [0.5, 0.5]),
    ],
)
def test_ngen_on_curves(tmp_path: Path, line: str, expected: list[float]) -> None:
    text = f"""*NODE
1, 1., 0.
3, 0., 1.
8, .6, .6
9, 0., 0.
{line}
*ELEMENT, TYPE=CPS3, ELSET=eall
1, 1, 3, 2
"""
    if expected == [0.5, 0.5]:
        text = text.replace("1, 1, 3, 2", "1, 1, 3, 9")
    assert points(read(tmp_path, text))[2] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("card", "expected"),
    [
        ("SHIFT\n3., 0., 0.", [4.0, 0.0]),
        ("SHIFT\n0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.", [0.0, 1.0]),
        ("REFLECT=LINE\n0., 0., 0., 0., 1., 0.", [-1.0, 0.0]),
        ("REFLECT=MIRROR\n0., 2., 0., 1., 2., 0.\n0., 2., 1.", [1.0, 4.0]),
        ("REFLECT=POINT\n0., 1., 0.", [-1.0, 2.0]),
    ],
)
def test_copies_of_nodes_and_elements(tmp_path: Path, card: str, expected: list[float]) -> None:
    copy = f"*NCOPY, CHANGE NUMBER=100, OLD SET=nall, NEW SET=more, {card}\n"
    copy += "*ELCOPY, ELEMENT SHIFT=10, OLD SET=eall, SHIFT NODES=100, NEW SET=copies\n"
    model = read(tmp_path, MESH + copy + SECTION.replace("eall", "both").replace(
        "*MATERIAL", "*ELSET, ELSET=both\neall, copies\n*MATERIAL"))  # fmt: skip
    assert points(model)[102] == pytest.approx(expected)
    assert model.mesh.cell_labels.tolist() == [1, 2, 11, 12]
    assert len(model.mesh.cell_sets["copies"]) == 2


def test_axes_of_nodes(tmp_path: Path) -> None:
    text = MESH.replace("*ELEMENT", "*NODE, SYSTEM=C\n7, 2., 90.\n*SYSTEM\n1., 1., 0., 1., 2., 0.\n"
                        "*NODE\n8, 1., 0.\n*SYSTEM\n*NODE\n9, 5., 5.\n*ELEMENT")  # fmt: skip
    found = points(read(tmp_path, text))
    assert found[7] == pytest.approx([0.0, 2.0])
    assert found[8] == pytest.approx([1.0, 2.0])
    assert found[9] == [5.0, 5.0]


def test_faults_of_generation(tmp_path: Path) -> None:
    for old, new, message in (
        ("1, 3\n", "1, 7\n", "node 7 is not defined before"),
        ("1, 3\n", "1, 3, 5\n", "is not reached"),
        ("1, 2, 1, 1", "9, 2, 1, 1", "element 9 is not defined before"),
        ("1, 2, 1, 1", "1, 0, 1, 1", "are expected"),
        ("*ELEMENT", "*NFILL\nlow, hgh, 2, 10\n*ELEMENT", "no node set named"),
        ("*ELEMENT", "*NCOPY, CHANGE NUMBER=5, OLD SET=lw, SHIFT\n1.\n*ELEMENT", "no node set"),
    ):
        assert old in GENERATED
        found = faults(tmp_path, GENERATED.replace(old, new, 1) + SECTION)
        assert any(message in d.message for d in found), (new, list(map(str, found)))


def test_parameters_are_worked_out(tmp_path: Path) -> None:
    head = "*PARAMETER\nlength = 2.0\nhalf = length/2 # comment\nforce = -sqrt(25) * 2**0\nn = 3\n"
    text = head + DECK.replace("3, 2., 0.", "3, <length>, 0.").replace("5, 1., 1.", "5, <half>, 1.")
    model = read(tmp_path, text.replace("3, 2, -5.", "<n>, 2, <force>"))
    assert points(model)[3] == [2.0, 0.0]
    assert points(model)[5] == [1.0, 1.0]
    assert model.steps[0].loads[0].value == -5.0
    for line, message in (
        ("x = __import__('os').getcwd()", "may stand here"),
        ("x = open('a')", "no function open"),
        ("x = 9**9**9", "too large"),
        ("x = y", "no *PARAMETER named y"),
        ("x = 1 +", "is not an expression"),
        ("x", "expected name"),
        ("x = 1/0", "division"),
        ("x = 'a'*9", "cannot be mixed"),
    ):
        found = faults(tmp_path, f"*PARAMETER\n{line}\n" + DECK)
        assert len(found) == 1
        assert message in found[0].message
        assert found[0].where is not None
        assert found[0].where.line == 2
    found = faults(tmp_path, head + DECK.replace("3, 2., 0.", "3, <lenth>, 0."))
    assert "no *PARAMETER named lenth" in found[0].message


def test_data_lines_of_a_file(tmp_path: Path) -> None:
    lines = MESH.split("*ELEMENT")[0].split("\n", 1)
    (tmp_path / "nodes.txt").write_text(lines[1])
    model = read(tmp_path, lines[0] + ", INPUT=nodes.txt\n" + DECK[DECK.index("*ELEMENT") :])
    assert model.mesh.n_nodes == 6
    (tmp_path / "nodes.txt").write_text(MESH)
    found = faults(tmp_path, lines[0] + ", INPUT=nodes.txt\n" + DECK[DECK.index("*ELEMENT") :])
    assert any("has keywords" in d.message for d in found)


#: Corners of a square and its mid-side nodes, numbered as a quadrilateral of eight nodes.
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)]


@pytest.mark.parametrize("side", range(4))
@pytest.mark.parametrize("quadratic", [False, True])
@pytest.mark.parametrize("clockwise", [False, True])
def test_a_quadrilateral_with_a_side_of_one_node_is_a_triangle(
    tmp_path: Path, side: int, quadratic: bool, clockwise: bool
) -> None:
    twin, count = (side + 1) % 4, 8 if quadratic else 4
    points_ = [list(p) for p in SQUARE]
    for i in range(4):  # sides that end in the twin now end in its partner
        a, b = (points_[side] if k == twin else points_[k] for k in (i, (i + 1) % 4))
        points_[4 + i] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]
    order = [0, 3, 2, 1, 7, 6, 5, 4] if clockwise else list(range(8))
    number = {i: i + 1 for i in range(8)} | {twin: side + 1, 4 + side: side + 1}
    nodes = "".join(f"{i + 1}, {p[0]}, {p[1]}\n" for i, p in enumerate(points_) if i != twin)
    row = ", ".join(str(number[order[i]]) for i in range(count))
    name = "CPS8R" if quadratic else "CPS4R"
    loads = "".join(f"1, P{f}, {f}.\n" for f in range(1, 5))
    text = f"*NODE\n{nodes}*ELEMENT, TYPE={name}, ELSET=eall\n1, {row}\n" + SECTION
    text += f"*STEP\n*STATIC\n*DLOAD\n{loads}*END STEP\n"
    model = read(tmp_path, text)
    assert [c.kind for c in model.mesh.cells] == ["tri6" if quadratic else "tri3"]
    assert model.sections[0].element == ("T6" if quadratic else "T3")
    assert any("side of one node" in note for note in model.notes)
    # Each pressure acts on the edge between the nodes that its face has in the deck.
    found = {}
    for load in model.steps[0].loads:
        for ends in model.mesh.edge_nodes(load.edges):
            found[load.value[0]] = set(model.mesh.node_labels[ends[:2]].tolist())
    expected = {}
    for f in range(4):
        ends = {number[order[f]], number[order[(f + 1) % 4]]}
        if len(ends) == 2:
            expected[f + 1.0] = ends
    assert found == expected


def test_a_collapsed_quadrilateral_has_the_triangles_answer(tmp_path: Path) -> None:
    lines = "1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n"
    quads = "1, 1, 2, 5, 4\n2, 2, 3, 3, 5\n3, 3, 6, 5, 5\n"
    mixed = "1, 1, 2, 5, 4\n*ELEMENT, TYPE=CPS3, ELSET=eall\n2, 2, 3, 5\n3, 3, 6, 5\n"
    answers = [
        ct.solve(read(tmp_path, DECK.replace(lines, m))).frames[-1].U for m in (quads, mixed)
    ]
    assert answers[0] == pytest.approx(answers[1], rel=1e-12)


@pytest.mark.parametrize(
    ("name", "element", "plane"),
    [("M3D4", "Q4", "stress"), ("S4R5", "Q4S", "stress"), ("CPE4H", "Q4S", "strain"),
     ("CPE4RH", "Q4S", "strain")],
)  # fmt: skip
def test_kin_of_planar_elements(tmp_path: Path, name: str, element: str, plane: str) -> None:
    model = read(tmp_path, DECK.replace("CPS4", name))
    assert (model.sections[0].element, model.sections[0].plane) == (element, plane)


def test_meshio_names_need_a_plane(tmp_path: Path) -> None:
    text = DECK.replace("CPS4", "CAX4P")
    found = faults(tmp_path, text)
    assert "which plane is meant" in found[0].message
    model = read(tmp_path, text, element_map={"CAX4P": "CPE4"})
    assert model.sections[0].plane == "strain"
    model = read(tmp_path, text.replace("*SOLID SECTION", "*SOLID SECTION, PLANE=STRAIN"))
    assert model.sections[0].plane == "strain"
    assert read(tmp_path, text[: text.index("*MATERIAL")]).mesh.n_cells == 2


def test_membrane_section(tmp_path: Path) -> None:
    text = (
        DECK.replace("CPS4", "M3D4").replace("*SOLID", "*MEMBRANE").replace("2.\n*B", "2., 5\n*B")
    )
    assert read(tmp_path, text).sections[0].thickness == 2.0


def test_sides_of_a_rigid_body(tmp_path: Path) -> None:
    rigid = "*ELEMENT, TYPE=R2D2, ELSET=rim\n11, 3, 6\n*NODE\n9, 3., 0.5\n"
    rigid += "*RIGID BODY, ELSET=rim, REF NODE=9\n"
    text = MESH + rigid + SECTION + SUPPORT + STEP.replace("3, 2", "9, 2").replace(", NLGEOM", "")
    frame = ct.solve(read(tmp_path, text)).frames[-1]
    # All of x = 2 moves like a rigid body about the node 9.
    slope = (frame.U[5, 0] - frame.U[2, 0]) / -1.0
    assert frame.U[2, 1] == pytest.approx(frame.U[6, 1] - slope, rel=1e-9)
    assert frame.U[5, 1] == pytest.approx(frame.U[2, 1], rel=1e-9)
