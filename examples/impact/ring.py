"""A ring, elastic or plastic, hits a rigid wall; its energies over time.

Four elements, the consistent inertia, the energy-momentum scheme and contact by Lagrange
multipliers. The final energy-balance error is due to scheme and contact.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

from corota.verification.impact_models import Flight, fly, mass_of, ring
from corota.verification.impact_models import run_ring as run

__all__ = ["Flight", "fly", "mass_of", "ring", "run"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--around", type=int, default=64, help="elements around the ring")
    args = parser.parse_args()
    sys.stdout.write(
        "material element  rebound  kinetic   strain  plastic balance  shape  iterations\n"
    )
    for plastic in (False, True):
        for element in ("Q4I", "Q8", "OPT", "Q4D"):
            f = fly(element, plastic=plastic, speed=1.0, around=args.around, increments=0)
            sys.stdout.write(
                f"{'yielding' if plastic else 'elastic':9}{element:7}{f.rebound:9.4f}"
                f"{f.kinetic:9.4f}{f.strain:9.4f}{f.plastic:9.4f}{f.energy_error:9.1e}{f.squash:7.3f}"
                f"{f.iterations:7.1f}\n"
            )


if __name__ == "__main__":
    main()
