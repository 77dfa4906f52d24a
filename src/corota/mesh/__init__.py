"""Planar meshes: data, generators, changes, quality, files.

Names are imported at first use: a mesh that is read from a deck needs no generators.
"""

# SPDX-License-Identifier: BSD-3-Clause
from importlib import import_module
from typing import TYPE_CHECKING, Any

from corota.mesh.assembly import add_node, assembly  # the module has the name of its function

if TYPE_CHECKING:
    from corota.mesh.change import merge, move, renumber, to_quadratic, to_triangles
    from corota.mesh.data import Cells, Mesh
    from corota.mesh.files import read
    from corota.mesh.generate import annulus, distort, line, mapped, rectangle
    from corota.mesh.kinds import EDGES, N_NODES
    from corota.mesh.random_fields import random_field

    outline: Any

#: Names of each module; that of `outline` is of a higher layer.
_NAMES = {
    ".outline.mesher": "outline",
    "change": "merge move renumber to_quadratic to_triangles",
    "data": "Cells Mesh",
    "files": "read",
    "generate": "annulus distort line mapped rectangle",
    "kinds": "EDGES N_NODES",
    "random_fields": "random_field",
}
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = [
    "EDGES",
    "N_NODES",
    "Cells",
    "Mesh",
    "add_node",
    "annulus",
    "assembly",
    "distort",
    "line",
    "mapped",
    "merge",
    "move",
    "outline",
    "random_field",
    "read",
    "rectangle",
    "renumber",
    "to_quadratic",
    "to_triangles",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'corota.mesh' has no attribute {name!r}")
    value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
