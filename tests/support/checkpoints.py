"""Runs that go on from their checkpoints, compared to the bit."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import corota as ct
from benchmarks.campaigns.same_bits import Takes, frame_differences
from corota.analysis.run import solve
from corota.results.observer import BaseObserver


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


def goes_on(build, every=1):
    """Each checkpoint leads to the next, and the middle and the last to the end.

    Parameters
    ----------
    build : callable
        Gives the model, made anew.
    every : int
        Which checkpoints are tried; with all of them, the first also leads to the end.
    """
    found, results, error = whole_run(build)
    if not found:
        assert not {s.procedure for s in build().steps} & {"static", "dynamic"}
        return
    for k in range(0, len(found) - 1, every):
        one = One()
        outcome(build(), one, found[k])
        assert state_differences(found[k + 1], one.found) == [], found[k].where
    far = [found[len(found) // 2], found[-1], *found[: every == 1]]
    for checkpoint in {id(c): c for c in far}.values():
        rest, ended = outcome(build(), start=checkpoint)
        at = (checkpoint.step, checkpoint.increment)
        behind = [f for f in results.frames if (f.step, f.increment) > at]
        assert len(rest.frames) == len(behind)
        for a, b in zip(behind, rest.frames, strict=True):
            assert not frame_differences(a, b), checkpoint.where
        assert ended == error
        assert rest.notes == results.notes
