"""The commands ``report``, ``watch`` and ``run --serve``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import threading
import urllib.request
from pathlib import Path

import pytest

from corota.cli import main
from corota.cli.watch import BARS, PLAIN_BARS, bars

DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=ALL
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=ALL, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1
*STEP, INC=100
*STATIC, DIRECT
0.1, 1.
*CLOAD
2, 1, 1.
3, 1, 1.
*END STEP
"""


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    path = tmp_path / "pull.inp"
    path.write_text(DECK)
    return path


def test_report(deck: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(deck), "-o", str(tmp_path / "out"), "-q"]) == 0
    assert main(["report", str(tmp_path / "out" / "pull.vtkhdf"), "--json"]) == 0
    record = json.loads(capsys.readouterr().out.splitlines()[-1])
    page = tmp_path / "out" / "pull.html"
    assert (record["event"], record["file"]) == ("report", str(page))
    assert record["bytes"] == page.stat().st_size
    other = tmp_path / "other.html"
    job = str(tmp_path / "out" / "pull")
    assert main(["report", job, "-o", str(other), "--title", "A title"]) == 0
    assert "<title>A title</title>" in other.read_text(encoding="utf-8")


def test_report_of_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", str(tmp_path / "none")]) == 6
    assert "no files of such a job" in capsys.readouterr().err


def test_watch_in_the_terminal(
    deck: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(deck), "-o", str(tmp_path), "-q"]) == 0
    assert main(["watch", str(tmp_path / "pull"), "--terminal"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert sum(line.startswith("step 1  increment") for line in lines) == 10
    assert lines[-1].startswith("done after ")


def test_bars() -> None:
    assert bars([1.0, 1e-12, 0.0, float("nan"), 1e9, 1e-6], BARS) == "█▁▁▁█▅"
    assert bars([1.0], PLAIN_BARS) == "#"


def test_serve(deck: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The page is there while the run goes on, and what it asks is answered."""
    seen: list[bytes] = []
    address: list[str] = []

    def look(found: str, terminal: object) -> None:
        address.append(found)
        seen.append(urllib.request.urlopen(found, timeout=20).read())

    monkeypatch.setattr("corota.cli.watch.tell_address", look)
    monkeypatch.setattr("corota.report.server.STILL_ASKING", 0.0)
    assert main(["run", str(deck), "-o", str(tmp_path), "-q", "--serve"]) == 0
    assert b"corotaReport" in seen[0]
    assert address[0].startswith("http://127.0.0.1:")
    with pytest.raises(OSError, match="refused"):
        urllib.request.urlopen(address[0], timeout=5)
    assert not any(t.name == "corota-page" for t in threading.enumerate())


@pytest.mark.parametrize("port", ["-1", "70000", "http"])
def test_port(port: str, deck: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(deck), f"--serve={port}"]) == 64
    assert "is not a port" in capsys.readouterr().err
