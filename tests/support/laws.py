"""The list of laws that tests try, and the energies of those that have one, written again here.

A new law is tried by its entry in `LAWS`; the contract tests ask for it. A hyperelastic law also
needs its energy in `ENERGIES`: the tests of points, fits, softening and relaxation follow from it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.model.hyperelastic import Hyperelastic


def _steel(f: float, **more: Any) -> dict[str, Any]:
    return {"E": f * 200e3, "nu": 0.3, "yield_stress": f * 250.0, **more}


#: Laws by their unit of stress over MPa and their unit of time over s (numbers in the new units).
LAWS: dict[str, Callable[[float, float], Any]] = {
    "elastic": lambda f, t: ct.Elastic(f * 200e3, 0.3),
    "orthotropic": lambda f, t: ct.Orthotropic(f * 9e3, f * 5e3, f * 4e3, 0.3, 0.2, 0.25, f * 2e3),
    "neo-Hooke": lambda f, t: ct.NeoHooke(f * 0.5, 0.02 / f),
    "Mooney-Rivlin": lambda f, t: ct.MooneyRivlin(f * 0.4, f * 0.1, 0.02 / f),
    "Yeoh": lambda f, t: ct.Yeoh(f * 0.5, f * -0.01, f * 0.002, 0.02 / f),
    "polynomial": lambda f, t: ct.Polynomial(C10=f * 0.4, C11=f * 0.01, C02=f * 0.003, D1=0.02 / f),
    "Ogden": lambda f, t: ct.Ogden((f * 0.5, f * 0.1), (1.5, -2.0), (0.02 / f, 0.0)),
    "Arruda-Boyce": lambda f, t: ct.ArrudaBoyce(f * 1.0, 3.0, 0.02 / f),
    "hyperfoam": lambda f, t: ct.Hyperfoam((f * 0.5, f * 0.1), (4.0, -2.0), (0.1, 0.3)),
    "Mullins": lambda f, t: ct.Mullins(ct.NeoHooke(f * 0.5, 0.02 / f), 2.0, f * 0.02, 0.1),
    "Mullins foam": lambda f, t: ct.Mullins(
        ct.Hyperfoam((f * 0.5, f * 0.1), (4.0, -2.0), (0.1, 0.3)), 1.5, f * 0.02
    ),
    "Prony": lambda f, t: ct.Viscoelastic(ct.Elastic(f * 2e3, 0.38), terms=[(0.3, 0.1, 0.4 * t)]),
    "Prony rubber": lambda f, t: ct.Viscoelastic(
        ct.NeoHooke(f * 0.5, 0.02 / f), terms=[(0.3, 0.0, 0.4 * t)]
    ),
    "isotropic": lambda f, t: ct.Mises(**_steel(f, isotropic=f * 2e3)),
    "ideal": lambda f, t: ct.Mises(**_steel(f)),
    "combined": lambda f, t: ct.Mises(
        **_steel(f, isotropic=f * 500.0, kinematic=f * 1e3, chaboche=[(f * 5e3, 50.0)])
    ),
    "Cowper-Symonds": lambda f, t: ct.Mises(
        **_steel(f, isotropic=f * 2e3, rate=ct.CowperSymonds(40.0 / t, 5.0))
    ),
    "Norton": lambda f, t: ct.Mises(f * 200e3, 0.3, rate=ct.Norton(1e-14 / f**5 / t, 5.0)),
    "Johnson-Cook": lambda f, t: ct.JohnsonCook(
        E=f * 200e3, nu=0.3, A=f * 350.0, B=f * 275.0, n=0.36, C=0.022, rate=1.0 / t
    ),
    "Ramberg-Osgood": lambda f, t: ct.RambergOsgood(f * 200e3, 0.3, f * 250.0, 8.0, 0.4),
    "Hill": lambda f, t: ct.Hill(**_steel(f, isotropic=f * 2e3, R22=1.1, R33=0.9, R12=1.05)),
    "Hill combined": lambda f, t: ct.Hill(
        **_steel(f, isotropic=f * 500.0, kinematic=f * 1e3, R22=1.1, R33=0.9, R12=1.05)
    ),
}


def _of_invariants(law: Any, i1: Any, i2: Any) -> Any:
    powers = [(1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)]
    return sum(c * i1**i * i2**j for c, (i, j) in zip(law.parameters(), powers, strict=False))


def _dilatation(D: Any, J: Any) -> Any:
    return sum((J - 1) ** (2 * i) / d for i, d in enumerate(D, start=1) if d)


def _polynomial(law: Any, stretch: Any, bar: Any, J: Any) -> Any:
    shape = _of_invariants(law, (bar**2).sum() - 3.0, (bar**-2.0).sum() - 3.0)
    return shape + _dilatation(law.parameters()[9:], J)


def _ogden(law: Any, stretch: Any, bar: Any, J: Any) -> Any:
    mu, alpha, D = np.reshape(law.parameters(), (-1, 3)).T
    shape = sum(2 * m / a**2 * ((bar**a).sum() - 3) for m, a in zip(mu, alpha, strict=True))
    return shape + _dilatation(D, J)


def _arruda_boyce(law: Any, stretch: Any, bar: Any, J: Any) -> Any:
    c = [1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750]
    first = (bar**2).sum()
    shape = sum(
        law.mu * ci / law.limit ** (2 * i) * (first ** (i + 1) - 3 ** (i + 1))
        for i, ci in enumerate(c)
    )
    return shape + ((J**2 - 1) / 2 - np.log(J)) / law.D


def _hyperfoam(law: Any, stretch: Any, bar: Any, J: Any) -> Any:
    total = 0.0
    mu, alpha, nu = np.reshape(law.parameters(), (-1, 3)).T
    for m, a, n in zip(mu, alpha, nu, strict=True):
        beta = n / (1 - 2 * n)
        volume = (J ** (-a * beta) - 1) / beta if beta else -a * np.log(J)
        total += 2 * m / a**2 * ((stretch**a).sum() - 3 + volume)
    return total


#: Energy density by the name of the law in the core, as the manuals have it: of the law, the
#: principal stretches, those of the isochoric deformation, and the ratio of volumes.
ENERGIES: dict[str, Callable[[Any, Any, Any, Any], Any]] = {
    "polynomial": _polynomial,
    "ogden": _ogden,
    "arruda_boyce": _arruda_boyce,
    "hyperfoam": _hyperfoam,
}
#: Rubber and foam of the list, each with a compressibility.
RUBBER: dict[str, Hyperelastic] = {
    name: law
    for name, law in ((name, make(1.0, 1.0)) for name, make in LAWS.items())
    if getattr(law, "law", "") in ENERGIES
}


def energy(law: Any, stretch: np.ndarray) -> Any:
    """Energy density of three principal stretches, which may be complex."""
    J = stretch.prod()
    return ENERGIES[law.law](law, stretch, stretch * J ** (-1 / 3), J)
