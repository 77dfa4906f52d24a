"""Parts of four sides without Gmsh: each is mapped from a rectangle."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import ResourceError
from corota.mesh.change import merge
from corota.mesh.generate import mapped
from corota.outline.drawing import set_name
from corota.outline.strips import AROUND, Faces, Side

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from corota.mesh.data import Mesh

#: Sides of a mapped mesh in order around the part.
SIDES = ("bottom", "right", "top", "left")


def mesh_four_sided(faces: Faces, names: list[str], size: float, quadratic: bool) -> Mesh:
    """Mesh parts of four sides; the sets are those that Gmsh would give.

    Parameters
    ----------
    faces : Faces
        One for each part.
    names : list of str
        Of the parts.
    size : float
        Largest side of a cell [length].

    Raises
    ------
    ResourceError
        If a part has a hole or other than four sides.
    """
    found: list[Mesh] = []
    for number, (face, part) in enumerate(zip(faces.faces, faces.parts, strict=True)):
        if len(face) != 1 or len(face[0]) != 4 or faces.parts.count(part) != 1:
            raise ResourceError(
                "outlines are meshed by Gmsh, which is not installed: pip install corota[mesh]; "
                "without it parts need four sides and no hole"
            )
        sides = [Side(faces.curves[k], back) for k, back in face[0]]
        rows = faces.rows.get(number) or _counts(sides, size)
        mesh = mapped(
            [_along(sides[0]), _along(sides[1]), _along(sides[2], True), _along(sides[3], True)],
            rows[0],
            rows[1],
            "quad8" if quadratic else "quad4",
        )
        given = {side: mesh.edge_sets[side] for side in SIDES}
        mesh.edge_sets, mesh.node_sets = {}, {}
        mesh.cell_sets = {names[part]: np.arange(mesh.n_cells)}
        for side, (k, _) in zip(SIDES, face[0], strict=True):
            if faces.curves[k].name:
                name = set_name(faces.curves[k].name)
                edges = mesh.edge_sets.get(name, np.zeros((0, 2), dtype=np.int64))
                mesh.edge_sets[name] = np.concatenate([edges, given[side]])
        found.append(mesh)
    return found[0] if len(found) == 1 else merge(*found)


def _along(side: Side, back: bool = False) -> Callable[[float], Sequence[float]]:
    """A side as a function of 0 to 1."""
    return lambda t: tuple(side.at(np.array([side.length * (1.0 - t if back else t)]))[0].tolist())


def _counts(sides: list[Side], size: float) -> tuple[int, ...]:
    """Cells along the sides, as many along opposite ones."""
    need = [
        max(
            math.ceil(side.length / size - 1e-9),
            math.ceil(AROUND * side.turn(0.0, side.length) / (2.0 * math.pi)),
        )
        for side in sides
    ]
    pair = (max(need[0], need[2]), max(need[1], need[3]))
    return pair * 2
