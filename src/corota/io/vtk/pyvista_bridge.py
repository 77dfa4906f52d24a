"""Meshes and results as PyVista grids."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.vtk.frame_arrays import cell_data, point_data
from corota.io.vtk.grid import topology
from corota.io.vtk.revolution import Revolution
from corota.results.arrays import require

if TYPE_CHECKING:
    from corota.mesh import Mesh
    from corota.results.results import Results


def mesh_grid(mesh: Mesh) -> Any:
    """A ``pyvista.UnstructuredGrid`` in reference coordinates, with labels and sets.

    Sets are arrays of 0 and 1, named ``node set NAME`` and ``element set NAME``.
    """
    pyvista = require("pyvista", "view")
    chain, ends, types, index = topology(mesh)
    sizes = np.diff(ends)
    cells = np.insert(chain, ends[:-1], sizes)
    points = np.column_stack([mesh.points, np.zeros(mesh.n_nodes)])
    grid = pyvista.UnstructuredGrid(cells, types, points)
    grid.point_data["node label"] = mesh.node_labels
    grid.cell_data["element label"] = mesh.cell_labels[index]
    for name, nodes in mesh.node_sets.items():
        member = np.zeros(mesh.n_nodes, np.uint8)
        member[nodes] = 1
        grid.point_data[f"node set {name}"] = member
    for name, rows in mesh.cell_sets.items():
        member = np.zeros(mesh.n_cells, np.uint8)
        member[rows] = 1
        grid.cell_data[f"element set {name}"] = member[index]
    grid.set_active_scalars(None)
    return grid


def results_grid(results: Results, frame: int, scale: float, revolve: float = 0.0) -> Any:
    """One frame as a ``pyvista.UnstructuredGrid``, with the arrays of result files.

    With `revolve` an axisymmetric section is turned about its axis by that angle [degrees].
    """
    grid = mesh_grid(results.mesh)
    state = results.frame(frame)
    index = topology(results.mesh)[3]
    for name, values in point_data(state, results.averaging).items():
        grid.point_data[name] = values
    for name, values in cell_data(state, results.mesh.n_cells).items():
        grid.cell_data[name] = values[index]
    grid.cell_data["section"] = results.sections()[index]
    grid.field_data["TimeValue"] = [state.time]
    grid.field_data["load factor"] = [state.factor]
    if scale:
        grid.points = np.asarray(grid.points) + scale * grid.point_data["displacement"]
    grid.set_active_scalars(None)
    return Revolution(results.model, revolve).grid(results.mesh, grid) if revolve else grid
