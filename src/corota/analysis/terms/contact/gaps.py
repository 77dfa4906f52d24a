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
    """Gaps and slips of one pair at a state.

    Parameters
    ----------
    gap, slip, area : ndarray, shape (k,)
        Weighted gap and slip of each constraint [length^3], covered area [length^2].
    constraint, pair : ndarray of int, shape (m,)
        Constraint of each term, and candidate pair of the core.
    variables : ndarray of int, shape (m, v)
        ``3 node + component``, -1 for none.
    gap_gradient, slip_gradient : ndarray, shape (m, v)
    parts : tuple of ndarray, shape (k,)
        Gap and area of each node before neighbors share constraints.
    bare : Terms or None
        Unmodified gaps and areas, where a condition on rates has changed them.
    between : Terms or None
        Gradients along which tractions act that are those of an increment, not of its end.
    """

    gap: Floats
    slip: Floats
    area: Floats
    constraint: Ints
    pair: Ints
    variables: Ints
    gap_gradient: Floats
    slip_gradient: Floats
    parts: tuple[Floats, Floats]
    bare: Terms | None = None
    between: Terms | None = None

    @property
    def acting(self) -> Terms:
        """Terms along whose gradients the tractions act."""
        return self if self.between is None else self.between


@dataclass(eq=False)
class ContactState:
    """All pairs at a state; none by default.

    Parameters
    ----------
    terms : list of Terms
    force : ndarray, shape (n_dofs,)
        Of the pairs on the nodes, along the axes of the nodes.
    size : ndarray, shape (n_dofs,)
        Sum of sizes of its parts.
    multipliers : ndarray, shape (n_multipliers,)
    damping : ndarray, shape (n_dofs,), or None
        Stabilizing stiffness of this increment.
    of_end : ndarray, shape (n_dofs,), or None
        Force at the end, where a scheme weighs that of pressure laws between both ends.
    states : list of ndarray
        Of the constraints, once committed.
    acting : list of Terms
        Along whose gradients the forces acted, once committed.
    where : ndarray, shape (n_nodes, 3)
        Positions at which they did, once committed.
    settled : list of ndarray
        States at a point of a path, once they are computed.
    time : float
        Step time.
    """

    terms: list[Terms] = field(default_factory=list)
    force: Floats = field(default_factory=partial(np.zeros, 0))
    size: Floats = field(default_factory=partial(np.zeros, 0))
    multipliers: Floats = field(default_factory=partial(np.zeros, 0))
    damping: Floats | None = None
    of_end: Floats | None = None
    states: list[NDArray[np.int8]] = field(default_factory=list)
    acting: list[Terms] = field(default_factory=list)
    where: Floats | None = None
    settled: list[NDArray[np.int8]] = field(default_factory=list)
    time: float = 0.0

    @property
    def force_at_end(self) -> Floats:
        """Of the pairs on the nodes at the end, shape (n_dofs,)."""
        return self.force if self.of_end is None else self.of_end


@dataclass
class Kink:
    """A place where contact forces jump, against the motion across it.

    Parameters
    ----------
    normal : ndarray, shape (n_dofs,)
        Gradient of the distance across the kink, positive on the far side.
    move : ndarray, shape (n_dofs,)
        Translations that go across, a motion of distance 1.
    jump : ndarray, shape (n_dofs,)
        Contact force of the far side less that of the near one.
    width : float
        Search distance [length].
    distance : float
        From the displacement judged last to the kink [length].
    share : float
        Part of the jump that is carried, from 0 on the near side to 1 on the far one.
    """

    normal: Floats
    move: Floats
    jump: Floats
    width: float = 0.0
    distance: float = 0.0
    share: float = 0.0
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
    """Right-hand sides of one linearization, one per column.

    Parameters
    ----------
    force, constrained : ndarray, shape (n_dofs, k)
        Of equilibrium, and prescribed changes at constrained dofs.
    own : ndarray, shape (k,)
        Share of the contact residual: 1 in a Newton correction, 0 in a rate.
    rows : ndarray, shape (n_multipliers, k), or None
        Added to the rows of the multipliers.
    """

    force: Floats
    constrained: Floats
    own: Floats
    rows: Floats | None = None


def sticking(states: States) -> States:
    """States in which what slips sticks."""
    return [np.where(s == SLIPPING, CLOSED, s).astype(np.int8) for s in states]
