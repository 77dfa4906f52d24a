"""Point masses and dashpots: attached to nodes, acting in dynamics only."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.mesh.parts import nodes_of

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.arrays import Floats, Ints


class Attachments:
    """Point masses and dashpots of a model by dof.

    Attributes
    ----------
    mass : ndarray, shape (n_dofs,)
        Added to the diagonal of any mass matrix [mass], [mass*length^2].

    Raises
    ------
    ModelError
        If a node carries no element and no constraint.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.mass = np.zeros(system.n_dofs)
        for item in system.model.point_masses:
            nodes = nodes_of(system.model.mesh, item.nodes)
            for dof, value in enumerate((item.mass, item.mass, item.inertia)):
                if value:
                    np.add.at(self.mass, system.attached_dofs(nodes, dof, "point mass"), value)
        self.dampers = bool(system.model.dashpots)
        self._ground(system)
        self._pairs(system)

    def _ground(self, system: System) -> None:
        self.ground = np.zeros(system.n_dofs)
        for item in system.model.dashpots:
            if item.second is None and item.dofs is None:
                nodes = np.array([item.first], np.int64)
                for dof, value in enumerate(item.to_ground):
                    if value:
                        self.ground[system.attached_dofs(nodes, dof, "dashpot")] += value

    def _pairs(self, system: System) -> None:
        pairs = [d for d in system.model.dashpots if d.second is not None or d.dofs is not None]
        self.c = np.array([d.c for d in pairs])
        #: Those whose force is not in proportion to the velocity, by index.
        self.tables = [(k, d) for k, d in enumerate(pairs) if d.table]
        ends = [[d.first, d.first if d.second is None else d.second] for d in pairs]
        self.nodes = np.array(ends, np.int64).reshape(-1, 2)
        self.dofs = flat = np.zeros((len(pairs), 4), np.int64)
        #: Fixed directions; zero along the line of the nodes.
        self.fixed = np.zeros((len(pairs), 4))
        for k, item in enumerate(pairs):
            if item.dofs is None:
                for column, (e, i) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
                    flat[k, column] = system.attached_dofs(self.nodes[k, e : e + 1], i, "dashpot")[
                        0
                    ]
                continue
            for e, dof in enumerate(item.dofs[: 1 if item.second is None else 2]):
                flat[k, 2 * e :] = system.attached_dofs(self.nodes[k, e : e + 1], dof, "dashpot")[0]
                self.fixed[k, 2 * e] = 1.0 - 2.0 * e
        self.along = ~self.fixed.any(axis=1)
        rows, columns = np.indices((4, 4)).reshape(2, -1)
        self.pair = (rows, columns)
        self.triplets = (flat[:, rows].ravel(), flat[:, columns].ravel())

    def damp(
        self, u: Floats, v: Floats, values: Floats, weight: float
    ) -> tuple[Floats, tuple[Ints, Ints, Floats] | None]:
        """Force of the dashpots and `weight` times its derivative by velocity.

        What dashpots to the ground give goes to `values`.

        Parameters
        ----------
        u, v : ndarray, shape (n_dofs,)
            Displacement and velocity.
        values : ndarray, shape (nnz,)
            Upper triangle, added to in place.
        weight : float
            Derivative of velocity by displacement in the time scheme [1/time].

        Returns
        -------
        force : ndarray, shape (n_dofs,)
        triplets : tuple of ndarray or None
            Rows, columns and values of the dashpots between nodes, in global axes.
        """
        system = self.system
        u, v = system.in_space(u), system.in_space(v)
        force: Floats = self.ground * v
        system.pattern.add_diagonal(values, weight * self.ground)
        if not len(self.c):
            return system.at_nodes(force), None
        axis = self._axes(u)
        rate = np.einsum("ki,ki->k", axis, v[self.dofs])
        push, slope = self.c * rate, self.c.copy()
        for k, item in self.tables:
            push[k], slope[k] = item.response(rate[k])
        np.add.at(force, self.dofs, push[:, None] * axis)
        rows, columns = self.pair
        outer = weight * slope[:, None] * axis[:, rows] * axis[:, columns]
        return system.at_nodes(force), (*self.triplets, outer.ravel())

    def _axes(self, u: Floats) -> Floats:
        """Directions of the dashpots, minus at the first end; shape (n, 4)."""
        points = self.system.model.mesh.points
        axes: Floats = self.fixed.copy()
        k = self.along
        dofs, nodes = self.dofs[k], self.nodes[k]
        moved = u[dofs] if self.system.nlgeom else np.zeros_like(u[dofs])
        line = points[nodes[:, 1]] + moved[:, 2:] - points[nodes[:, 0]] - moved[:, :2]
        line /= np.linalg.norm(line, axis=1)[:, None]
        axes[k] = np.hstack([-line, line])
        return axes

    def momenta(self, u: Floats, v: Floats) -> Floats:
        """Kinetic energy, linear and angular momentum, mass of the point masses, shape (5,)."""
        system = self.system
        m = np.zeros((len(system.per_node), 3))
        m[system.node_of_dof, system.component] = self.mass
        rate = system.by_node(v)
        x = system.model.mesh.points + system.by_node(u)[:, :2]
        p = m * rate
        turn = x[:, 0] @ p[:, 1] - x[:, 1] @ p[:, 0] + p[:, 2].sum()
        kinetic = 0.5 * float((p * rate).sum())
        return np.array([kinetic, p[:, 0].sum(), p[:, 1].sum(), turn, m[:, 0].sum()])
