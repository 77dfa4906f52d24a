"""``*SECTION PRINT``: force and moment on a surface, in equilibrium with loads and reactions."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli import main

DECK = """*NODE, NSET=NALL
1, 0., 0.
9, 40., 0.
37, 0., 5.
45, 40., 5.
*NGEN, NSET=NALL
1, 9
37, 45
*NGEN, NSET=LEFT
1, 37, 9
*NGEN, NSET=NALL
2, 38, 9
3, 39, 9
4, 40, 9
5, 41, 9
6, 42, 9
7, 43, 9
8, 44, 9
*NGEN, NSET=RIGHT
9, 45, 9
*ELEMENT, TYPE={element}, ELSET=EALL
1, 1, 2, 11, 10
*ELGEN, ELSET=EALL
1, 8, 1, 1, 4, 9, 8
*ELSET, ELSET=ROW, GENERATE
5, 29, 8
*SURFACE, NAME=CUT
ROW, S4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=EALL, MATERIAL=M
2.
*BOUNDARY
LEFT, 1, 2
*STEP{nlgeom}
*STATIC
.5, 1.
*CLOAD
RIGHT, 1, 4.
RIGHT, 2, -.5
*SECTION PRINT, SURFACE=CUT, NAME=SP1
SOF, SOM, SOAREA
*END STEP
"""


def numbers(text: str, title: str) -> list[float]:
    """The row below the last line with a title."""
    rest = text[text.rindex(title) :].splitlines()
    return [float(v) for v in rest[2].split()]


@pytest.mark.parametrize("element", ["CPS4", "CPE4I", "Q4R", "Q4D"])
@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
def test_a_cut_carries_the_loads_behind_it(
    element: str, nlgeom: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Through x = 20: -F, and the moment of F = (20, -2.5) about the cut's center."""
    path = tmp_path / "job.inp"
    path.write_text(DECK.format(element=element, nlgeom=nlgeom))
    monkeypatch.chdir(tmp_path)
    assert main(["run", str(path), "-q"]) == 0
    text = (tmp_path / "job.dat").read_text()
    force = numbers(text, "total surface force")
    assert force[:2] == pytest.approx([-20.0, 2.5], rel=1e-6)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = ct.read(path)
        frame = ct.solve(model, threads=1).frames[-1]
    x = model.mesh.points + (frame.U if nlgeom else 0.0)
    right = model.mesh.nodes_of("RIGHT")
    about_origin = (x[right, 0] * -0.5 - x[right, 1] * 4.0).sum()
    assert force[5] == pytest.approx(-about_origin, rel=1e-6)
    center = numbers(text, "center of gravity and mean normal")
    assert center[3:5] == pytest.approx([-1.0, 0.0], abs=0.2)
    area, tension, shear = numbers(text, "area, normal force")[:3]
    assert area == pytest.approx(10.0, rel=0.02)
    assert tension**2 + shear**2 == pytest.approx(20.0**2 + 2.5**2, rel=1e-6)
    about = numbers(text, "moment about the center of gravity")[2]
    assert about == pytest.approx(
        force[5] - (center[0] * force[1] - center[1] * force[0]), rel=1e-5
    )


def test_requests_are_written_and_checked(tmp_path: Path) -> None:
    path = tmp_path / "job.inp"
    path.write_text(DECK.format(element="CPS4", nlgeom=""))
    again = ct.read(ct.write(ct.read(path), tmp_path / "again.inp"))
    (request,) = again.steps[0].outputs
    assert (request.kind, request.variables) == ("section print", ("SOF", "SOM", "SOAREA"))
    path.write_text(DECK.format(element="CPS4", nlgeom="").replace("SURFACE=CUT,", "SURFACE=C,"))
    with pytest.raises(ct.DeckError, match=re.escape("no surface named 'C'")):
        ct.read(path)


@pytest.mark.parametrize("part", ["whole", "patch"])
@pytest.mark.parametrize("element", ["T3", "T6", "OPT", "Q4", "Q8R", "Q4D"])
def test_elements_that_touch_a_surface_with_a_corner_belong_to_it(
    element: str, part: str, tmp_path: Path
) -> None:
    """A block pressed on its top, or a part of it: at the top, at a cut and at the support."""
    kinds = {"T3": "tri3", "OPT": "tri3", "T6": "tri6", "Q8R": "quad8"}
    mesh = ct.mesh.rectangle(6.0, 3.0, 6, 3, cell=kinds.get(element, "quad4"))
    _, pairs = mesh.cell_edges()
    middle = np.array([mesh.points[n[:2]].mean(axis=0) for n in mesh.edge_nodes(pairs)])
    ends = np.array([mesh.points[n[:2], 1] for n in mesh.edge_nodes(pairs)])
    below = np.array([mesh.points[mesh.cells[0].nodes[cell, :3], 1].mean() for cell in pairs[:, 0]])
    on_top = (ends == 3.0).all(axis=1)
    mesh.edge_sets["patch"] = pairs[on_top & (middle[:, 0] > 2.0) & (middle[:, 0] < 4.0)]
    mesh.edge_sets["whole"] = pairs[on_top]
    mesh.edge_sets["cut"] = pairs[(ends == 1.0).all(axis=1) & (below < 1.0)]
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.3), thickness=2.0)
    model.fix("bottom")
    model.pressure(part, 10.0)
    step = ct.Static(nlgeom=False)
    step.outputs = [
        ct.Output("section print", ("SOF",), where=where) for where in (part, "cut", "bottom")
    ]
    path = tmp_path / "job.dat"
    ct.solve(model, step, threads=1).write(path)
    blocks = path.read_text().split("statistics for surface set")[1:]
    pressed = 10.0 * 2.0 * (6.0 if part == "whole" else 2.0)
    for block, force in zip(blocks, (-pressed, -pressed, pressed), strict=True):
        found = numbers(block, "total surface force")
        assert found[:2] == pytest.approx([0.0, force], abs=1e-4)
        assert found[5] == pytest.approx(3.0 * force, abs=1e-3)


@pytest.mark.parametrize("element", ["T3", "Q4I", "Q8R"])
@pytest.mark.parametrize("nlgeom", [False, True])
def test_area_and_center_of_a_ring_are_those_of_its_circles(
    element: str, nlgeom: bool, tmp_path: Path
) -> None:
    """An annulus 5 to 8, three edges, that swells by .04, in a linear step as undeformed."""
    kinds = {"T3": "tri3", "Q8R": "quad8"}
    mesh = ct.mesh.rectangle(3.0, 1.0, 3, 1, cell=kinds.get(element, "quad4"))
    mesh.points[:, 0] += 5.0
    model = ct.Model(mesh)
    model.section(
        "all",
        element=element,
        material=ct.Elastic(E=1000.0, nu=0.0, expansion=1.0),
        plane="axisymmetric",
        local_strain="linear",
    )
    model.fix("bottom", x=None)
    model.temperature(0.04)
    step = ct.Static(nlgeom=nlgeom)
    step.outputs = [ct.Output("section print", ("SOF",), where="top")]
    path = tmp_path / "job.dat"
    ct.solve(model, step, threads=1).write(path)
    text = path.read_text()
    a, b = (5.2, 8.32) if nlgeom else (5.0, 8.0)
    area = np.pi * (b**2 - a**2)
    center = 2.0 / 3.0 * (b**3 - a**3) / (b**2 - a**2)
    assert numbers(text, "area, normal force")[0] == pytest.approx(area, rel=1e-5)
    assert numbers(text, "center of gravity and mean")[0] == pytest.approx(center, rel=1e-5)
