"""A file that is complete at every moment: two copies, written in turn, swapped by renaming."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterator
from pathlib import Path

from corota.errors import FileError
from corota.io.regular_file import open_to_write
from corota.lazy import lazy

copyfile = lazy("shutil:copyfile")

#: Age of a file from which each commit is flushed before it is renamed [s]; a run that is
#: younger is cheap to repeat.
YOUNG = 1.0
#: Bytes of a page, the unit in which a file is written.
PAGE = 1 << 14


def full(error: OSError, path: Path) -> FileError:
    """Say which file could not be written, and why."""
    reason = error.strerror or str(error)
    return FileError(f"{path}: cannot write: {reason}")


@contextlib.contextmanager
def writing(path: Path) -> Iterator[None]:
    """Report errors of the system as those of writing a file.

    Raises
    ------
    FileError
        If writing fails.
    """
    try:
        yield
    except OSError as error:
        raise full(error, path) from None


def sync(path: Path) -> None:
    """Flush a file to the disk; as :func:`writing`."""
    with writing(path), open(path, "rb") as file:
        os.fsync(file.fileno())


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
        #: Pages written since the last commit, and those that the hidden copy is behind by.
        self._pages: dict[int, bytearray] = {}
        self._behind: dict[int, bytearray] = {}
        self._shown = False
        with writing(path):
            self.hidden.unlink(missing_ok=True)
            if keep:
                copyfile(path, self.hidden)
                self._size = path.stat().st_size
                self._shown = True
            else:
                self.hidden.touch()

    # File-like interface for HDF5.
    def seek(self, offset: int, whence: int = 0) -> int:
        self._at = offset + (0, self._at, self._size)[whence]
        return self._at

    def tell(self) -> int:
        return self._at

    def write(self, data: bytes | memoryview) -> int:
        view = memoryview(data).cast("B")
        for number, inside, part in self._parts(len(view)):
            page = self._pages.get(number)
            if page is None:
                page = self._pages[number] = bytearray(PAGE)
                self._read_shown(number * PAGE, memoryview(page))
            page[inside] = view[part]
        self._at += len(view)
        self._size = max(self._size, self._at)
        return len(view)

    def read(self, size: int) -> bytes:
        data = bytearray(size)
        return bytes(data[: self.readinto(data)])

    def readinto(self, buffer: bytearray | memoryview) -> int:
        view = memoryview(buffer).cast("B")
        count = max(0, min(len(view), self._size - self._at))
        view[:] = bytes(len(view))
        self._read_shown(self._at, view[:count])
        for number, inside, part in self._parts(count):
            if number in self._pages:
                view[part] = self._pages[number][inside]
        self._at += count
        return count

    def _parts(self, count: int) -> Iterator[tuple[int, slice, slice]]:
        """Pages of the next bytes: number, place within the page, place among the bytes."""
        done = 0
        while done < count:
            number, start = divmod(self._at + done, PAGE)
            size = min(PAGE - start, count - done)
            yield number, slice(start, start + size), slice(done, done + size)
            done += size

    def _read_shown(self, start: int, view: memoryview) -> None:
        """Fill a buffer from the visible file as far as that goes."""
        if self._shown:
            with open(self.path, "rb") as file:
                file.seek(start)
                file.readinto(view)

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
        if not self._pages and self._shown:
            return
        with writing(self.path):
            with open(self.hidden, "r+b") as file:
                for pages in (self._behind, self._pages):
                    for number, page in sorted(pages.items()):
                        file.seek(number * PAGE)
                        file.write(page)
                file.truncate(self._size)
                if time.monotonic() - self._born >= YOUNG:
                    file.flush()
                    os.fsync(file.fileno())
            self._swap(last)

    def _swap(self, last: bool) -> None:
        linked = self._shown and not last
        if linked:
            try:
                self._spare.unlink(missing_ok=True)
                os.link(self.path, self._spare)
            except OSError:  # a file system without hard links: the copy costs more, not safety
                linked = False
        os.replace(self.hidden, self.path)
        # Not before: without the exchange the visible file still needs these pages.
        self._behind, self._pages = self._pages, {}
        if linked:
            os.replace(self._spare, self.hidden)
        elif not last:
            copyfile(self.path, self.hidden)
            self._behind, self._shown = {}, True

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
    keep : bool
        Continue at the end of an existing file instead of emptying it.
    """

    def __init__(self, path: Path, keep: bool = False) -> None:
        self.path = path
        with writing(path):
            file = open_to_write(path, os.O_RDWR | (0 if keep else os.O_TRUNC))
            self._file = open(file, "r+b", buffering=0)  # noqa: SIM115 (closed by close)
            self._file.seek(0, os.SEEK_END)

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
        with writing(self.path):
            self._file.truncate(length)
            self._file.seek(length)

    def sync(self) -> None:
        """Flush everything to the disk."""
        with writing(self.path):
            os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close the file."""
        with contextlib.suppress(OSError):
            self._file.close()


@contextlib.contextmanager
def replaced(path: Path, suffix: str = "") -> Iterator[Path]:
    """Write a file under a temporary name, which the body gets and which then takes its place.

    Parameters
    ----------
    suffix : str
        End of the temporary name, for writers that choose the format by it.

    Raises
    ------
    FileError
        If writing fails; an earlier file of that name stays.
    """
    stem = path.name.removesuffix(path.suffix) if suffix else path.name
    hidden = path.with_name(f".{stem}.next{suffix}")
    try:
        hidden.unlink(missing_ok=True)  # it may be a link
        yield hidden
        os.replace(hidden, path)
    except OSError as error:
        with contextlib.suppress(OSError):
            hidden.unlink(missing_ok=True)
        raise full(error, path) from None


def replace_text(path: Path, text: str) -> None:
    """Write a small text file at once; see :func:`replaced`."""
    with replaced(path) as hidden:
        hidden.write_text(text, encoding="utf-8", newline="\n")
