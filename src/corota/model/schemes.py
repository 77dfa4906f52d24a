"""Time integration schemes as rows of coefficients.

The implicit schemes weigh the equation of motion between the two ends of an increment,

    (1 - alpha_m) f_I(n+1) + alpha_m f_I(n)
        + (1 - alpha_f) (f_int - f_ext)(n+1) + alpha_f (f_int - f_ext)(n) = 0,

with Newmark's relations of parameters beta and gamma between displacement, velocity and
acceleration. The energy-momentum scheme takes its forces from the core.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from corota.errors import InputError


@dataclass(frozen=True)
class Scheme:
    """Coefficients of an implicit scheme.

    Parameters
    ----------
    alpha_m, alpha_f : float
        Weights of the start of the increment in inertia and in the other forces.
    beta, gamma : float
        Newmark's parameters.
    name : str
    """

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float
    name: str = ""


def newmark(alpha: float = 0.0, rho: float = 1.0) -> Scheme:
    """Trapezoidal rule (Newmark 1959): no numerical dissipation in linear problems."""
    return Scheme(0.0, 0.0, 0.25, 0.5, "newmark")


def hht(alpha: float = -0.05, rho: float = 1.0) -> Scheme:
    """Hilber, Hughes & Taylor (1977); `alpha` from -1/3 (most dissipation) to 0."""
    if not -1.0 / 3.0 <= alpha <= 0.0:
        raise InputError(f"alpha of the HHT scheme must lie in [-1/3, 0], not {alpha}")
    return Scheme(0.0, -alpha, 0.25 * (1.0 - alpha) ** 2, 0.5 - alpha, "hht")


def bossak(alpha: float = -0.05, rho: float = 1.0) -> Scheme:
    """Wood, Bossak & Zienkiewicz (1981), WBZ-alpha; `alpha` from -1 (most dissipation) to 0.

    The spectral radius at infinite frequency is ``(1 + alpha) / (1 - alpha)``.
    """
    if not -1.0 <= alpha <= 0.0:
        raise InputError(f"alpha of Bossak's scheme must lie in [-1, 0], not {alpha}")
    return Scheme(alpha, 0.0, 0.25 * (1.0 - alpha) ** 2, 0.5 - alpha, "bossak")


def generalized_alpha(alpha: float = 0.0, rho: float = 0.8) -> Scheme:
    """Chung & Hulbert (1993) by the spectral radius at infinite frequency, 0 to 1."""
    if not 0.0 <= rho <= 1.0:
        raise InputError(f"rho_inf of the generalized-alpha scheme must lie in [0, 1], not {rho}")
    am, af = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    return Scheme(am, af, 0.25 * (1.0 - am + af) ** 2, 0.5 - am + af, "generalized_alpha")


#: Implicit schemes by name; called with ``alpha`` and ``rho``.
SCHEMES: dict[str, Callable[[float, float], Scheme]] = {
    "hht": hht,
    "newmark": newmark,
    "bossak": bossak,
    "generalized_alpha": generalized_alpha,
}


def names() -> tuple[str, ...]:
    """Names of all schemes of dynamic steps."""
    return (*SCHEMES, "energy_momentum", "central_difference")
