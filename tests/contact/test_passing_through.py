# SPDX-License-Identifier: BSD-3-Clause
"""A plate does not pass through a body in one increment, however thin the body is.

The core takes a penetration deeper than the body for none, and its search distance is four edges. A
strip that was thinner than the plate moved in one increment used to be passed through with force 0
and without a message. The force on the strip is that of small increments, and that of a cantilever.
"""

import numpy as np
import pytest

import corota as ct
from corota._core import times_of_crossing
from support.pairs import cover

LENGTH, HIGH, E, DEEP = 4.0, 0.05, 1000.0, 0.2
#: Left end of the plate, beside a node of the strip.
START = 3.5


def press(gap: float, increments: int, method: str, way: str, element: str = "Q4I") -> ct.Results:
    """A plate pressed onto the end of a cantilever, which is the slave or the master."""
    cell = {"Q4I": "quad4", "Q8R": "quad8", "Q4D": "quad4"}[element]
    strip = ct.mesh.rectangle(LENGTH, HIGH, 8, 1, cell)  # type: ignore[arg-type]
    if way == "rigid":
        mesh, slave = strip, "top"
        plate = ct.mesh.add_node(mesh, 2.0, 0.5, "plate")
        y = HIGH + gap
        master = ct.RigidCurve.line((5.0, y), (START, y), plate)
    else:
        block = ct.mesh.rectangle(1.5, 0.5, 3, 1, cell, origin=(START, HIGH + gap))  # type: ignore[arg-type]
        mesh = ct.mesh.assembly(strip=strip, block=block)
        slave, master = "strip.top", "block.bottom"
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=0.0))
    model.fix("left" if way == "rigid" else "strip.left")
    model.contact(slave, master, method=method, name="c")  # type: ignore[arg-type]
    if way == "rigid":
        model.fix("plate", x=0.0, y=-DEEP, rotation=True)
    else:
        model.fix("block.top", x=0.0, y=-DEEP)
    return ct.solve(model, ct.Static(increments=increments), threads=1)


@pytest.mark.parametrize(
    ("increments", "gap", "method", "way"),
    cover([1, 2], [0.0, 0.01, 0.08], ["mortar", "node_to_segment"], ["rigid", "deformable"]),
)
def test_a_plate_presses_a_thin_strip_in_any_increments(
    increments: int, gap: float, method: str, way: str
) -> None:
    force = press(gap, increments, method, way).history("c: force y").values[-1]
    assert force == pytest.approx(press(gap, 25, method, way).history("c: force y").values[-1])
    # The force acts at the left end of the plate; that of mortar contact over half an edge.
    cantilever = 3.0 * E * HIGH**3 / 12.0 * (DEEP - gap)
    last = START if method == "node_to_segment" else START + 0.25
    assert 0.97 * cantilever / last**3 < -force < 1.03 * cantilever / START**3


@pytest.mark.parametrize(
    ("gap", "method", "before", "second"),
    cover(
        [0.0, 0.01],
        ["mortar", "node_to_segment"],
        [None, {"increments": 1}, {}],
        [{"increments": 1}, {}, {"smallest_increment": 0.9}],
    ),
)
def test_a_plate_that_touches_or_rests_presses_in_any_step(
    gap: float, method: str, before: dict[str, float] | None, second: dict[str, float]
) -> None:
    strip = ct.mesh.rectangle(LENGTH, HIGH, 8, 1)
    plate = ct.mesh.add_node(strip, 2.0, 0.5, "plate")
    master = ct.RigidCurve.line((5.0, HIGH + gap), (START, HIGH + gap), plate)
    model = ct.Model(strip)
    model.section("all", element="Q4I", material=ct.Elastic(E=E, nu=0.0))
    model.fix("left")
    model.contact("top", master, method=method, name="c")  # type: ignore[arg-type]
    model.fix("plate", x=0.0, y=0.0, rotation=True)
    step = ct.Static(**second)  # type: ignore[arg-type]
    step.fix("plate", y=-DEEP)
    rest = [] if before is None else [ct.Static(**before)]  # type: ignore[arg-type]
    force = ct.solve(model, [*rest, step], threads=1).history("c: force y").values[-1]
    assert force == pytest.approx(press(gap, 25, method, "rigid").history("c: force y").values[-1])
    assert force < 0.0


@pytest.mark.parametrize("element", ["Q8R", "Q4D"])
def test_elements_with_midside_nodes_and_rotations_are_pressed_too(element: str) -> None:
    forces = [
        press(0.01, increments, "mortar", "rigid", element).history("c: force y").values[-1]
        for increments in (1, 25)
    ]
    assert forces[0] == pytest.approx(forces[1])
    assert forces[0] < 0.0


@pytest.mark.parametrize("scheme", ["hht", "newmark", "generalized_alpha", "energy_momentum"])
@pytest.mark.parametrize("increments", [1, 3, 10])
def test_a_strip_that_falls_in_fixed_increments_does_not_come_out_below(
    scheme: str, increments: int
) -> None:
    mesh = ct.mesh.rectangle(LENGTH, HIGH, 8, 1, origin=(0.0, 0.06))
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=E, nu=0.3, rho=1.0))
    model.contact("bottom", ct.RigidCurve.line((-3.0, 0.0), (7.0, 0.0)), name="c")
    model.velocity(y=-0.5)
    step = ct.Dynamic(scheme=scheme, increments=increments, period=0.5)  # type: ignore[arg-type]
    if scheme == "energy_momentum" and increments < 10:
        # Its gaps close after the increment of the impact: here, it does not see the floor.
        with pytest.raises(ct.ConvergenceError, match="passed through"):
            ct.solve(model, step, threads=1)
        return
    results = ct.solve(model, step, threads=1)
    assert np.abs(results.history("c: force y").values).max() > 0.0
    lowest = (mesh.points[:, 1] + results.frames[-1].U[:, 1]).min()
    assert lowest > -1e-6 or scheme == "energy_momentum"
    assert lowest > -HIGH


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_a_block_that_leaves_a_thin_plate_in_large_increments_is_not_refused(scheme: str) -> None:
    plate = ct.mesh.rectangle(LENGTH, HIGH, 8, 1)
    block = ct.mesh.rectangle(1.0, 0.5, 2, 1, origin=(1.5, HIGH + 0.01))
    mesh = ct.mesh.assembly(plate=plate, block=block)
    mesh.edge_sets["around"] = np.concatenate(
        [mesh.edge_sets[f"plate.{side}"] for side in ("bottom", "right", "top", "left")]
    )
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=E, nu=0.3, rho=1.0))
    model.fix("plate.left")
    model.contact("block.bottom", "around", name="c")
    model.velocity("block", y=1.0)
    results = ct.solve(model, ct.Dynamic(scheme=scheme, increments=5, period=15.0), threads=1)  # type: ignore[arg-type]
    last = results.frames[-1].U[mesh.node_sets["block"], 1]
    assert last == pytest.approx(np.full(len(last), 15.0), rel=1e-6)


@pytest.mark.parametrize("seed", range(20))
def test_the_crossings_found_are_those_of_every_node_with_every_piece(seed: int) -> None:
    """Random motions; the pieces do not turn, so that the time is exact."""
    rng = np.random.default_rng(seed)
    count, drift = 60, 10.0 ** rng.uniform(-1, 1)
    start = rng.uniform(size=(40, 2))
    first = np.stack([start, start + 0.1 * rng.standard_normal(start.shape)], axis=1)
    move = drift * rng.standard_normal(2)
    last = first + move + 0.01 * rng.standard_normal((40, 1, 2))  # without rotation: exact
    old, new = np.zeros((count, 3)), np.zeros((count, 3))
    old[:, :2] = rng.uniform(size=(count, 2))
    new[:, :2] = old[:, :2] + move + 0.2 * rng.standard_normal((count, 2))
    ends = np.full((40, 2), -1)
    found = times_of_crossing(first, last, ends, old, new, np.arange(count), np.zeros(count))
    for k in range(count):
        least = np.inf
        for p in range(40):
            a, b = first[p]
            edge = b - a
            x = old[k, :2] - a
            way = new[k, :2] - old[k, :2] - (last[p, 0] - a)
            normal = np.array([edge[1], -edge[0]])  # the outer side is on the right
            if x @ normal <= 0.0 or (x + way) @ normal >= 0.0:
                continue
            share = (x @ normal) / -(way @ normal)
            if 0.0 <= (x + share * way) @ edge <= edge @ edge:
                least = min(least, share)
        assert found[k] == pytest.approx(least), k
    assert np.isfinite(found).any()
    none = np.zeros(0, np.int64)
    assert not len(times_of_crossing(first, last, ends, old, new, none, np.zeros(0)))


@pytest.mark.parametrize("above", [0.0, 1e-12, -1e-12])
def test_a_node_that_touches_leaves_around_a_corner(above: float) -> None:
    """A rest of Newton's method at the start is no way through; a real one is."""
    piece = np.array([[[1.0, 0.0], [0.0, 0.0]]])  # the outer side is above
    none, start = np.full((1, 2), -1), np.array([-1e-9])
    old, new = np.array([[0.99, above, 0.0]]), np.array([[1.01, -0.1, 0.0]])
    left = times_of_crossing(piece, piece, none, old, new, np.array([0]), start, 1e-9)
    assert np.isinf(left).all()
    new[0, 0] = 0.9
    through = times_of_crossing(piece, piece, none, old, new, np.array([0]), start, 1e-9)
    assert through[0] == 0.0
    new[0, 1] = -1e-12
    rests = times_of_crossing(piece, piece, none, old, new, np.array([0]), start, 1e-9)
    assert np.isinf(rests).all()


@pytest.mark.parametrize("turn", [-0.3, 0.02, 0.15, 0.5])
@pytest.mark.parametrize("above", [1e-6, 1e-4, 1e-2])
def test_nodes_at_rest_on_a_polygon_that_turns_are_not_passed(turn: float, above: float) -> None:
    """A pad on a disc that spins stopped with a node passed through, which ended outside.

    The distance of a node from a piece that turns is quadratic in time, if its ends move evenly.
    """
    angles = -np.linspace(0.0, 2.0 * np.pi, 41)  # the disc on the left, outside on the right
    corners = [np.column_stack([np.cos(a), np.sin(a)])[::-1] for a in (angles, angles + turn)]
    first, last = (np.stack([x[:-1], x[1:]], axis=1) for x in corners)
    ends, count = np.full((40, 2), -1), 60
    around = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    old = np.column_stack([np.cos(around), np.sin(around), np.zeros(count)]) * (1.0 + above)
    nodes, start = np.arange(count), np.full(count, -1e-9)
    rests = times_of_crossing(first, last, ends, old, old, nodes, start, 1e-9)
    assert np.isinf(rests).all()
    through = times_of_crossing(first, last, ends, old, 0.5 * old, nodes, start, 1e-9)
    depth = 1.0 + above - np.cos(0.5 * turn) * np.cos(np.pi / 40)
    assert np.isfinite(through).all()
    assert through.max() <= 2.0 * depth / (1.0 + above) + 1e-12
