"""Whole runs of the command in processes of their own: exit codes, messages, results."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import random
import resource
import select
import shutil
import signal
import sys
import time
import warnings
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.campaigns.fault_readers import SEEDS, grammar, mutate

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from corota.model.model import Model

#: Seconds that one run may take: of the processor, and by the clock of a busy machine. One deck of
#: two elements tries its contact for 25 s before it is given up.
LIMIT, CLOCK = 60, 240.0
#: Exit codes that a run may end with.
CODES = {0, 2, 3, 4, 5, 6}
#: Largest output [byte].
LOG = 1_000_000
#: Free residual over the largest internal force of what is called converged.
EQUILIBRIUM = 1e-7


def forked(
    work: Callable[[], int], log: Path, limit: float = CLOCK, cpu: int = LIMIT
) -> tuple[int, float, str]:
    """Run in a forked process with its output in a file.

    Parameters
    ----------
    work : callable
        Returns the exit code.
    log : Path
    limit, cpu : float, int
        Most seconds by the clock and of the processor.

    Returns
    -------
    code : int
        Exit code; -n after signal n, -1000 after the time limit.
    seconds : float
    said : str
    """
    start = time.perf_counter()
    ready, done = os.pipe()
    child = os.fork()
    if child == 0:
        code = 70
        try:
            os.close(ready)
            target = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            os.dup2(target, 1)
            os.dup2(target, 2)
            resource.setrlimit(resource.RLIMIT_CPU, (cpu, cpu + 1))
            code = work()
        except BaseException as error:
            os.write(2, f"Traceback: {type(error).__name__}: {error}".encode())
        finally:
            sys.stdout.flush()
            os._exit(code & 0xFF)
    os.close(done)
    timely = bool(select.select([ready], [], [], limit)[0])
    os.close(ready)
    if not timely:
        os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    seconds = time.perf_counter() - start
    code = os.WEXITSTATUS(status) if os.WIFEXITED(status) else -os.WTERMSIG(status)
    with open(log, "rb") as file:
        said = file.read(2 * LOG).decode("utf-8", "replace")
    late = not timely or code in (-signal.SIGXCPU, -signal.SIGKILL)
    return (-1000 if late else code), seconds, said


def warm_up() -> None:
    """Import what a run imports, once and before the forks."""
    import h5py
    import scipy.sparse.linalg

    import corota.analysis.procedures.dynamic
    import corota.analysis.procedures.frequency
    import corota.analysis.run
    import corota.check
    import corota.cli.run
    import corota.io.job
    import corota.io.result_reader

    assert h5py
    assert scipy
    assert corota


def command(*arguments: str) -> int:
    """Run ``corota`` in this process."""
    from corota.cli import main

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return main(list(arguments))


def judged(code: int, said: str, folder: Path, name: str) -> str:
    """Name of the outcome of a run: ``exit N``, or what is wrong with it."""
    if code == -1000:
        rows = folder / f"{name}.sta"
        count = rows.read_text().count("\n") if rows.exists() else 0
        return "long, and advancing" if count > 200 else "hang"
    if code < 0:
        return f"crash: signal {-code}"
    if "Traceback" in said or code == 70:
        return "traceback: " + said.strip().splitlines()[0][:100]
    if code not in CODES:
        return f"wrong exit code {code}"
    if len(said) > LOG:
        return "endless log"
    if code != 0 and "error" not in said:
        return f"exit {code} without a message"
    if code == 0 and "corota: error" in said:
        return "an error with exit 0"
    if code == 0:
        try:
            fault = sound_results(folder, name)
        except Exception as error:
            fault = f"broken results behind exit 0: {type(error).__name__}: {str(error)[-60:]}"
        if fault:
            return fault
    return f"exit {code}"


def sound_results(folder: Path, name: str) -> str:
    """Why results behind exit 0 should not be there, or an empty text."""
    from corota.io.result_reader import read_results

    path = folder / f"{name}.vtkhdf"
    if not path.exists():
        return "silent success: exit 0 without results"
    with read_results(path) as results:
        if len(results.frames) == 0:
            return "silent success: exit 0 without frames"
        for frame in results.frames:
            for values in (frame.U, frame.UR, frame.RF, frame.F):
                if not np.isfinite(values).all():
                    return "NaN behind exit 0"
            for block in frame.fields:
                for what, values in block.values.items():
                    if not np.isfinite(values).all():
                        return f"NaN behind exit 0: {what}"
            for averages in (frame.averages, frame.cell_averages):
                for what, values in averages.items():
                    if not np.isfinite(values).all():
                        return f"NaN behind exit 0: {what}"
    for ending in ("dat", "csv", "sta"):
        file = folder / f"{name}.{ending}"
        if file.exists():
            words = set(file.read_text(errors="replace").lower().replace(",", " ").split())
            if words & {"nan", "inf", "-inf"}:
                return f"NaN behind exit 0: .{ending}"
    return ""


def run_deck(raw: bytes, folder: Path, arguments: tuple[str, ...] = ()) -> tuple[int, str]:
    """Exit code and outcome of ``corota run`` on a deck, in an emptied folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "deck.inp").write_bytes(raw)

    def work() -> int:
        os.chdir(folder)
        # A run that asks for more than this is refused memory, not the machine.
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        return command("run", "deck.inp", "-q", "--threads", "1", *arguments)

    code, _, said = forked(work, folder / "log")
    return code, judged(code, said, folder, "deck")


def decks(count: int, seed: int) -> Iterator[tuple[str, bytes]]:
    """Source and bytes of `count` decks that may well run."""
    rng = random.Random(seed)
    for _ in range(count):
        if rng.random() < 0.5:
            yield "mutated decks", mutate.mutate(rng.choice(SEEDS), rng)
        else:
            yield "decks of the grammar", grammar.deck(rng, rng.choice((0.0, 0.05, 0.3)))


def run_decks(count: int, seed: int, folder: Path, finds: Path) -> Counter[str]:
    """Whole runs of random decks; counts of ``source: outcome``."""
    outcomes: Counter[str] = Counter()
    kept: set[str] = set()
    for number, (source, raw) in enumerate(decks(count, seed)):
        _, outcome = run_deck(raw, folder / "run")
        outcomes[f"{source}: {outcome}"] += 1
        if not outcome.startswith("exit ") and outcome not in kept:
            kept.add(outcome)
            finds.mkdir(parents=True, exist_ok=True)
            (finds / f"run-{seed}-{number}.inp").write_bytes(raw)
            (finds / f"run-{seed}-{number}.txt").write_text(outcome + "\n")
    return outcomes


def random_model(seed: int) -> tuple[Model, Any]:
    """One of twenty clamped strips under random dead forces, 0.1 to 10 times what bends it well.

    Returns
    -------
    model : Model
    loads : ndarray, shape (n_nodes, 3)
    """
    import corota as ct
    from corota.verification.models import DRILLING, ELEMENTS, boundary, cell

    fixed, rng = np.random.default_rng(seed % 20), np.random.default_rng(seed)
    element = ELEMENTS[seed % 20 % len(ELEMENTS)]
    mesh = ct.mesh.rectangle(5.0, 1.0, 8, 2, cell(element), "alternate")
    mesh = ct.mesh.distort(mesh, 0.25, seed=int(fixed.integers(1000)))
    model = ct.Model(mesh)
    plastic = seed % 20 >= 14
    material: Any = (
        ct.Mises(E=1000.0, nu=0.3, yield_stress=20.0, isotropic=50.0)
        if plastic
        else ct.Elastic(E=1000.0, nu=0.3)
    )
    # With plastic flow the Green-Lagrange strain is refused.
    second = "logarithmic" if plastic else "green_lagrange"
    strain: Any = ("linear", second, "logarithmic")[seed % 3]
    model.section("all", element=element, material=material, local_strain=strain)
    model.fix("left", rotation=True)
    loads = np.zeros((mesh.n_nodes, 3))
    scale = 10.0 ** rng.uniform(-1.0, 1.0)
    free = np.setdiff1d(boundary(mesh), mesh.node_sets["left"])
    corners = np.intersect1d(free, mesh.cells[0].nodes[:, :3])
    for node in rng.choice(corners, 4, replace=False):
        force = scale * rng.uniform(-3.0, 3.0, 2)
        model.force([int(node)], x=force[0], y=force[1])
        loads[node, :2] += force
        if element in DRILLING:
            moment = scale * rng.uniform(-0.5, 0.5)
            model.force([int(node)], moment=moment)
            loads[node, 2] += moment
    return model, loads


def random_load(seed: int) -> str:
    """Solve a random model; what is called converged must be in equilibrium."""
    import corota as ct

    model, loads = random_model(seed)
    held = np.zeros(model.mesh.n_nodes, bool)
    held[model.mesh.node_sets["left"]] = True
    try:
        results = ct.solve(model, ct.Static(max_increments=60), threads=1, fields=False)
        outcome = "converged"
        if results.frames[-1].factor != 1.0:
            return "silent success: not at the full load"
    except ct.ConvergenceError as error:
        if error.results is None or not str(error).strip():
            return "failure: no reason or no results"
        results, outcome = error.results, "given up with the reason"
    for frame in results.frames[1:]:
        if not (np.isfinite(frame.U).all() and np.isfinite(frame.RF).all()):
            return "NaN in a converged frame"
        # Internal force = reaction + external force; free nodes carry their load only.
        internal = frame.RF + frame.F
        size = max(float(np.abs(internal).max()), 1e-300)
        if np.abs((internal - frame.factor * loads)[~held]).max() > EQUILIBRIUM * size:
            return "silent success: not in equilibrium"
    return outcome


def random_loads(count: int, seed: int, folder: Path) -> Counter[str]:
    """Random loads in forked processes; counts of outcomes."""
    outcomes: Counter[str] = Counter()
    folder.mkdir(parents=True, exist_ok=True)

    def work(number: int) -> Callable[[], int]:
        def inner() -> int:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                print("outcome:", random_load(number))
            return 0

        return inner

    for k in range(count):
        code, _, said = forked(work(seed + k), folder / "log")
        last = said.strip().splitlines()[-1:] or [""]
        if code == 0 and last[0].startswith("outcome: "):
            outcomes[f"random loads: {last[0][9:]}"] += 1
        elif code == -1000:
            outcomes["random loads: hang"] += 1
        else:
            outcomes[f"random loads: failure: exit {code}: {last[0][:80]}"] += 1
    return outcomes


def loose_deck(rng: random.Random) -> tuple[bytes, int]:
    """A strip with too few supports, and how many rigid motions it has left."""
    n, angle = rng.randint(1, 6), rng.uniform(0.0, 3.0)
    c, s = np.cos(angle), np.sin(angle)
    points = [(x, y) for y in (0.0, 1.0) for x in range(n + 1)]
    lines = ["*NODE"]
    lines += [
        f"{k + 1}, {c * x - s * y:.12g}, {s * x + c * y:.12g}" for k, (x, y) in enumerate(points)
    ]
    lines.append(f"*ELEMENT, TYPE={rng.choice(('CPS4', 'CPS4I', 'Q4D'))}, ELSET=E")
    lines += [f"{k + 1}, {k + 1}, {k + 2}, {n + k + 3}, {n + k + 2}" for k in range(n)]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "1000., .3", "*SOLID SECTION, ELSET=E, MATERIAL=M"]
    lines += ["1."]
    held = rng.randint(0, 2)
    free = 3 - held
    supports = []
    if held >= 1:
        supports.append(f"1, {rng.choice((1, 2))}")
    if held == 2:
        supports = ["1, 1, 2"]
    if supports:
        lines += ["*BOUNDARY", *supports]
    nlgeom = rng.choice(("", ", NLGEOM"))
    lines += [f"*STEP{nlgeom}", "*STATIC", "*CLOAD", f"{len(points)}, 2, 1.", "*END STEP", ""]
    return "\n".join(lines).encode(), free


def loose_models(count: int, seed: int, folder: Path) -> Counter[str]:
    """Models with one to three rigid motions left: refused with exit 3 and their number."""
    rng, outcomes = random.Random(seed), Counter[str]()
    for _ in range(count):
        raw, free = loose_deck(rng)
        code, outcome = run_deck(raw, folder / "loose")
        said = (folder / "loose" / "log").read_text(errors="replace")
        if code != 3:
            outcomes[f"loose models: wrong: {outcome}, not 3"] += 1
        elif "node" not in said:
            outcomes["loose models: wrong: no node is named"] += 1
        else:
            outcomes["loose models: exit 3 with a node to hold"] += 1
        checked = str(folder / "loose" / "deck.inp")
        code, _, said = forked(lambda deck=checked: command("check", deck, "-q"), folder / "log")
        right = code == 3 and said.count("a free body: it can") == free
        outcomes[
            "loose models: check counts the motions rightly"
            if right
            else f"loose models: wrong: check ends with {code} and another count than {free}"
        ] += 1
    return outcomes
