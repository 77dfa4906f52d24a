"""Edges that supports and rigid curves keep straight, whose rotations must not bend them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.mesh.parts import nodes_of_cells
from corota.model import axisymmetry
from corota.model.constraints import local_axes
from corota.model.contact import METHODS, RigidCurve
from corota.model.locking import SLENDER, outlines

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.arrays import Bools, Floats, Ints
    from corota.model.loads import Fixed
    from corota.model.model import Model


#: Square of the cosine between the direction of a support and the normal of an edge that it holds:
#: supports along a curve are not normal to the chords of a mesh.
NORMAL = 0.75
#: Distance over the length of an edge at which it lies on a rigid curve.
SAME = 1e-6


def straight(model: Model, supports: Sequence[Fixed], edges: Ints) -> Bools:
    """Whether edges stay straight, shape (n,): what acts on them acts at their nodes alone.

    Where a free rotation bent such an edge, a constant stress would be lost, on any mesh. That is
    so for edges between smooth supports and for those whose nodes touch a flat rigid curve from the
    start. Slender parts (:data:`corota.model.locking.SLENDER`) keep their bending: with straight
    edges one cell through the width is three times too stiff. Mortar contact acts on bent edges.
    Node to segment between two bodies loses a constant stress anyway: its edges stay as they are.

    Parameters
    ----------
    model : Model
    supports : sequence of Fixed
        Of the model and all steps.
    edges : ndarray of int, shape (n, 2)
        Nodes at both ends.
    """
    return _supported(model, supports, edges) | _touched(model, edges)


def _supported(model: Model, supports: Sequence[Fixed], edges: Ints) -> Bools:
    """Whether smooth supports hold both ends of edges along their normals.

    Clamped edges are not smooth, and edges whose ends cannot turn are not bent.
    """
    mesh = model.mesh
    fixed = np.zeros((mesh.n_nodes, 3), bool)
    for item in supports:
        try:
            nodes = mesh.node_indices(item.nodes)
        except InputError:
            continue  # which the supports report
        fixed[nodes, item.dof] |= not item.free
    if axisymmetry.is_axisymmetric(model):
        for nodes, dof in axisymmetry.guided(model):
            fixed[nodes, dof] = True
    axes = np.broadcast_to(np.eye(2), (mesh.n_nodes, 2, 2)).copy()
    for node, own in local_axes(mesh, model.axes).items():
        axes[node] = own
    chord = mesh.points[edges[:, 1]] - mesh.points[edges[:, 0]]
    normal = np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    length = np.hypot(*chord.T)
    normal /= np.where(length > 0.0, length, 1.0)[:, None]  # collapsed sides have none
    cosines = np.einsum("ekca,ec->eka", axes[edges], normal)
    ends = fixed[edges]
    share = np.sum(np.where(ends[..., :2], cosines**2, 0.0), axis=2)
    clamped, turns = ends[..., :2].all(axis=(1, 2)), ~ends[..., 2].all(axis=1)
    found: Bools = (share > NORMAL).all(axis=1) & ~clamped & turns
    return found


def _touched(model: Model, edges: Ints) -> Bools:
    """Whether edges of compact parts lie on a flat rigid curve that their nodes touch."""
    mesh = model.mesh
    found = np.zeros(len(edges), bool)
    for pair in model.contacts:
        nodes, single = _nodes(model, pair.slave)
        if isinstance(pair.master, RigidCurve) and (
            single or not METHODS[pair.method]["integrates"]
        ):
            here = np.zeros(mesh.n_nodes, bool)
            here[nodes] = True
            mine = np.flatnonzero(here[edges].all(axis=1))
            ends = mesh.points[edges[mine]]
            for segment in pair.master.segments[pair.master.segments[:, 6] == 0.0]:
                found[mine] |= _on(segment, ends)
    if found.any():
        keys = edges.min(axis=1) * mesh.n_nodes + edges.max(axis=1)
        _, edge, count = np.unique(keys, return_inverse=True, return_counts=True)
        found &= count[edge] == 1
        part, outline, area = outlines(mesh)
        slender = np.zeros(mesh.n_nodes, bool)
        slender[nodes_of_cells(mesh, np.flatnonzero((outline**2 > SLENDER * area)[part]))] = True
        found &= ~slender[edges[:, 0]]
    return found


def _on(segment: Floats, ends: Floats) -> Bools:
    """Whether both ends (n, 2, 2) of edges lie on a straight segment of a rigid curve."""
    start, along = segment[:2], segment[2:4] - segment[:2]
    size = np.hypot(*(ends[:, 1] - ends[:, 0]).T)[:, None]
    length = np.hypot(*along)
    at = (ends - start) @ along / length
    away = np.abs((ends - start) @ np.array([-along[1], along[0]])) / length
    near = (away <= SAME * size) & (at >= -SAME * size) & (at <= length + SAME * size)
    on: Bools = near.all(axis=1)
    return on


def _nodes(model: Model, where: str | Ints) -> tuple[Ints, bool]:
    """Nodes of a surface of contact, and whether it consists of them instead of edges."""
    mesh = model.mesh
    if isinstance(where, str):
        if where not in mesh.edge_sets:
            # An unknown name is reported with the pair.
            return np.asarray(mesh.node_sets.get(where, np.zeros(0)), np.int64), True
        where = mesh.edge_sets[where]
    given = np.asarray(where, np.int64)
    if given.ndim == 1:
        return given, True
    return mesh.edge_set_nodes(given), False
