# SPDX-License-Identifier: BSD-3-Clause
"""Equilibria at a kink of the contact surfaces, where no single side carries the force.

The lowest corner of a square that stands on it is pushed into a groove of two rigid flanks. Without
friction it slides down whichever flank it meets and rests at the bottom, where the force is any
positive combination of the normals of both.
"""

import math

import numpy as np
import pytest

import corota as ct
from benchmarks.corpora.contact_case_models import seal
from benchmarks.corpora.contact_problems import problem
from corota.results.observer import BaseObserver

#: Slope of the flanks.
SLOPE = math.radians(25.0)


def grooved(aside: float, near: float) -> tuple[ct.Model, int]:
    mesh = ct.mesh.move(ct.mesh.rectangle(1.0, 1.0, 4, 4, "quad4"), angle=45.0)
    low = int(np.argmin(mesh.points[:, 1]))
    mesh.points = mesh.points - mesh.points[low] + [0.02, 0.02]
    model = ct.Model(mesh)
    steel = ct.Elastic(E=1000.0, nu=0.3)
    model.section(
        "all",
        element="Q4I",
        material=steel,
        plane="strain",
        local_strain="logarithmic",
    )
    x = np.array([-2.0, -near, 0.0, near, 2.0])
    groove = ct.RigidCurve.polyline(np.column_stack([x, math.tan(SLOPE) * np.abs(x)]))
    slave = np.vstack([mesh.edge_sets["bottom"], mesh.edge_sets["left"]])
    model.contact(slave, groove, name="groove", method="node_to_segment")
    upper = np.union1d(mesh.node_sets["top"], mesh.node_sets["right"])
    model.fix(upper, x=aside, y=-0.06)
    return model, low


@pytest.mark.parametrize("near", [0.02, 0.3, 1.0])
@pytest.mark.parametrize("aside", [-0.02, -0.01, -0.03])
def test_a_corner_comes_to_rest_at_the_bottom_of_a_groove(aside, near):
    """Whatever the length of the segments beside the bottom: no node goes past a concave corner."""
    model, low = grooved(aside, near)
    notes = []

    class Log(BaseObserver):
        def iteration(self, info):
            notes.append(info.note)

    results = ct.solve(model, ct.Static(), observers=[Log()], threads=1)
    last = results.frames[-1]
    place = model.mesh.points[low] + last.U[low, :2]
    assert place == pytest.approx([0.0, 0.0], abs=1e-9)
    force = np.array([last.scalars[f"groove: force {a}"] for a in "xy"])
    # Between the normals of the flanks, and in balance with the supports.
    assert abs(force[0]) < math.tan(SLOPE) * abs(force[1])
    assert np.abs(last.RF[:, :2].sum(axis=0) + force).max() < 1e-9 * np.abs(force).max()
    assert any("kink" in note for note in notes)


def test_a_pressure_law_in_a_shallow_groove():
    """A node of a block on two soft flanks lies at the kink between them, with its area once.

    The block is stiff beside them: its force is the stiffness of the bed times the mean overlap.
    """
    depth, stiffness, slope = 0.01, 50.0, 0.02
    mesh = ct.mesh.rectangle(2.0, 1.0, 4, 2, "quad4", origin=(-1.0, 0.0))
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0), plane="strain")
    groove = ct.RigidCurve.polyline([[-2.0, 2.0 * slope], [0.0, 0.0], [2.0, 2.0 * slope]])
    law = ct.PressureLaw("linear", stiffness)
    model.contact("bottom", groove, law=law, method="node_to_segment", name="bed", start="keep")
    model.fix("top", x=0.0, y=-depth)
    last = ct.solve(model, ct.Static(), threads=1).frames[-1]
    force = 2.0 * stiffness * (depth + 0.5 * slope)
    assert last.scalars["bed: force y"] == pytest.approx(force, rel=0.01)
    assert last.scalars["bed: force x"] == pytest.approx(0.0, abs=1e-6 * force)


@pytest.mark.parametrize("number", [162, 306])
def test_increments_go_on_from_an_equilibrium_at_a_kink(number):
    """A node in the dent that it makes in a yielding block rests on both flanks, over increments.

    One flank alone is no equilibrium: a correction from there went many edges away.
    """
    given = problem(number, size=0.5)
    results = ct.solve(given.model, given.steps, threads=1)
    assert results.times[-1] == pytest.approx(sum(step.period for step in given.steps))
    assert max(f.scalars["residual"] for f in results.frames[1:]) < 1e-9


def test_walls_of_a_seal_meet_through_kink_after_kink() -> None:
    """Kinks lie closer than one search radius: the nearer one comes first.

    The force of the rib is that of mortar contact. In one radius the run stopped at .963.
    """
    forces = []
    for method in ("mortar", "node_to_segment"):
        model, steps = seal("Q8R", 60, method)
        results = ct.solve(model, steps, threads=1)
        assert results.times[-1] == pytest.approx(1.0)
        forces.append(abs(results.frames[-1].scalars["rib: force y"]))
    assert forces[1] == pytest.approx(forces[0], rel=0.01)
