# SPDX-License-Identifier: BSD-3-Clause
"""Rigid curves have the deformable body on their left; a body behind one is refused.

Convention: Abaqus and CalculiX profiles, and decision 36 of the design. A block whose curve
runs the wrong way used to be passed through with force 0 and exit status 0.
"""

import numpy as np
import pytest

import corota as ct
from corota.errors import ModelError
from support.pairs import quickly

SLANT = (np.cos(0.4), np.sin(0.4))
#: Curves above a block of 10 x 1, in the right direction: from right to left the block is below.
CURVES = {
    "line": lambda y: ct.RigidCurve.line((20.0, y), (-20.0, y)),
    "corner": lambda y: ct.RigidCurve.polyline([(20, y + 3), (5, y), (-10, y + 3)]),
    "fillet": lambda y: ct.RigidCurve.polyline([(9, y + 3), (5, y), (1, y + 3)], fillet=0.5),
    "box": lambda y: ct.RigidCurve.polyline(
        [(2, y), (2, y + 4), (8, y + 4), (8, y)], closed=True, fillet=0.3
    ),
    "disc": lambda y: ct.RigidCurve.circle((5.0, y + 2.0), 2.0),
    "arc": lambda y: ct.RigidCurve.arc((5.0, y + 2.0), 2.0, 45.0, -180.0),
}


def block(curve, push=-0.15):
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=40, ny=4)
    tool = ct.mesh.add_node(mesh, 5.0, 3.0, "tool")
    model = ct.Model(mesh)
    material = ct.Elastic(E=1000.0, nu=0.3)
    model.section("all", element="Q4I", material=material, local_strain="logarithmic")
    model.fix("bottom")
    curve.reference = tool
    model.contact("top", curve, name="tool")
    model.fix("tool", y=push, rotation=True)
    return model


def reversed_(curve):
    return ct.RigidCurve(curve.backward)


@pytest.mark.parametrize("name", list(CURVES))
@pytest.mark.parametrize("gap", [0.01, -0.005])
def test_the_deformable_body_is_on_the_left(name, gap):
    results = ct.solve(block(CURVES[name](1.0 + gap)))
    assert results.frames[-1].scalars["tool: force y"] < 0.0


@pytest.mark.parametrize("name", list(CURVES))
@pytest.mark.parametrize("gap", [0.05, 1e-9, 0.0, -1e-9, -1e-3, -0.1])
def test_a_body_on_the_wrong_side_is_refused(name, gap):
    """A body that touched its curve or overlapped it had force 0, without a word."""
    with pytest.raises(ModelError, match=r"wrong side.*node \d+ is nearest.*other\s+order"):
        ct.solve(block(reversed_(CURVES[name](1.0 + gap))))


@pytest.mark.parametrize("gap", quickly([0.0, -1e-3], -1e-3))
def test_the_side_is_that_of_the_body_where_all_edges_are_the_slave(gap):
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2000)  # edges at the side are nearer than the foot
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("top", x=0.0, y=-0.01)
    edges = np.concatenate(list(mesh.edge_sets.values()))
    model.contact(edges, ct.RigidCurve.line((9.0, -gap), (-9.0, -gap)))
    with pytest.raises(ModelError, match="wrong side"):
        ct.solve(model)


def test_a_disc_in_a_hole_drawn_as_a_disc_is_refused():
    mesh = ct.mesh.annulus(1.0, 2.0, 2, 24)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("inner")
    model.contact("outer", ct.RigidCurve.circle((0.0, 0.0), 2.0))
    with pytest.raises(ModelError, match="wrong side"):
        ct.solve(model)


def test_the_back_of_a_body_may_be_the_slave():
    """The upper side of a strip on a floor, which may roll up later."""
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2, origin=(0.0, 0.0))
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("bottom")
    model.contact("top", ct.RigidCurve.line((-9.0, 0.0), (19.0, 0.0)), name="c")
    assert ct.solve(model).frames[-1].scalars["c: force y"] == 0.0


def test_a_body_beside_the_end_of_a_curve_is_on_no_side():
    model = block(ct.RigidCurve.line((12.0, 0.5), (12.0, 5.0)))
    assert ct.solve(model).frames[-1].scalars["tool: force y"] == 0.0


def test_turning_a_curve_round_twice_gives_it_back():
    curve = CURVES["fillet"](1.0)
    np.testing.assert_allclose(reversed_(reversed_(curve)).segments, curve.segments, atol=1e-15)


@pytest.mark.parametrize("law", [None, ct.PressureLaw("linear", 1e5)])
@pytest.mark.parametrize("fillet", [0.3, 0.6, 0.0])
def test_a_round_corner_of_few_slave_edges_under_a_law_is_said_before_the_run(fillet, law):
    """Edges of 0.25: a radius of 0.3 is 1.2 of them, two are advised. Hard contact keeps it out."""
    points = [(2, 1.01), (2, 4), (8, 4), (8, 1.01)]
    model = block(ct.RigidCurve.polyline(points, closed=True, fillet=fillet), -0.02)
    model.contacts[0].law = law
    results = ct.solve(model)
    notes = [note for note in results.notes if "1.2 slave edges" in note]
    assert bool(notes) is (law is not None and fillet == 0.3)


PRESSED = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*SURFACE, NAME=FOOT
E, S1
*SURFACE, NAME=FLOOR, TYPE=SEGMENTS
START, {start}, 0.
LINE, {end}, 0.
*RIGID BODY, ANALYTICAL SURFACE=FLOOR
*SURFACE INTERACTION, NAME=I
*CONTACT PAIR, INTERACTION=I, TYPE={method}
FOOT, FLOOR
*BOUNDARY
3, 1, 1
4, 1, 1
*STEP
*STATIC
*BOUNDARY
3, 2, 2, -.01
4, 2, 2, -.01
*END STEP
"""


@pytest.mark.parametrize("method", ["MORTAR", "NODE TO SURFACE"])
def test_a_deck_presses_a_block_on_a_profile_without_reference_node(tmp_path, method):
    """E A d / h = 1000 * 0.01 = 10; drawn the other way round it is refused."""
    path = tmp_path / "a.inp"
    path.write_text(PRESSED.format(start=-5.0, end=9.0, method=method))
    frame = ct.solve(ct.read(path)).frames[-1]
    assert frame.scalars["FOOT-FLOOR: force y"] == pytest.approx(10.0, rel=1e-9)
    path.write_text(PRESSED.format(start=9.0, end=-5.0, method=method))
    with pytest.raises(ModelError, match="wrong side"):
        ct.solve(ct.read(path))


def half_in_a_pair(wide):
    """Two blocks pressed together; of one of both faces, half is in the pair."""
    low = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2)
    up = ct.mesh.move(ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2), shift=(0.0, 1.01))
    model = ct.Model(ct.mesh.assembly(low=low, up=up))
    material = ct.Elastic(E=1000.0, nu=0.3)
    model.section("all", element="Q4I", material=material, local_strain="logarithmic")
    slave, master = (model.mesh.edge_pairs(name) for name in ("up.bottom", "low.top"))
    if wide == "slave":
        model.contact(slave, master[:4], name="half")
    else:
        model.contact(slave[:4], master, name="half")
    model.fix("low.bottom")
    model.fix("up.top", x=0.0, y=-0.15)
    return model


@pytest.mark.parametrize("wide", ["slave", "master"])
def test_a_face_in_no_pair_that_sinks_into_the_other_body_is_noted(wide):
    notes = ct.solve(half_in_a_pair(wide)).notes
    assert any("in no pair lie in the other body" in note for note in notes)


def test_a_run_that_stops_names_the_face_in_no_pair():
    step = ct.Static(first_increment=0.5, largest_increment=0.5, max_increments=1)
    with pytest.raises(ct.ConvergenceError, match="in no pair lie in the other body"):
        ct.solve(half_in_a_pair("slave"), step)
