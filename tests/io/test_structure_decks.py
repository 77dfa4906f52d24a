"""Generated decks of beams, shells, masses, joints and CAE's layout agree with CalculiX 2.20.

The answers of ``ccx`` are stored in tests/data/structure_decks.json (made by ``python -m
benchmarks structure_decks``, which also runs CalculiX again).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json

import pytest

from benchmarks.corpora.structure_decks import (
    ANSWERS,
    COUNT,
    THEMES,
    by_corota,
    difference,
    generate,
)

STORED = json.loads(ANSWERS.read_text(encoding="utf-8"))


def test_nearly_all_decks_have_an_answer() -> None:
    assert len(STORED) >= 0.9 * COUNT
    assert {generate(int(number)).theme for number in STORED} == set(THEMES)


@pytest.mark.parametrize("number", STORED)
def test_a_deck_agrees_with_calculix(number: str) -> None:
    deck = generate(int(number))
    assert difference(by_corota(deck), STORED[number]) <= deck.tolerance
