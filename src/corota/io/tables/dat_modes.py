"""Tables of buckling factors in the ``.dat`` file, in CalculiX's layout.

Source: CalculiX 2.20, ``writebv.f``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

from corota.io.tables.dat_numbers import fortran

if TYPE_CHECKING:
    from corota.results.results import Frame

#: Name of a factor among the scalars of a frame; numbers count from 1.
FACTOR = "buckling factor {}"
HEAD = (
    "\n     B U C K L I N G   F A C T O R   O U T P U T\n\n"
    " MODE NO       BUCKLING\n                FACTOR\n\n"
)


def buckling_table(frame: Frame) -> str:
    """Table of the buckling factors of a frame; empty if it has none."""
    rows = []
    for number in count(1):
        value = frame.scalars.get(FACTOR.format(number))
        if value is None:
            break
        rows.append(f"{number:8d}  {fortran(value, 7):>14}\n")
    return HEAD + "".join(rows) if rows else ""


__all__ = ["buckling_table"]
