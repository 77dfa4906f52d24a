"""A long cylinder pressed onto a rigid plane: Hertz's pressure and width of contact.

Quarter of a disc, radius 8, E 200, nu 0.3, force 10 per unit thickness. Theory: H. Hertz, J. reine
angew. Math. 92 (1881); the half width is sqrt(4 F R / (pi E*)) with E* = E in plane stress and
E / (1 - nu^2) in plane strain, the largest pressure 2 F / (pi a). One geometrically linear
increment, as in the theory.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from typing import Any, Literal

import corota as ct
from corota.verification.contact_models import cylinder, measured, theory

__all__ = ["cylinder", "measured", "run", "theory"]


def run(
    plane: Literal["stress", "strain"] = "strain", unit: float = 1.0, **options: Any
) -> ct.Results:
    """Press, in one geometrically linear increment."""
    return ct.solve(cylinder(plane, unit=unit, **options), ct.Static(nlgeom=False))


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    sys.stdout.write("plane   element    n         a     Hertz        p0     Hertz  iterations\n")
    for plane in ("stress", "strain"):
        for element, n in (("Q4I", 24), ("Q4I", 48), ("Q8", 24), ("Q4D", 48)):
            results = run(plane, n=n, element=element)
            (a, p), (wide, top) = measured(results), theory(plane)
            iterations = int(results.history("iterations")[-1])
            sys.stdout.write(
                f"{plane:8}{element:6}{n:6}{a:10.4f}{wide:10.4f}{p:10.4f}{top:10.4f}"
                f"{iterations:12}\n"
            )


if __name__ == "__main__":
    main()
