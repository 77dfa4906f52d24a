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
        alone = most - max(before, after) > FLAT * most
        if alone and most - min(before, after) > STEEP * most:
            notes.append(
                f"contact pair {pair.name!r}: the largest force, {most:.4g}, at step time "
                f"{increments[i][1]:.4g} of step {increments[i][0]}, stands between {before:.4g} "
                f"and {after:.4g} of the increments beside it, between which it may be larger: a "
                "smaller largest_increment resolves the peak"
            )
    return notes
