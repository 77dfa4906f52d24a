"""The page of a run in progress: a server for this machine only, based on the files of the job."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import os
import re
import secrets
import threading
import time
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from corota.errors import CorotaError
from corota.io.result_reader import FileResults, read_vtkhdf
from corota.io.stop_request import request_stop
from corota.report.content import BITS, facts_of, frame_chunk, history_chunk, model_chunk
from corota.report.fields import NodalArrays
from corota.report.page import page
from corota.report.records import JobPaths, JobRecords, Records

if TYPE_CHECKING:
    from collections.abc import Callable


Answer = TypeVar("Answer")

HOST = "127.0.0.1"
#: Of zlib: the run needs the processor more than the page.
LEVEL = 1
#: Seconds after which a run whose process is not found counts as ended if its log does not grow.
QUIET = 60.0
#: Seconds within which an open page sends the next request.
STILL_ASKING = 2.5
#: Times that a result file is read again if the run exchanged it meanwhile.
TRIES = 4


class JobWatch:
    """Data of a job for a page, from its current files."""

    def __init__(self, job: JobPaths) -> None:
        self.job = job
        self._records = JobRecords(job)
        self._lock = threading.Lock()
        self._model: tuple[str, bytes] | None = None

    def records(self) -> Records:
        """The history of the run so far."""
        with self._lock:
            return self._records.update()

    def state(self) -> dict[str, Any]:
        """Progress of the run: ``version`` changes with the history, ``over`` with its end."""
        found = self.records()
        return {
            "version": len(found.rows)
            + len(found.iterations)
            + len(found.cut_backs)
            + len(found.notes)
            + len(found.end),
            "frames": self._read(lambda results: len(results.frames)) or 0,
            "over": not self.at_work(found),
            "status": found.end.get("status", ""),
        }

    def at_work(self, records: Records | None = None) -> bool:
        """Whether a process still writes the files."""
        found = records or self.records()
        if found.end:
            return False
        try:
            holder = int((self.job.folder / f".{self.job.name}.lock").read_text())
            os.kill(holder, 0)
        except (OSError, ValueError):
            # Ended by force, or on another machine: then its log still grows.
            return self._age() < QUIET
        return True

    def _age(self) -> float:
        try:
            return time.time() - self.job.path("jsonl").stat().st_mtime
        except OSError:
            return 0.0

    def model(self) -> bytes | None:
        """Chunk of the model; built once per run."""

        def make(results: FileResults) -> bytes:
            run = results.attributes.get("run", "")
            if self._model is None or self._model[0] != run:
                self._model = (run, model_chunk(results, LEVEL))
            return self._model[1]

        return self._read(make)

    def history(self) -> bytes:
        """Chunk of the history of the run."""
        facts = self._read(lambda results: facts_of(results, self.job.name)) or {
            "job": self.job.name
        }
        return history_chunk(self.records(), facts, [], level=LEVEL)

    def frame(self, index: int) -> bytes | None:
        """Chunk of a frame; None where there is none yet."""

        def make(results: FileResults) -> bytes | None:
            if not 0 <= index < len(results.frames):
                return None
            arrays = NodalArrays(results)
            return frame_chunk("increment", arrays, index, arrays.names, BITS, LEVEL)

        return self._read(make)

    def _read(self, action: Callable[[FileResults], Answer]) -> Answer | None:
        """Result of an action on the result file; None while there is none.

        The run exchanges two copies of the file and writes the one that is not
        visible: a result is valid if the file was the visible one before and after.
        """
        path = self.job.path("vtkhdf")
        for _ in range(TRIES):
            try:
                before = os.stat(path).st_ino
                with read_vtkhdf(path) as results:
                    found = action(results)
                if os.stat(path).st_ino == before:
                    return found
            except (CorotaError, OSError, KeyError, ValueError):
                if not path.exists():
                    return None
        return None

    def stop(self) -> None:
        """Request the end of the run after the current increment, with a checkpoint."""
        request_stop(self.job.folder, self.job.name)


#: Request of a frame, by a number that a run can have.
_FRAME = re.compile(r"frame/([0-9]{1,9})")


class _Handler(BaseHTTPRequestHandler):
    """Answers below the address with the token; all else is not found."""

    watch: ClassVar[JobWatch]
    token: ClassVar[str]
    server: PageServer
    protocol_version = "HTTP/1.1"

    def do_GET(self) -> None:
        name = self._name()
        if name is None:
            return self._fail(HTTPStatus.NOT_FOUND)
        self.server.note_request()
        if name == "":
            text = page(None, title=self.watch.job.name, live=f"/{self.token}")
            return self._answer(text.encode(), "text/html; charset=utf-8")
        if name == "state":
            return self._answer(json.dumps(self.watch.state()).encode(), "application/json")
        data = None
        if name in ("model", "history"):
            data = getattr(self.watch, name)()
        elif frame := _FRAME.fullmatch(name):
            data = self.watch.frame(int(frame[1]))
        if data is None:
            return self._answer(b"", "application/octet-stream", HTTPStatus.NO_CONTENT)
        return self._answer(data, "application/octet-stream")

    def do_POST(self) -> None:
        own = f"http://{self.headers.get('Host')}"
        if self._name() != "stop" or self.headers.get("Origin", own) != own:
            return self._fail(HTTPStatus.NOT_FOUND)
        self.watch.stop()
        return self._answer(b"{}", "application/json")

    def _name(self) -> str | None:
        """The requested name; None if the address is not that of this page.

        A page of another site whose name resolves to this machine sends its own name.
        """
        port = self.server.server_address[1]
        if self.headers.get("Host") not in (f"{HOST}:{port}", f"localhost:{port}"):
            return None
        parts = self.path.split("?")[0].split("/", 2)
        # Only bytes may be compared beyond ASCII.
        if len(parts) != 3 or not secrets.compare_digest(parts[1].encode(), self.token.encode()):
            return None
        return parts[2]

    def _fail(self, status: HTTPStatus) -> None:
        self._answer(b"", "text/plain", status)

    def _answer(self, data: bytes, kind: str, status: HTTPStatus = HTTPStatus.OK) -> None:
        try:
            self.send_response(status)
            for name, value in (
                ("Content-Type", kind),
                ("Content-Length", str(len(data))),
                ("Cache-Control", "no-store"),
                ("X-Content-Type-Options", "nosniff"),
                ("Referrer-Policy", "no-referrer"),
            ):
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(data)
        except OSError:  # the page was closed
            self.close_connection = True

    def log_message(self, format: str, *args: object) -> None:
        """Print nothing on the terminal."""


class PageServer(ThreadingHTTPServer):
    """Serves the page of a job on the loopback address, at an unguessable path.

    Parameters
    ----------
    port : int
        Any free one by default.

    Attributes
    ----------
    address : str
        Of the page.
    """

    daemon_threads = True

    def __init__(self, job: JobPaths, port: int = 0) -> None:
        token = secrets.token_urlsafe(18)
        handler = type("Handler", (_Handler,), {"watch": JobWatch(job), "token": token})
        super().__init__((HOST, port), handler)
        self.watch: JobWatch = handler.watch  # type: ignore[attr-defined]
        self.address = f"http://{HOST}:{self.server_address[1]}/{token}/"
        self._last = 0.0
        self._thread = threading.Thread(
            target=self.serve_forever,
            kwargs={"poll_interval": 0.1},
            name="corota-page",
            daemon=True,
        )

    def note_request(self) -> None:
        """Note the time of a request by a page."""
        self._last = time.monotonic()

    def __enter__(self) -> PageServer:
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self.shutdown()
        self.server_close()

    def wait_for_pages(self, seconds: float = 10.0) -> None:
        """Wait until open pages have fetched the end of the run."""
        limit = time.monotonic() + seconds
        while (now := time.monotonic()) < limit and now - self._last < STILL_ASKING:
            time.sleep(0.1)
