# SPDX-License-Identifier: BSD-3-Clause
"""Friction that depends on slip rate and pressure, against closed forms of rigid blocks."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import corota as ct
from corota.io.result_reader import read_results
from corota.mesh.data import Cells
from support.particles import table

pytestmark = [
    pytest.mark.filterwarnings("ignore:.*energy"),
    pytest.mark.filterwarnings("ignore:central differences took"),
]
STATIC, KINETIC, DECAY = 0.5, 0.2, 1.5
LAW = ct.DecayingFriction(STATIC, KINETIC, DECAY)


def floor(**options):
    return ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0), **options)


@pytest.mark.parametrize(
    ("scheme", "within"),
    [("hht", 2.5e-3), ("energy_momentum", 2.5e-3), ("central_difference", 4e-3)],
)
def test_block_slowed_by_decaying_friction(scheme, within):
    # m v' = -m g (mu_k + (mu_s - mu_k) exp(-d v)) gives
    # mu_k exp(d v) + mu_s - mu_k = (mu_k exp(d v0) + mu_s - mu_k) exp(-d mu_k g t).
    g, start, end = 10.0, 2.0, 0.5
    model = ct.Model(ct.mesh.rectangle(2.0, 0.5, nx=2, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.contact("bottom", floor(), friction=LAW, name="floor")
    model.gravity(y=-g)
    model.velocity(x=start)
    options = {} if scheme == "central_difference" else {"increments": 50}
    frames = ct.solve(model, ct.Dynamic(period=end, scheme=scheme, **options)).frames
    difference = STATIC - KINETIC
    for frame in frames[1:]:
        grown = (KINETIC * math.exp(DECAY * start) + difference) * math.exp(
            -DECAY * KINETIC * g * frame.time
        )
        speed = math.log((grown - difference) / KINETIC) / DECAY
        assert frame.scalars["momentum x"] == pytest.approx(speed, abs=within * start)


def test_belt_and_spring_with_decaying_friction():
    # m x'' = N mu(v - x') - k x while it slips; it rides with the belt otherwise.
    preload, k, v = 10.0, 80.0, 0.4
    law = ct.DecayingFriction(0.4, 0.2, 10.0)
    mesh = ct.mesh.rectangle(2.0, 0.5, nx=2, ny=2)
    middle = np.flatnonzero(np.abs(mesh.points[:, 1] - 0.25) < 1e-9)
    n = mesh.n_cells
    mesh = replace(mesh, cells=[*mesh.cells, Cells("point1", middle.reshape(-1, 1), 101 + middle)])
    carrier = ct.mesh.add_node(mesh, 0.0, -1.0, "belt")
    model = ct.Model(mesh)
    model.section(list(range(n)), element="Q4I", material=ct.Elastic(E=1e5, nu=0.0, rho=1.0))
    model.spring(list(range(n, n + len(middle))), k / len(middle), "x")
    model.contact("bottom", floor(reference=carrier), friction=law, name="belt")
    model.force("top", y=-preload)
    table(model, "run", [0.0, 10.0], [0.0, 10.0])
    model.fix("belt", x=v, y=0.0, rotation=True, amplitude="run")
    model.velocity(x=v)
    ride = 0.4 * preload / k / v

    def motion(t, at):
        return [at[1], preload * (0.2 + 0.2 * math.exp(-10.0 * abs(v - at[1]))) - k * at[0]]

    def sticks(t, at):
        return at[1] - (1.0 - 1e-6) * v

    sticks.terminal, sticks.direction = True, 1.0
    begin = [v * ride, v * (1.0 - 1e-4)]
    slip = solve_ivp(
        motion, (ride, 2.0), begin, events=sticks, rtol=1e-10, atol=1e-12, dense_output=True
    )
    again = slip.t_events[0][0]
    end = again + 0.3 * ride
    frames = ct.solve(model, ct.Dynamic(period=end, increments=300)).frames
    body = np.arange(mesh.n_nodes - 1)
    for frame in frames[1:]:
        t = frame.time
        x = v * t if t < ride else float(slip.sol(t)[0])
        x = float(slip.y[0, -1]) + v * (t - again) if t > again else x
        assert frame.U[body, 0].mean() == pytest.approx(x, abs=0.03 * v * ride)


@pytest.mark.parametrize("increments", [None, 7])
def test_dragged_block_has_the_friction_of_its_speed(increments):
    # A period of 4 s and a way of 2: 0.5 per second, in one increment or in more.
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1e6, nu=0.0))
    model.contact("bottom", floor(), friction=LAW, name="floor")
    model.pressure("top", 3.0)
    model.fix("left", x=2.0, y=None)
    given = {} if increments is None else {"increments": increments}
    last = ct.solve(model, ct.Static(nlgeom=True, period=4.0, **given)).frames[-1]
    mu = KINETIC + (STATIC - KINETIC) * math.exp(-DECAY * 0.5)
    assert abs(last.scalars["floor: friction x"]) == pytest.approx(6.0 * mu, rel=1e-3)


def test_table_of_rates_and_pressures():
    law = ct.FrictionTable([(0.3, 0.0, 5.0), (0.1, 1.0, 5.0), (0.2, 0.0, 15.0), (0.0, 2.0, 15.0)])
    at = law(np.array([0.5, 0.5, 9.0, 0.5]), np.array([5.0, 10.0, 0.0, 99.0]))
    np.testing.assert_allclose(at, [0.2, 0.175, 0.1, 0.15])
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1e6, nu=0.0))
    model.contact("bottom", floor(), friction=law, name="floor")
    model.pressure("top", 10.0)
    model.fix("left", x=0.5, y=None)
    last = ct.solve(model, ct.Static(nlgeom=True)).frames[-1]
    # The mean pressure 10 is that of all nodes but for the moment of the friction.
    lever = 0.175 * 20.0
    assert abs(last.scalars["floor: friction x"]) == pytest.approx(lever, rel=0.02)


def test_nodes_have_their_own_pressures():
    # Two bodies without a joint under 5 and 15 on one surface.
    law = ct.FrictionTable([(0.3, 0.0, 5.0), (0.1, 0.0, 15.0)])
    model = ct.Model(ct.mesh.rectangle(2.0, 0.1, nx=20, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1e6, nu=0.0))
    model.contact("bottom", floor(), friction=law, name="floor")
    xs = model.mesh.points[:, 0]
    top = np.flatnonzero(np.abs(model.mesh.points[:, 1] - 0.1) < 1e-9)
    for node in top.tolist():
        share = 0.05 if xs[node] in (0.0, 2.0) else 0.1
        model.force([node], y=-share * (5.0 if xs[node] < 1.0 - 1e-9 else 15.0))
    model.fix("right", x=0.3, y=None)
    last = ct.solve(model, ct.Static(nlgeom=True)).frames[-1]
    left, right = 0.95 * 5.0, 1.05 * 15.0
    exact = 0.3 * left + 0.1 * right
    assert abs(last.scalars["floor: friction x"]) == pytest.approx(exact, rel=0.02)


def test_friction_that_varies_is_written_and_stored(tmp_path):
    table = ct.FrictionTable([(0.3, 0.0, 5.0), (0.1, 1.0, 5.0), (0.2, 0.0, 15.0)])
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1e6, nu=0.0))
    model.contact("bottom", floor(), friction=LAW, friction_steps={2: table}, name="floor")
    model.fix("left", x=0.0, y=None)
    model.pressure("top", 3.0)
    steps = [ct.Static(nlgeom=True), ct.Static(nlgeom=True)]
    ct.write(model, tmp_path / "model.inp", steps)
    read = ct.read(tmp_path / "model.inp").contacts[0]
    assert (read.friction, read.friction_steps) == (LAW, {2: table})
    results = ct.solve(model, steps)
    results.write(tmp_path / "model.vtkhdf")
    with read_results(tmp_path / "model.vtkhdf") as file:
        stored = file.model.contacts[0]
    assert (stored.friction, stored.friction_steps) == (LAW, {2: table})


CARDS = """*NODE
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000000., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*SURFACE, NAME=TOP
E, S3
*SURFACE, NAME=BOTTOM
E, S1
*SURFACE, TYPE=SEGMENTS, NAME=FLOOR
START, -50., 0.
LINE, 50., 0.
*SURFACE INTERACTION, NAME=I
{friction}
*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE
BOTTOM, FLOOR
*STEP, NLGEOM
*STATIC
4., 4.
*BOUNDARY
1, 1, 1, 2.
4, 1, 1, 2.
*DSLOAD
TOP, P, 3.
*END STEP
"""


@pytest.mark.parametrize(
    ("card", "mu"),
    [
        ("*FRICTION, EXPONENTIAL DECAY\n0.5, 0.2, 1.5", 0.2 + 0.3 * math.exp(-0.75)),
        ("*FRICTION\n0.5, 0.\n0.1, 1.", 0.3),
        ("*FRICTION\n0.4, 1000.", 0.4),
    ],
)
def test_cards_of_friction_that_varies(tmp_path, card, mu):
    (tmp_path / "a.inp").write_text(CARDS.format(friction=card))
    last = ct.solve(ct.read(tmp_path / "a.inp")).frames[-1]
    force = abs(last.scalars["BOTTOM-FLOOR: friction x"])
    assert force == pytest.approx(6.0 * mu, rel=2e-3)


def test_a_card_of_pressures(tmp_path):
    (tmp_path / "a.inp").write_text(CARDS.format(friction="*FRICTION\n0.4, , 2.\n0.2, , 4."))
    found = ct.read(tmp_path / "a.inp").contacts[0].friction
    assert found == ct.FrictionTable([(0.4, 0.0, 2.0), (0.2, 0.0, 4.0)])


@pytest.mark.parametrize(
    ("card", "said"),
    [
        ("*FRICTION, EXPONENTIAL DECAY\n0.5, 0.2", "decay coefficient is missing"),
        ("*FRICTION, EXPONENTIAL DECAY\n0.5, 0.2, 0.", "decay of friction must be > 0"),
        ("*FRICTION\n0.5, 1.\n0.2, 1.", "given twice"),
        ("*FRICTION\n0.5, 0., 0., 20.\n0.2, 0., 0., 100.", "depends on the temperature"),
        ("*FRICTION, TEST DATA\n0.5\n0.2, 1.", "TEST DATA"),
    ],
)
def test_refused_cards_of_friction(tmp_path, card, said):
    (tmp_path / "a.inp").write_text(CARDS.format(friction=card))
    with pytest.raises(ct.DeckError, match=said):
        ct.read(tmp_path / "a.inp")
