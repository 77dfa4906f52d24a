"""Curves of a drawing cleaned into closed loops: parts and their holes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.lazy import lazy

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.arrays import Floats, Ints
    from corota.outline.curves import Curve


#: Gap that is closed, relative to the diagonal of the drawing.
GAP = 1e-5
#: Places that a message lists.
LISTED = 5


class OutlineError(InputError):
    """Curves that are no closed outline, with the places.

    Parameters
    ----------
    message : str
    curves : sequence of Curve
    places : ndarray, shape (n, 2)
        Where it is open, crosses itself, or more than two curves meet [length].
    """

    def __init__(
        self, message: str, curves: Sequence[Curve] = (), places: Floats | None = None
    ) -> None:
        super().__init__(message)
        self.curves = list(curves)
        self.places = np.zeros((0, 2)) if places is None else places

    # A convenience: a function of a higher layer, which loads at its first call.
    plot = lazy("corota.plots.refused_outline:refused_outline")


@dataclass
class Loops:
    """Closed loops of an outline.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Corners [length].
    curves : list of Curve
    ends : ndarray of int, shape (n_curves, 2)
        First and last corner of each curve.
    loops : list of list of (int, bool)
        Curves in order, counter-clockwise, and whether each is run backwards.
    parts : list of list of int
        Loops of each part: the outer one, then its holes.
    report : list of str
        What was cleaned.
    """

    points: Floats
    curves: list[Curve]
    ends: Ints
    loops: list[list[tuple[int, bool]]]
    parts: list[list[int]]
    report: list[str] = field(default_factory=list)

    def polygon(self, loop: int) -> Floats:
        """Points along a loop, counter-clockwise, the first not repeated; shape (n, 2)."""
        found = []
        for number, back in self.loops[loop]:
            at = self.curves[number].points
            found.append(at[::-1][:-1] if back else at[:-1])
        return np.vstack(found)


def clean(curves: Sequence[Curve], gap: float = 0.0) -> Loops:
    """Close gaps, remove what is double or has no length, and chain the curves to loops.

    Parameters
    ----------
    curves : sequence of Curve
    gap : float
        Largest gap that is closed [length]; 1e-5 of the diagonal by default.

    Raises
    ------
    OutlineError
        If curves cross, end without a neighbor or meet in threes, with the places.
    InputError
        If there are no curves.
    """
    given = [c for c in curves if len(c.points) > 1]
    if not given:
        raise InputError("the outline has no curves")
    everything = np.vstack([c.points for c in given])
    size = float(np.hypot(*np.ptp(everything, axis=0)))
    gap = gap or GAP * size
    report: list[str] = []
    long = [c for c in given if c.length > gap]
    if len(long) < len(given):
        report.append(f"{len(given) - len(long)} curves shorter than {gap:.3g} removed")
    if not long:
        raise InputError("the outline has no curve that is longer than the gap")
    points, ends, widest = _joined(np.array([c.points[[0, -1]] for c in long]), gap)
    if widest > 1e-12 * size:
        report.append(f"gaps up to {widest:.3g} closed")
    kept = _distinct(long, ends, gap)
    if len(kept) < len(long):
        report.append(f"{len(long) - len(kept)} double curves removed")
    chosen, ends = [long[k] for k in kept], ends[kept]
    for curve, (a, b) in zip(chosen, ends, strict=True):
        curve.points = curve.points.copy()
        curve.points[0], curve.points[-1] = points[a], points[b]
    _refuse_crossings(chosen, ends, gap)
    found = Loops(points, chosen, ends, _chained(points, chosen, ends, gap), [], report)
    found.parts = _parts(found)
    return found


def _joined(ends: Floats, gap: float) -> tuple[Floats, Ints, float]:
    """Corners, ends that are closer than `gap` united; the largest gap."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    flat = ends.reshape(-1, 2)
    pairs = cKDTree(flat).query_pairs(gap, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(flat),) * 2)
    count, owner = connected_components(graph, directed=False)
    points = np.zeros((count, 2))
    np.add.at(points, owner, flat)
    points /= np.bincount(owner)[:, None]
    widest = 2.0 * float(np.hypot(*(flat - points[owner]).T).max(initial=0.0))
    return points, owner.reshape(-1, 2).astype(np.int64), widest


def _distinct(curves: list[Curve], ends: Ints, gap: float) -> list[int]:
    """Curves that are not the same as an earlier one."""
    seen: dict[tuple[int, int], list[Floats]] = {}
    kept = []
    for k, (curve, (a, b)) in enumerate(zip(curves, ends.tolist(), strict=True)):
        half = _middle(curve)
        others = seen.setdefault((min(a, b), max(a, b)), [])
        if not any(np.hypot(*(half - other)) <= 10.0 * gap for other in others):
            others.append(half)
            kept.append(k)
    return kept


def _middle(curve: Curve) -> Floats:
    steps = np.hypot(*np.diff(curve.points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    half = 0.5 * along[-1]
    return np.array([np.interp(half, along, curve.points[:, i]) for i in range(2)])


def _refuse_crossings(curves: list[Curve], ends: Ints, gap: float) -> None:
    """Refuse curves that cross or touch other than at common ends."""
    first = np.vstack([c.points[:-1] for c in curves])
    last = np.vstack([c.points[1:] for c in curves])
    owner = np.repeat(np.arange(len(curves)), [len(c.points) - 1 for c in curves])
    step = last - first
    low, high = np.minimum(first, last) - gap, np.maximum(first, last) + gap
    places: list[str] = []
    crossings: list[Floats] = []
    for k in range(len(first)):
        near = (owner > owner[k]) & (low <= high[k]).all(axis=1) & (high >= low[k]).all(axis=1)
        rows = np.flatnonzero(near)
        if not len(rows):
            continue
        cross = step[k, 0] * step[rows, 1] - step[k, 1] * step[rows, 0]
        apart = first[rows] - first[k]
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (apart[:, 0] * step[rows, 1] - apart[:, 1] * step[rows, 0]) / cross
            t = (apart[:, 0] * step[k, 1] - apart[:, 1] * step[k, 0]) / cross
        slack, own = gap / np.hypot(*step[k]), gap / np.hypot(*step[rows].T)
        hit = (s >= -slack) & (s <= 1 + slack) & (t >= -own) & (t <= 1 + own)
        for row, share in zip(rows[hit], s[hit], strict=True):
            at = first[k] + share * step[k]
            common = set(ends[owner[k]]) & set(ends[owner[row]])
            corners = np.array([curves[owner[k]].points[0], curves[owner[k]].points[-1]])
            shared = any(
                np.hypot(*(corners[i] - at)) <= 4.0 * gap
                for i in range(2)
                if ends[owner[k]][i] in common
            )
            if not shared:
                sources = " and ".join(
                    filter(None, (curves[owner[k]].source, curves[owner[row]].source))
                )
                crossings.append(at)
                places.append(f"({at[0]:.6g}, {at[1]:.6g})" + (f" ({sources})" if sources else ""))
    if places:
        places = list(dict.fromkeys(places))
        raise OutlineError(
            f"curves cross at {_some(places)}: trim them there in the drawing, or move what is no "
            "outline to a layer that is left out",
            curves,
            np.array(crossings),
        )


def _chained(
    points: Floats, curves: list[Curve], ends: Ints, gap: float
) -> list[list[tuple[int, bool]]]:
    """Loops of curves, each counter-clockwise."""
    at: dict[int, list[int]] = {}
    for k, (a, b) in enumerate(ends.tolist()):
        at.setdefault(a, []).append(k)
        at.setdefault(b, []).append(k)
    loose = [p for p, meeting in at.items() if len(meeting) == 1]
    if loose:
        distance = _nearest_gap(points[loose])
        hint = f"; the nearest ends are {distance:.3g} apart" if distance else ""
        raise OutlineError(
            f"the outline is open at {_some([_place(points[p]) for p in loose])}{hint}: close it, "
            f"or give a larger gap than {gap:.3g}",
            curves,
            points[loose],
        )
    many = [p for p, meeting in at.items() if len(meeting) > 2]
    if many:
        raise OutlineError(
            f"three or more curves meet at {_some([_place(points[p]) for p in many])}: an outline "
            "has two at each corner",
            curves,
            points[many],
        )
    left = set(range(len(curves)))
    loops = []
    while left:
        start = min(left)
        corner, loop = int(ends[start][0]), []
        number = start
        while number in left:
            left.discard(number)
            back = int(ends[number][0]) != corner
            loop.append((number, back))
            corner = int(ends[number][0 if back else 1])
            number = next((k for k in at[corner] if k in left), -1)
        loops.append(loop)
    for k, loop in enumerate(loops):
        polygon = np.vstack(
            [(curves[n].points[::-1] if back else curves[n].points)[:-1] for n, back in loop]
        )
        if area(polygon) < 0.0:
            loops[k] = [(n, not back) for n, back in reversed(loop)]
    return loops


def _nearest_gap(points: Floats) -> float:
    from scipy.spatial import cKDTree

    if len(points) < 2:
        return 0.0
    distance = np.asarray(cKDTree(points).query(points, k=2)[0])
    return float(distance[:, 1].min())


def _parts(found: Loops) -> list[list[int]]:
    """Loops by part: those inside an even number of others are outer ones."""
    polygons = [found.polygon(k) for k in range(len(found.loops))]
    areas = [area(p) for p in polygons]
    around = [
        [j for j in range(len(polygons)) if areas[j] > areas[k] and contains(polygons[j], p[0])]
        for k, p in enumerate(polygons)
    ]
    outer = [k for k in range(len(polygons)) if len(around[k]) % 2 == 0]
    parts = {k: [k] for k in outer}
    for k in range(len(polygons)):
        if k not in parts:
            parts[min(around[k], key=areas.__getitem__)].append(k)
    return [parts[k] for k in outer]


def area(polygon: Floats) -> float:
    """Signed area of a polygon, shape (n, 2); positive if counter-clockwise."""
    x, y = polygon.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def contains(polygon: Floats, point: Floats) -> bool:
    """Whether a point, shape (2,), is inside a polygon, by the parity of crossings."""
    x, y = polygon.T
    nx, ny = np.roll(x, -1), np.roll(y, -1)
    spans = (y > point[1]) != (ny > point[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = x + (point[1] - y) / (ny - y) * (nx - x)
    return bool((spans & (crossing > point[0])).sum() % 2)


def _place(point: Floats) -> str:
    return f"({point[0]:.6g}, {point[1]:.6g})"


def _some(places: list[str]) -> str:
    more = f" and {len(places) - LISTED} more places" if len(places) > LISTED else ""
    return ", ".join(places[:LISTED]) + more
