# SPDX-License-Identifier: BSD-3-Clause
"""Trusses, beams and single nodes in contact: stops, pins, plates, other lines, ropes.

Values are closed forms of beam theory (no shear deformation), with default settings and one
increment. A line has its surfaces at half the height of its section.
"""

import numpy as np
import pytest

import corota as ct
from corota.errors import ModelError
from corota.mesh import Mesh
from corota.mesh.data import Cells

E, WIDTH, HEIGHT, SPAN = 2.1e5, 10.0, 1.0, 100.0
AREA, INERTIA = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12.0
EI = E * INERTIA
#: Tolerances: exact to the residual of a linear step; large rotation of a slender beam in nonlinear
#: ones (slope .01, shortening 1e-4, and the chord of an element in place of its axis).
EXACT, SLENDER = 1e-8, 3e-3


def lines(*chains, closed=False):
    """Mesh of chains of lines, cell sets a, b, c."""
    points, cells, sets, at, row = [], [], {}, 0, 0
    for name, chain in zip("abc", chains, strict=False):
        n = len(chain)
        first = np.arange(n if closed else n - 1)
        cells.append(at + np.column_stack([first, (first + 1) % n]))
        sets[name] = np.arange(row, row + len(first))
        points.append(np.asarray(chain, float))
        at, row = at + n, row + len(first)
    nodes, points = np.concatenate(cells), np.concatenate(points)
    labels = np.arange(1, len(nodes) + 1)
    mesh = Mesh(points, [Cells("line2", nodes, labels)], np.arange(1, len(points) + 1))
    mesh.cell_sets.update(sets)
    return mesh


def straight(start, end, n, y=0.0):
    x = np.linspace(start, end, n + 1)
    return np.column_stack([x, 0 * x + y])


def beam(model, name, **options):
    model.beam(name, material=ct.Elastic(E=E, nu=0.3), area=AREA, inertia=INERTIA, **options)


def cantilever(stop, force=-3.0, n=10, nlgeom=False, backwards=False, **options):
    """Tip force on a cantilever along x, clamped at 0."""
    chain = straight(0.0, SPAN, n)
    mesh = lines(chain[::-1] if backwards else chain)
    model = ct.Model(mesh)
    beam(model, "a")
    root, tip = (n, 0) if backwards else (0, n)
    model.fix([root], rotation=True)
    model.force([tip], y=force)
    model.contact("a", stop, name="c", **options)
    return ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1).frames[-1]


def propped(at, gap, force=3.0):
    """Force on a stop at `at` with a gap, of a cantilever with a force at its end."""
    return (force * at**2 * (3 * SPAN - at) / 6 - gap * EI) / (at**3 / 3)


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("backwards", [False, True])
def test_a_cantilever_comes_to_rest_on_a_stop(nlgeom, backwards):
    """Propped cantilever after closing; the tip stops half a height above the floor."""
    floor = ct.RigidCurve.line((50.0, -0.5 - 0.5 * HEIGHT), (200.0, -0.5 - 0.5 * HEIGHT))
    frame = cantilever(floor, nlgeom=nlgeom, backwards=backwards)
    assert frame.scalars["c: force y"] == pytest.approx(
        propped(SPAN, 0.5), rel=SLENDER if nlgeom else EXACT
    )
    assert frame.C[0 if backwards else 10, 2] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_both_sides_of_a_line_are_surfaces(side):
    y = -side * (0.5 + 0.5 * HEIGHT)
    stop = (
        ct.RigidCurve.line((50.0, y), (200.0, y))
        if side > 0
        else ct.RigidCurve.line((200, y), (50, y))
    )
    frame = cantilever(stop, force=-3.0 * side)
    assert frame.scalars["c: force y"] == pytest.approx(side * propped(SPAN, 0.5), rel=EXACT)


@pytest.mark.parametrize("at", [60.0, 55.0, 57.5, 61.0])
@pytest.mark.parametrize("nlgeom", [False, True])
def test_a_cantilever_rests_on_a_pin(at, nlgeom):
    """At a node and between nodes, where the bulge of the chord stands for the beam's axis."""
    pin = ct.RigidCurve.circle((at, -0.5 * HEIGHT - 0.5 - 2.0), 2.0)
    frame = cantilever(pin, nlgeom=nlgeom)
    assert frame.scalars["c: force y"] == pytest.approx(propped(at, 0.5), rel=SLENDER)


def test_a_sharp_rigid_corner_presses_between_two_nodes():
    corner = ct.RigidCurve.polyline([(45.0, -5.0), (55.0, -1.0), (65.0, -5.0)])
    frame = cantilever(corner)
    assert frame.scalars["c: force y"] == pytest.approx(propped(55.0, 0.5), rel=SLENDER)


def test_the_end_of_a_rigid_line_supports_a_beam_that_hangs_over_it():
    table = ct.RigidCurve.line((-20.0, -0.5 * HEIGHT - 0.2), (43.0, -0.5 * HEIGHT - 0.2))
    frame = cantilever(table)
    assert frame.scalars["c: force y"] == pytest.approx(propped(43.0, 0.2), rel=SLENDER)


def test_a_clearance_replaces_the_gap_of_the_coordinates():
    floor = ct.RigidCurve.line((50.0, -7.0), (200.0, -7.0))
    frame = cantilever(floor, clearance=0.5)
    assert frame.scalars["c: force y"] == pytest.approx(propped(SPAN, 0.5), rel=EXACT)


@pytest.mark.parametrize("law", [ct.PressureLaw("linear", 20.0)])
def test_a_pressure_law_acts_on_the_area_of_a_node(law):
    """Spring 20 * (width * 5) at the tip, whose length is half an element."""
    floor = ct.RigidCurve.line((96.0, -0.5 - 0.5 * HEIGHT), (200.0, -0.5 - 0.5 * HEIGHT))
    spring, k = 20.0 * WIDTH * 5.0, 3 * EI / SPAN**3
    frame = cantilever(floor, law=law)
    assert frame.scalars["c: force y"] == pytest.approx(
        (3.0 / k - 0.5) / (1 / k + 1 / spring), rel=1e-6
    )


def two_cantilevers(length, side, swapped, nlgeom, gap=0.4, force=3.0, n=8):
    mesh = lines(straight(0.0, SPAN, 10, side * (HEIGHT + gap)), straight(0.0, length, n))
    model = ct.Model(mesh)
    beam(model, "a")
    beam(model, "b")
    model.fix([0, 11], rotation=True)
    model.force([10], y=-side * force)
    model.contact(*("ba" if swapped else "ab"), name="c")
    frame = ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1).frames[-1]
    return side * frame.scalars["c: force y"] * (-1.0 if swapped else 1.0)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("length", [100.0, 65.0, 135.0])
def test_one_cantilever_is_caught_by_another(length, side, nlgeom, swapped):
    """Contact at the end of the shorter one, on either side, whichever is the slave."""
    gap, force = 0.4, 3.0
    at = min(length, SPAN)
    down = force * at**2 * (3 * SPAN - at) / 6 / EI
    exact = (down - gap) / (2 * at**3 / 3 / EI)
    found = two_cantilevers(length, side, swapped, nlgeom)
    assert found == pytest.approx(exact, rel=SLENDER)


def influence(at, load, length=100.0):
    """Deflection at one place of a clamped beam by a unit force at another."""
    if at > load:
        at, load = length - at, length - load
    rest = length - load
    return rest**2 * at**2 * (3 * load * length - at * (3 * load + rest)) / (6 * EI * length**3)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("cell", ["Q4I", "Q8"])
def test_a_block_presses_a_clamped_beam_with_its_corners(swapped, cell):
    gap, push = 0.2, 0.5
    kind = "quad8" if cell == "Q8" else "quad4"
    block = ct.mesh.rectangle(2.0, 4.0, 2, 4, cell=kind, origin=(-1.0, 0.5 * HEIGHT + gap))
    mesh = ct.mesh.assembly(beam=lines(straight(-50.0, 50.0, 20)), block=block)
    model = ct.Model(mesh)
    beam(model, "beam.a")
    stiff = ct.Elastic(E=1e9, nu=0.0)
    model.section(np.arange(20, mesh.n_cells), element=cell, material=stiff, thickness=WIDTH)
    model.fix([0, 20], rotation=True)
    model.fix("block.top", x=0.0, y=-push)
    model.contact(
        *(("block.bottom", "beam.a") if swapped else ("beam.a", "block.bottom")), name="c"
    )
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    exact = 2 * (push - gap) / (influence(49.0, 49.0) + influence(49.0, 51.0))
    found = frame.scalars["c: force y"] * (1.0 if swapped else -1.0)
    assert found == pytest.approx(exact, rel=1e-3)


def test_roles_do_not_matter_at_a_deflection_of_a_height():
    """One increment that pushes the block through the beam at first; both roles, one force."""
    found = []
    for swapped in (False, True):
        block = ct.mesh.rectangle(2.0, 4.0, 2, 4, origin=(-1.0, 0.5 * HEIGHT + 0.2))
        mesh = ct.mesh.assembly(beam=lines(straight(-50.0, 50.0, 20)), block=block)
        model = ct.Model(mesh)
        beam(model, "beam.a")
        stiff = ct.Elastic(E=1e9, nu=0.0)
        model.section(np.arange(20, mesh.n_cells), element="Q4I", material=stiff, thickness=WIDTH)
        model.fix([0, 20], rotation=True)
        model.fix("block.top", x=0.0, y=-1.2)
        sides = ["block.bottom", "beam.a"] if swapped else ["beam.a", "block.bottom"]
        model.contact(*sides, name="c")
        frame = ct.solve(model, threads=1).frames[-1]
        found.append(abs(frame.scalars["c: force y"]))
    assert found[0] == pytest.approx(found[1], rel=1e-9)
    assert found[0] > 1.5 * 2 / (influence(49.0, 49.0) + influence(49.0, 51.0))  # membrane force


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("nlgeom", [False, True])
def test_a_ring_of_wire_is_squeezed_between_plates(nlgeom, friction):
    """Ring theory: d = F R^3/EI (pi/4 - 2/pi) + F R/EA pi/4; 48 chords are .4 % too stiff."""
    radius, squeeze, n = 20.0, 0.2, 48
    angle = np.linspace(0.0, 2.0 * np.pi, n + 1)[:-1] - 0.5 * np.pi
    mesh = lines(radius * np.column_stack([np.cos(angle), np.sin(angle)]), closed=True)
    y = radius + 0.5 * HEIGHT
    plate = ct.mesh.add_node(mesh, 0.0, y, "plate")
    model = ct.Model(mesh)
    beam(model, "a")
    model.fix([0], x=0.0, y=None)
    model.fix([n // 2], x=0.0, y=None)
    model.contact("a", ct.RigidCurve.line((-50.0, -y), (50.0, -y)), name="low", friction=friction)
    upper = ct.RigidCurve.line((50.0, y), (-50.0, y), reference=plate)
    model.contact("a", upper, name="high", friction=friction)
    model.fix("plate", x=0.0, y=-squeeze, rotation=True)
    frame = ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1).frames[-1]
    soft = radius**3 / EI * (np.pi / 4 - 2 / np.pi) + radius / E / AREA * np.pi / 4
    for name, sign in (("low", 1.0), ("high", -1.0)):
        assert sign * frame.scalars[f"{name}: force y"] == pytest.approx(squeeze / soft, rel=1.5e-2)


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("increments", [1, 5])
def test_friction_has_a_moment_about_the_axis_of_a_beam(nlgeom, increments):
    """A floor drawn along under a tip: (N - F) L / 3 = mu N h / 4, N = F / (1 - 3 mu h / 4 L)."""
    height, friction, force = 10.0, 0.3, 500.0
    inertia = WIDTH * height**3 / 12.0
    mesh = lines(straight(0.0, SPAN, 10))
    floor = ct.mesh.add_node(mesh, 50.0, -50.0, "floor")
    model = ct.Model(mesh)
    model.beam("a", material=ct.Elastic(E=E), area=WIDTH * height, inertia=inertia)
    model.fix([0], rotation=True)
    model.force([10], y=-force)
    model.fix("floor", x=-2.0, y=0.0, rotation=True)
    under = ct.RigidCurve.line((60.0, -0.5 * height), (300.0, -0.5 * height), reference=floor)
    model.contact("a", under, name="c", friction=friction)
    steps = ct.Static(nlgeom=nlgeom, increments=increments)
    frame = ct.solve(model, steps, threads=1).frames[-1]
    exact = force / (1.0 - 0.75 * friction * height / SPAN)
    assert frame.scalars["c: force y"] == pytest.approx(exact, rel=1e-4)
    assert frame.scalars["c: friction x"] == pytest.approx(-friction * exact, rel=1e-4)


@pytest.mark.parametrize("wrap", [90.0, 180.0])
def test_a_wire_drawn_around_a_bolt_follows_euler_and_eytelwein(wrap):
    """T2 / T1 = exp(mu phi); elements of wrap/90 and a little bending: within .5 %."""
    friction, radius, height, n = 0.3, 10.0, 0.05, 90
    middle = radius + 0.5 * height
    angle = np.radians(np.linspace(90.0 + 0.5 * wrap, 90.0 - 0.5 * wrap, n + 1))
    arc = middle * np.column_stack([np.cos(angle), np.sin(angle)])
    start, end = (np.array([np.sin(a), -np.cos(a)]) for a in angle[[0, -1]])
    tail = np.arange(1, 9)[:, None] * 2 * middle * (angle[0] - angle[1])
    mesh = lines(np.concatenate([arc[0] - start * tail[::-1], arc, arc[-1] + end * tail]))
    last = mesh.n_nodes - 1
    model = ct.Model(mesh)
    wire = {"area": height, "inertia": 1e-2 * height**3 / 12.0, "height": height}
    model.beam("a", material=ct.Elastic(E=E), **wire)
    model.force([0], x=-start[0], y=-start[1])
    model.fix([last], x=0.5 * end[0], y=0.5 * end[1])
    model.contact("a", ct.RigidCurve.circle((0.0, 0.0), radius), name="c", friction=friction)
    frame = ct.solve(model, threads=1).frames[-1]
    pull = (
        float(frame.RF[last] @ end) if frame.RF.shape[1] == 2 else float(frame.RF[last][:2] @ end)
    )
    assert pull == pytest.approx(np.exp(friction * np.radians(wrap)), rel=5e-3)


@pytest.mark.parametrize("height", [0.0, 0.4])
def test_a_node_of_two_trusses_comes_to_rest_on_a_floor(height):
    """Two bars at 45 degrees: 2 N sin(45) = F - R, with sin(45)^2 EA / l each; linear."""
    area, gap, force = 2.0, 0.01, 1500.0
    mesh = lines(np.array([[-10.0, 10.0], [0.0, 0.0], [10.0, 10.0]]))
    model = ct.Model(mesh)
    model.truss("a", material=ct.Elastic(E=E), area=area, height=height)
    model.fix([0, 2])
    model.force([1], y=-force)
    y = -gap - 0.5 * height
    model.contact("a", ct.RigidCurve.line((-5.0, y), (5.0, y)), name="c")
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    stiff = 2 * E * area / np.hypot(10.0, 10.0) * 0.5
    assert frame.scalars["c: force y"] == pytest.approx(force - stiff * gap, rel=EXACT)


@pytest.mark.parametrize("where", ["tip", "index"])
def test_single_nodes_are_slaves_without_thickness(where):
    mesh = lines(straight(0.0, SPAN, 10))
    mesh.node_sets["tip"] = np.array([9, 10])
    model = ct.Model(mesh)
    beam(model, "a")
    model.fix([0], rotation=True)
    model.force([10], y=-3.0)
    floor = ct.RigidCurve.line((50.0, -0.5), (200.0, -0.5))
    model.contact("tip" if where == "tip" else np.array([9, 10]), floor, name="c")
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    assert frame.scalars["c: force y"] == pytest.approx(propped(SPAN, 0.5), rel=EXACT)
    assert frame.C[10, 0] == pytest.approx(propped(SPAN, 0.5), rel=EXACT)  # of the area 1


@pytest.mark.parametrize("name", ["tip", "a"])
def test_nodes_are_tied_to_the_side_of_a_body(name):
    """The tip of a cantilever, tied to a stiff block that moves: 3 EI d / L^3 (a pin)."""
    block = ct.mesh.rectangle(5.0, 4.0, 3, 2, origin=(SPAN - 3.0, -4.0))
    mesh = ct.mesh.assembly(beam=lines(straight(0.0, SPAN, 10)), block=block)
    mesh.node_sets["tip"] = np.array([10])
    model = ct.Model(mesh)
    beam(model, "beam.a")
    stiff = ct.Elastic(E=1e9, nu=0.0)
    model.section(np.arange(10, mesh.n_cells), element="Q4I", material=stiff, thickness=WIDTH)
    model.fix([0], rotation=True)
    model.fix("block.bottom", x=0.0, y=-0.5)
    model.tie("tip" if name == "tip" else "beam.a", "block.top", tolerance=0.1, name="t")
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    down = results.frames[-1].scalars["t: force y"]
    assert down == pytest.approx(-3 * EI * 0.5 / SPAN**3, rel=1e-5)


def test_a_line_drawn_the_wrong_way_under_a_beam_is_refused():
    mesh = lines(np.array([[0.0, 5.0], [0.0, 0.5 * HEIGHT], [10.0, 0.5 * HEIGHT], [10.0, 5.0]]))
    model = ct.Model(mesh)
    beam(model, "a")
    model.fix([0, 3], y=-0.1, rotation=True)
    model.contact("a", ct.RigidCurve.line((20.0, 0.0), (-20.0, 0.0)))
    with pytest.raises(ModelError, match="wrong side"):
        ct.solve(model)


@pytest.mark.parametrize(
    ("slave", "master", "text"),
    [
        ("a", "a", "cannot meet themselves"),
        ("a", "b", "share node 3"),
        ("spring", "b", "no section of a beam or truss"),
    ],
)
def test_what_lines_cannot_do_is_refused_by_name(slave, master, text):
    mesh = lines(straight(0.0, 1.0, 4), straight(0.0, 1.0, 2, 1.0))
    mesh.cell_sets["spring"] = np.array([0])
    if slave != "spring":
        mesh.cell_sets["b"] = np.array([2, 3])
    model = ct.Model(mesh)
    if slave == "spring":
        model.spring("spring", 1.0)
        beam(model, "b")
    else:
        beam(model, "a")
    model.fix([0, 5], rotation=True)
    model.contact(slave, master)
    with pytest.raises(ModelError, match=text):
        ct.solve(model)


DECK = """*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE=B33, ELSET=BEAM
{elements}
*MATERIAL, NAME=M
*ELASTIC
2e9, 0.
*DENSITY
8000.
*BEAM SECTION, ELSET=BEAM, MATERIAL=M, SECTION=RECT
0.05, 0.1
0, 0, 1
{surface}
*SURFACE, NAME=PIN, TYPE=SEGMENTS
START, 1.95, {y}
CIRCL, 2., {top}, 2., {y}
CIRCL, 2.05, {y}, 2., {y}
*RIGID BODY, ANALYTICAL SURFACE=PIN
*SURFACE INTERACTION, NAME=I
*CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE
S, PIN
*BOUNDARY
1, 1, 6
41, 1, 6
*STEP
*STATIC
*DLOAD
BEAM, GRAV, 10., 0., -1., 0.
*END STEP
"""


@pytest.mark.parametrize(
    ("surface", "half"),
    [
        ("*NSET, NSET=MID\n19, 20, 21, 22, 23\n*SURFACE, NAME=S, TYPE=NODE\nMID", 0.0),
        ("*SURFACE, NAME=S\nBEAM, SNEG", 0.05),
        ("*SURFACE, NAME=S\nBEAM", 0.05),
    ],
)
def test_a_deck_lowers_a_beam_onto_a_pin(tmp_path, surface, half):
    """Clamped ends, gap .01: R = (q L^4 / 384 EI - gap) 192 EI / L^3; written and read again."""
    nodes = "\n".join(f"{k + 1}, {0.1 * k}, 0." for k in range(41))
    elements = "\n".join(f"{k}, {k}, {k + 1}" for k in range(1, 41))
    y = -0.01 - half - 0.05
    text = DECK.format(nodes=nodes, elements=elements, surface=surface, y=y, top=y + 0.05)
    path = tmp_path / "a.inp"
    path.write_text(text)
    model = ct.read(path)
    force = ct.solve(model).frames[-1].scalars["S-PIN: force y"]
    stiff = 2e9 * 0.05 * 0.1**3 / 12.0
    exact = (400.0 * 4.0**4 / 384.0 / stiff - 0.01) * 192.0 * stiff / 4.0**3
    assert force == pytest.approx(exact, rel=1e-6)
    if not half:
        model.contacts[0].name = "S-PIN"
    ct.write(model, tmp_path / "b.inp")
    again = ct.solve(ct.read(tmp_path / "b.inp")).frames[-1]
    (found,) = (v for k, v in again.scalars.items() if k.endswith("force y"))
    assert found == pytest.approx(force, rel=1e-9)


@pytest.mark.parametrize("slave", ["a", "tip"])
@pytest.mark.usefixtures("quick_pictures")
def test_lines_and_nodes_are_in_result_files_and_pictures(tmp_path, slave):
    mesh = lines(straight(0.0, SPAN, 10))
    mesh.node_sets["tip"] = np.array([10, 9])
    model = ct.Model(mesh)
    beam(model, "a")
    model.fix([0], rotation=True)
    model.force([10], y=-3.0)
    model.contact(slave, ct.RigidCurve.line((50.0, -1.0), (150.0, -1.0)), name="c")
    results = ct.solve(model, ct.Static(nlgeom=False))
    results.write(tmp_path / "a.vtkhdf")
    back = ct.read_results(tmp_path / "a.vtkhdf")
    np.testing.assert_allclose(back.frames[-1].C, results.frames[-1].C, rtol=1e-12)
    ct.plots.contact_line(back, "c", path=tmp_path / "line.png")
    ct.plots.status(back, path=tmp_path / "status.png")
    assert (tmp_path / "line.png").stat().st_size > 1000
    assert (tmp_path / "status.png").stat().st_size > 1000


def test_a_falling_line_whose_nodes_are_all_slaves_is_named() -> None:
    """The foot alone as the slave: the force of the wave, rho c A v; all nodes: mass over time."""
    young, density, area, speed = 210e3, 7.85e-9, 300.0, 2000.0
    wave = np.sqrt(young * density) * area * speed
    mesh = ct.mesh.line([(0.0, 0.2), (0.0, 480.0)], n=6)
    for slave, named in (("start", False), ("all", True)):
        model = ct.Model(mesh)
        material = ct.Elastic(E=young, rho=density)
        model.beam("all", material=material, area=area, inertia=5e4, height=1e-3)
        model.velocity(y=-speed)
        model.fix("start", x=0.0, y=None)
        model.contact(slave, ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0)), name="floor")
        step = ct.Dynamic(period=2e-4, increments=20, scheme="energy_momentum")
        results = ct.solve(model, step)
        assert any("no other can take their mass" in note for note in results.notes) is named
        if not named:
            assert 0.9 * wave < results.history("floor: force y").max() < 1.6 * wave
