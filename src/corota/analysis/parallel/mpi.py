"""Communication by MPI, if the processes were started together."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pickle
import sys
import time
from functools import lru_cache
from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.parallel.communicator import ALONE, Communicator, runs_are_separate
from corota.errors import CorotaError, UnsupportedError
from corota.results.frame import PointFields

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import ModuleType

    from mpi4py import MPI
    from numpy.typing import NDArray

    from corota.analysis.linear.types import Item, Kind

#: Time for which a process with an error waits for the others to come with theirs [s].
PATIENCE = 5.0
#: Pause between two looks at them [s].
PAUSE = 0.02
#: Largest message of MPI in elements: counts are 32-bit integers there.
LARGEST_MESSAGE = 1 << 28


def processes() -> Communicator:
    """The communicator of all processes that were started together.

    Raises
    ------
    UnsupportedError
        If mpi4py is not installed.
    """
    if runs_are_separate():
        return ALONE
    try:
        mpi = import_module("mpi4py.MPI")
    except ImportError:
        raise UnsupportedError(
            "several processes need mpi4py: scripts/install_petsc.sh installs it"
        ) from None
    return _world(mpi) if mpi.COMM_WORLD.Get_size() > 1 else ALONE


@lru_cache(maxsize=1)
def _world(mpi: ModuleType) -> Processes:
    """All processes; made once, because MPI has few communicators."""
    return Processes(mpi, mpi.COMM_WORLD)


class Processes(Communicator):
    """All processes of an MPI communicator.

    Sums are formed on process 0 and sent to the others, so that they have the same bits on all.

    Parameters
    ----------
    mpi : module
        ``mpi4py.MPI``.
    """

    def __init__(self, mpi: ModuleType, world: MPI.Comm) -> None:
        self._mpi, self.handle = mpi, world.Dup()
        self._errors = world.Dup()
        # For messages of any length.
        self._objects = import_module("mpi4py.util.pkl5").Intracomm(world.Dup())
        self.rank, self.size = world.Get_rank(), world.Get_size()

    def sum(self, values: NDArray[Kind]) -> NDArray[Kind]:
        return self._reduced(values, self._mpi.SUM)

    def largest(self, values: NDArray[Kind]) -> NDArray[Kind]:
        return self._reduced(values, self._mpi.MAX)

    def _reduced(self, values: NDArray[Kind], operation: MPI.Op) -> NDArray[Kind]:
        own = np.ascontiguousarray(values)
        out = np.empty_like(own)
        given, found = own.reshape(-1), out.reshape(-1)
        for first in range(0, len(given), LARGEST_MESSAGE):
            part = slice(first, first + LARGEST_MESSAGE)
            self.handle.Reduce(given[part], found[part], operation, 0)
            self.handle.Bcast(found[part], 0)
        return out

    def greatest(self, value: float) -> float:
        return float(self.handle.bcast(self.handle.reduce(value, self._mpi.MAX, 0), 0))

    def any(self, flag: bool) -> bool:
        return bool(self.handle.allreduce(bool(flag), self._mpi.LOR))

    def broadcast(self, value: Item) -> Item:
        found: Item = self.handle.bcast(value, 0)
        return found

    def gather(self, value: Item) -> list[Item]:
        return self._objects.gather(value, 0) or []

    def exchange(self, parts: Sequence[Item]) -> list[Item]:
        found: list[Item] = self._objects.alltoall(list(parts))
        return found

    def concatenate(self, values: NDArray[Kind]) -> NDArray[Kind]:
        own = np.ascontiguousarray(values)
        counts = self.handle.allgather(own.size)
        out = np.empty(sum(counts), own.dtype)
        self.handle.Allgatherv(own.reshape(-1), (out, counts))
        return out.reshape(-1, *own.shape[1:])

    def agree(self, error: Exception | None) -> Exception | None:
        if not self.any(error is not None):
            return None
        every: list[Exception | None] = self.handle.allgather(_sendable(error))
        return next(each for each in every if each is not None)

    def fields(self, own: list[PointFields], numbers: Sequence[int]) -> list[PointFields]:
        parts = self.gather(list(zip(numbers, own, strict=True)))
        return _joined(parts) if parts else own

    def leave(self, error: BaseException, code: int = 1) -> None:
        """After an error: wait for the others, which have one too or wait for this process.

        If they do not come, the error is this process's own: it is printed, and all end.
        """
        arrived = self._errors.Ibarrier()
        limit = time.monotonic() + PATIENCE
        while not arrived.Test():
            if time.monotonic() > limit:
                kind = "" if isinstance(error, CorotaError) else f"{type(error).__name__}: "
                sys.stdout.flush()
                sys.stderr.write(f"corota: error: process {self.rank}: {kind}{error}\n")
                sys.stderr.flush()
                self.handle.Abort(code)
            time.sleep(PAUSE)


def _sendable(error: Exception | None) -> Exception | None:
    """An error that other processes can read."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _joined(parts: list[list[tuple[int, PointFields]]]) -> list[PointFields]:
    """Fields of blocks of which every process has some elements."""
    groups: dict[int, list[PointFields]] = {}
    for number, fields in (each for own in parts for each in own):
        groups.setdefault(number, []).append(fields)
    return [_join(groups[number]) for number in sorted(groups)]


def _join(group: list[PointFields]) -> PointFields:
    """Fields of elements of one block, in the order of their cells."""
    cells = np.concatenate([g.cells for g in group])
    order = np.argsort(cells, kind="stable")

    def put(each: list[NDArray[Kind]]) -> NDArray[Kind]:
        return np.concatenate(each)[order]

    one = group[0]
    names = list(one.values)
    return PointFields(
        one.element,
        cells[order],
        put([g.points for g in group]),
        one.shape,
        put([g.frame_rotation for g in group]),
        put([g.volume for g in group]),
        {name: put([g.values[name] for g in group]) for name in names},
        None if one.forces is None else put([g.forces for g in group if g.forces is not None]),
        None if one.fibers is None else put([g.fibers for g in group if g.fibers is not None]),
    )
