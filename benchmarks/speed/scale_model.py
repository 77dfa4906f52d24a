"""What large models cost, by model: memory, time and messages for each process.

Usage::

    python -m benchmarks scale_model [--dofs 1e6 1e7 1e8 1e9] [--processes 1 16 128 1024] [--write]
    python -m benchmarks scale_model --measure 70 143 353

A square of quadrilaterals with two dofs a node is cut by regular nested dissection, front by front,
down to the last node: entries of the factor, operations, and the update matrices that go from
front to front. With p processes the subtrees below level log2 p belong to one process each, and a
front above is shared by those of its subtree, in blocks (rows and columns are broadcast along a
grid of processes). Multigrid exchanges one layer of nodes for each product. Constants are
measured ones: of ``benchmarks/README.md`` (a million dofs, one thread, quiet machine) and, for
multigrid, of ``--measure``, which needs PETSc and compares the factor's model with time. Bandwidth
and latency of the network are assumed. ``--write`` puts the tables into ``docs/scale.md``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys
import time
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from benchmarks.common import machine, report, table, write_between

PAGE = Path(__file__).resolve().parents[2] / "docs" / "scale.md"
#: Dofs of a node; nodes of a region that is not cut further.
NODE, LEAF = 2, 16
#: Measured with 999,488 dofs of Q4I on one thread: seconds of a factorization, of a solution, of an
#: assembly.
MEASURED = 999_488
FACTOR, SOLVE, ASSEMBLY = 4.803 / 4.0, 1.016 / 4.0, 0.8485 / 5.0
#: Peak of such a run from a script, without result files [bytes].
PEAK = 2153e6
#: Multigrid with a million dofs by the solver ``petsc:gamg``: seconds a dof of the setup and of an
#: iteration, iterations to a residual of 1e-10, bytes a dof of the matrix, its pattern and its
#: hierarchy.
SETUP, ITERATION, ITERATIONS, HIERARCHY = 3.4e-6, 0.27e-6, 25, 1160.0
#: Bytes a dof that every process has: the mesh, the numbering and vectors of all dofs, of which an
#: iteration sums and gathers so many (each is sent to process 0 and back), measured with two.
REPLICATED, VECTORS = 550.0, 6.5
#: Network, assumed: bytes a second of one process, seconds of a message.
BANDWIDTH, LATENCY = 1e9, 2e-6
#: Products with the matrix of an iteration of multigrid on the finest level (smoothing, residual).
PRODUCTS = 6


@dataclass(frozen=True)
class Front:
    """A dense front.

    Parameters
    ----------
    pivots, border : int
        Equations that it eliminates, and those that it passes on to its parent.
    """

    pivots: int
    border: int

    @property
    def entries(self) -> float:
        """Values of the factor."""
        return 0.5 * self.pivots * (self.pivots + 1) + self.pivots * self.border

    @property
    def operations(self) -> float:
        """Multiplications and additions of its elimination."""
        p, m = self.pivots, self.pivots + self.border
        return (m**3 - (m - p) ** 3) / 3.0

    @property
    def update(self) -> float:
        """Values that go to the parent."""
        return 0.5 * self.border * (self.border + 1)


@dataclass(frozen=True)
class Tree:
    """Sums over a subtree."""

    entries: float = 0.0
    operations: float = 0.0

    def plus(self, entries: float, operations: float) -> Tree:
        return Tree(self.entries + entries, self.operations + operations)


#: Left, right, bottom, top: whether separators are there.
Sides = tuple[bool, bool, bool, bool]
FREE: Sides = (False, False, False, False)


def cut(w: int, h: int, sides: Sides) -> tuple[Front, list[tuple[int, int, Sides]]]:
    """Front of a region of w x h nodes, and the regions that its separator leaves."""
    left, right, bottom, top = sides
    border = NODE * (h * (left + right) + w * (bottom + top))
    if w * h <= LEAF or min(w, h) < 3:
        return Front(NODE * w * h, border), []
    if w < h:
        front, parts = cut(h, w, (bottom, top, left, right))
        return front, [(b, a, (s[2], s[3], s[0], s[1])) for a, b, s in parts]
    one = (w - 1) // 2
    return Front(NODE * h, border), [
        (one, h, (left, True, bottom, top)),
        (w - 1 - one, h, (True, right, bottom, top)),
    ]


@cache
def tree(w: int, h: int, sides: Sides = FREE) -> Tree:
    """Entries and operations of the factor of a region."""
    front, parts = cut(w, h, sides)
    found = Tree(front.entries, front.operations)
    for part in parts:
        below = tree(*part)
        found = found.plus(below.entries, below.operations)
    return found


@dataclass
class Share:
    """What the busiest process of a factorization has.

    Parameters
    ----------
    entries, operations : float
        Of the factor.
    values : float
        Sent.
    messages : float
        Sent.
    """

    entries: float = 0.0
    operations: float = 0.0
    values: float = 0.0
    messages: float = 0.0


#: Columns that are eliminated between two broadcasts.
BLOCK = 64


def share(n: int, processes: int) -> Share:
    """The busiest process of a square of n x n nodes."""
    found = Share()
    region: tuple[int, int, Sides] = (n, n, FREE)
    group = processes
    while group > 1:
        front, parts = cut(*region)
        if not parts:
            break
        found.entries += front.entries / group
        found.operations += front.operations / group
        size = front.pivots + front.border
        # Blocks of the panel along rows and columns of the grid of processes; update matrices.
        found.values += 2.0 * size * front.pivots / math.sqrt(group) + front.update / group
        found.messages += 2.0 * math.ceil(front.pivots / BLOCK) * math.log2(group) + group
        # The part with the longer border has more to do.
        region = max(parts, key=lambda part: tree(*part).operations)
        group //= 2
    below = tree(*region)
    if processes > 1:
        front, _ = cut(*region)
        found.values += front.update
        found.messages += 1.0
    found.entries += below.entries
    found.operations += below.operations
    return found


def nodes_of(dofs: float) -> int:
    """Nodes along a side of the square."""
    return round(math.sqrt(dofs / NODE))


def constants() -> dict[str, float]:
    """Speeds that follow from the measured run."""
    whole = tree(nodes_of(MEASURED), nodes_of(MEASURED))
    return {
        "operations a second": whole.operations / FACTOR,
        "bytes a second of the solution": 2.0 * 8.0 * whole.entries / SOLVE,
        "bytes a dof beside the factor": (PEAK - 8.0 * whole.entries) / MEASURED,
    }


def row(dofs: float, processes: int) -> list[object]:
    """Direct and multigrid for a size and a number of processes."""
    n = nodes_of(dofs)
    count, own = NODE * n * n, NODE * n * n / processes
    speed = constants()
    direct, model = share(n, processes), speed["bytes a dof beside the factor"] * own
    whole = VECTORS * 2.0 * 8.0 * count if processes > 1 else 0.0
    if processes > 1:
        model += REPLICATED * (count - own)
    network = (8.0 * direct.values + whole) / BANDWIDTH + LATENCY * direct.messages
    seconds = (
        direct.operations / speed["operations a second"]
        + 2.0 * 8.0 * direct.entries / speed["bytes a second of the solution"]
        + ASSEMBLY * own / MEASURED
        + network
    )
    halo = 4.0 * n / math.sqrt(processes) * NODE * 8.0 if processes > 1 else 0.0
    products = PRODUCTS * ITERATIONS * 4.0 / 3.0  # coarser levels have a quarter each
    levels = max(math.log(count / 100.0) / math.log(4.0), 1.0)
    sent = products * halo + whole
    exchange = sent / BANDWIDTH
    if processes > 1:
        exchange += LATENCY * ITERATIONS * (8.0 * PRODUCTS * levels + 3.0 * math.log2(processes))
    multigrid = own * (SETUP + ITERATIONS * ITERATION) + ASSEMBLY * own / MEASURED + exchange
    return [
        f"{count:.1e}",
        processes,
        f"{(8.0 * direct.entries + model) / 1e9:.3g}",
        f"{seconds:.3g}",
        f"{(8.0 * direct.values + whole) / 1e6:.3g}",
        f"{(HIERARCHY * own + model) / 1e9:.3g}",
        f"{multigrid:.3g}",
        f"{sent / 1e6:.3g}",
    ]


HEAD = [
    "dofs",
    "processes",
    "direct: GB",
    "direct: s / iteration",
    "direct: MB sent",
    "multigrid: GB",
    "multigrid: s / iteration",
    "multigrid: MB sent",
]


def factor_rows(dofs: list[float]) -> list[list[object]]:
    """Growth of the factor."""
    rows: list[list[object]] = []
    for size in dofs:
        n = nodes_of(size)
        found, count = tree(n, n), NODE * n * n
        flops = found.operations
        rows.append([f"{count:.1e}", found.entries / count, f"{flops:.3g}", flops / count**1.5])
    return rows


def measure(sides: list[int]) -> None:
    """Processor time of the factorization over its model, and multigrid, on squares."""
    from benchmarks.speed.linear_solver import square
    from corota.analysis.linear.solvers import Multifrontal

    rows: list[list[object]] = []
    for side in sides:
        upper, node = square(side)
        n = upper.shape[0]
        solver = Multifrontal()
        solver.threads = 1
        solver.analyze(upper.indptr, upper.indices, node)
        taken = []
        for _ in range(5):
            begin = time.process_time()
            solver.factorize(upper.data)
            taken.append(time.process_time() - begin)
        model = tree(side, side)
        speed = model.operations / min(taken) / 1e9
        rows.append([n, min(taken), speed, *mumps(upper, node, model), *multigrid(upper, side)])
    head = ["dofs", "factor [s]", "model Gflop/s", "MUMPS: entries / model", "operations / model"]
    head += ["GAMG: iterations", "setup [µs / dof]", "iteration [µs / dof]", "bytes / dof"]
    report("Constants, processor time of one thread", head, rows)


def mumps(upper: Any, node: Any, model: Tree) -> list[object]:
    """Entries and operations of MUMPS, with its own ordering, over those of the model."""
    if find_spec("petsc4py") is None:
        return [""] * 2
    from corota.analysis.linear.petsc import Petsc

    solver = Petsc()
    solver.analyze(upper.indptr, upper.indices, node)
    solver.factorize(upper.data)
    factor = solver._solver.getPC().getFactorMatrix()
    entries = factor.getMumpsInfog(29)
    entries = -1e6 * entries if entries < 0 else entries
    return [entries / model.entries, factor.getMumpsRinfog(3) / model.operations]


def multigrid(upper: Any, side: int) -> list[object]:
    """Iterations and cost of CG with GAMG and rigid-body near-null space, where PETSc is."""
    if find_spec("petsc4py") is None:
        return [""] * 4
    from corota.analysis.linear.petsc import load_petsc

    petsc = load_petsc()
    full = (upper + sp.triu(upper, 1).T).tocsr()
    full.sort_indices()
    n, kind, own = full.shape[0], petsc.IntType, petsc.COMM_SELF
    before = resident()
    rows = full.indptr.astype(kind), full.indices.astype(kind), full.data
    matrix = petsc.Mat().createAIJ((n, n), csr=rows, comm=own)
    matrix.setBlockSize(NODE)
    place = np.divmod(np.arange(n // NODE) + side + 1, side + 1)
    points = np.stack(place, axis=1).astype(float).ravel()
    where = petsc.Vec().createWithArray(points, bsize=NODE, comm=own)
    matrix.setNearNullSpace(petsc.NullSpace().createRigidBody(where))
    solver = petsc.KSP().create(own)
    solver.setType("cg")
    solver.setTolerances(rtol=1e-8)
    solver.getPC().setType("gamg")
    solver.setOperators(matrix)
    begin = time.process_time()
    solver.setUp()
    ready = time.process_time()
    memory = resident() - before
    rhs = petsc.Vec().createWithArray(np.random.default_rng(1).normal(size=n), comm=own)
    solver.solve(rhs, rhs.duplicate())
    end = time.process_time()
    count = solver.getIterationNumber()
    return [count, 1e6 * (ready - begin) / n, 1e6 * (end - ready) / n / count, memory / n]


def resident() -> float:
    """Memory of this process [bytes]."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * float(import_module("resource").getpagesize())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--dofs", type=float, nargs="+", default=[1e6, 1e7, 1e8, 1e9])
    parser.add_argument("--processes", type=int, nargs="+", default=[1, 16, 128, 1024])
    parser.add_argument("--measure", type=int, nargs="+", metavar="SIDE", help="elements a side")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/scale.md")
    args = parser.parse_args()
    if any(p < 1 or p & (p - 1) for p in args.processes):
        parser.error("numbers of processes are powers of two")
    if args.measure:
        measure(args.measure)
        return 0
    growth = table(
        ["dofs", "entries / dof", "operations", "operations / dofs^1.5"], factor_rows(args.dofs)
    )
    speeds = table(["constant", "value"], [[k, f"{v:.3g}"] for k, v in constants().items()])
    cost = table(HEAD, [row(d, p) for d in args.dofs for p in args.processes])
    text = f"{growth}\n\n{speeds}\n\n{cost}"
    sys.stdout.write(f"{machine()}\n\n{text}\n")
    if args.write:
        write_between(PAGE, "model", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
