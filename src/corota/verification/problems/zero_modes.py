"""Zero-energy modes: three rigid ones and no other, except the hourglass mode of Q8R.

Eigenvalues of the stiffness of one skew cell and of two adjacent cells, relative to the largest.
With reduced integration, Q8R has one more mode on a single cell, which two cells suppress.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Problem, Value
from corota.verification.models import DRILLING, ELEMENTS, assemble, cell, single
from corota.verification.shapes import QUAD, TRIANGLE

#: Skew quadrilateral, counter-clockwise.
SKEW = np.array([[0.0, 0.0], [1.6, 0.1], [1.3, 1.2], [-0.1, 0.9]])


def one(element: str) -> ct.Model:
    """A single cell."""
    kind = cell(element)
    n = int(kind[-1])
    if kind.startswith("tri"):
        x = TRIANGLE[:n] @ (SKEW[[1, 3]] - SKEW[0])
    else:
        r, s = QUAD[:n].T
        weights = 0.25 * np.stack(
            [(1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)], axis=1
        )
        x = weights @ SKEW
    return single(element, x, E=1.0, nu=0.3)


def two(element: str) -> ct.Model:
    """Two cells that share a side."""
    kind = cell(element)
    mesh = ct.mesh.mapped(SKEW, 1 if kind.startswith("tri") else 2, 1, kind)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0, nu=0.3))
    return model


def zeros(model: ct.Model, element: str) -> int:
    """Eigenvalues of the stiffness below 1e-10 of the largest."""
    width = 3 if element in DRILLING else 2
    _, stiffness = assemble(model, np.zeros((model.mesh.n_nodes, width)), nlgeom=False)
    found = np.linalg.eigvalsh(stiffness)
    return int((np.abs(found) < 1e-10 * found[-1]).sum())


def measure() -> Iterator[Value]:
    """Every element, alone and beside another."""
    for element in ELEMENTS:
        expected = 4 if element == "Q8R" else 3
        yield Value(
            f"zero modes of one cell, {element}",
            expected,
            zeros(one(element), element),
            0.0,
            "absolute",
        )
        yield Value(
            f"zero modes of two cells, {element}", 3, zeros(two(element), element), 0.0, "absolute"
        )


PROBLEM = Problem(
    title="Zero-energy modes",
    group="properties of the method",
    source="rank of the stiffness: T. J. R. Hughes, The Finite Element Method (1987), section 4.7",
    certainty="analytic",
    why="a count",
    seconds=0.1,
)
