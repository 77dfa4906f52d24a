"""Loads, constraints and large rotation: resultants, boundary value problems, minima of energy.

Every check names its claim; its docstring says where the reference comes from.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.optimize import minimize

import corota as ct
from corota.mesh.data import Cells
from corota.model.loads import Fixed, NodalForce
from support.audits import CELL, DRILLING, rotation, run
from support.pairs import cover

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


# --- One element, every edge, a state far from the reference ---


def moved(element: str, edge: str) -> tuple[Any, Any, np.ndarray, np.ndarray]:
    """One distorted element with all nodes held in a state far away, and its displacements."""
    corners = np.array([[0.0, 0.0], [2.0, 0.2], [1.8, 1.5], [-0.2, 1.1]])
    mesh = ct.mesh.rectangle(1.0, 1.0, 1, 1, CELL[element])
    s, t = mesh.points.T
    mesh.points = (
        np.outer((1 - s) * (1 - t), corners[0])
        + np.outer(s * (1 - t), corners[1])
        + np.outer(s * t, corners[2])
        + np.outer((1 - s) * t, corners[3])
    )
    rng = np.random.default_rng(7)
    turn = rotation(2.3)
    u = mesh.points @ (turn - np.eye(2)).T + rng.uniform(-0.05, 0.05, mesh.points.shape)
    spin = 2.3 + rng.uniform(-0.06, 0.06, mesh.n_nodes)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=300.0, nu=0.3), thickness=0.4)
    for n in range(mesh.n_nodes):
        model.fix([n], x=float(u[n, 0]), y=float(u[n, 1]))
        if element in DRILLING:
            model.fix([n], x=None, y=None, rotation=float(spin[n]))
    return mesh, model, u, spin


def along(mesh: Any, edge: str) -> np.ndarray:
    """Nodes of a straight edge in its order."""
    nodes = mesh.nodes_of(edge)
    axis = mesh.points[nodes] - mesh.points[nodes[0]]
    return nodes[np.argsort(axis @ (axis[np.argmax(np.abs(axis).sum(axis=1))]))]


@pytest.mark.parametrize(
    ("element", "edge"), cover(CELL, ["bottom", "right", "top", "left"], strength=1)
)
def test_pressure_on_every_edge_of_every_element(element: str, edge: str) -> None:
    """Force p t S(chord) and moment -p t (|b|^2 - |a|^2)/2 about the origin, for any curve.

    From a to b with the body on the left the normal into it is S dx; the moment of S dx is x.dx.
    Reactions are those of the state less those of the state without the pressure.
    """
    p, t = 3.0, 0.4
    frames = []
    for q in (0.0, p):
        mesh, model, u, _ = moved(element, edge)
        if q:
            model.pressure(edge, q)
        frames.append(ct.solve(model, ct.Static(increments=12), threads=1).frames[-1])
    x = mesh.points + u
    line = along(mesh, edge)
    a, b = x[line[0]], x[line[-1]]
    middle = x.mean(axis=0)
    side = b - a
    if side[0] * (middle - a)[1] - side[1] * (middle - a)[0] < 0:
        a, b = b, a
    force = p * t * np.array([-(b - a)[1], (b - a)[0]])
    moment = p * t * (b @ b - a @ a) / 2
    F = frames[1].F
    assert np.allclose(F[:, :2].sum(axis=0), force, rtol=1e-9)
    total = np.sum(x[:, 0] * F[:, 1] - x[:, 1] * F[:, 0] + F[:, 2])
    assert total == pytest.approx(moment, rel=1e-9)
    R = frames[1].RF - frames[0].RF
    assert np.allclose(R[:, :2].sum(axis=0), -force, rtol=1e-7)
    total = np.sum(x[:, 0] * R[:, 1] - x[:, 1] * R[:, 0] + R[:, 2])
    assert total == pytest.approx(-moment, rel=1e-7)


@pytest.mark.parametrize(
    ("element", "edge"), cover(CELL, ["bottom", "right", "top", "left"], strength=1)
)
def test_dead_traction_on_every_edge_of_every_element(element: str, edge: str) -> None:
    """Force q t L0, and its moment about the origin from the places where it acts.

    The mean place of an edge over its reference length is that of its ends, plus 2/3 of the
    offset of a middle node; of drilling edges plus the bulge a l0/12 (turn of one end less that
    of the other) along the current normal, a = 3/2 (OPT) or 1 (Q4D), theory, section 6.
    """
    q, t = np.array([2.0, -0.7]), 0.4
    mesh, model, u, spin = moved(element, edge)
    model.traction(edge, x=q[0], y=q[1])
    frame = ct.solve(model, ct.Static(increments=12), threads=1).frames[-1]
    x = mesh.points + u
    line = along(mesh, edge)
    X = mesh.points[line]
    l0 = np.linalg.norm(X[-1] - X[0])
    place = (x[line[0]] + x[line[-1]]) / 2
    if len(line) == 3:
        place = (x[line[0]] + 4 * x[line[1]] + x[line[2]]) / 6
    if element in DRILLING:
        chord = x[line[-1]] - x[line[0]]
        normal = np.array([-chord[1], chord[0]]) / np.linalg.norm(chord)
        share = 1.5 if element == "OPT" else 1.0
        bulge = share * l0 / 8 * (spin[line[0]] - spin[line[-1]])
        place = place + 2 / 3 * bulge * normal
    force = q * t * l0
    F = frame.F
    assert np.allclose(F[:, :2].sum(axis=0), force, rtol=1e-9)
    total = np.sum(x[:, 0] * F[:, 1] - x[:, 1] * F[:, 0] + F[:, 2])
    assert total == pytest.approx(place[0] * force[1] - place[1] * force[0], rel=1e-8)


# --- Amplitudes ---


def quintic(x: float) -> float:
    return x**3 * (10 - 15 * x + 6 * x**2)


AMPLITUDES: dict[str, tuple[str, Any]] = {
    "tabular": (
        "*AMPLITUDE, NAME=a\n0., 0.2, 0.3, 1.\n0.7, -0.5, 0.9, 0.4\n",
        lambda t: np.interp(t, [0, 0.3, 0.7, 0.9], [0.2, 1.0, -0.5, 0.4]),
    ),
    "shift": (
        "*AMPLITUDE, NAME=a, SHIFTX=0.25, SHIFTY=0.1\n0., 0., 0.5, 1.\n",
        lambda t: np.interp(t - 0.25, [0, 0.5], [0.0, 1.0]) + 0.1,
    ),
    "equal": (
        "*AMPLITUDE, NAME=a, DEFINITION=EQUALLY SPACED, FIXED INTERVAL=0.25, BEGIN=0.125\n"
        "0., 1., -1., 0.5\n",
        lambda t: np.interp(t - 0.125, [0, 0.25, 0.5, 0.75], [0, 1.0, -1.0, 0.5]),
    ),
    "smooth": (
        "*AMPLITUDE, NAME=a, DEFINITION=SMOOTH STEP\n0.1, 0., 0.5, 1., 0.9, -0.3\n",
        lambda t: (
            0.0
            if t < 0.1
            else quintic((t - 0.1) / 0.4)
            if t < 0.5
            else 1.0 - 1.3 * quintic((t - 0.5) / 0.4)
            if t < 0.9
            else -0.3
        ),
    ),
    "periodic": (
        "*AMPLITUDE, NAME=a, DEFINITION=PERIODIC\n2, 6., 0.2, 0.3\n0.5, -0.2, 0.1, 0.4\n",
        lambda t: (
            0.3
            if t < 0.2
            else 0.3
            + 0.5 * math.cos(6 * (t - 0.2))
            - 0.2 * math.sin(6 * (t - 0.2))
            + 0.1 * math.cos(12 * (t - 0.2))
            + 0.4 * math.sin(12 * (t - 0.2))
        ),
    ),
    "decay": (
        "*AMPLITUDE, NAME=a, DEFINITION=DECAY\n0.2, 0.8, 0.3, 0.4\n",
        lambda t: 0.2 if t < 0.3 else 0.2 + 0.8 * math.exp(-(t - 0.3) / 0.4),
    ),
}


@pytest.mark.parametrize(
    ("name", "what"),
    cover(AMPLITUDES, ["cload", "dload", "grav", "boundary", "temperature"], strength=1),
)
def test_kinds_of_amplitude_on_kinds_of_load(tmp_path: Path, name: str, what: str) -> None:
    """Each definition of *AMPLITUDE, formulas of the Abaqus manual, drives each kind of load.

    A bar of one element, nu = 0, linear: end displacement by hand at twenty times, in the first
    step and, with step time, again in the second. PERIODIC is kept as a fine table (2e-6).
    """
    card, formula = AMPLITUDES[name]
    load = {
        "cload": "*CLOAD, AMPLITUDE=a\n2, 1, 1.5\n3, 1, 1.5\n",
        "dload": "*DLOAD, AMPLITUDE=a\n1, P2, -3.\n",
        "grav": "*DLOAD, AMPLITUDE=a\n1, GRAV, 3., 1., 0., 0.\n",
        "boundary": "*BOUNDARY, AMPLITUDE=a\nright, 1, 1, 0.06\n",
        "temperature": "*TEMPERATURE, AMPLITUDE=a\nnall, 30.\n",
    }[what]
    unit = 0.06
    text = f"""*NODE, NSET=nall
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*NSET, NSET=right
2, 3
*ELEMENT, TYPE=CPS4, ELSET=all
1, 1, 2, 3, 4
*MATERIAL, NAME=m
*ELASTIC
100., 0.
*DENSITY
1.
*EXPANSION
1e-3
*SOLID SECTION, ELSET=all, MATERIAL=m
1.
{card}*BOUNDARY
1, 1, 2
4, 1, 2
*STEP
*STATIC, DIRECT
0.05, 1.
{load}*END STEP
*STEP
*STATIC, DIRECT
0.1, 1.
{load}*END STEP
"""
    results = run(tmp_path / "a.inp", text)
    # Weight of the whole bar on consistent nodes: the end moves by g rho L^2/2E = 0.06.
    for frame in results.frames:
        if frame.increment:
            want = unit * formula(frame.step_time)
            got = frame.U[1:3, 0].mean()
            assert got == pytest.approx(want, abs=2e-7 if name == "periodic" else 1e-9), (
                frame.step,
                frame.step_time,
            )


# --- Beams far bent: boundary value problems ---


def rod(
    EI: float, EA: float, L: float, load: Any, tip: Any, start: float = 0.0, n: int = 60
) -> Any:
    """Extensible rod without shear flexibility, clamped: x, y, angle, and force (H, V), moment.

    `load(x, y, angle)` is the force per reference length, `tip(x, y, angle)` force and moment.
    """

    def f(s: np.ndarray, z: np.ndarray) -> np.ndarray:
        x, y, a, H, V, M = z
        N = H * np.cos(a) + V * np.sin(a)
        stretch = 1 + N / EA
        qx, qy = load(x, y, a, stretch, M / EI)
        return np.array(
            [
                stretch * np.cos(a),
                stretch * np.sin(a),
                M / EI,
                -qx + 0 * x,
                -qy + 0 * x,
                -stretch * (V * np.cos(a) - H * np.sin(a)),
            ]
        )

    def ends(z0: np.ndarray, z1: np.ndarray) -> np.ndarray:
        H, V, M = tip(*z1[:3])
        return np.array([z0[0], z0[1], z0[2] - start, z1[3] - H, z1[4] - V, z1[5] - M])

    s = np.linspace(0, L, n)
    guess = np.zeros((6, n))
    guess[0] = s * math.cos(start)
    guess[1] = s * math.sin(start)
    guess[2] = start
    return f, ends, s, guess


def solve_rod(factors: int, make: Any) -> Any:
    """Continuation in the load: `make(share)` gives the parts."""
    z = None
    for k in range(1, factors + 1):
        f, e, s, guess = make(k / factors)
        if z is not None:
            s, guess = z.x, z.y
        z = solve_bvp(f, e, s, guess, tol=1e-6, max_nodes=5000)
        assert z.success, z.message
    return z.y[:, -1], z


def strip(element: str, n: int, L: float, h: float) -> tuple[Any, Any]:
    mesh = ct.mesh.rectangle(L, h, n, 1, CELL[element], origin=(0.0, -h / 2))
    return mesh, int(np.argmin(np.hypot(mesh.points[:, 0] - L, mesh.points[:, 1] + h / 2)))


@pytest.mark.parametrize(
    ("element", "what"),
    cover(
        ["BEAM", "Q8", "Q4D", "Q4I"],
        ["pressure", "weight", "bracket"],
        strength=1,
        allowed=lambda *case: case != ("BEAM", "pressure"),  # beams take no pressure
    ),
)
def test_cantilever_far_bent_by_load_on_its_length(element: str, what: str) -> None:
    """Pressure that follows, own weight upward, a dead force on a rigid bracket: rod theory.

    Boundary value problems of an extensible rod by SciPy's collocation; slenderness 50. The
    pressure acts on the lower side, which is longer than the axis by h/2 times the curvature.
    """
    L, h, E = 10.0, 0.2, 1e5
    EI, EA = E * h**3 / 12, E * h
    p, w, arm, P = 3.0 * EI / L**3 * 3, 20.0 * EI / L**3, np.array([1.0, 1.5]), 3.0 * EI / L**2

    def make(x: float) -> Any:
        if what == "pressure":
            return rod(
                EI,
                EA,
                L,
                lambda _x, _y, a, g, c: (
                    -x * p * (g + c * h / 2) * np.sin(a),
                    x * p * (g + c * h / 2) * np.cos(a),
                ),
                lambda *_: (0.0, 0.0, 0.0),
            )
        if what == "weight":
            return rod(EI, EA, L, lambda *_: (0.0, x * w), lambda *_: (0.0, 0.0, 0.0))

        def tip(_x: float, _y: float, a: float) -> tuple[float, float, float]:
            r = rotation(a) @ arm
            F = x * P * np.array([-0.5, 1.0])
            return F[0], F[1], r[0] * F[1] - r[1] * F[0]

        return rod(EI, EA, L, lambda *_: (0.0, 0.0), tip)

    z, _ = solve_rod(6, make)
    if element == "BEAM":
        n = 60
        points = np.column_stack([np.linspace(0, L, n + 1), np.zeros(n + 1)])
        points = np.vstack([points, [L + arm[0], arm[1]]])
        cells = Cells(
            "line2", np.column_stack([np.arange(n), np.arange(1, n + 1)]), np.arange(1, n + 1)
        )
        used = points if what == "bracket" else points[:-1]
        mesh = ct.Mesh(used, [cells])
        model = ct.Model(mesh)
        model.beam(np.arange(n), material=ct.Elastic(E=E, rho=1.0), area=h, inertia=h**3 / 12)
        model.fix([0], rotation=True)
        tip_node = n
        ref = n + 1
        if what == "bracket":
            model.rigid([n], ref)
    else:
        mesh, tip_node = strip(element, 40, L, h)
        ref = ct.mesh.add_node(mesh, L + arm[0], arm[1]) if what == "bracket" else -1
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=E, nu=0.0, rho=1.0))
        model.fix("left", rotation=True if element in DRILLING else None)
        if what == "bracket":
            model.rigid("right", ref)
    if what == "pressure":
        model.pressure("bottom", p)
    elif what == "weight":
        model.gravity(y=w / h)
    else:
        model.force([ref], x=-0.5 * P, y=P)
    results = ct.solve(model, ct.Static(increments=6), threads=1)
    frame = results.frames[-1]
    if element == "BEAM":
        end = np.array([L, 0.0]) + frame.U[tip_node]
    else:
        right = mesh.nodes_of("right")
        corners = right[np.argsort(mesh.points[right, 1])][[0, -1]]
        end = (mesh.points + frame.U)[corners].mean(axis=0)
    assert np.abs(end - z[:2]).max() < 4e-3 * L, (end, z[:2])
    assert abs(z[2]) > 1.0
    if what == "bracket":
        turn = frame.UR[ref]
        assert turn == pytest.approx(z[2], abs=5e-3 * abs(z[2]))
        force = np.array([-0.5 * P, P])
        assert np.allclose(frame.F[ref, :2], force)


@pytest.mark.parametrize("element", ["Q4D", "Q4DI", "OPT", "Q8"])
def test_a_beam_goes_on_where_a_strip_ends(element: str) -> None:
    """Half solid, half beam, clamped through the drilling rotation or a rigid end, and a stay.

    Rod theory with a dead tip force and a truss to a fixed point: collocation by SciPy.
    """
    L, h, E = 10.0, 0.25, 1e5
    EI, EA = E * h**3 / 12, E * h
    anchor, k = np.array([8.0, -4.0]), 0.35  # truss: engineering strain, stiffness EA/L0
    l0 = float(np.linalg.norm(np.array([L, 0.0]) - anchor))
    P = 3.5 * EI / L**2
    kk = k * EI / L**2

    def make(x: float) -> Any:
        def tip(px: float, py: float, a: float) -> tuple[float, float, float]:
            d = anchor - np.array([px, py])
            now = float(np.linalg.norm(d))
            T = kk * (now - l0) * d / now
            return T[0] + 0.3 * x * P, T[1] + x * P, 0.0

        return rod(EI, EA, L, lambda *_: (0.0, 0.0), tip)

    z, _ = solve_rod(6, make)
    n = 30
    solid = ct.mesh.rectangle(
        L / 2, h, 30, 2 if element != "Q8" else 1, CELL[element], origin=(0.0, -h / 2)
    )
    first = solid.n_nodes
    xs = np.linspace(L / 2, L, n + 1)
    points = np.vstack([solid.points, np.column_stack([xs, 0 * xs]), anchor])
    number = solid.n_cells
    beams = Cells(
        "line2",
        first + np.column_stack([np.arange(n), np.arange(1, n + 1)]),
        number + 1 + np.arange(n),
    )
    stay = Cells("line2", np.array([[first + n, first + n + 1]]), np.array([number + n + 1]))
    mesh = ct.Mesh(
        points,
        [*solid.cells, beams, stay],
        node_sets=solid.node_sets,
        edge_sets=solid.edge_sets,
    )
    model = ct.Model(mesh)
    steel = ct.Elastic(E=E, nu=0.0)
    model.section(np.arange(number), element=element, material=steel)
    model.beam(number + np.arange(n), material=steel, area=h, inertia=h**3 / 12)
    model.truss([number + n], material=ct.Elastic(E=kk * l0), area=1.0)
    model.fix("left", rotation=True if element in DRILLING else None)
    model.rigid("right", first)
    model.fix([first + n + 1])
    model.force([first + n], x=0.3 * P, y=P)
    frame = ct.solve(model, ct.Static(increments=8), threads=1).frames[-1]
    end = (mesh.points + frame.U)[first + n]
    tolerance = 2e-2 if element == "OPT" else 5e-3  # one row of pairs: see the theory
    assert np.abs(end - z[:2]).max() < tolerance * L, (end, z[:2])
    assert frame.UR[first + n] == pytest.approx(z[2], rel=tolerance)
    d = anchor - z[:2]
    N = kk * (np.linalg.norm(d) - l0)
    got = frame.fields[-1].values["N"].ravel()[0]
    assert got == pytest.approx(N, rel=3 * tolerance)


# --- Couplings at large rotation: minima of energy ---


@pytest.mark.parametrize("kind", ["distributing", "kinematic"])
@pytest.mark.parametrize("weights", [None, [1.0, 3.0, 2.0, 0.5]])
def test_coupled_springs_find_the_least_energy(kind: str, weights: Any) -> None:
    """Four nodes on springs, a reference node off their center with a dead force and a moment.

    Reference: energy of the springs less the work, minimized over the places of the nodes, with
    the formulas of the constraints page for mean motion and mean rotation.
    """
    if kind == "kinematic" and weights is not None:
        pytest.skip("weights belong to distributing couplings")
    X = np.array([[0.0, 0.0], [1.0, 0.2], [1.2, 1.1], [-0.1, 0.9]])
    away = np.array([[-1.5, -1.0], [2.5, -1.2], [2.6, 2.4], [-1.4, 2.2]])
    k = np.array([3.0, 5.0, 4.0, 6.0])
    ref = np.array([2.0, 2.5])
    F, M = np.array([4.0, 5.0]), -3.0
    l0 = np.linalg.norm(X - away, axis=1)
    w = np.array(weights if weights is not None else [1.0] * 4)
    w = w / w.sum()

    def springs(x: np.ndarray) -> float:
        return float(0.5 * np.sum(k * (np.linalg.norm(x - away, axis=1) - l0) ** 2))

    if kind == "distributing":
        # inner springs keep the four nodes from moving apart freely
        pairs = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]
        kin = 20.0
        c = w @ X

        def energy(u: np.ndarray) -> float:
            x = X + u.reshape(4, 2)
            inner = sum(
                0.5 * kin * (np.linalg.norm(x[a] - x[b]) - np.linalg.norm(X[a] - X[b])) ** 2
                for a, b in pairs
            )
            mean = w @ x
            D, d = X - c, x - mean
            cross = np.sum(w * (D[:, 0] * d[:, 1] - D[:, 1] * d[:, 0]))
            turn = math.atan2(cross, np.sum(w * (D * d).sum(axis=1)))
            place = mean + rotation(turn) @ (ref - c)
            return springs(x) + inner - F @ (place - ref) - M * turn

        found = minimize(energy, np.zeros(8), method="BFGS", options={"gtol": 1e-10})
        want = X + found.x.reshape(4, 2)
    else:

        def energy(q: np.ndarray) -> float:
            x = ref + q[:2] + (X - ref) @ rotation(q[2]).T
            return springs(x) - F @ q[:2] - M * q[2]

        found = minimize(energy, np.zeros(3), method="BFGS", options={"gtol": 1e-10})
        want = ref + found.x[:2] + (X - ref) @ rotation(found.x[2]).T
        pairs, kin = [], 0.0
    points = np.vstack([X, away, ref])
    lines = [(i, i + 4) for i in range(4)] + pairs
    mesh = ct.Mesh(points, [Cells("line2", np.array(lines), np.arange(1, len(lines) + 1))])
    model = ct.Model(mesh)
    for i in range(4):
        model.spring([i], float(k[i]))
    if pairs:
        model.spring(list(range(4, len(lines))), kin)
    model.fix([4, 5, 6, 7])
    model.couple([0, 1, 2, 3], 8, kind=kind, weights=weights)
    model.force([8], x=F[0], y=F[1], moment=M)
    frame = ct.solve(model, ct.Static(increments=10), threads=1).frames[-1]
    assert np.allclose((points + frame.U)[:4], want, atol=2e-5)
    assert abs(frame.UR[8]) > 0.2
    # The rotation and the supports: all forces and moments balance.
    x = points + frame.U
    total = frame.RF[:, :2].sum(axis=0) + F
    assert np.abs(total).max() < 1e-8
    moment = np.sum(x[:, 0] * frame.RF[:, 1] - x[:, 1] * frame.RF[:, 0]) + M
    moment += x[8, 0] * F[1] - x[8, 1] * F[0]
    assert abs(moment) < 1e-7


@pytest.mark.parametrize("element", ["Q8", "Q4I", "Q4D", "T6"])
def test_distributing_load_at_a_turned_end(element: str) -> None:
    """A block turned by 70 degrees carries an offset dead force through a distributing coupling.

    Statics: reactions at the turning grip hold force and moment about the current point.
    """
    mesh = ct.mesh.rectangle(3.0, 1.0, 6, 2, CELL[element])
    grip = ct.mesh.add_node(mesh, 0.0, 0.5, "grip")
    ref = ct.mesh.add_node(mesh, 4.0, 1.5, "ref")
    model = ct.Model(mesh)
    model.section(
        "all",
        element=element,
        material=ct.Elastic(E=500.0, nu=0.3),
        thickness=0.5,
        local_strain="logarithmic",
    )
    model.rigid("left", grip)
    model.couple("right", ref, kind="distributing")
    F = np.array([0.5, -0.8])
    turn = ct.Static(increments=8, supports=[Fixed([grip], d, 0.0) for d in (0, 1)])
    turn.fix([grip], x=None, y=None, rotation=math.radians(70.0))
    load = ct.Static(increments=4, loads=[NodalForce([ref], d, float(F[d])) for d in (0, 1)])
    load.force([ref], moment=0.6)
    frame = ct.solve(model, [turn, load], threads=1).frames[-1]
    x = mesh.points + frame.U
    assert np.allclose(frame.RF[grip, :2], -F, rtol=1e-7)
    arm = x[ref] - x[grip]
    want = -(arm[0] * F[1] - arm[1] * F[0]) - 0.6
    assert frame.RF[grip, 2] == pytest.approx(want, rel=1e-6)
    right = mesh.nodes_of("right")
    X = mesh.points[right]
    D, d = X - X.mean(axis=0), x[right] - x[right].mean(axis=0)
    mean = math.atan2(np.sum(D[:, 0] * d[:, 1] - D[:, 1] * d[:, 0]), np.sum(D * d))
    if element in ("Q4I", "Q4D"):  # equal weights by default only where the edge is linear
        weights = np.ones(len(right))
        weights = weights / weights.sum()
    assert frame.UR[ref] == pytest.approx(mean, abs=0.02)
    assert abs(mean) > 1.0


# --- Loads that must be equal, and refusals ---


@pytest.mark.parametrize("element", ["Q4I", "Q8R", "T6", "OPT", "Q4D"])
def test_pressure_in_steps_of_a_table_is_hydrostatic(element: str) -> None:
    """A wall under water: pressure by edge as a table, the water level rises in a second step.

    Resultant and moment of piecewise constant pressure by hand; clamped wall, linear.
    """
    H, n, t, rho = 4.0, 16, 0.5, 2.0
    mesh = ct.mesh.rectangle(1.0, H, 2, n, CELL[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.2), thickness=t)
    model.fix("bottom", rotation=True if element in DRILLING else None)
    left = np.array(mesh.edge_sets["left"])
    cells, faces = left.T
    corner = mesh.cells[0].nodes
    k = 3 if CELL[element].startswith("tri") else 4
    edges = [corner[c][[f, (f + 1) % k]] for c, f in zip(cells, faces, strict=True)]
    mid = mesh.points[np.array(edges), 1].mean(axis=1)
    steps = []
    for level in (2.5, 4.0):
        step = ct.Static(nlgeom=False)
        for edge, y in zip(left, mid, strict=True):
            step.pressure(edge[None, :], rho * max(level - y, 0.0))
        steps.append(step)
    frames = ct.solve(model, steps, threads=1).frames
    for step, level in ((1, 2.5), (2, 4.0)):
        frame = [f for f in frames if f.step == step][-1]
        p = rho * np.maximum(level - mid, 0.0) * H / n * t
        assert frame.F[:, 0].sum() == pytest.approx(p.sum(), rel=1e-10)
        total = np.sum(mesh.points[:, 0] * frame.F[:, 1] - mesh.points[:, 1] * frame.F[:, 0])
        total += frame.F[:, 2].sum()
        assert total == pytest.approx(-np.sum(p * mid), rel=1e-9)
        b = mesh.nodes_of("bottom")
        x, y = mesh.points[b].T
        reaction = np.sum(x * frame.RF[b, 1] - y * frame.RF[b, 0]) + frame.RF[b, 2].sum()
        assert reaction == pytest.approx(np.sum(p * mid), rel=1e-7)


@pytest.mark.parametrize(
    ("axis", "kind"),
    cover(["GRAV", "CENTRIF"], ["CPS8R", "CPE4I", "OPT", "Q4D", "CPS6"], strength=1),
)
def test_body_force_over_steps_under_nlgeom(tmp_path: Path, axis: str, kind: str) -> None:
    """Weight or spin in one step, the body turned by 90 degrees in the next: total force by hand.

    Weight: m g whatever the turn, reaction moment by the center. Spin about the grip: m w^2 r_c.
    """
    from support.audits import deck_mesh

    cell = {"CPS8R": "quad8", "OPT": "tri3", "CPS6": "tri6"}.get(kind, "quad4")
    mesh = ct.mesh.rectangle(2.0, 0.5, 4, 1, cell)
    n = mesh.n_nodes + 1
    card = "all, GRAV, 9., 0., -1., 0."
    if axis == "CENTRIF":
        card = "all, CENTRIF, 4., 0., 0.25, 0., 0., 0., 1."
    text = (
        deck_mesh(mesh, kind)
        + f"""*NODE
{n}, 0., 0.25
*MATERIAL, NAME=m
*ELASTIC
3000., 0.3
*DENSITY
2.
*SOLID SECTION, ELSET=all, MATERIAL=m
0.5
*RIGID BODY, NSET=left, REF NODE={n}
*BOUNDARY
{n}, 1, 2
{n}, 6, 6
*STEP, NLGEOM
*STATIC
0.5, 1.
*DLOAD
{card}
*END STEP
*STEP, NLGEOM
*STATIC
0.1, 1.
*BOUNDARY
{n}, 6, 6, {math.pi / 2!r}
*END STEP
"""
    )
    results = run(tmp_path / "b.inp", text)
    mass = 2.0 * 0.5 * 2.0 * 0.5
    for step in (1, 2):
        frame = [f for f in results.frames if f.step == step][-1]
        x = results.mesh.points + frame.U
        F = frame.F
        grip = x[-1]
        total = F[:, :2].sum(axis=0)
        moment = np.sum((x - grip)[:, 0] * F[:, 1] - (x - grip)[:, 1] * F[:, 0]) + F[:, 2].sum()
        assert np.allclose(frame.RF[-1, :2], -total, rtol=1e-7, atol=1e-9)
        assert frame.RF[-1, 2] == pytest.approx(-moment, rel=1e-6, abs=1e-8)
        if axis == "GRAV":
            assert np.allclose(total, [0.0, -9.0 * mass], atol=1e-9)
            assert np.linalg.norm(F[:, :2].sum(axis=0)) == pytest.approx(9.0 * mass)
        else:
            assert abs(moment) < 1e-7  # a spin about the grip has no moment there
            assert np.linalg.norm(total) == pytest.approx(4.0 * mass * 1.0, rel=5e-3)
