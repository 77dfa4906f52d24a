"""Table of result formats: one entry each, found by the ending of the file name."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import inspect
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from corota.errors import InputError
from corota.lazy import lazy

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from os import PathLike

    from corota.io.file_options import FileOptions
    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.model.paths import Modes
    from corota.model.steps import Step
    from corota.results.results import Frame, Results


def _vtkhdf(results: Results, path: Path, **options: Any) -> None:
    from corota.io.file_options import from_keywords
    from corota.io.vtk.vtkhdf import VtkhdfWriter

    if results.model.sections:
        options.setdefault("parts", results.info.get("processes", 1))
    writer = VtkhdfWriter(
        path,
        results.model,
        from_keywords(options),
        sections=results.sections(),
        steps=results.steps,
    )
    for frame in results.frames:
        writer.add(frame)
    writer.close(results.info)


def _vtu(results: Results, path: Path) -> None:
    from corota.io.vtk.vtu import write_vtu

    write_vtu(results, path)


def _pvd(results: Results, path: Path) -> None:
    from corota.io.vtk.vtu import write_pvd

    write_pvd(results, path)


def _npz(results: Results, path: Path) -> None:
    from corota.io.npz import write_npz

    write_npz(results, path)


def _frd(results: Results, path: Path, binary: bool = False, **options: Any) -> None:
    from corota.io.frd.writer import write_frd

    write_frd(results, path, binary, **options)


def _csv(results: Results, path: Path) -> None:
    from corota.io.atomic_file import replace_text
    from corota.io.tables.csv_history import Histories, csv_text

    histories = Histories(results.model, results.model.steps)
    rows = [histories.row(f) for f in results.frames]
    replace_text(path, csv_text(rows, results.model.unit_system))


def _dat(results: Results, path: Path) -> None:
    from corota.io.atomic_file import replace_text
    from corota.io.requests import Requests, last_of_steps
    from corota.io.tables.dat import check_requests, dat_blocks

    model = results.model
    check_requests(model.steps)
    requests, text = Requests(model, model.steps), []
    for frame, last in zip(results.frames, last_of_steps(results.frames), strict=True):
        requested = requests.due_now(frame)
        requested += requests.left_over(frame) if last else []
        text.append(dat_blocks(model, requested, frame))
    replace_text(path, "".join(text))


def _sta(results: Results, path: Path) -> None:
    from corota.io.atomic_file import replace_text
    from corota.io.tables.sta import STA_HEAD, sta_line

    lines, before = [STA_HEAD], (0, 0.0)
    for frame in results.frames:
        dt = frame.step_time - (before[1] if frame.step == before[0] else 0.0)
        before = (frame.step, frame.step_time)
        if frame.increment:
            lines.append(sta_line(frame, int(frame.scalars.get("attempts", 1)), dt))
    replace_text(path, "".join(lines))


#: Ending of the file name to its writer.
WRITERS: dict[str, Callable[..., None]] = {
    ".vtkhdf": _vtkhdf,
    ".hdf": _vtkhdf,
    ".pvd": _pvd,
    ".vtu": _vtu,
    ".frd": _frd,
    ".npz": _npz,
    ".csv": _csv,
    ".dat": _dat,
    ".sta": _sta,
}


class Stream(Protocol):
    """Writes a result file increment by increment during the analysis."""

    @property
    def state(self) -> dict[str, Any]: ...
    def add(self, frame: Frame) -> None: ...
    def add_modes(self, modes: Modes) -> None: ...
    def commit(self) -> None: ...
    def sync(self) -> None: ...
    def close(self, info: dict[str, Any] | None = None) -> None: ...


@dataclass(frozen=True)
class Job:
    """Data of a stream: model, steps, file options, state at a checkpoint."""

    model: Model
    steps: Sequence[Step]
    options: FileOptions
    run: str = ""
    resume: dict[str, Any] | None = None


def _stream_vtkhdf(path: Path, job: Job) -> Stream:
    from corota.io.vtk.vtkhdf import VtkhdfWriter

    return VtkhdfWriter(path, job.model, job.options, job.run, job.resume, steps=job.steps)


def _stream_pvd(path: Path, job: Job) -> Stream:
    from corota.io.vtk.vtu import PvdWriter

    return PvdWriter(path, job.model, job.resume)


def _stream_frd(path: Path, job: Job, binary: bool = False) -> Stream:
    from corota.io.frd.writer import FrdWriter

    return FrdWriter(path, job.model, job.steps, job.options, binary, job.resume)


#: Writer by format; a name is the file extension and, after a dash, a kind.
STREAMS: dict[str, Callable[[Path, Job], Stream]] = {
    "vtkhdf": _stream_vtkhdf,
    "pvd": _stream_pvd,
    "frd": _stream_frd,
    "frd-binary": partial(_stream_frd, binary=True),
}
#: Ending of the file name to the writer of meshes.
MESH_WRITERS: dict[str, Callable[[Mesh, Path], None]] = {
    ".inp": lazy("corota.io.deck.write.mesh:write_deck_mesh")
}


def write_mesh(mesh: Mesh, path: str | PathLike[str]) -> Path:
    """Write a mesh with its sets in the format of the file extension; return the path.

    Raises
    ------
    InputError
        If the ending is unknown.
    FileError
        If the file cannot be written.
    """
    target = Path(path)
    writer = MESH_WRITERS.get(target.suffix.lower())
    if writer is None:
        known = ", ".join(MESH_WRITERS)
        raise InputError(f"{target}: unknown mesh format {target.suffix!r}; use one of {known}")
    writer(mesh, target)
    return target


def write(results: Results, path: str | PathLike[str], **options: Any) -> Path:
    """Write results in the format of the file extension; return the path.

    Parameters
    ----------
    **options
        Of the format's writer.

    Raises
    ------
    InputError
        If the ending or an option is unknown or there is nothing to write.
    FileError
        If the file cannot be written.
    """
    target = Path(path)
    writer = WRITERS.get(target.suffix.lower())
    if writer is None:
        raise InputError(
            f"{target}: unknown result format {target.suffix!r}; use one of {', '.join(WRITERS)}"
        )
    if not results.frames:
        raise InputError(f"{target}: there are no frames to write")
    known = inspect.signature(writer).parameters
    if options and not any(p.kind is p.VAR_KEYWORD or name in options for name, p in known.items()):
        raise InputError(f"{target}: {target.suffix} has no options; remove {', '.join(options)}")
    writer(results, target, **options)
    return target
