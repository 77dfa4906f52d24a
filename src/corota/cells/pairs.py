"""Nodes of a cell that are the same node of the periodic body."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from corota.errors import InputError

if TYPE_CHECKING:
    from corota.arrays import Bools, Floats, Ints
    from corota.mesh import Mesh


NOWHERE: Ints = np.zeros(0, np.int64)
#: Distance of nodes that are one, over the vectors of the lattice.
SAME = 1e-6


def pair_nodes(mesh: Mesh, vectors: Floats, free: Ints = NOWHERE) -> tuple[Ints, Ints]:
    """Find the nodes that differ by vectors of the lattice.

    Parameters
    ----------
    mesh : Mesh
    vectors : ndarray, shape (2, 2)
        Vectors of the lattice, one a row.
    free : ndarray of int, optional
        Nodes that need no partner on the border, with those on the boundary up to the next ones
        that have a partner: contact surfaces.

    Returns
    -------
    first : ndarray of int, shape (n_nodes,)
        The first node of each class; a node without a partner is its own.
    shift : ndarray of int, shape (n_nodes, 2)
        Multiples of the vectors from the first node.

    Raises
    ------
    InputError
        If a node on a side has no partner on the other one, or two are at one place.
    """
    place = mesh.points @ np.linalg.inv(vectors)
    wrapped = np.mod(place, 1.0)
    wrapped[wrapped >= 1.0] = 0.0
    tree: Any = cKDTree(wrapped, boxsize=np.ones(2))
    pairs = tree.query_pairs(SAME, output_type="ndarray")
    n = mesh.n_nodes
    graph = sp.coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    label: Ints = np.asarray(connected_components(graph, directed=False)[1], np.int64)
    doubled = label[_doubles(place, label)]
    # Surfaces in contact cross the border with two nodes at one place: each has its own body.
    split = np.isin(label, doubled)
    label = np.unique(np.stack([label, split * _body(mesh)], axis=1), axis=0, return_inverse=True)[
        1
    ]
    label = label.ravel()
    _, firsts = np.unique(label, return_index=True)
    first = firsts[label]
    shift = np.rint(place - place[first]).astype(np.int64)
    # Nodes at one place within the body, such as those of a crack, stay apart.
    moved = np.zeros(len(firsts), bool)
    np.logical_or.at(moved, label, shift.any(axis=1))
    alone = ~moved[label]
    first[alone] = np.flatnonzero(alone)
    _refuse_doubles(mesh, place, label)
    _refuse_unpaired(mesh, place, first, shift, free)
    return first, shift


def _doubles(place: Floats, label: Ints) -> Bools:
    """Nodes with others of their class at the same place, where the class has several places."""
    _, first, index = np.unique(label, return_index=True, return_inverse=True)
    shift = np.rint(place - place[first[index]]).astype(np.int64)
    rows = np.column_stack([label, shift])
    _, inverse, count = np.unique(rows, axis=0, return_inverse=True, return_counts=True)
    several = np.zeros(len(first), bool)
    np.logical_or.at(several, index, shift.any(axis=1))
    return np.asarray((count[inverse.ravel()] > 1) & several[index])


def _body(mesh: Mesh) -> Ints:
    """Number of the connected cells that a node belongs to, shape (n_nodes,)."""
    n = mesh.n_nodes
    pairs = [np.stack([c.nodes[:, :1].repeat(c.nodes.shape[1], 1), c.nodes], 2) for c in mesh.cells]
    ends = np.concatenate([np.zeros((0, 2), np.int64), *(p.reshape(-1, 2) for p in pairs)])
    graph = sp.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], np.int64)


def _refuse_doubles(mesh: Mesh, place: Floats, label: Ints) -> None:
    bad = np.flatnonzero(_doubles(place, label))
    if len(bad):
        raise InputError(
            f"another node is at the place of node {mesh.node_labels[bad[0]]} on the border of the "
            "cell: merge them (mesh.merge), or move the border"
        )


def _refuse_unpaired(mesh: Mesh, place: Floats, first: Ints, shift: Ints, free: Ints) -> None:
    edges = mesh.edge_nodes(mesh.boundary_edges())
    for axis in range(2):
        if not shift[:, axis].any():
            raise InputError(
                f"no node has a partner along vector {axis + 1} of the lattice: cells do not touch "
                "there. Give the vectors, and mesh opposite sides alike"
            )
        low, high = place[:, axis].min(), place[:, axis].max()
        if high - low > 1.0 + SAME:
            continue  # no parallelogram: its border is not known
        sides = place[:, axis] < low + SAME, place[:, axis] > high - SAME
        # Edges along the border are within the body; struts there need no partner.
        outer = [n for n in edges if any(side[n].all() for side in sides)]
        both = np.intersect1d(first[sides[0]], first[sides[1]])
        bare = [n[~np.isin(first[n], both)] for n in outer]
        bad = np.setdiff1d(np.concatenate([free[:0], *bare]), _reached(bare, free))
        if len(bad):
            x, y = mesh.points[int(bad[0])]
            raise InputError(
                f"node {mesh.node_labels[int(bad[0])]} at ({x:.6g}, {y:.6g}) has no partner on the "
                f"opposite side of the cell ({len(bad)} nodes in all): mesh opposite sides alike"
            )


def _reached(edges: list[Ints], free: Ints) -> Ints:
    """Nodes that edges connect with given ones, with these."""
    count = -1
    while count != len(free):
        count = len(free)
        more = [n for n in edges if np.isin(n, free).any()]
        free = np.unique(np.concatenate([free, *more]))
    return free
