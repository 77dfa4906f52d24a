"""Sweeps on other executors, and sweeps that were killed: always the table of one process."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

import corota as ct

ROWS = [{"length": 5.0 + i} for i in range(12)]
MEASURES = {"F": "last(RF1@right)", "S": "max(MISES)"}
#: As users write it: build function at the top, the sweep under the guard.
SCRIPT = """\
import json
import sys
import time
from contextlib import nullcontext

import corota as ct


def strip(length):
    time.sleep(PAUSE)
    model = ct.Model(ct.mesh.rectangle(length, 1.0, nx=4, ny=1))
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.fix("right", x=0.01 * length)
    return model, ct.Static(increments=2)


def executor():
    if sys.argv[1] == "mpi":
        from mpi4py.futures import MPIPoolExecutor

        return MPIPoolExecutor()
    return nullcontext()


if __name__ == "__main__":
    rows = [{"length": 5.0 + i} for i in range(12)]
    with executor() as pool:
        workers = None if pool else int(sys.argv[2])
        found = ct.sweep(
            strip,
            rows,
            {"F": "last(RF1@right)", "S": "max(MISES)"},
            executor=pool,
            workers=workers,
            store="rows.jsonl",
        )
    print(json.dumps({name: found[name].tolist() for name in ("length", "F", "S")}))
"""


def strip(length: float) -> tuple[ct.Model, ct.Static]:
    model = ct.Model(ct.mesh.rectangle(length, 1.0, nx=4, ny=1))
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.fix("right", x=0.01 * length)
    return model, ct.Static(increments=2)


@pytest.fixture(scope="module")
def alone() -> dict[str, list[float]]:
    """The table of one process."""
    found = ct.sweep(strip, ROWS, MEASURES, workers=1)
    return {name: found[name].tolist() for name in ("length", "F", "S")}


def script(folder: Path, pause: float) -> Path:
    path = folder / "sweep.py"
    path.write_text(SCRIPT.replace("PAUSE", str(pause)), encoding="utf-8")
    return path


def table(command: list[Any], folder: Path) -> dict[str, list[float]]:
    """What the script prints."""
    run = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    found: dict[str, list[float]] = json.loads(run.stdout.splitlines()[-1])
    return found


def lines(store: Path) -> int:
    return len(store.read_text(encoding="utf-8").splitlines()) if store.exists() else 0


def workers_of(pid: int) -> list[int]:
    """Processes that a process started."""
    found = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False
    )
    return [int(word) for word in found.stdout.split()]


def runs(pid: int) -> bool:
    """Whether a process is there and no zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="ascii").split()[2] != "Z"
    except OSError:
        return False


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.parametrize("workers", [1, 2])
def test_a_killed_sweep_goes_on(
    alone: dict[str, list[float]], tmp_path: Path, workers: int
) -> None:
    path, store = script(tmp_path, 0.2), tmp_path / "rows.jsonl"
    command = [sys.executable, path, "processes", workers]
    running = subprocess.Popen([str(w) for w in command], cwd=tmp_path, stdout=subprocess.DEVNULL)
    deadline = time.monotonic() + 120.0
    while lines(store) < 4 and time.monotonic() < deadline:
        time.sleep(0.02)
    children = workers_of(running.pid)
    running.kill()
    running.wait()
    kept = lines(store)
    assert 4 <= kept < len(ROWS)
    assert table(command, tmp_path) == alone
    assert lines(store) == len(ROWS), "rows that were kept do not run again"
    while any(map(runs, children)) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert not any(map(runs, children)), "workers end with the sweep"


def open_mpi() -> bool:
    """Whether mpi4py and the starter of Open MPI are there, whose options the test uses."""
    starter = shutil.which("mpiexec")
    if starter is None or find_spec("mpi4py") is None:
        return False
    said = subprocess.run([starter, "--version"], capture_output=True, text=True, check=False)
    return "Open MPI" in said.stdout or "OpenRTE" in said.stdout


@pytest.mark.slow
@pytest.mark.skipif(not open_mpi(), reason="needs mpi4py and Open MPI")
def test_mpi_gives_the_same_table(alone: dict[str, list[float]], tmp_path: Path) -> None:
    command = ["mpiexec", "--oversubscribe"]
    if os.geteuid() == 0:
        command.append("--allow-run-as-root")
    command += [
        "-n",
        "3",
        sys.executable,
        "-m",
        "mpi4py.futures",
        str(script(tmp_path, 0.0)),
        "mpi",
    ]
    assert table(command, tmp_path) == alone


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_dask_gives_the_same_table(alone: dict[str, list[float]]) -> None:
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        found = ct.sweep(strip, ROWS, MEASURES, executor=client.get_executor())
    assert {name: found[name].tolist() for name in alone} == alone
