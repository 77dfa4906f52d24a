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
