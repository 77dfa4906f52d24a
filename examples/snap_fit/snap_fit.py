"""A snap-fit clip that is deflected too far: it yields and springs back with a permanent set.

A tapered arm, 15 long, 2.4 high at its root and 1.2 at its hook, polymer (E 2300, nu 0.38, yield
stress 45, hardening 150; N, mm), is deflected by 2 as it slides over a catch, and released. The
first deflection is elastic, the second one of 4 yields at the root.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct

LENGTH, ROOT, TIP = 15.0, 2.4, 1.2


def clip(nx: int = 30, ny: int = 4) -> ct.Model:
    """Build the arm, clamped at its root."""
    shape = [(0.0, 0.0), (LENGTH, ROOT - TIP), (LENGTH, ROOT), (0.0, ROOT)]
    model = ct.Model(ct.mesh.mapped(shape, nx, ny), name="snap fit")
    polymer = ct.Mises(E=2300.0, nu=0.38, yield_stress=45.0, isotropic=150.0)
    model.section("all", element="Q4I", material=polymer, thickness=4.0)
    model.fix("left")
    return model


def run(pushes: tuple[float, ...] = (2.0, 4.0)) -> list[tuple[float, float, float, float]]:
    """Push, greatest force, set after release and largest plastic strain of each push."""
    model = clip()
    hook = np.array([int(np.argmin(np.abs(model.mesh.points - [LENGTH, ROOT]).sum(axis=1)))])
    steps: list[ct.Static] = []
    for push in pushes:
        down = ct.model.Fixed(hook, 1, -push)
        steps.append(ct.Static(first_increment=0.25, supports=[down]))
        # The hook is free again: its force fades out over the step.
        steps.append(ct.Static(first_increment=0.25, new_supports=True, supports=_root(model)))
    results = ct.solve(model, steps)
    rows = []
    for number, push in enumerate(pushes):
        pushed = [f for f in results.frames if f.step == 2 * number + 1]
        freed = [f for f in results.frames if f.step == 2 * number + 2][-1]
        rows.append(
            (
                push,
                max(abs(float(f.RF[hook[0], 1])) for f in pushed),
                -float(freed.U[hook[0], 1]),
                float(freed.fields[0].values["PEEQ"].max()),
            )
        )
    return rows


def _root(model: ct.Model) -> list[ct.model.Fixed]:
    left = model.mesh.nodes_of("left")
    return [ct.model.Fixed(left, 0, 0.0), ct.model.Fixed(left, 1, 0.0)]


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    sys.stdout.write("push     force       set  largest PEEQ\n")
    for row in run():
        sys.stdout.write("{:4.1f} {:9.3f} {:9.4f} {:13.5f}\n".format(*row))


if __name__ == "__main__":
    main()
