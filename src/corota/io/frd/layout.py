"""What a ``.frd`` file consists of: element types, names of result blocks, their components.

Source: CalculiX GraphiX manual, "Result Format"; layout checked against files of CalculiX 2.20.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass

from corota.mesh.kinds import KINDS
from corota.results.table import requests

#: Our kinds: type number in the file, and nodes of it that the type has.
ELEMENTS = {name: kind.frd for name, kind in KINDS.items() if kind.frd}
#: Nodes of each type number; the first six are solids.
NODES = {1: 8, 2: 6, 3: 4, 4: 20, 5: 15, 6: 10, **dict(ELEMENTS.values())}
#: Type number to our kind: the one that has just its nodes.
NAMES = {number: name for name, (number, count) in ELEMENTS.items() if count == KINDS[name].count}


@dataclass(frozen=True)
class Block:
    """One result block.

    Parameters
    ----------
    name : str
        As in the file.
    components : tuple of (str, int, int, int)
        Name, kind (1 scalar, 2 vector, 4 tensor), row and column.
    request : str
        The variable that requests it in ``*NODE FILE``, ``*EL FILE`` or ``*CONTACT FILE``.
    size : str
        Name of the length of a vector that viewers compute; empty for none.
    """

    name: str
    components: tuple[tuple[str, int, int, int], ...]
    request: str
    size: str = ""


def _vector(name: str, letter: str, request: str) -> Block:
    parts = tuple((f"{letter}{i}", 2, i, 0) for i in (1, 2, 3))
    return Block(name, parts, request, "ALL")


def _tensor(name: str, letter: str, request: str) -> Block:
    rows = (("XX", 1, 1), ("YY", 2, 2), ("ZZ", 3, 3), ("XY", 1, 2), ("YZ", 2, 3), ("ZX", 3, 1))
    return Block(name, tuple((letter + part, 4, i, j) for part, i, j in rows), request)


def _scalars(name: str, names: tuple[str, ...], request: str) -> Block:
    return Block(name, tuple((part, 1, 0, 0) for part in names), request)


def _block(name: str) -> Block:
    """The block of an output variable, or one of its name."""
    row = requests()[name]
    if row.tensor:
        return _tensor(row.block, row.letter, row.request or name)
    if row.size[0]:
        return _vector(row.block, row.letter, row.request or name)
    return _scalars(row.block, (row.letter or row.block,), row.request or name)


DISP, VELO, FORC, STRESS, TOSTRAIN, NDTEMP = map(_block, ("U", "V", "RF", "S", "E", "NT"))
#: Size and phase in degrees of complex modes.
PDISP = Block(
    "PDISP",
    tuple(
        (f"{part}{i}", 12, i + 3 * (part == "PHA"), 0) for part in ("MAG", "PHA") for i in (1, 2, 3)
    ),
    "PU",
)
CONTACT = _scalars("CONTACT", ("COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2"), "CSTR")
#: Axial stress of beams at their surfaces, by the name of its values at both ends.
SURFACES = {
    side: _scalars(name, (name,), "S") for side, name in (("SR", "SRIGHT"), ("SL", "SLEFT"))
}


def blocks() -> list[Block]:
    """Blocks in the order in which they are written, which is CalculiX's; ours come last."""
    first = [DISP, VELO, NDTEMP, STRESS, TOSTRAIN, FORC]
    numbers = [row.name for row in requests().values() if row.block and not row.frame]
    scalars = [_block(name) for name in numbers if not requests()[name].tensor]
    known = ("PE", "ENER")  # as CalculiX orders them
    scalars.sort(key=lambda block: known.index(block.name) if block.name in known else len(known))
    return [*first, *scalars[:2], CONTACT, *scalars[2:], *SURFACES.values()]
