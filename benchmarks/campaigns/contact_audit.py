"""An audit of contact: 60 checks against closed forms and CalculiX, written from the pages alone.

``python -m benchmarks contact_audit`` runs all of them, or those that are named; ``--all`` lists
the rows that are right, too. Settings are the defaults, a step is one increment unless the
program shortens it. A check is *right* if all its rows are within the tolerances that were stated
before the first run, *stopped* if a run ends without an answer, else *wrong*.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
import warnings
from collections import Counter

import corota as ct
from benchmarks.campaigns import contact_audit_motion  # noqa: F401
from benchmarks.campaigns.contact_audit_statics import CHECKS, WITH_FRICTION, Row
from benchmarks.common import report


def outcome(name: str) -> tuple[str, list[Row], str, float]:
    """Verdict, rows, message of a run that stopped, and processor time of a check."""
    rows: list[Row] = []
    start, message = time.process_time(), ""
    try:
        rows.extend(CHECKS[name]())
    except ct.CorotaError as error:
        message = str(error)
    verdict = "stopped" if message else "right" if all(map(is_right, rows)) else "wrong"
    return verdict, rows, message, time.process_time() - start


def is_right(row: Row) -> bool:
    """Whether the answer of a row is within its tolerance."""
    _, answer, exact, tolerance = row
    return abs(answer - exact) <= tolerance * (abs(exact) or 1.0)


def main() -> int:
    """Run them; prints the rows that are wrong, and counts."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="checks; all by default")
    parser.add_argument("--all", action="store_true", help="list the rows that are right, too")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    listed, summary, counts = [], [], Counter[str]()
    for name in arguments.names or CHECKS:
        verdict, rows, message, seconds = outcome(name)
        counts[verdict] += 1
        friction = "yes" if name in WITH_FRICTION else ""
        worst = max((abs(r[1] - r[2]) / (abs(r[2]) or 1.0) for r in rows), default=float("nan"))
        summary.append((name, friction, len(rows), worst, verdict, seconds))
        for row in rows:
            if arguments.all or not is_right(row):
                variant, answer, exact, tolerance = row
                difference = (answer - exact) / (abs(exact) or 1.0)
                listed.append((name, variant, answer, exact, difference, tolerance))
        if message:
            listed.append((name, message.splitlines()[0], "", "", "", ""))
        sys.stdout.write(f"{name}: {verdict}, {worst:.2e}, {seconds:.1f} s\n")
        sys.stdout.flush()
    head = ("check", "friction", "rows", "largest difference", "verdict", "CPU s")
    report("Audit of contact", head, summary)
    if listed:
        head = ("check", "variant", "answer", "exact", "difference", "tolerance")
        report("Rows", head, listed)
    report("Counts", ("verdict", "checks"), sorted(counts.items()))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
