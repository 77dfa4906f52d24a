"""A cantilever under a sine load at its tip, with each element and a time step that is halved.

The problem that T.-N. Le, J.-M. Battini and M. Hjiaj computed with beams (Comput. Methods Appl.
Mech. Engrg 200 (2011)): length 10 m, section 0.5 m by 0.25 m, E = 210 GPa, density 7850 kg/m^3,
a tip force of 10 MN sin(50 t). Here it is made of planar elements. The paths of the tip are
compared with one another as the time step is halved; no published numbers are used.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct

LENGTH, WIDTH, DEPTH = 10.0, 0.5, 0.25
YOUNG, POISSON, DENSITY, FORCE, OMEGA = 210e9, 0.3, 7850.0, 10e6, 50.0
PERIOD = 0.3
CELLS = {"OPT": "tri3", "Q8": "quad8"}


def cantilever(element: str = "Q4I", cells: int = 16) -> tuple[ct.Model, int]:
    """Build the model; returns it with the node in the middle of the tip."""
    mesh = ct.mesh.rectangle(LENGTH, DEPTH, nx=cells, ny=2, cell=CELLS.get(element, "quad4"))
    model = ct.Model(mesh, name="cantilever")
    material = ct.Elastic(E=YOUNG, nu=POISSON, rho=DENSITY)
    model.section("all", element=element, material=material, thickness=WIDTH)
    model.fix("left", rotation=True)
    time = np.linspace(0.0, PERIOD, 1501)
    model.amplitudes["sine"] = ct.Amplitude(time, np.sin(OMEGA * time))
    model.traction("right", y=FORCE / (WIDTH * DEPTH), amplitude="sine")
    tip = int(np.argmin(np.hypot(*(mesh.points - [LENGTH, DEPTH / 2.0]).T)))
    return model, tip


def path(element: str, increments: int, mass: str = "consistent", cells: int = 16) -> np.ndarray:
    """Displacement of the tip at 30 equal times, shape (30, 2) [m]."""
    model, tip = cantilever(element, cells)
    step = ct.Dynamic(period=PERIOD, increments=increments, scheme="energy_momentum", mass=mass)
    results = ct.solve(model, step, fields=False)
    every = increments // 30
    return np.array([f.U[tip] for f in results.frames[every::every]])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=16, help="elements along the length")
    args = parser.parse_args()
    sys.stdout.write("largest deflection [m] and change when the time step is halved\n")
    for element in ("Q4I", "Q8", "OPT", "Q4D"):
        runs = [path(element, n, cells=args.cells) for n in (60, 120, 240)]
        changes = [float(np.abs(a - b).max()) for a, b in zip(runs, runs[1:], strict=False)]
        sys.stdout.write(
            f"{element:4}{np.abs(runs[-1][:, 1]).max():9.4f}   {changes[0]:9.5f}{changes[1]:9.5f}\n"
        )


if __name__ == "__main__":
    main()
