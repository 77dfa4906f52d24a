"""Names of the local strain measures, the paper's names for them, and which one to use."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from typing import Literal

from corota.errors import InputError, Location

LocalStrain = Literal["linear", "logarithmic", "green_lagrange", "simplified", "modified"]

#: Measures of the local displacement gradient: its symmetric part, the Hencky strain, and the
#: Green-Lagrange strain.
LOCAL_STRAINS = ("linear", "logarithmic", "green_lagrange")
#: The approaches of Cho, Joo, Shin and Kim (2017). Only the first pages of the paper were
#: available:
#: that its modified approach is the logarithmic strain is our reading.
ALIASES = {"simplified": "linear", "modified": "logarithmic"}
#: Local strain above which the linear measure is no longer accurate.
LARGE_STRAIN = 0.05
#: Strain of elastic bodies in nonlinear steps by the dialect of a deck. CalculiX: linear law
#: between Green-Lagrange strain and second Piola-Kirchhoff stress; Abaqus: logarithmic strain.
ELASTIC_STRAINS: dict[str, LocalStrain] = {
    "calculix": "green_lagrange",
    "abaqus": "logarithmic",
}
#: Advice on the measure, for messages, the check and the documents.
ADVICE = (
    "Up to local strains of 5 % all measures agree. Beyond that, the linear strain of elastic "
    "bodies in Python is a law of its own: use local_strain='logarithmic' to follow Abaqus and "
    "for materials that flow, 'green_lagrange' to follow CalculiX. In decks without LOCAL STRAIN "
    "the dialect decides."
)


def dialect_strain(chosen: LocalStrain, dialect: str) -> LocalStrain:
    """Measure in a deck that gives none.

    Parameters
    ----------
    chosen : str
        That of the material in Python. Laws that flow have the logarithmic strain in every
        dialect: their yield stress is a true stress.
    dialect : {"calculix", "abaqus"}
        Program that the deck was written for.
    """
    return ELASTIC_STRAINS[dialect] if chosen == "linear" else chosen


def local_strain(name: str, where: Location | None = None) -> str:
    """Name of a measure in :data:`LOCAL_STRAINS`, from it or from an alias.

    Blanks, hyphens, underscores and case are ignored.

    Raises
    ------
    InputError
        If there is no such measure.

    Examples
    --------
    >>> local_strain("GREEN LAGRANGE"), local_strain("simplified")
    ('green_lagrange', 'linear')
    """
    if isinstance(name, str) and name in LOCAL_STRAINS:
        return name
    known = {**{n: n for n in LOCAL_STRAINS}, **ALIASES}
    plain = {_plain(n): value for n, value in known.items()}
    found = plain.get(_plain(str(name)))
    if found is None:
        from difflib import get_close_matches

        begun = [n for n in plain if n.startswith(_plain(str(name)))]
        close = begun[:1] or get_close_matches(_plain(str(name)), list(plain), 1, 0.5)
        hint = f"; did you mean {plain[close[0]]!r}?" if close else ""
        raise InputError(
            f"no local strain {name!r}; there are {', '.join(repr(n) for n in LOCAL_STRAINS)} "
            f"(and the paper's names {', '.join(repr(n) for n in ALIASES)}){hint}",
            where,
        )
    return found


def _plain(name: str) -> str:
    return re.sub(r"[\s_-]+", "", name).lower()
