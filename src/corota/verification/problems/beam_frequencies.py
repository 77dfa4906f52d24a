"""Frequencies of a slender cantilever and of a free beam.

Length 10, depth 0.1, nu = 0, unit density. The numbers beta L of Euler's and Bernoulli's beam are
1.875104, 4.694091, 7.854757 clamped and 4.730041, 7.853205, 10.995608 free; the free one has three
rigid modes.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.model import elements
from corota.verification.catalogue import Problem, Value
from corota.verification.models import cell, run

CLAMPED = (1.875104069, 4.694091133, 7.854757438)
FREE = (4.730040745, 7.853204624, 10.99560784)
MESHES = {"Q8R": (60, 1), "Q8": (60, 1), "Q4I": (120, 2), "Q4D": (120, 2), "OPT": (120, 2)}


def numbers(element: str, clamped: bool) -> tuple[np.ndarray, float]:
    """Numbers beta L of the bending modes, and the largest rigid frequency over the first."""
    nx, ny = MESHES[element]
    model = ct.Model(ct.mesh.rectangle(10.0, 0.1, nx=nx, ny=ny, cell=cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    if clamped:
        model.fix("left", rotation=True)
    rigid = 0 if clamped else 3
    found = run(model, ct.Frequency(modes=3 + rigid)).modes[-1].factors
    scale = 2.0 * np.pi * 100.0 / np.sqrt(1e6 * 0.01 / 12.0)
    first = float(found[:rigid].max() / found[rigid]) if rigid else 0.0
    return np.sqrt(scale * found[rigid:]), first


def measure() -> Iterator[Value]:
    """Both beams."""
    for element in MESHES:
        tolerance = 5e-3 if elements.find(element).drilling else 1.5e-3
        for name, clamped, exact in (("clamped", True, CLAMPED), ("free", False, FREE)):
            found, rigid = numbers(element, clamped)
            for k, reference in enumerate(exact):
                yield Value(f"beta L {k + 1}, {name}, {element}", reference, found[k], tolerance)
            if not clamped:
                yield Value(
                    f"largest rigid frequency over the first, {element}",
                    1e-3,
                    rigid,
                    0.0,
                    "at most",
                )


PROBLEM = Problem(
    title="Frequencies of slender beams",
    group="dynamics",
    source="roots of the frequency equations of the Euler-Bernoulli beam",
    certainty="analytic",
    why="shear and rotary inertia take 0.1 % of the third number at this depth; drilling elements "
    "are a little soft on regular meshes",
    seconds=1.0,
)
