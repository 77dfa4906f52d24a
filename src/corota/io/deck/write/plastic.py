"""Plasticity of a material as ``*PLASTIC`` and ``*CYCLIC HARDENING``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.errors import UnsupportedError
from corota.io.deck.write.text import numbers
from corota.model.material_table import MaterialTable
from corota.model.plasticity import Mises, Voce

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.materials import Material

#: Plastic strain up to which a table represents linear hardening, beyond any analysis.
FAR = 100.0
#: Constants on a data line.
PER_ROW = 8


def plastic_cards(material: Material) -> str:
    """Cards of the plastic part; empty for other materials.

    Isotropic hardening alone is a table of ``*PLASTIC``. With back-stresses, or where it
    saturates, ``*PLASTIC, HARDENING=COMBINED`` has the back-stresses and ``*CYCLIC HARDENING`` the
    isotropic part.

    Raises
    ------
    UnsupportedError
        If the isotropic part saturates and grows linearly besides.
    """
    table: Sequence[tuple[float | None, Material]] = [(None, material)]
    if isinstance(material, MaterialTable):
        table = material.table
    # The temperature follows its numbers.
    rows = [((t,) if t is not None else (), m) for t, m in table if isinstance(m, Mises)]
    if not rows:
        return ""
    laws, back = [m.isotropic for _, m in rows], rows[0][1].back_stresses
    if any(isinstance(law, Voce) and law.H for law in laws):
        raise UnsupportedError(
            f"material {material.name or 'Mises'}: the linear part H of Voce hardening has no "
            "card in a deck: give a yield_curve instead, or keep the model in Python"
        )
    saturates = any(isinstance(law, Voce) and law.Q != 0.0 for law in laws)
    curves = [_table(m, at) for at, m in rows]
    if not back and not saturates:
        return "*PLASTIC\n" + "".join(curves)
    if back:
        text = "*PLASTIC, HARDENING=COMBINED, DATA TYPE=PARAMETERS, "
        text += f"NUMBER BACKSTRESSES={len(back)}\n"
        for at, m in rows:
            values = [m.first_yield, *(v for pair in m.back_stresses for v in pair), *at]
            for start in range(0, len(values), PER_ROW):
                text += numbers(values[start : start + PER_ROW]) + "\n"
    else:
        text = "*PLASTIC, HARDENING=COMBINED\n"
        text += "".join(numbers((m.first_yield, 0.0, *at)) + "\n" for at, m in rows)
    if saturates:
        text += "*CYCLIC HARDENING, PARAMETERS\n"
        for at, m in rows:
            law = m.isotropic
            q, b = (law.Q, law.b) if isinstance(law, Voce) else (0.0, 0.0)
            text += numbers((m.first_yield, q, b, *at)) + "\n"
        return text
    hardens = any(curve.count("\n") > 1 for curve in curves)
    return text + (f"*CYCLIC HARDENING\n{''.join(curves)}" if hardens else "")


def _table(material: Mises, at: tuple[float, ...] = ()) -> str:
    """Rows of yield stress, plastic strain and temperature; after the last the stress stays."""
    curve = material.yield_curve
    if curve is None:
        assert material.yield_stress is not None
        first, law = material.yield_stress, material.isotropic
        slope = 0.0 if isinstance(law, Voce) else float(law)
        curve = [(first, 0.0)] + ([(first + slope * FAR, FAR)] if slope else [])
    return "".join(numbers((*point, *at)) + "\n" for point in curve)


__all__ = ["plastic_cards"]
