"""Ironing: a round elastic die is pressed into a soft block and drawn across it.

Block 9 x 3, E 1; die of radius 1.5 with its lower arc on the block, E 10, nu 0.3, plane strain. The
die goes down by 0.3 and then 4 to the right, over many elements of the block; forces at its top.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys

import numpy as np

import corota as ct
from corota import plots
from corota.model import Fixed

RADIUS, DOWN, ACROSS = 1.5, 0.3, 4.0


def ironing(
    friction: float = 0.0, n: int = 12, element: str = "Q4I", unit: float = 1.0
) -> ct.Model:
    """Build block and die; `n` cells across the die, `unit` the size of the length unit."""
    size = 1.0 / unit
    half = math.radians(60.0)

    def arc(t: float) -> tuple[float, float]:
        phi = (2.0 * t - 1.0) * half
        return 2.5 * size + RADIUS * size * math.sin(phi), (
            3.0 + RADIUS * (1.0 - math.cos(phi))
        ) * size

    (left, low), (right, _) = arc(0.0), arc(1.0)
    high = 4.5 * size
    die = ct.mesh.mapped(
        [
            arc, lambda t: (right, low + (high - low) * t),
            lambda t: (left + (right - left) * t, high), lambda t: (left, low + (high - low) * t),
        ],
        n, n // 2,
    )  # fmt: skip
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

    def top(x: float, y: float) -> list[Fixed]:
        return [Fixed("die.top", 0, x / unit), Fixed("die.top", 1, y / unit)]

    return [
        ct.Static(first_increment=0.25, supports=top(0.0, -DOWN), name="down"),
        ct.Static(first_increment=0.05, supports=top(ACROSS, -DOWN), name="across"),
    ]


def run(friction: float = 0.0, unit: float = 1.0, **options: int | str) -> ct.Results:
    """Press and draw."""
    return ct.solve(ironing(friction, unit=unit, **options), steps(unit))  # type: ignore[arg-type]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plot", metavar="FILE", help="draw the forces on the die")
    args = parser.parse_args()
    sys.stdout.write("friction  down  across  across/down  increments  iterations\n")
    for friction in (0.0, 0.3):
        results = run(friction)
        step = np.array(results.history("step"))
        # The middle of the way, where the ends of the block are far.
        way = np.array(results.history("time")) - 1.0
        middle = (step == 2) & (way > 0.3) & (way < 0.7)
        down = -np.array(results.history("RF2", at="die.top"))[middle].mean()
        across = np.array(results.history("RF1", at="die.top"))[middle].mean()
        iterations = int(np.sum(results.history("iterations")))
        sys.stdout.write(
            f"{friction:8.1f}{down:7.3f}{across:8.3f}{across / down:13.3f}"
            f"{len(results.frames) - 1:12}{iterations:12}\n"
        )
    if args.plot:
        forces = [results.history(name, at="die.top") for name in ("RF1", "RF2")]
        plots.curve(forces, results.history("time"), path=args.plot)


if __name__ == "__main__":
    main()
