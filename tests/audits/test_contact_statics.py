"""An audit of contact, written from the pages alone: statically determinate bodies, with friction.

Nodes in bowls, discs in grooves, ropes over two drums, levers, gaps, folds. Default settings, one
increment a step.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from tests.support.audits import run
from tests.support.blocks import METHODS, STIFF, block, reaction, scalar, solve, step_ends

FLOOR = ct.RigidCurve.line((-100.0, 0.0), (100.0, 0.0))


def lines(points: Any, *pairs: tuple[int, int]) -> Mesh:
    cells = Cells("line2", np.array(pairs), np.arange(1, len(pairs) + 1))
    return Mesh(np.array(points, dtype=float), [cells], np.arange(1, len(points) + 1))


@pytest.mark.parametrize("mu", [0.0, 0.2])
@pytest.mark.parametrize("x", [0.5, -1.2])
def test_a_node_drawn_up_a_bowl_and_let_back(mu: float, x: float) -> None:
    """A node with the weight W in a bowl of radius 2, moved to x with sin(a) = x / 2, needs H = W
    tan(a + phi); let back to x / 2, H = W tan(a - phi). One increment each."""
    radius, weight, phi = 2.0, 3.0, math.atan(mu)
    mesh = lines([(0.0, 0.0), (0.0, 2.0)], (1, 0))
    k = 500.0
    model = ct.Model(mesh)
    model.spring([0], k, "x x")
    model.force([0], y=-weight)
    bowl = ct.RigidCurve.circle((0.0, radius), radius, inside=True)
    model.contact([0], bowl, friction=mu, name="bowl")
    places = [(x, 1.0), (x / 2, -1.0)]
    pulls = [
        math.copysign(1.0, x) * weight * math.tan(math.asin(abs(u) / radius) + side * phi)
        for u, side in places
    ]
    steps = []
    for (u, _), pull in zip(places, pulls, strict=True):
        step = ct.Static()
        step.fix([1], x=u + pull / k, y=0.0)
        steps.append(step)
    results = solve(model, *steps)
    for frame, (u, _), pull in zip(step_ends(results)[-2:], places, pulls, strict=True):
        assert frame.U[0, 0] == pytest.approx(u, rel=1e-5)
        assert frame.U[0, 1] == pytest.approx(radius - math.sqrt(radius**2 - u**2), rel=1e-5)
        assert frame.RF[1, 0] == pytest.approx(pull, rel=1e-5)
        assert frame.scalars["bowl: force y"] == pytest.approx(weight, rel=1e-6)


@pytest.mark.parametrize("mu", [0.1, 0.4])
@pytest.mark.parametrize("turn", [45.0, -120.0])
def test_a_disc_turns_in_a_groove(mu: float, turn: float) -> None:
    """A disc with W between two flanks at 45 degrees, turned: N1 and N2 with mu N along the turn's
    way balance W; the moment is mu R (N1 + N2), as sum: W = (N1 + N2) (1 + mu^2)^(1/2) cos ...
    solved from the two equations of force."""
    weight, radius, s = 5.0, 1.0, math.sqrt(0.5)
    left = block(0.4, 0.2, 8, 2, angle=-45.0)
    # flanks whose tops pass through the touching points (-s, -s) and (s, -s) of the disc about
    # the origin
    top_left = np.array([-s, -s]) - 0.2 * np.array([s, -s])
    a = ct.mesh.move(left, tuple(top_left - 0.2 * np.array([s, s])))
    right = block(0.4, 0.2, 8, 2, angle=45.0)
    b = ct.mesh.move(
        right, tuple(np.array([s, -s]) - 0.2 * np.array([s, s]) - 0.2 * np.array([-s, s]))
    )
    mesh = ct.mesh.assembly(a=a, b=b)
    disc = ct.mesh.add_node(mesh, 0.0, 0.0, "disc")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=STIFF)
    model.fix("a.bottom")
    model.fix("b.bottom")
    circle = ct.RigidCurve.circle((0.0, 0.0), radius, reference=disc)
    for name in "ab":
        model.contact(f"{name}.top", circle, friction=mu, name=name)
    press, rotate = ct.Static(), ct.Static()
    press.force("disc", y=-weight)
    press.fix("disc", x=None, y=None, rotation=0.0)
    rotate.fix("disc", x=None, y=None, rotation=math.radians(turn))
    results = solve(model, press, rotate)
    sign = math.copysign(1.0, turn)
    # on the disc: normals (s, s) at the left, (-s, s) at the right; the surface of a disc that
    # turns to the left
    # moves along (s, -s) at the left flank and (s, s) at the right one: friction is against it
    one = np.array([s, s]) - sign * mu * np.array([s, -s])
    two = np.array([-s, s]) - sign * mu * np.array([s, s])
    n1, n2 = np.linalg.solve(np.column_stack([one, two]), [0.0, weight])
    assert results.frames[-1].RF[disc, 2] == pytest.approx(sign * mu * radius * (n1 + n2), rel=1e-3)
    force = np.array([scalar(results, f"a: force {c}") for c in "xy"])
    assert force == pytest.approx(-n1 * one, rel=1e-3)


@pytest.mark.parametrize("method", METHODS)
def test_a_plate_drawn_from_between_two_others(method: str) -> None:
    """The middle of three elastic plates is drawn; it is slave above and master below: 2 mu P, half
    of it at each joint."""
    mu, load = 0.2, 8.0
    bodies = {
        "low": block(4.0, 0.5, 7, 1),
        "mid": block(4.0, 0.5, 8, 1, (0.0, 0.5)),
        "top": block(4.0, 0.5, 6, 1, (0.0, 1.0)),
    }
    model = ct.Model(ct.mesh.assembly(**bodies))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3))
    model.fix("low.bottom")
    model.fix("top.left", x=0.0, y=None)
    model.fix("top.right", x=0.0, y=None)
    model.force("top.top", y=-load)
    model.fix("mid.right", x=0.3, y=None)
    model.contact("low.top", "mid.bottom", friction=mu, method=method, name="under")
    model.contact("mid.top", "top.bottom", friction=mu, method=method, name="over")
    results = solve(model)
    assert reaction(results, "mid.right")[0] == pytest.approx(2 * mu * load, rel=1e-3)
    assert scalar(results, "under: force x") == pytest.approx(mu * load, rel=1e-3)
    assert scalar(results, "over: force x") == pytest.approx(-mu * load, rel=1e-3)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_the_end_of_a_cantilever_rubs_on_another(way: float) -> None:
    """The end node of an upper cantilever lies on a lower one at a of its length l; the upper root
    turns down by d at its end: N = d / (L^3 / 3EI + a^3 / 3EI). Moved along by 1e-3, the root
    needs mu N."""
    modulus, inertia, mu, d, length, a = 1e6, 0.1, 0.3, 0.01, 4.0, 3.0
    upper = [(x, 0.0) for x in np.linspace(-1.0, 3.0, 3)]
    lower = [(x, -0.05) for x in (0.0, 1.5, 2.3, 3.7)]
    pairs = [(0, 1), (1, 2), (3, 4), (4, 5), (5, 6)]
    mesh = lines(upper + lower, *pairs)
    mesh.cell_sets["lower"] = np.array([2, 3, 4])
    model = ct.Model(mesh)
    model.beam(
        [0, 1, 2, 3, 4],
        material=ct.Elastic(E=modulus, nu=0.3),
        area=10.0,
        inertia=inertia,
        height=0.1,
    )
    model.fix([3], rotation=True)
    model.contact([2], "lower", friction=mu, name="tip")
    turn, along = ct.Static(), ct.Static()
    turn.fix([0], x=0.0, y=0.0, rotation=-d / length)
    along.fix([0], x=way * 1e-3, y=0.0, rotation=-d / length)
    results = solve(model, turn, along)
    compliance = (length**3 + (a + way * 1e-3) ** 3) / (3 * modulus * inertia)
    normal = d / compliance
    assert scalar(results, "tip: force y") == pytest.approx(normal, rel=2e-2)
    normal = scalar(results, "tip: force y")
    assert abs(reaction(results, [0])[0]) == pytest.approx(mu * normal, rel=3e-2)


def test_a_deck_with_two_gaps(tmp_path: Path) -> None:
    """A plate of E = 1000 and nu = 0 is drawn by 40 to stops .01 away: 10 stretch it, 15 press on
    each stop."""
    text = (Path(__file__).parents[2] / "docs/decks/gap.inp").read_text()
    text = text.replace("1000., 0.3", "1000., 0.").replace("*STEP, NLGEOM", "*STEP")
    results = run(tmp_path / "job.inp", text)
    ends = [int(np.flatnonzero(results.mesh.node_labels == k)[0]) for k in (5, 6)]
    for node in ends:
        assert results.frames[-1].RF[node, 0] == pytest.approx(-15.0, rel=1e-8)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("apart", [0.3, -0.02])
def test_a_clearance_is_independent_of_the_coordinates(method: str, apart: float) -> None:
    """A column of nu = 0 stands `apart` above the floor, but has the clearance .01: lowered by .05
    it is pressed by .04, and drawn aside it rubs."""
    modulus, mu = 1e4, 0.3
    model = ct.Model(block(2.0, 1.0, 4, 2, (0.0, apart)))
    model.section("all", element="Q4", material=ct.Elastic(E=modulus, nu=0.0))
    model.contact(
        "bottom", FLOOR, clearance=0.01, friction=mu, method=method, reach=2.0, name="floor"
    )
    press, draw = ct.Static(), ct.Static()
    press.fix("top", x=0.0, y=-0.05)
    draw.fix("top", x=1.0, y=-0.05)
    results = solve(model, press, draw)
    pressed, drawn = step_ends(results)[-2:]
    assert pressed.scalars["floor: force y"] == pytest.approx(2.0 * modulus * 0.04, rel=1e-6)
    assert drawn.scalars["floor: force x"] == pytest.approx(
        -mu * drawn.scalars["floor: force y"], rel=1e-6
    )


@pytest.mark.parametrize("method", METHODS)
def test_friction_in_a_linear_step_sticks_and_reverses(method: str) -> None:
    """A block that is stiff in a linear step, with a spring k to the ground at its side, on a belt:
    the belt moves by D: the spring has min(k D, mu P), and after a return by B max(mu P - k B,
    -mu P)."""
    mu, load, k = 0.25, 8.0, 4.0
    mesh = block(2.0, 0.5, 4, 1)
    belt = ct.mesh.add_node(mesh, 0.0, -1.0, "belt")
    ground = ct.mesh.add_node(mesh, -3.0, 0.25, "ground")
    node = int(np.argmin(mesh.points[:-2].sum(axis=1)))
    mesh.cells.append(Cells("line2", np.array([[ground, node]]), np.array([1000])))
    n = mesh.n_cells - 1
    model = ct.Model(mesh)
    model.section(np.arange(n), element="Q4I", material=STIFF)
    model.spring([n], k, "x x")
    model.fix("ground")
    model.force("top", y=-load)
    line = ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0), reference=belt)
    model.contact("bottom", line, friction=mu, method=method, name="belt")
    steps = [ct.Static(nlgeom=False) for _ in range(4)]
    for step, x in zip(steps, (0.0, 0.3, 0.9, 0.2), strict=True):
        step.fix("belt", x=x, y=0.0, rotation=True)
    results = solve(model, *steps)
    force, before = 0.0, 0.0
    for frame, x in zip(step_ends(results)[-4:], (0.0, 0.3, 0.9, 0.2), strict=True):
        force = float(np.clip(force + k * (x - before), -mu * load, mu * load))
        before = x
        assert -frame.RF[ground, 0] == pytest.approx(force, rel=1e-4, abs=1e-6)


@pytest.mark.parametrize("place", [0.4, -0.9])
def test_a_lever_on_two_posts(place: float) -> None:
    """A rigid lever, a free rigid line with its node under P at x, lies on two posts at -1 and 1: P
    (1 +- x) / 2; the lever turns by the difference of their shortenings over 2."""
    load, stiff = 6.0, 1e4
    mesh = lines([(-1, 0), (-1, 1), (1, 0), (1, 1)], (0, 1), (2, 3))
    lever = ct.mesh.add_node(mesh, place, 1.0, "lever")
    model = ct.Model(mesh)
    model.truss([0, 1], material=ct.Elastic(E=stiff, nu=0.3), area=1.0)
    model.fix([0, 2])
    model.fix([1, 3], x=0.0, y=None)
    bar = ct.RigidCurve.line((3.0, 1.0), (-3.0, 1.0), reference=lever)
    model.contact([1, 3], bar, name="lever")
    model.force("lever", y=-load)
    model.fix("lever", x=0.0, y=None)
    results = solve(model)
    frame = results.frames[-1]
    left, right = load * (1 - place) / 2, load * (1 + place) / 2
    assert frame.C[[1, 3], 0] == pytest.approx([left, right], rel=1e-4)
    assert frame.UR[lever] == pytest.approx((left - right) / stiff / 2, rel=1e-3)


@pytest.mark.parametrize("method", METHODS)
def test_the_arms_of_a_fold_meet(method: str) -> None:
    """Two arms of length L and height 1 from one back, g apart, are pressed at their ends by F:
    each bends by g / 2 under 3 EI g / 2 / L^3 (and its shear), the rest passes from one to the
    other: the shear force of an arm is that of g / 2, not F. Self-contact of the inner contour."""
    length, gap, modulus, force = 20.0, 0.2, 1e5, 0.6
    a = block(length, 1.0, 20, 2)
    b = block(length, 1.0, 20, 2, (0.0, 1.0 + gap))
    model = ct.Model(ct.mesh.assembly(a=a, b=b))
    model.section("all", element="Q4I", material=ct.Elastic(E=modulus, nu=0.0))
    model.fix("a.left")
    model.fix("b.left")
    tips = {}
    for body, y, sign in (("a", 0.0, 1.0), ("b", 2.0 + gap, -1.0)):
        node = int(np.argmin(np.hypot(*(model.mesh.points - [length, y]).T)))
        tips[body] = node
        model.force([node], y=sign * force)
    inner = ["a.top", "b.bottom"]
    model.contact(inner, inner, friction=0.4, method=method, name="fold")
    results = solve(model, ct.Static(nlgeom=False))
    bend = gap / 2 / (length**3 / (3 * modulus / 12) + length * 1.2 / (modulus / 2))
    move = (
        results.frames[-1].U[model.mesh.nodes_of(inner[0])[-1], 1],
        results.frames[-1].U[model.mesh.nodes_of(inner[1])[-1], 1],
    )
    assert move[0] - move[1] == pytest.approx(gap, rel=0.1)
    cut = results.section((10.5, -1.0), (10.5, 1.1))
    assert abs(cut.V) == pytest.approx(bend, rel=4e-2)


def sprung(method: str, mu: float, angle: float = 0.0) -> tuple[ct.Model, int, np.ndarray]:
    """A block on a line at an angle with a spring k = 5 along it; the far node of the spring, the
    way."""
    way = np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle))])
    mesh = block(2.0, 0.5, 4, 1, angle=angle)
    node = int(np.argmax(mesh.points @ way))
    far = ct.mesh.add_node(mesh, *(mesh.points[node] + 60.0 * way), "far")
    mesh.cells.append(Cells("line2", np.array([[far, node]]), np.array([1000])))
    n = mesh.n_cells - 1
    model = ct.Model(mesh)
    model.section(np.arange(n), element="Q4I", material=ct.Elastic(E=1e6, nu=0.3))
    model.spring([n], 5.0)
    line = ct.RigidCurve.line(-90.0 * way, 90.0 * way)
    model.contact("bottom", line, friction=mu, method=method, name="line")
    return model, far, way


@pytest.mark.parametrize("method", METHODS)
def test_the_largest_friction_sticks(method: str) -> None:
    """With the coefficient 1e6 a block that a spring draws by 2 passes all of its force, 10, to the
    floor."""
    model, far, _ = sprung(method, 1e6)
    model.fix([far], x=2.0, y=0.0)
    model.force("bottom", y=-20.0)
    results = solve(model)
    assert reaction(results, [far])[0] == pytest.approx(10.0, rel=1e-4)
    assert scalar(results, "line: friction x") == pytest.approx(-10.0, rel=1e-4)
    assert scalar(results, "ALLFD") == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("angle", [137.0, -73.0])
def test_a_drawn_block_in_turned_axes(method: str, angle: float) -> None:
    """Floor, load and pull are turned by an angle: so is the force of the floor, (-mu P, P)."""
    mu, load = 0.4, 6.0
    model, far, way = sprung(method, mu, angle)
    across = np.array([-way[1], way[0]])
    model.force("top", x=-load * across[0], y=-load * across[1])
    model.fix([far], x=7.0 * way[0], y=7.0 * way[1])
    results = solve(model)
    expected = load * across - mu * load * way
    assert [scalar(results, f"line: force {c}") for c in "xy"] == pytest.approx(expected, rel=1e-4)
    assert reaction(results, [far])[:2] == pytest.approx(mu * load * way, rel=1e-4)


@pytest.mark.parametrize("method", METHODS)
def test_a_block_that_sticks_slips_when_its_load_falls(method: str) -> None:
    """P = 8 with mu = .25 holds a spring's 1; at P = 2 the bound is .5, and the block gives way by
    .5 / k; at P = 8 again the spring keeps its .5."""
    model, far, _ = sprung(method, 0.25)
    steps = []
    for load, x in ((8.0, 0.0), (8.0, 0.2), (2.0, 0.2), (8.0, 0.2)):
        step = ct.Static()
        step.force("top", y=-load)
        step.fix([far], x=x, y=0.0)
        steps.append(step)
    results = solve(model, *steps)
    pulls = [float(f.RF[far, 0]) for f in step_ends(results)[-4:]]
    assert pulls == pytest.approx([0.0, 1.0, 0.5, 0.5], rel=1e-3, abs=1e-6)
