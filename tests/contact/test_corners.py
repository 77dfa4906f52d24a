"""Sharp corners have constraints of their own, whichever side is the master.

A square on its tip is pressed into a block, whose edges are as long as the depth many times over,
at the middle of one of them.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.contact_torture import run
from benchmarks.corpora.contact_problems import problem
from corota import _core
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from corota.analysis.terms.contact.contact import ContactTerm
from corota.model.contact import METHODS
from corota.model.loads import Fixed
from support.pairs import quickly
from tests.contracts.test_contact_gaps import (
    LENGTHS,
    chain,
    check_derivatives,
    check_invariance,
    moved,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

DEEP = 0.06
ELASTIC = ct.Elastic(E=1000.0, nu=0.3, rho=1e-3)


def tip_on_block(
    slave: str, method: str, friction: float = 0.0, unit: float = 1.0, **more: Any
) -> ct.Model:
    """A square on its tip on a block, one of them the slave."""
    block = ct.mesh.rectangle(2.0, 1.0, nx=5, ny=3)
    square = ct.mesh.move(ct.mesh.rectangle(0.5, 0.5, nx=4, ny=4), (1.0, 1.0), angle=45.0)
    mesh = ct.mesh.move(ct.mesh.assembly(block=block, square=square), scale=unit)
    sets = mesh.edge_sets
    lower = np.vstack([sets["square.left"], sets["square.bottom"]])
    model = ct.Model(mesh)
    model.section("all", element="Q4", material=ELASTIC, local_strain="logarithmic", thickness=unit)
    both: list[Any] = ["block.top", lower] if slave == "block" else [lower, "block.top"]
    model.contact(*both, method=method, friction=friction, name="tip", **more)
    return model


def pushed(model: ct.Model, aside: float = 0.0, unit: float = 1.0) -> ct.Results:
    """Pressed in, then drawn aside."""
    model.fix("block.bottom")
    sets = [model.mesh.nodes_of(f"square.{side}") for side in ("right", "top")]
    held = np.unique(np.concatenate(sets))
    steps = [ct.Static(supports=[Fixed(held, 0, 0.0), Fixed(held, 1, -DEEP * unit)])]
    if aside:
        steps.append(ct.Static(first_increment=0.2, supports=[Fixed(held, 0, aside * unit)]))
    return ct.solve(model, steps, threads=1)


def force(results: ct.Results, frame: int = -1) -> np.ndarray:
    """On the slave."""
    at = results.frames[frame].scalars
    return np.array([at["tip: force x"], at["tip: force y"]])


def depth(results: ct.Results) -> float:
    """Of the tip below the edge that it meets."""
    mesh = results.model.mesh
    x = mesh.points + results.frames[-1].U
    top = mesh.nodes_of("block.top")
    top = top[np.argsort(x[top, 0])]
    lower = mesh.nodes_of("square.left")
    tip = int(lower[np.argmin(mesh.points[lower, 1])])
    return float(np.interp(x[tip, 0], x[top, 0], x[top, 1]) - x[tip, 1])


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("method", METHODS)
def test_a_corner_presses_the_same_as_slave_and_as_master(method: str, friction: float) -> None:
    """Exchanged, the tip is a node against the same edge: the equations are the same."""
    own = pushed(tip_on_block("block", method, friction), aside=0.09)
    other = pushed(tip_on_block("square", "node_to_segment", friction), aside=0.09)
    assert own.times[-1] == other.times[-1] == 2.0
    assert abs(depth(own)) < 1e-9
    for time in (1.0, 2.0):
        pressed = [force(r, int(np.flatnonzero(r.times == time)[0])) for r in (own, other)]
        assert pressed[0][1] < -1.0
        np.testing.assert_allclose(pressed[0], -pressed[1], rtol=1e-6, atol=1e-6)
    if friction:
        along = own.frames[-1].scalars["tip: friction x"]
        assert along == pytest.approx(-friction * force(own)[1], rel=0.05)


def test_mortar_keeps_the_corners_of_its_slave_out() -> None:
    assert abs(depth(pushed(tip_on_block("square", "mortar")))) < 1e-9


@pytest.mark.parametrize("method", METHODS)
def test_forces_and_moments_of_a_corner_balance(method: str) -> None:
    results = pushed(tip_on_block("block", method, 0.3), aside=0.09)
    last, mesh = results.frames[-1], results.model.mesh
    x, reaction = mesh.points + last.U, last.RF[:, :2]
    size = np.abs(reaction).sum()
    assert np.abs(reaction.sum(axis=0)).max() < 1e-12 * size
    assert abs((x[:, 0] * reaction[:, 1] - x[:, 1] * reaction[:, 0]).sum()) < 1e-12 * size
    of_block = reaction[mesh.nodes_of("block.bottom")].sum(axis=0)
    np.testing.assert_allclose(-of_block, force(results), atol=1e-10 * size)
    # The nodes beside the corner carry its force as pressures on their areas.
    p, q = results.nodal("CPRESS"), results.nodal("CSHEAR")
    on = mesh.nodes_of("block.top")
    area = np.where((mesh.points[on, 0] > 0.1) & (mesh.points[on, 0] < 1.9), 0.4, 0.2)
    whole = np.hypot(area @ p[on], area @ q[on])
    # Slip follows the tangent at the start of the increment.
    assert whole == pytest.approx(np.hypot(*force(results)), rel=1e-3)


def test_the_same_in_another_unit() -> None:
    runs = [pushed(tip_on_block("block", "mortar", 0.3, u), aside=0.09, unit=u) for u in (1.0, 1e3)]
    assert len(runs[0].frames) == len(runs[1].frames)
    np.testing.assert_allclose(1e-3 * runs[1].frames[-1].U, runs[0].frames[-1].U, atol=1e-9)


def wedge_force(method: str, fillet: float) -> float:
    """Of a rigid wedge pressed in between two nodes."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=5, ny=3)
    tool = ct.mesh.add_node(mesh, 1.0, 2.0, "tool")
    model = ct.Model(mesh)
    model.section("all", element="Q4", material=ELASTIC, local_strain="logarithmic")
    model.fix("bottom")
    model.fix("tool", x=0.0, y=-DEEP - (math.sqrt(2.0) - 1.0) * fillet, rotation=True)
    points = [(2.0, 2.0), (1.03, 1.0), (0.0, 2.0)]
    wedge = ct.RigidCurve.polyline(points, fillet=fillet, reference=tool)
    model.contact("top", wedge, method=method)
    last = ct.solve(model, ct.Static(), threads=1).frames[-1]
    assert abs(last.RF.sum(axis=0)[:2]).max() < 1e-10 * abs(last.RF[tool, 1])
    return float(last.RF[tool, 1])


@pytest.mark.parametrize("method", METHODS)
def test_a_rigid_corner_presses_as_one_with_a_tiny_fillet(method: str) -> None:
    """Such a fillet meets edges in node-to-segment contact: another constraint."""
    # The foremost point of a fillet of radius r is about r (sqrt 2 - 1) behind the corner.
    assert wedge_force(method, 0.0) == pytest.approx(wedge_force("node_to_segment", 1e-6), rel=1e-4)


def rounded(wedge: NDArray[np.float64], fillet: float) -> NDArray[np.float64]:
    """Segments of a tool with a fillet, and the body on the left as in the core."""
    rows = ct.RigidCurve.polyline(wedge[::-1], fillet=fillet).segments[::-1]
    return np.column_stack([rows[:, 2:4], rows[:, :2], rows[:, 4:6], -rows[:, 6]])


@pytest.mark.parametrize("fillet", [1e-6, 0.04, 0.3])
def test_a_small_fillet_is_kept_out_as_in_node_to_segment_contact(fillet: float) -> None:
    forces = [wedge_force(method, fillet) for method in METHODS]
    assert forces[0] == pytest.approx(forces[1], rel=1e-3)


@pytest.mark.parametrize("number", [1273, pytest.param(58, marks=pytest.mark.slow)])
def test_a_snap_fit_passes_a_small_fillet_with_the_force_of_a_finer_mesh(number: int) -> None:
    """Peaks of node-to-segment contact with slave edges a quarter (58: half) as long.

    One stopped where a node hung at the wall beside the fillet, which lay between two nodes.
    """
    given = problem(number, size=0.5)
    results = ct.solve(given.model, given.steps, threads=1)
    assert results.times[-1] == sum(step.period for step in given.steps)
    peaks = [np.abs(results.history(f"hook: force {axis}")).max() for axis in "xy"]
    exact = {1273: (5.151e-8, 5.657e-8), 58: (1.0999e10, 1.7202e10)}[number]
    assert peaks == pytest.approx(exact, rel=0.1)
    assert peaks[1] == pytest.approx(exact[1], rel=0.03)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("slave", ["linear", "quadratic", "drilling"])
@pytest.mark.parametrize("kind", ["edges", "turning", "fillet", "slave"])
def test_gap_and_slip_of_a_corner_have_exact_derivatives(
    kind: str, slave: str, method: str
) -> None:
    rng = np.random.default_rng(5)
    flat = np.column_stack([np.linspace(1.2, -0.2, 4), np.zeros(4)])
    wedge = np.array([[0.1, 0.5], [0.48, 0.02], [0.9, 0.5]])
    s = chain(slave, flat, 0, 0.02)
    m = chain("linear", wedge, len(s[0]))
    thick = np.full(len(s[1]), 2.0)
    X = np.vstack([s[0], m[0]])
    more: dict[str, Any] = {"method": method, "corners": True, **LENGTHS}
    if kind in ("turning", "fillet"):
        rows = np.column_stack([wedge[:-1], wedge[1:], np.zeros((2, 3))])
        if kind == "fillet":
            rows = rounded(wedge, 0.1)
        contact = _core.Contact.rigid(X, s[1], s[2], thick, rows, len(s[0]), (0.0, 0.0), **more)
    elif kind == "edges":
        contact = _core.Contact.edges(X, s[1], s[2], thick, m[1], m[2], **more)
    else:
        contact = _core.Contact.edges(X, m[1], m[2], thick[:2], s[1], s[2], **more)
    # The master of a body has two ends besides.
    sharp = int(method == "mortar" or kind in ("edges", "turning"))
    ends = 2 if kind in ("edges", "slave") else 0
    assert len(contact.corners) == ends + sharp
    x, old = moved(X, rng), moved(X, rng)
    check_derivatives(contact, x, old, rng)
    check_invariance(contact, x, old)
    if sharp:
        found = contact.evaluate(x, old)
        corner = len(contact.nodes) - (1 if kind == "slave" else 1 + ends)
        assert (found["constraint"] == corner).sum() == 1
    # A copy that takes the state evaluates the same.
    other = contact.state()
    contact.commit()
    contact.restore_state(*other)
    assert all(np.array_equal(a, b) for a, b in zip(contact.state(), other, strict=True))


@pytest.mark.parametrize("method", METHODS)
def test_corners_at_nodes_are_redundant_and_do_no_harm(method: str) -> None:
    """Blocks whose corners are at each other's nodes, all sides in contact surfaces."""
    a, b = (ct.mesh.rectangle(1.0, 1.0, nx=4, ny=4, origin=(0.0, y)) for y in (0.0, 1.0))
    mesh = ct.mesh.assembly(low=a, up=b)
    sets = mesh.edge_sets
    surfaces = [
        np.vstack([sets[f"{w}.{e}"] for e in es.split()])
        for w, es in (("low", "top right left"), ("up", "bottom right left"))
    ]
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ELASTIC)
    model.fix("low.bottom", x=None, y=0.0)
    model.fix([0, int(mesh.nodes_of("up.bottom")[0])], y=None, x=0.0)
    model.fix("up.top", x=None, y=-0.02)
    model.contact(*surfaces, method=method, friction=0.2, name="joint")
    results = ct.solve(model, ct.Static(), threads=1)
    assert not results.notes
    stress = results.nodal("S22")
    assert np.ptp(stress) < 1e-8 * abs(stress).max()


@pytest.mark.parametrize("element", ["OPT", "Q4D"])
def test_corners_beside_nodes_that_stick_take_no_iterations(element: str) -> None:
    """Blocks on each other that friction holds: their overhanging corners cannot slide.

    Slips of corners differ from those of the nodes beside them by the curvature of the motion. The
    run took 47 increments; a pile of four needed more than a thousand.
    """
    bodies, y = {}, 0.0
    cell = "tri3" if element == "OPT" else "quad4"
    for name, left, height, n in (("a", 0.0, 0.25, 4), ("b", 0.07, 0.3, 4), ("c", 0.02, 0.2, 3)):
        bodies[name] = ct.mesh.rectangle(1.0, height, n, 1, cell, origin=(left, y))
        y += height
    model = ct.Model(ct.mesh.assembly(**bodies))
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    model.contact("a.bottom", ct.RigidCurve.line((-3.0, 0.0), (4.0, 0.0)), friction=0.5, name="ab")
    model.contact("b.bottom", "a.top", friction=0.5, name="low")
    model.contact("c.bottom", "b.top", friction=0.5, name="high")
    model.gravity(y=-1.0, x=0.07)
    results = ct.solve(model, ct.Static(), threads=1)
    assert len(results.frames) == 2
    assert results.info["iterations"] <= 6
    last = results.frames[-1].scalars
    for pair, weight in (("ab", 0.75), ("low", 0.5), ("high", 0.2)):
        forces = [last[f"{pair}: force {axis}"] for axis in "xy"]
        assert forces == pytest.approx([-0.07 * weight, weight], rel=1e-8)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("beside", [0.0, 1e-8, -1e-8, 1e-4, -1e-4])
def test_a_block_whose_corners_lie_at_nodes_of_a_wider_table(method: str, beside: float) -> None:
    """Matching meshes: the corner of the block and the node of the table share their force.

    Their gaps differ by the slope of the table over a ten-thousandth of an edge. With friction the
    load stalled at .1 %.
    """
    parts = {
        "table": ct.mesh.rectangle(4.0, 1.0, 4, 1),
        "block": ct.mesh.rectangle(2.0, 1.0, 2, 1, origin=(1.0 + beside, 1.0)),
    }
    for nu in (0.0, 0.3):
        model = ct.Model(ct.mesh.assembly(**parts))
        model.section("all", element="Q4", material=ct.Elastic(E=1000.0, nu=nu))
        model.contact("table.top", "block.bottom", friction=0.2, method=method, name="rest")
        model.fix("table.bottom", x=None, y=0.0)
        corners = [model.mesh.node_sets[f"{part}.bottom"][0] for part in parts]
        model.fix(corners, x=0.0, y=None)
        model.traction("block.top", y=-1.0)
        results = ct.solve(model, ct.Static(), threads=1)
        assert len(results.frames) == 2
        assert results.info["iterations"] <= 12
        last = results.frames[-1].scalars
        assert abs(last["rest: force y"]) == pytest.approx(2.0, rel=1e-8)
        sunk = results.history("U2", at="block.top", combine="mean").values[-1]
        if nu:  # CalculiX 2.20, penalty 1e7, sticking slope 1e6
            assert sunk == pytest.approx(-0.001738, rel=0.01)


@pytest.mark.parametrize("method", METHODS)
def test_corners_between_nodes_that_stick_elsewhere_hold_a_body(method: str) -> None:
    """A block under the middle of one long edge, whose nodes stick to two other bodies."""
    parts = {"left": -0.3, "middle": 1.5, "right": 3.3}
    bodies = {k: ct.mesh.rectangle(1.0, 1.0, 2, 2, origin=(x, 0.0)) for k, x in parts.items()}
    mesh = ct.mesh.assembly(top=ct.mesh.rectangle(4.0, 1.0, 1, 1, origin=(0.0, 1.0)), **bodies)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ELASTIC)
    for side in ("left", "right"):
        model.fix(f"{side}.bottom")
    model.fix("middle.bottom", x=None, y=0.0)
    model.fix("top.top", x=0.0, y=-0.02)
    model.traction("middle.left", x=0.3)
    model.contact("top.bottom", [f"{k}.top" for k in parts], friction=0.5, method=method)
    last = ct.solve(model, ct.Static(), threads=1).frames[-1]
    moved = last.U[mesh.node_sets["middle.bottom"], 0]
    assert 0.0 < moved.mean() < 0.01


@pytest.mark.parametrize(
    "scheme",
    quickly(
        ["energy_momentum", "hht", "central_difference"], "energy_momentum", "central_difference"
    ),
)
def test_a_flying_corner_keeps_the_momentum(scheme: str) -> None:
    model = tip_on_block("block", "mortar", 0.3)
    model.velocity("square", x=3.0, y=-10.0)
    more: dict[str, Any] = {} if scheme != "central_difference" else {"mass": "lumped"}
    results = ct.solve(model, ct.Dynamic(period=0.01, scheme=scheme, **more), threads=1)
    assert results.history("tip: force y").min() < 0.0
    assert abs(results.frames[-1].scalars["energy balance"]) < 1e-2
    if scheme == "central_difference":
        return  # it has no sums of momenta
    for name in ("momentum x", "momentum y", "angular momentum"):
        value = results.history(name)
        np.testing.assert_allclose(value[-1], value[0], rtol=1e-8 if scheme != "hht" else 1e-2)


def test_a_pressure_law_has_no_corners_and_says_so() -> None:
    law = ct.PressureLaw("linear", 1e5)
    results = pushed(tip_on_block("block", "mortar", law=law))
    assert any("the master has sharp corners" in note for note in results.notes)
    assert depth(results) > 0.5 * DEEP
    results = pushed(tip_on_block("square", "mortar", law=law))
    assert not any("sharp corners" in note for note in results.notes)


def test_the_message_of_a_run_that_stops_names_a_corner_under_a_pressure_law() -> None:
    model = tip_on_block("block", "mortar", law=ct.PressureLaw("linear", 1e5))
    system = System(model, Multifrontal())
    system.begin(ct.Static(), 0.0, np.zeros(system.n_dofs), None)
    term = system.term(ContactTerm)
    assert system.wedges() == ""
    term.u = np.zeros(system.n_dofs)
    term.u[system.dofs(model.mesh.nodes_of("square"), 1)] = -DEEP
    assert "sharp corner of the master at node" in system.wedges()


@pytest.mark.parametrize(
    ("degrees", "flat", "with_corner"), [(11.0, 0, 1), (33.0, 0, 2), (77.0, 1, 2)]
)
def test_blunt_vertices_of_a_slave_count_against_a_master_with_corners(
    degrees: float, flat: int, with_corner: int
) -> None:
    """Against a flat master from 50 degrees on, against one with a corner, its own, from 20."""
    height = 0.5 * np.tan(np.radians(0.5 * degrees))
    wedge = np.array([[0.0, 0.5 + height], [0.5, 0.5], [1.0, 0.5 + height]])
    slave = chain("linear", wedge, 0)
    thick = np.full(2, 2.0)
    more: dict[str, Any] = {"method": "mortar", "corners": True, **LENGTHS}
    found = []
    for rise in (0.0, 1.0):
        opposite = np.array([[1.2, -rise], [0.5, 0.0], [-0.2, -rise]])
        m = chain("linear", opposite, 3)
        X = np.vstack([slave[0], m[0]])
        pair = _core.Contact.edges(X, slave[1], slave[2], thick, m[1], m[2], **more)
        found.append(len(pair.corners) - 2)  # and both ends of the master
    assert found == [flat, with_corner]


@pytest.mark.parametrize("number", [pytest.param(49, marks=pytest.mark.slow), 193])
def test_a_hook_past_a_catch_finishes(number: int) -> None:
    """193 stopped with the corner of the catch inside the hook; 49 with vertices of the hook."""
    row = run(number, limit=60, size=0.5)
    assert row["end"] == "done", row["why"]
    assert row["balance"] < 1e-8


@pytest.mark.parametrize("method", METHODS)
def test_a_corner_keeps_its_edge_somewhat_longer_than_it_takes_to_meet_one(method: str) -> None:
    """It meets an edge up to 20 degrees beside its cone, and leaves it 10 degrees later.

    With one angle for both, a corner that is inside at that angle is in force on one side of it and
    absent on the other: no equilibrium there.
    """
    wedge = np.array([[0.0, 1.0], [0.5, 0.5], [1.0, 1.0]])  # a right angle: a cone of 45 degrees
    m = chain("linear", wedge, 2)

    def tilted(degrees: float) -> NDArray[np.float64]:
        """Positions with the edge through the corner turned, the corner .01 inside."""
        angle = np.radians(degrees)
        way = np.array([np.cos(angle), np.sin(angle)])
        up = np.array([-way[1], way[0]])
        edge = np.array([0.5, 0.5]) + 0.01 * up + np.array([[0.6], [-0.6]]) * way
        return np.vstack([np.column_stack([edge, np.zeros(2)]), m[0]])

    slave = chain("linear", tilted(0.0)[:2, :2], 0)
    X = np.vstack([slave[0], m[0]])
    more: dict[str, Any] = {"method": method, "corners": True, **LENGTHS}
    pair = _core.Contact.edges(X, slave[1], slave[2], np.ones(1), m[1], m[2], **more)
    corner = len(pair.nodes) - 3  # before the ends of the master

    def met(degrees: float) -> bool:
        x = tilted(degrees)
        pair.search(x)
        found = pair.evaluate(x, None)
        return bool((found["constraint"] == corner).any())

    assert [met(d) for d in (70.0, 64.0, 70.0, 74.0, 76.0, 70.0, 64.0)] == [
        False,
        True,
        True,
        True,
        False,
        False,
        True,
    ]
    # A step that is refused forgets what it met.
    assert met(64.0)
    pair.restore()
    assert not met(70.0)


def test_a_hook_returns_past_a_coarse_catch() -> None:
    """1813 stopped as the corner of the catch, a little inside, met and left a bowed edge."""
    row = run(1813, limit=60, size=0.5)
    assert row["end"] == "done", row["why"]
    assert row["balance"] < 1e-8


def wedge_under_corner(
    element: str, method: str, friction: float, catch: str, way: float
) -> ct.Model:
    """A hard wedge on a spring, pushed under the corner of a catch by .75 of height.

    Its slope is 1/2 and has 12 edges, of which the corner passes five; the wedge moves by `way`.
    """
    deformable, fillet = catch == "deformable", 0.03 if catch == "fillet" else 0.0
    cell = {"Q8": "quad8", "T6": "tri6", "T3": "tri3", "OPT": "tri3"}.get(element, "quad4")
    first, last = (2.5, 0.5) if way > 0.0 else (0.5, 2.5)
    bottom, end, top, begin = (
        lambda t: (4.0 * t - 2.0, 0.0),
        lambda t: (2.0, last * t),
        lambda t: (4.0 * t - 2.0, first + (last - first) * t),
        lambda t: (-2.0, first * t),
    )
    mesh = ct.mesh.mapped([bottom, end, top, begin], 12, 3, cell)
    left = 2.3 if way > 0.0 else -3.0
    if deformable:
        block = ct.mesh.rectangle(0.7, 2.4, 1, 2, cell, origin=(left, 0.6))
        mesh = ct.mesh.assembly(wedge=mesh, catch=block)
    name = "wedge." if deformable else ""
    ref = ct.mesh.add_node(mesh, 0.0, 0.0, name="ref")
    solids = mesh.n_cells
    mesh.cells.append(ct.Cells("point1", np.array([[ref]]), np.array([solids + 1])))
    model = ct.Model(mesh)
    model.section(list(range(solids)), element=element, material=ct.Elastic(E=1e7, nu=0.3))
    model.spring([solids], 100.0, "y")
    model.rigid(f"{name}bottom", ref)
    model.fix("ref", x=way, y=None, rotation=0.0)
    points = [(left, 0.6), (left, 3.0), (left + 0.7, 3.0), (left + 0.7, 0.6)]
    sides: Any = ct.RigidCurve.polyline(points, closed=True, fillet=fillet)
    if deformable:
        model.fix("catch.top")
        sides = ["catch.left", "catch.bottom", "catch.right"]
    model.contact(f"{name}top", sides, method=method, friction=friction, name="catch")
    return model


@pytest.mark.parametrize(("way", "increments"), [(2.0, None), (-2.0, None), (2.0, 20)])
@pytest.mark.parametrize("friction", [0.0, 0.2])
@pytest.mark.parametrize("catch", ["sharp", "fillet", "deformable"])
@pytest.mark.parametrize("element", ["Q4I", "Q8", "T3", "OPT"])
@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
def test_a_wedge_slides_under_a_corner_that_passes_its_nodes(
    method: str,
    element: str,
    catch: str,
    friction: float,
    way: float,
    increments: int | None,
) -> None:
    """By hand: the spring gives the normal force, slope and friction the force along."""
    model = wedge_under_corner(element, method, friction, catch, way)
    step = ct.Static() if increments is None else ct.Static(increments=increments)
    results = ct.solve(model, step, threads=1)
    ref = int(model.mesh.nodes_of("ref")[0])
    # A fillet touches the slope farther in and higher.
    fillet = 0.03 if catch == "fillet" else 0.0
    down = 0.75 - fillet * (1.5 - math.sqrt(1.25))
    along = 50.0 * way * down * (0.5 + friction) / (1.0 - 0.5 * friction)
    assert results.frames[-1].RF[ref, 0] == pytest.approx(along, rel=1e-3)
    assert results.frames[-1].U[ref, 1] == pytest.approx(-down, rel=1e-3)
