"""A material whose constants follow the temperature."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, fields, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.arrays import Floats, distinct
from corota.errors import InputError, number
from corota.model.materials import Expansion, Material
from corota.model.plasticity import Mises, Voce
from corota.model.rates import CowperSymonds, Norton, RateCurves, YieldRatio

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike


#: Data of a material other than the constants of its law.
_COMMON = ("rho", "expansion", "rayleigh", "name", "where", "rows")


@dataclass
class MaterialTable(Material):
    """A material given at several temperatures: linear between them, constant outside.

    The stress is that of the elastic strain with the constants at the current temperature of
    each integration point. Plastic strain, back-stresses and the strain of an
    initial stress are kept when the temperature changes. The density is that at the initial
    temperature, so the mass does not change.

    Parameters
    ----------
    table : sequence of (float, Material)
        Temperatures and the material there, all of one class, in any order. Their yield curves
        may have different points; all have a curve or none, and as many back-stresses.
    rho : float, optional
        Density [mass/length^3]; by default those of the materials.
    expansion : float, tuple of three floats or Expansion, optional
        By default the coefficients of the materials, counted from temperature 0; coefficients that
        count from another one are an :class:`Expansion`.

    Raises
    ------
    InputError
        If the materials do not fit each other or a temperature is given twice.

    Notes
    -----
    As ``*ELASTIC`` and ``*PLASTIC`` with a column of temperatures. Yield stresses are
    interpolated at equal plastic strain. Back-stresses are kept as stresses, as in CalculiX;
    Abaqus changes them with their modulus.

    Examples
    --------
    >>> import corota as ct
    >>> cold = ct.Mises(E=210e3, nu=0.3, yield_curve=[(300.0, 0.0), (350.0, 0.1)])
    >>> hot = ct.Mises(E=150e3, nu=0.3, yield_curve=[(120.0, 0.0), (150.0, 0.1)])
    >>> steel = ct.MaterialTable([(20.0, cold), (600.0, hot)], expansion=1.2e-5)
    >>> steel.at(310.0).E
    180000.0
    """

    table: Sequence[tuple[float, Material]]

    follows_temperature = True

    def __post_init__(self) -> None:
        try:
            rows = [(number(t, "a temperature", self.where), m) for t, m in self.table]
        except (TypeError, ValueError):
            raise InputError(
                "a material table is a list of pairs (temperature, material)", self.where
            ) from None
        if not rows:
            raise InputError("a material table needs at least one temperature", self.where)
        rows.sort(key=lambda row: row[0])
        for (a, _), (b, _) in pairwise(rows):
            if a == b:
                raise InputError(f"the temperature {a:g} is given twice", self.where)
        materials = [m for _, m in rows]
        first = materials[0]
        for other in materials:
            if type(other) is not type(first) or not other.elastic_constants:
                raise InputError(
                    "a material table takes built-in materials, all of one class, not "
                    f"{type(first).__name__} and {type(other).__name__}",
                    self.where,
                )
        aligned = _aligned(materials, self)
        self.table = list(zip([t for t, _ in rows], aligned, strict=True))
        for name in (
            "law",
            "flows",
            "linear",
            "remembers",
            "oriented",
            "for_lines",
            "depends_on_time",
            "creeps",
        ):
            setattr(self, name, getattr(first, name))
        if not self.rho:
            self.rho = first.rho
        else:
            self.table = [(t, replace(m, rho=self.rho)) for t, m in self.table]
        if any((m.rho > 0.0) != (self.rho > 0.0) for _, m in self.table):
            raise InputError("give a density at every temperature or at none", self.where)
        if not Expansion.of(self.expansion) and any(Expansion.of(m.expansion) for m in materials):
            self.expansion = self._expansion(materials)
        self._check_motion()

    def _expansion(self, materials: list[Material]) -> Expansion:
        values = [m.expansion for m in materials]
        if any(isinstance(v, Expansion) for v in values):
            raise InputError(
                "give an expansion that is itself a table once for all temperatures: "
                "MaterialTable(..., expansion=...)",
                self.where,
            )
        alphas: Any = tuple(values)
        return Expansion(alphas, tuple(self.temperatures) if len(values) > 1 else ())

    @property
    def temperatures(self) -> list[float]:
        """The given temperatures, in increasing order."""
        return [t for t, _ in self.table]

    @property
    def first(self) -> Material:
        """The material at the lowest temperature."""
        return self.table[0][1]

    @property
    def varies(self) -> bool:
        """Whether the law depends on the temperature, and not the density alone."""
        numbers = [m.parameters() for _, m in self.table]
        return any(n != numbers[0] for n in numbers)

    @property
    def density_varies(self) -> bool:
        """Whether the density depends on the temperature."""
        return any(m.rho != self.rho for _, m in self.table)

    def at(self, temperature: float) -> Material:
        """The material at one temperature."""
        given = self.temperatures
        high = int(np.searchsorted(given, temperature, side="right"))
        low, high = max(high - 1, 0), min(high, len(given) - 1)
        a, b = self.table[low][1], self.table[high][1]
        share = 0.0 if low == high else (temperature - given[low]) / (given[high] - given[low])
        changed = {
            f.name: _mix(getattr(a, f.name), getattr(b, f.name), share)
            for f in fields(a)
            if f.name not in _COMMON
        }
        return replace(
            a,
            **changed,
            rho=float(_mix(a.rho, b.rho, share)),
            expansion=self.expansion,
            rayleigh=self.rayleigh,
            name=self.name,
            where=self.where,
        )

    def densities(self, temperature: ArrayLike) -> Floats:
        """Densities at temperatures, of any shape."""
        at = np.asarray(temperature, dtype=np.float64)
        return np.interp(at, self.temperatures, [m.rho for _, m in self.table])

    def _constants(self, temperature: ArrayLike) -> Floats:
        """Elastic constants at temperatures, shape (..., k)."""
        count = self.first.elastic_constants
        rows = np.array([m.parameters()[:count] for _, m in self.table])
        at = np.asarray(temperature, dtype=np.float64)
        columns = [np.interp(at, self.temperatures, column) for column in rows.T]
        return np.stack(columns, axis=-1)

    def compliances(self, temperature: ArrayLike) -> Floats:
        """Elastic compliances at temperatures, shape (..., 4, 4), see :meth:`compliance`."""
        return self.first.compliance_of(self._constants(temperature))

    def complementary_energy(self, temperature: ArrayLike, stress: Floats) -> Floats:
        """Complementary energy by volume of stresses along the material axes, shape (..., 4)."""
        return self.first.complementary_of(self._constants(temperature), stress)

    def compliance(self) -> Floats:
        return self.first.compliance()

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """Those of the material at the lowest temperature."""
        return self.first.parameters(orientation)

    def rows_of_parameters(self, orientation: float = 0.0) -> list[tuple[float, list[float]]]:
        """Temperatures and parameters for the core; empty where the law does not depend on it."""
        if not self.varies:
            return []
        return [(t, [float(v) for v in m.parameters(orientation)]) for t, m in self.table]


def _mix(a: Any, b: Any, share: float) -> Any:
    """A value between two of the same type."""
    if isinstance(a, Voce):
        return Voce(*(_mix(getattr(a, f.name), getattr(b, f.name), share) for f in fields(a)))
    if isinstance(a, CowperSymonds | Norton):
        return replace(
            a, **{f.name: _mix(getattr(a, f.name), getattr(b, f.name), share) for f in fields(a)}
        )
    if isinstance(a, int | float) and not isinstance(a, bool):
        return a if a == b else a + share * (b - a)
    if isinstance(a, list | tuple):
        pairs = zip(a, b, strict=True)
        return [tuple(_mix(x, y, share) for x, y in zip(p, q, strict=True)) for p, q in pairs]
    return a


def _aligned(materials: list[Material], table: MaterialTable) -> list[Material]:
    """Materials with corresponding parameters: curves at the same plastic strains."""
    plastic = [m for m in materials if isinstance(m, Mises)]
    if not plastic:
        return materials
    if len({m.yield_curve is None for m in plastic}) > 1:
        raise InputError(
            "give a yield curve at every temperature, or a yield stress at every temperature",
            table.where,
        )
    if len({len(m.back_stresses) for m in plastic}) > 1:
        raise InputError("give as many back-stresses at every temperature", table.where)
    if len({type(m.rate) for m in plastic}) > 1 or any(
        isinstance(m.rate, RateCurves | YieldRatio) for m in plastic
    ):
        raise InputError(
            "give the same kind of rate at every temperature, CowperSymonds or Norton", table.where
        )
    if len({bool(m.kinematic) for m in plastic}) > 1:
        plastic = [replace(m, kinematic=0.0, chaboche=m.back_stresses) for m in plastic]
    if plastic[0].yield_curve is None:
        if any(isinstance(m.isotropic, Voce) for m in plastic):
            plastic = [replace(m, isotropic=_voce(m)) for m in plastic]
        return list(plastic)
    curves = [np.array(m.yield_curve, dtype=np.float64) for m in plastic]
    strains = distinct(np.concatenate([c[:, 1] for c in curves]))
    out: list[Material] = []
    for m, curve in zip(plastic, curves, strict=True):
        stress = np.interp(strains, curve[:, 1], curve[:, 0])
        points = list(zip(stress.tolist(), strains.tolist(), strict=True))
        out.append(replace(m, yield_curve=points, rows=()))
    return out


def _voce(material: Mises) -> Voce:
    law = material.isotropic
    return law if isinstance(law, Voce) else Voce(0.0, 0.0, law)
