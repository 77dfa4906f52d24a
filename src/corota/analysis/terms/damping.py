"""Rayleigh damping of the model and of its materials as a matrix."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System

    Floats = NDArray[np.float64]


def material_pairs(system: System) -> list[tuple[float, float]]:
    """Damping per mass and per stiffness that materials have."""
    return sorted({b.section.material.rayleigh for b in system.blocks} - {(0.0, 0.0)})


def damping_matrix(
    system: System, u: Floats, per_stiffness: float = 0.0, mass: str = "consistent"
) -> Floats | None:
    """Damping by the stiffness of the model, and all damping of materials, at a displacement.

    Parameters
    ----------
    system : System
    u : ndarray, shape (n_dofs,)
        The committed displacement: the tangent there is the stiffness.
    per_stiffness : float
        Of the whole model [time].
    mass : str
        Kind of the mass matrix.

    Returns
    -------
    ndarray, shape (nnz,), or None
        Upper triangle [force*time/length]; None where nothing is damped.
    """
    parts = [per_stiffness * system.evaluate(u, 0.0).values] if per_stiffness else []
    for pair in material_pairs(system):
        alpha, beta = pair
        system.core.set_active([b.section.material.rayleigh == pair for b in system.blocks])
        try:
            if beta:
                parts.append(beta * system.evaluate(u, 0.0).values)
            if alpha:
                parts.append(alpha * _mass(system, u, mass))
        finally:
            system.core.set_active([])
    return sum(parts[1:], start=parts[0]) if parts else None


def mass_damping(system: System, u: Floats, mass: str) -> Floats | None:
    """Damping of materials per mass, upper triangle; None where there is none."""
    parts = []
    for alpha in sorted({b.section.material.rayleigh[0] for b in system.blocks} - {0.0}):
        chosen = [b.section.material.rayleigh[0] == alpha for b in system.blocks]
        system.core.set_active(chosen)
        try:
            parts.append(alpha * _mass(system, u, mass))
        finally:
            system.core.set_active([])
    return sum(parts[1:], start=parts[0]) if parts else None


def _mass(system: System, u: Floats, kind: str) -> Floats:
    """Mass matrix of the active blocks."""
    here, rest = system.in_space(u), np.zeros(system.n_dofs)
    values = system.pattern.zeros()
    force, scale = np.zeros((2, system.n_dofs))
    system.core.inertia(here, rest, rest, kind, [0.0, 0.0, 1.0], force, scale, values)
    return values


__all__ = ["damping_matrix", "mass_damping", "material_pairs"]
