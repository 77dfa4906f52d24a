"""The density method: material by node between 0 and 1, with filter and projection.

A body of the thickness ``t (least + (1 - least) r^power)`` has the stiffness of a penalized density
r (M. P. Bendsoe, O. Sigmund, Arch. Appl. Mech. 69 (1999) 635-654), in the plane and for every law,
and the derivative by the thickness of the nodes exists for all of them at once. Densities of nodes
(K. Matsui, K. Terada, Int. J. Numer. Meth. Engng 59 (2004) 1925-1944) are filtered by a cone
(B. Bourdin, Int. J. Numer. Meth. Engng 50 (2001) 2143-2158) and projected (F. Wang, B. S. Lazarov,
O. Sigmund, Struct. Multidisc. Optim. 43 (2011) 767-784).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from corota.analysis.run import solve
from corota.errors import InputError, number
from corota.gradients.asymptotes import moving_asymptotes
from corota.gradients.measures import Measure
from corota.gradients.optimization import Constraint, Design, Designs
from corota.gradients.parameters import Thickness
from corota.gradients.runs import Run
from corota.mesh import Mesh, to_triangles
from corota.mesh.data import Cells

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.model.model import Model


#: Largest change of a density in an iteration.
MOVE = 0.2
#: Sharpness of the smooth maximum over the bodies, by the first objective.
WORST = 20.0
#: Share of an edge: cuts nearer to a node move the node instead.
SNAP = 0.3


@dataclass
class Density:
    """Densities of the nodes of a mesh, and the thickness that they stand for.

    Parameters
    ----------
    mesh : Mesh
        Of triangles or quadrilaterals with corner nodes.
    radius : float
        Of the filter [length]: about half of the least width of a member.
    power : float
        Penalty of densities between 0 and 1.
    least : float
        Stiffness where there is no material, over that of the solid.
    sharpness : float
        Of the projection: 0 for none.
    threshold : float
        Filtered density that the projection makes 1/2: a larger one makes members thinner.
    thickness : float
        Of the solid [length].
    solid, void : array_like of int
        Nodes with and without material in any case.
    """

    mesh: Mesh
    radius: float
    power: float = 3.0
    least: float = 1e-3
    sharpness: float = 0.0
    threshold: float = 0.5
    thickness: float = 1.0
    solid: ArrayLike = ()
    void: ArrayLike = ()
    filter: Any = field(default=None, init=False, repr=False)
    areas: Any = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        number(self.radius, "the radius of the filter", above=0.0)
        if not (0.0 < self.least < 1.0 and self.power >= 1.0 and self.sharpness >= 0.0):
            raise InputError("expected 0 < least < 1, power >= 1 and sharpness >= 0")
        self.areas = _areas(self.mesh)
        points = self.mesh.points
        tree: Any = cKDTree(points)
        near = tree.sparse_distance_matrix(tree, self.radius, output_type="coo_matrix")
        cone = sp.coo_array((self.radius - near.data, (near.row, near.col)), shape=near.shape)
        # Distances of 0 are not stored.
        whole = cone.tocsr()
        whole.setdiag(self.radius)
        weights = whole @ sp.diags_array(self.areas)
        self.filter = sp.diags_array(1.0 / weights.sum(axis=1)) @ weights

    def densities(self, x: Floats) -> tuple[Floats, Floats]:
        """Densities of design variables, filtered and projected, and their slopes after the filter.

        Returns
        -------
        density, slope : ndarray, shape (n_nodes,)
        """
        mean = self._filtered(x)
        slope = np.ones_like(mean)
        if self.sharpness:
            b, middle = self.sharpness, self.threshold
            low = np.tanh(b * middle)
            span = low + np.tanh(b * (1.0 - middle))
            slope = b / span / np.cosh(b * (mean - middle)) ** 2
            mean = (low + np.tanh(b * (mean - middle))) / span
        return mean, slope

    def _filtered(self, x: Floats) -> Floats:
        # Given nodes are filtered, too: a hinge beside them would not be seen otherwise.
        fixed = x.copy()
        for nodes, value in ((self.solid, 1.0), (self.void, 0.0)):
            fixed[np.asarray(nodes, np.int64)] = value
        out: Floats = self.filter @ fixed
        return out

    def _before_filter(self, slope: Floats) -> Floats:
        """Gradient by the design variables from that by the filtered densities."""
        out: Floats = self.filter.T @ slope
        for nodes in (self.solid, self.void):
            out[np.asarray(nodes, np.int64)] = 0.0
        return out

    def thicknesses(self, x: Floats) -> Floats:
        """Thickness of the nodes [length], shape (n_nodes,)."""
        density = self.densities(x)[0]
        return self.thickness * (self.least + (1.0 - self.least) * density**self.power)

    def by_design(self, x: Floats, by_thickness: Floats) -> Floats:
        """Gradient by the design variables from that by the thickness of the nodes."""
        density, slope = self.densities(x)
        rate = self.thickness * (1.0 - self.least) * self.power * density ** (self.power - 1.0)
        return self._before_filter(by_thickness * rate * slope)

    def volume(self, x: Floats) -> tuple[float, Floats]:
        """Share of the area with material, and its gradient."""
        density, slope = self.densities(x)
        share = self.areas / self.areas.sum()
        return float(share @ density), self._before_filter(share * slope)

    def gray(self, x: Floats) -> float:
        """Share of densities that are neither 0 nor 1: mean of ``4 r (1 - r)``."""
        density = self.densities(x)[0]
        return float(self.areas @ (4.0 * density * (1.0 - density)) / self.areas.sum())

    def body(self, x: Floats) -> Mesh:
        """Triangles of the body where the filtered density exceeds the threshold.

        They are fitted to its boundary: nodes near it move onto it, other edges are cut. Islands
        are removed. Sets by geometry can be used on the mesh; those of the old one are lost.
        """
        mesh = self.mesh
        if any(cells.kind == "quad4" for cells in mesh.cells):
            mesh = to_triangles(mesh)
        return _largest(_cut(mesh, self._filtered(x) - self.threshold))


def optimize_density(
    build: Callable[[Mesh, Any], Model],
    density: Density,
    objective: Measure,
    volume: float,
    constraints: Sequence[Constraint] = (),
    *,
    start: ArrayLike | None = None,
    margin: float = 0.2,
    sharpness: Sequence[float] = (1.0, 4.0, 8.0, 16.0),
    most: int = 40,
    tolerance: float = 1e-4,
    record: str | os.PathLike[str] | None = None,
    progress: Callable[[int, Design], None] | None = None,
    **options: Any,
) -> tuple[Floats, Density]:
    """Find the densities of nodes that make a measure smallest with a given share of material.

    By the method of moving asymptotes (``pip install corota[optimize]``), with a projection that
    becomes sharper in stages. The worst of three bodies counts, whose thresholds differ by a
    margin: members that are too thin or too thick by as much still work, and hinges of one
    element, which only the densities can have, do not pay. Source: F. Wang, B. S. Lazarov, O.
    Sigmund (2011).

    Parameters
    ----------
    build : callable
        ``build(mesh, thickness)`` gives the model of a mesh, with its steps; `thickness` is that of
        the nodes, or a number.
    density : Density
    objective : Measure
    volume : float
        Largest share of the area with material.
    constraints : sequence of Constraint
    start : array_like, optional
        First densities; by default `volume` everywhere.
    margin : float
        Of the thresholds above and below 1/2; 0 for one body alone.
    sharpness : sequence of float
        Of the projection, stage by stage.
    most : int
        Most iterations of a stage.
    tolerance : float
        A stage ends where no density changes by more than the square root of it.
    record, progress
        As for :func:`corota.optimize`.
    **options
        Of :func:`corota.solve`.

    Returns
    -------
    x : ndarray, shape (n_nodes,)
        Design variables.
    density : Density
        With the last projection: ``density.body(x)`` is the body.
    """
    if not 0.0 < volume < 1.0:
        raise InputError(f"the share of material lies between 0 and 1, not {volume}")
    count = density.mesh.n_nodes
    x = np.full(count, float(volume)) if start is None else np.array(start, dtype=float)
    if x.shape != (count,):
        raise InputError(f"the first densities have the shape ({count},), not {x.shape}")
    measures = [objective, *(c.measure for c in constraints)]

    def evaluate(z: Floats) -> tuple[Floats, Floats]:
        """Values of the measures and the volume at densities and a sharpness."""
        at, values, rows = z[:-1], [], []
        for threshold in thresholds:
            own = replace(density, sharpness=float(z[-1]), threshold=threshold)
            results = solve(build(own.mesh, own.thicknesses(at)), fields=False, **options)
            run = Run(results, measures)
            values.append(run.values)
            rows += [own.by_design(at, row) for row in run.by(Thickness(by="node"))]
        share, by_share = replace(density, sharpness=float(z[-1])).volume(at)
        return np.append(np.ravel(values), share), np.array([*rows, by_share])

    thresholds = [0.5, 0.5 - margin, 0.5 + margin] if margin else [0.5]
    designs = Designs(evaluate, None if record is None else Path(record), progress)
    limits = []
    for each in constraints:
        low = -np.inf if each.lower is None else each.lower / each.size
        limits.append((low, np.inf if each.upper is None else each.upper / each.size))
    limits = [*limits * len(thresholds), (-np.inf, 1.0)]
    sizes = np.array([*[c.size for c in constraints] * len(thresholds), volume])
    objectives = np.arange(len(thresholds)) * len(measures)
    box = np.zeros(count), np.ones(count)
    first: list[float] = []
    for stage in sharpness:

        def at(y: Floats, stage: float = stage) -> tuple[Floats, Floats]:
            found = designs.at(np.append(y, stage))
            values, rows = np.array(found.values), np.array(found.gradient)
            first[:] = first or [abs(values[0]) or 1.0]
            # A smooth bound of the largest (G. Kreisselmeier, R. Steinhauser 1979).
            worst = WORST * values[objectives] / first[0]
            share = np.exp(worst - worst.max())
            bound = (worst.max() + np.log(share.mean())) / WORST
            by_bound = share / share.sum() @ rows[objectives] / first[0]
            others = np.delete(values, objectives) / sizes
            by_others = np.delete(rows, objectives, axis=0) / sizes[:, None]
            return np.append(bound, others), np.array([by_bound, *by_others])

        def usable(y: Floats, stage: float = stage) -> bool:
            return not designs.at(np.append(y, stage)).error

        x = moving_asymptotes(at, usable, x, box, limits, tolerance, most, MOVE).x
    return x, replace(density, sharpness=float(sharpness[-1]))


def _areas(mesh: Mesh) -> Floats:
    """Area that belongs to each node, shape (n_nodes,)."""
    out = np.zeros(mesh.n_nodes)
    for cells in mesh.cells:
        if cells.kind not in ("tri3", "quad4"):
            raise InputError(f"densities are for tri3 and quad4 cells, not {cells.kind}")
        p = mesh.points[cells.nodes]
        q = np.roll(p, -1, axis=1)
        area = 0.5 * (p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]).sum(axis=1)
        np.add.at(out, cells.nodes, area[:, None] / cells.nodes.shape[1])
    return out


def _cut(mesh: Mesh, level: Floats) -> Mesh:
    """Part of a mesh of triangles where a function of the nodes is positive."""
    points, level = mesh.points.copy(), level.copy()
    nodes = np.concatenate([cells.nodes for cells in mesh.cells])
    edges = np.unique(np.sort(nodes[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    corner = np.zeros(len(points), bool)
    border = mesh.boundary_edges()
    for ends in mesh.edge_nodes(border):
        corner[ends] = True  # the border of the domain stays
    for a, b in edges.tolist():
        if level[a] * level[b] < 0.0:
            share = level[a] / (level[a] - level[b])
            near, other, part = (a, b, share) if share < 0.5 else (b, a, 1.0 - share)
            if part < SNAP and not corner[near]:
                points[near] += part * (points[other] - points[near])
                level[near] = 0.0
            elif part < SNAP / 3.0:
                level[near] = 0.0
    made: dict[tuple[int, int], int] = {}
    more: list[Floats] = []

    def crossing(a: int, b: int) -> int:
        pair = (min(a, b), max(a, b))
        if pair not in made:
            share = level[pair[0]] / (level[pair[0]] - level[pair[1]])
            more.append(points[pair[0]] + share * (points[pair[1]] - points[pair[0]]))
            made[pair] = len(points) + len(more) - 1
        return made[pair]

    kept: list[tuple[int, int, int]] = []
    for triangle in nodes.tolist():
        polygon: list[int] = []
        if not any(level[n] > 0.0 for n in triangle):
            continue
        for a, b in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            if level[a] >= 0.0:
                polygon.append(a)
            if level[a] * level[b] < 0.0:
                polygon.append(crossing(a, b))
        kept += [(polygon[0], b, c) for b, c in zip(polygon[1:-1], polygon[2:], strict=True)]
    return _compact(np.concatenate([points, np.array(more).reshape(-1, 2)]), np.array(kept))


def _compact(points: Floats, triangles: Ints) -> Mesh:
    """Mesh of triangles without the nodes of none."""
    used, inverse = np.unique(triangles, return_inverse=True)
    table = inverse.reshape(-1, 3)
    return Mesh(points[used], [Cells("tri3", table, np.arange(1, len(table) + 1))])


def _largest(mesh: Mesh) -> Mesh:
    """The largest connected part of a mesh of triangles."""
    table = mesh.cells[0].nodes
    ends = table[:, [[0, 1], [1, 2]]].reshape(-1, 2)
    n = mesh.n_nodes
    graph = sp.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(n, n))
    label = sp.csgraph.connected_components(graph, directed=False)[1][table[:, 0]]
    return _compact(mesh.points, table[label == np.bincount(label).argmax()])
