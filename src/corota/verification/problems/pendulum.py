"""Pendulum: a slender uniform rod released from the horizontal has the period of the rigid rod.

Length 1, depth 0.02, g = 9.81, E = 1e7, nu = 0, unit density, pinned at its lower corner. The rigid
rod of that shape has the period 4 K(m) sqrt(2 R / (3 g)), R being the diagonal and K the complete
elliptic integral; the energy is measured over the swing. A point mass on a bar of the same length
swings with 4 K(1/2) sqrt(1 / g) = 2.367841948.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.special import ellipk

import corota as ct
from corota.verification.beam_models import polyline
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value, zero
from corota.verification.models import cell, run
from corota.verification.motion_models import column

LENGTH, DEPTH, GRAVITY = 1.0, 0.02, 9.81
#: Period of a point mass on a rigid rod of this length [time].
MASS_PERIOD = float(4.0 * ellipk(0.5) * np.sqrt(LENGTH / GRAVITY))
#: Angle of the center above the pin's level at the start, from hanging.
START = 0.5 * np.pi + np.arctan(DEPTH / LENGTH)
PERIOD = float(
    4.0
    * ellipk(np.sin(0.5 * START) ** 2)
    * np.sqrt(2.0 * np.hypot(LENGTH, DEPTH) / (3.0 * GRAVITY))
)


def pendulum(element: str) -> ct.Model:
    """The rod pinned at its lower left corner."""
    model = ct.Model(ct.mesh.rectangle(LENGTH, DEPTH, nx=10, ny=1, cell=cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=1e7, nu=0.0, rho=1.0))
    model.fix([int(np.argmin(np.hypot(*model.mesh.points.T)))])
    model.gravity(y=-GRAVITY)
    return model


def swing(element: str, periods: float = 1.6, per_period: int = 200, **keys: Any) -> ct.Results:
    """Swing with the energy-momentum scheme."""
    step = ct.Dynamic(
        period=periods * PERIOD,
        increments=round(periods * per_period),
        scheme="energy_momentum",
        tolerance=1e-10,
    )
    return run(pendulum(element), step, **keys)


def tip(results: ct.Results) -> tuple[np.ndarray, np.ndarray]:
    """Time and position x of the end."""
    nodes = results.mesh.nodes_of("right")
    x = np.array([LENGTH + f.U[nodes, 0].mean() for f in results.frames])
    return np.array([f.time for f in results.frames]), x


def period(results: ct.Results) -> float:
    """Twice the time between two passages through the middle."""
    return crossings(*tip(results))


def crossings(time: np.ndarray, x: np.ndarray) -> float:
    """Twice the time between two passages through x = 0."""
    k = np.flatnonzero(x[:-1] * x[1:] <= 0.0)
    at = time[k] + (time[k + 1] - time[k]) * x[k] / (x[k] - x[k + 1])
    return float(2.0 * np.diff(at).mean())


def on_a_bar() -> float:
    """Period of a point mass on a bar of length 1 that is released horizontally."""
    model = ct.Model(polyline([[0.0, 0.0], [LENGTH, 0.0]]))
    model.truss([0], material=ct.Elastic(E=1e6, nu=0.0, rho=1e-6), area=1.0)
    model.point_mass([1], 1.0)
    model.fix([0])
    model.force([1], y=-GRAVITY)
    step = ct.Dynamic(
        period=1.6 * MASS_PERIOD, increments=640, scheme="energy_momentum", tolerance=1e-10
    )
    frames = run(model, step).frames
    time = np.array([f.time for f in frames])
    return crossings(time, np.array([LENGTH + f.U[1, 0] for f in frames]))


def measure() -> Iterator[Value]:
    """Period and energy."""
    for element in ("Q4I", "Q4D", "OPT"):
        results = swing(element)
        yield Value(f"period, {element}", PERIOD, period(results), 2e-3)
        kinetic = float(column(results, "kinetic energy").max())
        drift = float(np.ptp(column(results, "energy balance"))) / kinetic
        yield zero(f"drift of the energy, {element}", drift, 1e-8)
    yield Value("period, point mass on a bar", MASS_PERIOD, on_a_bar(), 1e-3)


def curve() -> Curve:
    """Position of the end."""
    time, x = tip(swing("Q4D"))
    return Curve(
        "time",
        "x of the end",
        {"Q4D": (time, x)},
        {"a quarter and three of the rigid period": ([PERIOD / 4, 3 * PERIOD / 4], [0.0, 0.0])},
    )


def study() -> Study:
    """Error of the period against increments a period."""
    return Study.over(
        "error of the period, down to the flexibility",
        ("Q4I",),
        (100, 200, 400),
        lambda e, n: abs(period(swing(e, 1.6, n)) / PERIOD - 1.0),
        "increments a period",
    )


PROBLEM = Problem(
    title="Pendulum",
    group="dynamics",
    source="complete elliptic integral of the physical pendulum",
    certainty="analytic",
    why="flexibility of the rod and 200 increments a period",
    picture=lambda: Picture(swing("Q4D", 0.2, fields=True), "U2"),
    seconds=6.0,
)
