"""Controls of an increment of a path: an arc, a displacement, a load.

A control closes the equations of equilibrium, whose unknowns are displacements and load
factor: with the corrections ``a`` (of the residual) and ``b`` (of a unit of load factor) it
chooses the change ``d`` of the load factor, and the displacements change by ``a + d b``.

Source: M. A. Crisfield, *Non-linear Finite Element Analysis of Solids and Structures*, vol. 1
(1991), ch. 9; E. Ramm, in *Nonlinear Finite Element Analysis in Structural Mechanics* (1981).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from corota.analysis.path_system import product
from corota.arrays import Bools, Floats, Ints


class Control(Protocol):
    """One scalar condition on an increment."""

    def change(self, du: Floats, dfactor: float, a: Floats, b: Floats) -> float | None:
        """Change of the load factor, or None where the condition cannot be met.

        Parameters
        ----------
        du : ndarray, shape (n_dofs,)
            Displacement of the increment so far.
        dfactor : float
            Change of the load factor so far.
        a, b : ndarray, shape (n_dofs,)
            Correction by the residual, and for a unit of load factor.
        """


@dataclass
class Arc:
    """Length of the increment; the root that turns the increment least is taken.

    Parameters
    ----------
    radius : float
        Length of the counted displacements [length].
    counted : ndarray of bool, shape (n_dofs,)
        Displacements, not rotations: these have another unit.
    weight : float
        Length of a unit of load factor: 0 for the cylindrical form [length].
    """

    radius: float
    counted: Bools
    weight: float = 0.0

    def change(self, du: Floats, dfactor: float, a: Floats, b: Floats) -> float | None:
        counted, square = self.counted, self.weight**2
        plane = du + a
        two = product(b, b, counted) + square
        if two == 0.0 or not math.isfinite(two):
            return None
        # The nearest point of the line to the center first: close to a critical point `a`
        # and `b` are huge and nearly parallel, and the quadratic equation would lose all.
        middle = -(product(b, plane, counted) + square * dfactor) / two
        plane += middle * b
        left = self.radius**2 - product(plane, plane, counted)
        left -= square * (dfactor + middle) ** 2
        if not left >= 0.0:
            return None
        half = math.sqrt(left / two)
        turn = product(du, b, counted) + square * dfactor
        return middle + math.copysign(half, turn)


@dataclass
class Row:
    """A combination of displacements has a given value in this increment.

    Parameters
    ----------
    dofs : ndarray of int, shape (k,)
    weights : ndarray, shape (k,)
    value : float
        Change of the combination over the increment.
    """

    dofs: Ints
    weights: Floats
    value: float

    def of(self, u: Floats) -> float:
        """Value of the combination."""
        return float(self.weights @ u[self.dofs])

    def change(self, du: Floats, dfactor: float, a: Floats, b: Floats) -> float | None:
        slope = self.of(b)
        missing = self.value - self.of(du) - self.of(a)
        if slope == 0.0 or not math.isfinite(missing / slope):
            return None
        return missing / slope


@dataclass
class Plane:
    """The increment ends in a plane: its difference from a target has no part in a direction.

    Parameters
    ----------
    target, direction : ndarray, shape (n_dofs,)
        Displacement of the increment, and normal of the plane.
    counted : ndarray of bool, shape (n_dofs,)
    weight : float
        Length of a unit of load factor [length].
    """

    target: Floats
    target_factor: float
    direction: Floats
    direction_factor: float
    counted: Bools
    weight: float

    def change(self, du: Floats, dfactor: float, a: Floats, b: Floats) -> float | None:
        square = self.weight**2 * self.direction_factor
        slope = product(self.direction, b, self.counted) + square
        missing = -product(self.direction, du + a - self.target, self.counted)
        missing -= square * (dfactor - self.target_factor)
        if slope == 0.0 or not math.isfinite(missing / slope):
            return None
        return missing / slope


@dataclass
class Factor:
    """The load factor has a given change in this increment."""

    value: float

    def change(self, du: Floats, dfactor: float, a: Floats, b: Floats) -> float | None:
        return self.value - dfactor
