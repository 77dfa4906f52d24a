"""The examples of contact in units of 1, 1000 and 1024: the same increments and results.

Every example of ``examples/contact`` and ``examples/impact`` runs with automatic increments, as it
stands, in mm and in m (or m and mm). Increments, their iterations and cut-backs must be equal, and
displacements and contact forces over the whole run agree after conversion to about the tolerance of
Newton's method. In a unit of 1024 times the first nothing is rounded differently: there every digit
and every iteration of failed attempts must be equal, or something in the program has a unit. The
exit status says whether all that is so. ``--write`` puts the table into docs/contact.md; names
choose examples.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import importlib
import sys
import time
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.common import machine, table, write_between

if TYPE_CHECKING:
    import corota as ct

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "contact.md"
for folder in ("contact", "impact"):
    sys.path.insert(0, str(ROOT / "examples" / folder))

#: Relative difference of results that mm and m may have.
AGREE = 1e-7


@dataclass
class Case:
    """An example: its module, what it is, options of its ``run``.

    Parameters
    ----------
    masses : bool
        Whether mass and time keep their units, so that forces have one with a length in it;
        else force and time do.
    """

    module: str
    what: str
    options: dict[str, Any]
    masses: bool = False


CASES = (
    Case("hertz", "cylinder on a rigid plane, 48 x 48 `Q4I`", {"n": 48}),
    Case("ironing", "elastic die drawn across a soft block", {}),
    Case("ironing", "the same with friction 0.3", {"friction": 0.3}),
    Case("seal", "tube in a groove under a rib, inner walls touch", {}),
    Case("clip", "elastoplastic snap-fit, in and out", {"friction": 0.0}),
    Case("clip", "the same with friction 0.2", {"friction": 0.2}),
    Case("crushed_ring", "elastoplastic ring between plates, and relieved", {}),
    Case("bistable_beam", "beam that snaps away from a probe, in motion", {}),
    Case("bar", "elastic bar on a wall, HHT", {"step": 0.0}, masses=True),
    Case("ring", "elastic ring on a wall, energy-momentum", {"speed": 1.0}, masses=True),
    Case("ring", "the same, yielding", {"speed": 1.0, "plastic": True}, masses=True),
)


def timed(case: Case, unit: float) -> tuple[ct.Results, float]:
    """A run and its processor time [s]."""
    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = importlib.import_module(case.module).run(unit=unit, **case.options)
    return results, time.process_time() - begin


def counts(results: ct.Results) -> tuple[int, int, int]:
    """Increments, their iterations, and cut-backs."""
    iterations = sum(int(frame.scalars.get("iterations", 0)) for frame in results.frames)
    return len(results.frames) - 1, iterations, int(results.info.get("cut-backs", 0))


def wasted(results: ct.Results) -> int:
    """Iterations of attempts that were cut."""
    return int(results.info["iterations"]) - counts(results)[1]


def largest(one: np.ndarray, other: np.ndarray) -> float:
    """Largest difference relative to the largest value."""
    return float(np.abs(one - other).max() / np.abs(one).max())


def differ(case: Case, one: ct.Results, other: ct.Results, factor: float) -> tuple[float, float]:
    """Largest relative differences of displacements and of contact forces over all frames."""
    # `unit` of examples with masses is a unit in the unit of length, else that unit in mm.
    length, force = (1.0 / factor, 1.0 / factor) if case.masses else (factor, 1.0)
    moved = [np.array([f.U for f in results.frames]) for results in (one, other)]
    names = [n for n in one.frames[-1].scalars if n.endswith((": force x", ": force y"))]
    forces = [
        np.array([[f.scalars[n] for n in names] for f in results.frames[1:]])
        for results in (one, other)
    ]
    return largest(moved[0], length * moved[1]), largest(forces[0], force * forces[1])


def compare(case: Case) -> tuple[list[object], list[str]]:
    """A row of the table, and what is wrong with it."""
    (mm, cpu), (m, cpu_m), (binary, _) = (timed(case, unit) for unit in (1.0, 1000.0, 1024.0))
    lost = str(wasted(mm)) + (f" ({wasted(m)})" if wasted(m) != wasted(mm) else "")
    row: list[object] = [
        f"`{case.module}.py`",
        case.what,
        mm.mesh.n_cells,
        *counts(mm),
        lost,
        round(cpu, 1),
        round(cpu_m, 1),
    ]
    problems = []
    if (counts(mm), wasted(mm)) != (counts(binary), wasted(binary)):
        problems.append(f"{(*counts(mm), wasted(mm))} and {(*counts(binary), wasted(binary))}")
    elif any(differ(case, mm, binary, 1024.0)):
        problems.append("results differ in a unit of 1024")
    if counts(mm) != counts(m):
        return [*row, "-", "-"], [*problems, f"{counts(mm)} against {counts(m)}"]
    found = differ(case, mm, m, 1000.0)
    if max(found) > AGREE:
        problems.append("results differ")
    return [*row, *(f"{d:.0e}" for d in found)], problems


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="examples, all by default")
    parser.add_argument("--write", action="store_true", help="write the table into docs/contact.md")
    args = parser.parse_args()
    chosen = [case for case in CASES if not args.names or case.module in args.names]
    timed(CASES[0], 1.0)  # what is imported late
    rows: list[list[object]] = []
    problems: list[str] = []
    for case in chosen:
        row, found = compare(case)
        rows.append(row)
        problems += [f"{case.module} {case.options}: {text}" for text in found]
        sys.stderr.write(f"{case.module} {case.options}: {'; '.join(found) or 'equal'}\n")
    head = [
        "script",
        "what",
        "elements",
        "increments",
        "iterations",
        "cut-backs",
        "iterations lost",
        "CPU s",
        "in m",
        "displacements differ by",
        "forces by",
    ]
    text = f"`python -m benchmarks contact_units --write`, {machine()}\n\n{table(head, rows)}"
    sys.stdout.write(text + "\n")
    sys.stdout.writelines(f"{line}\n" for line in problems)
    if args.write:
        write_between(PAGE, "units", text)
    return len(problems)


if __name__ == "__main__":
    sys.exit(main())
