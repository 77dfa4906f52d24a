"""One cause has one message, which names the file once and says what to do; nodal thickness."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from decks import DECK, faults, read

import corota as ct
from corota.check import check
from corota.cli.info import model_lines, model_record
from corota.io.deck.elements import why_unsupported
from corota.io.deck.refused import REFUSED_PARAMETERS, UNSUPPORTED

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("name", ["CPE4T", "C3D8R", "SAX1", "QUAD4", "COH2D4", "CPS4E", "DC2D4"])
def test_refused_elements_are_told_once(tmp_path: Path, name: str) -> None:
    extra = "*SURFACE, NAME=top\neall, S3\n*ELSET, ELSET=some\n1, 2\n*STEP"
    text = (
        DECK.replace("CPS4", name)
        .replace("*STEP", extra, 1)
        .replace(
            "*CLOAD", "*DSLOAD\ntop, P, 1.\n*DLOAD\n1, P1, 2.\n*EL PRINT, ELSET=eall\nS\n*CLOAD"
        )
    )
    found = faults(tmp_path, text)
    assert [d.where.line for d in found if d.where] == [8], list(map(str, found))
    assert name in found[0].message


def test_refused_laws_and_procedures_are_told_once(tmp_path: Path) -> None:
    for old, new in (
        ("*ELASTIC\n210000., .3", "*ELASTIC\n210000., .3\n*MOHR COULOMB\n30., 5."),
        ("*STATIC\n.1, 1.", "*GREEN\n"),
        ("*STATIC\n.1, 1.", "*HEAT TRANSFER\n.1, 1."),
    ):
        found = faults(tmp_path, DECK.replace(old, new))
        assert len(found) == 1, list(map(str, found))
        assert "not supported" in found[0].message
        assert found[0].hint


def test_a_message_names_the_file_once(tmp_path: Path) -> None:
    for old, new in (
        ("*STATIC\n.1, 1.\n", ""),
        ("*STATIC", "*MATERIAL, NAME=steel\n*ELASTIC\n1., 0.\n*STATIC"),
        ("2, 2, 3, 6, 5", "2, 2, 3, 6, 5\n2, 2, 3, 6, 5"),
        ("6, 2., 1.", "6, 2., 1.\n6, 3., 1."),
        ("*BOUNDARY", "*SURFACE, NAME=a\neall, S1\n*SURFACE, NAME=a\neall, S2\n*BOUNDARY"),
    ):
        for finding in faults(tmp_path, DECK.replace(old, new)):
            assert str(finding).count("deck.inp") == 1, str(finding)


def test_every_refusal_says_what_to_do() -> None:
    assert all(len(text) > 15 for text in UNSUPPORTED.values())
    assert all(len(text) > 10 for text in REFUSED_PARAMETERS.values())
    for name in ("CGAX8R", "CPE4T", "CPE8RP", "CPEG4", "CONN2D2", "U1", "R3D4", "SAX1", "GAPCYL"):
        assert why_unsupported(name), name
    for name in ("CPS4", "QUAD", "UX", "CPS", "S"):
        assert not why_unsupported(name), name


def test_hints_do_not_change_the_answer(tmp_path: Path) -> None:
    found = faults(tmp_path, DECK.replace("*CLOAD\n3, 2, -5.", "*DLOAD\n1, HP2, 2."))
    assert all("did you mean" not in d.hint for d in found)
    found = faults(tmp_path, DECK.replace("CPS4", "CPE4Q"))
    assert "CPS" not in found[0].hint.replace("known: CPS and CPE", "")


def test_a_node_that_only_a_thickness_uses_must_exist(tmp_path: Path) -> None:
    given = "*NSET, NSET=thin\n1, 4711\n*NODAL THICKNESS\nthin, 4.\n*BOUNDARY"
    text = DECK.replace("*BOUNDARY", given, 1).replace("MATERIAL=", "NODAL THICKNESS, MATERIAL=")
    found = faults(tmp_path, text)
    assert [d.message for d in found] == ["node 4711 in set thin: not defined in the deck"]


def test_nodal_thickness_replaces_that_of_the_section(tmp_path: Path) -> None:
    given = "*NODAL THICKNESS\nnall, 4.\n*BOUNDARY"
    text = DECK.replace("*BOUNDARY", given, 1)
    plain = read(tmp_path, text)
    assert [s.thickness for s in plain.sections] == [2.0]
    assert any("has no NODAL THICKNESS" in note for note in plain.notes)
    text = text.replace("MATERIAL=steel", "MATERIAL=steel, NODAL THICKNESS")
    assert [s.thickness for s in read(tmp_path, text).sections] == [4.0]
    bare = text.replace("NODAL THICKNESS\n2.", "NODAL THICKNESS")
    model = read(tmp_path, bare)
    assert [s.thickness for s in model.sections] == [4.0]
    thick = DECK.replace("MATERIAL=steel\n2.", "MATERIAL=steel\n4.")
    expected = ct.solve(read(tmp_path, thick)).frames[-1].U
    assert ct.solve(model).frames[-1].U == pytest.approx(expected, rel=1e-12)  # noqa: SIM300
    # Of nodes that are not named it is that of the section.
    some = read(tmp_path, text.replace("nall, 4.", "3, 4.\n6, 4."))
    nodal = some.sections[0].nodal_thickness
    assert nodal is not None
    labels = some.mesh.node_labels
    assert dict(zip(labels.tolist(), nodal.tolist(), strict=True)) == {
        label: 4.0 if label in (3, 6) else 2.0 for label in labels.tolist()
    }
    assert any(
        "must be > 0" in d.message for d in faults(tmp_path, text.replace("nall, 4.", "3, 0."))
    )


PAIR = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
11, 0., 1.
12, 1., 1.
13, 1., 2.
14, 0., 2.
20, 0.5, 3.
*ELEMENT, TYPE=CPS4, ELSET=eall
1, 1, 2, 3, 4
2, 11, 12, 13, 14
*NSET, NSET=rim
13, 14
*MATERIAL, NAME=steel
*ELASTIC
210000., .3
*PLASTIC
100., 0.
200., .1
*SOLID SECTION, ELSET=eall, MATERIAL=steel
1.
*SURFACE, NAME=low
1, S3
*SURFACE, NAME=high
2, S1
*SURFACE INTERACTION, NAME=i
*FRICTION
.25
*CONTACT PAIR, INTERACTION=i, TYPE=SURFACE TO SURFACE
high, low
*RIGID BODY, NSET=rim, REF NODE=20
*BOUNDARY
1, 1, 2
2, 2
20, 1
20, 6
*STEP
*STATIC
*CLOAD
20, 2, -1.
*END STEP
"""


def test_check_lists_what_joins_bodies(tmp_path: Path) -> None:
    model = read(tmp_path, PAIR)
    text = "\n".join(model_lines(model))
    for part in (
        "contact high on low: mortar, hard, friction 0.25",
        "rigid body: 2 nodes, reference node 20",
        "steel: Mises, E 210000, nu 0.3, yield stress 100 to 200 at plastic strain 0.1 (2 points)",
    ):
        assert part in text
        assert part in "\n".join(model_record(model)["materials"] + model_record(model)["joints"])
    idle = [d.message for d in check(model) if "unused sets" in d.message]
    assert not any(name in text for text in idle for name in ("low", "high", "rim"))


def test_temperatures_that_nothing_feels_are_left_out(tmp_path: Path) -> None:
    text = DECK.replace("*CLOAD", "*TEMPERATURE\nnall, 60.\n*CLOAD")
    model = read(tmp_path, text)
    assert any("temperatures have no effect" in note for note in model.notes)
    assert len(ct.solve(model).frames) > 1
    warm = text.replace("*SOLID", "*EXPANSION\n1e-5\n*SOLID")
    assert len(read(tmp_path, warm).steps[0].loads) == 2


def test_lost_elements_of_a_set_are_told_once(tmp_path: Path) -> None:
    text = DECK.replace("*MATERIAL", "*ELSET, ELSET=some\n1, 7\n8, 9\n10\n*MATERIAL", 1)
    found = faults(tmp_path, text)
    assert [d.message for d in found] == [
        "element 7 and 3 others in set some: not defined in the deck"
    ]


@pytest.mark.parametrize("joint", ["*TIE, NAME=T\nhigh, low\n", ""])
def test_edges_that_a_joint_connects_are_not_called_open(joint: str, tmp_path: Path) -> None:
    """Two blocks one on the other, with two nodes at each place of their joint."""
    text = (
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 0., 1.\n6, 1., 1.\n7, 1., 2.\n"
        "8, 0., 2.\n*ELEMENT, TYPE=CPS4, ELSET=E\n1, 1, 2, 3, 4\n2, 5, 6, 7, 8\n"
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n"
        f"*SURFACE, NAME=low\n1, S3\n*SURFACE, NAME=high\n2, S1\n{joint}"
        "*BOUNDARY\n1, 1, 2\n2, 2\n8, 1\n*STEP\n*STATIC\n*CLOAD\n7, 2, -1.\n*END STEP\n"
    )
    said = [d.message for d in check(read(tmp_path, text)) if "not joined" in d.message]
    assert bool(said) == (not joint)
