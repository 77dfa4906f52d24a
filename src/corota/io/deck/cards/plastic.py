"""Cards of plasticity: ``*PLASTIC`` and ``*CYCLIC HARDENING``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.errors import InputError
from corota.io.deck import numerals
from corota.io.deck.cards.material import open_material
from corota.io.deck.drafts import PlasticDraft
from corota.model.plasticity import Mises, Voce

if TYPE_CHECKING:
    from corota.errors import Location
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import MaterialDraft
    from corota.io.deck.lexer import Card

#: Back-stresses that one material may have.
MOST_BACK_STRESSES = 20


def plastic(deck: Deck, card: Card) -> None:
    """``*PLASTIC[, HARDENING=]``: yield stress against plastic strain, or parameters."""
    found = open_material(deck, card)
    if found is None:
        return
    kind = deck.choice(card, "HARDENING", ("ISOTROPIC", "KINEMATIC", "COMBINED"), "ISOTROPIC")
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
    draft.curve, draft.rows = table
    if kind != "ISOTROPIC" and len(draft.curve) > 2:
        rows = list(card.rows())
        deck.row_error(
            card,
            rows[2],
            0,
            "kinematic hardening from a table is linear: two rows; for a curve give "
            "HARDENING=COMBINED, DATA TYPE=PARAMETERS with several back-stresses",
        )
        draft.ready = False


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
    values: list[float] = []
    for number, row in enumerate(rows):
        for index in range(min(8, wanted - len(values))):
            value = deck.real(card, row, index, names[len(values)])
            if value is None:
                return False
            values.append(value)
        if len(values) == wanted and number + 1 < len(rows):
            deck.row_error(
                card,
                rows[number + 1],
                0,
                "parameters that depend on temperature are not part of this version",
            )
            return False
    if len(values) < wanted:
        deck.error(card, card.where, f"data are missing: {', '.join(names[len(values) :])}")
        return False
    draft.curve = [(values[0], 0.0)]
    draft.rows = [rows[0].where]
    draft.back = list(zip(values[1::2], values[2::2], strict=True))
    return True


def _table(deck: Deck, card: Card) -> tuple[list[tuple[float, float]], list[Location]] | None:
    """Rows of stress, plastic strain (default 0), temperature (one only)."""
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: yield stress, plastic strain")
        return None
    points, where = [], []
    for row in rows:
        stress = deck.real(card, row, 0, "the yield stress")
        strain = deck.real(card, row, 1, "the plastic strain", 0.0)
        if stress is None or strain is None:
            return None
        deck.extra_fields(card, row, 3)
        if row.get(2) != rows[0].get(2):
            deck.row_error(
                card,
                row,
                2,
                "a yield curve that depends on temperature is not part of this version",
                "give the curve at the temperature of the part alone",
            )
            return None
        points.append((stress, strain))
        where.append(row.where)
    if rows[0].get(2):
        note = f"the temperature {rows[0].get(2)} in *{card.keyword} is ignored"
        deck.note(f"{rows[0].where}: {note}")
    return points, where


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
    values = [deck.real(card, rows[0], i, n) for i, n in enumerate(("the yield stress", "Q", "b"))]
    deck.extra_fields(card, rows[0], 4)
    for row in rows[1:]:
        deck.row_error(
            card, row, 0, "parameters that depend on temperature are not part of this version"
        )
        return
    if None not in values:
        initial, q, b = (float(v or 0.0) for v in values)
        draft.cyclic = ([(initial, 0.0)], [rows[0].where])
        draft.voce = (q, b)


def build_mises(deck: Deck, draft: MaterialDraft) -> Mises | None:
    """Plastic material of a draft with ``*ELASTIC`` and ``*PLASTIC``; ``None`` after an error.

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
    e, nu = draft.constants[:2]
    common: dict[str, Any] = {
        "rho": draft.rho,
        "rayleigh": draft.damping,
        "name": draft.name,
        "where": p.card.where,
    }
    if p.kind == "ISOTROPIC":
        return Mises(e, nu, yield_curve=p.curve, rows=p.rows, **common)
    # The check of the curve names the row.
    Mises(e, nu, yield_curve=p.curve, rows=p.rows, **common)
    back = list(p.back)
    if len(p.curve) == 2:
        (s0, _), (s1, p1) = p.curve
        if s1 > s0:
            back.append(((s1 - s0) / p1, 0.0))
    curve, rows = [p.curve[0]], [p.rows[0]]
    if p.cyclic is not None:
        curve, rows = p.cyclic
        if curve[0][0] != p.curve[0][0]:
            raise InputError(
                f"*CYCLIC HARDENING starts at the yield stress {curve[0][0]:g}, *PLASTIC at "
                f"{p.curve[0][0]:g}: give the same",
                rows[0],
            )
    if p.voce is not None:
        return Mises(
            e, nu, yield_stress=curve[0][0], isotropic=Voce(*p.voce), chaboche=back, **common
        )
    return Mises(e, nu, yield_curve=curve, chaboche=back, rows=rows, **common)
