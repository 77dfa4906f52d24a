"""Six decks under sixty limits of the address space, from the shell and from Python.

    python -m benchmarks memory_limits [--limits 60] [--only NAME] [--threads 1 2 8] [--fresh]

Each run is a process that sets its limit before it imports anything, from 200 MB to 2 GB. It has to
end with exit code 0, or 5 and a message (``ResourceError`` in Python), never by a signal. What had
converged before is in its result file, equal to the bit to that of a run without a limit. The
outcomes are kept in ``build/memory_limits.jsonl``: a campaign that was ended goes on where it was.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

import corota as ct
from benchmarks.campaigns.campaign_store import CampaignStore
from benchmarks.common import machine, table
from benchmarks.corpora.restart_cases import DECKS

#: Seconds that a run may take: of the processor, and by the clock of a busy machine.
LIMIT, CLOCK = 60, 900
JOBS = {
    "plastic": DECKS["isotropic hardening"],
    "contact": DECKS["contact, friction"],
    "path": DECKS["path of a frame"],
    "explicit": DECKS["motion, explicit"],
    "modal": DECKS["modal motion"],
    "sweep": lambda: (
        "*PARAMETER\nload = .8\n" + DECKS["large rotations"]().replace("-.8", "-<load>")
    ),
}
#: The same from a script: exit code 5 for the typed error, 1 for any other.
SCRIPT = """
import resource, sys
limit, threads, job = int(sys.argv[1]) << 20, int(sys.argv[2]), sys.argv[3]
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
try:
    import corota as ct
    from corota.io.job import JobFiles
    from numpy.linalg import norm
    import h5py, scipy.sparse
except (ImportError, MemoryError, OSError, SystemError) as error:
    sys.stderr.write(f"error: Python does not start: {error}")
    sys.exit(5)
try:
    if job == "sweep":
        design, store = {"load": [.2, .4, .8]}, "rows.jsonl"
        found = ct.sweep("job.inp", design, "last(U2@NA)", workers=1, store=store)
        wrong = {str(e) for e in found["error"] if str(e)}
        sys.stderr.write(f"error: {wrong}" if wrong else "")
        sys.exit(5 if any("memory" in e for e in wrong) else 1 if wrong else 0)
    files = JobFiles(".", "job", checkpoint_every=1)
    ct.solve(ct.read("job.inp"), threads=threads, observers=[files])
except ct.ResourceError as error:
    sys.stderr.write(f"error: {error}")
    sys.exit(5)
"""


def command(way: str, job: str, limit: int, threads: int) -> list[str]:
    """The process of a run; `limit` in MB."""
    if way == "Python":
        return [sys.executable, "-W", "ignore", "-c", SCRIPT, str(limit), str(threads), job]
    program = [sys.executable, "-m", "corota"]
    if job == "sweep":
        program += [
            "sweep",
            "job.inp",
            "-p",
            "load=.2,.4,.8",
            "-m",
            "last(U2@NA)",
            "-o",
            "rows.csv",
        ]
        program += ["--workers", str(threads)]
    else:
        program += ["run", "job.inp", "--checkpoint-every", "1", "--threads", str(threads)]
    line = f"ulimit -v {limit << 10}; exec " + " ".join(f"'{w}'" for w in [*program, "-q"])
    return ["sh", "-c", line]


def run(way: str, job: str, limit: int, threads: int, folder: Path, whole: Path) -> str:
    """Outcome of a run: ``exit 0``, ``exit 5``, or what is wrong with it."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "job.inp").write_text(JOBS[job]())
    surroundings = {k: v for k, v in os.environ.items() if k != "OPENBLAS_NUM_THREADS"}

    def bounded() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 5))

    try:
        done = subprocess.run(
            command(way, job, limit, threads),
            cwd=folder, env=surroundings, capture_output=True, text=True, timeout=CLOCK,
            check=False, preexec_fn=bounded,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return "hang, waiting"
    said = done.stderr.strip()
    code = done.returncode if done.returncode < 128 else 128 - done.returncode
    # The signal at the limit of processor time ends a run with 7; what does not heed it is killed.
    if code in (7, -signal.SIGXCPU, -signal.SIGKILL):
        return "hang, working"
    if code < 0:
        return f"signal {-code}: {said[:100]}"
    if code not in (0, 5):
        return f"wrong exit {code}: {said[-200:]}"
    if "Traceback" in said:
        return f"traceback with exit {code}: {said[-200:]}"
    if code == 5 and "error" not in said:
        return f"exit 5 without a message: {said[-100:]}"
    lost = lost_rows(folder, whole, code) if job == "sweep" else lost_frames(folder, whole, code)
    return lost or f"exit {code}"


def lost_rows(folder: Path, whole: Path, code: int) -> str:
    """What a sweep lost: all of its rows that are stored are right, and with exit 0 all are."""
    found, right = (_rows(f) for f in (folder, whole))
    if any(row not in right for row in found):
        return "rows of the sweep differ"
    return "rows are missing behind exit 0" if code == 0 and len(found) != len(right) else ""


def _rows(folder: Path) -> list[object]:
    rows = []
    for path in [*folder.glob("*.jsonl")]:
        for line in path.read_text().splitlines():
            row = json.loads(line)
            if "values" in row and not row.get("error"):
                rows.append([row["parameters"], row["values"]])
    return rows


def lost_frames(folder: Path, whole: Path, code: int) -> str:
    """Increments that a run reported and that are not in its result file."""
    rows = folder / "job.sta"
    reported = 0
    if rows.exists():
        reported = sum(line[:1] == " " and line.split()[:1][0].isdigit() for line in _lines(rows))
    path = folder / "job.vtkhdf"
    if not path.exists():
        return f"{reported} increments, no results" if reported or code == 0 else ""
    with ct.read_results(path) as mine, ct.read_results(whole / "job.vtkhdf") as right:
        if len(mine.frames) < reported:
            return f"{reported} increments, {len(mine.frames)} frames"
        if code == 0 and len(mine.frames) != len(right.frames):
            return "frames are missing behind exit 0"
        for a, b in zip(mine.frames, right.frames, strict=False):
            if not np.array_equal(a.U, b.U) or not np.array_equal(a.RF, b.RF):
                return "frames differ from those without a limit"
    return ""


def _lines(path: Path) -> list[str]:
    return [line for line in path.read_text().splitlines() if line.strip()]


def cases(
    limits: int, threads: list[int], only: str, both: bool
) -> list[tuple[str, str, int, int]]:
    """Way, job, limit [MB] and threads of all runs."""
    sizes = np.unique(np.geomspace(200, 2000, limits).round().astype(int)).tolist()
    ways, found = ("shell", "Python"), []
    # Coarse first: a campaign that is ended has seen the whole range.
    for k in sorted(range(len(sizes)), key=lambda k: int(f"{k:06b}"[::-1], 2)):
        size = sizes[k]
        for j, job in enumerate(JOBS):
            for i, count in enumerate(threads):
                taken = ways if both else (ways[(k + j + i) % 2],)
                found += [(w, job, size, count) for w in taken if only in f"{w} {job}"]
    return found


def main() -> int:
    """Run what is not in the store, and count."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--limits", type=int, default=60)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2, 8])
    parser.add_argument("--only", default="", help="ways and jobs whose name holds this")
    parser.add_argument("--both", action="store_true", help="from shell and Python, not in turn")
    parser.add_argument("--fresh", action="store_true", help="forget the store")
    args = parser.parse_args()
    done = CampaignStore("memory_limits", args.fresh)
    begin, wanted = time.perf_counter(), cases(args.limits, args.threads, args.only, args.both)
    with tempfile.TemporaryDirectory(prefix="corota-memory-") as name:
        base = Path(name)
        for job in {case[1] for case in wanted if case not in done}:
            outcome = run("shell", job, 1 << 20, 1, base / job, base / job)
            if outcome != "exit 0":
                raise SystemExit(f"{job} does not run without a limit: {outcome}")
        for case in wanted:
            if case in done:
                continue
            way, job, limit, count = case
            done[case] = run(way, job, limit, count, base / "run", base / job)
            if not done[case].startswith("exit "):
                sys.stderr.write(f"{case}: {done[case]}\n")
    counts = Counter(
        (way, job, done[case].partition(":")[0]) for case in wanted for way, job in [case[:2]]
    )
    bad = sum(n for (*_, outcome), n in counts.items() if not outcome.startswith("exit "))
    kinds = sorted({k[2] for k in counts})
    names = list(dict.fromkeys(k[:2] for k in counts))
    rows = [[f"{w}, {j}", *(counts[w, j, kind] for kind in kinds)] for w, j in names]
    rows.append(["all", *(sum(counts[w, j, kind] for w, j in names) for kind in kinds)])
    print(f"\n### Memory limits\n\n{machine()}; {time.perf_counter() - begin:.0f} s\n")
    print(table(["from, deck", *kinds], rows))
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
