"""Strip with a hole of half its width, plastic tension in plane stress.

A quarter, 10 x 18 with a hole of radius 5, E = 70000, nu = 0.2, yield stress 243. Without hardening
the limit load is yield stress times ligament: no stress field carries more, and a uniform stress on
the ligament carries that. With a hardening of 2240 and the top displaced by 0.3, with large
displacement, the force for a thickness of 0.01 is compared with CalculiX on nearly the same meshes;
its elements are layers of bricks with a different strain measure.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value, zero
from corota.verification.models import run
from corota.verification.plastic_models import find, perforated_strip

LIMIT = 243.0 * 5.0
#: Element, cells along an eighth of the hole, CalculiX's force with the like element.
HARDENING = [("Q8", 5, 16.7764), ("Q8", 15, 16.7656)]


@cache
def limit(element: str, n: int, pull: float = 0.3) -> ct.Results:
    """Perfectly plastic, small displacements, thickness 1."""
    law = ct.Mises(E=70000.0, nu=0.2, yield_stress=243.0)
    model = perforated_strip(element, n, law, pull, thickness=1.0)
    return run(model, ct.Static(nlgeom=False, increments=10), fields=True)


@cache
def hardened(element: str, n: int) -> ct.Results:
    """With hardening, large displacement, twenty increments."""
    model = perforated_strip(element, n, local_strain="logarithmic")
    return run(model, ct.Static(increments=20))


def force(results: ct.Results) -> np.ndarray:
    """Force at the top in each frame."""
    top = find(results.mesh, 1, 18.0)
    return np.array([f.RF[top, 1].sum() for f in results.frames])


def measure() -> Iterator[Value]:
    """Limit load; force with hardening."""
    for element, n, tolerance in (
        ("Q8R", 6, 0.006),
        ("Q8", 6, 0.01),
        ("Q4I", 10, 0.01),
        ("Q4D", 12, 0.025),
        ("OPT", 12, 0.03),
    ):
        found = force(limit(element, n))
        yield Value(
            f"limit load / (yield stress x ligament), {element}, n = {n}",
            1.0,
            found[-1] / LIMIT,
            tolerance,
        )
        yield zero(
            f"growth over the last tenth of the pull, {element}",
            found[-1] / np.interp(0.9, factors(limit(element, n)), found) - 1.0,
            2e-3,
        )
    for element, n, peer in HARDENING:
        yield Value(
            f"force with hardening at 0.3, {element}, n = {n}",
            peer,
            force(hardened(element, n))[-1],
            0.005,
        )


def factors(results: ct.Results) -> np.ndarray:
    """Share of the pull in each frame."""
    return np.array([f.factor for f in results.frames])


def curve() -> Curve:
    """Force over the limit load against the pull."""
    series = {}
    for element, n in (("Q8R", 6), ("Q4D", 12)):
        results = limit(element, n)
        series[f"{element}, n = {n}"] = (0.3 * factors(results), force(results) / LIMIT)
    return Curve("pull", "force / (yield stress x ligament)", series, {"limit": ([0.3], [1.0])})


def study() -> Study:
    """Error of the limit load."""
    return Study.over(
        "error of the limit load",
        ("Q4I", "Q8R", "Q8", "Q4D", "OPT"),
        (3, 6, 12),
        lambda e, n: abs(force(limit(e, n))[-1] / LIMIT - 1.0),
        "cells along an eighth of the hole",
    )


PROBLEM = Problem(
    title="Perforated strip",
    group="plasticity",
    source="theorems of limit analysis; CalculiX 2.20 for the force with hardening",
    certainty="computed independently",
    why="from above with the mesh; a layer of bricks with another strain is half a percent stiffer",
    picture=lambda: Picture(limit("Q8R", 12), "PEEQ"),
    seconds=2.0,
)
