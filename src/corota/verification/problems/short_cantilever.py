"""Short cantilever 48 x 12 under a parabolic end shear of 40.

E = 30000, nu = 0.25, thickness 1, fully clamped; drilling rotations are free at the clamp. The
value is the work-averaged tip displacement. Beam theory with shear gives 0.355333; the clamped
plane-stress solution is 0.35605.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import cantilever, edge_forces, linear, run

#: Diagonals and tip displacement on 4 x 1, 8 x 2, ..., 64 x 16 cells.
ROWS = {
    "Q4": ("right", [0.24242, 0.31620, 0.34470, 0.35301, 0.35525]),
    "Q4I": ("right", [0.34933, 0.35167, 0.35455, 0.35557, 0.35591]),
    "Q4D": ("right", [0.34022, 0.37132, 0.36043, 0.35723, 0.35637]),
    "OPT": ("left", [0.37370, 0.36302, 0.35739, 0.35620, 0.35604]),
    "Q8": ("right", [0.34955, 0.35482, 0.35569, 0.35594, 0.35602]),
    "Q9": ("right", [0.35208, 0.35533, 0.35586, 0.35600, 0.35605]),
}


def model(element: str, k: int, diagonal: Any = "right") -> Any:
    """Model of 4 x 1 cells, refined `k` times."""
    made = cantilever(
        element, 48.0, 12.0, 4 * 2**k, 2**k, E=30000.0, nu=0.25, rotation=False, diagonal=diagonal
    )
    made.loads += edge_forces(
        made.mesh, "right", lambda x: (0.0, 5.0 * (1.0 - (float(x[1]) / 6.0) ** 2))
    )
    return made


def tip(element: str, k: int, diagonal: Any = "right") -> float:
    """Work of the load over the load."""
    frame = linear(model(element, k, diagonal))
    return float((frame.F[:, 1] * frame.U[:, 1]).sum() / 40.0)


def measure() -> Iterator[Value]:
    """Every row to its last digit."""
    for element, (diagonal, row) in ROWS.items():
        for k, expected in enumerate(row):
            text = f"{element} {4 * 2**k} x {2**k}"
            yield Value(text, expected, tip(element, k, diagonal), 0.51e-5, "absolute")


def study() -> Study:
    """Error of the tip for every element."""
    cells = [4.0 * 4**k for k in range(5)]
    series = {
        element: (cells, [abs(tip(element, k, ROWS[element][0]) / 0.35605 - 1.0) for k in range(5)])
        for element in ROWS
    }
    return Study("error of the tip displacement", series, "cells")


PROBLEM = Problem(
    title="Short cantilever with parabolic shear",
    group="linear statics",
    source="C. A. Felippa, Comput. Methods Appl. Mech. Engrg 192 (2003); rows by an independent "
    "implementation of each element",
    certainty="computed independently",
    why="the last digit of the rows",
    picture=lambda: Picture(run(model("Q8", 2), ct.Static(nlgeom=False), fields=True), "S12"),
    seconds=1.3,
)
