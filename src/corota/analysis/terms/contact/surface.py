"""Edges of a contact surface in the format of the core."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import distinct

if TYPE_CHECKING:
    from numpy.typing import NDArray

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


__all__ = ["Surface"]
