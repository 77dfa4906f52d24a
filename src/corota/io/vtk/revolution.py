"""A section of a solid of revolution turned about its axis, for pictures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.mesh.kinds import KINDS
from corota.model.axisymmetry import is_axisymmetric
from corota.results.arrays import require

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh
    from corota.model.model import Model


#: Angle between two sections [degrees], at most.
STEP = 5.0
#: VTK types of a triangle and a quadrilateral that are swept: wedge and hexahedron.
SWEPT = {3: 13, 4: 12}


class Revolution:
    """Sections around the axis y, from the plane xy on.

    Parameters
    ----------
    angle : float
        Of the last section [degrees], up to 360.

    Raises
    ------
    InputError
        If the model is not axisymmetric, or the angle no part of a turn.
    """

    def __init__(self, model: Model, angle: float) -> None:
        if not is_axisymmetric(model):
            raise InputError("only axisymmetric models can be revolved")
        if not 0.0 < angle <= 360.0:
            raise InputError(f"revolve= is an angle in degrees, up to 360, not {angle:g}")
        self.turns = np.linspace(0.0, np.radians(angle), int(np.ceil(angle / STEP)) + 1)

    def vectors(self, values: Floats) -> Floats:
        """Vectors, or points, of the section (n, 3) in all sections, one after the other."""
        x, y = values[:, 0], values[:, 1]
        parts = [np.stack([x * np.cos(t), y, x * np.sin(t)], axis=1) for t in self.turns]
        return np.concatenate(parts)

    def repeat(self, values: NDArray[Any]) -> NDArray[Any]:
        """Numbers and tensors of the section, whose axes turn with it, in all sections."""
        return np.tile(values, (len(self.turns),) + (1,) * (values.ndim - 1))

    def grid(self, mesh: Mesh, section: Any) -> Any:
        """The solid as a ``pyvista.UnstructuredGrid`` with the arrays of the section's grid."""
        pyvista = require("pyvista", "view")
        cells: dict[int, list[Ints]] = {3: [], 4: []}
        owners: dict[int, list[Ints]] = {3: [], 4: []}
        for offset, block in zip(mesh.offsets, mesh.cells, strict=False):
            for part in KINDS[block.kind].pieces:
                cells[len(part)].append(block.nodes[:, part])
                owners[len(part)].append(np.arange(len(block)) + offset)
        chain, types, index = [], [], []
        for sides, flat in cells.items():
            if not flat:
                continue
            nodes, owner = np.concatenate(flat), np.concatenate(owners[sides])
            for k in range(len(self.turns) - 1):
                first = nodes + k * mesh.n_nodes
                size = np.full((len(nodes), 1), 2 * sides)
                chain.append(np.hstack([size, first, first + mesh.n_nodes]).ravel())
                types.append(np.full(len(nodes), SWEPT[sides], np.uint8))
                index.append(owner)
        points = self.vectors(np.asarray(section.points, dtype=np.float64))
        solid = pyvista.UnstructuredGrid(np.concatenate(chain), np.concatenate(types), points)
        for name, values in section.point_data.items():
            data = np.asarray(values)
            turned = data.ndim == 2 and data.shape[1] == 3
            solid.point_data[name] = self.vectors(data) if turned else self.repeat(data)
        owner = np.concatenate(index)
        for name, values in section.cell_data.items():
            solid.cell_data[name] = np.asarray(values)[owner]
        for name, values in section.field_data.items():
            solid.field_data[name] = values
        solid.set_active_scalars(None)
        return solid
