"""Gaps, slips and their gradients, at a state and over an increment; kinks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from corota._core import CLOSED, SLIPPING

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.arrays import Bools, Floats, Ints

    States = list[NDArray[np.int8]]


#: Rounding bound: relative difference of lengths, areas, parts of a way and forces that is
#: rounding.
SAME = 1e-9
#: Rest of Newton's method over its whole, as of a length over an edge: depth up to which a node
#: touches (as where a node of the other side carries both), that a fixed surface may be pressed
#: into another fixed one, slip that turns the friction of a node round whose stiffness does not
#: count; residual from which only digits are missing: states that do
#: not change any more are those of the end; stiffness of springs that relaxation leaves out.
SMALL = 1e-6
#: Regularization of redundant constraints: compliance of closed ones relative to that of their
#: nodes: constraints that follow from others then leave a matrix regular, and share the force.
COMPLIANCE = 1e-10
#: Search radius, in lengths that a correction was to go: beyond it lies another equilibrium, or
#: another kink. Under forces twice of it passes a limit point unseen.
FAR = 4.0
#: Force of a correction, over what a constraint or a kink can carry, from which it is not
#: followed: the constraint slips at once, the bodies do not rest at the kink.
EXCESS = 2.0
#: Entries of a table that is filled at once, and of a matrix that is kept dense, with a row and a
#: column for each constraint of a complementarity problem (memory and cost alone).
AT_ONCE = 100_000
#: Bisections of an interval down to its rounding.
HALVINGS = 44
#: Tries without progress, or returns of a set of states, before all states are chosen together or a
#: kink is searched, and before that is given up.
WAITED = 3
#: Tries without progress, or returns of a set of states, before an increment is cut: few that take
#: more converge. The choice of states may take `WAITED` times as many iterations besides those of
#: Newton's method, and as many in an explicit step.
PATIENCE = 8


@dataclass
class Terms:
    """Gaps and slips of one pair at a state: of its n constraints, each the sum of some terms."""

    gap: Floats  # weighted gap of each constraint [length^3], shape (n,)
    slip: Floats  # the same of the slip
    area: Floats  # that is covered [length^2], shape (n,)
    constraint: Ints  # of each term, shape (m,)
    pair: Ints  # candidate pair of the core, shape (m,)
    variables: Ints  # ``3 node + component``, -1 for none, shape (m, v)
    gap_gradient: Floats  # shape (m, v)
    slip_gradient: Floats
    #: Gap and area of each node before neighbors share constraints, shapes (n,).
    parts: tuple[Floats, Floats]
    #: Unmodified gaps and areas, where a condition on rates has changed them.
    bare: Terms | None = None
    #: Gradients along which tractions act that are those of an increment, not of its end.
    between: Terms | None = None

    @property
    def acting(self) -> Terms:
        """Terms along whose gradients the tractions act."""
        return self if self.between is None else self.between


@dataclass(eq=False)
class ContactState:
    """All pairs at a state; none by default."""

    terms: list[Terms] = field(default_factory=list)
    #: Of the pairs on the nodes, along the axes of the nodes, and the sum of the sizes of its
    #: parts, shapes (n_dofs,).
    force: Floats = field(default_factory=partial(np.zeros, 0))
    size: Floats = field(default_factory=partial(np.zeros, 0))
    multipliers: Floats = field(default_factory=partial(np.zeros, 0))  # shape (n_multipliers,)
    damping: Floats | None = None  # stabilizing stiffness of this increment, shape (n_dofs,)
    #: Force at the end, where a scheme weighs that of pressure laws between both ends.
    of_end: Floats | None = None
    #: Once committed: states of the constraints, terms along whose gradients the forces acted, and
    #: the positions at which they did, shape (n_nodes, 3).
    states: list[NDArray[np.int8]] = field(default_factory=list)
    acting: list[Terms] = field(default_factory=list)
    where: Floats | None = None
    settled: list[NDArray[np.int8]] = field(default_factory=list)  # states at a point of a path
    time: float = 0.0  # of the step

    @property
    def force_at_end(self) -> Floats:
        """Of the pairs on the nodes at the end, shape (n_dofs,)."""
        return self.force if self.of_end is None else self.of_end


@dataclass
class Kink:
    """A place where contact forces jump, against the motion across it."""

    normal: Floats  # gradient of the distance across it, positive on the far side, shape (n_dofs,)
    move: Floats  # translations that go across, a motion of distance 1, shape (n_dofs,)
    jump: Floats  # contact force of the far side less that of the near one, shape (n_dofs,)
    width: float = 0.0  # search distance [length]
    distance: float = 0.0  # from the displacement judged last to the kink [length]
    share: float = 0.0  # of the jump that is carried, from 0 on the near side to 1 on the far one
    far: list[Terms] = field(default_factory=list)  # of the pairs on the far side
    #: Displacement and share from which a correction was made, and the corrections of both.
    base: tuple[Floats, float, Floats, float] | None = None

    @property
    def excess(self) -> float:
        """Force beyond those of both sides [force]."""
        over = max(-self.share, self.share - 1.0)
        return over * float(np.abs(self.jump).max()) if over > SAME else 0.0

    def follow(self, u: Floats) -> None:
        """Take the share that belongs to a trial, which may be part of a correction."""
        if self.base is None:
            return
        start, share, du, change = self.base
        square = float(du @ du)
        part = min(max(float((u - start) @ du) / square, 0.0), 1.0) if square > 0.0 else 1.0
        self.share = share + part * change


def covered(area: Floats, full: Floats) -> Bools:
    """Which constraints have an opposite surface: by their areas there and their full ones."""
    found: Bools = area > SAME * full
    return found


def mean(weighted: Floats, area: Floats, full: Floats, alone: Floats | float = 0.0) -> Floats:
    """Weighted gaps or slips over their areas [length]; `alone` without an opposite surface."""
    seen = covered(area, full)
    return np.where(seen, weighted / np.where(seen, area, 1.0), alone)


@dataclass
class RightHandSides:
    """Right-hand sides of one linearization, one per column."""

    force: Floats  # of equilibrium, shape (n_dofs, k)
    constrained: Floats  # prescribed changes at constrained dofs, shape (n_dofs, k)
    own: Floats  # share of the contact residual: 1 in a Newton correction, 0 in a rate, shape (k,)
    rows: Floats | None = None  # added to those of the multipliers, shape (n_multipliers, k)


def sticking(states: States) -> States:
    """States in which what slips sticks."""
    return [np.where(s == SLIPPING, CLOSED, s).astype(np.int8) for s in states]
