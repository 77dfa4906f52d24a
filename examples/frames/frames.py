"""Lee's frame, Williams' toggle, a deep arch and a column: paths of solids beside exact beams.

Each is a solid of quadratic elements; the exact values are those of extensible, shear-flexible
beams, from their differential equations. Nothing is tuned: every path takes default settings.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import corota as ct

#: Load factors at the limit points of the exact beams (Timoshenko; the arch inextensible).
EXACT = {
    "lee": (1.8544527, -0.93924896),
    "toggle": (33.847716, 31.246220),
    "arch": (0.8973090, -0.073055),
}


def node_at(mesh: ct.Mesh, x: float, y: float) -> int:
    """Index of the node at a place."""
    index = int(np.argmin(np.abs(mesh.points - [x, y]).sum(axis=1)))
    assert np.allclose(mesh.points[index], [x, y], atol=1e-9 * np.ptp(mesh.points))
    return index


def lee_frame(element: str = "Q8", load: float = 1.0, scale: float = 1.0) -> tuple[ct.Model, int]:
    """Lee's frame as a solid: two legs of 120, 2 deep and 3 wide, hinged on their centrelines.

    `scale` changes the unit of length; forces stay. The node under the load comes with it.
    """
    cell = {"Q8": "quad8", "Q9": "quad9", "Q4I": "quad4", "Q4D": "quad4"}[element]
    fine = 1 if cell != "quad4" else 2

    def part(a: float, b: float, x: float, y: float, nx: int, ny: int) -> ct.Mesh:
        mesh = ct.mesh.rectangle(a, b, nx=fine * nx, ny=fine * ny, cell=cell)
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
    model.fix([node_at(mesh, 0.0, 0.0)])
    model.fix([node_at(mesh, 120.0 * scale, 120.0 * scale)])
    loaded = node_at(mesh, 24.0 * scale, 120.0 * scale)
    model.force([loaded], y=-load)
    return model, loaded


def column(element: str = "Q8", length: float = 100.0, depth: float = 2.0, n: int = 20) -> ct.Model:
    """Cantilever column along x under a compression of 1 on its right end, E = 1000, nu = 0."""
    cell = {"Q8": "quad8", "Q9": "quad9", "Q4I": "quad4", "Q4D": "quad4", "OPT": "tri3"}[element]
    mesh = ct.mesh.rectangle(length, depth, nx=n, ny=2, cell=cell)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.0))
    model.fix("left")
    model.traction("right", x=-1.0 / depth)
    return model


def euler_load(length: float = 100.0, depth: float = 2.0, young: float = 1000.0) -> float:
    """Buckling load of the cantilever column, with shear and shortening.

    Engesser's form of the Timoshenko column with kappa = 5/6 and nu = 0; shortening enters at
    the order of the critical strain.
    """
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
    cell = {"Q8": "quad8", "Q9": "quad9"}[element]
    mesh = ct.mesh.rectangle(span, depth, nx=cells, ny=2, cell=cell)
    mesh.points[:, 1] += rise * mesh.points[:, 0] / span - depth / 2.0
    model = ct.Model(mesh)
    material = ct.Elastic(E=1.03e7, nu=0.3)
    model.section("all", element=element, material=material, thickness=width)
    model.fix("left")
    model.fix("right", y=None)
    apex = node_at(mesh, span, rise)
    model.force([apex], y=-load / 2.0)
    return model, apex


def deep_arch(element: str = "Q8", load: float = 1.0) -> tuple[ct.Model, int]:
    """Circular arch of 215 degrees, R = 100, EI = 1e6, depth 1: hinged left, clamped right."""
    cell = {"Q8": "quad8", "Q9": "quad9"}[element]
    mesh = ct.mesh.annulus(
        99.5, 100.5, n_radial=2, n_around=120, angle=215.0, cell=cell, start=90.0 - 107.5
    )
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=12e6, nu=0.0))
    model.fix("start")
    foot = np.radians(90.0 + 107.5)
    model.fix([node_at(mesh, 100.0 * np.cos(foot), 100.0 * np.sin(foot))])
    crown = node_at(mesh, 0.0, 100.0)
    model.force([crown], y=-load)
    return model, crown


def follow(name: str) -> tuple[ct.Results, int]:
    """Follow the path of ``lee``, ``toggle`` or ``arch`` past its limit points."""
    model, node, end = {
        "lee": lambda: (*lee_frame(), -62.0),
        "toggle": lambda: (*williams_toggle(), -0.7),
        "arch": lambda: (*deep_arch(load=1000.0), -124.0),
    }[name]()
    model.name = name
    path = ct.ArcLength(displacement=([node], "y", end))
    return ct.solve(model, ct.Static(path=path)), node


def buckle() -> tuple[ct.Results, int]:
    """Follow the column along its axis, through its Euler load and off to one side."""
    model = column("Q8", n=40)
    model.name = "column"
    tip = node_at(model.mesh, 100.0, 1.0)
    path = ct.ArcLength(displacement=([tip], "y", 70.0), switch=True)
    return ct.solve(model, ct.Static(path=path)), tip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=Path, help="folder for pictures of the paths")
    args = parser.parse_args()
    sys.stdout.write(f"{'':10}{'limit points':>24}{'exact beam':>24}{'increments':>12}\n")
    for name, exact in EXACT.items():
        results, node = follow(name)
        found = [p.factor for p in results.critical_points]
        row = "".join(f"{x:12.5g}" for x in (*found, *exact))
        sys.stdout.write(f"{name:10}{row}{len(results.frames) - 1:12}\n")
        if args.pictures:
            curve = results.history("U2", at=[node])
            curve.plot("load factor", path=args.pictures / f"{name}.png")
    results, tip = buckle()
    linear = ct.solve(column("Q8", n=40), ct.Buckle()).modes[0].factors[0]
    found = results.critical_points[0]
    sys.stdout.write(
        f"\ncolumn: {found.kind} at {found.factor:.6g}; linear buckling {linear:.6g}; "
        f"Euler with shear {euler_load():.6g}\n"
    )
    if args.pictures:
        curve = results.history("U2", at=[tip])
        curve.plot("load factor", path=args.pictures / "column.png")


if __name__ == "__main__":
    main()
