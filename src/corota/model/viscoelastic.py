"""Linear viscoelasticity: an elastic or hyperelastic material whose stress relaxes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.display import Brief
from corota.errors import InputError, number
from corota.model.hyperelastic import laws_of_energies
from corota.model.materials import Elastic, Material, isotropic_compliance
from corota.model.single_point import SinglePoint
from corota.names import choose_attribute

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Complex, Floats


#: What the constants of a parent are.
MODULI = ("instantaneous", "long term")


@dataclass(repr=False)
class WLF(Brief):
    """Shift of times with the temperature: ``log10 a = -C1 (T - T0) / (C2 + T - T0)``.

    Times are divided by `a`: a hot body relaxes sooner. From ``T0 - C2`` down nothing relaxes.

    Parameters
    ----------
    C1, C2 : float
        Constants, > 0; C2 in units of temperature.
    T0 : float
        Temperature of the given times.

    Raises
    ------
    InputError
        If a constant is not positive.

    Notes
    -----
    Source: M. L. Williams, R. F. Landel and J. D. Ferry, *J. Am. Chem. Soc.* 77 (1955) 3701-3707.
    """

    C1: float
    C2: float
    T0: float = 0.0

    def __post_init__(self) -> None:
        for name, value in (("C1", self.C1), ("C2", self.C2)):
            number(value, name, above=0.0)
        number(self.T0, "T0")


@dataclass
class Viscoelastic(SinglePoint):
    """A material whose stress relaxes by a Prony series.

    The shear modulus is ``G(t) = G0 (1 - sum g (1 - exp(-t / tau)))``, the bulk modulus the same
    with the shares k.

    Parameters
    ----------
    parent : Elastic or a hyperelastic material
        What it is at once.
    terms : sequence of (g, k, tau)
        Shares of shear and bulk modulus, >= 0, with sums below 1, and times [time], > 0.
    moduli : {"instantaneous", "long term"}
        Whether the constants of the parent are those at once or those after a long time.
    shift : WLF, optional
        Shift of the times with the temperature.
    temperature : float, optional
        That of the body, with a shift; by default that of the shift.

    Raises
    ------
    InputError
        If a number is outside its range, or the parent is another material.

    Notes
    -----
    It relaxes in steps in which time passes, :class:`~corota.Visco` and
    :class:`~corota.Dynamic`; in other steps it is its instantaneous parent. The update is exact for
    a strain that grows evenly over the increment, and for one that stays, of any length. With a
    hyperelastic parent the deviator and the mean of the Kirchhoff stress relax, in the
    axes that turn with the body.

    Source: J. C. Simo and T. J. R. Hughes, *Computational Inelasticity* (1998), chapter 10.

    Examples
    --------
    >>> import corota as ct
    >>> glass = ct.Elastic(E=2300.0, nu=0.38)
    >>> polymer = ct.Viscoelastic(glass, terms=[(0.3, 0.0, 10.0), (0.2, 0.0, 1000.0)])
    """

    parent: Material
    terms: Sequence[tuple[float, float, float]]
    moduli: Literal["instantaneous", "long term"] = "instantaneous"
    shift: WLF | None = None
    temperature: float | None = None

    law = "viscoelastic"
    depends_on_time = True

    def __post_init__(self) -> None:
        choose_attribute(self, "moduli", MODULI, "moduli", self.where)
        if not isinstance(self.parent, Elastic) and self.parent.law not in laws_of_energies():
            raise InputError(
                f"Elastic and hyperelastic materials relax, {type(self.parent).__name__} does not",
                self.where,
            )
        try:
            rows = [(float(g), float(k), float(tau)) for g, k, tau in self.terms]
        except (TypeError, ValueError):
            raise InputError("the terms are rows of (g, k, tau)", self.where) from None
        for g, k, tau in rows:
            if not (np.isfinite([g, k, tau]).all() and min(g, k) >= 0.0 and tau > 0.0):
                raise InputError(
                    f"a term needs g >= 0, k >= 0 and tau > 0, not {g:g}, {k:g}, {tau:g}",
                    self.where,
                )
        if not rows or max(self._sums) >= 1.0:
            raise InputError(
                "there must be terms, and the sums of g and of k must be below 1", self.where
            )
        if self.parent.law == "hyperfoam" and any(g != k for g, k, _ in rows):
            raise InputError(
                "shear and volume of a foam relax together: give the same g and k", self.where
            )
        if self.temperature is not None and self.shift is None:
            raise InputError("a temperature has no effect without a shift", self.where)
        self.rho = self.rho or self.parent.rho
        if self.expansion or self.parent.expansion:
            raise InputError(
                "thermal strain of viscoelastic materials is not included: its stress through the "
                "thickness would not relax",
                self.where,
            )
        self.local_strain = self.parent.local_strain  # type: ignore[misc]
        self._check_motion()

    @property
    def _sums(self) -> tuple[float, float]:
        return sum(g for g, _, _ in self.terms), sum(k for _, k, _ in self.terms)

    @property
    def incompressible(self) -> bool:
        return self.parent.incompressible

    def compliance(self) -> Floats:
        if isinstance(self.parent, Elastic):
            e, nu = self._parent_numbers()
            return isotropic_compliance(e, nu)
        g, _ = self._sums
        soft = 1.0 - g if self.moduli == "long term" else 1.0
        return self.parent.compliance() * soft

    def relaxation(self, time: ArrayLike) -> tuple[Floats, Floats]:
        """Shares of shear and bulk modulus that are left at times after a sudden strain."""
        t = np.asarray(time, dtype=np.float64)[..., None] / self._factor
        g, k, tau = np.array(self.terms, dtype=np.float64).T
        gone = -np.expm1(-t / tau)
        return 1.0 - gone @ g, 1.0 - gone @ k

    def complex_moduli(self, rate: ArrayLike) -> tuple[Complex, Complex]:
        """Shear and bulk modulus in harmonic motion over the instantaneous ones.

        Parameters
        ----------
        rate : array_like
            Circular frequencies [rad/time].

        Returns
        -------
        tuple of ndarray
            Real parts are the storage, imaginary parts the loss moduli.
        """
        g, k, tau = np.array(self.terms, dtype=np.float64).T
        w = np.asarray(rate, dtype=np.float64)[..., None]
        # Nothing relaxes in an infinite time.
        left = 0.0 if self._factor == np.inf else 1.0 / (1.0 + 1j * w * tau * self._factor)
        left = np.broadcast_to(left, (*w.shape[:-1], len(tau)))
        return 1.0 - left @ g, 1.0 - left @ k

    @property
    def _factor(self) -> float:
        if self.shift is None:
            return 1.0
        at = self.shift.T0 if self.temperature is None else self.temperature
        warmer = at - self.shift.T0
        if self.shift.C2 + warmer <= 0.0:
            return float(np.inf)
        return float(10.0 ** (-self.shift.C1 * warmer / (self.shift.C2 + warmer)))

    def _parent_numbers(self) -> list[float]:
        """Parameters of the instantaneous parent."""
        numbers = self.parent.parameters()
        if self.moduli == "instantaneous":
            return numbers
        g, k = (1.0 / (1.0 - s) for s in self._sums)
        if isinstance(self.parent, Elastic):
            e, nu = numbers
            shear, bulk = g * e / (2.0 * (1.0 + nu)), k * e / (3.0 * (1.0 - 2.0 * nu))
            return [
                9.0 * bulk * shear / (3.0 * bulk + shear),
                (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
            ]
        law = self.parent.law
        if law == "polynomial":
            return [v * g for v in numbers[:9]] + [v / k for v in numbers[9:]]
        rows = np.reshape(numbers, (-1, 3))
        scale = (g, 1.0, 1.0) if law == "hyperfoam" else (g, 1.0, 1.0 / k)
        return [float(v) for v in (rows * scale).ravel()]

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """Number of the parent; its parameters, terms and shift, each after their number."""
        shift: list[float] = []
        if self.shift is not None:
            at = self.shift.T0 if self.temperature is None else self.temperature
            shift = [self.shift.C1, self.shift.C2, self.shift.T0, at]
        numbers = [float(["elastic", *laws_of_energies()].index(self.parent.law))]
        for own in (self._parent_numbers(), [v for row in self.terms for v in row], shift):
            numbers += [float(len(own)), *(float(v) for v in own)]
        return numbers
