"""Hertz: two equal steel cylinders of radius 10 in contact, plane strain.

E = 210000, nu = 0.3, a force of 500 per unit thickness: half width 0.1660929162, peak pressure
1916.456725. A quarter of either disc, with meshes that do not match; the contact width is a
sixtieth of the radius, small compared with the bodies as Hertz's theory assumes. Geometrically
linear.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value
from corota.verification.contact_models import ellipse_of, quarter
from corota.verification.models import DRILLING, run

R, YOUNG, NU, LOAD = 10.0, 210e3, 0.3, 500.0
HALF, PEAK = 0.1660929162, 1916.456725
#: Thinner cells in the middle (2.2) make the pressures of quadratic cells alternate by a half.
GROWTH = 1.8


@cache
def solved(element: str, n: int) -> ct.Results:
    """The upper disc with `n` elements per side, the lower one with a quarter fewer."""
    up = ct.mesh.move(quarter(R, n, element, GROWTH), shift=(0.0, R))
    low = ct.mesh.move(quarter(R, 3 * n // 4, element, GROWTH, upper=True), shift=(0.0, -R))
    model = ct.Model(ct.mesh.assembly(up=up, low=low))
    steel = ct.Elastic(E=YOUNG, nu=NU)
    model.section("all", element=element, material=steel, plane="strain")
    for name in ("up", "low"):
        model.fix(f"{name}.left", y=None, rotation=element in DRILLING)
    model.fix("low.bottom", x=None)
    model.contact("up.bottom", "low.top", name="pair")
    model.traction("up.top", y=-0.5 * LOAD / R)
    return run(model, ct.Static(nlgeom=False), fields=True)


def pressures(results: ct.Results) -> tuple[np.ndarray, np.ndarray]:
    """Place and contact pressure of the nodes of the upper disc."""
    nodes = results.mesh.nodes_of("up.bottom")
    return results.mesh.points[nodes, 0], np.asarray(results.nodal("CPRESS")[nodes])


def measure() -> Iterator[Value]:
    """Half width, peak, force."""
    for element, n in (("Q4I", 48), ("Q8R", 48), ("Q4D", 64)):
        results = solved(element, n)
        a, p0 = ellipse_of(*pressures(results))
        yield Value(f"half width, {element} {n} x {n}", HALF, a, 0.01)
        yield Value(f"peak pressure, {element} {n} x {n}", PEAK, p0, 0.01)
        force = results.frames[-1].scalars["pair: force y"]
        yield Value(f"force that passes, {element} {n} x {n}", 0.5 * LOAD, force, 1e-9)


def curve() -> Curve:
    """Pressure over the place."""
    x, p = pressures(solved("Q4I", 48))
    near = np.abs(x) < 1.6 * HALF
    line = np.linspace(0.0, HALF, 60)
    return Curve(
        "distance from the middle",
        "pressure",
        {"Hertz": (line, PEAK * np.sqrt(1.0 - (line / HALF) ** 2))},
        {"nodes of Q4I 48 x 48": (x[near], p[near])},
    )


def study() -> Study:
    """Error of the peak pressure."""
    return Study.over(
        "error of the peak pressure",
        ("Q4I", "Q4D"),
        (16, 32, 64),
        lambda e, n: abs(ellipse_of(*pressures(solved(e, n)))[1] / PEAK - 1.0),
        "elements per side",
    )


PROBLEM = Problem(
    title="Two equal cylinders (Hertz)",
    group="contact",
    source="H. Hertz (1882)",
    certainty="analytic",
    why="about nine cells are in contact; pressures at nodes alternate about the ellipse",
    picture=lambda: Picture(solved("Q4I", 48), "MISES"),
    seconds=2.0,
)
