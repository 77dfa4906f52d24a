"""The tangent is the derivative of the internal force, for every element and local strain.

Two distorted cells with random displacements of a few percent, rotated by a radian; central
differences of the internal force by every degree of freedom, over the largest entry.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from corota.verification.catalogue import Problem, Value, zero
from corota.verification.models import DRILLING, ELEMENTS, assemble
from corota.verification.problems.objectivity import STRAINS, patch, turned

STEP = 1e-6


def error(element: str, strain: str) -> float:
    """Largest difference between the tangent and the differences, relative."""
    model = patch(element, strain)
    shape = (model.mesh.n_nodes, 3 if element in DRILLING else 2)
    u = turned(model, np.random.default_rng(2).uniform(-0.03, 0.03, shape), 1.0)
    tangent = assemble(model, u)[1]
    columns = []
    for step in STEP * np.eye(u.size):
        d = step.reshape(shape)
        columns.append((assemble(model, u + d)[0] - assemble(model, u - d)[0]) / (2.0 * STEP))
    return float(np.abs(np.array(columns).T - tangent).max() / np.abs(tangent).max())


def measure() -> Iterator[Value]:
    """Every element and local strain."""
    for element in ELEMENTS:
        for strain in STRAINS:
            yield zero(f"error of the tangent, {element}, {strain}", error(element, strain), 1e-7)


PROBLEM = Problem(
    title="Tangent against differences",
    group="properties of the method",
    source="the definition of the tangent",
    certainty="analytic",
    why="central differences over 1e-6 leave some 1e-9 of rounding",
    seconds=2.0,
)
