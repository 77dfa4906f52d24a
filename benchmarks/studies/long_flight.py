"""Momenta and energy of a spinning flexible body over a great many increments.

A free block of two elements spins and vibrates; the energy-momentum scheme takes ``--steps``
increments (100,000 by default). Printed at each power of ten and at the end: the largest
deviations of linear momentum, angular momentum and energy from their first values, relative to
mass times speed, angular momentum and energy of the body. ``--element``, ``--mass``,
``--tolerance``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import warnings

import numpy as np

import corota as ct
from corota.results.observer import BaseObserver
from corota.results.results import Frame


def body(element: str) -> ct.Model:
    """Build the free block, which flies, spins and stretches."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section("all", element=element, material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    # Slowly: forces are judged against the rounding of the displacements.
    model.velocity(spin=1.0, x=0.003, about=(1.0, 0.5))
    return model


class Watch(BaseObserver):
    """Keep the largest deviations and print them at powers of ten."""

    def __init__(self, steps: int) -> None:
        self.steps, self.count = steps, 0
        self.first = np.zeros(4)
        self.size = np.ones(4)
        self.drift = np.zeros(4)

    def increment(self, frame: Frame) -> None:
        """Compare with the first increment."""
        s = frame.scalars
        if "momentum x" not in s:
            return
        now = np.array(
            [s["momentum x"], s["momentum y"], s["angular momentum"], s["energy balance"]]
        )
        if self.count == 0:
            kinetic, mass = s["kinetic energy"], 2.0
            speed = np.sqrt(2.0 * kinetic * mass)
            self.first, self.size = now, np.array([speed, speed, abs(now[2]), kinetic])
        self.count += 1
        self.drift = np.maximum(self.drift, np.abs(now - self.first) / self.size)
        power = np.log10(self.count)
        if power == round(power) or self.count % 20000 == 0 or self.count == self.steps:
            linear, angular, energy = self.drift[:2].max(), self.drift[2], self.drift[3]
            sys.stdout.write(
                f"{self.count:7d} increments: linear momentum {linear:.1e}, "
                f"angular {angular:.1e}, energy {energy:.1e}\n"
            )
            sys.stdout.flush()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=100_000)
    parser.add_argument("--element", default="Q4I")
    parser.add_argument("--mass", default="consistent")
    parser.add_argument("--tolerance", type=float, default=1e-12)
    args = parser.parse_args()
    step = ct.Dynamic(
        period=0.02 * args.steps,
        increments=args.steps,
        scheme="energy_momentum",
        mass=args.mass,
        tolerance=args.tolerance,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ct.solve(
            body(args.element),
            step,
            observers=[Watch(args.steps)],
            threads=1,
            keep="last",
            fields=False,
        )


if __name__ == "__main__":
    main()
