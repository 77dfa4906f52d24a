"""Viscous damping: dashpots, and Rayleigh damping of the model and of its materials."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.term import StatePoint, Term
from corota.analysis.terms.viscous import ViscousElements

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.inertia import Inertia
    from corota.arrays import Floats


class Damping(Term):
    """Viscous forces of an increment.

    Parameters
    ----------
    inertia : Inertia
        Provides mass and dashpots.
    per_mass : float
        Of the whole model [1/time].
    elements : ViscousElements
        Damping per stiffness.
    u : ndarray, shape (n_dofs,)
        The committed displacement, at which materials have their mass.
    """

    name = "damping"

    def __init__(
        self, inertia: Inertia, per_mass: float, elements: ViscousElements, u: Floats
    ) -> None:
        self.inertia, self.per_mass, self.elements = inertia, per_mass, elements
        #: Damping of materials per mass, upper triangle, or None.
        self.mass = mass_damping(inertia.system, u, inertia.kind)

    def add(self, point: StatePoint, at: Evaluation) -> None:
        system, v, values, weight = self.inertia.system, point.v, at.values, point.weights[1]
        force = np.zeros(len(v))
        if self.per_mass:
            mass = self.inertia.tangent(point.u)
            force += self.per_mass * system.product(mass, v)
            values += weight * self.per_mass * mass
        if self.mass is not None:
            force += system.product(self.mass, v)
            values += weight * self.mass
        if self.elements.any:
            begin, end, dt = point.between or (point.u, point.u, 0.0)
            force += self.elements.add(begin, end, v, dt, weight, values)
        attached = self.inertia.attached
        if attached.dampers:
            damped, triplets = attached.damp(point.u, v, values, weight)
            force += damped
            if triplets is not None:
                # Derivatives of external forces have the other sign.
                rows, columns, products = triplets
                at.add_load_stiffness(rows, columns, -products)
        at.add_damping(force)


def material_pairs(system: System) -> list[tuple[float, float]]:
    """Damping per mass and per stiffness that materials have."""
    return sorted({b.section.material.rayleigh for b in system.blocks} - {(0.0, 0.0)})


def damping_matrix(
    system: System, u: Floats, per_stiffness: float = 0.0, mass: str = "consistent"
) -> Floats | None:
    """Damping of the model per stiffness and all damping of materials, at a displacement.

    As in direct integration the stiffness is the elastic one in the frames of the elements: stress
    and loads, which change the tangent, dissipate nothing.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
        The committed displacement.
    per_stiffness : float
        Of the whole model [time].
    mass : str
        Kind of the mass matrix.

    Returns
    -------
    ndarray, shape (nnz,), or None
        Upper triangle [force*time/length]; None where nothing is damped.
    """
    values = mass_damping(system, u, mass)
    elements = ViscousElements(system, per_stiffness)
    if elements.any:
        values = system.pattern.zeros() if values is None else values
        elements.add(u, u, np.zeros(system.n_dofs), 0.0, 1.0, values)
    return values


def mass_damping(system: System, u: Floats, mass: str) -> Floats | None:
    """Damping of materials per mass, upper triangle; None where there is none."""
    parts = []
    for alpha in sorted({b.section.material.rayleigh[0] for b in system.blocks} - {0.0}):
        chosen = [b.section.material.rayleigh[0] == alpha for b in system.own_blocks]
        system.core.set_active(chosen)
        try:
            parts.append(alpha * _mass(system, u, mass))
        finally:
            system.core.set_active([])
    return sum(parts[1:], start=parts[0]) if parts else None


def _mass(system: System, u: Floats, kind: str) -> Floats:
    here, rest = system.in_space(u), np.zeros(system.n_dofs)
    values = system.pattern.zeros()
    force, scale = np.zeros((2, system.n_dofs))
    system.core.inertia(here, rest, rest, kind, [0.0, 0.0, 1.0], force, scale, values)
    return values
