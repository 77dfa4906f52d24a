"""Runs verification problems in parallel processes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import time
import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context

from corota.verification.catalogue import Problem, Value, problems
from corota.verification.outcome import Outcome


def measure(name: str, full: bool = False, pages: str = "") -> Outcome:
    """Measure one problem in this process.

    Parameters
    ----------
    full : bool
        Run its convergence study too.
    pages : str
        Folder that its page is written to, with the plotting extra.
    """
    problem = problems()[name]
    outcome = Outcome(name)
    start = time.perf_counter()
    try:
        with warnings.catch_warnings():
            # Large strain, for instance, is intended.
            warnings.simplefilter("ignore")
            # Python's own numbers pickle and print alike everywhere.
            outcome.values = [
                Value(v.quantity, float(v.reference), float(v.measured), float(v.tolerance), v.kind)
                for v in problem.measure()
            ]
            outcome.seconds = time.perf_counter() - start
            if full and problem.study is not None:
                outcome.study = problem.study()
            if pages:
                from corota.verification.pages import write_page

                write_page(problem, outcome, pages)
    except Exception as error:
        outcome.error = f"{type(error).__name__}: {error}"
        outcome.seconds = outcome.seconds or time.perf_counter() - start
    return outcome


def run(
    chosen: Sequence[Problem],
    done: Callable[[Outcome], None],
    *,
    full: bool = False,
    pages: str = "",
    jobs: int = 0,
) -> list[Outcome]:
    """Measure problems in parallel, the longest first; outcomes in the order of `chosen`.

    Parameters
    ----------
    done : callable
        Called with each outcome as it arrives.
    full, pages
        As for :func:`measure`.
    jobs : int
        Processes; all cores by default.
    """
    jobs = min(jobs or _cores(), len(chosen)) or 1
    outcomes: dict[str, Outcome] = {}
    _single_threaded()

    def attempt(names: list[str], jobs: int) -> list[str]:
        """Measure in a pool; returns the names lost with a process."""
        lost = []
        with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
            waiting: dict[Future[Outcome], str] = {
                pool.submit(measure, name, full, pages): name for name in names
            }
            try:
                while waiting:
                    ready, _ = wait(waiting, return_when=FIRST_COMPLETED)
                    for future in ready:
                        name = waiting.pop(future)
                        try:
                            outcomes[name] = future.result()
                        except BrokenProcessPool:
                            lost.append(name)
                            continue
                        done(outcomes[name])
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
        return lost

    lost = attempt([p.name for p in sorted(chosen, key=lambda p: -p.seconds)], jobs)
    for name in lost:
        # A process that ends breaks the whole pool: the others are run again.
        if attempt([name], 1):
            outcomes[name] = Outcome(name, error="its process ended early")
            done(outcomes[name])
    return [outcomes[p.name] for p in chosen]


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _single_threaded() -> None:
    """Limit the linear algebra libraries of new processes to one thread."""
    for name in ("OMP", "OPENBLAS", "MKL", "RAYON"):
        os.environ.setdefault(f"{name}_NUM_THREADS", "1")
