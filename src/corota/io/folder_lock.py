"""One run at a time for the files of a job: a lock that ends with its process."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import errno
import os
from pathlib import Path

from corota.errors import FileError
from corota.io.atomic_file import full
from corota.io.regular_file import open_to_write

try:
    import fcntl
except ImportError:  # a system without locks: two runs cannot be detected
    fcntl = None  # type: ignore[assignment]


class FolderLock:
    """Lock on a job's files, held until :meth:`release` or the end of the process.

    Parameters
    ----------
    path : Path
        Hidden file that carries it.

    Raises
    ------
    FileError
        If another run holds it, or the folder is not writable.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._file: int | None = None
        self._job = path.name[1:].removesuffix(".lock")
        while fcntl is not None and self._file is None:
            self._file = self._take()

    def _take(self) -> int | None:
        """The lock; None if the file was removed by its last holder meanwhile."""
        try:
            file = open_to_write(self.path, os.O_RDWR)
        except OSError as error:
            odd = error.errno in (errno.ELOOP, errno.EINVAL)  # a link or a pipe in its place
            raise full(error, self.path if odd else self.path.with_name(self._job)) from None
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = os.read(file, 32).decode("ascii", "replace").strip()
            os.close(file)
            raise FileError(
                f"{self.path.parent}: another run{f' (process {holder})' if holder else ''} is "
                f"writing the files of this job ({self._job}); wait for it, or use another folder "
                "(-o) or name (--name)"
            ) from None
        except OSError:
            return file  # a file system without locks
        with contextlib.suppress(OSError):
            if os.stat(self.path).st_ino == os.fstat(file).st_ino:
                os.ftruncate(file, 0)
                os.pwrite(file, str(os.getpid()).encode(), 0)
                return file
        os.close(file)
        return None

    def release(self) -> None:
        """Release the lock."""
        if self._file is None:
            return
        with contextlib.suppress(OSError):
            self.path.unlink()
        with contextlib.suppress(OSError):
            os.close(self._file)
        self._file = None
