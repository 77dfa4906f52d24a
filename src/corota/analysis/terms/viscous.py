"""Damping per stiffness in the element frame.

The viscous force of an element is its elastic local stiffness, at the initial temperature, times
the rates of its local dofs. A rigid motion has none of these in any configuration, so it is not
damped, and the forces have neither resultant nor moment.

With the frame's rotation R, ``eta = R X``, ``gamma = S eta / sum(eta . x)`` and x from the mean,
the frame turns at ``rate = gamma . v``, and the local dofs change by ``R^T (v - rate S x)`` and by
``phi' - rate``. Between two configurations the same holds exactly for finite increments with the
mean rotation matrix and the mean positions (see docs/dynamics.md).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import corota._core as _core
from corota.analysis.terms.user_material import UserBlocks
from corota.arrays import skew
from corota.errors import ModelError
from corota.model import elements
from corota.model.blocks import BlockOfCells, core_input

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.arrays import Bools, Floats, Ints


@dataclass
class _Block:
    """Damped elements of one kind, n of them with N nodes of M dofs.

    Parameters
    ----------
    dofs : ndarray of int, shape (n, N * M)
    arm : ndarray, shape (n, N, 2)
        Reference positions from their mean [length].
    matrix : ndarray, shape (n, N * M, N * M)
        Local stiffness times the damping per stiffness.
    chosen, places : ndarray
        Entries of the matrices in the upper triangle, and their positions.
    turns : bool
        Whether the element has a rotating frame.
    """

    dofs: Ints
    arm: Floats
    matrix: Floats
    chosen: Bools
    places: Ints
    turns: bool


class ViscousElements:
    """Damping per stiffness of the elements of a system.

    Parameters
    ----------
    per_stiffness : float
        Of the whole model; that of materials is added [time].
    """

    def __init__(self, system: System, per_stiffness: float = 0.0) -> None:
        self.system = system
        self.blocks: list[_Block] = []
        #: Whether any element of the model is damped.
        self.any = any(per_stiffness + b.section.material.rayleigh[1] for b in system.blocks)
        if self.any and system.axisymmetric and system.nlgeom:
            raise ModelError(
                "damping per stiffness with large rotations (nlgeom) is not for axisymmetric "
                "models: its matrix would turn with the element, and the hoop does not; use "
                "damping per mass"
            )
        for block in system.own_blocks:
            factor = per_stiffness + block.section.material.rayleigh[1]
            if factor:
                turns = elements.find(block.section.element).turns
                self.blocks.append(self._block(block, factor, turns))

    def _block(self, block: BlockOfCells, factor: float, turns: bool) -> _Block:
        system = self.system
        n, nodes = block.nodes.shape
        points = system.model.mesh.points[block.nodes]
        # Separate elements: the assembled matrix contains the element matrices.
        alone = core_input(block, system.model.mesh.points)
        alone["nodes"] = np.arange(n * nodes, dtype=np.uint32)
        core = _core.Problem(
            np.ascontiguousarray(points.reshape(-1, 2)), [alone], np.zeros(n * nodes, np.uint8)
        )
        if alone.get("by_temperature"):
            shape = core.shape(0).reshape(-1, nodes)
            core.set_temperatures(0, (system.free.start[block.nodes] @ shape.T).ravel())
        size = core.n_dofs // n
        force, scale, rest = np.zeros((3, core.n_dofs))
        values = np.zeros(len(core.indices))
        user = UserBlocks(core, [block])
        user.assemble(rest, False, lambda: core.assemble(rest, False, force, scale, values))
        rows, columns = np.triu_indices(size)
        order = np.lexsort((rows, columns))
        matrix = np.zeros((n, size, size))
        matrix[:, rows[order], columns[order]] = factor * values.reshape(n, -1)
        matrix[:, columns, rows] = matrix[:, rows, columns]
        each = size // nodes
        dofs = (system.start[block.nodes][:, :, None] + np.arange(each)).reshape(n, size)
        i, j = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        chosen = i <= j
        places, _ = system.pattern.places(i[chosen], j[chosen])
        arm = points - points.mean(axis=1, keepdims=True)
        return _Block(dofs, arm, matrix, chosen, places, turns)

    def add(
        self, begin: Floats, end: Floats, rate: Floats, dt: float, weight: float, values: Floats
    ) -> Floats:
        """Viscous force between two states, and `weight` times its derivative by velocity.

        Parameters
        ----------
        begin, end : ndarray, shape (n_dofs,)
            Displacements, the same for the force at an instant.
        rate : ndarray, shape (n_dofs,)
            Velocities, or the increment that forces work on over `dt`.
        dt : float
            Time between the states, 0 for an instant.
        values : ndarray, shape (nnz,)
            Upper triangle, added to in place.

        Returns
        -------
        ndarray, shape (n_dofs,)
        """
        system = self.system
        force = np.zeros(system.n_dofs)
        begin, end, rate = (system.in_space(x) for x in (begin, end, rate))
        for block in self.blocks:
            own = block.matrix
            v = rate[block.dofs]
            if block.turns and system.nlgeom:
                change = _change(block, begin[block.dofs], end[block.dofs], v, dt)
                own = np.swapaxes(change, 1, 2) @ own @ change
            f = np.einsum("eij,ej->ei", own, v)
            force += np.bincount(block.dofs.ravel(), f.ravel(), minlength=system.n_dofs)
            if weight:
                values += weight * np.bincount(
                    block.places, own[block.chosen], minlength=len(values)
                )
        return system.at_nodes(system.communicator.sum(force))


def _change(block: _Block, begin: Floats, end: Floats, v: Floats, dt: float) -> Floats:
    """Changes of the local dofs by those of the global ones, shape (n, N * M, N * M)."""
    n, nodes = block.arm.shape[:2]
    size = block.dofs.shape[1]
    each = size // nodes

    def placed(u: Floats) -> tuple[Floats, Floats]:
        move = u.reshape(n, nodes, each)[:, :, :2]
        x = block.arm + move - move.mean(axis=1, keepdims=True)
        along = (block.arm * x).sum(axis=(1, 2))
        across = (skew(block.arm) * x).sum(axis=(1, 2))
        return x, np.stack([along, across]) / np.hypot(along, across)

    (x0, r0), (x1, r1) = placed(begin), placed(end)
    x, (c, s) = 0.5 * (x0 + x1), 0.5 * (r0 + r1)
    eta = c[:, None, None] * block.arm + s[:, None, None] * skew(block.arm)
    gamma = skew(eta) / (eta * x).sum(axis=(1, 2))[:, None, None]
    row = np.zeros((n, nodes, each))
    row[:, :, :2] = gamma
    column = np.ones((n, nodes, each))
    column[:, :, :2] = skew(x)
    row, column = row.reshape(n, size), column.reshape(n, size)
    less = np.eye(size) - column[:, :, None] * row[:, None, :]
    out = less.reshape(n, nodes, each, size).copy()
    first, second = out[:, :, 0].copy(), out[:, :, 1].copy()
    c, s = c[:, None, None], s[:, None, None]
    out[:, :, 0], out[:, :, 1] = c * first + s * second, c * second - s * first
    if each == 3 and dt:
        # Differences of angles by those of their doubled half tangents.
        psi = dt * v.reshape(n, nodes, each)[:, :, 2]
        tau = dt * np.einsum("ei,ei->e", row, v)[:, None]
        d = 1.0 + 0.25 * psi * tau
        z = 0.5 * (psi - tau) / d
        small = np.abs(z) < 1e-4
        arc = np.where(small, 1.0 - z * z / 3.0, np.arctan(z) / np.where(small, 1.0, z))
        out[:, :, 2] *= (arc / d)[:, :, None]
    local: Floats = out.reshape(n, size, size)
    return local
