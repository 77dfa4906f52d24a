"""Faulty decks through the command: a message with a place, the right exit code, no traceback."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest
from decks import DECK, SUPPORT

from corota.cli import main

if TYPE_CHECKING:
    from pathlib import Path

HUGE = "9" * 1_000_000
#: Exit code, line of the first message (0: none is named), words of it, what is replaced by what.
CASES = [
    (2, 1, "*NODE", "*NODE, NSET", "*NODES, NSET"),
    (2, 20, "DIRCT", "*STATIC", "*STATIC, DIRCT"),
    (2, 8, "CPS5", "TYPE=CPS4", "TYPE=CPS5"),
    (2, 8, "axisymmetric", "TYPE=CPS4", "TYPE=SAX1"),
    (2, 14, "eall", "ELSET=eall, MATERIAL", "ELSET=eal, MATERIAL"),
    (2, 14, "steel", "MATERIAL=steel", "MATERIAL=steal"),
    (2, 22, "amplitude", "*CLOAD", "*CLOAD, AMPLITUDE=up"),
    (2, 23, "surface", "*CLOAD\n3, 2, -5.", "*DSLOAD\ntop, P, 2."),
    (2, 10, "node 3 is not defined", "3, 2., 0.", "7, 2., 0."),
    (2, 4, "already defined", "3, 2., 0.", "2, 2., 0."),
    (2, 10, "already defined", "2, 2, 3, 6, 5", "1, 2, 3, 6, 5"),
    (2, 9, "4 nodes", "1, 1, 2, 5, 4", "1, 1, 2, 5"),
    (2, 9, "twice", "1, 1, 2, 5, 4", "1, 1, 2, 1, 4"),
    (2, 9, "folded", "1, 1, 2, 5, 4", "1, 1, 5, 2, 4"),
    (2, 9, "", "4, 0., 1.\n5, 1., 1.\n", "4, 0., 0.\n5, 1., 0.\n"),
    (2, 4, "too many fields", "3, 2., 0.", "3, 2., 0., 0., 7."),
    (2, 4, "number", "3, 2., 0.", "3, two, 0."),
    (2, 4, "nan", "3, 2., 0.", "3, nan, 0."),
    (2, 4, "inf", "3, 2., 0.", "3, inf, 0."),
    (2, 4, "hexadecimal", "3, 2., 0.", "3, 0x10, 0."),
    (2, 4, "too large", "3, 2., 0.", "3, 1e400, 0."),
    (2, 4, "normal number", "3, 2., 0.", "3, 1e-310, 0."),
    (2, 23, "nan", "3, 2, -5.", "3, 2, nan"),
    (2, 13, "must be > 0", "210000., .3", "0., .3"),
    (2, 13, "Poisson", "210000., .3", "210000., .5"),
    (2, 15, "thickness", "MATERIAL=steel\n2.", "MATERIAL=steel\n0."),
    (3, 13, "density", "*STATIC\n.1, 1.\n", "*DYNAMIC\n.1, 1.\n"),
    (
        2,
        16,
        "*PLASTIC: the plastic strain must grow",
        "210000., .3\n",
        "210000., .3\n*PLASTIC\n200., 0.\n190., 0.\n",
    ),
    (2, 23, "increase", "*CLOAD", "*AMPLITUDE, NAME=a\n0., 0., 0., 1.\n*CLOAD"),
    (2, 22, "procedure", "*STATIC\n.1, 1.\n", ""),
    (2, 19, "INC", "*STEP, NLGEOM", "*STEP, NLGEOM, INC=0"),
    (2, 21, "must be > 0", ".1, 1.\n", "-1., 1.\n"),
    (2, 22, "OP", "*CLOAD", "*CLOAD, OP=OLD"),
    (2, 16, "'i'", "*BOUNDARY", "*CONTACT PAIR, INTERACTION=i\na, b\n*BOUNDARY"),
    (2, 16, "*EQUATION", "*BOUNDARY", "*CYCLIC SYMMETRY MODEL, N=3\n*BOUNDARY"),
    (2, 16, "itself", "*BOUNDARY", "*INCLUDE, INPUT=deck.inp\n*BOUNDARY"),
    (2, 16, "gone.inp", "*BOUNDARY", "*INCLUDE, INPUT=gone.inp\n*BOUNDARY"),
    (2, 16, "--allow-include", "*BOUNDARY", "*INCLUDE, INPUT=/etc/hosts\n*BOUNDARY"),
    (2, 16, "--allow-include", "*BOUNDARY", "*INCLUDE, INPUT=../x.inp\n*BOUNDARY"),
    (2, 16, "", "*BOUNDARY", "*INCLUDE, INPUT=/dev/zero\n*BOUNDARY"),
    (2, 17, "", "*BOUNDARY", "*NSET, NSET=a, GENERATE\n1, 1000000000\n*BOUNDARY"),
    (2, 4, "too large", "3, 2., 0.", f"{HUGE}, 2., 0."),
    (2, 4, "", "3, 2., 0.", "3, 2.\x00, 0."),
    (3, 0, "node", SUPPORT, "*NSET, NSET=unused\n1\n"),
]


@pytest.fixture
def deck(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path / "deck.inp"


def run(path: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Exit code of ``corota run`` and all that it said."""
    code = main(["run", path.name, "--quiet"])
    said = "".join(capsys.readouterr())
    assert "Traceback" not in said
    assert len(said) < 100_000
    return code, said


@pytest.mark.parametrize(("code", "line", "words", "old", "new"), CASES)
def test_a_fault_has_its_exit_code_and_place(
    deck: Path,
    capsys: pytest.CaptureFixture[str],
    code: int,
    line: int,
    words: str,
    old: str,
    new: str,
) -> None:
    assert old in DECK
    deck.write_text(DECK.replace(old, new, 1))
    found, said = run(deck, capsys)
    assert (found, words.lower() in said.lower()) == (code, True), said
    if line:
        assert f"deck.inp:{line}:" in said, said
    assert code == 3 or not list(deck.parent.glob("*.vtkhdf")), "a refused deck leaves no results"


HARDLY_DECKS = [
    ("empty", b"", 2),
    ("binary", bytes(range(256)) * 40, 2),
    ("gzip", b"\x1f\x8b\x08\x00" + bytes(100), 2),
    ("no mesh", b"*HEADING\nnothing\n", 2),
    ("latin-1", DECK.replace("steel", "st\u00e4l").encode("latin-1"), 0),
    ("crlf and tabs", DECK.replace("\n", "\r\n").replace(", ", ",\t").encode(), 0),
    ("no end of line", DECK.rstrip().encode(), 0),
    ("no load", DECK.replace("*CLOAD\n3, 2, -5.\n", "").encode(), 0),
    (
        "large numbers",
        DECK.replace("3, 2., 0.", "2147483647, 2., 0.")
        .replace("2, 2, 3, 6", "2, 2, 2147483647, 6")
        .replace("\n3, 2, -5.", "\n2147483647, 2, -5.")
        .encode(),
        0,
    ),
    ("one line of a megabyte", (DECK + "**" + "x" * 1_000_000 + "\n").encode(), 0),
    (
        "many sets",
        (
            DECK.replace(
                "*BOUNDARY", "".join(f"*NSET, NSET=s{i}\n1\n" for i in range(2000)) + "*BOUNDARY", 1
            )
        ).encode(),
        0,
    ),
    ("not held against turning", DECK.replace("4, 1\n", "").encode(), 3),
    ("too large a load", DECK.replace("3, 2, -5.", "3, 2, -5e9").encode(), 4),
]


@pytest.mark.parametrize(
    ("raw", "code"), [c[1:] for c in HARDLY_DECKS], ids=[c[0] for c in HARDLY_DECKS]
)
def test_odd_files_run_or_are_refused(
    deck: Path, capsys: pytest.CaptureFixture[str], raw: bytes, code: int
) -> None:
    deck.write_bytes(raw)
    found, said = run(deck, capsys)
    assert found == code, said
    if code:
        assert "error" in said
        assert "deck" in said or "can turn about" in said or "step 1 stopped" in said


def test_a_pipe_is_not_read_for_ever(deck: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(deck)
    found, said = run(deck, capsys)
    assert found in (2, 6), said
