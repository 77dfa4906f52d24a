"""Several bodies in one mesh, and nodes that belong to no element."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.arrays import Ints
from corota.errors import InputError
from corota.mesh.data import Cells, Mesh


def assembly(**bodies: Mesh) -> Mesh:
    """Combine bodies in one mesh: coincident nodes are not merged.

    Set names get the name of their body as a prefix, ``lower.top``; each body is a cell set and a
    node set with its name.

    Parameters
    ----------
    **bodies : Mesh

    Examples
    --------
    >>> from corota import mesh
    >>> block = mesh.rectangle(1.0, 1.0, nx=2, ny=2)
    >>> both = mesh.assembly(lower=block, upper=mesh.move(block, (0.0, 1.0)))
    >>> both.n_nodes, "upper.bottom" in both.edge_sets
    (18, True)
    """
    if not bodies:
        raise InputError("there is no body to assemble")
    kinds = list(dict.fromkeys(c.kind for m in bodies.values() for c in m.cells))
    first_node = np.concatenate([[0], np.cumsum([m.n_nodes for m in bodies.values()])])
    parts: dict[str, list[Ints]] = {kind: [] for kind in kinds}
    places: list[list[tuple[str, int, int]]] = []
    for start, body in zip(first_node, bodies.values(), strict=False):
        here = []
        for cells in body.cells:
            here.append((cells.kind, sum(map(len, parts[cells.kind])), len(cells)))
            parts[cells.kind].append(cells.nodes + start)
        places.append(here)
    blocks, first, label = [], {}, 0
    for kind in kinds:
        nodes = np.concatenate(parts[kind])
        blocks.append(Cells(kind, nodes, np.arange(label + 1, label + len(nodes) + 1)))
        first[kind] = label
        label += len(nodes)
    joined = Mesh(np.concatenate([m.points for m in bodies.values()]), blocks)
    for (name, body), start, here in zip(bodies.items(), first_node, places, strict=False):
        index = np.concatenate(
            [np.zeros(0, np.int64)] + [first[kind] + at + np.arange(n) for kind, at, n in here]
        )
        joined.node_sets[name] = np.arange(start, start + body.n_nodes)
        joined.cell_sets[name] = index
        for own, members in body.node_sets.items():
            joined.node_sets[f"{name}.{own}"] = members + start
        for own, members in body.cell_sets.items():
            joined.cell_sets[f"{name}.{own}"] = index[members]
        for own, edges in body.edge_sets.items():
            joined.edge_sets[f"{name}.{own}"] = np.column_stack([index[edges[:, 0]], edges[:, 1]])
    return joined


def add_node(mesh: Mesh, x: float, y: float, name: str = "") -> int:
    """Add a node that belongs to no cell, such as a reference node; returns its index.

    Parameters
    ----------
    mesh : Mesh
        Changed in place.
    x, y : float
        [length]
    name : str, optional
        Of a node set with this node.
    """
    if not (np.isfinite(x) and np.isfinite(y)):
        raise InputError(f"a node needs finite coordinates, not {x} and {y}")
    index = mesh.n_nodes
    label = int(mesh.node_labels.max(initial=0)) + 1
    mesh.points = np.vstack([mesh.points, [[float(x), float(y)]]])
    mesh.node_labels = np.append(mesh.node_labels, label)
    if name:
        mesh.node_sets[name] = np.array([index])
    return index
