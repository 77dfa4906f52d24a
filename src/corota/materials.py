"""Material laws as plain parameters, checked at construction."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from corota.errors import InputError

if TYPE_CHECKING:
    from corota.errors import Location


def _positive(value: float, name: str, where: Location | None) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{name} must be a positive number, not {value}", where)


@dataclass
class Material:
    """Common data of all materials.

    Parameters
    ----------
    rho : float
        Mass density [mass/length^3]; 0 means that none was given.
    name : str
        The user's name.
    where : Location, optional
        Card that defined it.
    """

    rho: float = field(default=0.0, kw_only=True)
    name: str = field(default="", kw_only=True)
    where: Location | None = field(default=None, kw_only=True, compare=False, repr=False)

    #: Name under which the core knows the law.
    law = ""

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """Numbers handed to the core, in the order that the law's file documents.

        Parameters
        ----------
        orientation : float, optional
            Angle of the material axes [rad]; without effect on isotropic laws.
        """
        raise TypeError(f"{type(self).__name__} has no parameters")


@dataclass
class Elastic(Material):
    """Isotropic linear elasticity.

    Parameters
    ----------
    E : float
        Young's modulus [force/length^2], > 0.
    nu : float
        Poisson's ratio, -1 < nu < 1/2.

    Raises
    ------
    InputError
        If a constant is outside its range.
    """

    E: float
    nu: float = 0.0

    law = "elastic"

    def __post_init__(self) -> None:
        _positive(self.E, "Young's modulus E", self.where)
        if not -1.0 < self.nu < 0.5:
            raise InputError(
                f"Poisson's ratio {self.nu} is outside -1 < nu < 0.5; "
                "for a nearly incompressible material use e.g. 0.4999",
                self.where,
            )
        if not (math.isfinite(self.rho) and self.rho >= 0.0):
            raise InputError(f"the density must be >= 0, not {self.rho}", self.where)

    def parameters(self, orientation: float = 0.0) -> list[float]:
        return [self.E, self.nu]


@dataclass
class Orthotropic(Material):
    """Orthotropic linear elasticity; axes 1 and 2 in the plane, 3 normal to it.

    The angle of axis 1 belongs to the section (``orientation``).

    Parameters
    ----------
    E1, E2, E3 : float
        Young's moduli [force/length^2], > 0.
    nu12, nu13, nu23 : float
        Poisson's ratios; ``nu12`` is the contraction along 2 under tension along 1.
    G12 : float
        Shear modulus in the plane [force/length^2], > 0.

    Raises
    ------
    InputError
        If the compliance is not positive definite.

    Notes
    -----
    Source: R. M. Jones, *Mechanics of Composite Materials*, 2nd ed., section 2.4.
    """

    E1: float
    E2: float
    E3: float
    nu12: float
    nu13: float
    nu23: float
    G12: float

    law = "orthotropic"

    def __post_init__(self) -> None:
        for name in ("E1", "E2", "E3", "G12"):
            _positive(getattr(self, name), name, self.where)
        s12, s13, s23 = -self.nu12 / self.E1, -self.nu13 / self.E1, -self.nu23 / self.E2
        s11, s22, s33 = 1.0 / self.E1, 1.0 / self.E2, 1.0 / self.E3
        minor = s11 * s22 - s12 * s12
        det = (
            s11 * (s22 * s33 - s23 * s23)
            - s12 * (s12 * s33 - s23 * s13)
            + s13 * (s12 * s23 - s22 * s13)
        )
        if not (minor > 0.0 and det > 0.0):
            raise InputError(
                "the orthotropic constants are not positive definite; the Poisson's ratios are "
                f"too large (|nu12| must be below {math.sqrt(self.E1 / self.E2):g})",
                self.where,
            )
        if not (math.isfinite(self.rho) and self.rho >= 0.0):
            raise InputError(f"the density must be >= 0, not {self.rho}", self.where)

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``E1, E2, E3, nu12, nu13, nu23, G12``, angle of axis 1 from x [rad]."""
        moduli = [self.E1, self.E2, self.E3]
        return [*moduli, self.nu12, self.nu13, self.nu23, self.G12, orientation]
