"""A strip with a hole under large plastic strain.

Quarter of an aluminium strip 20 x 36 with a hole of radius 5 (E 70000, nu 0.2, yield stress 243,
linear hardening 2240; N, mm), thickness 1. The top is moved by a sixth of the strip's half height:
the ligament yields, necks and thins. The local strain is logarithmic, so that the strains may be
large. The plastic strain controls the increments.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import corota as ct
from corota.verification.plastic_models import find, perforated_strip

PULL = 3.0


def strip(element: str = "Q4I", n: int = 10) -> ct.Model:
    """Quarter of the strip with `n` cells along an eighth of the hole."""
    return perforated_strip(element, n, pull=PULL, local_strain="logarithmic", thickness=1.0)


def run(element: str = "Q4I", n: int = 10) -> list[tuple[float, float, float, float]]:
    """Elongation, force, largest plastic strain and smallest thickness by increment."""
    model = strip(element, n)
    results = ct.solve(model, ct.Static(first_increment=0.02, plastic_increment=0.1))
    top = find(model.mesh, 1, 18.0)
    rows = []
    for frame in results.frames:
        fields = frame.fields[0].values
        force = float(frame.RF[top, 1].sum())
        rows.append(
            (
                float(frame.U[top[0], 1]),
                force,
                float(fields["PEEQ"].max()),
                float(fields["STH"].min()),
            )
        )
    return rows


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    sys.stdout.write("elongation      force  largest PEEQ  smallest thickness\n")
    for row in run():
        sys.stdout.write("{:10.3f} {:10.1f} {:13.4f} {:19.4f}\n".format(*row))


if __name__ == "__main__":
    main()
