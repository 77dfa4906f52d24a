"""P1 with Akantu: finite-deformation quadrilaterals, MUMPS. Arguments: n, tolerance."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import akantu
import numpy as np

from benchmarks import cantilever as p1


def main() -> None:
    n, tolerance = int(sys.argv[1]), float(sys.argv[2])
    start = time.perf_counter()
    points, cells = p1.grid(n)
    Path("material.dat").write_text(
        "material elastic [\n  name = m\n  rho = 1.\n"
        f"  E = {p1.YOUNG}\n  nu = {p1.POISSON}\n"
        "  Plane_Stress = true\n  finite_deformation = true\n]\n",
        encoding="ascii",
    )
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
    lines += [f"{k + 1} {x:.12g} {y:.12g} 0" for k, (x, y) in enumerate(points.tolist())]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [
        f"{k + 1} 3 2 1 1 " + " ".join(map(str, nodes))
        for k, nodes in enumerate((cells + 1).tolist())
    ]
    lines.append("$EndElements\n")
    Path("mesh.msh").write_text("\n".join(lines), encoding="ascii")
    akantu.parseInput("material.dat")
    mesh = akantu.Mesh(2)
    mesh.read("mesh.msh")
    model = akantu.SolidMechanicsModel(mesh)
    model.initFull(_analysis_method=akantu._static)
    # The order of nodes may differ from the file's.
    place = {tuple(np.round(x, 7)): k for k, x in enumerate(np.array(mesh.getNodes()))}
    mine = np.array([place[tuple(np.round(x, 7))] for x in points])
    model.getBlockedDOFs()[mine[points[:, 0] == 0.0], :] = True
    solver = model.getNonLinearSolver()
    solver.set("max_iterations", 50)
    solver.set("threshold", tolerance)
    solver.set("convergence_type", akantu.SolveConvergenceCriteria.residual)
    force, displacement = model.getExternalForce(), model.getDisplacement()
    shares = p1.tip_shares(points)
    nodes, weights = mine[list(shares)], np.array(list(shares.values()))
    ready = time.perf_counter()
    iterations = 0
    for k in range(1, p1.INCREMENTS + 1):
        # Akantu's planar models have unit thickness.
        force[nodes, 1] = p1.SHEAR * weights * k / p1.INCREMENTS
        model.solveStep()
        iterations += solver.getInt("nb_iterations")
    done = time.perf_counter()
    u, v = displacement[mine[p1.tip_middle(points)]]
    result = {"setup": ready - start, "solve": done - ready, "iterations": iterations}
    sys.stdout.write(json.dumps({**result, "u": float(u), "v": float(v)}) + "\n")


if __name__ == "__main__":
    main()
