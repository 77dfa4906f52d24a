"""Elements that leave the structure and join it again over the steps of an analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.constraints.elimination import Constraints
from corota.errors import ModelError, UnsupportedError
from corota.model.element_changes import ElementChange
from corota.model.user_material import UserMaterial

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats, Ints
    from corota.model.steps import Step


#: Procedures that may change the structure.
CHANGING = ("static", "dynamic")


class ElementChanges:
    """Which elements are in the structure.

    Nodes that no element has any more stay where they are.

    Attributes
    ----------
    removed : ndarray of bool, shape (n_cells,)
    held : ndarray of bool, shape (n_dofs,)
        Dofs of nodes without an element, which no support of the model constrains.
    """

    def __init__(self, system: NumberedModel) -> None:
        self.system = system
        self.removed = np.zeros(system.model.mesh.n_cells, bool)
        self.held = np.zeros(system.n_dofs, bool)

    def check(self, step: Step) -> None:
        """Refuse what the change of a step cannot be computed with."""
        if not step.element_changes:
            return
        system, where = self.system, step.element_changes[0].where
        if step.procedure not in CHANGING or getattr(step, "scheme", "") == "central_difference":
            raise UnsupportedError(
                "elements are removed and added in static and implicit dynamic steps", where
            )
        if system.communicator.size > 1:
            raise UnsupportedError("elements are removed and added by one process only", where)
        for block in system.blocks:
            if isinstance(block.section.material, UserMaterial):
                raise UnsupportedError("elements with a law in Python cannot be removed", where)
        mesh = system.model.mesh
        changing = np.concatenate([item.indices(mesh) for item in step.element_changes])
        for pair in system.model.contacts:
            sides = [s for s in (pair.slave, pair.master) if isinstance(s, str)]
            cells = [mesh.edge_sets[s][:, 0] for s in sides if s in mesh.edge_sets]
            if pair.steps is None and any(np.isin(c, changing).any() for c in cells):
                raise UnsupportedError(
                    f"contact {pair.name!r} is on elements that leave or join: let the pair end "
                    "and begin too (steps=, *MODEL CHANGE, TYPE=CONTACT PAIR)",
                    where,
                )
        if system.free.responds and any(c.add and c.strain_free for c in step.element_changes):
            raise UnsupportedError(
                "elements that join without strain cannot have thermal strain or initial stress: "
                "give them a material of their own without expansion",
                where,
            )

    def change(self, step: Step, u: Floats) -> None:
        """Remove and add the elements of a step.

        Parameters
        ----------
        u : ndarray, shape (n_dofs,)
            Displacement at the start of the step.
        """
        mesh = self.system.model.mesh
        joined: list[tuple[ElementChange, Ints]] = []
        for item in step.element_changes:
            cells = item.indices(mesh)
            wrong = cells[self.removed[cells] != item.add]
            if len(wrong):
                label, state = mesh.cell_labels[wrong[0]], "is in" if item.add else "is not in"
                raise ModelError(f"element {label} {state} the structure already", item.where)
            self.removed[cells] = not item.add
            if item.add and item.strain_free:
                joined.append((item, cells))
        system = self.system
        here = np.ascontiguousarray(system.in_space(u))
        for number, block in enumerate(system.own_blocks):
            if any(np.isin(block.cells, cells).all() for _, cells in joined):
                system.core.renew(number, here)
        out = [bool(self.removed[block.cells[0]]) for block in system.own_blocks]
        system.core.set_removed(out if any(out) else [])

    def bare(self) -> Bools:
        """Dofs of nodes that had elements and have none any more, but those of constraints."""
        system = self.system
        had, has = np.zeros((2, system.model.mesh.n_nodes), bool)
        for block in system.blocks:
            had[block.nodes] = True
            if not self.removed[block.cells[0]]:
                has[block.nodes] = True
        bare: Bools = (had & ~has)[system.node_of_dof]
        if isinstance(system.constraints, Constraints):
            free = np.zeros(system.n_dofs, bool)
            free[system.constraints.free] = True
            bare = bare & free
        return bare

    def force(self, u: Floats) -> Floats:
        """Force of the elements at a displacement, shape (n_dofs,)."""
        system = self.system
        force, scale = np.zeros((2, system.n_dofs))
        here = np.ascontiguousarray(system.in_space(u))
        system.core.assemble(here, system.nlgeom, force, scale, np.empty(0), system.about_linear)
        return system.at_nodes(force)
