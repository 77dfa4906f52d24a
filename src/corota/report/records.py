"""History of a job from its files: rows of increments, iterations, cut-backs, notes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import FileError
from corota.io.regular_file import parse_json
from corota.results.scalars import where_missing

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from corota.arrays import Floats
    from corota.results.results import Results


#: Endings of the files of a job, longest first.
ENDINGS = (
    ".last_iterate.vtkhdf", ".modes.vtkhdf", ".provenance.json", ".previous.vtkhdf", ".ckpt.1",
    ".vtkhdf", ".jsonl", ".ckpt", ".html", ".json", ".csv", ".sta", ".cvg", ".dat", ".inp", ".pvd",
)  # fmt: skip
#: Columns of the iterations.
ITERATION = (
    "step", "increment", "attempt", "iteration", "residual", "moment residual", "correction",
    "worst node", "worst dof",
)  # fmt: skip


@dataclass(frozen=True)
class JobPaths:
    """Folder and name of a job."""

    folder: Path
    name: str

    def path(self, ending: str) -> Path:
        """File with an ending, whether it exists or not."""
        return self.folder / f"{self.name}.{ending}"

    @property
    def results(self) -> Path | None:
        """The result file; that of the previous run until a run has written one."""
        for ending in ("vtkhdf", "hdf"):
            if self.path(ending).is_file():
                return self.path(ending)
        return None


def find_job(job: str | PathLike[str], folder: str | PathLike[str] | None = None) -> JobPaths:
    """Find the files of a job by its stem, its deck or any of its files.

    Parameters
    ----------
    folder : path-like, optional
        Where the files are; beside `job`, or the current folder by default.

    Raises
    ------
    FileError
        If there is neither a result file nor a log.
    """
    given = Path(job)
    name = given.name
    for ending in ENDINGS:
        if name.lower().endswith(ending) and len(name) > len(ending):
            name = name[: -len(ending)]
            break
    # The files of a deck elsewhere are in the current folder by default (-o).
    places = [given.parent, Path()] if folder is None else [Path(folder)]
    for place in places:
        found = JobPaths(place, name)
        if found.results is not None or found.path("jsonl").is_file():
            return found
    raise FileError(
        f"{places[0] / name}: no files of such a job ({name}.vtkhdf or {name}.jsonl); "
        "corota run writes them, give their folder with the name"
    )


@dataclass
class Records:
    """The history of a run.

    Parameters
    ----------
    names : list of str
        Headings of the rows, without units.
    rows : list of list of float
        One for each increment, in the order of `names`.
    iterations : list of tuple
        In the order of :data:`ITERATION`.
    cut_backs : list of dict
        ``step, increment, attempt, reason, dt``, and ``after``: number of iterations before.
    units : dict of str to str
        Units of the headings that have one.
    start, end : dict
        Records of the start and the end; the end is empty while the run is in progress.
    """

    names: list[str] = field(default_factory=list)
    rows: list[list[float]] = field(default_factory=list)
    iterations: list[tuple[float, ...]] = field(default_factory=list)
    cut_backs: list[dict[str, Any]] = field(default_factory=list)
    steps: list[dict[str, Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    start: dict[str, Any] = field(default_factory=dict)
    end: dict[str, Any] = field(default_factory=dict)
    increments: list[dict[str, Any]] = field(default_factory=list)
    units: dict[str, str] = field(default_factory=dict)

    def take(self, record: dict[str, Any]) -> None:
        """Add a record of the log."""
        kind = record.get("event")
        if kind == "iteration":
            self.iterations.append(tuple(_number(record.get(name)) for name in ITERATION))
        elif kind == "increment":
            self.increments.append({k: v for k, v in record.items() if k != "event"})
            self.end = {}  # a resumed run
        elif kind == "cut back":
            self.cut_backs.append({**record, "after": len(self.iterations)})
        elif kind == "step":
            self.steps.append(record)
        elif kind == "note":
            self._note(f"step {record.get('step')}: {record.get('note')}")
        elif kind == "start":
            self.start = record
            for note in record.get("notes", ()):
                self._note(str(note))
        elif kind == "end":
            self.end = record
            for note in record.get("notes", ()):
                self._note(str(note))

    def _note(self, text: str) -> None:
        # The notes of the end repeat those of the steps, without the number of the step.
        if not any(known == text or known.endswith(f": {text}") for known in self.notes):
            self.notes.append(text)

    def rows_of_increments(self) -> None:
        """Make the rows of the log's increments, where there is no table."""
        self.names = list(dict.fromkeys(k for record in self.increments for k in record))
        self.rows = [
            [_number(r.get(name, where_missing(name))) for name in self.names]
            for r in self.increments
        ]

    def table(self) -> Floats:
        """Rows as an array, shape (n, number of names)."""
        return np.array(self.rows, dtype=np.float64).reshape(len(self.rows), len(self.names))


def without_units(headings: Sequence[str]) -> tuple[list[str], dict[str, str]]:
    """Names of columns, and the units of those that have one.

    Examples
    --------
    >>> without_units(["time [s]", "load factor"])
    (['time', 'load factor'], {'time': 's'})
    """
    parts = [re.fullmatch(r"(.+?)(?: \[([^][]+)\])?", text) for text in headings]
    names = [found[1] if found else "" for found in parts]
    return names, {found[1]: found[2] for found in parts if found and found[2]}


def _number(value: Any) -> float:
    return float(value) if isinstance(value, int | float) else float("nan")


class Tail:
    """New lines of a growing text file; a replaced or shortened file is read from its start."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._at, self._file = 0, (0, 0)
        #: Whether the last lines are the first ones of a new file.
        self.restarted = True

    def lines(self) -> list[str]:
        """Lines since the last call."""
        try:
            found = self.path.stat()
            self.restarted = (found.st_dev, found.st_ino) != self._file or found.st_size < self._at
            if self.restarted:
                self._at, self._file = 0, (found.st_dev, found.st_ino)
            with open(self.path, "rb") as file:
                file.seek(self._at)
                data = file.read()
        except OSError:
            return []
        whole = data[: data.rfind(b"\n") + 1]
        self._at += len(whole)
        return whole.decode("utf-8", "replace").splitlines()


class JobRecords:
    """Records of a job, brought up to date by :meth:`update`."""

    def __init__(self, job: JobPaths) -> None:
        self.job, self.records = job, Records()
        self._log, self._table = Tail(job.path("jsonl")), Tail(job.path("csv"))

    def update(self) -> Records:
        """Read new data since the last call."""
        lines = self._log.lines()
        if lines and self._log.restarted:
            table = self.records.names, self.records.rows
            self.records = Records()
            self.records.names, self.records.rows = table
        for line in lines:
            try:
                record = parse_json(line)
            except ValueError:
                continue  # a line that the end of a process cut
            if isinstance(record, dict):
                self.records.take(record)
        rows = self._table.lines()
        if rows and self._table.restarted:
            self.records.names, self.records.units = without_units(next(csv.reader(rows[:1])))
            self.records.rows = []
            rows = rows[1:]
        width = len(self.records.names)
        for line in rows:
            values = [_float(text) for text in line.split(",")]
            if len(values) == width:
                self.records.rows.append(values)
        if not self.records.rows and self.records.increments:
            self.records.rows_of_increments()
        return self.records


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")


def records_of_files(job: JobPaths) -> Records:
    """Records of the files of a job."""
    return JobRecords(job).update()


def records_of_results(results: Results) -> Records:
    """Records of results in memory, which keep no iterations."""
    from corota.io.tables.csv_history import Histories

    found = Records(notes=[*results.model.notes, *results.notes])
    histories = Histories(results.model, results.steps or results.model.steps)
    rows = [histories.row(f, int(f.scalars.get("attempts", 1))) for f in results.frames]
    found.names = list(dict.fromkeys(name for row in rows for name in row))
    found.rows = [
        [float(row.get(name, where_missing(name))) for name in found.names] for row in rows
    ]
    found.start = {"version": _version(), "job": results.model.name}
    failed = results.last_iterate is not None
    found.end = {
        "status": "failed" if failed else "done",
        "profile": results.info.get("profile", {}),
    }
    return found


def _version() -> str:
    from corota._core import __version__

    return __version__
