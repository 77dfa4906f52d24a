"""Follower tractions on edges, and nodal follower forces."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.distributed_forces import Distribution, LoadSum, Pressure
from corota.mesh.shape_functions import edge_functions

if TYPE_CHECKING:
    import corota._core as _core
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats, Ints


#: Gauss points and weights of an edge.
_POINTS = np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)])
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 9.0
#: A quarter of a turn to the left.
_LEFT = np.array([[0.0, -1.0], [1.0, 0.0]])


class FollowingTraction(Distribution):
    """A traction with constant components tangential and normal to the edge.

    It acts on the current length. With t and n the current tangent and the normal to its left,
    the force is the integral of s_t t + s_n n, and t times the length is linear in the positions
    of the nodes: so is the force, and its derivative is constant. Of a ring the current
    circumference is another factor, linear in the radii. On drilling elements the
    component across acts on the bulge of their sides, as a pressure does; the component along
    acts on the chord.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Of each edge, the third repeated from the first where it is straight.
    thickness : ndarray, shape (n, 3)
        Of these nodes.
    value : tuple of float
        A vector on the reference [force/length^2], or one number: a shear along the edges, with
        the element on the left.
    bulges : list of (Bools, _core.EdgeLoads)
        Edges of drilling elements of one direction, by a mask of the edges.
    ring : bool
        Whether they are edges of axisymmetric sections.
    """

    def __init__(
        self,
        system: NumberedModel,
        nodes: Ints,
        thickness: Floats,
        value: tuple[float, ...],
        bulges: list[tuple[Bools, _core.EdgeLoads]],
        ring: bool = False,
    ) -> None:
        self.system = system
        x = system.model.mesh.points[nodes]
        shape, slope = edge_shapes(nodes[:, 2] == nodes[:, 0])
        d = np.einsum("egb,ebi->egi", slope, x)
        if len(value) == 1:
            along = np.full(d.shape[:2], value[0])
            across = np.zeros_like(along)
        else:
            unit = d / np.linalg.norm(d, axis=2, keepdims=True)
            along, across = unit @ np.array(value), (unit @ _LEFT.T) @ np.array(value)
        self.bulged: list[tuple[float, Pressure]] = []
        for mask, edges in bulges:
            size = float(across[mask][0, 0])
            if size != 0.0:
                self.bulged.append((size, Pressure(system, edges)))
            across[mask] = 0.0
        depth = np.full((len(nodes), 3), 2.0 * np.pi) if ring else thickness
        if not ring:
            shape = shape * np.einsum("ega,ea->eg", shape, depth)[..., None]
        #: Force at node a per position of node b at the points g, shape (n, 3, 3, 3, 2, 2).
        self._parts = np.einsum(
            "g,ega,egb,egij->egabij",
            _WEIGHTS * (2.0 * np.pi if ring else 1.0),
            shape,
            slope,
            along[..., None, None] * np.eye(2) + across[..., None, None] * _LEFT,
        )
        self.shape = shape if ring else None
        self.nodes, self.reference = nodes, x
        start = system.start[nodes]
        straight = nodes[:, 2] == nodes[:, 0]
        real = np.ones(nodes.shape, bool)
        real[straight, 2] = False
        pair = real[:, :, None, None, None] & real[:, None, :, None, None]
        matrix = self._matrix(x)
        rows = start[:, :, None, None, None] + np.arange(2)[:, None]
        columns = start[:, None, :, None, None] + np.arange(2)
        self._filled = np.broadcast_to(pair, matrix.shape) & (ring | (matrix != 0.0))
        self._rows = np.broadcast_to(rows, matrix.shape)[self._filled]
        self._columns = np.broadcast_to(columns, matrix.shape)[self._filled]

    def _radii(self, x: Floats) -> Floats:
        """Radii at the points, one where there is no circumference; shape (n, 3)."""
        if self.shape is None:
            return np.ones(self._parts.shape[:2])
        return np.asarray(np.einsum("ega,ea->eg", self.shape, x[..., 0]))

    def _matrix(self, x: Floats) -> Floats:
        """Derivative of the force by the positions, shape (n, 3, 3, 2, 2)."""
        matrix: Floats = np.einsum("eg,egabij->eabij", self._radii(x), self._parts)
        if self.shape is not None:
            along = np.einsum("egacij,ecj->egai", self._parts, x)
            matrix[..., 0] += np.einsum("egai,egb->eabi", along, self.shape)
        return matrix

    def _reference(self) -> Floats:
        force = self._at(self.reference)
        for size, pressure in self.bulged:
            force += size * pressure.unit()
        return force

    def add(self, scale: float, u: Floats, to: LoadSum) -> None:
        moved = self.system.by_node(to.middle(u))[:, :2]
        x = self.reference + moved[self.nodes]
        to.force += scale * self._at(x)
        to.entries.append((self._rows, self._columns, scale * self._matrix(x)[self._filled]))
        for size, pressure in self.bulged:
            pressure.add(scale * size, u, to)

    def _at(self, x: Floats) -> Floats:
        """Force of unit scale at positions of the edges' nodes, along the axes of the nodes."""
        force = np.zeros((len(self.system.model.mesh.points), 3))
        nodal = np.einsum("eg,egabij,ebj->eai", self._radii(x), self._parts, x)
        np.add.at(force[:, :2], self.nodes, nodal)
        return self.system.from_nodes(force)


def edge_shapes(straight: Bools, r: Floats = _POINTS) -> tuple[Floats, Floats]:
    """Shape functions and slopes of edges at points r from -1 to 1, shapes (n, points, 3)."""
    both = zip(edge_functions(r, curved=False), edge_functions(r), strict=True)
    shape, slope = (np.where(straight[:, None, None], line, curve) for line, curve in both)
    return shape, slope


class TurningForce(Distribution):
    """Nodal forces that follow the rotation of their node.

    Parameters
    ----------
    nodes : ndarray of int, shape (n,)
        Each once, and with a rotation.
    dof : int
        Direction on the reference: 0 or 1.
    value : ndarray, shape (n,)
    """

    def __init__(self, system: NumberedModel, nodes: Ints, dof: int, value: Floats) -> None:
        self.system, self.nodes = system, nodes
        # Along the axes of the nodes, as all nodal forces are given.
        given = np.zeros(system.n_dofs)
        np.add.at(given, system.dofs(nodes, dof), value)
        self.force = system.by_node(given)[nodes, :2]

    def _reference(self) -> Floats:
        return self._nodal(self.force)

    def add(self, scale: float, u: Floats, to: LoadSum) -> None:
        angle = self.system.by_node(to.middle(u))[self.nodes, 2]
        cos, sin = np.cos(angle), np.sin(angle)
        x, y = scale * self.force.T
        turned = np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)
        to.force += self._nodal(turned)
        start = self.system.start[self.nodes]
        rows = np.concatenate([start, start + 1])
        columns = np.concatenate([start + 2, start + 2])
        to.entries.append((rows, columns, np.concatenate([-turned[:, 1], turned[:, 0]])))

    def _nodal(self, force: Floats) -> Floats:
        out = np.zeros((len(self.system.model.mesh.points), 3))
        np.add.at(out[:, :2], self.nodes, force)
        return self.system.from_nodes(out)
