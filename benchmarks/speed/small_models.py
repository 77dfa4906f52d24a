"""Small models: the interpreter's share of an increment.

The processor's time is sampled: a signal at each tick asks whether the program is inside the
compiled core, whose classes are wrapped for that. The rest is Python: drivers, boundary
conditions, the judgement of residuals, frames. (Clocks around each call would cost as much as what
they measure.) The first increment of a run, which pays for its setting up, is left out. Target: at
most 10 % at 2,000 equations.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import signal
import sys
import time
import warnings
from typing import TYPE_CHECKING, Any

import corota as ct
from benchmarks.common import report
from corota import _core
from corota.results.observer import BaseObserver
from corota.results.results import Frame

if TYPE_CHECKING:
    from types import FrameType

#: Elements through the height of the cantilever.
SIZES = {400: 4, 2000: 9, 10000: 21}
INCREMENTS = 50
CLASSES = ("Problem", "Ldlt", "Lu", "EdgeLoads")
#: Requested processor time between two samples [s]; systems round it.
TICK = 1e-3


class Sampler(BaseObserver):
    """Counts ticks of processor time inside the core and outside, from increment 1 to the last."""

    def __init__(self) -> None:
        self.inside = self.active = False
        self.core = self.python = self.increments = 0
        self.seconds = self._begin = 0.0

    def tick(self, _signal: int, _frame: FrameType | None) -> None:
        """Handle the signal; one that comes during a call of the core is handled at its end."""
        if self.active and self.inside:
            self.core += 1
        elif self.active:
            self.python += 1

    def increment(self, frame: Frame) -> None:
        now = time.thread_time()
        if frame.increment == INCREMENTS:
            self.active = False
            self.seconds += now - self._begin
            self.increments += INCREMENTS - 1
        elif frame.increment == 1:
            self.active, self._begin = True, now

    def wrap(self, cls: type) -> type:
        """A class like `cls` that tells when one of its methods runs."""
        sampler = self

        class Wrapped:
            def __init__(self, *args: Any) -> None:
                self._inner = cls(*args)

            def __getattr__(self, name: str) -> Any:
                found = getattr(self._inner, name)
                if not callable(found):
                    return found

                def call(*args: Any) -> Any:
                    sampler.inside = True
                    try:
                        return found(*args)
                    finally:
                        sampler.inside = False

                # Found at once next time.
                self.__dict__[name] = call
                return call

        return Wrapped


def measure(n: int, seconds: float) -> list[object]:
    """One row: equations, time of an increment, samples, the interpreter's share and its time."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10 * n, ny=n))
    model.section("all", element="Q4I", material=ct.Elastic(E=1.2e6, nu=0.3), thickness=0.01)
    model.fix("left")
    model.force("right", y=-4.0 / (n + 1), per_node=True)
    sampler = Sampler()
    originals = {name: getattr(_core, name) for name in CLASSES}
    signal.signal(signal.SIGPROF, sampler.tick)
    signal.setitimer(signal.ITIMER_PROF, TICK, TICK)
    try:
        for name, cls in originals.items():
            setattr(_core, name, sampler.wrap(cls))
        while sampler.seconds < seconds:
            step = ct.Static(increments=INCREMENTS)
            results = ct.solve(model, step, observers=[sampler], threads=1, keep="last")
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        for name, cls in originals.items():
            setattr(_core, name, cls)
    samples = sampler.core + sampler.python
    share = sampler.python / max(samples, 1)
    error = (share * (1.0 - share) / max(samples, 1)) ** 0.5
    increment = 1e3 * sampler.seconds / sampler.increments
    return [
        results.info["n_dofs"],
        round(results.info["iterations"] / INCREMENTS, 1),
        increment,
        samples,
        f"{100.0 * share:.1f} ± {100.0 * error:.1f}",
        share * increment,
    ]


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--seconds", type=float, default=8.0, help="processor time a size")
    chosen = options.parse_args()
    warnings.filterwarnings("ignore", message="local strain")
    rows = [measure(n, chosen.seconds) for n in SIZES.values()]
    head = ["equations", "iterations", "an increment [ms]", "samples"]
    head += ["interpreter [%]", "interpreter [ms]"]
    report("Small models, one thread", head, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
