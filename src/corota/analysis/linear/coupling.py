"""What contact adds to the linearized equations."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.linear.triplets import Triplets
    from corota.arrays import Floats, Ints


@dataclass
class Coupling:
    """Contribution of contact to the linearized equations, in dofs and multipliers.

    Parameters
    ----------
    geometric_stiffness : Triplets
        Symmetric part at dofs, both triangles.
    skew : Triplets
        Skew part at dofs.
    rows : Triplets
        Dofs by multipliers: derivatives of the forces by the tractions, and transposed those
        of the constraints.
    follow : Triplets
        Dofs by multipliers without the transposed part.
    diagonal : ndarray, shape (n_multipliers,)
    force : ndarray, shape (n_dofs,)
        Added to the right-hand side of equilibrium, in global axes.
    near : callable
        Finds dofs and multipliers (-1 none) of pairs that may soon couple, where the pattern grows.
    """

    geometric_stiffness: Triplets
    skew: Triplets
    rows: Triplets
    follow: Triplets
    diagonal: Floats
    force: Floats
    near: Callable[[], tuple[Ints, Ints]]
