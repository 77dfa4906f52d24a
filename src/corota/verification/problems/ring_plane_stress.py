"""Ring of perfectly plastic material under inner pressure in plane stress (Nadai).

Radii 100 and 200, E = 210000, nu = 0.3, yield stress 240, plastic up to radius 140. In the plastic
part the stresses ``s_r = 2/sqrt3 sy cos(w + pi/6)``, ``s_t = 2/sqrt3 sy cos(w - pi/6)`` satisfy the
yield condition, and equilibrium gives ``r^2 sin(w) exp(sqrt3 w) = const``; outside Lame's holds.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.optimize import brentq

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value, zero
from corota.verification.problems.thick_cylinder_plastic import (
    INNER,
    OUTER,
    YIELD,
    YOUNG,
    perfect,
    ring,
)

ELEMENTS = ("Q4I", "Q8", "Q8R", "Q4D", "OPT", "T6")
FRONT = 140.0


def nadai(c: float) -> tuple[float, float, Callable[[float], float]]:
    """Inner pressure, outer displacement, and the radial stress as a function of the radius."""
    k = (OUTER / c) ** 2
    big = YIELD / np.sqrt(1 + 3 * k**2)
    w_c = np.arctan(np.sqrt(3) * k)

    def constant(r: float, w: float) -> float:
        return float(r**2 * np.sin(w) * np.exp(np.sqrt(3) * w))

    def radial(r: float) -> float:
        if r >= c:
            return float(big * (1 - (OUTER / r) ** 2))
        # The branch on which the circumferential stress falls inwards.
        w = brentq(lambda w: constant(r, w) - constant(c, w_c), w_c, 5 * np.pi / 6)
        return float(2 / np.sqrt(3) * YIELD * np.cos(w + np.pi / 6))

    return -radial(INNER), float(2 * big * OUTER / YOUNG), radial


def radial_stress(results: ct.Results) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Radius, radial stress and volume of the points."""
    fields = results.frames[-1].fields[0]
    x, s = fields.points.reshape(-1, 2), fields.values["S"].reshape(-1, 4)
    r = np.linalg.norm(x, axis=1)
    cos, sin = (x / r[:, None]).T
    mine = cos**2 * s[:, 0] + sin**2 * s[:, 1] + 2 * cos * sin * s[:, 3]
    return r, mine, fields.volume.ravel()


def measure() -> Iterator[Value]:
    """Outer displacement, and the mean error of the radial stress."""
    p, u, radial = nadai(FRONT)
    for element in ELEMENTS:
        results, found = ring(element, 12, "stress", perfect(0.3), p)
        yield Value(f"outer displacement, {element} 12 x 24", u, found, 0.01)
        r, mine, size = radial_stress(results)
        exact = np.array([radial(float(v)) for v in r])
        error = float(np.sqrt(size @ (mine - exact) ** 2 / size.sum())) / YIELD
        yield zero(f"mean error of the radial stress / yield stress, {element}", error, 0.04)


def curve() -> Curve:
    """Radial stress over the radius."""
    p, _, radial = nadai(FRONT)
    r, mine, _ = radial_stress(ring("Q8", 6, "stress", perfect(0.3), p)[0])
    line = np.linspace(INNER, OUTER, 60)
    return Curve(
        "radius",
        "radial stress",
        {"Nadai": (line, [radial(float(v)) for v in line])},
        {"points of Q8 6 x 12": (r, mine)},
    )


PROBLEM = Problem(
    title="Ring beyond yield in plane stress (Nadai)",
    group="plasticity",
    source="A. Nadai, Theory of Flow and Fracture of Solids (1950)",
    certainty="analytic",
    why="the plastic front passes through cells of 1/12 of the width",
    picture=lambda: Picture(
        ring("Q8", 12, "stress", perfect(0.3), nadai(FRONT)[0])[0], "PEEQ", 100.0
    ),
    seconds=2.0,
)
