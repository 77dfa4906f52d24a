"""Thick cylinder of perfectly plastic material under inner pressure, plane strain.

Radii 100 and 200, E = 210000, yield stress 240. Hill's solution, exact for incompressible material,
gives pressure and outer displacement for a plastic zone up to radius c; it is approached with nu =
0.4999, where locking elements fail. With nu = 0.3 the references are converged values.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.model.materials import Material
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import DRILLING, cell, nearest, run

INNER, OUTER, YOUNG, YIELD = 100.0, 200.0, 210000.0, 240.0
#: Elements that do not lock, with the options that keep them from it.
ELEMENTS: dict[str, dict[str, Any]] = {
    "Q4I": {},
    "Q8R": {},
    "Q4D": {"mean_dilatation": True},
    "Q4": {"mean_dilatation": True},
}
#: Pressure and outer displacement of steel, nu = 0.3.
STEEL = [(160.0, 0.111633), (180.0, 0.153985), (190.0, 0.20537)]


def ring(
    element: str, n: int, plane: Any, law: Material, p: float, **options: Any
) -> tuple[ct.Results, float]:
    """Quarter of the ring under a pressure, `n` cells across; with the outer displacement."""
    mesh = ct.mesh.annulus(INNER, OUTER, n, 2 * n, 90.0, cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=law, plane=plane, **options)
    turn = 0.0 if element in DRILLING else None
    model.fix("start", x=None, y=0.0, rotation=turn)
    model.fix("end", x=0.0, y=None, rotation=turn)
    model.pressure("inner", p)
    results = run(model, ct.Static(nlgeom=False, increments=8), fields=True)
    outer = mesh.nodes_of("outer")
    return results, float(np.linalg.norm(results.frames[-1].U[outer], axis=1).mean())


def perfect(nu: float, yield_stress: float = YIELD) -> ct.Mises:
    """The material of the ring, which does not harden."""
    return ct.Mises(E=YOUNG, nu=nu, yield_stress=yield_stress)


def hill(c: float, nu: float) -> tuple[float, float]:
    """Pressure and outer displacement of a cylinder that is plastic to radius c."""
    strength = 2.0 * YIELD / 3.0**0.5
    p = strength * (np.log(c / INNER) + 0.5 * (1.0 - (c / OUTER) ** 2))
    return float(p), float(strength * c**2 * (1.0 - nu**2) / (YOUNG * OUTER))


def measure() -> Iterator[Value]:
    """Outer displacement, for Hill's material and for steel."""
    for element, options in ELEMENTS.items():
        for c in (120.0, 160.0):
            p, exact = hill(c, 0.4999)
            yield Value(
                f"outer displacement, plastic to {c:g}, {element} 12 x 24",
                exact,
                ring(element, 12, "strain", perfect(0.4999), p, **options)[1],
                0.01,
            )
    results = ring("Q9", 24, "strain", perfect(0.3, 1e9), 1.0)[0]
    node = nearest(results.mesh, INNER, 0.0)
    yield Value(
        "pressure at first yield, Q9 24 x 48",
        103.75,
        YIELD / float(results.nodal("MISES")[node]),
        3e-3,
    )
    for p, exact in STEEL:
        yield Value(
            f"outer displacement at {p:g}, nu = 0.3, Q8R 12 x 24",
            exact,
            ring("Q8R", 12, "strain", perfect(0.3), p)[1],
            3e-3,
        )


def study() -> Study:
    """Error of the outer displacement at c = 160."""
    p, exact = hill(160.0, 0.4999)
    return Study.over(
        "error of the outer displacement",
        ELEMENTS,
        (3, 6, 12, 24),
        lambda e, n: abs(ring(e, n, "strain", perfect(0.4999), p, **ELEMENTS[e])[1] / exact - 1.0),
        "cells across",
    )


PROBLEM = Problem(
    title="Thick cylinder beyond yield (Hill)",
    group="plasticity",
    source="R. Hill, The Mathematical Theory of Plasticity (1950), chapter V",
    certainty="analytic",
    why="the plastic front passes through cells, which leaves 1 % on 12 cells; steel: converged "
    "values of another mesh",
    picture=lambda: Picture(ring("Q8R", 12, "strain", perfect(0.3), 190.0)[0], "PEEQ", 100.0),
    seconds=2.0,
)
