"""Outlines meshed by Gmsh: areas, lengths, sets, loops; `make test-mesh` installs what it needs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from benchmarks.corpora.outline_drawings import DIALECTS, SHAPES
from corota.cli import main
from corota.errors import FileError, InputError
from corota.outline import circle, outline, polyline

pytest.importorskip("gmsh", reason="the extra mesh: make test-mesh", exc_type=ImportError)
ezdxf = pytest.importorskip("ezdxf", reason="the extra mesh: make test-mesh")


def covered(mesh):
    """Area of the cells of a mesh."""
    total = 0.0
    for block in mesh.cells:
        corners = mesh.points[block.nodes[:, : 3 if block.kind.startswith("tri") else 4]]
        x, y = corners[..., 0], corners[..., 1]
        total += 0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum()
    return total


def length(mesh, name):
    ends = np.array([nodes[:2] for nodes in mesh.edge_nodes(mesh.edge_sets[name])])
    return np.hypot(*(mesh.points[ends[:, 1]] - mesh.points[ends[:, 0]]).T).sum()


def lever(path, *, gap=0.0, color=1, block=False):
    """A lever of 35 x 15 with a rounded corner, a hole of radius 3 and a slot."""
    drawing = ezdxf.new()
    drawing.header["$INSUNITS"] = 4
    space = drawing.modelspace()
    body = drawing.blocks.new("BODY") if block else space
    corner = math.tan(math.pi / 8.0)
    points = [(0, 0, 0), (30, 0, corner), (35, 5, 0), (35, 15, 0), (gap, 15, 0)]
    body.add_lwpolyline(points, format="xyb", dxfattribs={"layer": "body"})
    body.add_line((0.0, 15.0), (0.0, 0.0), dxfattribs={"layer": "clamp"})
    if block:
        space.add_blockref("BODY", (0.0, 0.0))
    space.add_circle((10.0, 7.0), 3.0, dxfattribs={"color": color})
    space.add_ellipse((24.0, 9.0), major_axis=(4.0, 0.0), ratio=0.5, dxfattribs={"layer": "slot"})
    space.add_text("lever", dxfattribs={"insert": (16.0, 2.0)})
    space.add_line((-5.0, -5.0), (50.0, 20.0), dxfattribs={"layer": "Defpoints"})
    space.add_point((1.0, 1.0))
    drawing.saveas(path)
    return path


@pytest.mark.parametrize("block", [False, True])
@pytest.mark.parametrize("gap", [0.0, 1e-4])
def test_a_drawing(tmp_path, block, gap):
    mesh = ct.mesh.outline(lever(tmp_path / "lever.dxf", gap=gap, block=block))
    area = 35.0 * 15.0 - 25.0 * (1.0 - math.pi / 4.0) - math.pi * 9.0 - math.pi * 8.0
    assert covered(mesh) == pytest.approx(area, rel=5e-3)
    assert set(mesh.edge_sets) == {"body", "clamp", "color_1", "slot"}
    assert list(mesh.cell_sets) == ["lever"]
    assert length(mesh, "clamp") == pytest.approx(15.0, rel=1e-4)
    assert length(mesh, "color_1") == pytest.approx(6.0 * math.pi, rel=1e-2)
    assert any("unit of the drawing: mm" in note for note in mesh.notes)
    assert any("POINT" in note for note in mesh.notes)
    assert any("gaps" in note for note in mesh.notes) == bool(gap)


def test_layers_are_chosen(tmp_path):
    mesh = ct.mesh.outline(lever(tmp_path / "a.dxf"), layers=["body", "clamp"])
    assert covered(mesh) == pytest.approx(525.0 - 25.0 * (1.0 - math.pi / 4.0), rel=1e-3)


def test_a_leaf_has_cells_through_its_thickness():
    leaf = [(0, 0), (30, 0), (30, 0.5), (15, 0.5), (15, 8), (0, 8)]
    mesh = outline(polyline(leaf, closed=True), through=4)
    across = mesh.nodes_of(ct.on_line((30.0, 0.0), (30.0, 0.5)))
    assert len(across) == 5
    assert mesh.n_cells < 1500


def test_a_strip_has_rows_of_cells():
    """Four sides, slender: 4 x 60 quadrilaterals, no longer than five times their height."""
    strip = outline(polyline([(0, 0), (60, 0), (60, 0.8), (0, 0.8)], closed=True))
    assert [(c.kind, len(c)) for c in strip.cells] == [("quad4", 4 * 60)]
    assert covered(strip) == pytest.approx(48.0, rel=1e-12)


@pytest.mark.parametrize(
    ("options", "kinds"),
    [({}, {"quad4"}), ({"triangles": True}, {"tri3"}), ({"quadratic": True}, {"quad8"})],
)
def test_kinds_of_cells(options, kinds):
    mesh = outline([*polyline([(0, 0), (4, 0), (4, 2), (0, 2)], closed=True)], **options)
    assert {c.kind for c in mesh.cells} <= kinds | {"tri3", "tri6"}
    assert covered(mesh) == pytest.approx(8.0, rel=1e-9)


def test_two_parts_and_a_hole():
    squares = [
        polyline(np.array([(0, 0), (4, 0), (4, 4), (0, 4)]) + s, "side", True) for s in (0, 9)
    ]
    mesh = outline([*squares, *circle((2.0, 2.0), 1.0, "hole")])
    assert set(mesh.cell_sets) == {"part_1", "part_2"}
    assert covered(mesh) == pytest.approx(32.0 - math.pi, rel=5e-3)


def test_a_meshed_drawing_is_solved(tmp_path):
    model = ct.Model(ct.mesh.outline(lever(tmp_path / "lever.dxf")))
    for block, element in (("quad4", "Q4I"), ("tri3", "T3")):
        cells = np.flatnonzero(np.repeat([c.kind == block for c in model.mesh.cells],
                                         [len(c) for c in model.mesh.cells]))  # fmt: skip
        if len(cells):
            model.section(cells, element=element, material=ct.Elastic(E=2e3, nu=0.35))
    model.fix("clamp")
    model.force(ct.on_line((35.0, 5.0), (35.0, 15.0)), y=-1.0)
    results = ct.solve(model)
    assert results.history("RF2", at="clamp")[-1] == pytest.approx(1.0, rel=1e-8)


@pytest.mark.parametrize("ending", ["inp", "msh"])
def test_the_command(tmp_path, ending):
    lever(tmp_path / "lever.dxf")
    done = subprocess.run(
        [sys.executable, "-m", "corota", "mesh", "lever.dxf", "-o", f"lever.{ending}"],
        cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "sets of edges: " in done.stdout
    again = ct.mesh.read(tmp_path / f"lever.{ending}")
    assert {"body", "clamp", "slot"} <= {name.lower() for name in again.edge_sets}


def test_a_refused_drawing_gets_a_picture(tmp_path):
    pytest.importorskip("matplotlib")
    drawing = ezdxf.new()
    corners = [(0, 0), (4, 3), (4, 0), (0, 3)]
    drawing.modelspace().add_lwpolyline(corners, close=True)
    drawing.saveas(tmp_path / "a.dxf")
    done = subprocess.run(
        [sys.executable, "-m", "corota", "mesh", "a.dxf"],
        cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert "a.refused.png shows where" in done.stderr
    assert (tmp_path / "a.refused.png").exists()


def test_nodes_lie_on_ellipses_and_on_arcs_of_rational_splines(tmp_path):
    """Cubic curves in place of them were off by 2.7e-4 of an ellipse, and by 3.7e-4 of an arc."""
    drawing = ezdxf.new()
    space = drawing.modelspace()
    space.add_ellipse((0.0, 0.0), major_axis=(20.0, 0.0), ratio=0.5, dxfattribs={"layer": "rim"})
    block = drawing.blocks.new("BORE")
    block.add_circle((0.0, 0.0), 1.0, dxfattribs={"layer": "bore"})
    scale = {"xscale": 3.0, "yscale": 2.0}
    space.add_blockref("BORE", (-8.0, 0.0), dxfattribs=scale)
    arc = space.add_spline(degree=2, dxfattribs={"layer": "eye"})
    # A semicircle of radius 4 of two quarters, each with the weight cos 45 in its corner.
    corners = [(12, 0), (12, 4), (8, 4), (4, 4), (4, 0)]
    arc.control_points = [(*at, 0.0) for at in corners]
    arc.knots = [0, 0, 0, 1, 1, 2, 2, 2]
    arc.weights = [1.0, 0.5**0.5, 1.0, 0.5**0.5, 1.0]
    space.add_line((4.0, 0.0), (12.0, 0.0), dxfattribs={"layer": "flat"})
    drawing.saveas(tmp_path / "a.dxf")
    mesh = ct.mesh.outline(tmp_path / "a.dxf", size=1.0, triangles=True, quadratic=True)
    for name, center, axes in (
        ("rim", (0.0, 0.0), (20.0, 10.0)),
        ("bore", (-8.0, 0.0), (3.0, 2.0)),
        ("eye", (8.0, 0.0), (4.0, 4.0)),
    ):
        at = mesh.points[mesh.nodes_of(name)]
        np.testing.assert_allclose(np.hypot(*((at - center) / axes).T), 1.0, rtol=0.0, atol=1e-6)


def test_a_hatch_names_its_part_and_a_text_comes_first(tmp_path):
    drawing = ezdxf.new()
    space = drawing.modelspace()
    for x in (0.0, 9.0):
        space.add_lwpolyline([(x, 0), (x + 4, 0), (x + 4, 4), (x, 4)], close=True)
    for x, layer in ((0.0, "steel"), (9.0, "rubber")):
        hatch = space.add_hatch(dxfattribs={"layer": layer})
        hatch.paths.add_polyline_path([(x, 0), (x + 4, 0), (x + 4, 4), (x, 4)], is_closed=True)
    space.add_text("pad", dxfattribs={"insert": (10.0, 1.0)})
    drawing.saveas(tmp_path / "a.dxf")
    assert set(ct.mesh.outline(tmp_path / "a.dxf").cell_sets) == {"steel", "pad"}


def test_layers_of_blocks_and_hidden_layers(tmp_path):
    """A binary drawing: what is on layer 0 of a block takes its layer; frozen layers are left."""
    drawing = ezdxf.new("R2018")
    drawing.layers.add("part")
    drawing.layers.add("old").freeze()
    block, space = drawing.blocks.new("INNER"), drawing.modelspace()
    block.add_lwpolyline([(0, 0), (8, 0), (8, 4), (0, 4)], close=True)
    block.add_circle((4, 2), 1.0, dxfattribs={"layer": "bore"})
    drawing.blocks.new("OUTER").add_blockref("INNER", (0.0, 0.0))
    space.add_blockref("OUTER", (1.0, 1.0), dxfattribs={"layer": "part"})
    space.add_line((-5.0, 2.0), (20.0, 3.0), dxfattribs={"layer": "old"})
    drawing.saveas(tmp_path / "a.dxf", fmt="bin")
    mesh = ct.mesh.outline(tmp_path / "a.dxf")
    assert set(mesh.edge_sets) == {"part", "bore"}
    assert "1 entities on the hidden layer 'old'" in mesh.notes
    space.add_line((-5.0, 2.0), (20.0, 3.0), dxfattribs={"layer": "center"})
    drawing.saveas(tmp_path / "a.dxf")
    with pytest.raises(InputError, match="on layer center"):
        ct.mesh.outline(tmp_path / "a.dxf")
    assert ct.mesh.outline(tmp_path / "a.dxf", layers=["part", "bore"]).n_nodes == mesh.n_nodes


def test_an_svg_drawing(tmp_path):
    """Rounded rectangle, turned ellipse, circle; layers, colors, texts, a unit, y up."""
    (tmp_path / "a.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="80mm" viewBox="0 0 40 20" '
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape">'
        '<g inkscape:label="rim" transform="translate(1 1)">'
        '<rect x="0" y="0" width="30" height="12" rx="2"/></g>'
        '<ellipse cx="0" cy="0" rx="4" ry="2" transform="translate(8 7) rotate(30)" '
        'style="stroke:#ff0000"/>'
        '<circle cx="22" cy="7" r="3" id="bore" stroke="black"/>'
        '<path d="M 27 4 c 1 0 2 1 2 2 q 0 1 -1 1 z" stroke="blue"/>'
        '<path d="M 0 0 L 9 9" style="display:none"/><text x="14" y="4">lever</text></svg>'
    )
    mesh = ct.mesh.outline(tmp_path / "a.svg")
    assert set(mesh.edge_sets) == {"rim", "color_ff0000", "color_blue"}
    assert list(mesh.cell_sets) == ["lever"]
    assert "unit of the drawing: mm" in mesh.notes
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    assert (*low, *high) == pytest.approx((2.0, -26.0, 62.0, -2.0))
    assert length(mesh, "rim") == pytest.approx(2 * (2 * 26 + 2 * 8 + 4 * math.pi), rel=3e-3)
    blob = 0.5 * 2 * 2 * 1.2
    area = 4 * (30 * 12 - (4 - math.pi) * 4 - math.pi * 8 - math.pi * 9)
    assert covered(mesh) == pytest.approx(area, abs=4 * blob * 2)
    holes = mesh.points[mesh.nodes_of("color_ff0000")] - (16.0, -14.0)
    c, s = math.cos(math.radians(-30.0)), math.sin(math.radians(-30.0))
    x, y = (holes @ np.array([[c, -s], [s, c]])).T
    assert (x / 8.0) ** 2 + (y / 4.0) ** 2 == pytest.approx(np.ones(len(x)), abs=1e-4)
    (tmp_path / "b.svg").write_text("<svg><path d='M 0 0 X'/></svg>")
    with pytest.raises((FileError, InputError)):
        ct.mesh.outline(tmp_path / "b.svg")
    (tmp_path / "c.svg").write_text("<svg")
    with pytest.raises(FileError, match="not a readable SVG"):
        ct.mesh.outline(tmp_path / "c.svg")


def test_a_step_face_has_rows_in_its_leaves(tmp_path):
    DIALECTS["solid"](SHAPES["stage"], tmp_path / "a.step", None)
    mesh = ct.mesh.outline(tmp_path / "a.step", through=3)
    leaf = ct.on_line((0.0, 23.0), (1.0, 23.0))
    left = mesh.points[(mesh.points[:, 0] < 1.5) & (abs(mesh.points[:, 1] - 23.0) < 3.0)]
    assert len(np.unique(left[:, 0].round(9))) == 4, leaf
    assert len(mesh.edge_sets) == 12


def test_the_gripper_of_the_page(tmp_path, monkeypatch, capsys):
    """docs/howto/flexure.md: from a drawing to travel, margin and report, beside a guided beam."""
    page = Path(__file__).parents[2] / "docs" / "howto" / "flexure.md"
    section = page.read_text(encoding="utf-8").split("## A gripper from its drawing")[1]
    program = section.split("```\n")[1]
    monkeypatch.chdir(tmp_path)
    exec(compile(program, "page", "exec"), {})
    printed = dict(row.rsplit(" ", 1) for row in capsys.readouterr().out.strip().splitlines())
    values = {name: float(value) for name, value in printed.items()}
    bending = 70e3 * 6.0 * 0.6**3 / 12.0
    low, high = (
        2 * 12 * bending / (long**3 - rigid**3) for long, rigid in ((42, 30), (41.2, 30.8))
    )
    assert low < values["stiffness"] < high
    for name in ("travel", "safety factor", "stiffness"):
        assert f"{values[name]:.2f}" in section or f"{values[name]:.3f}" in section, name
    assert (tmp_path / "gripper.html").exists()

    # The same as a deck: the pressure turns with the edge by 2e-4.
    drawing = str(ct.examples.path("four_bar.dxf"))
    (tmp_path / "job.inp").write_text(section.split("```\n")[3])
    assert main(["mesh", drawing, "-o", "four_bar.inp"]) == 0
    assert main(["run", "job.inp", "--element", "CPS4=Q4I", "-o", "out"]) == 0
    with open("out/job.csv", newline="") as file:
        last = list(csv.DictReader(file))[-1]
    assert float(last["JAW: travel"]) == pytest.approx(values["travel"], rel=1e-3)


def test_what_is_no_drawing_is_refused(tmp_path):
    (tmp_path / "a.dxf").write_text("no drawing")
    with pytest.raises(FileError, match="not a readable DXF drawing"):
        outline(tmp_path / "a.dxf")
    (tmp_path / "a.pdf").write_text("")
    with pytest.raises(InputError, match="outlines are read from"):
        outline(tmp_path / "a.pdf")
    with pytest.raises(InputError, match="size must be"):
        outline([], size=-1.0)
