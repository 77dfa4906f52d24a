"""Square array of holes in rubber: onset of its pattern, and the negative Poisson's ratio after it.

Holes of diameter 8.67 mm at a distance of 9.97 mm, in plane strain, pressed along y and free to
extend along x: the array of T. Mullin, S. Deschanel, K. Bertoldi, M. C. Boyce, *Pattern
transformation triggered by deformation*, Phys. Rev. Lett. 99 (2007) 084301. One cell gives the
load at which any Bloch wave loses its stiffness; the first has a period of 2 x 2 cells: the holes
become ellipses across each other. Four cells with that wave as a small imperfection follow it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys

import numpy as np

import corota as ct

#: Radius of the holes over their distance.
RADIUS = 4.335 / 9.97


def square_with_hole(radius: float, n: int) -> ct.Mesh:
    """Unit square with a hole in its middle: four patches, n elements around each."""

    def patch(quarter: int) -> ct.Mesh:
        c, s = math.cos(0.5 * math.pi * quarter), math.sin(0.5 * math.pi * quarter)
        turn = np.array([[c, s], [-s, c]])

        def inner(t):  # from -45 to 45 degrees
            angle = 0.5 * math.pi * (np.asarray(t) - 0.5)
            return 0.5 + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1) @ turn

        def outer(t):
            t = np.asarray(t)
            return 0.5 + np.stack([0.5 + 0.0 * t, t - 0.5], axis=-1) @ turn

        def between(end: float):
            a, b = inner(end), outer(end)
            return lambda t: a + np.multiply.outer(np.asarray(t), b - a)

        return ct.mesh.mapped(
            [between(0.0), outer, between(1.0), inner], max(n // 2, 1), n, "quad9"
        )

    return ct.mesh.merge(*(patch(quarter) for quarter in range(4)))


def cell(n: int = 8, bulk: float = 100.0) -> ct.PeriodicCell:
    """Cell of a neo-Hookean rubber with shear modulus 1."""
    model = ct.Model(square_with_hole(RADIUS, n))
    rubber = ct.NeoHooke(C10=0.5, D1=2.0 / bulk)
    model.section("all", element="Q9", material=rubber, plane="strain")
    return ct.PeriodicCell(model)


def pressed(of: ct.PeriodicCell, strain: float, largest: float = 0.1) -> ct.Results:
    """Compression along y, free along x."""
    of.drive([[None, 0.0], [0.0, -strain]])
    step = ct.Static(first_increment=largest, largest_increment=largest)
    return ct.solve(of.model, step, fields=False)


def onset(n: int = 8, bulk: float = 100.0) -> tuple[ct.PeriodicCell, ct.cells.Onset]:
    """First pattern among waves of periods up to four cells."""
    one = cell(n, bulk)
    return one, one.onset(pressed(one, 0.06), 4)


def patterned(one: ct.PeriodicCell, found: ct.cells.Onset, size: float) -> ct.PeriodicCell:
    """2 x 2 cells with the wave as an imperfection."""
    four = one.repeat(2, 2)
    model = four.base.copy()
    model.imperfection(one.pattern(four, found), [size])
    return ct.PeriodicCell(model, four.vectors)


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    say = sys.stdout.write
    say("elements around   strain at onset, period\n")
    for n in (4, 8, 12):
        one, found = onset(n)
        period = " x ".join(f"{1.0 / k:.0f}" for k in found.wave)
        say(f"{4 * n:15d} {-found.gradient[1, 1]:17.5f}, {period}\n")
    one, found = onset(6)
    four = patterned(one, found, 1e-3)
    results = pressed(four, 0.1, 0.05)
    say("strain along y   strain along x   stress over shear modulus   ratio\n")
    for k in range(0, len(results.frames), 4):
        h, p = four.gradient(results, k), four.stress(results, k)
        before = four.gradient(results, max(k - 1, 0))
        change = h - before
        ratio = -change[0, 0] / change[1, 1] if k else math.nan
        say(f"{h[1, 1]:14.4f} {h[0, 0]:16.4f} {p[1, 1]:27.5f} {ratio:7.3f}\n")


if __name__ == "__main__":
    main()
