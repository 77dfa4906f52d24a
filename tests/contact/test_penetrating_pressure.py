"""A fluid that penetrates between surfaces: its front and its force beside statics by hand."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.same_bits import Takes

LENGTH, HEIGHT = 10.0, 2.0
STIFF = 1e10


def on_a_bed(
    nx: int, bed: float, method: str = "mortar", plane: Any = "strain", radius: float = 0.0
) -> ct.Model:
    """A stiff block on a bed whose pressure grows with its depth (Winkler)."""
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, nx, 1, origin=(radius, 0.0))
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(STIFF, 0.0), plane=plane)
    floor = ct.RigidCurve.line((-50.0, 0.0), (radius + 50.0, 0.0))
    model.contact("bottom", floor, method=method, law=ct.PressureLaw("linear", bed), name="floor")
    return model


def moved(model: ct.Model, step: ct.Static, deep: float, tilt: float) -> None:
    """Move and turn the block, to a depth at its left end that grows along it."""
    for node in model.mesh.nodes_of("top"):
        x, y = model.mesh.points[node]
        step.fix([node], x=tilt * y, y=-deep - tilt * x)


def start(model: ct.Model) -> list[int]:
    return [int(np.argmin(model.mesh.points.sum(axis=1)))]


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
@pytest.mark.parametrize("nlgeom", [False, True])
def test_the_front_lies_where_the_contact_pressure_is_that_of_the_fluid(
    method: str, nlgeom: bool
) -> None:
    """Contact pressure 1 + 0.5 x under a tilted block, a fluid of 3.1: up to x = 4.2.

    Twenty cells of a half: the front is the node 4.0, because in the middle of the next edge the
    contact presses harder. One increment.
    """
    model = on_a_bed(20, 1e3, method)
    first, second = ct.Static(nlgeom=nlgeom), ct.Static(nlgeom=nlgeom, increments=1)
    moved(model, first, 1e-3, 0.5e-3)
    second.penetrating_pressure("bottom", 3.1, start=start(model))
    results = ct.solve(model, [first, second], threads=1)
    before, frame = [f for f in results.frames if f.step == 1][-1], results.frames[-1]
    assert frame.scalars["wetted length"] == pytest.approx(4.0)
    up = before.RF[:, 1].sum() - frame.RF[:, 1].sum()
    assert up == pytest.approx(3.1 * 4.0, rel=1e-3)
    # The fluid does not change the bed, whose depth is given.
    depth = 1e-3 * LENGTH + 0.25e-3 * LENGTH**2
    force = before.RF[model.mesh.nodes_of("top"), 1].sum()
    assert force == pytest.approx(-1e3 * depth, rel=1e-3)


@pytest.mark.parametrize(("off", "fluid"), [(1.5, 1.5), (1.4, 2.2)])
def test_the_front_under_a_block_off_its_center(off: float, fluid: float) -> None:
    """A force of 100 off the center of a rigid block on a bed, and a fluid at its light end.

    Statics by hand: contact a + b x and the fluid on whole cells balance force and moment; the
    front is the first node beyond which contact presses harder than the fluid in the mean of an
    edge. Its displacement by the fluid moves the front by some edges.
    """
    nx = 100
    model = on_a_bed(nx, 1e3)
    at = int(np.argmin(np.abs(model.mesh.points - [0.5 * LENGTH + off, HEIGHT]).sum(axis=1)))
    low = model.mesh.nodes_of("bottom")[0]
    model.fix([low], x=0.0, y=None)
    first, second = ct.Static(), ct.Static(increments=1)
    first.force([at], y=-100.0)
    second.penetrating_pressure("bottom", fluid, start=start(model))
    frame = ct.solve(model, [first, second], threads=1).frames[-1]

    def contact(front: float) -> tuple[float, float]:
        matrix = np.array([[LENGTH, LENGTH**2 / 2.0], [LENGTH**2 / 2.0, LENGTH**3 / 3.0]])
        force = 100.0 - fluid * front
        moment = 100.0 * (0.5 * LENGTH + off) - 0.5 * fluid * front**2
        a, b = np.linalg.solve(matrix, [force, moment])
        return float(a), float(b)

    x = np.linspace(0.0, LENGTH, nx + 1)
    front = 0
    while True:
        a, b = contact(x[front])
        if a + 0.5 * b * (x[front] + x[front + 1]) > fluid:
            break
        front += 1
    assert 0 < front < nx // 2
    assert a > 0.0
    assert frame.scalars["wetted length"] == pytest.approx(x[front])
    pressure = frame.C[model.mesh.nodes_of("bottom"), 0]
    # The pressure of an end is the mean over half an edge: within that.
    np.testing.assert_allclose(np.sort(pressure), a + b * x, atol=0.25 * b * x[1])
    carried = 100.0 - fluid * x[front]
    assert frame.scalars["floor: force y"] == pytest.approx(carried, rel=1e-6)


@pytest.mark.parametrize(
    ("element", "cell"), [("Q4I", "quad4"), ("Q4", "quad4"), ("Q8R", "quad8"), ("T6", "tri6")]
)
@pytest.mark.parametrize("plane", ["strain", "stress", "axisymmetric"])
def test_a_block_is_lifted_by_fluid_beneath(element: str, cell: Any, plane: Any) -> None:
    """Pressed on a floor by 2 (nu = 0): a fluid of 1.9 stays outside, one of 3 lifts the block.

    Its stress is then that of the fluid, and the force on the floor is gone: 3 on all of its foot.
    """
    young = 1000.0
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, 8, 2, cell=cell)
    mesh.points[:, 0] += 4.0
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(young, 0.0), plane=plane)
    model.contact("bottom", ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0)), name="floor")
    model.fix("top", y=-2.0 * HEIGHT / young)
    low, high = (ct.Static(increments=1) for _ in range(2))
    low.penetrating_pressure("bottom", 1.9, start=start(model))
    high.penetrating_pressure("bottom", 3.0, start=start(model))
    results = ct.solve(model, [ct.Static(), low, high], threads=1)
    ends = [[f for f in results.frames if f.step == n][-1] for n in (1, 2, 3)]
    area = np.pi * (14.0**2 - 16.0) if plane == "axisymmetric" else LENGTH
    top, foot = model.mesh.nodes_of("top"), model.mesh.nodes_of("bottom")
    assert [f.scalars["wetted length"] for f in ends[1:]] == pytest.approx([0.0, LENGTH])
    for frame, force in zip(ends, (2.0, 2.0, 3.0), strict=True):
        assert frame.RF[top, 1].sum() == pytest.approx(-force * area, rel=1e-3)
    np.testing.assert_allclose(ends[2].U[foot, 1], 1.0 * HEIGHT / young, rtol=5e-3)
    assert ends[2].scalars["floor: force y"] == pytest.approx(0.0, abs=1e-6)


def test_fluid_between_two_bodies_presses_on_both() -> None:
    """Two blocks on each other, three cells on four: the fluid parts them, forces balance."""
    low = ct.mesh.rectangle(LENGTH, HEIGHT, 4, 2)
    top = ct.mesh.rectangle(LENGTH, HEIGHT, 3, 2, origin=(0.0, HEIGHT))
    model = ct.Model(ct.mesh.assembly(low=low, top=top))
    model.section("all", element="Q4", material=ct.Elastic(1000.0, 0.0), plane="strain")
    model.contact("top.bottom", "low.top", name="joint")
    model.fix("low.bottom")
    model.fix("top.top", y=-4.0 * HEIGHT / 1000.0)
    begin = [n for n in model.mesh.nodes_of("top.bottom") if model.mesh.points[n, 0] < 1e-9]
    step = ct.Static(increments=1)
    step.penetrating_pressure("top.bottom", 3.0, start=begin, opposite="low.top")
    frame = ct.solve(model, [ct.Static(), step], threads=1).frames[-1]
    for name, sign in (("low.bottom", 1.0), ("top.top", -1.0)):
        force = frame.RF[model.mesh.nodes_of(name), 1].sum()
        assert force == pytest.approx(sign * 30.0, rel=5e-3)
    assert frame.F[:, 1].sum() == pytest.approx(0.0, abs=1e-9)


def test_the_fluid_draws_back_where_surfaces_are_pressed_again() -> None:
    """Let in by 1, pressed by 4 afterwards, under the same fluid of 3: dry again in the end."""
    young = 1000.0
    model = ct.Model(ct.mesh.rectangle(LENGTH, HEIGHT, 8, 2))
    model.section("all", element="Q4", material=ct.Elastic(young, 0.0), plane="strain")
    model.contact("bottom", ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0)), name="floor")
    steps = [ct.Static(), ct.Static(), ct.Static(increments=4)]
    steps[0].fix("top", y=-1.0 * HEIGHT / young)
    steps[1].penetrating_pressure("bottom", 3.0, start=start(model))
    steps[2].fix("top", y=-4.0 * HEIGHT / young)
    results = ct.solve(model, steps, threads=1)
    ends = [[f for f in results.frames if f.step == n][-1] for n in (2, 3)]
    assert ends[0].scalars["wetted length"] == pytest.approx(LENGTH)
    assert ends[1].scalars["wetted length"] == pytest.approx(0.0)
    assert ends[1].scalars["floor: force y"] == pytest.approx(40.0, rel=1e-2)


def test_a_checkpoint_keeps_the_front() -> None:
    """Resumed in the middle of the lift: the same bits."""

    def given() -> tuple[ct.Model, list[ct.Static]]:
        model = ct.Model(ct.mesh.rectangle(LENGTH, HEIGHT, 8, 2))
        model.section("all", element="Q4", material=ct.Elastic(1000.0, 0.0), plane="strain")
        model.contact("bottom", ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0)), name="floor")
        steps = [ct.Static(), ct.Static(), ct.Static(increments=4)]
        steps[0].fix("top", y=-2.0 * HEIGHT / 1000.0)
        steps[1].penetrating_pressure("bottom", 2.5, start=start(model))
        steps[2].penetrating_pressure("bottom", 3.0, start=start(model))
        return model, steps

    takes = Takes()
    model, steps = given()
    whole = ct.solve(model, steps, observers=[takes], threads=1).frames[-1]
    assert whole.scalars["wetted length"] == LENGTH
    for found in takes.found[1:-1]:
        model, steps = given()
        again = ct.solve(model, steps, threads=1, start=found).frames[-1]
        np.testing.assert_array_equal(again.U, whole.U)
        assert again.scalars["wetted length"] == LENGTH


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_a_block_is_lifted_in_motion(scheme: str) -> None:
    """A light block under a fluid that rises slowly has the stress of the fluid in the end."""
    model = ct.Model(ct.mesh.rectangle(LENGTH, HEIGHT, 8, 2))
    model.section("all", element="Q4", material=ct.Elastic(1000.0, 0.0, rho=1e-6), plane="strain")
    model.contact("bottom", ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0)), name="floor")
    model.fix("top", y=-2.0 * HEIGHT / 1000.0)
    rise = ct.Dynamic(period=0.1, increments=40, scheme=scheme, ramp=True)
    rise.penetrating_pressure("bottom", 3.0, start=start(model))
    frame = ct.solve(model, [ct.Static(), rise], threads=1).frames[-1]
    assert frame.scalars["wetted length"] == pytest.approx(LENGTH)
    top = model.mesh.nodes_of("top")
    assert frame.RF[top, 1].sum() == pytest.approx(-3.0 * LENGTH, rel=0.02)


def test_a_fluid_needs_a_slave_surface_and_a_start_on_it() -> None:
    model = on_a_bed(4, 1e3)
    model.fix("top")
    for where, begin, message in (
        ("top", model.mesh.nodes_of("top")[:1], "no slave surface"),
        ("bottom", model.mesh.nodes_of("top")[:1], "none of the start"),
    ):
        step = ct.Static()
        step.penetrating_pressure(where, 1.0, start=begin)
        with pytest.raises(ct.ModelError, match=message):
            ct.solve(model, step, threads=1)
    with pytest.raises(ct.InputError, match="pressures >= 0"):
        model.penetrating_pressure("bottom", -1.0, start=[0])
    path = ct.Static(path=ct.ArcLength())
    path.penetrating_pressure("bottom", 1.0, start=[0])
    with pytest.raises(ct.UnsupportedError, match="load control"):
        ct.solve(model, path, threads=1)


DECK = Path(__file__).parents[2] / "docs" / "decks" / "fluid.inp"


@pytest.mark.parametrize(("critical", "wet"), [("", 0.0), (", 3.", LENGTH)])
def test_the_card_has_its_critical_pressure(tmp_path: Path, critical: str, wet: float) -> None:
    """Zero by default: a surface that is pressed lets nothing in."""
    text = DECK.read_text()
    assert "1, , 3., 3.\n" in text
    path = tmp_path / "fluid.inp"
    path.write_text(text.replace("1, , 3., 3.\n", f"1, , 3.{critical}\n"))
    frame = ct.solve(ct.read(path), threads=1).frames[-1]
    assert frame.scalars["wetted length"] == pytest.approx(wet)
