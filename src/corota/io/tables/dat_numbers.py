"""Numbers and rows of the tables in ``.dat`` files."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def fortran(value: float, digits: int) -> str:
    """A number as Fortran's ``E`` format writes it, with a leading zero: ``0.5000000E+00``."""
    if value == 0.0:
        return f"{0.0:.{digits}f}E+00"
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    exponent = int(power) + 1
    sign = "-" if value < 0 else ""
    return f"{sign}0.{mantissa.lstrip('-').replace('.', '')}E{exponent:+03d}"


def rows(form: str, *columns: NDArray[np.generic]) -> str:
    """Rows of a table; one formatting call for all of them."""
    table: list[object] = []
    for row in zip(*(c.tolist() for c in columns), strict=True):
        table.extend(row)
    return (form * len(columns[0])) % tuple(table)
