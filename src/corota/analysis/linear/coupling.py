"""What contact adds to the linearized equations."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.triplets import Triplets

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.arrays import Ints


class Coupling:
    """What contact adds to the linearized equations, in dofs and multipliers; nothing at first.

    Parameters
    ----------
    n_dofs, n : int
        Dofs and multipliers.
    near : callable
        Finds tables of dofs and multipliers (-1 none), a row for each candidate that may soon
        couple, where the pattern grows.

    Attributes
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
    diagonal, rhs : ndarray, shape (n,)
        Of the rows of the multipliers.
    force : ndarray, shape (n_dofs,)
        Of tractions that are known after the correction, in global axes: added to the right-hand
        side of equilibrium.
    expected : int
        Negative pivots that the constraints have.
    """

    def __init__(self, n_dofs: int, n: int, near: Callable[[], list[tuple[Ints, Ints]]]) -> None:
        self.near = near
        self.geometric_stiffness, self.skew = Triplets.join([]), Triplets.join([])
        self.rows, self.follow = Triplets.join([]), Triplets.join([])
        self.diagonal, self.rhs = np.ones(n), np.zeros(n)
        self.force, self.expected = np.zeros(n_dofs), 0
