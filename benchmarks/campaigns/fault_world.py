"""A run whose surroundings fail: full disk, little memory, signals, odd files, many threads."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import hashlib
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

import corota as ct
from benchmarks.campaigns.fault_readers import SEEDS
from benchmarks.campaigns.fault_runs import CODES, command, forked, judged

#: Seconds of a run by the clock and of the processor where decks that fail are compared, too: one
#: tries contact for 30 s before it is given up.
CLOCK, LIMIT = 600.0, 120
#: A strip of 40 x 8 cells in many increments: long enough to be hit in the middle.
SLOW = ("0.002, 1., 1e-5, 0.002", 4000)


def strip_deck(nx: int = 40, ny: int = 8, times: str = "0.1, 1.", inc: int = 100) -> str:
    """Cantilever of CPS4I cells under a force at its end."""
    lines = ["*NODE"]
    number = {}
    for j in range(ny + 1):
        for i in range(nx + 1):
            number[i, j] = len(number) + 1
            lines.append(f"{number[i, j]}, {10.0 * i / nx:.12g}, {j / ny:.12g}")
    lines.append("*ELEMENT, TYPE=CPS4I, ELSET=E")
    for j in range(ny):
        for i in range(nx):
            corners = [number[i, j], number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]]
            lines.append(f"{j * nx + i + 1}, " + ", ".join(map(str, corners)))
    lines += ["*NSET, NSET=CLAMP", *(f"{number[0, j]}" for j in range(ny + 1))]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "1000., .3", "*SOLID SECTION, ELSET=E, MATERIAL=M"]
    lines += ["1.", "*BOUNDARY", "CLAMP, 1, 2", f"*STEP, NLGEOM, INC={inc}", "*STATIC", times]
    lines += ["*CLOAD", f"{number[nx, ny]}, 2, -1.", "*NODE PRINT, NSET=CLAMP", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


def _fresh(folder: Path) -> Path:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def full_disk(folder: Path) -> Counter[str]:
    """A limit on the size of files at twenty places stands for a full disk: exit 6."""
    outcomes: Counter[str] = Counter()
    deck = strip_deck(10, 2)
    for limit in np.unique(np.geomspace(10, 400_000, 20).astype(int)):
        _fresh(folder)
        (folder / "deck.inp").write_text(deck)

        def work(size: int = int(limit)) -> int:
            os.chdir(folder)
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            return command("run", "deck.inp", "-q", "--threads", "1")

        # The log would be limited too.
        code, _, _ = forked(work, Path("/dev/null"))
        broken = code == 6 and _broken(folder)
        outcomes["full disk: " + (broken or f"exit {code}")] += 1
    return outcomes


def _broken(folder: Path) -> str:
    """Whether a result file with its final name cannot be read."""
    path = folder / "deck.vtkhdf"
    if not path.exists():
        return ""
    try:
        with ct.read_results(path) as results:
            return "" if np.isfinite(results.frames[-1].U).all() else "NaN in a result file"
    except Exception as error:
        return f"broken result file: {type(error).__name__}"


def little_memory(folder: Path) -> Counter[str]:
    """Address space from what an idle process has to what the run needs: exit 5, no abort."""
    outcomes: Counter[str] = Counter()
    deck = strip_deck(120, 40, "1., 1.")
    for share in np.linspace(0.02, 1.0, 28):
        _fresh(folder)
        (folder / "deck.inp").write_text(deck)

        def work(extra: float = float(share)) -> int:
            os.chdir(folder)
            now = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
            size = now + int(extra * (400 << 20))
            resource.setrlimit(resource.RLIMIT_AS, (size, size))
            return command("run", "deck.inp", "-q", "--threads", "1")

        code, _, said = forked(work, folder / "log")
        outcome = judged(code, said, folder, "deck")
        outcomes[f"little memory: {outcome}"] += 1
    return outcomes


def signals(count: int, seed: int, folder: Path) -> Counter[str]:
    """SIGINT, SIGTERM, SIGKILL at random moments: exit 7, or at least no broken file."""
    outcomes: Counter[str] = Counter()
    rng = random.Random(seed)
    deck = strip_deck(20, 2, *SLOW)
    # A shell's background jobs ignore SIGINT, and what they start does, too.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    whole = 0.0
    for k in range(-1, count):
        _fresh(folder)
        (folder / "deck.inp").write_text(deck)
        number = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)[k % 3]
        with subprocess.Popen(
            [sys.executable, "-m", "corota", "run", "deck.inp", "--threads", "1"],
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        ) as run:
            assert run.stdout is not None
            run.stdout.readline()
            begin = time.perf_counter()
            if k < 0:  # undisturbed, for its time
                run.communicate()
                whole = time.perf_counter() - begin
                continue
            time.sleep(rng.uniform(0.0, whole))
            run.send_signal(number)
            try:
                _, said = run.communicate(timeout=60)
            except subprocess.TimeoutExpired:
                run.kill()
                outcomes[f"{number.name}: hang"] += 1
                continue
        if b"Traceback" in said:
            outcomes[f"{number.name}: traceback"] += 1
            continue
        broken = _broken(folder)
        outcomes[f"{number.name}: {broken or f'exit {run.returncode}'}"] += 1
    return outcomes


def odd_places(folder: Path) -> Counter[str]:
    """Files and folders that are not what they should be: exit codes by the table."""
    outcomes: Counter[str] = Counter()
    _fresh(folder)
    deck = folder / "deck.inp"
    deck.write_text(strip_deck(4, 1))
    (folder / "file").write_text("no folder")
    (folder / "empty.inp").write_text("")
    cases = {
        "missing deck": (("run", "gone.inp"), {6, 2}),
        "folder as deck": (("run", "."), {6, 2}),
        "empty deck": (("run", "empty.inp"), {2}),
        "device as deck": (("run", "/dev/zero"), {2, 6}),
        "output in a file": (("run", "deck.inp", "-o", "file"), {6}),
        "output in /proc": (("run", "deck.inp", "-o", "/proc/nothing"), {6}),
        "unknown option": (("run", "deck.inp", "--nothing"), {64}),
        "unknown command": (("walk", "deck.inp"), {64}),
        "deck as results": (("plot", "deck.inp"), {2, 6}),
        "text as results": (("info", "file"), {2, 6}),
        "convert to nothing": (("convert", "deck.inp", "x.abc"), {2}),
    }
    for name, (arguments, right) in cases.items():

        def work(words: tuple[str, ...] = arguments) -> int:
            os.chdir(folder)
            return command(*words)

        code, _, said = forked(work, folder.parent / "log")
        good = code in right and "Traceback" not in said and bool(said.strip())
        outcomes[f"odd places: {'right exit code' if good else f'wrong: {name}: exit {code}'}"] += 1
    for redirect, right in ((">&-", 0), ("2>&-", 0), (">/dev/full", 6)):
        line = f"{sys.executable} -m corota run deck.inp --threads 1 {redirect}"
        code = subprocess.run(
            line, shell=True, cwd=folder, check=False, stderr=subprocess.PIPE
        ).returncode
        good = code == right
        outcomes[
            f"odd places: {'right exit code' if good else f'wrong: {redirect}: exit {code}'}"
        ] += 1
    return outcomes


def damaged_results(count: int, seed: int, folder: Path) -> Counter[str]:
    """Flipped bytes and cuts of a result file: refused or read, never a crash."""
    outcomes: Counter[str] = Counter()
    rng = random.Random(seed)
    _fresh(folder)
    (folder / "deck.inp").write_text(strip_deck(6, 2))

    def work() -> int:
        os.chdir(folder)
        return command("run", "deck.inp", "-q", "--threads", "1")

    forked(work, folder / "log")
    whole = (folder / "deck.vtkhdf").read_bytes()
    for _ in range(count):
        data = bytearray(whole)
        if rng.random() < 0.3:
            del data[rng.randrange(len(data)) :]
        else:
            for _ in range(rng.choice((1, 1, 4, 16))):
                data[rng.randrange(len(data))] = rng.randrange(256)
        (folder / "bad.vtkhdf").write_bytes(bytes(data))

        def info() -> int:
            os.chdir(folder)
            return command("info", "bad.vtkhdf")

        code, _, said = forked(info, folder / "log")
        if code in (0, 2, 6) and "Traceback" not in said:
            outcomes[f"damaged results: exit {code}"] += 1
        else:
            last = [line for line in said.splitlines() if "error" in line][-1:] or [""]
            outcomes[f"damaged results: failure: exit {code}: {last[0][:120]}"] += 1
    return outcomes


def threads(folder: Path) -> Counter[str]:
    """Displacements and reactions bit by bit over 1, 2, 3, 4, 8 and 16 threads.

    Of a deck that does not finish, the exit codes on 1 and 4 threads.
    """
    outcomes: Counter[str] = Counter()
    decks = [strip_deck(60, 12), *(s for s in dict.fromkeys(SEEDS))]
    for number, deck in enumerate(decks):
        found, failed = set(), False
        for count in (1, 4, 2, 3, 8, 16):
            if failed and count != 4:
                break
            _fresh(folder)
            (folder / "deck.inp").write_text(deck)

            def work(number: int = count) -> int:
                os.chdir(folder)
                return command("run", "deck.inp", "-q", "--threads", str(number))

            code, _, said = forked(work, folder / "log", CLOCK, LIMIT)
            failed = code != 0
            good = code in CODES and "Traceback" not in said
            found.add(f"{'exit' if good else 'wrong exit'} {code}" if failed else _digest(folder))
        if len(found) != 1 or next(iter(found)).startswith("wrong"):
            outcomes[f"threads: wrong: deck {number}: {sorted(found)}"] += 1
        elif failed:
            outcomes[f"threads: {found.pop()} on 1 and on 4"] += 1
        else:
            outcomes["threads: bitwise equal"] += 1
    return outcomes


def _digest(folder: Path) -> str:
    digest = hashlib.sha256()
    with ct.read_results(folder / "deck.vtkhdf") as results:
        for frame in results.frames:
            for values in (frame.U, frame.UR, frame.RF, frame.F):
                digest.update(np.ascontiguousarray(values).tobytes())
            for block in frame.fields:
                for name in sorted(block.values):
                    digest.update(np.ascontiguousarray(block.values[name]).tobytes())
            for averages in (frame.averages, frame.cell_averages):
                for name in sorted(averages):
                    digest.update(np.ascontiguousarray(averages[name]).tobytes())
    return digest.hexdigest()
