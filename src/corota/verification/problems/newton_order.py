"""Newton's method converges quadratically for every element, local strain and follower pressure.

Cook's membrane under a shear of 0.3 in two increments: the observed order of the last corrections,
log(e1 / size) / log(e0 / size), is two where e1 = e0^2 / size. A strip under a follower pressure,
whose tangent is not symmetric, is measured too.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import corota as ct
from corota.verification.catalogue import Problem, Value
from corota.verification.models import ELEMENTS, Watch, cell, cook, run

BOUND = 1.8
LENGTH = 10.0


def order(element: str, strain: Any) -> float:
    """Smallest order over the increments of Cook's membrane."""
    model, _ = cook(element, 4, force=0.3, local_strain=strain)
    watch = Watch()
    run(model, ct.Static(increments=2, tolerance=1e-12), observers=[watch])
    return float(watch.orders(LENGTH, 1e-3).min())


def pressure_order(element: str) -> float:
    """Smallest order of a strip bent by a following pressure, its ends open."""
    mesh = ct.mesh.rectangle(10.0, 1.0, 20, 2, cell(element), "alternate")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1200.0, nu=0.3))
    model.fix("left", rotation=True)
    model.pressure("bottom", 0.5)
    watch = Watch()
    run(model, ct.Static(increments=4, tolerance=1e-11), observers=[watch])
    return float(watch.orders(0.1, 1e-2).min())


def measure() -> Iterator[Value]:
    """Every element."""
    for strain in ("linear", "green_lagrange"):
        for element in ELEMENTS:
            yield Value(
                f"order, {element}, {strain}", BOUND, order(element, strain), 0.0, "at least"
            )
    for element in ELEMENTS:
        yield Value(
            f"order with a following pressure, {element}",
            BOUND,
            pressure_order(element),
            0.0,
            "at least",
        )


PROBLEM = Problem(
    title="Order of Newton's method",
    group="properties of the method",
    source="quadratic convergence of Newton's method with the exact tangent",
    certainty="analytic",
    why="0.2 below two, measured where corrections are small and above rounding",
    seconds=2.5,
)
