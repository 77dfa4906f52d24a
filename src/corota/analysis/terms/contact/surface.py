"""Edges of a contact surface for the core, and masters as curves without kinks.

Master edges as a curve without kinks: a quadratic B-spline over the nodes.

Around each node whose edges meet at a blunt angle the boundary is the parabola from the middle of
the edge before to the middle of the edge behind, tangent to both. Neighbors share these points
and their tangents, so the normal is continuous. On a circle the curve has a constant distance to
it, that of the middles of the edges. Sharp corners, ends and straight boundaries do not change.

Source: C. de Boor, *A Practical Guide to Splines* (2001), ch. IX.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import distinct
from corota.mesh.parts import part_of_nodes
from corota.model.constraints import Coupling

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.numbered_model import NumberedModel

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


@dataclass
class Surface:
    """Edges of a surface for the core.

    Parameters
    ----------
    name : str
    edges : ndarray of int, shape (n, 2)
        Cell and local edge.
    nodes : ndarray of int, shape (n, 3)
        Corner, corner, mid-side node or -1; the element on the left.
    bulge, thickness, length : ndarray, shape (n,)
        Share of the drilling rotations in the shape of the edge [1], thickness and length of
        the chord [length]; of single nodes the distance to the next one.
    half : ndarray, shape (n,)
        Distance of a line to its surfaces, on both sides [length]; -1 for edges of bodies.
    """

    name: str
    edges: Ints
    nodes: Ints
    bulge: Floats
    thickness: Floats
    length: Floats
    half: Floats = field(default_factory=lambda: np.zeros(0))
    #: Nodes, in place of edges.
    points: Ints | None = None
    #: Whether gaps are those of nodes, as of every pair with lines.
    pointwise: bool = False

    @property
    def two_sided(self) -> bool:
        """Whether these are lines."""
        return bool((self.half >= 0.0).any())

    def take(self, rows: Ints) -> Surface:
        """Some of the edges."""
        return Surface(
            self.name,
            self.edges[rows],
            self.nodes[rows],
            self.bulge[rows],
            self.thickness[rows],
            self.length[rows],
            self.half[rows],
        )

    @property
    def node_list(self) -> Ints:
        """Nodes, each once."""
        if self.points is not None:
            return self.points
        every = distinct(self.nodes)
        return np.asarray(every[every >= 0])


def carrier(system: NumberedModel, side: Surface | None) -> int | None:
    """Reference node of a rigid body that is part of the body of a surface and turns with it."""
    if side is None:
        return None
    mesh = system.model.mesh
    part = part_of_nodes(mesh)
    own = part[side.node_list[0]]
    for item in system.model.constraints:
        if isinstance(item, Coupling) and item.kind == "kinematic":
            joined = part[mesh.node_indices(item.nodes)]
            if own >= 0 and (joined == own).any():
                return item.reference
    return None


#: Turns of the boundary at a node that are smoothed: larger ones are corners, smaller ones none.
CORNER, NONE = math.radians(50.0), math.radians(0.5)
#: Shapes of the core: an element edge, a parabola round a node, halves of an edge.
ELEMENT, SPLINE, FIRST_HALF, SECOND_HALF = range(4)


def smoothed(points: Floats, master: Surface) -> tuple[Ints, Floats, Ints]:
    """Pieces of the smoothed master in place of its edges.

    Parameters
    ----------
    points : ndarray, shape (n_nodes, 2)
    master : Surface

    Returns
    -------
    nodes : ndarray of int, shape (m, 3)
    bulge : ndarray, shape (m,)
    shapes : ndarray of int, shape (m,)
        In the format of the core.
    """
    of_edge = [_sides(row) for row in master.nodes.tolist()]
    after = {a: b for own in of_edge for a, b in own}
    before = {b: a for a, b in after.items()}
    round_ = set(blunt_turns(points, master))
    nodes: list[tuple[int, int, int]] = []
    bulge: list[float] = []
    shapes: list[int] = []

    def put(piece: tuple[int, int, int], shape: int, factor: float = 0.0) -> None:
        nodes.append(piece)
        bulge.append(factor)
        shapes.append(shape)

    for row, factor, own in zip(master.nodes.tolist(), master.bulge, of_edge, strict=True):
        if not round_.intersection(row):
            put(tuple(row), ELEMENT, float(factor))
            continue
        for a, b in own:
            if a not in round_ and b not in round_:
                put((a, b, -1), ELEMENT)
            elif a not in round_:
                put((a, b, -1), FIRST_HALF)
            elif b not in round_:
                put((a, b, -1), SECOND_HALF)
            if b in round_:
                put((before[b], after[b], b), SPLINE)
    return np.array(nodes, np.int64), np.array(bulge), np.array(shapes, np.int64)


def blunt_turns(points: Floats, master: Surface) -> dict[int, float]:
    """Nodes at which a boundary turns, but not sharply, with the angles [rad]."""
    sides = [side for row in master.nodes.tolist() for side in _sides(row)]
    after = dict(sides)
    out = {}
    for a, b in sides:
        if b not in after:
            continue
        (ax, ay), (bx, by) = points[b] - points[a], points[after[b]] - points[b]
        turn = abs(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
        if NONE < turn < CORNER:
            out[b] = turn
    return out


def sharp_corners(x: Floats, edges: Ints) -> list[int]:
    """Nodes at which a boundary with the body on its left turns left by more than `CORNER`."""
    after = dict(edges.tolist())
    out = []
    for a, b in edges.tolist():
        if b not in after:
            continue
        (ax, ay), (bx, by) = x[b] - x[a], x[after[b]] - x[b]
        if math.atan2(ax * by - ay * bx, ax * bx + ay * by) > CORNER:
            out.append(b)
    return out


def _sides(row: list[int]) -> list[tuple[int, int]]:
    """Straight sides between the nodes of an edge."""
    a, b, middle = row
    return [(a, b)] if middle < 0 else [(a, middle), (middle, b)]


__all__ = ["Surface", "blunt_turns", "carrier", "sharp_corners", "smoothed"]
