"""Active output requests of a step, and those due at an increment."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.model.steps import Output, Step, in_force

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.model import Model
    from corota.results.results import Frame

#: Two times closer than this share of the step's period are the same.
SAME_TIME = 1e-9


def due(output: Output, frame: Frame, step: Step, model: Model) -> bool:
    """Whether a request is due at a frame, except for the last of its step.

    The last one is always due (:func:`left_over`); increment 0, the state before the first
    step, never does.
    """
    if frame.increment == 0:
        return False
    if output.time_points:
        times = np.asarray(model.time_points[output.time_points], dtype=np.float64)
        near = np.abs(times - frame.step_time) <= SAME_TIME * step.period
        return bool(near.any())
    if frame.scalars.get("between increments"):
        return False
    return output.frequency > 0 and frame.increment % output.frequency == 0


class Requests:
    """Output requests of a run."""

    def __init__(self, model: Model, steps: Sequence[Step]) -> None:
        self._model, self._steps, self._in_force = model, steps, in_force(steps)

    def active(self, frame: Frame) -> list[Output]:
        """Requests of the step of a frame; none for a frame of no listed step."""
        return self._in_force[frame.step - 1] if 1 <= frame.step <= len(self._steps) else []

    def due_now(self, frame: Frame) -> list[Output]:
        """Requests that are due at a frame immediately."""
        return [
            o for o in self.active(frame) if due(o, frame, self._steps[frame.step - 1], self._model)
        ]

    def left_over(self, frame: Frame) -> list[Output]:
        """Requests that are due at a frame only because it is the last of its step."""
        if frame.increment == 0:
            return []
        done = self.due_now(frame)
        return [o for o in self.active(frame) if o not in done]

    def wants_file(self, frame: Frame) -> bool:
        """Whether a frame goes into the result file at once.

        Every frame does, unless ``*NODE FILE`` or ``*EL FILE`` requests thin them out.
        """
        if frame.increment == 0 or not any(o.of_file for o in self.active(frame)):
            return True
        return any(o.of_file for o in self.due_now(frame))


def last_of_steps(frames: Sequence[Frame]) -> list[bool]:
    """For each frame, whether it is the last of its step."""
    return [
        i + 1 == len(frames) or frames[i + 1].step != frame.step for i, frame in enumerate(frames)
    ]
