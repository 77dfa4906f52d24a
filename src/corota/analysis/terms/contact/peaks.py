"""Peaks of contact forces between two increments."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.model.contact import ContactPair

if TYPE_CHECKING:
    from corota.results.results import Results

#: Change of a force beside its largest value, relative to it, from which an increment may have
#: missed the peak.
STEEP = 0.05


def missed_peaks(results: Results, pairs: list[ContactPair], static: set[int]) -> list[str]:
    """Notes on largest forces of pairs beside which the force changes much in one increment.

    Parameters
    ----------
    results : Results
    pairs : list of ContactPair
    static : set of int
        Numbers of the static steps; in motion the scheme bounds the error of an increment.
    """
    notes = []
    frames = [f for f in results.frames if f.step in static]
    for pair in pairs:
        along = [[f.scalars.get(f"{pair.name}: force {c}", 0.0) for c in "xy"] for f in frames]
        force = np.hypot(*np.reshape(along, (-1, 2)).T)
        i = int(np.argmax(force)) if len(force) else 0
        if not 0 < i < len(frames) - 1 or frames[i - 1].step != frames[i + 1].step:
            continue
        before, most, after = force[i - 1 : i + 2]
        if most - min(before, after) > STEEP * most:
            notes.append(
                f"contact pair {pair.name!r}: the largest force, {most:.4g}, at step time "
                f"{frames[i].step_time:.4g} of step {frames[i].step}, stands between {before:.4g} "
                f"and {after:.4g} of the increments beside it, between which it may be larger: a "
                "smaller largest_increment resolves the peak"
            )
    return notes


__all__ = ["missed_peaks"]
