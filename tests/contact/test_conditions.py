"""Surfaces that do not separate, a largest shear traction, and pairs of some steps."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError, UnsupportedError

if TYPE_CHECKING:
    from pathlib import Path

E = 1000.0


def blocks(method="mortar", **conditions):
    """A block of 4 x 2 on one of 6 x 2; the lower one is fixed at its bottom."""
    mesh = ct.mesh.assembly(
        low=ct.mesh.rectangle(6.0, 2.0, nx=6, ny=2),
        up=ct.mesh.rectangle(4.0, 2.0, nx=3, ny=2, origin=(1.0, 2.0)),
    )
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=E, nu=0.0))
    model.fix("low.bottom")
    model.contact("up.bottom", "low.top", method=method, name="joint", **conditions)
    return model


def last(model, steps=None):
    return ct.solve(model, steps, threads=1).frames[-1]


@pytest.mark.parametrize(("method", "nlgeom"), [("mortar", True), ("node_to_segment", False)])
def test_surfaces_that_have_met_carry_tension(method, nlgeom):
    model = blocks(method, separates=False)
    model.fix("up.top", y=None)
    model.traction("up.top", y=3.0)
    results = ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1)
    frame = results.frames[-1]
    assert frame.scalars["joint: force y"] == pytest.approx(-12.0, rel=1e-9)
    low, up = (frame.U[model.mesh.nodes_of(name), 1] for name in ("low.top", "up.bottom"))
    assert up.mean() > 0.0
    assert low.max() > 0.0


def test_surfaces_that_separate_do_not():
    model = blocks()
    model.fix("up.top", y=None)
    model.fix("up.top", x=None, y=0.01)
    assert last(model).scalars["joint: force y"] == 0.0
    model = blocks(separates=False)
    model.fix("up.top", y=0.01)
    model.supports[-1].dof = 1
    assert last(model).scalars["joint: force y"] < -1.0


def test_what_meets_on_its_way_stays_together():
    """Pressed down first, then pulled up: the pull is that of a body glued to the floor."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2, origin=(0.0, 0.1))
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=E, nu=0.0))
    model.contact("bottom", ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0)), separates=False, name="f")
    down, up = ct.Static(increments=4), ct.Static(increments=4)
    down.fix("top", y=-0.12)
    up.fix("top", y=-0.09)
    results = ct.solve(model, [down, up], threads=1)
    force = results.history("f: force y")
    assert force[1] == 0.0  # still above the floor
    assert force[4] == pytest.approx(E * 2.0 * 0.02, rel=1e-9)
    assert force[8] == pytest.approx(-E * 2.0 * 0.01, rel=1e-9)


def test_a_surface_that_carries_tension_slides_without_friction():
    model = blocks(separates=False, friction=0.4)
    step = ct.Static(increments=5)
    step.fix("up.top", x=0.3, y=0.005)
    frame = last(model, step)
    assert frame.scalars["joint: force y"] < -1.0
    assert frame.scalars["joint: friction x"] == 0.0


@pytest.mark.parametrize(
    ("method", "increments", "press", "drag"),
    [
        ("mortar", 1, 8.0, 1.5),
        ("mortar", 3, 2.0, 0.6),
        ("mortar", 3, 8.0, 1.5),
        ("node_to_segment", 1, 8.0, 1.5),
    ],
)
def test_the_shear_traction_has_a_bound(method, increments, press, drag):
    """0.3 of the pressure, at most 1.5: of a pressure of 8 it would be 2.4."""
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0))
    model.contact(
        "bottom",
        ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0)),
        method=method,
        friction=0.3,
        shear_limit=1.5,
        name="floor",
    )
    push, slide = ct.Static(), ct.Static(increments=increments)
    for step in (push, slide):
        step.fix("top", y=None, x=0.0 if step is push else 0.2)
        step.traction("top", y=-press)
    frame = last(model, [push, slide])
    assert frame.scalars["floor: force y"] == pytest.approx(4.0 * press, rel=1e-9)
    assert frame.scalars["floor: force x"] == pytest.approx(-4.0 * drag, rel=1e-9)
    # It dissipates over the whole way.
    assert frame.scalars["ALLFD"] == pytest.approx(4.0 * drag * 0.2, rel=2e-2)


def test_a_bound_above_friction_changes_nothing():
    def answer(**more):
        model = blocks(friction=0.3, **more)
        step = ct.Static(increments=3)
        step.fix("up.top", x=0.02, y=-0.02)
        return last(model, step).U

    assert answer(shear_limit=1e9) == pytest.approx(answer(), abs=1e-14)


def test_a_pair_ends_and_begins_with_steps():
    model = blocks(steps=(1, 3))
    model.fix("up.top", x=None, y=-0.02)
    model.fix("up.left", y=None)
    steps = [ct.Static(), ct.Static(increments=4), ct.Static()]
    results = ct.solve(model, steps, threads=1)
    force = results.history("joint: force y")
    pull = np.array([f.RF[model.mesh.nodes_of("up.top"), 1].sum() for f in results.frames])
    assert force[1] > 0.0
    assert force[1] == pytest.approx(-pull[1], rel=1e-9)
    # What was pressed fades, though the pair is gone.
    np.testing.assert_allclose(force[2:6], 0.0)
    assert -pull[2:6] == pytest.approx(force[1] * np.array([0.75, 0.5, 0.25, 0.0]), abs=1e-9)
    assert force[6] == pytest.approx(force[1], rel=1e-9)


@pytest.mark.parametrize("increments", [1, 4])
@pytest.mark.parametrize("friction", [0.0, 2.0])
def test_energy_balances_while_the_forces_of_a_pair_that_ended_fade(friction, increments):
    """With friction a shear fades as well; of four increments 43 % of the energy seemed lost."""
    model = blocks(steps=(1, 3), friction=friction)
    model.fix("up.top", x=0.002 if friction else None, y=-0.02)
    model.fix("up.left", x=None if friction else 0.0, y=None)
    steps = [ct.Static(increments=increments) for _ in range(3)]
    results = ct.solve(model, steps, threads=1)
    energy = results.history("strain energy")
    assert max(energy) > 0.1
    assert energy[2 * increments] < 1e-12
    np.testing.assert_allclose(results.history("energy balance"), 0.0, atol=2e-3 * max(energy))
    assert not any("energy" in note for note in results.notes)


def test_a_pair_that_begins_later_is_not_felt_before():
    model = blocks(steps=(2,))
    down = ct.Static()
    down.fix("up.top", y=-0.02)
    results = ct.solve(model, [down, ct.Static()], threads=1)
    force = results.history("joint: force y")
    assert force[1] == 0.0
    assert force[2] > 1.0


def test_what_does_not_go_together_is_refused():
    with pytest.raises(InputError, match="largest shear traction"):
        blocks(shear_limit=1.0)
    with pytest.raises(InputError, match="omit the pressure law"):
        blocks(separates=False, law=ct.PressureLaw("linear", [1e4]))
    with pytest.raises(InputError, match="from 1"):
        blocks(steps=(0, 1))
    model = blocks(separates=False)
    model.fix("up.top", y=-0.01)
    with pytest.raises(UnsupportedError, match="do not separate"):
        ct.solve(model, ct.Static(path=ct.ArcLength()), threads=1)


@pytest.mark.parametrize(
    "conditions",
    [
        {"separates": False, "friction": 0.2},
        {"shear_limit": 2.5, "friction": 0.2},
        {"steps": (1, 3)},
        {"steps": (2,)},
    ],
)
def test_conditions_survive_decks_and_result_files(tmp_path: Path, conditions):
    model = blocks(**conditions)
    model.fix("up.top", y=-0.01)
    steps = [ct.Static(), ct.Static(), ct.Static()]
    ct.write(model, tmp_path / "job.inp", steps)
    again = ct.read(tmp_path / "job.inp").contacts[0]
    results = ct.solve(model, steps, threads=1)
    results.write(tmp_path / "job.vtkhdf")
    with ct.read_results(tmp_path / "job.vtkhdf") as read:
        kept = read.model.contacts[0]
        for pair in (again, kept):
            for name, value in conditions.items():
                found = getattr(pair, name)
                assert (tuple(found) if name == "steps" else found) == value
