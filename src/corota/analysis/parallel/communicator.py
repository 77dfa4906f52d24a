"""Communication between the processes of one analysis; with one process there is none.

All processes run the same program on the same model. Each evaluates its own elements; forces,
energies, matrices and decisions are then sums over the processes, or the largest of their values.
Vectors are whole on every process and have the same bits there, so all take the same branches.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from corota.analysis.linear.types import Item, Kind
    from corota.results.frame import PointFields


class Communicator:
    """One process: what is shared is returned as it is.

    Attributes
    ----------
    rank, size : int
        Number of this process, from 0, and the number of processes.
    """

    rank, size = 0, 1

    @property
    def first(self) -> bool:
        """Whether this process adds contributions that all processes compute."""
        return self.rank == 0

    def sum(self, values: NDArray[Kind]) -> NDArray[Kind]:
        """Sum of the arrays of all processes, which have the same shape."""
        return values

    def largest(self, values: NDArray[Kind]) -> NDArray[Kind]:
        """Largest values of all processes, of arrays of the same shape."""
        return values

    def greatest(self, value: float) -> float:
        """Largest of one number from each process."""
        return value

    def any(self, flag: bool) -> bool:
        """Whether the flag of any process is set."""
        return flag

    def all(self, flag: bool) -> bool:
        """Whether the flags of all processes are set."""
        return not self.any(not flag)

    def broadcast(self, value: Item) -> Item:
        """The value of process 0."""
        return value

    def gather(self, value: Item) -> list[Item]:
        """Values of all processes on process 0; no values on the others."""
        return [value]

    def exchange(self, parts: Sequence[Item]) -> list[Item]:
        """One value from each process, which gives one to each."""
        return list(parts)

    def concatenate(self, values: NDArray[Kind]) -> NDArray[Kind]:
        """The arrays of all processes one after the other, along the first axis."""
        return values

    def agree(self, error: Exception | None) -> Exception | None:
        """The error of the first process that has one; all processes must call this."""
        return error

    def fields(self, own: list[PointFields], numbers: Sequence[int]) -> list[PointFields]:
        """Fields of whole blocks on process 0, of the own elements on the others.

        Parameters
        ----------
        own : list of PointFields
            Of the own elements.
        numbers : sequence of int
            Their blocks.
        """
        return own

    def leave(self, error: BaseException, code: int = 1) -> None:
        """After an error: wait for the other processes; end them if they continue."""


#: The communicator of one process.
ALONE = Communicator()


_separate: ContextVar[bool] = ContextVar("separate", default=False)


@contextlib.contextmanager
def separate_runs() -> Iterator[None]:
    """Let each process run its own analyses in this block, also under ``mpiexec``."""
    token = _separate.set(True)
    try:
        yield
    finally:
        _separate.reset(token)


def runs_are_separate() -> bool:
    """Whether each process runs its own analyses."""
    return _separate.get()
