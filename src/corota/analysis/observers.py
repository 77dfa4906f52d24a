"""All observers of a run combined; a failing observer stops the run with its own error."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.analysis.parallel.communicator import ALONE, Communicator
from corota.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from corota.analysis.checkpoint import Checkpoint
    from corota.model.model import Model
    from corota.model.steps import Output, Step
    from corota.results.observer import Iteration, Observer
    from corota.results.results import Frame, Results


class Observers:
    """Passes every event on to each observer.

    An observer that sets an attribute ``stop`` to True requests the end after the current
    increment.
    """

    def __init__(self, each: Iterable[Observer]) -> None:
        self.each = list(each)
        for observer in self.each:
            for event in ("start", "increment", "end"):
                if not callable(getattr(observer, event, None)):
                    raise InputError(
                        f"an observer is derived from corota.BaseObserver; {observer!r} has no "
                        f"method {event}"
                    )
        #: Processes whose observers decide together.
        self.communicator: Communicator = ALONE
        #: Requests for output in the current step.
        self.requests: list[Output] = []

    @property
    def stop_requested(self) -> bool:
        """Whether any observer requests a stop."""
        return self.communicator.any(any(getattr(o, "stop", False) for o in self.each))

    @property
    def takes_checkpoints(self) -> bool:
        """Whether any observer keeps checkpoints."""
        return self.communicator.any(any(hasattr(o, "checkpoint") for o in self.each))

    @property
    def checkpoint_due(self) -> bool:
        """Whether a checkpoint is due after the current increment."""
        takers: list[Any] = [o for o in self.each if hasattr(o, "checkpoint")]
        due = self.communicator.any(any(o.checkpoint_due for o in takers))
        return due or (self.takes_checkpoints and self.stop_requested)

    def checkpoint(self, checkpoint: Checkpoint, keep: str = "") -> None:
        """Pass a checkpoint to observers that store them; `keep`: ending of a permanent file."""
        for o in self.each:
            if hasattr(o, "checkpoint"):
                o.checkpoint(checkpoint, keep)

    def start(self, model: Model, steps: list[Step]) -> None:
        """Begin an analysis."""
        for o in self.each:
            o.start(model, steps)

    def step(self, number: int, step: Step) -> None:
        """Begin a step."""
        for o in self.each:
            o.step(number, step)

    def iteration(self, info: Iteration) -> None:
        """Finish a Newton iteration."""
        for o in self.each:
            o.iteration(info)

    def increment(self, frame: Frame) -> None:
        """Accept an increment."""
        for o in self.each:
            o.increment(frame)

    def cut_back(self, step: int, increment: int, attempt: int, reason: str, dt: float) -> None:
        """Give up an attempt."""
        for o in self.each:
            o.cut_back(step, increment, attempt, reason, dt)

    def note(self, step: int, text: str) -> None:
        """Send a note on an automatic action of a step, such as a switch to arc length."""
        for o in self.each:
            if (tell := getattr(o, "note", None)) is not None:
                tell(step, text)

    def end(self, results: Results, error: Exception | None) -> None:
        """Finish."""
        for o in self.each:
            o.end(results, error)
