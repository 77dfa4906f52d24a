"""A whole Newton iteration with each material law over that of an elastic body.

``python -m benchmarks law_speed [LAW ...]`` presses a block of 353 x 353 cells (250 thousand dofs)
in plane strain under the logarithmic strain. Runs of the laws take turns; processor times of one
thread are compared, so that other work on the machine changes little: assembly, factorization,
solution, judgement of the residual. Targets: neo-Hooke, Yeoh, Prony 1.25; Ogden, Johnson-Cook 1.6;
a UMAT and a function with the C interface, as ``numba`` makes, 2.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import contextlib
import ctypes
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import corota as ct
from benchmarks.common import report
from benchmarks.speed.newton_iteration import Watch
from corota.model import elements

if TYPE_CHECKING:
    from collections.abc import Callable

SOURCE = Path(__file__).parents[2] / "tests" / "plastic" / "compiled_laws.c"
#: Strain to which the block is pressed, and iterations that are timed.
PRESSED, ITERATIONS = 0.02, 3
NU = 0.3
LAME = 1000.0 * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), 1000.0 / (2.0 * (1.0 + NU))


@cache
def library() -> str:
    """The compiled laws of the tests."""
    folder = Path(tempfile.mkdtemp())
    path = folder / "laws.so"
    subprocess.run(
        ["cc", "-O2", "-shared", "-fPIC", "-o", str(path), str(SOURCE), "-lm"], check=True
    )
    return str(path)


def c_function() -> ct.CompiledMaterial:
    """Linear elasticity by the C interface."""
    lame, shear = LAME
    function = ctypes.CDLL(library()).elastic
    return ct.CompiledMaterial(function, (lame + 2.0 * shear, lame), 1)


#: Laws with the largest ratio that is wanted.
LAWS: dict[str, tuple[Callable[[], Any], float]] = {
    "elastic": (lambda: ct.Elastic(1000.0, NU), 1.0),
    "neo-Hooke": (lambda: ct.NeoHooke(0.5, 0.02), 1.25),
    "Yeoh": (lambda: ct.Yeoh(0.5, -0.01, 0.002, 0.02, 0.1, 0.3), 1.25),
    "Prony": (
        lambda: ct.Viscoelastic(ct.Elastic(2e3, 0.38), terms=[(0.3, 0.1, 0.4), (0.2, 0.0, 4.0)]),
        1.25,
    ),
    "Ogden": (lambda: ct.Ogden((0.5, 0.1), (1.5, -2.0), (0.02, 0.0)), 1.6),
    "Johnson-Cook": (
        lambda: ct.JohnsonCook(E=200e3, nu=NU, A=350.0, B=275.0, n=0.36, C=0.022, rate=1.0),
        1.6,
    ),
    "UMAT": (lambda: ct.Umat(library(), (200e3, NU, 250.0, 2e3), 5, name="steel"), 2.0),
    "C function": (c_function, 2.0),
}


def times(material: Any, element: str, n: int) -> list[float]:
    """Processor times of the first iterations [s]."""
    mesh = ct.mesh.rectangle(10.0, 10.0, n, n, cell=elements.find(element).cell)
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=material, plane="strain", local_strain="logarithmic"
    )
    model.fix("bottom")
    model.fix("top", x=0.0, y=-10.0 * PRESSED)
    watch = Watch(time.process_time)
    step = ct.Visco if material.depends_on_time else ct.Static
    # No residual is that small: the step ends after the iterations.
    options: dict[str, Any] = {"increments": 1, "fixed_increments": True}
    options |= {"max_iterations": ITERATIONS, "tolerance": 1e-30}
    with contextlib.suppress(ct.ConvergenceError), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ct.solve(model, step(**options), observers=[watch], threads=1, fields=False)
    return watch.times[: ITERATIONS - 1]


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("laws", nargs="*", metavar="LAW", help=f"of {', '.join(LAWS)}; else all")
    options.add_argument("--element", default="Q4")
    options.add_argument("--cells", type=int, default=353, help="along a side")
    options.add_argument("--repeats", type=int, default=2)
    chosen = options.parse_args()
    names = ["elastic", *(n for n in chosen.laws or LAWS if n != "elastic")]
    taken: dict[str, list[float]] = {name: [] for name in names}
    for _ in range(chosen.repeats):
        for name in names:
            taken[name] += times(LAWS[name][0](), chosen.element, chosen.cells)
    first = statistics.median(taken["elastic"])
    rows: list[list[object]] = []
    for name in names:
        here = statistics.median(taken[name])
        rows.append([name, 1e3 * here, here / first, LAWS[name][1]])
    head = ["law", "iteration [ms]", "over the elastic one", "target"]
    report(f"Newton iteration of {chosen.element}, {chosen.cells}^2 cells", head, rows)
    return int(any(row[2] > row[3] for row in rows))  # type: ignore[operator]


if __name__ == "__main__":
    sys.exit(main())
