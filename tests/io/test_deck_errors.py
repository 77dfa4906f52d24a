"""Faulty decks: each fault is told once, with line, column and the way out."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import pytest
from decks import DECK, MESH, SECTION, STEP, SUPPORT, faults

import corota as ct

#: What is replaced, by what, line and column of the message (0: no place), a part of its text.
CASES = [
    # Keywords and parameters.
    ("*NODE, NSET", "*NODES, NSET", 1, 1, "did you mean *NODE?"),
    ("*SOLID SECTION", "*SOLID SECTON", 14, 1, "did you mean *SOLID SECTION?"),
    ("*STATIC", "*MODAL DYNAMC", 20, 1, "did you mean *MODAL DYNAMIC?"),
    ("*STATIC", "*QWERTY", 20, 1, "unknown keyword *QWERTY"),
    ("*STATIC", "*GREEN", 20, 1, "not part of this version"),
    ("*STATIC", "*STATIC, DIRCT", 20, 10, "did you mean DIRECT?"),
    ("*BOUNDARY", "*BOUNDARY, SUBMODEL", 16, 12, "SUBMODEL is not supported"),
    ("*BOUNDARY", "*BOUNDARY, FIXED", 16, 12, "FIXED belongs in a step"),
    ("*BOUNDARY", "*BOUNDARY, OP=OLD", 16, 15, "expected NEW, MOD"),
    ("*CLOAD", "*SURFACE INTERACTION, NAME=i", 22, 1, "inside a step"),
    ("*CLOAD", "*CLOAD, AMPLITUDE=up", 22, 19, "no amplitude named 'up'"),
    ("TYPE=CPS4, ELSET=eall", "ELSET=eall", 8, 1, "TYPE= is missing"),
    ("TYPE=CPS4", "TYPE=CPS5", 8, 16, "unknown element type 'CPS5'"),
    ("TYPE=CPS4", "TYPE=SAX1", 8, 16, "axisymmetric shells and membranes are not part"),
    ("TYPE=CPS4", "TYPE=CPS4, TYPE=CPS3", 8, 22, "given twice"),
    ("*ELASTIC", "*ELASTIC, TYPE=FANCY", 12, 16, "FANCY is not known"),
    ("*ELASTIC", "*MOHR COULOMB", 12, 1, "the material laws are"),
    # Data lines.
    ("3, 2., 0.", "3, 2.x, 0.", 4, 4, "x: expected a number, found '2.x'"),
    ("3, 2., 0.", "3, nan, 0.", 4, 4, "'nan' is not accepted"),
    ("3, 2., 0.", "3, -inf, 0.", 4, 4, "'-inf' is not accepted"),
    ("3, 2., 0.", "3, 0x10, 0.", 4, 4, "hexadecimal"),
    ("3, 2., 0.", "3, 1e400, 0.", 4, 4, "too large"),
    ("3, 2., 0.", "3, 1e-310, 0.", 4, 4, "smallest normal number"),
    ("3, 2., 0.", "3, 1. 5, 0.", 4, 4, "blank inside"),
    ("3, 2., 0.", "3, 2., 0., 0., 7.", 4, 16, "too many fields"),
    ("3, 2., 0.", "0, 2., 0.", 4, 1, "must be >= 1"),
    ("3, 2., 0.", "3.5, 2., 0.", 4, 1, "expected a whole number"),
    ("3, 2., 0.", "99999999999999999999, 2., 0.", 4, 1, "too large"),
    ("3, 2., 0.", "2, 2., 0.", 4, 0, "node 2 is already defined"),
    ("3, 2., 0.", "7, 2., 0.", 10, 0, "node 3 is not defined"),
    ("1, 1, 2, 5, 4", "1, 1, 2, 5", 9, 11, "has 4 nodes, found 3"),
    ("1, 1, 2, 5, 4", "1, 1, 2, 5, 4, 6", 9, 16, "has 4 nodes, found 5"),
    ("1, 1, 2, 5, 4", "1, 1, 2, 1, 4", 9, 0, "node 1 occurs twice"),
    ("1, 1, 2, 5, 4", "1, 1, 5, 2, 4", 9, 0, "folded"),
    ("2, 2, 3, 6, 5", "1, 2, 3, 6, 5", 10, 0, "element 1 is already defined"),
    ("4, 0., 1.\n5, 1., 1.\n", "4, 0., 0.\n5, 1., 0.\n", 9, 0, "no length"),
    # Materials and sections.
    ("210000., .3", "-1., .3", 13, 0, "must be > 0"),
    ("210000., .3", "210000., .5", 13, 0, "Poisson's ratio 0.5"),
    ("210000., .3", "", 12, 1, "a data line is missing"),
    ("*ELASTIC\n210000., .3\n", "", 11, 1, "has no *ELASTIC"),
    ("*MATERIAL, NAME=steel\n", "", 11, 1, "belongs to a material"),
    ("MATERIAL=steel", "MATERIAL=steal", 14, 38, "did you mean steel?"),
    ("ELSET=eall, MATERIAL", "ELSET=eal, MATERIAL", 14, 23, "did you mean eall?"),
    ("MATERIAL=steel\n2.", "MATERIAL=steel\n0.", 15, 1, "thickness must be > 0"),
    ("*SOLID SECTION", "*SOLID SECTION, PLANE=STRAIN", 14, 23, "does not fit"),
    ("*SOLID SECTION", "*SOLID SECTION, ORIENTATION=o", 14, 29, "no orientation named 'o'"),
    # Supports, loads, steps.
    ("1, 1, 2\n4", "7, 1, 2\n4", 17, 1, "node 7 is not defined"),
    ("1, 1, 2\n4", "nal, 1, 2\n4", 17, 1, "did you mean nall?"),
    ("1, 1, 2\n4", "1, 2, 1\n4", 17, 7, "is below the first"),
    ("1, 1, 2\n4", "1, 7\n4", 17, 4, "degree of freedom 1 to 6"),
    ("1, 1, 2\n4", "1, 11\n4", 17, 4, "temperatures"),
    ("1, 1, 2\n4", "1, XSYM\n4", 17, 4, "did you mean XSYMM?"),
    ("1, 1, 2\n4", "1, 3, 3, .5\n4", 17, 10, "cannot be moved"),
    ("1, 1, 2\n4", "1, 6, 6, .5\n4", 17, 4, "no rotation (dof 6)"),
    ("3, 2, -5.", "3, 6, -5.", 23, 4, "no rotation (dof 6)"),
    ("3, 2, -5.", "3, 3, -5.", 23, 4, "no load in dof 3"),
    ("3, 2, -5.", "3, 2", 23, 5, "the force is missing"),
    ("*CLOAD\n3, 2, -5.", "*DLOAD\n1, P5, 2.", 23, 4, "face P5 does not exist"),
    ("*CLOAD\n3, 2, -5.", "*DLOAD\n1, Q1, 2.", 23, 4, "unknown load type"),
    ("*CLOAD\n3, 2, -5.", "*DLOAD\n9, P1, 2.", 23, 1, "element 9 is not defined"),
    ("*CLOAD\n3, 2, -5.", "*DSLOAD\ntop, P, 2.", 23, 1, "no surface named 'top'"),
    ("*CLOAD\n3, 2, -5.", "*DLOAD\neall, GRAV, 9., 0., 0., -1.", 23, 25, "out of the plane"),
    ("*CLOAD\n3, 2, -5.", "*DSLOAD, FOLLOWER=NO\ntop, TRSHR, 2., 1.", 22, 19, "FOLLOWER=NO"),
    (".1, 1.\n", "2., 1.\n", 21, 1, "exceeds the period"),
    (".1, 1.\n", "-1., 1.\n", 21, 1, "must be > 0"),
    (".1, 1.\n", ".1, 1., .5\n", 21, 9, "smallest increment"),
    ("*STEP, NLGEOM", "*STEP, INC=0", 19, 12, "less than 1"),
    ("*END STEP\n", "", 19, 1, "no *END STEP"),
    ("*STATIC\n.1, 1.\n", "", 22, 1, "has no procedure"),
    ("*STEP, NLGEOM\n", "", 19, 1, "between *STEP and *END STEP"),
    ("*CLOAD", "*NODE\n9, 0., 0.\n*CLOAD", 22, 1, "inside a step"),
    ("*CLOAD", "*NODE PRINT, NSET=nal\nU\n*CLOAD", 22, 1, "no node set named 'nal'"),
    ("*CLOAD", "*NODE PRINT, ELSET=eall\nU\n*CLOAD", 22, 14, "unknown parameter ELSET"),
    ("*CLOAD", "*EL PRINT, NSET=nall\nS\n*CLOAD", 22, 12, "unknown parameter NSET"),
]


@pytest.mark.parametrize(("old", "new", "line", "column", "text"), CASES)
def test_a_fault_is_told_in_its_place(
    tmp_path: Path, old: str, new: str, line: int, column: int, text: str
) -> None:
    assert old in DECK
    found = faults(tmp_path, DECK.replace(old, new, 1))
    hits = [d for d in found if text in str(d)]
    assert hits, "\n".join(map(str, found))
    places = [(d.where.line, d.where.column) for d in hits if d.where]
    assert (line, column) in places, places


def test_all_faults_are_told_at_once(tmp_path: Path) -> None:
    text = DECK.replace("3, 2., 0.", "3, 2.x, 0.").replace("*STATIC", "*STATC")
    text = text.replace("210000., .3", "210000., .7").replace("4, 1\n", "4, 9\n")
    found = [d.where.line for d in faults(tmp_path, text) if d.where]
    assert {4, 13, 18, 20} <= set(found)


def test_a_message_has_file_line_caret_and_hint(tmp_path: Path) -> None:
    (tmp_path / "deck.inp").write_text(DECK.replace("MATERIAL=steel", "MATERIAL=steal"))
    with pytest.raises(ct.DeckError) as caught:
        ct.read(tmp_path / "deck.inp")
    lines = str(caught.value).splitlines()
    assert lines[0].endswith("deck.inp:14:38: error: *SOLID SECTION: no material named 'steal'")
    assert lines[1] == "    *SOLID SECTION, ELSET=eall, MATERIAL=steal"
    assert lines[2] == "    " + " " * 37 + "^"
    assert lines[3] == "    hint: did you mean steel?"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b"", "no keyword"),
        (b"\n\n", "no keyword"),
        (b"** only a comment\n", "no keyword"),
        (b"\x00\x01\x02ELF", "binary"),
        (b"hello\n*NODE\n1,0,0\n", "before the first keyword"),
        (b"*HEADING\nx\n", "no nodes"),
        (MESH.encode()[:60], "no elements"),
        (b"*", "unknown keyword"),
        (b"*,=,\n", "unknown keyword"),
    ],
)
def test_hardly_decks(tmp_path: Path, text: bytes, message: str) -> None:
    assert any(message in str(d) for d in faults(tmp_path, text))


@pytest.mark.parametrize(
    ("lines", "text"),
    [
        ("*NSET, NSET=a\na\n", "contains itself"),
        ("*NSET, NSET=a\nb\n*NSET, NSET=b\na\n", "contains itself"),
        ("*ELSET, ELSET=a\nb\n*ELSET, ELSET=b\na\n", "contains itself"),
        ("*NSET, NSET=a\n1, 9\n*BOUNDARY\na, 1\n", "node 9 in set a"),
        ("*NSET, NSET=a\n1.5\n", "whole number or a set name"),
        ("*NSET, NSET=a, GENERATE\n1, 1000000000\n", "entries; at most"),
        ("*NSET, NSET=a, GENERATE\n5, 1\n", "first <= last"),
        ("*NSET, NSET=a, GENERATE\n1, 6, 2\n", "is not reached"),
        ("*NSET\n1\n", "NSET= is missing"),
        ("*ELSET, ELSET=a\n1, 2, 77\n", "element 77 in set a"),
        ("*SURFACE, NAME=s\neall, S5\n", "has 4 faces, and no face 5"),
        ("*SURFACE, NAME=s\neall, top\n", "unknown face 'TOP'"),
        ("*SURFACE, NAME=s\nnone, S1\n", "no element set named 'none'"),
        ("*SURFACE, NAME=s\n1, S1\n*SURFACE, NAME=S\n1, S2\n", "already defined"),
        ("*AMPLITUDE, NAME=a\n0., 0., 0., 1.\n", "times must increase"),
        ("*AMPLITUDE, NAME=a\n", "at least one"),
        ("*AMPLITUDE, NAME=a\n0., 0., 1.\n", "the factor is missing"),
        ("*ORIENTATION, NAME=o\n1., 0., 0., 2., 0., 0.\n", "one line"),
        ("*ORIENTATION, NAME=o\n0., 0., 1., 0., 1., 0.\n", "plane z = 0"),
        ("*TIME POINTS, NAME=t\n1., .5\n", "must increase"),
        ("*TIME POINTS, NAME=t, GENERATE\n0., 1e9, 1e-9\n", "at most 1e6"),
        ("*MATERIAL, NAME=STEEL\n*ELASTIC\n1., 0.\n", "already defined"),
        ("*SOLID SECTION, ELSET=eall, MATERIAL=steel\n1.\n", "already has a section"),
    ],
)
def test_faults_of_sets_and_tables(tmp_path: Path, lines: str, text: str) -> None:
    found = faults(tmp_path, MESH + SECTION + lines + SUPPORT + STEP)
    assert any(text in str(d) for d in found), "\n".join(map(str, found))


def test_elements_without_a_section_are_named(tmp_path: Path) -> None:
    text = DECK.replace("ELSET=eall, MATERIAL", "ELSET=one, MATERIAL").replace(
        "*MATERIAL", "*ELSET, ELSET=one\n1\n*MATERIAL"
    )
    assert any("element 2 has no *SOLID SECTION" in str(d) for d in faults(tmp_path, text))


def test_many_faults_are_cut_short(tmp_path: Path) -> None:
    rows = "".join(f"{i}, x, y\n" for i in range(1, 5000))
    found = faults(tmp_path, "*NODE\n" + rows)
    assert len(found) < 300
    assert "more errors are not listed" in str(found[-1])
