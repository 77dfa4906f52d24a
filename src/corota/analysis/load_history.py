"""Prescribed values over a step."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.arrays import Bools, Floats, Ints


class LoadHistory:
    """Numbers over a step: from `begin` to `end`, or `end` times an amplitude.

    Attributes
    ----------
    begin, end : ndarray, shape (n,)
    amplitude : ndarray of int, shape (n,)
        Index into the names of amplitudes; 0 for none.
    removed : ndarray of bool, shape (n,)
        Whether the step removed the value instead of giving a new one.
    """

    def __init__(self, n: int) -> None:
        self.begin = np.zeros(n)
        self.end = np.zeros(n)
        self.amplitude = np.zeros(n, np.int64)
        self.removed = np.zeros(n, bool)

    def at(self, ramp: float, removal: float, factors: Floats) -> Floats:
        """Values where loads, removals and amplitudes have these shares and factors."""
        some = removal != ramp and self.removed.any()
        share = np.where(self.removed, removal, ramp) if some else ramp
        out: Floats = self.begin + share * (self.end - self.begin)
        if len(factors) > 1:
            named = self.amplitude.nonzero()[0]
            out[named] = self.end[named] * factors[self.amplitude[named]]
        return out

    def carry(self, reached: Floats, runs_on: Bools) -> None:
        """Start the next step from `reached`, except where the amplitude continues.

        Parameters
        ----------
        reached : ndarray, shape (n,)
        runs_on : ndarray of bool, shape (n_names,)
            Amplitudes that count total time.
        """
        kept = runs_on[self.amplitude]
        self.begin = reached.copy()
        self.end = np.where(kept, self.end, reached)
        self.amplitude = np.where(kept, self.amplitude, 0)
        self.removed[:] = False

    def remove(self, value: Floats | float = 0.0) -> None:
        """Remove all values: they change to `value`."""
        self.end[:] = value
        self.amplitude[:] = 0
        self.removed[:] = True

    def set(
        self, where: NDArray[np.int64 | np.bool_], value: Floats | float, amplitude: Ints | int
    ) -> None:
        """Give new numbers."""
        self.end[where] = value
        self.amplitude[where] = amplitude
        self.removed[where] = False
