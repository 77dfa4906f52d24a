"""Plasticity of a material as ``*PLASTIC`` and ``*CYCLIC HARDENING``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.errors import UnsupportedError
from corota.io.deck.write.text import number, numbers
from corota.model.plasticity import Mises, Voce

if TYPE_CHECKING:
    from corota.model.materials import Material

#: Plastic strain up to which a table holds linear hardening: no analysis comes near.
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
    if not isinstance(material, Mises):
        return ""
    law, back = material.isotropic, material.back_stresses
    if isinstance(law, Voce) and law.H:
        raise UnsupportedError(
            f"material {material.name or 'Mises'}: the linear part H of Voce hardening has no "
            "card in a deck: give a yield_curve instead, or keep the model in Python"
        )
    saturates = isinstance(law, Voce) and law.Q != 0.0
    if not back and not saturates:
        return "*PLASTIC\n" + _table(material)
    first = material.first_yield
    if back:
        values = [first, *(v for pair in back for v in pair)]
        text = "*PLASTIC, HARDENING=COMBINED, DATA TYPE=PARAMETERS, "
        text += f"NUMBER BACKSTRESSES={len(back)}\n"
        for start in range(0, len(values), PER_ROW):
            text += numbers(values[start : start + PER_ROW]) + "\n"
    else:
        text = f"*PLASTIC, HARDENING=COMBINED\n{number(first)}, 0.\n"
    if saturates:
        assert isinstance(law, Voce)
        return text + f"*CYCLIC HARDENING, PARAMETERS\n{numbers((first, law.Q, law.b))}\n"
    table = _table(material)
    return text + (f"*CYCLIC HARDENING\n{table}" if table.count("\n") > 1 else "")


def _table(material: Mises) -> str:
    """Rows of yield stress and plastic strain; after the last one the stress stays."""
    curve = material.yield_curve
    if curve is None:
        assert material.yield_stress is not None
        first, law = material.yield_stress, material.isotropic
        slope = 0.0 if isinstance(law, Voce) else float(law)
        curve = [(first, 0.0)] + ([(first + slope * FAR, FAR)] if slope else [])
    return "".join(numbers(point) + "\n" for point in curve)


__all__ = ["plastic_cards"]
