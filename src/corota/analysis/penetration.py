"""A fluid that presses on a chain of edges as far as contact lets it in."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import corota._core as _core
from corota.analysis.distributed_forces import Distribution, LoadSum, evaluate
from corota.errors import Location, ModelError

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats, Ints


#: Relative difference of pressures that is rounding.
SAME = 1e-9


class Edges(NamedTuple):
    """Edges under a fluid.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Ends and middle, which is the first end on straight edges.
    thickness : ndarray, shape (n, 3)
        Of these nodes.
    bulge : ndarray, shape (n,)
        Share of the drilling rotations in the shape of the edge.
    """

    nodes: Ints
    thickness: Floats
    bulge: Floats


class PenetratingPressure(Distribution):
    """A fluid that follows a chain of edges from its start; the scale is its pressure.

    The fluid passes from a node along an edge if contact presses there, in the mean of both ends,
    no harder than the fluid. It acts on edges that it has passed. Within an increment it advances
    only: at once along surfaces that are apart, and by one edge before the next equilibrium where
    they press, because each edge changes the contact pressure of the next. Between increments it
    draws back where surfaces press again.

    Parameters
    ----------
    chain : Edges
        Of the slave surface of contact, and of the surface that leads there.
    opposite : Edges or None
        Edges of the other body, which the fluid reaches where the nearest node of the chain is wet.
    start : ndarray of int, shape (n,)
        Nodes that are in the fluid.
    critical : float or None
        Contact pressure up to which the fluid passes; by default that of the fluid.
    where : Location or None
        Of the load, for messages.

    Raises
    ------
    ModelError
        If no start is on the chain.
    """

    def __init__(
        self,
        system: NumberedModel,
        chain: Edges,
        opposite: Edges | None,
        start: Ints,
        critical: float | None,
        where: Location | None,
    ) -> None:
        self.system, self.chain, self.opposite = system, chain, opposite
        self.critical = critical
        n = len(system.per_node)
        self.start = np.zeros(n, bool)
        self.start[start] = True
        self.on_chain = np.zeros(n, bool)
        self.on_chain[chain.nodes[:, :2]] = True
        self.start &= self.on_chain
        if not self.start.any():
            raise ModelError(
                "a fluid that penetrates starts at a node of its edges: none of the start is an "
                "end of one of them",
                where,
            )
        x = system.model.mesh.points
        self.length = np.hypot(*(x[chain.nodes[:, 1]] - x[chain.nodes[:, 0]]).T)
        #: Edges of the chain where the fluid is; those of the committed state, and its pressure.
        self.wet = np.zeros(len(chain.nodes), bool)
        self.committed = (self.wet, 0.0)
        self.pressure = 0.0
        #: Edges of the other body where it is.
        self.beside = np.zeros(0 if opposite is None else len(opposite.nodes), bool)

    def take_over(self, before: PenetratingPressure) -> None:
        """Start where another fluid on the same edges is, under the pressure that it has."""
        self.wet, self.committed, self.pressure = before.wet, before.committed, before.pressure

    def unit(self) -> Floats:
        return self._reference()  # the fluid moves

    def _reference(self) -> Floats:
        force = np.zeros(self.system.n_dofs)
        for edges in self._loaded():
            force += evaluate(self.system, edges.pressure, None, 1.0)[0]
        return force

    def add(self, scale: float, u: Floats, to: LoadSum) -> None:
        for edges in self._loaded():
            force, entries = evaluate(self.system, edges.pressure, to.middle(u), scale)
            to.force += force
            to.entries.append(entries)

    def _loaded(self) -> list[_core.EdgeLoads]:
        """The wet edges of both bodies for the core."""
        points, ring = self.system.model.mesh.points, self.system.axisymmetric
        found = []
        for edges, wet in ((self.chain, self.wet), (self.opposite, self.beside)):
            if edges is not None and wet.any():
                nodes = edges.nodes[wet].astype(np.uint32)
                thickness, bulge = edges.thickness[wet], edges.bulge[wet]
                if ring:  # the core knows the current way around
                    thickness = np.ones_like(thickness)
                found.append(_core.EdgeLoads(points, nodes, thickness, bulge, ring))
        return found

    @property
    def wetted(self) -> float:
        """Undeformed length of the edges that it has passed [length]."""
        return float(self.length[self.wet].sum())

    # -- the front ---------------------------------------------------------------------

    def begin(self, contact: Floats, soft: Bools, u: Floats) -> None:
        """Start an attempt at an increment: draw back where surfaces press again.

        Parameters
        ----------
        contact : ndarray, shape (n_nodes,)
            Contact pressure of the committed state.
        soft : ndarray of bool, shape (n_nodes,)
            Nodes whose contact has a pressure law.
        u : ndarray, shape (n_dofs,)
        """
        self.wet, self.pressure = self.committed
        may = self.wet & self._passes(contact, soft)
        self.wet = np.zeros_like(self.wet)
        while (near := self._next(may)).any():
            self.wet = self.wet | near
        self._reach(u)

    def advance(self, contact: Floats, soft: Bools, pressure: float, u: Floats) -> bool:
        """Advance at an equilibrium under a pressure of the fluid; False where it stands.

        Parameters are those of :meth:`begin`, of the trial state.
        """
        self.pressure = pressure
        before = self.wet
        if pressure > 0.0:
            may = self._passes(contact, soft)
            apart = may & (contact[self.chain.nodes[:, :2]] <= 0.0).all(axis=1)
            while (near := self._next(apart)).any():
                self.wet = self.wet | near
            if self.wet is before and (near := self._next(may)).any():
                self.wet = self.wet | near
        if self.wet is before:
            return False
        self._reach(u)
        return True

    def commit(self) -> None:
        """Accept the front."""
        self.committed = (self.wet, self.pressure)

    @property
    def _wet_nodes(self) -> Bools:
        """Nodes of edges with the fluid, shape (n_nodes,)."""
        found = np.zeros_like(self.start)
        found[self.chain.nodes[self.wet, :2]] = True
        return found

    def _next(self, may: Bools) -> Bools:
        """Dry edges that begin where the fluid is, of those that it may pass."""
        there = self.start | self._wet_nodes
        return there[self.chain.nodes[:, :2]].any(axis=1) & may & ~self.wet

    def _passes(self, contact: Floats, soft: Bools) -> Bools:
        """Edges along which contact does not press too hard, shape (n,).

        Between hard surfaces the fluid takes from the contact pressure what it presses itself: both
        together are compared with it. A layer with a pressure law has that of its thickness.
        """
        ends = self.chain.nodes[:, :2]
        whole, wet = np.zeros(len(contact)), np.zeros(len(contact))
        for end in ends.T:
            np.add.at(whole, end, self.length)
            np.add.at(wet, end, np.where(self.wet, self.length, 0.0))
        share = np.divide(wet, whole, out=np.zeros_like(wet), where=(whole > 0.0) & ~soft)
        both = (contact + self.pressure * share)[ends].mean(axis=1)
        least: Bools = both <= self.pressure * (1.0 + SAME)
        if self.critical is None:
            return least
        alone: Bools = contact[ends].mean(axis=1) <= self.critical * (1.0 + SAME)
        hard = self.wet & ~soft[ends].any(axis=1)
        return alone | (least & hard)

    def _reach(self, u: Floats) -> None:
        """Find the edges of the other body beside the fluid."""
        if self.opposite is None:
            return
        x = self.system.model.mesh.points + self.system.by_node(u)[:, :2]
        chain = np.flatnonzero(self.on_chain)
        ends = self.opposite.nodes[:, :2]
        apart = np.linalg.norm(x[ends][:, :, None] - x[chain], axis=3)
        self.beside = self._wet_nodes[chain[apart.argmin(axis=2)]].all(axis=1)
