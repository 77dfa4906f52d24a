"""Time of the phases of an analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from time import perf_counter


class Timer:
    """Adds up the time of a block; ten times lighter than a generator."""

    __slots__ = ("begin", "seconds")

    def __init__(self) -> None:
        self.seconds = 0.0

    def __enter__(self) -> None:
        self.begin = perf_counter()

    def __exit__(self, *_: object) -> None:
        self.seconds += perf_counter() - self.begin
