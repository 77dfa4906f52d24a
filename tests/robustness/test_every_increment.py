"""At every increment: a checkpoint into fresh objects, one increment more, the same whole state.

The state of an analysis decides all that follows it. So where each checkpoint leads to the next
one with the same bits, everything after any of them is the same; this is also run out from the
middle and the last one, and from the first where each one is tried.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct
from benchmarks.corpora.restart_cases import DECKS, EXAMPLES, MODELS
from support.checkpoints import goes_on

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")

#: Examples with hundreds of increments, of which every tenth is tried.
LONG = {"bistable_beam", "clip", "impact bar", "whip", "pulse"}
SLOW = LONG | {
    "free_flight",
    "gripper",
    "impact ring",
    "ironing",
    "lee frame",
    "pendulum",
    "rotor",
    "seal",
    "snap_by_load",
    "switch",
}


@pytest.fixture(params=[3, pytest.param(1, marks=pytest.mark.slow)], ids=["third", "each"])
def every(request):
    """Which of the checkpoints are tried."""
    return request.param


@pytest.mark.parametrize("name", DECKS)
def test_decks(name, every, tmp_path):
    deck = tmp_path / "job.inp"
    deck.write_text(DECKS[name]())
    goes_on(lambda: ct.read(deck), every)


@pytest.mark.parametrize("name", MODELS)
def test_models(name, every):
    goes_on(MODELS[name], every)


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] if n in SLOW else []) for n in EXAMPLES]
)
def test_examples(name, every):
    goes_on(EXAMPLES[name], 10 if name in LONG else every)
