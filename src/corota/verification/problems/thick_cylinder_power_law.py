"""Thick cylinder of a Ramberg-Osgood material under inner pressure, plane strain.

Radii 100 and 200, E = 210000, yield stress 240, offset 3/7. Without change of volume the radial
displacement is C / r, whatever the law, and the equivalent strain 2 C / (sqrt(3) r^2) gives the
equivalent stress q. Equilibrium, dp = 2 q / (sqrt(3) r) dr, is integrated over q: with
m = n - 1 and k(q) = offset (q / yield stress)^m,

    p = 1 / sqrt(3) [n q - m q F(1, 1/m; 1 + 1/m; -k(q))] from q(outer) to q(inner),

F Gauss's hypergeometric function (an arc tangent for n = 3). Where k is large this is the power
law's p = n / sqrt(3) (q(inner) - q(outer)). It is met with nu = 0.4999.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.special import hyp2f1

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.problems.thick_cylinder_plastic import (
    ELEMENTS,
    INNER,
    OUTER,
    YIELD,
    YOUNG,
    ring,
)

OFFSET, NU = 3.0 / 7.0, 0.4999
#: Exponents, and the equivalent strain at the inner radius over the yield strain.
CASES = [(3.0, 4.0), (10.0, 4.0), (10.0, 20.0)]
CELLS = (3, 6, 12, 24)


def law(exponent: float) -> ct.RambergOsgood:
    """The material of the cylinder."""
    return ct.RambergOsgood(E=YOUNG, nu=NU, yield_stress=YIELD, exponent=exponent, offset=OFFSET)


def exact(exponent: float, strain: float) -> tuple[float, float, float]:
    """Pressure, outer displacement and equivalent stress at the inner radius.

    Parameters
    ----------
    strain : float
        Equivalent strain at the inner radius over the yield strain.
    """
    inner = strain * YIELD / YOUNG
    ends = law(exponent).uniaxial(np.array([inner * (INNER / OUTER) ** 2, inner]))
    m = exponent - 1.0
    k = OFFSET * (ends / YIELD) ** m
    sums = exponent * ends - m * ends * hyp2f1(1.0, 1.0 / m, 1.0 + 1.0 / m, -k)
    pressure = float(np.diff(sums)[0]) / math.sqrt(3.0)
    return pressure, 0.5 * math.sqrt(3.0) * inner * INNER**2 / OUTER, float(ends[1])


def measure() -> Iterator[Value]:
    """Outer displacement for each exponent and element; stress at the inner radius."""
    for element, options in ELEMENTS.items():
        for exponent, strain in CASES:
            pressure, outer, _ = exact(exponent, strain)
            found = ring(element, 12, "strain", law(exponent), pressure, **options)[1]
            name = f"outer displacement, n = {exponent:g}, {strain:g} yield strains, {element}"
            yield Value(f"{name} 12 x 24", outer, found, 1e-3 if element == "Q8R" else 0.015)
    for exponent, strain in CASES:
        pressure, _, stress = exact(exponent, strain)
        results = ring("Q8R", 24, "strain", law(exponent), pressure)[0]
        found = float(results.nodal("MISES")[results.mesh.nodes_of("inner")].mean())
        name = f"equivalent stress inside, n = {exponent:g}, {strain:g} yield strains"
        yield Value(f"{name}, Q8R 24 x 48", stress, found, 5e-3)


def picture() -> Picture:
    """Equivalent stress at the largest pressure."""
    exponent, strain = CASES[-1]
    pressure = exact(exponent, strain)[0]
    return Picture(ring("Q8R", 12, "strain", law(exponent), pressure)[0], "MISES", 5.0)


def study() -> Study:
    """Error of the outer displacement for the exponent 10 and 20 yield strains."""
    pressure, outer, _ = exact(*CASES[-1])
    material = law(CASES[-1][0])
    return Study.over(
        "error of the outer displacement",
        ELEMENTS,
        CELLS,
        lambda e, n: abs(ring(e, n, "strain", material, pressure, **ELEMENTS[e])[1] / outer - 1.0),
        "cells across",
    )


PROBLEM = Problem(
    title="Thick cylinder of a power-law material (Ramberg and Osgood)",
    group="plasticity",
    source="equilibrium of C / r integrated over the equivalent stress (see the description)",
    certainty="analytic",
    why="the volume changes a little (nu = 0.4999), and the displacement grows with the n-th power "
    "of the pressure: an error of stress counts n times",
    picture=picture,
    seconds=4.0,
)
