"""Cells of lattices of beams: depth 1, E = 1, struts of length 1 and height t."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

import corota as ct

ROOT3 = np.sqrt(3.0)


def lattice(nodes: list[tuple[float, float]], struts: list[tuple[int, int]], t: float, n: int = 1):
    """Model of struts of n beams between nodes."""
    points = [np.array(p, float) for p in nodes]
    lines = []
    for first, last in struts:
        chain = [first]
        for k in range(1, n):
            points.append(points[first] + k / n * (points[last] - points[first]))
            chain.append(len(points) - 1)
        chain.append(last)
        lines += list(zip(chain[:-1], chain[1:], strict=True))
    cells = ct.mesh.Cells("line2", np.array(lines), np.arange(1, len(lines) + 1))
    model = ct.Model(ct.mesh.Mesh(np.array(points), [cells]))
    model.beam(
        np.arange(len(lines)), material=ct.Elastic(E=1.0, rho=1.0), area=t, inertia=t**3 / 12.0
    )
    return model


def square(t: float, n: int = 1) -> ct.PeriodicCell:
    model = lattice([(0, 0), (1, 0), (0, 1)], [(0, 1), (0, 2)], t, n)
    return ct.PeriodicCell(model, [(1.0, 0.0), (0.0, 1.0)])


def triangular(t: float, n: int = 1) -> ct.PeriodicCell:
    ends = [(0, 0), (1, 0), (0.5, ROOT3 / 2), (-0.5, ROOT3 / 2)]
    model = lattice(ends, [(0, 1), (0, 2), (0, 3)], t, n)
    return ct.PeriodicCell(model, [ends[1], ends[2]])


def honeycomb(t: float, n: int = 1) -> ct.PeriodicCell:
    """With vertical struts."""
    ends = [(0, 0), (0, -1), (ROOT3 / 2, 0.5), (-ROOT3 / 2, 0.5)]
    model = lattice(ends, [(0, 1), (0, 2), (0, 3)], t, n)
    return ct.PeriodicCell(model, [(ROOT3, 0.0), (ROOT3 / 2, 1.5)])
