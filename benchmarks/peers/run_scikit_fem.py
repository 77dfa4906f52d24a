"""P1 with scikit-fem: total-Lagrangian St. Venant-Kirchhoff in NumPy, SuperLU."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import skfem
from scipy.sparse.linalg import splu

from benchmarks.peers.shared import (
    MAX_ITERATIONS,
    Clock,
    arguments,
    piola,
    place,
    plane_stress,
    tolerance,
)


@skfem.BilinearForm
def stiffness(u, v, w):
    return np.einsum("ijkl...,kl...,ij...->...", w["tangent"], u.grad, v.grad, optimize=True)


@skfem.LinearForm
def force(v, w):
    return np.einsum("ij...,ij...->...", w["stress"], v.grad)


def main() -> None:
    p, _ = arguments()
    mesh = skfem.MeshQuad(p.points.T.copy(), p.cells.T.copy())
    kind = {4: skfem.ElementQuad1, 8: skfem.ElementQuadS2}[p.cells.shape[1]]()
    basis = skfem.Basis(mesh, skfem.ElementVector(kind), intorder=2 if len(p.cells[0]) == 4 else 4)
    mine = place(p.points, basis.doflocs[:, 0::2].T)
    held = 2 * mine[p.held_nodes] + p.held_dofs
    free = np.setdiff1d(np.arange(basis.N), held)
    whole = np.zeros(basis.N)
    whole[2 * mine[p.load_nodes] + p.load_dofs] = p.load_values / p.thickness
    lam, mu = plane_stress(p.young, p.poisson)
    u = basis.zeros()
    iterations = 0
    clock = Clock()
    for k in range(1, p.last + 1):
        external = whole * k / p.increments
        first = 0.0
        for attempt in range(MAX_ITERATIONS):
            gradient = np.array(basis.interpolate(u).grad)
            gradient[0, 0] += 1.0
            gradient[1, 1] += 1.0
            stress, tangent = piola(gradient, lam, mu)
            residual = external - force.assemble(basis, stress=stress)
            norm = float(np.linalg.norm(residual[free]))
            first = first or norm
            if attempt and norm <= tolerance(p) * first:
                break
            matrix = stiffness.assemble(basis, tangent=tangent)
            u[free] += splu(matrix[free][:, free].tocsc()).solve(residual[free])
            iterations += 1
        else:
            raise SystemExit(f"increment {k} did not converge")
    tip = 2 * mine[p.watch[0]]
    clock.tell(skfem.__version__, iterations, u[tip : tip + 2])


if __name__ == "__main__":
    main()
