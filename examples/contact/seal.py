"""A rubber tube pressed into a groove by a round rib until its inner walls are in contact.

Outer radius 4, wall 0.8 (E 5, nu 0.45; N, mm; plane strain), in a groove with round corners, under
a rigid rib of radius 1.5 that moves down by 6.8. Half of it is computed; the inner surface has
self-contact.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct
from corota.model.loads import Fixed

INNER, OUTER, WIDTH, DOWN, RIB = 3.2, 4.0, 4.6, 6.8, 1.5


def seal(n: int = 60, ny: int = 4, element: str = "Q4S", unit: float = 1.0) -> ct.Model:
    """Build half a tube, `n` cells around; `unit` is the length unit in mm."""
    low, high, wide = INNER / unit, OUTER / unit, WIDTH / unit
    half = ct.mesh.annulus(low, high, n_radial=ny, n_around=n, angle=180.0, start=-90.0)
    rib = ct.mesh.add_node(half, 0.0, high + RIB / unit, name="rib")
    model = ct.Model(half, name="seal")
    rubber = ct.Elastic(E=5.0 * unit**2, nu=0.45)
    model.section(
        "all",
        element=element,
        material=rubber,
        plane="strain",
        thickness=1.0 / unit,
        local_strain="logarithmic",
    )
    for name in ("start", "end"):
        model.fix(name, y=None)
    # The tube lies to the left of both: inside the groove, outside the rib.
    groove = ct.RigidCurve.polyline(
        [(-high, -high), (wide, -high), (wide, 3.0 * high)], fillet=1.0 / unit
    )
    round_ = ct.RigidCurve.arc((0.0, high + RIB / unit), RIB / unit, 45.0, -180.0, reference=rib)
    model.contact("outer", groove, name="groove")
    model.contact("outer", round_, name="rib")
    model.contact("inner", "inner", name="inside")
    model.fix("rib", y=None, rotation=True)
    return model


def run(unit: float = 1.0, **options: int | str) -> ct.Results:
    """Press the rib down."""
    down = ct.Static(first_increment=0.05, supports=[Fixed("rib", 1, -DOWN / unit)])
    return ct.solve(seal(unit=unit, **options), down)  # type: ignore[arg-type]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plot", metavar="FILE", help="draw the seal")
    args = parser.parse_args()
    results = run()
    force = -2.0 * np.array(results.history("RF2", at="rib"))
    inside = np.array(results.history("inside: area"))
    way = -np.array(results.history("U2", at="rib"))
    first = way[np.argmax(inside > 0.0)] if inside.any() else np.nan
    sys.stdout.write(
        f"walls touch after {first:.2f}; force {force[-1]:.2f} at {way[-1]:.2f}; "
        f"{len(results.frames) - 1} increments, "
        f"{int(np.sum(results.history('iterations')))} iterations\n"
    )
    if args.plot:
        results.plot("MISES", path=args.plot)


if __name__ == "__main__":
    main()
