"""An audit of contact, written from the pages alone: results in memory and files, units, moments,
decks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from tests.support.audits import run
from tests.support.blocks import METHODS, block, reaction, scalar, solve

MU, LOAD, TRAVEL = 0.3, 5.0, 1.7


def drawn(method: str, unit: float = 1.0) -> tuple[ct.Model, int]:
    """A block of 4 x 1 x 1 with E = 1e5, in a unit of length that is `unit` times smaller, drawn
    over a floor with a node."""
    mesh = block(4.0 * unit, 1.0 * unit, 8, 2)
    node = ct.mesh.add_node(mesh, 3.0 * unit, -2.0 * unit, "floor")
    model = ct.Model(mesh)
    material = ct.Elastic(E=1e5 / unit**2, nu=0.3)
    model.section("all", element="Q4I", material=material, thickness=unit)
    model.force("top", y=-LOAD)
    model.fix("top", x=TRAVEL * unit, y=None)
    model.fix("floor", rotation=True)
    line = ct.RigidCurve.line((-90.0 * unit, 0.0), (90.0 * unit, 0.0), reference=node)
    model.contact("bottom", line, friction=MU, method=method, name="floor")
    return model, node


@pytest.mark.parametrize("method", METHODS)
def test_moment_on_the_node_of_a_floor(method: str) -> None:
    """The floor bears (mu P, -P) at x = 2 + d + mu: about its node at (3, -2) the force on the
    floor has the moment (x - 3) (-P) - 2 mu P, and the reaction is against it."""
    model, node = drawn(method)
    results = solve(model)
    place = 2.0 + TRAVEL + MU
    force = results.frames[-1].RF[node]
    assert force[0] == pytest.approx(-MU * LOAD, rel=1e-6)
    assert force[1] == pytest.approx(LOAD, rel=1e-6)
    assert force[2] == pytest.approx((place - 3.0) * LOAD + 2.0 * MU * LOAD, rel=1e-4)


@pytest.mark.parametrize("unit", [1e-3, 1e3, 25.4])
@pytest.mark.parametrize("method", METHODS)
def test_a_drawn_block_in_other_units(method: str, unit: float) -> None:
    """Lengths times u, moduli by u^2: forces are the same, displacements times u,
    pressures by u^2."""
    one, other = (solve(drawn(method, u)[0]) for u in (1.0, unit))
    assert len(one.frames) == len(other.frames)
    a, b = one.frames[-1], other.frames[-1]
    assert b.RF[:, :2] == pytest.approx(a.RF[:, :2], rel=1e-6, abs=1e-6)
    assert b.U / unit == pytest.approx(a.U, rel=1e-8, abs=1e-9)
    assert b.C[:, :2] * unit**2 == pytest.approx(a.C[:, :2], rel=1e-5, abs=1e-6)
    assert b.C[:, 3] / unit == pytest.approx(a.C[:, 3], rel=1e-6, abs=1e-9)
    assert b.scalars["ALLFD"] / unit == pytest.approx(a.scalars["ALLFD"], rel=1e-6)


@pytest.mark.parametrize("ending", ["vtkhdf", "pvd"])
def test_contact_in_memory_and_in_a_file(ending: str, tmp_path: Path) -> None:
    """Pressures add up to P, shears to mu P along the edges against the motion, slips are the
    travel; each file has the same numbers, and so has the table of histories."""
    model, _ = drawn("mortar")
    results = solve(model)
    nodes = results.mesh.nodes_of("bottom")
    weights = np.full(9, 0.5)
    weights[[0, -1]] = 0.25
    pressed, sheared, slid = (results.nodal(n)[nodes] for n in ("CPRESS", "CSHEAR", "CSLIP"))
    order = np.argsort(results.mesh.points[nodes, 0])
    assert weights @ pressed[order] == pytest.approx(LOAD, rel=1e-6)
    # along the bottom with the body on the left: to the right; friction pulls to the left
    assert weights @ sheared[order] == pytest.approx(-MU * LOAD, rel=1e-6)
    assert np.abs(slid) == pytest.approx(np.full(9, TRAVEL), rel=1e-3)
    assert set(results.nodal("CSTATUS")[nodes]) == {2.0}
    path = results.write(tmp_path / f"job.{ending}")
    again = ct.read_results(path)
    for name in ("CPRESS", "CSHEAR", "COPEN", "CSLIP", "CSTATUS"):
        assert again.nodal(name) == pytest.approx(results.nodal(name), rel=1e-6, abs=1e-9), name
    table = results.write(tmp_path / "job.csv")
    rows = [r for r in csv.reader(table.read_text().splitlines()) if r and not r[0].startswith("#")]
    last = dict(zip(rows[0], rows[-1], strict=True))
    for name in ("floor: force x", "floor: force y", "floor: moment"):
        key = next(k for k in last if k.startswith(name))
        assert float(last[key]) == pytest.approx(scalar(results, name), rel=1e-6)


def test_gap_of_a_block_that_is_lifted_and_tilted() -> None:
    """Nodes of a block that is lifted by .2 and turned by 10 degrees are open by their height above
    the floor; the gap of the pair is the smallest; nothing presses and nothing rubs."""
    mesh = block(4.0, 1.0, 8, 2)
    ref = ct.mesh.add_node(mesh, 0.0, 0.0, "ref")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    model.rigid("top", ref)
    model.fix("ref", x=3.0, y=0.2, rotation=math.radians(10.0))
    floor = ct.RigidCurve.line((-9.0, 0.0), (90.0, 0.0))
    model.contact("bottom", floor, friction=0.4, method="node_to_segment", reach=5.0, name="floor")
    results = solve(model)
    nodes = mesh.nodes_of("bottom")
    height = 0.2 + mesh.points[nodes, 0] * math.sin(math.radians(10.0))
    assert results.nodal("COPEN")[nodes] == pytest.approx(height, rel=1e-6)
    assert scalar(results, "floor: gap") == pytest.approx(0.2, rel=1e-6)
    assert scalar(results, "floor: force y") == 0.0
    assert scalar(results, "floor: area") == 0.0


DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 3., 0.
5, 0., 1.
6, 1., 1.
7, 2., 1.
8, 3., 1.
100, 1., -1.
*ELEMENT, TYPE=CPE4I, ELSET=block
1, 1, 2, 6, 5
2, 2, 3, 7, 6
3, 3, 4, 8, 7
*NSET, NSET=top
5, 6, 7, 8
*NSET, NSET=floor_node
100
*SURFACE, NAME=below
block, S1
*SURFACE, NAME=floor, TYPE=SEGMENTS
START, -50., 0.
LINE, 50., 0.
*RIGID BODY, ANALYTICAL SURFACE=floor, REF NODE=100
*MATERIAL, NAME=rubber
*ELASTIC
1e6, 0.3
*SOLID SECTION, ELSET=block, MATERIAL=rubber
2.
*SURFACE INTERACTION, NAME=rough
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD
*FRICTION
0.25
*CONTACT PAIR, INTERACTION=rough, TYPE={kind}
below, floor
*BOUNDARY
100, 1, 2
100, 6, 6
*STEP, NLGEOM
*STATIC
1., 1.
*CLOAD
top, 2, -3.
*BOUNDARY
top, 1, 1, -4.
*NODE PRINT, NSET=floor_node
RF
*CONTACT PRINT, SLAVE=below, MASTER=floor
CF, CFN, CFS
*END STEP
"""


@pytest.mark.parametrize("kind", ["SURFACE TO SURFACE", "NODE TO SURFACE"])
def test_a_deck_prints_the_forces_of_friction(kind: str, tmp_path: Path) -> None:
    """Four nodes with 3 each are drawn to the left: 12 down, mu 12 = 3 to the left on the floor, in
    the tables too."""
    results = run(tmp_path / "job.inp", DECK.format(kind=kind))
    node = int(np.argmin(results.mesh.points[:, 1]))
    assert reaction(results, [node])[:2] == pytest.approx([3.0, 12.0], rel=1e-5)
    numbers = []
    for line in (tmp_path / "job.dat").read_text().splitlines():
        try:
            numbers.append([float(word) for word in line.split()])
        except ValueError:
            continue
    rows = [r for r in numbers if len(r) >= 3]
    assert any(pytest.approx(abs(x), rel=1e-4) == 12.0 for r in rows for x in r)
    assert any(pytest.approx(abs(x), rel=1e-4) == 3.0 for r in rows for x in r)


@pytest.mark.parametrize("mu", [0.1, 0.5])
def test_friction_takes_the_work_of_a_drawn_block(mu: float) -> None:
    """Pressed, then drawn by 6 in one increment: friction takes mu P 6 (nu = 0: no
    shear before)."""
    model = ct.Model(block(4.0, 1.0, 8, 2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0))
    model.contact(
        "bottom", ct.RigidCurve.line((-90.0, 0.0), (90.0, 0.0)), friction=mu, name="floor"
    )
    press, draw = ct.Static(), ct.Static()
    press.force("top", y=-LOAD)
    press.fix("top", x=0.0, y=None)
    draw.fix("top", x=6.0, y=None)
    results = solve(model, press, draw)
    assert scalar(results, "ALLFD") == pytest.approx(mu * LOAD * 6.0, rel=1e-3)
