"""Euler's column: buckling load, higher modes, bifurcation on the path and post-buckling.

A cantilever column 100 x 2 with E = 1000, nu = 0. The buckling load with shear is Engesser's; the
second and third are 9 and 25 times the first. The path bifurcates there; its branch follows the
elastica under an axial load.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any, Literal

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value
from corota.verification.frame_models import column, euler_load
from corota.verification.models import nearest, run

ELEMENTS = {"Q8": 2e-3, "Q9": 2e-3, "Q4I": 2e-3, "Q4D": 5e-3, "OPT": 5e-3}


def elastica(load: float) -> tuple[float, float]:
    """Deflection and shortening over length of a cantilever column; load over Euler's."""
    k = brentq(lambda k: (2.0 / np.pi * ellipk(k * k)) ** 2 - load, 1e-9, 1.0 - 1e-9)
    return float(2.0 * k / ellipk(k * k)), float(2.0 - 2.0 * ellipe(k * k) / ellipk(k * k))


@cache
def solved(side: Literal[1, -1] = 1, **keys: Any) -> tuple[ct.Results, int]:
    """Along the axis, through the bifurcation and off to one side; with the tip."""
    model = column("Q8", n=40)
    tip = nearest(model.mesh, 100.0, 1.0)
    path = ct.ArcLength(displacement=([tip], "y", 70.0 * side), switch=True, side=side)
    return run(model, ct.Static(path=path), **keys), tip


def measure() -> Iterator[Value]:
    """Eigenvalues, the bifurcation and the last state of the branch."""
    for element, tolerance in ELEMENTS.items():
        factors = run(column(element, n=80), ct.Buckle(modes=3)).modes[0].factors
        yield Value(f"buckling load, {element} 80 x 2", euler_load(), factors[0], tolerance)
        for k in (1, 2):
            yield Value(
                f"mode {k + 1} over the first, {element}",
                (2 * k + 1) ** 2,
                factors[k] / factors[0],
                5e-3,
            )
    results, tip = solved()
    critical = results.critical_points[0]
    linear = run(column("Q8", n=40), ct.Buckle()).modes[0].factors[0]
    yield Value("bifurcation on the path, against linear buckling", linear, critical.factor, 2e-4)
    last = results.frames[-1]
    deflection, shortening = elastica(last.factor / critical.factor)
    yield Value("deflection of the branch at its end", 100.0 * deflection, last.U[tip, 1], 5e-3)
    yield Value("shortening there", 100.0 * shortening, -last.U[tip, 0], 2e-2)


def curve() -> Curve:
    """Load against deflection beside the elastica."""
    results, tip = solved()
    first = results.critical_points[0].factor
    loads = np.linspace(1.001, 1.4, 12)
    exact = [100.0 * elastica(p)[0] for p in loads]
    return Curve(
        "deflection of the tip",
        "load over that of buckling",
        {
            "Q8 40 x 2": (
                [float(f.U[tip, 1]) for f in results.frames],
                [f.factor / first for f in results.frames],
            )
        },
        {
            "elastica": (
                [x for x in exact if x < 71.0],
                [p for p, x in zip(loads, exact, strict=True) if x < 71.0],
            )
        },
    )


def study() -> Study:
    """Error of the first load."""
    return Study.over(
        "error of the buckling load",
        ELEMENTS,
        (5, 10, 20, 40),
        lambda e, n: abs(
            float(run(column(e, n=n), ct.Buckle()).modes[0].factors[0]) / euler_load() - 1.0
        ),
        "cells along",
    )


PROBLEM = Problem(
    title="Euler's column, before and after buckling",
    group="paths and buckling",
    source="L. Euler (1744); F. Engesser's shear; the elastica in elliptic integrals, S. P. "
    "Timoshenko, J. M. Gere, Theory of Elastic Stability, section 2.7",
    certainty="analytic",
    why="shear and shortening of a column whose depth is a fiftieth of its length; drilling "
    "elements are a little soft on regular meshes",
    picture=lambda: Picture(solved(fields=True)[0], "S11"),
    seconds=0.4,
)
