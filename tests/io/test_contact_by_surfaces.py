"""General contact by pairs of surfaces, contact that steps begin, friction that they change."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct

#: A block of unit width on a table; both of one element, E = 1000, Poisson's ratio 0.
BLOCKS = """*NODE
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
5, 0.5, {foot}
6, 1.5, {foot}
7, 1.5, 2.
8, 0.5, 2.
*ELEMENT, TYPE=CPS4, ELSET=LOW
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPS4, ELSET=HIGH
2, 5, 6, 7, 8
*NSET, NSET=TOP
7, 8
*SURFACE, NAME=TABLE
LOW, S3
*SURFACE, NAME=FOOT
HIGH, S1
*SURFACE, NAME=BODY
HIGH
*MATERIAL, NAME=STEEL
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=LOW, MATERIAL=STEEL
1.
*SOLID SECTION, ELSET=HIGH, MATERIAL=STEEL
1.
*SURFACE INTERACTION, NAME=A
*FRICTION
{first}
*SURFACE INTERACTION, NAME=B
*FRICTION
0.1
"""
STEPS = """*BOUNDARY
1, 1, 2
2, 1, 2
3, 1, 2
4, 1, 2
TOP, 1
*STEP, NLGEOM
*STATIC
{inside}*BOUNDARY
TOP, 2, 2, {down}
*END STEP
*STEP, NLGEOM
*STATIC
0.5, 0.5, 0.5, 0.5
{later}*BOUNDARY
TOP, 1, 1, 0.1
*END STEP
"""
ALL = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n"


def forces(
    path: Path,
    contact: str = "",
    inside: str = "",
    later: str = "",
    first: float = 0.3,
    foot: float = 1.0,
    down: float = -0.01,
    head: str = "",
) -> list[tuple[float, float]]:
    """Push to the right and downwards at the top, at the end of both steps and between."""
    text = head + BLOCKS.format(foot=foot, first=first) + contact
    deck = path / "deck.inp"
    deck.write_text(text + STEPS.format(inside=inside, later=later, down=down))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = ct.read(deck)
        results = ct.solve(model, threads=1)
    top = model.mesh.nodes_of("TOP")
    return [tuple(f.RF[top, :2].sum(axis=0) * [1.0, -1.0]) for f in results.frames if f.increment]


@pytest.mark.parametrize(
    ("assigned", "wanted"),
    [(" , , A\n", 0.3), (" , , A\nFOOT, TABLE, B\n", 0.1), (" , , A\nTABLE, BODY, B\n", 0.1)],
)
def test_the_last_line_that_names_two_surfaces_counts(
    tmp_path: Path, assigned: str, wanted: float
) -> None:
    """A dragged block: T = mu N, whatever the increment."""
    found = forces(tmp_path, ALL + "*CONTACT PROPERTY ASSIGNMENT\n" + assigned)
    across, down = found[-1]
    assert down > 1.0
    assert across / down == pytest.approx(wanted, rel=1e-2)


@pytest.mark.parametrize("row", ["FOOT, TABLE", "TABLE, BODY", "BODY, TABLE"])
def test_excluded_surfaces_pass_through_each_other(tmp_path: Path, row: str) -> None:
    found = forces(tmp_path, ALL + f"*CONTACT EXCLUSIONS\n{row}\n")
    assert np.abs(found).max() < 1e-9


def test_a_surface_that_does_not_touch_itself_still_touches_others(tmp_path: Path) -> None:
    plain = forces(tmp_path, ALL + "*CONTACT PROPERTY ASSIGNMENT\n , , A\n")
    rows = "*CONTACT EXCLUSIONS\nBODY,\nTABLE,\n*CONTACT PROPERTY ASSIGNMENT\n , , A\n"
    assert np.allclose(forces(tmp_path, ALL + rows), plain, rtol=1e-6, atol=1e-9)


def test_named_pairs_take_their_interaction(tmp_path: Path) -> None:
    pairs = "*CONTACT\n*CONTACT INCLUSIONS\nFOOT, TABLE\n*CONTACT PROPERTY ASSIGNMENT\n"
    across, down = forces(tmp_path, pairs + "TABLE, FOOT, B\n")[-1]
    assert across / down == pytest.approx(0.1, rel=1e-2)
    with pytest.raises(ct.DeckError, match="no inclusion of general contact has these two"):
        forces(tmp_path, pairs + "BODY, FOOT, B\n")


def test_an_interference_presses_and_a_clean_start_does_not(tmp_path: Path) -> None:
    """A block between plates, pressed from 1.01 to 1: N = E ln(s) / s with the stretch s."""
    s = 1.0 / 1.01
    for data, wanted in (("", 0.0), (", INTERFERENCE", 1000.0 * math.log(1.0 / s) / s)):
        text = f"*CONTACT INITIALIZATION DATA, NAME=D{data}\n{ALL}"
        text += "*CONTACT INITIALIZATION ASSIGNMENT\n , , D\n"
        found = forces(tmp_path, text, foot=0.99, down=0.0)[0]
        assert found[1] == pytest.approx(wanted, rel=1e-6, abs=1e-9)


def test_contact_of_a_step_acts_from_it_on(tmp_path: Path) -> None:
    before = forces(tmp_path, ALL + "*CONTACT PROPERTY ASSIGNMENT\n , , A\n")
    rows = ALL + "*CONTACT PROPERTY ASSIGNMENT\n , , A\n"
    assert np.allclose(forces(tmp_path, inside=rows), before, rtol=1e-9, atol=1e-9)
    pair = "*CONTACT PAIR, INTERACTION=A, TYPE=SURFACE TO SURFACE, ADJUST=0.\nFOOT, TABLE\n"
    abaqus = "** DIALECT: abaqus\n"
    assert forces(tmp_path, inside=pair, head=abaqus)[-1] == pytest.approx(before[-1], rel=1e-6)
    late = forces(tmp_path, later=pair + "*BOUNDARY\nTOP, 2, 2, -.01\n", down=0.0, head=abaqus)
    assert np.abs(late[0]).max() < 1e-9
    assert late[-1] == pytest.approx(before[-1], rel=1e-6)


@pytest.mark.parametrize("first", [0.0, 0.3])
@pytest.mark.parametrize(("head", "middle"), [("", 0.1), ("*PREPRINT\n", None)])
def test_friction_changes_at_once_or_over_the_step(
    tmp_path: Path, first: float, head: str, middle: float | None
) -> None:
    """CalculiX changes the coefficient at once, Abaqus linearly over the step; T = mu N."""
    pair = "*CONTACT PAIR, INTERACTION=A, TYPE=SURFACE TO SURFACE\nFOOT, TABLE\n"
    change = "*CHANGE FRICTION, INTERACTION=A\n*FRICTION\n.1\n"
    later = change + "*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 1.\n"
    deck = forces(tmp_path, pair, later=later, first=first, head=head)
    across, down = deck[-1]
    assert across / down == pytest.approx(0.1, rel=1e-2)
    text = "*END STEP\n*STEP, NLGEOM\n*STATIC\n0.5, 1., 0.5, 0.5\n" + change
    found = forces(tmp_path, pair, later=text, first=first, head=head)
    across, down = found[-2]
    wanted = middle if middle is not None else 0.5 * (first + 0.1)
    assert across / down == pytest.approx(wanted, rel=1e-2)
    across, down = found[-1]
    assert across / down == pytest.approx(0.1, rel=1e-2)


def test_friction_of_a_step_is_written_and_read(tmp_path: Path) -> None:
    pair = "*CONTACT PAIR, INTERACTION=A, TYPE=SURFACE TO SURFACE\nFOOT, TABLE\n"
    change = "*CHANGE FRICTION, INTERACTION=A\n*FRICTION\n.1\n"
    deck = tmp_path / "deck.inp"
    text = BLOCKS.format(foot=1.0, first=0.3) + pair
    deck.write_text(text + STEPS.format(inside="", later=change, down=-0.01))
    model = ct.read(deck)
    assert model.contacts[0].friction_steps == {2: 0.1}
    ct.write(model, tmp_path / "again.inp")
    again = ct.read(tmp_path / "again.inp")
    assert again.contacts[0].friction_steps == {2: 0.1}
    assert not again.contacts[0].friction_ramps
    with pytest.raises(ct.DeckError, match="inside a step"):
        forces(tmp_path, pair, later="*FRICTION\n.1\n")
