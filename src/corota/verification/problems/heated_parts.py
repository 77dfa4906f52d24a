"""Heated parts: a free plate, a constrained one, a bimetal strip and a column that buckles.

A free plate expands by alpha T without stress; one constrained along x has the stress -E alpha T
(plane strain: over 1 - nu). A strip 20 x 0.5 of two layers with alpha = 1e-5 and 2e-5, heated by
200 degrees, bends to a circle with Timoshenko's curvature 3 (a2 - a1) T / (2 h), with large
displacement. A column between fixed hinges buckles at alpha T = pi^2 I / (A L^2).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value, zero
from corota.verification.models import ELEMENTS, cell, nearest, run

YOUNG, NU, ALPHA = 1000.0, 0.3, 1e-3
LENGTH, DEPTH, WARM = 20.0, 0.5, 200.0
CURVATURE = 1.5 * WARM * 1e-5 / DEPTH


def plate(element: str, plane: Any, held: bool) -> ct.Results:
    """A plate of distorted cells, one degree warmer, free or held along x."""
    mesh = ct.mesh.distort(ct.mesh.rectangle(3.0, 2.0, 3, 2, cell(element)), 0.2, seed=1)
    model = ct.Model(mesh)
    material = ct.Elastic(YOUNG, NU, expansion=ALPHA)
    model.section("all", element=element, material=material, plane=plane)
    if held:
        for side in ("left", "right"):
            model.fix(side, y=None, rotation=True)
        model.fix("bottom", x=None, rotation=True)
    else:
        model.fix([nearest(mesh, 0.0, 0.0)])
        model.fix([nearest(mesh, 3.0, 0.0)], x=None)
    model.temperature(1.0)
    return run(model, ct.Static(nlgeom=False), fields=True)


def strip(element: str = "Q8", **keys: Any) -> ct.Results:
    """Two metals on each other; the left end is held along x, its lower corner altogether."""
    mesh = ct.mesh.rectangle(LENGTH, DEPTH, 60, 4, cell(element))
    middle = mesh.points[mesh.cells[0].nodes[:, :3]].mean(axis=1)[:, 1]
    mesh.cell_sets["upper"] = np.flatnonzero(middle > 0.5 * DEPTH)
    mesh.cell_sets["lower"] = np.flatnonzero(middle < 0.5 * DEPTH)
    model = ct.Model(mesh)
    for name, alpha in (("upper", 2e-5), ("lower", 1e-5)):
        model.section(name, element=element, material=ct.Elastic(2e5, 0.0, expansion=alpha))
    model.fix("left", y=None)
    model.fix([nearest(mesh, 0.0, 0.0)])
    model.temperature(WARM)
    return run(model, ct.Static(increments=4), **keys)


def circle(part: Any = 1.0) -> Any:
    """Deflection of the end of the strip at a share of the temperature."""
    curvature = CURVATURE * np.asarray(part)
    return (1.0 - np.cos(LENGTH * curvature)) / curvature


def measure() -> Iterator[Value]:
    """Stresses and expansion for every element; strip and column."""
    for element in ELEMENTS:
        frame = plate(element, "stress", held=False).frames[-1]
        stress = float(np.abs(frame.fields[0].values["S"]).max()) / (YOUNG * ALPHA)
        yield zero(f"stress of the free plate / (E alpha T), {element}", stress, 1e-10)
        u = frame.U - ALPHA * plate(element, "stress", held=False).mesh.points
        yield zero(
            f"error of its expansion / (alpha T), {element}", float(np.abs(u).max()) / ALPHA, 1e-10
        )
        for plane, exact in (("stress", -1.0), ("strain", -1.0 / (1.0 - NU))):
            values = plate(element, plane, held=True).frames[-1].fields[0].values["S"][..., 0]
            worst = values.ravel()[np.abs(values / (YOUNG * ALPHA) - exact).argmax()]
            yield Value(
                f"stress of the held plate / (E alpha T), plane {plane}, {element}",
                exact,
                worst / (YOUNG * ALPHA),
                1e-9,
            )
    for element in ("Q8", "Q4I", "Q4D"):
        results = strip(element)
        tip = nearest(results.mesh, LENGTH, 0.0)
        found = -float(results.frames[-1].U[tip, 1])
        yield Value(f"deflection of the strip, {element} 60 x 4", circle(), found, 3e-3)
    critical = np.pi**2 / 12.0 / 100.0**2
    mesh = ct.mesh.rectangle(100.0, 1.0, 40, 1, "quad8", origin=(0.0, -0.5))
    model = ct.Model(mesh)
    model.section("all", element="Q8", material=ct.Elastic(YOUNG, 0.0, expansion=ALPHA))
    for side, x in (("left", 0.0), ("right", 100.0)):
        # A hinge in the middle of a rigid end; on a node alone it would press into the column.
        hinge = nearest(mesh, x, 0.0)
        model.rigid(np.setdiff1d(mesh.nodes_of(side), hinge), hinge)
        model.fix([hinge])
    model.temperature(1.0)
    factor = run(model, ct.Buckle()).modes[0].factors[0]
    yield Value("alpha T of the column, Q8 40 x 1", critical, ALPHA * factor, 1e-3)


def curve() -> Curve:
    """Deflection against the temperature."""
    results = strip()
    tip = nearest(results.mesh, LENGTH, 0.0)
    part = np.linspace(0.01, 1.0, 40)
    return Curve(
        "temperature [degrees]",
        "deflection of the end",
        {"Timoshenko's circle": (WARM * part, circle(part))},
        {
            "Q8 60 x 4": (
                [WARM * f.factor for f in results.frames],
                [-float(f.U[tip, 1]) for f in results.frames],
            )
        },
    )


PROBLEM = Problem(
    title="Heated parts",
    group="linear statics",
    source="S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, chapter 13; S. Timoshenko, "
    "J. Opt. Soc. Am. 11 (1925)",
    certainty="analytic",
    why="rounding; for the strip its ends and the mesh, for the column shear and shortening",
    picture=lambda: Picture(strip(fields=True), "S11"),
    seconds=1.0,
)
