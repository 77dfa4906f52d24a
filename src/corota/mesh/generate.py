"""Meshes of simple shapes, with the sets that an analysis needs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

import corota._core as _core
from corota.arrays import Floats, Ints, distinct
from corota.errors import InputError
from corota.mesh.change import merge, placed_middles
from corota.mesh.data import Cells, Mesh
from corota.mesh.kinds import KINDS, PLANAR
from corota.renamed import accept_old_names

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    Curve = Callable[[float], Sequence[float]]
    Kind = Literal["tri3", "tri6", "quad4", "quad8", "quad9"]
    Diagonal = Literal["right", "left", "alternate"]

#: Two triangles of a lattice: along the diagonal from lower left to upper right, or the other.
_SPLIT = {
    "right": ((0, 2, 8, 1, 5, 4), (0, 8, 6, 4, 7, 3)),
    "left": ((0, 2, 6, 1, 4, 3), (2, 8, 6, 5, 7, 4)),
}
#: Triangle and its side on the bottom, right, top and left of the lattice.
_SIDES = {
    "right": ((0, 0), (0, 1), (1, 1), (1, 2)),
    "left": ((0, 0), (1, 0), (1, 1), (0, 2)),
}
_NAMES = ("bottom", "right", "top", "left")


def rectangle(
    lx: float,
    ly: float,
    nx: int,
    ny: int,
    cell: Kind = "quad4",
    diagonal: Diagonal = "right",
    origin: tuple[float, float] = (0.0, 0.0),
) -> Mesh:
    """Mesh a rectangle with equal cells.

    The sides are named ``left``, ``right``, ``bottom`` and ``top``, each as a node set and as
    an edge set; all cells are ``all``. ``model.fix`` takes the nodes; ``model.force`` (as a
    resultant), ``model.traction`` and ``model.pressure`` take the edges.

    Parameters
    ----------
    lx, ly : float
        Sides [length], > 0.
    nx, ny : int
        Cells along them (squares that are cut into two triangles, for those).
    cell : {"tri3", "tri6", "quad4", "quad8", "quad9"}
    diagonal : {"right", "left", "alternate"}
        Of triangles: from the lower left to the upper right corner, the other, or changing
        from square to square.
    origin : tuple of float
        Lower left corner [length].

    Examples
    --------
    >>> from corota import mesh
    >>> strip = mesh.rectangle(10.0, 1.0, nx=10, ny=2)
    >>> strip.n_nodes, strip.n_cells, list(strip.node_sets)
    (33, 20, ['bottom', 'right', 'top', 'left'])
    """
    if not (lx > 0.0 and ly > 0.0 and math.isfinite(lx) and math.isfinite(ly)):
        raise InputError(f"the sides of a rectangle must be > 0, not {lx} and {ly}")
    x, y = origin
    corners = [(x, y), (x + lx, y), (x + lx, y + ly), (x, y + ly)]
    return mapped(corners, nx, ny, cell, diagonal)


def mapped(
    shape: ArrayLike | Sequence[Curve],
    nx: int,
    ny: int,
    cell: Kind = "quad4",
    diagonal: Diagonal = "right",
) -> Mesh:
    """Mesh a four-sided region.

    Parameters
    ----------
    shape : array_like, shape (4, 2), or four callables
        The corners, counter-clockwise [length]; or the sides ``bottom(t)``, ``right(t)``,
        ``top(t)``, ``left(t)`` with t from 0 to 1, bottom and top from left to right, left and
        right from bottom to top, which give x and y.
    nx, ny : int
        Cells along bottom and top, along left and right.
    cell, diagonal
        As for :func:`rectangle`.

    Returns
    -------
    Mesh
        With the sets of :func:`rectangle`.

    Notes
    -----
    Source: W. J. Gordon, C. A. Hall, Int. J. Numer. Meth. Engng 7 (1973), the bilinearly blended
    map.

    Examples
    --------
    >>> from corota import mesh
    >>> cook = mesh.mapped([(0, 0), (48, 44), (48, 60), (0, 44)], nx=4, ny=4)
    >>> cook.points[-1].tolist()
    [48.0, 60.0]
    """
    _check(nx, ny, cell, diagonal)
    if isinstance(shape, (list, tuple)) and len(shape) == 4 and all(map(callable, shape)):
        sides: Sequence[Curve] = shape
    else:
        corners = np.asarray(shape, dtype=np.float64)
        if corners.shape != (4, 2) or not np.isfinite(corners).all():
            raise InputError("expected four corners (x, y) or four callables")
        sides = [
            _segment(corners[0], corners[1]),
            _segment(corners[1], corners[2]),
            _segment(corners[3], corners[2]),
            _segment(corners[0], corners[3]),
        ]
    return _build(_blend(sides, 2 * nx + 1, 2 * ny + 1), nx, ny, cell, diagonal)


@accept_old_names(centre="center")
def annulus(
    inner: float,
    outer: float,
    n_radial: int,
    n_around: int,
    angle: float = 360.0,
    cell: Kind = "quad4",
    diagonal: Diagonal = "right",
    start: float = 0.0,
    center: tuple[float, float] = (0.0, 0.0),
) -> Mesh:
    """Mesh a ring or a sector of it.

    Node and edge sets: ``inner``, ``outer`` and, for a sector, ``start`` and ``end``.

    Parameters
    ----------
    inner, outer : float
        Radii [length], 0 < inner < outer. For a solid disc take a hole of a fiftieth of `outer`.
    n_radial, n_around : int
        Cells along the radius and around.
    angle : float, optional
        Opening [degrees]; 360 is the closed ring.
    cell, diagonal
        As for :func:`rectangle`.
    start : float, optional
        Direction of the first side, from x [degrees].
    center : tuple of float, optional
        Center [length].

    Examples
    --------
    >>> from corota import mesh
    >>> quarter = mesh.annulus(1.0, 2.0, n_radial=4, n_around=8, angle=90.0, cell="quad8")
    >>> sorted(quarter.edge_sets)
    ['end', 'inner', 'outer', 'start']
    """
    _check(n_radial, n_around, cell, diagonal)
    if not 0.0 < inner < outer < math.inf:
        raise InputError(f"expected 0 < inner < outer, not {inner} and {outer}")
    if not 0.0 < angle <= 360.0:
        raise InputError(f"the angle must be > 0 and at most 360 degrees, not {angle}")
    if angle == 360.0 and n_around < 3:
        raise InputError("a closed ring needs at least 3 cells around")
    radius = np.linspace(inner, outer, 2 * n_radial + 1)
    phi = np.radians(np.linspace(start, start + angle, 2 * n_around + 1))
    around = np.stack([np.cos(phi), np.sin(phi)], axis=1)
    lattice = radius[None, :, None] * around[:, None, :]
    mesh = _build(lattice + np.asarray(center), n_radial, n_around, cell, diagonal)
    names = {"left": "inner", "right": "outer", "bottom": "start", "top": "end"}
    for table in (mesh.node_sets, mesh.edge_sets):
        for old in _NAMES:
            table[names[old]] = table.pop(old)
    if angle == 360.0:
        for name in ("start", "end"):
            del mesh.node_sets[name], mesh.edge_sets[name]
        mesh = merge(mesh, tolerance=1e-9 * outer)
    return mesh


def line(points: ArrayLike, n: int | Sequence[int] = 10, name: str = "") -> Mesh:
    """Mesh a polyline with line cells, for beams, trusses and springs.

    Parameters
    ----------
    points : array_like, shape (k, 2)
        Its corners in order [length]; the last one may be the first one again.
    n : int or sequence of int
        Cells of each side, or of all sides.
    name : str, optional
        Of the line, to tell it from others that :func:`merge` joins with it: its cell set gets this
        name in place of ``all``, its node sets ``NAME.start`` in place of ``start`` and so on.

    Returns
    -------
    Mesh
        Node sets ``start`` and ``end`` (not of a closed line) and ``corner_1``, ``corner_2``, ...
        of the points between; the cell set ``all``.

    Raises
    ------
    InputError
        If there are fewer than two points, two in a row coincide, or `n` does not fit.

    Examples
    --------
    >>> from corota import mesh
    >>> hook = mesh.line([(0, 0), (0, 10), (5, 10)], n=[8, 4])
    >>> hook.n_nodes, hook.n_cells, list(hook.node_sets)
    (13, 12, ['start', 'end', 'corner_1'])
    """
    corners = np.asarray(points, dtype=np.float64)
    if corners.ndim != 2 or corners.shape[1:] != (2,) or len(corners) < 2:
        raise InputError(f"a line needs two or more points (x, y), not an array {corners.shape}")
    sides = np.diff(corners, axis=0)
    if not np.isfinite(corners).all():
        raise InputError("the points of a line must be finite numbers")
    if not (lengths := np.linalg.norm(sides, axis=1)).all():
        first = int(np.argmin(lengths))
        raise InputError(f"points {first} and {first + 1} of the line are the same")
    counts = np.broadcast_to(np.asarray(n), len(sides)) if np.ndim(n) == 0 else np.asarray(n)
    if counts.shape != (len(sides),) or counts.dtype.kind not in "iu" or counts.min() < 1:
        raise InputError(f"a line of {len(sides)} sides needs one or {len(sides)} counts, not {n}")
    steps = [
        first + np.arange(count)[:, None] / count * side
        for first, side, count in zip(corners, sides, counts.tolist(), strict=False)
    ]
    closed = len(corners) > 3 and bool((corners[0] == corners[-1]).all())
    nodes = np.concatenate(steps if closed else [*steps, corners[-1:]])
    chain = np.arange(int(counts.sum()) + 1) % len(nodes)
    cells = Cells("line2", np.column_stack([chain[:-1], chain[1:]]), np.arange(1, len(chain)))
    ends = np.cumsum(counts)[:-1]
    named = {} if closed else {"start": [0], "end": [len(nodes) - 1]}
    named |= {f"corner_{i}": [int(end)] for i, end in enumerate(ends, 1)}
    return Mesh(
        nodes,
        [cells],
        node_sets={f"{name}.{k}" if name else k: np.array(v) for k, v in named.items()},
        cell_sets={name or "all": np.arange(len(chain) - 1)},
    )


def distort(mesh: Mesh, amount: float, seed: int = 0) -> Mesh:
    """Shift the corner nodes inside a mesh at random; the boundary does not move.

    Nodes in the middle of sides and cells follow, so that inner sides stay straight.

    Parameters
    ----------
    mesh : Mesh
    amount : float
        Largest shift over the shortest side at the node, 0 to about 0.3.
    seed : int, optional
        Of the random numbers.

    Examples
    --------
    >>> from corota import mesh
    >>> plate = mesh.distort(mesh.rectangle(1.0, 1.0, nx=4, ny=4), 0.2)
    """
    if not 0.0 <= amount < 0.5:
        raise InputError(f"the amount of distortion must lie in 0 to 0.5, not {amount}")
    shortest = np.full(mesh.n_nodes, np.inf)
    corner = np.zeros(mesh.n_nodes, bool)
    for cells in mesh.cells:
        count = 3 if cells.kind.startswith("tri") else 4
        for i in range(count):
            a, b = cells.nodes[:, i], cells.nodes[:, (i + 1) % count]
            length = np.linalg.norm(mesh.points[a] - mesh.points[b], axis=1)
            np.minimum.at(shortest, a, length)
            np.minimum.at(shortest, b, length)
            corner[a] = True
    free = corner.copy()
    free[mesh.edge_set_nodes(mesh.boundary_edges())] = False
    shift = np.random.default_rng(seed).uniform(-amount, amount, (mesh.n_nodes, 2))
    points = mesh.points.copy()
    points[free] += shift[free] * shortest[free, None]
    return placed_middles(mesh, points)


#: Bytes of a cell with its nodes, while a mesh is made.
CELL = 200.0


def _check(nx: int, ny: int, cell: str, diagonal: str) -> None:
    if nx < 1 or ny < 1:
        raise InputError(f"a mesh needs at least one cell each way, not {nx} x {ny}")
    if cell not in PLANAR:
        raise InputError(f"unknown cell {cell!r}; known: {', '.join(PLANAR)}")
    if diagonal not in ("right", "left", "alternate"):
        raise InputError(f"unknown diagonal {diagonal!r}; known: right, left, alternate")
    if nx * ny * CELL > 1e8:
        _core.require_memory(nx * ny * CELL, f"a mesh of {nx} x {ny} cells")


def _segment(a: Floats, b: Floats) -> Curve:
    return lambda t: ((1.0 - t) * a + t * b).tolist()


def _blend(sides: Sequence[Curve], nx: int, ny: int) -> Floats:
    """Points of the blended map, shape (ny, nx, 2)."""
    s, t = np.linspace(0.0, 1.0, nx), np.linspace(0.0, 1.0, ny)
    bottom, top = (np.array([sides[i](v) for v in s], dtype=np.float64) for i in (0, 2))
    right, left = (np.array([sides[i](v) for v in t], dtype=np.float64) for i in (1, 3))
    size = float(np.ptp(np.concatenate([bottom, top, left, right]), axis=0).max())
    for name, a, b in (
        ("bottom and left", bottom[0], left[0]),
        ("bottom and right", bottom[-1], right[0]),
        ("top and right", top[-1], right[-1]),
        ("top and left", top[0], left[-1]),
    ):
        if not np.allclose(a, b, rtol=0.0, atol=1e-9 * size):
            raise InputError(f"the sides {name} do not meet: {a} and {b}")
    u, v = s[None, :, None], t[:, None, None]
    corners = (
        (1 - u) * (1 - v) * bottom[0]
        + u * (1 - v) * bottom[-1]
        + (1 - u) * v * top[0]
        + u * v * top[-1]
    )
    return np.asarray(
        (1 - v) * bottom + v * top + (1 - u) * left[:, None] + u * right[:, None] - corners
    )


def _build(lattice: Floats, nx: int, ny: int, cell: Kind, diagonal: Diagonal) -> Mesh:
    """Mesh on a lattice of (2 ny + 1, 2 nx + 1) points; unused ones are dropped."""
    width = 2 * nx + 1
    i, j = np.meshgrid(np.arange(nx), np.arange(ny))
    corner = (2 * j * width + 2 * i).ravel()
    local = np.array(
        [0, 1, 2, width, width + 1, width + 2, 2 * width, 2 * width + 1, 2 * width + 2]
    )
    nodes9 = corner[:, None] + local
    sides = (
        np.arange(nx),
        np.arange(ny) * nx + nx - 1,
        np.arange(nx) + (ny - 1) * nx,
        np.arange(ny) * nx,
    )
    if cell.startswith("tri"):
        cells, edges = _triangles(nodes9, (i + j).ravel(), cell, diagonal, sides)
    else:
        # Nodes of the kind on the 3 x 3 points of a cell, row by row.
        r, s = np.array(KINDS[cell].natural, dtype=np.int64).T + 1
        cells = nodes9[:, 3 * s + r]
        edges = [
            np.stack([cells_of, np.full(len(cells_of), side)], axis=1)
            for side, cells_of in enumerate(sides)
        ]
    used = distinct(cells)
    new = np.full(lattice.shape[0] * lattice.shape[1], -1)
    new[used] = np.arange(len(used))
    index = np.arange(len(new)).reshape(lattice.shape[:2])
    borders = (index[0], index[:, -1], index[-1], index[:, 0])
    mesh = Mesh(
        lattice.reshape(-1, 2)[used],
        [Cells(cell, np.ascontiguousarray(new[cells]), np.arange(1, len(cells) + 1))],
    )
    for name, border, edge in zip(_NAMES, borders, edges, strict=True):
        mesh.node_sets[name] = new[border][new[border] >= 0]
        mesh.edge_sets[name] = edge.astype(np.int64)
    mesh.cell_sets["all"] = np.arange(len(cells))
    return mesh


def _triangles(
    nodes9: Ints, parity: Ints, cell: str, diagonal: Diagonal, sides: tuple[Ints, ...]
) -> tuple[Ints, list[Ints]]:
    count = 3 if cell == "tri3" else 6
    left = np.zeros(len(nodes9), bool) if diagonal == "right" else np.ones(len(nodes9), bool)
    if diagonal == "alternate":
        left = parity % 2 == 1
    cells = np.zeros((2 * len(nodes9), count), dtype=np.int64)
    edges = [np.zeros((len(squares), 2), dtype=np.int64) for squares in sides]
    for name, mask in (("right", ~left), ("left", left)):
        for half in (0, 1):
            rows = 2 * np.flatnonzero(mask) + half
            cells[rows] = nodes9[mask][:, list(_SPLIT[name][half][:count])]
        for side, squares in enumerate(sides):
            half, local = _SIDES[name][side]
            here = mask[squares]
            edges[side][here, 0] = 2 * squares[here] + half
            edges[side][here, 1] = local
    return cells, edges
