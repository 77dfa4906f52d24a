"""Friction is mu N along the slip, whatever the increment: dragged, turned, rolled, past an end."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.friction_exact import tension
from corota import _core
from corota.model.contact import METHODS
from support.pairs import cover
from tests.contracts.test_contact_gaps import LENGTHS, against_rigid, gradients, moved, two_bodies

ELASTIC = ct.Elastic(E=1e4, nu=0.3)


def ratio(results, at):
    """Force along the way over the pressing force."""
    return results.history("RF1", at=at).values[-1] / -results.history("RF2", at=at).values[-1]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("table", ["slave", "master"])
@pytest.mark.parametrize("travel", [0.1, 0.31, 1.0])
def test_block_on_a_wider_table(method, table, travel):
    """The slave edges at the ends of the block are covered in part, and the cover moves on."""
    block = ct.mesh.rectangle(1.0, 1.0, 5, 5, origin=(0.5, 0.5))
    model = ct.Model(ct.mesh.assembly(b=block, t=ct.mesh.rectangle(4.0, 0.5, 20, 4)))
    model.section("all", element="Q4I", material=ELASTIC)
    model.fix("t.bottom")
    pair = ("t.top", "b.bottom") if table == "slave" else ("b.bottom", "t.top")
    model.contact(*pair, friction=0.2, method=method)
    press, drag = ct.Static(), ct.Static()
    # Little: dents tilt the surfaces.
    press.fix("b.top", x=0.0, y=-0.001)
    drag.fix("b.top", x=travel, y=-0.001)
    assert ratio(ct.solve(model, [press, drag], threads=1), "b.top") == pytest.approx(0.2, rel=0.01)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("travel", [0.3, 0.6])
def test_block_past_the_end_of_a_rigid_line(method, travel):
    model = ct.Model(ct.mesh.rectangle(1.0, 0.5, 8, 4))
    model.section("all", element="Q4I", material=ELASTIC)
    line = ct.RigidCurve.line((-3.0, 0.0), (1.1, 0.0))
    model.contact("bottom", line, friction=0.3, method=method)
    press, drag = ct.Static(), ct.Static()
    press.fix("top", x=0.0, y=-0.002)
    drag.fix("top", x=travel, y=-0.002)
    assert ratio(ct.solve(model, [press, drag], threads=1), "top") == pytest.approx(0.3, rel=0.01)


def brake(method, turn, carried=0.0):
    """A pad on a drum that turns in one step, both carried round by an angle [degrees]."""
    mesh = ct.mesh.annulus(10.0, 12.0, 2, 6, angle=20.0, start=80.0)
    drum = ct.mesh.add_node(mesh, 0.0, 0.0, "drum")
    frame = ct.mesh.add_node(mesh, 0.0, 0.0, "frame")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0))
    model.rigid("outer", frame)
    circle = ct.RigidCurve.circle((0.0, 0.0), 10.0, reference=drum)
    model.contact("inner", circle, friction=0.2, method=method, name="c")
    press, step = ct.Static(), ct.Static()
    for s, angle, own in ((press, 0.0, 0.0), (step, carried, turn)):
        c, d = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        s.fix("frame", x=0.02 * d, y=-0.02 * c, rotation=np.radians(angle))
        s.fix("drum", x=0.0, y=0.0, rotation=np.radians(angle + own))
    return ct.solve(model, [press, step], threads=1).frames[-1]


@pytest.mark.parametrize(
    ("method", "turn"), cover(METHODS, [20.0, 60.0, 120.0, 180.0, -270.0, 360.0], strength=1)
)
def test_pad_on_a_turning_drum(method, turn):
    """The moment on the drum is mu N R, N from the pressures; the slip is the arc."""
    frame = brake(method, turn)
    slipping = frame.C[:, 4] == 2.0
    p, q = frame.C[slipping, 0], frame.C[slipping, 1]
    assert slipping.sum() == (frame.C[:, 4] > 0.0).sum() >= 6
    np.testing.assert_allclose(q, -np.sign(turn) * 0.2 * p, rtol=1e-6)
    np.testing.assert_allclose(frame.C[slipping, 3], 10.0 * np.radians(turn), rtol=0.01)
    friction, push = frame.scalars["c: friction moment"], brake(method, 0.0).scalars["c: force y"]
    # The sum of the pressures exceeds their resultant by 10 degrees to both sides.
    mean = np.sin(np.radians(10.0)) / np.radians(10.0)
    assert abs(friction) == pytest.approx(0.2 * push * 10.0 / mean, rel=0.02)


def test_a_common_rotation_changes_no_force():
    """Between both sides of a pair, to rounding: slips stay, and forces turn."""
    rng = np.random.default_rng(3)
    for method in METHODS:
        for X, contact in (
            two_bodies("quadratic", "linear", method),
            two_bodies("linear", "drilling", method),
        ):
            x, old = moved(X, rng), moved(X, rng)
            contact.search(x)
            first = contact.evaluate(x, old)
            B = gradients(first, contact, x.size)[1].reshape(-1, len(x), 3)
            for degrees in (10.0, 90.0, 180.0, 270.0, 400.0):
                a = np.radians(degrees)
                turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
                y = np.column_stack([x[:, :2] @ turn.T + [3.0, -2.0], x[:, 2] + a])
                contact.search(y)
                d = contact.evaluate(y, old)
                np.testing.assert_allclose(d["total_slip"], first["total_slip"], atol=1e-12)
                own = gradients(d, contact, x.size)[1].reshape(-1, len(x), 3)
                np.testing.assert_allclose(own[:, :, :2], B[:, :, :2] @ turn.T, atol=1e-12)
                np.testing.assert_allclose(own[:, :, 2], B[:, :, 2], atol=1e-12)


@pytest.mark.parametrize(("method", "carried"), cover(METHODS, [45.0, 180.0, 400.0], strength=1))
def test_forces_turn_with_a_brake_that_is_carried_round(method, carried):
    still, turned = brake(method, 30.0), brake(method, 30.0, carried)
    np.testing.assert_allclose(turned.C[:, :2], still.C[:, :2], atol=1e-9 * abs(still.C).max())


@pytest.mark.parametrize("method", METHODS)
def test_a_rigid_disc_rolls_without_slip(method):
    """In one increment: slave points far from the first contact stick where the disc rolls on."""
    X = np.column_stack([np.linspace(7.0, -1.0, 81), np.zeros(81)])
    X = np.vstack([np.column_stack([X, np.zeros(81)]), [[0.0, 1.0, 0.0]]])
    edges = np.column_stack([np.arange(80), np.arange(1, 81), np.full(80, -1)])
    circle = np.array([[1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 2.0 * np.pi]])
    contact = _core.Contact.rigid(
        X, edges, np.zeros(80), np.ones(80), circle, 81, (0.0, 0.0), method=method, **LENGTHS
    )
    closed = np.zeros(len(contact.nodes), bool)
    closed[70] = True  # at the origin
    for turn in (0.4, 1.0, 3.0, 6.5):
        x = X.copy()
        x[-1] = turn, 1.0, -turn
        contact.search(x)
        d = contact.evaluate(x, X, closed)
        nearest = np.argmin(abs(X[contact.nodes, 0] - turn))
        slip = d["total_slip"][nearest] / d["total_area"][nearest]
        assert abs(slip) < 0.01 * turn


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q8R", "T6", "Q9"])
def test_a_disc_that_is_free_to_turn_rolls_along_a_bowl(element, method):
    """The axle goes along an arc, in steps whose chords rise by less than the disc is pressed in.

    Supports move along the chord of a step: over a longer one the disc would leave the bowl, with a
    rotation that is unconstrained.
    """
    bowl, disc, pressed, angle, steps = 10.0, 3.0, 0.002, 0.15, 6
    arm = bowl - disc + pressed
    cell = {"Q4I": "quad4", "T6": "tri6", "Q9": "quad9"}.get(element, "quad8")
    mesh = ct.mesh.annulus(bowl, bowl + 1.0, 1, 24, angle=30.0, start=255.0, cell=cell)
    axle = ct.mesh.add_node(mesh, 0.0, -arm, "axle")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.0))
    model.fix("outer")
    circle = ct.RigidCurve.circle((0.0, -arm), disc, reference=axle)
    model.contact("inner", circle, friction=0.2, method=method)
    run = [ct.Static()]
    run[0].fix("axle", x=0.0, y=0.0, rotation=0.0)
    for a in np.linspace(0.0, angle, steps + 1)[1:]:
        step = ct.Static()
        if len(run) == 1:
            step.release("axle", x=False, y=False, rotation=True)
        step.fix("axle", x=arm * np.sin(a), y=arm * (1.0 - np.cos(a)), rotation=None)
        run.append(step)
    turn = ct.solve(model, run, threads=1).frames[-1].UR[axle]
    assert turn == pytest.approx(-(bowl - disc) / disc * angle, rel=0.01)


@pytest.mark.parametrize("curve", ["solid", "line"])
def test_whole_turns_of_a_rigid_curve_count(curve):
    X, contact = against_rigid(curve, "linear", "node_to_segment", node=True)
    if curve == "solid":
        # Onto the circle: a slip is as long as the way of the slave point where the gap is closed.
        X[:4, 1] = 1.11 - np.sqrt(1.0 - (X[:4, 0] - 0.5) ** 2)
    closed = np.ones(len(contact.nodes), bool)
    contact.search(X)
    assert not contact.evaluate(X, X, closed)["total_slip"].any()
    x = X.copy()
    x[-1, 2] += 4.0 * np.pi
    contact.search(x)
    d = contact.evaluate(x, X, closed)
    seen = d["total_area"] > 0.0
    assert seen.sum() == 4
    way = 4.0 * np.pi if curve == "solid" else 0.0
    slip = d["total_slip"][seen] / d["total_area"][seen]
    np.testing.assert_allclose(slip, way, atol=1e-12)


def test_slip_is_a_number_where_a_ray_grazes_a_round():
    """The end of an arc whose normal lies along the slave: the ray at its foot is a tangent."""
    n = 4
    X = np.column_stack([np.linspace(1.3, -1.3, n + 1), np.zeros((n + 1, 2))])
    X = np.vstack([X, [[0.0, 0.5, 0.0]]])
    edges = np.column_stack([np.arange(n), np.arange(1, n + 1), np.full(n, -1)])
    circle = np.array([[0.5, 0.5, 0.0, 0.0, 0.0, 0.5, 2.0 * np.pi]])
    contact = _core.Contact.rigid(
        X, edges, np.zeros(n), np.ones(n), circle, n + 1, (0.0, 0.0), method="mortar", **LENGTHS
    )
    for place in np.linspace(-0.7, 0.7, 101):
        old, x = X.copy(), X.copy()
        old[-1, 0] += place
        x[-1, 0] += place - 0.4
        contact.search(x)
        d = contact.evaluate(x, old)
        assert d["total_area"].any()
        assert np.isfinite(d["total_slip"]).all()


@pytest.mark.parametrize(("mu", "degrees"), [(0.22, 72.0), (0.15, 102.0)])
def test_the_end_of_a_slave_in_a_moved_grip_has_no_traction_of_its_own(mu, degrees):
    """It would move nothing, and take any size: the strip stopped, or was drawn by it."""
    step = ct.Static(increments=1)
    assert tension("mortar", "Q4I", mu, degrees, step) == pytest.approx(1.0, rel=0.01)
