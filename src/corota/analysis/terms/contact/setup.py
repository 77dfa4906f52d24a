"""From the contact pairs and ties of a model to pairs of the core, checked and named.

Surfaces are edges of bodies, lines or single nodes. Master edges may be a curve without kinks, a
quadratic B-spline over the nodes: around each node whose edges meet at a blunt angle the boundary
is the parabola from the middle of the edge before to the middle of the edge behind, tangent to
both. Neighbors share these points and their tangents, so the normal is continuous. On a circle the
curve has a constant distance to it, that of the middles of the edges. Sharp corners, ends and
straight boundaries do not change.

Source: C. de Boor, *A Practical Guide to Splines* (2001), ch. IX.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import IntEnum
from itertools import permutations
from typing import TYPE_CHECKING, Any

import numpy as np

import corota._core as _core
from corota._core import CORNER
from corota.analysis.terms.contact.gaps import AT_ONCE, SAME
from corota.arrays import distinct
from corota.errors import ModelError
from corota.mesh.kinds import SIDES
from corota.mesh.parts import nodes_of_cells, part_of_cells, part_of_nodes, parts_without
from corota.model import elements
from corota.model.constraints import Coupling
from corota.model.contact import ContactPair, RigidCurve, Tie, edges_or_nodes, joint_thickness
from corota.results.rigid import rigid_lines

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats, Ints
    from corota.mesh import Mesh


#: Default search distance of pairs, in edges.
REACH = 4.0


@dataclass
class Surface:
    """Edges of a surface for the core, n of them."""

    name: str
    edges: Ints  # cell and local edge, shape (n, 2)
    nodes: Ints  # corner, corner, mid-side node or -1; the element on the left; shape (n, 3)
    bulge: Floats  # share of the drilling rotations in the shape of each edge [1], shape (n,)
    thickness: Floats  # [length], 0 for a circumference, shape (n,)
    length: Floats  # of the chord; of single nodes the distance to the next one [length]
    #: Distance of a line to its surfaces, on both sides [length]; -1 for edges of bodies.
    half: Floats = field(default_factory=lambda: np.zeros(0))
    points: Ints | None = None  # nodes, in place of edges
    pointwise: bool = False  # whether gaps are those of nodes, as of every pair with lines

    @property
    def two_sided(self) -> bool:
        """Whether these are lines."""
        return bool((self.half >= 0.0).any())

    def take(self, rows: Ints) -> Surface:
        """Some of the edges."""
        parts = ("edges", "nodes", "bulge", "thickness", "length", "half")
        return Surface(self.name, *(getattr(self, part)[rows] for part in parts))

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


if TYPE_CHECKING:
    #: The core's pair, its surfaces, its search distance and the depth of a penetration it sees.
    Core = tuple[_core.Contact, Surface, Surface | None, float, float]


def _refused(item: ContactPair | Tie, why: str) -> ModelError:
    """The error of a pair or tie that is refused."""
    kind = "tie" if isinstance(item, Tie) else "contact pair"
    return ModelError(f"{kind} {item.name!r}: {why}", item.where)


def _reference(curve: RigidCurve) -> tuple[int, tuple[float, float]]:
    """Node that a curve follows, -1 for none, and the point of a fixed one."""
    if curve.reference is None or isinstance(curve.reference, tuple):
        return -1, curve.reference or (0.0, 0.0)
    return int(curve.reference), (0.0, 0.0)


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


def _spacing(system: NumberedModel) -> Floats:
    """Distance to the nearest node of the same cell, shape (n_nodes,)."""
    mesh = system.model.mesh
    out = np.full(mesh.n_nodes, np.inf)
    for block in mesh.cells:
        x = mesh.points[block.nodes]
        for a, b in permutations(range(block.nodes.shape[1]), 2):
            np.minimum.at(out, block.nodes[:, a], np.hypot(*(x[:, a] - x[:, b]).T))
    out[~np.isfinite(out) | (out == 0.0)] = system.length
    return out


# -- masters without kinks -----------------------------------------------------------------

#: Turn of a straight boundary whose coordinates have few digits [rad].
FLAT = 5e-3


class Shape(IntEnum):
    """Pieces of a master, as the core numbers them."""

    ELEMENT, SPLINE, FIRST_HALF, SECOND_HALF = range(4)


def smoothed(points: Floats, master: Surface) -> tuple[Ints, Floats, Ints]:
    """Pieces of the smoothed master in place of its edges, in the format of the core.

    These are nodes, bulge and kinds of shape, (m, 3), (m,) and (m,); `points` are (n_nodes, 2).
    """
    of_edge = [_sides(row) for row in master.nodes.tolist()]
    after = {a: b for own in of_edge for a, b in own}
    before = {b: a for a, b in after.items()}
    round_ = set(blunt_turns(points, master))
    pieces: list[tuple[list[int], float, Shape]] = []
    for row, factor, own in zip(master.nodes.tolist(), master.bulge, of_edge, strict=True):
        if not round_.intersection(row):
            pieces.append((row, float(factor), Shape.ELEMENT))
            continue
        for a, b in own:
            if a not in round_ and b not in round_:
                pieces.append(([a, b, -1], 0.0, Shape.ELEMENT))
            elif a not in round_:
                pieces.append(([a, b, -1], 0.0, Shape.FIRST_HALF))
            elif b not in round_:
                pieces.append(([a, b, -1], 0.0, Shape.SECOND_HALF))
            if b in round_:
                pieces.append(([before[b], after[b], b], 0.0, Shape.SPLINE))
    nodes, bulge, shapes = zip(*pieces, strict=True)
    return np.array(nodes, np.int64), np.array(bulge), np.array(shapes, np.int64)


def blunt_turns(points: Floats, master: Surface) -> dict[int, float]:
    """Nodes at which a boundary turns, but not sharply, with the angles [rad]."""
    turns = _turns(points, [side for row in master.nodes.tolist() for side in _sides(row)])
    return {node: abs(turn) for node, turn in turns.items() if FLAT < abs(turn) < CORNER}


def sharp_corners(x: Floats, edges: Ints) -> list[int]:
    """Nodes at which a boundary with the body on its left turns left by more than `CORNER`."""
    return [node for node, turn in _turns(x, edges.tolist()).items() if turn > CORNER]


def _turns(x: Floats, sides: list[tuple[int, int]]) -> dict[int, float]:
    """Angles to the left by which a boundary turns at the ends of its sides [rad]."""
    after, out = dict(sides), {}
    for a, b in sides:
        if b in after:
            (ax, ay), (bx, by) = x[b] - x[a], x[after[b]] - x[b]
            out[b] = math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    return out


def _sides(row: list[int]) -> list[tuple[int, int]]:
    """Straight sides between the nodes of an edge."""
    a, b, middle = row
    return [(a, b)] if middle < 0 else [(a, middle), (middle, b)]


# -- pairs -----------------------------------------------------------------------------


def surface(system: NumberedModel, where: str | Ints, item: ContactPair | Tie) -> Surface:
    """Edges of a surface, lines or single nodes; refuses interior edges.

    Raises
    ------
    ModelError
        Naming the set and the element.
    """
    mesh = system.model.mesh
    name = where if isinstance(where, str) else "edges"
    if isinstance(where, str) and where not in mesh.edge_sets and where not in mesh.node_sets:
        known = ", ".join(mesh.edge_sets) or "none"
        raise _refused(item, f"no surface named {where!r}; there are: {known}")
    edges, single = edges_or_nodes(mesh, where)
    if len(single):
        # Without thickness, each with the area 1.
        name = name if isinstance(where, str) else "nodes"
        none, flat = np.zeros((0, 3), np.int64), np.zeros(0)
        spacing = _spacing(system)[single]
        return Surface(name, edges, none, flat, flat, spacing, flat, distinct(single))
    if not len(edges):
        raise _refused(item, f"surface {name!r} is empty")
    edges = edges[np.sort(np.unique(edges, axis=0, return_index=True)[1])]
    lines = mesh.are_lines(edges[:, 0])
    if lines.any() and not lines.all():
        cell = mesh.cell_labels[int(edges[int(np.argmax(lines)), 0])]
        raise _refused(
            item,
            f"surface {name!r} has edges of bodies and the line "
            f"{cell}; make two surfaces, and a pair of each",
        )
    inner = ~(lines | _among(edges, mesh.boundary_edges()))
    if inner.any():
        cell = int(edges[int(np.argmax(inner)), 0])
        raise _refused(
            item,
            f"surface {name!r} is not on the boundary: "
            f"{int(inner.sum())} of its {len(edges)} edges lie between elements, the first at "
            f"element {mesh.cell_labels[cell]}; take outer edges only",
        )
    n = len(edges)
    nodes = np.full((n, 3), -1, np.int64)
    bulge, thickness, half = np.zeros(n), np.zeros(n), np.full(n, -1.0)
    found = np.zeros(n, bool)
    for block in system.blocks:
        order = np.argsort(block.cells)
        at = np.minimum(np.searchsorted(block.cells[order], edges[:, 0]), len(order) - 1)
        mine = block.cells[order][at] == edges[:, 0]
        section, element = block.section, elements.find(block.section.element)
        area, height = section.profile[0], section.line_height
        if lines.any() and not (area and element.name in ("BEAM", "TRUSS")):
            continue
        for side, local in enumerate(SIDES[element.cell]):
            here = np.flatnonzero(mine & (edges[:, 1] == side))
            rows = order[at[here]]
            nodes[here, : len(local)] = block.nodes[rows][:, list(local)]
            # A beam's chord bulges by the difference of its end rotations, as a drilling edge does.
            bulge[here] = block.shares(rows, side)
            if lines.any():
                half[here] = 0.5 * height
                thickness[here] = area / (height or np.sqrt(area))
            elif not section.axisymmetric:  # 0 stands for the circumference
                depth = section.thickness_at(nodes[here, :2], mesh.points)
                thickness[here] = depth.mean(axis=1)
            found[here] = True
    if not found.all():
        cell = int(edges[int(np.argmin(found)), 0])
        of_lines = "no section of a beam or truss; springs have no surface"
        why = of_lines if lines.any() else "no section, or no such edge"
        raise _refused(item, f"element {mesh.cell_labels[cell]} of surface {name!r} has {why}")
    length = np.hypot(*(mesh.points[nodes[:, 1]] - mesh.points[nodes[:, 0]]).T)
    return Surface(name, edges, nodes, bulge, thickness, length, half)


def _among(edges: Ints, others: Ints) -> Bools:
    """Which edges are in a list of others."""
    many = 1 + max(int(edges[:, 1].max(initial=0)), int(others[:, 1].max(initial=0)))
    key = edges[:, 0] * many + edges[:, 1]
    return np.isin(key, others[:, 0] * many + others[:, 1])


def along_contour(found: Surface, points: Floats) -> Surface:
    """The edges one after the other along each contour.

    Of two edges in self-contact the later one is the slave. A closed contour begins at its sharpest
    notch, which meets nothing: so a slit has one side before the other.
    """
    follower = {int(a): k for k, a in enumerate(found.nodes[:, 0])}
    ends = set(found.nodes[:, 1].tolist())
    starts = [k for k, a in enumerate(found.nodes[:, 0].tolist()) if a not in ends]
    order: list[int] = []
    seen = np.zeros(len(found.nodes), bool)
    for first in [*starts, *range(len(found.nodes))]:
        contour: list[int] = []
        at: int | None = first
        while at is not None and not seen[at]:
            seen[at] = True
            contour.append(at)
            at = follower.get(int(found.nodes[at, 1]))
        if contour and at == first:
            turns = _turns(points, found.nodes[contour, :2].tolist())
            # The tip of a slit turns by half a turn, of either sign by rounding.
            turns |= {a: t - math.tau for a, t in turns.items() if t > math.pi - SAME}
            begin = int(np.argmin([turns[a] for a in found.nodes[contour, 0].tolist()]))
            contour = contour[begin:] + contour[:begin]
        order += contour
    return found.take(np.array(order, np.int64))


def make_core(system: NumberedModel, item: ContactPair | Tie) -> Core:
    """The core's pair, its surfaces, its search distance and the depth of a penetration it sees.

    Slave edges out of the tolerance of a tie are not tied.

    Raises
    ------
    ModelError
        If the surfaces cannot come into contact, or such a pair is not supported.
    """
    mesh, pair = system.model.mesh, None if isinstance(item, Tie) else item
    slave = surface(system, item.slave, item)
    master: Surface | None = None
    itself = pair is not None and pair.itself
    if not isinstance(item.master, RigidCurve) and not itself:
        master = surface(system, item.master, item)
        if pair and pair.images is not None:
            master = master.repeated(pair.images)
    sides = [slave] if master is None else [slave, master]
    longest = max(float(side.length.max()) for side in sides)
    if isinstance(item, Tie):
        reach = item.tolerance or 0.1 * longest
    else:
        reach = item.reach or REACH * longest
    depth = np.inf
    slave.pointwise = of_lines(slave) or (pair is not None and any(map(of_lines, sides)))
    if slave.pointwise:
        _check_lines(system, item, slave, master)
        if pair:
            bodies = [side for side in sides if not of_lines(side)]
            depth = min((float(_thickness(system, body).max()) for body in bodies), default=reach)
        reach += max(float(side.half.max(initial=0.0)) for side in sides)
    elif master is not None:
        _check_pair(system, item, slave, master)
    if pair and not slave.pointwise:
        # Deeper inside a body, the core takes the opposite side for that of another body.
        same = itself
        if pair.images is not None and master is not None:
            part = part_of_cells(mesh)
            same = bool(np.isin(part[slave.edges[:, 0]], part[master.edges[:, 0]]).any())
        thickness = _thickness(system, slave)
        depth = 0.5 * float(thickness.min()) if same else float(thickness.max())
        if itself:
            slave = along_contour(slave, mesh.points)
        if master is not None:
            slave.thickness[:] = _joint(mesh.points, slave, master)
    core = core_of(mesh, item, slave, master, reach, depth)
    if pair or slave.pointwise:
        # A boundary that meets itself is both sides; a rigid master knows its own rotation.
        core.carry(carrier(system, slave), carrier(system, master or slave))
    return core, slave, master, reach, depth


def _joint(points: Floats, slave: Surface, master: Surface) -> Floats:
    """Thickness of the joint at the slave edges; 0 stands for a circumference.

    A rib on a ring has the smaller of its thickness and the circumference.
    """
    if not (slave.thickness.any() or master.thickness.any()):
        return slave.thickness
    depths = []
    for side in (slave, master):
        around = 2.0 * np.pi * points[side.nodes[:, :2], 0].mean(axis=1)
        depths.append(np.where(side.thickness == 0.0, around, side.thickness))
    joint = joint_thickness(points, slave.nodes, depths[0], master.nodes, depths[1])
    return np.where((slave.thickness == 0.0) & (joint == depths[0]), 0.0, joint)


def core_of(
    mesh: Mesh,
    item: ContactPair | Tie,
    slave: Surface,
    master: Surface | None,
    reach: float,
    depth: float,
) -> _core.Contact:
    """The core's pair of two surfaces, of one with itself or with a rigid curve.

    Raises
    ------
    ModelError
        If the core refuses it.
    """
    x = np.column_stack([mesh.points, np.zeros(mesh.n_nodes)])
    curve, margin = item.master, reach
    method, corners = "point_tie" if slave.pointwise else "tie", False
    if isinstance(item, ContactPair):
        margin = 0.5 * reach
        # A pressure law permits overclosure, and its pressures act on areas: a corner has none.
        method, corners = "line" if slave.pointwise else item.method, item.law is None
    facts: Any = {"method": method, "reach": reach, "margin": margin}
    rigid = (curve.backward, *_reference(curve)) if isinstance(curve, RigidCurve) else None
    turns = isinstance(curve, RigidCurve) and curve.turns
    try:
        if slave.pointwise:
            none = np.zeros((0, 3), np.int64), np.zeros(0), np.zeros(0)
            other = none if master is None else (master.nodes, master.bulge, master.half)
            edges, thickness = (slave.nodes, slave.bulge, slave.half), slave.thickness
            nodes = np.zeros(0, np.int64)
            if isinstance(item, Tie) or slave.points is not None:
                edges, thickness, nodes = none, none[1], slave.node_list
            curved = rigid and (*rigid, turns)
            own = edges, thickness, nodes
            return _core.line_contact(x, *own, other, curved, depth=depth, **facts)
        side = x, slave.nodes, slave.bulge, slave.thickness
        facts |= {"corners": corners}
        if rigid:
            return _core.Contact.rigid(*side, *rigid, turns=turns, depth=depth, **facts)
        if master is None:
            return _core.Contact.itself(*side, **facts)
        nodes, bulge, shapes = master.nodes, master.bulge, None
        if getattr(item, "smooth", False):
            nodes, bulge, shapes = smoothed(mesh.points, master)
        return _core.Contact.edges(*side, nodes, bulge, master_shapes=shapes, depth=depth, **facts)
    except ValueError as error:
        raise _refused(item, str(error)) from None


def of_lines(side: Surface) -> bool:
    """Whether a surface consists of lines or single nodes."""
    return side.two_sided or side.points is not None


def _thickness(system: NumberedModel, slave: Surface) -> Floats:
    """Thickness of the body behind edges of its surface, inwards.

    Infinite where there is nothing behind.
    """
    mesh = system.model.mesh
    boundary, part = mesh.boundary_edges(), part_of_cells(mesh)
    boundary = boundary[np.isin(part[boundary[:, 0]], part[slave.edges[:, 0]])]
    ends = np.array([nodes[:2] for nodes in mesh.edge_nodes(boundary)])
    x, inwards = mesh.points, -outward(mesh.points[slave.nodes[:, :2]])
    start = x[slave.nodes[:, :2]].mean(axis=1)
    first, along = x[ends[:, 0]], x[ends[:, 1]] - x[ends[:, 0]]
    found = np.empty(len(start))
    for own in _chunks(len(start), len(ends)):
        away, way = first - start[own, None], inwards[own, None]
        det = along[:, 0] * way[..., 1] - along[:, 1] * way[..., 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            # start + s way = first + t along
            s = (along[:, 0] * away[..., 1] - along[:, 1] * away[..., 0]) / det
            t = (way[..., 0] * away[..., 1] - way[..., 1] * away[..., 0]) / det
        hit = (s > SAME * slave.length[own, None]) & (t > -SAME) & (t < 1.0 + SAME)
        found[own] = np.where(hit, s, np.inf).min(axis=1)
    found = found[np.isfinite(found)]
    return found if len(found) else np.full(1, np.inf)


def _check_shared(
    system: NumberedModel, item: ContactPair | Tie, slave: Surface, master: Surface
) -> None:
    shared = np.intersect1d(slave.node_list, master.node_list)
    if len(shared):
        raise _refused(
            item,
            f"surfaces {slave.name!r} and {master.name!r} share node "
            f"{system.model.mesh.node_labels[shared[0]]}, so they cannot separate there; remove "
            "it from one of them, give each body its own nodes, or use self-contact of one surface",
        )


def _check_lines(
    system: NumberedModel, item: ContactPair | Tie, slave: Surface, master: Surface | None
) -> None:
    if getattr(item, "smooth", False):
        raise _refused(
            item, "a pair with a line or with single nodes is not smoothed; leave smooth out"
        )
    if master is not None and master.points is not None:
        raise _refused(
            item,
            f"a master needs edges or lines, and {master.name!r} is a node "
            "set; exchange slave and master",
        )
    if master is not None:
        _check_shared(system, item, slave, master)
    elif not isinstance(item.master, RigidCurve):
        raise _refused(
            item,
            "a line, or single nodes, cannot meet themselves; "
            "make two surfaces of the parts that meet",
        )


def _check_pair(
    system: NumberedModel, item: ContactPair | Tie, slave: Surface, master: Surface
) -> None:
    mesh = system.model.mesh
    imaged = isinstance(item, ContactPair) and item.images is not None
    both = _among(slave.edges, master.edges)
    if both.any() and not imaged:
        cell = mesh.cell_labels[int(slave.edges[int(np.argmax(both)), 0])]
        raise _refused(
            item,
            f"{int(both.sum())} edges are on both surfaces, {slave.name!r} "
            f"and {master.name!r}, the first at element {cell}; remove them from one, or name "
            "the same surface twice for self-contact",
        )
    if isinstance(item, Tie):
        return
    _check_shared(system, item, slave, master)
    x = mesh.points
    out_s, out_m = (outward(x[side.nodes[:, :2]]) for side in (slave, master))
    # No edges face each other: bodies may rotate, but not before contact.
    facing = any((out_s[own] @ out_m.T < 0.0).any() for own in _chunks(len(out_s), len(out_m)))
    # Nor does any face or overlap the corner of the master's box that is farthest along its normal.
    at, box = x[slave.nodes[:, :2]].mean(axis=1), x[master.node_list]
    corner = np.where(out_s > 0.0, box.max(axis=0), box.min(axis=0))
    ahead = ((corner - at) * out_s).sum(axis=1) > -0.5 * slave.length.max()
    if not facing or not ahead.any():
        raise _refused(
            item,
            f"no edge of {slave.name!r} faces any edge of "
            f"{master.name!r} (their outward normals point away from each other); select the "
            "sides that face each other",
        )


def _chunks(n: int, others: int) -> list[slice]:
    """Parts of n rows, each of which with the others fits into a table of `AT_ONCE` entries."""
    count = max(1, AT_ONCE // max(others, 1))
    return [slice(begin, begin + count) for begin in range(0, n, count)]


def outward(pieces: Floats) -> Floats:
    """Unit normals of straight pieces of shape (m, 2, 2), to their right."""
    along = pieces[:, 1] - pieces[:, 0]
    return np.asarray(np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None])


# -- sides of surfaces ------------------------------------------------------------------

#: Angle up to which an arc counts as straight, of the way of a side that turns in an increment; and
#: between a slave edge and the normal of a rigid curve up to which it faces neither side [rad].
STRAIGHT = 0.1


def check_side(system: NumberedModel, item: ContactPair | Tie, slave: Surface, x: Floats) -> None:
    """Refuse a slave surface whose body starts on the wrong side of a rigid curve.

    The body may have its surface on the curve, or reach through it by less than half. Positions and
    rotations `x` at the start have the shape (n_nodes, 3).

    Raises
    ------
    ModelError
        Naming the pair, the curve and the nearest node.
    """
    curve = item.master
    if not isinstance(curve, RigidCurve) or not curve.turns:  # no curve, or a gap element
        return
    mesh, size = system.model.mesh, SAME * float(slave.length.max())
    pieces = curve_at(curve, chords(curve), mesh.points, x)
    ends = x[slave.nodes[:, :2], :2]
    nodes = slave.node_list if slave.pointwise else slave.nodes[:, 0]
    at = x[nodes, :2] if slave.pointwise else ends.mean(axis=1)
    distance, best, beside = signed_distances(pieces, at, size)
    if slave.pointwise:
        # Lines and single nodes have no outer side of their own.
        away = distance <= size
    else:
        # An edge that faces away is behind, or in front with its back to the curve.
        turned = (outward(ends) * outward(pieces)[best]).sum(axis=1)
        beside &= np.abs(turned) >= STRAIGHT
        away = turned >= STRAIGHT
    nearest = int(np.argmin(np.where(beside, np.abs(distance), np.inf)))
    if not (beside & away)[nearest]:
        return
    part = part_of_nodes(mesh)
    if slave.pointwise:
        # Springs end where they will, on either side, and a node with springs alone has no side.
        springs = np.zeros(mesh.n_cells, bool)
        for block in system.blocks:
            springs[block.cells] = block.section.element.startswith("SPRING")
        if not np.isin(nodes, nodes_of_cells(mesh, np.flatnonzero(~springs))).any():
            return
        part = parts_without(mesh, springs)
    body, _, inside = signed_distances(pieces, x[np.isin(part, part[slave.node_list]), :2], size)
    # What lies on the curve as a whole tells no side.
    least = size if slave.pointwise else 0.0
    if not inside.any() or body[inside].max() >= -body[inside].min() - least:
        return
    depth = -float(distance[nearest])
    place = f"{abs(depth):.4g} {'behind' if depth > 0 else 'through'} it"
    name = f" {curve.name!r}" if curve.name else ""
    raise _refused(
        item,
        "the slave surface starts on the wrong side of "
        f"the rigid curve{name}: node {mesh.node_labels[nodes[nearest]]} is nearest, "
        f"{'on it' if abs(depth) <= size else place}. "
        "The deformable body belongs on the left of the curve's direction of travel; give its "
        "points in the other order (corota plot draws the rigid body shaded)",
    )


def chords(curve: RigidCurve) -> Floats:
    """A curve as straight pieces, the rigid body on their left, shape (m, 2, 2)."""
    lines = rigid_lines(curve)
    return np.concatenate([np.stack([line[1:], line[:-1]], axis=1) for line in lines])


def curve_at(curve: RigidCurve, pieces: Floats, points: Floats, x: Floats) -> Floats:
    """Straight pieces of a curve where its reference node has moved to; shape (m, 2, 2).

    `points` and `x` are positions in the reference configuration and now, shapes (n_nodes, 2) at
    least and (n_nodes, 3).
    """
    node = curve.reference
    if not isinstance(node, int | np.integer):
        return pieces
    return rotated(pieces, curve.turns * x[node, 2], points[node, :2], x[node, :2])


def rotated(
    x: Floats, turn: float, about: Floats | float = 0.0, to: Floats | float = 0.0
) -> Floats:
    """Points turned about one point by an angle and moved to another."""
    c, s = math.cos(turn), math.sin(turn)
    return np.asarray((x - about) @ np.array([[c, s], [-s, c]]) + to)


def alone(points: Floats, same: float) -> Bools:
    """Which points have no other one of the list in their place."""
    places = np.round(points / same)
    _, which, count = np.unique(places, axis=0, return_inverse=True, return_counts=True)
    return np.asarray(count[which.ravel()] == 1)


def signed_distances(pieces: Floats, points: Floats, same: float) -> tuple[Floats, Ints, Bools]:
    """Signed distance to the nearest piece, positive to its right, and which piece this is.

    The last part of the result is whether the nearest point lies on the curve, not at a free end.
    """
    start, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    square, normals = (along**2).sum(axis=1), outward(pieces)
    first, last = np.split(alone(np.concatenate([pieces[:, 0], pieces[:, 1]]), same), 2)
    distance, best = np.empty(len(points)), np.empty(len(points), np.int64)
    share = np.empty(len(points))
    for own in _chunks(len(points), len(pieces)):
        away = points[own, None] - start
        t = (away * along).sum(axis=2) / square
        apart = away - np.clip(t, 0.0, 1.0)[:, :, None] * along
        size = np.hypot(apart[:, :, 0], apart[:, :, 1])
        height = (away * normals).sum(axis=2)
        near = size <= size.min(axis=1, keepdims=True) + same
        # At a corner the piece with the larger distance decides, as for a wedge.
        k = np.where(near, np.abs(height), -1.0).argmax(axis=1)
        rows = np.arange(len(k))
        best[own], share[own] = k, t[rows, k]
        distance[own] = np.copysign(size[rows, k], height[rows, k])
    beyond = ((share < 0.0) & first[best]) | ((share > 1.0) & last[best])
    return distance, best, ~beyond
