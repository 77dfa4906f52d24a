"""A request to end a run from outside: a hidden file beside its files.

It reaches a run on whatever machine and system, unlike a signal; what follows is the same: the run
ends after the increment at work, with a checkpoint.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import time
from pathlib import Path

from corota.io.atomic_file import full

#: Seconds between two looks at the folder.
BEAT = 0.25


def stop_file(folder: Path, name: str) -> Path:
    """The file that asks the run of a job to end."""
    return folder / f".{name}.stop"


def request_stop(folder: Path, name: str) -> None:
    """Ask the run of a job to end after the increment at work.

    Raises
    ------
    FileError
        If the folder takes no files.
    """
    path = stop_file(folder, name)
    try:
        path.touch()
    except OSError as error:
        raise full(error, path) from None


class StopRequest:
    """Looks for the request, no more often than every :data:`BEAT`.

    Parameters
    ----------
    path : Path
        One that an earlier run left is removed.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.clear()
        self._next = 0.0
        self._requested = False

    @property
    def requested(self) -> bool:
        """Whether the run is to end."""
        now = time.monotonic()
        if not self._requested and now >= self._next:
            self._next = now + BEAT
            self._requested = self.path.exists()
        return self._requested

    def clear(self) -> None:
        """Remove the file."""
        with contextlib.suppress(OSError):
            self.path.unlink(missing_ok=True)


__all__ = ["BEAT", "StopRequest", "request_stop", "stop_file"]
