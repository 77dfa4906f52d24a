"""Elements that leave the structure in a step, or come back without strain."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import numpy as np

from corota.display import Brief
from corota.errors import InputError, Location, ModelError
from corota.mesh import selection

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.arrays import Ints
    from corota.mesh import Mesh


@dataclass(repr=False)
class ElementChange(Brief):
    """Cells that leave the structure with a step, or join it.

    Parameters
    ----------
    cells : str or array_like of int
        Cell set, or cell indices.
    add : bool
        Whether they join it.
    strain_free : bool
        Whether cells that join have no strain where their nodes are then.
    """

    cells: str | Ints
    add: bool = False
    strain_free: bool = True
    where: Location | None = field(default=None, compare=False, repr=False)

    def indices(self, mesh: Mesh) -> Ints:
        """Indices of the cells.

        Raises
        ------
        ModelError
            If there is no such set or cell.
        """
        if not isinstance(self.cells, str):
            return selection.indices(self.cells, "cell", mesh.n_cells, self.where)
        try:
            return np.asarray(mesh.cell_sets[mesh.set_name(self.cells, "cell")], np.int64)
        except InputError as error:
            raise ModelError(error.message, self.where) from None


class Changing(Protocol):
    """A step, of which only its changes matter here."""

    element_changes: list[ElementChange]


def groups_of_cells(mesh: Mesh, steps: Sequence[Changing]) -> Ints:
    """Number of the group of each cell, shape (n_cells,): cells of one group change alike."""
    group = np.zeros(mesh.n_cells, np.int64)
    for step in steps:
        for change in step.element_changes:
            inside = np.zeros(mesh.n_cells, np.int64)
            inside[change.indices(mesh)] = 1
            group = np.unique(2 * group + inside, return_inverse=True)[1].reshape(-1)
    return group
