"""Balance error of every verification problem and example.

Usage::

    python -m benchmarks.energy_balance [NAME ...] [--markdown]

Each analysis of a problem leaves its largest error of the energy account over its largest energy;
the worst of a problem is shown, with how many of its analyses are above 1e-3. Names choose
problems of the catalogue, or examples by their path (``examples/motion/pendulum.py``).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import runpy
import sys
import warnings
from pathlib import Path
from typing import Any

from corota.analysis.run import Analysis
from corota.verification import catalogue, runner

ROOT = Path(__file__).resolve().parents[1]
#: Error that counts as small.
SMALL = 1e-3


def watch() -> list[tuple[str, float]]:
    """Let every analysis note its scheme and balance error."""
    found: list[tuple[str, float]] = []
    run = Analysis.run

    def measured(self: Analysis) -> Any:
        try:
            return run(self)
        finally:
            account = getattr(self, "energies", None)
            if account is not None:
                found.append((account.scheme, account.error))

    Analysis.run = measured  # type: ignore[method-assign]
    return found


def main(names: list[str]) -> None:
    """Print one row for each problem and example."""
    markdown = "--markdown" in names
    names = [name for name in names if not name.startswith("--")]
    found = watch()
    every = [
        *catalogue.problems(),
        *(str(p.relative_to(ROOT)) for p in sorted((ROOT / "examples").rglob("*.py"))),
    ]
    heads = ("problem", "analyses", "worst error", "scheme", "above 1e-3")
    row = "| {} | {} | {} | {} | {} |" if markdown else "{:42s} {:>9} {:>12} {:20s} {}"
    print(row.format(*heads))
    if markdown:
        print("|---|---|---|---|---|")
    for name in names or every:
        found.clear()
        note = ""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                if name.endswith(".py"):
                    runpy.run_path(str(ROOT / name), run_name="__main__")
                else:
                    runner.measure(name)
            except (Exception, SystemExit) as error:  # a row says what an example stopped at
                note = f" {type(error).__name__}"
        if not found:
            continue
        scheme, worst = max(found, key=lambda pair: abs(pair[1]))
        above = sum(abs(error) > SMALL for _, error in found)
        cells = (name, len(found), f"{worst:+.1e}", scheme, f"{above}{note}")
        print(row.format(*cells), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
