"""An analysis as a stream of plain records: JSON lines for logs, monitors and pipes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import math
import time
from typing import TYPE_CHECKING, Any

from corota.results.observer import BaseObserver, Iteration

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.model.model import Model
    from corota.model.steps import Step
    from corota.results.results import Frame, Results


def json_line(record: dict[str, Any]) -> str:
    """One line of JSON; a number that is not finite becomes ``null``."""
    return json.dumps(plain(record), allow_nan=False, separators=(",", ":")) + "\n"


def plain(value: Any) -> Any:
    """Data for JSON: numbers and arrays of NumPy as Python's, NaN and infinity as None."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, bool | int | str) or value is None:
        return value
    try:
        number = float(value)
    except (TypeError, ValueError):
        return str(value)
    return number if math.isfinite(number) else None


class Events(BaseObserver):
    """Converts events into records.

    Parameters
    ----------
    emit : callable
        Takes each record, a dict with the key ``event``.
    run : str
        Name of the run.
    """

    def __init__(self, emit: Callable[[dict[str, Any]], None], run: str = "") -> None:
        self._emit, self._run = emit, run
        self._begin = time.perf_counter()
        self._labels: Any = None
        self._cuts: dict[tuple[int, int], int] = {}

    def start(self, model: Model, steps: list[Step]) -> None:
        from corota._core import __version__

        self._labels = model.mesh.node_labels
        self._emit(
            {
                "event": "start",
                "version": __version__,
                "job": model.name,
                "run": self._run,
                "nodes": model.mesh.n_nodes,
                "cells": model.mesh.n_cells,
                "steps": len(steps),
                "notes": model.notes,
            }
        )

    def resume(self, model: Model, cuts: dict[tuple[int, int], int]) -> None:
        """Continue where an earlier run stopped."""
        self._labels, self._cuts = model.mesh.node_labels, dict(cuts)

    def step(self, number: int, step: Step) -> None:
        self._emit(
            {
                "event": "step",
                "step": number,
                "name": step.name,
                "procedure": step.procedure,
                "nlgeom": step.nlgeom,
                "period": step.period,
            }
        )

    def iteration(self, info: Iteration) -> None:
        node = int(self._labels[info.worst_node]) if info.worst_node >= 0 else None
        self._emit(
            {
                "event": "iteration",
                "step": info.step,
                "increment": info.increment,
                "attempt": info.attempt,
                "iteration": info.iteration,
                "residual": info.residual,
                "moment residual": info.moment_residual,
                "correction": info.correction,
                "worst node": node,
                "worst dof": info.worst_dof + 1,
                "note": info.note,
            }
        )

    def increment(self, frame: Frame) -> None:
        attempts = self._cuts.get((frame.step, frame.increment), 0) + 1
        self._emit(
            {
                "event": "increment",
                "step": frame.step,
                "increment": frame.increment,
                "attempts": attempts if frame.increment else 0,
                "time": frame.time,
                "step time": frame.step_time,
                "load factor": frame.factor,
                "elapsed": time.perf_counter() - self._begin,
                **frame.scalars,
            }
        )

    def cut_back(self, step: int, increment: int, attempt: int, reason: str, dt: float) -> None:
        self._cuts[step, increment] = attempt
        self._emit(
            {
                "event": "cut back",
                "step": step,
                "increment": increment,
                "attempt": attempt,
                "reason": reason,
                "dt": dt,
            }
        )

    def note(self, step: int, text: str) -> None:
        self._emit({"event": "note", "step": step, "note": text})

    def end(self, results: Results, error: Exception | None) -> None:
        record: dict[str, Any] = {
            "event": "end",
            "status": "failed" if error else "done",
            "elapsed": time.perf_counter() - self._begin,
            "profile": results.info.get("profile", {}),
            "notes": results.notes,
        }
        if error:
            record |= {"error": type(error).__name__, "message": str(error)}
        self._emit(record)
