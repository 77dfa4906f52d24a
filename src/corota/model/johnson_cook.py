"""Johnson-Cook plasticity: hardening, rate and softening by temperature, with adiabatic heat."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, replace

from corota.errors import InputError, number
from corota.model.material_table import MaterialTable
from corota.model.single_point import LawOfTheCore


@dataclass
class JohnsonCook(LawOfTheCore):
    """J2 plasticity with ``(A + B p^n) (1 + C ln max(p' / rate, 1)) (1 - T*^m)``.

    Here ``T* = (T - transition) / (melting - transition)`` between 0 and 1, and ``p'`` is the rate
    of the equivalent plastic strain p.

    Parameters
    ----------
    E, nu : float
        Young's modulus [force/length^2], > 0, and Poisson's ratio.
    A, B : float
        Yield stress, > 0, and factor of hardening, >= 0 [force/length^2].
    n : float
        Exponent of hardening, > 0.
    C : float
        Factor of the rate, >= 0.
    rate : float
        Rate up to which it has no effect [1/time], > 0.
    m : float
        Exponent of softening, > 0; without `melting` there is none.
    melting, transition : float, optional
        Temperatures where the strength ends and where softening begins.
    temperature : float, optional
        That of the body, by default `transition`; see :meth:`with_temperatures`.
    heat_fraction : float
        Share of the plastic work that heats its point, 0 to 1: nothing flows to its neighbors
        (adiabatic). With `specific_heat` and the density.
    specific_heat : float
        Heat by mass and temperature [length^2/time^2/temperature].

    Raises
    ------
    InputError
        If a number is outside its range.

    Notes
    -----
    In static steps the time is that of the step. From melting on a thousandth of the strength is
    left, so that a tangent exists.

    Source: G. R. Johnson and W. H. Cook, *Proc. 7th Int. Symp. on Ballistics* (1983) 541-547.

    Examples
    --------
    >>> import corota as ct
    >>> steel = ct.JohnsonCook(
    ...     E=200e3, nu=0.29, A=792.0, B=510.0, n=0.26, C=0.014, rate=1.0,
    ...     m=1.03, melting=1520.0, transition=20.0,
    ...     rho=7.83e-9, heat_fraction=0.9, specific_heat=4.77e8,
    ... )
    """

    E: float
    nu: float
    A: float
    B: float = 0.0
    n: float = 1.0
    C: float = 0.0
    rate: float = 1.0
    m: float = 1.0
    melting: float | None = None
    transition: float = 0.0
    temperature: float | None = None
    heat_fraction: float = 0.0
    specific_heat: float = 0.0

    law = "viscoplastic"
    depends_on_time = True
    for_lines = True
    elastic_constants = 2

    def __post_init__(self) -> None:
        self._check_isotropic(self.E, self.nu)
        self._check_motion()
        number(self.A, "the yield stress A", self.where, above=0.0)
        for name, value in (("n", self.n), ("the rate", self.rate), ("m", self.m)):
            number(value, name, self.where, above=0.0)
        for name, value in (("B", self.B), ("C", self.C)):
            number(value, name, self.where, least=0.0)
        if self.melting is not None and not self.melting > self.transition:
            raise InputError(
                f"the melting temperature {self.melting:g} must lie above the transition "
                f"{self.transition:g}",
                self.where,
            )
        if not 0.0 <= self.heat_fraction <= 1.0:
            raise InputError(
                f"the fraction of heat must lie between 0 and 1, not {self.heat_fraction}",
                self.where,
            )
        if self.heat_fraction:
            number(self.specific_heat, "the specific heat", self.where, above=0.0)
            number(self.rho, "the density of a material that heats", self.where, above=0.0)
            if self.melting is None:
                raise InputError(
                    "heat has no effect without the melting temperature: give it, or leave "
                    "heat_fraction out",
                    self.where,
                )

    @property
    def first_yield(self) -> float:
        return self.A

    def with_temperatures(self) -> MaterialTable:
        """The material at the temperatures of the model (``temperature`` of steps)."""
        if self.melting is None:
            raise InputError("without melting the strength has no temperature", self.where)
        low = self.transition - 10.0 * (self.melting - self.transition)
        rows = [(t, replace(self, temperature=t)) for t in (low, self.melting)]
        return MaterialTable(rows, rho=self.rho, name=self.name, where=self.where,
                             expansion=self.expansion, rayleigh=self.rayleigh)  # fmt: skip

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``E, nu, 0``, then hardening, rate and heat, each after the number of its numbers."""
        heat: list[float] = []
        if self.melting is not None:
            share = 0.0
            if self.heat_fraction:
                share = self.heat_fraction / (self.rho * self.specific_heat)
            here = self.transition if self.temperature is None else self.temperature
            heat = [share, self.transition, self.melting, self.m, here]
        lists = [[3.0, self.A, self.B, self.n], [2.0, self.C, self.rate] if self.C else [], heat]
        numbers = [float(self.E), float(self.nu), 0.0]
        for own in lists:
            numbers += [float(len(own)), *(float(v) for v in own)]
        return numbers
