"""Thrown bodies: an L-shaped block that tumbles and a slender rod, after a pulse on one end.

A block of legs 4 x 1 and 1 x 3 and a rod 10 x 0.3 (E = 20000, nu = 0.3, unit density) are loaded
for half a unit of time at one end and then fly freely, the rod with bending vibrations. From then
on linear momentum, angular momentum and energy must be constant, as they are with the
energy-momentum scheme. The HHT scheme loses angular momentum and energy slowly; its rates are
given.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value, zero
from corota.verification.motion_models import PULSE, block, drift, fly, rod

BODIES = {"block": block, "rod": rod}
CASES = [("block", "Q4I"), ("block", "Q4D"), ("block", "OPT"), ("rod", "Q4D"), ("rod", "OPT")]


@cache
def flown(body: str, element: str, scheme: str = "energy_momentum") -> ct.Results:
    """Five units of time in 250 increments."""
    return fly(BODIES[body](element), scheme=scheme)


def measure() -> Iterator[Value]:
    """Drifts of both bodies; rates of HHT."""
    for body, element in CASES:
        for name, value in drift(flown(body, element)).items():
            yield zero(f"drift of the {name}, {body}, {element}", value, 1e-9)
    push = flown("block", "Q4I").frames[-1].scalars
    # The pulse is sin^2: half of its height times its length, over a side of 1.
    for axis, force in (("x", 10.0), ("y", 30.0)):
        yield Value(
            f"momentum {axis} of the block", 0.5 * PULSE * force, push[f"momentum {axis}"], 1e-9
        )
    lost = drift(flown("block", "Q4I", "hht"))
    yield Value(
        "angular momentum that HHT loses at least", 1e-6, lost["angular momentum"], 0.0, "at least"
    )
    yield Value(
        "angular momentum that HHT loses at most", 1e-2, lost["angular momentum"], 0.0, "at most"
    )
    yield zero("linear momentum that HHT loses", lost["momentum x"], 1e-9)


def curve() -> Curve:
    """Angular momentum of the block over that after the pulse, less one."""
    series = {}
    for scheme in ("energy_momentum", "hht"):
        late = [f for f in flown("block", "Q4I", scheme).frames if f.time > PULSE + 1e-9]
        value = np.array([f.scalars["angular momentum"] for f in late])
        series[scheme] = ([f.time for f in late], value / value[0] - 1.0)
    return Curve("time", "change of the angular momentum", series)


PROBLEM = Problem(
    title="Tumbling block and thrown rod",
    group="dynamics",
    source="conservation laws; J. C. Simo, N. Tarnow, Z. Angew. Math. Phys. 43 (1992)",
    certainty="analytic",
    why="Newton's tolerance of 1e-11 over 250 increments",
    picture=lambda: Picture(flown("block", "Q4I"), "MISES"),
    seconds=3.0,
)
