"""Compliance of a cantilever by nodal densities and its gradient with JAX-FEM.

``python run_jax_fem.py TASK.npz RESULT.npz``; see ``differentiable``. Needs no other module of the
benchmarks. Where petsc4py is missing a stand-in holds the matrices that JAX-FEM passes to SciPy's
solver: the only thing that it uses PETSc for there.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import importlib.util
import sys
import time
import types

import numpy as np
import scipy.sparse as sp


class Matrix:
    """What JAX-FEM asks of a PETSc matrix."""

    def createAIJ(self, size, csr):
        self.rows = sp.csr_array((csr[2], csr[1], csr[0]), shape=size)
        return self

    def zeroRows(self, rows):
        kept = np.ones(self.rows.shape[0])
        kept[rows] = 0.0
        self.rows = (sp.diags_array(kept) @ self.rows + sp.diags_array(1.0 - kept)).tocsr()

    def getValuesCSR(self):
        return self.rows.indptr, self.rows.indices, self.rows.data

    def getSize(self):
        return self.rows.shape

    def transpose(self):
        other = Matrix()
        other.rows = self.rows.T.tocsr()
        return other


def provide_matrices():
    """Let JAX-FEM import petsc4py, which may be missing."""
    if importlib.util.find_spec("petsc4py") is not None:
        return
    stand_in = types.ModuleType("petsc4py.PETSc")
    stand_in.Mat, stand_in.IntType = Matrix, np.int32
    package = types.ModuleType("petsc4py")
    package.PETSc = stand_in
    sys.modules.update({"petsc4py": package, "petsc4py.PETSc": stand_in})


def cantilever(task):
    """Plane strain with a stiffness that is interpolated from the nodes."""
    import jax.numpy as jnp
    from jax_fem.generate_mesh import Mesh
    from jax_fem.problem import Problem

    class Cantilever(Problem):
        def get_tensor_map(self):
            def stress(gradient, stiffness):
                young, nu = task["young"] * stiffness[0], task["poisson"]
                shear = young / (2.0 * (1.0 + nu))
                bulk = young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
                strain = 0.5 * (gradient + gradient.T)
                return bulk * jnp.trace(strain) * jnp.eye(2) + 2.0 * shear * strain

            return stress

        def get_surface_maps(self):
            return [lambda u, x: jnp.array([0.0, task["load"] / task["height"]])]

        def set_params(self, density):
            least = task["least"]
            stiffness = least + (1.0 - least) * density**3
            fe = self.fes[0]
            at_points = jnp.einsum("qn,cn->cq", fe.shape_vals, stiffness[fe.cells])
            self.internal_vars = [at_points[..., None]]

    length = float(task["points"][:, 0].max())

    def left(point):
        return jnp.isclose(point[0], 0.0, atol=1e-6)

    def right(point):
        return jnp.isclose(point[0], length, atol=1e-6)

    def zero(point):
        return 0.0

    mesh = Mesh(task["points"], task["cells"], ele_type="QUAD4")
    held = [[left, left], [0, 1], [zero, zero]]
    return Cantilever(
        mesh, vec=2, dim=2, ele_type="QUAD4", dirichlet_bc_info=held, location_fns=[right]
    )


def main():
    """Solve a task some times and store values and times."""
    provide_matrices()
    import jax
    import jax.numpy as jnp
    from jax_fem import logger
    from jax_fem.solver import ad_wrapper

    jax.config.update("jax_enable_x64", True)
    logger.setLevel("ERROR")
    stored = np.load(sys.argv[1])
    task = {k: (float(v) if v.ndim == 0 else v) for k, v in stored.items()}
    options = {"umfpack_solver": {}}
    predict = ad_wrapper(cantilever(task), solver_options=options, adjoint_solver_options=options)
    force = jnp.asarray(task["force"])

    def compliance(density):
        return -jnp.sum(force * predict(density)[0][:, 1])

    density = jnp.asarray(task["density"])
    value, slope = jax.value_and_grad(compliance)(density)
    begin = time.perf_counter()
    for _ in range(int(task["repeats"])):
        value = compliance(density).block_until_ready()
    forward = (time.perf_counter() - begin) / task["repeats"]
    begin = time.perf_counter()
    for _ in range(int(task["repeats"])):
        value, slope = jax.value_and_grad(compliance)(density)
        slope.block_until_ready()
    both = (time.perf_counter() - begin) / task["repeats"]
    np.savez(sys.argv[2], value=value, slope=slope, forward=forward, both=both)


if __name__ == "__main__":
    main()
