"""A flexible block in free flight with spin: momenta and energy over a hundred increments.

4 x 1, E = 10000, nu = 0.3, unit density, spinning at 1 and moving at 0.3 without supports. The
energy-momentum scheme conserves linear momentum, angular momentum and energy to rounding, for every
element, local strain and mass, while energy is exchanged between motion and strain. The trapezoidal
rule loses angular momentum, as expected.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value, zero
from corota.verification.models import ELEMENTS, run
from corota.verification.motion_models import column, flyer


@cache
def solved(
    element: str,
    strain: Any = "linear",
    mass: Any = "consistent",
    scheme: Any = "energy_momentum",
    **keys: Any,
) -> ct.Results:
    """Fly for two units of time."""
    step = ct.Dynamic(period=2.0, increments=40, scheme=scheme, mass=mass, tolerance=1e-11)
    return run(flyer(element, strain), step, **keys)


def drift(results: ct.Results) -> tuple[float, float, float]:
    """Change of linear and angular momentum and of the energy balance, over their sizes."""
    kinetic = float(column(results, "kinetic energy").max())
    linear = max(float(np.ptp(column(results, f"momentum {a}"))) for a in "xy") / kinetic
    angular = column(results, "angular momentum")
    energy = float(np.ptp(column(results, "energy balance"))) / kinetic
    return linear, float(np.ptp(angular) / np.abs(angular).max()), energy


def measure() -> Iterator[Value]:
    """Drifts of all elements, and of the trapezoidal rule."""
    cases: list[tuple[str, Any, Any]] = [(e, "linear", "consistent") for e in ELEMENTS]
    cases += [
        (e, "green_lagrange", m)
        for e in ("Q4I", "Q8", "Q4D", "OPT")
        for m in ("constant", "lumped")
    ]
    for element, strain, mass in cases:
        values = drift(solved(element, strain, mass))
        text = f"{element}, {strain}, {mass} mass"
        for name, value, bound in zip(
            ("linear momentum", "angular momentum", "energy"),
            values,
            (1e-12, 1e-12, 1e-11),
            strict=True,
        ):
            yield zero(f"drift of the {name}, {text}", value, bound)
    exchange = float(np.ptp(column(solved("Q4I"), "kinetic energy")))
    yield Value("energy exchanged between motion and strain, Q4I", 1e-5, exchange, 0.0, "at least")
    lost = drift(solved("Q4I", scheme="newmark"))[1]
    yield Value("angular momentum that the trapezoidal rule loses", 1e-6, lost, 0.0, "at least")


def curve() -> Curve:
    """Angular momentum of two schemes."""
    series = {}
    for scheme in ("energy_momentum", "newmark"):
        values = column(solved("Q4I", scheme=scheme), "angular momentum")
        series[scheme] = (np.linspace(0.05, 2.0, len(values)), values / values[0] - 1.0)
    return Curve("time", "change of the angular momentum", series)


PROBLEM = Problem(
    title="Free flight: momenta and energy",
    group="dynamics",
    source="conservation laws; J. C. Simo, N. Tarnow, Z. Angew. Math. Phys. 43 (1992)",
    certainty="analytic",
    why="rounding and Newton's tolerance of 1e-11",
    picture=lambda: Picture(solved("Q4I", fields=True), "MISES"),
    seconds=4.0,
)
