# SPDX-License-Identifier: BSD-3-Clause
"""Memory of a model, checked before it is allocated.

A failed allocation in the core cannot be caught, so the large arrays are estimated
first. The solver checks the factor, whose size follows from the ordering.
"""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import corota._core as _core
from corota.model import elements

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.blocks import BlockOfCells

#: Bytes for each entry of the element matrices (measured: 4.3 to 6.0), and for each node.
ENTRY, NODE = 7.0, 700.0
#: A model of fewer bytes is not checked: the check takes as long as an iteration of such a model.
SMALL = 4e6
#: Addresses of SciPy's libraries and of each thread of its BLAS, which waits for ever without.
LIBRARIES, BLAS_THREAD = 100e6, 34e6


def require_libraries() -> None:
    """Refuse an analysis where the libraries that it may load find no room.

    Raises
    ------
    ResourceError
        With the memory needed and available.
    """
    if "scipy.linalg" not in sys.modules:
        given = os.environ.get("OPENBLAS_NUM_THREADS", "")
        threads = int(given) if given.isdecimal() else os.cpu_count() or 1
        _core.require_memory(LIBRARIES + BLAS_THREAD * threads, "the libraries of an analysis")


def require_model(blocks: Sequence[BlockOfCells], n_nodes: int) -> None:
    """Refuse a model that exceeds the available memory.

    Raises
    ------
    ResourceError
        With the memory needed and available.
    """
    entries = 0.0
    for b in blocks:
        dofs = b.nodes.shape[1] * elements.find(b.section.element).dofs_per_node
        entries += len(b.nodes) * float(dofs) ** 2
    bytes_ = ENTRY * entries + NODE * n_nodes
    if bytes_ < SMALL:
        return
    count = sum(len(b.nodes) for b in blocks)
    _core.require_memory(bytes_, f"a model of {count} elements and {n_nodes} nodes")
