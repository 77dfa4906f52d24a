"""Optimization of designs with exact gradients, a record, and restart from it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np

from corota.display import Brief
from corota.errors import CorotaError, FileError, InputError
from corota.gradients.measures import Measure
from corota.gradients.runs import value_and_grad

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Floats
    from corota.model.model import Model


@dataclass
class Constraint:
    """Bounds of a measure.

    Parameters
    ----------
    measure : Measure
    lower, upper : float, optional
        With both the same it is an equation.
    """

    measure: Measure
    lower: float | None = None
    upper: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.measure, Measure):
            raise InputError(f"a constraint needs a measure with a gradient, not {self.measure!r}")
        if self.lower is None and self.upper is None:
            raise InputError(f"the constraint of {self.measure!r} has no bound: lower= or upper=")
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            raise InputError(f"the lower bound {self.lower} is above the upper one {self.upper}")

    @property
    def size(self) -> float:
        """Size that differences from the bounds are measured by."""
        sizes = [abs(b) for b in (self.lower, self.upper) if b]
        return max(sizes, default=1.0)

    def excess(self, value: float) -> float:
        """Distance beyond the bounds, 0 inside."""
        low = -np.inf if self.lower is None else self.lower
        high = np.inf if self.upper is None else self.upper
        return float(max(low - value, value - high, 0.0))


@dataclass
class Design:
    """One design that was analyzed.

    Parameters
    ----------
    x : list of float
    values : list of float
        Objective, then constraints.
    gradient : list of list of float
        Of each by all parameters.
    error : str
        Why the analysis failed; empty if it did not.
    """

    x: list[float]
    values: list[float] = field(default_factory=list)
    gradient: list[list[float]] = field(default_factory=list)
    error: str = ""


@dataclass(repr=False)
class Optimum(Brief):
    """Result of an optimization.

    Parameters
    ----------
    x : ndarray, shape (k,)
        The best design that keeps the constraints, to a millionth of their bounds; where none does,
        the one that misses them least.
    value : float
        Objective there.
    constraints : ndarray
        Measures of the constraints there.
    success : bool
        Whether the optimizer met its tolerance.
    message : str
    history : list of Design
        All designs, in their order.
    runs : int
        Analyses of this call; those of a record are not repeated.
    """

    x: Floats
    value: float
    constraints: Floats
    success: bool
    message: str
    history: list[Design]
    runs: int

    def __str__(self) -> str:
        return (
            f"objective {self.value:.6g} after {len(self.history)} designs ({self.runs} analyses); "
            f"{self.message}"
        )


class Designs:
    """Evaluates designs once, and keeps them in a file."""

    def __init__(
        self,
        function: Any,
        record: Path | None,
        progress: Callable[[int, Design], None] | None,
    ) -> None:
        self.function, self.record, self.progress = function, record, progress
        self.history: list[Design] = []
        self.known: dict[bytes, Design] = {}
        self.stored: dict[bytes, Design] = {}
        if record is not None and record.exists():
            self._read(record)

    def _read(self, record: Path) -> None:
        text = record.read_text(encoding="utf-8")
        # A line without an end was being written when the run was stopped.
        whole = text[: text.rfind("\n") + 1]
        for number, line in enumerate(whole.splitlines(), 1):
            try:
                found = Design(**json.loads(line))
                self.stored[_key(found.x)] = found
            except (ValueError, TypeError):
                raise FileError(
                    f"{record}:{number}: not a design of an optimization; name another file"
                ) from None
        if len(whole) < len(text):
            record.write_text(whole, encoding="utf-8")

    def at(self, x: Floats) -> Design:
        """The design with parameters x."""
        key = _key(x)
        if key in self.known:
            return self.known[key]
        found = self.stored.get(key)
        if found is None:
            found = self._evaluate(x)
            if self.record is not None:
                line = json.dumps(vars(found)) + "\n"
                with self.record.open("a", encoding="utf-8") as file:
                    file.write(line)
        self.known[key] = found
        self.history.append(found)
        if self.progress is not None:
            self.progress(len(self.history), found)
        return found

    def _evaluate(self, x: Floats) -> Design:
        try:
            values, rows = self.function(x)
        except CorotaError as error:
            if not any(not e.error for e in self.history):
                raise
            return Design(x.tolist(), error=str(error))
        return Design(x.tolist(), np.atleast_1d(values).tolist(), np.atleast_2d(rows).tolist())


def _key(x: ArrayLike) -> bytes:
    return np.asarray(x, dtype=np.float64).tobytes()


def optimize(
    build: Callable[[Floats], Model],
    x0: ArrayLike,
    objective: Measure,
    constraints: Sequence[Constraint] = (),
    *,
    bounds: Sequence[tuple[float, float]] | None = None,
    maximize: bool = False,
    method: Literal["SLSQP", "trust-constr", "MMA"] = "SLSQP",
    tolerance: float = 1e-8,
    most: int = 100,
    sizes: ArrayLike | None = None,
    record: str | os.PathLike[str] | None = None,
    progress: Callable[[int, Design], None] | None = None,
    **options: Any,
) -> Optimum:
    """Find parameters of a model that make a measure smallest, with exact gradients.

    Each design is one analysis with the gradients of all measures. Parameters are scaled by their
    sizes, the objective by its first value, constraints by their bounds.

    Parameters
    ----------
    build : callable
        As for :func:`corota.value_and_grad`.
    x0 : array_like, shape (k,)
        First design; its analysis must succeed.
    objective : Measure
    constraints : sequence of Constraint
    bounds : sequence of (float, float), optional
        Lowest and highest value of each parameter.
    maximize : bool
        Make the objective largest.
    method : {"SLSQP", "trust-constr", "MMA"}
        The first two of SciPy; the method of moving asymptotes, for many parameters within bounds
        and inequalities, by mmapy (``pip install corota[optimize]``).
    tolerance : float
        Relative to the scaled objective.
    most : int
        Most iterations.
    sizes : array_like, optional
        Sizes of the parameters; by default the ranges of the bounds, or the magnitudes of `x0`.
    record : path-like, optional
        File (``.jsonl``) that keeps each design; the same call continues from it. The methods
        are deterministic, so that designs which are stored are taken in the same order.
    progress : callable, optional
        ``progress(number, design)`` after each design.
    **options
        Of :func:`corota.solve`.

    Returns
    -------
    Optimum

    Raises
    ------
    CorotaError
        If the first design fails. A later one that fails counts as worse than all before, so
        that the optimizer takes a shorter step.

    Examples
    --------
    The lightest cantilever whose tip sags by at most 0.1; sag falls with the third power of the
    height:

    >>> import corota as ct
    >>> from corota import gradients
    >>> def build(x):
    ...     model = ct.Model(ct.mesh.rectangle(10.0, x[0], nx=10, ny=1))
    ...     model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0, rho=1.0))
    ...     model.fix("left")
    ...     model.force("right", y=-0.5)
    ...     return model
    >>> sag = gradients.Displacement("right", "y")
    >>> found = ct.optimize(
    ...     build, [1.0], gradients.Mass(), [gradients.Constraint(sag, lower=-0.1)],
    ...     bounds=[(0.2, 3.0)], threads=1,
    ... )
    >>> bool(abs(found.constraints[0] + 0.1) < 1e-6)
    True
    """
    start = np.array(x0, dtype=float)
    if start.ndim != 1 or not np.isfinite(start).all():
        raise InputError(f"the first design has the shape (k,) and is finite, not {x0!r}")
    if method not in ("SLSQP", "trust-constr", "MMA"):
        raise InputError(f"method is 'SLSQP', 'trust-constr' or 'MMA', not {method!r}")
    if method == "MMA" and (bounds is None or not np.isfinite(np.array(bounds, float)).all()):
        raise InputError("method='MMA' needs finite bounds of all parameters")
    scale = _scale(start, bounds, sizes)
    own = list(constraints)
    measures = [objective, *(c.measure for c in own)]
    function = value_and_grad(build, measures, sizes=scale, **options)
    designs = Designs(function, None if record is None else Path(record), progress)
    first = designs.at(start)
    sign = -1.0 if maximize else 1.0
    unit = np.array([sign / (abs(first.values[0]) or 1.0), *(1.0 / c.size for c in own)])
    last_good: list[Design] = [first]

    def at(y: Floats) -> tuple[Floats, Floats]:
        """Scaled values and gradients."""
        found = designs.at(_unscaled(y, scale, bounds))
        if not found.error:
            last_good[0] = found
            return unit * found.values, unit[:, None] * np.array(found.gradient) * scale
        good = last_good[0]
        values = unit * good.values
        # Worse than all before, with the slope of the last design that could be analyzed.
        worst = max(unit[0] * e.values[0] for e in designs.history if not e.error)
        values[0] = worst + 1.0 + abs(worst)
        return values, unit[:, None] * np.array(good.gradient) * scale

    limits = [
        (
            -np.inf if each.lower is None else each.lower * unit[k],
            np.inf if each.upper is None else each.upper * unit[k],
        )
        for k, each in enumerate(own, start=1)
    ]
    box = None
    if bounds is not None:
        low, high = np.array(bounds, dtype=float).T
        box = low / scale, high / scale
    found: Any
    if box is not None and method == "MMA":
        from corota.gradients.asymptotes import moving_asymptotes

        def usable(y: Floats) -> bool:
            return not designs.at(_unscaled(y, scale, bounds)).error

        found = moving_asymptotes(at, usable, start / scale, box, limits, tolerance, most)
    else:
        found = _by_scipy(method, at, start / scale, box, limits, tolerance, most)
    best = _best(designs, own, unit)
    return Optimum(
        np.array(best.x),
        best.values[0],
        np.array(best.values[1:]),
        bool(found.success),
        str(found.message),
        designs.history,
        function.runs,
    )


def _by_scipy(
    method: str,
    at: Callable[[Floats], tuple[Floats, Floats]],
    start: Floats,
    box: tuple[Floats, Floats] | None,
    limits: Sequence[tuple[float, float]],
    tolerance: float,
    most: int,
) -> Any:
    """Minimize the first value within limits of the others by SciPy."""
    from scipy.optimize import Bounds, NonlinearConstraint, minimize

    def value(k: int, y: Floats) -> float:
        return float(at(y)[0][k])

    def slope(k: int, y: Floats) -> Floats:
        return np.asarray(at(y)[1][k])

    conditions: list[Any] = []
    for k, (low, high) in enumerate(limits, start=1):
        bound: Any = partial(value, k)
        conditions.append(NonlinearConstraint(bound, low, high, jac=partial(slope, k)))
    extra: dict[str, Any] = {"maxiter": most}
    if method == "SLSQP":
        extra["ftol"] = tolerance
    else:
        extra |= {"gtol": tolerance, "xtol": tolerance}
    return cast("Any", minimize)(
        partial(value, 0),
        start,
        jac=partial(slope, 0),
        bounds=None if box is None else Bounds(*box, keep_feasible=True),
        constraints=conditions,
        method=method,
        options=extra,
    )


def _scale(
    start: Floats, bounds: Sequence[tuple[float, float]] | None, sizes: ArrayLike | None
) -> Floats:
    if sizes is not None:
        given = np.broadcast_to(np.asarray(sizes, dtype=float), start.shape)
        if not (given > 0.0).all():
            raise InputError("the sizes of the parameters must be > 0")
        return given
    if bounds is not None:
        if len(bounds) != len(start):
            raise InputError(f"{len(bounds)} bounds for {len(start)} parameters")
        low, high = np.array(bounds, dtype=float).T
        if not (low < high).all():
            raise InputError("the lower bounds must be below the upper ones")
        if np.isfinite(high - low).all():
            return np.asarray(high - low)
    most = float(np.abs(start).max(initial=0.0)) or 1.0
    return np.where(start != 0.0, np.abs(start), most)


def _unscaled(y: Floats, scale: Floats, bounds: Sequence[tuple[float, float]] | None) -> Floats:
    """Parameters within their bounds, from scaled ones."""
    x: Floats = np.asarray(y * scale)
    if bounds is not None:
        low, high = np.array(bounds, dtype=float).T
        x = np.clip(x, low, high)
    return x


def _best(designs: Designs, constraints: Sequence[Constraint], unit: Floats) -> Design:
    """The best design that keeps the constraints; else the one that is nearest to it."""
    good = [each for each in designs.history if not each.error]
    excess = []
    for each in good:
        over = [c.excess(v) / c.size for c, v in zip(constraints, each.values[1:], strict=True)]
        excess.append(max(over, default=0.0))
    kept = [each for each, over in zip(good, excess, strict=True) if over <= 1e-6]
    if kept:
        return min(kept, key=lambda e: unit[0] * e.values[0])
    return good[int(np.argmin(excess))]
