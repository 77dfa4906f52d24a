"""Selections by geometry, as names of sets: ``near(10, 0.5)``, ``on_line(0, 0, 0, 1)``, ...

Such a name may stand wherever the name of a set may. The mesh makes the set when it is first
looked up: a node set, an edge set of the boundary edges within the selection and, for an area, a
cell set.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from corota.arrays import Bools, Floats

    Point = Sequence[float]

#: Distance within which a node lies on a curve, relative to the diagonal of the mesh.
TOLERANCE = 1e-6
_FORM = re.compile(r"(near|on_line|inside|on_circle)\(([^()]*)\)")
_ARGUMENTS = {
    "near": "x, y",
    "on_line": "x1, y1, x2, y2",
    "inside": "x_min, y_min, x_max, y_max",
    "on_circle": "x, y, radius",
}


def near(x: float, y: float) -> str:
    """Select the node that is closest to a point.

    Parameters
    ----------
    x, y : float
        The point [length].

    Returns
    -------
    str
        Name of the selection.

    Examples
    --------
    >>> import corota as ct
    >>> strip = ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2)
    >>> strip.points[strip.nodes_of(ct.near(9.9, 0.6))].tolist()
    [[10.0, 0.5]]
    """
    return _name("near", x, y)


def on_line(first: Point, last: Point) -> str:
    """Select the nodes on a straight line between two points, and the boundary edges on it.

    Parameters
    ----------
    first, last : sequence of float, shape (2,)
        End points [length].

    Returns
    -------
    str
        Name of the selection.

    Examples
    --------
    >>> import corota as ct
    >>> strip = ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2)
    >>> len(strip.nodes_of(ct.on_line((10.0, 0.0), (10.0, 1.0))))
    3
    """
    return _name("on_line", *first, *last)


def inside(lower: Point, upper: Point) -> str:
    """Select the nodes in a box, and the cells and boundary edges all of whose nodes are there.

    Parameters
    ----------
    lower, upper : sequence of float, shape (2,)
        Lower left and upper right corner [length]; infinite numbers leave a side open.

    Returns
    -------
    str
        Name of the selection.

    Examples
    --------
    >>> import corota as ct
    >>> strip = ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2)
    >>> len(strip.cell_indices(ct.inside((7.0, 0.0), (10.0, 0.5))))
    3
    """
    return _name("inside", *lower, *upper)


def on_circle(center: Point, radius: float) -> str:
    """Select the nodes on a circle, and the boundary edges whose ends are on it.

    Parameters
    ----------
    center : sequence of float, shape (2,)
        [length].
    radius : float
        [length].

    Returns
    -------
    str
        Name of the selection.

    Examples
    --------
    >>> import corota as ct
    >>> ring = ct.mesh.annulus(1.0, 2.0, 2, 8)
    >>> len(ring.nodes_of(ct.on_circle((0.0, 0.0), 2.0)))
    8
    """
    return _name("on_circle", *center, radius)


def is_selection(name: str) -> bool:
    """Whether a name is that of a selection by geometry."""
    return _FORM.fullmatch(name.strip()) is not None


def selected(name: str, points: Floats) -> Bools:
    """Nodes of a selection, shape (n_nodes,).

    Parameters
    ----------
    name : str
        Of the selection.
    points : ndarray, shape (n_nodes, 2)
        [length]

    Raises
    ------
    InputError
        If its numbers are wrong, or it selects nothing.
    """
    form = _FORM.fullmatch(name.strip())
    assert form is not None
    kind = form[1]
    try:
        numbers = [float(text) for text in form[2].split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != len(_ARGUMENTS[kind].split(",")) or any(map(math.isnan, numbers)):
        raise InputError(f"selection {name!r}: write {kind}({_ARGUMENTS[kind]}) with numbers")
    chosen = _MASKS[kind](points, *numbers)
    if not chosen.any():
        raise InputError(f"selection {name!r}: no node lies there; {_extent(points)}")
    return chosen


def is_point(name: str) -> bool:
    """Whether a selection is that of one node."""
    return name.strip().startswith("near")


def is_area(name: str) -> bool:
    """Whether a selection has cells."""
    return name.strip().startswith("inside")


def _name(kind: str, *numbers: float) -> str:
    if len(numbers) != len(_ARGUMENTS[kind].split(",")):
        raise InputError(f"{kind} takes {_ARGUMENTS[kind]}: points are pairs of numbers")
    return f"{kind}({', '.join(f'{float(v):.9g}' for v in numbers)})"


def _size(points: Floats) -> float:
    return float(np.hypot(*np.ptp(points, axis=0)))


def _extent(points: Floats) -> str:
    low, high = points.min(axis=0), points.max(axis=0)
    return f"the mesh has x from {low[0]:g} to {high[0]:g}, y from {low[1]:g} to {high[1]:g}"


def _near(points: Floats, x: float, y: float) -> Bools:
    chosen = np.zeros(len(points), np.bool_)
    chosen[np.argmin(np.hypot(points[:, 0] - x, points[:, 1] - y))] = True
    return chosen


def _on_line(points: Floats, x1: float, y1: float, x2: float, y2: float) -> Bools:
    along = np.array([x2 - x1, y2 - y1])
    length = float(np.hypot(*along))
    if not (length > 0.0 and math.isfinite(length)):
        raise InputError("a line is selected between two different points")
    from_first = points - (x1, y1)
    place = from_first @ along / length
    distance = np.abs(from_first @ (-along[1], along[0])) / length
    slack = TOLERANCE * _size(points)
    return np.asarray((distance <= slack) & (place >= -slack) & (place <= length + slack))


def _inside(points: Floats, x1: float, y1: float, x2: float, y2: float) -> Bools:
    slack = TOLERANCE * _size(points)
    low, high = np.array([x1, y1]) - slack, np.array([x2, y2]) + slack
    return np.asarray(((points >= low) & (points <= high)).all(axis=1))


def _on_circle(points: Floats, x: float, y: float, radius: float) -> Bools:
    distance = np.hypot(points[:, 0] - x, points[:, 1] - y)
    return np.asarray(np.abs(distance - radius) <= TOLERANCE * _size(points))


#: Nodes of each kind of selection.
_MASKS: dict[str, Callable[..., Bools]] = {
    "near": _near,
    "on_line": _on_line,
    "inside": _inside,
    "on_circle": _on_circle,
}
