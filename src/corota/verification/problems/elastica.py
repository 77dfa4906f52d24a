"""Elastica: a slender cantilever under a transverse dead force at its end.

Length 10, depth 0.1, nu = 0, so that the planar solid is nearly the inextensible elastica; loads up
to P L^2 / EI = 20, where the end points along the force. The values are deflection and shortening
of the end over the length, for every element that is suitable for bending.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value
from corota.verification.models import Watch, cantilever, last_frames, run

LENGTH, HEIGHT, YOUNG = 10.0, 0.1, 1.2e9
#: P L^2 / EI, deflection / L, shortening / L.
EXACT = [
    (0.2, 0.0663644821, 0.0026465483),
    (0.5, 0.1621435757, 0.0159189625),
    (1, 0.3017207738, 0.0564332363),
    (2, 0.4934574804, 0.1606417208),
    (3, 0.6032534411, 0.2544201846),
    (4, 0.6699641813, 0.3289412422),
    (5, 0.7137915236, 0.3876283607),
    (6, 0.7445711489, 0.4345888287),
    (7, 0.7673690997, 0.4729274284),
    (8, 0.7849823750, 0.5048277321),
    (9, 0.7990555275, 0.5318205627),
    (10, 0.8106090249, 0.5549955978),
    (15, 0.8477156743, 0.6352857804),
    (20, 0.8686958983, 0.6838855676),
]
#: Cells along and across.
MESHES = {
    "Q8": (50, 1),
    "Q8R": (50, 1),
    "Q9": (50, 1),
    "T6": (60, 1),
    "Q4I": (100, 1),
    "OPT": (200, 2),
    "Q4D": (100, 4),
}


def solved(
    element: str, nx: int, ny: int, watch: Watch | None = None, **keys: object
) -> ct.Results:
    """One step with one increment for each load of the table."""
    model = cantilever(element, LENGTH, HEIGHT, nx, ny, E=YOUNG)
    unit = YOUNG * HEIGHT**2 / 12.0 / LENGTH**2
    steps: list[object] = [
        ct.Static(
            loads=[ct.EdgeLoad("right", "traction", (0.0, k * unit))], increments=1, tolerance=1e-12
        )
        for k, _, _ in EXACT
    ]
    return run(model, steps, observers=[watch] if watch else [], **keys)  # type: ignore[arg-type]


def end(results: ct.Results) -> np.ndarray:
    """Deflection and shortening of the middle of the end over the length, by load."""
    mesh = results.mesh
    tip = mesh.node_sets["right"]
    middle = tip[np.abs(mesh.points[tip, 1]) < 1e-9]
    where = middle if len(middle) else tip
    u = np.array([f.U[where].mean(axis=0) for f in last_frames(results)]) / LENGTH
    return np.stack([u[:, 1], -u[:, 0]], axis=1)


def measure() -> Iterator[Value]:
    """Largest error over all loads, and the values at 10."""
    exact = np.array([row[1:] for row in EXACT])
    for element, (nx, ny) in MESHES.items():
        found = end(solved(element, nx, ny))
        yield Value(f"deflection at 10, {element} {nx} x {ny}", exact[11, 0], found[11, 0], 2e-3)
        yield Value(f"shortening at 10, {element} {nx} x {ny}", exact[11, 1], found[11, 1], 2e-3)
        worst = float(np.abs(found / exact - 1.0).max())
        yield Value(f"largest error of all 14 loads, {element}", 2e-3, worst, 0.0, "at most")


def curve() -> Curve:
    """Deflection and shortening against the load."""
    exact, found = np.array(EXACT), end(solved("Q4I", 100, 1))
    load = np.concatenate([[0.0], exact[:, 0]])
    lines = np.concatenate([np.zeros((1, 2)), found])
    return Curve(
        "P L^2 / EI",
        "displacement / L",
        {"deflection, Q4I": (load, lines[:, 0]), "shortening, Q4I": (load, lines[:, 1])},
        {
            "elastica, deflection": (exact[:, 0], exact[:, 1]),
            "elastica, shortening": (exact[:, 0], exact[:, 2]),
        },
    )


def study() -> Study:
    """Largest error over all loads against cells along."""
    exact = np.array([row[1:] for row in EXACT])
    return Study.over(
        "largest error, which ends at that of the slenderness",
        ("Q4I", "OPT", "Q4D", "Q8", "Q9"),
        (10, 20, 40, 80),
        lambda e, n: float(np.abs(end(solved(e, n, MESHES[e][1])) / exact - 1.0).max()),
        "cells along",
    )


PROBLEM = Problem(
    title="Elastica under a dead end force",
    group="large displacement",
    source="elliptic integrals; K. Mattiasson, Int. J. Numer. Meth. Engng 17 (1981), agrees",
    certainty="analytic",
    why="shear and extension at a depth of a hundredth of the length, and the mesh",
    picture=lambda: Picture(solved("Q8", 50, 1, fields=True), "U2"),
    seconds=2.1,
)
