"""Loads, supports and amplitudes over steps, against answers found apart."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.model.loads import Fixed, Temperature
from support.audits import BARS, CELL, DRILLING, deck_mesh, run

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


def test_amplitudes_over_three_steps(tmp_path: Path) -> None:
    """A force by step time, one by total time and one without amplitude on one chain of bars.

    Tables read by hand at quarters: step time ends with its last value, total time runs on until
    OP=NEW; what OP=NEW takes goes linearly to zero; a new value starts from the old one.
    """
    text = (
        BARS
        + """*STEP
*STATIC, DIRECT
0.25, 1.
*CLOAD, AMPLITUDE=tri
3, 1, 2.
*CLOAD, AMPLITUDE=tot
2, 1, 4.
*END STEP
*STEP
*STATIC, DIRECT
0.25, 1.
*CLOAD
3, 1, -1.
*END STEP
*STEP
*STATIC, DIRECT
0.25, 1.
*CLOAD, OP=NEW
3, 1, 3.
*END STEP
"""
    )
    results = run(tmp_path / "a.inp", text)
    k = 100.0 * 0.2 / 2.0
    end = [0.0, 1.0, 2.0, 1.4, 0.8, *np.linspace(0.8, -1.0, 5)[1:], *np.linspace(-1, 3, 5)[1:]]
    total = np.interp(np.linspace(0, 2, 9), [0, 1, 3], [0, 1, -1]) * 4
    middle = [*total, *(total[-1] * np.array([0.75, 0.5, 0.25, 0.0]))]
    frames = [f for f in results.frames if f.increment > 0 or f.step == 1]
    for f, a, b in zip(frames, end, middle, strict=True):
        assert f.U[1, 0] == pytest.approx((a + b) / k, abs=1e-12)
        assert f.U[2, 0] == pytest.approx((a + b) / k + a / k, abs=1e-12)
        assert f.RF[0, 0] == pytest.approx(-(a + b), abs=1e-10)


def test_temperature_and_support_amplitudes(tmp_path: Path) -> None:
    """An amplitude of temperature multiplies the temperature itself; a support follows its table.

    Bar held at both ends that starts at 20 degrees: force -EA(alpha (T - 20) - u/L).
    """
    text = (
        BARS.replace("*BOUNDARY\n", "*BOUNDARY\n3, 1, 1\n")
        + """*NSET, NSET=every, ELSET=all
*INITIAL CONDITIONS, TYPE=TEMPERATURE
every, 20.
*STEP
*STATIC, DIRECT
0.25, 1.
*TEMPERATURE, AMPLITUDE=tri
every, 50.
*BOUNDARY, AMPLITUDE=tot
3, 1, 1, 0.1
*END STEP
*STEP
*STATIC, DIRECT
0.25, 1.
*TEMPERATURE
every, 30.
*END STEP
"""
    )
    results = run(tmp_path / "b.inp", text)
    temperatures = [0.0, 25.0, 50.0, 35.0, 20.0, *np.linspace(20.0, 30.0, 5)[1:]]
    moves = np.interp(np.linspace(0, 2, 9), [0, 1, 3], [0, 1, -1]) * 0.1
    frames = [f for f in results.frames if f.increment > 0]
    for f, T, u in zip(frames, temperatures[1:], moves[1:], strict=True):
        force = 100.0 * 0.2 * (u / 4.0 - 1e-3 * (T - 20.0))
        assert f.RF[2, 0] == pytest.approx(force, abs=1e-10)


def test_order_of_conservative_loads_does_not_matter() -> None:
    """Heat, gravity, a held end that turns, dead and closed pressure loads, in three orders.

    Elastic and conservative: the state depends on the final loads only.
    """
    from corota.model.loads import BodyForce, EdgeLoad, NodalForce

    mesh = ct.mesh.rectangle(6.0, 1.0, nx=12, ny=2, cell="quad8")
    end = ct.mesh.add_node(mesh, 6.0, 0.5, "ref")
    loads = [
        Temperature("", 40.0),
        BodyForce("", "gravity", (0.0, -0.05)),
        NodalForce([end], 1, 0.4),
        EdgeLoad("bottom", "traction", (0.02, 0.03)),
    ]
    ends = []
    for order in ([[0, 1, 2, 3]], [[0], [1], [2], [3]], [[3], [2, 1], [0]]):
        model = ct.Model(mesh)
        model.section(
            "all",
            element="Q8",
            material=ct.Elastic(E=200.0, nu=0.3, rho=2.0, expansion=2e-4),
            thickness=0.6,
            plane="strain",
            local_strain="logarithmic",
        )
        model.fix("left")
        model.rigid("right", end)
        steps = [
            ct.Static(loads=[loads[i] for i in one], supports=[Fixed([end], 2, 1.2)], increments=4)
            for one in order
        ]
        ends.append(ct.solve(model, steps, threads=1).frames[-1])
    for f in ends[1:]:
        assert np.abs(f.U - ends[0].U).max() < 1e-7 * np.abs(ends[0].U).max()
        assert np.abs(f.RF - ends[0].RF).max() < 1e-6 * np.abs(ends[0].RF).max()


@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q9", "T6", "OPT", "Q4D", "Q4DI"])
def test_pressure_has_the_resultant_of_its_chord(element: str) -> None:
    """Follower pressure on a curved edge of a bent strip: force p t times the chord turned.

    The normal integrates to the difference of the end points, whatever lies between.
    """
    sides = [
        lambda t: (6 * t, 0.4 * np.sin(3 * t)),
        lambda t: (6 + 0 * t, 0.4 * np.sin(3.0) + t),
        lambda t: (6 * t, 1 + 0.4 * np.sin(3 * t)),
        lambda t: (0 * t, t),
    ]
    mesh = ct.mesh.mapped(sides, nx=10, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=900.0, nu=0.3), thickness=1.7)
    model.fix("left", rotation=True if element in DRILLING else None)
    model.pressure("top", 0.6)
    results = ct.solve(model, ct.Static(increments=10), threads=1)
    frame = results.frames[-1]
    top = mesh.nodes_of("top")
    top = top[np.argsort(mesh.points[top, 0])]
    a, b = (mesh.points + frame.U)[top[[0, -1]]]
    chord = b - a
    want = 0.6 * 1.7 * np.array([chord[1], -chord[0]])
    assert np.allclose(frame.F[:, :2].sum(axis=0), want, rtol=1e-9)
    assert np.allclose(frame.RF[:, :2].sum(axis=0), -want, rtol=1e-7)
    assert abs(frame.U[top[-1], 1]) > 1.0


@pytest.mark.parametrize("element", CELL)
def test_moment_balance_of_weight_pressure_and_spin(element: str) -> None:
    """Reactions of a cantilever far bent: forces and moments of loads about the current points.

    Weight t h L rho g in total; all external forces and moments balance the clamp's, RM included.
    """
    mesh = ct.mesh.rectangle(8.0, 1.0, nx=8, ny=2, cell=CELL[element])
    model = ct.Model(mesh)
    material = ct.Elastic(E=2000.0, nu=0.3, rho=1.5)
    model.section("all", element=element, material=material, thickness=0.4)
    model.fix("left", rotation=True if element in DRILLING else None)
    model.gravity(0.3, -0.9)
    model.pressure("right", 0.7)
    model.centrifugal(0.25, about=(-1.0, 0.0))
    frame = ct.solve(model, ct.Static(increments=8), threads=1).frames[-1]
    x = mesh.points + frame.U

    def moment(force: np.ndarray) -> float:
        return float(np.sum(x[:, 0] * force[:, 1] - x[:, 1] * force[:, 0] + force[:, 2]))

    scale = np.abs(frame.F).max()
    assert np.abs((frame.F + frame.RF)[:, :2].sum(axis=0)).max() < 1e-6 * scale
    assert abs(moment(frame.F + frame.RF)) < 1e-5 * scale
    only = ct.Model(mesh)
    only.section("all", element=element, material=material, thickness=0.4)
    only.fix("left", rotation=True if element in DRILLING else None)
    only.gravity(0.3, -0.9)
    weight = ct.solve(only, ct.Static(increments=8), threads=1).frames[-1]
    assert np.allclose(
        weight.RF[:, :2].sum(axis=0), -8.0 * 0.4 * 1.5 * np.array([0.3, -0.9]), rtol=1e-7
    )


@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q9", "Q4D", "Q4DI", "OPT"])
def test_spinning_bar_under_large_strain(element: str) -> None:
    """Radial bar under centrifugal load, Biot strain, nu = 0: x = sin(k X)/(k cos k L).

    From E u'' + rho w^2 (X + u) = 0 and u'(L) = 0, k^2 = rho w^2/E; the reaction is -E t h u'(0).
    """
    E, rho, w, L, t, h = 50.0, 2.0, 1.1, 2.0, 0.3, 0.2
    mesh = ct.mesh.rectangle(L, h, nx=40, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=0.0, rho=rho), thickness=t)
    model.fix("left", y=None)
    model.fix("bottom", x=None, rotation=True if element in DRILLING else None)
    model.fix("top", x=None, y=None, rotation=True if element in DRILLING else None)
    model.centrifugal(w)
    frame = ct.solve(model, ct.Static(increments=2), threads=1).frames[-1]
    k = math.sqrt(rho * w**2 / E)
    bottom = mesh.nodes_of("bottom")
    X = mesh.points[bottom, 0]
    want = np.sin(k * X) / (k * math.cos(k * L)) - X
    # The frame of a slender triangle turns by a second-order angle under pure stretch.
    tolerance = 3e-3 if element in ("T3", "T6", "OPT") else 5e-4
    assert np.abs(frame.U[bottom, 0] - want).max() < tolerance * want.max()
    force = E * t * h * (1 / math.cos(k * L) - 1)
    left = mesh.nodes_of("left")
    assert frame.RF[left, 0].sum() == pytest.approx(-force, rel=1e-3)


def test_dload_and_dsload_and_python_agree(tmp_path: Path) -> None:
    """One follower pressure by element faces, by a surface, by an edge set, and half and half.

    Clockwise elements in one deck: turned on reading, their faces keep the deck's numbers.
    """
    mesh = ct.mesh.rectangle(5.0, 1.0, nx=5, ny=1, cell="quad8")
    nodes = deck_mesh(mesh, "CPE8")
    body = """*MATERIAL, NAME=m
*ELASTIC
300., 0.3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.8
*SURFACE, NAME=roof
1, {face}
2, {face}
3, {face}
4, {face}
5, {face}
*BOUNDARY
left, 1, 2
*STEP, NLGEOM
*STATIC
0.25, 1., 0.25, 0.25
{load}
*END STEP
"""
    clockwise = []
    for line in nodes.splitlines():
        clockwise.append(line)
    start = clockwise.index("*ELEMENT, TYPE=CPE8, ELSET=all") + 1
    for i in range(start, start + 5):
        e, *n = clockwise[i].split(", ")
        clockwise[i] = ", ".join([e, n[0], n[3], n[2], n[1], n[7], n[6], n[5], n[4]])
    # counter-clockwise: bottom, right, top, left are 1 to 4; clockwise: left, top, right, bottom
    decks = {
        "dload": nodes + body.format(face="S3", load="*DLOAD\nall, P3, 0.4"),
        "dsload": nodes + body.format(face="S3", load="*DSLOAD\nroof, P, 0.4"),
        "both": nodes + body.format(face="S3", load="*DLOAD\nall, P3, 0.3\n*DSLOAD\nroof, P, 0.1"),
        "clockwise": "\n".join(clockwise)
        + "\n"
        + body.format(face="S2", load="*DLOAD\nall, P2, 0.1\n*DSLOAD\nroof, P, 0.3"),
    }
    model = ct.Model(mesh)
    model.section(
        "all",
        element="Q8",
        material=ct.Elastic(E=300.0, nu=0.3),
        thickness=0.8,
        plane="strain",
        local_strain="green_lagrange",
    )
    model.fix("left")
    model.pressure("top", 0.4)
    want = ct.solve(model, ct.Static(increments=4), threads=1).frames[-1]
    for name, text in decks.items():
        got = run(tmp_path / f"{name}.inp", text).frames[-1]
        assert np.allclose(got.U, want.U, atol=1e-8), name
        assert np.allclose(got.RF, want.RF, atol=1e-7), name


def test_linear_step_before_a_nonlinear_one(tmp_path: Path) -> None:
    """An elastic structure ends where one nonlinear step ends, whatever a linear step did before.

    The load of the linear step stays (dead), and the second step adds; hyperelastic equilibrium
    depends on the final loads only.
    """
    mesh = ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1)
    head = (
        deck_mesh(mesh, "Q4I")
        + """*MATERIAL, NAME=m
*ELASTIC
500., 0.3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.5
*BOUNDARY
left, 1, 2
"""
    )
    two = """*STEP
*STATIC
*CLOAD
right, 2, 0.1
*END STEP
*STEP, NLGEOM
*STATIC
*CLOAD
right, 1, -0.2
*END STEP
"""
    one = """*STEP, NLGEOM
*STATIC
0.25, 1.
*CLOAD
right, 2, 0.1
right, 1, -0.2
*END STEP
"""
    a = run(tmp_path / "two.inp", head + two).frames[-1]
    b = run(tmp_path / "one.inp", head + one).frames[-1]
    assert np.allclose(a.U, b.U, atol=1e-8)
    assert np.allclose(a.RF, b.RF, atol=1e-7)


def test_body_forces_are_known_by_direction_over_steps(tmp_path: Path) -> None:
    """Gravity in a second direction adds, in the same one replaces, OP=NEW takes all away.

    Sums of reactions: weight m g with m = rho V of a part 0.4 thick; CENTRIF about a point adds
    m w^2 (centroid - point) in a linear step.
    """
    mesh = ct.mesh.rectangle(3.0, 1.0, nx=3, ny=1, cell="quad8")
    text = (
        deck_mesh(mesh, "CPS8")
        + """*MATERIAL, NAME=m
*ELASTIC
500., 0.3
*DENSITY
2.
*SOLID SECTION, ELSET=all, MATERIAL=m
0.4
*BOUNDARY
left, 1, 2
*STEP
*STATIC
*DLOAD
all, GRAV, 5., 0., -1., 0.
*END STEP
*STEP
*STATIC
*DLOAD
all, GRAV, 3., 1., 0., 0.
*END STEP
*STEP
*STATIC
*DLOAD
all, GRAV, 7., 0., -1., 0.
all, CENTRIF, 4., -1., 0., 0., 0., 0., 1.
*END STEP
*STEP
*STATIC
*DLOAD, OP=NEW
all, GRAV, 1., 0., 2., 0.
*END STEP
"""
    )
    results = run(tmp_path / "g.inp", text)
    m = 2.0 * 3.0 * 0.4
    spin = 4.0 * (np.array([1.5, 0.5]) - np.array([-1.0, 0.0]))
    want = [(0.0, -5.0), (3.0, -5.0), (3.0 + spin[0], -7.0 + spin[1]), None]
    for step, g in enumerate(want, 1):
        frame = [f for f in results.frames if f.step == step][-1]
        total = frame.RF[:, :2].sum(axis=0)
        if g is None:  # a direction is made a unit vector, as in CalculiX
            assert np.allclose(total, [0.0, -m], atol=1e-8)
        else:
            assert np.allclose(total, -m * np.array(g), rtol=1e-8)


def test_support_taken_away_leaves_no_reaction(tmp_path: Path) -> None:
    """*BOUNDARY, OP=NEW without a prop: the cantilever ends as one that was never propped."""
    mesh = ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1)
    head = (
        deck_mesh(mesh, "CPS4I")
        + """*MATERIAL, NAME=m
*ELASTIC
500., 0.3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.5
"""
    )
    load = "*CLOAD\nright, 2, -0.3\n"
    propped = (
        "*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*BOUNDARY\nleft, 1, 2\nright, 2, 2\n"
        + load
        + "*END STEP\n*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*BOUNDARY, OP=NEW\nleft, 1, 2\n*END STEP\n"
    )
    free = "*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*BOUNDARY\nleft, 1, 2\n" + load + "*END STEP\n"
    a = run(tmp_path / "a.inp", head + propped)
    b = run(tmp_path / "b.inp", head + free).frames[-1]
    assert np.allclose(a.frames[-1].U, b.U, atol=1e-8)
    right = mesh.nodes_of("right")
    assert np.abs(a.frames[-1].RF[right]).max() < 1e-8
    one = [f for f in a.frames if f.step == 1][-1]
    assert one.RF[right, 1].sum() == pytest.approx(0.6, rel=1e-9)


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8", "Q9", "T6", "OPT", "Q4D"])
def test_work_of_pressure_in_a_ring(element: str) -> None:
    """Linear inflation: ALLWK = ALLIE = p (area swept) t/2, and Lame's displacement sets the area.

    Half of p 2 pi a u(a) t for a ring of four quadrants held by symmetry.
    """
    a, b, p, E, nu, t = 1.0, 1.6, 3.0, 700.0, 0.3, 0.35
    n = 10 if element in ("Q8", "Q9", "T6") else 40
    mesh = ct.mesh.annulus(a, b, 6, n, angle=90.0, cell=CELL[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=nu), thickness=t)
    turn = True if element in DRILLING else None
    model.fix("start", x=None, rotation=turn)
    model.fix("end", y=None, rotation=turn)
    model.pressure("inner", p)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    C = p * a**2 / (b**2 - a**2)
    u = C / E * ((1 - nu) * a + (1 + nu) * b**2 / a)
    want = p * (math.pi / 2) * a * u * t / 2
    assert frame.scalars["ALLWK"] == pytest.approx(want, rel=6e-3)
    assert frame.scalars["ALLIE"] == pytest.approx(frame.scalars["ALLWK"], rel=1e-9)


@pytest.mark.parametrize("element", CELL)
def test_elastic_cycle_gives_all_work_back(element: str) -> None:
    """Load, turn far, and unload over three steps: work, energy and displacement end at zero."""
    mesh = ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    model.section(
        "all",
        element=element,
        material=ct.Elastic(E=300.0, nu=0.2),
        thickness=0.2,
        plane="strain",
        local_strain="logarithmic",
    )
    model.fix("left", rotation=True if element in DRILLING else None)
    from corota.model.loads import EdgeLoad, NodalForce

    right = mesh.nodes_of("right")
    steps = [
        ct.Static(loads=[NodalForce(right, 1, 0.08)], increments=20),
        ct.Static(loads=[EdgeLoad("top", "pressure", (0.03,))], increments=20),
        ct.Static(new_loads=True, increments=20),
    ]
    results = ct.solve(model, steps, threads=1)
    largest = max(f.scalars["ALLSE"] for f in results.frames)
    last = results.frames[-1]
    assert np.abs(last.U).max() < 1e-8
    assert abs(last.scalars["ALLSE"]) < 1e-12 * largest
    assert abs(last.scalars["ALLWK"]) < 5e-3 * largest


def test_opposite_pressures_on_a_turning_body_cancel() -> None:
    """Equal pressure on all sides of a bent, closed body: no resultant, stress -p of all cells.

    Plane strain; nu = 0.25; the body is turned and bent by its supports' absence: it floats on
    three held dofs. Uniform Cauchy stress -p in the plane under green_lagrange and logarithmic.
    """
    mesh = ct.mesh.mapped(
        [
            lambda t: (4 * t, 0.5 * np.sin(3 * t)),
            lambda t: (4 + 0.3 * t, 0.5 * np.sin(3.0) + t),
            lambda t: (4.3 * t, 1 + (0.5 * np.sin(3.0)) * t),
            lambda t: (0 * t, t),
        ],
        nx=5,
        ny=2,
        cell="quad8",
    )
    for strain in ("logarithmic", "green_lagrange"):
        model = ct.Model(mesh)
        model.section(
            "all",
            element="Q8",
            material=ct.Elastic(E=100.0, nu=0.25),
            plane="strain",
            thickness=0.7,
            local_strain=strain,
        )
        for side in ("left", "right", "top", "bottom"):
            model.pressure(side, 6.0)
        left = mesh.nodes_of("left")
        a, b = left[np.argmin(mesh.points[left, 1])], left[np.argmax(mesh.points[left, 1])]
        model.fix([int(a)])
        model.fix([int(b)], y=None)
        frame = ct.solve(model, ct.Static(increments=3), threads=1).frames[-1]
        S = frame.fields[0].values["S"]
        assert np.allclose(S[..., 0], -6.0, atol=1e-6)
        assert np.allclose(S[..., 1], -6.0, atol=1e-6)
        assert np.abs(S[..., 3]).max() < 1e-6
        assert np.abs(frame.RF).max() < 1e-6


def test_supports_over_steps(tmp_path: Path) -> None:
    """A moved support stays where it is if not named, goes back linearly if named with zero.

    Bars of the chain above: force EA u/L at every increment.
    """
    text = (
        BARS
        + """*STEP
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
3, 1, 1, 0.2
*END STEP
*STEP
*STATIC, DIRECT
0.5, 1.
*CLOAD
2, 1, 1.
*END STEP
*STEP
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
3, 1, 1, 0.
*END STEP
*STEP
*STATIC, DIRECT
0.5, 1.
*BOUNDARY, OP=NEW
1, 1, 2
2, 2, 2
3, 2, 2
*END STEP
"""
    )
    results = run(tmp_path / "s.inp", text)
    frames = [f for f in results.frames if f.increment > 0]
    u = [0.1, 0.2, 0.2, 0.2, 0.1, 0.0]
    p = [0.0, 0.0, 0.5, 1.0, 1.0, 1.0]
    for f, a, load in zip(frames, u, p, strict=False):
        assert f.U[2, 0] == pytest.approx(a, abs=1e-12)
        assert f.U[1, 0] == pytest.approx(a / 2 + load / 20.0, abs=1e-12)
        assert f.RF[2, 0] == pytest.approx(10.0 * (a - f.U[1, 0]), abs=1e-10)
    assert frames[-1].U[2, 0] == pytest.approx(0.1, abs=1e-10)
    assert abs(frames[-1].RF[2, 0]) < 1e-10


def test_shifted_amplitude_on_a_following_pressure(tmp_path: Path) -> None:
    """SHIFTX and SHIFTY of an amplitude of total time on *DLOAD, two steps: F = p(t) t chord."""
    mesh = ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1, cell="quad8")
    text = (
        deck_mesh(mesh, "CPS8")
        + """*MATERIAL, NAME=m
*ELASTIC
900., 0.3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.5
*AMPLITUDE, NAME=a, TIME=TOTAL TIME, SHIFTX=0.5, SHIFTY=0.25
0., 0., 1., 1.
*BOUNDARY
left, 1, 2
*STEP, NLGEOM
*STATIC, DIRECT
0.25, 1.
*DLOAD, AMPLITUDE=a
all, P3, 0.4
*END STEP
*STEP, NLGEOM
*STATIC, DIRECT
0.25, 1.
*END STEP
"""
    )
    results = run(tmp_path / "a.inp", text)
    top = mesh.nodes_of("top")
    top = top[np.argsort(mesh.points[top, 0])]
    for f in results.frames:
        if not f.increment:
            continue
        p = 0.4 * (np.interp(f.time, [0.5, 1.5], [0.0, 1.0]) + 0.25)
        x = mesh.points + f.U
        chord = x[top[-1]] - x[top[0]]
        want = p * 0.5 * np.array([chord[1], -chord[0]])
        assert np.allclose(f.F[:, :2].sum(axis=0), want, rtol=1e-8)
