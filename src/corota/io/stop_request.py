"""A request to end a run from outside: a hidden file in its folder.

Unlike a signal it works on any machine and system; the effect is the same: the run
ends after the current increment, with a checkpoint.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import time
from pathlib import Path

from corota.io.atomic_file import full

#: Seconds between two checks of the folder.
BEAT = 0.25


def stop_file(folder: Path, name: str) -> Path:
    """The file that requests the end of a run."""
    return folder / f".{name}.stop"


def request_stop(folder: Path, name: str) -> None:
    """Request the end of the run of a job after the current increment.

    Raises
    ------
    FileError
        If the folder is not writable.
    """
    path = stop_file(folder, name)
    try:
        path.touch()
    except OSError as error:
        raise full(error, path) from None


class StopRequest:
    """Checks for the request, at most once every :data:`BEAT`.

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
