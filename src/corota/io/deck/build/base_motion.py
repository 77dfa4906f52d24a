"""Supports whose velocity or acceleration a deck prescribes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from corota.io.deck.card import Refused, key
from corota.model.integrated import IntegratedAmplitude, VibrationAmplitude
from corota.model.loads import Fixed
from corota.model.steps import Dynamic, ModalDynamic, SteadyState, Visco

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import Draft, StepDraft
    from corota.model.model import Model

#: Prescribed quantity by the number of its integrations.
NAMES = {1: "velocity", 2: "acceleration"}
#: Procedures that take time; ``None`` is a static step.
TIMED = (None, Dynamic, ModalDynamic, Visco)


def base_motion(deck: Deck, model: Model, draft: Draft, amplitude: str, step: StepDraft) -> str:
    """Name of the integrated amplitude of a support.

    Without an amplitude the value acts at once, or grows over a dynamic step with
    ``AMPLITUDE=RAMP``. A velocity lasts until the support is given again, as in Abaqus.

    Raises
    ------
    Refused
        After an error.
    """
    what = NAMES[draft.order]
    if step.make not in (TIMED if draft.order == 1 else (Dynamic, ModalDynamic)):
        steps = "*DYNAMIC or *MODAL DYNAMIC" if draft.order == 2 else "steps with time"
        text = f"TYPE={what.upper()} belongs to {steps}"
        draft.card.refuse(text, "TYPE", "prescribe the displacement in other steps")
    number = next(i for i, s in enumerate(deck.steps) if s is step)
    later, moved = deck.steps[number + 1 :], deck.steps[:number]
    total = bool(amplitude) and model.amplitudes[amplitude].total_time
    if draft.order == 2 and any(s.make in (Dynamic, ModalDynamic) for s in moved):
        text = "a prescribed acceleration starts from rest; a dynamic step precedes it"
        hint = "give the whole record in the first dynamic step, in TIME=TOTAL TIME"
        draft.card.refuse(text, "TYPE", hint)
    if (
        draft.order == 2
        and not total
        and any(
            s.make in (Dynamic, ModalDynamic) and not s.new_supports and not _again(draft, s)
            for s in later
        )
    ):
        text = f"the {what} ends with its step, and a later dynamic step does not continue it"
        hint = "give it again there, or an amplitude with TIME=TOTAL TIME"
        draft.card.refuse(text, "TYPE", hint)
    lasts = draft.order == 1 or total
    begins = sum(s.times[1] for s in moved if s.make in TIMED) if lasts else 0.0
    name = f"{what} {amplitude or 'constant'} of step {number + 1}"
    if name not in model.amplitudes:
        if amplitude:
            table = model.amplitudes[amplitude]
            time, value = table.time, table.value
            if not total:  # it ends with the step; its last velocity lasts
                inside = time < step.times[1]
                time = np.append(time[inside], step.times[1])
                value = np.append(value[inside], table(step.times[1]))
        elif step.options.get("ramp"):
            time, value = np.array([0.0, step.times[1]]), np.array([0.0, 1.0])
        else:
            time, value = np.zeros(1), np.ones(1)
        if lasts and not total:
            time = time + begins
        model.amplitudes[name] = IntegratedAmplitude(
            time, value, draft.order, begins, lasts, name, draft.card.where
        )
    return name


def base_supports(deck: Deck, model: Model, step: StepDraft, supports: list[Fixed]) -> list[Fixed]:
    """Moves of ``*BASE MOTION``: all dofs of a direction that supports hold at zero.

    Parameters
    ----------
    supports : list of Fixed
        Of the step itself.
    """
    before = [] if step.new_supports else [s for m in model.steps for s in m.supports]
    every = [*model.supports, *before, *supports]
    found: list[Fixed] = []
    for draft in step.base_motions:
        with suppress(Refused):
            found += _moved(deck, model, step, draft, every)
    return found


def _moved(
    deck: Deck, model: Model, step: StepDraft, draft: Draft, every: list[Fixed]
) -> list[Fixed]:
    card = draft.card
    named = (a for a in model.amplitudes.values() if key(a.name) == key(draft.amplitude))
    table = next(named, None)
    if table is None:
        card.refuse(f"no amplitude named {draft.amplitude!r}", "AMPLITUDE")
    held = [s.nodes for s in every if s.dof == draft.index and s.value == 0.0 and not s.amplitude]
    if not held:
        text = f"no support holds dof {draft.index + 1}, which the base moves"
        card.refuse(text, "DOF", hint="fix the nodes at the base by *BOUNDARY")
    name = table.name
    if draft.order and step.make is SteadyState:
        if draft.order == 1:
            card.refuse("in a harmonic step give the displacement or the acceleration", "TYPE")
        name = f"vibration {table.name}"
        made = VibrationAmplitude(table.time, table.value, False, name, card.where)
        model.amplitudes[name] = made
    elif draft.order:
        name = base_motion(deck, model, draft, table.name, step)
    return [Fixed(nodes, draft.index, draft.value[0], name, card.where) for nodes in held]


def _again(draft: Draft, step: StepDraft) -> bool:
    """Whether a step defines the same support again."""
    return any(d.target == draft.target and d.index == draft.index for d in step.supports)
