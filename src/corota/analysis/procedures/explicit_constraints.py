"""Accelerations of central differences where dofs depend on others: rigid bodies, equations, axes.

The position at the end of an increment fulfills the constraints, and their forces act along the
gradients of its beginning: with ``u = g(w)`` of the independent dofs w and ``G = dg/dw``,

    G(u0)^T (M a + r) = 0,    a = ((g(w1) - u0) / dt - v) / h,

which conserves momenta, and energy as central differences do (Ryckaert, Ciccotti & Berendsen 1977;
Hairer, Lubich & Wanner, *Geometric Numerical Integration*, VII.1.4). The reduced mass ``G^T M G``
couples few dofs and is factorized.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import ConvergenceError, Location, UnsupportedError

if TYPE_CHECKING:
    from corota.analysis.constraints.elimination import LinearizedConstraints
    from corota.analysis.equations import System
    from corota.arrays import Bools, Floats


#: Unbalanced force relative to the largest that ends the iteration, and that may remain.
BALANCED, ROUNDED = 1e-11, 1e-7
#: Rounding of the force that changes a velocity, relative to the one that would stop it.
EPSILON = 4.0 * np.finfo(float).eps
#: Corrections of an increment.
CORRECTIONS = 30


class FreeMass:
    """The diagonal mass of a model without constraints.

    Parameters
    ----------
    mass : ndarray, shape (n_dofs,)

    Attributes
    ----------
    moving, idle : ndarray of bool, shape (n_dofs,)
        Unknowns with mass that no support moves, and those without mass.
    carried : ndarray of bool, shape (n_dofs,)
        Dofs that forces move: unknowns, and those that depend on them.
    inverse : ndarray, shape (n_dofs,)
        Inverse mass of dofs that forces move by themselves, else zero.
    """

    def __init__(self, system: System, mass: Floats) -> None:
        self.system, self.mass = system, mass
        free = ~system.conditions.constrained
        self.moving = self.carried = free & (mass > 0.0)
        self.idle = free & ~self.moving
        self.inverse = np.divide(1.0, mass, out=np.zeros_like(mass), where=self.moving)

    def inertia(self, x: Floats) -> Floats:
        """Product of the mass and accelerations of the unknowns, shape (n_dofs,)."""
        return self.mass * x

    def response(self, force: Floats) -> Floats:
        """Acceleration by a force on the unknowns, shape (n_dofs,)."""
        return self.inverse * force

    def stiffness(self, values: Floats, x: Floats) -> Floats:
        """Product of a tangent and changes of the unknowns."""
        return self.system.pattern.multiply(values, x)

    def felt(self, values: Floats) -> Bools:
        """Unknowns that feel a stiffness, whichever dof moves."""
        return self.system.pattern.largest_by_row(values) > 0.0

    def follow(self, move: Floats, u: Floats) -> Bools:
        """Set the moves of dofs that follow supports, in place; all that supports move."""
        return self.system.conditions.constrained

    def accelerate(
        self, u: Floats, v: Floats, residual: Floats, h: float, dt: float, ahead: Floats
    ) -> Floats:
        """Acceleration that changes the velocity, shape (n_dofs,).

        Parameters
        ----------
        u : ndarray, shape (n_dofs,)
            Displacement at the beginning of an increment.
        v : ndarray, shape (n_dofs,)
            Velocity before it, half an increment behind; at the start of a motion that at `u`.
        residual : ndarray, shape (n_dofs,)
            Internal less external force.
        h, dt : float
            Time that the acceleration acts, and the increment.
        ahead : ndarray, shape (n_dofs,)
            Move of the supported dofs in the increment.
        """
        return -self.inverse * residual


class ReducedMass(FreeMass):
    """The mass of the independent dofs where others depend on them."""

    def __init__(self, system: System, mass: Floats, u: Floats) -> None:
        super().__init__(system, mass)
        self.constraints = system.constraints
        self._update(system.constraints.link(u))

    def _update(self, link: LinearizedConstraints) -> None:
        """Factorize the mass at a state."""
        import scipy.sparse as sp
        from scipy.sparse.linalg import splu

        system, n = self.system, self.system.n_dofs
        constraints = self.constraints
        self.link = link
        transform = link.transform
        reduced = (transform.T @ sp.diags_array(self.mass) @ transform).tocsr()
        weight = np.zeros(n)
        weight[constraints.free] = reduced.diagonal()
        unknown = np.zeros(n, bool)
        unknown[constraints.free] = True
        unknown &= ~system.conditions.constrained
        self.moving = unknown & (weight > 0.0)
        self.idle = unknown & ~self.moving
        chosen = self.moving[constraints.free]
        inner = reduced[chosen][:, chosen]
        self._solve = splu(inner.tocsc()).solve
        others = abs(inner).sum(axis=1) - inner.diagonal()
        alone = np.zeros(n, bool)
        alone[np.flatnonzero(self.moving)] = others <= 1e-12 * inner.diagonal()
        self.inverse = np.divide(1.0, weight, out=np.zeros(n), where=alone)
        # A dof follows supports alone if no unknown moves it.
        dependent = constraints.dependent
        moves = abs(link.g) @ unknown.astype(float) > 0.0
        self.led = dependent[~moves]
        self.carried = self.moving.copy()
        self.carried[dependent[moves]] = True

    def inertia(self, x: Floats) -> Floats:
        return self.link.gather(self.mass * self.link.move(x))

    def response(self, force: Floats) -> Floats:
        out = np.zeros_like(force)
        out[self.moving] = self._solve(force[self.moving])
        return out

    def stiffness(self, values: Floats, x: Floats) -> Floats:
        system = self.system
        moved = self.constraints.to_global(self.link.move(x))
        force = system.pattern.multiply(values, moved)
        return self.link.gather(self.constraints.to_axes(force))

    def felt(self, values: Floats) -> Bools:
        size = self.system.pattern.largest_by_row(values)
        return self.link.gather_sizes(size) > 0.0

    def follow(self, move: Floats, u: Floats) -> Bools:
        held: Bools = self.system.conditions.constrained.copy()
        at = u + np.where(held, move, 0.0)
        self.constraints.complete(at)
        move[self.led] = (at - u)[self.led]
        held[self.led] = True
        return held

    def accelerate(
        self, u: Floats, v: Floats, residual: Floats, h: float, dt: float, ahead: Floats
    ) -> Floats:
        """See :class:`FreeMass`.

        Raises
        ------
        ConvergenceError
            If no position fulfills the constraints.
        """
        constraints, mass = self.constraints, self.mass
        link = constraints.link(u)
        if constraints.bending:
            self._update(link)
        move = np.where(self.system.conditions.constrained, ahead, dt * v)
        best = np.inf
        for _ in range(CORRECTIONS):
            at = u + move
            constraints.complete(at)
            move = at - u
            a = (move / dt - v) / h
            inertia = mass * a
            rest = np.where(self.moving, link.gather(residual + inertia), 0.0)
            size = max(float(np.abs(residual).max()), float(np.abs(inertia).max()))
            # Of a motion without forces nothing is left but the rounding of its positions.
            digits = float((mass * (np.abs(at) / dt + np.abs(v))).max()) / h
            left = float(np.abs(rest).max())
            exact = max(BALANCED * size, EPSILON * digits)
            if left <= exact or (left >= best and left <= ROUNDED * size):
                return a
            if not left < np.inf:
                break
            best = min(best, left)
            move = move - h * dt * self.response(rest)
        raise ConvergenceError(
            "central differences found no positions that fulfill the constraints: use a smaller "
            "increment, or an implicit scheme"
        )

    def refuse_contact(self, mine: Bools, where: Location | None) -> None:
        """Refuse contact at nodes whose motion is coupled to that of others by mass.

        Parameters
        ----------
        mine : ndarray of bool, shape (n_nodes,)
            Nodes in contact.

        Raises
        ------
        UnsupportedError
        """
        system = self.system
        bad = mine[system.node_of_dof] & self.carried & (self.inverse == 0.0)
        if bad.any():
            raise UnsupportedError(
                f"{system.describe(int(np.flatnonzero(bad)[0]))} is in contact and its motion "
                "depends on that of others by a constraint: central differences do not support "
                "both at one node; use an implicit scheme, or move one of them",
                where,
            )


def mass_of(system: System, mass: Floats, u: Floats) -> FreeMass:
    """The mass that central differences accelerate, at a displacement."""
    return ReducedMass(system, mass, u) if system.link.couples else FreeMass(system, mass)
