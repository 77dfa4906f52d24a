"""Thick cantilever under a parabolic dead end shear, up to tip displacements of two thirds.

10 x 1, thickness 1, E = 1200, nu = 0.3, fully clamped. With `linear` local strain fine square cells
approach the continuum whose energy is (U - I) : C : (U - I) / 2 with the right stretch U, not the
Saint Venant-Kirchhoff solid; at surface strains of 14 % the two differ noticeably.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import Watch, cantilever, edge_forces, last_frames, nearest, run

#: Load, and the displacement of the middle of the end on Q9 80 x 8.
EXACT = {1.0: (-0.56737, 3.03767), 2.0: (-1.61730, 4.97497), 4.0: (-3.31596, 6.77129)}


def solved(element: str, nx: int, watch: Watch | None = None, **keys: Any) -> ct.Results:
    """One step a load, on square cells."""
    model = cantilever(element, 10.0, 1.0, nx, nx // 10, E=1200.0, nu=0.3)

    def shear(p: float) -> Any:
        return lambda x: (0.0, 1.5 * p * (1.0 - 4.0 * float(x[1]) ** 2))

    steps: list[Any] = [
        ct.Static(loads=edge_forces(model.mesh, "right", shear(p)), increments=2, tolerance=1e-10)
        for p in EXACT
    ]
    return run(model, steps, observers=[watch] if watch else [], **keys)


def measure() -> Iterator[Value]:
    """Both components at all loads."""
    results = solved("Q9", 80)
    tip = nearest(results.mesh, 10.0, 0.0)
    for (p, exact), frame in zip(EXACT.items(), last_frames(results), strict=True):
        for axis, reference, found in zip("xy", exact, frame.U[tip], strict=True):
            yield Value(f"displacement {axis} at P = {p:g}, Q9 80 x 8", reference, found, 3e-4)


def study() -> Study:
    """Error of the deflection at P = 4 for square cells."""
    series = {}
    for element in ("Q4I", "Q4D", "Q8", "Q9"):
        cells, errors = [], []
        for nx in (20, 40, 80):
            results = solved(element, nx)
            try:
                tip = nearest(results.mesh, 10.0, 0.0)
            except ValueError:
                continue
            found = float(results.frames[-1].U[tip, 1])
            cells.append(float(nx))
            errors.append(abs(found / EXACT[4.0][1] - 1.0))
        series[element] = (cells, errors)
    return Study("error of the deflection against Q9 80 x 8", series, "cells along")


PROBLEM = Problem(
    title="Thick cantilever beside its continuum",
    group="large displacement",
    source="an independent total-Lagrangian program for the same continuum, Q9 80 x 8",
    certainty="computed independently",
    why="the best-fit frame is the polar rotation only to second order in the strain",
    picture=lambda: Picture(solved("Q8", 40, fields=True), "S11"),
    seconds=0.8,
)
