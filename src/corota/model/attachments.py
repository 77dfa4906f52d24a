"""Attachments of nodes: point masses and dashpots."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from corota.arrays import Ints
from corota.display import Brief
from corota.errors import InputError, Location


@dataclass(repr=False)
class PointMass(Brief):
    """A mass, and an inertia about its axis, at each node of a set.

    Parameters
    ----------
    nodes : str or array_like of int
    mass : float
        [mass], >= 0. Gravity and spin act on it where they act on all cells, or on a cell at its
        node.
    inertia : float
        Of a drilling rotation [mass*length^2], >= 0.
    """

    nodes: str | Ints
    mass: float
    inertia: float = 0.0
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        if not (np.isfinite([self.mass, self.inertia]).all() and self.mass >= 0.0 <= self.inertia):
            raise InputError(
                f"a point mass and its inertia must be >= 0, not {self.mass}, {self.inertia}",
                self.where,
            )


@dataclass(repr=False)
class Dashpot(Brief):
    """A damper between two nodes, along their line or in dofs, or from a node to the ground.

    Parameters
    ----------
    first, second : int, int or None
        Node indices; None is the ground.
    c : float
        Along the line, or between `dofs` [force*time/length].
    to_ground : tuple of float
        Along x, along y and about z [force*time/length], [force*length*time]; with the ground.
    dofs : tuple of int, optional
        Dof of the first and of the second node (0 x, 1 y, 2 rotation), in place of the line: its
        velocity is that of the first less that of the second; with the ground that of the first.
    table : tuple of (float, float), optional
        Relative velocities, rising, and forces, in place of `c`; beyond the ends the force is
        constant. Without `dofs` the velocity is that at which the nodes part.
    """

    first: int
    second: int | None = None
    c: float = 0.0
    to_ground: tuple[float, float, float] = (0.0, 0.0, 0.0)
    dofs: tuple[int, int] | None = None
    table: tuple[tuple[float, float], ...] = ()
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        if not (np.isfinite([self.c, *self.to_ground]).all() and min(self.c, *self.to_ground) >= 0):
            raise InputError(f"a dashpot must be >= 0, not {self.c}, {self.to_ground}", self.where)
        if self.dofs is not None and not {*self.dofs} <= {0, 1, 2}:
            raise InputError(f"dofs of a dashpot are 0, 1 or 2, not {self.dofs}", self.where)
        if not self.table:
            return
        v, f = np.array(self.table, float).T
        if len(v) < 2 or not np.isfinite([v, f]).all() or (np.diff(v) <= 0.0).any():
            raise InputError("a dashpot needs two velocities or more, which rise", self.where)
        if (np.diff(f) < 0.0).any() or (np.sign(v) * f < 0.0).any():
            raise InputError(
                "the force of a dashpot must rise with the velocity and have its sign", self.where
            )
        if self.c or any(self.to_ground) or (self.second is None and self.dofs is None):
            raise InputError("a table of a dashpot stands in place of c and to_ground", self.where)

    def response(self, rate: float) -> tuple[float, float]:
        """Force at a relative velocity, and its derivative."""
        if not self.table:
            return self.c * rate, self.c
        v, f = np.array(self.table, float).T
        i = int(np.searchsorted(v, rate, side="right"))
        slope = (f[i] - f[i - 1]) / (v[i] - v[i - 1]) if 0 < i < len(v) else 0.0
        return float(np.interp(rate, v, f)), float(slope)
