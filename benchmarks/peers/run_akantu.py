"""P1 and P4 with Akantu: finite-deformation quadrilaterals, MUMPS, trapezoidal rule."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from importlib.metadata import version
from pathlib import Path

import akantu
import numpy as np

from benchmarks.peers.shared import MAX_ITERATIONS, Clock, arguments, place, tolerance


def main() -> None:
    p, _ = arguments()
    Path("material.dat").write_text(
        f"material elastic [\n  name = m\n  rho = {p.density}\n"
        f"  E = {p.young}\n  nu = {p.poisson}\n"
        "  Plane_Stress = true\n  finite_deformation = true\n]\n",
        encoding="ascii",
    )
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(p.points))]
    lines += [f"{k + 1} {x:.12g} {y:.12g} 0" for k, (x, y) in enumerate(p.points.tolist())]
    lines += ["$EndNodes", "$Elements", str(len(p.cells))]
    kind = {4: 3, 8: 16}[p.cells.shape[1]]
    lines += [
        f"{k + 1} {kind} 2 1 1 " + " ".join(map(str, nodes))
        for k, nodes in enumerate((p.cells + 1).tolist())
    ]
    lines.append("$EndElements\n")
    Path("mesh.msh").write_text("\n".join(lines), encoding="ascii")
    akantu.parseInput("material.dat")
    mesh = akantu.Mesh(2)
    mesh.read("mesh.msh")
    model = akantu.SolidMechanicsModel(mesh)
    transient = p.name == "P4"
    kind = akantu._implicit_dynamic if transient else akantu._static
    model.initFull(_analysis_method=kind)
    # The order of nodes may differ from the file's.
    mine = place(p.points, np.array(mesh.getNodes()))
    model.getBlockedDOFs()[mine[p.held_nodes], p.held_dofs] = True
    solver = model.getNonLinearSolver()
    solver.set("max_iterations", MAX_ITERATIONS)
    solver.set("threshold", tolerance(p))
    solver.set("convergence_type", akantu.SolveConvergenceCriteria.residual)
    if transient:
        model.setTimeStep(p.period / p.increments)
    force, displacement = model.getExternalForce(), model.getDisplacement()
    tip = mine[p.watch[0]]
    iterations, most = 0, 0.0
    clock = Clock()
    for k in range(1, p.last + 1):
        # Akantu's planar models have unit thickness.
        share = 1.0 if transient else k / p.increments
        force[mine[p.load_nodes], p.load_dofs] = share * p.load_values / p.thickness
        model.solveStep()
        iterations += solver.getInt("nb_iterations")
        most = max(most, float(displacement[tip, 1]))
    result = [most] if transient else displacement[tip].tolist()
    clock.tell(version("akantu"), iterations, result)


if __name__ == "__main__":
    main()
