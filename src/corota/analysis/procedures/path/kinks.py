"""Orientation of a path behind a point, where it may have a kink.

A smooth path turns little over an increment: its direction is the one nearest to the chord.
Where contact closes, opens or begins to slip the direction jumps, by any angle. The chord is
then a sum of the directions before and behind, and the state changes determine which way leads
on. At a corner of a nonlinear spring the sum alone determines it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.analysis.path_system import Metric, PathSystem, Point, Tangent
from corota.analysis.procedures.path.corrector import tangent_at
from corota.arrays import Floats

#: Cosine from which two directions determine each other's orientation.
MIN_COSINE = 0.5


def direction(
    system: PathSystem,
    metric: Metric,
    base: Point,
    old: Tangent,
    point: Point,
    aim: Tangent | None = None,
    sure: bool = False,
    corner: Tangent | None = None,
) -> tuple[Tangent, float | None]:
    """Direction at a point that was evaluated last.

    Parameters
    ----------
    base : Point
        Committed start of the increment.
    old : Tangent
        Direction there.
    aim : Tangent, optional
        Direction at a point behind, or the predicted one.
    sure : bool
        Whether the increment is so short that what changed its state decides alone.
    corner : Tangent, optional
        Direction behind a corner of a law that lies in the increment.

    Returns
    -------
    tangent : Tangent
    aside : float or None
        Share of the chord that the directions at both ends leave; None without a kink.

    Raises
    ------
    SingularError
        If the tangent matrix has no inverse there.
    """
    tangent, _ = tangent_at(system, point, metric)
    if corner is not None:
        return behind_corner(metric, base, old, point, tangent, corner)
    du, df = point.u - base.u, point.factor - base.factor
    if metric.dot(tangent.u, tangent.factor, du, df) < 0.0:
        tangent = tangent.reversed()
    ahead = system.ahead(point.evaluation, tangent.u)
    if ahead == 0.0:
        return tangent, None
    length = metric.size(du, df) or 1.0
    along = 0.0 if aim is None else metric.dot(tangent.u, tangent.factor, aim.u, aim.factor)
    if abs(along) > MIN_COSINE and along * ahead > 0.0:
        return (tangent if along > 0.0 else tangent.reversed()), 0.0
    aside = _aside(metric, du, df, old, tangent)
    if ahead < 0.0:
        other = _aside(metric, du, df, old, tangent.reversed())
        if not (sure or other < 0.5 * aside):
            return tangent, np.inf  # chord and contact contradict each other
        tangent, aside = tangent.reversed(), other
    return tangent, aside / length


def behind_corner(
    metric: Metric, base: Point, old: Tangent, point: Point, tangent: Tangent, behind: Tangent
) -> tuple[Tangent, float | None]:
    """Direction at a point before or behind a corner, whichever of both it is like."""
    before, after = (metric.dot(tangent.u, tangent.factor, t.u, t.factor) for t in (old, behind))
    if abs(before) >= abs(after):
        return (tangent if before > 0.0 else tangent.reversed()), None
    tangent = tangent if after > 0.0 else tangent.reversed()
    du, df = point.u - base.u, point.factor - base.factor
    length = metric.size(du, df) or 1.0
    return tangent, _aside(metric, du, df, old, tangent) / length


def sense_behind(metric: Metric, base: Point, old: Tangent, point: Point, new: Tangent) -> Tangent:
    """The sense of a direction behind a corner: the chord is a sum of it and the one before."""
    du, df = point.u - base.u, point.factor - base.factor
    back = new.reversed()
    first, second = (_aside(metric, du, df, old, t) for t in (new, back))
    return new if first <= second else back


def _aside(metric: Metric, du: Floats, df: float, old: Tangent, new: Tangent) -> float:
    """Distance of a chord from the sums of two directions, neither of them backwards."""
    a, b = shares(metric, du, df, old, new)
    if min(a, b) < 0.0:
        a = max(metric.dot(old.u, old.factor, du, df), 0.0)
        b = max(metric.dot(new.u, new.factor, du, df), 0.0)
        a, b = (a, 0.0) if a > b else (0.0, b)
    return metric.size(du - a * old.u - b * new.u, df - a * old.factor - b * new.factor)


def shares(
    metric: Metric, du: Floats, df: float, old: Tangent, new: Tangent
) -> tuple[float, float]:
    """Lengths along two directions whose sum comes nearest to a chord."""
    c = metric.dot(old.u, old.factor, new.u, new.factor)
    p = metric.dot(old.u, old.factor, du, df)
    q = metric.dot(new.u, new.factor, du, df)
    if c * c >= 1.0:
        return 0.5 * p, 0.5 * q
    return (p - c * q) / (1.0 - c * c), (q - c * p) / (1.0 - c * c)
