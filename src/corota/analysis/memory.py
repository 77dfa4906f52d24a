# SPDX-License-Identifier: BSD-3-Clause
"""Memory of a model, asked for before it is laid out.

What a failed allocation of the core does cannot be caught; so the large pieces are estimated
first. The factor is judged by the solver, which knows its size from the order of elimination.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from corota import _core
from corota.model import elements

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.analysis.blocks import BlockOfCells

#: Bytes for each entry of the element matrices (measured: 4.3 to 6.0), and for each node.
ENTRY, NODE = 7.0, 700.0


def require_model(blocks: Sequence[BlockOfCells], n_nodes: int) -> None:
    """Refuse a model that is too large for what is free.

    Raises
    ------
    ResourceError
        With what it takes and what there is.
    """
    entries = 0.0
    for b in blocks:
        dofs = b.nodes.shape[1] * elements.find(b.section.element).dofs_per_node
        entries += len(b.nodes) * float(dofs) ** 2
    bytes_ = ENTRY * entries + NODE * n_nodes
    count = sum(len(b.nodes) for b in blocks)
    _core.require_memory(bytes_, f"a model of {count} elements and {n_nodes} nodes")
