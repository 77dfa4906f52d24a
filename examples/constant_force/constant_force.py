"""A constant-force flexure, found by its shape with exact gradients.

A curved beam is clamped at one end and guided at the other, which moves down by 3 mm. A straight
beam would resist more and more; a curved one snaps. Between both lies a shape whose force stays the
same over most of the way: it protects what it presses on, without a sensor. The rise of the center
line and the depth at four stations are found by :func:`corota.optimize`; each design is one
analysis with the gradients of the forces at all increments.

The result is analyzed again on a mesh twice as fine.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import corota as ct
from corota import gradients

#: Span, way of the guided end, wanted force [mm, N]; sheet [mm] of nylon [MPa].
SPAN, WAY, FORCE = 40.0, 3.0, 1.0
SHEET, YOUNG, POISSON = 5.0, 1800.0, 0.4
#: Increments of the way, and the first whose force counts.
INCREMENTS, FIRST = 10, 4
#: Rise of the center line and depths at four stations [mm]: start and bounds. The clamped end is
#: thin: shapes that are stiff at both ends have even forces too, but buckle on the way.
START = (5.0, 0.5, 0.7, 0.9, 1.1)
BOUNDS = ((0.2, 8.0), (0.4, 0.6), *(((0.4, 1.6),) * 3))


def flexure(x: np.ndarray, cells: int = 16) -> ct.Model:
    """Build the flexure of a rise and four depths."""
    rise, depths = x[0], np.asarray(x[1:])
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=cells, ny=1, cell="quad8")
    s, across = mesh.points[:, 0], mesh.points[:, 1] - 0.5
    stations = np.linspace(0.0, 1.0, len(depths))
    # Depths follow the cubic through the stations, so that sides stay smooth.
    powers = np.vander(stations, increasing=True)
    depth = np.vander(s, len(depths), increasing=True) @ np.linalg.solve(powers, depths)
    height = 0.5 * rise * (1.0 - np.cos(np.pi * s))
    slope = 0.5 * rise * np.pi / SPAN * np.sin(np.pi * s)
    size = np.hypot(1.0, slope)
    mesh.points = np.column_stack(
        [SPAN * s - across * depth * slope / size, height + across * depth / size]
    )
    model = ct.Model(mesh, name="constant force")
    material = ct.Elastic(E=YOUNG, nu=POISSON)
    model.section("all", element="Q8R", material=material, thickness=SHEET)
    model.fix("left")
    model.fix("right", y=-WAY)
    model.steps = [ct.Static(increments=INCREMENTS, fixed_increments=True)]
    return model


def uneven() -> gradients.Measure:
    """Sum of squares of the forces' differences from the wanted one, relative to it."""
    frames = range(FIRST, INCREMENTS + 1)
    forces = [gradients.Reaction("right", "y", frame=k) for k in frames]
    parts = [(force / -FORCE - 1.0) ** 2.0 for force in forces]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total / float(len(parts))


def optimum(most: int = 40, cells: int = 16, **options: object) -> gradients.Optimum:
    """Find the flexure from the start."""

    def build(x: np.ndarray) -> ct.Model:
        return flexure(x, cells)

    return ct.optimize(build, START, uneven(), bounds=BOUNDS, most=most, **options)


def forces(x: np.ndarray, cells: int = 16) -> np.ndarray:
    """Forces over the way [N]."""
    results = ct.solve(flexure(x, cells))
    return -np.asarray(results.history("RF2", at="right"))


def main(arguments: list[str] | None = None) -> int:
    """Optimize, print the forces before and after, and draw the shape."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("constant_force"))
    given = parser.parse_args(arguments)
    given.out.mkdir(parents=True, exist_ok=True)

    def show(number: int, design: gradients.Design) -> None:
        print(f"design {number}: objective {design.values[0]:.3e}")

    found = optimum(record=given.out / "designs.jsonl", progress=show)
    print(found)
    print("rise and depths [mm]:", np.round(found.x, 3))
    rows = zip(
        np.linspace(0.0, WAY, INCREMENTS + 1), forces(np.array(START)), forces(found.x),
        forces(found.x, 32), strict=True,
    )  # fmt: skip
    print("way [mm], force before, after, on a finer mesh [N]")
    for way, before, after, finer in rows:
        print(f"{way:5.2f} {before:9.4f} {after:9.4f} {finer:9.4f}")
    results = ct.solve(flexure(found.x, 32))
    print("stable on the whole way:", bool(results.history("stable").min() > 0.0))
    results.plot("MISES", path=given.out / "shape.png")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
