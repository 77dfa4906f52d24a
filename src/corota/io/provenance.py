"""Provenance of results: program, libraries, deck, by version and digest."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from corota.errors import FileError
from corota.io.atomic_file import replace_text
from corota.io.regular_file import digest, require_regular

#: Libraries that affect the numbers and the files.
LIBRARIES = ("numpy", "scipy", "h5py")


def sha256(path: str | PathLike[str]) -> str:
    """Digest of a file.

    Raises
    ------
    FileError
        If it cannot be read.
    """
    require_regular(path)
    try:
        with open(path, "rb") as file:
            return digest(file)[0]
    except OSError as error:
        raise FileError(f"{path}: cannot read: {error.strerror or error}") from None


def source_of(files: Sequence[str | PathLike[str]]) -> dict[str, Any]:
    """Digests of a deck and of all that was read with it.

    Parameters
    ----------
    files : sequence of path-like
        The deck, then the files that it includes.

    Returns
    -------
    dict
        ``deck``: name of the deck; ``path``: its path; ``sha256``: its digest; ``included``:
        digests of the other files by their paths relative to the deck's folder.

    Raises
    ------
    FileError
        If one cannot be read.
    """
    deck, *others = (Path(file).resolve() for file in files)
    # A checkpoint carries a digest of its own, and may be replaced by the job that reads it.
    others = [file for file in others if ".ckpt" not in file.suffixes]
    included = {os.path.relpath(file, deck.parent): sha256(file) for file in others}
    return {"deck": deck.name, "path": str(deck), "sha256": sha256(deck), "included": included}


def changed_file(source: Mapping[str, Any], deck: str | PathLike[str]) -> str:
    """Name of the first file that is missing or differs from its digest; empty if there is none.

    Parameters
    ----------
    source : mapping
        Of :func:`source_of`.
    deck : path-like
        The deck as it is.
    """
    folder = Path(deck).resolve().parent
    wanted = {str(deck): source["sha256"]}
    wanted |= {str(folder / name): digest for name, digest in source.get("included", {}).items()}
    for name, expected in wanted.items():
        try:
            if sha256(name) != expected:
                return name
        except FileError:
            return name
    return ""


def write_provenance(folder: Path, name: str, files: Sequence[str | PathLike[str]]) -> Path:
    """Write ``NAME.provenance.json`` into a folder; return its path.

    `files` are the deck and what it includes.

    Raises
    ------
    FileError
        If writing fails.
    """
    import platform
    from importlib.metadata import PackageNotFoundError, version

    import corota._core as _core
    from corota._core import __version__

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
        "input": source_of(files),
    }
    path = folder / f"{name}.provenance.json"
    folder.mkdir(parents=True, exist_ok=True)
    replace_text(path, json.dumps(record, indent=2) + "\n")
    return path
