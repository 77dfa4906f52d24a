"""A bistable beam is pushed by a rigid probe and snaps to its second shape.

Cosine beam: span 100, height 4, depth 1, width 5 (E 2000, nu 0.3; N, mm, s, t), clamped at both
ends; a round probe moves down by 7 on its middle in a tenth of a second. Half of the beam is
computed, so it cannot tilt, like the double beams of switches. For slender beams
the largest force is 740 E I h / L^3, the force vanishes after 4 h / 3, and the second shape is
1.99 h below the first (J. Qiu, J. Lang, A. Slocum, J. Microelectromech. Syst. 13 (2004)).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable

import numpy as np

import corota as ct
from corota.model.loads import Fixed

SPAN, HEIGHT, DEPTH, WIDTH, RADIUS, DOWN = 100.0, 4.0, 1.0, 5.0, 5.0, 7.0
YOUNG = 2000.0


def beam(nx: int = 40, ny: int = 2, element: str = "Q4I", unit: float = 1.0) -> ct.Model:
    """Build half a beam and the probe; `unit` is the length unit in mm."""

    def curve(offset: float) -> Callable[[float], tuple[float, float]]:
        def at(t: float) -> tuple[float, float]:
            rise = 0.5 * HEIGHT * (1.0 + math.cos(math.pi * t))
            return 0.5 * SPAN * t / unit, (rise + offset) / unit

        return at

    def upright(t: float, x: float, y: float) -> tuple[float, float]:
        return x / unit, (y + (t - 0.5) * DEPTH) / unit

    body = ct.mesh.mapped(
        [
            curve(-0.5 * DEPTH),
            lambda t: upright(t, 0.5 * SPAN, 0.0),
            curve(0.5 * DEPTH),
            lambda t: upright(t, 0.0, HEIGHT),
        ],
        nx,
        ny,
    )
    top = (HEIGHT + 0.5 * DEPTH + RADIUS) / unit
    probe = ct.mesh.add_node(body, 0.0, top, name="probe")
    model = ct.Model(body, name="bistable beam")
    material = ct.Elastic(E=YOUNG * unit**2, nu=0.3, rho=1e-9 * unit**4)
    model.section("all", element=element, material=material, thickness=WIDTH / unit)
    drilling = element in ("Q4D", "OPT")
    model.fix("left", y=None, rotation=drilling)
    model.fix("right", rotation=drilling)
    tip = ct.RigidCurve.arc((0.0, top), RADIUS / unit, 45.0, -180.0, reference=probe)
    model.contact("top", tip, name="probe")
    model.fix("probe", y=None, rotation=True)
    return model


def run(unit: float = 1.0, **options: int | str) -> ct.Results:
    """Push slowly, a dozen periods of the beam, which a little damping brings to rest."""
    down = ct.Dynamic(
        period=0.1,
        alpha=-0.3,
        ramp=True,
        rayleigh=(500.0, 0.0),
        supports=[Fixed("probe", 1, -DOWN / unit)],
    )
    return ct.solve(beam(unit=unit, **options), down)  # type: ignore[arg-type]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--plot", metavar="FILE", help="draw the force of the probe against its way"
    )
    args = parser.parse_args()
    results = run()
    force = -2.0 * np.array(results.history("RF2", at="probe"))
    way = -np.array(results.history("U2", at="probe"))
    last = int(np.flatnonzero(force > 0.0)[-1])
    middle = -np.array(results.history("U2", at="left"))
    theory = 740.0 * YOUNG * WIDTH * DEPTH**3 / 12.0 * HEIGHT / SPAN**3
    sys.stdout.write(
        f"greatest force {force.max():.3f} (theory {theory:.3f}); leaves the probe after "
        f"{way[last]:.2f} ({4.0 / 3.0 * HEIGHT:.2f});\n"
        f"second shape {middle[-1]:.2f} below ({1.99 * HEIGHT:.2f}); "
        f"{int(np.sum(results.history('iterations')))} iterations\n"
    )
    if args.plot:
        load = results.history("RF2", at="probe")
        load.plot(against=results.history("U2", at="probe"), path=args.plot)


if __name__ == "__main__":
    main()
