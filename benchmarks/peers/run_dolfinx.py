"""P1 and P4 with DOLFINx: bilinear St. Venant-Kirchhoff, MUMPS, trapezoidal rule."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import dolfinx
import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

from benchmarks.peers.shared import (
    MAX_ITERATIONS,
    Clock,
    arguments,
    place,
    plane_stress,
    tolerance,
)


def main() -> None:
    p, _ = arguments()
    # Corners go row by row here.
    shape = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell("quadrilateral", 2), 1))
    domain = mesh.create_mesh(MPI.COMM_SELF, p.cells[:, [0, 1, 3, 2]], p.points, shape)
    space = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    mine = place(p.points, space.tabulate_dof_coordinates()[:, :2])
    held = (2 * mine[p.held_nodes] + p.held_dofs).astype(np.int32)
    loaded = 2 * mine[p.load_nodes] + p.load_dofs
    degree = {"quadrature_degree": 2}
    dx = ufl.Measure("dx", domain=domain, metadata=degree)
    lam, mu = plane_stress(p.young, p.poisson)
    u = fem.Function(space)
    test, trial = ufl.TestFunction(space), ufl.TrialFunction(space)
    gradient = ufl.Identity(2) + ufl.grad(u)
    strain = 0.5 * (gradient.T * gradient - ufl.Identity(2))
    energy = lam / 2.0 * ufl.tr(strain) ** 2 + mu * ufl.inner(strain, strain)
    residual = ufl.derivative(p.thickness * energy * dx, u, test)
    force_form, tangent_form = fem.form(residual), fem.form(ufl.derivative(residual, u, trial))
    matrix, vector = petsc.create_matrix(tangent_form), petsc.create_vector(force_form)
    transient = p.name == "P4"
    step = p.period / p.increments
    mass = None
    if transient:
        inertia = p.density * p.thickness * ufl.inner(trial, test) * dx
        mass = petsc.assemble_matrix(fem.form(inertia))
        mass.assemble()
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setOperators(matrix)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    change, product = matrix.createVecRight(), matrix.createVecRight()
    external = np.zeros(len(u.x.array))
    velocity, acceleration = external.copy(), external.copy()

    def times_mass(values: np.ndarray) -> np.ndarray:
        change.array[:] = values
        mass.mult(change, product)
        return product.array.copy()

    if transient:  # the force acts at once: M a = f at the start
        external[loaded] = p.load_values
        vector.array[:] = external
        vector.array[held] = 0.0
        clamped = mass.copy()
        clamped.zeroRowsColumns(held, 1.0)
        solver.setOperators(clamped)
        solver.solve(vector, change)
        acceleration = change.array.copy()
        solver.setOperators(matrix)
    tip = 2 * mine[p.watch[0]]
    iterations, most = 0, 0.0
    clock = Clock()
    for k in range(1, p.last + 1):
        if not transient:
            external[loaded] = p.load_values * k / p.increments
        start = u.x.array.copy()
        first = 0.0
        for attempt in range(MAX_ITERATIONS):
            with vector.localForm() as local:
                local.set(0.0)
            petsc.assemble_vector(vector, force_form)
            vector.array[:] -= external
            if transient:
                now = 4.0 / step**2 * (u.x.array - start - step * velocity) - acceleration
                vector.array[:] += times_mass(now)
            vector.array[held] = 0.0
            norm = vector.norm()
            first = first or norm
            if attempt and norm <= tolerance(p) * first:
                break
            matrix.zeroEntries()
            petsc.assemble_matrix(matrix, tangent_form)
            matrix.assemble()
            if transient:
                matrix.axpy(4.0 / step**2, mass, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
            matrix.zeroRowsColumns(held, 1.0)
            solver.solve(vector, change)
            u.x.array[:] -= change.array
            iterations += 1
        else:
            raise SystemExit(f"increment {k} did not converge")
        if transient:
            velocity = velocity + 0.5 * step * (acceleration + now)
            acceleration = now
        most = max(most, float(u.x.array[tip + 1]))
    result = [most] if transient else u.x.array[tip : tip + 2].tolist()
    clock.tell(dolfinx.__version__, iterations, result)


if __name__ == "__main__":
    main()
