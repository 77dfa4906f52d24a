"""Interface of a system for path following: rates and corrections per unit of load factor."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import ResidualNorms
    from corota.arrays import Bools, Floats


#: Message for an unsymmetric tangent, where stability is unknown.
NOT_CONSERVATIVE = (
    "the loads follow the structure and have no potential: the tangent is not symmetric, so its "
    "pivots do not show stability (non-conservative: use dynamics)"
)


#: Number of equidistant points on a chord at which forces are compared.
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
#: Ratio of second differences below which forces are not smooth.
CORNER = 0.2


def product(u: Floats, v: Floats, counted: Bools) -> float:
    """Scalar product over the counted dofs.

    Without a linear algebra library: its threads cost more than such a sum.
    """
    return float(np.einsum("i,i,i->", u, v, counted))


@dataclass
class Point:
    """An equilibrium: displacement, load factor and the evaluation there."""

    u: Floats
    factor: float
    at: Evaluation | None

    @property
    def evaluation(self) -> Evaluation:
        """The evaluation of an equilibrium; a guess has none."""
        assert self.at is not None
        return self.at


@dataclass
class Tangent:
    """Direction of the path at a point.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
        Displacement per unit of path.
    factor : float
        Load factor per unit of path.
    negative : int
        Negative pivots of the tangent matrix, -1 if unknown.
    """

    u: Floats
    factor: float
    negative: int

    def reversed(self) -> Tangent:
        """The opposite direction."""
        return Tangent(-self.u, -self.factor, self.negative)


@dataclass
class Metric:
    """Length of directions in displacement and load factor.

    The displacement that a unit of load factor makes at the start of the step counts as much
    as that unit, so that arcs have no unit and a linear structure takes one to factor one.
    """

    counted: Bools
    length: float  # displacement of a unit of load factor at the start

    def dot(self, u: Floats, f: float, v: Floats, g: float) -> float:
        """Scalar product of two directions."""
        return 0.5 * (product(u, v, self.counted) / self.length**2 + f * g)

    def size(self, u: Floats, f: float) -> float:
        """Length of a direction."""
        return float(np.sqrt(self.dot(u, f, u, f)))

    def displacement(self, u: Floats) -> float:
        """Length of the displacements alone [length]."""
        return float(np.sqrt(product(u, u, self.counted)))


class PathSystem(Protocol):
    """A system with a load factor.

    Its unknowns are the dofs, followed by those that the system adds; a path neither
    measures nor controls the latter.
    """

    @property
    def n_dofs(self) -> int:
        """Dofs, the first of the unknowns."""

    @property
    def counted(self) -> Bools:
        """Unknowns that measure lengths, shape (n,)."""

    @property
    def length(self) -> float:
        """Size of the structure [length]."""

    def restart(self, loose: bool = False, like: Evaluation | None = None) -> None:
        """Begin an attempt at an increment: discard the data of earlier attempts.

        `loose` allows free bodies to be moved until they are constrained, as into contact; `like`
        is an evaluation that the guess was taken from.
        """

    def evaluate(self, u: Floats, step_time: float) -> Evaluation:
        """Residual and tangent."""

    def take_over(self, at: Evaluation, last: Evaluation) -> None:
        """Give the start what flows and slips at the end of the last increment."""

    def rows(self, u: Floats, step_time: float) -> Floats:
        """Internal forces, and the equations of the other unknowns."""

    def residual_norms(self, at: Evaluation, u: Floats) -> ResidualNorms:
        """Size of the residual."""

    def refuse(self, at: Evaluation, u: Floats) -> str:
        """Why an equilibrium cannot be the next of the path, or nothing."""

    def explain(self, at: Evaluation) -> str:
        """Cause of a failed attempt, for its message."""

    def load_rate(self, u: Floats) -> tuple[Floats, Floats]:
        """Change of forces and of prescribed dofs per unit of load factor."""

    def advance(self, at: Evaluation, force: Floats, move: Floats) -> tuple[Floats, Floats]:
        """Newton correction at the load factor, and the change per unit of it.

        `force` and `move` are those of :meth:`load_rate`.
        """

    def rate(self, at: Evaluation, force: Floats, move: Floats) -> tuple[Floats, int]:
        """Change per unit of load factor, and negative pivots (-1 if unknown)."""

    def solve_with_last_factor(self, rhs: Floats) -> Floats:
        """All unknowns for forces of shape (n_dofs,), with the last factorization."""

    def ahead(self, at: Evaluation, rate: Floats) -> float:
        """Whether a direction points away from the kink since the committed state.

        Positive if so, negative if it points back, 0 where the path has no kink.
        """

    def around(
        self, base: Point, tangent: Tangent, metric: Metric, size: float, period: float
    ) -> tuple[Point, Tangent] | None:
        """Predict a point behind the kinks between it and a committed one.

        Also the direction there; None where there is no kink within a distance.
        """

    def has_corner(self, base: Point, point: Point, period: float) -> bool:
        """Whether a law of the structure has a corner between two near equilibria."""

    def commit(self) -> None:
        """Accept the last evaluated state."""


class SmoothPath:
    """A system without contact on a path."""

    more_iterations = 0
    not_conservative = NOT_CONSERVATIVE

    def __init__(self, system: System) -> None:
        self.system = system
        self.n_dofs, self.counted, self.length = system.n_dofs, system.counted, system.length
        self.evaluate, self.residual_norms, self.commit = (
            system.evaluate,
            system.residual_norms,
            system.commit,
        )
        self.load_rate, self.solve_with_last_factor = (
            system.load_rate,
            system.solve_with_last_factor,
        )
        self.rate = system.correct

    def start(self, u: Floats) -> Floats:
        """The unknowns of a committed state."""
        return u

    def take_over(self, at: Evaluation, last: Evaluation) -> None:
        """Take the tangent of flow: what is on its yield surface has the elastic one."""
        at.values[:] = last.values

    def rows(self, u: Floats, step_time: float) -> Floats:
        """Forces at the dofs."""
        return self.evaluate(u, step_time).internal

    def restart(self, loose: bool = False, like: Evaluation | None = None) -> None:
        """Nothing is kept between attempts."""

    def refuse(self, at: Evaluation, u: Floats) -> str:
        """An unconstrained body far away is not in equilibrium."""
        return self.system.scales.implausible_displacement(u)

    def explain(self, at: Evaluation) -> str:
        """The residual is the explanation."""
        return ""

    def ahead(self, at: Evaluation, rate: Floats) -> float:
        """No kinks are known."""
        return 0.0

    def around(self, *_: object) -> None:
        """No kinks are known."""

    def has_corner(self, base: Point, point: Point, period: float) -> bool:
        """Whether forces along the chord of two near equilibria have a single corner.

        Where they are smooth, their second differences are alike; a corner of a law leaves some of
        them without any.
        """
        forces = []
        for share in SHARES:
            u = base.u + share * (point.u - base.u)
            factor = base.factor + share * (point.factor - base.factor)
            at = self.system.evaluate(u, factor * period)
            forces.append(np.where(self.system.conditions.constrained, 0.0, at.reaction))
        self.system.evaluate(point.u, point.factor * period)
        bends = [
            float(np.abs(a - 2.0 * b + c).max())
            for a, b, c in zip(forces, forces[1:], forces[2:], strict=False)
        ]
        return min(bends) < CORNER * max(bends)

    def advance(self, at: Evaluation, force: Floats, move: Floats) -> tuple[Floats, Floats]:
        """See :class:`PathSystem`; `at` is overwritten."""
        rhs = np.stack([-at.residual, force], axis=1)
        constrained = np.stack([np.zeros_like(move), move], axis=1)
        x, _ = self.system.correct(at, rhs, constrained)
        return x[:, 0], x[:, 1]
