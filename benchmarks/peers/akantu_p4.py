"""P4 with Akantu: finite deformation, trapezoidal rule. Arguments: n, load."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import akantu
import numpy as np

from benchmarks import cantilever as p1
from benchmarks.p4_transient import DT, INCREMENTS


def main() -> None:
    n, load = int(sys.argv[1]), float(sys.argv[2])
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
    model.initFull(_analysis_method=akantu._implicit_dynamic)
    place = {tuple(np.round(x, 7)): k for k, x in enumerate(np.array(mesh.getNodes()))}
    mine = np.array([place[tuple(np.round(x, 7))] for x in points])
    model.getBlockedDOFs()[mine[points[:, 0] == 0.0], :] = True
    solver = model.getNonLinearSolver()
    solver.set("max_iterations", 50)
    solver.set("threshold", 1e-6)
    solver.set("convergence_type", akantu.SolveConvergenceCriteria.residual)
    model.setTimeStep(DT)
    force, displacement = model.getExternalForce(), model.getDisplacement()
    shares = p1.tip_shares(points)
    nodes, weights = mine[list(shares)], np.array(list(shares.values()))
    force[nodes, 1] = load * weights
    tip = mine[p1.tip_middle(points)]
    iterations, most, begin = 0, 0.0, time.perf_counter()
    for _ in range(INCREMENTS):
        model.solveStep()
        iterations += solver.getInt("nb_iterations")
        most = max(most, float(displacement[tip, 1]))
    seconds = time.perf_counter() - begin
    result = {"seconds": seconds, "iterations": iterations, "most": most}
    sys.stdout.write(json.dumps(result) + "\n")


if __name__ == "__main__":
    main()
