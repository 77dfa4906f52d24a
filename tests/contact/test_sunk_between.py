"""Surfaces that overlap where a pair has no constraint are noted."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct

CELLS = {"Q8R": "quad8", "T6": "tri6", "Q4I": "quad4"}


def pressed(element: str, method: str, at: float, role: str = "rigid") -> tuple[float, list[str]]:
    """Force of a round of radius 3 that goes by .03 into edges of 1 at x = `at`, and notes."""
    cell = CELLS[element]
    bodies = {"block": ct.mesh.rectangle(8.0, 2.0, 8, 2, cell=cell, origin=(-4.0, -2.0))}
    if role != "rigid":
        bodies["round"] = ct.mesh.annulus(2.0, 3.0, 1, 120, cell=cell, center=(at, 3.0))
    mesh = ct.mesh.assembly(**bodies)
    model = ct.Model(mesh)
    model.section("block", element=element, material=ct.Elastic(E=1e3))
    model.fix("block.bottom")
    if role == "rigid":
        node = ct.mesh.add_node(mesh, at, 3.0, "center")
        other: object = ct.RigidCurve.circle((at, 3.0), 3.0, reference=node)
        model.fix(node, x=0.0, y=-0.03, rotation=True)
    else:
        model.section("round", element=element, material=ct.Elastic(E=1e7))
        other = "round.outer"
        model.fix("round.inner", x=0.0, y=-0.03)
    model.contact("block.top", other, method=method, name="pair")
    results = ct.solve(model, threads=1)
    notes = [n for n in results.notes if "the surfaces overlap by" in n and "at the end" in n]
    return float(results.history("pair: force y")[-1]), notes


@pytest.mark.parametrize(
    ("element", "method", "role"),
    [
        ("Q8R", "mortar", "rigid"),
        ("T6", "mortar", "master"),
        ("Q4I", "mortar", "rigid"),
        ("Q4I", "node_to_segment", "master"),
    ],
)
def test_what_goes_in_between_constraints_is_never_unsaid(element, method, role) -> None:
    """Between corner nodes mortar held nothing up to h^2 / 8 R = .042: no force, and no word."""
    force, notes = pressed(element, method, 0.5, role)
    assert force < 0.0 or (len(notes) == 1 and "'pair' has no force, though" in notes[0])
    assert "overlap by 0.03 at node" in notes[0] if notes else force < -10.0


@pytest.mark.parametrize(
    ("element", "method", "at"),
    [("Q8R", "mortar", 0.0), ("Q8R", "node_to_segment", 0.5), ("Q4I", "node_to_segment", 0.5)],
)
def test_what_constraints_hold_has_no_note(element, method, at) -> None:
    force, notes = pressed(element, method, at)
    assert force < -10.0
    assert not notes
