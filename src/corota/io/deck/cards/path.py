"""Cards of equilibrium paths and stability: arc length, buckling, solution controls."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.io.deck.card import Card, complete, key
from corota.io.deck.cards.step import keeps_preload, open_procedure, step_times
from corota.io.deck.drafts import PLANAR, StepDraft
from corota.io.deck.keywords import keyword
from corota.model.paths import ArcLength, Label
from corota.model.steps import Buckle

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck

#: Values of *CONTROLS that are used here: position in its line, option of the step.
_CONTROLS = {"FIELD": (0, "tolerance"), "TIMEINCREMENTATION": (4, "max_iterations")}
#: Kinds of *CONTROLS that change nothing here.
_WITHOUT_EFFECT = ("LINESEARCH", "CONTACT", "CONSTRAINTS")


@keyword(
    "STATIC",
    "DIRECT RIKS STABILIZE",
    "SOLVER TIMERESET ALLSDTOL CONTINUE FACTOR ADIABATIC LONGTERM",
)
def static(deck: Deck, card: Card) -> None:
    """``*STATIC[, DIRECT]``: first increment, period, smallest, largest; ``RIKS``: arc length."""
    now = open_procedure(deck, card)
    now.direct = card.has("DIRECT")
    if card.has("RIKS"):
        _riks(card, now)
    else:
        step_times(card, now)
    if card.has("STABILIZE"):
        card.note(
            "no artificial damping is added; beyond a limit point "
            "the path of equilibrium is followed, through unstable states, to the whole load"
        )
        now.options = {"ramp": now.ramp, "at_limit": "follow", **now.options}
    _take_controls(deck)


def _take_controls(deck: Deck) -> None:
    """Apply ``*CONTROLS`` so far to the open static step."""
    now = deck.step
    static_now = now is not None and now.procedure is not None and now.make is None
    if now is not None and static_now and deck.controls:
        now.options = {"ramp": now.ramp, **now.options, **deck.controls}


def _riks(card: Card, now: StepDraft) -> None:
    """First arc, its scale, smallest, largest; ends: load factor; node, dof, displacement."""
    rows = list(card.rows())
    if len(rows) > 1:
        rows[1].refuse(0, "one data line is expected")
    numbers: list[float] = [0.0] * 5
    end: tuple[Label, int, float] | None = None
    if rows:
        row = rows[0]
        row.at_most(8)
        names = [f"the {what}" for what in ("first arc", "scale of arcs", "smallest arc")]
        names += ["the largest arc", "the load factor at the end"]
        for index, name in enumerate(names):
            numbers[index] = row.number(index, name, 0.0)
            if numbers[index] < 0.0 and index < 4:
                row.refuse(index, f"{name} must be > 0, not {numbers[index]:g}")
        if row.get(5):
            label = row.integer(5, "the node that ends the path")
            way = row.integer(6, "the degree of freedom")
            value = row.number(7, "the displacement at the end")
            node, dof = complete([label, way])
            if dof not in PLANAR:
                row.refuse(6, f"expected degree of freedom 1, 2 or 6, found {dof}")
            end = (Label(node), PLANAR[dof], value)
    first, scale, least, most, factor = numbers
    scale = scale or 1.0
    path = ArcLength(factor=factor or None, displacement=end, increments=now.max_increments)
    now.options = {"ramp": now.ramp, "path": path}
    # Arcs are measured in load factors of the linear structure, the first being its share.
    now.times = (first / scale, 1.0, least / scale, most / scale)


@keyword("BUCKLE", ignored="SOLVER EIGENSOLVER")
def buckle(deck: Deck, card: Card) -> None:
    """``*BUCKLE``: the number of factors; other entries control other solvers."""
    now, rows, count = open_procedure(deck, card), list(card.rows()), 1
    if rows:
        count = rows[0].whole(0, "the number of buckling factors")
        if count < 1:
            rows[0].refuse(0, f"at least one factor is needed, not {count}")
        if len(rows) > 1:
            rows[1].refuse(0, "one data line is expected")
    preload = keeps_preload(deck, card, now)
    now.make = Buckle
    now.options = {"modes": count, "preload": preload, "dead_loads": True}


@keyword("CONTROLS", "PARAMETERS RESET", "ANALYSIS TYPE FIELD")
def controls(deck: Deck, card: Card) -> None:
    """``*CONTROLS``: tolerance and iterations are used, the rest is noted."""
    if card.has("RESET"):
        deck.controls.clear()
        return
    kind = key(card.value("PARAMETERS"))
    if not kind and (card.has("ANALYSIS") or card.has("TYPE")):
        deck.note(f"{card.where}: *CONTROLS has no effect: increments adapt automatically")
        return
    if kind in _WITHOUT_EFFECT:
        deck.notes.append(f"{card.where}: *CONTROLS, PARAMETERS={kind} has no effect here")
        return
    if kind not in _CONTROLS:
        known = "FIELD, TIME INCREMENTATION, LINE SEARCH, CONTACT, CONSTRAINTS"
        card.refuse(f"PARAMETERS must be one of {known}", hint="or write RESET")
    index, option = _CONTROLS[kind]
    row = next(card.rows(), None)
    if row is not None and row.get(index) and kind == "FIELD":
        (value,) = row.positive(("the tolerance",), index)
        # Largest, not mean, forces are the scale here: a looser one would cost accuracy.
        deck.controls[option] = min(value, 1e-9)
    elif row is not None and row.get(index):
        count = row.whole(index, "the number of iterations")
        if count < 1:
            row.refuse(index, f"at least one iteration is needed, not {count}")
        deck.controls[option] = count
    _take_controls(deck)
    deck.notes.append(
        f"{card.where}: of *CONTROLS only a residual tolerance tighter than 1e-9 and the largest "
        "number of iterations are used; increments adapt automatically"
    )
