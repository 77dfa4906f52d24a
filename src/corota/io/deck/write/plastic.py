"""Plasticity of a material as ``*PLASTIC`` and ``*CYCLIC HARDENING``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.errors import UnsupportedError
from corota.io.deck.write.text import number, numbers
from corota.model.hill import Hill
from corota.model.johnson_cook import JohnsonCook
from corota.model.material_table import MaterialTable
from corota.model.plasticity import Mises, Voce
from corota.model.rates import Norton, RateCurves, YieldRatio

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.materials import Material
    from corota.model.viscoelastic import Viscoelastic

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
    if isinstance(table[0][1], JohnsonCook):
        return _johnson_cook(table[0][1], len(table) > 1)
    # The temperature follows its numbers.
    rows = [((t,) if t is not None else (), m) for t, m in table if isinstance(m, Mises)]
    if not rows:
        return ""
    rate = rate_cards(rows)
    if not rows[0][1].has_yield or isinstance(rows[0][1].rate, RateCurves):
        return rate
    text = _hardening_cards(material, rows) + rate
    first = rows[0][1]
    if isinstance(first, Hill):
        ratios = (first.R11, first.R22, first.R33, first.R12, 1.0, 1.0)
        text += f"*POTENTIAL\n{numbers(ratios)}\n"
    return text


def _johnson_cook(material: JohnsonCook, by_temperature: bool) -> str:
    """Cards of Johnson-Cook plasticity."""
    if material.temperature is not None and not by_temperature:
        raise UnsupportedError(
            f"material {material.name or 'JohnsonCook'}: its temperature has no card in a deck: "
            "use with_temperatures() and the temperatures of the model"
        )
    numbers_ = [material.A, material.B, material.n]
    if material.melting is not None:
        numbers_ += [material.m, material.melting, material.transition]
    text = f"*PLASTIC, HARDENING=JOHNSON COOK\n{numbers(numbers_)}\n"
    if material.C:
        text += f"*RATE DEPENDENT, TYPE=JOHNSON COOK\n{numbers((material.C, material.rate))}\n"
    if material.heat_fraction:
        text += f"*SPECIFIC HEAT\n{numbers((material.specific_heat,))}\n"
        text += f"*INELASTIC HEAT FRACTION\n{numbers((material.heat_fraction,))}\n"
    return text


def rate_cards(rows: Sequence[tuple[tuple[float, ...], Mises]]) -> str:
    """Cards of the rate of plastic flow, or of creep; empty without one."""
    first = rows[0][1]
    rate = first.rate
    if rate is None:
        return ""
    if isinstance(rate, RateCurves):
        assert first.yield_curve is not None
        curves = [(0.0, first.yield_curve), *rate.curves]
        return "".join(
            f"*PLASTIC, RATE={number(at)}\n" + "".join(numbers(point) + "\n" for point in curve)
            for at, curve in curves
        )
    if isinstance(rate, YieldRatio):
        lines = "".join(numbers(row) + "\n" for row in rate.table)
        return f"*RATE DEPENDENT, TYPE=YIELD RATIO\n{lines}"
    if isinstance(rate, Norton):
        lines = "".join(
            numbers((m.rate.A, m.rate.n, m.rate.m, *at)) + "\n"
            for at, m in rows
            if isinstance(m.rate, Norton)
        )
        return f"*CREEP, LAW={rate.hardening.upper()}\n{lines}"
    if any(m.rate != rate for _, m in rows):
        raise UnsupportedError(
            f"material {first.name or 'Mises'}: a rate that follows the temperature has no card "
            "in a deck"
        )
    return f"*RATE DEPENDENT\n{numbers((rate.D, rate.n))}\n"


def _hardening_cards(material: Material, rows: Sequence[tuple[tuple[float, ...], Mises]]) -> str:
    """Cards of the yield stress and its hardening."""
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


def prony_cards(material: Viscoelastic) -> str:
    """Cards of the relaxation of a viscoelastic material; its parent has its own.

    Raises
    ------
    UnsupportedError
        If its temperature differs from that of its times.
    """
    shift = material.shift
    if shift is not None and material.temperature not in (None, shift.T0):
        raise UnsupportedError(
            f"material {material.name or 'Viscoelastic'}: its temperature cannot be written to a "
            "deck: keep the model in Python"
        )
    text = "*VISCOELASTIC, TIME=PRONY\n" + "".join(numbers(row) + "\n" for row in material.terms)
    if shift is not None:
        text += f"*TRS\n{numbers((shift.T0, shift.C1, shift.C2))}\n"
    return text
