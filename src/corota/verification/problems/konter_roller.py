"""Konter's cylinder roller on a block against Hertz's line contact.

A roller of radius 50, E = 210000, pressed by 35000 per unit thickness on a block of aluminium, 200
wide and high, E = 70000, nu = 0.3 both, plane strain; a quarter of the roller on half of the block,
geometrically linear. Hertz: half width 6.214627867, peak pressure 3585.362231. The same in plane
stress, whose contact modulus has no 1 - nu^2. Pressures at the nodes of linear cells alternate by a
few percent about the ellipse; its half width is taken from the second moment.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value
from corota.verification.contact_models import ellipse_of, with_middles
from corota.verification.models import cell, run

R, H, E1, E2, NU, LOAD = 50.0, 100.0, 210e3, 70e3, 0.3, 35e3


def _graded(a: Any, b: Any) -> Any:
    """Points from a to b, close together at a."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    return lambda t: a + (b - a) * (np.asarray(t) ** 1.7)[..., None]


def _arc(t: Any) -> Any:
    angle = np.radians(60.0) * np.asarray(t) ** 1.7
    return np.stack([R * np.sin(angle), R - R * np.cos(angle)], axis=-1)


def roller(
    n: int,
    element: str,
    plane: Any = "strain",
    load: float = LOAD,
    nlgeom: bool = False,
    method: str = "mortar",
    **keys: Any,
) -> ct.Results:
    """A quarter of the roller on half of the block; the load is that of the whole."""
    kind, corner = cell(element), (0.6 * R, R)
    disc = ct.mesh.mapped(
        [_arc, _graded(_arc(1.0), corner), _graded((0, R), corner), _graded((0, 0), (0, R))],
        n,
        n,
        kind,
    )
    up, side = _graded((0, 0), (0, -H)), _graded((H, 0), (H, -H))
    block = ct.mesh.mapped(
        [
            _graded((0, -H), (H, -H)),
            lambda t: side(1.0 - np.asarray(t)),
            _graded((0, 0), (H, 0)),
            lambda t: up(1.0 - np.asarray(t)),
        ],
        n,
        n,
        kind,
    )
    disc = ct.mesh.move(with_middles(ct.mesh.move(disc, (0.0, -R)), R), (0.0, R))
    model = ct.Model(ct.mesh.assembly(disc=disc, block=with_middles(block, R)))
    for name, modulus in (("disc", E1), ("block", E2)):
        material = ct.Elastic(E=modulus, nu=NU)
        model.section(name, element=element, material=material, plane=plane)
        model.fix(f"{name}.left", x=0.0, y=None, rotation=True)
    model.fix("block.bottom", x=None, y=0.0)
    model.traction("disc.top", y=-0.5 * load / (0.6 * R))
    model.contact("disc.bottom", "block.top", name="roller", method=method)
    return run(model, ct.Static(nlgeom=nlgeom), **keys)


def pressures(results: ct.Results) -> tuple[np.ndarray, np.ndarray]:
    """Place and contact pressure of the nodes of the roller."""
    nodes = results.mesh.nodes_of("disc.bottom")
    return results.mesh.points[nodes, 0], np.asarray(results.nodal("CPRESS")[nodes])


def ellipse(results: ct.Results) -> tuple[float, float]:
    """Half width and peak of the ellipse of the pressures."""
    return ellipse_of(*pressures(results))


def hertz(load: float, plane: str) -> tuple[float, float]:
    """Half width and peak pressure of the exact line contact."""
    c = 1.0 - NU**2 if plane == "strain" else 1.0
    modulus = 1.0 / (c / E1 + c / E2)
    a = float(np.sqrt(4.0 * load * R / (np.pi * modulus)))
    return a, 2.0 * load / (np.pi * a)


def measure() -> Iterator[Value]:
    """Half width, peak, and the force that passes."""
    cases = [("Q8R", "strain", 20), ("Q8R", "stress", 20), ("Q4D", "strain", 40)]
    for element, plane, n in [*cases, ("Q4I", "strain", 40)]:
        results = roller(n, element, plane)
        a, p0 = ellipse(results)
        exact = hertz(LOAD, plane)
        text = f"plane {plane}, {element} {n} x {n}"
        yield Value(f"half width, {text}", exact[0], a, 0.02)
        yield Value(f"peak pressure, {text}", exact[1], p0, 0.02)
        force = results.frames[-1].scalars["roller: force y"]
        yield Value(f"force that passes, {text}", 0.5 * LOAD, force, 1e-9)


def curve() -> Curve:
    """Pressure over the place."""
    x, p = pressures(roller(20, "Q8R"))
    a, p0 = hertz(LOAD, "strain")
    near = np.abs(x) < 1.6 * a
    line = np.linspace(0.0, a, 60)
    return Curve(
        "distance from the middle",
        "pressure",
        {"Hertz": (line, p0 * np.sqrt(1.0 - (line / a) ** 2))},
        {"nodes of Q8R 20 x 20": (x[near], p[near])},
    )


def study() -> Study:
    """Error of the peak pressure."""
    p0 = hertz(LOAD, "strain")[1]
    return Study.over(
        "error of the peak pressure",
        ("Q4I", "Q4D", "Q8R"),
        (10, 20, 40),
        lambda e, n: abs(ellipse(roller(n, e))[1] / p0 - 1.0),
        "elements per side",
    )


PROBLEM = Problem(
    title="Konter's roller against Hertz",
    group="contact",
    source="H. Hertz (1882); geometry of A. W. A. Konter's benchmark, from memory; NLGEOM off",
    certainty="analytic",
    why="Hertz's bodies are half spaces; the contact is an eighth of the radius wide",
    picture=lambda: Picture(roller(20, "Q8R", fields=True), "MISES"),
    seconds=4.0,
)
