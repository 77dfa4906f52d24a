"""Progress of a run: a live line on terminals, a line per increment elsewhere."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import time
from typing import TYPE_CHECKING

from corota.cli.parser import terminal_columns
from corota.results.observer import BaseObserver, Iteration

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal
    from corota.model.model import Model
    from corota.model.steps import Step
    from corota.results.results import Frame, Results

HEAD = " step    inc  att  iter          time   load factor   residual"


class Progress(BaseObserver):
    """Observer that prints.

    Parameters
    ----------
    verbose : int
        1: a line for each increment on terminals too; 2: each iteration.
    """

    #: Seconds between two refreshes of the live line.
    REFRESH = 0.1

    def __init__(self, terminal: Terminal, verbose: int = 0) -> None:
        self.terminal, self.verbose = terminal, verbose
        self.increments = self.iterations = self.cut_backs = 0
        self._begin = self._step_begin = time.perf_counter()
        self._shown = 0.0
        self._number, self._total, self._period = 0, 0, 1.0
        self._done = 0.0
        self._text = ""
        self._residual = 0.0
        self._cuts: dict[tuple[int, int], int] = {}
        self._labels: list[int] = []

    def start(self, model: Model, steps: list[Step]) -> None:
        self._model, self._total = model, len(steps)

    def step(self, number: int, step: Step) -> None:
        self._number, self._period, self._done = number, step.period, 0.0
        self._step_begin = time.perf_counter()
        geometry = "nonlinear" if step.nlgeom else "linear"
        name = f" {step.name}" if step.name else ""
        self.terminal.line(
            f"Step {number} of {self._total}{name}: {step.procedure}, geometrically {geometry}, "
            f"period {step.period:g}"
        )
        if self._lines:
            self.terminal.line(HEAD)

    @property
    def _lines(self) -> bool:
        return not self.terminal.live or self.verbose > 0

    def iteration(self, info: Iteration) -> None:
        self.iterations += 1
        self._residual = max(info.residual, info.moment_residual)
        if self.verbose > 1:
            node = self._model.mesh.node_labels[info.worst_node] if info.worst_node >= 0 else "-"
            self.terminal.line(
                f"       iteration {info.iteration:2d}: residual {info.residual:9.2e}, moments "
                f"{info.moment_residual:9.2e}, correction {info.correction:9.2e}, largest at node "
                f"{node} dof {info.worst_dof + 1} {info.note}".rstrip()
            )
        self._text = f"inc {info.increment}  it {info.iteration}  residual {self._residual:.1e}" + (
            f"  factor {info.factor:.4g}" if info.factor else ""
        )
        self._refresh()

    def increment(self, frame: Frame) -> None:
        if frame.increment == 0:
            return
        self.increments += 1
        self._done = frame.step_time / self._period
        attempt = self._cuts.get((frame.step, frame.increment), 0) + 1
        count = int(frame.scalars.get("iterations", 0))
        if self._lines:
            self.terminal.line(
                f"{frame.step:5d} {frame.increment:6d} {attempt:4d} {count:5d} {frame.time:13.6g} "
                f"{frame.factor:13.6g} {self._residual:10.2e}"
            )
        self._text = f"inc {frame.increment}  it {count}  residual {self._residual:.1e}  " + (
            f"factor {frame.factor:.4g}"
        )
        self._refresh()

    def cut_back(self, step: int, increment: int, attempt: int, reason: str, dt: float) -> None:
        self.cut_backs += 1
        self._cuts[step, increment] = attempt
        self.terminal.line(
            self.terminal.color(
                f"  step {step}, increment {increment}, attempt {attempt}: {reason}; "
                f"next time increment {dt:.4g}",
                "yellow",
            )
        )

    def note(self, step: int, text: str) -> None:
        self.terminal.line(self.terminal.color(f"  step {step}: {text}", "yellow"))

    def end(self, results: Results, error: Exception | None) -> None:
        self.terminal.status("")

    def _refresh(self) -> None:
        now = time.perf_counter()
        if not self.terminal.live or now - self._shown < self.REFRESH:
            return
        self._shown = now
        full, empty = ("█", "░") if self.terminal.unicode else ("#", "-")
        share = min(max(self._done, 0.0), 1.0)
        cells = round(20 * share)
        bar = full * cells + empty * (20 - cells)
        left = ""
        if share > 0.0:
            left = "  left " + duration((now - self._step_begin) * (1.0 - share) / share)
        text = f" step {self._number}/{self._total} {bar} {share:4.0%}  {self._text}{left}"
        width = terminal_columns() - 1
        self.terminal.status(text[:width])


def duration(seconds: float) -> str:
    """A duration for display: ``0.42 s``, ``12.3 s``, ``3:07``, ``2:03:10``."""
    if seconds < 10.0:
        return f"{seconds:.2f} s"
    if seconds < 60.0:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
