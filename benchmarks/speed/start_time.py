"""What starting costs: whole processes of small jobs, interleaved, beside CalculiX.

Usage::

    python -m benchmarks start_time [--before TREE] [--rounds 9] [--sizes 1 410 4230] [--write]

Each round runs every command once: the interpreter alone, with NumPy, with h5py (the floors of
any program that uses them), ``corota --help``, and the same deck by ``corota run`` and by CalculiX:
one element in one increment, and problem P1 with ten. ``--before`` names another source tree with
its compiled core, which takes its turn in the same rounds. Bytecode is kept in a temporary folder,
as it is beside an installed package. The least and the median wall time and the least processor
time are shown. ``--write`` puts the table into ``benchmarks/README.md``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

from benchmarks.common import machine, table, write_between
from benchmarks.corpora import decks, problems

ROOT = Path(__file__).resolve().parents[2]
ONE = """\
*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
*CLOAD
2, 1, 1.
3, 1, 1.
*NODE FILE
U
*EL FILE
S
*END STEP
"""
#: Elements through the height of problem P1 by the number of dofs.
HEIGHTS = {410: 4, 4230: 14, 41492: 45}


@dataclass
class Command:
    """A command that is run in every round, and what it took.

    Parameters
    ----------
    job : str
    program : str
    words : list of str
    tree : Path or None
        Source tree that Python imports Corota from.
    """

    job: str
    program: str
    words: list[str]
    tree: Path | None = None
    wall: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)

    def run(self, folder: Path) -> None:
        """Run it in a folder of its own.

        Raises
        ------
        RuntimeError
            If it fails.
        """
        environment = dict(os.environ, PYTHONPYCACHEPREFIX=str(folder / f"bytecode-{self.program}"))
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        for name in ("OMP", "OPENBLAS"):
            environment[f"{name}_NUM_THREADS"] = "1"
        if self.tree is not None:
            environment["PYTHONPATH"] = str(self.tree / "src")
        place = folder / self.program.replace(" ", "-")
        place.mkdir(exist_ok=True)
        before, start = _processor_time(), time.perf_counter()
        with subprocess.Popen(
            self.words,
            cwd=place,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        ) as child:
            _, said = child.communicate()
        self.wall.append(time.perf_counter() - start)
        self.cpu.append(_processor_time() - before)
        if child.returncode:
            raise RuntimeError(f"{' '.join(self.words)}: {said.decode(errors='replace')}")

    def row(self) -> list[object]:
        """Row of the table; the first round, which writes bytecode, does not count."""
        wall, cpu = self.wall[1:], self.cpu[1:]
        return [self.job, self.program, min(wall), median(wall), min(cpu)]


def _processor_time() -> float:
    """Of all processes that were run and have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def commands(folder: Path, sizes: list[int], before: Path | None) -> list[Command]:
    """Everything that a round runs."""
    python = sys.executable
    trees = {"Corota": ROOT} if before is None else {"before": before, "Corota": ROOT}
    found = [
        Command("interpreter alone", "Python", [python, "-c", "pass"]),
        Command("import numpy", "Python", [python, "-c", "import numpy"]),
        Command("import h5py", "Python", [python, "-c", "import h5py"]),
    ]
    for name, tree in trees.items():
        found.append(Command("--help", name, [python, "-m", "corota", "--help"], tree))
    solver = shutil.which("ccx")
    for size in sizes:
        deck = folder / f"job{size}.inp"
        if size == 1:
            deck.write_text(ONE, encoding="ascii")
        else:
            decks.write_deck(deck, problems.BUILDERS["P1"](HEIGHTS[size], 1, 0))
        job = "one element" if size == 1 else f"{size} dofs, ten increments"
        for name, tree in trees.items():
            words = [python, "-m", "corota", "run", str(deck), "-q", "--threads", "1"]
            found.append(Command(job, name, words, tree))
        if solver:
            found.append(Command(job, "CalculiX", [solver, "-i", str(deck.with_suffix(""))]))
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", type=Path, help="another source tree with its compiled core")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument(
        "--sizes", type=int, nargs="+", default=[1, 410, 4230], choices=[1, *HEIGHTS]
    )
    parser.add_argument("--write", action="store_true", help="put the table into the page")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        listed = commands(folder, args.sizes, args.before and args.before.resolve())
        for _ in range(args.rounds + 1):
            for command in listed:
                command.run(folder)
    head = ["job", "program", "least wall [s]", "median wall [s]", "least processor time [s]"]
    text = table(head, [command.row() for command in listed])
    sys.stdout.write(f"{machine()}\n\n{text}\n")
    if args.write:
        page = ROOT / "benchmarks" / "README.md"
        write_between(page, "start", f"Measured on {machine()}.\n\n{text}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
