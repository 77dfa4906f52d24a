"""Time and memory of decks with very many trusses, beams, steps, materials and sets.

    python -m benchmarks sizes [--only NAME] [--scale 1.0]

Each deck is run by ``corota run`` in a process of its own, at its full size and at a tenth of it.
The table gives processor time and peak memory of both, less those of the same deck of almost
nothing, and their ratio over that of the sizes: none may be above two.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.common import machine, table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: Time and memory over size that are too much.
MOST = 2.0
LAW = "*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*DENSITY\n1.\n"
STEP = "*STEP\n*STATIC\n1., 1.\n"
NO_OUTPUT = "*NODE FILE, FREQUENCY=1\nU\n"


def trusses(n: int) -> Iterator[str]:
    """A braced girder: five bars a panel."""
    panels = n // 5
    yield "*NODE\n"
    for k in range(panels + 1):
        yield f"{2 * k + 1}, {k}., 0.\n{2 * k + 2}, {k}., 1.\n"
    yield "*ELEMENT, TYPE=T2D2, ELSET=E\n"
    for k in range(panels):
        a, b, c, d = (2 * k + j for j in (1, 2, 3, 4))
        for j, (p, q) in enumerate(((a, c), (b, d), (c, d), (a, d), (b, c))):
            yield f"{5 * k + j + 1}, {p}, {q}\n"
    yield LAW + "*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n*BOUNDARY\n1, 1, 2\n2, 1\n"
    # Supports at every tenth panel: the matrix of a girder of that length alone is no test.
    for k in range(10, panels + 1, 10):
        yield f"{2 * k + 1}, 2\n"
    yield STEP + f"*CLOAD\n{2 * panels + 2}, 2, -.001\n{NO_OUTPUT}*END STEP\n"


def beams(n: int) -> Iterator[str]:
    """A beam on many supports."""
    yield "*NODE\n"
    for k in range(n + 1):
        yield f"{k + 1}, {k}., 0.\n"
    yield "*ELEMENT, TYPE=B21, ELSET=E\n"
    for k in range(n):
        yield f"{k + 1}, {k + 1}, {k + 2}\n"
    yield LAW + "*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT\n1., 1.\n0., 0., -1.\n"
    yield "*BOUNDARY\n1, 1, 2\n"
    for k in range(10, n + 1, 10):
        yield f"{k + 1}, 2\n"
    yield STEP + f"*CLOAD\n{n // 2 + 5}, 2, -.001\n{NO_OUTPUT}*END STEP\n"


def strip(nx: int) -> str:
    """Nodes and elements of a strip of one row."""
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{2 * k + 1}, {k}., 0.\n{2 * k + 2}, {k}., 1." for k in range(nx + 1)]
    lines.append("*ELEMENT, TYPE=CPS4, ELSET=EALL")
    lines += [f"{k + 1}, {2 * k + 1}, {2 * k + 3}, {2 * k + 4}, {2 * k + 2}" for k in range(nx)]
    return "\n".join(lines) + "\n"


def steps(n: int) -> Iterator[str]:
    """One strip under loads that go up and down."""
    yield strip(4) + LAW + "*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1.\n"
    yield "*BOUNDARY\n1, 1, 2\n2, 1, 2\n"
    for k in range(n):
        yield f"{STEP}*CLOAD, OP=NEW\n10, 2, {-0.001 * (k % 7):.3f}\n*END STEP\n"


def materials(n: int) -> Iterator[str]:
    """A strip of as many materials as it has hundreds of elements."""
    yield strip(100 * n)
    for k in range(n):
        yield f"*ELSET, ELSET=E{k}, GENERATE\n{100 * k + 1}, {100 * k + 100}\n"
        yield LAW.replace("=M", f"=M{k}").replace("1000.", f"{1000 + k}.")
        yield f"*SOLID SECTION, ELSET=E{k}, MATERIAL=M{k}\n1.\n"
    yield "*BOUNDARY\n1, 1, 2\n2, 1, 2\n"
    # A strip 12,000 times as long as high, held at one end, bends beyond double precision.
    for k in range(10, 100 * n + 1, 10):
        yield f"{2 * k + 1}, 2\n"
    yield f"{STEP}*CLOAD\n{200 * n + 2}, 1, .001\n*END STEP\n"


def sets(n: int) -> Iterator[str]:
    """A strip with many node and element sets, each with a support or a load."""
    yield strip(n)
    for k in range(n):
        yield f"*NSET, NSET=N{k}\n{2 * k + 3}\n*ELSET, ELSET=E{k}\n{k + 1}\n"
    yield LAW + "*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1.\n*BOUNDARY\n1, 1, 2\n2, 1, 2\n"
    for k in range(0, n, 2):
        yield f"N{k}, 2\n"
    yield STEP + "*CLOAD\n"
    for k in range(1, n, 2):
        yield f"N{k}, 1, 1e-6\n"
    yield "*END STEP\n"


#: Deck and full size.
CASES: dict[str, tuple[Callable[[int], Iterator[str]], int]] = {
    "trusses": (trusses, 1_000_000),
    "beams": (beams, 200_000),
    "steps": (steps, 10_000),
    "materials": (materials, 300),
    "sets": (sets, 10_000),
}


def measure(deck: Callable[[int], Iterator[str]], n: int, folder: Path) -> tuple[float, float]:
    """Processor seconds and peak memory [MB] of a run."""
    path = folder / "job.inp"
    with open(path, "w", encoding="ascii") as file:
        file.writelines(deck(n))
    words = [sys.executable, "-m", "corota", "run", "job.inp", "-q", "--threads", "1"]
    with subprocess.Popen([*words, "--checkpoint-every", "0"], cwd=folder) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"exit code {process.returncode} with {n}")
    for file in folder.iterdir():
        file.unlink()
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1e3


def main() -> int:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--only", default="", help="cases whose name holds this")
    parser.add_argument("--scale", type=float, default=1.0, help="share of the full sizes")
    args = parser.parse_args()
    rows, bad = [], 0
    for name, (deck, size) in CASES.items():
        if args.only not in name:
            continue
        full = round(size * args.scale)
        with tempfile.TemporaryDirectory(prefix="corota-sizes-") as folder:
            smaller = max(full // 100, 1), max(full // 10, 2)
            runs = [measure(deck, n, Path(folder)) for n in (*smaller, full)]
        base, tenth, whole = runs
        ratios = []
        for k in (0, 1):
            # Differences of two sizes: what a run costs without any is not counted.
            growth = (whole[k] - tenth[k]) / max(tenth[k] - base[k], 1e-9)
            ratios.append(growth / 10.0)
        bad += any(ratio > MOST for ratio in ratios)
        rows.append(
            [
                f"{full:,} {name}",
                *(f"{tenth[0]:.2f}, {whole[0]:.2f}", f"{ratios[0]:.2f}"),
                *(f"{tenth[1]:.0f}, {whole[1]:.0f}", f"{ratios[1]:.2f}"),
            ]
        )
        print(rows[-1], flush=True)
    head = ["deck", "CPU s at a tenth, whole", "over linear"]
    print(f"\n### Sizes\n\n{machine()}\n")
    print(table([*head, "MB at a tenth, whole", "over linear"], rows))
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
