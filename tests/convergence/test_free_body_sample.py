"""A sample of the random decks of ``python -m benchmarks free_bodies``.

Equilibrium is computed again from the written results; who is held is known by construction.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

from benchmarks.campaigns.free_bodies import run, same_verdict
from benchmarks.corpora.free_body_decks import make
from support.pairs import quickly

SAMPLE = 60


@pytest.mark.parametrize("first", quickly(range(0, SAMPLE, 10), 0))
def test_no_deck_ends_without_equilibrium_or_reason(first, tmp_path):
    for number in range(first, first + 10):
        deck = make(f"sample:{number}")
        outcome = run(deck, tmp_path)
        assert not outcome.faults, (number, deck.features, outcome.message)
        if number % 3 == 0:
            assert not same_verdict(deck, tmp_path, outcome.code), (number, deck.features)
