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


def pair_forces(pairs: list[ContactPair], scalars: dict[str, float]) -> list[float]:
    """Size of the force of each pair [force] from the histories of an increment."""
    along = ([scalars.get(f"{pair.name}: force {c}", 0.0) for c in "xy"] for pair in pairs)
    return [float(np.hypot(x, y)) for x, y in along]


def missed_peaks(
    increments: list[tuple[int, float, list[float]]], pairs: list[ContactPair]
) -> list[str]:
    """Notes on largest forces of pairs beside which the force changes much in one increment.

    Parameters
    ----------
    increments : list of tuple of int, float and list of float
        Step, step time and :func:`pair_forces` of each increment of the static steps; in motion
        the scheme bounds the error of an increment.
    pairs : list of ContactPair
    """
    notes: list[str] = []
    for k, pair in enumerate(pairs):
        force = np.array([forces[k] for _, _, forces in increments])
        i = int(np.argmax(force)) if len(force) else 0
        if not 0 < i < len(force) - 1 or increments[i - 1][0] != increments[i + 1][0]:
            continue
        before, most, after = force[i - 1 : i + 2]
        if most - min(before, after) > STEEP * most:
            notes.append(
                f"contact pair {pair.name!r}: the largest force, {most:.4g}, at step time "
                f"{increments[i][1]:.4g} of step {increments[i][0]}, stands between {before:.4g} "
                f"and {after:.4g} of the increments beside it, between which it may be larger: a "
                "smaller largest_increment resolves the peak"
            )
    return notes
