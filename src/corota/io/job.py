"""The files of a job, written in a separate thread during the analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import glob
import os
import time
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.analysis.checkpoint import Checkpoint, model_tree
from corota.analysis.state_tree import Reader, Unstorable, Writer
from corota.errors import FileError, InputError
from corota.io.atomic_file import TextFile, full
from corota.io.events import Events, json_line
from corota.io.file_options import CHECKPOINTS, LEVEL, FileOptions
from corota.io.finite import check_frame
from corota.io.folder_lock import FolderLock
from corota.io.provenance import source_of
from corota.io.requests import Requests
from corota.io.stop_request import StopRequest, stop_file
from corota.io.tables.csv_history import CsvWriter, Histories
from corota.io.tables.sta import CVG_HEAD, STA_HEAD, cvg_line, sta_failed, sta_line
from corota.io.task_queue import TaskQueue
from corota.io.writers import STREAMS, Job, Stream
from corota.lazy import lazy
from corota.names import choose
from corota.results.observer import BaseObserver, Iteration

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from corota.io.checkpoint import Saved
    from corota.model.model import Model
    from corota.model.steps import Output, Step
    from corota.results.results import Frame, Results

# Tables and checkpoints that small jobs do not write.
check_requests = lazy("corota.io.tables.dat:check_requests")
dat_blocks = lazy("corota.io.tables.dat:dat_blocks")
buckling_table = lazy("corota.io.tables.dat_modes:buckling_table")
eigenvalue_tables = lazy("corota.io.tables.dat_modes:eigenvalue_tables")
store = lazy("corota.io.checkpoint:store")

#: Endings of all files of a job.
ENDINGS = (
    *("dat", "sta", "cvg", "jsonl", "csv", "vtkhdf", "pvd", "npz", "vtu"),
    *("last_iterate.vtkhdf", "modes.vtkhdf", "provenance.json", *CHECKPOINTS),
)
#: Seconds between checkpoints, unless other intervals are requested.
CHECKPOINT_SECONDS = 60.0
#: Least time between checkpoints over the cost of one: they take at most a hundredth of a run.
CHECKPOINT_WAIT = 100.0


class JobFiles(BaseObserver):
    """Observer that writes ``<job>.vtkhdf .dat .sta .cvg .csv .jsonl`` into a folder.

    Every accepted increment is on disk within a quarter of a second, in files that are readable
    at every moment: text files are extended by whole pieces, the result file by exchange of
    complete copies.

    Parameters
    ----------
    folder : path-like
        Created if it does not exist; files of an earlier run of the same job are replaced.
    name : str
        Stem of the file names; the model's name by default.
    formats : sequence of {"vtkhdf", "pvd", "frd", "frd-binary"}
    histories : sequence of str
        Extra columns of the CSV file: ``VARIABLE@SET`` or ``VARIABLE@NODE``.
    points : bool
        Store values at the quadrature points in the result file; several times the size.
    single : bool
        Store fields in 4 bytes a number.
    fields : {"all", "requested"} or sequence of str
        Fields of the result file; see :class:`corota.io.file_options.FileOptions`.
    compression : int
        Level of gzip, 0 for none.
    parts : int
        Parts of the grid in the result file: the number of processes of the run.
    profile : dict of str to float, optional
        Seconds of phases before the analysis, such as ``read``.
    checkpoint_every : int
        Increments between checkpoints; 0 for none by count.
    checkpoint_seconds : float
        Least time between checkpoints [s]; 0 for none by time. Where one checkpoint costs more than
        a hundredth of it, a hundred times that cost, so that large models do not wait for them.
    source : dict, optional
        Source of the model, for checkpoints, as :func:`corota.io.provenance.source_of` gives it;
        that of ``model.sources`` by default.
    resume : Saved, optional
        Continue the files of a run from one of its checkpoints.

    Attributes
    ----------
    paths : list of Path
        Files written.
    error : Exception or None
        Why writing stopped.

    Examples
    --------
    >>> import tempfile
    >>> import corota as ct
    >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1), name="beam")
    >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    >>> model.fix("left")
    >>> model.force("right", y=0.01)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = ct.JobFiles(folder)
    ...     results = ct.solve(model, ct.Static(), observers=[files], threads=1)
    ...     sorted(path.name for path in files.paths)
    ['beam.csv', 'beam.cvg', 'beam.jsonl', 'beam.sta', 'beam.vtkhdf']
    """

    def __init__(
        self,
        folder: str | PathLike[str] = ".",
        name: str = "",
        *,
        formats: Sequence[str] = ("vtkhdf",),
        histories: Sequence[str] = (),
        points: bool = False,
        single: bool = False,
        fields: str | Sequence[str] = "all",
        compression: int = LEVEL,
        parts: int = 1,
        profile: dict[str, float] | None = None,
        checkpoint_every: int = 0,
        checkpoint_seconds: float = CHECKPOINT_SECONDS,
        source: dict[str, Any] | None = None,
        resume: Saved | None = None,
    ) -> None:
        self.folder, self.name = Path(folder), name
        self.paths: list[Path] = []
        self._queue = TaskQueue(self._commit)
        self._formats = [choose(form, STREAMS, "result format") for form in formats]
        self._extra = histories
        chosen = fields if isinstance(fields, str) else tuple(fields)
        self._form = FileOptions(points, single, chosen, compression, parts)
        self._profile = profile or {}
        self._last_tried = (0.0, 0)
        self._stored: tuple[Any, list[Any], str] | tuple[()] | None = None
        self._largest = 0.0
        self._reached = (0.0, 0.0)
        self._cuts: dict[tuple[int, int], int] = {}
        self._newest: tuple[Frame, bool] | None = None
        self._closed = True
        self._every, self._seconds = checkpoint_every, checkpoint_seconds
        self._resumed = resume
        self._source = source or {}
        #: Set to request a checkpoint after the next increment, for instance by a signal.
        self.checkpoint_requested = False
        #: The newest checkpoint of this run.
        self.checkpointed: Checkpoint | None = None
        #: Cost of the last checkpoint: copying the state, writing it [s].
        self._cost, self._due = [0.0, 0.0], 0.0
        self._known_cuts: dict[tuple[int, int], int] = {}
        self._held: FolderLock | None = None
        self._end_request: StopRequest | None = None
        self.run = os.urandom(6).hex() if resume is None else resume.run

    @property
    def error(self) -> Exception | None:
        """Why writing stopped."""
        return self._queue.error

    # Called by the analysis.
    def start(self, model: Model, steps: list[Step]) -> None:
        """Open the files.

        Raises
        ------
        FileError
            If the folder or a file cannot be made.
        InputError
            If a print request names an unknown variable.
        """
        self._printed = any(o.kind.endswith("print") for s in steps for o in s.outputs)
        if self._printed:
            check_requests(steps)
        self.model, self.steps = model, steps
        self._requests = Requests(model, steps)
        name = self._checked_name(model)
        self._place = self._source
        if not self._place and model.sources:
            with contextlib.suppress(FileError):
                self._place = source_of(model.sources)
        self._histories = Histories(model, steps, self._extra)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise full(error, self.folder) from None
        if not self._closed:
            raise InputError("these files are being written already; make JobFiles for each run")
        self._newest = None
        self.paths.clear()
        self._held = FolderLock(self.folder / f".{name}.lock")
        self._end_request = StopRequest(stop_file(self.folder, name))
        try:
            self._start(model, steps, name)
        except BaseException:
            self._held.release()
            raise

    def _checked_name(self, model: Model) -> str:
        """Stem of the files: one that stays in the folder and replaces no input.

        Raises
        ------
        InputError
            If it does not.
        """
        name = self.name or model.name
        if name in ("", ".", "..") or "/" in name or os.sep in name or not name.isprintable():
            raise InputError(
                f"the name of a job is the stem of its files, without a folder, not {name!r}; "
                "the folder is given by -o (JobFiles(folder, name))"
            )
        inputs = {os.path.realpath(file) for file in model.sources}
        kept = self.folder.glob(f"{glob.escape(name)}.step-*.ckpt")
        for path in (*(self.folder / f"{name}.{ending}" for ending in ENDINGS), *kept):
            if path.exists() and os.path.realpath(path) in inputs:
                raise InputError(
                    f"{path} is an input of this job and would be replaced by its results: use "
                    "another folder (-o) or name (--name)"
                )
        return name

    def _start(self, model: Model, steps: list[Step], name: str) -> None:
        """Open the files, as new files or at the state of a checkpoint."""
        resumed = self._resumed
        self._last_checkpoint = time.monotonic()
        self._increments, self._step, self._increment = 0, 1, 0
        if resumed is None:
            self._set_aside(name)
        self._text: dict[str, TextFile] = {}
        endings = ["sta", "cvg", "jsonl"]
        if self._printed or any(s.procedure in ("buckle", "frequency") for s in steps):
            endings.insert(0, "dat")
        with contextlib.ExitStack() as opened:  # closed where one of them cannot be continued
            for ending in endings:
                text = TextFile(self._path(name, ending), keep=resumed is not None)
                self._text[ending] = text
                opened.callback(text.close)
            self._csv = CsvWriter(self._path(name, "csv"), model.unit_system)
            opened.callback(self._csv.close)
            if resumed is None:
                self._text["sta"].append(STA_HEAD)
                self._text["cvg"].append(CVG_HEAD)
            else:
                self._take_up(resumed)
            opened.pop_all()
        self._big: list[Stream] = []
        big = [(form, self._path(name, form.partition("-")[0])) for form in self._formats]
        self._closed = False
        self._queue.start()
        self._queue.put(lambda: self._open(big))  # takes as long as solving a small job
        self._events = Events(self._log, self.run)
        if resumed is None:
            self._events.start(model, steps)
        else:
            self._events.resume(model, self._known_cuts)

    def _set_aside(self, name: str) -> None:
        """Set the files of an earlier run aside.

        Its results have another name until this run is done; its checkpoints are removed.
        """
        endings = (*CHECKPOINTS, "last_iterate.vtkhdf", "modes.vtkhdf")
        gone = [f"{name}.{ending}" for ending in endings]
        gone += [path.name for path in self.folder.glob(f"{glob.escape(name)}.step-*.ckpt")]
        try:
            for old in [*gone, f"{name}.dat", f"{name}.csv", f"{name}.frd"]:
                (self.folder / old).unlink(missing_ok=True)
            for ending in ("vtkhdf", "pvd"):
                path = self.folder / f"{name}.{ending}"
                if path.exists():
                    os.replace(path, self._previous(name, ending))
        except OSError as error:
            raise full(error, self.folder / name) from None

    def _previous(self, name: str, ending: str) -> Path:
        return self.folder / f"{name}.previous.{ending}"

    def _take_up(self, saved: Saved) -> None:
        """Truncate the files to the state of the checkpoint, and continue from there."""
        found = saved.files
        for ending, text in self._text.items():
            text.cut(found["text"][ending])
        count, names = found["csv"]
        if count:
            self._csv.resume(count, names)
        self._histories.resume(tuple(found["before"]))
        self._cuts = {(s, i): n for s, i, n in found["cuts"]}
        self._known_cuts = dict(self._cuts)
        self._largest, self._reached = found["largest"], tuple(found["reached"])
        if found["newest"] is not None:
            tree, place = found["newest"]
            self._newest = (Reader(saved.state.arrays[place:], {}).read(tree), found["filed"])
        if found["tried"] is not None:
            self._last_tried = tuple(found["tried"])

    def _open(self, big: list[tuple[str, Path]]) -> None:
        """Create the writers of the result files."""
        for name, path in big:
            job = Job(self.model, self.steps, self._form, self.run, self._state_of(name))
            self._big.append(STREAMS[name](path, job))

    def _state_of(self, ending: str) -> dict[str, Any] | None:
        """Where a checkpoint left a result file; None for a new one."""
        if self._resumed is None:
            return None
        found: dict[str, Any] = self._resumed.files["big"][ending]
        return found

    def _path(self, name: str, ending: str) -> Path:
        path = self.folder / f"{name}.{ending}"
        self.paths.append(path)
        return path

    def step(self, number: int, step: Step) -> None:
        resumed = self._resumed
        if resumed is not None and number == resumed.state.step and not self._increments:
            return  # it is in the files
        self._events.step(number, step)

    @property
    def stop(self) -> bool:
        """Whether a page or another process requested the end of the run after this increment."""
        return self._end_request is not None and self._end_request.requested

    # Checkpoints.
    @property
    def checkpoint_due(self) -> bool:
        """Whether a checkpoint is due after this increment."""
        step = self.steps[self._step - 1]
        every = step.restart or self._every
        by_count = every > 0 and self._increment % every == 0
        wait = max(self._seconds, CHECKPOINT_WAIT * sum(self._cost))
        late = self._seconds > 0.0 and time.monotonic() - self._last_checkpoint >= wait
        due = self.checkpoint_requested or by_count or late
        if due:
            self._due = time.perf_counter()
        return due

    def checkpoint(self, checkpoint: Checkpoint, keep: str = "") -> None:
        """Take the state of the analysis; it is written after all earlier data.

        Parameters
        ----------
        keep : str
            Ending of a file of its own that is not replaced, such as ``step-1.ckpt``.
        """
        self.checkpoint_requested, self._last_checkpoint = False, time.monotonic()
        self._cost[0] = time.perf_counter() - self._due
        self.checkpointed = checkpoint
        known = {
            "cuts": [[*where, n] for where, n in self._cuts.items()],
            "largest": self._largest,
            "reached": list(self._reached),
            "tried": list(self._last_tried),
        }
        size = sum(array.nbytes for array in checkpoint.arrays)
        self._queue.put(lambda: self._checkpoint(checkpoint, known, keep), size)

    def _checkpoint(self, checkpoint: Checkpoint, known: dict[str, Any], keep: str) -> None:
        """Flush the files to the disk, then write the checkpoint that refers to them."""
        begin = time.perf_counter()
        for big in self._big:
            big.commit()
        for text in self._text.values():
            text.sync()
        self._csv.sync()
        for big in self._big:
            big.sync()
        newest = None
        writer = Writer({})
        if self._newest is not None:
            frame, filed = self._newest
            if not filed or self._requests.left_over(frame):
                newest = [writer.write(frame), len(checkpoint.arrays)]
            known["filed"] = filed
        files = known | {
            "text": {ending: text.length for ending, text in self._text.items()},
            "csv": list(self._csv.state),
            "before": list(self._histories.before),
            "big": {e: b.state for e, b in zip(self._formats, self._big, strict=True)},
            "newest": newest,
        }
        checkpoint.arrays = [*checkpoint.arrays, *writer.arrays]
        name = self.name or self.model.name
        if self._stored is None:
            self._stored = self._model_tree()
        store(
            self.folder / f"{name}.{keep or CHECKPOINTS[0]}",
            checkpoint,
            files,
            name,
            self.run,
            self._options(),
            self._stored or None,
        )
        self._cost[1] = time.perf_counter() - begin

    def _model_tree(self) -> tuple[Any, list[Any], str] | tuple[()]:
        try:
            return model_tree(self.model, self.steps)
        except Unstorable:
            return ()

    def _options(self) -> dict[str, Any]:
        return {
            "folder": str(self.folder),
            "formats": self._formats,
            "histories": list(self._extra),
            **asdict(self._form),
            "every": self._every,
            "seconds": self._seconds,
            "source": self._place,
        }

    def iteration(self, info: Iteration) -> None:
        if info.iteration <= 1:
            self._largest = 0.0
        self._largest = max(self._largest, info.correction)
        self._last_tried = (info.dt, info.iteration)
        line = cvg_line(info, self._largest)
        self._queue.put(lambda: self._text["cvg"].append(line))
        self._events.iteration(info)

    def increment(self, frame: Frame) -> None:
        attempts = self._cuts.get((frame.step, frame.increment), 0) + 1
        self._increments += 1 if frame.increment else 0
        self._step, self._increment = frame.step, frame.increment
        self._reached = (frame.time, frame.step_time)
        size = 8 * (frame.U.size * 6 + sum(b.volume.size * 24 for b in frame.fields))
        self._events.increment(frame)
        self._queue.put(lambda: self._write(frame, attempts), size)

    def cut_back(self, step: int, increment: int, attempt: int, reason: str, dt: float) -> None:
        self._cuts[step, increment] = attempt
        tried, count = self._last_tried
        line = sta_failed(step, increment, attempt, count, self._reached, tried)
        self._queue.put(lambda: self._text["sta"].append(line))
        self._events.cut_back(step, increment, attempt, reason, dt)

    def end(self, results: Results, error: Exception | None) -> None:
        """Write pending data and close; raise a write error unless the analysis failed first."""
        if self._closed:
            return
        self._queue.drain()
        if self._queue.error is None:
            self._queue.attempt(self._end_step)
        profile = results.info.setdefault("profile", {})
        for phase, seconds in self._profile.items():
            profile.setdefault(phase, seconds)
        results.info["seconds held by output"] = profile.get("write", 0.0)
        profile["write"] = self._queue.seconds
        self._queue.attempt(lambda: self._events.end(results, error))
        if results.modes and "vtkhdf" in self._formats:
            from corota.io.modes import write_modes

            self._queue.attempt(self._commit)  # modes take longer than they may wait
            path = self._path(self.name or self.model.name, "modes.vtkhdf")
            self._queue.attempt(lambda: write_modes(results, path))
        for big in self._big:
            for modes in results.modes:
                self._queue.attempt(lambda big=big, modes=modes: big.add_modes(modes))  # type: ignore[misc]
        self._iterate(results)
        self.close(results.info, done=error is None)
        if self._queue.error is not None and error is None:
            raise self._queue.error

    def _iterate(self, results: Results) -> None:
        """Write the last iterate; a converged run has no such file."""
        name = f"{self.name or self.model.name}.last_iterate.vtkhdf"
        if results.last_iterate is None or "vtkhdf" not in self._formats:
            (self.folder / name).unlink(missing_ok=True)
            return
        from corota.io.modes import write_iterate

        path = self.folder / name
        self.paths.append(path)
        self._queue.attempt(lambda: write_iterate(results, path))

    def close(self, info: dict[str, Any] | None = None, done: bool = False) -> None:
        """Write pending data and close the files; errors are kept in :attr:`error`.

        After a run that is `done` the results of the one before are removed, and checkpoints that
        were not
        requested.
        """
        if self._closed:
            return
        self._queue.drain()
        self._closed = True
        if self._queue.error is None:
            self._queue.attempt(self._end_step)
        for big in self._big:
            self._queue.attempt(lambda big=big: big.close(info))  # type: ignore[misc]
        for text in self._text.values():
            text.close()
        self._csv.close()
        if done and self._queue.error is None:
            name = self.name or self.model.name
            gone = [self._previous(name, ending) for ending in ("vtkhdf", "pvd")]
            if not self._every and not any(step.restart for step in self.steps):
                gone += [self.folder / f"{name}.{ending}" for ending in CHECKPOINTS]
            for path in gone:
                with contextlib.suppress(OSError):
                    path.unlink(missing_ok=True)
        if self._held is not None:
            self._held.release()
        if self._end_request is not None:
            self._end_request.clear()

    def __enter__(self) -> JobFiles:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    # The writer's side.
    def _log(self, record: dict[str, Any]) -> None:
        self._queue.put(lambda: self._text["jsonl"].append(json_line(record)))

    def _commit(self) -> None:
        """Update the result files."""
        for big in self._big:
            big.commit()

    def _write(self, frame: Frame, attempts: int) -> None:
        check_frame(frame)
        if self._newest is not None and self._newest[0].step != frame.step:
            self._end_step()
        row = self._histories.row(frame, attempts)
        if frame.increment:
            self._text["sta"].append(sta_line(frame, attempts, row["dt"]))
        self._csv.add(row)
        if "dat" in self._text:
            self._text["dat"].append(buckling_table(frame) + eigenvalue_tables(frame))
        self._answer(self._requests.due_now(frame), frame)
        filed = self._requests.wants_file(frame)
        if filed:
            self._file(frame)
        self._newest = (frame, filed)

    def _end_step(self) -> None:
        """The newest frame was the last of its step, so it answers all requests."""
        if self._newest is None:
            return
        frame, filed = self._newest
        self._newest = None
        self._answer(self._requests.left_over(frame), frame)
        if not filed:
            self._file(frame)

    def _answer(self, outputs: list[Output], frame: Frame) -> None:
        text = dat_blocks(self.model, outputs, frame) if "dat" in self._text else ""
        if text:
            self._text["dat"].append(text)

    def _file(self, frame: Frame) -> None:
        for big in self._big:
            big.add(frame)
