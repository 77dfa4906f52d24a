"""Rigid curves on nodes, starts, pressure laws, self-contact, and contact with other features."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.contact import METHODS

#: Local strains above 5 % warn; these tests press hard.
pytestmark = pytest.mark.filterwarnings("ignore:local strain")


def punch(method="mortar", load=None, scale=1.0, element="Q4I"):
    """A block under a rigid disc on a reference node, moved or loaded; lengths times `scale`."""
    mesh = ct.mesh.rectangle(4.0 * scale, 1.0 * scale, 16, 4)
    disc = ct.mesh.add_node(mesh, 2.0 * scale, 2.0 * scale, "disc")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e3 / scale**2, nu=0.3))
    model.fix("bottom")
    if load is None:
        model.fix("disc", x=0.0, y=-0.15 * scale, rotation=True)
    else:
        model.fix("disc", x=0.0, y=None, rotation=True)
        model.force("disc", y=-load)
    circle = ct.RigidCurve.circle((2.0 * scale, 2.0 * scale), 1.0 * scale, reference=disc)
    model.contact("top", circle, method=method, name="punch")
    return ct.solve(model, ct.Static(increments=3), threads=1), disc


@pytest.mark.parametrize("method", METHODS)
def test_moved_and_loaded_disc_agree(method):
    moved, disc = punch(method)
    force = moved.frames[-1].RF[disc, 1]
    assert moved.frames[-1].scalars["punch: force y"] == pytest.approx(force, rel=1e-9)
    loaded, disc = punch(method, load=-force)
    assert loaded.frames[-1].U[disc, 1] == pytest.approx(-0.15, rel=1e-6)
    # Nothing comes from contact without friction: what is put in is in the block.
    last = loaded.frames[-1].scalars
    assert last["external work"] == pytest.approx(last["strain energy"], rel=0.03)


def test_units_change_nothing():
    meters, _ = punch()
    millimeters, _ = punch(scale=1e3)
    a, b = (r.history("iterations").values for r in (meters, millimeters))
    assert a.tolist() == b.tolist()
    force = [r.frames[-1].scalars["punch: force y"] for r in (meters, millimeters)]
    assert force[1] == pytest.approx(force[0] / 1e3, rel=1e-8)  # per thickness 1 in either


def test_solvers_agree():
    faer, _ = punch()
    model = faer.model
    other = ct.solve(model, ct.Static(increments=3), threads=1, solver="superlu")
    assert pytest.approx(faer.frames[-1].U, abs=1e-9) == other.frames[-1].U


def stacked(gap=0.0, **options):
    low = ct.mesh.rectangle(3.0, 1.0, 6, 2)
    up = ct.mesh.rectangle(1.0, 1.0, 3, 3, origin=(1.0, 1.0 + gap))
    model = ct.Model(ct.mesh.assembly(low=low, up=up))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("low.bottom")
    model.fix("up.left", x=0.0, y=None)
    model.contact("up.bottom", "low.top", name="pair", **options)
    return model


@pytest.mark.parametrize(
    "options", [{}, {"stabilize": True}, {"start": "adjust", "adjust": 0.2}, {"clearance": 0.05}]
)
def test_a_body_free_before_contact(options):
    model = stacked(0.1, **options)
    model.traction("up.top", y=-5.0)
    frame = ct.solve(model, ct.Static(increments=3), threads=1).frames[-1]
    assert frame.scalars["pair: force y"] == pytest.approx(5.0, rel=1e-9)
    sunk = {"adjust": 0.0, "clearance": -0.05}.get(list(options)[-1] if options else "", -0.1)
    bottom = model.mesh.nodes_of("up.bottom")
    assert frame.U[bottom, 1].mean() == pytest.approx(sunk, abs=0.005)
    assert (frame.scalars["stabilization energy"] > 0.0) == ("stabilize" in options)


@pytest.mark.parametrize(("start", "share"), [("keep", 1.0), ("ramp", 0.5), ("adjust", 0.0)])
def test_overlap_at_the_start(start, share):
    model = stacked(-0.02, start=start)
    model.fix("up.top", x=None, y=0.0)
    results = ct.solve(model, ct.Static(increments=2), threads=1)
    force = results.history("pair: force y").values
    full = 12.21 if start != "adjust" else 0.0
    assert force[-1] == pytest.approx(full, rel=0.01)
    assert force[1] == pytest.approx(share * full, rel=0.01)
    assert "overlap by up to 0.02 at node" in results.notes[0]


@pytest.mark.parametrize(
    "law",
    [
        ct.PressureLaw("linear", 1e4),
        ct.PressureLaw("exponential", 5.0, 0.01),
        ct.PressureLaw("tabular", [0.0, 1.0, 20.0], [0.0, 1e-3, 3e-3]),
    ],
)
def test_pressure_laws(law):
    model = stacked(max(0.0, -law.start), law=law)
    model.traction("up.top", y=-5.0)
    results = ct.solve(model, ct.Static(increments=8), threads=1)
    nodes = model.mesh.nodes_of("up.bottom")
    p, gap = results.nodal("CPRESS")[nodes], results.nodal("COPEN")[nodes]
    assert p == pytest.approx(law(-gap)[0], rel=1e-8)
    last = results.frames[-1].scalars
    assert last["pair: force y"] == pytest.approx(5.0, rel=1e-9)
    kept = last["strain energy"] + last["contact energy"]
    assert last["external work"] == pytest.approx(kept, rel=0.02)


def test_laws_are_their_own_derivatives():
    w = np.linspace(-0.009, 0.02, 7)
    for law in (
        ct.PressureLaw("linear", 1e4),
        ct.PressureLaw("exponential", 5.0, 0.01),
        ct.PressureLaw("tabular", [0.0, 1.0, 20.0], [-0.01, 1e-3, 3e-3]),
    ):
        at = w[w > law.start]
        up, down = law(at + 1e-7), law(at - 1e-7)
        assert (up[0] - down[0]) / 2e-7 == pytest.approx(law(at)[1], rel=1e-5)
        assert (up[2] - down[2]) / 2e-7 == pytest.approx(law(at)[0], rel=1e-5)
    soft = ct.PressureLaw("exponential", 5.0, 0.01)
    assert soft(np.zeros(1))[0] == pytest.approx(5.0)
    assert soft(np.full(1, -0.01))[0] == pytest.approx(0.0, abs=1e-12)


def test_a_strip_touches_itself():
    """An open ring is pressed until its end touches its own inside."""
    mesh = ct.mesh.annulus(0.8, 1.0, n_radial=2, n_around=32, angle=340.0, start=-80.0)
    mesh.edge_sets["skin"] = mesh.boundary_edges()
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    bottom, top = (int(f(mesh.points[:, 1])) for f in (np.argmin, np.argmax))
    model.fix([bottom])
    model.fix([top], x=0.0, y=-1.75)
    model.contact("skin", "skin", name="skin")
    results = ct.solve(model, ct.Static(increments=16), threads=1)
    assert results.nodal("CPRESS").max() > 0.0
    last = results.frames[-1].scalars
    assert last["skin: area"] > 0.0
    assert last["external work"] == pytest.approx(last["strain energy"], rel=0.01)


def test_rigid_body_presses_a_plastic_block():
    """The upper block is a rigid body, the lower one yields."""
    low = ct.mesh.rectangle(3.0, 1.0, 9, 4)
    up = ct.mesh.rectangle(1.0, 0.5, 2, 1, origin=(1.0, 1.0))
    mesh = ct.mesh.assembly(low=low, up=up)
    handle = ct.mesh.add_node(mesh, 1.5, 1.5)
    model = ct.Model(mesh)
    steel = ct.Mises(E=1000.0, nu=0.3, yield_stress=4.0, isotropic=20.0)
    model.section("low", element="Q4I", material=steel)
    model.section("up", element="Q4I", material=ct.Elastic(E=1000.0))
    model.fix("low.bottom")
    model.rigid("up", handle)
    model.fix([handle], x=0.0, y=-0.02, rotation=None)
    model.contact("low.top", "up.bottom", friction=0.2, name="pair")
    results = ct.solve(model, ct.Static(increments=4), threads=1)
    frame = results.frames[-1]
    assert frame.RF[handle, 1] == pytest.approx(frame.scalars["pair: force y"], rel=1e-8)
    assert results.nodal("PEEQ").max() > 1e-3
    assert max(f.scalars.get("iterations", 0) for f in results.frames) <= 16


def test_contact_in_files(tmp_path):
    results, _ = punch()
    results.write(tmp_path / "punch.vtkhdf")
    with ct.read_results(tmp_path / "punch.vtkhdf") as stored:
        for name in ("CPRESS", "COPEN", "CSTATUS"):
            assert stored.nodal(name) == pytest.approx(results.nodal(name))
        assert stored.history("punch: force y").values == pytest.approx(
            results.history("punch: force y").values
        )


@pytest.mark.parametrize("method", METHODS)
def test_constraints_that_follow_from_others_are_left_out(method):
    """The same wall twice, and a corner that is held on it."""
    mesh = ct.mesh.rectangle(1.0, 0.5, 4, 2)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    corner = mesh.node_sets["bottom"][:1]
    model.fix(corner)
    model.traction("top", y=-2.0)
    for name in ("wall", "again"):
        wall = ct.RigidCurve.line((-1.0, 0.0), (2.0, 0.0))
        model.contact("bottom", wall, method=method, name=name)
    results = ct.solve(model, threads=1)
    assert any("is redundant" in note for note in results.notes)
    last = results.frames[-1]
    on_walls = last.scalars["wall: force y"] + last.scalars["again: force y"]
    assert on_walls + last.RF[corner, 1].sum() == pytest.approx(2.0, rel=1e-9)
    assert np.abs(last.U[mesh.node_sets["bottom"], 1]).max() < 1e-9
