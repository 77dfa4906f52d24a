"""A stage on two parallel leaf flexures: rigid links by a constraint, and a return spring.

The leaves are strips of drilling quadrilaterals. The stage is a rigid body; its reference node
stands in the middle between the leaf ends, where the driving force and the spring act. While
it moves sideways by d it moves down by nearly 3 d^2 / (5 L), and hardly rotates.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np

import corota as ct
from corota.mesh.data import Cells

LENGTH, HEIGHT, SPAN = 50.0, 0.5, 30.0
YOUNG, SPRING = 2.0e5, 2.0


def guide(force: float = 20.0, nx: int = 40) -> tuple[ct.Model, int]:
    """Build the guide; the model and the reference node of its stage."""
    leaf = ct.mesh.rectangle(HEIGHT, LENGTH, nx=1, ny=nx, cell="quad4")
    n = leaf.n_nodes
    points = np.vstack(
        [leaf.points, leaf.points + np.array([SPAN, 0.0]), [[0.5 * (SPAN + HEIGHT), LENGTH]]]
    )
    quads = leaf.cells[0].nodes
    stage = 2 * n
    cells = [
        Cells("quad4", np.vstack([quads, quads + n]), np.arange(1, 2 * len(quads) + 1)),
        Cells("point1", np.array([[stage]]), np.array([10_000])),
    ]
    low, top = leaf.nodes_of("bottom"), leaf.nodes_of("top")
    mesh = replace(
        leaf,
        points=points,
        cells=cells,
        node_labels=np.arange(1, len(points) + 1),
        node_sets={"feet": np.concatenate([low, low + n]), "ends": np.concatenate([top, top + n])},
        cell_sets={},
        edge_sets={},
    )
    model = ct.Model(mesh, name="guide")
    model.section(
        np.arange(2 * len(quads)), element="Q4D", material=ct.Elastic(E=YOUNG), thickness=5.0
    )
    model.spring([2 * len(quads)], SPRING, "x")
    model.fix("feet", rotation=True)
    model.rigid("ends", stage)
    model.force([stage], x=force)
    return model, stage


def main() -> ct.Results:
    model, stage = guide()
    results = ct.solve(model, ct.Static(increments=10))
    last = results.frames[-1]
    across, down = last.U[stage]
    sys.stdout.write(
        f"The stage moves by {across:.3f} across and {down:.3f} down "
        f"(3 d^2 / 5 L = {0.6 * across**2 / LENGTH:.3f}) and turns by {last.UR[stage]:.2e};\n"
        f"the spring takes {SPRING * across:.2f} of 20.\n"
    )
    return results


if __name__ == "__main__":
    main()
