"""Deep double-notched bar in plane strain tension, perfectly plastic: the limit load.

``(2 + pi) / sqrt(3)`` times the yield stress on the ligament (Prandtl). Standard full-integration
elements lock and never reach a limit; those used here do not. E = 206900, nu = 0.29, yield stress
450.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.models import run
from corota.verification.plastic_models import find, notched

LIMIT = (2.0 + np.pi) / 3.0**0.5
#: Element, mean dilatation, cells on the ligament, pull, tolerance.
CASES = [
    ("Q4", True, 8, 0.15, 0.01),
    ("Q4D", True, 12, 0.15, 0.01),
    ("Q8", False, 8, 0.15, 0.01),
    ("Q8R", False, 8, 0.2, 0.013),
    ("Q4I", False, 8, 0.15, 0.01),
]


def solved(
    element: str, mean: bool, n: int, pull: float, **keys: Any
) -> tuple[ct.Results, np.ndarray]:
    """Path, and the mean stress on the ligament over the yield stress in each frame."""
    model = notched(element, n, pull, mean_dilatation=mean)
    results = run(model, ct.Static(nlgeom=False, increments=10), **keys)
    top = find(model.mesh, 1, 15.0)
    return results, np.array([f.RF[top, 1].sum() / 450.0 for f in results.frames])


def measure() -> Iterator[Value]:
    """Limit load of each element."""
    for element, mean, n, pull, tolerance in CASES:
        yield Value(
            f"limit stress / yield stress, {element}, {n} cells on the ligament",
            LIMIT,
            solved(element, mean, n, pull)[1][-1],
            tolerance,
        )


def curve() -> Curve:
    """Stress against pull: one element that locks and two that do not."""
    series = {}
    for label, element, mean in (
        ("Q4, locks", "Q4", False),
        ("Q4 with mean dilatation", "Q4", True),
        ("Q4I", "Q4I", False),
    ):
        results, stress = solved(element, mean, 8, 0.15)
        series[label] = ([0.15 * f.factor for f in results.frames], stress)
    return Curve(
        "pull", "stress on the ligament / yield stress", series, {"limit": ([0.15], [LIMIT])}
    )


PROBLEM = Problem(
    title="Double-notched bar: a limit load without locking",
    group="plasticity",
    source="J. C. Nagtegaal, D. M. Parks, J. R. Rice, Comput. Methods Appl. Mech. Engrg 4 (1974)",
    certainty="analytic",
    why="one percent on eight cells across the ligament, approached from above with the mesh",
    picture=lambda: Picture(solved("Q8R", False, 8, 0.2, fields=True)[0], "PEEQ"),
    seconds=6.0,
)
