"""General contact, sides of rigid bodies that touch, and nodes that are adjusted."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

#: Two blocks, the upper one 0.01 above the lower, and a floor of rigid sides below.
BLOCKS = """*NODE
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
5, 0.5, 1.01
6, 1.5, 1.01
7, 1.5, 2.01
8, 0.5, 2.01
11, -1., 0.
12, 1., 0.
13, 3., 0.
20, 1., -1.
*ELEMENT, TYPE=CPS4, ELSET=LOW
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPS4, ELSET=HIGH
2, 5, 6, 7, 8
*ELEMENT, TYPE=R2D2, ELSET=SIDES
11, 11, 12
12, 12, 13
*RIGID BODY, ELSET=SIDES, REF NODE=20
*NSET, NSET=TOP
7, 8
*NSET, NSET=FOOT
5
*NSET, NSET=FEET
5, 6
*MATERIAL, NAME=STEEL
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=LOW, MATERIAL=STEEL
1.
*SOLID SECTION, ELSET=HIGH, MATERIAL=STEEL
1.
"""
STEP = """*BOUNDARY
20, 1, 6
1, 1
4, 1
5, 1
8, 1
*STEP, NLGEOM
*STATIC
*BOUNDARY
TOP, 2, 2, -0.05
*END STEP
"""
GENERAL = """*SURFACE INTERACTION, NAME=SLIDE
*CONTACT
*CONTACT INCLUSIONS, ALL EXTERIOR
*CONTACT PROPERTY ASSIGNMENT
 ,  , SLIDE
"""
FLOOR = "*SURFACE, NAME=FLOOR\nSIDES, SPOS\n"


def read(tmp_path: Path, text: str) -> ct.Model:
    path = tmp_path / "blocks.inp"
    path.write_text(text, encoding="utf-8")
    return ct.read(path)


def fault(tmp_path: Path, text: str) -> str:
    with pytest.raises(ct.DeckError) as caught:
        read(tmp_path, text)
    return str(caught.value)


def test_all_exterior_is_one_surface_that_touches_itself_and_rigid_sides(tmp_path: Path) -> None:
    model = read(tmp_path, BLOCKS + FLOOR + GENERAL + STEP)
    first, second = model.contacts
    assert first.itself
    assert isinstance(second.master, ct.RigidCurve)
    assert "ALL_EXTERIOR" in model.mesh.edge_sets
    frame = ct.solve(model, threads=1).frames[-1]
    # The top goes down by 0.05, of which 0.01 is the gap: the floor carries the compression.
    push = float(frame.RF[11, 1])
    assert push > 15.0
    assert frame.RF[:, 1].sum() == pytest.approx(0.0, abs=1e-8)
    named = (
        FLOOR + "*SURFACE, NAME=A\nLOW, S3\n*SURFACE, NAME=B\nHIGH, S1\n*SURFACE, NAME=C\nLOW, S1\n"
    )
    pairs = (
        "*SURFACE INTERACTION, NAME=SLIDE\n*CONTACT PAIR, INTERACTION=SLIDE, ADJUST=0., "
        "TYPE=SURFACE TO SURFACE\nB, A\nC, FLOOR\n"
    )
    other = ct.solve(read(tmp_path, BLOCKS + named + pairs + STEP), threads=1).frames[-1]
    assert push == pytest.approx(float(other.RF[11, 1]), rel=0.02)


def test_combined_surfaces_do_not_disturb_general_contact(tmp_path: Path) -> None:
    named = "*SURFACE, NAME=A\nLOW, S3\n*SURFACE, NAME=B\nLOW, S2\n"
    named += "*SURFACE, NAME=C, COMBINE=UNION\nA, B\n"
    model = read(tmp_path, BLOCKS + named + GENERAL + STEP)
    assert len(model.contacts) == 1
    assert len(model.mesh.edge_sets["C"]) == 2


def test_controls_hold_for_general_contact(tmp_path: Path) -> None:
    text = (
        BLOCKS
        + GENERAL
        + STEP.replace("*BOUNDARY\nTOP", "*CONTACT CONTROLS, STABILIZE\n*BOUNDARY\nTOP")
    )
    assert [pair.stabilize for pair in read(tmp_path, text).contacts] == [True]


def test_inclusions_name_pairs(tmp_path: Path) -> None:
    named = "*SURFACE, NAME=A\nLOW, S3\n*SURFACE, NAME=B\nHIGH, S1\n"
    text = BLOCKS + named + "*CONTACT\n*CONTACT INCLUSIONS\nB, A\n" + STEP
    model = read(tmp_path, text)
    assert [(p.slave, p.master) for p in model.contacts] == [("B", "A")]
    assert any("hard, no friction" in note for note in model.notes)
    assert "no *CONTACT INCLUSIONS" in fault(
        tmp_path, text.replace("*CONTACT INCLUSIONS\nB, A\n", "")
    )
    assert "under *CONTACT" in fault(tmp_path, text.replace("*CONTACT\n", ""))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("SPOS", "S1", "need SPOS"),
        ("12, 12, 13", "12, 13, 12", "do not follow each other"),
        ("*RIGID BODY, ELSET=SIDES, REF NODE=20\n", "", "no *RIGID BODY"),
    ],
)
def test_sides_of_rigid_bodies_need_a_direction_a_line_and_a_body(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    pair = "*SURFACE, NAME=C\nLOW, S1\n*SURFACE INTERACTION, NAME=SLIDE\n"
    pair += "*CONTACT PAIR, INTERACTION=SLIDE, TYPE=MORTAR\nC, FLOOR\n"
    text = BLOCKS + FLOOR + pair + STEP
    assert isinstance(read(tmp_path, text).contacts[0].master, ct.RigidCurve)
    assert said in fault(tmp_path, text.replace(old, new))


def test_sides_seen_from_below_are_no_floor(tmp_path: Path) -> None:
    """SNEG turns the line round: its left is below."""
    pair = "*SURFACE, NAME=C\nLOW, S1\n*SURFACE INTERACTION, NAME=SLIDE\n"
    pair += "*CONTACT PAIR, INTERACTION=SLIDE, TYPE=MORTAR\nC, FLOOR\n"
    text = BLOCKS + FLOOR.replace("SPOS", "SNEG") + pair + STEP
    curve = read(tmp_path, text).contacts[0].master
    assert curve.segments[0, :4].tolist() == [3.0, 0.0, 1.0, 0.0]


def test_only_the_nodes_of_a_set_are_adjusted(tmp_path: Path) -> None:
    """Both feet of the upper block, 0.01 above, one of them, or none."""
    named = (
        "*SURFACE, NAME=A\nLOW, S3\n*SURFACE, NAME=B\nHIGH, S1\n*SURFACE INTERACTION, NAME=SLIDE\n"
    )
    pair = "*CONTACT PAIR, INTERACTION=SLIDE, TYPE=NODE TO SURFACE{}\nB, A\n"
    held = STEP.replace("20, 1, 6", "20, 1, 6\n1, 2\n2, 2").replace("-0.05", "-0.02")
    force = []
    for adjust in (", ADJUST=FEET", ", ADJUST=FOOT", ""):
        model = read(tmp_path, BLOCKS + named + pair.format(adjust) + held)
        frame = ct.solve(model, threads=1).frames[-1]
        force.append(float(frame.RF[[0, 1], 1].sum()))
    assert force[0] > 1.2 * force[1] > 1.2 * 1.2 * force[2] > 0.0
    whole = read(tmp_path, BLOCKS + named + pair.format(", ADJUST=0.02") + held)
    assert force[0] == pytest.approx(
        ct.solve(whole, threads=1).frames[-1].RF[:2, 1].sum(), rel=1e-9
    )
    assert np.isfinite(force).all()
    assert "no node set named 'FOOTS'" in fault(
        tmp_path, BLOCKS + named + pair.format(", ADJUST=FOOTS") + held
    )


def test_a_pair_in_a_part_without_instances_is_refused(tmp_path: Path) -> None:
    text = BLOCKS + "*PART, NAME=P\n*SURFACE INTERACTION, NAME=I\n"
    text += "*CONTACT PAIR, INTERACTION=I, TYPE=MORTAR\nA, B\n*END PART\n" + STEP
    assert "no surface named" in fault(tmp_path, text)
