"""Types of arrays, and replacements of NumPy functions that would load large modules."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Bools = NDArray[np.bool_]
    Complex = NDArray[np.complex128]
    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
else:
    # Annotations are not evaluated.
    Bools = Complex = Floats = Ints = np.ndarray


def skew(vectors: Floats) -> Floats:
    """Vectors rotated to the left by a right angle, shape (..., 2)."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)


def distinct(values: ArrayLike) -> NDArray[Any]:
    """Distinct values in ascending order.

    ``numpy.unique`` gives the same; its first call loads masked arrays, which takes as long as
    solving a small model.

    Parameters
    ----------
    values : array_like
        Without NaN; of any shape.

    Returns
    -------
    ndarray, shape (n,)

    Examples
    --------
    >>> distinct([[3, 1], [3, 2]])
    array([1, 2, 3])
    """
    found = np.array(values).ravel()
    found.sort()
    first = np.ones(len(found), dtype=bool)
    np.not_equal(found[1:], found[:-1], out=first[1:])
    return found[first]


class Lookup:
    """Indices of labels.

    Parameters
    ----------
    labels : ndarray of int, shape (n,)
        Of labels that occur more than once the first one counts.
    indices : ndarray of int, shape (n,), optional
        0 to n - 1 by default.
    """

    def __init__(self, labels: Ints, indices: Ints | None = None) -> None:
        indices = np.arange(len(labels)) if indices is None else indices
        if (np.diff(labels) < 0).any():
            order = np.argsort(labels, kind="stable")
            labels, indices = labels[order], indices[order]
        self._labels, self._indices = labels, indices
        # Labels without gaps are looked up by their distance from the first.
        self._dense = len(labels) > 0 and bool((np.diff(labels) == 1).all())

    def __call__(self, labels: Ints) -> Ints:
        """Index of each label, -1 where there is none."""
        if len(self._labels) == 0:
            return np.full(np.shape(labels), -1, dtype=np.int64)
        if self._dense:
            at = labels - self._labels[0]
            inside = (at >= 0) & (at < len(self._labels))
            return np.where(inside, self._indices[np.where(inside, at, 0)], -1)
        at = np.minimum(np.searchsorted(self._labels, labels), len(self._labels) - 1)
        return np.where(self._labels[at] == labels, self._indices[at], -1)
