"""The verification catalog: what a problem is, and the list of all of them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import cache
from importlib import import_module
from inspect import cleandoc
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Literal

from corota.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from corota.model.model import Model
    from corota.results.results import Results

#: Groups of problems in the order in which they are listed.
GROUPS = (
    "linear statics",
    "large displacement",
    "paths and buckling",
    "plasticity",
    "dynamics",
    "contact",
    "properties of the method",
)

Certainty = Literal["analytic", "computed independently", "published", "converged here"]


@dataclass(frozen=True)
class Value:
    """One measured number beside its reference.

    Parameters
    ----------
    quantity : str
        What it is, with the mesh or element that it was measured on.
    tolerance : float
        Largest error.
    kind : {"relative", "absolute", "at least", "at most"}
        Error: of the quotient, of the difference, or how far a bound is missed.
    """

    quantity: str
    reference: float
    measured: float
    tolerance: float = 0.0
    kind: Literal["relative", "absolute", "at least", "at most"] = "relative"

    @property
    def error(self) -> float:
        """Error of the given `kind`; NaN where the measured value is NaN."""
        difference = self.measured - self.reference
        if self.kind == "relative":
            return abs(difference / self.reference)
        if self.kind == "absolute" or not math.isfinite(difference):
            return abs(difference)
        return max(0.0, -difference if self.kind == "at least" else difference)

    @property
    def ok(self) -> bool:
        """Whether the error is within the tolerance; never for NaN."""
        return self.error <= self.tolerance


def zero(quantity: str, measured: float, tolerance: float) -> Value:
    """A number that should be zero, such as an error, with the largest size that it may have."""
    return Value(quantity, 0.0, measured, tolerance, "absolute")


@dataclass(frozen=True)
class Study:
    """Errors over refinement, for a convergence plot.

    Parameters
    ----------
    label : str
        What the error is of.
    series : dict of str to (sizes, errors)
        By element or scheme; sizes are dofs or increments.
    across : str
        What the sizes are.
    """

    label: str
    series: Mapping[str, tuple[Sequence[float], Sequence[float]]]
    across: str = "degrees of freedom"

    @classmethod
    def over(
        cls,
        label: str,
        names: Iterable[str],
        sizes: Sequence[int],
        error: Callable[[str, int], float],
        across: str,
    ) -> Study:
        """Errors of each name, an element or a scheme, at all sizes."""
        at = [float(size) for size in sizes]
        return cls(label, {n: (at, [error(n, size) for size in sizes]) for n in names}, across)


@dataclass(frozen=True)
class Curve:
    """A computed curve with reference points.

    Parameters
    ----------
    x, y : str
        Axis labels.
    series, points : dict of str to (x, y)
        Computed lines and reference points.
    """

    x: str
    y: str
    series: Mapping[str, tuple[ArrayLike, ArrayLike]]
    points: Mapping[str, tuple[ArrayLike, ArrayLike]] = field(default_factory=dict)


@dataclass(frozen=True)
class Picture:
    """What a page shows: a variable of results on the deformed shape, or a model.

    Parameters
    ----------
    variable : str
        As ``corota plot --field`` takes it; ignored for a model.
    scale : float
        Factor of the displacements.
    """

    subject: Results | Model
    variable: str = "MISES"
    scale: float = 1.0


@dataclass
class Problem:
    """A problem with a known answer.

    Its module's docstring describes it; the module's function ``measure`` gives the values, in
    seconds, not minutes. Functions ``curve`` and ``study`` are for the pages, where there are any;
    a study may take longer.

    Parameters
    ----------
    source : str
        Where the problem and its reference values are from.
    certainty : str
        How sure the reference is: ``analytic``; ``computed independently`` by another program
        on the same discretization or a much finer one; ``published`` and not checked by us;
        ``converged here`` on finer meshes, which shows consistency and no more.
    why : str
        Reason of the tolerances.
    picture : callable, optional
        For the pages.
    seconds : float
        About how long `measure` takes on one core; long ones are started first.
    """

    title: str
    group: str
    source: str
    certainty: Certainty
    why: str
    picture: Callable[[], Picture] | None = None
    seconds: float = 1.0
    name: str = field(default="", init=False)
    description: str = field(default="", init=False)
    measure: Callable[[], Iterable[Value]] = field(init=False)
    curve: Callable[[], Curve] | None = field(default=None, init=False)
    study: Callable[[], Study] | None = field(default=None, init=False)


@cache
def problems() -> dict[str, Problem]:
    """All problems by name: one module each of :mod:`corota.verification.problems`."""
    package = import_module("corota.verification.problems")
    found = []
    for info in iter_modules(package.__path__):
        module = import_module(f"{package.__name__}.{info.name}")
        problem: Problem = module.PROBLEM
        problem.name = info.name
        problem.description = cleandoc(module.__doc__ or problem.title)
        problem.measure = module.measure
        problem.curve = getattr(module, "curve", None)
        problem.study = getattr(module, "study", None)
        found.append(problem)
    found.sort(key=lambda p: (GROUPS.index(p.group), p.name))
    return {p.name: p for p in found}


def chosen(patterns: Sequence[str]) -> list[Problem]:
    """Problems whose names match any of the patterns (``*`` and ``?``); all without patterns.

    Raises
    ------
    InputError
        If a pattern matches none.
    """
    every = problems()
    if not patterns:
        return list(every.values())
    names = set()
    for pattern in patterns:
        hits = {name for name in every if fnmatchcase(name, pattern.lower())}
        if not hits:
            raise InputError(
                f"no verification problem {pattern!r}; `corota verify --list` names them"
            )
        names |= hits
    return [problem for name, problem in every.items() if name in names]
