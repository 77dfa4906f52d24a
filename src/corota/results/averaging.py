"""Values of variables at nodes and cells: averages of those at points."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Bools, Floats, Ints, distinct
from corota.mesh.kinds import KINDS
from corota.model.element_changes import groups_of_cells
from corota.results.table import COMPONENTS, INVARIANTS, POSITIVE
from corota.results.variables import STORED, averaged_value, invariant, stored_as

if TYPE_CHECKING:
    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.results.frame import Frame, PointFields


#: The order of operations, written into result files.
AVERAGING = (
    "Nodal values: components at the quadrature points are extrapolated to the nodes of each cell "
    "(linear fit in triangles, bilinear in quadrilaterals, least squares) and averaged over the "
    "cells of one section at a node with equal weights; numbers that cannot be negative are cut "
    "off at 0, and invariants are taken from the averaged components. At a border of sections the "
    "larger by size is taken."
)


def extrapolation(name: str, shape: Floats) -> Floats:
    """Matrix from values at the points of a cell to values at its nodes, shape (k, p).

    A least-squares fit: constant with one or two points, otherwise linear in triangles and
    bilinear in quadrilaterals (linear if there are three points).

    Parameters
    ----------
    name : str
        Kind of the cell.
    shape : ndarray, shape (p, k)
        Shape functions at the points.
    """
    points, kind = len(shape), KINDS[name]
    corners = np.array(kind.natural or [(0.0, 0.0)], dtype=np.float64)
    at = shape @ corners
    terms = 1 if points < 3 else 3 if kind.n_corners == 3 or points == 3 else 4

    def basis(x: Floats) -> Floats:
        every = [np.ones(len(x)), x[:, 0], x[:, 1], x[:, 0] * x[:, 1]]
        return np.stack(every[:terms], axis=1)

    return np.asarray(basis(corners) @ np.linalg.pinv(basis(at)))


def section_of_cells(model: Model) -> Ints:
    """Number of the section group of each cell, -1 without; shape (n_cells,).

    Sections that share material, thickness, state and orientation make one group: triangles
    and quadrilaterals of one part are averaged together.
    """
    group = np.full(model.mesh.n_cells, -1, dtype=np.int64)
    kinds: list[tuple[object, ...]] = []
    for section in model.sections:
        nodal = section.nodal_thickness
        key = (
            section.material,
            section.thickness if nodal is None else nodal.tobytes(),
            section.plane,
            section.orientation,
        )
        if key not in kinds:
            kinds.append(key)
        where = section.cells
        if isinstance(where, str):
            if where in model.mesh.cell_sets:
                group[model.mesh.cell_sets[where]] = kinds.index(key)
            else:
                group[:] = kinds.index(key)
        else:
            group[where] = kinds.index(key)
    changes = groups_of_cells(model.mesh, model.steps)
    # Cells that are removed have no values to average with.
    return np.where(group < 0, -1, group * (1 + int(changes.max(initial=0))) + changes)


def nodes_of_groups(
    groups: list[Ints], nodes: list[Ints], n_nodes: int
) -> tuple[Ints, Ints, list[Ints]]:
    """Nodes, once for each section group that has a cell there.

    Parameters
    ----------
    groups : list of ndarray, shape (n,)
        Section group of each cell, by blocks of one kind of cells.
    nodes : list of ndarray, shape (n, k)
    n_nodes : int

    Returns
    -------
    group, node : ndarray, shape (c,)
        In ascending order of groups, then of nodes.
    places : list of ndarray, shape (n * k,)
        Where the nodes of each cell are among them.
    """
    keys = [(g[:, None] * n_nodes + k).ravel() for g, k in zip(groups, nodes, strict=True)]
    found = distinct(np.concatenate(keys)) if keys else np.zeros(0, dtype=np.int64)
    return found // n_nodes, found % n_nodes, [np.searchsorted(found, key) for key in keys]


class Averaging:
    """Point values averaged at nodes; caches the maps of the last blocks.

    Parameters
    ----------
    mesh : Mesh
    sections : ndarray of int, shape (n_cells,)
        Section group of each cell (:func:`section_of_cells`).
    """

    def __init__(self, mesh: Mesh, sections: Ints) -> None:
        self.mesh, self.sections = mesh, sections
        self._cells: list[Ints] = []
        self._nodes: list[Ints] = []
        self._kinds: list[str] = []
        self._groups: tuple[Ints, Ints, list[Ints]] | None = None

    def _locate(self, fields: list[PointFields]) -> None:
        """Find nodes and section groups of the cells of blocks, unless they are those before."""
        cells = [b.cells for b in fields if len(b.cells)]
        if len(cells) == len(self._cells) and all(
            a is b or np.array_equal(a, b) for a, b in zip(cells, self._cells, strict=True)
        ):
            return
        self._cells, self._nodes, self._kinds, self._groups = cells, [], [], None
        for own in cells:
            block, _ = self.mesh.locate(int(own[0]))
            offset = int(self.mesh.offsets[block])
            self._nodes.append(self.mesh.cells[block].nodes[own - offset])
            self._kinds.append(self.mesh.cells[block].kind)

    def _average(
        self, fields: list[PointFields], names: list[str], places: list[Ints], n: int
    ) -> dict[str, Floats]:
        """Averages at `n` places, given those of the nodes of each cell."""
        count = np.zeros(n)
        sums: dict[str, Floats] = {}
        for name in names:
            width = {b.values[name].shape[2:] for b in fields if name in b.values} or {()}
            sums[name] = np.zeros((n, *width.pop()))
        filled = (b for b in fields if len(b.cells))
        for block, kind, flat in zip(filled, self._kinds, places, strict=True):
            count += np.bincount(flat, minlength=n)
            matrix = extrapolation(kind, block.shape)
            # einsum, not @: threads of a BLAS would compete with the solver for a small product.
            for name in names:
                if name not in block.values:
                    continue
                values = block.values[name]
                if values.ndim == 2:
                    at = np.einsum("np,kp->nk", values, matrix)
                    sums[name] += np.bincount(flat, weights=at.ravel(), minlength=n)
                    continue
                for column in range(values.shape[2]):
                    if not values[..., column].any():
                        continue
                    at = np.einsum("np,kp->nk", values[..., column], matrix)
                    sums[name][:, column] += np.bincount(flat, at.ravel(), minlength=n)
        share = 1.0 / np.maximum(count, 1.0)
        found = {k: (v.T * share).T for k, v in sums.items()}
        for name in POSITIVE & found.keys():
            np.maximum(found[name], 0.0, out=found[name])  # extrapolation must not make them < 0
        return found

    def by_group(
        self, fields: list[PointFields], names: list[str]
    ) -> tuple[Ints, Ints, dict[str, Floats]]:
        """Stored values (tensors and scalars) at the nodes of each section group.

        Parameters
        ----------
        fields : list of PointFields
        names : list of str
            Keys of ``values``; a block without one counts as zero.

        Returns
        -------
        group, node : ndarray, shape (c,)
            In ascending order of groups, then of nodes.
        values : dict of str to ndarray, shape (c, 4) or (c,)
        """
        self._locate(fields)
        if self._groups is None:
            groups = [self.sections[cells] for cells in self._cells]
            self._groups = nodes_of_groups(groups, self._nodes, self.mesh.n_nodes)
        group, node, places = self._groups
        return group, node, self._average(fields, names, places, len(node))

    def nodal(
        self, fields: list[PointFields], names: list[str], section: int | None = None
    ) -> dict[str, Floats]:
        """Nodal values of tensors and scalars, averaged within one section.

        Parameters
        ----------
        fields : list of PointFields
        names : list of str
        section : int, optional
            The group; by default all, and at nodes of several the larger by size.

        Returns
        -------
        dict of str to ndarray, shape (n_nodes, 4) or (n_nodes,)
            Zero at nodes without a cell.
        """
        n = self.mesh.n_nodes
        self._locate(fields)
        extent = [g for cells in self._cells for g in _extent(self.sections[cells])]
        if section is None and (not extent or min(extent) == max(extent)):
            return self._average(fields, names, [nodes.ravel() for nodes in self._nodes], n)
        group, node, values = self.by_group(fields, names)
        if section is not None:
            chosen = group == section
            group, node = group[chosen], node[chosen]
            values = {name: rows[chosen] for name, rows in values.items()}
        found = {name: np.zeros((n, *rows.shape[1:])) for name, rows in values.items()}
        for turn in _turns(node):
            for name, rows in values.items():
                at, new = node[turn], rows[turn]
                sizes = [(v.reshape(len(at), -1) ** 2).sum(axis=1) for v in (found[name][at], new)]
                larger = sizes[1] > sizes[0]
                found[name][at[larger]] = new[larger]
        return found

    def values(self, fields: list[PointFields], name: str, section: int | None = None) -> Floats:
        """One component, invariant or scalar at the nodes, shape (n_nodes,)."""
        stored, column = _stored(name)
        return _pick(self.nodal(fields, [stored], section)[stored], name, column)

    def extremes(self, fields: list[PointFields], name: str) -> list[tuple[float, int, int]]:
        """Smallest and largest nodal value, each with a cell and the node; empty without values.

        Parameters
        ----------
        fields : list of PointFields
        name : str
            Component, invariant or scalar.
        """
        stored, column = _stored(name)
        fields = [b for b in fields if len(b.cells) and stored in b.values]
        if not fields:
            return []
        group, node, averages = self.by_group(fields, [stored])
        values = _pick(averages[stored], name, column)
        found = []
        for at in (int(values.argmin()), int(values.argmax())):
            cell = next(
                int(cells[rows[0]])
                for cells, nodes in zip(self._cells, self._nodes, strict=True)
                if (
                    rows := np.flatnonzero(
                        (nodes == node[at]).any(axis=1) & (self.sections[cells] == group[at])
                    )
                ).size
            )
            found.append((float(values[at]), cell, int(node[at])))
        return found


def _stored(name: str) -> tuple[str, int]:
    """Array of points that has a variable, and its column; -1 for a scalar or an invariant."""
    return COMPONENTS.get(name, (INVARIANTS.get(name, (name,))[0], -1))


def _pick(values: Floats, name: str, column: int) -> Floats:
    if name in INVARIANTS:
        return invariant(name, values)
    return values if column < 0 else values[:, column]


def _extent(values: Ints) -> tuple[int, int]:
    return int(values.min()), int(values.max())


def _turns(nodes: Ints) -> list[Ints]:
    """Indices of the first mention of each node, those of the second ones, and so on."""
    order = np.argsort(nodes, kind="stable")
    first = np.ones(len(nodes), dtype=bool)
    first[1:] = nodes[order][1:] != nodes[order][:-1]
    starts = np.flatnonzero(first)
    turn = np.arange(len(nodes)) - np.repeat(starts, np.diff([*starts, len(nodes)]))
    return [order[turn == k] for k in range(int(turn.max(initial=-1)) + 1)]


def cell_weights(block: PointFields) -> Floats:
    """Share of each point in the average over its cell, shape (n, p)."""
    whole = block.volume.sum(axis=1, keepdims=True)
    # Springs have no volume.
    weight = np.where(whole > 0.0, block.volume, 1.0)
    return np.asarray(weight / weight.sum(axis=1, keepdims=True))


def cell_mean(block: PointFields, name: str, weights: Floats | None = None) -> Floats:
    """Volume average over each cell of stored values, shape (n,) or (n, 4).

    Parameters
    ----------
    block : PointFields
    name : str
    weights : ndarray, shape (n, p), optional
        :func:`cell_weights` of the block, where several of its values are averaged.
    """
    weight = cell_weights(block) if weights is None else weights
    return np.asarray(np.einsum("np,np...->n...", weight, block.values[name]))


def stored_at_nodes(frame: Frame, name: str, section: int | None) -> Floats:
    """A variable of a frame without values at points, at the nodes; shape (n_nodes,).

    With a section its own averages, where the frame has them, and 0 at other nodes.
    """
    own = None if section is None else frame.section_averages.get(section)
    if own is None:
        array = stored_as(name)[0]
        tensor = STORED[INVARIANTS[name][0]] if name in INVARIANTS else array
        if not any(key in frame.averages for key in (name, array, tensor)):
            return np.zeros(len(frame.U))  # a variable of line elements only
        return averaged_value(frame.averages, name)
    out = np.zeros(len(frame.U))
    tensor, column = _stored(name)
    if tensor in own:
        nodes = np.asarray(own["nodes"], dtype=np.int64)
        out[nodes] = _pick(own[tensor], name, column)
    return out


def stored_at_cells(frame: Frame, name: str, n_cells: int) -> Floats:
    """A variable of a frame without values at points, over the cells; shape (n_cells,)."""
    of_cells = {n.removeprefix("cell "): n for n in frame.cell_averages}
    tensor = INVARIANTS[name][0] if name in INVARIANTS else COMPONENTS.get(name, (name,))[0]
    array = of_cells.get(STORED.get(tensor, tensor))
    if array is None:
        return np.zeros(n_cells)
    values = frame.cell_averages[array]
    if name in INVARIANTS:
        return invariant(name, values[:, :4])
    column = COMPONENTS[name][1] if name in COMPONENTS else -1
    return np.asarray(values if column < 0 else values[:, column], dtype=np.float64)


def cell_values(frame: Frame, name: str, n_cells: int) -> Floats:
    """Volume averages over the cells, shape (n_cells,), 0 where there are none.

    Invariants are taken from the averaged components.
    """
    if not frame.fields:
        return stored_at_cells(frame, name, n_cells)
    tensor, column = COMPONENTS.get(name, (INVARIANTS.get(name, (name,))[0], -1))
    out = np.zeros(n_cells)
    for block in frame.fields:
        if tensor not in block.values:
            continue
        mean = cell_mean(block, tensor)
        if name in INVARIANTS:
            mean = invariant(name, mean)
        out[block.cells] = mean[:, column] if column >= 0 else mean
    return out


def cells_with(frame: Frame, name: str, n_cells: int) -> Bools:
    """Whether each cell has a variable at its points, shape (n_cells,)."""
    tensor = COMPONENTS.get(name, (INVARIANTS.get(name, (name,))[0],))[0]
    out = np.zeros(n_cells, dtype=bool)
    if not frame.fields:
        return frame.cells_with.get(tensor, out)
    for block in frame.fields:
        if tensor in block.values:
            out[block.cells] = True
    return out
