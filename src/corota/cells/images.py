"""Images of contact surfaces: what a cell meets beyond its border.

A surface of a periodic body goes on in the neighbor cells. Its images there have nodes of their
own, which move as the nodes that they repeat, ``u(x + d) = u(x) + H d``: they are nodes of the
periodic body like those on the border of the cell. So the forces of contact across the border enter
the mean stress, the tangent and the waves without further terms.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.model.contact import ContactPair, RigidCurve, edges_or_nodes

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.model.model import Model

    #: Nodes by their class and the multiples of the vectors from its first node.
    Places = dict[tuple[int, int, int], int]

#: The cells around a cell; one of each pair of opposite ones, and all with the cell itself.
HALF = [(1, 0), (-1, 1), (0, 1), (1, 1)]
WHOLE = [(0, 0), *HALF, *((-i, -j) for i, j in HALF)]


def contact_nodes(model: Model) -> Ints:
    """Nodes of all contact surfaces."""
    sides = [side for pair in model.contacts for side in (pair.slave, pair.master)]
    found = [nodes_of_surface(model, s) for s in sides if not isinstance(s, RigidCurve)]
    return np.unique(np.concatenate([np.zeros(0, np.int64), *found]))


def nodes_of_surface(model: Model, side: str | Ints) -> Ints:
    """Nodes of a surface of edges or single nodes."""
    edges, nodes = edges_or_nodes(model.mesh, side)
    return np.unique(np.concatenate([nodes, *model.mesh.edge_nodes(edges)]))


def add_images(
    base: Model, vectors: Floats, first: Ints, shift: Ints
) -> tuple[Model, Ints, Ints, Ints]:
    """Let the contact surfaces of a cell meet those of the cells around it.

    The master of a pair gets its images in the eight cells around. A surface that meets itself is
    slave to its images in four of them, so that each two are a pair once.

    Parameters
    ----------
    base : Model
    vectors : ndarray, shape (2, 2)
    first : ndarray of int, shape (n_nodes,)
    shift : ndarray of int, shape (n_nodes, 2)
        Of the nodes of `base`, see :func:`corota.cells.pairs.pair_nodes`.

    Returns
    -------
    around : Model
        `base` itself if no surfaces meet, else a copy with nodes of images behind its own.
    first, shift : ndarray of int
        Of its nodes.
    repeated : ndarray of int, shape (n_nodes,)
        The node of `base` that each node repeats: of those of `base` itself.
    """
    n = base.mesh.n_nodes
    classes = [(f, i, j) for f, (i, j) in zip(first.tolist(), shift.tolist(), strict=True)]
    own = {key: node for node, key in enumerate(classes)}
    # Ends of a surface that meets itself would close on its images if they were one node.
    of_itself: Places = {}
    repeated = list(range(n))
    pairs: list[ContactPair] = []
    for pair in base.contacts:
        if isinstance(pair.master, RigidCurve):
            pairs.append(pair)
            continue
        nodes = nodes_of_surface(base, pair.master).tolist()
        places, cells = (of_itself, HALF) if pair.itself else (own, WHOLE)
        images = np.full((len(cells), n), -1, np.int64)
        for row, (i, j) in zip(images, cells, strict=True):
            for node in nodes:
                f, a, b = classes[node]
                key = (f, a + i, b + j)
                if key not in places:
                    places[key] = len(classes)
                    classes.append(key)
                    repeated.append(node)
                row[node] = places[key]
        if pair.itself:
            pairs.append(pair)
            pair = replace(pair, name=f"{pair.name} across the border")
        pairs.append(replace(pair, images=images))
    if len(repeated) == n:
        return base, first, shift, np.arange(n)
    around = base.copy()
    around.contacts = pairs
    every = np.array(classes, np.int64)
    of = np.array(repeated, np.int64)
    mesh, new = around.mesh, of[n:]
    moved = (every[n:, 1:] - shift[new]) @ vectors
    mesh.points = np.concatenate([mesh.points, mesh.points[new] + moved])
    labels = int(mesh.node_labels.max(initial=0)) + 1 + np.arange(len(new))
    mesh.node_labels = np.concatenate([mesh.node_labels, labels])
    return around, every[:, 0], every[:, 1:], of
