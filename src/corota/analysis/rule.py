"""What an increment makes of its unknowns: the state point of the terms, and their equation."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.term import StatePoint

if TYPE_CHECKING:
    from corota.analysis.constraints.elimination import Constraints, LinearizedConstraints
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.elements import Elements
    from corota.arrays import Floats


class Rule:
    """Statics: the state at the end of the increment, at rest; time schemes derive from it."""

    #: Whether bodies have inertia.
    moves = False

    def point(self, u: Floats, step_time: float) -> StatePoint:
        """State at which the terms are evaluated for displacements at the end."""
        still = np.zeros(len(u))
        return StatePoint(u, step_time, still, still)

    def add_elements(self, elements: Elements, point: StatePoint, at: Evaluation) -> None:
        """Fill in the forces of the elements, to which the other terms add."""
        elements.add(point, at)

    def link(self, constraints: Constraints, u: Floats) -> LinearizedConstraints:
        """The constraints linearized for displacements at the end."""
        return constraints.link(u)

    def close(self, point: StatePoint, at: Evaluation) -> None:
        """Weigh what the terms have added, and add inertia and damping."""

    def improve(self, du: Floats, driven: bool) -> Floats:
        """A Newton correction that converges faster, where supports are `driven` or not."""
        return du


class AtVelocity(Rule):
    """A state in motion: terms see its velocity.

    Parameters
    ----------
    v : ndarray, shape (n_dofs,)
    """

    def __init__(self, v: Floats) -> None:
        self.v = v

    def point(self, u: Floats, step_time: float) -> StatePoint:
        return StatePoint(u, step_time, self.v, np.zeros(len(u)))


#: Statics.
REST = Rule()
