"""Balance error of every verification problem and example, and how it falls with the increment.

Usage::

    python -m benchmarks energy_balance [NAME ...] [--markdown] [--no-orders]

Each analysis of a problem leaves its largest error of the energy account over its largest energy.
The worst of a problem is shown, with how many of its analyses are above 1e-3. A problem above 1e-3
runs again with increments cut to a half and a quarter: the row then shows the errors of the same
analysis and the order, from the numbers of increments that were made. Names choose problems of the
catalog, or examples by their path (``examples/motion/pendulum.py``).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import copy
import io
import math
import runpy
import sys
import warnings
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.run import Analysis
from corota.model.steps import Dynamic, Static
from corota.verification import catalogue, runner

if TYPE_CHECKING:
    from corota.model.steps import Step

ROOT = Path(__file__).resolve().parents[2]
#: Error that counts as small.
SMALL = 1e-3
#: Cuts of the increments of a second and a third run.
CUTS = (2, 4)


@dataclass
class Run:
    """Scheme, balance error and step times of one analysis."""

    scheme: str
    error: float
    times: dict[int, list[float]]

    @property
    def increments(self) -> int:
        return sum(len(times) - 1 for times in self.times.values())


class Watch:
    """Records the balance error of every analysis and cuts its increments where requested."""

    def __init__(self) -> None:
        self.found: list[Run | None] = []
        self.cut = 1
        self.before: list[Run | None] = []
        run = Analysis.run

        def measured(analysis: Analysis) -> Any:
            number = len(self.found)
            self.found.append(None)
            first = self.before[number] if number < len(self.before) else None
            # Without fields there is no account.
            analysis.fields, analysis.results.keep = True, "all"
            if self.cut > 1 and first is not None:
                refine(analysis, self.cut, first.times)
            try:
                return run(analysis)
            finally:
                account = getattr(analysis, "energies", None)
                if account is not None:
                    times = step_times(analysis)
                    self.found[number] = Run(account.scheme, account.error, times)

        Analysis.run = measured  # type: ignore[method-assign]


def step_times(analysis: Analysis) -> dict[int, list[float]]:
    """Times of the frames of each step, its start first."""
    found: dict[int, list[float]] = {}
    for frame in analysis.results.frames:
        times = found.setdefault(frame.step, [0.0])
        if frame.step_time > times[-1]:
            times.append(frame.step_time)
    return found


def refine(analysis: Analysis, cut: int, times: dict[int, list[float]]) -> None:
    """Cut each increment of an earlier run into so many."""
    stops: dict[int, list[float]] = {}
    steps = []
    for number, step in enumerate(analysis.steps, start=1):
        known = np.array(times.get(number, [0.0]))
        steps.append(finer(step, cut, float(np.diff(known).max(initial=0.0))))
        shares = np.arange(1, cut + 1) / cut
        stops[id(steps[-1])] = (
            (known[:-1, None] + np.diff(known)[:, None] * shares).ravel().tolist()
        )
    analysis.steps = steps
    before = analysis._stops
    analysis._stops = lambda step: [*before(step), *stops[id(step)]]  # type: ignore[method-assign]


def finer(step: Step, cut: int, largest: float) -> Step:
    """The same step with shorter increments."""
    if not isinstance(step, Static | Dynamic):
        return step
    step = copy.copy(step)
    if isinstance(step, Static) and step.path is not None:
        bound = min(step.largest_increment, 4.0 * step.first_increment)
    else:
        bound = min(step.largest_increment, largest or step.largest_increment)
    step.first_increment = min(step.first_increment, bound) / cut
    step.largest_increment = bound / cut
    step.smallest_increment = min(step.smallest_increment, 1e-3 * step.first_increment)
    step.max_increments *= 4 * cut
    if isinstance(step, Dynamic):
        step.error_tolerance /= cut * cut
    return step


def forget() -> None:
    """Empty the caches in which the problems keep their analyses."""
    for name, module in list(sys.modules.items()):
        if name.startswith("corota.verification.problems"):
            for item in vars(module).values():
                if hasattr(item, "cache_clear"):
                    item.cache_clear()


def play(name: str) -> str:
    """Run a problem or an example; name what stopped it."""
    forget()
    given = sys.argv, sys.path
    sys.argv = [name]  # an example reads its own arguments
    sys.path = [str((ROOT / name).parent), *sys.path]  # and imports its neighbors
    with warnings.catch_warnings(), redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")
        try:
            if name.endswith(".py"):
                runpy.run_path(str(ROOT / name), run_name="__main__")
            else:
                runner.measure(name)
        except (Exception, SystemExit) as error:  # a row says what an example stopped at
            if getattr(error, "code", 1):
                return f" {type(error).__name__}"
        finally:
            sys.argv, sys.path = given
    return ""


def orders(watch: Watch, name: str, number: int) -> str:
    """Errors of one analysis with shorter increments, and the order of the last two."""
    watch.before, runs, note = watch.found, [watch.found[number]], ""
    for watch.cut in CUTS:
        watch.found = []
        note = play(name)
        runs.append(watch.found[number] if number < len(watch.found) else None)
    watch.cut = 1
    known = [run for run in runs if run is not None]
    cells = " ".join(f"{abs(run.error):.1e} ({run.increments})" for run in known)
    a, b = known[0], known[-1]
    if b.increments <= a.increments or b.error == 0.0:
        return f"{cells} -{note}"
    order = math.log(abs(a.error / b.error)) / math.log(b.increments / a.increments)
    return f"{cells}, order {order:.1f}{note}"


def main(names: list[str]) -> None:
    """Print one row for each problem and example."""
    markdown, refine = "--markdown" in names, "--no-orders" not in names
    names = [name for name in names if not name.startswith("--")]
    watch = Watch()
    every = [
        *catalogue.problems(),
        *(str(p.relative_to(ROOT)) for p in sorted((ROOT / "examples").rglob("*.py"))),
    ]
    heads = ("problem", "analyses", "worst error", "scheme", "above 1e-3", "error (increments)")
    row = "| {} | {} | {} | {} | {} | {} |" if markdown else "{:42s} {:>9} {:>12} {:20s} {:11} {}"
    print(row.format(*heads))
    if markdown:
        print("|---|---|---|---|---|---|")
    for name in names or every:
        watch.found = []
        note = play(name)
        runs = [(abs(run.error), i) for i, run in enumerate(watch.found) if run is not None]
        if not runs:
            print(row.format(name, 0, "", "", note, "solves no step of its own"), flush=True)
            continue
        worst, number = max(runs)
        above = sum(error > SMALL for error, _ in runs)
        run = watch.found[number]
        assert run is not None
        text = orders(watch, name, number) if refine and worst > SMALL else ""
        cells = (name, len(runs), f"{run.error:+.1e}", run.scheme, f"{above}{note}", text)
        print(row.format(*cells), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
