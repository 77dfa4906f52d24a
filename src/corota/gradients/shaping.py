"""Shapes by a few numbers: control points move boundaries, and the motion goes on into the mesh.

The positions of all nodes are linear in the parameters, so that one factorization serves all
designs and the shape is as smooth as the parameters. Source: J. Haslinger, R. A. E. Makinen,
Introduction to Shape Optimization, SIAM (2003), chapter 5.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import CubicSpline
from scipy.sparse.linalg import splu

from corota.errors import InputError
from corota.gradients.parameters import Shape
from corota.mesh import quality
from corota.names import choose

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh


#: Distance over the size of the mesh at which a mirrored node lies on the moved edge.
ON_EDGE = 1e-6
#: Poisson's ratio of the elastic extension.
POISSON = 0.3
#: Least determinant of a cell's map over that of the first shape.
LEAST = 0.05


class ShapeDesign:
    """A mesh whose boundaries move by parameters; see :func:`corota.shape`.

    Parameters
    ----------
    mesh : Mesh
    extension : {"harmonic", "elastic"}
    slide : mapping of str to str
    """

    def __init__(self, mesh: Mesh, extension: str, slide: Mapping[str, str]) -> None:
        self.base = mesh
        self.extension = choose(extension, ("harmonic", "elastic"), "extension")
        self.slide = {name: choose(axis, ("x", "y"), "axis") for name, axis in slide.items()}
        for name in self.slide:
            if name not in mesh.edge_sets:
                raise InputError(f"no edge set named {name!r} that could slide")
        self._moved: list[Floats] = []
        self._motion: Floats | None = None

    @property
    def n(self) -> int:
        """Number of parameters."""
        return len(self._moved)

    def control(
        self,
        edges: str,
        count: int,
        *,
        direction: Sequence[float] | None = None,
        ends: bool = False,
        mirror: tuple[str, float] | None = None,
    ) -> slice:
        """Add control points along a chain of edges, whose nodes follow a cubic spline.

        Parameters
        ----------
        edges : str
            Edge set: one chain, open or closed.
        count : int
            Control points, evenly along the chain, from its end with the smaller x; each is a
            parameter, a distance [length]. A closed chain is passed with the body on its left.
        direction : sequence of float, optional
            Direction of the motion; by default along the outward normal of each node.
        ends : bool
            Whether the ends of an open chain move, too: the first and last control points. What
            they move along must slide.
        mirror : (axis, place), optional
            ``("x", 0.0)``: the boundary that mirrors the chain at x = 0 moves as its mirror image.

        Returns
        -------
        slice
            Places of the new parameters.

        Raises
        ------
        InputError
            If the edges are no chain, or nothing mirrors them.
        """
        nodes, closed = self._chain(edges)
        if count < 1 or (ends and count < 2):
            raise InputError(f"control points along {edges!r}: {count} are too few")
        points = self.base.points[nodes]
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        along /= along[-1]
        functions = _splines(count, closed, ends)
        weights = functions(along)
        if direction is None:
            ways = self._normals(edges, nodes)
        else:
            way = np.asarray(direction, dtype=float)
            if way.shape != (2,) or not np.hypot(*way) > 0.0:
                raise InputError(f"a direction has two numbers, not {direction!r}")
            ways = np.broadcast_to(way / np.hypot(*way), points.shape)
        first = self.n
        others = None if mirror is None else self._mirrored(mirror, nodes, along, points)
        for k in range(count):
            moved = np.full((self.base.n_nodes, 2), np.nan)
            moved[nodes] = weights[:, k, None] * ways
            if others is not None:
                partners, places, sign = others
                each = functions(places)[:, k, None]
                spread = [np.interp(places, along, ways[:, i]) for i in (0, 1)]
                moved[partners] = each * np.stack(spread, axis=1) * sign
            self._moved.append(moved)
        self._motion = None
        return slice(first, self.n)

    def translate(self, edges: str, direction: Sequence[float]) -> slice:
        """Add one parameter that moves a boundary as a whole, such as a hole.

        Parameters
        ----------
        edges : str
        direction : sequence of float
            Motion for a parameter of 1 [length].
        """
        way = np.asarray(direction, dtype=float)
        if way.shape != (2,):
            raise InputError(f"a direction has two numbers, not {direction!r}")
        moved = np.full((self.base.n_nodes, 2), np.nan)
        moved[self._chain(edges)[0]] = way
        self._moved.append(moved)
        self._motion = None
        return slice(self.n - 1, self.n)

    @property
    def motion(self) -> Floats:
        """Motion of all nodes for each parameter, shape (n, n_nodes, 2)."""
        if self._motion is None:
            self._motion = self._extend()
        return self._motion

    def mesh(self, x: ArrayLike) -> Mesh:
        """The mesh of parameters of shape (n,), with the cells of the first one.

        Raises
        ------
        InputError
            If a cell folds; an optimization takes a shorter step then.
        """
        at = np.asarray(x, dtype=float)
        if at.shape != (self.n,):
            raise InputError(f"the shape has {self.n} parameters, not {at.shape}")
        points = self.base.points + np.tensordot(at, self.motion, axes=1)
        self._check(points)
        base = self.base
        # Sets may be added to it.
        return replace(
            base,
            points=points,
            node_sets=dict(base.node_sets),
            cell_sets=dict(base.cell_sets),
            edge_sets=dict(base.edge_sets),
        )

    def parameter(self) -> Shape:
        """The parameters for :func:`corota.gradient`, at the shape of the run."""
        return Shape(self.motion)

    # -- boundaries --------------------------------------------------------------------

    def _chain(self, edges: str) -> tuple[Ints, bool]:
        """Nodes of an edge set in their order, and whether they close (the first comes again)."""
        mesh = self.base
        if edges not in mesh.edge_sets:
            known = ", ".join(sorted(mesh.edge_sets)) or "none"
            raise InputError(f"no edge set named {edges!r}; there are: {known}")
        after: dict[int, Ints] = {}
        for nodes in mesh.edge_nodes(mesh.edge_sets[edges]):
            if int(nodes[0]) in after:
                raise InputError(f"the edges of {edges!r} branch: a shape moves one chain of them")
            after[int(nodes[0])] = nodes
        ends = {int(nodes[1]) for nodes in after.values()}
        starts = [n for n in after if n not in ends]
        if len(starts) > 1:
            raise InputError(
                f"the edges of {edges!r} are {len(starts)} chains: a shape moves one at a time"
            )
        here = starts[0] if starts else next(iter(after))
        chain = [here]
        for _ in range(len(after)):
            if here not in after:
                break
            edge = after[here]
            chain += [int(n) for n in (*edge[2:], edge[1])]
            here = int(edge[1])
        if len(chain) < 1 + sum(len(nodes) - 1 for nodes in after.values()):
            raise InputError(f"the edges of {edges!r} are several chains: a shape moves one")
        if starts and tuple(mesh.points[chain[-1]]) < tuple(mesh.points[chain[0]]):
            chain.reverse()
        return np.array(chain), not starts

    def _normals(self, edges: str, chain: Ints) -> Floats:
        """Outward normals of the nodes of a chain."""
        mesh = self.base
        out = np.zeros((mesh.n_nodes, 2))
        for nodes in mesh.edge_nodes(mesh.edge_sets[edges]):
            a, b = mesh.points[nodes[0]], mesh.points[nodes[1]]
            # The body is on the left of its edges.
            out[nodes] += np.array([b[1] - a[1], a[0] - b[0]]) / np.hypot(*(b - a))
        found: Floats = out[chain]
        found /= np.linalg.norm(found, axis=1)[:, None]
        return found

    def _boundary(self) -> Ints:
        mesh = self.base
        edges = mesh.edge_nodes(mesh.boundary_edges())
        return np.unique(np.concatenate([np.ravel(e) for e in edges]))

    def _mirrored(
        self, mirror: tuple[str, float], nodes: Ints, along: Floats, points: Floats
    ) -> tuple[Ints, Floats, Floats]:
        """Boundary nodes whose mirror images lie on a chain, their places on it, and the signs."""
        axis, place = mirror
        k = ("x", "y").index(choose(axis, ("x", "y"), "axis"))
        others = np.setdiff1d(self._boundary(), nodes)
        image = self.base.points[others].copy()
        image[:, k] = 2.0 * place - image[:, k]
        tolerance = ON_EDGE * float(np.ptp(self.base.points, axis=0).max())
        best, places = np.full(len(others), np.inf), np.zeros(len(others))
        for i in range(len(points) - 1):
            step = points[i + 1] - points[i]
            share = np.clip((image - points[i]) @ step / (step @ step), 0.0, 1.0)
            far = np.linalg.norm(image - points[i] - share[:, None] * step, axis=1)
            nearer = far < best
            best[nearer] = far[nearer]
            places[nearer] = (along[i] + share * (along[i + 1] - along[i]))[nearer]
        on = best <= tolerance
        if not on.any():
            raise InputError(f"no boundary is the mirror image at {axis} = {place:g}")
        sign = np.ones(2)
        sign[k] = -1.0
        return others[on], places[on], sign

    # -- extension ---------------------------------------------------------------------

    def _extend(self) -> Floats:
        mesh, n = self.base, self.base.n_nodes
        if not self._moved:
            return np.zeros((0, n, 2))
        fixed = np.zeros((n, 2), bool)
        border = mesh.boundary_edges()
        nodes = mesh.edge_nodes(border)
        for i, axis in enumerate(("x", "y")):
            free = {
                (int(cell), int(side))
                for name, along in self.slide.items()
                if along == axis
                for cell, side in mesh.edge_sets[name]
            }
            for edge, own in zip(border, nodes, strict=True):
                if (int(edge[0]), int(edge[1])) not in free:
                    fixed[own, i] = True
        moved = ~np.isnan(np.stack(self._moved)).all(axis=0)
        fixed |= moved
        triangles, share, middles = _triangles(mesh)
        given = np.nan_to_num(np.stack(self._moved)).transpose(1, 2, 0)
        corners = np.unique(triangles)
        out = np.where(fixed[..., None], given, 0.0)
        if self.extension == "harmonic":
            matrix = _laplace(mesh.points, triangles, share)
            for i in (0, 1):
                free = corners[~fixed[corners, i]]
                known = corners[fixed[corners, i]]
                if len(free):
                    rhs = -(matrix[free][:, known] @ out[known, i])
                    out[free, i] = splu(matrix[free][:, free].tocsc()).solve(rhs)
        else:
            matrix = _elastic(mesh.points, triangles, share)
            dofs = (2 * corners[:, None] + np.arange(2)).ravel()
            flat = fixed.ravel()
            free, known = dofs[~flat[dofs]], dofs[flat[dofs]]
            whole = out.reshape(2 * n, -1)
            if len(free):
                rhs = -(matrix[free][:, known] @ whole[known])
                whole[free] = splu(matrix[free][:, free].tocsc()).solve(rhs)
            out = whole.reshape(n, 2, -1)
        for node, ends in middles.items():
            mean = out[list(ends)].mean(axis=0)
            out[node] = np.where(fixed[node][:, None], out[node], mean)
        return np.ascontiguousarray(out.transpose(2, 0, 1))

    def _check(self, points: Floats) -> None:
        mesh = self.base
        for first, cells in zip(mesh.offsets, mesh.cells, strict=False):
            if not cells.kind.startswith(("tri", "quad")):
                continue
            before = quality.jacobians(cells.kind, mesh.points[cells.nodes])
            after = quality.jacobians(cells.kind, points[cells.nodes])
            folded = np.flatnonzero((after < LEAST * before).any(axis=1))
            if len(folded):
                cell = int(folded[0])
                x, y = mesh.points[cells.nodes[cell]].mean(axis=0)
                raise InputError(
                    f"the shape folds {len(folded)} cells, the first one "
                    f"{mesh.cell_labels[int(first) + cell]} near ({x:.4g}, {y:.4g}): narrow the "
                    "bounds of the parameters, or begin again from a mesh of the shape so far"
                )


def shape(
    mesh: Mesh,
    *,
    extension: Literal["harmonic", "elastic"] = "harmonic",
    slide: Mapping[str, str] | None = None,
) -> ShapeDesign:
    """Let parameters move the boundaries of a mesh, whose cells stay the same.

    Parameters
    ----------
    mesh : Mesh
    extension : {"harmonic", "elastic"}
        How the motion goes on into the mesh: each coordinate by Laplace's equation, or by an
        elastic body with small cells that are stiffer.
    slide : mapping of str to str, optional
        Boundaries whose nodes may slide along an axis, such as ``{"left": "y"}``; others that no
        parameter moves stay where they are.

    Returns
    -------
    ShapeDesign
        With :meth:`~ShapeDesign.control` and :meth:`~ShapeDesign.translate` for parameters, and
        :meth:`~ShapeDesign.mesh` for the mesh of their values.

    Examples
    --------
    The top of a beam gets three control points, the bottom follows as its mirror image:

    >>> import numpy as np
    >>> import corota as ct
    >>> design = ct.shape(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=4))
    >>> design.control("top", 3, mirror=("y", 0.5))
    slice(0, 3, None)
    >>> mesh = design.mesh([0.0, 0.2, 0.0])
    >>> middle = np.abs(mesh.points[:, 0] - 5.0) < 1e-9
    >>> [round(float(y), 3) for y in mesh.points[middle][[0, -1], 1]]
    [-0.2, 1.2]
    """
    return ShapeDesign(mesh, extension, slide or {})


def _splines(count: int, closed: bool, ends: bool) -> CubicSpline:
    """Cardinal functions of control points on (0, 1), as one spline with `count` values."""
    if closed:
        places = np.linspace(0.0, 1.0, count + 1)
        values = np.vstack([np.eye(count), np.eye(count)[:1]])
        if count < 2:
            return CubicSpline([0.0, 1.0], np.ones((2, 1)), bc_type="natural")
        return CubicSpline(places, values, bc_type="periodic")
    if ends:
        return CubicSpline(np.linspace(0.0, 1.0, count), np.eye(count), bc_type="natural")
    places = np.linspace(0.0, 1.0, count + 2)
    values = np.zeros((count + 2, count))
    values[1:-1] = np.eye(count)
    return CubicSpline(places, values, bc_type="natural")


def _triangles(mesh: Mesh) -> tuple[Ints, Floats, dict[int, tuple[int, ...]]]:
    """Triangles of the corners, their shares, and other nodes with the corners they follow.

    A quadrilateral is the mean of both ways to cut it.
    """
    tables: list[Ints] = []
    shares: list[Floats] = []
    middles: dict[int, tuple[int, ...]] = {}
    for cells in mesh.cells:
        sides = 3 if cells.kind.startswith("tri") else 4
        if not cells.kind.startswith(("tri", "quad")):
            continue
        nodes = cells.nodes
        cuts = [[0, 1, 2]] if sides == 3 else [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]]
        for cut in cuts:
            tables.append(nodes[:, cut])
            shares.append(np.full(len(nodes), 1.0 if sides == 3 else 0.5))
        for k in range(sides, nodes.shape[1]):
            around = range(sides) if k == 2 * sides else (k - sides, (k - sides + 1) % sides)
            columns = nodes[:, list(around)].tolist()
            middles.update(
                {int(m): tuple(ends) for m, ends in zip(nodes[:, k], columns, strict=True)}
            )
    if not tables:
        raise InputError("a shape moves the boundaries of planar cells; the mesh has none")
    return np.concatenate(tables), np.concatenate(shares), middles


def _gradients(points: Floats, triangles: Ints) -> tuple[Floats, Floats]:
    """Gradients of the corners' functions, shape (n, 2, 3), and areas."""
    p = points[triangles]
    edge = np.roll(p, -2, axis=1) - np.roll(p, -1, axis=1)
    area = 0.5 * np.abs(edge[:, 0, 0] * edge[:, 1, 1] - edge[:, 0, 1] * edge[:, 1, 0])
    turned = np.stack([-edge[..., 1], edge[..., 0]], axis=1)
    return turned / (2.0 * area)[:, None, None], area


def _laplace(points: Floats, triangles: Ints, share: Floats) -> sp.csr_array:
    gradient, area = _gradients(points, triangles)
    values = np.einsum("eia,eib,e->eab", gradient, gradient, area * share)
    rows = np.repeat(triangles, 3, axis=1).ravel()
    columns = np.tile(triangles, 3).ravel()
    n = len(points)
    return sp.coo_array((values.ravel(), (rows, columns)), shape=(n, n)).tocsr()


def _elastic(points: Floats, triangles: Ints, share: Floats) -> sp.csr_array:
    """Stiffness of triangles whose modulus is one over their area."""
    gradient = _gradients(points, triangles)[0]
    strain = np.zeros((len(triangles), 3, 6))
    strain[:, 0, 0::2] = strain[:, 2, 1::2] = gradient[:, 0]
    strain[:, 1, 1::2] = strain[:, 2, 0::2] = gradient[:, 1]
    law = np.array([[1.0, POISSON, 0.0], [POISSON, 1.0, 0.0], [0.0, 0.0, 0.5 - 0.5 * POISSON]])
    values = np.einsum("eia,ij,ejb,e->eab", strain, law, strain, share)
    dofs = (2 * triangles[..., None] + np.arange(2)).reshape(len(triangles), 6)
    rows, columns = np.repeat(dofs, 6, axis=1).ravel(), np.tile(dofs, 6).ravel()
    n = 2 * len(points)
    return sp.coo_array((values.ravel(), (rows, columns)), shape=(n, n)).tocsr()
