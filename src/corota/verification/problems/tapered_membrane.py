"""NAFEMS FV32: the first six frequencies of a tapered membrane clamped at its wide end.

Length 10 m, height 5 m to 1 m, thickness 0.05 m, E = 200 GPa, nu = 0.3, density 8000 kg/m^3.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import cell, run

#: Frequencies [Hz].
EXACT = np.array([44.623, 130.03, 162.70, 246.05, 379.90, 391.44])


def tapered(element: str, nx: int = 16, ny: int = 8) -> ct.Model:
    """The membrane on nx x ny cells."""
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=nx, ny=ny, cell=cell(element))
    s, t = mesh.points.T.copy()
    mesh.points[:, 0] = 10.0 * s
    mesh.points[:, 1] = (2.5 * (1.0 - s) + 0.5 * s) * (2.0 * t - 1.0)
    model = ct.Model(mesh)
    material = ct.Elastic(E=200e9, nu=0.3, rho=8000.0)
    model.section("all", element=element, material=material, thickness=0.05)
    model.fix("left")
    return model


def frequencies(model: ct.Model, modes: int = 6) -> np.ndarray:
    """Natural frequencies [1/time]."""
    return np.asarray(run(model, ct.Frequency(modes=modes)).modes[-1].factors)


def measure() -> Iterator[Value]:
    """All six on quadratic meshes, the first three on others."""
    for element, tolerance in (("Q8", 4e-5), ("Q9", 1e-4)):
        for k, found in enumerate(frequencies(tapered(element))):
            yield Value(f"frequency {k + 1} [Hz], {element} 16 x 8", EXACT[k], found, tolerance)
    for element in ("Q4I", "Q4D", "OPT"):
        for k, found in enumerate(frequencies(tapered(element), 3)):
            yield Value(f"frequency {k + 1} [Hz], {element} 16 x 8", EXACT[k], found, 0.01)


def study() -> Study:
    """Largest error of the first three."""
    return Study.over(
        "largest error of three frequencies",
        ("Q4I", "Q4D", "OPT", "Q8", "Q9"),
        (2, 4, 8),
        lambda e, n: float(np.abs(frequencies(tapered(e, 2 * n, n), 3) / EXACT[:3] - 1.0).max()),
        "cells across",
    )


PROBLEM = Problem(
    title="Tapered membrane (NAFEMS FV32)",
    group="dynamics",
    source="F. Abbassian, D. J. Dawswell, N. C. Knowles, Free Vibration Benchmarks, NAFEMS (1987)",
    certainty="published",
    why="five digits of the source on quadratic meshes; 1 % on linear ones of this size",
    picture=lambda: Picture(tapered("Q8")),
    seconds=0.5,
)
