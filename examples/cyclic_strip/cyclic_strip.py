"""Bars and strips under load cycles: the Bauschinger effect and ratcheting.

A steel strip (E 206000, nu 0.3, yield stress 250 and two back-stresses, 60000/400 and 4000/10)
is cycled between unequal stresses: each cycle leaves additional strain (ratcheting). With
linear kinematic hardening the loops close instead.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct

CYCLES = 5
#: Highest and lowest mean stress of a cycle [MPa].
HIGH, LOW = 340.0, -240.0


def strip(material: ct.Mises) -> ct.Model:
    """Strip 20 x 4, held left so that it may thin; its axis is guided, or it would buckle."""
    model = ct.Model(ct.mesh.rectangle(20.0, 4.0, 10, 2), name="cyclic strip")
    model.section("all", element="Q4I", material=material, thickness=1.0)
    model.fix("left", y=None)
    axis = np.flatnonzero(np.isclose(model.mesh.points[:, 1], 2.0))
    model.fix(axis, x=None)
    return model


def materials() -> dict[str, ct.Mises]:
    """The two steels by name."""
    common = {"E": 206000.0, "nu": 0.3, "yield_stress": 250.0}
    return {
        "two back-stresses": ct.Mises(**common, chaboche=[(60000.0, 400.0), (4000.0, 10.0)]),
        "linear kinematic": ct.Mises(**common, kinematic=12000.0),
    }


def run(material: ct.Mises, cycles: int = CYCLES) -> list[float]:
    """Mean axial strain at the top of each cycle."""
    model = strip(material)
    steps = []
    for _ in range(cycles):
        for stress in (HIGH, LOW):
            load = ct.model.EdgeLoad("right", "traction", (stress, 0.0))
            steps.append(ct.Static(first_increment=0.2, loads=[load], new_loads=True))
    results = ct.solve(model, steps)
    right = model.mesh.nodes_of("right")
    tops = [f for f in results.frames if f.factor == 1.0 and f.step % 2 == 1]
    return [float(f.U[right, 0].mean()) / 20.0 for f in tops]


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    for name, material in materials().items():
        strains = " ".join(f"{100 * e:8.4f}" for e in run(material))
        sys.stdout.write(f"{name:<18} strain at the tops [%]: {strains}\n")


if __name__ == "__main__":
    main()
