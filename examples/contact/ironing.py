"""Ironing: a round elastic die is pressed into a soft block and moved across it.

Block 9 x 3, E 1; die of radius 1.5 with its lower arc on the block, E 10, nu 0.3, plane strain. The
die moves down by 0.3 and then 4 to the right, over many elements of the block; forces at its top.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct
from corota import plots
from corota.verification.contact_models import ironing, steps


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
