"""Lee's frame, Williams' toggle, a deep arch and a column: paths of solids against exact beams.

Each is a solid of quadratic elements; the exact values are those of extensible, shear-flexible
beams, from their differential equations. Every path uses default settings.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path

import corota as ct
from corota.verification.frame_models import (
    column,
    deep_arch,
    euler_load,
    lee_frame,
    williams_toggle,
)
from corota.verification.models import nearest

#: Load factors at the limit points of the exact beams (Timoshenko; the arch inextensible).
EXACT = {
    "lee": (1.8544527, -0.93924896),
    "toggle": (33.847716, 31.246220),
    "arch": (0.8973090, -0.073055),
}


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
    tip = nearest(model.mesh, 100.0, 1.0)
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
