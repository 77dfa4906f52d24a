"""A whole Newton iteration against factorizing and solving alone, up to a million equations.

Between two reports of Newton's method lie assembly, boundary conditions, factorization, solution,
line search and the judgement of the residual: everything that an iteration costs. Target: at most
1.3 times factorization and solution (``Q4I``, 250 thousand and a million).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
import warnings
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.common import report
from benchmarks.corpora import cantilever as p1
from corota.mesh import Cells
from corota.results.observer import BaseObserver, Iteration

if TYPE_CHECKING:
    from collections.abc import Callable

#: Elements through the height of the cantilever: about 4, 40, 250 and 1000 thousand equations.
SIZES = {"4k": 14, "40k": 45, "250k": 112, "1m": 223}


class Watch(BaseObserver):
    """Times between the reports of one attempt [s], of the wall by default."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self.clock = clock
        self.times: list[float] = []
        self._last: tuple[tuple[int, int, int], float] | None = None

    def iteration(self, info: Iteration) -> None:
        key, now = (info.step, info.increment, info.attempt), self.clock()
        if self._last is not None and self._last[0] == key:
            self.times.append(now - self._last[1])
        self._last = (key, now)


def measure(size: str, element: str, threads: int) -> list[object]:
    """One row of the table."""
    points, cells = p1.grid(SIZES[size])
    model = ct.Model(ct.Mesh(points, [Cells("quad4", cells, np.arange(1, len(cells) + 1))]))
    material = ct.Elastic(E=p1.YOUNG, nu=p1.POISSON)
    model.section("all", element=element, material=material, thickness=p1.THICKNESS)
    model.fix(np.flatnonzero(points[:, 0] == 0.0))
    for node, share in p1.tip_shares(points).items():
        model.force([node], y=0.2 * p1.SHEAR * p1.THICKNESS * share)
    watch = Watch()
    results = ct.solve(
        model, ct.Static(increments=2), observers=[watch], threads=threads, fields=False
    )
    profile, count = results.info["profile"], results.info["iterations"]
    direct = (profile["factor"] + profile["solve"]) / count
    whole = float(np.mean(watch.times))
    assembly = profile["assemble"] / count
    n = results.info["n_dofs"]
    return [element, n, count, 1e3 * assembly, 1e3 * direct, 1e3 * whole, whole / direct]


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--sizes", nargs="+", default=list(SIZES)[:3], choices=list(SIZES))
    options.add_argument("--elements", nargs="+", default=["Q4I", "Q4D"])
    options.add_argument("--threads", type=int, default=1)
    chosen = options.parse_args()
    warnings.filterwarnings("ignore", message="local strain")
    rows = [
        measure(size, element, chosen.threads)
        for size in chosen.sizes
        for element in chosen.elements
    ]
    head = ["element", "dofs", "iterations", "assembly [ms]", "factor + solve [ms]"]
    head += ["whole iteration [ms]", "ratio"]
    report(f"Newton iteration, {chosen.threads} thread(s)", head, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
