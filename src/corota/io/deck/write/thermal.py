"""Temperatures, expansion and initial stress of a model as cards of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import UnsupportedError
from corota.model.materials import Expansion, Material

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike

    from corota.arrays import Ints
    from corota.io.deck.write.text import Writer
    from corota.model.model import Model


def expansion_cards(material: Material) -> str:
    """The card of a material's expansion; empty without one."""
    found = Expansion.of(material.expansion)
    if not found:
        return ""
    ortho = any(not isinstance(a, int | float) for a in found.alpha)
    text = f"*EXPANSION, TYPE={'ORTHO' if ortho else 'ISO'}, ZERO={found.zero!r}\n"
    table = found.temperature or (0.0,)
    for alpha, at in zip(found.alpha, table, strict=True):
        values = [float(v) for v in np.broadcast_to(alpha, 3 if ortho else 1)]
        text += ", ".join(f"{v!r}" for v in [*values, float(at)]) + "\n"
    return text


def temperatures(names: Writer, nodes: str | Ints, value: ArrayLike) -> str:
    """Lines of temperatures."""
    every = np.arange(names.mesh.n_nodes)
    given = np.asarray(value, dtype=np.float64)
    if given.ndim == 0:
        where = every if isinstance(nodes, str) and not nodes else nodes
        return "".join(f"{target}, {float(given)!r}\n" for target in names.nodes(where))
    indices = names.mesh.nodes_of(nodes) if isinstance(nodes, str) and nodes else nodes
    labels = names.mesh.node_labels[every if isinstance(indices, str) else indices]
    rows = zip(labels.tolist(), given.tolist(), strict=True)
    return "".join(f"{label}, {v!r}\n" for label, v in rows)


def initial_cards(names: Writer, model: Model) -> Iterator[str]:
    """Cards of initial temperatures and stresses."""
    for item in model.initial_temperatures:
        yield "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n"
        yield temperatures(names, item.nodes, item.value)
    for stress in model.initial_stresses:
        cells = stress.cells if len(stress.cells) else np.arange(model.mesh.n_cells)
        values = [np.asarray(v, dtype=np.float64) for v in stress.value]
        if any(v.ndim > 1 and v.shape[1] > 1 for v in values):
            raise UnsupportedError(
                "an initial stress that varies within an element cannot be written to a deck: "
                "give each element one, or keep the model in Python"
            )
        yield "*INITIAL CONDITIONS, TYPE=STRESS\n"
        if all(v.ndim == 0 for v in values):
            numbers = ", ".join(f"{float(v)!r}" for v in values)
            yield f"{names.cell_set(cells)}, {numbers}\n"
            continue
        if isinstance(cells, str):
            cells = model.mesh.cell_sets[cells]
        rows = np.stack([np.broadcast_to(v.reshape(-1), len(cells)) for v in values], axis=1)
        for label, row in zip(model.mesh.cell_labels[cells].tolist(), rows.tolist(), strict=True):
            yield f"{label}, " + ", ".join(f"{v!r}" for v in row) + "\n"
