"""Provenance of results: program, libraries, deck, by version and digest."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from corota.errors import FileError
from corota.io.atomic_file import replace_text

if TYPE_CHECKING:
    from collections.abc import Callable
    from os import PathLike

#: Bytes of a deck that is kept.
SMALL = 1 << 18
#: Libraries that affect the numbers and the files.
LIBRARIES = ("numpy", "scipy", "h5py")


def sha256(path: str | PathLike[str]) -> str:
    """Digest of a file.

    Raises
    ------
    FileError
        If it cannot be read.
    """
    import hashlib

    try:
        found = hashlib.sha256()
        with open(path, "rb") as file:
            while block := file.read(1 << 20):
                found.update(block)
        return found.hexdigest()
    except OSError as error:
        raise FileError(f"{path}: cannot read: {error.strerror or error}") from None


def source_of(deck: str | PathLike[str]) -> dict[str, str]:
    """Name and digest of a deck."""
    return {"deck": Path(deck).name, "sha256": sha256(deck)}


def place_of(deck: str | PathLike[str]) -> dict[str, str]:
    """Name, digest and path of a deck, for later jobs."""
    return source_of(deck) | {"path": str(Path(deck).resolve())}


def place_later(deck: str | PathLike[str]) -> Callable[[], dict[str, str]]:
    """Give :func:`place_of` of a deck as it is now, when it is called.

    A small deck is kept until then: loading the functions for digests takes longer than reading it.

    Raises
    ------
    FileError
        If it cannot be read.
    """
    path = Path(deck)
    try:
        data = path.read_bytes() if path.stat().st_size <= SMALL else b""
    except OSError as error:
        raise FileError(f"{path}: cannot read: {error.strerror or error}") from None
    if not data:
        found = place_of(deck)
        return lambda: found
    whole = str(path.resolve())

    def place() -> dict[str, str]:
        import hashlib

        return {"deck": path.name, "sha256": hashlib.sha256(data).hexdigest(), "path": whole}

    return place


def write_provenance(folder: Path, name: str, deck: str | PathLike[str]) -> Path:
    """Write ``NAME.provenance.json`` into a folder; return its path.

    Raises
    ------
    FileError
        If writing fails.
    """
    import platform
    from importlib.metadata import PackageNotFoundError, version

    from corota import __version__, _core

    libraries = {}
    for library in LIBRARIES:
        try:
            libraries[library] = version(library)
        except PackageNotFoundError:
            continue
    record = {
        "program": "corota",
        "version": __version__,
        "core sha256": sha256(str(_core.__file__)),
        "python": platform.python_version(),
        "system": f"{sys.platform} {platform.machine()}",
        "libraries": libraries,
        "input": source_of(deck),
    }
    path = folder / f"{name}.provenance.json"
    folder.mkdir(parents=True, exist_ok=True)
    replace_text(path, json.dumps(record, indent=2) + "\n")
    return path


__all__ = ["place_later", "place_of", "sha256", "source_of", "write_provenance"]
