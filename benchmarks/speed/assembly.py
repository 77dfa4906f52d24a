"""Residual and tangent: nanoseconds an element, and the share of a factorization.

Every element with plain numbers and with the processor's vector instructions, on one thread
(processor time) and on two (wall time), beside the time that touching the same memory takes
(zero, then read and write each entry). Then the ratio to the numeric factorization of the same
matrix, both on one thread, in turn. Targets: at most 15 % for Q4I, Q8, OPT and Q4D; two threads
1.7 times one. Ends with an error if vector instructions bring less than a factor of 1.5 for any
element: then something on the way was not inlined.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
from functools import partial

import numpy as np

import corota as ct
from benchmarks.common import interleaved, report
from corota.analysis.equations import System
from corota.analysis.linear.solvers import make_solver
from corota.model import elements

#: Cantilever, ten to one: nodes for each cell of the mesh, to find the size for a count of dofs.
NODES_PER_CELL = {"tri3": 0.5, "quad4": 1.0, "tri6": 2.0, "quad8": 3.0, "quad9": 4.0}
LEAST_SPEEDUP = 1.5
TARGET = {"Q4I", "Q8", "OPT", "Q4D"}


class Case:
    """An element on a distorted cantilever of about `n_dofs`, clamped on the left."""

    def __init__(self, name: str, n_dofs: float) -> None:
        element = elements.find(name)
        triangles = 2.0 if element.cell.startswith("tri") else 1.0
        nodes_per_square = NODES_PER_CELL[element.cell] * triangles
        ny = max(1, int((n_dofs / element.dofs_per_node / nodes_per_square / 10.0) ** 0.5))
        mesh = ct.mesh.rectangle(10.0, 1.0, nx=10 * ny, ny=ny, cell=element.cell)
        model = ct.Model(mesh)
        model.section("all", element=name, material=ct.Elastic(E=1.2e6, nu=0.3), thickness=0.01)
        model.fix("left")
        self.name = name
        self.solver = make_solver()
        if hasattr(self.solver, "threads"):
            self.solver.threads = 1
        self.system = System(model, self.solver, 1)
        self.system.begin(ct.Static(), 0.0, np.zeros(self.system.n_dofs), None)
        n = self.system.n_dofs
        rng = np.random.default_rng(1)
        self.u = 1e-4 / ny * rng.standard_normal(n)
        self.force, self.scale = np.zeros(n), np.zeros(n)
        self.values = np.zeros(len(self.system.pattern.indices))
        self.n_elements = mesh.n_cells

    def assemble(self, lanes: str = "best", threads: int = 1) -> None:
        """Force, scale and tangent."""
        core = self.system.core
        core.set_lanes(lanes)
        core.assemble(self.u, True, self.force, self.scale, self.values)

    def assemble_alone(self) -> None:
        """One thread, between two rounds with two."""
        self.system.core.set_threads(1)
        self.assemble()
        self.system.core.set_threads(2)

    def touch(self) -> None:
        """Zero the same arrays, then read and write each entry once."""
        for array in (self.force, self.scale, self.values):
            array.fill(0.0)
            array += 1.0

    def factorize(self) -> None:
        """Factorize the tangent that :meth:`prepare` left."""
        self.solver.factorize(self.masked)

    def prepare(self) -> None:
        """Assemble, hold the clamp and analyze the pattern."""
        system = self.system
        self.assemble()
        self.masked = self.values.copy()
        system.core.mask(self.masked, system.conditions.constrained)
        self.solver.analyze(system.pattern.indptr, system.pattern.indices, system.node_of_dof)


def table_of_elements(n_dofs: float, repeats: int) -> bool:
    """Print nanoseconds an element; whether vector instructions pay everywhere."""
    rows, pays = [], True
    for name in elements.names():
        case = Case(name, n_dofs)
        width = case.system.core.set_lanes("best")
        one = interleaved(
            {
                "scalar": partial(case.assemble, "scalar"),
                "simd": case.assemble,
                "floor": case.touch,
            },
            repeats,
            clock=time.thread_time,
        )
        case.system.core.set_threads(2)
        two = interleaved(
            {
                "scalar": partial(case.assemble, "scalar"),
                "simd": case.assemble,
                "one": case.assemble_alone,
            },
            repeats,
        )
        ns = 1e9 / case.n_elements
        speedup = one["scalar"] / one["simd"]
        pays = pays and (width == 1 or speedup >= LEAST_SPEEDUP)
        row = [one["scalar"], one["simd"], two["scalar"], two["simd"], one["floor"]]
        rows.append(
            [
                name,
                case.n_elements,
                *(round(t * ns) for t in row),
                round(speedup, 2),
                round(two["one"] / two["simd"], 2),
            ]
        )
    head = ["element", "elements", "scalar, 1 thread", "SIMD, 1", "scalar, 2", "SIMD, 2"]
    head += ["memory floor", "SIMD gain", "2 threads gain"]
    report(f"Residual and tangent, ns an element, {width} lanes", head, rows)
    return pays


def table_of_ratios(sizes: list[float], repeats: int) -> None:
    """Print assembly against factorization, one thread each."""
    rows = []
    for n_dofs in sizes:
        for name in sorted(TARGET):
            case = Case(name, n_dofs)
            case.prepare()
            t = interleaved(
                {"assemble": case.assemble, "factor": case.factorize},
                repeats,
                clock=time.thread_time,
            )
            rows.append(
                [
                    name,
                    case.system.n_dofs,
                    1000.0 * t["assemble"],
                    1000.0 * t["factor"],
                    round(t["assemble"] / t["factor"], 3),
                ]
            )
    head = ["element", "dofs", "assembly [ms]", "factorization [ms]", "ratio"]
    report("Residual and tangent against the factorization, one thread", head, rows)


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--dofs", type=float, default=250e3, help="size of the element table")
    options.add_argument("--sizes", type=float, nargs="*", default=[250e3, 1e6])
    options.add_argument("--repeats", type=int, default=5)
    chosen = options.parse_args()
    pays = table_of_elements(chosen.dofs, chosen.repeats)
    table_of_ratios(chosen.sizes, chosen.repeats)
    if not pays:
        sys.stderr.write(f"vector instructions bring less than {LEAST_SPEEDUP} somewhere\n")
    return 0 if pays else 1


if __name__ == "__main__":
    sys.exit(main())
