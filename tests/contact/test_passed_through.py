"""Parts of a body that are in no pair with a rigid curve and end behind it are noted."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct


def overhanging(surface: str) -> ct.Results:
    """A leaf on a floor, of which the middle or the whole bottom is a slave, bent by its ends."""
    mesh = ct.mesh.rectangle(10.0, 0.5, nx=20, ny=2)
    mesh.edge_sets["middle"] = mesh.edge_sets["bottom"][8:12]
    model = ct.Model(mesh)
    model.section(element="Q4I", material=ct.Elastic(1000.0, 0.3))
    model.contact(surface, ct.RigidCurve.line((-5.0, 0.0), (15.0, 0.0)), name="floor")
    model.fix(ct.near(5.0, 0.0), y=None)
    model.force("left", y=-0.2)
    model.force("right", y=-0.2)
    return ct.solve(model, ct.Static())


@pytest.mark.filterwarnings("ignore")
def test_parts_without_a_pair_are_noted() -> None:
    notes = [n for n in overhanging("middle").notes if "in no pair with this rigid curve" in n]
    assert len(notes) == 1
    assert "node 1 by" in notes[0] or "node 21 by" in notes[0]
    assert not any("in no pair" in note for note in overhanging("bottom").notes)


@pytest.mark.filterwarnings("ignore")
def test_whole_outlines_have_no_note() -> None:
    mesh = ct.mesh.annulus(3.2, 4.0, 2, 40)
    rib = ct.mesh.add_node(mesh, 0.0, 4.0, "rib")
    model = ct.Model(mesh)
    model.section(element="Q4I", material=ct.Elastic(5.0, 0.3))
    floor = ct.RigidCurve.line((-5.0, -4.0), (5.0, -4.0))
    upper = ct.RigidCurve.line((5.0, 4.0), (-5.0, 4.0), reference=rib)
    model.contact("outer", floor)
    model.contact("outer", upper)
    model.fix("rib", y=None, rotation=True)
    model.fix(ct.near(0.0, -4.0), y=None)
    step = ct.Static(increments=4)
    step.fix("rib", x=None, y=-1.0)
    assert not any("in no pair" in n for n in ct.solve(model, step).notes)
