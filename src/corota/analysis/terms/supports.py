"""Prescribed displacements over the steps of an analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.load_history import LoadHistory
from corota.errors import ModelError
from corota.model.dofs import DOFS
from corota.model.loads import Fixed, check_supports

if TYPE_CHECKING:
    from collections.abc import Iterable

    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.load_factors import LoadFactors
    from corota.arrays import Bools, Floats, Ints


class Supports:
    """The supports that act now.

    Attributes
    ----------
    constrained : ndarray of bool, shape (n_dofs,)
        Dofs with a prescribed value.
    notes : list of str
        Notes on the step.
    """

    def __init__(self, system: NumberedModel, factors: LoadFactors) -> None:
        self.system, self.factors = system, factors
        self.constrained = np.zeros(system.n_dofs, bool)
        self.history = LoadHistory(system.n_dofs)
        self.notes: list[str] = []
        #: Supports that fix or move these dofs, in the order in which they were given.
        self.acting: list[Fixed] = []
        self._guide()

    # -- steps -------------------------------------------------------------------------

    def carry(self, u: Floats) -> None:
        """Start the next step from displacement `u`, except where an amplitude continues."""
        self.history.carry(u, self.factors.runs_on)

    def release(self) -> None:
        """Release all dofs."""
        self.acting = []
        self.constrained[:] = False
        self.history.amplitude[:] = 0
        self._guide()

    def _guide(self) -> None:
        """Keep nodes of a ring on its axis."""
        for nodes, dof in self.system.guided:
            dofs = self.system.dofs(nodes, dof)
            self.constrained[dofs[dofs >= 0]] = True

    def add(self, items: Iterable[Fixed], once: bool = False) -> None:
        """Add supports.

        Parameters
        ----------
        once : bool
            Refuse a dof that is given two values; the same one twice is one. Of decks the later
            value counts, with a note.

        Raises
        ------
        ModelError
            If a node has no such dof, a constraint determines it, there is nothing to release, or
            there are two values: naming the node, the direction and both.
        """
        items = list(items)
        check_supports(items)
        nodes = [self.system.model.mesh.node_indices(item.nodes) for item in items]
        if once:
            self._refuse_conflicts(items, nodes)
        runs = groupby(range(len(items)), lambda k: items[k].place if items[k].free else "")
        for _, group in runs:
            run = list(group)
            first, end = run[0], run[-1] + 1
            if items[first].free:
                self._release(items[first:end])
            else:
                self._fix(items[first:end], nodes[first:end])

    def _dofs(self, items: list[Fixed], nodes: list[Ints]) -> tuple[Ints, Ints, Ints]:
        """Number of the support, node and dof, -1 for none, of all nodes of some supports."""
        number = np.repeat(np.arange(len(items)), [len(some) for some in nodes])
        every = np.concatenate(nodes)
        return number, every, self.system.dofs(every, np.array([i.dof for i in items])[number])

    def _fix(self, items: list[Fixed], nodes: list[Ints]) -> None:
        self.acting += items
        number, every, dofs = self._dofs(items, nodes)
        for k in sorted(set(number[dofs < 0].tolist())):
            item, missing = items[k], (number == k) & (dofs < 0)
            # A rotation may be given for nodes without one, as with dofs 1-6 in decks.
            if item.dof == 2 and item.value != 0.0:
                label = self.system.model.mesh.node_labels[every[missing][0]]
                raise ModelError(
                    f"node {label} has no drilling rotation to prescribe; use OPT or Q4D there",
                    item.where,
                )
            if item.dof == 2 and item.where is None and missing.sum() == len(nodes[k]):
                from corota.model.rotations import without_rotation

                self.notes.append(without_rotation(self.system.model.mesh, item))
        number, dofs = number[dofs >= 0], dofs[dofs >= 0]
        for k in sorted(set(number[self.system.constraints.place[dofs] >= 0].tolist())):
            self.system.constraints.refuse_constrained(dofs[number == k], items[k].where)
        if self.system.guided:
            for k, item in enumerate(items):
                self._refuse_off_axis(item, dofs[number == k])
        value = np.array([item.value for item in items])[number]
        keep = np.array([item.keep for item in items])[number]
        index = np.array([self.factors.index(item.amplitude, item.where) for item in items])
        self.constrained[dofs] = True
        self.history.set(dofs, np.where(keep, self.history.begin[dofs], value), index[number])

    def hold(self, dofs: Bools, u: Floats) -> None:
        """Let dofs stay at a displacement, shape (n_dofs,)."""
        places = np.flatnonzero(dofs)
        self.constrained[places] = True
        self.history.set(places, u[places], 0)

    def _release(self, items: list[Fixed]) -> None:
        ended: list[Fixed] = []
        stay: list[Fixed] = []
        for support in self.acting:
            ends = any(support.same_dofs(item) for item in items)
            (ended if ends else stay).append(support)
        if not ended:
            where, which = items[0].place, ", ".join(list(DOFS)[item.dof] for item in items)
            places = ", ".join(dict.fromkeys(s.place for s in self.acting)) or "none"
            raise ModelError(
                f"no support at {where} in {which} when the step begins, so there is none to "
                f"release; supports are at: {places}",
                items[0].where,
            )
        self.acting = stay
        freed = np.zeros(len(self.constrained), bool)
        for supports, free in ((ended, True), (self.acting, False)):
            for support in supports:
                nodes = self.system.model.mesh.node_indices(support.nodes)
                dofs = self.system.dofs(nodes, support.dof)
                freed[dofs[dofs >= 0]] = free
        self.constrained[freed] = False
        self.history.amplitude[freed] = 0
        self._guide()

    def _refuse_off_axis(self, item: Fixed, dofs: Ints) -> None:
        """Refuse to move what is guided along the axis of a ring."""
        if item.value == 0.0:
            return
        for nodes, dof in self.system.guided:
            if dof == item.dof and (hit := np.isin(dofs, self.system.dofs(nodes, dof))).any():
                at = self.system.node_of_dof[dofs[hit][0]]
                label = self.system.model.mesh.node_labels[at]
                raise ModelError(
                    f"node {label} lies on the axis of an axisymmetric model, or moves a body "
                    f"without deformation: its {list(DOFS)[dof]} is zero, not "
                    f"{item.value:g}; an interference begins as an overlap, with start='ramp'",
                    item.where,
                )

    def _refuse_conflicts(self, items: list[Fixed], nodes: list[Ints]) -> None:
        if not items:
            return
        dofs = self._dofs(items, nodes)[2]
        dofs = np.sort(dofs[dofs >= 0])
        if (dofs[1:] != dofs[:-1]).all():
            return
        n = self.system.n_dofs
        value, amplitude, given = np.zeros(n), np.zeros(n, np.int64), np.zeros(n, bool)
        for item, places in zip(items, nodes, strict=True):
            dofs = self.system.dofs(places, item.dof)
            places, dofs = places[dofs >= 0], dofs[dofs >= 0]
            if item.free:
                given[dofs] = False
                continue
            index = self.factors.index(item.amplitude, item.where)
            given_before = given[dofs] & (not item.keep)
            twice = given_before & ((value[dofs] != item.value) | (amplitude[dofs] != index))
            if twice.any():
                at = int(np.flatnonzero(twice)[0])
                label = self.system.model.mesh.node_labels[places[at]]
                name = list(DOFS)[item.dof]
                other, own = value[dofs[at]], item.value
                what = f"two values, {other:g} and {own:g}" if other != own else "two amplitudes"
                dof = f"{name} (dof {(1, 2, 6)[item.dof]})"
                if item.where is not None:  # a deck: as CalculiX does, but with a note
                    self.notes.append(
                        f"{item.where}: node {label} is given {what}, in {dof}; the later one is "
                        "used"
                    )
                    break
                raise ModelError(
                    f"node {label} is given {what}, in {dof}: leave "
                    "one of the supports out, or put the later one into a step of its own",
                    item.where,
                )
            value[dofs], amplitude[dofs], given[dofs] = item.value, index, True

    # -- values ------------------------------------------------------------------------

    def at(self, step_time: float, u: Floats) -> Floats:
        """Values at prescribed dofs, and `u` elsewhere; shape (n_dofs,)."""
        history, factors = self.history, self.factors
        values = factors.values(history, step_time)
        if len(factors.names) > 1 and factors.moves_on.any():
            on = factors.moves_on[history.amplitude]
            begun = factors.of_amplitudes(0.0)[history.amplitude[on]]
            values[on] += history.begin[on] - history.end[on] * begun
        return np.where(self.constrained, values, u)

    def change(self) -> Floats:
        """Change per unit of load factor, 0 at free dofs; shape (n_dofs,)."""
        return np.where(self.constrained, self.history.end - self.history.begin, 0.0)

    def rates(self, step_time: float, window: float) -> tuple[Floats, Floats]:
        """Velocity and acceleration of prescribed dofs at a time, 0 elsewhere; shapes (n_dofs,).

        Amplitudes are seen over a window (half its width), which is the increment: what
        changes faster than that is a pulse of the right impulse.
        """
        constrained, history, period = self.constrained, self.history, self.factors.period
        v, a = np.zeros(len(constrained)), np.zeros(len(constrained))
        if self.factors.ramp:
            v = self.change() / period
        window = min(window, period / 3.0)
        for index in self.amplitudes():
            table, start = self.factors.table(index)
            rate, growth = table.derivatives(start + step_time, window, start, start + period)
            named = constrained & (history.amplitude == index)
            v[named], a[named] = history.end[named] * rate, history.end[named] * growth
        return v, a

    def kinks(self) -> list[tuple[str, float]]:
        """Amplitudes whose rate jumps within the step, with the first step time."""
        out = []
        for index in self.amplitudes():
            table, start = self.factors.table(index)
            times = table.kinks() - start
            inside = times[(times > 0.0) & (times < self.factors.period * (1.0 - 1e-9))]
            if len(inside):
                out.append((self.factors.names[index], float(inside[0])))
        return out

    def amplitudes(self) -> list[int]:
        """Indices of the amplitudes that move supports."""
        used = np.bincount(self.history.amplitude[self.constrained])
        return [i for i, count in enumerate(used.tolist()) if i and count]
