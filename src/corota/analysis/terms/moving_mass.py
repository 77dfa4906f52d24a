"""The mass for gravity and spin in a static step.

A static state is an equilibrium of the dynamic step that follows only if its weight is that of the
mass in motion: lumped and redistributed masses load other nodes than the consistent mass does, with
the same sum.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from corota.model.steps import Dynamic, Frequency, Step


@dataclass(frozen=True)
class MovingMass:
    """A field of mass.

    Parameters
    ----------
    kind : {"consistent", "constant", "lumped"}
    redistribute : bool
        Whether slave nodes of contact pass their mass to other nodes.
    """

    kind: str = "consistent"
    redistribute: bool = False


def masses_of_steps(steps: Sequence[Step]) -> list[MovingMass]:
    """Mass for each step: that of the dynamic step that is next from there, itself included.

    Where none follows it is that of the last one before. Where there is none at all it is that of
    the next frequency step, so that its modes are about a state of equilibrium, or consistent.
    """
    motion: Dynamic | None = None
    modes: Frequency | None = None
    for step in steps:
        motion = step if isinstance(step, Dynamic) else motion
    found: list[MovingMass] = []
    for step in reversed(steps):
        motion = step if isinstance(step, Dynamic) else motion
        modes = step if isinstance(step, Frequency) else modes
        if motion is not None and motion.scheme == "central_difference":
            found.append(MovingMass("lumped"))
        elif motion is not None:
            found.append(MovingMass(motion.mass, motion.redistribute))
        else:
            found.append(MovingMass() if modes is None else MovingMass(modes.mass))
    return found[::-1]
