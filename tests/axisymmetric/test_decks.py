"""Decks of CAX elements: read, written and read again, and beside CalculiX 2.20."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path

import pytest

import corota as ct
from benchmarks.axisymmetric_decks import ANSWERS, generate
from benchmarks.structure_decks import by_corota, difference
from corota.io.deck.write.model import write_deck

STORED = json.loads(ANSWERS.read_text(encoding="utf-8"))
#: A few of them; ``python -m benchmarks.axisymmetric_decks --stored`` compares with all.
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
