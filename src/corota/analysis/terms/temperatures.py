"""Temperatures of nodes over the steps of an analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.load_history import LoadHistory
from corota.arrays import Floats, distinct
from corota.errors import ModelError

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.load_factors import LoadFactors
    from corota.model.loads import Temperature


class Temperatures:
    """The absolute temperatures of the nodes, initially those of the model."""

    def __init__(self, system: NumberedModel, factors: LoadFactors) -> None:
        self.system, self.factors = system, factors
        self.history = LoadHistory(len(system.free.start))
        self.begin_at(system.free.start)

    def begin_at(self, values: Floats) -> None:
        """Let the nodes have these temperatures, shape (n_nodes,)."""
        self.history.begin[:] = self.history.end[:] = values

    def carry(self, end: float) -> None:
        """Start the next step from the temperatures at step time `end`."""
        self.history.carry(self.at(end), self.factors.runs_on)

    def remove(self) -> None:
        """Let the temperatures return to the initial ones."""
        self.history.remove(self.system.free.start)

    def set(self, item: Temperature) -> None:
        """Give nodes new temperatures.

        Raises
        ------
        ModelError
            If no material responds to them, or their number does not fit.
        """
        self.system.free.require_response(item.where)
        amplitude = self.factors.index(item.amplitude, item.where)
        every = isinstance(item.nodes, str) and not item.nodes
        mesh = self.system.model.mesh
        nodes = np.arange(len(self.history.end)) if every else mesh.node_indices(item.nodes)
        try:
            self.history.set(nodes, item.value, amplitude)
        except ValueError:
            raise ModelError(
                f"{np.size(item.value)} temperatures for {len(nodes)} nodes", item.where
            ) from None

    def at(self, step_time: float) -> Floats:
        """Temperatures of the nodes, shape (n_nodes,)."""
        return self.factors.values(self.history, step_time)

    @property
    def change(self) -> Floats:
        """Change per unit of load factor, shape (n_nodes,)."""
        return self.history.end - self.history.begin

    def amplitudes(self) -> list[int]:
        """Indices of the amplitudes that temperatures follow."""
        return [int(i) for i in distinct(self.history.amplitude) if i]

    def vary(self) -> bool:
        """Whether temperatures change in the step."""
        period = self.factors.period
        times = {0.0, period}
        for index in self.amplitudes():
            table, start = self.factors.table(index)
            own = table.time - start
            times |= set(own[(own > 0.0) & (own < period)].tolist())
        return any(not np.array_equal(self.at(t), self.history.begin) for t in times)
