"""A strip that is bent and let go in one increment, against pure bending by hand."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import pytest

import corota as ct
from support.pairs import cover

LENGTH, HEIGHT, E, FLOW, TURN = 40.0, 2.0, 200e3, 400.0, 0.4


def bent(element: str, increments: int, nlgeom: bool, **law: Any) -> ct.Results:
    cell = {"Q8R": "quad8", "T6": "tri6"}.get(element, "quad4")
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, nx=20, ny=8, cell=cell)  # type: ignore[arg-type]
    tip = ct.mesh.add_node(mesh, LENGTH, 0.5 * HEIGHT, name="tip")
    model = ct.Model(mesh)
    model.section(element=element, material=ct.Mises(E, 0.3, yield_stress=FLOW, **law))
    model.fix("left")
    model.rigid("right", tip)
    bend = ct.Static(increments=20, nlgeom=nlgeom)
    bend.fix("tip", x=None, y=None, rotation=TURN)
    free = ct.Static(increments=increments, nlgeom=nlgeom)
    free.release("tip")
    return ct.solve(model, [bend, free])


@pytest.mark.parametrize(
    ("element", "increments", "nlgeom"), cover(["Q4I", "Q4S", "Q8R", "Q4D"], [1, 5], [True, False])
)
def test_angle_after_the_release(element: str, increments: int, nlgeom: bool) -> None:
    results = bent(element, increments, nlgeom)
    ratio = 2.0 * FLOW * LENGTH / (E * HEIGHT * TURN)
    moment = FLOW * HEIGHT**2 / 4.0 * (1.0 - ratio**2 / 3.0)
    stays = TURN - moment * LENGTH / (E * HEIGHT**3 / 12.0)
    found = results.history("UR3", at="tip").values[-1]
    assert found == pytest.approx(stays, rel=0.035 if element == "Q4D" else 0.003)
    # The way back is elastic: no increment is cut.
    assert len([f for f in results.frames if f.step == 2]) == increments
    assert not results.info.get("cut-backs")


def test_hardening_follows_the_same_way() -> None:
    several, one = (bent("Q4I", n, True, kinematic=2000.0) for n in (5, 1))
    angles = [r.history("UR3", at="tip").values[-1] for r in (several, one)]
    assert angles[0] == pytest.approx(angles[1], rel=1e-8)
