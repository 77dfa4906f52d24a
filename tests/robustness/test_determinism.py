"""One program gives the same bits on any number of threads, in any process, place and language."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec

import pytest

import corota as ct
from benchmarks.campaigns.same_bits import folder_differences, frame_differences
from benchmarks.corpora.restart_cases import DECKS, MODELS

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


def block(steps, material=None):
    """A plate of some thousand dofs, so that threads have something to do."""
    model = ct.Model(ct.mesh.rectangle(3.0, 1.0, nx=60, ny=20))
    own = material or ct.Mises(E=1000.0, nu=0.3, yield_stress=5.0, isotropic=50.0, rho=1.0)
    model.section("all", element="Q4I", material=own)
    model.fix("left")
    model.force("right", y=-0.2)
    model.steps = steps
    return model


CASES = {
    "plastic": lambda: block([ct.Static(increments=3)]),
    "motion": lambda: block([ct.Dynamic(period=0.5, increments=4)]),
    "explicit": lambda: block([ct.Dynamic(period=0.05, scheme="central_difference")]),
    "friction": MODELS["bump, friction"],
    "branch": MODELS["branch"],
    "frequencies": lambda: block([ct.Frequency(modes=3)], ct.Elastic(E=1e3, nu=0.3, rho=1.0)),
}


@pytest.mark.parametrize("name", CASES)
def test_any_number_of_threads_gives_the_same_bits(name):
    alone = ct.solve(CASES[name](), threads=1)
    for threads in (2, 3, 4, 8):
        other = ct.solve(CASES[name](), threads=threads)
        assert len(alone.frames) == len(other.frames)
        for a, b in zip(alone.frames, other.frames, strict=True):
            assert not frame_differences(a, b), threads


def test_surroundings_do_not_matter(tmp_path):
    """Language, time zone, hash seed, threads of BLAS and folder, through the command."""
    surroundings = [
        {"LC_ALL": "C", "TZ": "UTC", "PYTHONHASHSEED": "0"},
        {"LC_ALL": "de_DE.UTF-8", "LANG": "tr_TR.UTF-8", "TZ": "Asia/Kathmandu"}
        | {"PYTHONHASHSEED": "4711", "PYTHONOPTIMIZE": "1", "OPENBLAS_NUM_THREADS": "3"},
        {"PYTHONHASHSEED": "1", "PYTHONUTF8": "0", "LC_ALL": "POSIX"},
    ]
    runs = []
    for number, more in enumerate(surroundings):
        folder = tmp_path / ("x" * 40 * number + f" {number} ü")
        folder.mkdir()
        (folder / "job.inp").write_text(DECKS["contact, friction"]())
        runs.append(
            subprocess.Popen(
                [sys.executable, "-m", "corota", "run", "job.inp", "-q", "-o", "out"],
                cwd=folder,
                env=os.environ | more,
            )
        )
    assert [run.wait(120) for run in runs] == [0, 0, 0]
    first, *others = [folder / "out" for folder in sorted(tmp_path.iterdir())]
    for other in others:
        assert folder_differences(first, other) == []


SCRIPT = """
import sys, threading, warnings
warnings.simplefilter("ignore")
import corota as ct

def tip(load, threads=2):
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 40, 8))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=-load, per_node=True)
    return float(ct.solve(model, ct.Static(), threads=threads).frames[-1].U.min())

LOADS = [1e-4 * (1 + k) for k in range(4)]

def main(way):
    alone = [tip(load) for load in LOADS]
    if way in ("fork", "spawn", "forkserver"):
        import multiprocessing
        with multiprocessing.get_context(way).Pool(2) as pool:
            found = pool.map_async(tip, LOADS).get(90)
    elif way.startswith("futures"):
        import multiprocessing
        from concurrent.futures import ProcessPoolExecutor
        context = multiprocessing.get_context(way.split()[1])
        with ProcessPoolExecutor(2, context) as pool:
            found = list(pool.map(tip, LOADS, timeout=90))
    elif way == "joblib":
        import joblib
        found = joblib.Parallel(2, timeout=90)(joblib.delayed(tip)(load) for load in LOADS)
    elif way == "joblib threads":
        import joblib
        found = joblib.Parallel(2, "threading")(joblib.delayed(tip)(load) for load in LOADS)
    elif way == "threads":
        found = [0.0] * len(LOADS)
        def work(k):
            found[k] = tip(LOADS[k])
        each = [threading.Thread(target=work, args=(k,)) for k in range(len(LOADS))]
        [t.start() for t in each]; [t.join(90) for t in each]
    else:  # children are forked while another thread of the parent solves
        import multiprocessing
        stop = threading.Event()
        def busy():
            while not stop.is_set():
                tip(1e-4)
        thread = threading.Thread(target=busy); thread.start()
        try:
            with multiprocessing.get_context("fork").Pool(2, maxtasksperchild=1) as pool:
                found = pool.map_async(tip, LOADS, chunksize=1).get(90)
        finally:
            stop.set(); thread.join()
    print(found == alone)

if __name__ == "__main__":
    main(sys.argv[1])
"""

WAYS = ["threads", "spawn", "forkserver", "fork", "fork beside a solve"]
WAYS += ["futures fork", "futures spawn", "joblib", "joblib threads"]


@pytest.mark.skipif(sys.platform == "win32", reason="fork")
@pytest.mark.parametrize("way", WAYS)
def test_solving_in_workers_is_right_and_never_hangs(way, tmp_path):
    if way.startswith("joblib") and find_spec("joblib") is None:
        pytest.skip("joblib is not installed")
    script = tmp_path / "work.py"
    script.write_text(SCRIPT)
    done = subprocess.run(
        [sys.executable, str(script), way], capture_output=True, text=True, timeout=110, check=False
    )
    assert done.stdout.split() == ["True"], done.stdout + done.stderr
