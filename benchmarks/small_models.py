"""Small models: the interpreter's share of an increment.

The core's classes are wrapped in clocks; what a run takes beyond the time inside them is Python:
drivers, boundary conditions, the judgement of residuals, frames. Processor time of one thread, so
that other programs do not count. Target: at most 10 % at 2,000 equations.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import statistics
import sys
import time
import warnings
from typing import Any

import corota as ct
from benchmarks.common import report
from corota import _core

#: Elements through the height of the cantilever.
SIZES = {400: 4, 2000: 9, 10000: 21}
CLASSES = ("Problem", "Ldlt", "Lu", "EdgeLoads")


class Clock:
    """Time inside the core."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def wrap(self, cls: type) -> type:
        """A class like `cls` that stops the time of its construction and its methods."""
        clock = self

        class Timed:
            def __init__(self, *args: Any) -> None:
                begin = time.thread_time()
                self._inner = cls(*args)
                clock.seconds += time.thread_time() - begin

            def __getattr__(self, name: str) -> Any:
                begin = time.thread_time()
                found = getattr(self._inner, name)
                clock.seconds += time.thread_time() - begin
                if not callable(found):
                    return found

                def call(*args: Any) -> Any:
                    begin = time.thread_time()
                    try:
                        return found(*args)
                    finally:
                        clock.seconds += time.thread_time() - begin

                # Found at once next time: the clock must not cost what it measures.
                self.__dict__[name] = call
                return call

        return Timed


def measure(n: int, repeats: int) -> list[object]:
    """One row: equations, increments, time an increment, share of the interpreter."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10 * n, ny=n))
    model.section("all", element="Q4I", material=ct.Elastic(E=1.2e6, nu=0.3), thickness=0.01)
    model.fix("left")
    model.force("right", y=-4.0 / (n + 1))
    clock = Clock()
    originals = {name: getattr(_core, name) for name in CLASSES}
    shares, times = [], []
    try:
        for name, cls in originals.items():
            setattr(_core, name, clock.wrap(cls))
        for _ in range(repeats):
            clock.seconds = 0.0
            begin = time.thread_time()
            results = ct.solve(model, ct.Static(increments=20), threads=1)
            whole = time.thread_time() - begin
            times.append(whole)
            shares.append(1.0 - clock.seconds / whole)
    finally:
        for name, cls in originals.items():
            setattr(_core, name, cls)
    info = results.info
    increment = 1e3 * statistics.median(times) / 20
    share = 100.0 * statistics.median(shares)
    return [info["n_dofs"], 20, info["iterations"], increment, round(share, 1)]


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--repeats", type=int, default=9)
    chosen = options.parse_args()
    warnings.filterwarnings("ignore", message="local strain")
    rows = [measure(n, chosen.repeats) for n in SIZES.values()]
    head = ["equations", "increments", "iterations", "an increment [ms]", "interpreter [%]"]
    report("Small models, one thread", head, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
