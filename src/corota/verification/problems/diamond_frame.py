"""Diamond frame: a square of four bars is loaded in tension or compression along a diagonal.

The loaded corners are hinges, the two others are rigid. By symmetry each bar is a cantilever under
a dead force of half the load at 45 degrees; the integrals of the inextensible elastica are the
exact solution. Bars of length 1 with EI = 1 and an EA of 1e6; loads up to P L^2 / EI = 10 and both
signs. Half of the frame is computed with beams, and with Q8 as a solid of depth 0.01.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

import corota as ct
from corota.model import elements
from corota.verification.beam_models import polyline
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.models import last_frames, nearest, run

LOADS = (1.0, 2.0, 4.0, 6.0, 8.0, 10.0)
HALF = 0.5**0.5
#: Depth of the bars of the solid, and its modulus for EI = 1 with unit thickness.
DEPTH = 0.01


@cache
def elastica(load: float) -> tuple[float, float]:
    """Distances of the hinge and of the rigid corner from the middle, under a signed load.

    The bar starts at the rigid corner at 45 degrees (the corner's own tangents cannot turn) and
    ends at the hinge without moment; load > 0 pulls the hinges apart. With phi the angle of the
    bar to the line of the load and a the one at the hinge, phi'^2 = P (cos a - cos phi) up to
    sign, P being the load.
    """
    start, p = 0.25 * np.pi, abs(load)

    def parts(a: float) -> tuple[float, float, float]:
        # phi = a + (start - a) s^2 takes the square root's singularity at the hinge away.
        span = abs(start - a)

        def integral(weight: Callable[[float], float]) -> float:
            def f(s: float) -> float:
                phi = a + (start - a) * s * s
                half = 0.5 * span * s * s
                slope = 2.0 * p * np.sin(0.5 * (phi + a)) * np.sinc(half / np.pi) * 0.5 * span
                return weight(phi) * 2.0 * span / float(np.sqrt(slope))

            return float(quad(f, 0.0, 1.0, epsabs=1e-13, epsrel=1e-12)[0])

        return integral(lambda _: 1.0), integral(np.cos), integral(np.sin)

    low, high = (1e-6, start - 1e-9) if load > 0.0 else (start + 1e-9, np.pi - 1e-6)
    end = brentq(lambda a: parts(a)[0] - 1.0, low, high, xtol=1e-14)
    _, along, across = parts(end)
    return along, across


def frame(element: str, load: float = 0.0) -> tuple[ct.Model, int, int]:
    """One bar, from the rigid corner on the left to the hinge; with both nodes.

    The line of the load is y; the rigid corner moves along x only, the hinge along y only.
    """
    if elements.find(element).line:
        way = np.linspace(0.0, 1.0, 61)[:, None]
        model = ct.Model(polyline(way * [HALF, HALF]))
        material = ct.Elastic(E=1e6, nu=0.0)
        model.beam(np.arange(60), material=material, area=1.0, inertia=1e-6)
        corner, hinge = 0, 60
    else:
        mesh = ct.mesh.rectangle(1.0, DEPTH, 60, 1, "quad8", origin=(0.0, -0.5 * DEPTH))
        model = ct.Model(ct.mesh.move(mesh, angle=45.0))
        material = ct.Elastic(E=12.0 / DEPTH**3, nu=0.0)
        model.section("all", element=element, material=material)
        corner, hinge = nearest(model.mesh, 0.0, 0.0), nearest(model.mesh, HALF, HALF)
    if elements.find(element).line:
        model.fix([corner], x=None, y=0.0, rotation=True)
    else:
        # The end keeps its direction: all of it moves along x as the corner does.
        end = model.mesh.nodes_of("left")
        model.fix(end, x=None, y=0.0)
        for node in end:
            if node != corner:
                model.equation((int(node), "x", 1.0), (corner, "x", -1.0))
    model.fix([hinge], x=0.0, y=None)
    if load:
        model.force([hinge], y=0.5 * load)
    return model, corner, hinge


@cache
def solved(element: str, sign: float, **keys: Any) -> tuple[ct.Results, int, int]:
    """A step for each load."""
    model, corner, hinge = frame(element)
    steps: list[Any] = [
        ct.Static(loads=[ct.NodalForce(np.array([hinge]), 1, 0.5 * sign * p)], tolerance=1e-11)
        for p in LOADS
    ]
    return run(model, steps, **keys), corner, hinge


def distances(element: str, sign: float) -> np.ndarray:
    """Distances from the middle of the hinge, and of the rigid corner, by load."""
    results, corner, hinge = solved(element, sign)
    frames = last_frames(results)
    high = HALF + np.array([f.U[hinge, 1] for f in frames])
    wide = HALF - np.array([f.U[corner, 0] for f in frames])
    return np.stack([high, wide], axis=1)


def measure() -> Iterator[Value]:
    """Every load by beams, the largest by solids too."""
    for word, sign in (("pulled", 1.0), ("pressed", -1.0)):
        for element in ("BEAM", "Q8"):
            found = distances(element, sign)
            for k, load in enumerate(LOADS):
                if element == "Q8" and k < len(LOADS) - 1:
                    continue
                text = f"{word} with {load:g}, {element}"
                tolerance = 5e-5 if elements.find(element).line else 2e-4
                for name, known, value in zip(
                    ("hinge", "rigid corner"), elastica(sign * load), found[k], strict=True
                ):
                    yield Value(
                        f"{name} from the middle, {text}", known, value, tolerance, "absolute"
                    )


def curve() -> Curve:
    """Distances against the load, both signs."""
    loads = np.concatenate([-np.array(LOADS[::-1]), [0.0], LOADS])
    rows = np.concatenate([distances("BEAM", -1.0)[::-1], [[HALF, HALF]], distances("BEAM", 1.0)])
    exact = np.array([elastica(p) if p else (HALF, HALF) for p in loads])
    return Curve(
        "P L^2 / EI",
        "distance from the middle / L",
        {"hinge, beams": (loads, rows[:, 0]), "rigid corner, beams": (loads, rows[:, 1])},
        {"elastica, hinge": (loads, exact[:, 0]), "elastica, corner": (loads, exact[:, 1])},
    )


PROBLEM = Problem(
    title="Diamond frame",
    group="large displacement",
    source="integrals of the inextensible elastica; the problem is in K. Mattiasson, Int. J. "
    "Numer. Meth. Engng 17 (1981)",
    certainty="analytic",
    why="60 straight beams for the curve; the solid's depth of a hundredth, as for the elastica",
    picture=lambda: Picture(solved("Q8", -1.0, fields=True)[0], "S11"),
    seconds=1.0,
)
