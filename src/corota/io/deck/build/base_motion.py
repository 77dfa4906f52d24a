"""Supports whose velocity or acceleration a deck prescribes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.model.integrated import IntegratedAmplitude
from corota.model.steps import Dynamic, ModalDynamic

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import Draft, StepDraft
    from corota.model.model import Model

#: Prescribed quantity by the number of its integrations.
NAMES = {1: "velocity", 2: "acceleration"}


def base_motion(
    deck: Deck, model: Model, draft: Draft, amplitude: str, step: StepDraft
) -> str | None:
    """Name of the integrated amplitude of a support; ``None`` after an error.

    Without an amplitude the value acts at once, or grows over the step with ``AMPLITUDE=RAMP``.
    """
    what = NAMES[draft.order]
    where = draft.card.at("TYPE")
    if step.make not in (Dynamic, ModalDynamic):
        text = f"TYPE={what.upper()} belongs to *DYNAMIC or *MODAL DYNAMIC"
        deck.error(draft.card, where, text, hint="prescribe the displacement in other steps")
        return None
    number = next(i for i, s in enumerate(deck.steps) if s is step)
    later, moved = deck.steps[number + 1 :], deck.steps[:number]
    total = bool(amplitude) and model.amplitudes[amplitude].total_time
    if draft.order == 2 and any(s.make in (Dynamic, ModalDynamic) for s in moved):
        deck.error(
            draft.card,
            where,
            "a prescribed acceleration starts from rest; a dynamic step precedes it",
            hint="give the whole record in the first dynamic step, in TIME=TOTAL TIME",
        )
        return None
    if not total and any(
        s.make in (Dynamic, ModalDynamic) and not s.new_supports and not _again(draft, s)
        for s in later
    ):
        deck.error(
            draft.card,
            where,
            f"the {what} ends with its step, and a later dynamic step does not continue it",
            hint="give it again there, or an amplitude with TIME=TOTAL TIME",
        )
        return None
    begins = sum(s.times[1] for s in moved) if total else 0.0
    name = f"{what} {amplitude or 'constant'} of step {number + 1}"
    if name not in model.amplitudes:
        if amplitude:
            table = model.amplitudes[amplitude]
            time, value = table.time, table.value
        elif step.options.get("ramp"):
            time, value = np.array([0.0, step.times[1]]), np.array([0.0, 1.0])
        else:
            time, value = np.zeros(1), np.ones(1)
        model.amplitudes[name] = IntegratedAmplitude(
            time, value, draft.order, begins, total, name, draft.card.where
        )
    return name


def _again(draft: Draft, step: StepDraft) -> bool:
    """Whether a step defines the same support again."""
    return any(d.target == draft.target and d.index == draft.index for d in step.supports)


__all__ = ["base_motion"]
