"""Forces at nodes that keep their direction, over the steps of an analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.load_history import LoadHistory
from corota.errors import ModelError

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.load_factors import LoadFactors
    from corota.arrays import Floats, Ints
    from corota.model.loads import NodalForce


class NodalForces:
    """The nodal forces that act now.

    Attributes
    ----------
    history : LoadHistory
        Of forces without an amplitude.
    timed : dict of int to ndarray, shape (n_dofs,)
        Forces at factor one, by the index of their amplitude.
    reached : ndarray, shape (n_dofs,)
        Forces at the end of the step before.
    """

    def __init__(self, system: NumberedModel, factors: LoadFactors) -> None:
        self.system, self.factors = system, factors
        self.history = LoadHistory(system.n_dofs)
        self.timed: dict[int, Floats] = {}
        self.reached = np.zeros(system.n_dofs)

    def carry(self, end: float) -> None:
        """Start the next step from the forces at step time `end`."""
        self.reached = self.at(end)
        runs_on, factors = self.factors.runs_on, self.factors.of_amplitudes(end)
        self.timed = {a: values for a, values in self.timed.items() if runs_on[a]}
        ended = self.reached.copy()
        for amplitude, values in self.timed.items():
            ended -= factors[amplitude] * values
        self.history.carry(ended, runs_on)

    def remove(self) -> None:
        """Remove all forces from those that earlier steps reached."""
        self.history.begin, self.timed = self.reached.copy(), {}
        self.history.remove()

    def set(self, items: list[NodalForce]) -> None:
        """Set the forces of a step in place of earlier ones at the same dofs.

        Items that follow their nodes replace earlier forces only. The others add up, each with its
        own amplitude.

        Raises
        ------
        ModelError
            If a node cannot carry the force.
        """
        places = [self._dofs(item) for item in items]
        self._replace(items, places)
        for item, dofs in zip(items, places, strict=True):
            if not item.follower:
                amplitude = self.factors.index(item.amplitude, item.where)
                target = self.history.end
                if amplitude:
                    target = self.timed.setdefault(amplitude, np.zeros(self.system.n_dofs))
                np.add.at(target, dofs, item.value if np.any(item.value) else 0.0)

    def at(self, step_time: float) -> Floats:
        """Forces at a time, shape (n_dofs,)."""
        factors = self.factors.of_amplitudes(step_time)
        force = self.factors.values(self.history, step_time, factors)
        for amplitude, values in self.timed.items():
            force += factors[amplitude] * values
        return force

    def _replace(self, items: list[NodalForce], places: list[Ints]) -> None:
        """Remove forces at dofs that the step redefines: at once if only amplitudes follow."""
        if not items:
            return
        named = np.zeros(self.system.n_dofs, bool)
        ramped = np.zeros(self.system.n_dofs, bool)
        for item, dofs in zip(items, places, strict=True):
            named[dofs] = True
            ramped[dofs] |= not item.amplitude
        for values in self.timed.values():
            values[named] = 0.0
        self.history.set(named, 0.0, 0)
        self.history.begin[named] = np.where(ramped[named], self.reached[named], 0.0)

    def _dofs(self, item: NodalForce) -> Ints:
        nodes = self.system.model.mesh.node_indices(item.nodes)
        dofs = self.system.dofs(nodes, item.dof)
        if not np.any(item.value):
            return dofs[dofs >= 0]  # zero ends a force; it needs no place for one
        if (dofs < 0).any():
            label = self.system.model.mesh.node_labels[nodes[dofs < 0][0]]
            what = (
                "has no drilling rotation for a moment; use OPT or Q4D there"
                if item.dof == 2
                else "belongs to no element and cannot carry a force"
            )
            raise ModelError(f"node {label} {what}", item.where)
        self.system.constraints.refuse_loaded(dofs, item.where)
        return dofs
