"""The equations at a state: forces, tangent, linearized constraints."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.constraints.none import IDENTITY
from corota.analysis.terms.contact.gaps import ContactState

if TYPE_CHECKING:
    from corota.analysis.constraints.elimination import LinearizedConstraints
    from corota.arrays import Floats, Ints


@dataclass
class Evaluation:
    """Residual and tangent at a state.

    Parameters
    ----------
    internal, external : ndarray, shape (n_dofs,)
        Force and moment.
    scale : ndarray, shape (n_dofs,)
        Sum of absolute element forces.
    values : ndarray, shape (nnz,)
        Tangent of the internal force, upper triangle, columns.
    load_stiffness : tuple of ndarray or None
        Triplets (row, column, value) of the derivative of the external force.
    link : LinearizedConstraints
        The constraints linearized at the state.
    added : ndarray, shape (n_dofs,), or None
        Artificial stiffness on the diagonal of the tangent.
    inertia, damping : ndarray, shape (n_dofs,), or None
        Forces of inertia and damping, added to those of the displacement.
    contact_state : ContactState
        Gaps and slips of pairs and ties: the equations of their multipliers.
    inertial_stiffness, momentum : float
        In motion: inertia per displacement [force/length], and the largest of the terms of
        which the acceleration is a difference [force].
    """

    internal: Floats
    external: Floats
    scale: Floats
    values: Floats
    load_stiffness: tuple[Ints, Ints, Floats] | None = None
    link: LinearizedConstraints = IDENTITY
    added: Floats | None = None
    inertia: Floats | None = None
    damping: Floats | None = None
    contact_state: ContactState = field(default_factory=ContactState)
    inertial_stiffness: float = 0.0
    momentum: float = 0.0

    @property
    def residual(self) -> Floats:
        """Internal minus external force, shape (n_dofs,)."""
        return self.internal - self.external

    def add_damping(self, force: Floats) -> None:
        """Add a force that dissipates energy: along the velocity, on the side of the stresses."""
        self.damping = force if self.damping is None else self.damping + force

    def add_spring(self, stiffness: Floats, moved: Floats) -> None:
        """Add artificial springs at the dofs, shapes (n_dofs,)."""
        self.internal = self.internal + stiffness * moved
        self.added = stiffness if self.added is None else self.added + stiffness

    def weigh(self, share: float) -> None:
        """Multiply the tangent, in place."""
        self.values *= share
        if self.load_stiffness is not None:
            rows, columns, values = self.load_stiffness
            self.load_stiffness = (rows, columns, share * values)

    def add_load_stiffness(self, rows: Ints, columns: Ints, values: Floats) -> None:
        """Add triplets to the derivative of the external force."""
        if self.load_stiffness is not None:
            i, j, before = self.load_stiffness
            rows, columns = np.concatenate([i, rows]), np.concatenate([j, columns])
            values = np.concatenate([before, values])
        self.load_stiffness = (rows, columns, values)

    @property
    def reaction(self) -> Floats:
        """Residual with what dependent dofs pass on to their masters, shape (n_dofs,)."""
        return self.link.gather(self.residual)
