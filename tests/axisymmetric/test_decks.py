"""Decks of CAX elements: read, written and read again, and beside CalculiX 2.20."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from benchmarks.corpora.axisymmetric_decks import ANSWERS, generate
from benchmarks.corpora.structure_decks import by_corota, difference
from corota.io.deck.write.model import write_deck
from tests.support.calculix import needs_ccx, run_ccx

STORED = json.loads(ANSWERS.read_text(encoding="utf-8"))
#: A few of them; ``python -m benchmarks axisymmetric_decks --stored`` compares with all.
SOME = list(STORED)[:12]

RING = """*NODE
1, 10., 0.
2, 11., 0.
3, 11., 1.
4, 10., 1.
*ELEMENT, TYPE={type}, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*DENSITY
1.
*SOLID SECTION, ELSET=E, MATERIAL=M
*BOUNDARY
1, 2
2, 2
*STEP
*STATIC
{load}
*END STEP
"""


def read(tmp_path: Path, text: str) -> ct.Model:
    path = tmp_path / "ring.inp"
    path.write_text(text)
    return ct.read(path)


@pytest.mark.parametrize("number", SOME)
def test_a_deck_agrees_with_calculix(number: str) -> None:
    deck = generate(int(number))
    assert difference(by_corota(deck), STORED[number]) <= deck.tolerance


def test_a_written_deck_gives_the_same_model(tmp_path: Path) -> None:
    load = "*DLOAD\nE, CENTRIF, 2., 0., 0., 0., 0., 1., 0."
    model = read(tmp_path, RING.format(type="CAX4I", load=load))
    assert model.sections[0].plane == "axisymmetric"
    write_deck(model, tmp_path / "again.inp")
    again = ct.read(tmp_path / "again.inp")
    assert again.sections[0].plane == "axisymmetric"
    one, two = (ct.solve(m, threads=1).frames[-1].U for m in (model, again))
    assert (one == two).all()


def test_a_thickness_has_no_effect_and_says_so(tmp_path: Path) -> None:
    text = RING.format(type="CAX4", load="*CLOAD\n3, 2, 1.")
    model = read(tmp_path, text.replace("MATERIAL=M\n*B", "MATERIAL=M\n2.\n*B"))
    assert model.sections[0].thickness == 1.0
    assert any("no effect" in note for note in model.notes)


@pytest.mark.parametrize(
    ("load", "words"),
    [
        ("*DLOAD\nE, CENTRIF, 2., 0., 0., 0., 0., 0., 1.", "0, 1, 0"),
        ("*DLOAD\nE, GRAV, 2., 1., 0., 0.", "along the axis"),
    ],
)
def test_loads_that_vary_around_the_axis_are_refused(tmp_path: Path, load: str, words: str) -> None:
    with pytest.raises(ct.CorotaError, match=words):
        ct.solve(read(tmp_path, RING.format(type="CAX4", load=load)), threads=1)


@pytest.mark.parametrize("type_", ["SAX1", "MAX1", "CGAX4", "CAX4T", "CAXA4"])
def test_other_elements_of_revolution_are_refused_with_the_reason(
    tmp_path: Path, type_: str
) -> None:
    with pytest.raises(ct.CorotaError, match="not part of this version"):
        read(tmp_path, RING.format(type=type_, load="*CLOAD\n3, 2, 1."))


def triangles(load: str) -> tuple[str, ct.Mesh]:
    """A deck of CAX3, 4 x 3 cells of two, with a load."""
    mesh = ct.mesh.rectangle(10.0, 8.0, 4, 3, "tri3")
    mesh.points[:, 0] += 5.0
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{i}, {x:.12g}, {y:.12g}, 0." for i, (x, y) in enumerate(mesh.points.tolist(), 1)]
    lines += ["*ELEMENT, TYPE=CAX3, ELSET=EALL"]
    nodes = (mesh.cells[0].nodes + 1).tolist()
    lines += [", ".join(map(str, [label, *row])) for label, row in enumerate(nodes, 1)]
    lines += ["*NSET, NSET=LOWER", *(f"{n + 1}," for n in mesh.nodes_of("bottom"))]
    lines += ["*SURFACE, NAME=ROOF"]
    lines += [f"{cell + 1}, S{side + 1}" for cell, side in mesh.edge_pairs("top").tolist()]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "210000., .3", "*DENSITY", "7.8e-9"]
    lines += ["*SOLID SECTION, ELSET=EALL, MATERIAL=M", "*BOUNDARY", "LOWER, 2, 2"]
    lines += ["*STEP", "*STATIC", load, "*NODE PRINT, NSET=NALL", "U", "*END STEP"]
    return "\n".join(lines) + "\n", mesh


def at_centroids(kind: str, mesh: ct.Mesh) -> np.ndarray:
    """Nodal forces of a load whose circumference is that of the middle of its edge or triangle."""
    force = np.zeros((mesh.n_nodes, 2))
    x = mesh.points
    if kind == "roof":
        for ends in mesh.edge_nodes(mesh.edge_pairs("top")):
            area = 2.0 * np.pi * x[ends, 0].mean() * np.ptp(x[ends, 0])
            force[ends, 1] -= 50.0 * area / len(ends)
        return force
    for nodes in mesh.cells[0].nodes:
        (ax, ay), (bx, by) = x[nodes[1:]] - x[nodes[0]]
        radius = x[nodes, 0].mean()
        mass = 7.8e-9 * 2.0 * np.pi * radius * 0.5 * abs(ax * by - ay * bx)
        if kind == "weight":
            force[nodes, 1] -= 1e8 * mass / 3.0
        else:
            force[nodes, 0] += 1e7 * radius * mass / 3.0
    return force


@needs_ccx
@pytest.mark.parametrize(
    ("kind", "load", "least"),
    [
        ("roof", "*DSLOAD\nROOF, P, 50.", 0.03),
        ("weight", "*DLOAD\nEALL, GRAV, 1e8, 0., -1., 0.", 0.01),
        ("spin", "*DLOAD\nEALL, CENTRIF, 1e7, 0., 0., 0., 0., 1., 0.", 0.008),
    ],
)
def test_calculix_takes_loads_of_cax3_at_centroids(
    tmp_path: Path, kind: str, load: str, least: float
) -> None:
    """Its wedge has one point: nodes share a load alike, though the outer ones have more of it.

    With these forces both agree as they do for other elements, with the load they differ.
    """
    text, mesh = triangles(load)
    (tmp_path / "ccx.inp").write_text(text)
    run_ccx(tmp_path, "ccx")
    rows = [line.split() for line in (tmp_path / "ccx.dat").read_text().splitlines()]
    known = np.array([row[1:3] for row in rows if len(row) == 4 and row[0].isdigit()], float)
    force = at_centroids(kind, mesh)
    cards = [f"{n + 1}, {d + 1}, {force[n, d]:.12g}" for n, d in np.argwhere(force).tolist()]
    forces = "\n".join(["*CLOAD", *cards])
    apart = []
    for given in (load, forces):
        moved = ct.solve(read(tmp_path, triangles(given)[0]), threads=1).frames[-1].U
        apart.append(np.abs(moved - known).max() / np.abs(known).max())
    assert apart[0] > least
    assert apart[1] < 5e-4


HOT = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
210000., .3
*EXPANSION
1.2e-5
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*INITIAL CONDITIONS, TYPE=TEMPERATURE
NALL, 20.
*BOUNDARY
1, 1, 2
4, 1
2, 2
*STEP, NLGEOM
*STATIC
1., 1.
*CLOAD
2, 1, {force}
3, 1, {force}
*TEMPERATURE
NALL, {heat}
*NODE PRINT, NSET=NALL
U
*END STEP
"""


@needs_ccx
def test_a_heated_body_is_strained_from_its_hot_shape_in_calculix(tmp_path: Path) -> None:
    """Heated by 1000: its compliance is 1 / (1 + e) of the cold one, here 1 / (1 + e)^2.

    The reason for deck 34, a heated ring that spins: e = 1.2e-3 on half of the displacement.
    """
    found = []
    for force, heat in (("105.", "20."), ("0.", "1020."), ("105.", "1020.")):
        text = HOT.format(force=force, heat=heat)
        (tmp_path / "ccx.inp").write_text(text)
        run_ccx(tmp_path, "ccx")
        rows = [line.split() for line in (tmp_path / "ccx.dat").read_text().splitlines()]
        theirs = next(float(row[1]) for row in rows if len(row) == 4 and row[0] == "2")
        ours = float(ct.solve(read(tmp_path, text), threads=1).frames[-1].U[1, 0])
        found.append((theirs, ours))
    cold, hot, pulled = np.array(found)
    np.testing.assert_allclose((pulled - hot) / cold, [1.0 / 1.012, 1.0 / 1.012**2], rtol=1e-4)
