"""Elastic bar against a rigid wall: one contact of duration 2 L / c, then rebound.

Length 10, E = 900, unit density and section, nu = 0, speed 0.1: waves run at c = 30, the bar is in
contact for 0.6667 under the force rho c A v = 3, is 1/30 shorter when the wave reaches its free
end, and leaves with its initial velocity. Steel (210 GPa, 7850 kg/m^3, 1 m, 1 cm^2, 10 m/s: 386.7
us, 40.6 kN, which is 406 MPa) and the unit bar (2, 0.1) follow by scaling. A contact force on nodes
with mass creates energy and chatters; here the mass of the contact nodes is redistributed. Two
hundred cells along the bar, increments of half the time that a wave takes through one. The rebound
stays 0.1 to 0.5 % slow on every mesh: the missing energy remains in waves.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from corota.verification.catalogue import Curve, Picture, Problem, Study, Value
from corota.verification.impact_models import Impact, bar, strike

#: Element, scheme and cells along the bar.
CASES = [
    ("Q4I", "hht", 200),
    ("Q4I", "energy_momentum", 200),
    ("Q8", "hht", 100),
    ("OPT", "hht", 100),
    ("Q4D", "hht", 100),
]


@cache
def struck(element: str, scheme: str, cells: int, redistribute: bool = True) -> Impact:
    """One impact."""
    return strike(element, scheme, cells=cells, redistribute=redistribute)


def measure() -> Iterator[Value]:
    """Contacts, duration, force, shortening, rebound, energy, each over its exact value."""
    for element, scheme, cells in CASES:
        hit = struck(element, scheme, cells)
        text = f"{element} {cells} x 1, {scheme}"
        coarse = 200 / cells
        yield Value(f"contacts, {text}", 1, hit.contacts, 0.0, "absolute")
        yield Value(f"duration of the contact, {text}", 1.0, hit.duration, 0.01 * coarse)
        yield Value(f"mean force, {text}", 1.0, hit.mean_force, 0.01 * coarse)
        yield Value(f"largest shortening, {text}", 1.0, hit.shortening, 0.01 * coarse)
        yield Value(f"velocity of the rebound, {text}", 1.0, hit.rebound, 0.01 * coarse)
        yield Value(f"energy at the end, {text}", 1.0, hit.energy, 0.01)
    kept = struck("Q4I", "newmark", 50, redistribute=False)
    yield Value("contacts with the mass kept, Q4I 50 x 1", 5, kept.contacts, 0.0, "at least")
    yield Value("energy at the end with the mass kept", 1.5, kept.energy, 0.0, "at least")


def curve() -> Curve:
    """Force on the wall."""
    series = {}
    for element, scheme in (("Q4I", "hht"), ("Q4I", "energy_momentum")):
        time, force, _ = struck(element, scheme, 200).history.T
        series[f"{element}, {scheme}"] = (time, force)
    return Curve(
        "time / (2 L / c)",
        "force / (rho c A v)",
        {**series, "exact": ([0.0, 0.0, 1.0, 1.0, 1.3], [0.0, 1.0, 1.0, 0.0, 0.0])},
    )


def study() -> Study:
    """Error of the shortening with cells and increments together."""
    return Study.over(
        "error of the largest shortening",
        ("Q4I", "Q4D"),
        (25, 50, 100, 200),
        lambda e, n: abs(struck(e, "hht", n).shortening - 1.0),
        "cells along the bar",
    )


PROBLEM = Problem(
    title="Bar against a wall",
    group="contact",
    source="d'Alembert's waves in a bar: S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, "
    "section 168",
    certainty="analytic",
    why="1 % with 200 cells, twice that with 100: the wave fronts spread over several cells",
    picture=lambda: Picture(bar("Q4I", 20)),
    seconds=12.0,
)
