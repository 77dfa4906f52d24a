"""Running a sweep: rows to workers, values back, each row stored when it is done."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor, as_completed
from contextlib import nullcontext
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.errors import InputError, ResourceError
from corota.sweeps.design import rows_of
from corota.sweeps.measures import Measure
from corota.sweeps.store import Store
from corota.sweeps.table import Sweep
from corota.sweeps.variant import DeckBuild, Job, Outcome, calculate

if TYPE_CHECKING:
    from concurrent.futures import Future

    from corota.results.results import Results

    Build = Callable[..., Any] | str | os.PathLike[str]
    Measures = Mapping[str, Callable[[Results], float] | str] | Sequence[str] | str
    Progress = Callable[[int, int, int], None]


def sweep(
    build: Build,
    parameters: Mapping[str, Sequence[Any]] | Iterable[Mapping[str, Any]] | Any,
    measures: Measures,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Sweep:
    """Run a model with many values of its parameters.

    Parameters
    ----------
    build : callable or path-like
        ``build(**row)`` returns a model, a model and its steps, or results. A path names a deck
        whose ``*PARAMETER`` values the rows replace.
    parameters : mapping, iterable of mappings or pandas.DataFrame
        A mapping of names to values makes all combinations; otherwise one mapping a row, as
        :func:`corota.grid` and :func:`corota.sample` give them.
    measures : mapping, sequence of str or str
        Measures of each run: functions of the results that return a number, or strings such as
        ``"max(RM3@hub)"`` (:class:`corota.sweeps.measures.Measure`).
    executor : concurrent.futures.Executor, optional
        Executor of the rows: ``MPIPoolExecutor`` of mpi4py, ``Client.get_executor()`` of Dask, or
        any other. By default a pool of processes with one thread each.
    workers : int, optional
        Processes of the default pool; all cores by default. 1 runs in this process.
    store : path-like, optional
        File (``.jsonl``) that stores each row when it ends. Stored rows are not run again,
        so a stopped sweep can be resumed. Failed rows run again.
    progress : callable, optional
        ``progress(done, total, failed)`` after each row.

    Returns
    -------
    Sweep
        One row for each design, in their order, with errors kept in the column ``error``.

    Raises
    ------
    InputError
        If the input is not a sweep, or if every row failed.
    ResourceError
        If the workers died, or if every row failed and one of them for want of memory.

    Examples
    --------
    >>> import corota as ct
    >>> def strip(length):
    ...     model = ct.Model(ct.mesh.rectangle(length, 1.0, nx=10, ny=1))
    ...     model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    ...     model.fix("left")
    ...     model.force("right", y=-0.01)
    ...     return model
    >>> found = ct.sweep(strip, {"length": [5.0, 10.0]}, {"tip": "last(U2@right)"}, workers=1)
    >>> bool(found["tip"][1] / found["tip"][0] > 7.0)
    True
    """
    if executor is not None and workers is not None:
        raise InputError("give either an executor or a number of workers")
    if workers is not None and workers < 1:
        raise InputError(f"a sweep needs at least one worker, not {workers}")
    rows = rows_of(parameters)
    chosen = named(measures)
    if clash := set(chosen) & set(rows[0]):
        raise InputError(f"{sorted(clash)[0]!r} is both a parameter and a measure")
    job = Job(build if callable(build) else DeckBuild(Path(build)), chosen)
    kept = Store(None if store is None else Path(store), job)
    outcomes: dict[int, Outcome] = {}
    for number, row in enumerate(rows):
        if (known := kept.find(row)) is not None:
            outcomes[number] = known
    failed = 0

    def take(number: int, outcome: Outcome) -> None:
        nonlocal failed
        outcomes[number] = outcome
        kept.add(rows[number], outcome)
        failed += bool(outcome.error)
        if progress is not None:
            progress(len(outcomes), len(rows), failed)

    left = [number for number in range(len(rows)) if number not in outcomes]
    if workers is None and executor is None:
        workers = min(os.cpu_count() or 1, len(left)) or 1
    with kept:
        if executor is None and workers == 1:
            for number in left:
                take(number, calculate(job, rows[number]))
        elif left:
            _spread(job, rows, left, take, executor, workers or 1)
    ordered = [outcomes[number] for number in range(len(rows))]
    if all(outcome.error for outcome in ordered):
        short = any(outcome.short for outcome in ordered)
        failure = ResourceError if short else InputError
        raise failure(f"every row of the sweep failed; the first: {ordered[0].error}")
    return Sweep(rows, list(chosen), ordered)


def named(measures: Measures) -> dict[str, Callable[[Results], float]]:
    """Measures by name; the default name is the text."""
    if isinstance(measures, str):
        measures = [measures]
    if not isinstance(measures, Mapping):
        measures = {str(text): text for text in measures}
    if not measures:
        raise InputError("a sweep needs at least one measure, such as 'max(U2@tip)'")
    found: dict[str, Callable[[Results], float]] = {}
    for name, measure in measures.items():
        if not (callable(measure) or isinstance(measure, str)):
            raise InputError(f"measure {name!r}: give a function of the results or a string")
        found[name] = Measure(measure) if isinstance(measure, str) else measure
    return found


def _spread(
    job: Job,
    rows: Sequence[Mapping[str, Any]],
    left: Sequence[int],
    take: Callable[[int, Outcome], None],
    executor: Executor | None,
    workers: int,
) -> None:
    """Run rows in an executor."""
    payload = packed(job, foreign=executor is not None)
    pool: Any = nullcontext(executor)
    if executor is None:
        from multiprocessing import get_context

        # Forked processes would inherit the locks of this one's threads.
        pool = ProcessPoolExecutor(
            workers, mp_context=get_context("spawn"), initializer=end_with_parent
        )
    with pool as running:
        futures: dict[Future[Outcome], int] = {
            running.submit(unpacked_run, payload, dict(rows[number])): number for number in left
        }
        try:
            for future in as_completed(futures):
                take(futures[future], future.result())
        except BrokenExecutor:
            raise ResourceError(
                "the workers of the sweep stopped; a script must call sweep under 'if __name__ "
                '== "__main__":\', and each worker needs memory for its own run'
            ) from None
        except BaseException:
            for future in futures:
                future.cancel()
            raise


def end_with_parent() -> None:
    """Let this worker end when the process that started it is killed; nothing else does."""
    from multiprocessing import parent_process
    from threading import Thread

    parent = parent_process()
    assert parent is not None

    def watch() -> None:
        parent.join()
        os._exit(1)

    Thread(target=watch, name="corota-parent", daemon=True).start()


def packed(job: Job, foreign: bool) -> bytes:
    """Job as bytes that a worker can read.

    Functions of a script or notebook exist only there: `foreign` workers get their text, which
    if cloudpickle is installed.

    Raises
    ------
    InputError
        If the job cannot be sent to another process.
    """
    by_value = find_spec("cloudpickle") is not None
    if by_value and foreign:
        return bytes(import_module("cloudpickle").dumps(job))
    try:
        return pickle.dumps(job)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        if by_value:
            return bytes(import_module("cloudpickle").dumps(job))
        raise InputError(
            f"the build function or a measure cannot be sent to other processes ({error}): define "
            "it by def at the top of a file, install cloudpickle, or use workers=1"
        ) from None


@lru_cache(maxsize=1)
def _job(payload: bytes) -> Job:
    job = pickle.loads(payload)
    assert isinstance(job, Job)
    return job


def unpacked_run(payload: bytes, row: dict[str, Any]) -> Outcome:
    """Run a row in a worker."""
    return calculate(_job(payload), row)
