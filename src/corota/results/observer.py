"""Interface of observers of an analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from corota.model.model import Model
    from corota.model.steps import Step
    from corota.results.frame import Frame
    from corota.results.results import Results


@dataclass
class Iteration:
    """Report of one Newton iteration to observers."""

    step: int
    increment: int
    attempt: int
    iteration: int
    residual: float  # relative force residual
    moment_residual: float  # relative moment residual
    correction: float  # largest displacement correction [length]
    worst_node: int  # index of the node with the largest residual
    worst_dof: int
    note: str = ""
    dt: float = 0.0  # size of the increment that is tried [time]
    factor: float = 0.0  # load factor that is tried


class Observer(Protocol):
    """Interface of an observer; every method is optional for implementers.

    Derive from :class:`BaseObserver` to write only those you need.
    """

    def start(self, model: Model, steps: list[Step]) -> None: ...
    def step(self, number: int, step: Step) -> None: ...
    def iteration(self, info: Iteration) -> None: ...
    def increment(self, frame: Frame) -> None: ...
    def cut_back(self, step: int, increment: int, attempt: int, reason: str, dt: float) -> None: ...
    def note(self, step: int, text: str) -> None: ...
    def end(self, results: Results, error: Exception | None) -> None: ...


class BaseObserver:
    """An observer that does nothing."""

    def start(self, model: Model, steps: list[Step]) -> None:
        """Begin an analysis."""

    def step(self, number: int, step: Step) -> None:
        """Begin a step."""

    def iteration(self, info: Iteration) -> None:
        """Finish a Newton iteration."""

    def increment(self, frame: Frame) -> None:
        """Accept an increment."""

    def cut_back(self, step: int, increment: int, attempt: int, reason: str, dt: float) -> None:
        """Give up an attempt; ``dt`` is the next one's increment."""

    def note(self, step: int, text: str) -> None:
        """Receive a note on an automatic action of a step, such as a switch to arc length."""

    def end(self, results: Results, error: Exception | None) -> None:
        """Finish, with the error if there was one."""
