"""Histories of the increments of a run, in memory up to a bound, beyond in a temporary file."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import tempfile
from collections.abc import Sequence
from typing import overload

import numpy as np

from corota.arrays import Floats
from corota.errors import InputError

#: Bytes of the unit in which the bound is given [MB].
MEGABYTE = 1e6


class _File:
    """A temporary file, which the system deletes with the process at the latest."""

    def __init__(self) -> None:
        self.file = tempfile.TemporaryFile()  # noqa: SIM115
        self.size = 0

    def __del__(self) -> None:
        self.file.close()

    def write(self, array: Floats) -> None:
        self.file.seek(self.size)
        self.file.write(np.ascontiguousarray(array).data)
        self.size += array.nbytes

    def read(self, start: int, count: int) -> Floats:
        self.file.seek(start)
        return np.frombuffer(self.file.read(8 * count), np.float64)


class _Filed(Sequence["Floats"]):
    """Arrays of one axis that stand in a file; each is read when it is taken."""

    def __init__(self, file: _File, arrays: Sequence[Floats]) -> None:
        self.file, self.sizes = file, [array.size for array in arrays]
        self.starts = [file.size + 8 * sum(self.sizes[:k]) for k in range(len(arrays))]
        for array in arrays:
            file.write(array)

    def __len__(self) -> int:
        return len(self.sizes)

    @overload
    def __getitem__(self, index: int) -> Floats: ...
    @overload
    def __getitem__(self, index: slice) -> list[Floats]: ...
    def __getitem__(self, index: int | slice) -> Floats | list[Floats]:
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        return self.file.read(self.starts[index], self.sizes[index])


class HistoryStore:
    """Keeps arrays for the way back through a run.

    Parameters
    ----------
    memory : float, optional
        Memory for them [MB]; by default any. What does not fit goes to a temporary file: the
        numbers stay the same to the bit.

    Attributes
    ----------
    kept, filed : int
        Bytes in memory, and in the file.

    Raises
    ------
    InputError
        If the bound is negative or no number.
    """

    def __init__(self, memory: float | None = None) -> None:
        if memory is not None and not (np.isfinite(memory) and memory >= 0.0):
            raise InputError(f"memory must be a number of MB >= 0, not {memory!r}")
        self.bound = np.inf if memory is None else memory * MEGABYTE
        self.kept = self.filed = 0
        self._file: _File | None = None

    def keep(self, arrays: Sequence[Floats]) -> Sequence[Floats]:
        """The same numbers, in memory or read from the file at each use."""
        size = sum(array.nbytes for array in arrays)
        if self.kept + size <= self.bound:
            self.kept += size
            return list(arrays)
        self._file = self._file or _File()
        self.filed += size
        return _Filed(self._file, arrays)
