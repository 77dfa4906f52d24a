"""Slender members of an outline: cut off at their ends, so that they are meshed in rows."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from corota.arrays import Floats, Ints
from corota.outline.curves import Curve
from corota.outline.loops import Loops, area, contains

#: Length over thickness from which a member is meshed in rows, and the largest length of its cells
#: over their height.
SLENDER, ASPECT = 4.0, 5.0
#: Cells along a full circle.
AROUND = 24
#: Rays from each curve, at least.
RAYS = 24
#: Cosine of the angle between the sides of a member, at least.
FACING = 0.9
#: Share of the thickness within which a cut takes a corner that is there.
SNAP = 0.15


class Side:
    """A curve of an outline, directed so that the material is to its left.

    Parameters
    ----------
    back : bool
        Whether it is run from its last point to its first.
    """

    def __init__(self, curve: Curve, back: bool) -> None:
        self.curve = curve
        self.points = curve.points[::-1] if back else curve.points
        steps = np.hypot(*np.diff(self.points, axis=0).T)
        #: Length from the first point to each, shape (n,) [length].
        self.along = np.concatenate([[0.0], np.cumsum(steps)])
        self.length = float(self.along[-1])

    @cached_property
    def _spline(self) -> object:
        from scipy.interpolate import make_interp_spline

        return make_interp_spline(self.along, self.points, k=min(3, len(self.points) - 1))

    def at(self, s: Floats) -> Floats:
        """Points at lengths along the curve, shape (n, 2)."""
        if self.curve.smooth:
            return np.asarray(self._spline(s))  # type: ignore[operator]
        found = self.chord(s)
        if self.curve.center is not None:
            out = found - self.curve.center
            radii = np.hypot(*(self.points - self.curve.center).T)
            found = self.curve.center + out * (
                np.interp(s, self.along, radii) / np.hypot(*out.T)
            ).reshape(-1, 1)
        return found

    def chord(self, s: Floats) -> Floats:
        """Points of the polygon, from which rays start, shape (n, 2)."""
        return np.column_stack([np.interp(s, self.along, self.points[:, i]) for i in (0, 1)])

    def inward(self, s: Floats) -> Floats:
        """Unit normals to the left, shape (n, 2)."""
        if self.curve.center is not None:
            out = self.at(s) - self.curve.center
            turn = _cross(self.points[0] - self.curve.center, self.points[1] - self.curve.center)
            normal = -out if turn > 0.0 else out
        elif self.curve.smooth:
            normal = _left(np.asarray(self._spline(s, 1)))  # type: ignore[operator]
        else:
            normal = np.tile(_left(self.points[-1] - self.points[0]), (len(s), 1))
        return np.asarray(normal / np.hypot(*normal.T)[:, None])

    def radius(self, s: Floats) -> Floats:
        """Radius of curvature at lengths along the curve, infinite for lines, shape (n,)."""
        if self.curve.center is not None:
            return np.full(len(s), float(np.hypot(*(self.points[0] - self.curve.center))))
        if not self.curve.smooth:
            return np.full(len(s), np.inf)
        way, bend = (np.asarray(self._spline(s, k)) for k in (1, 2))  # type: ignore[operator]
        with np.errstate(divide="ignore"):
            return np.asarray(np.hypot(*way.T) ** 3 / np.abs(_cross(way, bend)))

    def turn(self, first: float, last: float) -> float:
        """Angle between the tangents at two lengths [rad]."""
        a, b = self.inward(np.array([first, last]))
        return abs(math.atan2(_cross(a, b), float(a @ b)))

    def piece(self, first: float, last: float, a: Floats, b: Floats) -> Curve:
        """The part between two lengths, from point `a` to point `b`."""
        within = (self.along > first + 1e-9 * self.length) & (
            self.along < last - 1e-9 * self.length
        )
        at = np.vstack([a, self.points[within], b])
        old = self.curve
        return Curve(at, old.center, old.smooth and len(at) > 2, old.name, old.source)


def sides_of(loops: Loops) -> list[Side]:
    """All curves of an outline in the order of their numbers, material to the left."""
    outer = {part[0] for part in loops.parts}
    found: dict[int, Side] = {}
    for k, loop in enumerate(loops.loops):
        for number, back in loop:
            found[number] = Side(loops.curves[number], back if k in outer else not back)
    return [found[number] for number in range(len(loops.curves))]


class Rays:
    """Rays through the material, from one side of an outline to the opposite one."""

    def __init__(self, sides: Sequence[Side]) -> None:
        self.first = np.vstack([side.points[:-1] for side in sides])
        self.step = np.vstack([np.diff(side.points, axis=0) for side in sides])
        counts = [len(side.points) - 1 for side in sides]
        #: Side of each segment, and the length along it at its start and end.
        self.owner = np.repeat(np.arange(len(sides)), counts)
        self.start = np.concatenate([side.along[:-1] for side in sides])
        self.size = np.hypot(*self.step.T)

    def hit(self, at: Floats, normal: Floats) -> tuple[Floats, Ints, Floats]:
        """Distance to the opposite side, its number (-1 for none) and the length along it."""
        n = len(at)
        distances, owners, places = np.full(n, np.inf), np.full(n, -1), np.zeros(n)
        for k in range(n):
            cross = normal[k, 0] * self.step[:, 1] - normal[k, 1] * self.step[:, 0]
            apart = self.first - at[k]
            with np.errstate(divide="ignore", invalid="ignore"):
                distance = _cross(apart, self.step) / cross
                share = (apart[:, 0] * normal[k, 1] - apart[:, 1] * normal[k, 0]) / cross
            near = 1e-6 * self.size
            hit = (share >= -1e-9) & (share <= 1.0 + 1e-9) & (distance > near)
            if hit.any():
                best = int(np.where(hit, distance, np.inf).argmin())
                distances[k] = distance[best]
                owners[k] = self.owner[best]
                places[k] = self.start[best] + np.clip(share[best], 0, 1) * self.size[best]
        return distances, owners, places


@dataclass
class _Strip:
    """A slender member between two sides.

    Parameters
    ----------
    spans : list of list of float
        First and last length along each; where the first side begins, the second ends.
    thickness : float
        Largest distance of the sides [length].
    """

    sides: tuple[int, int]
    spans: list[list[float]]
    thickness: float

    @property
    def length(self) -> float:
        return max(last - first for first, last in self.spans)


@dataclass
class Faces:
    """An outline cut into faces.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Corners [length].
    curves : list of Curve
        Pieces of the outline, then the cuts.
    ends : ndarray of int, shape (n_curves, 2)
    faces : list of list of list of (int, bool)
        Curves of the loops of each face, the outer loop first, and whether each runs backwards;
        outer loops are counter-clockwise, holes clockwise.
    parts : list of int
        Part of each face.
    rows : dict of int to tuple of int
        Cells along the four curves of faces that are meshed in rows.
    """

    points: Floats
    curves: list[Curve]
    ends: Ints
    faces: list[list[list[tuple[int, bool]]]]
    parts: list[int]
    rows: dict[int, tuple[int, ...]] = field(default_factory=dict)


def cut(loops: Loops, size: float, through: int) -> Faces:
    """Cut off the slender members of an outline; the rest keeps its curves.

    A member lies between two curves that face each other over a length of four times their
    distance. It is cut off by straight lines across its ends, so that fillets there stay with the
    rest, and gets at least `through` rows of cells.

    Parameters
    ----------
    size : float
        Largest side of a cell [length].
    """
    sides = sides_of(loops)
    strips = _strips(loops, sides, size)
    while True:
        faces, quads = _faces(loops, sides, strips)
        wrong = _wrong(loops, faces, quads)
        if not wrong:
            break
        strips = [strip for k, strip in enumerate(strips) if k not in wrong]
    _count(faces, quads, strips, sides, size, through)
    return faces


# -- members -----------------------------------------------------------------------------


def _strips(loops: Loops, sides: list[Side], size: float) -> list[_Strip]:
    """Slender members, each once."""
    rays = Rays(sides)
    found = [
        strip for number in range(len(sides)) for strip in _strips_from(number, sides, rays, size)
    ]
    found.sort(key=lambda strip: -strip.length / strip.thickness)
    kept: list[_Strip] = []
    taken: dict[int, list[list[float]]] = {}
    corners = np.array(loops.points)
    for strip in found:
        slack = 1e-3 * strip.thickness
        free = all(
            last <= low + slack or first >= high - slack
            for side, (first, last) in zip(strip.sides, strip.spans, strict=True)
            for low, high in taken.get(side, [])
        )
        if free and not _contains_any(strip, sides, corners):
            kept.append(strip)
            for side, span in zip(strip.sides, strip.spans, strict=True):
                taken.setdefault(side, []).append(span)
    return kept


def _strips_from(number: int, sides: list[Side], rays: Rays, size: float) -> list[_Strip]:
    """Members on the left of a side."""
    side = sides[number]
    count = max(RAYS, math.ceil(side.length / size)) if len(sides) > 1 else 0
    s = side.length * np.linspace(1e-6, 1.0 - 1e-6, count + 1) if count else np.zeros(0)
    if not len(s):
        return []
    distance, owner, _ = _facing(number, sides, rays, s)
    found = []
    k = 0
    while k < len(s):
        last = k
        while last + 1 < len(s) and owner[last + 1] == owner[k] >= 0 and (
            abs(distance[last + 1] - distance[last]) <= 0.5 * (s[last + 1] - s[last])
        ):  # fmt: skip
            last += 1
        if owner[k] >= 0 and last > k:
            found += _strip_between(number, sides, rays, s, int(k), int(last), int(owner[k]))
        k = last + 1
    return found


def _facing(number: int, sides: list[Side], rays: Rays, s: Floats) -> tuple[Floats, Ints, Floats]:
    """As :meth:`Rays.hit` from lengths along a side; nothing where the sides are not parallel."""
    at, normal = sides[number].chord(s), sides[number].inward(s)
    distance, owner, place = rays.hit(at, normal)
    for k, other in enumerate(owner.tolist()):
        if other >= 0 and normal[k] @ sides[other].inward(place[k : k + 1])[0] > -FACING:
            owner[k] = -1
    return distance, owner, place


def _strip_between(
    number: int, sides: list[Side], rays: Rays, s: Floats, first: int, last: int, other: int
) -> list[_Strip]:
    """The member of a run of rays that meet the same side, if it is slender."""
    side, opposite = sides[number], sides[other]
    ends = [
        _end(number, sides, rays, s, first, -1, other),
        _end(number, sides, rays, s, last, 1, other),
    ]
    (s0, h0, t0), (s1, h1, t1) = ends
    # Half or one thickness away from what stands between the sides, or from an end along which the
    # outline runs.
    for k, (at, height, place) in enumerate(ends):
        near = SNAP * height
        at = _snapped(at, side.length, near)
        place = _snapped(place, opposite.length, near)
        closed = at in (0.0, side.length) or place in (0.0, opposite.length)
        back = 0.0 if closed else height
        if closed and _runs_along(number, other, sides, at, place, k):
            back = 0.5 * height
        if back:
            at += back if k == 0 else -back
            if not s0 < at < s1:
                return []
            distance, owner, length = _facing(number, sides, rays, np.array([at]))
            if owner[0] != other:
                return []
            height, place = float(distance[0]), float(length[0])
        ends[k] = (at, height, place)
    (s0, h0, t0), (s1, h1, t1) = ends
    thick = max(h0, h1)
    if min(s1 - s0, t0 - t1) < (1.0 - 1e-6) * SLENDER * thick:
        return []
    return [_Strip((number, other), [[s0, s1], [t1, t0]], thick)]


def _runs_along(
    number: int, other: int, sides: list[Side], at: float, place: float, end: int
) -> bool:
    """Whether the outline leaves a corner at an end of a member along the cut there.

    Not where one straight side joins both corners, which needs no cut.
    """
    first, second = sides[number], sides[other]
    corners = first.at(np.array([at]))[0], second.at(np.array([place]))[0]
    # Where the first side ends, the second one begins.
    leaving, arriving = ((first, at), (second, place))[:: 1 if end else -1]
    for this, (side, length) in enumerate((leaving, arriving)):
        if length != (0.0 if this else side.length):
            continue
        corner = side.points[0 if this else -1]
        for neighbor in sides:
            points = neighbor.points[::-1] if this else neighbor.points
            if neighbor is side or not np.array_equal(points[0], corner):
                continue
            apart = [float(np.hypot(*(point - corner))) for point in corners]
            far = corners[int(np.argmax(apart))]
            joins = len(points) == 2 and np.hypot(*(points[-1] - far)) < 1e-9 * max(apart)
            way, wanted = points[1] - points[0], far - corner
            cosine = way @ wanted / (np.hypot(*way) * np.hypot(*wanted))
            if cosine > FACING and not joins:
                return True
    return False


def _snapped(value: float, length: float, near: float) -> float:
    if value <= near:
        return 0.0
    return length if value >= length - near else value


def _end(
    number: int, sides: list[Side], rays: Rays, s: Floats, k: int, way: int, other: int
) -> tuple[float, float, float]:
    """Where a run of rays ends: length along the side, distance, length along the opposite one."""
    inside = s[k]
    if 0 <= k + way < len(s):
        outside = s[k + way]
        for _ in range(30):
            middle = 0.5 * (inside + outside)
            _, owner, _ = _facing(number, sides, rays, np.array([middle]))
            inside, outside = (middle, outside) if owner[0] == other else (inside, middle)
    distance, _, place = _facing(number, sides, rays, np.array([inside]))
    return float(inside), float(distance[0]), float(place[0])


def _contains_any(strip: _Strip, sides: list[Side], corners: Floats) -> bool:
    """Whether a corner of the outline lies within a member."""
    around = np.vstack(
        [
            sides[number].at(np.linspace(span[0], span[1], 50))
            for number, span in zip(strip.sides, strip.spans, strict=True)
        ]
    )
    low, high = around.min(axis=0), around.max(axis=0)
    slack = 1e-3 * strip.thickness
    near = corners[((corners > low - slack) & (corners < high + slack)).all(axis=1)]
    return any(
        contains(around, point) and np.hypot(*(around - point).T).min() > 0.05 * strip.thickness
        and _away(around, point) > slack
        for point in near
    )  # fmt: skip


def _away(polygon: Floats, point: Floats) -> float:
    """Distance of a point from the sides of a polygon."""
    step = np.roll(polygon, -1, axis=0) - polygon
    share = ((point - polygon) * step).sum(axis=1) / np.maximum((step**2).sum(axis=1), 1e-300)
    foot = polygon + np.clip(share, 0.0, 1.0)[:, None] * step
    return float(np.hypot(*(foot - point).T).min())


# -- faces -------------------------------------------------------------------------------


def _faces(loops: Loops, sides: list[Side], strips: list[_Strip]) -> tuple[Faces, list[set[int]]]:
    """Faces of the outline with its cuts, and the four curves of each member."""
    points = [np.array(p) for p in loops.points]
    vertices = [_vertices(loops, sides, number) for number in range(len(sides))]
    corners: list[list[int]] = []
    for strip in strips:
        found = []
        for number, span in zip(strip.sides, strip.spans, strict=True):
            for s in span:
                found.append(
                    _vertex(vertices[number], s, SNAP * strip.thickness, points, sides[number])
                )
        corners.append(found)
    curves: list[Curve] = []
    ends: list[tuple[int, int]] = []
    part_of_side = _part_of_side(loops)
    parts: list[int] = []
    for number, side in enumerate(sides):
        stops = sorted(vertices[number].items())
        for (first, a), (last, b) in zip(stops[:-1], stops[1:], strict=True):
            curves.append(side.piece(first, last, points[a], points[b]))
            ends.append((a, b))
            parts.append(part_of_side[number])
    outline = len(curves)
    quads = []
    for strip, (a, b, c, d) in zip(strips, corners, strict=True):
        quad = {_between(ends[:outline], a, b), _between(ends[:outline], c, d)}
        for p, q in ((b, c), (d, a)):
            quad.add(
                _joining(p, q, curves, ends, outline, parts, part_of_side[strip.sides[0]], points)
            )
        quads.append(quad)
    faces, owners = _traced(points, curves, ends, outline, parts, len(loops.parts))
    return Faces(np.array(points), curves, np.array(ends), faces, owners), quads


def _vertices(loops: Loops, sides: list[Side], number: int) -> dict[float, int]:
    """Corners along a side by their length."""
    a, b = loops.ends[number].tolist()
    if not np.array_equal(sides[number].points[0], loops.points[a]):
        a, b = b, a
    return {0.0: a, sides[number].length: b}


def _vertex(
    along: dict[float, int], s: float, near: float, points: list[Floats], side: Side
) -> int:
    """Corner at a length along a side: one that is near, or a new one."""
    nearest = min(along, key=lambda other: abs(other - s))
    if abs(nearest - s) <= near:
        return along[nearest]
    points.append(side.at(np.array([s]))[0])
    along[s] = len(points) - 1
    return along[s]


def _part_of_side(loops: Loops) -> dict[int, int]:
    return {
        number: k
        for k, part in enumerate(loops.parts)
        for loop in part
        for number, _ in loops.loops[loop]
    }


def _between(ends: list[tuple[int, int]], a: int, b: int) -> int:
    """Number of the piece from one corner to another; -1 for none or several pieces."""
    return next((k for k, pair in enumerate(ends) if pair == (a, b)), -1)


def _joining(
    a: int,
    b: int,
    curves: list[Curve],
    ends: list[tuple[int, int]],
    outline: int,
    parts: list[int],
    part: int,
    points: list[Floats],
) -> int:
    """Number of the straight curve between two corners, which is there or becomes a cut."""
    for k, pair in enumerate(ends):
        straight = curves[k].center is None and not curves[k].smooth
        if straight and (pair == (a, b) or (k >= outline and pair == (b, a))):
            return k
    curves.append(Curve(np.array([points[a], points[b]])))
    ends.append((a, b))
    parts.append(part)
    return len(ends) - 1


def _traced(
    points: list[Floats],
    curves: list[Curve],
    ends: list[tuple[int, int]],
    outline: int,
    parts: list[int],
    n_parts: int,
) -> tuple[list[list[list[tuple[int, bool]]]], list[int]]:
    """Faces: from each directed curve on to the next one to the left, around the material."""
    leaving: dict[int, list[tuple[float, tuple[int, bool]]]] = {}
    directed = [(k, False) for k in range(len(ends))] + [
        (k, True) for k in range(outline, len(ends))
    ]
    for k, back in directed:
        leaving.setdefault(ends[k][back], []).append((_direction(curves[k], back), (k, back)))
    left = dict.fromkeys(directed)
    cycles: list[list[tuple[int, bool]]] = []
    while left:
        here = next(iter(left))
        cycle = []
        while here in left:
            del left[here]
            cycle.append(here)
            k, back = here
            behind = _direction(curves[k], not back)
            turns = [
                ((behind - angle) % (2.0 * math.pi), way)
                for angle, way in leaving[ends[k][not back]]
                if way != (k, not back)
            ]
            if not turns:
                break
            here = min(turns)[1]
        cycles.append(cycle)
    faces: list[list[list[tuple[int, bool]]]] = []
    owners: list[int] = []
    polygons = [polygon(curves, cycle) for cycle in cycles]
    areas = [area(p) for p in polygons]
    outer = [k for k in range(len(cycles)) if areas[k] > 0.0]
    for k in outer:
        faces.append([cycles[k]])
        owners.append(parts[cycles[k][0][0]])
    for k in range(len(cycles)):
        if areas[k] <= 0.0:
            around = [
                f for f, j in enumerate(outer)
                if owners[f] == parts[cycles[k][0][0]] and contains(polygons[j], polygons[k][0])
            ]  # fmt: skip
            if around:
                faces[min(around, key=lambda f: areas[outer[f]])].append(cycles[k])
    return faces, owners


def _direction(curve: Curve, back: bool) -> float:
    """Angle in which a curve leaves its first point, or its last one if run backwards [rad]."""
    at = curve.points[::-1] if back else curve.points
    way = at[1] - at[0]
    if curve.center is not None:
        out = at[0] - curve.center
        tangent = np.array([-out[1], out[0]])
        way = tangent if tangent @ way > 0.0 else -tangent
    return math.atan2(way[1], way[0])


def polygon(curves: list[Curve], cycle: list[tuple[int, bool]]) -> Floats:
    """Points along directed curves, the first not repeated, shape (n, 2)."""
    return np.vstack(
        [curves[k].points[::-1][:-1] if back else curves[k].points[:-1] for k, back in cycle]
    )


def _wrong(loops: Loops, faces: Faces, quads: list[set[int]]) -> set[int]:
    """Members that are no face of four sides; all, if the faces do not cover the parts."""
    four = [{k for k, _ in face[0]} for face in faces.faces if len(face) == 1]
    wrong = {k for k, quad in enumerate(quads) if -1 in quad or quad not in four}
    if not wrong and quads:
        given = sum(
            (1.0 if k == part[0] else -1.0) * area(loops.polygon(k))
            for part in loops.parts for k in part
        )  # fmt: skip
        covered = sum(area(polygon(faces.curves, c)) for face in faces.faces for c in face)
        if abs(covered - given) > 1e-3 * given:
            wrong = set(range(len(quads)))
    return wrong


# -- cells -------------------------------------------------------------------------------


def _count(
    faces: Faces,
    quads: list[set[int]],
    strips: list[_Strip],
    sides: list[Side],
    size: float,
    through: int,
) -> None:
    """Cells along the curves of members and of four-sided blocks.

    Opposite sides of a face have as many cells, which passes from face to face across the cuts.
    """
    four = {f: [k for k, _ in face[0]] for f, face in enumerate(faces.faces)
            if len(face) == 1 and len(face[0]) == 4}  # fmt: skip
    members = {frozenset(cycle): f for f, cycle in four.items()}
    need = [math.ceil(curve.length / size - 1e-9) for curve in faces.curves]
    structured = []
    for strip, quad in zip(strips, quads, strict=True):
        face = members[frozenset(quad)]
        structured.append(face)
        pairs = four[face][0::2], four[face][1::2]
        short, long = sorted(pairs, key=lambda pair: sum(faces.curves[k].length for k in pair))
        across = max(through, math.ceil(strip.thickness / size - 1e-9))
        along = math.ceil(strip.length / min(size, ASPECT * strip.thickness / across) - 1e-9)
        for number, span in zip(strip.sides, strip.spans, strict=True):
            along = max(along, math.ceil(AROUND * sides[number].turn(*span) / (2.0 * math.pi)))
        for k in short:
            need[k] = across
        for k in long:
            need[k] = along
    blocks = [f for f in four if f not in structured and _is_block(faces, faces.faces[f][0])]
    for f in blocks:
        if faces.parts.count(faces.parts[f]) == 1:  # the whole part, not a block between members
            need = [max(n, through) if k in four[f] else n for k, n in enumerate(need)]
    structured += blocks
    same = list(range(len(faces.curves)))
    for f in structured:
        for a, b in (four[f][0::2], four[f][1::2]):
            old, new = same[a], same[b]
            same = [new if k == old else k for k in same]
    used = {k for f in structured for k in four[f]}
    for f in structured:
        faces.rows[f] = tuple(max(need[j] for j in used if same[j] == same[k]) for k in four[f])


def _is_block(faces: Faces, loop: list[tuple[int, bool]]) -> bool:
    """Whether a face of four sides is near a rectangle: opposite sides alike, corners square."""
    ways = [Side(faces.curves[k], back) for k, back in loop]
    lengths = [way.length for way in ways]
    alike = all(max(a, b) <= 1.5 * min(a, b) for a, b in (lengths[0::2], lengths[1::2]))
    normals = [(way.inward(np.array([0.0]))[0], way.inward(np.array([way.length]))[0])
               for way in ways]  # fmt: skip
    turns = [abs(float(normals[k - 1][1] @ normals[k][0])) for k in range(4)]
    return alike and max(turns) < 0.6


def _cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _left(way: Floats) -> Floats:
    return np.stack([-way[..., 1], way[..., 0]], axis=-1)
