"""Values at nodes, sets, points inside elements and points along a line."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.display import Brief
from corota.errors import InputError
from corota.lazy import lazy
from corota.mesh.kinds import EDGES
from corota.mesh.shape_functions import shape_functions, shape_gradients
from corota.names import choose
from corota.results.history import History
from corota.results.sampling import sampled

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh
    from corota.results.source import ResultSource


# A convenience: a function of a higher layer, which loads at its first call.
draw_along = lazy("corota.plots:along")

#: How far outside an element, in its natural coordinates, a point may lie by rounding.
INSIDE = 1e-7
#: Steps of Newton's method for natural coordinates, at most.
STEPS = 25


class Interpolation:
    """Nodes and shape functions of the elements that contain given reference points.

    Parameters
    ----------
    mesh : Mesh
    points : array_like, shape (n, 2)
        Reference coordinates [length].

    Attributes
    ----------
    cells : ndarray of int, shape (n,)
        Element of each point, -1 outside of all.
    """

    def __init__(self, mesh: Mesh, points: ArrayLike) -> None:
        self.points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        self.cells = np.full(len(self.points), -1, np.int64)
        self._pieces: list[tuple[Ints, Ints, Floats]] = []
        size = float(np.ptp(mesh.points, axis=0).max()) if mesh.n_nodes else 1.0
        for offset, cells in zip(mesh.offsets, mesh.cells, strict=False):
            if not EDGES[cells.kind] or not len(cells):
                continue
            corners = mesh.points[cells.nodes]
            pad = 1e-9 * size
            if len(EDGES[cells.kind][0]) == 3:  # curved sides bulge beyond their nodes
                pad += 0.25 * float(np.ptp(corners, axis=1).max())
            low, high = corners.min(axis=1) - pad, corners.max(axis=1) + pad
            for row in np.flatnonzero(self.cells < 0):
                point = self.points[row]
                near = np.flatnonzero(((low <= point) & (point <= high)).all(axis=1))
                for cell in near:
                    at = natural(cells.kind, corners[cell], point)
                    if at is None:
                        continue
                    self.cells[row] = offset + cell
                    weights = shape_functions(cells.kind, at[None])[0]
                    self._pieces.append((np.array([row]), cells.nodes[cell], weights))
                    break

    def values(self, nodal: Floats) -> Floats:
        """Nodal values (n_nodes, ...) at the points; nan outside of all elements."""
        out = np.full((len(self.points), *nodal.shape[1:]), np.nan)
        for row, nodes, weights in self._pieces:
            out[row] = np.einsum("k,k...->...", weights, nodal[nodes])
        return out


def natural(kind: str, corners: Floats, point: Floats) -> Floats | None:
    """Natural coordinates of a point in a cell, by Newton's method; None if it lies outside."""
    triangle = kind.startswith("tri")
    at = np.full(2, 1.0 / 3.0) if triangle else np.zeros(2)
    size = float(np.ptp(corners, axis=0).max())
    for _ in range(STEPS):
        miss = point - shape_functions(kind, at[None])[0] @ corners
        jacobian = (shape_gradients(kind, at[None])[0] @ corners).T
        try:
            change = np.linalg.solve(jacobian, miss)
        except np.linalg.LinAlgError:
            return None
        at = at + np.clip(change, -0.5, 0.5)
        if np.abs(change).max() < 1e-9:
            break
    else:
        return None
    if np.abs(shape_functions(kind, at[None])[0] @ corners - point).max() > 1e-6 * size:
        return None
    if triangle:
        inside = at.min() >= -INSIDE and at.sum() <= 1 + INSIDE
    else:
        inside = np.abs(at).max() <= 1 + INSIDE
    return at if inside else None


@dataclass(repr=False)
class Place(Brief):
    """Results at one place; ``place["U2"]`` is the history of a variable there.

    Parameters
    ----------
    results : Results
    name : str
        For labels.
    nodes : ndarray of int, shape (n,)
        Node indices; displacements of several are averaged, forces summed.
    inside : Interpolation, optional
        A point in an element instead.
    """

    results: ResultSource
    name: str
    nodes: Ints
    inside: Interpolation | None = field(default=None, repr=False)

    def __getitem__(self, variable: str) -> History:
        return self.history(variable)

    def history(self, variable: str) -> History:
        """A variable over the frames.

        Raises
        ------
        InputError
            If there is no such variable.
        """
        results = self.results
        if self.inside is None:
            found: History = results.history(variable, at=self.nodes.tolist())
            found.name = f"{found.name.partition(' at ')[0]} at {self.name}"
            return found
        values = [
            float(sampled(results, variable, i, self.inside.values)[0])
            for i in range(len(results.frames))
        ]
        return History(f"{variable.upper()} at {self.name}", np.array(values), results)

    def to_dataframe(self, *variables: str) -> Any:
        """Histories as a ``pandas.DataFrame`` over the total time; displacements by default."""
        chosen = variables or ("U1", "U2")
        return self.results.to_dataframe(*(self.history(name) for name in chosen))


def place(
    results: ResultSource, node: int | None, point: ArrayLike | None, where: str | ArrayLike | None
) -> Place:
    """Find a place; see :meth:`corota.results.Results.at`."""
    mesh = results.mesh
    if sum(given is not None for given in (node, point, where)) != 1:
        raise InputError("give one of node=, point= or a set: results.at(node=17)")
    if node is not None:
        found = np.flatnonzero(mesh.node_labels == node)
        if not len(found):
            raise InputError(f"there is no node {node}; give the label of a node")
        return Place(results, f"node {node}", found)
    if point is not None:
        inside = Interpolation(mesh, point)
        if len(inside.cells) != 1:
            raise InputError(f"point= takes one point (x, y), not {len(inside.cells)}")
        x, y = inside.points[0]
        if inside.cells[0] < 0:
            raise InputError(f"the point ({x:g}, {y:g}) of the undeformed shape is in no element")
        return Place(results, f"({x:g}, {y:g})", np.zeros(0, np.int64), inside)
    assert where is not None
    nodes = mesh.node_indices(where)
    return Place(results, where if isinstance(where, str) else f"{len(nodes)} nodes", nodes)


@dataclass(repr=False)
class Line(Brief):
    """Results along a line of the undeformed shape; ``line["S11"]`` are values at its points.

    Parameters
    ----------
    results : Results
    points : ndarray, shape (n, 2)
        Reference coordinates [length].
    frame : int
    """

    results: ResultSource
    points: Floats
    frame: int = -1

    def __post_init__(self) -> None:
        self._inside = Interpolation(self.results.mesh, self.points)

    @property
    def distance(self) -> Floats:
        """Length along the line up to each point, shape (n,) [length]."""
        pieces = np.hypot(*np.diff(self.points, axis=0).T)
        return np.concatenate([[0.0], np.cumsum(pieces)])

    def __getitem__(self, variable: str) -> Floats:
        return self.values(variable)

    def values(self, variable: str) -> Floats:
        """A variable at the points, shape (n,); nan outside of the elements.

        Raises
        ------
        InputError
            If there is no such variable.
        """
        return sampled(self.results, variable, self.frame, self._inside.values)

    def to_dataframe(self, *variables: str) -> Any:
        """Table of distance, x, y and variables as a ``pandas.DataFrame``."""
        chosen = variables or ("U1", "U2")
        columns = {"distance": self.distance, "x": self.points[:, 0], "y": self.points[:, 1]}
        return import_module("pandas").DataFrame(
            columns | {name: self.values(name) for name in chosen}
        )

    def plot(self, *variables: str, path: str | PathLike[str] | None = None, ax: Any = None) -> Any:
        """Draw variables over the distance; see :func:`corota.plots.along`."""
        return draw_along(self, variables, path=path, ax=ax)


def line(
    results: ResultSource, path: str | ArrayLike, points: int, frame: int, spread: str
) -> Line:
    """Find a line; see :meth:`corota.results.Results.along`."""
    mesh = results.mesh
    spread = choose(spread, ("even", "given"), "spread of points")
    if isinstance(path, str):
        name = mesh.set_name(path)
        if name in mesh.edge_sets:
            nodes = chained(mesh, mesh.edge_sets[name])
        else:
            nodes = mesh.nodes_of(name)
        corners, spread = mesh.points[nodes], "given"
    else:
        corners = np.asarray(path, dtype=np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 2:
        raise InputError(f"a path is two or more points (x, y), not an array {corners.shape}")
    if spread == "even":
        if points < 2:
            raise InputError(f"a line needs two or more points, not {points}")
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
        at = np.linspace(0.0, along[-1], points)
        corners = np.stack([np.interp(at, along, corners[:, i]) for i in (0, 1)], axis=1)
    found = Line(results, corners, frame)
    if (found._inside.cells < 0).all():
        raise InputError("the path runs outside of all elements (undeformed coordinates)")
    return found


def chained(mesh: Mesh, edges: Ints) -> Ints:
    """Nodes of connected edges, one after the other along the boundary.

    Raises
    ------
    InputError
        If they make no single chain.
    """
    sides = [n if len(n) == 2 else n[[0, 2, 1]] for n in mesh.edge_nodes(edges)]
    begins = {int(s[0]): s for s in sides}
    ends = {int(s[-1]) for s in sides}
    starts = [n for n in begins if n not in ends] or [int(sides[0][0])]
    if len(starts) > 1 or len(begins) < len(sides):
        raise InputError("these edges do not form one line; give points of a path instead")
    chain, at = [starts[0]], starts[0]
    for _ in sides:
        if at not in begins:
            raise InputError("these edges do not form one line; give points of a path instead")
        chain += begins[at][1:].tolist()
        at = chain[-1]
    return np.array(chain, dtype=np.int64)
