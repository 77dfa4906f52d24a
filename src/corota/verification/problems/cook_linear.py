"""Cook's membrane: a tapered panel, clamped left, under a shear force on its right side.

Corners (0, 0), (48, 44), (48, 60), (0, 44), thickness 1, E = 1, nu = 1/3, a uniformly distributed
force of 1. It combines bending and shear on skew cells. The value is the vertical displacement of
(48, 52).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import corota as ct
from corota.model import elements
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import cook, linear, run

#: Element, diagonals, rotations clamped, and the displacement for 2, 4, 8, ... elements per side.
ROWS = [
    ("Q4", "right", False, [11.8452, 18.2992, 22.0792, 23.4304, 23.8176]),
    ("Q4I", "right", False, [21.0503, 23.0164, 23.6888, 23.8833, 23.9398]),
    ("Q8", "right", False, [22.7177, 23.7083, 23.8837, 23.9346, 23.9551]),
    ("Q9", "right", False, [23.2887, 23.8397, 23.9254, 23.9494, 23.9608]),
    ("Q4D", "right", False, [22.27, 23.36, 23.77, 23.90]),
    ("Q4D", "right", True, [21.40, 23.07, 23.63]),
    ("OPT", "left", False, [20.5644, 22.4495, 23.4323, 23.7987, 23.9115]),
    ("OPT", "left", True, [19.49]),
]
#: Extrapolated from Q9 meshes up to 100 x 100.
CONVERGED = 23.9664


def tip(element: str, n: int, diagonal: str = "alternate", clamp: bool = False) -> float:
    """Vertical displacement of (48, 52)."""
    model, node = cook(element, n, diagonal=diagonal, clamp=clamp)  # type: ignore[arg-type]
    return float(linear(model).U[node, 1])


def measure() -> Iterator[Value]:
    """Every row of the table to its last digit, and a fine mesh."""
    for element, diagonal, clamp, row in ROWS:
        digits = 4 if any(round(v, 2) != v for v in row) else 2
        for k, expected in enumerate(row):
            n = 2 ** (k + 1)
            text = f"{element} {n} x {n}" + (", rotations clamped" if clamp else "")
            found = tip(element, n, diagonal, clamp)
            yield Value(text, expected, found, 0.51 * 10.0**-digits, "absolute")
    yield Value("Q9 64 x 64, converged value", CONVERGED, tip("Q9", 64), 1e-4)


def study() -> Study:
    """Error of the tip for every element."""
    series = {}
    for element in ("T3", "Q4", "Q4I", "OPT", "Q4D", "T6", "Q8", "Q8R", "Q9"):
        dofs, errors = [], []
        for n in (2, 4, 8, 16, 32):
            model, node = cook(element, n)
            frame = linear(model)
            dofs.append(frame.U.size + (len(frame.UR) if elements.find(element).drilling else 0))
            errors.append(abs(float(frame.U[node, 1]) / CONVERGED - 1.0))
        series[element] = (dofs, errors)
    return Study("error of the tip displacement", series)


PROBLEM = Problem(
    title="Cook's membrane, linear",
    group="linear statics",
    source="R. D. Cook, J. Struct. Div. ASCE 100 (1974); rows of the elements by an independent "
    "implementation of each, the converged value by Q9 meshes up to 100 x 100",
    certainty="computed independently",
    why="rows: the last printed digit; the converged value within the mesh error at a corner "
    "that is singular",
    picture=lambda: Picture(run(cook("Q8", 8)[0], ct.Static(nlgeom=False), fields=True)),
    seconds=2.2,
)
