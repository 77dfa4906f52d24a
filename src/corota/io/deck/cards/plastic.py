"""Cards of plasticity: ``*PLASTIC`` and ``*CYCLIC HARDENING``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import fields
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from corota.errors import InputError
from corota.io.deck import numerals
from corota.io.deck.cards.material import open_material
from corota.io.deck.cards.rates import johnson_cook
from corota.io.deck.drafts import CurveDraft, MaterialDraft, PlasticDraft
from corota.model.hill import Hill
from corota.model.plasticity import Mises, Voce

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card

#: Back-stresses that one material may have.
MOST_BACK_STRESSES = 20


def plastic(deck: Deck, card: Card) -> None:
    """``*PLASTIC[, HARDENING=][, RATE=]``: yield stress against plastic strain, or parameters."""
    found = open_material(deck, card)
    if found is None:
        return
    kinds = ("ISOTROPIC", "KINEMATIC", "COMBINED", "JOHNSONCOOK")
    kind = deck.choice(card, "HARDENING", kinds, "ISOTROPIC")
    if kind == "JOHNSONCOOK":
        johnson_cook(deck, card)
        return
    if card.has("RATE"):
        _curve_of_rate(deck, card, found, kind)
        return
    data = deck.choice(card, "DATATYPE", ("HALFCYCLE", "PARAMETERS"), "HALFCYCLE")
    if data == "PARAMETERS" and kind != "COMBINED":
        deck.error(card, card.at("DATATYPE"), "DATA TYPE=PARAMETERS needs HARDENING=COMBINED")
        return
    if found.plastic is not None and found.plastic.card is not None:
        deck.error(card, card.where, f"material {found.name} already has a *PLASTIC")
        return
    draft = found.plastic = found.plastic or PlasticDraft()
    draft.card, draft.kind = card, kind
    if data == "PARAMETERS":
        draft.ready = _parameters(deck, card, draft)
        return
    table = _table(deck, card)
    draft.ready = table is not None
    if table is None:
        return
    draft.curves = table
    long = next((curve for curve in table if len(curve.points) > 2), None)
    if kind != "ISOTROPIC" and long is not None:
        row = next(row for row in card.rows() if row.where == long.rows[2])
        deck.row_error(
            card,
            row,
            0,
            "kinematic hardening from a table is linear: two rows at a temperature; for a curve "
            "give HARDENING=COMBINED, DATA TYPE=PARAMETERS with several back-stresses",
        )
        draft.ready = False


def _curve_of_rate(deck: Deck, card: Card, found: MaterialDraft, kind: str) -> None:
    """One of several curves, each at a rate of the plastic strain."""
    rate = deck.parameter_number(card, "RATE", 0.0, 0.0)
    draft = found.plastic = found.plastic or PlasticDraft()
    if kind != "ISOTROPIC" or (draft.card is not None and not draft.rated):
        deck.error(card, card.at("RATE"), "RATE= belongs to isotropic tables, in every *PLASTIC")
        return
    table = _table(deck, card)
    draft.ready = draft.ready and table is not None
    if table is None:
        return
    if len(table) > 1:
        deck.error(card, card.at("RATE"), "curves by rate take one temperature")
        draft.ready = False
        return
    if any(other == rate for other, _ in draft.rated):
        deck.error(card, card.at("RATE"), f"the rate {rate:g} is given twice")
        draft.ready = False
        return
    if draft.card is None or rate < min(other for other, _ in draft.rated):
        # The curve at the lowest rate is that below it too.
        draft.card, draft.curves = card, table
    draft.rated.append((rate, table[0].points))


def _parameters(deck: Deck, card: Card, draft: PlasticDraft) -> bool:
    """Yield stress, then C and gamma of each back-stress, up to eight numbers a line."""
    count = 1
    if card.has("NUMBERBACKSTRESSES"):
        text = card.value("NUMBERBACKSTRESSES")
        count = int(text) if numerals.is_integer(text) and len(text) < 4 else 0
        if not 1 <= count <= MOST_BACK_STRESSES:
            deck.error(
                card,
                card.at("NUMBERBACKSTRESSES"),
                f"NUMBER BACKSTRESSES must be a whole number from 1 to {MOST_BACK_STRESSES}, "
                f"not {numerals.shown(text)}",
            )
            return False
    rows = list(card.rows())
    wanted = 1 + 2 * count
    names = ["the yield stress"]
    for i in range(1, count + 1):
        names += [f"C of back-stress {i}", f"gamma of back-stress {i}"]
    # Behind the last number stands the temperature, at most eight on a line.
    n_rows = -(-wanted // 8) if len(rows) <= -(-wanted // 8) else -(-(wanted + 1) // 8)
    if not rows or len(rows) % n_rows:
        deck.error(
            card,
            card.where,
            f"{wanted} numbers take {n_rows} data lines for each temperature, not {len(rows)}: "
            f"{', '.join(names)}, the temperature",
        )
        return False
    for first in range(0, len(rows), n_rows):
        mine = rows[first : first + n_rows]
        values: list[float] = []
        for index, name in enumerate(names):
            row_number, column = divmod(index, 8)
            value = deck.real(card, mine[row_number], column, name)
            if value is None:
                return False
            values.append(value)
        row_number, column = divmod(wanted, 8)
        at: float | None = 0.0
        if row_number < n_rows:
            at = deck.real(card, mine[row_number], column, "the temperature", 0.0)
        if at is None:
            return False
        back = list(zip(values[1::2], values[2::2], strict=True))
        draft.curves.append(CurveDraft(at, [(values[0], 0.0)], [mine[0].where], back))
    return _distinct(deck, card, draft.curves)


def _distinct(deck: Deck, card: Card, curves: list[CurveDraft]) -> bool:
    """Whether each temperature has one curve; reports an error otherwise."""
    found = sorted(curve.temperature for curve in curves)
    twice = next((a for a, b in pairwise(found) if a == b), None)
    if twice is None:
        return True
    deck.error(card, card.where, f"the temperature {twice:g} is given twice")
    return False


def _table(deck: Deck, card: Card) -> list[CurveDraft] | None:
    """Rows of stress, plastic strain (default 0), temperature; a curve at each temperature."""
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: yield stress, plastic strain")
        return None
    curves: list[CurveDraft] = []
    for row in rows:
        stress = deck.real(card, row, 0, "the yield stress")
        strain = deck.real(card, row, 1, "the plastic strain", 0.0)
        at = deck.real(card, row, 2, "the temperature", 0.0)
        if stress is None or strain is None or at is None:
            return None
        deck.extra_fields(card, row, 3)
        if not curves or curves[-1].temperature != at:
            curves.append(CurveDraft(at, [], []))
        curves[-1].points.append((stress, strain))
        curves[-1].rows.append(row.where)
    if not _distinct(deck, card, curves):
        return None
    if len(curves) == 1 and rows[0].get(2):
        note = f"the temperature {rows[0].get(2)} in *{card.keyword} is ignored"
        deck.note(f"{rows[0].where}: {note}")
    return curves


def potential(deck: Deck, card: Card) -> None:
    """``*POTENTIAL``: R11, R22, R33, R12, R13, R23; the last two are out of the plane."""
    found = open_material(deck, card)
    rows = list(card.rows())
    if found is None:
        return
    if len(rows) != 1:
        deck.error(card, card.where, "one data line is expected: R11, R22, R33, R12, R13, R23")
        return
    values = []
    for index, name in enumerate(("R11", "R22", "R33", "R12")):
        value = deck.real(card, rows[0], index, name)
        if value is None:
            return
        values.append(value)
    deck.extra_fields(card, rows[0], 6)
    found.potential, found.potential_card = tuple(values), card


def cyclic_hardening(deck: Deck, card: Card) -> None:
    """``*CYCLIC HARDENING[, PARAMETERS]``: size of the yield surface against plastic strain."""
    found = open_material(deck, card)
    if found is None:
        return
    draft = found.plastic = found.plastic or PlasticDraft()
    if draft.cyclic_card is not None:
        deck.error(card, card.where, f"material {found.name} already has a *CYCLIC HARDENING")
        return
    draft.cyclic_card = card
    if not card.has("PARAMETERS"):
        draft.cyclic = _table(deck, card)
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: yield stress, Q, b")
        return
    curves = []
    for row in rows:
        values = [deck.real(card, row, i, n) for i, n in enumerate(("the yield stress", "Q", "b"))]
        at = deck.real(card, row, 3, "the temperature", 0.0)
        deck.extra_fields(card, row, 4)
        if None in values or at is None:
            return
        initial, q, b = (float(v or 0.0) for v in values)
        curves.append(CurveDraft(at, [(initial, 0.0)], [row.where], voce=(q, b)))
    if _distinct(deck, card, curves):
        draft.cyclic = curves


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
            _hill(_mises(p.kind, curve, cyclic.get(curve.temperature), elastic, common), ratios),
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
    kind: str,
    curve: CurveDraft,
    cyclic: CurveDraft | None,
    elastic: Callable[[float], tuple[float, float]],
    common: dict[str, Any],
) -> Mises:
    """The material at one temperature."""
    e, nu = elastic(curve.temperature)
    # The check of the curve names the row.
    plain = Mises(e, nu, yield_curve=curve.points, rows=curve.rows, **common)
    if kind == "ISOTROPIC":
        return plain
    back = list(curve.back)
    if len(curve.points) == 2:
        (s0, _), (s1, p1) = curve.points
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
