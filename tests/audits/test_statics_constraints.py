"""Rigid parts, couplings and equations in large rotation, against answers found apart."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import corota as ct
from corota.mesh.data import Cells
from support.audits import CELL, DRILLING, deck_mesh, rows_of, run
from support.pairs import cover

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


@pytest.mark.parametrize(
    ("element", "plane"),
    cover(["Q4I", "Q8", "Q9", "Q4DI", "Q4S"], ["stress", "strain"], strength=1),
)
def test_full_circle_by_a_moment_on_a_rigid_end(element: str, plane: str) -> None:
    """A strip rolled up by M = 2 pi E' I/L at a reference node; the clamp reacts -M; work M pi.

    E' is E/(1 - nu^2) in plane strain. Linear moment-curvature law, so strain energy is M 2 pi/2.
    """
    E, nu, t, L, h = 1.2e6, 0.3, 0.8, 10.0, 0.05
    if plane == "stress":
        nu = 0.0
    mesh = ct.mesh.rectangle(L, h, nx=40, ny=1, cell=CELL[element])
    end = ct.mesh.add_node(mesh, L, h / 2, "ref")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=nu), thickness=t, plane=plane)
    middle = mesh.nodes_of("left")
    model.fix("left", y=None, rotation=True if element in DRILLING else None)
    model.fix([int(middle[0])])
    model.rigid("right", end)
    Ep = E / (1 - nu**2)
    M = 2 * math.pi * Ep * t * h**3 / 12 / L
    model.force([end], moment=M)
    frame = ct.solve(model, ct.Static(increments=16), threads=1).frames[-1]
    assert frame.UR[end] == pytest.approx(2 * math.pi, rel=2e-2)
    left = mesh.nodes_of("left")
    x = mesh.points + frame.U
    clamp = np.sum(
        x[left, 0] * frame.RF[left, 1] - x[left, 1] * frame.RF[left, 0] + frame.RF[left, 2]
    )
    assert clamp == pytest.approx(-M, rel=1e-6)
    assert frame.scalars["ALLSE"] + frame.scalars["ALLAE"] == pytest.approx(
        0.5 * M * frame.UR[end], rel=1e-2
    )
    assert frame.scalars["ALLWK"] == pytest.approx(0.5 * M * frame.UR[end], rel=1e-2)


def test_distributing_coupling_spreads_by_weights() -> None:
    """Force and moment on a distributing node, read from springs to the ground at its nodes.

    Equal weights: each node takes P/n and M (-y, x)/sum r^2 about the centroid.
    """
    y = np.array([0.0, 1.0, 2.5, 4.0])
    points = np.vstack([np.column_stack([np.zeros(4), y]), [[3.0, 1.0]]])
    cells = [Cells("line2", np.array([[0, 1], [1, 2], [2, 3]]), np.array([1, 2, 3]))]
    cells.append(Cells("point1", np.arange(4).reshape(-1, 1), np.arange(4, 8)))
    from corota.mesh import Mesh

    mesh = Mesh(points, cells, np.arange(1, 6))
    model = ct.Model(mesh)
    model.truss([0, 1, 2], material=ct.Elastic(E=1e-3), area=1e-6)
    model.spring([3, 4, 5, 6], 50.0, "x")
    model.couple([0, 1, 2, 3], 4, kind="distributing")
    for n in range(4):
        model.fix([n], x=None)
    model.force([4], x=2.0, moment=1.5)
    model.fix([4], x=None, y=None)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    r = y - y.mean()
    # The force acts at the reference node, whose arm about the centroid adds -2 (1 - mean).
    M = 1.5 - 2.0 * (1.0 - y.mean())
    force = 2.0 / 4 - M * r / np.sum(r**2)
    assert np.allclose(50.0 * frame.U[:4, 0], force, rtol=1e-6)


def test_equation_with_right_side_in_turned_axes(tmp_path: Path) -> None:
    """u1' - 2 v1' = 0.3 in axes at 40 degrees on springs: two equations by hand.

    Along the constraint the springs' force is normal to the free direction.
    """
    c, s = math.cos(math.radians(40)), math.sin(math.radians(40))
    text = f"""*NODE
1, 0., 0.
2, 5., 0.
*ELEMENT, TYPE=SPRING1, ELSET=kx
1, 1
*ELEMENT, TYPE=SPRING1, ELSET=ky
2, 1
*SPRING, ELSET=kx
1
10.
*SPRING, ELSET=ky
2
25.
*TRANSFORM, NSET=turned, TYPE=R
{c}, {s}, 0., {-s}, {c}, 0.
*NSET, NSET=turned
1
*EQUATION
3
1, 1, 1., 1, 2, -2., 2, 1, -0.3
*BOUNDARY
2, 1, 1, 1.
*STEP, NLGEOM
*STATIC
*CLOAD
1, 1, 4.
1, 2, -1.
*END STEP
"""
    frame = run(tmp_path / "e.inp", text).frames[-1]
    R = np.array([[c, -s], [s, c]])  # columns are the local axes
    K = R.T @ np.diag([10.0, 25.0]) @ R
    a = np.array([1.0, -2.0])
    A = np.block([[K, a[:, None]], [a[None, :], np.zeros((1, 1))]])
    local = np.linalg.solve(A, [4.0, -1.0, 0.3])[:2]
    assert np.allclose(frame.U[0], R @ local, atol=1e-10)


@pytest.mark.parametrize("kind", ["CPE8", "CPE8R", "T6", "Q9", "Q4I", "Q4D", "OPT"])
def test_sector_of_a_tube_on_inclined_planes(tmp_path: Path, kind: str) -> None:
    """Lame's tube as a sector from 20 to 80 degrees, its sides held by *TRANSFORM, TYPE=C.

    Radial displacement and hoop stress in plane strain with heat: thickness 0.6, pressure inside.
    """
    a, b, p, E, nu, alpha, T = 1.0, 2.0, 5.0, 1000.0, 0.3, 1e-4, 10.0
    cell = {"T6": "tri6", "Q9": "quad9", "Q4I": "quad4", "Q4D": "quad4", "OPT": "tri3"}
    coarse = cell.get(kind, "quad8")
    n = 24 if coarse in ("quad4", "tri3") else 8
    mesh = ct.mesh.annulus(a, b, n, n, angle=60.0, start=20.0, cell=coarse)
    plane = "" if kind.startswith("C") else ", PLANE=STRAIN"
    lines = ["*NODE"]
    lines += [
        f"{m}, {float(x)!r}, {float(y)!r}"
        for m, (x, y) in zip(mesh.node_labels, mesh.points, strict=True)
    ]
    lines.append(f"*ELEMENT, TYPE={kind}, ELSET=all")
    for label, nodes in zip(mesh.cells[0].labels, mesh.cells[0].nodes, strict=True):
        lines.append(f"{label}, " + ", ".join(str(mesh.node_labels[i]) for i in nodes))
    for name in ("start", "end", "inner"):
        lines.append(f"*NSET, NSET={name}")
        lines += [str(mesh.node_labels[i]) for i in mesh.nodes_of(name)]
    lines.append("*SURFACE, NAME=bore")
    for c, e in mesh.edge_sets["inner"]:
        lines.append(f"{mesh.cells[0].labels[c]}, S{e + 1}")
    text = "\n".join(lines) + (
        f"""
*NSET, NSET=every, ELSET=all
*TRANSFORM, NSET=every, TYPE=C
0., 0., 0., 0., 0., 1.
*MATERIAL, NAME=m
*ELASTIC
{E}, {nu}
*EXPANSION
{alpha}
*SOLID SECTION, ELSET=all, MATERIAL=m{plane}
0.6
*BOUNDARY
start, 2, 2
end, 2, 2
"""
        + ("start, 6, 6\nend, 6, 6\n" if kind in DRILLING else "")
        + f"""*STEP
*STATIC
*DSLOAD
bore, P, {p}
*TEMPERATURE
every, {T}
*END STEP
"""
    )
    results = run(tmp_path / "tube.inp", text)
    u = np.hypot(*(mesh.points + results.frames[-1].U).T) - np.hypot(*mesh.points.T)
    r = np.hypot(*mesh.points.T)
    C = p * a**2 / (b**2 - a**2)
    want = (1 + nu) / E * C * ((1 - 2 * nu) * r + b**2 / r) + (1 + nu) * alpha * T * r
    tolerance = 4e-3 if coarse in ("quad4", "tri3") else 2e-4
    assert np.abs(u - want).max() < tolerance * want.max()
    hold = mesh.nodes_of("end")
    force = results.frames[-1].RF[hold, :2].sum(axis=0)
    out = np.array([-math.sin(math.radians(80)), math.cos(math.radians(80))])
    # Hoop stresses of a sector balance the pressure: p a t in all, whatever the material.
    assert force @ out == pytest.approx(p * a * 0.6, rel=1e-9)


def test_coupling_of_x_only_with_a_moment() -> None:
    """Kinematic coupling of x: plane sections stay plane along x, the nodes slide in y.

    A moment on the reference node bends a strip with M/EI; Poisson's contraction stays free.
    """
    E, nu, t, h, L = 1000.0, 0.4, 0.6, 1.0, 8.0
    mesh = ct.mesh.rectangle(L, h, nx=16, ny=2, cell="quad8")
    end = ct.mesh.add_node(mesh, L, h / 2, "ref")
    model = ct.Model(mesh)
    model.section("all", element="Q8", material=ct.Elastic(E=E, nu=nu), thickness=t)
    model.fix("left", y=None)
    left = mesh.nodes_of("left")
    middle = left[np.argmin(np.abs(mesh.points[left, 1] - h / 2))]
    model.fix([int(middle)], x=None)
    model.couple("right", end, dofs="x")
    model.fix([end], x=None)
    model.force([end], moment=0.7)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    EI = E * t * h**3 / 12
    assert frame.UR[end] == pytest.approx(0.7 * L / EI, rel=1e-8)
    right = mesh.nodes_of("right")
    tip = right[np.argmin(np.abs(mesh.points[right, 1] - h / 2))]
    assert frame.U[tip, 1] == pytest.approx(0.7 * L**2 / (2 * EI), rel=1e-8)
    S = frame.fields[0].values["S"]
    y = frame.fields[0].points[..., 1] - frame.fields[0].points[..., 1].mean()
    assert np.abs(S[..., 1]).max() < 1e-8
    assert np.abs(S[..., 3]).max() < 1e-8
    assert np.abs(y).max() > 0


def test_nodes_on_a_straight_line_that_turns(tmp_path: Path) -> None:
    """*MPC, STRAIGHT on the end of a strip bent by a rigid turn of two corners, NLGEOM.

    All nodes of the end lie on the line of its corners; the line's forces sum to nothing.
    """
    mesh = ct.mesh.rectangle(6.0, 1.0, nx=6, ny=4)
    right = mesh.nodes_of("right")
    right = right[np.argsort(mesh.points[right, 1])]
    labels = [int(mesh.node_labels[i]) for i in right]
    order = [labels[0], labels[-1], *labels[1:-1]]
    text = (
        deck_mesh(mesh, "Q4I")
        + f"""*MATERIAL, NAME=m
*ELASTIC
500., 0.3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.5
*MPC
STRAIGHT, {", ".join(map(str, order))}
*BOUNDARY
left, 1, 2
*STEP, NLGEOM
*STATIC
0.1, 1.
*CLOAD
{labels[2]}, 2, 1.5
{labels[-1]}, 1, -0.5
{labels[0]}, 1, 0.5
*END STEP
"""
    )
    results = run(tmp_path / "m.inp", text)
    frame = results.frames[-1]
    x = mesh.points + frame.U
    e = x[right[-1]] - x[right[0]]
    e /= np.linalg.norm(e)
    for i in right:
        d = x[i] - x[right[0]]
        assert abs(e[0] * d[1] - e[1] * d[0]) < 1e-9
    assert abs(math.atan2(e[1], e[0]) - math.pi / 2) > 0.3
    left = mesh.nodes_of("left")
    assert np.allclose(frame.RF[left, :2].sum(axis=0), [0.0, -1.5], atol=1e-8)
    moment = np.sum(x[left, 0] * frame.RF[left, 1] - x[left, 1] * frame.RF[left, 0])
    load = x[labels[2] - 1, 0] * 1.5 + x[right[-1], 1] * 0.5 - x[right[0], 1] * 0.5
    assert moment == pytest.approx(-load, rel=1e-7)


def test_support_on_a_distributing_node_says_what_to_hold() -> None:
    """The message names the coupled nodes, not the reference node that is held already."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    end = ct.mesh.add_node(mesh, 2.0, 0.5, "ref")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.3))
    model.couple("right", end, kind="distributing")
    model.fix("left")
    model.fix([end])
    with pytest.raises(ct.CorotaError, match="support the nodes that it follows") as caught:
        ct.solve(model, ct.Static(), threads=1)
    assert "support the reference node" not in str(caught.value)


@pytest.mark.parametrize("kind", ["pressure", "traction", "gravity"])
@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q4D", "T6", "OPT"])
def test_rigid_door_on_a_torsion_spring(element: str, kind: str) -> None:
    """A rigid plate hinged at a reference node: k a = p t L^2/2 for pressure at any turn,
    q t L^2/2 cos(a) for dead traction, m g L/2 cos(a) - m g h/2 sin(a) for weight.
    """
    L, h, t, k = 2.0, 0.5, 0.7, 3.0
    mesh = ct.mesh.rectangle(L, h, nx=4, ny=1, cell=CELL[element])
    hinge = ct.mesh.add_node(mesh, 0.0, 0.0, "hinge")
    mesh.cells.append(Cells("point1", np.array([[hinge]]), np.array([999])))
    n = mesh.n_cells - 1
    model = ct.Model(mesh)
    model.section(
        list(range(n)), element=element, material=ct.Elastic(E=1e3, nu=0.3, rho=1.5), thickness=t
    )
    model.spring([n], k, "rotation")
    model.rigid(np.arange(hinge), hinge)
    model.fix([hinge])
    if kind == "pressure":
        model.pressure("bottom", 4.0)
    elif kind == "traction":
        model.traction("bottom", y=4.0)
    else:
        model.gravity(y=5.0, cells=list(range(n)))
    frame = ct.solve(model, ct.Static(increments=5), threads=1).frames[-1]
    a = frame.UR[hinge]
    moment = {
        "pressure": 4.0 * t * L**2 / 2,
        "traction": 4.0 * t * L**2 / 2 * math.cos(a),
        "gravity": 1.5 * t * L * h * 5.0 * (L / 2 * math.cos(a) - h / 2 * math.sin(a)),
    }[kind]
    assert k * a == pytest.approx(moment, rel=1e-7)
    assert abs(a) > 0.5
    force = {
        "pressure": 4.0 * t * L * np.array([-math.sin(a), math.cos(a)]),
        "traction": np.array([0.0, 4.0 * t * L]),
        "gravity": np.array([0.0, 1.5 * t * L * h * 5.0]),
    }[kind]
    assert np.allclose(frame.RF[hinge, :2], -force, atol=1e-6 * 10)


def test_roller_far_along_an_incline(tmp_path: Path) -> None:
    """A bar whose end rides on a line at 30 degrees under a dead force along it, NLGEOM.

    Axes of *TRANSFORM stay in space: one unknown, energy k e^2/2 - P s made stationary.
    """
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    text = f"""*NODE
1, 0., 1.
2, 0., 0.
*ELEMENT, TYPE=T2D2, ELSET=all
1, 1, 2
*MATERIAL, NAME=m
*ELASTIC
100., 0.
*SOLID SECTION, ELSET=all, MATERIAL=m
0.2
*TRANSFORM, NSET=r, TYPE=R
{c}, {s}, 0., {-s}, {c}, 0.
*NSET, NSET=r
2
*BOUNDARY
1, 1, 2
2, 2, 2
*STEP, NLGEOM
*STATIC
0.1, 1.
*CLOAD
2, 1, 9.
*NODE PRINT, NSET=r
U, RF
*END STEP
"""
    frame = run(tmp_path / "r.inp", text).frames[-1]

    def slope(x: float) -> float:
        p = np.array([c * x, s * x - 1.0])
        long = float(np.hypot(*p))
        return 20.0 * (long - 1.0) * float(p @ [c, s]) / long - 9.0

    x = brentq(slope, 0.6, 5.0)
    assert frame.U[1] @ [c, s] == pytest.approx(x, rel=1e-8)
    assert abs(frame.U[1] @ [-s, c]) < 1e-10
    p = np.array([c * x, s * x - 1.0])
    long = float(np.hypot(*p))
    across = 20.0 * (long - 1.0) * float(p @ [-s, c]) / long
    assert frame.RF[1][:2] @ [-s, c] == pytest.approx(across, rel=1e-7)
    row = [float(w) for w in rows_of(tmp_path / "r.dat", "forces")[-1][0].split()[1:3]]
    assert row[0] == pytest.approx(9.0, rel=1e-6)
    assert row[1] == pytest.approx(across, rel=1e-6)


def test_weights_of_a_distributing_coupling_in_large_rotation() -> None:
    """Force and moment on a distributing node far turned: balance about the clamp, ALLWK.

    Moments of the reference node's load about the current position of the weighted mean.
    """
    mesh = ct.mesh.rectangle(8.0, 1.0, nx=8, ny=2, cell="quad8")
    end = ct.mesh.add_node(mesh, 9.0, 0.3, "ref")
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=ct.Elastic(E=800.0, nu=0.3), thickness=0.4)
    model.fix("left")
    right = mesh.nodes_of("right")
    model.couple(right, end, kind="distributing", weights=np.arange(1.0, len(right) + 1))
    model.force([end], x=-0.2, y=0.35, moment=0.9)
    frames = ct.solve(model, ct.Static(increments=40), threads=1).frames
    frame = frames[-1]
    x = mesh.points + frame.U
    left = mesh.nodes_of("left")
    assert np.allclose(frame.RF[left, :2].sum(axis=0), [0.2, -0.35], atol=1e-7)
    clamp = np.sum(x[left, 0] * frame.RF[left, 1] - x[left, 1] * frame.RF[left, 0])
    load = x[end, 0] * 0.35 + x[end, 1] * 0.2 + 0.9
    assert clamp == pytest.approx(-load, rel=1e-6)
    assert frame.UR[end] > 0.5
    work = 0.0
    for f, g in zip(frames[:-1], frames[1:], strict=True):
        mean = (f.F[end] + g.F[end]) / 2
        step = np.append(g.U[end] - f.U[end], g.UR[end] - f.UR[end])
        work += float(mean @ step)
    assert frame.scalars["ALLWK"] == pytest.approx(work, rel=1e-8)
    assert frame.scalars["ALLIE"] == pytest.approx(work, rel=2e-3)


@pytest.mark.parametrize("rhs", [0.0, 0.3])
def test_account_of_an_equation(rhs: float) -> None:
    """Two springs joined by u1 - 2 u2 = rhs with a load: displacements and the energy of both.

    Minimum of k1 u1^2/2 + k2 u2^2/2 - P u2 on the constraint.
    """
    from corota.mesh import Mesh

    cells = [Cells("point1", np.array([[0], [1]]), np.array([1, 2]))]
    mesh = Mesh(np.array([[0.0, 0.0], [3.0, 0.0]]), cells, np.array([1, 2]))
    model = ct.Model(mesh)
    model.spring([0], 10.0, "x")
    model.spring([1], 4.0, "x")
    model.equation((0, "x", 1.0), (1, "x", -2.0), rhs=rhs)
    model.fix([0, 1], x=None)
    model.force([1], x=3.0)
    frame = ct.solve(model, ct.Static(increments=4), threads=1).frames[-1]
    u2 = (3.0 - 20.0 * rhs) / 44.0
    u1 = 2 * u2 + rhs
    assert frame.U[:, 0] == pytest.approx([u1, u2], rel=1e-9)
    assert frame.scalars["ALLSE"] == pytest.approx(5 * u1**2 + 2 * u2**2, rel=1e-9)
    assert frame.constraint_force is not None
    assert frame.constraint_force[:, 0] == pytest.approx([10 * u1, 4 * u2 - 3.0], rel=1e-9)
    assert frame.constraint_force[1, 0] == pytest.approx(-2 * frame.constraint_force[0, 0])
    if rhs == 0.0:
        assert frame.scalars["ALLWK"] == pytest.approx(5 * u1**2 + 2 * u2**2, rel=1e-9)
