"""Standard streams, signals and disks that refuse: the run goes on or ends cleanly."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import os
import pty
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from corota.io.result_reader import read_results

DECK = Path(__file__).parent / "deck.inp"
CALL = [sys.executable, "-m", "corota"]


def on_terminal(arguments, env, call=CALL):
    """Output of a command whose standard output is a terminal."""
    main, side = pty.openpty()
    run = subprocess.Popen([*call, *arguments], stdout=side, stderr=side, env=env)
    os.close(side)
    seen = b""
    while True:
        try:
            piece = os.read(main, 65536)
        except OSError:
            break
        if not piece:
            break
        seen += piece
    os.close(main)
    return run.wait(timeout=60), seen.decode()


@pytest.mark.parametrize("limit", [10, 200, 3000, 40000, 120000])
def test_full_disk_is_6_names_the_file_and_leaves_no_broken_one(tmp_path, limit, call):
    """A limit on the size of files stands for a disk that is full at some moment."""

    def small():
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    done = call("run", DECK, "-o", tmp_path, "-q", preexec_fn=small)
    assert done.returncode == 6, (done.returncode, done.stderr)
    assert f"{tmp_path}/deck." in done.stderr
    assert "cannot write" in done.stderr
    if (tmp_path / "deck.vtkhdf").exists():
        with read_results(tmp_path / "deck.vtkhdf") as results:
            assert len(results.frames) >= 1
    for name in ("deck.sta", "deck.csv", "deck.cvg", "deck.jsonl"):
        if (tmp_path / name).exists():
            assert (tmp_path / name).read_text()[-1:] in ("\n", "")


def test_reader_that_goes_away_does_not_stop_the_run(tmp_path):
    with subprocess.Popen(
        [*CALL, "run", str(DECK), "-o", str(tmp_path)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as run:
        run.stdout.close()
        error = run.stderr.read()
        assert run.wait(timeout=60) == 0
    assert error == b""
    with read_results(tmp_path / "deck.vtkhdf") as results:
        assert results.frames[-1].factor == pytest.approx(1.0)


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-"])
def test_closed_streams_do_not_stop_the_run(tmp_path, closed):
    line = f"{' '.join(CALL)} run {DECK} -o {tmp_path} {closed}"
    assert subprocess.run(line, shell=True, check=False, timeout=60).returncode == 0
    assert (tmp_path / "deck.vtkhdf").exists()


def test_full_standard_output_is_6_but_the_files_are_there(tmp_path, call):
    with open("/dev/full", "w") as full:
        done = call(
            "run", DECK, "-o", tmp_path, stdout=full, stderr=subprocess.PIPE, capture_output=False
        )
    assert done.returncode == 6
    assert "standard output: cannot write" in done.stderr
    assert (tmp_path / "deck.vtkhdf").exists()


#: A signal comes where Python loses an exception, or makes another one of it: in a callback of a
#: weak reference, or while a class is being made, as imports do.
WHILE_IMPORTING = """
import signal, sys, weakref
way = sys.argv.pop()
from importlib.abc import MetaPathFinder
class Strike:
    def __set_name__(self, owner, name):
        signal.raise_signal(signal.SIGINT)
class Finder(MetaPathFinder):
    def find_spec(self, name, *_):
        if name == "corota.io.deck.drafts":
            if way == "lost":
                weakref.finalize(strike := Strike(), signal.raise_signal, signal.SIGINT)
                del strike
            else:
                type("Made", (), {"part": Strike()})
sys.meta_path.insert(0, Finder())
signal.signal(signal.SIGINT, signal.default_int_handler)
from corota.cli import program
program()
"""


@pytest.mark.parametrize("way", ["lost", "another"])
def test_an_interrupt_while_a_deck_is_read_ends_with_7(tmp_path, way, deck):
    path = deck(tmp_path / "deck.inp")
    done = subprocess.run(
        [sys.executable, "-c", WHILE_IMPORTING, "run", str(path), way],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        check=False,
    )
    assert (done.returncode, done.stderr) == (7, "corota: error: interrupted\n")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_the_run_with_7_and_all_increments_on_disk(tmp_path, number, deck):
    path = deck(
        tmp_path / "long.inp",
        ("INC=50", "INC=100000"),
        ("0.25,1.,1e-5,0.25", "1e-4,1.,1e-6,1e-4"),
    )
    with subprocess.Popen(
        [*CALL, "run", str(path), "-o", str(tmp_path), "--json"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # What runs the tests may ignore the signal, and the run would inherit that.
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),
    ) as run:
        done = 0
        while done < 5:
            record = json.loads(run.stdout.readline())
            done = record["increment"] if record["event"] == "increment" else done
        run.send_signal(number)
        # Not communicate(): it would miss what readline() has already taken into its buffer.
        output, error = run.stdout.read(), run.stderr.read()
        run.wait(timeout=60)
    assert run.returncode == 7, error
    assert "Traceback" not in error
    records = [json.loads(line) for line in output.splitlines()]
    last = max((r["increment"] for r in records if r["event"] == "increment"), default=done)
    with read_results(tmp_path / "long.vtkhdf") as results:
        assert results.frames[-1].increment == last


def test_terminal_shows_a_live_line(tmp_path):
    # The line is refreshed with every increment, however fast the machine is.
    refreshed = (
        "from corota.cli.progress import Progress; Progress.REFRESH = 0.0; "
        "from corota.cli import program; program()"
    )
    arguments = ["run", str(DECK), "-o", str(tmp_path)]
    env = {**os.environ, "TERM": "xterm", "PYTHONIOENCODING": "utf-8"}
    env.pop("NO_COLOR", None)
    code, text = on_terminal(arguments, env, [sys.executable, "-c", refreshed])
    assert code == 0
    assert "\r\x1b[2K step 1/1 " in text
    assert "left " in text
    assert "\x1b[32mDone\x1b[0m" in text
    assert " step    inc" not in text
    code, plain = on_terminal(arguments, {**env, "NO_COLOR": "1"})
    assert "\x1b[32m" not in plain
    code, dumb = on_terminal(arguments, {**env, "TERM": "dumb"})
    assert "\x1b" not in dumb
    assert " step    inc" in dumb
