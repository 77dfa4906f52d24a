"""A ring, elastic or plastic, hits a rigid wall: balances of energy and momentum.

Outer radius 1, wall 0.1, E = 10000, nu = 0.3, unit density, speed 2 (yielding: yield stress 60,
hardening 200, speed 1). There is no formula. Kinetic, strain and plastic energy must add up to the
initial energy, there is no force along the wall, and the impulse of the wall equals the change of
momentum; the errors vanish with the increments. Energy-momentum scheme, contact by multipliers.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from corota.verification.catalogue import Curve, Picture, Problem, Study, Value, zero
from corota.verification.impact_models import Flight, fly

AROUND = 24
#: Element, whether it yields, and increments: fixed, or 0 for automatic ones.
CASES = [("Q4I", False, 200), ("Q4I", True, 0), ("Q4D", True, 0)]


@cache
def flown(element: str, plastic: bool, increments: int = 0, tolerance: float = 2e-3) -> Flight:
    """One impact."""
    return fly(
        element,
        plastic=plastic,
        speed=1.0 if plastic else 2.0,
        around=AROUND,
        period=1.0 if plastic else 0.8,
        increments=increments,
        tolerance=tolerance,
    )


def impulse(flight: Flight) -> float:
    """Momentum that the wall gave, over that at the start."""
    history, results = flight.history, flight.results
    assert results is not None
    step = np.diff(history["time"], prepend=0.0)
    start = results.frames[-1].scalars["momentum y"] / flight.rebound
    return float((history["force"] * step).sum() / start)


def measure() -> Iterator[Value]:
    """Energies and momenta."""
    for element, plastic, increments in CASES:
        flight = flown(element, plastic, increments)
        text = f"{'yielding' if plastic else 'elastic'}, {element}"
        yield zero(
            f"largest energy-balance error, {text}", flight.energy_error, 0.03 if plastic else 2e-4
        )
        yield zero(f"momentum along the wall, {text}", flight.sideways, 1e-9)
        yield Value(
            f"momentum that the wall gave, {text}", 1.0 + flight.rebound, impulse(flight), 1e-8
        )
        yield Value(f"velocity of the rebound at most, {text}", 1.0, flight.rebound, 0.0, "at most")
    slow, fast = flown("Q4I", True, 0, 8e-3).energy_error, flown("Q4I", True).energy_error
    yield Value(
        "energy-balance error with finer increments over that before",
        0.7,
        fast / slow,
        0.0,
        "at most",
    )


def picture() -> Picture:
    """The ring that has yielded."""
    results = flown("Q4I", True).results
    assert results is not None
    return Picture(results, "PEEQ")


def curve() -> Curve:
    """Energies of the ring that yields."""
    history = flown("Q4I", True).history
    total = history["kinetic"] + history["strain"] + history["plastic"]
    series = {n: (history["time"], history[n]) for n in ("kinetic", "strain", "plastic")}
    return Curve("time", "energy / that of the start", {**series, "sum": (history["time"], total)})


def study() -> Study:
    """Energy-balance error against the error that increments may make."""
    sizes = (8e-3, 2e-3, 5e-4)
    return Study(
        "energy-balance error of the yielding ring",
        {
            e: ([1.0 / s for s in sizes], [flown(e, True, 0, s).energy_error for s in sizes])
            for e in ("Q4I", "Q4D")
        },
        "1 / tolerance of the increments",
    )


PROBLEM = Problem(
    title="Ring against a wall",
    group="contact",
    source="balance of energy and momentum",
    certainty="analytic",
    why="yielding: plastic work uses the stress at the end of the increment, a first-order error",
    picture=picture,
    seconds=7.0,
)
