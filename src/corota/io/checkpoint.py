"""Checkpoints as files: one HDF5 file each, checked before use; the last two are kept.

A file begins with a block of text that HDF5 readers skip: the name of the format, and length and
SHA-256 of all that follows. No data are interpreted before these agree. It is written
under another name, flushed to the disk and renamed, so that no name ever stands for half a file.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import json
import os
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.checkpoint import Checkpoint
from corota.analysis.state_tree import Reader, UnsuitableState
from corota.errors import FileError
from corota.io.atomic_file import replaced
from corota.io.file_options import CHECKPOINTS
from corota.io.regular_file import digest, parse_json, require_regular

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.model import Model
    from corota.model.steps import Step

#: First line of a file; the number is that of the format.
MAGIC = "corota checkpoint 2\n"
#: Bytes of the block before the HDF5 part.
HEAD = 512


@dataclass
class Saved:
    """Contents of a checkpoint file.

    Parameters
    ----------
    files : dict
        State of the files of the run, see :class:`corota.io.job.JobFiles`.
    job : str
        Stem of the file names.
    run : str
        Name of the run that wrote it.
    model : tuple or None
        Tree, arrays and digest of the model and its steps.
    """

    path: Path
    state: Checkpoint
    files: dict[str, Any]
    job: str
    run: str
    options: dict[str, Any]
    model: tuple[Any, list[Any], str] | None


def rebuilt(saved: Saved) -> tuple[Model, list[Step]]:
    """The model of a checkpoint and its steps.

    Raises
    ------
    FileError
        If it holds functions and is not stored for that reason.
    """
    if saved.model is None:
        raise FileError(
            f"{saved.path}: the model holds Python functions, which are not stored; give it again: "
            "corota.resume(path, model=...)"
        )
    tree, arrays, _ = saved.model
    try:
        found = Reader(arrays, {}).read(tree)
        return found["model"], found["steps"]
    except (UnsuitableState, LookupError, TypeError) as error:
        raise FileError(f"{saved.path}: not a checkpoint of this program: {error}") from None


def store(
    path: Path,
    state: Checkpoint,
    files: dict[str, Any],
    job: str,
    run: str,
    options: dict[str, Any],
    model: tuple[Any, list[Any], str] | None,
) -> None:
    """Write a checkpoint under `path`; the one that is there moves to ``path.1``.

    Raises
    ------
    FileError
        If writing fails; existing checkpoints remain.
    """
    import h5py

    from corota._core import __version__

    head = {
        f.name: getattr(state, f.name) for f in fields(state) if f.name not in ("tree", "arrays")
    }
    with replaced(path) as hidden:
        with h5py.File(hidden, "w", userblock_size=HEAD) as file:
            file.attrs["program"] = __version__
            file.attrs["job"], file.attrs["run"] = job, run
            file.attrs["head"] = json.dumps(head)
            file.attrs["options"] = json.dumps(options)
            _put(file, "files", json.dumps(files))
            _tree(file.create_group("state"), state.tree, state.arrays)
            if model is not None:
                own = file.create_group("model")
                own.attrs["digest"] = model[2]
                _tree(own, model[0], model[1])
        with open(hidden, "r+b") as raw:
            raw.seek(HEAD)
            text = _head(*digest(raw))
            raw.seek(0)
            raw.write(text)
            raw.flush()
            os.fsync(raw.fileno())
        older = path.with_name(f"{path.name}.1")
        if path.exists():
            os.replace(path, older)
    sync_folder(path.parent)


def _head(sha256: str, size: int) -> bytes:
    """First block of a file."""
    return f"{MAGIC}sha256 {sha256}\nbytes {size}\n".encode().ljust(HEAD, b"\0")


def sync_folder(folder: Path) -> None:
    """Flush the names in a folder to the disk, where the system supports it."""
    with contextlib.suppress(OSError, AttributeError):
        number = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


def _put(group: Any, name: str, text: str) -> None:
    group[name] = np.frombuffer(text.encode() or b" ", np.uint8)


def _tree(group: Any, tree: Any, arrays: Sequence[Any]) -> None:
    """Store a tree: its text, and its arrays one after the other by type."""
    places = []
    flat: dict[str, list[Any]] = {}
    ends: dict[str, int] = {}
    for array in arrays:
        kind = array.dtype.str
        start = ends.get(kind, 0)
        places.append([kind, list(array.shape), start])
        flat.setdefault(kind, []).append(np.ascontiguousarray(array).reshape(-1))
        ends[kind] = start + array.size
    _put(group, "tree", json.dumps(tree, separators=(",", ":")))
    _put(group, "places", json.dumps(places))
    for kind, parts in flat.items():
        whole = np.concatenate(parts)
        group[f"numbers {kind.strip('<>|=')}"] = whole.view(np.uint8) if kind[1] in "US" else whole


def _untree(group: Any) -> tuple[Any, list[Any]]:
    tree = parse_json(bytes(group["tree"][()]))
    whole: dict[str, Any] = {}
    arrays = []
    for kind, shape, start in parse_json(bytes(group["places"][()])):
        if kind not in whole:
            whole[kind] = group[f"numbers {kind.strip('<>|=')}"][()].view(np.dtype(kind))
        size = int(np.prod(shape, dtype=int))
        # Separate copies: a change in place must not affect another array.
        arrays.append(whole[kind][start : start + size].reshape(shape).copy())
    return tree, arrays


def load(path: Path) -> Saved:
    """Read one checkpoint file.

    Raises
    ------
    FileError
        With the reason, if it is missing, damaged, foreign or of another version.
    """
    import h5py

    from corota._core import __version__

    require_regular(path)
    try:
        with open(path, "rb") as raw:
            head = raw.read(HEAD)
            _check_head(path, head, raw)
    except OSError as error:
        raise FileError(f"{path}: cannot read: {error.strerror or error}") from None
    try:
        with h5py.File(path, "r") as file:
            program = str(file.attrs["program"])
            if program != __version__:
                raise FileError(
                    f"{path}: written by version {program}; this is {__version__}, which may round "
                    "differently: continue with that version"
                )
            own = parse_json(str(file.attrs["head"]))
            tree, arrays = _untree(file["state"])
            model = None
            if "model" in file:
                model = (*_untree(file["model"]), str(file["model"].attrs["digest"]))
            return Saved(
                path,
                Checkpoint(**own, tree=tree, arrays=arrays),
                parse_json(bytes(file["files"][()])),
                str(file.attrs["job"]),
                str(file.attrs["run"]),
                parse_json(str(file.attrs["options"])),
                model,
            )
    except (OSError, KeyError, ValueError, TypeError) as error:
        raise FileError(f"{path}: not a checkpoint of this program: {error}") from None


def _check_head(path: Path, head: bytes, raw: Any) -> None:
    """Compare length and digest of a file with what its head says."""
    if not head.startswith(MAGIC.split()[0].encode()):
        raise FileError(f"{path}: not a checkpoint")
    lines = head.rstrip(b"\0").decode("ascii", "replace").splitlines()
    if lines[0] + "\n" != MAGIC:
        raise FileError(f"{path}: a checkpoint of another format ({lines[0][:40]!r})")
    try:
        wanted = lines[1].removeprefix("sha256 ")
        length = int(lines[2].removeprefix("bytes "))
        whole = head == _head(wanted, length)
    except (IndexError, ValueError):
        whole = False
    if not whole:
        raise FileError(f"{path}: damaged: its first block is not readable")
    found, size = digest(raw)
    if size != length:
        raise FileError(f"{path}: damaged: {size} bytes of {length}")
    if found != wanted:
        raise FileError(f"{path}: damaged: its checksum is wrong")


def candidates(path: Path) -> list[Path]:
    """The checkpoint files for a path, the newest first.

    Parameters
    ----------
    path : Path
        A checkpoint, a deck, another file of the job, or its stem.
    """
    if path.name.endswith(CHECKPOINTS):
        stem = path.name.removesuffix(".1").removesuffix(".ckpt")
        listed = [path, *(path.with_name(f"{stem}.{ending}") for ending in CHECKPOINTS)]
    else:
        stem = path.name if not path.suffix else path.stem
        listed = [
            path.with_name(f"{s}.{e}")
            for s in dict.fromkeys((stem, path.name))
            for e in CHECKPOINTS
        ]
    return [p for p in dict.fromkeys(listed) if p.exists()]


def newest(path: Path) -> tuple[Saved, list[str]]:
    """The newest intact checkpoint, and the reasons why others were refused.

    Raises
    ------
    FileError
        If there is none.
    """
    refused: list[str] = []
    found = candidates(path)
    for each in found:
        try:
            return load(each), refused
        except FileError as error:
            refused.append(str(error))
    if not found:
        raise FileError(f"{path}: there is no checkpoint (JOB.ckpt) of this job; run it again")
    raise FileError("no checkpoint can be used; " + "; ".join(refused))
