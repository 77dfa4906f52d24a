"""Received folders: links, pipes, odd includes, foreign files, and little memory, at random."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import random
import resource
import shutil
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.campaigns.fault_runs import LOG, command, forked, sound_results
from benchmarks.campaigns.fault_world import strip_deck

if TYPE_CHECKING:
    from collections.abc import Callable

#: Exit codes that a command may end with.
CODES = {0, 2, 3, 4, 5, 6, 64}
#: Endings of the files of a job, and of files that are read.
WRITTEN = ("dat", "sta", "cvg", "jsonl", "csv", "vtkhdf", "npz", "frd", "ckpt", "ckpt.1", "pvd")
READ = ("inp", "msh", "unv", "frd", "vtu", "pvd", "vtkhdf", "npz", "ckpt", "jsonl", "dxf")
#: Where a link may lead.
TARGETS = ("../beyond", "../new", "/dev/zero", "/dev/null", "/etc/hostname", ".", "job.inp", "loop")
SWEPT = "*PARAMETER\nload = 1.\n" + strip_deck(2, 1).replace("-1.", "-<load>")
Words = list[str]


def linked(rng: random.Random, folder: Path) -> list[Words]:
    """Links, pipes and folders under the names of a job's files."""
    (folder / "job.inp").write_text(strip_deck(2, 1))
    for _ in range(rng.choice((1, 1, 2, 4))):
        ending = rng.choice(WRITTEN)
        name = rng.choice(
            (f"job.{ending}", f".job.{ending}.next", ".job.lock", f"job.step-1.{ending}")
        )
        odd(rng, folder / name)
    every = ["--checkpoint-every", "1", "--format", rng.choice(("vtkhdf", "npz", "frd", "pvd"))]
    found = [["run", "job.inp", "-q", "--threads", "1", *every]]
    if rng.random() < 0.3:
        found.append(["resume", "job.inp", "-q"])
    if rng.random() < 0.2:
        found.append(["report", "job"])
    return found


def odd(rng: random.Random, path: Path) -> None:
    """A link, a pipe, a folder, an unreadable or an empty file."""
    if path.exists() or path.is_symlink():
        return
    how = rng.randrange(6)
    if how < 3:
        path.symlink_to(rng.choice(TARGETS))
    elif how == 3:
        os.mkfifo(path)
    elif how == 4:
        path.mkdir()
    else:
        path.write_bytes(rng.randbytes(rng.choice((0, 1, 100, 5000))))


def included(rng: random.Random, folder: Path) -> list[Words]:
    """A deck with one to three includes, each of them odd or sound."""
    lines = strip_deck(2, 1).splitlines(keepends=True)
    for k in range(rng.randint(1, 3)):
        at = rng.randrange(len(lines))
        name = rng.choice(
            (f"part{k}.inc", f"part{k}.inc", "../beyond", "/etc/passwd", "job.inp", ".")
        )
        path = folder / name
        if rng.random() < 0.4 and name.endswith(".inc"):
            path.write_text("".join(lines[at : at + 3]))
            lines[at : at + 3] = []
        elif name.endswith(".inc"):
            odd(rng, path)
        lines.insert(at, f"*INCLUDE, INPUT={name}\n")
    (folder / "job.inp").write_text("".join(lines))
    return [[rng.choice(("run", "check", "info")), "job.inp", "-q"]]


#: First bytes of files of other programs.
HEADS = (
    *(b"\x89PNG\r\n\x1a\n", b"PK\x03\x04", b"\x1f\x8b\x08", b"\x7fELF", b"%PDF-1.7", b"GIF89a"),
    *(b"\x89HDF\r\n\x1a\n", b"<?xml version='1.0'?>", b'{"a": ', b"\x93NUMPY", b"    1C"),
    *(b"$MeshFormat\n4.1 0 8\n", b"    -1\n  2411\n", b"  0\nSECTION\n", b"ISO-10303-21;\n"),
    *(b"\xff\xfe", b"\xef\xbb\xbf"),
)


def foreign(rng: random.Random, folder: Path) -> list[Words]:
    """A file of another kind under the ending of one that is read."""
    name = f"job.{rng.choice(READ)}"
    how = rng.randrange(3)
    if how == 0:
        data = rng.choice(HEADS) + rng.randbytes(rng.choice((0, 10, 1000, 20_000)))
    elif how == 1:
        data = rng.choice(FILES)
    else:
        one, two = rng.choice(FILES), rng.choice(FILES)
        data = one[: rng.randrange(len(one) + 1)] + two[rng.randrange(len(two) + 1) :]
    (folder / name).write_bytes(data)
    words = rng.choice(
        [
            *(["info", name], ["convert", name, "out.inp"], ["convert", name, "out.vtu"]),
            *(["plot", name], ["report", name], ["resume", "job"], ["run", name, "-q"]),
            *(["mesh", name], ["check", name]),
        ]
    )
    return [words]


def swept(rng: random.Random, folder: Path) -> list[Words]:
    """A store of a sweep that was damaged, and the sweep again."""
    (folder / "job.inp").write_text(SWEPT)
    words = ["sweep", "job.inp", "-p", "load=1,2", "-m", "last(U2@CLAMP)", "-o", "t.csv"]
    words += ["--workers", "1", "-q"]
    data = bytearray(ROWS)
    for _ in range(rng.choice((1, 1, 3))):
        how = rng.randrange(4)
        at = rng.randrange(len(data) + 1)
        if how == 0:
            del data[at:]
        elif how == 1 and data:
            data[at % len(data)] = rng.randrange(256)
        elif how == 2:
            data[at:at] = rng.choice((b"NaN", b"\n", b"{}\n", b"[" * 5000, rng.randbytes(20)))
        else:
            data += bytes(data[at:])
    (folder / "t.jsonl").write_bytes(bytes(data))
    return [words]


#: Whole files of a run and of a sweep, made once by :func:`prepare`.
FILES: list[bytes] = []
ROWS = b""


def prepare(folder: Path) -> None:
    """Make the files that others are made of."""
    global ROWS
    _fresh(folder)
    (folder / "job.inp").write_text(strip_deck(2, 1))
    (folder / "swept.inp").write_text(SWEPT)

    def work() -> int:
        os.chdir(folder)
        every = ["--checkpoint-every", "1", "--format", "vtkhdf", "--format", "npz"]
        command("run", "job.inp", "-q", "--threads", "1", *every, "--format", "frd")
        words = ["-p", "load=1,2", "-m", "last(U2@CLAMP)", "-o", "t.csv", "--workers", "1", "-q"]
        return command("sweep", "swept.inp", *words)

    code, _, said = forked(work, folder.parent / "log")
    if code:
        raise RuntimeError(said)
    ROWS = (folder / "t.jsonl").read_bytes()
    FILES[:] = [
        p.read_bytes() for p in sorted(folder.iterdir()) if p.is_file() and p.stat().st_size
    ]


def _fresh(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)


KINDS: dict[str, Callable[[random.Random, Path], list[Words]]] = {
    "links and pipes": linked,
    "includes": included,
    "foreign files": foreign,
    "stores of sweeps": swept,
}


def run(count: int, seed: int, base: Path, finds: Path) -> Counter[str]:
    """Counts of ``kind: outcome``; folders that failed are kept in `finds`."""
    outcomes: Counter[str] = Counter()
    prepare(base / "whole")
    folder, beyond = base / "world" / "received", base / "world" / "beyond"
    for number in range(count):
        rng = random.Random(f"{seed} {number}")
        _fresh(folder)
        beyond.write_text("untouched")
        kind = rng.choice(list(KINDS))
        words = KINDS[kind](rng, folder)
        left = rng.choice((0, 0, 0, rng.randrange(1, 400)))
        if left:
            kind += ", little memory"
        for line in words:
            outcome = _one(line, folder, left, base / "log")
            if beyond.read_text() != "untouched" or {p.name for p in beyond.parent.iterdir()} != {
                "beyond", "received",
            }:  # fmt: skip
                outcome = "failure: outside of the folder"
            outcomes[f"{kind}: {outcome}"] += 1
            if not outcome.startswith("exit "):
                kept = finds / f"folder-{seed}-{number}"
                kept.mkdir(parents=True, exist_ok=True)
                (kept / "outcome.txt").write_text(f"{line}\n{left} MB\n{outcome}\n")
                break
    return outcomes


def _one(words: Words, folder: Path, left: int, log: Path) -> str:
    """Outcome of a command in a folder, with so many MB of addresses left if not 0."""

    def work() -> int:
        os.chdir(folder)
        now = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        size = now + (left << 20) if left else 8 << 30
        resource.setrlimit(resource.RLIMIT_AS, (size, size))
        return command(*words)

    code, _, said = forked(work, log, cpu=30)
    if code == -1000:
        return "hang"
    if code < 0:
        return f"crash: signal {-code}"
    if "Traceback" in said or code == 70 or "internal error" in said:
        return "traceback: " + said.strip().splitlines()[-1][:100]
    if code not in CODES:
        return f"wrong exit code {code}"
    if len(said) > LOG:
        return "endless log"
    if code and not said.strip():
        return f"exit {code} without a message: wrong"
    if code == 0 and words[0] == "run" and (folder / "job.vtkhdf").is_file():
        try:
            if fault := sound_results(folder, "job"):
                return fault
        except Exception as error:
            return f"broken results behind exit 0: {error!r:.80}"
    return f"exit {code}"
