"""Columns of the saddle-point system from terms of contact."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.triplets import Triplets

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


def border(where: Ints, column: Ints, gradient: Floats, rows: NDArray[np.bool_]) -> Triplets:
    """Gradients of some terms as columns."""
    where, gradient = where[rows], gradient[rows]
    columns = np.repeat(column[rows], where.shape[1])
    flat, values = where.ravel(), gradient.ravel()
    keep = (flat >= 0) & (values != 0.0)
    return Triplets(flat[keep], columns[keep], values[keep])


def stacked(parts: list[tuple[Ints, Ints]]) -> tuple[Ints, Ints]:
    """Rows of several pairs below each other, filled with -1."""
    out = []
    for which in (0, 1):
        tables = [p[which] for p in parts if len(p[which])]
        width = max((t.shape[1] for t in tables), default=0)
        full = [np.pad(t, ((0, 0), (0, width - t.shape[1])), constant_values=-1) for t in tables]
        out.append(np.concatenate(full) if full else np.zeros((0, 0), np.int64))
    return out[0], out[1]


__all__ = ["border", "stacked"]
