"""Attachments of nodes: point masses and dashpots."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.display import Brief
from corota.errors import InputError, Location

if TYPE_CHECKING:
    from corota.mesh.data import Ints


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
    """A linear damper between two nodes, along their line, or from a node to the ground.

    Parameters
    ----------
    first, second : int, int or None
        Node indices; None is the ground.
    c : float
        Along the line [force*time/length].
    to_ground : tuple of float
        Along x, along y and about z [force*time/length], [force*length*time]; with the ground.
    """

    first: int
    second: int | None = None
    c: float = 0.0
    to_ground: tuple[float, float, float] = (0.0, 0.0, 0.0)
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        if not (np.isfinite([self.c, *self.to_ground]).all() and min(self.c, *self.to_ground) >= 0):
            raise InputError(f"a dashpot must be >= 0, not {self.c}, {self.to_ground}", self.where)
