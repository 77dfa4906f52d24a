"""A steel ring crushed between two rigid plates, and unloaded.

Mean radius 9.5, wall 1 (E 210000, nu 0.3, yield stress 300, hardening 1000; N, mm; plane strain).
Half of it is computed. Limit load of a rigid-plastic ring: 4 My / R with the plastic moment
My = s t^2 / 4, s = 2/sqrt(3) times the yield stress (J. A. DeRuntz, P. G. Hodge, 1963).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys

import numpy as np

import corota as ct
from corota.model.loads import Fixed

INNER, OUTER, DOWN, BACK, YIELD = 9.0, 10.0, 10.0, 0.25, 300.0


def ring(
    friction: float = 0.0, n: int = 60, ny: int = 4, element: str = "Q4I", unit: float = 1.0
) -> ct.Model:
    """Build half a ring, `n` cells around, and plates; `unit` is the length unit in mm."""
    low, high = INNER / unit, OUTER / unit
    half = ct.mesh.annulus(low, high, n_radial=ny, n_around=n, angle=180.0, start=-90.0)
    plate = ct.mesh.add_node(half, 0.0, high, name="plate")
    model = ct.Model(half, name="crushed ring")
    steel = ct.Mises(
        E=210e3 * unit**2, nu=0.3, yield_stress=YIELD * unit**2, isotropic=1000.0 * unit**2
    )
    model.section(
        "all",
        element=element,
        material=steel,
        plane="strain",
        thickness=1.0 / unit,
        local_strain="logarithmic",
    )
    for name in ("start", "end"):
        model.fix(name, y=None)
    wide = 2.0 * high
    # The ring lies to the left of the direction of each line.
    floor = ct.RigidCurve.line((-wide, -high), (wide, -high))
    roof = ct.RigidCurve.line((wide, high), (-wide, high), reference=plate)
    model.contact("outer", floor, friction=friction, name="floor")
    model.contact("outer", roof, friction=friction, name="roof")
    model.fix("plate", y=None, rotation=True)
    return model


def steps(unit: float = 1.0, way: float = DOWN) -> list[ct.Static]:
    """Down, and up until the ring is about to come free: from then on nothing holds it."""

    def at(y: float) -> list[Fixed]:
        return [Fixed("plate", 1, y / unit)]

    down = ct.Static(first_increment=0.2 / way, supports=at(-way), name="down")
    return [down, ct.Static(first_increment=0.01, supports=at(BACK - way), name="up")]


def run(
    friction: float = 0.0, unit: float = 1.0, way: float = DOWN, **options: int | str
) -> ct.Results:
    """Crush and relieve."""
    model = ring(friction, unit=unit, **options)  # type: ignore[arg-type]
    return ct.solve(model, steps(unit, way))


def limit_load() -> float:
    """Of the rigid-plastic ring."""
    radius, wall = 0.5 * (INNER + OUTER), OUTER - INNER
    return 4.0 * (2.0 / math.sqrt(3.0) * YIELD) * wall**2 / 4.0 / radius


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plot", metavar="FILE", help="draw force against way")
    args = parser.parse_args()
    results = run()
    force = -2.0 * np.array(results.history("RF2", at="plate"))
    way = -np.array(results.history("U2", at="plate"))
    early = float(np.interp(1.0, way[: int(np.argmax(way))], force[: int(np.argmax(way))]))
    sys.stdout.write(
        f"force after 1 mm {early:.1f} (limit load {limit_load():.1f}), greatest "
        f"{force.max():.1f};\n"
        f"largest plastic strain {results.nodal('PEEQ').max():.3f}; "
        f"{len(results.frames) - 1} increments, "
        f"{int(np.sum(results.history('iterations')))} iterations\n"
    )
    if args.plot:
        force_half = results.history("RF2", at="plate")
        force_half.plot(against=results.history("U2", at="plate"), path=args.plot)


if __name__ == "__main__":
    main()
