"""A contact problem with CalculiX.

CalculiX needs a penalty: :data:`STIFF` times Young's modulus per length, and a tenth of it for
sticking, within the range that its manual recommends. With surfaces, ``HARD`` contact takes
its own.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import os
import re
import resource
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.peers.contact_data import ContactData, Outcome, mean

if TYPE_CHECKING:
    from collections.abc import Iterator

    from benchmarks.peers.contact_data import Face

CARDS = {"Q4": "CPE4", "T3": "CPE3", "Q8": "CPE8", "Q8R": "CPE8R", "T6": "CPE6"}
#: Types of contact pairs, and what the tables call them.
KINDS = {"SURFACE TO SURFACE": "surfaces", "NODE TO SURFACE": "nodes"}
#: Penalty over Young's modulus per length.
STIFF = 50.0
#: Most increments of a step, and its shortest and longest over the period: longer ones jump to
#: folded shapes.
INCREMENTS, SMALLEST, LONGEST = 2000, 1e-7, 0.05


def deck(data: ContactData, kind: str) -> str:
    """A problem as CalculiX reads it.

    Numbers have 11 digits, since CalculiX reads the first 20 characters of a field.

    Parameters
    ----------
    data : ContactData
        In plane strain.
    kind : str
        Of the contact pairs.
    """
    lines = [*_mesh(data), *_material(data)]
    for i, pair in enumerate(data.pairs):
        lines += [*_surface(f"S{i}", pair.slave), *_surface(f"M{i}", pair.master)]
        lines.append(f"*SURFACE INTERACTION, NAME=I{i}")
        if kind == "NODE TO SURFACE":
            lines.append("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")
            lines.append(f"{STIFF * data.young:.11g}, {1e-6 * data.young:.11g}")
        else:
            lines.append("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD")
        if pair.friction:
            lines.append(f"*FRICTION\n{pair.friction:.11g}, {0.1 * STIFF * data.young:.11g}")
        lines += [f"*CONTACT PAIR, INTERACTION=I{i}, TYPE={kind}", f"S{i}, M{i}"]
    lines.append("*NSET, NSET=WATCH")
    lines += [f"{n + 1}," for n in data.watched]
    for i, stage in enumerate(data.stages):
        lines.append(f"*STEP, NLGEOM, INC={INCREMENTS}\n*STATIC")
        most = max(stage.first, LONGEST * stage.period)
        lines.append(
            f"{stage.first:.11g}, {stage.period:.11g}, {SMALLEST * stage.period:.11g}, {most:.11g}"
        )
        lines.append("*BOUNDARY")
        lines += [f"{n + 1}, {dof + 1}, {dof + 1}, {v:.11g}" for n, dof, v in stage.driven]
        if i == 0:
            lines += _loads(data)
        lines.append("*NODE PRINT, NSET=WATCH, TOTALS=ONLY\nRF\n*END STEP")
    return "\n".join(lines) + "\n"


def _mesh(data: ContactData) -> Iterator[str]:
    yield "*NODE"
    for n in sorted({*data.used, *(node for tool in data.tools for node in tool.nodes)}):
        x, y = data.points[n]
        yield f"{n + 1}, {x:.11g}, {y:.11g}, 0."
    number = 0
    groups = [("BODY", CARDS[data.element], data.cells)]
    groups += [(f"E{i}", "CPE4", tool.cells) for i, tool in enumerate(data.tools)]
    for name, card, cells in groups:
        yield f"*ELEMENT, TYPE={card}, ELSET={name}"
        for nodes in cells:
            number += 1
            yield f"{number}, " + ", ".join(str(n + 1) for n in nodes)


def _material(data: ContactData) -> Iterator[str]:
    yield "*MATERIAL, NAME=M"
    yield f"*ELASTIC\n{data.young:.11g}, {data.poisson:.11g}"
    yield f"*DENSITY\n{data.density:.11g}"
    for name in ("BODY", *(f"E{i}" for i in range(len(data.tools)))):
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL=M\n{data.thickness:.11g}"


def _surface(name: str, face: Face) -> Iterator[str]:
    yield f"*SURFACE, NAME={name}"
    for cell, side in face.sides:
        yield f"{cell + 1}, S{side + 1}"


def _loads(data: ContactData) -> Iterator[str]:
    size = math.hypot(*data.gravity)
    if size:
        x, y = (part / size for part in data.gravity)
        yield f"*DLOAD\nBODY, GRAV, {size:.11g}, {x:.11g}, {y:.11g}, 0."
    if data.forces:
        yield "*CLOAD"
    for n, fx, fy in data.forces:
        yield f"{n + 1}, 1, {fx:.11g}"
        yield f"{n + 1}, 2, {fy:.11g}"


def run(data: ContactData, kind: str, used: list[int], limit: int) -> Outcome:
    """The outcome of CalculiX.

    Parameters
    ----------
    data : ContactData
    kind : str
        A key of :data:`KINDS`.
    used : list of int
        Increments of Corota, which are not those of CalculiX.
    limit : int
        Longest processor time [s].
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "job.inp").write_text(deck(data, kind), encoding="ascii")
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
        force = mean(_totals(folder / "job.dat"), data.period)
        reached = _reached(folder / "job.sta")
        iterations = _rows(folder / "job.cvg")
    reported = "yes" if not why else f"{why}, {reached / data.period:.0%}"
    return Outcome(reported, iterations, force)


def _short(error: str) -> str:
    return "diverges" if "too many" in error or "increment" in error else error[:60]


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
