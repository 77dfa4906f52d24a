"""Acceleration of an iteration whose tangent is an approximation."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.arrays import Floats

#: Corrections before the first one that is changed: an iteration that converges well ends earlier.
PLAIN = 5
#: Differences of corrections that are combined, at most.
DEPTH = 10
#: Share of the largest singular value below which differences count as dependent.
DEPENDENT = 1e-12


class Acceleration:
    """Combines the last corrections so that, were they linear in the unknowns, the next were zero.

    D. G. Anderson, *Journal of the ACM* 12, 1965, 547-560; for Newton's method with an approximate
    tangent N. N. Carlson & K. Miller, *SIAM Journal on Scientific Computing* 19, 1998, 728-765.

    Parameters
    ----------
    weights : ndarray, shape (n_dofs,)
        Make the unknowns comparable.
    """

    def __init__(self, weights: Floats) -> None:
        self.weights = weights
        self._points: list[Floats] = []
        self._corrections: list[Floats] = []

    def improve(self, u: Floats, du: Floats) -> Floats:
        """The correction to take at `u` in place of `du`, which the tangent gives there."""
        self._points = [*self._points[-DEPTH:], u.copy()]
        self._corrections = [*self._corrections[-DEPTH:], du]
        if len(self._points) <= PLAIN:
            return du
        moved = np.diff(self._points, axis=0).T
        changed = np.diff(self._corrections, axis=0).T
        rows = self.weights[:, None]
        share, *_ = np.linalg.lstsq(rows * changed, self.weights * du, rcond=DEPENDENT)
        out: Floats = du - (moved + changed) @ share
        return out
