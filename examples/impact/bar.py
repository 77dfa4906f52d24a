"""An elastic bar hits a rigid wall: one contact of duration 2 L / c, then rebound.

The exact solution: the bar is compressed with the force rho c A v for the time 2 L / c that the
wave takes to the free end and back, and leaves with its initial velocity. A time scheme
whose contact force acts on nodes with mass creates energy instead, and chatters; here other nodes
of the elements carry the mass of the contact nodes.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

from corota.verification.impact_models import run_bar as run
from corota.verification.impact_models import strike

__all__ = ["run", "strike"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=200, help="elements along the bar")
    args = parser.parse_args()
    sys.stdout.write("over the exact values: contacts, duration, force, rebound, energy\n")
    for element in ("Q4I", "Q8", "OPT", "Q4D"):
        hit = strike(element, cells=args.cells)
        sys.stdout.write(
            f"{element:4}{hit.contacts:4d}{hit.duration:9.4f}{hit.force:9.4f}{hit.rebound:9.4f}"
            f"{hit.energy:9.4f}\n"
        )


if __name__ == "__main__":
    main()
