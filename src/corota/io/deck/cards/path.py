"""Cards of equilibrium paths and stability: arc length, buckling, solution controls."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.errors import InputError
from corota.io.deck.cards import step as inp_cards_step
from corota.io.deck.cards.step import keeps_preload, open_procedure
from corota.io.deck.lexer import Card, key
from corota.model.paths import ArcLength, Label
from corota.model.steps import Buckle

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck

#: Values of *CONTROLS that are used here: position in its line, option of the step.
_CONTROLS = {"FIELD": (0, "tolerance"), "TIMEINCREMENTATION": (4, "max_iterations")}
#: Kinds of *CONTROLS that change nothing here.
_WITHOUT_EFFECT = ("LINESEARCH", "CONTACT", "CONSTRAINTS")


def static(deck: Deck, card: Card) -> None:
    """``*STATIC``, or ``*STATIC, RIKS``: the path by arc length."""
    if not card.has("RIKS"):
        inp_cards_step.static(deck, card)
    else:
        _riks(deck, card)
    if card.has("STABILIZE") and deck.step is not None and deck.step.procedure is card:
        deck.note(
            f"{card.where}: {card.spelled}: no artificial damping is added; beyond a limit point "
            "the path of equilibrium is followed, through unstable states, to the whole load"
        )
        deck.step.options = {"ramp": deck.step.ramp, "at_limit": "follow", **deck.step.options}
    _take_controls(deck)


def _take_controls(deck: Deck) -> None:
    """Apply ``*CONTROLS`` so far to the open static step."""
    now = deck.step
    static_now = now is not None and now.procedure is not None and now.make is None
    if now is not None and static_now and deck.controls:
        now.options = {"ramp": now.ramp, **now.options, **deck.controls}


def _riks(deck: Deck, card: Card) -> None:
    """First arc, its scale, smallest, largest; ends: load factor; node, dof, displacement."""
    now = open_procedure(deck, card)
    if now is None:
        return
    now.direct = card.has("DIRECT")
    rows = list(card.rows())
    if len(rows) > 1:
        deck.row_error(card, rows[1], 0, "one data line is expected")
        return
    numbers: list[float] = [0.0] * 5
    end: tuple[Label, int, float] | None = None
    if rows:
        row = rows[0]
        deck.extra_fields(card, row, 8)
        names = (
            "the first arc",
            "the scale of arcs",
            "the smallest arc",
            "the largest arc",
            "the load factor at the end",
        )
        for index, name in enumerate(names):
            value = deck.real(card, row, index, name, 0.0)
            if value is None:
                return
            if value < 0.0 and index < 4:
                deck.row_error(card, row, index, f"{name} must be > 0, not {value:g}")
                return
            numbers[index] = value
        if row.get(5):
            node = deck.integer(card, row, 5, "the node that ends the path")
            dof = deck.integer(card, row, 6, "the degree of freedom")
            value = deck.real(card, row, 7, "the displacement at the end")
            if node is None or dof is None or value is None:
                return
            if dof not in (1, 2, 6):
                deck.row_error(card, row, 6, f"expected degree of freedom 1, 2 or 6, found {dof}")
                return
            end = (Label(node), {1: 0, 2: 1, 6: 2}[dof], value)
    first, scale, least, most, factor = numbers
    scale = scale or 1.0
    try:
        path = ArcLength(factor=factor or None, displacement=end, increments=now.max_increments)
    except InputError as error:
        deck.error(card, card.where, error.message)
        return
    now.options = {"ramp": now.ramp, "path": path}
    # Arcs are measured in load factors of the linear structure, the first being its share.
    now.times = (first / scale, 1.0, least / scale, most / scale)


def buckle(deck: Deck, card: Card) -> None:
    """``*BUCKLE``: the number of factors; other entries control other solvers."""
    now = open_procedure(deck, card)
    if now is None:
        return
    rows = list(card.rows())
    count: int | None = 1
    if rows:
        count = deck.integer(card, rows[0], 0, "the number of buckling factors")
        if count is None:
            return
        if count < 1:
            deck.row_error(card, rows[0], 0, f"at least one factor is needed, not {count}")
            return
        if len(rows) > 1:
            deck.row_error(card, rows[1], 0, "one data line is expected")
            return
    preload = keeps_preload(deck, card, now)
    now.make = Buckle
    now.options = {"modes": count, "preload": preload, "dead_loads": True}


def controls(deck: Deck, card: Card) -> None:
    """``*CONTROLS``: tolerance and iterations are used, the rest is noted."""
    if card.has("RESET"):
        deck.controls.clear()
        return
    kind = key(card.value("PARAMETERS"))
    rows = list(card.rows())
    if not kind and (card.has("ANALYSIS") or card.has("TYPE")):
        deck.note(f"{card.where}: *CONTROLS has no effect: increments adapt automatically")
        return
    if kind in _WITHOUT_EFFECT:
        deck.notes.append(f"{card.where}: *CONTROLS, PARAMETERS={kind} has no effect here")
        return
    if kind not in _CONTROLS:
        known = "FIELD, TIME INCREMENTATION, LINE SEARCH, CONTACT, CONSTRAINTS"
        deck.error(card, card.where, f"PARAMETERS must be one of {known}", hint="or write RESET")
        return
    index, option = _CONTROLS[kind]
    if rows and rows[0].get(index):
        if kind == "FIELD":
            value = deck.real(card, rows[0], index, "the tolerance")
            if value is None:
                return
            if value <= 0.0:
                deck.row_error(card, rows[0], index, f"the tolerance must be > 0, not {value:g}")
                return
            # Largest, not mean, forces are the scale here: a looser one would cost accuracy.
            deck.controls[option] = min(value, 1e-9)
        else:
            count = deck.integer(card, rows[0], index, "the number of iterations")
            if count is None:
                return
            if count < 1:
                deck.row_error(
                    card, rows[0], index, f"at least one iteration is needed, not {count}"
                )
                return
            deck.controls[option] = count
    _take_controls(deck)
    deck.notes.append(
        f"{card.where}: of *CONTROLS only a residual tolerance tighter than 1e-9 and the largest "
        "number of iterations are used; increments adapt automatically"
    )
