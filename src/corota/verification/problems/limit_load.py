"""Perfectly plastic cantilevers in plane stress: prescribed tip displacement up to the limit load.

The collapse load of beam theory is ``sy t h^2 / (4 L)``, with a plastic hinge at the clamp. A
cantilever of 10 x 1 (E = 1000, nu = 0.3, yield stress 1) is loaded to collapse: the clamp
constrains the section laterally, so that its hinge carries more than that of the beam, at most 2 /
sqrt 3 times as much. A slender one of 6 x 0.5 (yield stress 10, limit 0.1041667) is displaced by
0.65, where Prager and Hodge's formula ``(5 - (3 + r) sqrt(3 - 2 r)) / r^2`` of the load r over the
elastic limit gives 0.868 of the limit.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from scipy.optimize import brentq

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value, zero
from corota.verification.models import DRILLING, cell, run
from corota.verification.plastic_models import cantilever

#: Length, height, yield stress, movement of the tip.
SHAPES = {"10 x 1": (10.0, 1.0, 1.0, 0.5), "6 x 0.5": (6.0, 0.5, 10.0, 0.65)}
CASES = [("Q8R", 4), ("Q8", 4), ("Q4I", 8), ("Q4D", 8)]


@cache
def solved(shape: str, element: str, ny: int) -> ct.Results:
    """The cantilever, its tip moved."""
    length, height, strength, move = SHAPES[shape]
    if shape == "10 x 1":
        model = cantilever(element, ny, move)
    else:
        nx = round(ny * length / height)
        model = ct.Model(ct.mesh.rectangle(length, height, nx, ny, cell(element)))
        law = ct.Mises(E=1000.0, nu=0.3, yield_stress=strength)
        model.section("all", element=element, material=law)
        model.fix("left", rotation=True if element in DRILLING else None)
        model.fix("right", x=None, y=-move)
    return run(
        model, ct.Static(nlgeom=False, first_increment=0.1, largest_increment=0.1), fields=True
    )


def loads(results: ct.Results, shape: str) -> tuple[np.ndarray, np.ndarray]:
    """Movement of the tip, and force over the limit of beam theory."""
    length, height, strength, move = SHAPES[shape]
    right = results.mesh.nodes_of("right")
    force = np.array([-float(f.RF[right, 1].sum()) for f in results.frames])
    limit = strength * height**2 / (4.0 * length)
    return move * np.array([f.factor for f in results.frames]), force / limit


def prager_hodge(shape: str) -> float:
    """Load over the limit at the whole movement, by the formula for slender bars."""
    length, height, strength, move = SHAPES[shape]
    first = 2.0 * strength * length**2 / (3.0 * 1000.0 * height)

    def excess(r: float) -> float:
        return float((5.0 - (3.0 + r) * np.sqrt(3.0 - 2.0 * r)) / r**2 - move / first)

    return float(brentq(excess, 1.0, 1.5)) / 1.5


def measure() -> Iterator[Value]:
    """Both cantilevers."""
    for element, ny in CASES:
        end = loads(solved("10 x 1", element, ny), "10 x 1")[1]
        text = f"10 x 1, {element}, {ny} layers"
        yield Value(f"collapse load / limit, {text}, at least", 1.0, end[-1], 0.0, "at least")
        yield Value(f"collapse load / limit, {text}, at most", 1.06, end[-1], 0.0, "at most")
        yield zero(f"growth in the last increment, {text}", end[-1] / end[-2] - 1.0, 1e-3)
        found = loads(solved("6 x 0.5", element, ny), "6 x 0.5")[1][-1]
        yield Value(
            f"load / limit at 0.65, 6 x 0.5, {element}, {ny} layers",
            prager_hodge("6 x 0.5"),
            found,
            0.01,
        )


def curve() -> Curve:
    """Load against the movement."""
    return Curve(
        "movement of the tip",
        "load / limit of beam theory",
        {f"{s}, Q4I": loads(solved(s, "Q4I", 8), s) for s in SHAPES},
        {
            "Prager and Hodge, 6 x 0.5": ([0.65], [prager_hodge("6 x 0.5")]),
            "beam theory": ([0.5], [1.0]),
        },
    )


def study() -> Study:
    """Change of the collapse load with the layers."""
    last = {e: loads(solved("10 x 1", e, 32), "10 x 1")[1][-1] for e in ("Q4I", "Q8R", "Q4D")}
    return Study.over(
        "collapse load less that of 32 layers, relative",
        last,
        (4, 8, 16),
        lambda e, n: abs(loads(solved("10 x 1", e, n), "10 x 1")[1][-1] / last[e] - 1.0),
        "layers",
    )


PROBLEM = Problem(
    title="Limit load of a cantilever",
    group="plasticity",
    source="W. Prager, P. G. Hodge, Theory of Perfectly Plastic Solids (1951)",
    certainty="analytic",
    why="bounds of the clamped hinge; a slender bar within 1 % of the formula, which has no shear",
    picture=lambda: Picture(solved("10 x 1", "Q4I", 8), "PEEQ"),
    seconds=1.0,
)
