"""Lee's frame, Williams' toggle, a deep arch and a column as solids."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

import corota as ct
from corota.verification.models import cell, nearest


def lee_frame(element: str = "Q8", load: float = 1.0, scale: float = 1.0) -> tuple[ct.Model, int]:
    """Lee's frame as a solid: two legs of 120, 2 deep and 3 wide, hinged on their centerlines.

    `scale` changes the unit of length; forces stay. The node under the load comes with it.
    """
    fine = 2 if cell(element) == "quad4" else 1

    def part(a: float, b: float, x: float, y: float, nx: int, ny: int) -> ct.Mesh:
        mesh = ct.mesh.rectangle(a, b, nx=fine * nx, ny=fine * ny, cell=cell(element))
        return ct.mesh.move(mesh, shift=(x, y))

    mesh = ct.mesh.merge(
        part(2.0, 119.0, -1.0, 0.0, 2, 40),
        part(2.0, 2.0, -1.0, 119.0, 2, 2),
        part(23.0, 2.0, 1.0, 119.0, 8, 2),
        part(96.0, 2.0, 24.0, 119.0, 32, 2),
    )
    mesh = ct.mesh.move(mesh, scale=scale)
    model = ct.Model(mesh)
    material = ct.Elastic(E=720.0 / scale**2, nu=0.3)
    model.section("all", element=element, material=material, thickness=3.0 * scale)
    model.fix([nearest(mesh, 0.0, 0.0)])
    model.fix([nearest(mesh, 120.0 * scale, 120.0 * scale)])
    loaded = nearest(mesh, 24.0 * scale, 120.0 * scale)
    model.force([loaded], y=-load)
    return model, loaded


def column(element: str = "Q8", length: float = 100.0, depth: float = 2.0, n: int = 20) -> ct.Model:
    """Cantilever column along x under a compression of 1 on its right end, E = 1000, nu = 0."""
    mesh = ct.mesh.rectangle(length, depth, nx=n, ny=2, cell=cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.0))
    model.fix("left")
    model.traction("right", x=-1.0 / depth)
    return model


def euler_load() -> float:
    """Buckling load of the cantilever column, with shear and shortening.

    Engesser's form of the Timoshenko column with kappa = 5/6 and nu = 0; shortening enters at
    the order of the critical strain.
    """
    length, depth, young = 100.0, 2.0, 1000.0
    bending = young * depth**3 / 12.0
    euler = np.pi**2 * bending / (4.0 * length**2)
    return euler / (1.0 + euler / (5.0 / 6.0 * 0.5 * young * depth))


def williams_toggle(
    element: str = "Q8", load: float = 1.0, cells: int = 30
) -> tuple[ct.Model, int]:
    """Half of Williams' toggle as a solid: half span 12.943 in, rise .386, .753 x .243 bars.

    `load` is that of the whole; the node at the apex comes with the model.
    """
    span, rise, width, depth = 12.943, 0.386, 0.753, 0.243
    mesh = ct.mesh.rectangle(span, depth, nx=cells, ny=2, cell=cell(element))
    mesh.points[:, 1] += rise * mesh.points[:, 0] / span - depth / 2.0
    model = ct.Model(mesh)
    material = ct.Elastic(E=1.03e7, nu=0.3)
    model.section("all", element=element, material=material, thickness=width)
    model.fix("left")
    model.fix("right", y=None)
    apex = nearest(mesh, span, rise)
    model.force([apex], y=-load / 2.0)
    return model, apex


def deep_arch(element: str = "Q8", load: float = 1.0, cells: int = 120) -> tuple[ct.Model, int]:
    """Circular arch of 215 degrees, R = 100, EI = 1e6, depth 1: hinged left, clamped right."""
    mesh = ct.mesh.annulus(
        99.5, 100.5, n_radial=2, n_around=cells, angle=215.0, cell=cell(element), start=90.0 - 107.5
    )
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=12e6, nu=0.0))
    model.fix("start")
    foot = np.radians(90.0 + 107.5)
    model.fix([nearest(mesh, 100.0 * np.cos(foot), 100.0 * np.sin(foot))])
    crown = nearest(mesh, 0.0, 100.0)
    model.force([crown], y=-load)
    return model, crown
