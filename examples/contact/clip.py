"""A snap-fit clip is pushed past a rigid catch and pulled out again, with friction and yielding.

A polymer arm (E 2300, nu 0.38, yield stress 45, hardening 150; N, mm), 2 high and 4 thick, with a
hook of height 2. The catch is a rigid bar with round corners. The root moves by 9 to
the right and back; its reaction is the insertion force.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct
from corota.model.loads import Fixed

LENGTH, HEIGHT, WAY = 20.0, 2.0, 10.0
#: Upper contour: arm, steep retention face, flat top, slope that leads in.
CONTOUR = ((0.0, 2.0), (14.0, 2.0), (15.6, 4.0), (16.0, 4.0), (20.0, 1.4))


def clip(
    friction: float = 0.2, nx: int = 160, ny: int = 6, element: str = "Q4I", unit: float = 1.0
) -> ct.Model:
    """Build clip and catch; `unit` is the length unit in mm."""
    xs, ys = np.array(CONTOUR).T / unit
    length = LENGTH / unit

    def top(t: float) -> tuple[float, float]:
        return length * t, float(np.interp(length * t, xs, ys))

    body = ct.mesh.mapped(
        [
            lambda t: (length * t, 0.0),
            lambda t: (length, ys[-1] * t),
            top,
            lambda t: (0.0, ys[0] * t),
        ],
        nx,
        ny,
    )
    model = ct.Model(body, name="clip")
    polymer = ct.Mises(
        E=2300.0 * unit**2, nu=0.38, yield_stress=45.0 * unit**2, isotropic=150.0 * unit**2
    )
    model.section("all", element=element, material=polymer, thickness=4.0 / unit)
    corners = np.array([(20.5, 2.2), (20.5, 5.0), (23.0, 5.0), (23.0, 2.2)]) / unit
    catch = ct.RigidCurve.polyline(corners, closed=True, fillet=1.0 / unit)
    upper = np.vstack([body.edge_sets["top"], body.edge_sets["right"]])
    model.contact(upper, catch, friction=friction, name="hook")
    return model


def steps(unit: float = 1.0) -> list[ct.Static]:
    """Push in, then pull out."""
    held = [Fixed("left", 1, 0.0)]
    way = WAY / unit
    there = ct.Static(first_increment=0.1, supports=[*held, Fixed("left", 0, way)], name="in")
    back = ct.Static(first_increment=0.1, supports=[Fixed("left", 0, 0.0)], name="out")
    return [there, back]


def run(friction: float = 0.2, unit: float = 1.0, **options: int | str) -> ct.Results:
    """Push in and pull out."""
    return ct.solve(clip(friction, unit=unit, **options), steps(unit))  # type: ignore[arg-type]


def forces(results: ct.Results) -> tuple[float, float]:
    """Greatest force to push in and to pull out, in the force unit."""
    force = np.array(results.history("RF1", at="left"))
    step = np.array(results.history("step"))
    return float(force[step <= 1].max()), float(-force[step == 2].min())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plot", metavar="FILE", help="draw force against way")
    args = parser.parse_args()
    sys.stdout.write("friction  push in  pull out  increments  iterations\n")
    for friction in (0.0, 0.2):
        results = run(friction)
        into, out = forces(results)
        iterations = int(np.sum(results.history("iterations")))
        sys.stdout.write(
            f"{friction:8.1f}{into:9.2f}{out:10.2f}{len(results.frames) - 1:12}{iterations:12}\n"
        )
    if args.plot:
        force = results.history("RF1", at="left")
        force.plot(against=results.history("U1", at="left"), path=args.plot)


if __name__ == "__main__":
    main()
