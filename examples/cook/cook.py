"""Cook's membrane with every element, small and large load.

A tapered panel clamped at its left edge under a uniform shear at the right one (48 x 44/16,
E = 1, nu = 1/3, thickness 1). The linear tip displacement converges to 23.966 (Q9, 100 x 100
elements); the table shows each element on coarse meshes.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct
from corota.model import elements

#: Converged vertical displacement of the upper right corner's edge middle, linear.
REFERENCE = 23.966
#: Loads of the two tables.
UNIT, LARGE = 1.0, 0.5
MESHES = (2, 4, 8, 16)


def panel(n: int, cell: str) -> ct.Mesh:
    """Cook's panel with n by n cells; triangles split the quadrilaterals alternately."""
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=n, ny=n, cell=cell)
    s, t = mesh.points.T
    lower, upper = 44.0 * s, 44.0 + 16.0 * s
    mesh.points = np.column_stack([48.0 * s, lower + t * (upper - lower)])
    return mesh


def cook(element: str, n: int, load: float) -> ct.Model:
    """Build the panel under a total shear force on its right edge.

    Parameters
    ----------
    element : str
    n : int
        Cells along a side; even.
    load : float
        Total force [force].
    """
    model = ct.Model(panel(n, elements.find(element).cell), name="cook")
    model.section("all", element=element, material=ct.Elastic(E=1.0, nu=1.0 / 3.0))
    model.fix("left")
    model.traction("right", y=load / 16.0)
    return model


def tip(element: str, n: int, load: float, *, nlgeom: bool) -> float:
    """Vertical displacement at (48, 52), the middle of the loaded edge [length]."""
    model = cook(element, n, load)
    step = ct.Static(nlgeom=nlgeom, increments=5 if nlgeom else 1)
    frame = ct.solve(model, step, fields=False).frames[-1]
    node = int(np.argmin(np.abs(model.mesh.points - [48.0, 52.0]).sum(axis=1)))
    return float(frame.U[node, 1])


def linear_table() -> dict[str, list[float]]:
    """Tip displacements under a unit load by element, one for each of :data:`MESHES`."""
    return {name: [tip(name, n, UNIT, nlgeom=False) for n in MESHES] for name in elements.names()}


def large_table() -> dict[str, list[float]]:
    """Tip displacements under :data:`LARGE`, with large rotations."""
    return {name: [tip(name, n, LARGE, nlgeom=True) for n in MESHES] for name in elements.names()}


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    head = "".join(f"{n:>6} x {n:<4}" for n in MESHES)
    for title, rows in (
        (f"linear, load {UNIT:g} (converged {REFERENCE})", linear_table()),
        (f"large rotation, load {LARGE:g} (converged 9.686)", large_table()),
    ):
        sys.stdout.write(f"\n{title}\n{'element':<8}{head}\n")
        for name, values in rows.items():
            sys.stdout.write(f"{name:<8}" + "".join(f"{v:10.3f}   " for v in values) + "\n")


if __name__ == "__main__":
    main()
