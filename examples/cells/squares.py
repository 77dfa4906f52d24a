"""Rotating squares that fold onto their neighbors: contact across the border of a cell.

Squares of side a, one in each cell, are linked by struts of length l from the upper right corner of
each to the lower left one of the next along x, and from the upper left to the lower right one along
y. Pressed alike along x and y, all turn by an angle t without force. The distance p of their
centers follows from the length of the struts,

    l^2 = (p - a (cos t - sin t))^2 + a^2 (cos t + sin t)^2,

until the corners meet the sides of the neighbors, where p cos t = a: l = a + sqrt(p^2 - a^2). So
the squares close at p^2 = a^2 + (l - a)^2. Pressed further they turn back along each other, and
the struts are shortened: the mean stress is the derivative of their energy.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys

import numpy as np

import corota as ct

#: Side of the squares, length of the struts, and force of these per strain.
SIDE, LENGTH, STRUT = 1.0, 1.25, 1.0
#: Distance of the squares at the start, where their sides are along the axes, and where they close.
START = SIDE + math.sqrt(LENGTH**2 - SIDE**2)
CLOSED = math.hypot(SIDE, LENGTH - SIDE)
#: Closing strain.
STRAIN = 1.0 - CLOSED / START


def cell(n: int = 4, stiff: float = 1e6) -> ct.PeriodicCell:
    """A square with n x n elements, `stiff` times as stiff as the struts, and its two struts."""
    square = ct.mesh.rectangle(SIDE, SIDE, nx=n, ny=n)
    corner = {
        (x, y): int(np.argmin(np.abs(square.points - [x, y]).sum(axis=1)))
        for x in (0.0, SIDE)
        for y in (0.0, SIDE)
    }
    # The struts end at nodes of the next cells: one node of the periodic body with the corners.
    ends = [corner[0.0, 0.0], corner[SIDE, 0.0]]
    points = np.vstack([square.points, square.points[ends] + [[START, 0.0], [0.0, START]]])
    lines = np.array([[corner[SIDE, SIDE], len(points) - 2], [corner[0.0, SIDE], len(points) - 1]])
    struts = ct.mesh.Cells("line2", lines, n * n + 1 + np.arange(2))
    mesh = ct.mesh.Mesh(points, [*square.cells, struts], edge_sets=dict(square.edge_sets))
    model = ct.Model(mesh)
    body, strut = ct.Elastic(E=stiff * STRUT, nu=0.3), ct.Elastic(E=STRUT, nu=0.0)
    model.section(np.arange(n * n), element="Q4", material=body)
    model.truss(n * n + np.arange(2), material=strut, area=1.0)
    model.contact("right", "left", method="node_to_segment")
    model.contact("top", "bottom", method="node_to_segment")
    return ct.PeriodicCell(model, [(START, 0.0), (0.0, START)])


def pressed(of: ct.PeriodicCell, strain: float, increments: int = 20) -> ct.Results:
    """Compression alike along x and y."""
    of.drive([[-strain, 0.0], [0.0, -strain]])
    return ct.solve(of.model, ct.Static(increments=increments), fields=False)


def stress(strain: float) -> float:
    """Mean nominal stress along x and y of rigid squares."""
    p = START * (1.0 - strain)
    if p >= CLOSED:
        return 0.0
    slid = math.sqrt(p**2 - SIDE**2)
    return STRUT / START * (SIDE + slid - LENGTH) / LENGTH * p / slid


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    say = sys.stdout.write
    one = cell()
    say(f"the squares close at a strain of {STRAIN:.6f}\n")
    say("strain over that      stress   that of rigid squares\n")
    for share in (0.5, 0.99999, 1.00001, 1.01, 1.03):
        found = one.stress(pressed(one, share * STRAIN))
        say(f"{share:16.5f} {found[0, 0]:11.8f} {stress(share * STRAIN):23.8f}\n")


if __name__ == "__main__":
    main()
