"""Coulomb friction: stick on an incline, sliding, its work, reversal."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest

import corota as ct
from corota.model.contact import METHODS


def incline(friction, method="mortar"):
    """A block that rests on a slope of 30 degrees by its weight."""
    mesh = ct.mesh.move(ct.mesh.rectangle(1.0, 0.4, 4, 2), angle=30.0)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.gravity(y=-10.0)
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    slope = ct.RigidCurve.line((-5 * c, -5 * s), (5 * c, 5 * s))
    model.contact("bottom", slope, friction=friction, method=method, name="slope")
    return model


@pytest.mark.parametrize("method", METHODS)
def test_block_rests_where_the_slope_is_below_the_friction(method):
    results = ct.solve(incline(0.58, method), threads=1)  # tan 30 = 0.577
    sums = results.frames[-1].scalars
    assert sums["slope: force y"] == pytest.approx(10.0 * 0.4, rel=1e-9)
    assert sums["slope: force x"] == pytest.approx(0.0, abs=1e-9)
    p, q = results.nodal("CPRESS"), results.nodal("CSHEAR")
    assert (np.abs(q) <= 0.58 * p * (1.0 + 1e-9)).all()


def test_block_that_slides_is_said_to():
    with pytest.raises(ct.ConvergenceError, match="friction does not hold the bodies") as found:
        ct.solve(incline(0.57), ct.Static(smallest_increment=0.1), threads=1)
    assert "slope" in str(found.value)
    assert "contact state (open, stick or slip) kept changing at node" in str(found.value)


def dragged(element, cell, method, there_and_back=False, law=None):
    """A block under pressure is dragged over another by 1.5, and back by 1."""
    low = ct.mesh.rectangle(4.0, 0.5, 9, 1, cell)
    up = ct.mesh.rectangle(1.0, 0.5, 3, 2, cell, origin=(0.7, 0.5))
    model = ct.Model(ct.mesh.assembly(low=low, up=up))
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.3))
    model.fix("low.bottom")
    model.amplitudes["push"] = ct.Amplitude([0.0, 0.2, 5.0], [0.0, 1.0, 1.0])
    model.amplitudes["drag"] = ct.Amplitude([0.0, 0.2, 1.0, 2.0], [0.0, 0.0, 1.5, 0.5])
    model.fix("up.top", x=1.0, y=None, rotation=True, amplitude="drag")
    model.traction("up.top", y=-10.0, amplitude="push")
    model.contact("up.bottom", "low.top", friction=0.3, method=method, law=law, name="pair")
    period = 2.0 if there_and_back else 1.0
    step = ct.Static(period=period, first_increment=0.2, largest_increment=0.2)
    return ct.solve(model, step, threads=1)


@pytest.mark.parametrize(
    ("element", "cell", "method"),
    [("Q4I", "quad4", "mortar"), ("T6", "tri6", "node_to_segment"), ("OPT", "tri3", "mortar")],
)
def test_sliding_force_and_work(element, cell, method):
    results = dragged(element, cell, method)
    last, before = results.frames[-1].scalars, results.frames[2].scalars  # it slides
    assert last["pair: force y"] == pytest.approx(10.0, rel=1e-8)
    # Along the surface, which the pressure bends a little.
    assert last["pair: force x"] == pytest.approx(-3.0, rel=2e-3)
    work = last["external work"] - before["external work"]
    kept = last["strain energy"] - before["strain energy"]
    lost = last["friction energy"] - before["friction energy"]
    assert lost == pytest.approx(work - kept, rel=5e-3)
    assert results.info.get("cut-backs", 0) == 0


@pytest.mark.parametrize("law", [None, ct.PressureLaw("linear", 1e5)])
def test_friction_turns_with_the_motion(law):
    results = dragged("Q4I", "quad4", "mortar", there_and_back=True, law=law)
    force = results.history("pair: force x").values
    assert force[5] == pytest.approx(-3.0, rel=2e-3)
    assert force[-1] == pytest.approx(3.0, rel=2e-3)
    lost = results.history("friction energy").values
    assert (np.diff(lost) >= -1e-12).all()
    assert results.nodal("CSTATUS").max() == 2.0


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
@pytest.mark.parametrize("elements", [True, False])
def test_the_message_names_bodies_that_slide_from_load_zero_on(method, elements):
    """A ladder below its angle of friction, and a stack whose lowest joint slides."""
    floor = ct.RigidCurve.line((-1.0, 0.0), (3.0, 0.0))
    if elements:
        a, b = (ct.mesh.rectangle(2.0, 0.4, n, 1, origin=(0.0, y)) for n, y in ((3, 0.0), (2, 0.4)))
        model = ct.Model(ct.mesh.assembly(a=a, b=b))
        model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3))
        model.contact("a.bottom", floor, friction=0.3, method=method, name="floor")
        model.contact("b.bottom", "a.top", friction=0.3, method=method, name="joint")
        model.force("b.top", y=-10.0)
        model.force("b.left", x=1.5)
        model.force("a.left", x=1.6)
    else:
        angle = math.atan((1.0 - 0.4**2) / 0.8) - math.radians(1.5)
        foot, head = (math.cos(angle), 0.0), (0.0, math.sin(angle))
        model = ct.Model(ct.mesh.line([foot, head], n=4))
        model.beam("all", material=ct.Elastic(E=1e6), area=0.01, inertia=1e-5)
        model.line_load(y=-1.0)
        wall = ct.RigidCurve.line((0.0, 3.0), (0.0, -1.0))
        for end, master in (("start", floor), ("end", wall)):
            nodes = model.mesh.node_sets[end]
            model.contact(nodes, master, friction=0.4, method=method, name=end)
    with pytest.raises(ct.ConvergenceError, match="they slide"):
        ct.solve(model, ct.Static(), threads=1)


def test_the_message_of_a_block_that_tips_from_load_zero_on_names_no_sliding():
    model = ct.Model(ct.mesh.rectangle(1.0, 3.0, 4, 8))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3))
    floor = ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0))
    model.contact("bottom", floor, friction=0.9, name="floor")
    model.force("top", x=2.0, y=-8.0)
    with pytest.raises(ct.ConvergenceError) as error:
        ct.solve(model, ct.Static(), threads=1)
    assert "slide" not in str(error.value)
