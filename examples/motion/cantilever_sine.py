"""A cantilever under a sine load at its tip, with each element and two time steps.

The problem that T.-N. Le, J.-M. Battini and M. Hjiaj computed with beams (Comput. Methods Appl.
Mech. Engrg 200 (2011)): length 10 m, section 0.5 m by 0.25 m, E = 210 GPa, density 7850 kg/m^3,
a tip force of 10 MN sin(50 t). Here it is made of planar elements. The paths of the tip are
compared with one another as the time step is halved; no published numbers are used.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

from corota.verification.motion_models import sine_path as path


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=16, help="elements along the length")
    args = parser.parse_args()
    sys.stdout.write("largest deflection [m] and change when the time step is halved\n")
    for element in ("Q4I", "Q8", "OPT", "Q4D"):
        runs = [path(element, n, cells=args.cells) for n in (60, 120, 240)]
        changes = [float(np.abs(a - b).max()) for a, b in zip(runs, runs[1:], strict=False)]
        sys.stdout.write(
            f"{element:4}{np.abs(runs[-1][:, 1]).max():9.4f}   {changes[0]:9.5f}{changes[1]:9.5f}\n"
        )


if __name__ == "__main__":
    main()
