"""Output variables computed from others at the same point, and their table.

A variable in :data:`DERIVED` is computed with the frames and available wherever
variables at points are: in histories, pictures, tables and result files.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from corota.arrays import Floats
from corota.errors import InputError


class PointValues(Protocol):
    """Fields of a block for a derived variable: :class:`corota.results.results.PointFields`."""

    @property
    def values(self) -> dict[str, Floats]: ...
    @property
    def volume(self) -> Floats: ...


@dataclass(frozen=True)
class Derived:
    """A variable that is a function of others.

    Parameters
    ----------
    function : callable
        Takes the fields of a block of elements, returns an array of shape (n, p) for its n elements
        with p points, or None where the block has no such variable.
    meaning : str
        What it is, with its dimension in brackets.
    """

    function: Callable[[PointValues], Floats | None]
    meaning: str = ""


#: Variables by name; empty unless a user adds some.
DERIVED: dict[str, Derived] = {}


def add_derived(block: PointValues) -> None:
    """Compute the variables of :data:`DERIVED` for a block, in place.

    Raises
    ------
    InputError
        If one does not have one value per point.
    """
    for name, item in DERIVED.items():
        values = item.function(block)
        if values is None:
            continue
        if values.shape != block.volume.shape:
            raise InputError(
                f"the output variable {name!r} has shape {values.shape}; give one value for each "
                f"point: {block.volume.shape}"
            )
        block.values[name] = values
