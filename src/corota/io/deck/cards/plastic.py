"""Cards of plasticity: ``*PLASTIC`` and ``*CYCLIC HARDENING``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import fields
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.io.deck import numerals
from corota.io.deck.cards.material import open_material
from corota.io.deck.cards.rates import johnson_cook
from corota.io.deck.drafts import CurveDraft, MaterialDraft, PlasticDraft
from corota.io.deck.keywords import keyword
from corota.model.hill import Hill
from corota.model.plasticity import Mises, Voce

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.card import Card
    from corota.io.deck.deck import Deck

#: Back-stresses that one material may have.
MOST_BACK_STRESSES = 20


@keyword("PLASTIC", "HARDENING DATATYPE NUMBERBACKSTRESSES RATE DEPENDENCIES", place="model")
def plastic(deck: Deck, card: Card) -> None:
    """``*PLASTIC[, HARDENING=][, RATE=]``: yield stress against plastic strain, or parameters."""
    found = open_material(deck, card)
    kinds = ("ISOTROPIC", "KINEMATIC", "COMBINED", "JOHNSONCOOK")
    kind = card.choice("HARDENING", kinds, "ISOTROPIC")
    if kind == "JOHNSONCOOK":
        johnson_cook(deck, card)
        return
    if card.has("RATE"):
        _curve_of_rate(card, found, kind)
        return
    data = card.choice("DATATYPE", ("HALFCYCLE", "PARAMETERS"), "HALFCYCLE")
    if data == "PARAMETERS" and kind != "COMBINED":
        card.refuse("DATA TYPE=PARAMETERS needs HARDENING=COMBINED", "DATATYPE")
    if found.plastic is not None and found.plastic.card is not None:
        card.refuse(f"material {found.name} already has a *PLASTIC")
    draft = found.plastic = found.plastic or PlasticDraft()
    draft.card, draft.kind, draft.ready = card, kind, False
    draft.of_test = deck.dialect == "abaqus"
    draft.curves = _parameters(card) if data == "PARAMETERS" else _table(card)
    long = next((curve for curve in draft.curves if len(curve.points) > 2), None)
    if kind != "ISOTROPIC" and long is not None:
        row = next(row for row in card.rows() if row.where == long.rows[2])
        row.refuse(
            0,
            "kinematic hardening from a table is linear: two rows at a temperature; for a curve "
            "give HARDENING=COMBINED, DATA TYPE=PARAMETERS with several back-stresses",
        )
    draft.ready = True


def _curve_of_rate(card: Card, found: MaterialDraft, kind: str) -> None:
    """One of several curves, each at a rate of the plastic strain."""
    rate = card.number("RATE", 0.0, 0.0)
    draft = found.plastic = found.plastic or PlasticDraft()
    if kind != "ISOTROPIC" or (draft.card is not None and not draft.rated):
        card.refuse("RATE= belongs to isotropic tables, in every *PLASTIC", "RATE")
    ready, draft.ready = draft.ready, False
    table = _table(card)
    if len(table) > 1:
        card.refuse("curves by rate take one temperature", "RATE")
    if any(other == rate for other, _ in draft.rated):
        card.refuse(f"the rate {rate:g} is given twice", "RATE")
    if draft.card is None or rate < min(other for other, _ in draft.rated):
        # The curve at the lowest rate is that below it too.
        draft.card, draft.curves = card, table
    draft.rated.append((rate, table[0].points))
    draft.ready = ready


def _parameters(card: Card) -> list[CurveDraft]:
    """Yield stress, then C and gamma of each back-stress, up to eight numbers a line."""
    count = 1
    if card.has("NUMBERBACKSTRESSES"):
        text = card.value("NUMBERBACKSTRESSES")
        count = int(text) if numerals.is_integer(text) and len(text) < 4 else 0
        if not 1 <= count <= MOST_BACK_STRESSES:
            range_ = f"must be a whole number from 1 to {MOST_BACK_STRESSES}"
            text = f"NUMBER BACKSTRESSES {range_}, not {numerals.shown(text)}"
            card.refuse(text, "NUMBERBACKSTRESSES")
    rows = list(card.rows())
    wanted = 1 + 2 * count
    names = ["the yield stress"]
    for i in range(1, count + 1):
        names += [f"C of back-stress {i}", f"gamma of back-stress {i}"]
    # Behind the last number stands the temperature, at most eight on a line.
    n_rows = -(-wanted // 8) if len(rows) <= -(-wanted // 8) else -(-(wanted + 1) // 8)
    if not rows or len(rows) % n_rows:
        card.refuse(
            f"{wanted} numbers take {n_rows} data lines for each temperature, not {len(rows)}: "
            f"{', '.join(names)}, the temperature"
        )
    curves = []
    for first in range(0, len(rows), n_rows):
        mine = rows[first : first + n_rows]
        values = [mine[i // 8].number(i % 8, name) for i, name in enumerate(names)]
        row_number, column = divmod(wanted, 8)
        at = mine[row_number].number(column, "the temperature", 0.0) if row_number < n_rows else 0.0
        back = list(zip(values[1::2], values[2::2], strict=True))
        curves.append(CurveDraft(at, [(values[0], 0.0)], [mine[0].where], back))
    return _distinct(card, curves)


def _distinct(card: Card, curves: list[CurveDraft]) -> list[CurveDraft]:
    """The curves, if each temperature has one."""
    found = sorted(curve.temperature for curve in curves)
    twice = next((a for a, b in pairwise(found) if a == b), None)
    if twice is not None:
        card.refuse(f"the temperature {twice:g} is given twice")
    return curves


def _table(card: Card) -> list[CurveDraft]:
    """Rows of stress, plastic strain (default 0), temperature; a curve at each temperature."""
    rows = card.lines("yield stress, plastic strain")
    names = ("the yield stress", "the plastic strain", "the temperature")
    curves: list[CurveDraft] = []
    for row in rows:
        stress, strain, at = row.reals(names, 0.0, required=1)
        row.at_most(3)
        if not curves or curves[-1].temperature != at:
            curves.append(CurveDraft(at, [], []))
        curves[-1].points.append((stress, strain))
        curves[-1].rows.append(row.where)
    _distinct(card, curves)
    if len(curves) == 1 and rows[0].get(2):
        note = f"the temperature {rows[0].get(2)} in *{card.keyword} is ignored"
        card.deck.note(f"{rows[0].where}: {note}")
    return curves


@keyword("POTENTIAL", place="model")
def potential(deck: Deck, card: Card) -> None:
    """``*POTENTIAL``: R11, R22, R33, R12, R13, R23; the last two are out of the plane."""
    found = open_material(deck, card)
    row = card.one_line("R11, R22, R33, R12, R13, R23")
    values = row.reals(("R11", "R22", "R33", "R12"))
    row.at_most(6)
    found.potential, found.potential_card = tuple(values), card


@keyword("CYCLIC HARDENING", "PARAMETERS", place="model")
def cyclic_hardening(deck: Deck, card: Card) -> None:
    """``*CYCLIC HARDENING[, PARAMETERS]``: size of the yield surface against plastic strain."""
    found = open_material(deck, card)
    draft = found.plastic = found.plastic or PlasticDraft()
    if draft.cyclic_card is not None:
        card.refuse(f"material {found.name} already has a *CYCLIC HARDENING")
    draft.cyclic_card = card
    if not card.has("PARAMETERS"):
        draft.cyclic = _table(card)
        return
    curves, names = [], ("the yield stress", "Q", "b", "the temperature")
    for row in card.lines("yield stress, Q, b"):
        initial, q, b, at = row.reals(names, 0.0, required=3)
        row.at_most(4)
        curves.append(CurveDraft(at, [(initial, 0.0)], [row.where], voce=(q, b)))
    draft.cyclic = _distinct(card, curves)


def build_mises(
    draft: MaterialDraft, elastic: Callable[[float], tuple[float, float]], **common: Any
) -> list[tuple[float, Mises]] | None:
    """Plastic material of a draft by temperature; ``None`` after an error.

    Parameters
    ----------
    draft : MaterialDraft
        With ``*ELASTIC`` and ``*PLASTIC``.
    elastic : callable
        Young's modulus and Poisson's ratio at a temperature.
    **common
        What all materials have.

    Raises
    ------
    InputError
        With the place, where a number is outside its range.
    """
    p = draft.plastic
    assert p is not None
    if p.card is None:
        assert p.cyclic_card is not None
        raise InputError(
            "*CYCLIC HARDENING needs *PLASTIC, HARDENING=COMBINED in the same material",
            p.cyclic_card.where,
        )
    if p.cyclic_card is not None and p.kind != "COMBINED":
        raise InputError(
            "*CYCLIC HARDENING belongs to *PLASTIC, HARDENING=COMBINED", p.cyclic_card.where
        )
    if draft.law != "ISOTROPIC":
        raise InputError("*PLASTIC needs isotropic constants in *ELASTIC", p.card.where)
    if not p.ready or (p.cyclic_card is not None and p.cyclic is None):
        return None
    common["where"] = p.card.where
    cyclic = {curve.temperature: curve for curve in p.cyclic or ()}
    ratios: dict[str, Any] = {}
    if draft.potential:
        ratios = dict(zip(("R11", "R22", "R33", "R12"), draft.potential, strict=True))
    if len(cyclic) == 1 and len(p.curves) == 1:
        cyclic = {p.curves[0].temperature: next(iter(cyclic.values()))}
    if cyclic and set(cyclic) != {curve.temperature for curve in p.curves}:
        assert p.cyclic_card is not None
        raise InputError(
            "*CYCLIC HARDENING and *PLASTIC are given at different temperatures: give the same",
            p.cyclic_card.where,
        )
    return [
        (
            curve.temperature,
            _hill(_mises(p, curve, cyclic.get(curve.temperature), elastic, common), ratios),
        )
        for curve in p.curves
    ]


def _hill(law: Mises, ratios: dict[str, Any]) -> Mises:
    """The same with the ratios of Hill's yield function, if there are any."""
    if not ratios:
        return law
    own: dict[str, Any] = {f.name: getattr(law, f.name) for f in fields(law)}
    return Hill(**own, **ratios)


def _mises(
    draft: PlasticDraft,
    curve: CurveDraft,
    cyclic: CurveDraft | None,
    elastic: Callable[[float], tuple[float, float]],
    common: dict[str, Any],
) -> Mises:
    """The material at one temperature."""
    e, nu = elastic(curve.temperature)
    # The check of the curve names the row.
    plain = Mises(e, nu, yield_curve=curve.points, rows=curve.rows, **common)
    if draft.kind == "ISOTROPIC":
        return plain
    back = list(curve.back)
    if len(curve.points) == 2:
        (s0, _), (s1, p1) = curve.points
        if cyclic is not None and draft.of_test:
            s1 -= _growth(cyclic, p1)
        if s1 > s0:
            back.append(((s1 - s0) / p1, 0.0))
    points, rows = [curve.points[0]], [curve.rows[0]]
    if cyclic is not None:
        points, rows = cyclic.points, cyclic.rows
        if points[0][0] != curve.points[0][0]:
            raise InputError(
                f"*CYCLIC HARDENING starts at the yield stress {points[0][0]:g}, *PLASTIC at "
                f"{curve.points[0][0]:g}: give the same",
                rows[0],
            )
        if cyclic.voce is not None:
            first, law = points[0][0], Voce(*cyclic.voce)
            return Mises(e, nu, yield_stress=first, isotropic=law, chaboche=back, **common)
    return Mises(e, nu, yield_curve=points, chaboche=back, rows=rows, **common)


def _growth(cyclic: CurveDraft, strain: float) -> float:
    """Growth of the yield surface up to a plastic strain."""
    if cyclic.voce is not None:
        q, b = cyclic.voce
        return q * (1.0 - math.exp(-b * strain))
    stresses, strains = np.array(cyclic.points).T
    return float(np.interp(strain, strains, stresses) - stresses[0])
