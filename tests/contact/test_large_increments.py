"""Contact in one default increment in which bodies turn far."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from tests.audits.test_contact_arcs import belt, polygon_ratio
from tests.support.blocks import METHODS, STIFF, block, chain, reaction, scalar, solve
from tests.support.pairs import quickly

TURN = 2.0 * math.pi


@pytest.mark.parametrize("turns", quickly([1.0, -1.0, 2.0, 0.998], -1.0, 0.998))
def test_a_drum_turns_whole_turns_below_a_rope(turns: float) -> None:
    """Tensions differ by the factor of the polygon; the rope does not pass through the drum."""
    angle, n, mu, pull = 90.0, 8, 0.25, 1.0
    points = belt(angle, n)
    mesh = chain(points)
    drum = ct.mesh.add_node(mesh, 0.0, 0.0, "drum")
    model = ct.Model(mesh)
    model.truss("chain", material=ct.Elastic(E=1e6, nu=0.3), area=1.0)
    end = points[-1] - points[-2]
    end /= np.hypot(*end)
    model.fix([0])
    model.fix("drum", rotation=turns * TURN)
    model.force([len(points) - 1], x=pull * end[0], y=pull * end[1])
    circle = ct.RigidCurve.circle((0, 0), 1.0, reference=drum)
    model.contact("chain", circle, friction=mu, name="drum")
    results = solve(model)
    left = math.hypot(*reaction(results, [0])[:2])
    assert left == pytest.approx(pull * polygon_ratio(angle, n, mu) ** -np.sign(turns), rel=1e-4)
    frame = results.frames[-1]
    slipping = frame.C[:, 4] == 2.0
    np.testing.assert_allclose(frame.C[slipping, 3], turns * TURN, rtol=1e-3)


@pytest.mark.parametrize("turns", [1.0, -2.0])
@pytest.mark.parametrize("role", ["master", "slave"])
@pytest.mark.parametrize("method", METHODS)
def test_a_meshed_drum_turns_whole_turns(method: str, role: str, turns: float) -> None:
    """Positions show nothing; the rigid core says it. The moment is mu P R, within the tilt of the
    facets of a master that nodes meet; the work is that along the whole way."""
    mu, load, radius, n = 0.4, 10.0, 5.0, 120
    pad = block(0.5, 0.5, 4, 2, (-0.25, radius))
    mesh = ct.mesh.assembly(pad=pad, drum=ct.mesh.annulus(4.0, radius, 2, n))
    axle = ct.mesh.add_node(mesh, 0.0, 0.0, "axle")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0))
    model.fix("pad.left", x=0.0, y=None)
    model.fix("pad.right", x=0.0, y=None)
    model.force("pad.top", y=-load)
    model.rigid("drum.inner", "axle")
    sides = ("pad.bottom", "drum.outer")
    model.contact(*(sides if role == "master" else sides[::-1]), friction=mu, method=method)
    press, rotate = ct.Static(), ct.Static()
    press.fix("axle", rotation=0.0)
    rotate.fix("axle", rotation=turns * TURN)
    results = solve(model, press, rotate)
    moment = results.frames[-1].RF[axle, 2]
    facets = method == "node_to_segment"
    exact = math.copysign(mu * load * radius, turns)
    assert moment == pytest.approx(exact, rel=math.pi / n / mu + 0.01 if facets else 0.01)
    work = abs(turns) * TURN * mu * load * radius
    assert scalar(results, "ALLFD") == pytest.approx(work, rel=0.02)


def drawn_below(angle: float, n: int, mu: float, turn: float) -> tuple[float, int]:
    """Tension of a rope of n chords, held at one end, over the exact one; increments."""
    points = belt(angle, n)
    mesh = chain(points)
    drum = ct.mesh.add_node(mesh, 0.0, 0.0, "drum")
    model = ct.Model(mesh)
    model.truss("chain", material=ct.Elastic(E=1e6, nu=0.3), area=1.0)
    end = points[-1] - points[-2]
    end /= np.hypot(*end)
    model.fix([0])
    model.fix("drum", rotation=turn)
    model.force([len(points) - 1], x=end[0], y=end[1])
    circle = ct.RigidCurve.circle((0, 0), 1.0, reference=drum)
    model.contact("chain", circle, friction=mu, name="drum")
    results = solve(model)
    left = math.hypot(*reaction(results, [0])[:2])
    return left * polygon_ratio(angle, n, mu) ** np.sign(turn), len(results.frames) - 1


@pytest.mark.parametrize("n", [12, 18])
def test_a_rope_over_three_quarters_of_a_drum_does_not_pass_through_it(n: int) -> None:
    """Its ends cross, and its straight parts are long: all of it stays within the search.

    Chords of more than a third of the radius lie inside the drum: a rope that is drawn so stays so.
    """
    assert drawn_below(270.0, n, 0.3, 2.0)[0] == pytest.approx(1.0, rel=1e-4)


@pytest.mark.parametrize("turn", [2.0, -2.0])
@pytest.mark.parametrize("n", [12, 18, 24])
def test_a_rope_over_half_a_drum_slips_one_way_from_the_first_correction(
    n: int, turn: float
) -> None:
    """What sticks in the first correction moves with the drum without traction: which way it slips
    follows from the correction with slip, not from the rounding of that traction."""
    tension, increments = drawn_below(180.0, n, 0.3, turn)
    assert tension == pytest.approx(1.0, rel=1e-6)
    assert increments == 1


@pytest.mark.parametrize(
    ("element", "degrees", "edges", "mu", "increments"),
    [
        ("Q4I", 180.0, 60, 0.3, 1),
        ("Q4I", 270.0, 180, 0.3, 1),
        ("Q8R", 175.0, 58, 0.11, 7),
        ("Q8R", 270.0, 90, 0.3, 1),
    ],
)
def test_a_strip_of_many_edges_is_drawn_around_a_drum_in_few_iterations(
    element: str, degrees: float, edges: int, mu: float, increments: int
) -> None:
    """Each node that sticks takes the whole load: states chosen one by one advance by a node in
    each iteration."""
    cell = "quad8" if element == "Q8R" else "quad4"
    mesh = ct.mesh.annulus(1.0, 1.02, 1, edges, angle=degrees, cell=cell)
    wheel = ct.mesh.add_node(mesh, 0.0, 0.0, "wheel")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e6, nu=0.0))
    model.rigid("end", wheel)
    model.contact("inner", ct.RigidCurve.circle((0.0, 0.0), 1.0), friction=mu, method="mortar")
    step = ct.Static() if increments == 1 else ct.Static(increments=increments)
    step.traction("start", y=-1.0 / 0.02)
    step.fix("wheel", x=0.0, y=0.0, rotation=0.03)
    results = solve(model, step)
    tension = results.frames[-1].RF[wheel, 2] / 1.01
    exact = math.exp(mu * math.radians(degrees) / 1.01)
    assert tension == pytest.approx(exact, rel=0.01)
    assert len(results.frames) - 1 == increments
    assert max(frame.scalars["iterations"] for frame in results.frames[1:]) <= 5


@pytest.mark.parametrize("element", ["beam", "OPT"])
def test_a_node_a_whole_turn_off_its_neighbors_is_refused(element: str) -> None:
    """No element has a force then. A body that turns whole turns is accepted."""
    mesh = ct.mesh.line([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], n=1)
    if element == "OPT":
        mesh = ct.mesh.rectangle(2.0, 1.0, 2, 1, "tri3")
    model = ct.Model(mesh)
    if element == "beam":
        model.beam("all", material=ct.Elastic(E=1e6), area=1e-3, inertia=1e-8)
    else:
        model.section("all", element="OPT", material=ct.Elastic(E=1e6, nu=0.3))
    system = System(model, Multifrontal())
    system.begin(ct.Static(), 0.0, np.zeros(system.n_dofs), None)
    off = np.zeros(system.n_dofs)
    off[system.start[1] + 2] = TURN
    assert np.abs(system.evaluate(off, 0.0).residual).max() < 1e-6
    assert "against each other by 6.28" in system.scales.implausible_displacement(off)
    assert not system.scales.implausible_displacement(np.where(system.is_rotation, TURN, 0.0))


def test_no_node_of_a_wire_drawn_over_a_bar_turns_once_more_than_its_neighbors() -> None:
    """Elements take nodal rotations up to whole turns: three nodes that an iterate had turned by
    2 pi were in equilibrium, with a slip of a whole round and friction the wrong way (pull 6 %
    less). The tension is that of exp(mu pi) within the turn of the chords."""
    mu, way, n, span = 0.25, 0.1, 48, 16
    angles = np.radians(np.linspace(180.0, 0.0, n + 1))
    arc = list(np.column_stack([np.cos(angles), np.sin(angles)]))
    mesh = ct.mesh.line([(-1.0, -1.0), *arc, (1.0, -1.0)], n=[span, *[1] * n, span])
    model = ct.Model(mesh)
    model.beam("all", material=ct.Elastic(E=1e6), area=1e-3, inertia=1e-10)
    bar = ct.RigidCurve.circle((0.0, 0.0), 1.0)
    model.contact("all", bar, friction=mu, name="bar")
    model.fix("start", x=0.0, y=None)
    model.force("start", y=-1.0)
    model.fix("end", x=0.0, y=-way)
    results = solve(model)
    frame = results.frames[-1]
    pull = -reaction(results, mesh.node_sets["end"])[1]
    assert pull == pytest.approx(math.exp(mu * math.pi), rel=2e-3)
    assert np.abs(frame.UR).max() < math.pi / 2
    closed = frame.C[:, 4] == 2.0
    assert 0.0 < frame.C[closed, 3].min() <= frame.C[closed, 3].max() < way


def rolled(travel: float, gap: float, method: str, disc: str, slave: str) -> np.ndarray:
    """Way and turn of a disc of the radius 1 between two plates, over their exact values."""
    parts = {
        "low": block(2.6, 0.2, 26, 1, (-1.3, -0.2)),
        "high": block(3.6, 0.2, 36, 1, (-1.8, 2.0 + 2.0 * gap)),
    }
    if disc == "meshed":
        parts["disc"] = ct.mesh.move(ct.mesh.annulus(0.5, 1.0, 2, 48), (0.0, 1.0 + gap))
    mesh = ct.mesh.assembly(**parts)
    core = ct.mesh.add_node(mesh, 0.0, 1.0 + gap, "core")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=STIFF)
    model.fix("low.bottom")
    model.force("high.top", y=-10.0)
    model.fix("high.left", x=travel, y=None)
    if disc == "meshed":
        model.rigid("disc.inner", core)
    circle = ct.RigidCurve.circle((0.0, 1.0 + gap), 1.0, reference=core)
    for plate in ("low.top", "high.bottom"):
        sides = (plate, "disc.outer" if disc == "meshed" else circle)
        model.contact(
            *(sides if slave == "plates" else sides[::-1]), friction=0.5, method=method, name=plate
        )
    frame = solve(model).frames[-1]
    return np.array([frame.U[core, 0], -frame.UR[core]]) / (0.5 * travel)


@pytest.mark.parametrize(("travel", "gap"), [(2.0, 0.0), (-0.6, 0.02)])
@pytest.mark.parametrize(
    ("disc", "slave"),
    [
        ("rigid", "plates"),
        pytest.param("meshed", "plates", marks=pytest.mark.slow),
        pytest.param("meshed", "disc", marks=pytest.mark.slow),
    ],
)
@pytest.mark.parametrize("method", METHODS)
def test_a_disc_that_nothing_presses_at_first_rolls(
    method: str, disc: str, slave: str, travel: float, gap: float
) -> None:
    """It moves by half the travel, and turns by as much over its radius. Contact begins below and
    above its center, wherever it is at the end: the points that were opposite to those in contact
    at the end would give a turn of 1.127 or .833 for 1."""
    exact = 2e-3 if disc == "rigid" else 2e-2
    np.testing.assert_allclose(rolled(travel, gap, method, disc, slave), 1.0, atol=exact)


@pytest.mark.parametrize("height", [0.25, 0.5])
@pytest.mark.parametrize("element", ["Q4I", "T6"])
@pytest.mark.parametrize("method", METHODS)
def test_a_block_that_a_spring_draws_back_slides_in_one_increment(
    method: str, element: str, height: float
) -> None:
    """Friction takes mu N along the whole way; the block stays flat, far from tipping.

    It stood on its corner: friction held it first, against a spring that pulled with 50 mu N.
    """
    load, mu, stiffness, way = 10.0, 0.3, 100.0, 0.8
    body = ct.mesh.rectangle(1.0, 0.5, nx=4, ny=2, cell="tri6" if element == "T6" else "quad4")
    spring = ct.mesh.line([(1.0, height), (11.0, height)], n=1)
    mesh = ct.mesh.assembly(body=body, spring=spring)
    model = ct.Model(mesh)
    model.section("body", element=element, material=ct.Elastic(E=1e9, nu=0.3))
    model.spring("spring", stiffness)
    start, end = (int(mesh.nodes_of(f"spring.{name}")[0]) for name in ("start", "end"))
    side = mesh.nodes_of("body.right")
    corner = int(side[np.argmin(np.abs(mesh.points[side, 1] - height))])
    for direction in ("x", "y"):
        model.equation((start, direction, 1.0), (corner, direction, -1.0))
    floor = ct.RigidCurve.line((-5.0, 0.0), (6.0, 0.0))
    model.contact("body.bottom", floor, method=method, friction=mu, name="floor")
    steps = [ct.Static(increments=1) for _ in range(4)]
    steps[0].force("body.top", y=-load)
    for step, x in zip(steps, (0.0, way, -way, way), strict=True):
        step.fix([end], x=x, y=0.0)
    results = solve(model, *steps)
    stretch = mu * load / stiffness
    exact = mu * load * (5.0 * way - 5.0 * stretch)
    assert scalar(results, "ALLFD") == pytest.approx(exact, rel=1e-4)
    assert np.abs(results.frames[-1].U[mesh.nodes_of("body.bottom"), 1]).max() < 1e-6
