"""Stresses and frequencies of a spinning annulus.

A disc with a hole rotates steadily. With radii a and b and s = rho omega^2 the stresses of plane
stress are

    sigma_r = s (3 + nu) / 8 (a^2 + b^2 - a^2 b^2 / r^2 - r^2),
    sigma_t = s (3 + nu) / 8 (a^2 + b^2 + a^2 b^2 / r^2 - (1 + 3 nu) / (3 + nu) r^2),

see S. Timoshenko and J. N. Goodier, Theory of Elasticity, section 32. A quarter under the
centrifugal load gives them in a static step. The whole disc starts from that state, free and with
the velocity of the spin, and keeps it during the rotation: the initial state of a transient.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct

INNER, OUTER = 0.1, 0.4
YOUNG, POISSON, DENSITY, SPEED = 210e9, 0.3, 7850.0, 600.0


def annulus(cells: int = 12) -> ct.Model:
    """Build the quarter with twice as many elements around as across."""
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=cells, ny=2 * cells, cell="quad8")
    radius = INNER + (OUTER - INNER) * mesh.points[:, 0]
    angle = 0.5 * np.pi * mesh.points[:, 1]
    mesh.points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    model = ct.Model(mesh, name="rotor")
    model.section("all", element="Q8", material=ct.Elastic(YOUNG, POISSON, rho=DENSITY))
    model.fix("bottom", x=None)
    model.fix("top", y=None)
    model.loads.append(ct.model.BodyForce("", "centrifugal", (SPEED**2, 0.0, 0.0)))
    return model


def growth(cells: int = 12) -> tuple[float, float, float]:
    """Growth of the hole's radius, as computed and by the formula [m]; first frequency [1/s]."""
    model = annulus(cells)
    results = ct.solve(model, [ct.Static(nlgeom=False), ct.Frequency(modes=1, nlgeom=False)])
    hole = model.mesh.nodes_of("left")
    frame = next(f for f in results.frames if f.increment > 0)
    found = float(np.hypot(*frame.U[hole].T).mean())
    return found, hoop_at_hole() * INNER / YOUNG, float(results.modes[-1].factors[0])


def stresses(radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Radial and hoop stress by the formulas [Pa]."""
    factor = DENSITY * SPEED**2 * (3.0 + POISSON) / 8.0
    both, ring = INNER**2 + OUTER**2, (INNER * OUTER / radius) ** 2
    share = (1.0 + 3.0 * POISSON) / (3.0 + POISSON)
    return factor * (both - ring - radius**2), factor * (both + ring - share * radius**2)


def hoop_at_hole() -> float:
    """Hoop stress at the hole by the formula [Pa]."""
    return float(stresses(np.array([INNER]))[1][0])


def turn(increments: int = 120, turns: float = 0.5) -> ct.results.Results:
    """Follow the whole disc, free, from its steady state through some turns."""
    mesh = ct.mesh.annulus(INNER, OUTER, n_radial=4, n_around=24, cell="quad8")
    model = ct.Model(mesh, name="rotor")
    model.section("all", element="Q8", material=ct.Elastic(YOUNG, POISSON, rho=DENSITY))
    # Three dofs hold the disc while it is loaded; nothing else does, as the load balances.
    right, left = (int(np.argmin(np.abs(mesh.points @ [s, 0.0] - INNER))) for s in (1.0, -1.0))
    held = [ct.model.Fixed(np.array([n]), 1) for n in (right, left)]
    held.append(ct.model.Fixed(np.array([int(np.argmin(mesh.points[:, 1]))]), 0))
    spin = ct.model.BodyForce("", "centrifugal", (SPEED**2, 0.0, 0.0))
    model.velocity(spin=SPEED)
    load = ct.Static(loads=[spin], supports=held)
    free = ct.Dynamic(
        period=turns * 2.0 * np.pi / SPEED,
        increments=increments,
        scheme="energy_momentum",
        new_loads=True,
        new_supports=True,
        max_iterations=40,
    )
    return ct.solve(model, [load, free])


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    found, exact, frequency = growth()
    sys.stdout.write(f"growth of the hole {1e6 * found:.4f} um, formula {1e6 * exact:.4f} um\n")
    sys.stdout.write(f"hoop stress at the hole by the formula {hoop_at_hole() / 1e6:.2f} MPa\n")
    sys.stdout.write(f"first symmetric frequency at speed {frequency:.1f} Hz\n")


if __name__ == "__main__":
    main()
