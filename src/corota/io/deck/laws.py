"""The table of material laws of decks: their constants, materials and cards."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from corota.errors import InputError
from corota.model import hyperelastic as rubber
from corota.model.hill import Hill
from corota.model.johnson_cook import JohnsonCook
from corota.model.material_table import MaterialTable
from corota.model.materials import Elastic, Material, Orthotropic
from corota.model.plasticity import Mises
from corota.model.ramberg_osgood import RambergOsgood


@dataclass(frozen=True)
class DeckLaw:
    """A law whose card holds its constants.

    Parameters
    ----------
    card : str
        The card with its parameters.
    constants : tuple of str
        Names of the constants in the order of the data lines.
    make : callable
        Gives the material from the constants and, by keyword, what all materials have.
    per_row : int
        Constants on a data line.
    optional : int
        Optional constants at the end; they default to zero.
    pieces : int
        Pieces of an interval of temperature in which the constants of the material are straight;
        more than one where they are no linear functions of those of the card.
    writes : tuple of types of Material, optional
        The materials that are written by this card.
    values : callable, optional
        Gives the constants of such a material.
    """

    card: str
    constants: tuple[str, ...]
    make: Callable[..., Material]
    per_row: int = 8
    optional: int = 0
    pieces: int = 1
    writes: tuple[type[Material], ...] = ()
    values: Callable[[Any], Sequence[float]] | None = None


def _lamina(e1: float, e2: float, nu12: float, g12: float, *_: float, **common: Any) -> Material:
    # A lamina has no constants of the third direction: those of the second are used.
    return Orthotropic(e1, e2, e2, nu12, nu12, 0.0, g12, **common)


def _engineering(*constants: float, **common: Any) -> Material:
    return Orthotropic(*constants[:7], **common)


def _stiffness(*constants: float, **common: Any) -> Material:
    """From D1111, D1122, D2222, D1133, D2233, D3333, D1212."""
    d11, d12, d22, d13, d23, d33, g12 = constants[:7]
    stiffness = np.array([[d11, d12, d13], [d12, d22, d23], [d13, d23, d33]])
    if not np.all(np.linalg.eigvalsh(stiffness) > 0.0):
        raise InputError("the stiffness is not positive definite", common["where"])
    s = np.linalg.inv(stiffness)
    e1, e2, e3 = 1.0 / np.diag(s)
    constants = (e1, e2, e3, -s[0, 1] * e1, -s[0, 2] * e1, -s[1, 2] * e2, g12)
    return Orthotropic(*constants, **common)


#: Coefficients of the polynomial of each degree.
_POLYNOMIAL = {n: [f"C{i}{j}" for i, j in rubber.POWERS if i + j <= n] for n in (1, 2, 3)}
_REDUCED = {n: [name for name in names if name.endswith("0")] for n, names in _POLYNOMIAL.items()}


def _polynomial(kind: Any, names: list[str], *constants: float, **common: Any) -> Material:
    names = [*names, *(f"D{i}" for i in range(1, len(constants) - len(names) + 1))]
    return kind(**dict(zip(names, constants, strict=True)), **common)  # type: ignore[no-any-return]


def _stretches(kind: Any, *constants: float, **common: Any) -> Material:
    """From mu and alpha of all terms, then the third constants."""
    count = len(constants) // 3
    pairs = constants[: 2 * count]
    return kind(pairs[::2], pairs[1::2], constants[2 * count :], **common)  # type: ignore[no-any-return]


def _by_column(material: Any) -> list[float]:
    """The reverse of :func:`_stretches`."""
    rows = np.reshape(material.parameters(), (-1, 3))
    return [*rows[:, :2].ravel(), *rows[:, 2]]


def _invariants(
    card: str, kind: type[Material], names: list[str], volumes: int, writes: bool = True
) -> DeckLaw:
    """A law of the invariants, with some compressibilities."""
    every = (*names, *(f"D{i}" for i in range(1, volumes + 1)))
    return DeckLaw(
        f"HYPERELASTIC, {card}",
        every,
        partial(_polynomial, kind, names),
        optional=volumes,
        writes=(kind,) if writes else (),
        values=lambda m: [getattr(m, name) for name in every],
    )


def _terms(card: str, kind: type[Material], third: str, count: int) -> DeckLaw:
    """A law of the stretches with `count` terms."""
    numbers = range(1, count + 1)
    return DeckLaw(
        f"{card}, N={count}",
        (
            *(f"{name}{i}" for i in numbers for name in ("mu", "alpha")),
            *(f"{third}{i}" for i in numbers),
        ),
        partial(_stretches, kind),
        optional=count,
        writes=(kind,),
        values=_by_column,
    )


#: Hyperelastic laws, by name and number of terms.
_HYPERELASTIC = {
    "NEOHOOKE": _invariants("NEO HOOKE", rubber.NeoHooke, ["C10"], 1),
    "MOONEY-RIVLIN": _invariants("MOONEY-RIVLIN", rubber.MooneyRivlin, ["C10", "C01"], 1),
    "YEOH": _invariants("YEOH", rubber.Yeoh, _REDUCED[3], 3),
    **{
        f"POLYNOMIAL{n}": _invariants(f"POLYNOMIAL, N={n}", rubber.Polynomial, names, n, n == 3)
        for n, names in _POLYNOMIAL.items()
    },
    **{
        f"REDUCEDPOLYNOMIAL{n}": _invariants(
            f"REDUCED POLYNOMIAL, N={n}", rubber.Polynomial, names, n, False
        )
        for n, names in _REDUCED.items()
    },
    **{
        f"OGDEN{n}": _terms("HYPERELASTIC, OGDEN", rubber.Ogden, "D", n)
        for n in range(1, rubber.MAX_TERMS + 1)
    },
    "ARRUDA-BOYCE": DeckLaw(
        "HYPERELASTIC, ARRUDA-BOYCE",
        ("mu", "the limit stretch", "D"),
        rubber.ArrudaBoyce,
        optional=1,
        writes=(rubber.ArrudaBoyce,),
        values=rubber.ArrudaBoyce.parameters,
    ),
    **{
        f"HYPERFOAM{n}": _terms("HYPERFOAM", rubber.Hyperfoam, "nu", n)
        for n in range(1, rubber.MAX_TERMS + 1)
    },
}

#: Laws by the keyword of their card without blanks, which `KEYWORDS` takes from here; those of
#: ``*ELASTIC`` by its ``TYPE=``.
LAWS: dict[str, DeckLaw] = {
    "ISOTROPIC": DeckLaw(
        "ELASTIC",
        ("Young's modulus", "Poisson's ratio"),
        Elastic,
        per_row=2,
        optional=1,
        writes=(Elastic, Mises, Hill, JohnsonCook),
        values=lambda m: (m.E, m.nu),
    ),
    "LAMINA": DeckLaw(
        "ELASTIC, TYPE=LAMINA", ("E1", "E2", "nu12", "G12", "G13", "G23"), _lamina, optional=2
    ),
    "ENGINEERINGCONSTANTS": DeckLaw(
        "ELASTIC, TYPE=ENGINEERING CONSTANTS",
        ("E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23"),
        _engineering,
        optional=2,
        writes=(Orthotropic,),
        values=lambda m: (*m.parameters()[:7], m.G12, m.G12),
    ),
    "ORTHOTROPIC": DeckLaw(
        "ELASTIC, TYPE=ORTHO",
        ("D1111", "D1122", "D2222", "D1133", "D2233", "D3333", "D1212", "D1313", "D2323"),
        _stiffness,
        optional=2,
        pieces=64,
    ),
    "DEFORMATIONPLASTICITY": DeckLaw(
        "DEFORMATION PLASTICITY",
        ("Young's modulus", "Poisson's ratio", "the yield stress", "the exponent", "the offset"),
        RambergOsgood,
        per_row=5,
        writes=(RambergOsgood,),
        values=RambergOsgood.parameters,
    ),
    **_HYPERELASTIC,
}


def law_cards(material: Material, number: Callable[[float], str]) -> str | None:
    """The card of a material's law; ``None`` where there is none."""
    table: Sequence[tuple[float | None, Material]] = [(None, material)]
    if isinstance(material, MaterialTable):
        table = material.table
    first = table[0][1]
    law = next(
        (
            law
            for law in LAWS.values()
            if type(first) in law.writes
            and law.values is not None
            and len(law.values(first)) == len(law.constants)
        ),
        None,
    )
    if law is None:
        return None
    assert law.values is not None
    text = f"*{law.card}\n"
    for temperature, own in table:
        values = [number(v) for v in law.values(own)]
        rows = [values[i : i + law.per_row] for i in range(0, len(values), law.per_row)]
        if temperature is not None:
            rows[-1].append(number(temperature))
        text += "".join(", ".join(row) + "\n" for row in rows)
    return text
