"""Numbers and rows of the tables in ``.dat`` files."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.arrays import Floats


def fortran(value: float, digits: int) -> str:
    """A number as Fortran's ``E`` format writes it, with a leading zero: ``0.5000000E+00``."""
    if value == 0.0:
        return f"{0.0:.{digits}f}E+00"
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    exponent = int(power) + 1
    sign = "-" if value < 0 else ""
    return f"{sign}0.{mantissa.lstrip('-').replace('.', '')}E{exponent:+03d}"


def statistics(
    what: str,
    time: float,
    gap: str,
    force: Sequence[float] | Floats,
    part: tuple[float, Floats, Floats],
    last: str,
    bends: bool = False,
) -> str:
    """Resultant on a surface, its place and direction.

    Parameters
    ----------
    what : str
        Names of the surfaces.
    gap, last : str
        Blank within a title, and the title of the last table, in which CalculiX's two tables
        differ.
    force : sequence of float
        Force x, y and moment about the origin.
    part : float, ndarray, ndarray
        Area, center and mean normal.
    bends : bool
        Whether the last table has the torque and the bending moment.
    """
    area, center, normal = part
    fx, fy, moment = (float(v) for v in force)
    about = moment - (center[0] * fy - center[1] * fx)
    along = float(np.array([fx, fy]) @ normal)
    across = math.hypot(fx - along * normal[0], fy - along * normal[1])
    tables = {
        f"total surface force (fx,fy,fz) and moment about the origin{gap}(mx,my,mz)": (
            fx,
            fy,
            0.0,
            0.0,
            0.0,
            moment,
        ),
        "center of gravity and mean normal": (*center, 0.0, *normal, 0.0),
        "moment about the center of gravity(mx,my,mz)": (0.0, 0.0, about),
        last: (area, along, across, *((0.0, abs(about)) if bends else ())),
    }
    text = f"\n statistics for {what} and time {fortran(time, 7):>14}\n"
    for title, values in tables.items():
        text += f"\n   {title}\n\n    " + " ".join(f"{float(v) + 0.0:13.6E}" for v in values) + "\n"
    return text


def rows(form: str, *columns: NDArray[np.generic]) -> str:
    """Rows of a table; one formatting call for all of them."""
    table: list[object] = []
    for row in zip(*(c.tolist() for c in columns), strict=True):
        table.extend(row)
    return (form * len(columns[0])) % tuple(table)
