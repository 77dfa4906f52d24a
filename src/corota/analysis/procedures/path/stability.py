"""Where an equilibrium path loses or regains stability: limit and bifurcation points.

The tangent's negative pivots count its unstable directions (Sylvester's law of inertia). An
increment over which the count changes, or over which the load factor turns back, holds a
critical point; it is located on the path, with the state before the increment kept.

Source: W. Wagner and P. Wriggers, Engineering Computations 5 (1988) 103-109; R. Seydel,
*Practical Bifurcation and Stability Analysis* (2010), ch. 5.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.path_system import PathSystem, Point, Tangent
    from corota.arrays import Floats


#: A critical point is located to this share of the increment that holds it.
CRITICAL_POINT_TOLERANCE = 1e-7
#: A kink to this fraction, searched next to its expected position by a fraction of the bracket.
BLUNT, BISECTION_OFFSET = 1e-4, 0.02
#: Behind a critical point the search for the next one starts at this fraction of the increment.
CLEAR = 1e-2
#: Distances at which a neighbor of a point without inverse is tried.
NEARBY = (0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
#: Distance from a point without inverse at which a neighbor stands for it.
BESIDE = 1e-4
#: Most points that are solved to locate one.
MOST_TRIALS = 40
#: Share of work (see :func:`work_share`) under which a mode takes no work from the load.
NO_WORK = 1e-3


@dataclass
class Station:
    """An equilibrium with the direction of the path there.

    Parameters
    ----------
    share : float
        Position in the increment, 0 at its start and 1 at its end.
    behind : bool
        Whether the path may have a kink since the start.
    """

    share: float
    point: Point
    tangent: Tangent
    behind: bool = False


@dataclass
class Critical:
    """A located critical point.

    Parameters
    ----------
    after : Station
        The nearest point that was solved behind it.
    kind : {"limit", "bifurcation", "kink"}
        A kink is not a critical point: the tangent jumps there, and the load factor continues.
    mode : ndarray, shape (n,)
        Null direction of the tangent (the softest, where it jumps), its largest component 1.
    projection : float
        See :func:`work_share`.
    negative : tuple of int
        Negative pivots before and behind.
    branches : list of ndarray, shape (n,)
        Directions of the branches, once they are computed.
    """

    point: Point
    after: Station
    kind: Literal["limit", "bifurcation", "kink"]
    mode: Floats
    projection: float
    negative: tuple[int, int]
    branches: list[Floats] = field(default_factory=list)


def softest_mode(system: PathSystem, start: Floats | None) -> tuple[float, Floats]:
    """Eigenvalue of the last factorized tangent that is nearest to zero, and its vector.

    Inverse iteration; the rate is the ratio of the two smallest eigenvalues, so that near a
    critical point two or three solutions suffice.

    Parameters
    ----------
    start : ndarray, shape (n,), or None
        A guess.

    Returns
    -------
    value : float
        Signed eigenvalue.
    vector : ndarray, shape (n,)
        All unknowns, its largest displacement 1.
    """
    n, counted = system.n_dofs, system.counted
    x = np.random.default_rng(7).standard_normal(n) if start is None else start[:n].copy()
    x /= np.linalg.norm(x)
    value = 0.0
    for _ in range(40):
        whole = system.solve_with_last_factor(x)
        y = whole[:n]
        size = float(np.linalg.norm(y))
        if size == 0.0 or not np.isfinite(size):
            break
        before, value = value, 1.0 / float(x @ y) if x @ y != 0.0 else 0.0
        change = np.linalg.norm(y / size - np.copysign(1.0, x @ y) * x)
        x, whole = y / size, whole / size
        if change < 1e-6 or (abs(value - before) <= 1e-10 * abs(value) and change < 1e-3):
            break
    shown = np.where(counted[:n], x, 0.0)
    largest = shown[np.abs(shown).argmax()] or 1.0
    return value, whole / largest


def has_event(before: Tangent, now: Tangent) -> bool:
    """Whether a critical point lies between two neighboring points."""
    changed = min(before.negative, now.negative) >= 0 and now.negative != before.negative
    return changed or turned(before, now)


def turned(before: Tangent, now: Tangent) -> bool:
    """Whether the load factor grows at one point and falls at the other."""
    return before.factor * now.factor < 0.0


def locate(
    system: PathSystem,
    start: Station,
    end: Station,
    solve: Callable[[float], Station | None],
    crossing: Callable[[Station, Station], float],
) -> Critical | None:
    """Find the first critical point of an increment.

    Parameters
    ----------
    system : PathSystem
        Its last factorization is that of `end`.
    start, end : Station
        Of the increment; :func:`has_event` holds between them.
    solve : callable
        Equilibrium and tangent at a share of the increment, or None; a `SingularError`
        where the tangent has no inverse.
    crossing : callable
        Share at which the directions of two stations cross.

    Returns
    -------
    Critical or None
        None if the increment must be shortened first.
    """
    low, high = start, end
    behind = [end]
    mode: Floats | None = None
    best: tuple[float, Station, Floats | None] | None = None
    tests: list[tuple[float, float]] = []
    for _ in range(MOST_TRIALS):
        kink = low.behind != high.behind
        share = _propose(tests, low.share, high.share)
        if kink:
            # Near the crossing, but so that both ends of the bracket come nearer in turn.
            left = high.share - low.share
            share = (
                crossing(low, high)
                + (BISECTION_OFFSET if best and best[1] is low else -BISECTION_OFFSET) * left
            )
            share = min(
                max(share, low.share + BISECTION_OFFSET * left),
                high.share - BISECTION_OFFSET * left,
            )
        sample = None
        now: Station | None = low
        for distance in NEARBY:
            near = max(share - distance, 0.5 * (low.share + share))
            try:
                now = solve(near)
                if now is None:
                    break
                # Where the tangent jumps, no mode gives the distance.
                sample = now, *((0.0, None) if kink else softest_mode(system, mode))
                break
            except SingularError:
                # As near as arithmetic permits; a neighbor is sufficient.
                if best is not None and abs(near - best[1].share) <= BESIDE:
                    break
        if sample is None:
            # Close to a kink rounding decides the states.
            if best is None or (now is None and not (kink and high.share - low.share < CLEAR)):
                return None
            break
        now, value, mode = sample
        by_factor = turned(start.tangent, high.tangent)
        if has_event(start.tangent, now.tangent):
            high = now
            behind.append(now)
        else:
            low = now
        if by_factor != turned(start.tangent, high.tangent):
            tests.clear()
        test = now.tangent.factor if turned(start.tangent, high.tangent) else value
        tests.append((now.share, test))
        if best is None or kink or abs(value) <= abs(best[0]):
            best = (value, now, mode)
        if high.share - low.share <= (BLUNT if kink else CRITICAL_POINT_TOLERANCE):
            break
        if not kink and _settled(tests):
            break
    assert best is not None
    _, at, mode = best
    if mode is None:
        found = solve(at.share)
        if found is None:
            return None
        at, mode = found, softest_mode(system, None)[1]
    # Pivots and load factor change sign a rounding error apart: look from a distance.
    clear = min(at.share + CLEAR, end.share)
    after = min((s for s in behind if s.share >= clear), key=lambda s: s.share)
    projection = work_share(system, at.point, mode)
    limit = turned(start.tangent, after.tangent)
    if turned(start.tangent, high.tangent) and abs(projection) <= NO_WORK:
        # Of several soft modes, as where a body yields everywhere, the path takes one itself.
        along = high.tangent.u
        work = work_share(system, at.point, along)
        if abs(work) > NO_WORK:
            shown = np.where(system.counted, along, 0.0)
            mode, projection = along / shown[np.abs(shown).argmax()], work
    negative = (start.tangent.negative, after.tangent.negative)
    kind: Literal["limit", "bifurcation", "kink"] = "bifurcation"
    if low.behind != high.behind:
        kind = "limit" if limit else "kink"
    elif limit and abs(projection) > NO_WORK:
        kind = "limit"
    return Critical(at.point, after, kind, mode, projection, negative)


def limit_behind(system: PathSystem, before: Tangent, end: Station) -> Critical:
    """Limit point at a kink at the end of an increment, whose mode is the direction behind it."""
    along = end.tangent.u
    mode = along / (along[np.abs(np.where(system.counted, along, 0.0)).argmax()] or 1.0)
    share = work_share(system, end.point, mode)
    pivots = (before.negative, end.tangent.negative)
    return Critical(end.point, end, "limit", mode, share, pivots)


def _propose(tests: list[tuple[float, float]], low: float, high: float) -> float:
    """Secant of the test function's last two values, or the middle of the bracket."""
    middle = 0.5 * (low + high)
    if len(tests) < 2:
        return middle
    (a, f), (b, g) = tests[-2:]
    if f == g:
        return middle
    share = b - g * (b - a) / (g - f)
    # A secant that leaves the bracket or barely enters it closes in on nothing.
    margin = 1e-9 * (high - low)
    if not low + margin < share < high - margin:
        return middle
    if len(tests) >= 6 and len(tests) % 3 == 0:
        return middle
    return share


def _settled(tests: list[tuple[float, float]]) -> bool:
    """Whether the last secant step was small and its next would be smaller."""
    if len(tests) < 3:
        return False
    (a, f), (b, g) = tests[-2:]
    return abs(b - a) <= CRITICAL_POINT_TOLERANCE and abs(g) <= abs(f)


def work_share(system: PathSystem, point: Point, mode: Floats) -> float:
    """Work of the load in a mode, over the load times the mode's largest displacement.

    It is 0 where the load does not drive the mode (bifurcation) and of order one where it
    does, however fine the mesh. Moving supports act through the stiffness between them and
    the free dofs: a difference of internal forces.
    """
    force, move = system.load_rate(point.u)
    if np.any(move):
        # Of the dofs alone: multipliers of contact have another unit.
        scale = float(np.abs(point.u[: system.n_dofs]).max(initial=0.0)) or 1.0
        step = 1e-6 * scale / float(np.abs(move).max())
        ahead = system.rows(point.u + step * move, 0.0)
        behind = system.rows(point.u - step * move, 0.0)
        force = force - (ahead - behind) / (2.0 * step)
        force[move != 0.0] = 0.0
    whole = 0.0
    for kind in (system.counted, ~system.counted):
        largest = float(np.abs(mode[kind]).max(initial=0.0))
        whole += float(np.abs(force[kind]).sum()) * largest
    return float(force @ mode) / whole if whole else 0.0
