"""The files of a job, written beside the analysis in a thread of their own."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import threading
import time
from collections import deque
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.io.atomic_file import TextFile, full
from corota.io.events import Events, json_line
from corota.io.finite import check_frame
from corota.io.requests import due_now, left_over, wants_file
from corota.io.tables.csv_history import CsvWriter, Histories
from corota.io.tables.dat import check_requests, dat_blocks
from corota.io.tables.dat_modes import buckling_table, eigenvalue_tables
from corota.io.tables.sta import CVG_HEAD, STA_HEAD, cvg_line, sta_failed, sta_line
from corota.results.observer import BaseObserver

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from os import PathLike
    from types import TracebackType

    from corota.io.vtk.vtkhdf import VtkhdfWriter
    from corota.io.vtk.vtu import PvdWriter
    from corota.model.model import Model
    from corota.model.steps import Output, Step
    from corota.results.observer import Iteration
    from corota.results.results import Frame, Results

#: Files are brought up to date at most so often; a killed run loses no more than this [s].
BEAT = 0.25
#: Work waiting for the writer, above which the analysis waits for it.
MOST_WAITING = 256 << 20


class JobFiles(BaseObserver):
    """Observer that writes ``<job>.vtkhdf .dat .sta .cvg .csv .jsonl`` into a folder.

    Every accepted increment is on disk within :data:`BEAT` seconds, in files that are readable
    at every moment: text grows by whole pieces, the result file by exchange of complete copies.

    Parameters
    ----------
    folder : path-like
        Made if it does not exist; files of an earlier run of the same job are replaced.
    name : str
        Stem of the file names; the model's name by default.
    formats : sequence of {"vtkhdf", "pvd"}
    histories : sequence of str
        Extra columns of the CSV file: ``VARIABLE@SET`` or ``VARIABLE@NODE``.
    points : bool
        Store values at the quadrature points in the result file.
    profile : dict of str to float, optional
        Seconds of phases before the analysis, such as ``read``.

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
        points: bool = True,
        profile: dict[str, float] | None = None,
    ) -> None:
        self.folder, self.name = Path(folder), name
        self.paths: list[Path] = []
        self.error: Exception | None = None
        self.seconds = 0.0
        self._formats, self._extra, self._points = formats, histories, points
        self._profile = profile or {}
        self._tasks: deque[tuple[Callable[[], None], int]] = deque()
        self._waiting = 0
        self._wake, self._free = threading.Event(), threading.Condition()
        self._stop = False
        self._thread: threading.Thread | None = None
        self._busy_until = 0.0
        self._last_iteration: Iteration | None = None
        self._largest = 0.0
        self._reached = (0.0, 0.0)
        self._cuts: dict[tuple[int, int], int] = {}
        self._newest: tuple[Frame, bool] | None = None
        self._closed = True

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
        check_requests(steps)
        self.model, self.steps = model, steps
        name = self.name or model.name
        self._histories = Histories(model, steps, self._extra)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise full(error, self.folder) from None
        self._text: dict[str, TextFile] = {}
        endings = ["sta", "cvg", "jsonl"]
        printed = any(o.kind.endswith("print") for s in steps for o in s.outputs)
        if printed or any(s.procedure in ("buckle", "frequency") for s in steps):
            endings.insert(0, "dat")
        for ending in endings:
            self._text[ending] = TextFile(self._path(name, ending))
        self._text["sta"].append(STA_HEAD)
        self._text["cvg"].append(CVG_HEAD)
        self._csv = CsvWriter(self._path(name, "csv"))
        self._big: list[VtkhdfWriter | PvdWriter] = []
        big = [(ending, self._path(name, ending)) for ending in self._formats]
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="corota-files", daemon=True)
        self._thread.start()
        self._put(lambda: self._open(big))  # takes as long as solving a small job
        self._events = Events(self._log)
        self._events.start(model, steps)

    def _open(self, big: list[tuple[str, Path]]) -> None:
        """Make the writers of the result files."""
        for ending, path in big:
            if ending == "pvd":
                from corota.io.vtk.vtu import PvdWriter

                self._big.append(PvdWriter(path, self.model))
            else:
                from corota.io.vtk.vtkhdf import VtkhdfWriter

                self._big.append(VtkhdfWriter(path, self.model, self._points))

    def _path(self, name: str, ending: str) -> Path:
        path = self.folder / f"{name}.{ending}"
        self.paths.append(path)
        return path

    def step(self, number: int, step: Step) -> None:
        self._events.step(number, step)

    def iteration(self, info: Iteration) -> None:
        if info.iteration <= 1:
            self._largest = 0.0
        self._largest = max(self._largest, info.correction)
        self._last_iteration = info
        line = cvg_line(info, self._largest)
        self._put(lambda: self._text["cvg"].append(line))
        self._events.iteration(info)

    def increment(self, frame: Frame) -> None:
        attempts = self._cuts.get((frame.step, frame.increment), 0) + 1
        self._reached = (frame.time, frame.step_time)
        size = 8 * (frame.U.size * 6 + sum(b.volume.size * 24 for b in frame.fields))
        self._events.increment(frame)
        self._put(lambda: self._write(frame, attempts), size)

    def cut_back(self, step: int, increment: int, attempt: int, reason: str, dt: float) -> None:
        self._cuts[step, increment] = attempt
        last = self._last_iteration
        tried, count = (last.dt, last.iteration) if last else (0.0, 0)
        line = sta_failed(step, increment, attempt, count, self._reached, tried)
        self._put(lambda: self._text["sta"].append(line))
        self._events.cut_back(step, increment, attempt, reason, dt)

    def end(self, results: Results, error: Exception | None) -> None:
        """Write what waits and close; raise what went wrong unless the analysis failed first."""
        if self._closed:
            return
        self._drain()
        if self.error is None:
            self._finish(self._end_step)
        profile = results.info.setdefault("profile", {})
        for phase, seconds in self._profile.items():
            profile.setdefault(phase, seconds)
        results.info["seconds held by output"] = profile.get("write", 0.0)
        profile["write"] = self.seconds
        self._finish(lambda: self._events.end(results, error))
        if results.modes and "vtkhdf" in self._formats:
            from corota.io.modes import write_modes

            path = self._path(self.name or self.model.name, "modes.vtkhdf")
            self._finish(lambda: write_modes(results, path))
        self._iterate(results)
        self.close(results.info)
        if self.error is not None and error is None:
            raise self.error

    def _iterate(self, results: Results) -> None:
        """Write where the last attempt ended; after a run that converged there is no such file."""
        from corota.io.modes import write_iterate

        name = f"{self.name or self.model.name}.last_iterate.vtkhdf"
        if results.last_iterate is None or "vtkhdf" not in self._formats:
            (self.folder / name).unlink(missing_ok=True)
            return
        path = self.folder / name
        self.paths.append(path)
        self._finish(lambda: write_iterate(results, path))

    def close(self, info: dict[str, Any] | None = None) -> None:
        """Write what waits and close the files; errors stay in :attr:`error`."""
        if self._closed:
            return
        self._drain()
        self._closed = True
        if self.error is None:
            self._finish(self._end_step)
        for big in self._big:
            self._finish(lambda big=big: big.close(info))  # type: ignore[misc]
        for text in self._text.values():
            text.close()
        self._csv.close()

    def __enter__(self) -> JobFiles:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    # The writer's side.
    def _put(self, task: Callable[[], None], size: int = 200) -> None:
        if self.error is not None:
            raise self.error
        if self._thread is None:
            task()
            return
        with self._free:
            while self._waiting > MOST_WAITING and self.error is None:
                self._wake.set()
                self._free.wait(1.0)
            self._waiting += size
        self._tasks.append((task, size))
        if time.perf_counter() >= self._busy_until:
            self._wake.set()

    def _log(self, record: dict[str, Any]) -> None:
        self._put(lambda: self._text["jsonl"].append(json_line(record)))

    def _finish(self, task: Callable[[], None]) -> None:
        try:
            task()
        except Exception as error:  # the first error is the one to report
            self.error = self.error or error

    def _work(self) -> None:
        while not self._stop or self._tasks:
            if not self._stop:
                self._wake.wait(BEAT if self._tasks else None)
            self._wake.clear()
            self._busy_until = time.perf_counter() + BEAT
            self._empty()

    def _empty(self) -> None:
        """Do what waits, then bring the result files up to date."""
        begin, done, frames = time.thread_time(), 0, False
        while self._tasks:
            task, size = self._tasks.popleft()
            if self.error is None:
                self._finish(task)
            done += size
            frames = frames or size > 200
            if done > MOST_WAITING // 4:
                break
        if frames and self.error is None:
            for big in self._big:
                self._finish(big.commit)
        with self._free:
            self._waiting -= done
            self._free.notify_all()
        self.seconds += time.thread_time() - begin

    def _drain(self) -> None:
        if self._thread is None:
            return
        self._stop = True
        self._wake.set()
        self._thread.join()
        self._thread = None
        self._empty()

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
        self._answer(due_now(self.model, self.steps, frame), frame)
        filed = wants_file(self.model, self.steps, frame)
        if filed:
            self._file(frame)
        self._newest = (frame, filed)

    def _end_step(self) -> None:
        """The newest frame was the last of its step, so it answers all requests."""
        if self._newest is None:
            return
        frame, filed = self._newest
        self._newest = None
        self._answer(left_over(self.model, self.steps, frame), frame)
        if not filed:
            self._file(frame)

    def _answer(self, outputs: list[Output], frame: Frame) -> None:
        text = dat_blocks(self.model, outputs, frame) if "dat" in self._text else ""
        if text:
            self._text["dat"].append(text)

    def _file(self, frame: Frame) -> None:
        for big in self._big:
            big.add(frame)


__all__ = ["BEAT", "JobFiles"]
