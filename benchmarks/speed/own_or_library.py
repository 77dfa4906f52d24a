"""Our own iterative methods beside those of SciPy, on the systems that analyses solve.

GMRES on the unsymmetric part of frictional contact, block Lanczos on the pencil of linear buckling.
Both take each other's place inside an analysis, with the same products and factorizations; times
are of this thread's processor. ``--pardiso N`` compares our call of PARDISO with that of pypardiso,
where both packages are installed (PYPARDISO_MKL_RT names oneMKL's library). docs/design.md says
what follows from the figures.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
import warnings
from typing import Any

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigs, gmres

import corota as ct
from benchmarks.common import report
from benchmarks.speed.before_after_worker import contact
from corota.analysis.equations import System
from corota.analysis.linear import gmres as gmres_own
from corota.analysis.linear import saddle_point
from corota.analysis.linear.solvers import make_solver
from corota.analysis.linear.system import LinearSystem
from corota.analysis.procedures import buckling


def gmres_row(n: int) -> list[object]:
    """Both methods on every system of a job in frictional contact, `n` elements along the face."""
    own = saddle_point.gmres
    seconds, steps = [0.0, 0.0], [0, 0]
    systems = size = 0

    def both(solve: Any, rest: Any, b: Any, n_inner: int) -> Any:
        nonlocal systems, size
        start = time.thread_time()
        found, own_steps = own(solve, rest, b, n_inner)
        seconds[0] += time.thread_time() - start
        if found is None:
            return None, own_steps
        steps[0] += own_steps
        systems, size = systems + 1, len(b)
        start = time.thread_time()
        r, scale = solve(b), np.ones(size)
        for part in (slice(0, n_inner), slice(n_inner, size)):
            scale[part] = np.abs(r[part]).max(initial=0.0) or 1.0

        def apply(v: Any) -> Any:
            product = np.zeros(size)
            np.add.at(product, rest.rows, rest.values * (v * scale)[rest.columns])
            steps[1] += 1
            return v + solve(product) / scale

        operator = LinearOperator((size, size), matvec=apply, dtype=float)
        most, enough = gmres_own.MOST_STEPS, gmres_own.TOLERANCE
        gmres(operator, r / scale, rtol=enough, atol=0.0, restart=most, maxiter=1)
        seconds[1] += time.thread_time() - start
        return found, own_steps

    saddle_point.gmres = both
    try:
        model, step = contact(n, 0.3)
        ct.solve(model, step, threads=1, fields=False)
    finally:
        saddle_point.gmres = own
    return ["GMRES", size, systems, *steps, *(1e3 * s for s in seconds), seconds[1] / seconds[0]]


def lanczos_row(ny: int) -> list[object]:
    """Both methods on four buckling factors of a strip with `ny` elements through its height."""
    own, row = buckling.largest, []

    def both(apply: Any, solve: Any, start: Any, count: int, tolerance: float = 1e-6) -> Any:
        solves = [0, 0]

        def counted(x: Any) -> Any:
            solves[0] += 1
            return solve(x)

        begin = time.thread_time()
        found = own(apply, counted, start, count, tolerance)
        middle = time.thread_time()

        def product(v: Any) -> Any:
            solves[1] += 1
            return solve(np.asfortranarray(apply(np.asfortranarray(v.reshape(-1, 1)))))[:, 0]

        # The pencil has no sign, so that ARPACK's symmetric method has no inner product for it.
        operator = LinearOperator((len(start),) * 2, matvec=product, dtype=float)
        eigs(operator, k=count + 2, which="LR", v0=solve(start)[:, 0], tol=1e-10)
        seconds = middle - begin, time.thread_time() - middle
        row[:] = ["block Lanczos", len(start), 1, *solves, *(1e3 * s for s in seconds)]
        row.append(seconds[1] / seconds[0])
        return found

    buckling.largest = both
    try:
        model = ct.Model(ct.mesh.rectangle(20.0, 1.0, 20 * ny, ny))
        model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
        model.fix("left")
        model.force(model.mesh.nodes_of("right"), x=-1.0 / (ny + 1))
        ct.solve(model, ct.Buckle(modes=4), threads=1)
    finally:
        buckling.largest = own
    return row


def pardiso_row(ny: int) -> list[object]:
    """Our call of PARDISO beside pypardiso's: numerical factorization and solution of a strip."""
    import scipy.sparse as sp
    from pypardiso.pardiso_wrapper import PyPardisoSolver

    model = ct.Model(ct.mesh.rectangle(4.0 * ny, ny, 4 * ny, ny))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.2)
    step = ct.Static()
    system = System(model, make_solver("multifrontal"), 1)
    system.begin(step, 0.0, np.zeros(system.n_dofs), None)
    at = system.evaluate(np.zeros(system.n_dofs), step.period)
    pattern, values, b = system.constraints.pattern, at.values.copy(), at.external.copy()
    pattern.mask(values, system.constrained)
    b[system.constrained] = 0.0
    own, library = LinearSystem(make_solver("pardiso")), PyPardisoSolver(mtype=-2)
    upper = sp.triu(pattern.full(values)).tocsr()
    upper.sort_indices()

    def phase(number: int) -> Any:
        library.set_phase(number)
        return library._call_pardiso(upper, np.asfortranarray(b[:, None]))

    def best(call: Any) -> float:
        times = []
        for _ in range(4):
            begin = time.perf_counter()
            call()
            times.append(time.perf_counter() - begin)
        return 1e3 * min(times[1:])

    phase(11)
    factorize = best(lambda: own.factorize(pattern, values)), best(lambda: phase(22))
    solve = best(lambda: own.solve(b)), best(lambda: phase(33))
    x, y = own.solve(b), phase(33).ravel()
    return [system.n_dofs, *factorize, *solve, float(np.abs(x - y).max() / np.abs(x).max())]


def main() -> int:
    """Print the table."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--contact", nargs="+", type=int, default=[24, 57])
    options.add_argument("--buckling", nargs="+", type=int, default=[4, 12, 24])
    options.add_argument("--pardiso", nargs="+", type=int, default=[])
    chosen = options.parse_args()
    if chosen.pardiso:
        names = ["factorize", "pypardiso", "solve", "pypardiso", "difference"]
        report("PARDISO [ms]", ["unknowns", *names], [pardiso_row(n) for n in chosen.pardiso])
        return 0
    warnings.simplefilter("ignore")
    rows = [gmres_row(n) for n in chosen.contact] + [lanczos_row(n) for n in chosen.buckling]
    head = ["method", "unknowns", "systems", "own solves", "SciPy's", "own [ms]", "SciPy [ms]"]
    report("Own methods beside SciPy's", [*head, "ratio"], rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
