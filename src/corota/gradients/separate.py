"""Elements without common nodes: what each gives by its dofs, all elements at once."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import corota._core as _core
from corota.gradients.differences import all_derivatives
from corota.model import elements
from corota.model.blocks import core_input

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.equations import System
    from corota.arrays import Floats, Ints
    from corota.gradients.trajectory import Point

    Of = Callable[[dict[str, Any]], Floats]


def fields_of(core: Any, u: Floats, point: Point) -> list[dict[str, Any]]:
    """Fields at the points of all blocks."""
    found: list[dict[str, Any]] = core.recover(u, point.system.nlgeom)
    return found


#: Step over the size of an element, a strain, or of a member of the histories: smooth laws take the
#: first one; stresses have kinks at the border of flow, from which the second one keeps away.
STEP, BY_FLOW = 1e-4, 1e-6


class Separate:
    """Some elements of a block, each with nodes of its own.

    Parameters
    ----------
    system : System
        Its elements have the histories and temperatures of the state.
    index : int
        Block.
    rows : ndarray of int
        Elements in the block.
    u : ndarray, shape (n_dofs,)
        Displacement in global axes.
    """

    def __init__(self, system: System, index: int, rows: Ints, u: Floats) -> None:
        whole = system.blocks[index]
        block = whole.part(rows)
        self.nlgeom, self.rows = system.nlgeom, rows
        facts = elements.find(block.section.element)
        n, k, m = len(rows), facts.n_nodes, facts.dofs_per_node
        points = system.model.mesh.points[block.nodes].reshape(-1, 2)
        given = core_input(block, system.free.start)
        given["nodes"] = np.arange(n * k, dtype=np.uint32)
        self.core = _core.Problem(points, [given], np.zeros(0, np.uint8))
        self.dofs = system.start[block.nodes][..., None] + np.arange(m)
        self.u = u[self.dofs].ravel()
        self.members = 0
        histories = system.core.histories(False)[index]
        if len(histories):
            self.members = len(histories) // len(whole.cells)
            self.histories = histories.reshape(-1, self.members)[rows].copy()
            self.core.set_histories([self.histories.ravel()])
        system.free.give(index, rows, self.core)
        system.elements.give_clock(self.core)
        #: Step of a displacement, by element.
        size = np.ptp(system.model.mesh.points[block.nodes], axis=1).max(axis=1)
        self.step = float((BY_FLOW if self.members else STEP) * (size.min() or 1.0))

    def by_displacement(self, of: Of, out: Floats) -> None:
        """Add the derivatives by all dofs of a number of each element, to shape (n_dofs,)."""
        n, width = len(self.rows), self.u.size // len(self.rows)
        for k in range(width):

            def value(offset: float, k: int = k) -> Floats:
                moved = self.u.reshape(n, width).copy()
                moved[:, k] += offset
                return of(self.core.recover(moved.ravel(), self.nlgeom)[0])

            np.add.at(out, self.dofs.reshape(n, width)[:, k], all_derivatives(value, self.step))

    def by_history(self, of: Of, out: Floats) -> None:
        """Add the derivatives by the members of the histories, to those of the block."""
        into = out.reshape(-1, self.members)
        for k in range(self.members):
            size = float(np.abs(self.histories[:, k]).max(initial=0.0)) or BY_FLOW

            def value(offset: float, k: int = k) -> Floats:
                moved = self.histories.copy()
                moved[:, k] += offset
                self.core.set_histories([moved.ravel()])
                return of(self.core.recover(self.u, self.nlgeom)[0])

            into[self.rows, k] += all_derivatives(value, BY_FLOW * size)
        if self.members:
            self.core.set_histories([self.histories.ravel()])
