"""Hexachiral lattice: Poisson's ratio near -1, and the bands of its waves.

Rigid rings of radius r with six ligaments each, tangent to rings on opposite sides (D. Prall, R. S.
Lakes, Int. J. Mech. Sci. 39 (1997) 305-314). Under an equal strain e both ways all rings turn by
the same angle p and the ligaments, of length L, bend to an S. By hand, with the distance R of the
rings, ``R^2 = L^2 + 4 r^2``, the energy of a ligament is

    EA / (2 L) (e L - 2 r p)^2 + 6 EI / L (p + 2 e r / L)^2

in which p makes it smallest; three ligaments and the area ``sqrt(3) R^2 / 2`` give the bulk
modulus. For slender ligaments ``E = sqrt(3) / 2 E_s (t / L)^3 (R / r)^2``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys

import numpy as np

import corota as ct
from corota.cells import elastic_constants

#: Radius of the rings, and their distance.
RADIUS, DISTANCE = 0.2, 1.0
#: Length of the ligaments.
LENGTH = math.sqrt(DISTANCE**2 - 4.0 * RADIUS**2)


def cell(height: float, n: int = 4) -> ct.PeriodicCell:
    """One ring with six halves of ligaments of n beams; E = 1, density 1, depth 1."""
    points, lines, ring = [np.zeros(2)], [], []
    tilt = math.asin(2.0 * RADIUS / DISTANCE)
    for angle in np.arange(6) * math.pi / 3.0:
        end = 0.5 * DISTANCE * np.array([math.cos(angle), math.sin(angle)])
        along = np.array([math.cos(angle - tilt), math.sin(angle - tilt)])
        start = end - 0.5 * LENGTH * along
        first = len(points)
        ring.append(first)
        points += [start + k / n * (end - start) for k in range(n + 1)]
        lines += [(first + k, first + k + 1) for k in range(n)]
    mesh = ct.mesh.Mesh(
        np.array(points), [ct.mesh.Cells("line2", np.array(lines), np.arange(1, 6 * n + 1))]
    )
    model = ct.Model(mesh)
    law = ct.Elastic(E=1.0, rho=1.0)
    model.beam(np.arange(6 * n), material=law, area=height, inertia=height**3 / 12.0)
    model.rigid(ring, 0)
    vectors = DISTANCE * np.array([[1.0, 0.0], [0.5, 0.5 * math.sqrt(3.0)]])
    return ct.PeriodicCell(model, vectors)


def bulk_modulus(height: float) -> float:
    """Bulk modulus in the plane by hand."""
    stretch, bend = height, height**3 / 12.0
    turn = (2.0 * RADIUS * stretch * LENGTH - 24.0 * bend * RADIUS / LENGTH) / (
        4.0 * RADIUS**2 * stretch + 12.0 * bend
    )
    energy = stretch / (2.0 * LENGTH) * (LENGTH - 2.0 * RADIUS * turn) ** 2
    energy += 6.0 * bend / LENGTH * (turn + 2.0 * RADIUS / LENGTH) ** 2
    return 3.0 * energy / (math.sqrt(3.0) * DISTANCE**2)


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    say = sys.stdout.write
    say("height / length   Young's modulus   ratio   bulk modulus / by hand\n")
    for share in (0.02, 0.05, 0.1):
        height = share * LENGTH
        found = elastic_constants(cell(height).tangent())
        bulk = 0.5 * found["E1"] / (1.0 - found["nu12"])
        say(
            f"{share:15.2f} {found['E1']:17.4e} {found['nu12']:7.4f} "
            f"{bulk / bulk_modulus(height):24.12f}\n"
        )
    several = cell(0.05 * LENGTH).repeat(2, 2)
    several.drive([[0.15, 0.0], [0.0, None]])
    results = ct.solve(several.model, ct.Static())
    wide = several.gradient(results)
    say(f"stretched by {wide[0, 0]:.2f} it widens by {wide[1, 1]:.4f}\n")
    waves = cell(0.05 * LENGTH).waves()
    say("lowest frequencies at the corner of the zone (1/3, 1/3):\n")
    say(" ".join(f"{f:.5f}" for f in waves.frequencies([[1.0 / 3.0, 1.0 / 3.0]], 6)[0]) + "\n")


if __name__ == "__main__":
    main()
