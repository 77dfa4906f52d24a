"""J2 (von Mises) plasticity with isotropic, kinematic and combined hardening."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from corota.display import Brief
from corota.errors import InputError, Location, number
from corota.model.rates import Norton, Rate, RateCurves
from corota.model.single_point import LawOfTheCore

#: Largest number of back-stresses of a material.
MAX_BACK_STRESSES = 6


@dataclass(repr=False)
class Voce(Brief):
    """Isotropic hardening that saturates: ``Q (1 - exp(-b p)) + H p`` above the yield stress.

    Parameters
    ----------
    Q : float
        Saturated growth of the yield stress [force/length^2], >= 0.
    b : float
        Rate in terms of the equivalent plastic strain, >= 0.
    H : float
        Linear part [force/length^2], >= 0.

    Notes
    -----
    Source: E. Voce, *J. Inst. Metals* 74 (1948) 537-562.
    """

    Q: float
    b: float
    H: float = 0.0


@dataclass
class Mises(LawOfTheCore):
    """J2 plasticity, integrated implicitly, in plane stress and plane strain.

    Parameters
    ----------
    E : float
        Young's modulus [force/length^2], > 0.
    nu : float
        Poisson's ratio, -1 < nu < 1/2.
    yield_curve : sequence of (stress, plastic strain), optional
        Points of the uniaxial curve, starting at plastic strain 0; straight between them and
        constant after the last. Give this or `yield_stress`.
    yield_stress : float, optional
        Initial yield stress [force/length^2], > 0.
    isotropic : float or Voce, optional
        Slope of the yield stress against equivalent plastic strain [force/length^2], or a
        saturating law.
    kinematic : float, optional
        Modulus of linear kinematic hardening: slope of the uniaxial back-stress
        [force/length^2].
    chaboche : sequence of (C, gamma), optional
        Back-stresses ``db = 2/3 C dep - gamma b dp``; C [force/length^2] > 0, gamma >= 0. With
        `kinematic` at most six.
    rate : CowperSymonds, YieldRatio, RateCurves or Norton, optional
        Rise of the yield stress with the rate of the plastic strain, or creep. With
        :class:`~corota.Norton` a yield stress is optional.

    Raises
    ------
    InputError
        If a number is outside its range, or the curve falls.

    Notes
    -----
    Any of the isotropic laws goes with any back-stresses (combined hardening); none of them
    is perfect plasticity. With ``gamma > 0`` the exact tangent is not symmetric; its symmetric
    part is used, which took at most a tenth more iterations where it was measured.

    Sources: J. C. Simo and R. L. Taylor, *Int. J. Numer. Methods Eng.* 22 (1986) 649-670;
    J. L. Chaboche, *Int. J. Plasticity* 2 (1986) 149-188.

    Examples
    --------
    >>> import corota as ct
    >>> steel = ct.Mises(E=210e3, nu=0.3, yield_stress=250.0, isotropic=1000.0)
    >>> alloy = ct.Mises(E=70e3, nu=0.33, yield_curve=[(200.0, 0.0), (260.0, 0.02)])
    """

    E: float
    nu: float = 0.0
    yield_curve: Sequence[tuple[float, float]] | None = None
    yield_stress: float | None = None
    isotropic: float | Voce = 0.0
    kinematic: float = 0.0
    chaboche: Sequence[tuple[float, float]] = ()
    rate: Rate | None = None
    #: Location of each row of the yield curve in a deck.
    rows: Sequence[Location] = field(default=(), kw_only=True, compare=False, repr=False)

    elastic_constants = 2
    law = "mises"
    for_lines = True

    def __post_init__(self) -> None:
        self._check_isotropic(self.E, self.nu)
        self._check_motion()
        self.depends_on_time = self.rate is not None
        self.creeps = isinstance(self.rate, Norton)
        self.law = "viscoplastic" if self.depends_on_time else "mises"
        given = (self.yield_curve is not None) + (self.yield_stress is not None)
        if given > 1 or (given == 0 and not isinstance(self.rate, Norton)):
            raise InputError("give either yield_curve or yield_stress", self.where)
        if self.yield_curve is not None:
            if self.isotropic != 0.0:
                raise InputError(
                    "yield_curve already defines the isotropic hardening: leave out isotropic, "
                    "or give yield_stress instead of the curve",
                    self.where,
                )
            try:
                curve = [(float(s), float(p)) for s, p in self.yield_curve]
            except (TypeError, ValueError):
                raise InputError(
                    "yield_curve is rows of (stress, plastic strain); for one stress give "
                    "yield_stress",
                    self.where,
                ) from None
            self._check_curve(curve)
        elif self.yield_stress is not None:
            number(self.yield_stress, "the yield stress", self.where, above=0.0)
        elif self.isotropic != 0.0 or self.back_stresses:
            raise InputError(
                "hardening without a yield stress: give yield_stress or yield_curve", self.where
            )
        if isinstance(self.rate, RateCurves):
            self._check_rate_curves(self.rate)
        law = self.isotropic if isinstance(self.isotropic, Voce) else Voce(0.0, 0.0, self.isotropic)
        for name, value in (("Q", law.Q), ("b", law.b), ("the isotropic slope", law.H)):
            number(value, name, self.where, least=0.0)
        number(self.kinematic, "the kinematic modulus", self.where, least=0.0)
        for place, (c, gamma) in enumerate(self.chaboche, start=1):
            number(c, f"C of back-stress {place}", self.where, above=0.0)
            number(gamma, f"gamma of back-stress {place}", self.where, least=0.0)
        if len(self.back_stresses) > MAX_BACK_STRESSES:
            raise InputError(
                f"at most {MAX_BACK_STRESSES} back-stresses are supported, not "
                f"{len(self.back_stresses)}; fit the curve with fewer",
                self.where,
            )

    def _check_rate_curves(self, rate: RateCurves) -> None:
        if self.yield_curve is None:
            raise InputError("RateCurves need a yield_curve, that at rate 0", self.where)
        for _, curve in rate.curves:
            self._check_curve([(float(s), float(p)) for s, p in curve])
        try:
            rate.joined(self.yield_curve)
        except InputError as error:
            raise InputError(error.message, self.where) from None

    def _check_curve(self, curve: list[tuple[float, float]]) -> None:
        if not curve:
            raise InputError("the yield curve has no points", self.where)
        for i, (stress, strain) in enumerate(curve):
            where = self.rows[i] if i < len(self.rows) else self.where
            if not (math.isfinite(stress) and stress > 0.0):
                raise InputError(f"the yield stress must be > 0, not {stress:g}", where)
            if not (math.isfinite(strain) and strain >= 0.0):
                raise InputError(f"the plastic strain must be >= 0, not {strain:g}", where)
            if i == 0 and strain != 0.0:
                raise InputError(
                    f"the yield curve must start at plastic strain 0, not {strain:g}: give the "
                    "plastic, not the total, strain",
                    where,
                )
            if i and strain <= curve[i - 1][1]:
                raise InputError(
                    f"the plastic strain must grow from row to row, but {strain:g} follows "
                    f"{curve[i - 1][1]:g}",
                    where,
                )
            if i and stress < curve[i - 1][0]:
                raise InputError(
                    f"the yield stress may not fall, but {stress:g} follows {curve[i - 1][0]:g}; "
                    "softening depends on the mesh and is not supported",
                    where,
                )

    @property
    def has_yield(self) -> bool:
        """Whether it has a yield stress; creep needs none."""
        return self.yield_curve is not None or self.yield_stress is not None

    @property
    def back_stresses(self) -> list[tuple[float, float]]:
        """Pairs (C, gamma), the linear one first."""
        linear = [(float(self.kinematic), 0.0)] if self.kinematic else []
        return linear + [(float(c), float(gamma)) for c, gamma in self.chaboche]

    @property
    def first_yield(self) -> float:
        if self.yield_curve is not None:
            return float(self.yield_curve[0][0])
        # Creep alone has no yield: a stress for pictures and scales.
        return 1e-3 * self.E if self.yield_stress is None else self.yield_stress

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``E, nu, n``, n pairs ``C, gamma``, then the kind of hardening and its numbers.

        With a rate: the number of these numbers before them, then the same of the rate, and 0.
        """
        back = self.back_stresses
        numbers = [float(self.E), float(self.nu), float(len(back))]
        numbers += [value for pair in back for value in pair]
        hardening = self._hardening()
        if self.rate is None:
            return numbers + hardening
        if isinstance(self.rate, RateCurves):
            assert self.yield_curve is not None
            rate = self.rate.numbers(self.yield_curve)
        else:
            rate = self.rate.numbers()
        return [*numbers, float(len(hardening)), *hardening, float(len(rate)), *rate, 0.0]

    def _hardening(self) -> list[float]:
        """Kind of the isotropic hardening and its numbers; empty without a yield stress."""
        if self.yield_curve is not None:
            return [1.0, *(float(v) for point in self.yield_curve for v in point)]
        if self.yield_stress is None:
            return []
        if isinstance(self.isotropic, Voce):
            law = self.isotropic
            return [2.0, float(self.yield_stress), law.Q, law.b, law.H]
        return [0.0, float(self.yield_stress), float(self.isotropic)]
