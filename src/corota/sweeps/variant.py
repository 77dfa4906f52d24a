"""One row of a sweep: build the model, solve it on one thread, measure the results."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.errors import InputError, ResourceError

if TYPE_CHECKING:
    from corota.model.model import Model
    from corota.results.results import Results


@dataclass(frozen=True)
class DeckBuild:
    """Reads a deck with other values of its ``*PARAMETER`` names."""

    path: Path
    options: Mapping[str, Any] = field(default_factory=dict)

    def __call__(self, **parameters: Any) -> Model:
        """Model of the deck."""
        from corota.io.formats import read

        return read(self.path, parameters=parameters, **self.options)

    def files(self) -> list[Path]:
        """The deck and the files that it includes."""
        from corota.io.deck.lexer import Lexer

        lexer = Lexer(self.path, bool(self.options.get("allow_include")))
        lexer.read()
        return [self.path, *sorted(lexer.files - {self.path.resolve()})]


@dataclass(frozen=True)
class Job:
    """Common data of all rows of a sweep."""

    build: Callable[..., Any]
    measures: Mapping[str, Callable[[Results], float]]


@dataclass
class Outcome:
    """Outcome of a row: values by measure, or the error.

    Parameters
    ----------
    error : str
        Empty for a row that ended.
    seconds : float
        Wall time of the row [s].
    notes : list of str
        Warnings and notes of the run.
    short : bool
        Whether the memory did not suffice.
    """

    values: dict[str, float] = field(default_factory=dict)
    error: str = ""
    seconds: float = 0.0
    notes: list[str] = field(default_factory=list)
    short: bool = False


def calculate(job: Job, row: Mapping[str, Any]) -> Outcome:
    """Run one row; errors are part of the outcome."""
    from corota.analysis.parallel.communicator import separate_runs

    outcome, begin = Outcome(), time.perf_counter()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            with separate_runs():
                results = solved(job.build(**row))
            outcome.values = {name: number(name, m(results)) for name, m in job.measures.items()}
            outcome.notes += [*results.model.notes, *results.notes]
        except Exception as error:
            kind = "" if hasattr(error, "exit_code") else f"{type(error).__name__}: "
            outcome.short = isinstance(error, (MemoryError, ResourceError))
            first, *more = f"{kind}{error}".splitlines() or [""]
            outcome.error = first + (f" (and {len(more)} more lines)" if more else "")
    outcome.notes += [str(w.message) for w in caught if issubclass(w.category, UserWarning)]
    outcome.notes = list(dict.fromkeys(outcome.notes))
    outcome.seconds = time.perf_counter() - begin
    return outcome


def solved(built: Any) -> Results:
    """Results from the return value of a build function: a model, a model and steps, or results."""
    from corota.analysis.run import solve
    from corota.model.model import Model
    from corota.results.results import Results

    if isinstance(built, Results):
        return built
    if isinstance(built, Model):
        return solve(built, threads=1)
    if isinstance(built, tuple) and len(built) == 2 and isinstance(built[0], Model):
        return solve(*built, threads=1)
    raise InputError(
        "the build function of a sweep returns a Model, (Model, steps) or Results, not "
        f"{type(built).__name__}"
    )


def number(name: str, value: Any) -> float:
    """Value of a measure."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InputError(
            f"measure {name!r} returned {type(value).__name__}, not a number"
        ) from None
