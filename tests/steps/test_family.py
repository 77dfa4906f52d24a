"""400 generated decks of several steps beside CalculiX 2.20.

The answers of ``ccx`` are stored in tests/data/deck_family.json (made by ``python -m
benchmarks deck_family``, which also runs CalculiX again). Displacements, total reactions (not in
motion), stresses, frequencies and buckling factors agree to the digits that CalculiX prints in
linear steps, and to 1e-3 in motion and under large rotations; the exceptions stand in the
benchmark with their proofs.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from collections import Counter

import pytest

from benchmarks.corpora.deck_family import ANSWERS, EXCEPTIONS, by_corota, full, verdict
from benchmarks.corpora.deck_generator import COUNT, THEMES, generate
from support.pairs import quickly


@pytest.mark.parametrize("part", quickly(range(4), 0, 2))
@pytest.mark.parametrize("theme", range(len(THEMES)), ids=lambda i: THEMES[i].replace(" ", "-"))
def test_decks_agree_with_calculix(theme: int, part: int) -> None:
    stored = json.loads(ANSWERS.read_text())
    numbers = range(theme, COUNT, len(THEMES))[part::4]
    wrong = []
    for number in numbers:
        if str(number) not in stored:
            continue  # CalculiX does not finish it
        deck = generate(number)
        found, error = verdict(deck, by_corota(deck), full(stored[str(number)]))
        if found == "differing":
            wrong.append((number, error))
    assert not wrong


def test_the_family_is_large_and_its_exceptions_are_few() -> None:
    features = Counter(f for number in range(COUNT) for f in generate(number).features)
    excepted = sum(features[name] for name in EXCEPTIONS)
    stored = json.loads(ANSWERS.read_text())
    assert len(stored) >= 390
    assert excepted < 0.2 * COUNT
    assert ANSWERS.stat().st_size < 600_000
