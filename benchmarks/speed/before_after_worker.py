"""One build of Corota under observation: what every analysis of a task gives, frame by frame.

:mod:`before_after` starts this in a process for each build and tells it what to do.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import hashlib
import importlib
import io
import json
import os
import pickle
import runpy
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct

ROOT = Path(__file__).resolve().parents[2]
#: Entries of a frame's scalars and of the counters that are times.
CLOCKS = ("seconds", "profile", "threads")


def parts(name: str, value: Any) -> dict[str, Any]:
    """All numbers of an object by a name made of its attributes."""
    if isinstance(value, np.ndarray):
        return {name: value} if value.dtype.kind in "fiubc" else {}
    if isinstance(value, bool | int | float | complex | np.number):
        return {name: np.atleast_1d(np.asarray(value))}
    found: dict[str, Any] = {}
    if isinstance(value, Mapping):
        for key, inner in value.items():
            found |= parts(f"{name}.{key}", inner)
    elif isinstance(value, list | tuple):
        for key, inner in enumerate(value):
            found |= parts(f"{name}[{key}]", inner)
    elif is_dataclass(value) and type(value).__name__ in ("PointFields", "Frame", "Modes"):
        for item in fields(value):
            found |= parts(f"{name}.{item.name}", getattr(value, item.name))
    return found


def summary(frame: Any, whole: bool) -> dict[str, Any]:
    """A frame as a digest of all its bits, sums by name and, if wanted, its arrays."""
    numbers = parts("", frame)
    digest = hashlib.sha1(usedforsecurity=False)
    sums: dict[str, Any] = {}
    for name in sorted(numbers):
        array = np.ascontiguousarray(numbers[name])
        digest.update(name.encode() + array.tobytes())
        size = np.abs(array.astype(complex))
        sums[name] = (float(size.max(initial=0.0)), float(size.mean()) if size.size else 0.0)
    return {
        "digest": digest.hexdigest(),
        "sums": sums,
        "arrays": numbers if whole else {},
        "iterations": getattr(frame, "scalars", {}).get("iterations"),
    }


class Recorder:
    """Keeps what every analysis of this process gives."""

    def __init__(self) -> None:
        self.runs: list[dict[str, Any]] = []
        analysis = importlib.import_module(ct.solve.__module__).Analysis
        run = analysis.run

        def watched(this: Any) -> Any:
            error = ""
            try:
                return run(this)
            except Exception as caught:
                error = f"{type(caught).__name__}: {caught}"
                raise
            finally:
                self.runs.append(self.kept(this.results, error))

        analysis.run = watched

    @staticmethod
    def kept(results: Any, error: str) -> dict[str, Any]:
        """What is compared of results."""
        frames = results.frames
        kept = [summary(f, k == len(frames) - 1) for k, f in enumerate(frames)]
        kept += [summary(m, True) for m in results.modes]
        counts = {k: v for k, v in results.info.items() if k not in CLOCKS}
        return {
            "frames": kept,
            "counts": {k: v for k, v in counts.items() if isinstance(v, int | float)},
            "notes": list(results.notes),
            "critical": [str(point) for point in results.critical_points],
            "error": error,
        }


# -- what is run ---------------------------------------------------------------------------


def catalogue(name: str) -> list[tuple[str, float]]:
    """The values of a problem of the catalog."""
    from corota.verification.catalogue import problems

    return [(v.quantity, float(v.measured)) for v in problems()[name].measure()]


def example(name: str) -> list[tuple[str, float]]:
    """Run an example as its reader does."""
    path = ROOT / "examples" / name
    sys.argv = [str(path)]
    runpy.run_path(str(path), run_name="__main__")
    return []


def deck(name: str) -> list[tuple[str, float]]:
    """Run a deck: a file of the repository, or one of the generated ones by its number."""
    if not name.startswith("#"):
        ct.solve(ct.read(ROOT / name))
        return []
    from benchmarks.corpora.deck_generator import generate

    path = Path("made.inp")
    path.write_text(generate(int(name[1:])).text, encoding="ascii")
    ct.solve(ct.read(path))
    return []


def strip(nx: int, ny: int, element: str, material: Any, thickness: float = 1.0) -> ct.Model:
    """A strip of length 10 and height 1, clamped at the left."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx, ny))
    model.section("all", element=element, material=material, thickness=thickness)
    model.fix("left", rotation=True if element == "Q4D" else None)
    return model


def bending(nx: int, ny: int, element: str) -> tuple[ct.Model, Any]:
    """Large bending of an elastic strip."""
    model = strip(nx, ny, element, ct.Elastic(E=1000.0, nu=0.3))
    model.force(model.mesh.nodes_of("right"), y=0.2 / (ny + 1))
    return model, ct.Static(increments=3)


def yielding(nx: int, ny: int, strain: str) -> tuple[ct.Model, Any]:
    """Stretching beyond yield."""
    law = ct.Mises(E=200000.0, nu=0.3, yield_stress=400.0, isotropic=2000.0)
    model = strip(nx, ny, "Q4I", law)
    model.sections[0].local_strain = strain  # the default was another one once
    model.fix("right", x=0.06, y=0.0)
    return model, ct.Static(increments=4)


def contact(n: int, friction: float) -> tuple[ct.Model, Any]:
    """Two blocks pressed together: problem P3 of the side by side table."""
    from benchmarks.corpora.problems import blocks
    from corota.mesh import Cells

    p = blocks(n, friction=friction)
    cells = [Cells("quad4", p.cells, np.arange(1, len(p.cells) + 1))]
    model = ct.Model(ct.Mesh(p.points, cells))
    model.section("all", element="Q4I", material=ct.Elastic(E=p.young, nu=p.poisson))
    for node, dof, value in zip(p.held_nodes, p.held_dofs, p.held_values, strict=True):
        model.fix([int(node)], **({"x": value, "y": None} if dof == 0 else {"x": None, "y": value}))
    model.contact(edges_of(p.cells, p.slave), edges_of(p.cells, p.master), friction=friction)
    return model, ct.Static(increments=4)


def edges_of(cells: Any, edges: Any) -> Any:
    """Cells and sides of edges given by their nodes."""
    sides = {
        frozenset((int(a), int(b))): (c, s)
        for c, cell in enumerate(cells)
        for s, (a, b) in enumerate(zip(cell, np.roll(cell, -1), strict=True))
    }
    return np.array([sides[frozenset(map(int, edge))] for edge in edges])


def swinging(nx: int, ny: int, element: str, **options: Any) -> tuple[ct.Model, Any]:
    """A strip that a sudden force sets in motion."""
    model = strip(nx, ny, element, ct.Elastic(E=1000.0, nu=0.3, rho=1e-3))
    model.amplitudes["on"] = ct.Amplitude([0.0, 100.0], [1.0, 1.0])
    model.force(model.mesh.nodes_of("right"), y=0.2 / (ny + 1), amplitude="on")
    return model, ct.Dynamic(period=0.08, increments=8, **options)


def rubber(strain: Any, state: Any, plane: str) -> Any:
    """A stiffening elastic law in Python."""
    c = 1000.0 / 0.91 * np.array([[1.0, 0.3, 0.0], [0.3, 1.0, 0.0], [0.0, 0.0, 0.35]])
    square = np.einsum("...i,ij,...j->...", strain, c, strain)
    factor = 1.0 + 0.05 * square
    first = strain @ c
    tangent = factor[..., None, None] * c + 0.1 * first[..., :, None] * first[..., None, :]
    return factor[..., None] * first, tangent, state


def own(element: str, step: Any) -> tuple[ct.Model, Any]:
    """A material in Python."""
    model = strip(10, 2, element, ct.UserMaterial(rubber, rho=1e-3))
    model.force(model.mesh.nodes_of("right"), y=0.05)
    return model, step


def constrained(step: Any) -> tuple[ct.Model, Any]:
    """A strip whose end is a rigid body that is turned."""
    model = strip(20, 2, "Q4I", ct.Elastic(E=1000.0, nu=0.3, rho=1e-3))
    node = int(model.mesh.nodes_of("right")[0])
    model.rigid("right", node)
    model.force([node], y=0.05)
    return model, step


CASES: dict[str, Callable[[], tuple[ct.Model, Any]]] = {
    "Q4I 410": lambda: bending(40, 4, "Q4I"),
    "Q4D 615": lambda: bending(40, 4, "Q4D"),
    "Q4I 41k": lambda: bending(450, 45, "Q4I"),
    "Q4D 41k": lambda: bending(370, 37, "Q4D"),
    "Q4I 250k": lambda: bending(1115, 111, "Q4I"),
    "Q4D 250k": lambda: bending(912, 91, "Q4D"),
    "J2 linear 410": lambda: yielding(40, 4, "linear"),
    "J2 linear 41k": lambda: yielding(450, 45, "linear"),
    "J2 logarithmic 410": lambda: yielding(40, 4, "logarithmic"),
    "J2 logarithmic 41k": lambda: yielding(450, 45, "logarithmic"),
    "P3 contact 740": lambda: contact(8, 0.0),
    "P3 contact": lambda: contact(24, 0.0),
    "P3 friction": lambda: contact(24, 0.3),
    "P3 contact 4k": lambda: contact(20, 0.0),
    "P3 friction 4k": lambda: contact(20, 0.3),
    "P3 contact 32k": lambda: contact(56, 0.0),
    "P3 friction 32k": lambda: contact(56, 0.3),
    "P4 hht 41k": lambda: swinging(450, 45, "Q4I"),
    "P4 hht 410": lambda: swinging(40, 4, "Q4I"),
    "P4 energy-momentum 410": lambda: swinging(40, 4, "Q4D", scheme="energy_momentum"),
}


def case(name: str) -> list[tuple[str, float]]:
    """One of the models above, for its values."""
    model, step = MODELS[name]()
    ct.solve(model, step)
    return []


MODELS: dict[str, Callable[[], tuple[ct.Model, Any]]] = {
    **{name: CASES[name] for name in CASES if not name.endswith("k")},
    **{
        f"Python material, {element}, {scheme}": lambda element=element, scheme=scheme: own(
            element,
            ct.Static(increments=3)
            if scheme == "static"
            else ct.Dynamic(period=0.08, increments=8, scheme=scheme),
        )
        for element in ("Q4", "Q4I", "Q4D")
        for scheme in ("static", "newmark", "hht", "generalized_alpha", "energy_momentum")
    },
    **{
        f"rigid end, {scheme}": lambda scheme=scheme: constrained(
            ct.Static(increments=3)
            if scheme == "static"
            else ct.Dynamic(period=0.08, increments=8, scheme=scheme)
        )
        for scheme in ("static", "newmark", "hht", "energy_momentum")
    },
}


def timed(name: str) -> dict[str, Any]:
    """Seconds of a Newton iteration of a case, of this thread alone."""
    model, step = CASES[name]()
    start = time.process_time()
    results = ct.solve(model, step, threads=1, fields=False)
    seconds, info = time.process_time() - start, results.info
    return {
        "seconds": seconds / max(info["iterations"], 1),
        "iterations": info["iterations"],
        "dofs": info["n_dofs"],
    }


RUN = {"catalogue": catalogue, "examples": example, "decks": deck, "cases": case}


def do(recorder: Recorder, part: str, name: str) -> Any:
    """One task."""
    if part == "list":
        if name == "catalogue":
            from corota.verification.catalogue import problems

            return list(problems())
        return list(CASES if name == "speed" else MODELS)
    if part == "speed":
        return timed(name)
    if part == "torture":
        from benchmarks.campaigns.contact_torture import run

        return run(*json.loads(name))
    recorder.runs = []
    found: list[tuple[str, float]] = []
    error = ""
    try:
        found = RUN[part](name)
    except (Exception, SystemExit) as caught:
        error = f"{type(caught).__name__}: {caught}"
    return {"values": found, "runs": recorder.runs, "error": error}


def main() -> None:
    """Do what standard input says, a line for each task."""
    home = Path(sys.argv[1]).resolve()
    if home not in Path(ct.__file__).resolve().parents:
        raise SystemExit(f"corota comes from {ct.__file__}, not from {home}")
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    os.cpu_count = lambda: 1  # sums in one order, and quiet neighbors
    warnings.simplefilter("ignore")
    recorder = Recorder()
    for line in sys.stdin:
        part, name, out = json.loads(line)
        with (
            tempfile.TemporaryDirectory() as folder,
            contextlib.chdir(folder) if hasattr(contextlib, "chdir") else contextlib.nullcontext(),
            contextlib.redirect_stdout(io.StringIO()),
            contextlib.redirect_stderr(io.StringIO()),
        ):
            answer = do(recorder, part, name)
        Path(out).write_bytes(pickle.dumps(answer))
        answers.write("done\n")
        answers.flush()


if __name__ == "__main__":
    main()
