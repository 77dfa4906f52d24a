"""Electrostatic attraction of two parallel electrodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.distributed_forces import Distribution, LoadSum
from corota.analysis.failure import ElementFailure
from corota.analysis.following_forces import edge_shapes
from corota.errors import Location, ModelError
from corota.mesh.shape_functions import edge_functions

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Floats, Ints


#: Gauss points and weights of an edge: 1 / gap is no polynomial.
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(5)


class ElectrostaticPressure(Distribution):
    """Edges that an opposite electrode attracts through a gap.

    The field runs straight across the gap. With s along the electrodes, g the current gap across
    them and t the thickness, the energy of the field at constant voltage is
    ``-1/2 eps V^2 t int ds / g``: force and derivative follow from it, the derivative is symmetric.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Of each edge, the third repeated from the first where it is straight.
    thickness : ndarray, shape (n, 3)
        Of these nodes.
    strength : float
        Half of the permittivity times the square of the voltage at scale one [force].
    ground : ndarray, shape (2, 2), or None
        Two points of a fixed straight electrode.
    opposite : ndarray, shape (m, 3), or None
        Nodes of the edges of the opposite electrode instead.
    where : Location or None
        Of the load, for messages.

    Raises
    ------
    ModelError
        If the electrodes do not face each other.
    """

    def __init__(
        self,
        system: NumberedModel,
        nodes: Ints,
        thickness: Floats,
        strength: float,
        ground: Floats | None,
        opposite: Ints | None,
        where: Location | None,
    ) -> None:
        self.system, self.strength = system, strength
        points = system.model.mesh.points
        if strength == 0.0:  # it only ends an earlier load
            nodes, thickness = nodes[:0], thickness[:0]
        shape, slope = edge_shapes(nodes[:, 2] == nodes[:, 0], _POINTS)
        line = ground if ground is not None else points[np.zeros(2, np.int64)]
        if opposite is not None:
            line = np.stack(
                [points[opposite[:, 0]].mean(axis=0), points[opposite[:, 1]].mean(axis=0)]
            )
        along = line[1] - line[0]
        along = along / (float(np.hypot(*along)) or 1.0)
        across = np.array([-along[1], along[0]])
        at = np.einsum("ega,eai->egi", shape, points[nodes])
        if len(nodes) and float((across @ (at - line[0]).reshape(-1, 2).T).mean()) < 0.0:
            across = -across
        self.axes = np.stack([along, across])
        n, count = len(nodes), len(_POINTS)
        faces = np.zeros((n, count, 3), np.int64)
        weights = np.zeros((n, count, 3))
        base = np.full((n, count), float(across @ line[0]))
        if opposite is not None and n:
            faces, weights = _facing(points, self.axes, at, opposite, where)
            base[:] = 0.0
        self.base = base
        # The rows of an edge: its nodes, then those of the opposite electrode.
        self.nodes = np.concatenate([np.broadcast_to(nodes[:, None], (n, count, 3)), faces], axis=2)
        zero = np.zeros_like(shape)
        self.shape = np.concatenate([shape, -weights], axis=2)
        sense = np.sign(np.einsum("ega,ea->eg", slope, points[nodes] @ along))
        self.slope = np.concatenate([sense[..., None] * slope, zero], axis=2)
        self.weight = strength * np.einsum("ega,ea->eg", shape, thickness) * _WEIGHTS
        start = system.start[self.nodes]
        dofs = np.stack([start, start + 1], axis=-1)
        self._rows = np.broadcast_to(dofs[..., :, None, :, None], (n, count, 6, 6, 2, 2)).ravel()
        self._columns = np.broadcast_to(dofs[..., None, :, None, :], (n, count, 6, 6, 2, 2)).ravel()
        gap, _ = self._gap(np.zeros_like(points))
        if n and not (gap > 0.0).all():
            raise ModelError("the electrodes of an electrostatic load have no gap", where)

    def _reference(self) -> Floats:
        return self._force(*self._gap(np.zeros_like(self.system.model.mesh.points)))

    def add(self, scale: float, u: Floats, to: LoadSum) -> None:
        if not len(self.weight) or scale == 0.0:
            return
        gap, stretch = self._gap(self.system.by_node(to.middle(u))[:, :2])
        if not (gap > 0.0).all():
            raise ElementFailure("the electrodes of an electrostatic load meet")
        to.force += scale * self._force(gap, stretch)
        # Second derivatives of ds / g by the positions along and across.
        n, d = self.shape, self.slope
        mixed = np.einsum("eg,ega,egb->egab", -self.weight / gap**2, d, n)
        square = np.einsum("eg,ega,egb->egab", 2.0 * self.weight * stretch / gap**3, n, n)
        t, a = self.axes
        values = (
            mixed[..., None, None] * np.multiply.outer(t, a)
            + np.swapaxes(mixed, 2, 3)[..., None, None] * np.multiply.outer(a, t)
            + square[..., None, None] * np.multiply.outer(a, a)
        )
        entries = scale * values.ravel()
        some = entries != 0.0
        to.entries.append((self._rows[some], self._columns[some], entries[some]))

    def _gap(self, moved: Floats) -> tuple[Floats, Floats]:
        """Gap and length per natural coordinate at the Gauss points, shapes (n, points)."""
        x = (self.system.model.mesh.points + moved)[self.nodes]
        gap = np.einsum("ega,ega->eg", self.shape, x @ self.axes[1]) - self.base
        return gap, np.einsum("ega,ega->eg", self.slope, x @ self.axes[0])

    def _force(self, gap: Floats, stretch: Floats) -> Floats:
        """Force of scale one, along the axes of the nodes: the gradient of ds / g."""
        along = (self.weight / gap)[..., None] * self.slope
        across = (-self.weight * stretch / gap**2)[..., None] * self.shape
        force = np.zeros((len(self.system.model.mesh.points), 3))
        values = along[..., None] * self.axes[0] + across[..., None] * self.axes[1]
        np.add.at(force[:, :2], self.nodes, values)
        return self.system.from_nodes(force)


def _facing(
    points: Floats, axes: Floats, at: Floats, opposite: Ints, where: Location | None
) -> tuple[Ints, Floats]:
    """Nodes and weights of the points of the opposite electrode that face given ones.

    Parameters
    ----------
    axes : ndarray, shape (2, 2)
        Directions along and across the electrodes.
    at : ndarray, shape (n, points, 2)
    opposite : ndarray, shape (m, 3)

    Raises
    ------
    ModelError
        If a point faces no edge.
    """
    ends = (points @ axes[0])[opposite[:, :2]]
    place = at @ axes[0]
    low, high = ends.min(axis=1), ends.max(axis=1)
    slack = 1e-6 * float(high.max() - low.min())
    outside = np.maximum(low - place[..., None], place[..., None] - high)
    edge = outside.argmin(axis=2)
    if (np.take_along_axis(outside, edge[..., None], axis=2) > slack).any():
        raise ModelError(
            "an electrode reaches beyond the opposite one; give the shorter of the two as the "
            "loaded edges",
            where,
        )
    first, last = ends[edge, 0], ends[edge, 1]
    r = np.clip(2.0 * (place - first) / (last - first) - 1.0, -1.0, 1.0)
    straight = (opposite[:, 2] == opposite[:, 0])[edge]
    line, curve = edge_functions(r, curved=False)[0], edge_functions(r)[0]
    return opposite[edge], np.where(straight[..., None], line, curve)
