"""Tables of buckling factors, eigenvalues and masses in the ``.dat`` file, in CalculiX's layout.

Participation and effective mass are CalculiX's: those of the free degrees of freedom alone, which
move as a rigid body along x, y or about the origin. Its columns of motions out of the plane are
zero here.

Source: CalculiX 2.20, ``writebv.f``, ``writeev.f``, ``writeevcomplex.f``, ``effectivemodalmass.f``
(the tests compare with its files).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from itertools import count
from typing import TYPE_CHECKING

from corota.io.tables.dat_numbers import fortran

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from corota.results.results import Frame

#: Name of a factor among the scalars of a frame; numbers count from 1.
FACTOR = "buckling factor {}"
HEAD = (
    "\n     B U C K L I N G   F A C T O R   O U T P U T\n\n"
    " MODE NO       BUCKLING\n                FACTOR\n\n"
)


#: Rigid motions in the plane, by the names of the scalars of a frame.
RIGID = ("x", "y", "rotation")
REAL = (
    "\n     E I G E N V A L U E   O U T P U T\n\n"
    " MODE NO    EIGENVALUE                       FREQUENCY   \n"
    "                                     REAL PART            IMAGINARY PART\n"
    "                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)\n\n"
)
COMPLEX = (
    "\n     E I G E N V A L U E   O U T P U T\n\n"
    " MODE NO                     FREQUENCY   \n"
    "                      REAL PART         IMAGINARY PART\n"
    "             (RAD/TIME)   (CYCLES/TIME)   (RAD/TIME)\n\n"
)
COLUMNS = (
    "\nMODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION"
    "      Z-ROTATION\n\n"
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


def eigenvalue_tables(frame: Frame) -> str:
    """Eigenvalues, participation factors and effective masses of a frame; empty if it has none."""
    found = []
    for number in count(1):
        f = frame.scalars.get(f"frequency {number}")
        if f is None:
            break
        found.append((f, frame.scalars.get(f"growth rate {number}", 0.0)))
    if not found:
        return ""
    if any(rate != 0.0 and f != 0.0 for f, rate in found):
        # A time factor exp(i omega t): decaying modes have a positive imaginary part.
        rows = ((2.0 * math.pi * f, f, -rate) for f, rate in found)
        text = COMPLEX + "".join(_row(k, row) for k, row in enumerate(rows, start=1))
    else:
        rows4 = (
            (4.0 * math.pi**2 * f * f - rate**2, 2.0 * math.pi * f, f, abs(rate))
            for f, rate in found
        )
        text = REAL + "".join(_row(k, row) for k, row in enumerate(rows4, start=1))
    return text + _masses(frame, len(found))


def _masses(frame: Frame, modes: int) -> str:
    """Participation factors, effective masses, and the whole mass that can move."""
    scalars = frame.scalars
    if "moving mass x" not in scalars:
        return ""
    rigid = [[scalars[f"participation {axis} {k}"] for axis in RIGID] for k in range(1, modes + 1)]
    masses = [[value**2 for value in row] for row in rigid]
    sums = [math.fsum(column) for column in zip(*masses, strict=True)]
    whole = [scalars[f"moving mass {axis}"] for axis in RIGID]

    def table(rows: list[list[float]]) -> str:
        return "".join(_row(k, _six(row)) for k, row in enumerate(rows, start=1))

    parts = (
        ("P A R T I C I P A T I O N   F A C T O R S", table(rigid)),
        ("E F F E C T I V E   M O D A L   M A S S", table(masses) + _row("TOTAL  ", _six(sums))),
        ("T O T A L   E F F E C T I V E   M A S S", _row("", _six(whole)) + "\n"),
    )
    return "".join(f"\n     {head}\n{COLUMNS}{body}" for head, body in parts)


def _six(row: Sequence[float]) -> tuple[float, ...]:
    """Numbers of x, y and the rotation among those of space."""
    x, y, turn = row
    return (x, y, 0.0, 0.0, 0.0, turn)


def _row(head: int | str, values: Iterable[float]) -> str:
    return f"{head:>7}" + "".join(f"  {fortran(v, 7):>14}" for v in values) + "\n"
