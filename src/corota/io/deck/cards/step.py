"""Cards of steps: begin, end and times; headings."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.io.deck.card import Card, key
from corota.io.deck.drafts import StepDraft
from corota.io.deck.keywords import keyword
from corota.model.steps import Dynamic

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.model.loads import LoadKind


#: Cards that ``OP=NEW`` concerns together.
_KINDS = {
    "support": "supports (*BOUNDARY)",
    "force": "nodal forces (*CLOAD)",
    "distributed": "distributed loads (*DLOAD, *DSLOAD)",
    "temperature": "temperatures (*TEMPERATURE)",
}


@keyword("HEADING", ignored="UNITS")
def heading(deck: Deck, card: Card) -> None:
    """``*HEADING``: free text."""
    deck.heading += [row.text.strip() for row in card.rows()]


@keyword("PARAMETER", ignored="DEPENDENT INDEPENDENT")
def parameter(deck: Deck, card: Card) -> None:
    """``*PARAMETER``: its values are already substituted in the text."""


def turns_nlgeom_on(deck: Deck, card: str) -> None:
    """A card that makes the steps of CalculiX geometrically nonlinear."""
    if deck.dialect == "calculix" and card not in deck.nonlinear:
        deck.nonlinear.append(card)


@keyword("STEP", "NLGEOM INC AMPLITUDE PERTURBATION", "NAME UNSYMM EXTRAPOLATION SOLVER CONVERTSDI")
def step(deck: Deck, card: Card) -> None:
    """``*STEP[, NLGEOM][, INC=][, AMPLITUDE=RAMP|STEP]``."""
    if deck.step is not None:
        card.error(f"the step of {deck.step.card.where} has no *END STEP before this")
    before = bool(deck.steps and deck.steps[-1].nlgeom)
    nlgeom = before or bool(deck.nonlinear)
    if deck.nonlinear and not card.has("NLGEOM"):
        names = " and ".join(deck.nonlinear)
        turn = "turns" if len(deck.nonlinear) == 1 else "turn"
        deck.note(f"{names} {turn} NLGEOM on in steps that do not say NLGEOM=NO, as in CalculiX")
    if card.has("NLGEOM"):
        said = card.choice("NLGEOM", ("YES", "NO", "ON", "OFF", ""), "YES")
        nlgeom = said not in ("NO", "OFF") or before
        if before and key(card.value("NLGEOM")) in ("NO", "OFF"):
            deck.notes.append(
                f"{card.where}: NLGEOM=NO after a step with NLGEOM has no effect: large "
                "rotations stay on, because the structure would jump to the solution of the "
                "linear theory"
            )
    limit = card.integer("INC", 100, 1)
    ramp = card.choice("AMPLITUDE", ("RAMP", "STEP"), "RAMP") == "RAMP"
    deck.step = StepDraft(card, nlgeom, limit, ramp, restart=deck.restart)
    deck.steps.append(deck.step)
    deck.material = None


@keyword("END STEP")
def end_step(deck: Deck, card: Card) -> None:
    """``*END STEP``."""
    card.no_rows()
    now, deck.step = deck.step, None
    if now is None:
        card.error("there is no open *STEP")
    elif now.procedure is None:
        text = f"the step of {now.card.where} has no procedure"
        card.error(text, hint="put *STATIC after *STEP")
    elif now.card.has("PERTURBATION") and now.make is None:
        _perturb(deck, now)
    elif now.make in (None, Dynamic) and any(s.perturbs for s in deck.steps):
        text = "a step after a linear perturbation starts from the state before that one, which is"
        now.card.error(f"{text} not part of this version", hint="put it into another deck")


def _perturb(deck: Deck, now: StepDraft) -> None:
    """Make a static step with ``PERTURBATION`` a load case of the structure without load.

    Each has its own loads and supports, and those of the model. As everything is linear, it does
    not matter that it starts from the load case before.
    """
    if any(not s.perturbs and s.make is None for s in deck.steps if s is not now):
        now.card.refuse(
            "a linear perturbation of a loaded state is not part of this version",
            "PERTURBATION",
            "leave PERTURBATION out: loads then continue from the step before",
        )
    now.perturbs, now.nlgeom = True, False
    now.new_loads |= {"force", "distributed", "temperature"}
    if not now.new_supports:
        now.new_supports = len(deck.steps) > 1
        now.supports = (deck.supports if now.new_supports else []) + now.supports
    which = "it is linear" if len(deck.steps) == 1 else "its loads act alone"
    deck.note(f"{now.card.where}: PERTURBATION: {which}")


def open_procedure(deck: Deck, card: Card) -> StepDraft:
    """The open step with this card as its procedure.

    Raises
    ------
    Refused
        If there is none, or it has a procedure.
    """
    now = open_step(deck, card)
    if now.procedure is not None:
        card.refuse("the step already has a procedure")
    now.procedure = card
    return now


def step_times(card: Card, now: StepDraft) -> None:
    """Read the data line of a procedure: first increment, period, smallest, largest."""
    rows = list(card.rows())
    if len(rows) > 1:
        rows[1].error(0, "one data line is expected")
    if not rows:
        return
    row = rows[0]
    row.at_most(4)
    names = ("the first increment", "the period", "the smallest increment", "the largest increment")
    values = row.reals(names, 0.0)
    for index, value in enumerate(values):
        if value < 0.0 or (value == 0.0 and index < 2 and row.get(index)):
            row.refuse(index, f"{names[index]} must be > 0, not {value:g}")
    first, period, least, most = values
    period = period or 1.0
    first = first or period
    if first > period:
        row.refuse(0, f"the first increment {first:g} exceeds the period {period:g}")
    if least > first:
        row.refuse(2, f"the smallest increment {least:g} exceeds the first, {first:g}")
    if most and most < least:
        row.refuse(3, f"the largest increment {most:g} is below the smallest, {least:g}")
    if most and most < first:
        text = f"the first increment {first:g} is reduced to the largest, {most:g}"
        card.deck.note(f"{row.where}: {text}")
        first = most
    now.times = (first, period, least, most)


def renews(now: StepDraft | None, card: Card, kind: str) -> bool:
    """Whether a card removes loads of its kind from earlier steps (``OP=NEW``)."""
    new = card.choice("OP", ("NEW", "MOD"), "MOD") == "NEW"
    if now is None:
        return new
    before = kind in now.said
    now.said.add(kind)
    renewed = now.new_supports if kind == "support" else kind in now.new_loads
    if new and before and not renewed:
        text = f"OP=NEW comes after another card of the step with {_KINDS[kind]}"
        card.error(text, "OP", "put OP=NEW on the first of them; CalculiX ignores it here")
    return new


def loads_of(deck: Deck, card: Card, kind: LoadKind) -> StepDraft:
    """The step that a card of loads belongs to; as :func:`open_step`."""
    now = open_step(deck, card)
    if renews(now, card, kind):
        now.new_loads.add(kind)
    return now


def keeps_preload(deck: Deck, card: Card, now: StepDraft) -> bool:
    """Whether a step starts from stresses and displacements of the steps before.

    As in CalculiX, ``*STEP, PERTURBATION`` requests it; in Abaqus, a step before with NLGEOM does.
    """
    if deck.dialect == "abaqus":
        return any(step.nlgeom for step in deck.steps if step is not now)
    # Linear load cases leave the structure as it was.
    kept = now.card.has("PERTURBATION") and not any(step.perturbs for step in deck.steps)
    if len(deck.steps) > 1 and not kept:
        deck.notes.append(
            f"{card.where}: *{card.keyword} is about the structure without load, as in CalculiX; "
            "write *STEP, PERTURBATION to keep the preload of the steps before"
        )
    return kept


def open_step(deck: Deck, card: Card) -> StepDraft:
    """The open step.

    Raises
    ------
    Refused
        If there is none.
    """
    if deck.step is None:
        card.refuse("the card belongs inside a step, between *STEP and *END STEP")
    return deck.step
