"""Newton's method for one increment, with line search and full rollback.

Prescribed displacements act through the tangent: their increment is part of the first
linear solve, so that the elements at the moved edge do not take all of it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import numpy as np

from corota.analysis.failure import ElementFailure, GiveUp
from corota.analysis.rule import REST, Rule
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.evaluation import Evaluation
    from corota.arrays import Floats


#: A residual below this multiple of the rounding error of the internal force counts as zero.
FLOOR = 10.0
#: Growth of the residual over its start that is given up as divergence.
DIVERGED = 1e6
#: Share of the tolerance that an iteration with the old tangent is expected to reach.
CHORD = 0.01
#: Shortest line search step.
SHORTEST = 1.0 / 64.0
#: Work of the residual at the end of a correction, relative to that at its start, up to which a
#: strict line search accepts it.
SLACK = 0.8
#: Share of the smallest residual so far that a new one must be below to count as progress.
PROGRESS = 0.9


def larger(a: float, b: float) -> float:
    """The larger of two; unlike ``max``, it propagates NaN."""
    return a if a > b or a != a else b


class Corrections(Protocol):
    """Evaluation and correction of the equations: of a system, or with contact states."""

    @property
    def evaluate(self) -> Callable[[Floats, float, Rule], Evaluation]: ...
    def predict(self, at: Evaluation, du_prescribed: Floats) -> tuple[Floats, int]: ...
    def residual_norms(self, at: Evaluation, u: Floats) -> ResidualNorms: ...
    def return_tangent(self, at: Evaluation) -> None: ...


@dataclass
class ResidualNorms:
    """Size of a residual against its scale, for forces and moments separately."""

    force: float  # largest free residual force / force scale
    moment: float
    floor: float  # relative size of rounding errors of forces
    worst: int  # dof with the largest relative residual
    moment_floor: float = 0.0  # and of moments, whose scale may be much smaller
    #: Whether all forces are of rounding size, in a motion that may be that slow.
    idle: bool = False
    #: Residuals of forces and moments over all that acts, be it force, moment or inertia.
    combined: tuple[float, float] = (0.0, 0.0)
    note: str = ""  # how the correction before was found, for the log
    #: Measures `floor` and `moment_floor`, which few residuals need and which takes as long as the
    #: norms.
    measure: Callable[[], tuple[float, float]] | None = None

    @property
    def size(self) -> float:
        return larger(self.force, self.moment)

    def rounding(self, tolerance: float) -> bool:
        """Whether what is left, of forces and of moments, is small or rounding."""
        if self.measure is not None:
            self.floor, self.moment_floor = self.measure()
            self.measure = None
        forces = self.force <= max(tolerance, FLOOR * self.floor)
        return forces and self.moment <= max(tolerance, FLOOR * self.moment_floor)


@dataclass
class Settings:
    """When an increment is converged, and when it is given up."""

    tolerance: float = 1e-9
    max_iterations: int = 16
    #: Correct with the last factorization, for an iteration that converges with it.
    reuse: Callable[[Evaluation], Floats] | None = None
    #: Iterations without a clearly smaller residual after which the attempt is given up; 0: never.
    patience: int = 0
    #: Line search in every iteration in which supports do not move.
    search: bool = False
    #: Residual after the first iteration above which the attempt is given up.
    first: float = math.inf


@dataclass
class Outcome:
    """Result of an increment.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
        Last trial, equilibrium if converged.
    at : Evaluation
        Evaluation at `u`.
    sizes : list of float
        Residual before the first iteration and after each.
    negative : int
        Negative pivots of the last factorization, -1 if unknown.
    reason : str
        Why it did not converge.
    note : str
        How it converged, if not by the tolerance.
    """

    converged: bool
    u: Floats
    at: Evaluation | None
    iterations: int = 0
    sizes: list[float] = field(default_factory=list)
    negative: int = -1
    reason: str = ""
    note: str = ""


def newton(
    system: Corrections,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    start: Evaluation | None = None,
    report: Callable[[int, ResidualNorms, float, str], None] | None = None,
    rule: Rule = REST,
) -> Outcome:
    """Find equilibrium at a time, starting from a displacement.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
        Converged displacement of the increment before; not changed.
    prescribed : ndarray, shape (n_dofs,)
        Target of the prescribed dofs, `u` elsewhere.
    step_time : float
        Time at which loads are taken.
    start : Evaluation, optional
        Evaluation at `u` and `step_time`, if it is known.
    report : callable, optional
        Called with iteration number, residual norms, largest correction and a note.
    rule : Rule
        What the increment makes of its unknowns.

    Raises
    ------
    SingularError
        If the structure is not constrained.
    """
    try:
        at = start if start is not None else system.evaluate(u, step_time, rule)
    except ElementFailure as error:
        return Outcome(False, u, None, reason=str(error))
    outcome = Outcome(False, u, at)
    du_prescribed = prescribed - u
    moved = bool(du_prescribed.any())
    norms = system.residual_norms(at, u)
    size = norms.size
    outcome.sizes.append(size)
    # With moving supports the first residual gives no scale for the one to be reached.
    if not moved and size <= settings.tolerance and not norms.idle:
        outcome.converged = True
        return outcome
    best, least, waited = size, math.inf, 0
    for iteration in range(1, settings.max_iterations + 1):
        try:
            again = settings.reuse
            if again and not moved and _old_will_do(outcome.sizes, settings.tolerance):
                du = again(at)
            else:
                du, outcome.negative = system.predict(at, du_prescribed)
                du = rule.improve(du, moved)
        except SingularError as error:
            if iteration == 1:
                raise
            # A trial state may be a mechanism, as in plastic collapse, where the start is not.
            outcome.reason = f"a trial state has a singular tangent ({error})"
            return outcome
        except GiveUp as error:
            outcome.reason = str(error)
            return outcome
        if not math.isfinite(du.sum()):
            outcome.reason = "the linear solution is not finite"
            return outcome
        before = size
        strict = settings.search and not moved
        trial = _search(system, u, du, at, step_time, before, iteration, strict, rule)
        if isinstance(trial, str):
            outcome.reason = trial
            return outcome
        system.return_tangent(at)
        u, at, length = trial
        if moved:
            du_prescribed = (1.0 - length) * du_prescribed
            moved = bool(du_prescribed.any())
        norms = system.residual_norms(at, u)
        size = norms.size
        settled = not moved and size > settings.tolerance and size >= 0.1 * before
        settled = settled and norms.rounding(settings.tolerance)
        if settled:
            # Against the smaller of forces and moments alone it could look large.
            norms.force, norms.moment = norms.combined
            size = norms.size
        outcome.u, outcome.at, outcome.iterations = u, at, iteration
        outcome.sizes.append(size)
        if report is not None:
            # Unknowns beyond the dofs are multipliers, of another unit.
            largest = float(np.abs(du[: len(at.internal)]).max())
            note = "; ".join(filter(None, [f"step {length:.3g}" * (length != 1.0), norms.note]))
            report(iteration, norms, length * largest, note)
        if not math.isfinite(size):
            outcome.reason = "the residual is not finite"
            return outcome
        if settled or (not moved and size <= settings.tolerance):
            outcome.converged = True
            if settled:
                outcome.note = f"residual {size:.1e} is at the rounding floor"
            return outcome
        if iteration == 1 and size > settings.first:
            outcome.reason = f"the first iteration leaves a residual of {size:.1e}"
            return outcome
        if iteration > 1 and size > DIVERGED * max(best, 1e-6):
            outcome.reason = f"diverges: the residual grew to {size:.1e}"
            return outcome
        if size < PROGRESS * least:
            least, waited = size, 0  # many small steps are progress as well
        else:
            waited += 1
        if waited == settings.patience > 0:
            outcome.reason = f"no progress in {waited} iterations (residual {size:.1e})"
            return outcome
        best = min(best, size)
    outcome.reason = (
        f"no convergence in {settings.max_iterations} iterations (residual {outcome.sizes[-1]:.1e})"
    )
    return outcome


def _work(du: Floats, at: Evaluation) -> float:
    """Work of the residual on a correction; unknowns beyond the dofs have none."""
    residual = at.residual
    return float(du[: len(residual)] @ residual)


def _old_will_do(sizes: list[float], tolerance: float) -> bool:
    """Whether the tangent of the iteration before takes the residual below the tolerance.

    It is wrong by about the last correction, so it reduces the residual by about the same
    factor once more, where a new tangent would square it.
    """
    if len(sizes) < 3:
        return False
    before, now = sizes[-2:]
    return now * now <= CHORD * tolerance * before


def _search(
    system: Corrections,
    u: Floats,
    du: Floats,
    start: Evaluation,
    step_time: float,
    before: float,
    iteration: int,
    strict: bool,
    rule: Rule,
) -> tuple[Floats, Evaluation, float] | str:
    """Take the step; shorten it where elements fail or the residual grows.

    Early growth of the residual is accepted: in slender structures it is stretching that
    the next iteration removes. A strict search refuses it (M. A. Crisfield, *Non-linear Finite
    Element Analysis of Solids and Structures* 1, 1991, section 9.2).
    """
    length = 1.0
    problem = ""
    while length >= SHORTEST:
        trial = u + (du if length == 1.0 else length * du)
        try:
            at = system.evaluate(trial, step_time, rule)
        except ElementFailure as error:
            problem = str(error)
            length *= 0.5
            continue
        if strict:
            first, last = _work(du, start), _work(du, at)
            if not (first < 0.0 and last > SLACK * abs(first)):
                return trial, at, length
            shorter = length * min(max(first / (first - last), 0.1), 0.9)
            if shorter < SHORTEST:
                return trial, at, length
            length = shorter
            system.return_tangent(at)
            continue
        if iteration <= 4 or length < 1.0:
            return trial, at, length
        after = system.residual_norms(at, trial).size
        if after <= 2.0 * before:
            return trial, at, length
        # Zero of the work of the residual along the step, by one regula falsi.
        first, last = _work(du, start), _work(du, at)
        if first < 0.0 < last:
            length = min(max(first / (first - last), 0.1), 0.9)
            system.return_tangent(at)
            continue
        return trial, at, length
    return problem
