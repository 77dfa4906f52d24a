"""Sharp corners of a master that penetrate a slave surface with a pressure law."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.smoothing import sharp_corners
from corota.model.contact import ContactPair

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.terms.contact.pair import Pair

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Depth from which a corner is reported, and beyond which it is on the far side of a body [edges].
NAMED, FAR = 0.1, 2.0


def sunk_corner(system: System) -> str:
    """Message on the deepest corner of a master inside a slave surface, or ''.

    A pressure law acts on areas, so that a corner has no constraint of its own: it can penetrate
    between two slave nodes until one of them is in contact with the side of the corner and jams.
    """
    contact_term = system.contact_term
    x = contact_term.positions(contact_term.u)[:, :2]
    worst, said = NAMED, ""
    for pair in contact_term.pairs:
        if pair.law is None or pair.master is None or not isinstance(pair.item, ContactPair):
            continue
        for corner in sharp_corners(x, pair.master.nodes[:, :2]):
            depth, ends = _depth(x, pair, corner)
            if worst < depth < FAR:
                label = contact_term.system.model.mesh.node_labels
                worst = depth
                said = (
                    f"; the sharp corner of the master at node {label[corner]} lies {depth:.2g} "
                    f"slave edges inside the slave surface of {pair.name!r}, between nodes "
                    f"{label[ends[0]]} and {label[ends[1]]}: a pressure law acts on areas, so "
                    "that it goes in until they wedge. Exchange slave and master, refine the "
                    "slave where the corner meets it, round the corner, or use hard contact"
                )
    return said


def _depth(x: Floats, pair: Pair, corner: int) -> tuple[float, tuple[int, int]]:
    """Depth behind the nearest slave edge [its length], and the edge; 0 beyond its ends."""
    edges = pair.slave.nodes[:, :2]
    edges = edges[(edges != corner).all(axis=1)]
    if not len(edges):
        return 0.0, (-1, -1)
    d, r = x[edges[:, 1]] - x[edges[:, 0]], x[corner] - x[edges[:, 0]]
    square = (d * d).sum(axis=1)
    along = (r * d).sum(axis=1) / square
    off = r - np.clip(along, 0.0, 1.0)[:, None] * d
    k = int(np.argmin((off * off).sum(axis=1)))
    a, b = edges[k].tolist()
    if not 0.0 < along[k] < 1.0:
        return 0.0, (a, b)
    return float((d[k, 0] * r[k, 1] - d[k, 1] * r[k, 0]) / square[k]), (a, b)


__all__ = ["sunk_corner"]
