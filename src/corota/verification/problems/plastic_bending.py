"""Rectangular bars bent beyond yield: moment, springback and a cantilever's deflection.

Pure bending of a perfectly plastic bar: ``M / M_y = 1.5 - 0.5 (k_y / k)^2`` for curvatures k beyond
the first yield k_y; removing the elastic curvature of that moment leaves zero moment. A slender
cantilever deflects at P times its elastic limit load by Prager and Hodge's formula. A bar under a
saw-tooth strain follows the hysteresis loops of isotropic and kinematic hardening.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value, zero
from corota.verification.models import DRILLING, cell, last_frames, run

RATIOS = (1.5, 2.0, 3.0, 5.0, 10.0)


def bend(curvature: list[float], element: str = "Q8", layers: int = 10) -> np.ndarray:
    """Moment over that at first yield, along a history of curvatures over the first."""
    height, length, E, sy = 1.0, 0.5, 200000.0, 200.0
    mesh = ct.mesh.rectangle(length, height, 1, layers, cell(element), origin=(0.0, -0.5))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Mises(E=E, nu=0.0, yield_stress=sy))
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    first = 2.0 * sy / E / height
    right = mesh.nodes_of("right")
    y = mesh.points[right, 1]
    steps: list[Any] = []
    for value in curvature:
        held = [
            ct.Fixed(np.array([node]), 0, float(-value * first * length * place))
            for node, place in zip(right, y, strict=True)
        ]
        if element in DRILLING:
            held.append(ct.Fixed(right, 2, value * first * length))
        steps.append(ct.Static(nlgeom=False, increments=4, supports=held))
    frames = last_frames(run(model, steps))
    return np.array([-(f.RF[right, 0] @ y) for f in frames]) / (sy * height**2 / 6)


def cantilever(ratio: float, **keys: Any) -> tuple[ct.Results, float, float]:
    """Deflection over that at the elastic limit, computed and exact, at `ratio` times its load."""
    length, E, sy = 40.0, 200000.0, 200.0
    mesh = ct.mesh.rectangle(length, 1.0, 80, 6, "quad8")
    limit = sy / (6 * length)
    elastic = limit * length**3 / (3 * E / 12)
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=ct.Mises(E=E, nu=0.0, yield_stress=sy))
    model.fix("left")
    model.traction("right", y=-ratio * limit)
    results = run(model, ct.Static(nlgeom=False, increments=10), **keys)
    tip = -float(results.frames[-1].U[mesh.nodes_of("right"), 1].mean())
    q = np.sqrt(3.0 - 2.0 * ratio)
    return results, tip / elastic, float((5.0 - (3.0 + ratio) * q) / ratio**2)


def cycles(kind: str) -> tuple[list[float], list[float]]:
    """Stress after each reversal of strain at 0.005, computed and exact."""
    E, sy, H = 200000.0, 250.0, 5000.0
    slope = E * H / (E + H)
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1))
    options: dict[str, Any] = {kind: H}
    model.section("all", element="Q4I", material=ct.Mises(E=E, nu=0.3, yield_stress=sy, **options))
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    steps: list[Any] = []
    for target in (0.005, -0.005):
        support = ct.Fixed(model.mesh.nodes_of("right"), 0, 2 * target)
        steps.append(ct.Static(nlgeom=False, increments=5, supports=[support]))
    frames = last_frames(run(model, steps, fields=True))
    found = [float(f.fields[0].values["S"][0, 0, 0]) for f in frames]
    top = sy + slope * (0.005 - sy / E)
    size = top if kind == "isotropic" else sy
    return found, [top, top - 2 * size - slope * (0.01 - 2 * size / E)]


def measure() -> Iterator[Value]:
    """Moments, residual, deflections, loops."""
    last = 10.0 - (1.5 - 0.5 / 100.0)
    moment = bend([*RATIOS, last])
    for k, found in zip(RATIOS, moment, strict=False):
        yield Value(f"moment at {k:g} times the first curvature", 1.5 - 0.5 / k**2, found, 0.005)
    yield zero("moment after springback", moment[-1], 0.01)
    for ratio in (1.2, 1.45):
        _, found, exact = cantilever(ratio)
        yield Value(
            f"deflection of the cantilever at {ratio:g} times the limit", exact, found, 0.01
        )
    for kind in ("isotropic", "kinematic"):
        for name, found, exact in zip(("top", "bottom"), *cycles(kind), strict=True):
            yield Value(f"stress at the {name} of the loop, {kind}", exact, found, 1e-9)


def curve() -> Curve:
    """Moment against curvature."""
    k = np.linspace(0.2, 10.0, 25)
    exact = np.where(k < 1.0, k, 1.5 - 0.5 / np.maximum(k, 1.0) ** 2)
    return Curve(
        "curvature over the first",
        "moment over the first",
        {"exact": (k, exact)},
        {"Q8, ten layers": (RATIOS, bend(list(RATIOS)))},
    )


PROBLEM = Problem(
    title="Bars beyond yield: bending, springback, cycles",
    group="plasticity",
    source="W. Prager, P. G. Hodge, Theory of Perfectly Plastic Solids (1951)",
    certainty="analytic",
    why="ten layers with three points each across the depth; loops are exact",
    picture=lambda: Picture(cantilever(1.45, fields=True)[0], "PEEQ"),
    seconds=1.0,
)
