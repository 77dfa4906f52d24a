"""Decks as people and programs write them, in layouts that are not those of the corpus.

Lower case, tabs, CRLF, blank fields, lines that go on, sets of sets, parts and instances, several
steps, cards of other programs. Poisson's ratio is 0 in plane stress: CalculiX, whose answers these
are, makes solids of planar elements, whose stress across vanishes in the mean only.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.corpora.corpus import compare

FOLDER = Path(__file__).parents[1] / "data" / "wild"
#: x, y, ux, uy of two nodes of each deck, by CalculiX 2.20.
ANSWERS = json.loads((FOLDER / "answers.json").read_text(encoding="utf-8"))
DECKS = sorted(path.stem for path in FOLDER.glob("*.inp"))
#: Flow and contact: CalculiX iterates to 5e-3 of the mean force, and its pressures need overlap.
LOOSE = ("plastic_bar", "kinematic_plastic_cycle", "contact_options", "quasi_static")


def test_every_deck_has_an_answer() -> None:
    assert len(DECKS) >= 60
    assert set(DECKS) == set(ANSWERS)


@pytest.mark.parametrize("name", DECKS)
def test_a_deck_runs_and_is_right(name: str) -> None:
    accepted, ran, difference = compare(FOLDER / f"{name}.inp", ANSWERS[name])
    assert accepted
    assert ran
    assert difference < (1e-3 if name in LOOSE else 5e-5)
