"""Time and memory of reading a deck.

``python benchmarks/speed/read_deck.py [nodes] [--before FOLDER]``: the default is 1e6 nodes. With
the folder of an older checkout (with its core) both read the same files in turn, three times; the
smallest processor times and their ratio are printed.

A square of Q4 elements is written as a deck and as Gmsh 4.1 text, and each is read in a
process of its own; the peak of the resident memory is that of the whole process.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import corota as ct

CHILD = """
import sys, time
import corota as ct
def peak_kb():
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmHWM"))
base = peak_kb()
start, begun = time.perf_counter(), time.process_time()
mesh = ct.mesh.read(sys.argv[1])
seconds, cpu = time.perf_counter() - start, time.process_time() - begun
peak = peak_kb()
print(mesh.n_nodes, mesh.n_cells, seconds, peak / 1024, base / 1024, cpu)
"""


def write_deck(mesh: ct.Mesh, path: Path) -> None:
    """Write nodes, elements, one long set and a short step."""
    cells = mesh.cells[0]
    with open(path, "w") as file:
        file.write("*NODE, NSET=nall\n")
        np.savetxt(file, np.column_stack([mesh.node_labels, mesh.points]), "%d, %.15g, %.15g")
        file.write("*ELEMENT, TYPE=CPS4, ELSET=eall\n")
        rows = np.column_stack([cells.labels, mesh.node_labels[cells.nodes]])
        np.savetxt(file, rows, "%d, %d, %d, %d, %d")
        file.write("*NSET, NSET=copy\n")
        labels = mesh.node_labels[: mesh.n_nodes // 10 * 10].reshape(-1, 10)
        np.savetxt(file, labels, ", ".join(["%d"] * 10))
        file.write(
            "*MATERIAL, NAME=m\n*ELASTIC\n1., .3\n*SOLID SECTION, ELSET=eall, MATERIAL=m\n1.\n"
        )


def write_gmsh(mesh: ct.Mesh, path: Path) -> None:
    """Write the same mesh as MSH 4.1 text."""
    cells = mesh.cells[0]
    n, m = mesh.n_nodes, mesh.n_cells
    with open(path, "w") as file:
        file.write("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n")
        file.write(f"1 {n} 1 {n}\n2 1 0 {n}\n")
        np.savetxt(file, mesh.node_labels, "%d")
        np.savetxt(file, np.column_stack([mesh.points, np.zeros(n)]), "%.16g %.16g %g")
        file.write(f"$EndNodes\n$Elements\n1 {m} 1 {m}\n2 1 3 {m}\n")
        rows = np.column_stack([cells.labels, mesh.node_labels[cells.nodes]])
        np.savetxt(file, rows, "%d %d %d %d %d")
        file.write("$EndElements\n")


def read(path: Path, checkout: Path | None = None) -> list[str]:
    """Nodes, cells, seconds, peak and start in MB, processor time; in a process of its own."""
    environment = dict(os.environ)
    if checkout is not None:
        environment["PYTHONPATH"] = str(checkout / "src")
    command = [sys.executable, "-c", CHILD, str(path)]
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=environment)
    return done.stdout.split()


def main(nodes: int, before: Path | None = None) -> None:
    """Print one line a format."""
    side = max(1, round(math.sqrt(nodes)) - 1)
    mesh = ct.mesh.rectangle(1.0, 1.0, side, side)
    mesh = ct.mesh.move(mesh, angle=17.0)
    with tempfile.TemporaryDirectory() as folder:
        for name, write in (("a.inp", write_deck), ("a.msh", write_gmsh)):
            path = Path(folder) / name
            write(mesh, path)
            if before is not None:
                pairs = [[float(read(path, at)[5]) for at in (before, None)] for _ in range(3)]
                old, new = (min(column) for column in zip(*pairs, strict=True))
                print(f"{name[2:]}: before {old:.2f} s, now {new:.2f} s, ratio {new / old:.3f}")
                continue
            n, m, seconds, peak, base, _ = read(path)
            size = path.stat().st_size / 2**20
            print(
                f"{name[2:]}: {int(n):,} nodes, {int(m):,} cells, {size:.0f} MB: "
                f"{float(seconds):.2f} s, peak {float(peak):.0f} MB (start {float(base):.0f} MB)"
            )


if __name__ == "__main__":
    older = sys.argv.index("--before") if "--before" in sys.argv else 0
    numbers = [a for i, a in enumerate(sys.argv[1:], 1) if i not in (older, older + 1) or not older]
    main(
        int(float(numbers[0])) if numbers else 1_000_000,
        Path(sys.argv[older + 1]) if older else None,
    )
