"""The core beside other users of the process: signal handlers, forks, threads."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

import corota as ct

MODEL = """
import corota as ct

def tip(threads, load=1e-3, n=20):
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, n, n // 3))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=-load, per_node=True)
    return float(ct.solve(model, ct.Static(), threads=threads).frames[-1].U.min())
"""


def run(code: str, seconds: float = 60.0) -> str:
    """Standard output of a program in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", MODEL + code],
        capture_output=True,
        text=True,
        timeout=seconds,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("name", ["SIGTERM", "SIGABRT"])
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ordering_leaves_the_signal_handlers_of_the_process(name: str) -> None:
    """Each signal finds the handler that was set.

    One signal comes from within the run, between the ordering of two models.
    """
    code = f"""
import os, signal
count = []
signal.signal(signal.{name}, lambda *a: count.append(1))
for _ in range(3):
    tip(1)
    os.kill(os.getpid(), signal.{name})
print(len(count))
"""
    assert run(code).split() == ["3"]


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_signal_while_another_thread_orders_reaches_its_handler() -> None:
    code = """
import os, signal, threading, time
count = []
signal.signal(signal.SIGTERM, lambda *a: count.append(1))
found = []
worker = threading.Thread(target=lambda: found.append(tip(1, n=120)))
worker.start()
sent = 0
while worker.is_alive():
    os.kill(os.getpid(), signal.SIGTERM)
    sent += 1
    time.sleep(0.02)
worker.join()
print(sent > 3, len(count) >= 1, found[0] < 0.0)
"""
    assert run(code).split() == ["True", "True", "True"]


@pytest.mark.skipif(not hasattr(sys, "getswitchinterval") or sys.platform == "win32", reason="fork")
@pytest.mark.parametrize("threads", [1, 2])
def test_children_of_a_fork_solve_after_their_parent_has(threads: int) -> None:
    """A forked child has none of the threads of its parent's pools."""
    code = f"""
import multiprocessing as mp, warnings
warnings.simplefilter("ignore")
own = tip({threads}, n=60)
with mp.get_context("fork").Pool(2) as pool:
    found = pool.starmap_async(tip, [({threads}, 1e-3, 60)] * 3).get(timeout=50)
print(all(value == own for value in found))
"""
    assert run(code).split() == ["True"]


def test_solving_in_several_threads_of_one_process_gives_the_same_bits() -> None:
    """Nothing in the core is global and mutable but locks and pools."""

    def tip(load: float) -> float:
        model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 20, 4))
        model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
        model.fix("left")
        model.force("right", y=-load, per_node=True)
        return float(ct.solve(model, ct.Static(increments=3), threads=2).frames[-1].U.min())

    loads = [1e-3 * (1 + k) for k in range(6)]
    alone = [tip(load) for load in loads]
    with ThreadPoolExecutor(3) as pool:
        assert list(pool.map(tip, loads)) == alone


def test_more_threads_than_make_sense_are_capped() -> None:
    """A hundred thousand threads are not started; a note says how many are."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=-1e-3, per_node=True)
    results = ct.solve(model, ct.Static(), threads=100_000)
    assert results.info["threads"] <= 1024
    assert any("threads" in note for note in results.notes)
