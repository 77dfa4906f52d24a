"""A long cylinder pressed onto a rigid plane: Hertz's pressure and width of contact.

Quarter of a disc, radius 8, E 200, nu 0.3, force 10 per unit thickness. Theory: H. Hertz, J. reine
angew. Math. 92 (1881); the half width is sqrt(4 F R / (pi E*)) with E* = E in plane stress and
E / (1 - nu^2) in plane strain, the greatest pressure 2 F / (pi a). One geometrically linear
increment, as the theory.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable
from typing import Literal

import numpy as np

import corota as ct

RADIUS, YOUNG, NU, FORCE = 8.0, 200.0, 0.3, 10.0


def cylinder(
    plane: Literal["stress", "strain"], n: int = 24, element: str = "Q4I", unit: float = 1.0
) -> ct.Model:
    """Build the quarter disc; `n` cells along its sides, `unit` the size of the length unit."""
    R = RADIUS / unit

    def arc(first: float, last: float, power: float) -> Callable[[float], tuple[float, float]]:
        def at(t: float) -> tuple[float, float]:
            phi = math.radians(first + (last - first) * t**power)
            return R * math.cos(phi), R * math.sin(phi)

        return at

    # Cells grow away from the point of contact.
    quarter = ct.mesh.mapped(
        [
            arc(-90.0, -65.0, 1.5), arc(-65.0, 0.0, 1.0),
            lambda t: (R * t, 0.0), lambda t: (0.0, R * (t**1.8 - 1.0)),
        ],
        n, n, cell="quad8" if element.startswith("Q8") else "quad4",
    )  # fmt: skip
    model = ct.Model(quarter, name="hertz")
    material = ct.Elastic(E=YOUNG * unit**2, nu=NU)
    model.section("all", element=element, material=material, plane=plane, thickness=1.0 / unit)
    drilling = element in ("Q4D", "OPT")
    model.fix("left", y=None, rotation=drilling)
    # The rigid body lies to the left of the direction of the line: below it.
    floor = ct.RigidCurve.line((0.5 * R, -R), (-0.5 * R, -R))
    model.contact("bottom", floor)
    model.traction("top", y=-0.5 * FORCE * unit / R)
    return model


def theory(plane: str) -> tuple[float, float]:
    """Half width and greatest pressure."""
    modulus = YOUNG if plane == "stress" else YOUNG / (1.0 - NU**2)
    a = math.sqrt(4.0 * FORCE * RADIUS / (math.pi * modulus))
    return a, 2.0 * FORCE / (math.pi * a)


def measured(results: ct.Results, unit: float = 1.0) -> tuple[float, float]:
    """Half width from the second moment of the pressure, F a^2 / 4, and greatest pressure."""
    mesh = results.mesh
    nodes = mesh.nodes_of("bottom")
    nodes = nodes[np.argsort(mesh.points[nodes, 0])]
    x, p = mesh.points[nodes, 0], results.nodal("CPRESS")[nodes]
    a = 2.0 * math.sqrt(np.trapezoid(p * x**2, x) / np.trapezoid(p, x))
    middle = p > 0.5 * p.max()
    _, top = np.polyfit(x[middle] ** 2, p[middle] ** 2, 1)
    return a * unit, math.sqrt(top) / unit**2


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    sys.stdout.write("plane   element    n         a     Hertz        p0     Hertz  iterations\n")
    for plane in ("stress", "strain"):
        for element, n in (("Q4I", 24), ("Q4I", 48), ("Q8", 24), ("Q4D", 48)):
            results = ct.solve(cylinder(plane, n, element), ct.Static(nlgeom=False))
            (a, p), (wide, top) = measured(results), theory(plane)
            iterations = int(results.history("iterations")[-1])
            sys.stdout.write(
                f"{plane:8}{element:6}{n:6}{a:10.4f}{wide:10.4f}{p:10.4f}{top:10.4f}"
                f"{iterations:12}\n"
            )


if __name__ == "__main__":
    main()
