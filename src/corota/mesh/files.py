"""Reading a mesh from a file."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.lazy import lazy

if TYPE_CHECKING:
    import os

    from corota.mesh.data import Mesh

# A convenience: a function of a higher layer, which loads at its first call.
read_mesh = lazy("corota.io.formats:read_mesh")


def read(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh.

    Gmsh's ``.msh`` (2.2 and 4.1, text and binary) and decks ``.inp`` are read directly; other
    formats through meshio, if it is installed. Physical groups become sets: of cells for surfaces,
    of edges and nodes for curves, of nodes for points.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    Mesh

    Raises
    ------
    InputError
        With file and line of the error.
    FileError
        If the file cannot be read.
    """
    mesh: Mesh = read_mesh(path)
    return mesh
