"""Deformation plasticity: the nonlinear elasticity of Ramberg and Osgood."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import number
from corota.model.single_point import LawOfTheCore

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Floats

#: Halvings after which an interval is of rounding size.
BISECTIONS = 60


@dataclass
class RambergOsgood(LawOfTheCore):
    """Deformation plasticity: ``E e = s + offset (|s| / yield_stress)^(exponent - 1) s``.

    The strain is a function of the stress alone, so that unloading follows the same
    curve. Under proportional loads it is power-law plasticity (fracture
    mechanics, notches); where parts unload, use :class:`~corota.Mises`.

    Parameters
    ----------
    E : float
        Young's modulus [force/length^2], > 0.
    nu : float
        Poisson's ratio, -1 < nu < 1/2.
    yield_stress : float
        Stress at which the power term is `offset` times the elastic strain [force/length^2], > 0.
    exponent : float
        Power of the stress, >= 1.
    offset : float
        Size of the power term, > 0; 3/7 and 0.002 E / yield_stress are usual.

    Raises
    ------
    InputError
        If a number is outside its range.

    Notes
    -----
    In three dimensions the power term acts on the deviator, with the equivalent stress q:
    ``E e = (1 + nu) S - (1 - 2 nu) p I + 3/2 offset (q / yield_stress)^(exponent - 1) S``.
    All its energy is stored. As ``*DEFORMATION PLASTICITY`` of CalculiX and Abaqus.

    Sources: W. Ramberg and W. R. Osgood, NACA Technical Note 902 (1943); G. Dhondt, *CalculiX
    CrunchiX User's Manual*, "Ramberg-Osgood materials".

    Examples
    --------
    >>> import corota as ct
    >>> alloy = ct.RambergOsgood(E=72e3, nu=0.33, yield_stress=300.0, exponent=10.0, offset=0.48)
    """

    E: float
    nu: float
    yield_stress: float
    exponent: float
    offset: float

    law = "ramberg_osgood"
    remembers = False
    elastic_constants = 5

    def __post_init__(self) -> None:
        self._check_isotropic(self.E, self.nu)
        self._check_motion()
        number(self.yield_stress, "the yield stress", self.where, above=0.0)
        number(self.offset, "the offset", self.where, above=0.0)
        number(self.exponent, "the exponent", self.where, least=1.0)

    @property
    def first_yield(self) -> float:
        return self.yield_stress

    def uniaxial(
        self, strain: ArrayLike, time: ArrayLike | None = None, lasting: bool = True
    ) -> Floats:
        """Uniaxial stress at axial strains, from the law itself by bisection."""
        wanted = self.E * np.abs(np.asarray(strain, float))
        # Either term alone would give too large a stress.
        power = (wanted / (self.offset * self.yield_stress)) ** (1.0 / self.exponent)
        low, high = np.zeros_like(wanted), np.minimum(wanted, self.yield_stress * power)
        for _ in range(BISECTIONS):
            s = 0.5 * (low + high)
            grown = s + self.offset * self.yield_stress * (s / self.yield_stress) ** self.exponent
            low, high = np.where(grown < wanted, s, low), np.where(grown < wanted, high, s)
        out: Floats = np.copysign(high, strain)
        return out

    @classmethod
    def complementary_of(cls, constants: Floats, stress: Floats) -> Floats:
        E, _, yield_stress, exponent, offset = np.moveaxis(constants, -1, 0)
        xx, yy, zz, xy = np.moveaxis(stress, -1, 0)
        q2 = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2
        power = offset * (np.sqrt(q2) / yield_stress) ** (exponent - 1.0)
        out: Floats = power * q2 / (E * (exponent + 1.0))
        return out + super().complementary_of(constants, stress)

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``E, nu, yield_stress, exponent, offset``."""
        numbers = (self.E, self.nu, self.yield_stress, self.exponent, self.offset)
        return [float(v) for v in numbers]
