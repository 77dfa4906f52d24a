"""Gaps, slips and their gradients at a state."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: States of a constraint, as the laws of the core number them.
OPEN, CLOSED, SLIPPING = 0, 1, 2
#: Fraction of its full area below which a node counts as uncovered.
COVERED = 1e-9


@dataclass
class Terms:
    """Gaps and slips of one pair at a state.

    Parameters
    ----------
    gap, slip, area : ndarray, shape (k,)
        Weighted gap and slip of each constraint [length^3], covered area [length^2].
    constraint, pair : ndarray of int, shape (m,)
        Constraint of each term, and candidate pair of the core.
    variables : ndarray of int, shape (m, v)
        ``3 node + component``, -1 for none.
    gap_gradient, slip_gradient : ndarray, shape (m, v)
    parts : tuple of ndarray, shape (k,)
        Gap and area of each node before neighbors share constraints.
    bare : Terms or None
        Unmodified gaps and areas, where a condition on rates has changed them.
    between : Terms or None
        Gradients along which tractions act that are those of an increment, not of its end.
    """

    gap: Floats
    slip: Floats
    area: Floats
    constraint: Ints
    pair: Ints
    variables: Ints
    gap_gradient: Floats
    slip_gradient: Floats
    parts: tuple[Floats, Floats]
    bare: Terms | None = None
    between: Terms | None = None

    @property
    def acting(self) -> Terms:
        """Terms along whose gradients the tractions act."""
        return self if self.between is None else self.between


__all__ = ["CLOSED", "COVERED", "OPEN", "SLIPPING", "Terms"]
