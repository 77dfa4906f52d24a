"""Kinds of cells: one record each, from which every table by kind is derived."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from corota.arrays import Floats


@dataclass(frozen=True)
class Kind:
    """A kind of cell, and its codes in files.

    Nodes are the corners counter-clockwise, then the middles of the sides 1-2, 2-3, ..., then the
    center. VTK, Gmsh and CalculiX have the same order.

    Parameters
    ----------
    name : str
    count : int
        Number of nodes.
    vtk, gmsh : int
        Numbers of the type; 0 for none.
    frd : tuple of int
        Number of the type in ``.frd`` files and how many of the nodes it has; empty for none.
    meshio : str
        Name of the type in meshio; empty for none.
    edges : tuple of tuple of int
        Local nodes of the edges: first, last and, on quadratic ones, middle. Empty for lines and
        points.
    reversal : tuple of int
        Order in which the nodes of a clockwise cell are counter-clockwise.
    pieces : tuple of tuple of int
        Triangles and quadrilaterals with straight sides that the cell consists of.
    unv : tuple of int
        Numbers of the type in universal files: plane stress, plane strain, plate, membrane,
        axisymmetric, shell.
    deck : str
        Type that decks have for it where no section gives one.
    natural : tuple of (float, float)
        Natural coordinates r, s of the nodes: from -1 to 1, in triangles from 0 to 1.
    powers : tuple of (int, int)
        Powers of r and s in the monomials of the shape functions, as many as nodes.
    points : tuple of (float, float)
        Natural coordinates at which the map is tested for folds.
    """

    name: str
    count: int
    vtk: int
    gmsh: int
    frd: tuple[int, int] | tuple[()]
    meshio: str
    edges: tuple[tuple[int, ...], ...] = ()
    reversal: tuple[int, ...] = ()
    pieces: tuple[tuple[int, ...], ...] = ()
    unv: tuple[int, ...] = ()
    deck: str = ""
    natural: tuple[tuple[float, float], ...] = ()
    powers: tuple[tuple[int, int], ...] = ()
    points: tuple[tuple[float, float], ...] = ()

    @property
    def dimension(self) -> int:
        """0 for points, 1 for lines, 2 for cells with an area."""
        return 2 if self.edges else min(self.count - 1, 1)

    @property
    def n_corners(self) -> int:
        """Number of corners; 0 for lines and points."""
        return len(self.edges)

    @property
    def quadratic(self) -> bool:
        """Whether its sides have a node in the middle."""
        return any(2 in power for power in self.powers)

    @cached_property
    def coefficients(self) -> Floats:
        """Factors of the monomials (rows) in the shape functions (columns): one at its node."""
        inverse = np.linalg.inv(monomials(np.array(self.natural), self.powers))
        return np.asarray(inverse, dtype=np.float64)


def monomials(at: Floats, powers: tuple[tuple[int, int], ...]) -> Floats:
    """Products of powers of natural coordinates (m, 2); shape (m, k)."""
    i, j = np.array(powers).T
    return np.asarray(at[:, :1] ** i * at[:, 1:] ** j, dtype=np.float64)


#: Natural coordinates of the nodes.
_TRIANGLE = ((0, 0), (1, 0), (0, 1), (0.5, 0), (0.5, 0.5), (0, 0.5))
_SQUARE = ((-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0))
_LINE = ((-1, 0), (1, 0), (0, 0))
#: Powers of the monomials of the shape functions: in all 1, r, s, rs, r^2, s^2, r^2s, rs^2, r^2s^2.
_TRIANGLE_POWERS = ((0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2))
_SQUARE_POWERS = (*_TRIANGLE_POWERS, (2, 1), (1, 2), (2, 2))
_LINE_POWERS = ((0, 0), (1, 0), (2, 0))
_TRIANGLE_POINTS = ((1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3))
_TWO, _THREE = (-np.sqrt(1 / 3), np.sqrt(1 / 3)), (-np.sqrt(0.6), 0.0, np.sqrt(0.6))
_FOUR_POINTS = tuple((r, s) for s in _TWO for r in _TWO)
_NINE_POINTS = tuple((r, s) for s in _THREE for r in _THREE)
_QUADRATIC_SIDES = ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7))

KINDS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        Kind(
            "tri3", 3, vtk=5, gmsh=2, frd=(7, 3), meshio="triangle",
            edges=((0, 1), (1, 2), (2, 0)),
            reversal=(0, 2, 1),
            pieces=((0, 1, 2),),
            unv=(41, 51, 61, 74, 81, 91),
            deck="CPS3", natural=_TRIANGLE[:3], powers=_TRIANGLE_POWERS[:3],
            points=_TRIANGLE_POINTS,
        ),
        Kind(
            "tri6", 6, vtk=22, gmsh=9, frd=(8, 6), meshio="triangle6",
            edges=((0, 1, 3), (1, 2, 4), (2, 0, 5)),
            reversal=(0, 2, 1, 5, 4, 3),
            pieces=((0, 3, 5), (1, 4, 3), (2, 5, 4), (3, 4, 5)),
            unv=(42, 52, 62, 72, 82, 92),
            deck="CPS6", natural=_TRIANGLE, powers=_TRIANGLE_POWERS,
            points=_TRIANGLE_POINTS,
        ),
        Kind(
            "quad4", 4, vtk=9, gmsh=3, frd=(9, 4), meshio="quad",
            edges=((0, 1), (1, 2), (2, 3), (3, 0)),
            reversal=(0, 3, 2, 1),
            pieces=((0, 1, 2, 3),),
            unv=(44, 54, 64, 71, 84, 94),
            deck="CPS4", natural=_SQUARE[:4], powers=_SQUARE_POWERS[:4],
            points=_FOUR_POINTS,
        ),
        Kind(
            "quad8", 8, vtk=23, gmsh=16, frd=(10, 8), meshio="quad8",
            edges=_QUADRATIC_SIDES,
            reversal=(0, 3, 2, 1, 7, 6, 5, 4),
            pieces=((0, 4, 7), (1, 5, 4), (2, 6, 5), (3, 7, 6), (4, 5, 6, 7)),
            unv=(45, 55, 65, 75, 85, 95),
            deck="CPS8", natural=_SQUARE[:8], powers=_SQUARE_POWERS[:8],
            points=_NINE_POINTS,
        ),
        Kind(
            # .frd files have no type with a node in the center.
            "quad9", 9, vtk=28, gmsh=10, frd=(10, 8), meshio="quad9",
            edges=_QUADRATIC_SIDES,
            reversal=(0, 3, 2, 1, 7, 6, 5, 4, 8),
            pieces=((0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)),
            deck="Q9", natural=_SQUARE, powers=_SQUARE_POWERS,
            points=_NINE_POINTS,
        ),
        Kind("line2", 2, vtk=3, gmsh=1, frd=(11, 2), meshio="line", unv=(11, 21, 22),
             natural=_LINE[:2], powers=_LINE_POWERS[:2]),
        Kind("line3", 3, vtk=21, gmsh=8, frd=(12, 3), meshio="line3", unv=(24,),
             natural=_LINE, powers=_LINE_POWERS),
        Kind("point1", 1, vtk=1, gmsh=15, frd=(), meshio="vertex"),
    )
}  # fmt: skip

#: Kinds that have an area.
PLANAR = tuple(name for name, kind in KINDS.items() if kind.edges)
#: Local nodes of the edges of each kind; see :class:`Kind`.
EDGES = {name: kind.edges for name, kind in KINDS.items()}
#: Edges that sets may name: a line's two sides are the line forwards and backwards.
SIDES = {**EDGES, "line2": ((0, 1), (1, 0))}
#: Number of nodes of each kind.
N_NODES = {name: kind.count for name, kind in KINDS.items()}
