"""What the equations are at a state: forces, tangent, linearized constraints."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from corota.analysis.constraints.none import IDENTITY

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from corota.analysis.constraints.elimination import LinearizedConstraints

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


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
        The constraints linearised at the state.
    added : ndarray, shape (n_dofs,), or None
        What damping added to the diagonal of the tangent: no stiffness.
    heft, momentum : float
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
    heft: float = 0.0
    momentum: float = 0.0

    @property
    def residual(self) -> Floats:
        """Internal minus external force, shape (n_dofs,)."""
        return self.internal - self.external

    @property
    def reaction(self) -> Floats:
        """Residual with what dependent dofs pass on to their masters, shape (n_dofs,)."""
        return self.link.gather(self.residual)


__all__ = ["Evaluation"]
