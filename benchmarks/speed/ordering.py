"""Order of elimination from the edges alone, and from coordinates: time, entries, work.

Both analyze the pattern of the first factorization of each problem, on one thread, in turn.
``--problems P1:40k P2:40k P1:1M:Q4D``
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import contextlib
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from benchmarks.common import report
from benchmarks.corpora import decks
from benchmarks.corpora.problems import build
from corota import _core
from corota.analysis.linear.solvers import Multifrontal


class Found(BaseException):
    """The pattern is known; the analysis is not wanted."""


class PatternOnly(Multifrontal):
    """Keeps the first pattern and the coordinates."""

    def place_nodes(self, points: Any) -> None:
        self.points = points

    def analyze(self, *pattern: Any) -> None:
        self.pattern = pattern
        raise Found


def pattern_of(problem: str, size: str, element: str) -> tuple[Any, Any]:
    """Pattern and coordinates of a benchmark problem."""
    solver = PatternOnly()
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "job.inp"
        decks.write_deck(deck, build(problem, size, last=1))
        model = ct.read(deck, element_map={"CPS4": element})
        with contextlib.suppress(Found):
            ct.solve(model, solver=solver, threads=1)
    return solver.pattern, solver.points


def analyzed(pattern: Any, points: Any) -> tuple[float, int, float]:
    """Processor time of an analysis, entries of the factor, multiplications."""
    solver = Multifrontal()
    solver.threads = 1
    solver.place_nodes(points)
    begin = time.process_time()
    solver.analyze(*pattern)
    return time.process_time() - begin, *_core.factor_size(solver._core)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    usual = ["P1:40k", "P1:40k:Q4D", "P2:40k", "P3:33k", "P1:400k"]
    parser.add_argument("--problems", nargs="+", default=usual)
    args = parser.parse_args()
    rows = []
    for text in args.problems:
        problem, size, element = (*text.split(":"), "Q4I")[:3]
        pattern, points = pattern_of(problem, size, element)
        edges = analyzed(pattern, np.zeros((0, 2)))
        placed = analyzed(pattern, points)
        ratios = [f"{b / a:.2f}" for a, b in zip(edges, placed, strict=True)]
        rows.append([problem, element, len(pattern[0]) - 1, *edges, *placed, *ratios])
    head = ["problem", "element", "equations"]
    for kind in ("edges", "coordinates", "ratio of"):
        head += [f"{kind} {what}" for what in ("seconds", "entries", "multiplications")]
    report("Order of elimination, one thread", head, rows)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
