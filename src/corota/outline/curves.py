"""Curves of an outline: lines, arcs and splines, each with the name of its set."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Floats


#: Samples of a full circle.
SAMPLES = 72
#: Largest angle of an arc [rad]; longer ones are cut.
MOST = 0.75 * math.pi


@dataclass
class Curve:
    """One curve from its first to its last point.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Points on the curve in order, the ends included [length].
    center : ndarray, shape (2,), optional
        Of an arc [length].
    smooth : bool
        Whether the points are those of a spline; otherwise they are joined by straight lines.
    name : str
        Of the edge set that the curve belongs to; none if empty.
    source : str
        Where it comes from, for messages.
    """

    points: Floats
    center: Floats | None = None
    smooth: bool = False
    name: str = ""
    source: str = field(default="", compare=False)

    @property
    def length(self) -> float:
        """Length of the polygon of its points [length]."""
        return float(np.hypot(*np.diff(self.points, axis=0).T).sum())


def line(first: ArrayLike, last: ArrayLike, name: str = "", source: str = "") -> Curve:
    """A straight line between two points, shape (2,) [length]."""
    return Curve(_points([first, last]), name=name, source=source)


def polyline(
    points: ArrayLike,
    name: str = "",
    closed: bool = False,
    source: str = "",
    fillet: ArrayLike = 0.0,
) -> list[Curve]:
    """Straight lines from point to point, with rounded corners.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Corners [length].
    name : str
        Of the edge set.
    closed : bool
        Whether a line leads back to the first point.
    source : str
        Where they come from, for messages.
    fillet : float or array_like, shape (n,)
        Radius of the arc at each corner, 0 for a sharp one [length]; those at the ends of an open
        polyline are not used.

    Raises
    ------
    InputError
        If a fillet does not fit between its neighbors.

    Examples
    --------
    >>> bar = polyline([(0, 0), (4, 0), (4, 2), (0, 2)], closed=True, fillet=[0, 0, 1, 1])
    >>> [curve.center is not None for curve in bar]
    [False, False, True, False, True, False]
    """
    at = _points(points)
    n = len(at)
    radii = np.broadcast_to(np.asarray(fillet, dtype=np.float64), (n,)).copy()
    if not closed:
        radii[[0, -1]] = 0.0
    if not (np.isfinite(radii).all() and (radii >= 0.0).all()):
        raise InputError(f"radii of fillets must be >= 0, not {fillet!r:.80}")
    size = np.hypot(*(np.roll(at, -1, axis=0) - at).T)
    ways = (np.roll(at, -1, axis=0) - at) / np.where(size > 0.0, size, 1.0)[:, None]
    turns = np.array([_turn(ways[k - 1], ways[k]) if radii[k] else 0.0 for k in range(n)])
    reach = radii * np.abs(np.tan(0.5 * turns))
    sides = range(n if closed else n - 1)
    tight = [k for k in sides if reach[k] + reach[(k + 1) % n] > size[k] * (1.0 + 1e-9)]
    if tight:
        raise InputError(
            f"the fillets at the ends of the side from {at[tight[0]].tolist()} do not fit into its "
            f"length of {size[tight[0]]:.6g}"
        )
    found = []
    for k in range(n):
        first, last = at[k] - reach[k] * ways[k - 1], at[k] + reach[k] * ways[k]
        if reach[k]:
            found += bulge(first, last, math.tan(0.25 * turns[k]), name, source)
        if k in sides:
            after = (k + 1) % n
            end = at[after] - reach[after] * ways[k]
            if np.hypot(*(end - last)) > 1e-9 * size[k]:
                found.append(line(last, end, name, source))
    return found


def _turn(before: Floats, after: Floats) -> float:
    """Angle from one direction to another, to the left [rad]."""
    cross = before[0] * after[1] - before[1] * after[0]
    return math.atan2(float(cross), float(before @ after))


def arc(
    center: ArrayLike, radius: float, start: float, end: float, name: str = "", source: str = ""
) -> list[Curve]:
    """An arc from an angle to another [rad], counter-clockwise if `end` is larger.

    Arcs of more than 135 degrees are cut into equal parts.
    """
    middle = _points([center])[0]
    if not (radius > 0.0 and math.isfinite(radius + start + end)):
        raise InputError(f"an arc needs a radius > 0 and finite angles, not {radius}")
    parts = max(1, math.ceil(abs(end - start) / MOST - 1e-9))
    cuts = np.linspace(start, end, parts + 1)
    found = []
    for a, b in pairwise(cuts):
        sides = max(2, math.ceil(abs(b - a) / (2.0 * math.pi) * SAMPLES - 1e-9))
        angles = np.linspace(a, b, sides + 1)
        at = middle + radius * np.column_stack([np.cos(angles), np.sin(angles)])
        found.append(Curve(at, middle, name=name, source=source))
    return found


def circle(center: ArrayLike, radius: float, name: str = "", source: str = "") -> list[Curve]:
    """A full circle, as three arcs."""
    return arc(center, radius, 0.0, 2.0 * math.pi, name, source)


def bulge(
    first: ArrayLike, last: ArrayLike, value: float, name: str = "", source: str = ""
) -> list[Curve]:
    """An arc between two points with the tangent of a quarter of its angle, as in DXF.

    Positive values turn counter-clockwise from the first to the last point; 0 is a line.
    """
    a, b = _points([first, last])
    if abs(value) < 1e-12:
        return [line(a, b, name, source)]
    chord = b - a
    height = (1.0 - value * value) / (4.0 * value)
    middle = 0.5 * (a + b) + height * np.array([-chord[1], chord[0]])
    start = math.atan2(a[1] - middle[1], a[0] - middle[0])
    curves = arc(
        middle, float(np.hypot(*(a - middle))), start, start + 4.0 * math.atan(value), name, source
    )
    # The ends are those of the drawing, to the bit.
    curves[0].points[0], curves[-1].points[-1] = a, b
    return curves


def spline(points: ArrayLike, name: str = "", source: str = "") -> list[Curve]:
    """A smooth curve through points, shape (n, 2) [length]; a closed one is cut into two."""
    at = _points(points)
    half = len(at) // 2
    closed = len(at) > 3 and np.allclose(at[0], at[-1], rtol=0.0, atol=1e-9 * np.ptp(at))
    parts = [at[: half + 1], at[half:]] if closed else [at]
    return [Curve(part, smooth=len(part) > 2, name=name, source=source) for part in parts]


def _points(given: ArrayLike | Sequence[ArrayLike]) -> Floats:
    at = np.array(given, dtype=np.float64)
    if at.ndim != 2 or at.shape[1] != 2 or not np.isfinite(at).all():
        raise InputError(f"points have shape (n, 2) and finite coordinates, not {given!r:.80}")
    return at
