"""Cards of steps: begin, end and times."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.io.deck.drafts import StepDraft
from corota.io.deck.lexer import Card, key
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


def turns_nlgeom_on(deck: Deck, card: str) -> None:
    """A card that makes the steps of CalculiX geometrically nonlinear."""
    if deck.dialect == "calculix" and card not in deck.nonlinear:
        deck.nonlinear.append(card)


def step(deck: Deck, card: Card) -> None:
    """``*STEP[, NLGEOM][, INC=][, AMPLITUDE=RAMP|STEP]``."""
    if deck.step is not None:
        deck.error(
            card, card.where, f"the step of {deck.step.card.where} has no *END STEP before this"
        )
    before = bool(deck.steps and deck.steps[-1].nlgeom)
    nlgeom = before or bool(deck.nonlinear)
    if deck.nonlinear and not card.has("NLGEOM"):
        names = " and ".join(deck.nonlinear)
        turn = "turns" if len(deck.nonlinear) == 1 else "turn"
        deck.note(f"{names} {turn} NLGEOM on in steps that do not say NLGEOM=NO, as in CalculiX")
    if card.has("NLGEOM"):
        nlgeom = (
            deck.choice(card, "NLGEOM", ("YES", "NO", "ON", "OFF", ""), "YES") not in ("NO", "OFF")
            or before
        )
        if before and nlgeom and key(card.value("NLGEOM")) in ("NO", "OFF"):
            deck.notes.append(
                f"{card.where}: NLGEOM=NO after a step with NLGEOM has no effect: large "
                "rotations stay on, because the structure would jump to the solution of the "
                "linear theory"
            )
    limit = deck.parameter_integer(card, "INC", 100, 1)
    ramp = deck.choice(card, "AMPLITUDE", ("RAMP", "STEP"), "RAMP") == "RAMP"
    deck.step = StepDraft(card, nlgeom, limit, ramp, restart=deck.restart)
    deck.steps.append(deck.step)
    deck.material = None


def end_step(deck: Deck, card: Card) -> None:
    """``*END STEP``."""
    deck.no_rows(card)
    if deck.step is None:
        deck.error(card, card.where, "there is no open *STEP")
    elif deck.step.procedure is None:
        deck.error(
            card,
            card.where,
            f"the step of {deck.step.card.where} has no procedure",
            hint="put *STATIC after *STEP",
        )
    elif deck.step.card.has("PERTURBATION") and deck.step.make is None:
        _perturb(deck, deck.step)
    elif deck.step.make in (None, Dynamic) and any(s.perturbs for s in deck.steps):
        deck.error(
            deck.step.card,
            deck.step.card.where,
            "a step after a linear perturbation starts from the state before that one, which is "
            "not part of this version",
            hint="put it into another deck",
        )
    deck.step = None


def _perturb(deck: Deck, now: StepDraft) -> None:
    """Make a static step with ``PERTURBATION`` a load case of the structure without load.

    Each has its own loads and supports, and those of the model. As everything is linear, it does
    not matter that it starts from the load case before.
    """
    if any(not s.perturbs and s.make is None for s in deck.steps if s is not now):
        deck.error(
            now.card,
            now.card.at("PERTURBATION"),
            "a linear perturbation of a loaded state is not part of this version",
            hint="leave PERTURBATION out: loads then continue from the step before",
        )
        return
    now.perturbs = True
    now.nlgeom = False
    now.new_loads |= {"force", "distributed", "temperature"}
    if not now.new_supports:
        now.new_supports = len(deck.steps) > 1
        now.supports = (deck.supports if now.new_supports else []) + now.supports
    which = "it is linear" if len(deck.steps) == 1 else "its loads act alone"
    deck.note(f"{now.card.where}: PERTURBATION: {which}")


def open_procedure(deck: Deck, card: Card) -> StepDraft | None:
    """The open step with this card as its procedure; ``None`` after an error."""
    now = open_step(deck, card)
    if now is not None and now.procedure is not None:
        deck.error(card, card.where, "the step already has a procedure")
        return None
    if now is not None:
        now.procedure = card
    return now


def static(deck: Deck, card: Card) -> None:
    """Read ``*STATIC[, DIRECT]``: first increment, period, smallest and largest increment."""
    now = open_procedure(deck, card)
    if now is not None:
        now.direct = card.has("DIRECT")
        step_times(deck, card, now)


def step_times(deck: Deck, card: Card, now: StepDraft) -> None:
    """Read the data line of a procedure: first increment, period, smallest, largest."""
    rows = list(card.rows())
    if len(rows) > 1:
        deck.row_error(card, rows[1], 0, "one data line is expected")
    if not rows:
        return
    deck.extra_fields(card, rows[0], 4)
    names = ("the first increment", "the period", "the smallest increment", "the largest increment")
    values = [deck.real(card, rows[0], i, name, 0.0) for i, name in enumerate(names)]
    for index, value in enumerate(values):
        if value is None:
            return
        if value < 0.0 or (value == 0.0 and index < 2 and rows[0].get(index)):
            deck.row_error(card, rows[0], index, f"{names[index]} must be > 0, not {value:g}")
            return
    first, period, least, most = (float(v or 0.0) for v in values)
    period = period or 1.0
    first = first or period
    if first > period:
        deck.row_error(
            card, rows[0], 0, f"the first increment {first:g} exceeds the period {period:g}"
        )
    elif least > first:
        deck.row_error(
            card, rows[0], 2, f"the smallest increment {least:g} exceeds the first, {first:g}"
        )
    elif most and most < least:
        deck.row_error(
            card, rows[0], 3, f"the largest increment {most:g} is below the smallest, {least:g}"
        )
    else:
        if most and most < first:
            text = f"the first increment {first:g} is reduced to the largest, {most:g}"
            deck.note(f"{rows[0].where}: {text}")
            first = most
        now.times = (first, period, least, most)


def renews(deck: Deck, now: StepDraft | None, card: Card, kind: str) -> bool:
    """Whether a card removes loads of its kind from earlier steps (``OP=NEW``)."""
    new = deck.choice(card, "OP", ("NEW", "MOD"), "MOD") == "NEW"
    if now is None:
        return new
    before = kind in now.said
    now.said.add(kind)
    renewed = now.new_supports if kind == "support" else kind in now.new_loads
    if new and before and not renewed:
        deck.error(
            card,
            card.at("OP"),
            f"OP=NEW comes after another card of the step with {_KINDS[kind]}",
            hint="put OP=NEW on the first of them; CalculiX ignores it here",
        )
    return new


def loads_of(deck: Deck, card: Card, kind: LoadKind) -> StepDraft | None:
    """Return the step that a card of loads belongs to, or None after an error."""
    now = open_step(deck, card)
    if now is not None and renews(deck, now, card, kind):
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


def open_step(deck: Deck, card: Card) -> StepDraft | None:
    """Return the open step, or None after an error."""
    if deck.step is None:
        deck.error(card, card.where, "the card belongs inside a step, between *STEP and *END STEP")
    return deck.step
