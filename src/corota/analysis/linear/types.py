"""Types of arrays and sparse matrices, for annotations."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    import scipy.sparse as sp
    from numpy.typing import NDArray

    #: Kind of numbers of an array that is taken apart only.
    Kind = TypeVar("Kind", bound=np.generic)
    #: What processes send to one another.
    Item = TypeVar("Item")
    #: Integers of any width.
    Index = NDArray[np.integer[Any]]
    #: Compressed columns or rows.
    Sparse = sp.csc_array[np.float64] | sp.csr_array[np.float64]
