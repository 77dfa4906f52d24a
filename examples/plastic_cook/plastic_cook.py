"""Cook's panel beyond yield with four kinds of elements on coarse meshes.

The tapered panel 48 x 44/16, clamped left, carries a shear force of 1.8 on its right edge
(E 70, nu 1/3, yield stress 0.243, linear hardening 0.135; kN, mm, plane stress).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct
from corota.verification.plastic_models import cook

ELEMENTS = ("Q4", "Q4I", "Q8", "Q4D", "OPT")
MESHES = (4, 8, 16)


def tip(element: str, n: int) -> float:
    """Vertical displacement of the upper right corner [mm]."""
    model = cook(element, n)
    results = ct.solve(model, ct.Static(first_increment=0.2))
    corner = int(np.argmin(np.abs(model.mesh.points - [48.0, 60.0]).sum(axis=1)))
    return float(results.frames[-1].U[corner, 1])


def table() -> dict[str, list[float]]:
    """Displacements by element, one for each of :data:`MESHES`."""
    return {name: [tip(name, n) for n in MESHES] for name in ELEMENTS}


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    sys.stdout.write("element " + "".join(f"{n:>7} x {n:<3}" for n in MESHES) + "\n")
    for name, values in table().items():
        sys.stdout.write(f"{name:<8}" + "".join(f"{v:10.3f}   " for v in values) + "\n")


if __name__ == "__main__":
    main()
