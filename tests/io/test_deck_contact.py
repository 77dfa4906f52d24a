"""Cards of contact: what they put into the model, and what is wrong with them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from decks import MESH, SECTION, STEP, SUPPORT, faults, read

from corota.model.contact import RigidCurve

#: A second body above the first, a node for rigid curves, and their surfaces.
ABOVE = """*NODE
11, 0., 1.
12, 2., 1.
13, 2., 2.
14, 0., 2.
30, 1., 3.
*ELEMENT, TYPE=CPS4, ELSET=eall
3, 11, 12, 13, 14
*SURFACE, NAME=Low
1, S3
2, S3
*SURFACE, NAME=High
3, S1
*SURFACE, NAME=Points, TYPE=NODE
4
5
6
"""
INTERACTION = "*SURFACE INTERACTION, NAME=I\n"
PAIR = "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nLow, High\n"


def deck(lines: str, step: str = STEP) -> str:
    return MESH + ABOVE + SECTION + lines + SUPPORT + step


def test_the_first_surface_is_the_slave(tmp_path: Path) -> None:
    (pair,) = read(tmp_path, deck(INTERACTION + PAIR)).contacts
    assert (pair.slave, pair.master, pair.method) == ("Low", "High", "mortar")
    assert (pair.friction, pair.law, pair.clearance, pair.start) == (0.0, None, None, "keep")


@pytest.mark.parametrize(
    ("name", "method"),
    [
        ("NODE TO SURFACE", "node_to_segment"),
        ("SURFACE TO SURFACE", "mortar"),
        ("MORTAR", "mortar"),
        ("LINMORTAR", "mortar"),
        ("PGLINMORTAR", "mortar"),
    ],
)
def test_types(tmp_path: Path, name: str, method: str) -> None:
    lines = INTERACTION + PAIR.replace("SURFACE TO SURFACE", name)
    assert read(tmp_path, deck(lines)).contacts[0].method == method


def test_node_surfaces_become_the_edges_between_their_nodes(tmp_path: Path) -> None:
    model = read(tmp_path, deck(INTERACTION + PAIR.replace("Low", "Points")))
    np.testing.assert_array_equal(model.contacts[0].slave, model.mesh.edge_sets["Low"])


def test_behavior_and_friction(tmp_path: Path) -> None:
    lines = INTERACTION + (
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0., -.1\n5., 0.\n20., .1\n"
        "*FRICTION\n.3, 1e5\n"
    )
    model = read(tmp_path, deck(lines + PAIR))
    pair = model.contacts[0]
    assert pair.friction == 0.3
    assert pair.law is not None
    assert pair.law.pressure.tolist() == [0.0, 5.0, 20.0]
    assert pair.law.overclosure.tolist() == [-0.1, 0.0, 0.1]
    assert any("stick slope" in note for note in model.notes)


@pytest.mark.parametrize("value", ["1e7", "1e300", "-.1", "nan"])
def test_friction_coefficients_without_sense_are_refused(tmp_path: Path, value: str) -> None:
    assert "friction" in str(faults(tmp_path, deck(f"{INTERACTION}*FRICTION\n{value}\n{PAIR}")))


@pytest.mark.parametrize(
    ("name", "rows", "pressure", "overclosure"),
    [("LINEAR", "1e6, 0.", 1e6, 0.0), ("EXPONENTIAL", ".01, 7.", 7.0, 0.01)],
)
def test_laws_of_two_numbers(
    tmp_path: Path, name: str, rows: str, pressure: float, overclosure: float
) -> None:
    lines = f"{INTERACTION}*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={name}\n{rows}\n{PAIR}"
    law = read(tmp_path, deck(lines)).contacts[0].law
    assert law is not None
    assert (law.kind, law.pressure[0], law.overclosure[0]) == (name.lower(), pressure, overclosure)


def test_ties_and_tied_interactions_are_the_same(tmp_path: Path) -> None:
    tied = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e7\n"
    first = read(tmp_path, deck(INTERACTION + tied + PAIR))
    second = read(tmp_path, deck("*TIE, NAME=T, POSITION TOLERANCE=.2, ADJUST=NO\nLow, High\n"))
    assert not first.contacts
    assert not second.contacts
    (a,), (b,) = first.ties, second.ties
    assert (a.slave, a.master) == (b.slave, b.master) == ("Low", "High")
    assert (b.tolerance, b.name) == (0.2, "T")


def test_the_start_of_a_pair(tmp_path: Path) -> None:
    lines = INTERACTION + PAIR + "*CLEARANCE, SLAVE=low, MASTER=high, VALUE=.125\n"
    assert read(tmp_path, deck(lines)).contacts[0].clearance == 0.125
    adjusted = INTERACTION + PAIR.replace("TYPE", "ADJUST=.01, TYPE")
    pair = read(tmp_path, deck(adjusted)).contacts[0]
    assert (pair.start, pair.adjust) == ("adjust", 0.01)
    step = STEP.replace("*CLOAD", "*CONTACT INTERFERENCE, SHRINK\nLow, High\n*CLOAD")
    assert read(tmp_path, deck(INTERACTION + PAIR, step)).contacts[0].start == "ramp"
    step = STEP.replace("*CLOAD", "*CONTACT CONTROLS, STABILIZE\n*CLOAD")
    assert read(tmp_path, deck(INTERACTION + PAIR, step)).contacts[0].stabilize


def test_a_surface_with_itself(tmp_path: Path) -> None:
    for line in ("Low, Low", "Low", "Low,"):
        pair = read(tmp_path, deck(INTERACTION + PAIR.replace("Low, High", line))).contacts[0]
        assert pair.itself


PROFILE = "*SURFACE, TYPE=SEGMENTS, NAME=Die\nSTART, 3., 4.\nLINE, 2., 4.\nCIRCL, 1., 3., 2., 3.\n"
BODY = "*RIGID BODY, ANALYTICAL SURFACE=Die, REF NODE=30\n"


def test_the_rigid_body_of_a_profile_lies_to_its_right(tmp_path: Path) -> None:
    """Abaqus: the outward normal is the direction of the profile turned counter-clockwise.

    Rigid curves of Python have it there too, so the segments are those of the deck.
    """
    lines = INTERACTION + PROFILE + BODY + PAIR.replace("High", "Die")
    model = read(tmp_path, deck(lines))
    curve = model.contacts[0].master
    assert isinstance(curve, RigidCurve)
    assert curve.reference == np.flatnonzero(model.mesh.node_labels == 30)[0]
    assert curve.name == "Die"
    np.testing.assert_allclose(
        curve.segments,
        [[3.0, 4.0, 2.0, 4.0, 0.0, 0.0, 0.0], [2.0, 4.0, 1.0, 3.0, 2.0, 3.0, 0.5 * np.pi]],
    )


@pytest.mark.parametrize("body", ["", BODY.replace(", REF NODE=30", "")])
def test_a_profile_without_a_reference_node_stays(tmp_path: Path, body: str) -> None:
    """A rigid body without REF NODE was refused, though the page calls it fixed."""
    model = read(tmp_path, deck(INTERACTION + PROFILE + body + PAIR.replace("High", "Die")))
    curve = model.contacts[0].master
    assert isinstance(curve, RigidCurve)
    assert curve.reference is None
    missing = "REF NODE" if body else r"\*RIGID BODY"
    assert any(re.search(f"has no {missing}, so it stays where it is", n) for n in model.notes)


def test_fillets_round_corners(tmp_path: Path) -> None:
    sharp = "*SURFACE, TYPE=SEGMENTS, NAME=Die, FILLET RADIUS=.5\nSTART, 3., 4.\nLINE, 2., 4.\n"
    lines = INTERACTION + sharp + "LINE, 2., 3.\n" + PAIR.replace("High", "Die")
    curve = read(tmp_path, deck(lines)).contacts[0].master
    assert isinstance(curve, RigidCurve)
    assert len(curve.segments) == 3
    assert curve.segments[1, 6] == pytest.approx(0.5 * np.pi)


def test_requests(tmp_path: Path) -> None:
    cards = (
        "*CONTACT PRINT, SLAVE=low, MASTER=high, FREQUENCY=2\nCDIS, CSTR, CF\n"
        "*CONTACT PRINT, TOTALS=ONLY\nCELS\n*CONTACT OUTPUT\nCSTRESS\n"
    )
    step = STEP.replace("*END STEP", cards + "*END STEP")
    outputs = read(tmp_path, deck(INTERACTION + PAIR, step)).steps[0].outputs
    assert [(o.kind, o.variables, o.where, o.frequency) for o in outputs] == [
        ("contact print", ("CDIS", "CSTR", "CF"), "Low-High", 2),
        ("contact print", ("CELS",), "", 1),
        ("contact file", ("CSTR",), "", 1),
    ]


FAULTS = [
    (PAIR, "INTERACTION", "no *SURFACE INTERACTION named 'I'"),
    (INTERACTION + PAIR.replace("Low", "Lov"), "Lov", "no surface named 'Lov'"),
    (INTERACTION + PAIR.replace("SURFACE TO SURFACE", "MASSLESS"), "MASSLESS", "not known"),
    (INTERACTION + PAIR.replace("TYPE", "ADJUST=eall, TYPE"), "eall", "node set"),
    (INTERACTION + PAIR.replace("Low, High", ", High"), ", High", "slave surface is missing"),
    ("*FRICTION\n.3\n", "*FRICTION", "under a *SURFACE INTERACTION"),
    (INTERACTION + "*FRICTION\n-.3\n", "-.3", "must be >= 0"),
    (
        INTERACTION + "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n-5.\n" + PAIR,
        "*SURFACE BEHAVIOR",
        "must be > 0",
    ),
    (
        INTERACTION + "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=CUBIC\n-5.\n" + PAIR,
        "CUBIC",
        "expected HARD, LINEAR",
    ),
    (
        INTERACTION + PAIR + "*CLEARANCE, SLAVE=high, MASTER=low, VALUE=.1\n",
        "*CLEARANCE",
        "no *CONTACT PAIR of high and low",
    ),
    (INTERACTION + PROFILE + PAIR.replace("Low, High", "Die, Low"), "Die, Low", "cannot be the sl"),
    (
        INTERACTION + PROFILE.replace("2., 3.\n", "2., 3.5\n") + PAIR.replace("High", "Die"),
        "CIRCL",
        "equally far",
    ),
    (PROFILE.replace("START, 3., 4.\n", ""), "LINE", "comes first"),
    (PROFILE.replace("CIRCL", "PARAB"), "PARAB", "START, LINE or CIRCL"),
    (BODY, "ANALYTICAL", "no surface named 'Die'"),
    (BODY.replace("REF NODE=30", "ROT NODE=30"), "RIGID BODY", "REFNODE= is missing"),
    (BODY.replace("REF NODE=30", "NSET=30"), "RIGID BODY", "REFNODE= is missing"),
    (BODY.replace("Die", "Low"), "ANALYTICAL", "not a rigid profile"),
    ("*TIE, NAME=T\nLow\n", "Low\n", "master surface is missing"),
    (
        INTERACTION + "*SURFACE, NAME=One, TYPE=NODE\n5\n" + PAIR.replace("High", "One"),
        "Low, One",
        "no outer element edge",
    ),
    ("*CONTACT\n", "*CONTACT", "no *CONTACT INCLUSIONS"),
    ("*CONTACT EXCLUSIONS\n", "*CONTACT", "belongs under *CONTACT"),
    (INTERACTION + "*FRICTION, ANISOTROPIC\n", "ANISOTROPIC", "ANISOTROPIC"),
]


@pytest.mark.parametrize(("lines", "place", "text"), FAULTS)
def test_faults_are_told_with_their_place(
    tmp_path: Path, lines: str, place: str, text: str
) -> None:
    whole = deck(lines)
    line = whole[: whole.index(place, len(MESH + ABOVE + SECTION))].count("\n") + 1
    found = faults(tmp_path, whole)
    assert any(text in d.message and d.where and d.where.line == line for d in found), found


def test_unknown_pairs_of_requests_are_named(tmp_path: Path) -> None:
    step = STEP.replace("*END STEP", "*CONTACT PRINT, SLAVE=a, MASTER=b\nCF\n*END STEP")
    assert any("no contact pair named 'a-b'" in d.message for d in faults(tmp_path, deck("", step)))
