"""A notch hinge bent by a moment on the drilling rotation of one node, in both drilling elements.

A block of PEEK, 36 x 7 x 10 mm, necked to 1 mm by two notches of radius 6 (mm, N, MPa). Beam
theory with the height varying along the hinge (J. M. Paros and L. Weisbord, *How to design flexure
hinges*, Machine Design 37, 1965) gives the rotation for comparison: bending without shear
force, so the moment is uniform and large rotations have no effect.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import sys

import numpy as np

import corota as ct

YOUNG, POISSON, THICKNESS = 3700.0, 0.4, 10.0
RADIUS, NECK, HEIGHT, LENGTH = 6.0, 1.0, 7.0, 36.0
#: Half the angle that the notch takes of its circle.
ANGLE = math.acos(1.0 - (HEIGHT - NECK) / (2.0 * RADIUS))
MOMENT = 200.0


def height(x: np.ndarray) -> np.ndarray:
    """Height of the hinge at a distance from the neck [length]."""
    inside = np.abs(x) < RADIUS * math.sin(ANGLE)
    arc = np.sqrt(np.maximum(RADIUS**2 - x**2, 0.0))
    return np.where(inside, NECK + 2.0 * (RADIUS - arc), HEIGHT)


def beam_rotation(moment: float) -> float:
    """Rotation of one end against the other by beam theory [rad]."""
    n = 20_000
    turn = ANGLE * (2.0 * (np.arange(n) + 0.5) / n - 1.0)
    stiffness = YOUNG * THICKNESS * height(RADIUS * np.sin(turn)) ** 3 / 12.0
    hinge = np.sum(RADIUS * np.cos(turn) / stiffness) * 2.0 * ANGLE / n
    blocks = (LENGTH - 2.0 * RADIUS * math.sin(ANGLE)) / (YOUNG * THICKNESS * HEIGHT**3 / 12.0)
    return moment * float(hinge + blocks)


def hinge(element: str) -> ct.Model:
    """Build the hinge, held on the left, with the moment at the middle of the right end."""
    cell = "quad4" if element == "Q4D" else "tri3"
    mesh = ct.mesh.rectangle(32.0, 2.0, nx=32, ny=8, cell=cell)
    edge = RADIUS * math.sin(ANGLE)
    stations = np.concatenate(
        [
            np.linspace(-LENGTH / 2.0, -edge, 7)[:-1],
            RADIUS * np.sin(np.linspace(-ANGLE, ANGLE, 21)),
            np.linspace(edge, LENGTH / 2.0, 7)[1:],
        ]
    )
    x = stations[np.rint(mesh.points[:, 0]).astype(int)]
    mesh.points = np.column_stack([x, 0.5 * height(x) * (mesh.points[:, 1] - 1.0)])
    model = ct.Model(mesh, name="flexure")
    material = ct.Elastic(E=YOUNG, nu=POISSON)
    model.section("all", element=element, material=material, thickness=THICKNESS)
    model.fix("left")
    model.force([middle(mesh)], moment=MOMENT)
    return model


def middle(mesh: ct.Mesh) -> int:
    """Node in the middle of the right end."""
    return int(np.argmin(np.abs(mesh.points - [LENGTH / 2.0, 0.0]).sum(axis=1)))


def rotation(results: ct.Results) -> float:
    """Rotation of the right end, from its corners [rad]."""
    mesh = results.mesh
    end = mesh.nodes_of("right")
    low, high = (end[pick(mesh.points[end, 1])] for pick in (np.argmin, np.argmax))
    side = (mesh.points + results.frames[-1].U)[high] - (mesh.points + results.frames[-1].U)[low]
    return math.atan2(-side[0], side[1])


def main() -> dict[str, float]:
    expected = beam_rotation(MOMENT)
    sys.stdout.write(f"beam theory  {math.degrees(expected):7.3f} degrees\n")
    found = {}
    for element in ("Q4D", "OPT"):
        found[element] = rotation(ct.solve(hinge(element), ct.Static(increments=5)))
        ratio = found[element] / expected
        sys.stdout.write(f"{element:<11}  {math.degrees(found[element]):7.3f}   {ratio:.3f}\n")
    return found


if __name__ == "__main__":
    main()
