"""A cantilever up to its limit load, and the residual state after unloading.

A perfectly plastic strip 10 x 1 (E 1000, nu 0.3, yield stress 1, thickness 1) is bent by its tip.
The collapse load of beam theory is ``1 / (4 * 10)``, with a plastic hinge at the clamp. The tip
is displaced, not loaded, so that the peak needs no special control; then it is released.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import corota as ct
from corota.verification.plastic_models import cantilever

#: Limit load of beam theory.
LIMIT = 1.0 / 40.0
MOVE = 0.5


def run(element: str = "Q4I", ny: int = 6) -> tuple[list[tuple[float, float]], float]:
    """Tip displacement and force over the limit load by increment; the set that is left."""
    model = cantilever(element, ny, MOVE)
    left, right = model.mesh.nodes_of("left"), model.mesh.nodes_of("right")
    model.supports.clear()
    clamp = [ct.model.Fixed(left, 0), ct.model.Fixed(left, 1)]
    bend = ct.Static(
        nlgeom=False, first_increment=0.1, supports=[*clamp, ct.model.Fixed(right, 1, -MOVE)]
    )
    free = ct.Static(nlgeom=False, new_supports=True, supports=clamp)
    results = ct.solve(model, [bend, free])
    curve = [
        (-float(f.U[right, 1].mean()), -float(f.RF[right, 1].sum()) / LIMIT)
        for f in results.frames
        if f.step == 1
    ]
    return curve, -float(results.frames[-1].U[right, 1].mean())


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    curve, rest = run()
    sys.stdout.write("tip displacement  force / limit load\n")
    for row in curve:
        sys.stdout.write("{:16.4f} {:19.5f}\n".format(*row))
    sys.stdout.write(f"left after unloading: {rest:.4f}\n")


if __name__ == "__main__":
    main()
