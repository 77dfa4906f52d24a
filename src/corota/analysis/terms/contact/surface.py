"""Surfaces for the core: edges, lines and single nodes, and masters as curves without kinks.

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
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np

import corota._core as _core
from corota.arrays import distinct
from corota.errors import ModelError
from corota.mesh.parts import part_of_nodes
from corota.model import elements
from corota.model.constraints import Coupling
from corota.model.contact import ContactPair, RigidCurve, Tie

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

    def repeated(self, images: Ints) -> Surface:
        """The surface on the nodes of its images, one row of `images` for each."""
        found = self.take(np.tile(np.arange(len(self.edges)), len(images)))
        nodes = [np.where(self.nodes >= 0, row[self.nodes], -1) for row in images]
        found.nodes = np.concatenate(nodes)
        return found

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
    for item in system.model.constraints:
        if isinstance(item, Coupling) and item.kind == "kinematic":
            part = part_of_nodes(mesh)
            own = part[side.node_list[0]]
            if own >= 0 and (part[mesh.node_indices(item.nodes)] == own).any():
                return item.reference
    return None


# -- lines and single nodes ----------------------------------------------------------------


def line_surface(system: NumberedModel, name: str, edges: Ints, item: ContactPair | Tie) -> Surface:
    """Lines of a surface, with the distance to their surfaces: half the height of the section.

    Raises
    ------
    ModelError
        Naming the element that has no section.
    """
    mesh = system.model.mesh
    n = len(edges)
    nodes = np.full((n, 3), -1, np.int64)
    nodes[:, :2] = np.array(mesh.edge_nodes(edges))
    bulge, width, half = np.zeros(n), np.zeros(n), np.full(n, -1.0)
    for block in system.blocks:
        here = np.isin(edges[:, 0], block.cells)
        if not here.any():
            continue
        section = block.section
        element = elements.find(section.element)
        if not section.profile[0] or element.name not in ("BEAM", "TRUSS"):
            continue
        # A beam's chord bulges by the difference of its end rotations, as a drilling edge does.
        bulge[here] = element.alpha_b
        half[here] = 0.5 * section.line_height
        width[here] = section.profile[0] / (section.line_height or np.sqrt(section.profile[0]))
    if (half < 0.0).any():
        cell = mesh.cell_labels[int(edges[int(np.argmin(half)), 0])]
        raise ModelError(
            f"contact pair {item.name!r}: element {cell} of surface {name!r} has no section of a "
            "beam or truss; springs have no surface",
            item.where,
        )
    length = np.hypot(*(mesh.points[nodes[:, 1]] - mesh.points[nodes[:, 0]]).T)
    return Surface(name, edges, nodes, bulge, width, length, half)


def node_surface(system: NumberedModel, name: str, nodes: Ints, item: ContactPair | Tie) -> Surface:
    """Single nodes as a slave surface without thickness, each with the area 1."""
    if not len(nodes):
        raise ModelError(f"contact pair {item.name!r}: node set {name!r} is empty", item.where)
    spacing = _spacing(system)[nodes]
    edges, flat = np.zeros((0, 3), np.int64), np.zeros(0)
    return Surface(name, edges[:, :2], edges, flat, flat, spacing, flat, distinct(nodes))


def _spacing(system: NumberedModel) -> Floats:
    """Distance to the nearest node of the same cell, shape (n_nodes,)."""
    mesh = system.model.mesh
    out = np.full(mesh.n_nodes, np.inf)
    for block in mesh.cells:
        x = mesh.points[block.nodes]
        for a in range(block.nodes.shape[1]):
            for b in range(a):
                apart = np.hypot(*(x[:, a] - x[:, b]).T)
                np.minimum.at(out, block.nodes[:, a], apart)
                np.minimum.at(out, block.nodes[:, b], apart)
    out[~np.isfinite(out) | (out == 0.0)] = system.length
    return out


def line_core(
    system: NumberedModel,
    item: ContactPair | Tie,
    slave: Surface,
    master: Surface | RigidCurve,
    reach: float,
    depth: float,
) -> tuple[_core.Contact, Surface, Surface | None, float, float]:
    """The core's pair, its surfaces, its search distance and the depth of a penetration it sees.

    Raises
    ------
    ModelError
        If such a pair is not supported.
    """
    mesh = system.model.mesh
    _check_lines(system, item, slave, master)
    slave.pointwise = True
    wide = max(0.0, slave.half.max(initial=0.0), *_half(master))
    reach += wide
    x = np.column_stack([mesh.points, np.zeros(mesh.n_nodes)])
    flat = np.zeros(0)
    none = (np.zeros((0, 3), np.int64), flat, flat)
    rigid = None
    other = none
    if isinstance(master, RigidCurve):
        reference = master.reference
        point = reference if isinstance(reference, tuple) else (0.0, 0.0)
        node = -1 if reference is None or isinstance(reference, tuple) else int(reference)
        rigid = (master.backward, node, point, master.turns)
    else:
        other = (master.nodes, master.bulge, master.half)
    tied = isinstance(item, Tie)
    points = slave.points if slave.points is not None else np.zeros(0, np.int64)
    if tied and slave.points is None:
        points = slave.node_list
    own = none if len(points) else (slave.nodes, slave.bulge, slave.half)
    try:
        core = _core.line_contact(
            x,
            own,
            slave.thickness if not len(points) else flat,
            points,
            other,
            rigid,
            method="point_tie" if tied else "line",
            reach=reach,
            margin=reach if tied else 0.5 * reach,
            depth=depth,
        )
    except ValueError as error:
        raise ModelError(f"contact pair {item.name!r}: {error}", item.where) from None
    body = None if isinstance(master, RigidCurve) else master
    core.carry(carrier(system, slave), carrier(system, body))
    return core, slave, body, reach, depth


def _half(master: Surface | RigidCurve) -> list[float]:
    return [] if isinstance(master, RigidCurve) else [float(master.half.max(initial=0.0))]


def _check_lines(
    system: NumberedModel,
    item: ContactPair | Tie,
    slave: Surface,
    master: Surface | RigidCurve,
) -> None:
    kind = "tie" if isinstance(item, Tie) else "contact pair"
    if getattr(item, "smooth", False):
        raise ModelError(
            f"contact pair {item.name!r}: a pair with a line or with single nodes is not smoothed; "
            "leave smooth out",
            item.where,
        )
    if isinstance(master, RigidCurve):
        return
    if master.points is not None:
        raise ModelError(
            f"{kind} {item.name!r}: a master needs edges or lines, and {master.name!r} is a node "
            "set; exchange slave and master",
            item.where,
        )
    shared = np.intersect1d(slave.node_list, master.node_list)
    if len(shared):
        raise ModelError(
            f"{kind} {item.name!r}: {slave.name!r} and {master.name!r} share node "
            f"{system.model.mesh.node_labels[shared[0]]}, so they cannot separate there; remove "
            "it from one of them",
            item.where,
        )


# -- masters without kinks -----------------------------------------------------------------

#: Turns of the boundary at a node that are smoothed: larger ones are corners, smaller ones none.
CORNER, NONE = math.radians(50.0), math.radians(0.5)


class Shape(IntEnum):
    """Pieces of a master, as the core numbers them."""

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
    shapes: list[Shape] = []

    def put(piece: tuple[int, int, int], shape: Shape, factor: float = 0.0) -> None:
        nodes.append(piece)
        bulge.append(factor)
        shapes.append(shape)

    for row, factor, own in zip(master.nodes.tolist(), master.bulge, of_edge, strict=True):
        if not round_.intersection(row):
            put(tuple(row), Shape.ELEMENT, float(factor))
            continue
        for a, b in own:
            if a not in round_ and b not in round_:
                put((a, b, -1), Shape.ELEMENT)
            elif a not in round_:
                put((a, b, -1), Shape.FIRST_HALF)
            elif b not in round_:
                put((a, b, -1), Shape.SECOND_HALF)
            if b in round_:
                put((before[b], after[b], b), Shape.SPLINE)
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


__all__ = [
    "Surface",
    "blunt_turns",
    "carrier",
    "line_core",
    "line_surface",
    "node_surface",
    "sharp_corners",
    "smoothed",
]
