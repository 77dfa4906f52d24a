"""A file that is complete at every moment: two copies, written in turn, swapped by renaming."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import os
import time
from pathlib import Path
from typing import IO

from corota.errors import FileError
from corota.lazy import lazy

copyfile = lazy("shutil:copyfile")

#: Age of a file from which each commit is flushed before it is renamed [s]; a run that is
#: younger is cheap to repeat.
YOUNG = 1.0


def full(error: OSError, path: Path) -> FileError:
    """Say which file could not be written, and why."""
    reason = error.strerror or str(error)
    return FileError(f"{path}: cannot write: {reason}")


def sync(path: Path) -> None:
    """Flush a file to the disk.

    Raises
    ------
    FileError
        If writing fails.
    """
    try:
        with open(path, "rb") as file:
            os.fsync(file.fileno())
    except OSError as error:
        raise full(error, path) from None


class AtomicFile:
    """File-like object whose visible name always denotes a complete state.

    Writes are held in memory until :meth:`commit`. A commit brings the hidden copy up to date
    (the writes of this commit and of the one before) and exchanges the names by atomic renaming.
    Anyone who opens the visible name, even after the process was killed at any moment,
    sees the state of one commit. The cost is that everything is written twice. A commit of a file
    that is no longer young is flushed to the disk before the names change, so that a power failure
    also leaves the state of a commit.

    Parameters
    ----------
    path : Path
        The visible name; not touched before the first commit.
    keep : bool
        Continue the existing file.
    """

    def __init__(self, path: Path, keep: bool = False) -> None:
        self.path = path
        self.hidden = path.with_name(f".{path.name}.next")
        self._spare = path.with_name(f".{path.name}.last")
        self._born = time.monotonic()
        self._at = 0
        self._size = 0
        self._pending: list[tuple[int, bytes]] = []
        self._behind: list[tuple[int, bytes]] = []
        self._shown = False
        try:
            self.hidden.unlink(missing_ok=True)
            if keep:
                copyfile(path, self.hidden)
                self._size = path.stat().st_size
                self._shown = True
            else:
                self.hidden.touch()
        except OSError as error:
            raise full(error, path) from None

    # File-like interface for HDF5.
    def seek(self, offset: int, whence: int = 0) -> int:
        self._at = offset + (0, self._at, self._size)[whence]
        return self._at

    def tell(self) -> int:
        return self._at

    def write(self, data: bytes | memoryview) -> int:
        held = bytes(data)
        self._pending.append((self._at, held))
        self._at += len(held)
        self._size = max(self._size, self._at)
        return len(held)

    def read(self, size: int) -> bytes:
        held = bytearray(size)
        return bytes(held[: self.readinto(held)])

    def readinto(self, buffer: bytearray | memoryview) -> int:
        view = memoryview(buffer).cast("B")
        start, end = self._at, min(self._at + len(view), self._size)
        view[:] = bytes(len(view))
        if self._shown:
            with open(self.path, "rb") as file:
                file.seek(start)
                file.readinto(view)
        for offset, data in self._pending:
            first, last = max(start, offset), min(end, offset + len(data))
            if first < last:
                view[first - start : last - start] = data[first - offset : last - offset]
        self._at = end
        return end - start

    def truncate(self, size: int | None = None) -> int:
        self._size = self._at if size is None else size
        return self._size

    def flush(self) -> None:
        """Do nothing: only a commit is flushed to the disk."""

    def commit(self, last: bool = False) -> None:
        """Make the current state the visible one.

        Parameters
        ----------
        last : bool
            Whether nothing will be written any more: then no hidden copy is made.

        Raises
        ------
        FileError
            If writing fails; the visible file keeps the state of the commit before.
        """
        if not self._pending and self._shown:
            return
        try:
            with open(self.hidden, "r+b") as file:
                self._apply(file, self._behind)
                self._apply(file, self._pending)
                file.truncate(self._size)
                if time.monotonic() - self._born >= YOUNG:
                    file.flush()
                    os.fsync(file.fileno())
        except OSError as error:
            raise full(error, self.path) from None
        self._behind, self._pending = self._pending, []
        try:
            self._swap(last)
        except OSError as error:
            raise full(error, self.path) from None

    def _apply(self, file: IO[bytes], writes: list[tuple[int, bytes]]) -> None:
        for offset, data in writes:
            file.seek(offset)
            file.write(data)

    def _swap(self, last: bool) -> None:
        if last:
            os.replace(self.hidden, self.path)
            return
        if not self._shown:
            os.replace(self.hidden, self.path)
            copyfile(self.path, self.hidden)
            self._behind = []
            self._shown = True
            return
        try:
            self._spare.unlink(missing_ok=True)
            os.link(self.path, self._spare)
        except OSError:  # a file system without hard links: the copy costs more, not safety
            os.replace(self.hidden, self.path)
            copyfile(self.path, self.hidden)
            self._behind = []
            return
        os.replace(self.hidden, self.path)
        os.replace(self._spare, self.hidden)

    def sync(self) -> None:
        """Flush the last commit to the disk."""
        sync(self.path)

    def close(self) -> None:
        """Remove the hidden copy; uncommitted data are lost."""
        for name in (self.hidden, self._spare):
            with contextlib.suppress(OSError):
                name.unlink(missing_ok=True)


class TextFile:
    """A text file that is extended by whole pieces.

    A piece that cannot be written is cut off again, so the file never ends within one.

    Parameters
    ----------
    path : Path
    keep : bool
        Continue at the end of an existing file instead of emptying it.
    """

    def __init__(self, path: Path, keep: bool = False) -> None:
        self.path = path
        try:
            mode = "r+b" if keep else "w+b"
            self._file = open(path, mode, buffering=0)  # noqa: SIM115 (closed by close)
            self._file.seek(0, os.SEEK_END)
        except OSError as error:
            raise full(error, path) from None

    def append(self, text: str | bytes) -> None:
        """Write a piece and flush it at once.

        Raises
        ------
        FileError
            If writing fails.
        """
        data = memoryview(text.encode() if isinstance(text, str) else text)
        start = self._file.tell()
        try:
            while data:
                data = data[self._file.write(data) :]
        except OSError as error:
            with contextlib.suppress(OSError):
                self._file.truncate(start)
                self._file.seek(start)
            raise full(error, self.path) from None

    @property
    def length(self) -> int:
        """Bytes so far."""
        return self._file.tell()

    def cut(self, length: int) -> None:
        """Truncate the file to a length.

        Raises
        ------
        FileError
            If the file is shorter.
        """
        if self.length < length:
            raise FileError(f"{self.path}: {self.length} bytes, the checkpoint expects {length}")
        try:
            self._file.truncate(length)
            self._file.seek(length)
        except OSError as error:
            raise full(error, self.path) from None

    def sync(self) -> None:
        """Flush everything to the disk."""
        try:
            os.fsync(self._file.fileno())
        except OSError as error:
            raise full(error, self.path) from None

    def close(self) -> None:
        """Close the file."""
        with contextlib.suppress(OSError):
            self._file.close()


def replace_text(path: Path, text: str) -> None:
    """Write a small text file at once: temporary name, then renaming.

    Raises
    ------
    FileError
        If writing fails; an earlier file of that name stays.
    """
    hidden = path.with_name(f".{path.name}.next")
    try:
        hidden.write_text(text, encoding="utf-8", newline="\n")
        os.replace(hidden, path)
    except OSError as error:
        with contextlib.suppress(OSError):
            hidden.unlink(missing_ok=True)
        raise full(error, path) from None
