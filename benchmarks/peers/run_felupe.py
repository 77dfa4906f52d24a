"""P1 with FElupe: total-Lagrangian St. Venant-Kirchhoff in NumPy, SuperLU."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import felupe
import numpy as np
from scipy.sparse.linalg import splu

from benchmarks.peers.shared import (
    MAX_ITERATIONS,
    Clock,
    arguments,
    piola,
    plane_stress,
    tolerance,
)


class Law:
    """A law in the plane with the two methods that FElupe calls."""

    def __init__(self, lam: float, mu: float) -> None:
        self.x = [np.zeros((2, 2)), np.zeros(0)]
        self.constants = lam, mu

    def gradient(self, x):
        return [piola(x[0], *self.constants)[0], x[-1]]

    def hessian(self, x):
        return [piola(x[0], *self.constants)[1]]


def main() -> None:
    p, _ = arguments()
    mesh = felupe.Mesh(p.points, p.cells, "quad")
    displacement = felupe.Field(felupe.RegionQuad(mesh), dim=2)
    field = felupe.FieldContainer([displacement])
    body = felupe.SolidBody(Law(*plane_stress(p.young, p.poisson)), field)
    held = 2 * p.held_nodes + p.held_dofs
    free = np.setdiff1d(np.arange(p.n_dofs), held)
    whole = np.zeros(p.n_dofs)
    whole[2 * p.load_nodes + p.load_dofs] = p.load_values / p.thickness
    iterations = 0
    clock = Clock()
    for k in range(1, p.last + 1):
        external = whole * k / p.increments
        first = 0.0
        for attempt in range(MAX_ITERATIONS):
            residual = external - body.assemble.vector(field).toarray().ravel()
            norm = float(np.linalg.norm(residual[free]))
            first = first or norm
            if attempt and norm <= tolerance(p) * first:
                break
            matrix = body.assemble.matrix(field).tocsr()
            change = np.zeros(p.n_dofs)
            change[free] = splu(matrix[free][:, free].tocsc()).solve(residual[free])
            displacement.values[:] += change.reshape(-1, 2)
            iterations += 1
        else:
            raise SystemExit(f"increment {k} did not converge")
    clock.tell(felupe.__version__, iterations, displacement.values[p.watch[0]])


if __name__ == "__main__":
    main()
