"""Input and output of a path: plan, ends, increments."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from corota.analysis.procedures.path.controls import Control, Factor, Row

if TYPE_CHECKING:
    from corota.analysis.path_system import Point, Tangent
    from corota.analysis.procedures.path.stability import Critical


class PathStalled(Exception):
    """No further increment could be found; the message says why."""


@dataclass
class End:
    """Where a path ends: a displacement or the load factor (``row`` None) has a value."""

    value: float
    row: Row | None = None

    def miss(self, point: Point) -> float:
        """Signed distance from the end."""
        return (point.factor if self.row is None else self.row.of(point.u)) - self.value

    def control(self, base: Point) -> Control:
        """What lands on the end from a point."""
        if self.row is None:
            return Factor(self.value - base.factor)
        return replace(self.row, value=self.value - self.row.of(base.u))


@dataclass
class Plan:
    """How a path is followed.

    Parameters
    ----------
    first, smallest, largest : float
        Sizes of increments, in units of the path (see :class:`Metric`).
    fixed : bool
        Never change the size.
    increments : int
        End after so many; 0 for no such end.
    row : Row, optional
        Displacement control; its ``value`` is the increment of the displacement.
    side : int
        Sign of the mode along which another branch is entered.
    branch : int
        Which of several branches, from 1.
    """

    first: float = 0.05
    smallest: float = 1e-7
    largest: float = math.inf
    fixed: bool = False
    ends: list[End] = field(default_factory=list)
    increments: int = 0
    row: Row | None = None
    spherical: bool = False
    locate: bool = True
    switch: bool = False
    side: int = 1
    branch: int = 1
    stop_at_limit: bool = False


@dataclass
class Increment:
    """An accepted point of the path.

    Parameters
    ----------
    tangent : Tangent
        Direction in which the path continues.
    size : float
        Length of the increment, in units of the path.
    negative : int
        Negative pivots, -1 if unknown; at a critical point those before it.
    control : {"arc", "displacement", "load", "mode"}
    last : bool
        Whether the path ends here.
    closed : bool
        Whether a branch has come back to where it began.
    """

    point: Point
    tangent: Tangent
    iterations: int
    attempts: int
    size: float
    negative: int
    control: Literal["arc", "displacement", "load", "mode"] = "arc"
    critical: Critical | None = None
    last: bool = False
    closed: bool = False
