"""Goal seek: the value of one parameter for which a measure reaches a target."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.display import Brief
from corota.errors import CorotaError, InputError
from corota.sweeps.run import named
from corota.sweeps.store import Store
from corota.sweeps.table import Sweep
from corota.sweeps.variant import DeckBuild, Job, Outcome, calculate

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    from corota.results.results import Results
    from corota.sweeps.run import Build

#: Most runs of a search; bisection to a millionth of the range takes 20.
MOST_RUNS = 40


@dataclass
class Sought(Brief):
    """Result of a goal seek.

    Parameters
    ----------
    parameter : str
    value : float
        Of the parameter.
    measure : float
        Of the run at that value.
    target : float
    runs : Sweep
        All runs, in their order.
    """

    parameter: str
    value: float
    measure: float
    target: float
    runs: Sweep

    def __str__(self) -> str:
        name = self.runs.measures[0]
        return (
            f"{self.parameter} = {self.value:.6g}: {name} = {self.measure:.6g} for a target of "
            f"{self.target:.6g}, {len(self.runs)} runs"
        )


class _Reached(Exception):
    """The target is reached within the tolerance."""


def seek(
    build: Build,
    parameter: Mapping[str, Sequence[float]],
    measure: str | Callable[[Results], float],
    target: float,
    *,
    tolerance: float = 1e-4,
    fixed: Mapping[str, Any] | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Callable[[float, float], None] | None = None,
) -> Sought:
    """Find the value of a parameter for which a measure has a given value.

    The range must hold the target between the measures of its ends. Brent's method keeps a bracket
    and usually needs 5 to 8 runs.

    Parameters
    ----------
    build : callable or path-like
        As for :func:`corota.sweep`.
    parameter : mapping
        Name of one parameter and its range: ``{"t": (0.3, 0.9)}``.
    measure : str or callable
        As for :func:`corota.sweep`.
    target : float
        Wanted value of the measure.
    tolerance : float
        Largest error of the measure, relative to the target (absolute for a target of zero).
    fixed : mapping, optional
        Values of other parameters.
    store : path-like, optional
        File (``.jsonl``) that keeps each run; stored runs are not repeated.
    progress : callable, optional
        ``progress(value, measure)`` after each run.

    Returns
    -------
    Sought

    Raises
    ------
    InputError
        If the range does not hold the target, or the input is no search.
    CorotaError
        If a run fails, with its parameter.

    References
    ----------
    R. P. Brent, Algorithms for Minimization Without Derivatives (1973), chapter 4.

    Examples
    --------
    >>> import corota as ct
    >>> def strip(depth):
    ...     model = ct.Model(ct.mesh.rectangle(10.0, depth, nx=20, ny=1))
    ...     model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    ...     model.fix("left")
    ...     model.force("right", y=-0.01)
    ...     return model, ct.Static(nlgeom=False)
    >>> found = ct.seek(strip, {"depth": (0.5, 2.0)}, "last(U2@right)", target=-0.04)
    >>> 0.9 < found.value < 1.1
    True
    """
    name, low, high = _range_of(parameter)
    if not (math.isfinite(target) and tolerance > 0.0):
        raise InputError("a search needs a finite target and a tolerance > 0")
    chosen = named({str(measure): measure} if isinstance(measure, str) else {"measure": measure})
    job = Job(build if callable(build) else DeckBuild(Path(build)), chosen)
    (label,) = chosen
    rows: list[dict[str, Any]] = []
    outcomes: list[Outcome] = []
    slack = tolerance * (abs(target) or 1.0)

    def error_at(value: float) -> float:
        row = {**(fixed or {}), name: value}
        outcome = kept.find(row)
        if outcome is None:
            outcome = calculate(job, row)
            kept.add(row, outcome)
        rows.append(row)
        outcomes.append(outcome)
        if outcome.error:
            raise CorotaError(f"the run with {name} = {value:g} failed: {outcome.error}")
        found = outcome.values[label]
        if progress is not None:
            progress(value, found)
        if not math.isfinite(found):
            raise InputError(f"the measure is {found} for {name} = {value:g}")
        if abs(found - target) <= slack:
            raise _Reached
        return found - target

    with Store(None if store is None else Path(store), job) as kept, contextlib.suppress(_Reached):
        _search(error_at, name, low, high, target)
    errors = [abs(outcome.values[label] - target) for outcome in outcomes]
    best = min(range(len(rows)), key=errors.__getitem__)
    runs = Sweep(rows, [label], outcomes)
    return Sought(name, float(rows[best][name]), outcomes[best].values[label], target, runs)


def _range_of(parameter: Mapping[str, Sequence[float]]) -> tuple[str, float, float]:
    try:
        ((name, ends),) = parameter.items()
        low, high = (float(end) for end in ends)
    except (ValueError, TypeError, AttributeError):
        raise InputError(
            'a search has one parameter with its range, such as {"t": (0.3, 0.9)}, not '
            f"{parameter!r}"
        ) from None
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise InputError(f"the range of {name} must rise, not {low:g} to {high:g}")
    return str(name), low, high


def _search(
    error_at: Callable[[float], float], name: str, low: float, high: float, target: float
) -> None:
    from scipy.optimize import brentq

    at_low, at_high = error_at(low), error_at(high)
    if at_low * at_high > 0.0:
        raise InputError(
            f"the measure is {at_low + target:.6g} at {name} = {low:g} and {at_high + target:.6g} "
            f"at {name} = {high:g}: both on one side of the target {target:g}; widen the range"
        )
    ends = {low: at_low, high: at_high}
    brentq(
        lambda value: ends[value] if value in ends else error_at(value),
        low, high, xtol=1e-12 * (high - low), rtol=1e-12, maxiter=MOST_RUNS, disp=False,
    )  # fmt: skip
