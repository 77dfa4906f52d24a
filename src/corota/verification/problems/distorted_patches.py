"""Constant strain on twenty random meshes for every element, in plane stress and plane strain.

A rectangle 3 x 2 of 3 x 3 cells whose inner nodes are shifted by up to 0.3 of a side, rotated by a
different angle each time; a random linear field prescribes the displacements (and drilling
rotations) of its boundary. Displacements inside and the stress at every point must be those of the
field.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Value, zero
from corota.verification.models import DRILLING, ELEMENTS, boundary, cell, prescribe, run

YOUNG, POISSON, SEEDS = 210.0, 0.3, 20


def moduli(plane: str) -> np.ndarray:
    """Hooke's law for xx, yy and the shear angle."""
    c, d = YOUNG / (1.0 - POISSON**2), POISSON
    if plane == "strain":
        c = YOUNG * (1.0 - POISSON) / (1.0 + POISSON) / (1.0 - 2.0 * POISSON)
        d = POISSON / (1.0 - POISSON)
    return np.array([[c, c * d, 0.0], [c * d, c, 0.0], [0.0, 0.0, YOUNG / 2.0 / (1.0 + POISSON)]])


def distorted(element: str, seed: int) -> ct.Mesh:
    """One of the meshes."""
    mesh = ct.mesh.rectangle(3.0, 2.0, 3, 3, cell(element), "alternate")
    return ct.mesh.move(ct.mesh.distort(mesh, 0.3, seed), shift=(1.0, -0.5), angle=7.0 * seed)


def solved(element: str, plane: Any, seed: int) -> tuple[ct.Results, np.ndarray]:
    """One mesh; with the gradient of its field."""
    mesh = distorted(element, seed)
    h = 1e-3 * np.random.default_rng(seed).uniform(-1.0, 1.0, (2, 2))
    model = ct.Model(mesh)
    material = ct.Elastic(E=YOUNG, nu=POISSON)
    model.section("all", element=element, material=material, thickness=0.7, plane=plane)
    edge = boundary(mesh)
    skew = np.array(0.5 * (h[1, 0] - h[0, 1])) if element in DRILLING else None
    prescribe(model, edge, mesh.points[edge] @ h.T, skew)
    return run(model, ct.Static(nlgeom=False), fields=True), h


def errors(element: str, plane: str, seed: int) -> tuple[float, float]:
    """Largest errors of displacements and stresses over their sizes."""
    results, h = solved(element, plane, seed)
    u = results.mesh.points @ h.T
    displacement = float(np.abs(results.frames[-1].U - u).max() / np.abs(u).max())
    stress = moduli(plane) @ [h[0, 0], h[1, 1], h[0, 1] + h[1, 0]]
    found = results.frames[-1].fields[0].values["S"][..., [0, 1, 3]]
    return displacement, float(np.abs(found - stress).max() / np.abs(stress).max())


def measure() -> Iterator[Value]:
    """The worst of the meshes."""
    for element in ELEMENTS:
        for plane in ("stress", "strain"):
            worst = np.max([errors(element, plane, seed) for seed in range(SEEDS)], axis=0)
            yield zero(f"displacement error, {element}, plane {plane}", worst[0], 1e-12)
            yield zero(f"stress error, {element}, plane {plane}", worst[1], 1e-11)


PROBLEM = Problem(
    title="Constant strain on random meshes",
    group="properties of the method",
    source="any linear field solves the equations",
    certainty="analytic",
    why="rounding",
    picture=lambda: Picture(solved("Q8", "stress", 7)[0], "U", 100.0),
    seconds=3.0,
)
