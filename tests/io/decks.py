"""Ten-line decks for the tests of the reader."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

#: Two squares side by side: nodes 1 to 6, elements 1 and 2.
MESH = """*NODE, NSET=nall
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
*ELEMENT, TYPE=CPS4, ELSET=eall
1, 1, 2, 5, 4
2, 2, 3, 6, 5
"""
SECTION = """*MATERIAL, NAME=steel
*ELASTIC
210000., .3
*SOLID SECTION, ELSET=eall, MATERIAL=steel
2.
"""
SUPPORT = """*BOUNDARY
1, 1, 2
4, 1
"""
STEP = """*STEP, NLGEOM
*STATIC
.1, 1.
*CLOAD
3, 2, -5.
*END STEP
"""
DECK = MESH + SECTION + SUPPORT + STEP


def read(folder: Path, text: str | bytes, **options: object) -> ct.Model:
    """Write a deck and read it."""
    path = folder / "deck.inp"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return ct.read(path, **options)  # type: ignore[arg-type]


def faults(folder: Path, text: str | bytes, **options: object) -> list[ct.errors.Diagnostic]:
    """Diagnostics of a deck that must be refused."""
    try:
        model = read(folder, text, **options)
    except ct.DeckError as error:
        return error.diagnostics
    raise AssertionError(f"the deck was accepted: {model.notes}")
