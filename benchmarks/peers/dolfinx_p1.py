"""P1 with DOLFINx 0.5: bilinear St. Venant-Kirchhoff, MUMPS. Arguments: n, tolerance."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import sys
import time

import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

from benchmarks import cantilever as p1


def main() -> None:
    n, tolerance = int(sys.argv[1]), float(sys.argv[2])
    start = time.perf_counter()
    corners = [[0.0, 0.0], [p1.LENGTH, p1.HEIGHT]]
    domain = mesh.create_rectangle(MPI.COMM_SELF, corners, [10 * n, n], mesh.CellType.quadrilateral)
    space = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    left = mesh.locate_entities_boundary(domain, 1, lambda x: np.isclose(x[0], 0.0))
    right = mesh.locate_entities_boundary(domain, 1, lambda x: np.isclose(x[0], p1.LENGTH))
    zero = np.zeros(2, dtype=PETSc.ScalarType)
    clamp = fem.dirichletbc(zero, fem.locate_dofs_topological(space, 1, left), space)
    tags = mesh.meshtags(domain, 1, np.sort(right), np.full(len(right), 1, dtype=np.int32))
    dx = ufl.Measure("dx", domain=domain, metadata={"quadrature_degree": 2})
    ds = ufl.Measure("ds", domain=domain, subdomain_data=tags)
    lam = p1.YOUNG * p1.POISSON / (1.0 - p1.POISSON**2)  # plane stress
    mu = p1.YOUNG / (2.0 * (1.0 + p1.POISSON))
    u = fem.Function(space)
    traction = fem.Constant(domain, PETSc.ScalarType(0.0))
    gradient = ufl.Identity(2) + ufl.grad(u)
    strain = 0.5 * (gradient.T * gradient - ufl.Identity(2))
    energy = lam / 2.0 * ufl.tr(strain) ** 2 + mu * ufl.inner(strain, strain)
    potential = p1.THICKNESS * (energy * dx - traction * u[1] * ds(1))
    residual = ufl.derivative(potential, u, ufl.TestFunction(space))
    tangent = ufl.derivative(residual, u, ufl.TrialFunction(space))
    residual_form, tangent_form = fem.form(residual), fem.form(tangent)
    matrix = petsc.create_matrix(tangent_form)
    vector = petsc.create_vector(residual_form)
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setOperators(matrix)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    step = matrix.createVecRight()
    ready = time.perf_counter()
    iterations = 0
    for k in range(1, p1.INCREMENTS + 1):
        traction.value = p1.SHEAR / p1.HEIGHT * k / p1.INCREMENTS
        first = 0.0
        for attempt in range(50):
            with vector.localForm() as local:
                local.set(0.0)
            petsc.assemble_vector(vector, residual_form)
            petsc.set_bc(vector, [clamp], u.vector, -1.0)
            norm = vector.norm()
            first = first or norm
            if attempt and norm <= tolerance * first:
                break
            matrix.zeroEntries()
            petsc.assemble_matrix(matrix, tangent_form, [clamp])
            matrix.assemble()
            solver.solve(vector, step)
            u.x.array[:] -= step.array_r
            iterations += 1
        else:
            raise SystemExit(f"increment {k} did not converge")
    done = time.perf_counter()
    positions = space.tabulate_dof_coordinates()
    points, _ = p1.grid(n)
    target = points[p1.tip_middle(points)]
    node = int(np.argmin(np.abs(positions[:, :2] - target).sum(axis=1)))
    tip = u.x.array.reshape(-1, 2)[node]
    result = {"setup": ready - start, "solve": done - ready, "iterations": iterations}
    sys.stdout.write(json.dumps({**result, "u": float(tip[0]), "v": float(tip[1])}) + "\n")


if __name__ == "__main__":
    main()
