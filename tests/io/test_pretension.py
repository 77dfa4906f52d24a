"""Pre-tension sections: tension by a force, lock, and the cut itself."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import corota as ct

E, NU, FORCE = 1000.0, 0.3, 10.0


def bolt(kind: str, angle: float, normal: str, faces: str) -> str:
    """A bar of four by two elements, of length 4 and width 1, held at both ends along its axis."""
    mesh = ct.mesh.move(ct.mesh.rectangle(4.0, 1.0, 4, 2, kind), angle=angle)
    name = {"quad4": "CPS4", "quad8": "CPS8", "tri3": "CPS3"}[kind]
    text = "*NODE\n" + "".join(
        f"{n}, {p[0]!r}, {p[1]!r}\n"
        for n, p in zip(mesh.node_labels.tolist(), mesh.points.tolist(), strict=True)
    )
    text += f"900, 9., 9.\n*ELEMENT, TYPE={name}, ELSET=EALL\n"
    for label, row in zip(mesh.cells[0].labels.tolist(), mesh.cells[0].nodes, strict=True):
        text += f"{label}, " + ", ".join(map(str, mesh.node_labels[row].tolist())) + "\n"
    for side in ("left", "right"):
        labels = mesh.node_labels[mesh.nodes_of(side)].tolist()
        text += f"*NSET, NSET={side}\n" + "".join(f"{n}\n" for n in labels)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    axes = f"{c}, {s}, 0., {-s}, {c}, 0."
    return text + (
        f"*SURFACE, NAME=CUT\n{faces}\n*PRE-TENSION SECTION, SURFACE=CUT, NODE=900\n{normal}\n"
        f"*MATERIAL, NAME=M\n*ELASTIC\n{E}, {NU}\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1.\n"
        f"*TRANSFORM, NSET=left\n{axes}\n*TRANSFORM, NSET=right\n{axes}\n"
        "*BOUNDARY\nleft, 1\nright, 1\n1, 2\n"
        f"*STEP\n*STATIC\n*CLOAD\n900, 1, {FORCE}\n*END STEP\n"
        "*STEP\n*STATIC\n*BOUNDARY, FIXED\n900, 1\n*BOUNDARY\nright, 1, 1, 0.02\n*END STEP\n"
    )


def read(tmp_path: Path, text: str) -> ct.Model:
    path = tmp_path / "bolt.inp"
    path.write_text(text, encoding="utf-8")
    return ct.read(path)


@pytest.mark.parametrize("kind", ["quad4", "quad8"])
@pytest.mark.parametrize("angle", [0.0, 30.0])
def test_force_then_lock(tmp_path: Path, kind: str, angle: float) -> None:
    """A uniform state: stress = force / area; the length that is missing is F L / EA.

    CalculiX finds the same (4e-2 at the node for the straight bar).
    """
    model = read(tmp_path, bolt(kind, angle, "", "2, S2\n6, S2"))
    node = int(np.flatnonzero(model.mesh.node_labels == 900)[0])
    results = ct.solve(model, threads=1)
    first, last = results.frames[-2:]
    assert first.U[node, 0] == pytest.approx(FORCE * 4.0 / E, rel=1e-10)
    assert last.U[node, 0] == pytest.approx(FORCE * 4.0 / E, rel=1e-10)
    # Locked, the bar takes 0.02 as one of length 4.
    for frame, stress in ((first, FORCE), (last, FORCE + E * 0.02 / 4.0)):
        for block in frame.fields:
            s = block.values["S"].reshape(-1, 4)
            assert s[:, 0] + s[:, 1] == pytest.approx(stress, rel=1e-9)


def test_the_normal_gives_the_sign(tmp_path: Path) -> None:
    model = read(tmp_path, bolt("quad4", 0.0, "-1., 0., 0.", "2, S2\n6, S2"))
    frame = ct.solve(model, threads=1).frames[1]
    assert frame.fields[0].values["S"][..., 0] == pytest.approx(-FORCE, rel=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("SURFACE=CUT, NODE", "SURFACE=CUTS, NODE", "no surface named 'CUTS'"),
        ("2, S2\n6, S2", "2, S2", "does not cut the body in two"),
        ("2, S2\n6, S2", "4, S2\n8, S2", "does not cut the body in two"),
        ("SURFACE=CUT, NODE", "ELEMENT=2, NODE", "a beam or truss"),
        ("NODE=900", "NODE=901", "node 901 is not defined"),
        ("NODE=900\n\n", "NODE=900\n0., 0., 1.\n", "must lie in the plane"),
    ],
)
def test_faults_of_sections(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = bolt("quad4", 0.0, "", "2, S2\n6, S2")
    assert old in text
    with pytest.raises(ct.DeckError) as caught:
        read(tmp_path, text.replace(old, new))
    assert said in str(caught.value)


def heated(angle: float, cut: bool) -> str:
    """The bar with temperature and thickness by a set of all nodes, its cut locked or absent."""
    text = bolt("quad4", angle, "", "2, S2\n6, S2")
    head = text.split("*STEP", 1)[0]
    if not cut:
        lines = head.splitlines()
        at = next(k for k, line in enumerate(lines) if line.startswith("*PRE-TENSION"))
        head = "\n".join(lines[:at] + lines[at + 2 :]) + "\n"
        head = head.replace("900, 9., 9.\n", "")
    every = ", ".join(str(n) for n in range(1, 16))
    head = head.replace("*MATERIAL", f"*NSET, NSET=ALL\n{every}\n*MATERIAL", 1)
    head = head.replace("MATERIAL=M\n1.\n", "MATERIAL=M, NODAL THICKNESS\n1.\n")
    head = head.replace("*ELASTIC", "*EXPANSION\n1e-3\n*ELASTIC", 1)
    head += "*NODAL THICKNESS\nALL, 2.\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 5.\n"
    hold = "*BOUNDARY\n900, 1\n" if cut else ""
    return head + f"{hold}*STEP\n*STATIC\n*TEMPERATURE\nALL, -15.\n*END STEP\n"


@pytest.mark.parametrize("angle", [0.0, 30.0])
def test_fields_of_nodes_reach_both_faces(tmp_path: Path, angle: float) -> None:
    """A locked cut is no cut: the cooled bar between walls has the stress E alpha 20 everywhere."""
    for cut in (True, False):
        model = read(tmp_path, heated(angle, cut))
        frame = ct.solve(model, threads=1).frames[-1]
        values = frame.fields[0].values
        s = values["S"].reshape(-1, 4)
        assert s[:, 0] + s[:, 1] == pytest.approx(E * 1e-3 * 20.0, rel=1e-9)
        assert frame.fields[0].volume.sum() == pytest.approx(8.0, rel=1e-12)


@pytest.mark.parametrize("turn", [20.0, -75.0])
def test_local_axes_at_the_cut_change_nothing(tmp_path: Path, turn: float) -> None:
    text = bolt("quad4", 30.0, "", "2, S2\n6, S2")
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    turned = text.replace(
        "*BOUNDARY",
        f"*NSET, NSET=C\n3, 8, 13\n*TRANSFORM, NSET=C\n{c}, {s}, 0., {-s}, {c}, 0.\n*BOUNDARY",
        1,
    )
    one, other = (ct.solve(read(tmp_path, t), threads=1).frames[-1] for t in (text, turned))
    assert np.abs(one.U - other.U).max() < 1e-12


def test_an_initial_velocity_moves_both_faces(tmp_path: Path) -> None:
    head = bolt("quad4", 0.0, "", "2, S2\n6, S2").split("*TRANSFORM")[0]
    every = ", ".join(str(n) for n in range(1, 16))
    text = head.replace("*ELASTIC", "*DENSITY\n2.\n*ELASTIC") + (
        f"*NSET, NSET=ALL\n{every}\n*INITIAL CONDITIONS, TYPE=VELOCITY\nALL, 1, 3.\n"
        "*STEP\n*DYNAMIC, DIRECT\n0.1, 0.1\n*BOUNDARY\n900, 1\n*END STEP\n"
    )
    frame = ct.solve(read(tmp_path, text), threads=1).frames[-1]
    assert frame.scalars["momentum x"] == pytest.approx(2.0 * 4.0 * 3.0, rel=1e-9)
    assert frame.scalars["ALLKE"] == pytest.approx(0.5 * 8.0 * 9.0, rel=1e-9)
