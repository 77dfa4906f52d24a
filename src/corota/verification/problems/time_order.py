"""Order of the time integration schemes on a strip under a smooth load pulse.

4 x 0.5, E = 10000, nu = 0.3, unit density, clamped left, gravity of 8 times sin^4(pi t): smooth, so
that no unresolved mode is excited. The displacements at t = 1 with 50, 100 and 200 increments give
the order, which is two for every scheme.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.model.schemes import names
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import run

#: Explicit steps have increments of their own.
SCHEMES = tuple(name for name in names() if name != "central_difference")


def solved(scheme: Any, n: int, **keys: Any) -> ct.Results:
    """The strip after one unit of time in `n` increments."""
    time = np.linspace(0.0, 1.0, 2001)
    model = ct.Model(ct.mesh.rectangle(4.0, 0.5, nx=8, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.fix("left")
    model.amplitudes["wave"] = ct.Amplitude(time, np.sin(np.pi * time) ** 4)
    model.gravity(y=-8.0, amplitude="wave")
    step = ct.Dynamic(period=1.0, increments=n, scheme=scheme, tolerance=1e-12)
    return run(model, step, **keys)


def differences(scheme: str, counts: tuple[int, ...]) -> list[float]:
    """Largest change of the displacements from each number of increments to the next."""
    ends = [solved(scheme, n).frames[-1].U for n in counts]
    return [float(np.abs(a - b).max()) for a, b in zip(ends, ends[1:], strict=False)]


def measure() -> Iterator[Value]:
    """Order of every scheme."""
    for scheme in SCHEMES:
        first, second = differences(scheme, (50, 100, 200))
        yield Value(f"order of {scheme}", 1.9, float(np.log2(first / second)), 0.0, "at least")


def study() -> Study:
    """Differences of successive numbers of increments."""
    counts = (25, 50, 100, 200, 400)
    return Study(
        "change when the increment is halved",
        {s: ([float(n) for n in counts[1:]], differences(s, counts)) for s in SCHEMES},
        "increments",
    )


PROBLEM = Problem(
    title="Order of the time integration",
    group="properties of the method",
    source="schemes of second order: N. M. Newmark (1959); H. M. Hilber, T. J. R. Hughes, R. L. "
    "Taylor (1977); W. L. Wood, M. Bossak, O. C. Zienkiewicz (1981); J. Chung, G. M. Hulbert "
    "(1993); J. C. Simo, N. Tarnow (1992)",
    certainty="analytic",
    why="0.1 below two on the finest pair",
    picture=lambda: Picture(solved("newmark", 50, fields=True), "U2"),
    seconds=4.0,
)
