"""Newton's method with the load factor among the unknowns, and directions along a path.

Equilibrium and the constraint of the path are solved by elimination: one factorization, two
right-hand sides.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure, GiveUp
from corota.analysis.newton import DIVERGED, ResidualNorms, Settings
from corota.analysis.path_system import Metric, PathSystem, Point, Tangent, product
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.procedures.path.controls import Control


#: Displacements below this share of the structure's size are rounding.
STILL = 1e-12


@dataclass
class Corrected:
    """What became of an attempt.

    Parameters
    ----------
    point : Point or None
        Equilibrium, if it was found.
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
    guess: Point,
    period: float,
    control: Control,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, float], None] | None = None,
    loose: bool = False,
) -> Corrected:
    """Find the equilibrium that meets a control, starting from a guess.

    Parameters
    ----------
    base : Point
        Where the increment starts.
    guess : Point
        Satisfies the control, with prescribed dofs at the values of its load factor.
    period : float
        Step time of load factor one [time].
    report : callable, optional
        Called with iteration, residual norms, largest correction and load factor.
    loose : bool
        Whether what moves freely may be brought to a hold.
    """
    done = Corrected(None)
    system.restart(loose, guess.at)
    at = _search(done, system, base, guess, period, control, settings, report)
    if done.point is not None:
        done.reason = system.refuse(done.point.evaluation, done.point.u)
        if done.reason:
            done.point = None
    if done.point is None and at is not None:
        done.reason += system.explain(at)
    return done


def _search(
    done: Corrected,
    system: PathSystem,
    base: Point,
    guess: Point,
    period: float,
    control: Control,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, float], None] | None,
) -> Evaluation | None:
    """Fill in what became of an attempt; returns the last evaluation, None if there is none."""
    u, factor = guess.u, guess.factor
    n, best, at = system.n_dofs, np.inf, None
    norms: ResidualNorms | None = None
    correction = 0.0
    for iteration in range(settings.max_iterations + 1):
        try:
            at = system.evaluate(u, factor * period)
        except ElementFailure as error:
            done.reason = str(error)
            return at
        before, norms = norms, system.residual_norms(at, u)
        settled = norms.size <= settings.tolerance
        if not settled and before is not None and norms.size >= 0.1 * before.size:
            settled = norms.rounding(settings.tolerance)
            if settled:
                norms.force, norms.moment = norms.combined
        done.sizes.append(norms.size)
        done.iterations = iteration
        if iteration and report is not None:
            report(iteration, norms, correction, factor)
        if not np.isfinite(norms.size):
            done.reason = "the residual is not finite"
            return at
        if settled:
            done.point = Point(u, factor, at)
            return at
        if iteration > 1 and norms.size > DIVERGED * max(best, 1e-6):
            done.reason = f"diverges: the residual grew to {norms.size:.1e}"
            return at
        best = min(best, norms.size)
        if iteration == settings.max_iterations:
            break
        force, move = system.load_rate(u)
        try:
            a, b = system.advance(at, force, move)
        except SingularError as error:
            done.reason, done.singular = str(error), error
            return at
        except GiveUp as error:
            done.reason = str(error)
            return at
        change = control.change(u - base.u, factor - base.factor, a, b)
        du = a if change is None else a + change * b
        if change is None or not np.isfinite(du).all():
            done.reason = "no equilibrium near the predictor at this arc length"
            return at
        correction = float(np.abs(du[:n]).max(initial=0.0))
        u, factor = u + du, factor + change
    done.reason = (
        f"no convergence in {settings.max_iterations} iterations (residual {done.sizes[-1]:.1e})"
    )
    return at


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
    # The matrix is overwritten by the factorization's preparation: the point keeps its own.
    x, negative = system.rate(point.evaluation, force, move)
    if metric is None:
        metric = Metric(system.counted, float(np.sqrt(product(x, x, system.counted))))
        if metric.length <= STILL * system.length:
            # Nothing moves under the load, as in a fixed and heated bar.
            metric.length = system.length
    size = metric.size(x, 1.0)
    return Tangent(x / size, 1.0 / size, negative), metric
