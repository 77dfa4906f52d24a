"""Rows of a sweep on disk: one line of JSON each, with a checksum and a digest of their input."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import hashlib
import inspect
import json
import os
from dataclasses import asdict
from typing import IO, TYPE_CHECKING, Any

from corota.errors import FileError
from corota.io.atomic_file import replace_text
from corota.io.regular_file import open_to_write, parse_json, read_bytes
from corota.sweeps.measures import Measure
from corota.sweeps.variant import DeckBuild, Job, Outcome

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path


class Store:
    """Stores outcomes in a file, if there is one.

    A row is identified by its parameters and by its sweep: the measures, and the text of the build
    function or of the deck with all it includes. Rows of other sweeps are left alone. A change
    elsewhere, as in a function that the build function calls, is not detected. Each line has the
    name of its sweep and a checksum: a line that was edited, or put together from others, is
    refused.

    Raises
    ------
    FileError
        If the file cannot be read or written, is another one, or has a row that was changed.
    """

    def __init__(self, path: Path | None, job: Job) -> None:
        self.path = path
        self._known: dict[str, Outcome] = {}
        self._file: IO[str] | None = None
        if path is None:
            return
        self._job = digest(job)
        try:
            text = read_bytes(path).decode("utf-8") if path.exists() else ""
        except UnicodeDecodeError as error:
            raise FileError(f"{path}: cannot be read as the store of a sweep: {error}") from None
        # A line without an end was being written when the sweep was stopped.
        self._whole = text[: text.rfind("\n") + 1]
        for number, line in enumerate(self._whole.splitlines(), 1):
            try:
                found = parse_json(line)
                outcome = Outcome(**found["outcome"])
                intact = found.pop("checksum") == checksum(found)
                if found["run"] == self._job:
                    self._known[found["digest"]] = outcome
            except (ValueError, KeyError, TypeError):
                raise FileError(
                    f"{path}:{number}: not a row of a sweep; name another file"
                ) from None
            if not intact:
                raise FileError(
                    f"{path}:{number}: this row has changed since it was written; remove the line, "
                    "and the sweep will run it again"
                )
        self._cut = len(self._whole) < len(text)

    def find(self, row: Mapping[str, Any]) -> Outcome | None:
        """Outcome of a successful row."""
        if self.path is None:
            return None
        known = self._known.get(self._digest(row))
        return None if known is None or known.error else known

    def add(self, row: Mapping[str, Any], outcome: Outcome) -> None:
        """Write a row."""
        if self.path is None or self._file is None:
            return
        line = {"digest": self._digest(row), "run": self._job, "row": row}
        line |= {"outcome": asdict(outcome)}
        # As it will be read: numbers of NumPy and other objects are text there.
        line = json.loads(json.dumps(line, default=repr))
        line["checksum"] = checksum(line)
        try:
            self._file.write(json.dumps(line) + "\n")
            self._file.flush()
        except OSError as error:
            raise FileError(f"{self.path}: {error.strerror}") from None

    def __enter__(self) -> Store:
        if self.path is not None:
            try:
                if self._cut:
                    replace_text(self.path, self._whole)
                file = open_to_write(self.path, os.O_WRONLY | os.O_APPEND)
                self._file = open(file, "a", encoding="utf-8")
            except OSError as error:
                raise FileError(f"{self.path}: {error.strerror}") from None
        return self

    def __exit__(self, *raised: object) -> None:
        if self._file is not None:
            self._file.close()

    def _digest(self, row: Mapping[str, Any]) -> str:
        text = json.dumps(row, sort_keys=True, default=repr)
        return hashlib.sha256(f"{self._job}\n{text}".encode()).hexdigest()[:32]


def checksum(line: Mapping[str, Any]) -> str:
    """Checksum of the contents of a row."""
    return hashlib.sha256(json.dumps(line, sort_keys=True).encode()).hexdigest()[:32]


def digest(job: Job) -> str:
    """Digest of the common data of all rows."""
    from corota._core import __version__

    parts = [__version__]
    if isinstance(job.build, DeckBuild):
        from corota.io.provenance import source_of

        files = source_of(job.build.files())
        parts += [files["sha256"], repr(files["included"]), repr(dict(job.build.options))]
    else:
        parts.append(text_of(job.build))
    for name, measure in job.measures.items():
        parts += [name, measure.text if isinstance(measure, Measure) else text_of(measure)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def text_of(function: Any) -> str:
    """Source of a function, or its name where there is none."""
    try:
        return inspect.getsource(function)
    except (OSError, TypeError):
        return (
            f"{getattr(function, '__module__', '')}.{getattr(function, '__qualname__', function)}"
        )
