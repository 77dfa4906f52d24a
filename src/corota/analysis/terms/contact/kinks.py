"""Equilibria at a kink of the contact surfaces.

Gaps depend on the positions continuously, but not smoothly: as a corner of one surface passes a
node of the other, their gradients jump, and contact forces with them. Where the bodies rest exactly
there, the force is between those of both sides, and Newton's method, which uses one side at a
time, cycles. Here the position of the jump becomes an equation, and the force that is
carried across it an unknown: the generalized gradient in the sense of Clarke.

Source: F. H. Clarke, *Optimization and Nonsmooth Analysis* (1983), ch. 2.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import GiveUp
from corota.analysis.terms.contact.gaps import (
    EXCESS,
    FAR,
    HALVINGS,
    SMALL,
    WAITED,
    Kink,
    RightHandSides,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.contact import ContactTerm
    from corota.analysis.terms.contact.equations import ContactEquations
    from corota.analysis.terms.contact.gaps import ContactState
    from corota.analysis.terms.contact.pair import Terms
    from corota.analysis.terms.term import StatePoint
    from corota.arrays import Floats, Ints


#: Share that tells a jump from a gradual change: of a difference of contact forces, which halves
#: with the way if it is gradual, and of a correction, which the next one takes back at a jump.
#: First search radius of a kink, in lengths that the last correction was to go.
JUMP = 0.2


class Sides:
    """Contact forces at displacements near each other, for the same tractions.

    Parameters
    ----------
    term : ContactTerm
    multipliers : ndarray, shape (n_multipliers,)
    step_time : float
    """

    def __init__(self, term: ContactTerm, multipliers: Floats, step_time: float) -> None:
        self.term, self.multipliers, self.time = term, multipliers, step_time

    @property
    def noise(self) -> float:
        """Gaps that are rounding [length]."""
        return max(pair.noise for pair in self.term.pairs)

    def state(self, u: Floats, shear: bool = True) -> ContactState:
        """Contact at a displacement, whatever masters the nodes had before.

        Without `shear` its force is that of the pressures alone.
        """
        term = self.term
        multipliers = self.multipliers
        if not shear:
            multipliers = multipliers.copy()
            for pair in term.pairs:
                multipliers[pair.first + pair.n : pair.first + pair.width] = 0.0
        for pair in term.pairs:
            pair.core.forget()
        return term.evaluate(u, multipliers, self.time, np.zeros(0))

    def jump(self, place: Callable[[float], Floats]) -> tuple[float, float, Floats] | None:
        """Where forces jump on the way from `place(0)` to `place(1)`, and by how much.

        Returns
        -------
        before, behind : float
            Ends of an interval of the size of rounding.
        jump : ndarray, shape (n_dofs,)
            None is returned if forces change gradually.
        """
        low, high = 0.0, 1.0
        first, last = self.state(place(low)).force, self.state(place(high)).force
        whole = float(np.abs(last - first).max())
        if whole == 0.0:
            return None
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            force = self.state(place(middle)).force
            if np.abs(force - first).max() > np.abs(last - force).max():
                high, last = middle, force
            else:
                low, first = middle, force
            if float(np.abs(last - first).max()) <= JUMP * whole:
                return None
        return low, high, last - first


def found(sides: Sides, here: Floats, there: Floats) -> Kink | None:
    """The kink between two displacements, seen from the first, or None.

    Parameters
    ----------
    here, there : ndarray, shape (n_dofs,)
    """

    def place(t: float) -> Floats:
        return here + t * (there - here)

    at = sides.jump(place)
    kink = None if at is None else _kink(sides, place, at)
    if at is None or kink is None:
        return None
    apart = float(kink.normal @ (there - here))
    if apart <= sides.noise:
        return None  # rounding, or the jump drives the bodies apart: nothing rests there
    kink.width, kink.distance = FAR * apart, 0.5 * (at[0] + at[1]) * apart
    return kink


def near_side(term: ContactTerm, point: StatePoint, kink: Kink) -> ContactState | None:
    """Contact on the near side of a kink next to a displacement, None if there is none any more.

    The kink takes the new normal, jump and distance.
    """
    u, sides = point.u, Sides(term, point.multipliers, point.time)
    # Nearer jumps come first. In a width of rounding either side may do so.
    least = SMALL * max(pair.edge for pair in term.pairs)
    for width in (*(max(x * abs(kink.distance), least) for x in (JUMP, FAR)), kink.width):
        if width > kink.width:
            continue

        def place(t: float, w: float = width) -> Floats:
            return u + (2.0 * t - 1.0) * w * kink.move

        at = sides.jump(place)
        new = None if at is None else _kink(sides, place, at)
        if at is None or new is None or float(new.jump @ kink.jump) <= 0.0:
            continue
        kink.far = sides.state(place(at[1])).terms
        state = sides.state(place(at[0]))
        kink.distance = (2.0 * at[0] - 1.0) * width * float(new.normal @ kink.move)
        kink.normal, kink.move, kink.jump = new.normal, new.move, new.jump
        kink.follow(u)
        state.force = state.force + kink.share * kink.jump
        return state
    return None


def both_sides(kink: Kink, near: list[Terms]) -> list[Terms]:
    """Terms of the pairs whose gradients are those of both sides, by the shares they carry."""
    return [_mixed(a, b, kink.share) for a, b in zip(near, kink.far, strict=True)]


def _mixed(near: Terms, far: Terms, share: float) -> Terms:
    def join(name: str) -> Ints:
        both: Ints = np.concatenate([getattr(near, name), getattr(far, name)])
        return both

    def weighted(name: str) -> Floats:
        parts = (1.0 - share) * getattr(near, name), share * getattr(far, name)
        return np.concatenate(parts)

    def mean(name: str) -> Floats:
        value: Floats = (1.0 - share) * getattr(near, name) + share * getattr(far, name)
        return value

    return replace(
        near,
        gap=mean("gap"),
        slip=mean("slip"),
        area=mean("area"),
        constraint=join("constraint"),
        pair=join("pair"),
        variables=join("variables"),
        gap_gradient=weighted("gap_gradient"),
        slip_gradient=weighted("slip_gradient"),
    )


def _kink(
    sides: Sides,
    place: Callable[[float], Floats],
    at: tuple[float, float, Floats],
) -> Kink | None:
    low, high, jump = at
    # Gaps are continuous: the jump of their gradients is normal to the kink. Slips are not.
    pressures = jump
    if any(pair.rubs for pair in sides.term.pairs):
        pressures = sides.state(place(high), False).force - sides.state(place(low), False).force
    moves = np.where(sides.term.system.is_rotation, 0.0, pressures)
    size = float(np.sqrt(moves @ moves))
    return Kink(-pressures / size, -moves / size, jump) if size > 0.0 else None


def keeps_kink(problem: ContactEquations, at: Evaluation) -> bool:
    """Whether the correction is one at a kink; looks for one where there is no progress."""
    if problem.kink is not None:
        problem.beyond += problem.kink.excess > 0.0
        if problem.beyond <= WAITED:
            return True
        if problem.inherits:
            problem.kink, problem.beyond, problem.inherits = None, 0, False
            return False
        raise GiveUp("no equilibrium at the kink of the contact surfaces")
    if (
        problem.waited < WAITED
        or problem.kinks >= WAITED
        or not _to_and_fro(problem.places)
        or at.link.couples
        or problem.term.persistent
        or not problem.system.nlgeom
    ):
        return False
    sides = Sides(problem.term, at.contact_state.multipliers, at.contact_state.time)
    _, before, here = problem.places
    problem.kink = found(sides, here, before)
    # The candidates of the search may have changed.
    state, now = at.contact_state, sides.state(here)
    at.internal = at.internal + state.force - now.force
    at.contact_state = now
    problem.kinks += problem.kink is not None
    return problem.kink is not None


def _to_and_fro(places: list[Floats]) -> bool:
    """Whether the last two corrections cancel each other."""
    if len(places) < 3:
        return False
    first, before, here = places
    return float(np.abs(here - first).max()) <= JUMP * float(np.abs(here - before).max())


def along_kink(
    problem: ContactEquations, at: Evaluation, right_sides: RightHandSides
) -> tuple[Floats, int] | None:
    """Newton correction with the force that the kink carries as an unknown."""
    kink = problem.kink
    assert kink is not None
    both = RightHandSides(
        np.column_stack([right_sides.force[:, 0], kink.jump]),
        np.column_stack([right_sides.constrained[:, 0], np.zeros(problem.n)]),
        np.array([1.0, 0.0]),
    )
    z, negative = problem.columns(at, both, problem.chosen(at.contact_state))
    first, second = kink.normal @ z[: problem.n]
    if second == 0.0:
        problem.kink = None
        return None
    change = (kink.distance - float(first)) / float(second)
    if not -EXCESS <= kink.share + change <= 1.0 + EXCESS:
        problem.kink = None
        return None
    dz: Floats = z[:, 0] + change * z[:, 1]
    kink.base = (problem.places[-1], kink.share, dz[: problem.n].copy(), change)
    problem.stage = "equilibrium at a kink of the contact surfaces"
    return problem.moved(dz), negative
