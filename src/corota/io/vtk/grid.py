"""The unstructured grid of a model: its mesh, followed by its rigid curves as lines."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.mesh import Cells
from corota.mesh.kinds import KINDS, N_NODES
from corota.results.averaging import section_of_cells
from corota.results.rigid import moved, rigid_curves, rigid_lines

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.results.results import Frame


#: VTK cell types of our kinds; node orders agree.
VTK_TYPES = {name: kind.vtk for name, kind in KINDS.items()}
#: VTK cell type of a rigid curve.
POLY_LINE = 4


def topology(mesh: Mesh) -> tuple[Ints, Ints, NDArray[np.uint8], Ints]:
    """Connectivity, offsets, types and global cell indices of all cells."""
    chain: list[Ints] = []
    sizes: list[Ints] = []
    types: list[NDArray[np.uint8]] = []
    index: list[Ints] = []
    for offset, cells in zip(mesh.offsets, mesh.cells, strict=False):
        if not len(cells):
            continue
        chain.append(cells.nodes.ravel())
        sizes.append(np.full(len(cells), cells.nodes.shape[1], np.int64))
        types.append(np.full(len(cells), VTK_TYPES[cells.kind], np.uint8))
        index.append(np.arange(len(cells), dtype=np.int64) + offset)
    if not chain:
        return *(np.zeros(0, np.int64),) * 2, np.zeros(0, np.uint8), np.zeros(0, np.int64)
    ends = np.concatenate([[0], np.cumsum(np.concatenate(sizes))])
    return np.concatenate(chain), ends, np.concatenate(types), np.concatenate(index)


def grid_cells(types: Ints, chain: Ints, ends: Ints, labels: Ints) -> list[Cells]:
    """Blocks of cells of a grid: runs of one type.

    Raises
    ------
    InputError
        If a type is not one of ours.
    """
    kinds = {number: kind for kind, number in VTK_TYPES.items()}
    cells = []
    cuts = [0, *(np.flatnonzero(np.diff(types)) + 1).tolist(), len(types)]
    for first, end in pairwise(cuts):
        if first == end:
            continue
        kind = kinds.get(int(types[first]))
        if kind is None:
            raise InputError(f"cell type {types[first]} is not one of Corota's")
        nodes = chain[ends[first] : ends[end]].reshape(-1, N_NODES[kind])
        cells.append(Cells(kind, nodes, labels[first:end]))
    return cells


class Grid:
    """Points and cells of a model as VTK has them.

    Rigid curves are lines behind the elements: their points have the displacement of their
    reference node's rigid motion, and 0 in all other arrays.

    Parameters
    ----------
    sections : ndarray of int, shape (n_cells,), optional
        Section group of each cell; those of the model by default.
    parts : ndarray of int, shape (n_cells,), optional
        Part of each cell, where the grid has several; see :class:`corota.io.vtk.parts.Parts`.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        Reference coordinates, nodes first.
    chain, ends, types : ndarray
        Connectivity, offsets (one more than cells), cell types; of one part after the other.
    sizes : ndarray of int, shape (n_parts, 3)
        Points, cells and entries of the connectivity of each part.
    rows : dict of str to ndarray
        Of several parts: ``nodes`` and ``cells`` of the rows.
    n_rigid : int
        Rigid curves, the last cells.
    """

    def __init__(
        self, model: Model, sections: Ints | None = None, parts: Ints | None = None
    ) -> None:
        mesh = self._mesh = model.mesh
        self._model = model
        self.chain, self.ends, self.types, self._index = topology(mesh)
        self.sizes = np.array([[mesh.n_nodes, len(self.types), len(self.chain)]])
        self.rows: dict[str, Ints] = {}
        points = mesh.points
        if parts is not None:
            from corota.io.vtk.parts import Parts

            cut = Parts(self.chain, self.ends, parts[self._index], mesh.n_nodes)
            self.chain, self.ends, self.sizes = cut.chain, cut.ends, cut.sizes
            self.types, self._index = self.types[cut.cells], self._index[cut.cells]
            self.rows = {"nodes": cut.nodes, "cells": self._index}
            points = points[cut.nodes]
        self._sections = section_of_cells(model) if sections is None else sections
        self._curves = rigid_curves(model)
        lines = [np.concatenate(rigid_lines(curve)) for curve in self._curves]
        self.n_rigid = len(lines)
        self._rigid = np.concatenate([np.zeros((0, 2)), *lines])
        flat = np.concatenate([points, self._rigid])
        self.points = np.column_stack([flat, np.zeros(len(flat))])
        if lines:
            sizes = [len(line) for line in lines]
            more = np.arange(len(self._rigid), dtype=np.int64) + self.sizes[-1, 0]
            self.sizes[-1] += len(self._rigid), len(lines), len(self._rigid)
            self.chain = np.concatenate([self.chain, more])
            start = self.ends[-1:] if len(self.ends) else np.zeros(1, np.int64)
            self.ends = np.concatenate(
                [start if not len(self.ends) else self.ends, start + np.cumsum(sizes)]
            )
            self.types = np.concatenate([self.types, np.full(len(lines), POLY_LINE, np.uint8)])

    @property
    def still(self) -> dict[str, Ints]:
        """Arrays at the cells that do not change."""
        section = self._sections[self._index]
        labels = self._mesh.cell_labels[self._index]
        return {
            "section": np.concatenate([section, np.full(self.n_rigid, -1, np.int64)]),
            "element label": np.concatenate([labels, np.zeros(self.n_rigid, np.int64)]),
        }

    def at_points(self, data: dict[str, Floats], frame: Frame) -> dict[str, Floats]:
        """Arrays at the nodes in the order of the grid, continued on rigid curves."""
        if self.rows:
            data = {name: values[self.rows["nodes"]] for name, values in data.items()}
        if not self.n_rigid:
            return data
        found = {name: _longer(values, len(self._rigid)) for name, values in data.items()}
        if "displacement" in found:
            lines = [line for curve in self._curves for line in moved(self._model, curve, frame)]
            shift = np.concatenate(lines) - self._rigid
            found["displacement"][-len(shift) :, :2] = shift
        return found

    def at_cells(self, data: dict[str, Floats]) -> dict[str, Floats]:
        """Arrays of all cells in the order of the grid, continued on rigid curves."""
        found = {name: values[self._index] for name, values in data.items()}
        if not self.n_rigid:
            return found
        return {name: _longer(values, self.n_rigid) for name, values in found.items()}


def _longer(values: Floats, more: int) -> Floats:
    return np.concatenate([values, np.zeros((more, *values.shape[1:]), values.dtype)])
