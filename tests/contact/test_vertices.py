"""A block on a spring slides over a hill: up its slope, over its vertices, down; forces by hand."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct

#: Of the hill.
HEIGHT, FOOT, FLAT = 0.36, 1.2, 1.6
STIFFNESS, WEIGHT = 100.0, 10.0
CELLS = {"Q8": "quad8", "T3": "tri3"}


def hill(slope: float) -> tuple[list[float], list[float]]:
    """Vertices of the profile."""
    run = HEIGHT / slope
    x = [-2.0, FOOT, FOOT + run, FOOT + run + FLAT, FOOT + 2.0 * run + FLAT, 8.0]
    return x, [0.0, 0.0, HEIGHT, HEIGHT, 0.0, 0.0]


def block_on_hill(
    element: str, method: str, friction: float, slope: float, rigid: bool, way: float
) -> ct.Model:
    """A hard block of four edges, pushed along by `way`; its sides are part of the surface."""
    x, y = hill(slope)
    cell = CELLS.get(element, "quad4")
    mesh = ct.mesh.rectangle(1.0, 1.0, 4, 4, cell)
    if not rigid:
        bottom, right, top, left = (
            lambda t: (-2.0 + 10.0 * t, -1.0),
            lambda t: (8.0, -1.0 + t),
            lambda t: (-2.0 + 10.0 * t, float(np.interp(-2.0 + 10.0 * t, x, y))),
            lambda t: (-2.0, -1.0 + t),
        )
        # Edges of .2 begin at the vertices.
        ground = ct.mesh.mapped([bottom, right, top, left], 50, 2, cell)
        mesh = ct.mesh.assembly(block=mesh, ground=ground)
    name = "" if rigid else "block."
    ref = ct.mesh.add_node(mesh, 0.5, 1.0, name="ref")
    solids = mesh.n_cells
    mesh.cells.append(ct.Cells("point1", np.array([[ref]]), np.array([solids + 1])))
    model = ct.Model(mesh)
    model.section(list(range(solids)), element=element, material=ct.Elastic(E=1e7, nu=0.3))
    model.spring([solids], STIFFNESS, "y")
    model.force([ref], y=-WEIGHT)
    model.rigid(f"{name}top", ref)
    model.fix("ref", x=way, y=None, rotation=0.0)
    master: Any = "ground.top"
    if rigid:
        master = ct.RigidCurve.polyline(list(zip(x, y, strict=True)))
    else:
        model.fix("ground.bottom")
    slave: Any = [f"{name}{side}" for side in ("bottom", "right", "left")]
    model.contact(slave, master, friction=friction, method=method, name="hill")
    return model


@pytest.mark.parametrize(
    ("place", "increments"), [("up", None), ("over", None), ("down", None), ("over", 20)]
)
@pytest.mark.parametrize("friction", [0.0, 0.2])
@pytest.mark.parametrize(("slope", "rigid"), [(0.3, True), (0.9, True), (0.9, False)])
@pytest.mark.parametrize("element", ["Q4I", "Q8", "T3"])
@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
def test_a_block_slides_over_a_hill(
    method: str,
    element: str,
    slope: float,
    rigid: bool,
    friction: float,
    place: str,
    increments: int | None,
) -> None:
    run = HEIGHT / slope
    # The front stands on the slope, the foot of the block over a vertex, its back on the way down.
    way = {
        "up": FOOT + 0.5 * run - 1.0,
        "over": FOOT + run - 0.47,
        "down": FOOT + 1.5 * run + FLAT,
    }[place]
    model = block_on_hill(element, method, friction, slope, rigid, way)
    step = ct.Static() if increments is None else ct.Static(increments=increments)
    last = ct.solve(model, step, threads=1).frames[-1]
    rise = HEIGHT if place == "over" else 0.5 * HEIGHT
    steep = {"up": slope, "over": 0.0, "down": -slope}[place]
    normal = WEIGHT + STIFFNESS * rise
    along = normal * (friction + steep) / (1.0 - friction * steep)
    ref = int(model.mesh.nodes_of("ref")[0])
    assert last.U[ref, 1] == pytest.approx(rise, rel=1e-3)
    assert last.RF[ref, 0] == pytest.approx(along, abs=1e-3 * normal)
