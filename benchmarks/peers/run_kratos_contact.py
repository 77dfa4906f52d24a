"""P3 with Kratos: mortar contact by augmented Lagrange multipliers, sparse LU."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import KratosMultiphysics as Kratos

from benchmarks.corpora.problems import Problem
from benchmarks.peers.contact_data import ContactData, Face, Pair, Stage
from benchmarks.peers.run_kratos_problem import parameters, start
from benchmarks.peers.shared import MAX_ITERATIONS, TOLERANCE, Clock, arguments


def contact_data(p: Problem) -> ContactData:
    """P3 in the increments that are run."""
    share = p.last / p.increments
    driven = zip(p.held_nodes.tolist(), p.held_dofs.tolist(), p.held_values.tolist(), strict=True)
    return ContactData(
        points=p.points.tolist(),
        cells=p.cells.tolist(),
        element="Q4",
        young=p.young,
        poisson=p.poisson,
        density=p.density,
        thickness=p.thickness,
        plane="stress",
        pairs=[Pair(Face([], p.slave.tolist()), Face([], p.master.tolist()), p.friction)],
        stages=[Stage(share / p.last, share, [(n, dof, share * v) for n, dof, v in driven])],
        watched=p.watch.tolist(),
    )


def main() -> None:
    p, _ = arguments()
    data = contact_data(p)
    settings = parameters(data, "ALM")
    settings["solver_settings"] |= {
        "residual_relative_tolerance": TOLERANCE,
        "residual_absolute_tolerance": 1e-10,
        "max_iteration": MAX_ITERATIONS,
    }
    analysis = start(data, settings)
    clock = Clock()
    iterations, force = 0, 0.0
    for row in analysis.rows([p.last]):
        if not row["converged"]:
            raise SystemExit(f"time {row['time']:g} did not converge")
        iterations += row["iterations"]
        force = row["force"][1]
    clock.tell(Kratos.KratosGlobals.Kernel.Version(), iterations, [force])


if __name__ == "__main__":
    main()
