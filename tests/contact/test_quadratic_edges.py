"""Mortar contact of quadratic edges: all nodes have constraints."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct

CELLS = {"Q8R": "quad8", "Q8": "quad8", "T6": "tri6"}
RADIUS, THICK, ROLLER, WAY, E = 10.0, 0.2, 3.0, 0.02, 1e5


def squeezed(element: str, role: str, count: int, friction: float, start: float) -> float:
    """Force of a thin ring between rollers over that of a curved beam.

    F R^3 / 2 EI ((a + sin a cos a) / 2 sin^2 a - 1 / a), a = pi / count. The mesh begins at an
    angle of `start` degrees: rollers meet its 90 edges at corners or at mid-side nodes.
    """
    inner, outer = RADIUS - THICK / 2.0, RADIUS + THICK / 2.0
    cell = CELLS[element]
    bodies = {"ring": ct.mesh.annulus(inner, outer, 1, 90, cell=cell, start=start)}
    angles = 2.0 * math.pi / count * (0.5 + np.arange(count))
    away = np.column_stack([np.cos(angles), np.sin(angles)])
    centers = (outer + ROLLER) * away
    if role != "rigid":
        for k, center in enumerate(centers):
            solid = ct.mesh.annulus(1.5, ROLLER, 2, 90, cell=cell, center=tuple(center))
            bodies[f"roller{k}"] = solid
    mesh = ct.mesh.assembly(**bodies)
    model = ct.Model(mesh)
    model.section("ring", element=element, material=ct.Elastic(E=E))
    for k, (center, out) in enumerate(zip(centers, away, strict=True)):
        pair = ["ring.outer", f"roller{k}.outer"]
        if role == "rigid":
            node = ct.mesh.add_node(mesh, *center, f"{k}")
            pair[1] = ct.RigidCurve.circle(center, ROLLER, reference=node)
            model.fix(f"{k}", x=-WAY * out[0], y=-WAY * out[1], rotation=True)
        else:
            model.section(f"roller{k}", element=element, material=ct.Elastic(E=1e7))
            model.fix(f"roller{k}.inner", x=-WAY * out[0], y=-WAY * out[1])
        model.contact(*(pair[::-1] if role == "slave" else pair), friction=friction, name=f"{k}")
    # Midway between two rollers the ring does not turn; two without friction let it move along.
    bore = mesh.node_sets["ring.inner"]
    side = bore[np.argmin(np.hypot(*(mesh.points[bore] - (inner, 0.0)).T))]
    model.fix([side], x=0.0 if count == 2 and friction == 0.0 else None, y=0.0)
    results = ct.solve(model, threads=1)
    force = [results.history(f"0: force {c}")[-1] for c in "xy"]
    a = math.pi / count
    soft = 0.5 * ((a + math.sin(a) * math.cos(a)) / (2.0 * math.sin(a) ** 2) - 1.0 / a)
    return math.hypot(*force) / (WAY * E * THICK**3 / 12.0 / (soft * RADIUS**3))


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize(("count", "start"), [(2, 0.0), (2, 2.0), (3, 0.0), (3, 2.0)])
@pytest.mark.parametrize("element", CELLS)
def test_rollers_squeeze_a_ring(element, count, start, friction):
    """Those at mid-side nodes went in by h^2 / 8 R = .026 before they pressed: no force at .02."""
    assert squeezed(element, "rigid", count, friction, start) == pytest.approx(1.0, abs=0.026)


@pytest.mark.parametrize(("role", "friction"), [("master", 0.3), ("slave", 0.0)])
def test_meshed_rollers_squeeze_a_ring(role, friction):
    assert squeezed("Q8R", role, 3, friction, 2.0) == pytest.approx(1.0, abs=0.026)


def bonded(element: str, law: str, friction: float) -> tuple[float, float]:
    """Force of a block between plates that it sticks to, over that of the block held there; its
    largest distance from the lower plate."""
    forces, apart = [], 0.0
    materials = {"rubber": ct.NeoHooke(C10=0.5, D1=0.02), "elastic": ct.Elastic(E=100.0, nu=0.3)}
    for sticks in (True, False):
        mesh = ct.mesh.rectangle(2.0, 1.0, 8, 4, cell=CELLS[element])
        plate = ct.mesh.add_node(mesh, 1.0, 3.0, "plate")
        model = ct.Model(mesh)
        model.section(
            "all",
            element=element,
            material=materials[law],
            plane="strain",
            local_strain="logarithmic",
        )
        if sticks:
            floor = ct.RigidCurve.line((-9.0, 0.0), (11.0, 0.0))
            upper = ct.RigidCurve.line((11.0, 1.0), (-9.0, 1.0), reference=plate)
            model.contact("bottom", floor, friction=friction, name="floor")
            model.contact("top", upper, friction=friction, name="upper")
            model.fix("plate", x=0.0, y=-0.15, rotation=True)
        else:
            model.fix("plate", x=0.0, y=0.0, rotation=True)
            model.fix("bottom")
            model.fix("top", x=0.0, y=-0.15)
        results = ct.solve(model, threads=1)
        end = results.frames[-1]
        bottom = mesh.node_sets["bottom"]
        if sticks:
            forces.append(-results.history("upper: force y")[-1])
            apart = float(np.abs(end.U[bottom, 1]).max())
            assert not any(
                "surfaces overlap" in note and "at the end" in note for note in results.notes
            )
        else:
            forces.append(end.RF[bottom, 1].sum())
    return forces[0] / forces[1], apart


@pytest.mark.parametrize("law", ["rubber", "elastic"])
@pytest.mark.parametrize("element", CELLS)
def test_a_block_that_sticks_to_plates_is_held_at_all_nodes(element, law):
    """Nodes between constraints lay up to .023 off the plates, and forces were 6 to 12 % too small.

    Beside the corners of the block that is held supports pull; contact does not.
    """
    ratio, apart = bonded(element, law, 10.0)
    assert ratio == pytest.approx(1.0, abs=0.01)
    assert apart < 5e-4
