"""Contact models that examples and problems share: a cylinder on a plane, a die that irons."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal

import numpy as np

import corota as ct
from corota.mesh import EDGES
from corota.verification.models import DRILLING, cell

#: Hertz's cylinder: radius, modulus, Poisson's ratio, force a unit of thickness.
RADIUS, YOUNG, NU, FORCE = 8.0, 200.0, 0.3, 10.0
#: The die that irons: radius, ways down and across.
DIE, DOWN, ACROSS = 1.5, 0.3, 4.0


def quarter(
    radius: float, n: int, element: str, growth: float = 1.5, upper: bool = False
) -> ct.Mesh:
    """Right quarter of a disc about the origin, lower or upper, `n` cells along its sides.

    Cells grow away from the lowest (highest) point, with the power `growth` along the arc.
    """

    def arc(first: float, last: float, power: float) -> Callable[[float], tuple[float, float]]:
        def at(t: float) -> tuple[float, float]:
            phi = math.radians(first + (last - first) * t**power)
            return radius * math.cos(phi), radius * math.sin(phi)

        return at

    def flat(t: float) -> tuple[float, float]:
        return radius * t, 0.0

    power = growth + 0.3
    if upper:
        sides = [
            flat,
            arc(0.0, 65.0, 1.0),
            arc(90.0, 65.0, growth),
            lambda t: (0.0, radius * (1.0 - (1.0 - t) ** power)),
        ]
    else:
        sides = [
            arc(-90.0, -65.0, growth),
            arc(-65.0, 0.0, 1.0),
            flat,
            lambda t: (0.0, radius * (t**power - 1.0)),
        ]
    return with_middles(ct.mesh.mapped(sides, n, n, cell(element)), radius)


def with_middles(mesh: ct.Mesh, radius: float) -> ct.Mesh:
    """The mesh with the outer side nodes in the middle of their sides, which grow with a power.

    Those on the axes and on the circle of a radius about the origin.
    """
    for block in mesh.cells:
        for local in EDGES[block.kind]:
            if len(local) < 3:
                continue
            a, b, m = (mesh.points[block.nodes[:, i]] for i in local)
            middle = 0.5 * (a + b)
            ends = np.stack([np.hypot(*a.T), np.hypot(*b.T), np.hypot(*m.T)])
            curved = np.all(np.abs(ends - radius) < 1e-9 * radius, axis=0)
            middle[curved] *= radius / np.hypot(*middle[curved].T)[:, None]
            side = np.zeros(len(a), bool) | curved
            side |= np.all(np.abs([a[:, 0], b[:, 0]]) < 1e-12 * radius, axis=0)
            side |= np.all(np.abs([a[:, 1], b[:, 1]]) < 1e-12 * radius, axis=0)
            mesh.points[block.nodes[side, local[2]]] = middle[side]
    return mesh


def cylinder(
    plane: Literal["stress", "strain"], n: int = 24, element: str = "Q4I", unit: float = 1.0
) -> ct.Model:
    """Build the quarter disc; `n` cells along its sides, `unit` the size of the length unit."""
    R = RADIUS / unit
    model = ct.Model(quarter(R, n, element), name="hertz")
    material = ct.Elastic(E=YOUNG * unit**2, nu=NU)
    model.section("all", element=element, material=material, plane=plane, thickness=1.0 / unit)
    model.fix("left", y=None, rotation=element in DRILLING)
    # The cylinder lies to the left of the direction of the line: above it.
    floor = ct.RigidCurve.line((-0.5 * R, -R), (0.5 * R, -R))
    model.contact("bottom", floor)
    model.traction("top", y=-0.5 * FORCE * unit / R)
    return model


def theory(plane: str) -> tuple[float, float]:
    """Half width and greatest pressure."""
    modulus = YOUNG if plane == "stress" else YOUNG / (1.0 - NU**2)
    a = math.sqrt(4.0 * FORCE * RADIUS / (math.pi * modulus))
    return a, 2.0 * FORCE / (math.pi * a)


def measured(results: ct.Results, unit: float = 1.0) -> tuple[float, float]:
    """Half width from the second moment of the pressure, F a^2 / 4, and greatest pressure."""
    mesh = results.mesh
    nodes = mesh.nodes_of("bottom")
    nodes = nodes[np.argsort(mesh.points[nodes, 0])]
    x, p = mesh.points[nodes, 0], results.nodal("CPRESS")[nodes]
    a = 2.0 * math.sqrt(np.trapezoid(p * x**2, x) / np.trapezoid(p, x))
    middle = p > 0.5 * p.max()
    _, top = np.polyfit(x[middle] ** 2, p[middle] ** 2, 1)
    return a * unit, math.sqrt(top) / unit**2


def ironing(
    friction: float = 0.0, n: int = 12, element: str = "Q4I", unit: float = 1.0
) -> ct.Model:
    """Build block and die; `n` cells across the die, `unit` the size of the length unit."""
    size = 1.0 / unit
    half = math.radians(60.0)

    def arc(t: float) -> tuple[float, float]:
        phi = (2.0 * t - 1.0) * half
        return 2.5 * size + DIE * size * math.sin(phi), (3.0 + DIE * (1.0 - math.cos(phi))) * size

    (left, low), (right, _) = arc(0.0), arc(1.0)
    high = 4.5 * size
    die = ct.mesh.mapped(
        [
            arc,
            lambda t: (right, low + (high - low) * t),
            lambda t: (left + (right - left) * t, high),
            lambda t: (left, low + (high - low) * t),
        ],
        n,
        n // 2,
    )
    block = ct.mesh.rectangle(9.0 * size, 3.0 * size, nx=4 * n, ny=n)
    model = ct.Model(ct.mesh.assembly(block=block, die=die), name="ironing")
    soft, hard = (ct.Elastic(E=E * unit**2, nu=0.3) for E in (1.0, 10.0))
    model.section(
        "block",
        element=element,
        material=soft,
        plane="strain",
        thickness=size,
        local_strain="logarithmic",
    )
    model.section(
        "die",
        element=element,
        material=hard,
        plane="strain",
        thickness=size,
        local_strain="logarithmic",
    )
    model.contact("die.bottom", "block.top", friction=friction, name="die")
    model.fix("block.bottom")
    return model


def steps(unit: float = 1.0) -> list[ct.Static]:
    """Down, then across."""

    def top(x: float, y: float) -> list[ct.Fixed]:
        return [ct.Fixed("die.top", 0, x / unit), ct.Fixed("die.top", 1, y / unit)]

    return [
        ct.Static(first_increment=0.25, supports=top(0.0, -DOWN), name="down"),
        ct.Static(first_increment=0.05, supports=top(ACROSS, -DOWN), name="across"),
    ]


def ellipse_of(x: np.ndarray, p: np.ndarray) -> tuple[float, float]:
    """Half width and peak of the ellipse p^2 = p0^2 (1 - x^2/a^2) of pressures at places.

    The peak by least squares of the squares, the half width by the second moment, a^2 / 4.
    """
    inner = p > 0.2 * p.max()
    table = np.column_stack([np.ones(inner.sum()), x[inner] ** 2])
    square = np.linalg.lstsq(table, p[inner] ** 2, rcond=None)[0][0]
    order, fine = np.argsort(x), np.linspace(0.0, float(x.max()), 20001)
    q = np.interp(fine, x[order], p[order])
    return float(2.0 * np.sqrt((q * fine**2).sum() / q.sum())), float(np.sqrt(square))
