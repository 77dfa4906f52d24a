"""Explicit motion with artificial mass and damping that brings bodies in contact to rest.

Dynamic relaxation: central differences with a diagonal mass for which the increment 1 is stable.
Velocities are set to zero at every peak of the kinetic energy, so that the bodies come to rest.
Contact acts by forward-increment multipliers, which need no equilibrium on the way: bodies pass
corners and snap. Nothing is committed, and stresses are those of one increment from the committed
state. The result is a position to start Newton's method from, no solution.

Sources: P. Underwood, *Dynamic relaxation*, in: Computational Methods for Transient Analysis
(1983); P. A. Cundall, *Explicit finite difference methods in geomechanics* (1976), for kinetic
damping.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.energies import Energies
from corota.analysis.failure import ElementFailure
from corota.analysis.terms.contact.forward import ForwardContact
from corota.errors import ConvergenceError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.terms.contact.pair import Terms

    Floats = NDArray[np.float64]

#: Largest number of increments, and of those in which the unbalanced force has not halved.
MOST, PATIENCE = 6000, 1500
#: Unbalanced force at rest over the largest force.
AT_REST = 1e-4
#: Increments between two updates of the mass.
UPDATE = 50
#: Mass over the least one that is stable by the rows of the tangent.
SAFETY = 2.0
#: Smallest mass over the largest one, for dofs without stiffness.
LEAST = 1e-6
#: Fraction of an overlap that remains after an increment: all of it, as in central differences, or
#: less. A gap that jumps back and forth has no position of rest if the overlap is removed.
REMAINS = (1.0, 0.95)
#: Longest displacement of supports in an increment, in shortest edges of a slave surface.
STEP = 0.02


@dataclass
class Rest:
    """A position at which the bodies rest.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    multipliers : ndarray, shape (n_multipliers,)
    states : list of ndarray
        Of contact; no node slips any more.
    """

    u: Floats
    multipliers: Floats
    states: list[NDArray[np.int8]]


class _Contact(ForwardContact):
    """Contact of a motion that is not part of the analysis: nothing is counted or committed."""

    multipliers: Floats
    remains = 1.0

    def _count(self, *_: Any) -> None:
        """No work."""

    def _commit(
        self,
        u: Floats,
        found: list[Terms],
        multipliers: Floats,
        force: Floats,
        size: Floats,
        time: float,
    ) -> None:
        self.multipliers = multipliers
        self.depth = [self.remains * depth for depth in self.depth]


def come_to_rest(
    system: System, u: Floats, left: Floats, step_time: float, edge: float, remains: float = 1.0
) -> Rest | None:
    """Move from a position until the bodies rest; None if they do not.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    left : ndarray, shape (n_dofs,)
        Displacement that supports still have to make.
    step_time : float
        Step time of the loads and of the position of rest.
    edge : float
        Shortest edge of the slave surfaces [length].
    remains : float
        Fraction of an overlap that remains after an increment.
    """
    if system.link.couples:
        return None  # eliminated dofs make the mass matrix full
    held = system.conditions.constrained
    u, v = u.copy(), np.zeros_like(u)
    contact = _Contact(system.contact_term, Energies(system), 1.0)
    contact.remains = remains
    parts = max(1, int(np.ceil(float(np.abs(left).max()) / (STEP * edge))))
    mass = np.ones_like(u)
    kinetic, least, since = 0.0, np.inf, parts
    for i in range(MOST):
        driven = left / parts if i < parts else np.zeros_like(u)
        try:
            at = system.evaluate(u, step_time)
            if i % UPDATE == 0:
                mass = _stable_mass(system, at.values)
            inverse = np.where(held, 0.0, 1.0 / mass)
            free = np.where(held, driven, v - inverse * at.residual)
            before = np.where(held, driven, v)
            force = contact.act(u, v, free, before, 1.0, inverse, step_time)
        except (ElementFailure, ConvergenceError):
            return None
        unbalanced = np.where(held, 0.0, at.residual - force)
        largest = max(float(np.abs(at.internal).max()), float(np.abs(force).max()))
        rest = float(np.abs(unbalanced).max())
        if i >= parts and rest <= AT_REST * largest:
            return Rest(u, contact.multipliers, contact.state)
        if i >= parts and rest < 0.5 * least:
            least, since = rest, i
        if i > since + PATIENCE:
            return None
        v = np.where(held, driven, v - inverse * unbalanced)
        last, kinetic = kinetic, float((mass * v * v)[~held].sum())
        if i >= parts and kinetic < last:
            v, kinetic = np.zeros_like(v), 0.0
        u = u + v
    return None


def _stable_mass(system: System, values: Floats) -> Floats:
    """Diagonal mass for which the increment 1 is stable, shape (n_dofs,).

    The largest eigenvalue of M^-1 K is at most the largest sum of a row, over the mass of the row.
    """
    rows: Floats = system.pattern.multiply(np.abs(values), np.ones(system.n_dofs))
    out: Floats = 0.25 * SAFETY * np.maximum(rows, LEAST * rows.max())
    return out


__all__ = ["REMAINS", "Rest", "come_to_rest"]
