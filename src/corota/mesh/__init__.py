"""Planar meshes: data, generators, changes, quality, files."""

# SPDX-License-Identifier: BSD-3-Clause
from corota.mesh.assembly import add_node, assembly
from corota.mesh.change import merge, move, renumber, to_quadratic, to_triangles
from corota.mesh.data import EDGES, N_NODES, Cells, Mesh
from corota.mesh.files import read
from corota.mesh.generate import annulus, distort, mapped, rectangle

__all__ = [
    "EDGES",
    "N_NODES",
    "Cells",
    "Mesh",
    "add_node",
    "annulus",
    "assembly",
    "distort",
    "mapped",
    "merge",
    "move",
    "read",
    "rectangle",
    "renumber",
    "to_quadratic",
    "to_triangles",
]
