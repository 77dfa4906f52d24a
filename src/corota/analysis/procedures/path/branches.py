"""Branches that leave an equilibrium path at a bifurcation point.

At a simple point the branch leaves along the mode, to either side. At a multiple one the null
space has several modes, and the branches leave along some of their combinations: the solutions of
the branching equations in the null space. They are found as such: from directions all around the
null space the full equations are solved with a small prescribed amplitude along each, and those
that
lead to the same branch count once.

Source: R. Seydel, *Practical Bifurcation and Stability Analysis* (2010), ch. 5; M. Golubitsky,
I. Stewart and D. G. Schaeffer, *Singularities and Groups in Bifurcation Theory* II (1988), ch. X.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from corota.analysis.path_system import Point
from corota.analysis.procedures.path.controls import Row
from corota.analysis.procedures.path.corrector import tangent_at
from corota.analysis.procedures.path.plan import Increment, PathStalled
from corota.analysis.procedures.path.tracer import LEFT, PathTracer
from corota.errors import SingularError

if TYPE_CHECKING:
    from corota.analysis.procedures.path.stability import Critical, Station
    from corota.arrays import Floats


#: Largest displacement by which a branch is entered, as a share of the structure's size ...
MODE = 0.02
#: ... and shares of it that are tried.
MODE_SHARES = (1.0, 0.3, 0.1, 3.0, 0.03, 0.01, 0.003)
#: Directions in a plane of two modes that are tried.
DIRECTIONS = 8
#: Cosine of the angle from which two directions are one.
SAME = 0.98


@dataclass
class Branch:
    """A state on a branch.

    Parameters
    ----------
    direction : ndarray, shape (n,)
        From the bifurcation point, of unit length in the displacements.
    """

    station: Station
    direction: Floats
    iterations: int
    attempts: int


def switch(tracer: PathTracer, critical: Critical) -> Increment:
    """Leave along a branch: its amplitude is prescribed, load and shape adapt.

    Raises
    ------
    PathStalled
        If no branch can be entered, or the requested one does not exist.
    """
    wanted = tracer.plan.branch
    found: list[Branch] = []
    reason = ""
    directions = _directions(tracer, critical)
    for direction in directions:
        if len(directions) == 1 and wanted == 1 and found:
            break
        branch, why = _enter(tracer, direction)
        reason = why or reason
        if branch is not None and all(abs(_cosine(tracer, branch, b)) < SAME for b in found):
            found.append(branch)
    if not found:
        raise PathStalled(f"the other branch could not be entered: {reason}")
    critical.branches = [branch.direction for branch in found]
    if wanted > len(found):
        raise PathStalled(
            f"branch {wanted} was requested, but {len(found)} leave the bifurcation point"
        )
    return _take(tracer, found[wanted - 1])


def _cosine(tracer: PathTracer, a: Branch, b: Branch) -> float:
    counted = tracer.system.counted
    return float(a.direction[counted] @ b.direction[counted])


def _directions(tracer: PathTracer, critical: Critical) -> list[Floats]:
    """Directions to try: the mode, or those all around a null space of several."""
    before, after = critical.negative
    counted = tracer.system.counted
    mode = critical.mode / np.linalg.norm(critical.mode[counted])
    count = abs(after - before) if min(before, after) >= 0 else 1
    if count < 2:
        return [mode]
    modes = _null_space(tracer, critical, count)
    out = list(modes)
    for a, b in combinations(modes, 2):
        for k in range(DIRECTIONS):
            angle = np.pi * k / DIRECTIONS
            if k % (DIRECTIONS // 2):
                out.append(np.cos(angle) * a + np.sin(angle) * b)
    return out


def _null_space(tracer: PathTracer, critical: Critical, count: int) -> list[Floats]:
    """Softest modes at a multiple point, orthonormal in the displacements."""
    system = tracer.system
    try:
        tangent_at(system, tracer.base)
    except SingularError:
        # As near as arithmetic permits: a neighbor's factorization is sufficient.
        tangent_at(system, critical.after.point)
    n, counted = system.n_dofs, system.counted
    x = np.random.default_rng(7).standard_normal((n, count))
    x[:, 0] = critical.mode[:n]
    for _ in range(12):
        x, _ = np.linalg.qr(np.column_stack([system.solve_with_last_factor(c)[:n] for c in x.T]))
    whole = np.column_stack([system.solve_with_last_factor(c) for c in x.T])
    whole = whole / np.linalg.norm(whole[:n], axis=0)
    basis, r = np.linalg.qr(whole[counted])
    whole = whole @ np.linalg.inv(r)
    # Modes of single members, where there are such, are the plainest basis: rotate towards the
    # fewest displacements (varimax by plane rotations).
    for _ in range(20):
        for i, j in combinations(range(count), 2):
            u, v = basis[:, i] ** 2 - basis[:, j] ** 2, 2.0 * basis[:, i] * basis[:, j]
            angle = 0.25 * np.arctan2(2.0 * (u @ v), u @ u - v @ v)
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            basis[:, [i, j]] = basis[:, [i, j]] @ turn
            whole[:, [i, j]] = whole[:, [i, j]] @ turn
    out = []
    for column in whole.T:
        shown = np.where(counted, column, 0.0)
        out.append(column * np.sign(shown[np.abs(shown).argmax()]))
    return out


def _enter(tracer: PathTracer, along: Floats) -> tuple[Branch | None, str]:
    """A state on the branch in a direction, before any end of the path, and why there is none."""
    system, base = tracer.system, tracer.base
    counted = np.flatnonzero(system.counted & (along != 0.0))
    weights = along[counted]
    # Near the point the branch is as singular as the point; a larger mode is regular.
    first = tracer.plan.side * MODE * system.length / float(np.abs(weights).max())
    reason, beyond = "", None
    for attempt, share in enumerate(MODE_SHARES, start=1):
        amplitude = share * first
        guess = Point(base.u + amplitude * along, base.factor, None)
        done = tracer._solve(guess, Row(counted, weights, amplitude), tracer.size)
        tracer.guess = guess  # the branch turns off: the angle is not judged
        station, reason = None, done.reason
        if done.point is not None:
            station, reason = tracer._check_growth(done.point, tracer.size)
        tracer.guess = None
        if station is None:
            continue
        step = station.point.u - base.u
        branch = Branch(
            station, step / np.linalg.norm(step[system.counted]), done.iterations, attempt
        )
        if tracer._crossed(station.point) is None:
            return branch, ""
        beyond = branch
    return beyond, reason


def _take(tracer: PathTracer, branch: Branch) -> Increment:
    """Commit a state on a branch, or the end of the path if that comes first."""
    base, system = tracer.base, tracer.system
    station = branch.station
    point, tangent = station.point, station.tangent
    tracer.guess = point  # angles from the old path are not judged
    crossed = tracer._crossed(point)
    if crossed is not None:
        landed = tracer._land(crossed, point)
        moved = 0.0
        if landed is not None:
            moved = float((landed[0].u - base.u)[system.counted] @ branch.direction[system.counted])
        if landed is None or abs(moved) <= LEFT * np.linalg.norm(
            (point.u - base.u)[system.counted]
        ):
            raise PathStalled("the end of the path could not be reached on the branch")
        point, tangent = landed
    tracer.attempt = branch.attempts
    tracer.landed = crossed is not None or any(
        tracer._reached(end, point) for end in tracer.plan.ends
    )
    tracer._evaluated = None
    tracer._commit(point)
    du, df = point.u - base.u, point.factor - base.factor
    tracer.size = tracer.metric.size(du, df)
    length = tracer.first_metric.size(du, df)
    # A closed branch comes back to where it began.
    tracer.origin = base
    tracer.base, tracer.guess = point, None
    tracer.tangent = tracer.mark = tangent
    tracer._measure(tracer.metric.displacement(du), abs(df))
    return Increment(
        point, tangent, branch.iterations, branch.attempts, length, tangent.negative, "mode"
    )


class BranchTracer(PathTracer):
    """A path that takes another branch at a bifurcation point, where its plan says so."""

    recomputed: ClassVar[frozenset[str]] = frozenset({"report", "cut_back"})

    def take_branch(self, critical: Critical) -> Increment:
        return switch(self, critical)
