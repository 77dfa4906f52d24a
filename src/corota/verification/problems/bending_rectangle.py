"""Energy of one rectangle in pure bending over the exact one, for aspect ratios from 1 to 16.

Incompatible modes (Q4I) and the optimal triangle pair (OPT) are exact, the drilling quadrilateral
is 2 to 4 % too stiff, and the bilinear one locks in shear with the square of the aspect ratio.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Problem, Value
from corota.verification.models import DRILLING, assemble, cell

#: Ratios for the aspects, and their tolerance.
ROWS = {
    "Q4": ((1.4835, 2.6374, 7.2527, 25.714, 99.560), 5e-4),
    "Q4I": ((1.0, 1.0, 1.0, 1.0, 1.0), 1e-12),
    "OPT": ((1.0, 1.0, 1.0, 1.0, 1.0), 1e-12),
    "Q4D": ((1.042, 1.025, 1.019, 1.017, 1.017), 6e-4),
}


def ratio(element: str, a: float, b: float) -> float:
    """Energy of one rectangle a x b in pure bending over the exact one."""
    mesh = ct.mesh.rectangle(a, b, 1, 1, cell(element), "right", origin=(-a / 2, -b / 2))
    E, kappa = 1000.0, 0.01
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=0.3))
    x, y = mesh.points.T
    columns = [kappa * x * y, -0.5 * kappa * (x**2 - 0.25 * a**2)]
    if element in DRILLING:
        columns.append(-kappa * x)
    u = np.stack(columns, axis=1)
    force, _ = assemble(model, u, nlgeom=False)
    return float(0.5 * force @ u.ravel() / (0.5 * E * b**3 / 12.0 * kappa**2 * a))


def measure() -> Iterator[Value]:
    """Every aspect."""
    for element, (row, tolerance) in ROWS.items():
        for aspect, expected in zip((1, 2, 4, 8, 16), row, strict=True):
            yield Value(
                f"{element}, aspect {aspect}",
                expected,
                ratio(element, float(aspect), 1.0),
                tolerance,
            )


PROBLEM = Problem(
    title="Bending energy of one rectangle",
    group="linear statics",
    source="C. A. Felippa, Comput. Methods Appl. Mech. Engrg 192 (2003); Q4 and Q4D by an "
    "independent implementation",
    certainty="computed independently",
    why="rounding where exact, otherwise the printed digits",
    seconds=0.1,
)
