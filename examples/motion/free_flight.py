"""Free flight: a spinning flexible rod, and a tumbling L-shaped block.

The bodies are unconstrained. A pulse acts on a corner for a short time; from then on linear
momentum,
angular momentum and energy must be constant.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path

from corota.verification.motion_models import block, drift, fly, rod

__all__ = ["block", "drift", "fly", "rod"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=Path, help="folder for animations in true time")
    args = parser.parse_args()
    for name, model in (("rod", rod()), ("block", block())):
        results = fly(model)
        sys.stdout.write(f"{name}: drift of the invariants in free flight\n")
        for what, value in drift(results).items():
            sys.stdout.write(f"  {what:18}{value:9.1e}\n")
        if args.pictures:
            from corota import plots

            plots.animate(results, "MISES", path=args.pictures / f"{name}.gif")


if __name__ == "__main__":
    main()
