"""Notes on contact forces whose largest value stands between two increments."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from corota.model.contact import ContactPair

#: Note alone: change of a force beside its largest value, relative to it, from which an increment
#: may have missed the peak.
STEEP = 0.05
#: Note alone: change beside it up to which the largest value is that of a plateau, as of a body
#: that slides. The force of a ring in its hole is below `ROUNDING` of pressure times area.
FLAT = 1e-3
ROUNDING = 1e-9

#: Step, from 1, step time and size of the force of a pair in an increment.
Instant = tuple[int, float, float]
#: No increment.
NONE: Instant = (0, 0.0, -1.0)
#: The last increment, that before the largest force, that of it, and the one behind.
Peak = tuple[Instant, Instant, Instant, Instant]


def pair_forces(
    pairs: list[ContactPair], scalars: dict[str, float], pressure: float
) -> list[float]:
    """Size of the force of each pair [force] from the histories of an increment.

    Parameters
    ----------
    pressure : float
        Largest pressure of all pairs [stress]; a force that is rounding beside it counts as 0.
    """
    found = []
    for pair in pairs:
        x, y = (scalars.get(f"{pair.name}: force {c}", 0.0) for c in "xy")
        force = float(np.hypot(x, y))
        least = ROUNDING * pressure * scalars.get(f"{pair.name}: area", 0.0)
        found.append(force if force > least else 0.0)
    return found


def followed(peak: Peak, now: Instant) -> Peak:
    """Where the largest force of a pair stands after one more increment."""
    last, before, most, after = peak
    if now[2] > most[2]:
        before, most, after = last, now, NONE
    elif not after[0]:
        after = now
    return now, before, most, after


def missed_peaks(peaks: list[Peak], pairs: list[ContactPair]) -> list[str]:
    """Notes on largest forces of pairs beside which the force changes much in one increment.

    Parameters
    ----------
    peaks : list of Peak
        Of each pair, over the increments of the static steps; in motion the scheme bounds the
        error of an increment.
    """
    notes: list[str] = []
    for (_, (begin, _, before), (step, time, most), (end, _, after)), pair in zip(
        peaks, pairs, strict=True
    ):
        if not begin or begin != end:
            continue
        alone = most - max(before, after) > FLAT * most
        if alone and most - min(before, after) > STEEP * most:
            notes.append(
                f"contact pair {pair.name!r}: the largest force, {most:.4g}, at step time "
                f"{time:.4g} of step {step}, stands between {before:.4g} "
                f"and {after:.4g} of the increments beside it, between which it may be larger: a "
                "smaller largest_increment resolves the peak"
            )
    return notes
