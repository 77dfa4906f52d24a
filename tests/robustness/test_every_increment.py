"""At every increment: a checkpoint into fresh objects, one increment more, the same whole state.

The state of an analysis decides all that follows it. So where each checkpoint leads to the next
one with the same bits, everything after any of them is the same; this is also run out from the
first, the middle and the last one.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import pytest

import corota as ct
from benchmarks.restart_cases import DECKS, EXAMPLES, MODELS
from benchmarks.same_bits import Takes, frame_differences
from corota.analysis.run import solve
from corota.results.observer import BaseObserver

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


class One(BaseObserver):
    """Takes the checkpoint of the next increment and asks for the end."""

    checkpoint_due = True

    def __init__(self):
        self.found, self.stop = None, False

    def checkpoint(self, checkpoint, keep=""):
        if not keep and self.found is None:
            self.found, self.stop = checkpoint, True


def whole_run(build):
    takes = Takes()
    results, error = outcome(build(), takes)
    return takes.found, results, error


def outcome(model, observer=None, start=None):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        observers = [] if observer is None else [observer]
        try:
            return solve(model, observers=observers, threads=1, start=start), ""
        except ct.CorotaError as error:
            return getattr(error, "results", None), str(error)


def state_differences(one, other):
    """What differs between two checkpoints, to the bit."""
    names = ("step", "increment", "time", "step_time", "factor", "kind", "tree")
    found = [name for name in names if getattr(one, name) != getattr(other, name)]
    if len(one.arrays) != len(other.arrays):
        return [*found, "number of arrays"]
    for k, (a, b) in enumerate(zip(one.arrays, other.arrays, strict=True)):
        if (a.dtype, a.shape) != (b.dtype, b.shape) or a.tobytes() != b.tobytes():
            found.append(f"array {k}")
    return found


@pytest.fixture(params=[3, pytest.param(1, marks=pytest.mark.slow)], ids=["third", "each"])
def every(request):
    """Which of the checkpoints are tried."""
    return request.param


def goes_on(build, every):
    found, results, error = whole_run(build)
    if not found:
        assert not {s.procedure for s in build().steps} & {"static", "dynamic"}
        return
    for k in range(0, len(found) - 1, every):
        one = One()
        outcome(build(), one, found[k])
        assert state_differences(found[k + 1], one.found) == [], found[k].where
    for checkpoint in {id(c): c for c in (found[0], found[len(found) // 2], found[-1])}.values():
        rest, ended = outcome(build(), start=checkpoint)
        at = (checkpoint.step, checkpoint.increment)
        behind = [f for f in results.frames if (f.step, f.increment) > at]
        assert len(rest.frames) == len(behind)
        for a, b in zip(behind, rest.frames, strict=True):
            assert not frame_differences(a, b), checkpoint.where
        assert ended == error
        # A peak is one of the increments that this run has made.
        first, second = (
            [n for n in found.notes if "resolves the peak" not in n] for found in (rest, results)
        )
        assert first == second


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
