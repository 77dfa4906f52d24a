"""Problems of the torture set beside CalculiX: who finishes, iterations, forces.

``python -m benchmarks.contact_beside_ccx --write`` takes the first problems of
:mod:`benchmarks.contact_problems` that CalculiX can be given: static, elastic, without contact of a
surface with itself and without stabilization. Both programs get the same nodes, elements,
supports, loads and first increments, in a unit in which the body's size is one, and
St. Venant's law in large rotations. Elements without a counterpart are replaced on both sides:
``Q4I`` and ``Q4D`` by ``Q4`` (``CPE4``), ``OPT`` by ``T3`` (``CPE3``). Round tools are polygons
with chords of 3 degrees in CalculiX, and arcs here.

CalculiX needs a penalty: :data:`STIFF` times Young's modulus per length, and a tenth of it for
sticking, within the range that its manual recommends. With surfaces, ``HARD`` contact takes
its own.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from benchmarks.common import machine, table
from benchmarks.contact_problems import FAMILIES, Draw, Problem
from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: Elements on both sides.
SAME = {"Q4I": "Q4", "Q4D": "Q4", "OPT": "T3"}
CARDS = {"Q4": "CPE4", "T3": "CPE3", "Q8": "CPE8", "Q8R": "CPE8R", "T6": "CPE6"}
#: Of the random numbers of the problems.
SEED = 20261122
#: Penalty over Young's modulus per length.
STIFF = 50.0
#: Chords of round tools [rad], and the depth of what lies behind their edges.
CHORD, DEPTH = math.radians(3.0), 0.05
#: Most increments of a step of CalculiX, and its shortest and longest over the period: longer ones
#: jump to folded shapes.
INCREMENTS, SMALLEST, LONGEST = 2000, 1e-7, 0.05
PAGE = Path(__file__).parents[1] / "docs" / "contact.md"
MARKS = ("<!-- ccx: begin -->", "<!-- ccx: end -->")
KINDS = {"SURFACE TO SURFACE": "surfaces", "NODE TO SURFACE": "nodes"}


@dataclass
class Run:
    """How a run ended.

    Parameters
    ----------
    end : str
        "yes", or why it stopped, with the share of the way.
    iterations : int
        Of all attempts.
    force : float
        Magnitude of the force on the tool or the support, averaged over the run.
    seconds : float
    """

    end: str
    iterations: int
    force: float
    seconds: float


def chosen(count: int, size: float) -> list[Problem]:
    """Problems that both programs can be given."""
    out: list[Problem] = []
    number = 0
    while len(out) < count:
        given = _unit_problem(number, size)
        if _fits(given):
            for section in given.model.sections:
                section.element = SAME.get(section.element, section.element)
                section.local_strain = "green_lagrange"
            out.append(given)
        number += 1
    return out


def _unit_problem(number: int, size: float) -> Problem:
    """The problem of a number with unit length and a modulus of 1000."""
    names = list(FAMILIES)
    family = names[number % len(names)]
    draw = Draw(np.random.default_rng([SEED, number]), 1.0, size)
    draw.length, draw.stress, draw.density = 1.0, 1.0, 1e-4
    model, steps = FAMILIES[family](draw)
    static = all(isinstance(step, ct.Static) for step in steps)
    return Problem(f"{family}-{number}", draw.what, model, steps, static)


def _fits(given: Problem) -> bool:
    material = given.model.sections[0].material
    plain = isinstance(material, ct.Elastic) and material.nu < 0.4
    pairs = given.model.contacts
    alone = any(pair.itself or pair.stabilise for pair in pairs)
    return given.static and plain and not alone


# -- the deck ---------------------------------------------------------------------------


def polygon(curve: RigidCurve) -> Floats:
    """A curve as the corners of a polygon, the deformable body on its left, shape (n, 2)."""
    points: list[Any] = []
    for x0, y0, x1, y1, cx, cy, sweep in curve.segments.tolist():
        if sweep == 0.0:
            some = np.array([(x0, y0), (x1, y1)])
        else:
            radius, start = math.hypot(x0 - cx, y0 - cy), math.atan2(y0 - cy, x0 - cx)
            angle = start + np.linspace(0.0, sweep, 1 + math.ceil(abs(sweep) / CHORD))
            some = np.column_stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle)])
        points += [p for p in some if not points or np.hypot(*(p - points[-1])) > 1e-9]
    return np.array(points)


class Deck:
    """A problem as CalculiX reads it.

    Numbers have 11 digits, since CalculiX reads the first 20 characters of a field.

    Parameters
    ----------
    given : Problem
    kind : str
        Of the contact pairs.
    """

    def __init__(self, given: Problem, kind: str) -> None:
        self.given, self.model, self.kind = given, given.model, kind
        self.lines: list[str] = []
        self.tools: list[tuple[Any, list[int]]] = []
        mesh = self.model.mesh
        self.next_node, self.next_cell = mesh.n_nodes + 1, mesh.n_cells + 1
        self.watched: list[int] = []

    def text(self) -> str:
        """The deck."""
        self._mesh()
        self._material()
        for i, pair in enumerate(self.model.contacts):
            self._pair(i, pair)
        for i, (_, nodes) in enumerate(self.tools):
            self._set(f"T{i}", nodes)
        self._watch()
        for i, step in enumerate(self.given.steps):
            self._step(i, step)
        return "\n".join(self.lines) + "\n"

    def _set(self, name: str, nodes: Any, kind: str = "NSET") -> None:
        self.lines.append(f"*{kind}, {kind}={name}")
        self.lines += [f"{n}," for n in nodes]

    def _mesh(self) -> None:
        mesh, add = self.model.mesh, self.lines.append
        add("*NODE")
        used = np.unique(np.concatenate([c.nodes.ravel() for c in mesh.cells]))
        for n in used:
            x, y = mesh.points[n]
            add(f"{n + 1}, {x:.11g}, {y:.11g}, 0.")
        section = self.model.sections[0]
        number = 0
        for block in mesh.cells:
            add(f"*ELEMENT, TYPE={CARDS[section.element]}, ELSET=BODY")
            for nodes in block.nodes:
                number += 1
                add(f"{number}, " + ", ".join(str(n + 1) for n in nodes))

    def _material(self) -> None:
        section = self.model.sections[0]
        m = section.material
        self.lines += [
            "*MATERIAL, NAME=M",
            f"*ELASTIC\n{m.E:.11g}, {m.nu:.11g}",
            f"*DENSITY\n{m.rho:.11g}",
            f"*SOLID SECTION, ELSET=BODY, MATERIAL=M\n{section.thickness:.11g}",
        ]

    def _pair(self, i: int, pair: Any) -> None:
        add = self.lines.append
        modulus = self.model.sections[0].material.E
        nodes_only = self.kind == "NODE TO SURFACE"
        self._surface(f"S{i}", pair.slave)
        if isinstance(pair.master, RigidCurve):
            self._tool(i, pair.master)
        else:
            self._surface(f"M{i}", pair.master)
        add(f"*SURFACE INTERACTION, NAME=I{i}")
        if nodes_only:
            add("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")
            add(f"{STIFF * modulus:.11g}, {1e-6 * modulus:.11g}")
        else:
            add("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD")
        if pair.friction:
            add(f"*FRICTION\n{pair.friction:.11g}, {0.1 * STIFF * modulus:.11g}")
        add(f"*CONTACT PAIR, INTERACTION=I{i}, TYPE={self.kind}")
        add(f"S{i}, M{i}")

    def _surface(self, name: str, where: Any) -> None:
        mesh = self.model.mesh
        edges = mesh.edge_sets[where] if isinstance(where, str) else where
        self.lines.append(f"*SURFACE, NAME={name}")
        self.lines += [f"{cell + 1}, S{side + 1}" for cell, side in edges]

    def _tool(self, i: int, curve: RigidCurve) -> None:
        """Elements behind the edges of a polygon, whose nodes are all driven."""
        front = polygon(curve)
        along = np.diff(front, axis=0)
        normal = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
        mean = np.vstack([normal[:1], normal[:-1] + normal[1:], normal[-1:]])
        closed = np.hypot(*(front[0] - front[-1])) < 1e-9
        if closed:
            mean[0] = mean[-1] = normal[0] + normal[-1]
        rounds = np.hypot(*(curve.segments[:, :2] - curve.segments[:, 4:6]).T)
        depth = min(DEPTH, 0.5 * float(rounds[curve.segments[:, 6] != 0.0].min(initial=1.0)))
        back = front + depth * mean / np.hypot(*mean.T)[:, None]
        add = self.lines.append
        add("*NODE")
        n, first = len(front), self.next_node
        for k, (x, y) in enumerate(np.vstack([front, back])):
            add(f"{first + k}, {x:.11g}, {y:.11g}, 0.")
        self.next_node += 2 * n
        add(f"*ELEMENT, TYPE=CPE4, ELSET=E{i}")
        cells = []
        for k in range(n - 1):
            # Counter-clockwise: the back lies on the right of the way.
            corners = (first + k + 1, first + k, first + n + k, first + n + k + 1)
            add(f"{self.next_cell}, " + ", ".join(map(str, corners)))
            cells.append(self.next_cell)
            self.next_cell += 1
        thickness = self.model.sections[0].thickness
        add(f"*SOLID SECTION, ELSET=E{i}, MATERIAL=M\n{thickness:.11g}")
        add(f"*SURFACE, NAME=M{i}")
        self.lines += [f"{cell}, S1" for cell in cells]
        self.tools.append((curve, list(range(first, first + 2 * n))))

    def _watch(self) -> None:
        """The nodes whose reaction is compared: the first tool, or the first support."""
        if self.tools:
            self.watched = self.tools[0][1]
        else:
            first = self.model.supports[0].nodes
            self.watched = [int(n) + 1 for n in nodes_of(self.model, first)]
        self._set("WATCH", self.watched)

    def _step(self, number: int, step: Any) -> None:
        add = self.lines.append
        period = step.period
        add(f"*STEP, NLGEOM, INC={INCREMENTS}\n*STATIC")
        first = min(step.first_increment, period)
        most = max(first, LONGEST * period)
        add(f"{first:.11g}, {period:.11g}, {SMALLEST * period:.11g}, {most:.11g}")
        supports = [*(self.model.supports if number == 0 else []), *step.supports]
        add("*BOUNDARY")
        for item in supports:
            if item.dof > 1 or self._moves_a_tool(item):
                continue
            for n in nodes_of(self.model, item.nodes):
                add(f"{n + 1}, {item.dof + 1}, {item.dof + 1}, {item.value:.11g}")
        for i, (curve, _) in enumerate(self.tools):
            motion = [0.0, 0.0]
            told = number == 0
            for item in supports:
                if item.dof < 2 and _is_of(self.model, item, curve):
                    motion[item.dof], told = item.value, True
            if told:
                add(f"T{i}, 1, 1, {motion[0]:.11g}\nT{i}, 2, 2, {motion[1]:.11g}")
        if number == 0:
            self._loads()
        add("*NODE PRINT, NSET=WATCH, TOTALS=ONLY\nRF\n*END STEP")

    def _moves_a_tool(self, item: Any) -> bool:
        return any(_is_of(self.model, item, curve) for curve, _ in self.tools)

    def _loads(self) -> None:
        for load in self.model.loads:
            if hasattr(load, "cells"):
                gx, gy = load.value[:2]
                size = math.hypot(gx, gy)
                self.lines.append(
                    f"*DLOAD\nBODY, GRAV, {size:.11g}, {gx / size:.11g}, {gy / size:.11g}, 0."
                    if size
                    else "**"
                )
            elif hasattr(load, "edges"):
                self._traction(load)

    def _traction(self, load: Any) -> None:
        """A dead traction as forces on nodes."""
        mesh = self.model.mesh
        edges = mesh.edge_sets[load.edges] if isinstance(load.edges, str) else load.edges
        force: dict[int, Floats] = {}
        for nodes in mesh.edge_nodes(edges):
            length = np.hypot(*(mesh.points[nodes[1]] - mesh.points[nodes[0]]))
            share = (0.5, 0.5) if len(nodes) == 2 else (1 / 6, 1 / 6, 2 / 3)
            for n, part in zip(nodes, share, strict=True):
                value = part * length * self.model.sections[0].thickness * np.array(load.value)
                force[int(n)] = force.get(int(n), np.zeros(2)) + value
        self.lines.append("*CLOAD")
        for n, (fx, fy) in force.items():
            self.lines += [f"{n + 1}, 1, {fx:.11g}", f"{n + 1}, 2, {fy:.11g}"]


def nodes_of(model: ct.Model, where: Any) -> Any:
    """Indices of nodes."""
    return model.mesh.nodes_of(where) if isinstance(where, str) else np.atleast_1d(where)


def _is_of(model: ct.Model, item: Any, curve: RigidCurve) -> bool:
    """Whether a support is one of the reference node of a curve."""
    return isinstance(curve.reference, int | np.integer) and curve.reference in nodes_of(
        model, item.nodes
    )


# -- runs -------------------------------------------------------------------------------


def by_ccx(given: Problem, kind: str, limit: int) -> Run:
    """The outcome of CalculiX."""
    text = Deck(given, kind).text()
    period = sum(step.period for step in given.steps)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "job.inp").write_text(text)
        begin = resource.getrusage(resource.RUSAGE_CHILDREN)
        found = subprocess.run(
            ["ccx", "-i", "job"],
            cwd=folder,
            check=False,
            capture_output=True,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)),
        )
        end = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime
        said = found.stdout.decode(errors="replace")
        why = ""
        if seconds > 0.95 * limit:
            why = f"over {limit} s"
        elif "Job finished" not in said:
            errors = re.findall(r"\*ERROR[^\n]*", said)
            why = _short(errors[-1]) if errors else "stops"
        force = _mean(_totals(folder / "job.dat"), period)
        reached = _reached(folder / "job.sta")
        iterations = _rows(folder / "job.cvg")
    told = "yes" if not why else f"{why}, {reached / period:.0%}"
    return Run(told, iterations, force, seconds)


def _short(error: str) -> str:
    return "diverges" if "too many" in error or "increment" in error else error[:60]


def _mean(found: Iterable[tuple[float, float]], period: float) -> float:
    """Mean over time of forces that begin with none, linear between their times."""
    time, force = np.array([(0.0, 0.0), *found]).T
    return float(np.trapezoid(force, time)) / period


def _totals(file: Path) -> Iterator[tuple[float, float]]:
    """Times and magnitudes of the sums of reactions, one for each increment."""
    if not file.exists():
        return
    lines = file.read_text(errors="replace").splitlines()
    for i, line in enumerate(lines):
        if "total force" in line:
            numbers = next((row.split() for row in lines[i + 1 : i + 4] if row.strip()), [])
            if len(numbers) >= 2:
                yield float(line.split()[-1]), math.hypot(float(numbers[0]), float(numbers[1]))


def _reached(file: Path) -> float:
    """Total time of the last increment that converged."""
    if not file.exists():
        return 0.0
    rows = [line.split() for line in file.read_text(errors="replace").splitlines()]
    times = [float(r[4]) for r in rows if len(r) == 7 and r[0].isdigit()]
    return times[-1] if times else 0.0


def _rows(file: Path) -> int:
    """Iterations of all attempts."""
    if not file.exists():
        return 0
    rows = [line.split() for line in file.read_text(errors="replace").splitlines()]
    return sum(1 for r in rows if len(r) > 4 and r[0].isdigit())


def by_corota(given: Problem, limit: int) -> Run:
    """Our outcome."""
    begin = time.process_time()
    why, results = "", None

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            watch = [_Limit(begin + limit)]
            results = ct.solve(given.model, given.steps, threads=1, observers=watch)
        except ct.CorotaError as error:
            results = getattr(error, "results", None)
            why = "over time" if isinstance(error, ct.Interrupted) else "stops"
    seconds = time.process_time() - begin
    period = sum(step.period for step in given.steps)
    frames = results.frames[1:] if results else []
    force = _mean([(frame.time, _force(given.model, frame)) for frame in frames], period)
    share = results.times[-1] / period if results and len(results.times) else 0.0
    end = "yes" if not why else f"{why}, {share:.0%}"
    count = int(results.info.get("iterations", 0)) if results else 0
    return Run(end, count, force, seconds)


class _Limit(ct.BaseObserver):
    """Stops a run that takes too long."""

    def __init__(self, end: float) -> None:
        self.last = end

    @property
    def stop(self) -> bool:
        """Whether time is up."""
        return time.process_time() > self.last


def _force(model: ct.Model, frame: Any) -> float:
    """The force that a deck of CalculiX prints the sum of."""
    for pair in model.contacts:
        if isinstance(pair.master, RigidCurve):
            name = pair.name
            return math.hypot(frame.scalars[f"{name}: force x"], frame.scalars[f"{name}: force y"])
    nodes = nodes_of(model, model.supports[0].nodes)
    return math.hypot(*frame.RF[nodes][:, :2].sum(axis=0))


# -- the table --------------------------------------------------------------------------


def compare(count: int, size: float, limit: int) -> str:
    """The table."""
    rows = []
    done = {"Corota": 0, **dict.fromkeys(KINDS.values(), 0)}
    for given in chosen(count, size):
        own = by_corota(given, limit)
        done["Corota"] += own.end == "yes"
        element = given.model.sections[0].element
        mu = given.model.contacts[0].friction
        cells = [given.name, f"{element}, {mu:g}", own.end, str(own.iterations), f"{own.force:.4g}"]
        for kind, name in KINDS.items():
            other = by_ccx(given, kind, limit)
            done[name] += other.end == "yes"
            away = ""
            if other.end == own.end == "yes" and own.force:
                away = f"{100.0 * (other.force / own.force - 1.0):+.1f} %"
            cells += [other.end, str(other.iterations), away]
        rows.append(cells)
        sys.stdout.write(" | ".join(cells) + "\n")
        sys.stdout.flush()
    finished = [str(done[name]) for name in ("Corota", "surfaces", "nodes")]
    rows.append(["finished", "", finished[0], "", "", finished[1], "", "", finished[2], "", ""])
    head = ["problem", "element, friction", "Corota", "iterations", "force", "ccx, surfaces"]
    head += ["iterations", "force", "ccx, nodes", "iterations", "force"]
    return table(head, rows)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--size", type=float, default=0.5, help="factor on numbers of elements")
    parser.add_argument("--limit", type=int, default=30, help="CPU seconds of a run")
    parser.add_argument("--deck", type=int, help="print the deck of one, by its place")
    parser.add_argument("--write", action="store_true", help="put the table into docs/contact.md")
    args = parser.parse_args()
    if args.deck is not None:
        given = chosen(args.deck + 1, args.size)[-1]
        sys.stdout.write(Deck(given, "SURFACE TO SURFACE").text())
        return 0
    if not shutil.which("ccx"):
        sys.stderr.write("the program ccx is not installed\n")
        return 2
    text = compare(args.count, args.size, args.limit)
    text = f"`python -m benchmarks.contact_beside_ccx --write`, {machine()}\n\n{text}"
    if args.write:
        page = PAGE.read_text()
        before, after = page.index(MARKS[0]) + len(MARKS[0]), page.index(MARKS[1])
        PAGE.write_text(f"{page[:before]}\n{text}\n{page[after:]}")
    else:
        sys.stdout.write(f"\n{text}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
