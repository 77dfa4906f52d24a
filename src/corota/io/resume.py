"""Resuming from a checkpoint."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from corota.analysis.run import solve
from corota.analysis.state_tree import UnsuitableState
from corota.errors import FileError, InputError
from corota.io.checkpoint import Saved, newest, rebuilt
from corota.io.file_options import FileOptions
from corota.io.job import JobFiles
from corota.model.steps import Step

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from os import PathLike

    from corota.analysis.linear.solvers import LinearSolver
    from corota.model.model import Model
    from corota.results.observer import Observer
    from corota.results.results import Results


def resume(
    path: str | PathLike[str],
    steps: Step | Sequence[Step] | None = None,
    *,
    model: Model | None = None,
    observers: Iterable[Observer] = (),
    solver: str | LinearSolver = "multifrontal",
    threads: int | None = None,
    keep: Literal["all", "last"] = "all",
    fields: bool = True,
) -> Results:
    """Resume a stopped run from its newest intact checkpoint.

    The results are bitwise identical to those of an uninterrupted run, and so are its files,
    which continue from the state of the checkpoint.

    Parameters
    ----------
    path : path-like
        A checkpoint, or the deck, a file or the stem of a job with one.
    steps : Step or sequence of Step, optional
        Steps that follow the state of the checkpoint, in place of the rest of the run. No file of
        the run changes then; `observers` may hold a :class:`JobFiles` of another name.
    model : Model, optional
        Needed if its materials are Python functions, which are not stored.
    observers, solver, threads, keep, fields
        As for :func:`corota.solve`. With another solver the results agree to rounding.

    Returns
    -------
    Results
        Of the increments after the checkpoint.

    Raises
    ------
    FileError
        If there is no checkpoint, or each is damaged or belongs to another program or model.
    """
    saved, refused = newest(Path(path))
    own, old = model_of(saved, model)
    observers = list(observers)
    if steps is None:
        observers.append(files_of(saved))
        plan = old
    else:
        new = [steps] if isinstance(steps, Step) else list(steps)
        plan = [*old[: saved.state.step], *new]
        saved.state.leave_step = True
    own.notes += [f"not used: {reason}" for reason in refused]
    try:
        return solve(
            own,
            plan,
            observers=observers,
            solver=solver,
            threads=threads,
            keep=keep,
            fields=fields,
            start=saved.state,
        )
    except UnsuitableState as error:
        raise foreign(saved, error) from None


def foreign(saved: Saved, error: UnsuitableState) -> FileError:
    """The error of a checkpoint that does not fit the model."""
    return FileError(f"{saved.path}: this checkpoint belongs to another model ({error})")


def model_of(saved: Saved, model: Model | None = None) -> tuple[Model, list[Step]]:
    """Model and steps that a checkpoint belongs to.

    Raises
    ------
    FileError
        If the model is another one, or is not stored and not given.
    """
    if model is None:
        return rebuilt(saved)
    if not model.steps:
        raise InputError("the model needs its steps (model.steps) to continue from a checkpoint")
    return model, list(model.steps)


def files_of(saved: Saved) -> JobFiles:
    """The files of a run, to be continued."""
    options = saved.options
    return JobFiles(
        saved.path.parent,
        saved.job,
        formats=options["formats"],
        histories=options["histories"],
        **{f.name: options[f.name] for f in fields(FileOptions)},
        checkpoint_every=options["every"],
        checkpoint_seconds=options["seconds"],
        source=options["source"],
        resume=saved,
    )
