"""Variants a second of a sweep, and the same table from other executors.

Usage::

    python -m benchmarks sweep_rate [--variants 200] [--executors serial processes dask]
    mpiexec -n 3 python -m mpi4py.futures -m benchmarks.speed.sweep_rate --executors mpi

A cross-spring flexure of about 2,000 dofs is bent in ten increments; thickness, length and
modulus vary. The rate counts the start of the processes once; beside it stands the rate by
processor time of the first rows in this process, which other programs on the machine disturb less.
``dask`` (dask.distributed) and ``mpi`` (mpi4py) run where they are installed, with two workers.
The first rows are compared with those of this process, and the table with that of the executor
before, bit by bit.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import os
import sys
import time
from contextlib import ExitStack
from importlib import import_module
from typing import Any

import numpy as np

import corota as ct

MEASURES = {"moment": "absmax(RM3@hub)", "force": "last(RF2@tip)", "MISES": "max(MISES)"}


def flexure(thickness: float, length: float, E: float) -> tuple[ct.Model, ct.Static]:
    """Strip of 100 x 9 cells, one end held, the other moved across by a tenth of its length."""
    model = ct.Model(ct.mesh.rectangle(length, thickness, nx=100, ny=9))
    model.mesh.node_sets["hub"] = model.mesh.node_indices("left")
    model.mesh.node_sets["tip"] = model.mesh.node_indices("right")
    model.section(element="Q4I", material=ct.Elastic(E=E, nu=0.3))
    model.fix("hub")
    model.fix("tip", x=None, y=0.1 * length)
    return model, ct.Static(increments=10)


def pool(name: str, stack: ExitStack) -> dict[str, Any]:
    """Options of ``ct.sweep`` for an executor by name."""
    if name == "serial":
        return {"workers": 1}
    if name == "processes":
        return {"workers": os.cpu_count() or 1}
    if name == "dask":
        distributed = import_module("distributed")
        cluster = stack.enter_context(
            distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
        )
        client = stack.enter_context(distributed.Client(cluster))
        return {"executor": client.get_executor()}
    futures = import_module("mpi4py.futures")
    return {"executor": stack.enter_context(futures.MPIPoolExecutor())}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--variants", type=int, default=200)
    parser.add_argument("--executors", nargs="+", default=["processes"])
    args = parser.parse_args()
    rows = ct.sample(
        args.variants, {"thickness": (0.2, 0.6), "length": (15.0, 25.0), "E": (7e4, 2.1e5)}
    )
    model, _ = flexure(**rows[0])
    begin = time.process_time()
    first = ct.sweep(flexure, rows[:8], MEASURES, workers=1)
    sys.stdout.write(f"one process: {8 / (time.process_time() - begin):.1f} variants a second\n")
    failed = False
    before: ct.Sweep | None = None
    for name in args.executors:
        with ExitStack() as stack:
            begin = time.perf_counter()
            found = ct.sweep(flexure, rows, MEASURES, **pool(name, stack))
            seconds = time.perf_counter() - begin
        same = all(found[m][:8].tolist() == first[m].tolist() for m in MEASURES)
        if before is not None:
            same &= all(found[m].tolist() == before[m].tolist() for m in MEASURES)
        before = found
        failed |= not same or bool(found.failed)
        sys.stdout.write(
            f"{name}: {len(found)} variants of {2 * model.mesh.n_nodes} dofs in {seconds:.1f} s, "
            f"{args.variants / seconds:.1f} a second, median {np.median(found['seconds']):.3f} s "
            f"a row, {len(found.failed)} failed, "
            f"{'same bits as one process' if same else 'OTHER VALUES'}\n"
        )
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
