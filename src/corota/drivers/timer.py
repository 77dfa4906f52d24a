"""Time of the phases of an analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from time import perf_counter


class Timer:
    """Adds the time of a block to a profile; ten times lighter than a generator."""

    __slots__ = ("begin", "phase", "profile")

    def __init__(self, profile: dict[str, float], phase: str) -> None:
        self.profile, self.phase = profile, phase

    def __enter__(self) -> None:
        self.begin = perf_counter()

    def __exit__(self, *_: object) -> None:
        spent = perf_counter() - self.begin
        self.profile[self.phase] = self.profile.get(self.phase, 0.0) + spent
