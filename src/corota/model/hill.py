"""Plasticity of rolled sheet: the yield function of Hill (1948)."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from corota.errors import InputError, number
from corota.model.plasticity import Mises


@dataclass
class Hill(Mises):
    """Plasticity that depends on the direction in a rolled sheet, with combined hardening.

    ``F (s22 - s33)^2 + G (s33 - s11)^2 + H (s11 - s22)^2 + 2 N s12^2 = sy^2`` in the axes of the
    material, whose first one is the rolling direction (`orientation` of the section). They turn
    with the body. Yield stresses, curves and back-stresses are those of :class:`~corota.Mises`; a
    back-stress moves along the stress less itself.

    Parameters
    ----------
    R11, R22, R33 : float
        Yield stresses along the axes over `sy`, > 0.
    R12 : float
        Yield stress in shear over ``sy / sqrt(3)``, > 0.

    Raises
    ------
    InputError
        If a number is outside its range, or the ratios do not close a yield surface.

    Notes
    -----
    As ``*POTENTIAL``. With all ratios 1 it is Mises plasticity. Rates are refused.

    Sources: R. Hill, *Proc. R. Soc. Lond. A* 193 (1948) 281-297; H. Ziegler, *Q. Appl. Math.* 17
    (1959) 55-65.

    Examples
    --------
    >>> import corota as ct
    >>> sheet = ct.Hill.from_lankford(1.8, 1.4, 2.2, E=206e3, nu=0.3, yield_stress=160.0)
    """

    R11: float = 1.0
    R22: float = 1.0
    R33: float = 1.0
    R12: float = 1.0

    oriented = True

    for_lines = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.rate is not None:
            raise InputError("Hill plasticity has no rate: leave it out", self.where)
        self.law = "hill"
        for name in ("R11", "R22", "R33", "R12"):
            number(getattr(self, name), name, self.where, above=0.0)
        f, g, h = self._normal
        if not f * g + g * h + h * f > 0.0:
            raise InputError(
                "the ratios do not close a yield surface: bring R11, R22 and R33 closer", self.where
            )

    @property
    def _normal(self) -> tuple[float, float, float]:
        """F, G and H."""
        a, b, c = (0.5 / r**2 for r in (self.R11, self.R22, self.R33))
        return b + c - a, c + a - b, a + b - c

    @classmethod
    def from_lankford(cls, r0: float, r45: float, r90: float, **options: Any) -> Hill:
        """The material of a sheet by its plastic strain ratios at 0, 45 and 90 degrees.

        A ratio is the plastic strain across a strip over that through its thickness; the yield
        stress is the one along the rolling direction.
        """
        for name, value in (("r0", r0), ("r45", r45), ("r90", r90)):
            number(value, name, above=0.0)
        f, g, h = r0 / (r90 * (1.0 + r0)), 1.0 / (1.0 + r0), r0 / (1.0 + r0)
        n = (r0 + r90) * (1.0 + 2.0 * r45) / (2.0 * r90 * (1.0 + r0))
        return cls(
            R22=1.0 / math.sqrt(f + h),
            R33=1.0 / math.sqrt(f + g),
            R12=math.sqrt(1.5 / n),
            **options,
        )

    @property
    def first_yield(self) -> float:
        return super().first_yield * self.R11

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``E, nu, R11, R22, R33, R12``, angle of axis 1 from x [rad], then as ``Mises``."""
        ratios = (self.E, self.nu, self.R11, self.R22, self.R33, self.R12, orientation)
        back = [value for pair in self.back_stresses for value in pair]
        count = float(len(self.back_stresses))
        return [*(float(v) for v in ratios), count, *back, *self._hardening()]
