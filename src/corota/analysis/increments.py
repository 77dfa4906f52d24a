"""Size of the next increment: growth after easy ones, cut-back after failures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.steps import Step

#: An increment that took at most so many iterations was easy ...
EASY = 5
#: ... and after two easy ones in a row the next is longer by this factor.
GROWTH = 1.5
#: After a failed attempt the increment is cut to this share.
CUT = 0.25
#: Attempts at one increment before the step is given up.
MAX_ATTEMPTS = 12
#: Relative slack under which two times are the same.
SAME = 1e-10


@dataclass
class Increments:
    """Increment control of one step.

    Parameters
    ----------
    stops : sequence of float
        Step times that must be hit exactly.
    """

    step: Step
    stops: Sequence[float] = ()
    time: float = 0.0
    number: int = 0
    attempt: int = 1
    easy: int = field(default=0, repr=False)
    size: float = field(default=0.0, repr=False)

    def __post_init__(self) -> None:
        self.size = self.step.first_increment
        period = self.step.period
        inner = sorted({s for s in self.stops if SAME * period < s < period * (1.0 - SAME)})
        self.stops = [*inner, period]

    @property
    def finished(self) -> bool:
        return self.time >= self.step.period * (1.0 - SAME)

    def target(self) -> float:
        """Target step time of the next attempt [time]."""
        stop = next(s for s in self.stops if s > self.time + SAME * self.step.period)
        left = stop - self.time
        # A small rest at the end would cost an extra increment.
        return stop if self.size >= left * (1.0 - 1e-6) else self.time + self.size

    @property
    def shortest(self) -> float:
        """Increment below which a local error cuts no further [time].

        That is the smallest one with which the largest ones reach the end of the step and, when
        half of the increments are used, the mean of those that are left until there.
        """
        step = self.step
        left, rest = max(step.max_increments - self.number, 1), step.period - self.time
        if 2 * left > step.max_increments:
            return max(step.smallest_increment, rest - (left - 1) * step.largest_increment)
        return max(step.smallest_increment, rest / left)

    def accept(self, time: float, iterations: int) -> None:
        """Continue after a converged attempt."""
        self.time = time
        self.number += 1
        self.easy = self.easy + 1 if iterations <= EASY and self.attempt == 1 else 0
        self.attempt = 1
        if self.easy >= 2 and not self.step.fixed_increments:
            self.size = min(GROWTH * self.size, self.step.largest_increment)
            self.easy = 0

    def cut(self, tried: float, share: float = CUT) -> str:
        """Shorten to a share of a failed attempt at a time; returns why that cannot be, or ''."""
        self.easy = 0
        if self.step.fixed_increments:
            return "the increments are fixed (DIRECT) and cannot be cut"
        self.attempt += 1
        self.size = share * (tried - self.time)
        if self.attempt > MAX_ATTEMPTS:
            return f"{MAX_ATTEMPTS} attempts failed"
        if self.size < self.step.smallest_increment * (1.0 - SAME):
            return f"the smallest increment, {self.step.smallest_increment:g}, is reached"
        return ""
