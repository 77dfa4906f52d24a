"""The page of a run at work: who may ask, what is answered, and that the run can be ended."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import http.client
import json
import threading
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest

import corota as ct
from corota.io.stop_request import request_stop, stop_file
from corota.report.chunk import unpack
from corota.report.records import JobPaths
from corota.report.server import JobWatch, PageServer
from corota.results.observer import BaseObserver


def bar(name: str = "bar") -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1), name=name)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.1)
    return model


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> JobPaths:
    folder = tmp_path_factory.mktemp("served")
    with ct.JobFiles(folder) as files:
        ct.solve(bar(), ct.Static(increments=4), observers=[files], threads=1)
    return JobPaths(folder, "bar")


@pytest.fixture
def server(job: JobPaths) -> Iterator[PageServer]:
    with PageServer(job) as made:
        yield made


def ask(
    server: PageServer, path: str, method: str = "GET", **headers: str
) -> tuple[int, bytes, dict[str, str]]:
    found = urlsplit(server.address)
    assert found.hostname == "127.0.0.1"
    connection = http.client.HTTPConnection(found.hostname, found.port or 0, timeout=20)
    try:
        connection.request(method, path, headers=headers)
        answer = connection.getresponse()
        return answer.status, answer.read(), dict(answer.getheaders())
    finally:
        connection.close()


def own(server: PageServer, name: str = "") -> str:
    return urlsplit(server.address).path + name


def test_page_model_history_frames(server: PageServer) -> None:
    status, text, headers = ask(server, own(server))
    assert status == 200
    assert headers["Referrer-Policy"] == "no-referrer"
    assert b"connect-src 'self'" in text
    state = json.loads(ask(server, own(server, "state"))[1])
    assert (state["frames"], state["over"], state["status"]) == (5, True, "done")
    model, _ = unpack(ask(server, own(server, "model"))[1])
    assert model["name"] == "bar"
    _, rows = unpack(ask(server, own(server, "history"))[1])
    assert len(rows["rows"]) == 5
    head, arrays = unpack(ask(server, own(server, "frame/4"))[1])
    assert head["increment"] == 4
    assert arrays["U"].shape == (22, 2)
    assert ask(server, own(server, "frame/5"))[0] == 204


def test_others_are_not_found(server: PageServer) -> None:
    assert ask(server, "/")[0] == 404
    assert ask(server, "/guess/state")[0] == 404
    assert ask(server, own(server, "state"), Host="evil.example")[0] == 404
    assert ask(server, own(server, "stop"), "POST", Origin="http://evil.example")[0] == 404
    assert ask(server, own(server, "state"), "POST")[0] == 404
    assert not stop_file(server.watch.job.folder, "bar").exists()


def test_nothing_yet(tmp_path: Path) -> None:
    with PageServer(JobPaths(tmp_path, "later")) as server:
        assert ask(server, own(server))[0] == 200
        assert ask(server, own(server, "model"))[0] == 204
        state = json.loads(ask(server, own(server, "state"))[1])
        assert (state["frames"], state["over"]) == (0, False)


class Ask(ct.BaseObserver):
    """Presses the button after an increment."""

    def __init__(self, server: PageServer) -> None:
        self.server = server

    def increment(self, frame: ct.Frame) -> None:
        if frame.increment == 2:
            assert ask(self.server, own(self.server, "stop"), "POST")[0] == 200


def test_stop_ends_with_a_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("corota.io.stop_request.BEAT", 0.0)
    whole = ct.solve(bar(), ct.Static(increments=6), threads=1)
    with PageServer(JobPaths(tmp_path, "bar")) as server, ct.JobFiles(tmp_path) as files:
        watch = Ask(server)
        with pytest.raises(ct.Interrupted, match="stopped at step 1"):
            ct.solve(bar(), ct.Static(increments=6), observers=[watch, files], threads=1)
    assert not stop_file(tmp_path, "bar").exists()
    assert JobWatch(JobPaths(tmp_path, "bar")).state()["status"] == "failed"
    results = ct.resume(tmp_path / "bar", threads=1)
    assert results.frames[-1].U.tolist() == whole.frames[-1].U.tolist()


def test_a_request_that_an_earlier_run_left_is_forgotten(tmp_path: Path) -> None:
    request_stop(tmp_path, "bar")
    with ct.JobFiles(tmp_path) as files:
        results = ct.solve(bar(), ct.Static(increments=3), observers=[files], threads=1)
    assert len(results.frames) == 4


class Wait(BaseObserver):
    """Waits for one more look at the files after every hundredth increment."""

    def __init__(self, looked: threading.Event) -> None:
        self.looked = looked

    def increment(self, frame: ct.Frame) -> None:
        if frame.increment in (100, 200, 300):
            self.looked.clear()
            assert self.looked.wait(120.0), "the reader saw no frame"


def test_pages_while_the_run_writes(tmp_path: Path) -> None:
    """Whole answers at every moment: the files are read while they are exchanged."""
    watch = JobWatch(JobPaths(tmp_path, "bar"))
    faults: list[object] = []
    done = threading.Event()
    looked = threading.Event()

    def look() -> None:
        while not done.is_set():
            try:
                count = watch.state()["frames"]
                if count < 2:  # the first frame is zero, and zeros are left out
                    continue
                data = watch.frame(count - 1)
                if data is None or "U" not in unpack(data)[1]:
                    faults.append(count)
            except Exception as fault:
                faults.append(fault)
            looked.set()

    reader = threading.Thread(target=look)
    reader.start()
    try:
        with ct.JobFiles(tmp_path) as files:
            watched = [files, Wait(looked)]
            ct.solve(bar(), ct.Static(increments=300), observers=watched, threads=1)
    finally:
        done.set()
        reader.join(30.0)
    assert not faults
    assert looked.is_set()
    assert watch.state()["frames"] == 301
