"""What contact costs as its edges become many: search, evaluation, borders; exponent and share.

A strip of n cells pressed on another of 1.5 n cells, one row of cells each, so that nearly
everything is contact; one increment, processor seconds of one thread. ``--edges`` slave edges.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
from typing import Any

import numpy as np

import corota as ct
from benchmarks.common import report


def strips(n: int) -> ct.Model:
    """Two strips of length 1, their cells as high as long."""
    upper = ct.mesh.rectangle(1.0, 1.0 / n, n, 1, origin=(0.0, 1.0 / n))
    lower = ct.mesh.rectangle(1.0, 1.0 / n, 3 * n // 2, 1)
    model = ct.Model(ct.mesh.assembly(upper=upper, lower=lower))
    model.section("all", element="Q4", material=ct.Elastic(E=1.0, nu=0.3))
    model.fix("lower.bottom")
    model.fix("upper.top", x=0.0, y=-0.01 / n)
    model.contact("upper.bottom", "lower.top", name="pair")
    return model


def measure(n: int) -> dict[str, Any]:
    """Iterations, and processor seconds of each phase."""
    from corota.analysis import timer

    before, timer.perf_counter = timer.perf_counter, time.process_time
    try:
        begin = time.process_time()
        results = ct.solve(strips(n), ct.Static(increments=1), threads=1, fields=False)
        whole = time.process_time() - begin
    finally:
        timer.perf_counter = before
    return {**results.info["profile"], "whole": whole, "count": int(results.info["iterations"])}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--edges", nargs="+", type=int, default=[500, 2000, 8000, 32000])
    args = parser.parse_args()
    measure(100)  # what is imported late
    rows: list[list[object]] = []
    spent: list[float] = []
    for n in args.edges:
        found = measure(n)
        contact = found["contact"] + found["border"]
        spent.append(contact / found["count"])
        share = f"{contact / found['whole']:.0%}"
        rows.append(
            [n, found["count"], 1e6 * spent[-1] / n, found["factor"], found["whole"], share]
        )
    if len(rows) > 1:
        slope = np.polyfit(np.log(args.edges), np.log(spent), 1)[0]
        rows.append(["exponent", "", f"{slope:.2f}", "", "", ""])
    head = [
        "slave edges",
        "iterations",
        "contact: us / (edge iteration)",
        "factor [s]",
        "whole [s]",
    ]
    report("Contact of two strips, one thread", [*head, "share of contact"], rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
