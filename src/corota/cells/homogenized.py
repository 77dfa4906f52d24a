"""Constants and ellipticity of homogenized bodies, from their tangents."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

#: Directions in which ellipticity is tried, over half a turn.
DIRECTIONS = 720


def elastic_constants(tangent: ArrayLike) -> dict[str, float]:
    """Constants of an orthotropic plane body from its tangent in the unloaded state.

    Parameters
    ----------
    tangent : array_like, shape (2, 2, 2, 2)
        Of :meth:`PeriodicCell.tangent`.

    Returns
    -------
    dict of str to float
        ``E1``, ``E2``, ``G12`` [stress], ``nu12``, ``nu21``: of plane strain those in the plane.
    """
    pairs = [(0, 0), (1, 1), (0, 1)]
    whole = np.asarray(tangent, dtype=np.float64)
    stiffness = np.array([[whole[a + b] for b in pairs] for a in pairs])
    c = np.linalg.inv(stiffness)
    return {
        "E1": float(1.0 / c[0, 0]),
        "E2": float(1.0 / c[1, 1]),
        "G12": float(1.0 / c[2, 2]),
        "nu12": float(-c[1, 0] / c[0, 0]),
        "nu21": float(-c[0, 1] / c[1, 1]),
    }


def ellipticity(tangent: ArrayLike) -> tuple[float, float]:
    """Smallest eigenvalue of the acoustic tensor: stiffness of the body against long waves.

    Parameters
    ----------
    tangent : array_like, shape (2, 2, 2, 2)
        Of :meth:`PeriodicCell.tangent`, about any state.

    Returns
    -------
    value : float
        Positive while the body is stable against waves of any length much larger than the cell
        (G. Geymonat, S. Mueller, N. Triantafyllidis, Arch. Rational Mech. Anal. 122 (1993)
        231-290) [stress].
    angle : float
        Of the wave vector in the reference configuration [rad].
    """
    angles = np.linspace(0.0, math.pi, DIRECTIONS, endpoint=False)
    normal = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    acoustic = np.einsum("aj,ijkl,al->aik", normal, np.asarray(tangent, float), normal)
    least = np.linalg.eigvalsh(0.5 * (acoustic + acoustic.transpose(0, 2, 1)))[:, 0]
    at = int(np.argmin(least))
    return float(least[at]), float(angles[at])
