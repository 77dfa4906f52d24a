"""Regular files only: a received folder may hold links, pipes and devices under any name."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import errno
import json
import os
import stat
from os import PathLike
from typing import IO, Any

from corota.errors import FileError

#: Flags that some systems do not have.
_NO_LINK = getattr(os, "O_NOFOLLOW", 0)
_NO_WAIT = getattr(os, "O_NONBLOCK", 0)
_BINARY = getattr(os, "O_BINARY", 0)


def open_to_write(path: str | PathLike[str], flags: int) -> int:
    """Open a regular file for writing, without following a link.

    Parameters
    ----------
    flags : int
        Of :func:`os.open`; the file is created if it is missing.

    Returns
    -------
    int
        File descriptor.

    Raises
    ------
    OSError
        As :func:`os.open`; for a link, a folder, a pipe or a device with a reason that names it.
    """
    if os.path.islink(path):
        raise OSError(errno.ELOOP, "it is a link; remove it, or use another folder or name")
    flags |= os.O_CREAT | os.O_CLOEXEC | _NO_LINK | _NO_WAIT | _BINARY
    file = os.open(path, flags & ~os.O_TRUNC, 0o644)
    try:
        if not stat.S_ISREG(os.fstat(file).st_mode):
            raise OSError(errno.EINVAL, "it is not a regular file")
        if flags & os.O_TRUNC:
            os.ftruncate(file, 0)
    except BaseException:
        os.close(file)
        raise
    return file


def require_regular(path: str | PathLike[str]) -> None:
    """Refuse what is not a regular file, such as a pipe, from which a reader would wait for ever.

    Raises
    ------
    FileError
        If it is missing, a folder, a pipe or a device.
    """
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise FileError(f"{path}: cannot read: {reason}") from None
    if stat.S_ISDIR(mode):
        raise FileError(f"{path}: cannot read: it is a folder")
    if not stat.S_ISREG(mode):
        raise FileError(f"{path}: cannot read: it is not a regular file")


def read_bytes(path: str | PathLike[str]) -> bytes:
    """Contents of a regular file.

    Raises
    ------
    FileError
        If it cannot be read or is not a regular file.
    """
    require_regular(path)
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise FileError(f"{path}: cannot read: {error.strerror or error}") from None


def digest(file: IO[bytes]) -> tuple[str, int]:
    """SHA-256 of the rest of an open file, and its number of bytes."""
    import hashlib

    found, size = hashlib.sha256(), 0
    while block := file.read(1 << 22):
        found.update(block)
        size += len(block)
    return found.hexdigest(), size


def parse_json(text: str | bytes) -> Any:
    """Value of a text of JSON, as :func:`json.loads`.

    Raises
    ------
    ValueError
        If it is not JSON, or nested too deeply to be read.
    """
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("nested too deeply") from None
