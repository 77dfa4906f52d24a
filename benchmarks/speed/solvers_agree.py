"""Another linear solver against the default one: the same values and iterations in the catalogue.

``python -m benchmarks solvers_agree petsc`` runs a part of the verification catalogue, of all kinds
of problems, with each solver: displacements and rotations of every frame must agree to a relative
1e-9 of the largest in the analysis (reactions of parts that expand freely are rounding). ``--only``
names problems. Ends with 1 if one differs.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import warnings
from typing import Any

import numpy as np

import corota.analysis.run as analysis
from benchmarks.common import report
from benchmarks.speed.before_after import QUICK
from corota.analysis.linear.solvers import SOLVERS, make_solver
from corota.verification.catalogue import problems

#: Values may differ by this share of the largest of their kind in the analysis.
TOLERANCE = 1e-9
#: Rotations below are compared with this one [rad].
SMALL_ROTATION = 1e-6
NAMES = [*QUICK["catalogue"], "plate_with_hole", "strip_footing", "ring_impact"]


def runs(name: str, solver: str) -> list[Any]:
    """Results of all analyses that a problem makes."""
    found: list[Any] = []

    class Watched(analysis.Analysis):
        def run(self) -> Any:
            results = super().run()
            found.append(results)
            return results

    before = analysis.Analysis, analysis.make_solver
    analysis.Analysis = Watched  # type: ignore[misc]
    analysis.make_solver = lambda *_: make_solver(solver)  # type: ignore[assignment]
    for module in [m for k, m in sys.modules.items() if k.startswith("corota.verification")]:
        for item in vars(module).values():  # problems keep their results
            if hasattr(item, "cache_clear"):
                item.cache_clear()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            list(problems()[name].measure())
    finally:
        analysis.Analysis, analysis.make_solver = before  # type: ignore[misc]
    return found


def difference(ours: Any, theirs: Any) -> tuple[float, str]:
    """Largest relative difference of two results, and what differs otherwise."""
    if len(ours.frames) != len(theirs.frames):
        return float("inf"), f"{len(ours.frames)} and {len(theirs.frames)} frames"
    worst, said = 0.0, ""
    for kind in ("U", "UR"):
        pairs = [
            (getattr(a, kind, None), getattr(b, kind, None))
            for a, b in zip(ours.frames, theirs.frames, strict=True)
        ]
        arrays = [(a, b) for a, b in pairs if a is not None and np.size(a)]
        size = max((float(np.abs(a).max()) for a, _ in arrays), default=0.0)
        size = max(size, SMALL_ROTATION) if kind == "UR" else size
        if size > 0.0:
            worst = max([worst, *(float(np.abs(a - b).max()) / size for a, b in arrays)])
    counts = [
        [frame.scalars.get("iterations", 0.0) for frame in results.frames]
        for results in (ours, theirs)
    ]
    if counts[0] != counts[1]:
        said = f"{sum(counts[0]):g} and {sum(counts[1]):g} iterations"
    return worst, said


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("solver", choices=[name for name in SOLVERS if name != "multifrontal"])
    parser.add_argument("--only", nargs="+", default=NAMES)
    args = parser.parse_args()
    rows: list[list[object]] = []
    failed = 0
    for name in args.only:
        ours, theirs = runs(name, "multifrontal"), runs(name, args.solver)
        found = [difference(a, b) for a, b in zip(ours, theirs, strict=True)]
        worst = max((value for value, _ in found), default=0.0)
        said = "; ".join(dict.fromkeys(text for _, text in found if text))
        failed += worst > TOLERANCE or not sum(len(r.frames) for r in ours)
        rows.append([name, len(found), sum(len(r.frames) for r in ours), f"{worst:.1e}", said])
        sys.stdout.write(f"{rows[-1]}\n")
        sys.stdout.flush()
    head = ["problem", "analyses", "frames", "largest difference", "otherwise"]
    report(f"multifrontal and {args.solver}", head, rows)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
