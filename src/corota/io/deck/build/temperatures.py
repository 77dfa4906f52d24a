"""Temperatures of a deck: where they have no effect, and where the whole model has one."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.deck import Deck


def drop_temperatures(deck: Deck) -> None:
    """Leave out temperatures where no material responds to them."""
    if any(m.expansion != 0.0 or m.follows_temperature for m in deck.materials.values()):
        return
    given = [d for step in deck.steps for d in step.loads if d.kind == "temperature"]
    if given:
        deck.note(f"{given[0].row.where}: temperatures have no effect: no material has *EXPANSION")
    for step in deck.steps:
        step.loads = [d for d in step.loads if d.kind != "temperature"]
    deck.initial = [i for i in deck.initial if i.draft.kind != "initial temperature"]


def constant_temperature(targets: Targets) -> float | None:
    """Temperature of the whole model in all steps; ``None`` where there are several."""
    deck = targets.deck
    if not any(m.follows_temperature for m in deck.materials.values()):
        return 0.0
    if any(d.kind == "temperature" for step in deck.steps for d in step.loads):
        return None
    found = np.zeros(targets.mesh.n_nodes)
    for item in deck.initial:
        nodes = targets.nodes(item.draft) if item.draft.kind == "initial temperature" else None
        if nodes is not None:
            found[targets.mesh.node_indices(nodes)] = item.draft.value[0]
    cells = [block.nodes.ravel() for block in targets.mesh.cells]
    mine = found[np.concatenate([np.zeros(0, np.int64), *cells])]
    return float(mine[0]) if len(mine) and (mine == mine[0]).all() else None
