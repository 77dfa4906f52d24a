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
