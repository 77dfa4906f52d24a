"""Contact pairs and ties in which lines or single nodes take part."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import corota._core as _core
from corota.analysis.terms.contact.surface import Surface, carrier
from corota.arrays import distinct
from corota.errors import ModelError
from corota.model import elements
from corota.model.contact import ContactPair, RigidCurve, Tie

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.numbered_model import NumberedModel

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


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
    _check(system, item, slave, master)
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


def _check(
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


__all__ = ["line_core", "line_surface", "node_surface"]
