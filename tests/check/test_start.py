"""``check`` judges by the start of the run itself: what holds a body there holds it here."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json

import pytest

from corota.cli import main

TWO = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
11, 0., 1.
12, 1., 1.
13, 1., 2.
14, 0., 2.
20, .5, 2.5
*ELEMENT, TYPE=CPS4, ELSET=A
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPS4, ELSET=B
2, 11, 12, 13, 14
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=A, MATERIAL=M
1.
*SOLID SECTION, ELSET=B, MATERIAL=M
1.
*NSET, NSET=TOP
13, 14
*SURFACE, NAME=SLAVE
2, S1
*SURFACE, NAME=MASTER
1, S3
*SURFACE, NAME=LID
2, S3
*SURFACE, NAME=FLANK
2, S2
*BOUNDARY
1, 1, 2
2, 1, 2
"""
STEP = """*STEP
*STATIC
*DSLOAD
LID, P, 1.
FLANK, P, .1
*END STEP
"""
#: What joins or holds the upper block, and whether it is held then.
JOINED = {
    "nothing": ("", False),
    "tie": ("*TIE, NAME=T\nSLAVE, MASTER\n", True),
    "equations": (
        "".join(
            f"*EQUATION\n2\n{a}, {d}, 1., {b}, {d}, -1.\n"
            for a, b in ((11, 4), (12, 3))
            for d in (1, 2)
        ),
        True,
    ),
    "hinge": ("*EQUATION\n2\n11, 1, 1., 4, 1, -1.\n*EQUATION\n2\n11, 2, 1., 4, 2, -1.\n", False),
    "rigid body": ("*RIGID BODY, NSET=TOP, REF NODE=20\n*BOUNDARY\n20, 1, 2\n20, 6\n", True),
    "free rigid body": ("*RIGID BODY, NSET=TOP, REF NODE=20\n*BOUNDARY\n20, 1, 2\n", False),
    "coupling": (
        "*COUPLING, REF NODE=20, SURFACE=LID, CONSTRAINT NAME=C\n*KINEMATIC\n"
        "*BOUNDARY\n20, 1, 2\n20, 6\n",
        True,
    ),
    "contact": (
        "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\n"
        "SLAVE, MASTER\n*BOUNDARY\n11, 1\n14, 1\n",
        True,
    ),
    "contact that slides": (
        "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\n"
        "SLAVE, MASTER\n",
        False,
    ),
}


@pytest.mark.parametrize("joined", sorted(JOINED))
def test_check_and_run_agree_on_what_is_held(joined, tmp_path, capsys):
    card, held = JOINED[joined]
    path = tmp_path / "job.inp"
    path.write_text(TWO + card + STEP)
    checked = main(["check", str(path)])
    assert checked == (0 if held else 3), capsys.readouterr().err
    assert main(["run", str(path), "--output", str(tmp_path), "--quiet"]) == checked


@pytest.mark.parametrize("held", [True, False])
@pytest.mark.parametrize(
    ("kind", "section"),
    [
        ("T2D2", "*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n"),
        ("B21", "*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT\n.1, .1\n0., 0., -1.\n"),
    ],
)
def test_lines_are_checked(kind, section, held, tmp_path, capsys):
    """Decks with trusses and beams ended with an internal error."""
    path = tmp_path / "job.inp"
    support = "1, 1, 2\n2, 2\n" if held else "1, 1, 2\n"
    path.write_text(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n"
        f"*ELEMENT, TYPE={kind}, ELSET=E\n1, 1, 2\n2, 2, 3\n3, 1, 3\n"
        f"*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n{section}"
        f"*BOUNDARY\n{support}*STEP\n*STATIC\n*CLOAD\n3, 1, 1.\n*END STEP\n"
    )
    code = main(["check", str(path)])
    assert code == (0 if held else 3), capsys.readouterr().err
    assert main(["run", str(path), "--output", str(tmp_path), "--quiet"]) == code


def test_a_bare_mesh_is_fine(tmp_path, capsys):
    path = tmp_path / "mesh.inp"
    path.write_text("*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n")
    assert main(["check", str(path)]) == 0
    assert "3 nodes, 1 elements" in capsys.readouterr().out


@pytest.mark.parametrize(("fault", "code"), [("*NONSENSE\n", 2), ("", 3)])
def test_refused_decks_give_json_too(fault, code, tmp_path, capsys):
    path = tmp_path / "job.inp"
    path.write_text(TWO + fault + STEP)
    assert main(["check", "--json", str(path)]) == code
    records = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert any(r.get("severity") == "error" for r in records)
    assert records[-1]["event"] == "check"
    assert records[-1]["errors"] > 0
