"""A flexible pendulum over ten periods, with its energy.

A rod of length 1 hangs on a pin at its lower corner and is released horizontally. Its center is
then a little above the pin, by the angle e = atan(depth / length). As a rigid body with the
diagonal R it has the period 4 K(m) sqrt(2 R / (3 g)), where K is the complete elliptic integral
of parameter m = sin^2((pi / 2 + e) / 2); that of the flexible one is close.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np
from scipy.special import ellipk

import corota as ct

LENGTH, DEPTH, GRAVITY = 1.0, 0.02, 9.81
START = 0.5 * np.pi + np.arctan(DEPTH / LENGTH)
RIGID = (
    4.0
    * float(ellipk(np.sin(0.5 * START) ** 2))
    * np.sqrt(2.0 * np.hypot(LENGTH, DEPTH) / (3.0 * GRAVITY))
)


def pendulum(element: str = "Q4D", young: float = 2e7) -> tuple[ct.Model, int]:
    """Build the rod pinned at its lower left corner; returns it with a node of the tip."""
    cell = "tri3" if element == "OPT" else "quad4"
    mesh = ct.mesh.rectangle(LENGTH, DEPTH, nx=10, ny=1, cell=cell)
    model = ct.Model(mesh, name="pendulum")
    model.section("all", element=element, material=ct.Elastic(E=young, nu=0.3, rho=1.0))
    model.fix([int(np.argmin(np.hypot(*mesh.points.T)))])
    model.gravity(y=-GRAVITY)
    return model, int(mesh.nodes_of("right")[0])


def swing(periods: float = 10.0, per_period: int = 120, element: str = "Q4D") -> ct.Results:
    """Swing with the energy-momentum scheme."""
    model, _ = pendulum(element)
    step = ct.Dynamic(
        period=periods * RIGID, increments=round(periods * per_period), scheme="energy_momentum"
    )
    return ct.solve(model, step, fields=False)


def measured(results: ct.Results) -> float:
    """Mean period: the time between passages of the tip through the middle to the left."""
    tip = int(results.model.mesh.nodes_of("right")[0])
    x = LENGTH + np.array([f.U[tip, 0] for f in results.frames])
    time = np.array([f.time for f in results.frames])
    k = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))
    crossings = time[k] + (time[k + 1] - time[k]) * x[k] / (x[k] - x[k + 1])
    return float(np.diff(crossings).mean())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--periods", type=float, default=10.0)
    args = parser.parse_args()
    results = swing(args.periods)
    late = results.frames[1:]
    kinetic = max(f.scalars["kinetic energy"] for f in late)
    balance = np.ptp([f.scalars["energy balance"] for f in late])
    sys.stdout.write(f"period {measured(results):.5f} s, of a rigid rod {RIGID:.5f} s\n")
    sys.stdout.write(f"drift of the energy over its exchange {balance / kinetic:.1e}\n")


if __name__ == "__main__":
    main()
