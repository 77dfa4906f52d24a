"""Supports that a step releases, as the supports that remain."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.loads import Fixed
    from corota.model.model import Model
    from corota.model.steps import Step


def without_releases(model: Model, steps: Sequence[Step]) -> tuple[Model, list[Step]]:
    """The same model and steps, in which a step with a release begins with new supports.

    Programs whose decks can end all supports at once only take this form. Supports of the model
    become those of the first step. Without a release both are returned as they are.
    """
    if not any(s.free for step in steps for s in step.supports):
        return model, list(steps)
    same = copy(model)
    same.supports = []
    acting: list[Fixed] = []
    found = []
    for index, step in enumerate(steps):
        own = step.supports
        if index == 0 or step.new_supports:
            own = [*model.supports, *own]
        freed = any(s.free for s in own)
        acting = [] if step.new_supports else acting
        for support in own:
            acting = [s for s in acting if not s.same_dofs(support)]
            acting += [] if support.free else [support]
        new = step.new_supports or freed
        found.append(replace(step, new_supports=new, supports=acting if new else own))
    return same, found
