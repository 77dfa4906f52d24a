"""Each keyword of a deck by a few lines: what it puts into the model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from decks import DECK, MESH, SECTION, STEP, SUPPORT, read

import corota as ct
from corota.model.loads import BodyForce, EdgeLoad, NodalForce


def with_step(lines: str) -> str:
    return MESH + SECTION + SUPPORT + "*STEP\n*STATIC\n" + lines + "*END STEP\n"


def test_the_plain_deck(tmp_path: Path) -> None:
    model = read(tmp_path, DECK)
    assert model.mesh.points.tolist() == [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
    assert model.mesh.cells[0].nodes.tolist() == [[0, 1, 4, 3], [1, 2, 5, 4]]
    section = model.sections[0]
    assert (section.cells, section.element, section.plane) == ("eall", "Q4", "stress")
    assert section.thickness == 2.0
    assert section.material == ct.Elastic(210000.0, 0.3, name="steel")
    assert [(s.nodes.tolist(), s.dof) for s in model.supports] == [([0], 0), ([0], 1), ([3], 0)]
    step = model.steps[0]
    assert (step.nlgeom, step.first_increment, step.period) == (True, 0.1, 1.0)
    load = step.loads[0]
    assert isinstance(load, NodalForce)
    assert (load.nodes.tolist(), load.dof, load.value) == ([2], 1, -5.0)


def test_case_and_blanks_have_no_meaning(tmp_path: Path) -> None:
    odd = DECK.lower().replace("*solid section", "*Solid  SECTION").replace("*end step", "*EndStep")
    odd = odd.replace(", ", "\t ,  ").replace("elset=eall", "El Set = EALL")
    model = read(tmp_path, odd)
    plain = read(tmp_path, DECK)
    assert np.array_equal(model.mesh.points, plain.mesh.points)
    assert model.sections[0].element == "Q4"
    assert model.supports == plain.supports or len(model.supports) == 3


@pytest.mark.parametrize("ending", ["\r\n", "\r", "\n"])
@pytest.mark.parametrize("coding", ["utf-8", "latin-1", "utf-8-sig"])
def test_line_ends_and_codings(tmp_path: Path, ending: str, coding: str) -> None:
    text = "*HEADING\nTräger, 20 µm\n** Prüfung\n" + DECK
    model = read(tmp_path, text.replace("\n", ending).encode(coding))
    assert model.mesh.n_nodes == 6
    assert model.title == "Träger, 20 µm"


def test_long_lines_long_numbers_and_fortran_exponents(tmp_path: Path) -> None:
    text = DECK.replace("2, 1., 0.", "2, 1.00000000000000000000000000D+00" + " " * 100_000 + ", 0.")
    text = text.replace("210000., .3", "2.1d5, 3.0000000000000000000E-01")
    model = read(tmp_path, text)
    assert model.mesh.points[1, 0] == 1.0
    assert model.sections[0].material == ct.Elastic(210000.0, 0.3, name="steel")


def test_empty_fields_are_zero_and_comments_are_skipped(tmp_path: Path) -> None:
    model = read(tmp_path, DECK.replace("4, 0., 1.\n", "** in between\n\n4, , 1., 0.,\n"))
    assert model.mesh.points[3].tolist() == [0.0, 1.0]


@pytest.mark.parametrize(
    ("deck", "element", "plane", "size"),
    [
        ("CPS3", "T3", "stress", 3),
        ("CPE3", "T3", "strain", 3),
        ("CPS4", "Q4", "stress", 4),
        ("CPE4", "Q4", "strain", 4),
        ("CPS4I", "Q4I", "stress", 4),
        ("CPE4I", "Q4I", "strain", 4),
        ("CPS4R", "Q4I", "stress", 4),
        ("CPE4R", "Q4I", "strain", 4),
        ("CPS6", "T6", "stress", 6),
        ("CPE6", "T6", "strain", 6),
        ("CPS8", "Q8", "stress", 8),
        ("CPE8", "Q8", "strain", 8),
        ("CPS8R", "Q8R", "stress", 8),
        ("CPE8R", "Q8R", "strain", 8),
        ("S3", "T3", "stress", 3),
        ("S4", "Q4", "stress", 4),
        ("T3", "T3", "stress", 3),
        ("T6", "T6", "stress", 6),
        ("Q4", "Q4", "stress", 4),
        ("Q4I", "Q4I", "stress", 4),
        ("Q4S", "Q4S", "stress", 4),
        ("Q4R", "Q4R", "stress", 4),
        ("Q4D", "Q4D", "stress", 4),
        ("Q4DI", "Q4DI", "stress", 4),
        ("OPT", "OPT", "stress", 3),
        ("Q8", "Q8", "stress", 8),
        ("Q8R", "Q8R", "stress", 8),
        ("Q9", "Q9", "stress", 9),
    ],
)
def test_element_names(tmp_path: Path, deck: str, element: str, plane: str, size: int) -> None:
    corners = {3: [(0, 0), (2, 0), (0, 2)], 4: [(0, 0), (2, 0), (2, 2), (0, 2)]}
    base = corners[3 if size in (3, 6) else 4]
    points = list(base)
    if size > 4:
        points += [
            ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
            for a, b in zip(base, base[1:] + base[:1], strict=True)
        ]
    if size == 9:
        points.append((1, 1))
    nodes = "".join(f"{i}, {x}, {y}\n" for i, (x, y) in enumerate(points, start=1))
    text = f"*NODE\n{nodes}*ELEMENT, TYPE={deck}, ELSET=eall\n5, " + ", ".join(
        str(i) for i in range(1, size + 1)
    )
    model = read(tmp_path, text + "\n" + SECTION)
    assert model.mesh.cells[0].nodes.tolist() == [list(range(size))]
    assert model.mesh.cells[0].labels.tolist() == [5]
    assert (model.sections[0].element, model.sections[0].plane) == (element, plane)


@pytest.mark.parametrize(
    ("deck", "literal"), [("CPS4R", "Q4R"), ("CPE4R", "Q4R"), ("S4R", "Q4R"), ("CPS4I", "Q4I")]
)
def test_reduced_integration_is_literal_where_it_is_asked_for(
    tmp_path: Path, deck: str, literal: str
) -> None:
    """Claim: what stands for CPS4R is named in a note; as_written takes it literally."""
    nodes = "1,0,0\n2,2,0\n3,2,2\n4,0,2\n"
    text = f"*NODE\n{nodes}*ELEMENT, TYPE={deck}, ELSET=eall\n5, 1, 2, 3, 4\n{SECTION}"
    path = tmp_path / "literal.inp"
    path.write_text(text)
    assert ct.read(path, as_written=True).sections[0].element == literal
    model = ct.read(path)
    assert model.sections[0].element == "Q4I"
    assert any(f"{deck} becomes Q4I" in n for n in model.notes) == (deck != "CPS4I")
    assert ct.read(path, element_map={deck: "Q4D"}, as_written=True).sections[0].element == "Q4D"


def test_a_long_element_line_continues_after_a_comma(tmp_path: Path) -> None:
    text = "*NODE\n1,0,0\n2,2,0\n3,2,2\n4,0,2\n5,1,0\n6,2,1\n7,1,2\n8,0,1\n"
    text += "*ELEMENT, TYPE=CPS8, ELSET=eall\n1, 1, 2, 3, 4, 5,\n6, 7, 8\n"
    assert read(tmp_path, text + SECTION).mesh.cells[0].nodes.tolist() == [list(range(8))]


def test_plane_strain_of_a_section(tmp_path: Path) -> None:
    text = DECK.replace("TYPE=CPS4", "TYPE=Q4I").replace(
        "*SOLID SECTION,", "*SOLID SECTION, PLANE=STRAIN, LOCAL STRAIN=GREEN LAGRANGE,"
    )
    section = read(tmp_path, text).sections[0]
    assert (section.plane, section.local_strain) == ("strain", "green_lagrange")


def test_element_map_keeps_the_plane_state(tmp_path: Path) -> None:
    text = DECK.replace("CPS4", "CPE4")
    section = read(tmp_path, text, element_map={"cpe4": "Q4D"}).sections[0]
    assert (section.element, section.plane) == ("Q4D", "strain")
    for wrong in ({"CPE4": "OPT"}, {"CPE4": "Q5"}, {"CPE44": "Q4"}):
        with pytest.raises(ct.InputError):
            read(tmp_path, text, element_map=wrong)


def test_one_section_over_two_element_types(tmp_path: Path) -> None:
    text = MESH + "*NODE\n7, 3., 0.\n*ELEMENT, TYPE=CPS3, ELSET=eall\n3, 3, 7, 6\n" + SECTION
    model = read(tmp_path, text)
    assert [(s.element, s.cells.tolist()) for s in model.sections] == [("Q4", [0, 1]), ("T3", [2])]


def test_sets_grow_mix_and_keep_their_order(tmp_path: Path) -> None:
    text = MESH + (
        "*NSET, NSET=a\n5, 2\n*NSET, NSET=b, GENERATE\n1, 5, 2\n*NSET, NSET=A\n b, 6, 2,\n"
        "*ELSET, ELSET=a\n2\n*ELSET, ELSET=c, GENERATE\n1, 2\n*NSET, NSET=d, ELSET=a\n"
    )
    mesh = read(tmp_path, text).mesh
    assert mesh.node_sets["a"].tolist() == [4, 1, 0, 2, 5]
    assert mesh.node_sets["b"].tolist() == [0, 2, 4]
    assert mesh.node_sets["d"].tolist() == [1, 2, 4, 5]
    assert mesh.cell_sets["a"].tolist() == [1]
    assert mesh.cell_sets["c"].tolist() == [0, 1]
    assert mesh.node_sets["nall"].tolist() == list(range(6))


def test_surfaces_of_faces_sets_and_nodes(tmp_path: Path) -> None:
    text = MESH + (
        "*SURFACE, NAME=top, TYPE=ELEMENT\n1, S3\n2, S3\n*SURFACE, NAME=low\neall, S1\n"
        "*SURFACE, NAME=around\neall,\n*SURFACE, NAME=points, TYPE=NODE\n1,\nnall,\n"
    )
    mesh = read(tmp_path, text).mesh
    assert mesh.edge_sets["top"].tolist() == [[0, 2], [1, 2]]
    assert mesh.edge_sets["low"].tolist() == [[0, 0], [1, 0]]
    assert len(mesh.edge_sets["around"]) == 6
    assert mesh.node_sets["points"].tolist() == list(range(6))


def test_clockwise_elements_are_turned_and_keep_their_faces(tmp_path: Path) -> None:
    text = DECK.replace("2, 2, 3, 6, 5", "2, 2, 5, 6, 3").replace(
        "*CLOAD\n3, 2, -5.\n", "*DLOAD\n2, P2, 3.\neall, P1, 1.\n"
    )
    text = text.replace("*MATERIAL", "*SURFACE, NAME=top\n1, S3\n2, S2\n*MATERIAL")
    model = read(tmp_path, text)
    mesh = model.mesh
    assert mesh.cells[0].nodes.tolist()[1] == [1, 2, 5, 4]
    assert sum("clockwise" in note for note in model.notes) == 1
    y = mesh.points[np.concatenate(mesh.edge_nodes(mesh.edge_sets["top"])), 1]
    assert (y == 1.0).all()
    upper, both = model.steps[0].loads
    assert isinstance(upper, EdgeLoad)
    assert isinstance(both, EdgeLoad)
    assert [set(e.tolist()) for e in mesh.edge_nodes(upper.edges)] == [{4, 5}]
    assert [set(e.tolist()) for e in mesh.edge_nodes(both.edges)] == [{0, 1}, {1, 4}]


def test_materials(tmp_path: Path) -> None:
    text = DECK.replace("*SOLID", "*DENSITY\n7.8e-9\n*SOLID")
    assert read(tmp_path, text).sections[0].material.rho == 7.8e-9
    text = DECK.replace("210000., .3", "210000., .3, 20.")
    assert any("temperature" in note for note in read(tmp_path, text).notes)


@pytest.mark.parametrize(
    ("type_", "rows", "wanted"),
    [
        (
            "ENGINEERING CONSTANTS",
            "10., 4., 3., .3, .2, .1, 2., 1.,\n1.",
            [10, 4, 3, 0.3, 0.2, 0.1, 2],
        ),
        ("LAMINA", "10., 4., .3, 2.", [10, 4, 4, 0.3, 0.3, 0.0, 2]),
    ],
)
def test_orthotropic_materials_with_an_orientation(
    tmp_path: Path, type_: str, rows: str, wanted: list[float]
) -> None:
    text = DECK.replace("*ELASTIC\n210000., .3", f"*ELASTIC, TYPE={type_}\n{rows}").replace(
        "MATERIAL=steel\n2.", "MATERIAL=steel, ORIENTATION=fiber\n2."
    )
    text = text.replace("*MATERIAL", "*ORIENTATION, NAME=Fiber\n1., 1., 0., -1., 1.\n*MATERIAL", 1)
    section = read(tmp_path, text).sections[0]
    assert section.material.parameters()[:7] == pytest.approx(wanted)
    assert section.orientation == pytest.approx(math.pi / 4)


def test_an_orthotropic_stiffness_gives_its_constants(tmp_path: Path) -> None:
    wood = ct.Orthotropic(10.0, 4.0, 3.0, 0.3, 0.2, 0.1, 2.0)
    c = np.linalg.inv(
        [
            [1 / 10, -0.3 / 10, -0.2 / 10],
            [-0.3 / 10, 1 / 4, -0.1 / 4],
            [-0.2 / 10, -0.1 / 4, 1 / 3],
        ]
    )
    rows = f"{c[0, 0]}, {c[0, 1]}, {c[1, 1]}, {c[0, 2]}, {c[1, 2]}, {c[2, 2]}, 2.\n"
    text = DECK.replace("*ELASTIC\n210000., .3\n", "*ELASTIC, TYPE=ORTHO\n" + rows)
    material = read(tmp_path, text).sections[0].material
    assert material.parameters() == pytest.approx(wood.parameters())


def test_an_orientation_may_turn_about_its_third_axis(tmp_path: Path) -> None:
    text = DECK.replace("MATERIAL=steel\n2.", "MATERIAL=steel, ORIENTATION=o\n2.").replace(
        "*MATERIAL", "*ORIENTATION, NAME=o\n1., 0., 0., 0., 1., 0.\n3, 30.\n*MATERIAL", 1
    )
    assert read(tmp_path, text).sections[0].orientation == pytest.approx(math.pi / 6)


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("nall, 1", [("nall", 0, 0.0)]),
        ("1, 1, 2, .5", [(0, 0, 0.5), (0, 1, 0.5)]),
        ("1, 2, , -.5", [(0, 1, -0.5)]),
        ("1, ENCASTRE", [(0, 0, 0.0), (0, 1, 0.0)]),
        ("1, pinned", [(0, 0, 0.0), (0, 1, 0.0)]),
        ("1, XSYMM", [(0, 0, 0.0)]),
        ("1, YSYMM", [(0, 1, 0.0)]),
        ("1, 1, 6", [(0, 0, 0.0), (0, 1, 0.0)]),
        ("1, 3, 5", []),
        ("1, 3", []),
        ("1, 6, 6", []),
    ],
)
def test_supports(tmp_path: Path, line: str, wanted: list[tuple[object, int, float]]) -> None:
    model = read(tmp_path, MESH + SECTION + "*BOUNDARY\n" + line + "\n" + STEP)
    found = [
        (s.nodes if isinstance(s.nodes, str) else int(s.nodes[0]), s.dof, s.value)
        for s in model.supports
    ]
    assert found == wanted


def test_dof_6_is_the_drilling_rotation(tmp_path: Path) -> None:
    text = DECK.replace("CPS4", "Q4D").replace("3, 2, -5.", "3, 6, -5.").replace("1, 1, 2", "1,1,6")
    model = read(tmp_path, text)
    assert [s.dof for s in model.supports] == [0, 1, 2, 0]
    assert model.steps[0].loads[0].dof == 2


def test_loads(tmp_path: Path) -> None:
    model = read(
        tmp_path,
        with_step(
            "*CLOAD\nnall, 1, 2.\n1, 3, 0.\n*DLOAD\neall, GRAV, 9.81, 0., -2., 0.\n"
            "eall, CENTRIF, 4., 1., 2., 0., 0., 0., 1.\n2, P2, -3.\n"
            "*DSLOAD\nright, P, 7.\n*DSLOAD, FOLLOWER=NO\nright, TRVEC, 10., 3., 4.\n"
        ).replace("*MATERIAL", "*SURFACE, NAME=right\n2, S2\n*MATERIAL"),
    )
    force, weight, spin, face, push, pull = model.steps[0].loads
    assert isinstance(force, NodalForce)
    assert (force.nodes, force.dof, force.value) == ("nall", 0, 2.0)
    assert isinstance(weight, BodyForce)
    assert (weight.cells, weight.kind, weight.value) == ("eall", "gravity", (0.0, -9.81))
    assert isinstance(spin, BodyForce)
    assert (spin.kind, spin.value) == ("centrifugal", (4.0, 1.0, 2.0))
    assert isinstance(face, EdgeLoad)
    assert (face.edges.tolist(), face.kind, face.value) == ([[1, 1]], "pressure", (-3.0,))
    assert isinstance(push, EdgeLoad)
    assert (push.edges, push.kind, push.value) == ("right", "pressure", (7.0,))
    assert isinstance(pull, EdgeLoad)
    assert (pull.kind, pull.value) == ("traction", pytest.approx((6.0, 8.0)))


def test_amplitudes(tmp_path: Path) -> None:
    text = with_step("*CLOAD, AMPLITUDE=Up\n3, 1, 2.\n").replace(
        "*STEP",
        "*AMPLITUDE, NAME=up, TIME=TOTAL TIME, SHIFTX=1., SHIFTY=.5\n0., 0., 1., 1.,\n2., 0.\n"
        "*STEP",
        1,
    )
    model = read(tmp_path, text)
    table = model.amplitudes["up"]
    assert table.time.tolist() == [1.0, 2.0, 3.0]
    assert table.value.tolist() == [0.5, 1.5, 0.5]
    assert table.total_time
    assert model.steps[0].loads[0].amplitude == "up"


@pytest.mark.parametrize(
    ("step", "static", "wanted"),
    [
        ("", "", (1.0, 1.0, 1e-6, 1.0, False)),
        (", INC=7", ".1, 2., .01, .5", (0.1, 2.0, 0.01, 0.5, False)),
        ("", "DIRECT.25, 1.", (0.25, 1.0, 1e-6, 1.0, True)),
    ],
)
def test_increments_of_a_step(
    tmp_path: Path, step: str, static: str, wanted: tuple[float, float, float, float, bool]
) -> None:
    direct = static.startswith("DIRECT")
    lines = f"*STEP{step}\n*STATIC{', DIRECT' if direct else ''}\n{static.replace('DIRECT', '')}\n"
    found = read(tmp_path, MESH + SECTION + SUPPORT + lines + "*END STEP\n").steps[0]
    assert (
        found.first_increment,
        found.period,
        found.smallest_increment,
        found.largest_increment,
        found.fixed_increments,
    ) == pytest.approx(wanted)
    assert found.max_increments == (7 if step else 100)
    assert not found.nlgeom


def test_several_steps_with_new_and_modified_conditions(tmp_path: Path) -> None:
    text = (
        MESH
        + SECTION
        + SUPPORT
        + (
            "*STEP, NLGEOM, AMPLITUDE=STEP\n*STATIC\n*CLOAD\n3, 1, 1.\n3, 1, 2.\n*END STEP\n"
            "*STEP\n*STATIC\n*CLOAD, op=New\n6, 1, 1.\n*END STEP\n"
            "*STEP, NLGEOM=NO\n*STATIC\n*BOUNDARY, OP=NEW\n1, 1, 2\n3, 2\n*END STEP\n"
        )
    )
    model = read(tmp_path, text)
    first, second, third = model.steps
    # Once on, NLGEOM stays on; the deck is told.
    assert [s.nlgeom for s in model.steps] == [True, True, True]
    assert any("NLGEOM=NO" in note for note in model.notes)
    assert [s.ramp for s in model.steps] == [False, True, True]
    assert [load.value for load in first.loads] == [1.0, 2.0]
    assert (second.new_loads, second.new_supports) == ({"force"}, False)
    assert (third.new_loads, third.new_supports) == (set(), True)
    # Supports before the first step do not outlive OP=NEW.
    assert (len(model.supports), len(first.supports), len(third.supports)) == (0, 3, 3)


def test_output_requests(tmp_path: Path) -> None:
    text = with_step(
        "*NODE PRINT, NSET=nall, TOTALS=ONLY, FREQUENCY=5\nRF\n"
        "*EL PRINT, ELSET=EALL, TIME POINTS=tp\nS, E\n*NODE FILE, OUTPUT=2D\nU, RF, NT\n"
        "*EL FILE, FREQUENCY=0\nS\n*OUTPUT, FIELD, FREQUENCY=3\n*ELEMENT OUTPUT\nS, SDV\n"
        "*NODE OUTPUT\nU\n*OUTPUT, HISTORY, VARIABLE=PRESELECT\n"
    ).replace("*STEP", "*TIME POINTS, NAME=tp\n.25, .5, 1.\n*STEP", 1)
    model = read(tmp_path, text)
    found = [(o.kind, o.variables, o.where, o.frequency) for o in model.steps[0].outputs]
    assert found == [
        ("node print", ("RF",), "nall", 5),
        ("el print", ("S", "E"), "eall", 1),
        ("node file", ("U", "RF", "NT"), "", 1),
        ("el file", ("S",), "", 3),
        ("node file", ("U",), "", 3),
        ("node file", ("U", "RF"), "", 1),
        ("el file", ("S", "E"), "", 1),
    ]
    assert model.steps[0].outputs[0].totals == "only"
    assert model.time_points["TP"].tolist() == [0.25, 0.5, 1.0]
    assert model.steps[0].outputs[1].time_points == "TP"
    assert not any("NT is not written" in note for note in model.notes)
    assert any("SDV is not written" in note for note in model.notes)


def test_time_points_may_be_generated(tmp_path: Path) -> None:
    text = DECK.replace("*STEP", "*TIME POINTS, NAME=t, GENERATE\n0., 1., .25\n*STEP", 1)
    assert read(tmp_path, text).time_points["T"].tolist() == [0, 0.25, 0.5, 0.75, 1.0]


def test_heading_and_notes(tmp_path: Path) -> None:
    text = "*HEADING\nA cantilever\nof steel\n*PREPRINT, ECHO=NO\n" + DECK.replace(
        "MATERIAL=steel\n2.", "MATERIAL=steel"
    )
    model = read(tmp_path, text)
    assert model.title == "A cantilever of steel"
    assert model.sections[0].thickness == 1.0
    assert any("*PREPRINT is ignored" in note for note in model.notes)
    assert any("no thickness is given for eall; 1 is taken" in note for note in model.notes)
