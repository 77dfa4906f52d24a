"""Contents and format of the result file of an analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from corota.errors import InputError
from corota.results.derived import DERIVED
from corota.results.table import MEANING, TABLE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.steps import Step

#: Fields by the names of decks, and the arrays that they are in files.
FIELDS: dict[str, tuple[str, ...]] = {}
for _row in TABLE.values():
    _arrays = dict.fromkeys([_row.stored, *(item.array for item in _row.invariants)])
    _request = "U" if _row.name == "UR" else _row.request or _row.name
    FIELDS[_request] = FIELDS.get(_request, ()) + tuple(_arrays)
    FIELDS |= {item.name: (item.array,) for item in _row.invariants}
#: Other names of fields in requests.
ALIASES = {
    "ELSE": "ENER", "NT11": "NT", "LE": "E", "CSTRESS": "CSTR", "CDISP": "CDIS", "UR": "U",
    "SF": "N", "ENERGY": "ENER", "RFM": "RF", "CF": "F",
}  # fmt: skip
#: Always written: it is needed to draw the shape.
ALWAYS = frozenset(FIELDS["U"])
#: Endings of checkpoints, the newest first.
CHECKPOINTS = ("ckpt", "ckpt.1")
#: A level of gzip that takes little time; higher ones gain little on floating-point numbers.
LEVEL = 1


@dataclass(frozen=True)
class FileOptions:
    """What goes into a result file.

    Parameters
    ----------
    points : bool
        Values at the quadrature points too; several times the size.
    single : bool
        Fields as numbers of 4 bytes, with about seven digits.
    fields : {"all", "requested"} or sequence of str
        ``U RF F V A S E ENER PEEQ CSTR CDIS ...`` or names of arrays; ``"requested"`` follows
        ``*NODE FILE``, ``*EL FILE`` and ``*CONTACT FILE``. Displacements are always written.
    compression : int
        Level of gzip from 1 to 9, after sorting bytes by their place; 0 for none.
    parts : int
        Parts of the grid in a VTKHDF file, those that a run on as many processes has: ParaView on
        several processes gives each some of them.
    """

    points: bool = False
    single: bool = False
    fields: str | tuple[str, ...] = "all"
    compression: int = LEVEL
    parts: int = 1

    def __post_init__(self) -> None:
        if not 0 <= self.compression <= 9:
            raise InputError(f"compression is a level from 0 to 9, not {self.compression}")
        if self.parts < 1:
            raise InputError(f"a grid has one part or more, not {self.parts}")
        if isinstance(self.fields, str):
            if self.fields not in ("all", "requested"):
                raise InputError(
                    f"fields={self.fields!r}: give 'all', 'requested' or a list such as ['U', 'S']"
                )
            return
        known = {*FIELDS, *ALIASES, *MEANING, *DERIVED}
        known |= {array for arrays in FIELDS.values() for array in arrays}
        for name in self.fields:
            if name not in known and name.upper() not in known:
                raise InputError(f"unknown field {name!r}; use {', '.join(FIELDS)}, PEEQ, ENER ...")

    def chosen(self, steps: Sequence[Step]) -> frozenset[str] | None:
        """Names of requested arrays; None for all."""
        if self.fields == "all":
            return None
        if self.fields == "requested":
            outputs = [o for s in steps for o in s.outputs if o.of_file]
            if not outputs:
                return None
            names: list[str] = [name for o in outputs for name in o.variables]
        else:
            names = list(self.fields)
        found = set(ALWAYS)
        for name in names:
            upper = ALIASES.get(name.upper(), name.upper())
            found |= set(FIELDS.get(upper, (name, upper)))
        return frozenset(found)


def wanted(name: str, chosen: frozenset[str] | None) -> bool:
    """Whether an array of a file was requested; arrays of pairs and cells like the field."""
    stem = name.partition(": ")[0].removeprefix("cell ")
    return chosen is None or name in chosen or stem in chosen


def from_keywords(options: dict[str, Any]) -> FileOptions:
    """Options from keyword arguments; a list of fields may be any sequence."""
    given = dict(options)
    if not isinstance(given.get("fields", ""), str):
        given["fields"] = tuple(given["fields"])
    try:
        return FileOptions(**given)
    except TypeError as error:
        raise InputError(
            f"{error}; options are points, single, fields, compression, parts"
        ) from None
