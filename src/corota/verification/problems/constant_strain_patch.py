"""MacNeal and Harder's patch: constant strain on five distorted cells, for every element.

0.24 x 0.12, thickness 0.001, E = 1e6, nu = 0.25; the boundary has the displacement u = 1e-3 (x +
y/2), v = 1e-3 (y + x/2) and the corresponding drilling rotations. The stresses must be 4000/3,
4000/3 and 400 to rounding everywhere. A second patch is loaded by its edge tractions and supported
at two nodes. Drilling elements pass it with free rotations because their edge loads include end
moments.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Value, zero
from corota.verification.models import DRILLING, ELEMENTS, boundary, cell, prescribe, run

POINTS = np.array(
    [[0, 0], [0.24, 0], [0.24, 0.12], [0, 0.12], [0.04, 0.02], [0.18, 0.03], [0.16, 0.08],
     [0.08, 0.08]]
)  # fmt: skip
QUADS = np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]])
STRESS = np.array([4000 / 3, 4000 / 3, 0.0, 400.0])
SIDES = {(0, -1): (1, 0.0), (1, 0): (0, 0.24), (0, 1): (1, 0.12), (-1, 0): (0, 0.0)}


def patch(element: str) -> ct.Mesh:
    """The five cells, as squares or triangles, with middle nodes where wanted."""
    mesh = ct.Mesh(POINTS, [ct.Cells("quad4", QUADS, np.arange(1, 6))])
    kind = cell(element)
    if kind.startswith("tri"):
        mesh = ct.mesh.to_triangles(mesh)
    if kind in ("tri6", "quad8", "quad9"):
        mesh = ct.mesh.to_quadratic(mesh, center=kind == "quad9")
    return mesh


def _model(element: str) -> ct.Model:
    model = ct.Model(patch(element))
    material = ct.Elastic(E=1e6, nu=0.25)
    model.section("all", element=element, material=material, thickness=0.001)
    return model


def moved(element: str) -> ct.Results:
    """The patch with all of its boundary moved."""
    model = _model(element)
    x, y = model.mesh.points.T
    u = 1e-3 * np.stack([x + y / 2, y + x / 2], axis=1)
    edge = boundary(model.mesh)
    prescribe(model, edge, u[edge], 0.0 if element in DRILLING else None)
    return run(model, ct.Static(nlgeom=False), fields=True)


def pulled(element: str) -> ct.Results:
    """The patch under its edge tractions, supported against rigid motion only."""
    model = _model(element)
    mesh, edges = model.mesh, model.mesh.boundary_edges()
    ends = np.array([mesh.points[list(nodes)[:2]].mean(axis=0) for nodes in mesh.edge_nodes(edges)])
    tensor = np.array([[STRESS[0], STRESS[3]], [STRESS[3], STRESS[1]]])
    for normal, (axis, place) in SIDES.items():
        mine = edges[np.abs(ends[:, axis] - place) < 1e-9]
        t = tensor @ normal
        model.loads.append(ct.EdgeLoad(mine, "traction", (float(t[0]), float(t[1]))))
    model.fix([0])
    model.fix([1], x=None, y=0.5e-3 * 0.24)
    return run(model, ct.Static(nlgeom=False), fields=True)


def stress_error(results: ct.Results) -> float:
    """Largest error of the stress at the points over the largest stress."""
    worst = 0.0
    for block in results.frames[-1].fields:
        worst = max(worst, float(np.abs(block.values["S"] - STRESS).max()))
    return worst / float(STRESS[0])


def measure() -> Iterator[Value]:
    """Stress of both patches."""
    for element in ELEMENTS:
        yield zero(f"stress error, moved boundary, {element}", stress_error(moved(element)), 1e-11)
    for element in ELEMENTS:
        if element != "Q8R":
            yield zero(
                f"stress error, edge tractions, {element}", stress_error(pulled(element)), 1e-9
            )


PROBLEM = Problem(
    title="Constant-strain patch",
    group="linear statics",
    source="R. H. MacNeal, R. L. Harder, Finite Elements in Analysis and Design 1 (1985)",
    certainty="analytic",
    why="rounding; with tractions rounding times the condition number",
    picture=lambda: Picture(moved("Q8"), "U1", 100.0),
    seconds=0.3,
)
