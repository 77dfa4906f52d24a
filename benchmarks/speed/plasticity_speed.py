"""What plasticity costs: a Newton iteration with half of the points yielding over an elastic one.

A square of N x N cells is stretched so that its left half yields; assembly, factorization and
solution of one iteration are timed in turn with the same mesh of elastic material.
``--size`` (cells a side; 353 gives 250k dofs), ``--elements``, ``--threads``, ``--repeats``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
from typing import Any

import numpy as np

import corota as ct
from benchmarks.common import interleaved, report
from corota.analysis.equations import System
from corota.analysis.linear.solvers import SOLVERS
from corota.model.steps import Static
from corota.verification.plastic_models import CELL, DRILLING


def problem(element: str, n: int, law: Any, threads: int) -> tuple[System, Any]:
    """System and displacement: strain grows from left to right, yield is met in the middle."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, n, n, CELL[element]))
    model.section("all", element=element, material=law)
    model.fix("left", rotation=True if element in DRILLING else None)
    solver = SOLVERS["multifrontal"]()
    solver.threads = threads  # type: ignore[attr-defined]
    system = System(model, solver, threads)
    system.begin(Static(), 0.0, np.zeros(system.n_dofs), None)
    x = model.mesh.points[:, 0]
    values = np.zeros((len(x), 3))
    values[:, 0] = 0.002 * x**2  # strain 0.004 x, yield at x = 1/2
    return system, system.from_nodes(values.ravel())


def measure(element: str, n: int, threads: int, repeats: int) -> list[object]:
    """Row of the table of one element."""
    laws = {
        "elastic": ct.Elastic(E=200000.0, nu=0.0),
        "plastic": ct.Mises(E=200000.0, nu=0.0, yield_stress=400.0, isotropic=2000.0),
    }
    made = {name: problem(element, n, law, threads) for name, law in laws.items()}

    def iteration(name: str) -> None:
        system, u = made[name]
        at = system.evaluate(u, 0.0)
        system.predict(at, np.zeros(system.n_dofs))

    def assembly(name: str) -> None:
        system, u = made[name]
        system.evaluate(u, 0.0)

    runs = {
        f"{what.__name__} {name}": (lambda what=what, name=name: what(name))
        for what in (assembly, iteration)
        for name in laws
    }
    times = interleaved(runs, repeats)
    system, u = made["plastic"]
    system.evaluate(u, 0.0)
    fields, _ = system.recover(u)
    share = float((fields[0].values["PEEQ"] > 0).mean())
    return [
        element,
        system.n_dofs,
        share,
        1e3 * times["assembly elastic"],
        1e3 * times["assembly plastic"],
        1e3 * times["iteration elastic"],
        1e3 * times["iteration plastic"],
        times["iteration plastic"] / times["iteration elastic"],
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=353)
    parser.add_argument("--elements", nargs="*", default=["Q4", "Q4I"])
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    head = (
        "element",
        "dofs",
        "yielding",
        "assembly elastic [ms]",
        "plastic [ms]",
        "iteration elastic [ms]",
        "plastic [ms]",
        "ratio",
    )
    rows = [measure(e, options.size, options.threads, options.repeats) for e in options.elements]
    report(f"One iteration, half of the points yielding, {options.threads} threads", head, rows)


if __name__ == "__main__":
    main()
