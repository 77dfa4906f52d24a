"""Newton's method with the load factor among the unknowns, and directions along a path.

The bordered system is solved by elimination: one factorisation, two right-hand sides.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from corota.drivers.controls import product
from corota.drivers.newton import DIVERGED, ElementFailure, Judgement, Settings
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.drivers.controls import Control

    Floats = NDArray[np.float64]
    Mask = NDArray[np.bool_]


class PathSystem(Protocol):
    """A system whose load has a factor: see :class:`corota.drivers.system.System`."""

    @property
    def counted(self) -> Mask:
        """Dofs that measure lengths, shape (n_dofs,)."""
        ...

    @property
    def length(self) -> float:
        """Size of the structure [length]."""
        ...

    def evaluate(self, u: Floats, step_time: float) -> Any:
        """Residual and tangent."""
        ...

    def judge(self, at: Any, u: Floats) -> Judgement:
        """Size of the residual."""
        ...

    def load_rate(self, u: Floats) -> tuple[Floats, Floats]:
        """Change of forces and of held dofs per unit of load factor."""
        ...

    def correct(self, at: Any, rhs: Floats, du_held: Floats) -> tuple[Floats, int]:
        """Factorise and solve for several columns."""
        ...

    def solve_again(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation, held dofs at rest."""
        ...

    def commit(self) -> None:
        """Accept the last evaluated state."""
        ...


@dataclass
class Point:
    """An equilibrium: displacement, load factor and the evaluation there."""

    u: Floats
    factor: float
    at: Any


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


@dataclass
class Metric:
    """Length of directions in displacement and load factor.

    The displacement that a unit of load factor makes at the start of the step counts as much
    as that unit, so that arcs have no unit and a linear structure takes one to factor one.
    """

    counted: Mask
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


@dataclass
class Corrected:
    """What became of an attempt.

    Parameters
    ----------
    point : Point or None
        Equilibrium, if it was found.
    iterations : int
    sizes : list of float
        Residuals, the first before the first correction.
    reason : str
        Why it was not found.
    singular : SingularError or None
        Set where a tangent on the way had no inverse.
    """

    point: Point | None
    iterations: int = 0
    sizes: list[float] = field(default_factory=list)
    reason: str = ""
    singular: SingularError | None = None


def correct(
    system: PathSystem,
    base: Point,
    u: Floats,
    factor: float,
    period: float,
    control: Control,
    settings: Settings,
    report: Callable[[int, Judgement, float, float], None] | None = None,
) -> Corrected:
    """Find the equilibrium that meets a control, starting from a guess.

    Parameters
    ----------
    system : PathSystem
    base : Point
        Where the increment starts.
    u : ndarray, shape (n_dofs,)
        Guess that meets the control, with held dofs where `factor` puts them.
    factor : float
    period : float
        Step time of load factor one [time].
    control : Control
    settings : Settings
    report : callable, optional
        Told iteration, judgement, largest correction and load factor.

    Returns
    -------
    Corrected
    """
    done = Corrected(None)
    best = np.inf
    judged, correction = None, 0.0
    for iteration in range(settings.max_iterations + 1):
        try:
            at = system.evaluate(u, factor * period)
        except ElementFailure as error:
            done.reason = str(error)
            return done
        before, judged = judged, system.judge(at, u)
        done.sizes.append(judged.size)
        done.iterations = iteration
        if iteration and report is not None:
            report(iteration, judged, correction, factor)
        if not np.isfinite(judged.size):
            done.reason = "the residual is not finite"
            return done
        stalled = before is not None and judged.size >= 0.1 * before.size
        if judged.size <= settings.tolerance or (stalled and judged.rounding(settings.tolerance)):
            done.point = Point(u, factor, at)
            return done
        if iteration > 1 and judged.size > DIVERGED * max(best, 1e-6):
            done.reason = f"diverges: the residual grew to {judged.size:.1e}"
            return done
        best = min(best, judged.size)
        if iteration == settings.max_iterations:
            break
        force, move = system.load_rate(u)
        rhs = np.stack([-at.residual, force], axis=1)
        held = np.stack([np.zeros_like(move), move], axis=1)
        try:
            x, _ = system.correct(at, np.asfortranarray(rhs), np.asfortranarray(held))
        except SingularError as error:
            done.reason, done.singular = str(error), error
            return done
        change = control.change(u - base.u, factor - base.factor, x[:, 0], x[:, 1])
        if change is None or not np.isfinite(x).all():
            done.reason = "no equilibrium near the guess at this length"
            return done
        du = x[:, 0] + change * x[:, 1]
        correction = float(np.abs(du).max(initial=0.0))
        u, factor = u + du, factor + change
    done.reason = (
        f"no convergence in {settings.max_iterations} iterations (residual {done.sizes[-1]:.1e})"
    )
    return done


def tangent_at(
    system: PathSystem, point: Point, metric: Metric | None = None
) -> tuple[Tangent, Metric]:
    """Direction of the path at an equilibrium, of length one, towards growing load factor.

    Raises
    ------
    SingularError
        If the tangent matrix has no inverse there.
    """
    force, move = system.load_rate(point.u)
    # The matrix is overwritten by the factorisation's preparation: the point keeps its own.
    x, negative = system.correct(point.at, force, move)
    if metric is None:
        metric = Metric(system.counted, float(np.sqrt(product(x, x, system.counted))))
        if metric.length == 0.0:
            metric.length = 1.0
    size = metric.size(x, 1.0)
    return Tangent(x / size, 1.0 / size, negative), metric


__all__ = ["Corrected", "Metric", "PathSystem", "Point", "Tangent", "correct", "tangent_at"]
