"""Statics, plasticity, loads, constraints and output in combinations, against answers found apart.

Every check names its claim; the comment says where its reference value comes from.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import corota as ct
from corota.mesh.data import Cells
from corota.model.loads import Fixed, Temperature

CELL = {
    "T3": "tri3",
    "OPT": "tri3",
    "T6": "tri6",
    "Q4": "quad4",
    "Q4I": "quad4",
    "Q4R": "quad4",
    "Q4S": "quad4",
    "Q4D": "quad4",
    "Q4DI": "quad4",
    "Q8": "quad8",
    "Q8R": "quad8",
    "Q9": "quad9",
}
pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")

DRILLING = ("OPT", "Q4D", "Q4DI")


def rotation(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def boundary(mesh: Any) -> np.ndarray:
    return np.unique(np.concatenate([mesh.nodes_of(s) for s in ("left", "right", "top", "bottom")]))


def run(path: Path, text: str, **options: Any) -> Any:
    """Run a deck and leave its files beside it."""
    path.write_text(text)
    model = ct.read(path, **options)
    files = ct.JobFiles(path.parent, path.stem, points=True)
    return ct.solve(model, observers=[files], threads=1)


def deck_mesh(mesh: Any, kind: str) -> str:
    """Nodes, elements and sets of a mesh as cards."""
    lines = ["*NODE"]
    for label, (x, y) in zip(mesh.node_labels, mesh.points, strict=True):
        lines.append(f"{label}, {float(x)!r}, {float(y)!r}")
    lines.append(f"*ELEMENT, TYPE={kind}, ELSET=all")
    for label, nodes in zip(mesh.cells[0].labels, mesh.cells[0].nodes, strict=True):
        lines.append(f"{label}, " + ", ".join(str(mesh.node_labels[n]) for n in nodes))
    for name in ("left", "right", "top", "bottom"):
        lines.append(f"*NSET, NSET={name}")
        lines += [str(mesh.node_labels[n]) for n in mesh.nodes_of(name)]
    return "\n".join(lines) + "\n"


def tables(path: Path) -> dict[str, list[np.ndarray]]:
    """Read the tables of a .dat file: rows of numbers below each heading, by its first word."""
    found: dict[str, list[np.ndarray]] = {}
    rows: list[list[float]] = []
    head = ""
    for line in [*path.read_text().splitlines(), "end"]:
        words = line.split()
        if not words:
            continue
        try:
            rows.append([float(w) for w in words])
        except ValueError:
            if rows:
                found.setdefault(head, []).append(np.array(rows))
            rows, head = [], line.strip().split(" for ")[0].split(" (")[0]
    return found


# --- Homogeneous states: a reference program of a single point ---


def strain_of(stretch: np.ndarray) -> np.ndarray:
    """Hencky strain from the right Cauchy-Green tensor."""
    values, vectors = np.linalg.eigh(stretch)
    return vectors @ np.diag(0.5 * np.log(values)) @ vectors.T


class Point:
    """J2 plasticity in three dimensions, radial return, linear hardenings.

    The stress through the thickness is made zero by a scalar equation for the thickness strain.
    """

    def __init__(self, E: float, nu: float, sy: float, H: float, K: float, plane: str) -> None:
        self.G, self.bulk = E / (2 + 2 * nu), E / (3 - 6 * nu)
        self.sy, self.H, self.K, self.plane = sy, H, K, plane
        self.ep, self.beta, self.p = np.zeros((3, 3)), np.zeros((3, 3)), 0.0
        self.ezz = 0.0

    def trial(self, e2: np.ndarray, ezz: float) -> tuple[Any, ...]:
        e = np.zeros((3, 3))
        e[:2, :2], e[2, 2] = e2, ezz
        ee = e - self.ep
        mean = np.trace(ee) / 3
        s = 2 * self.G * (ee - mean * np.eye(3))
        xi = s - self.beta
        q = math.sqrt(1.5) * np.linalg.norm(xi)
        dp = max(0.0, (q - self.sy - self.H * self.p) / (3 * self.G + self.H + self.K))
        flow = 1.5 * xi / q if q > 0 else xi
        stress = s - 2 * self.G * dp * flow + 3 * self.bulk * mean * np.eye(3)
        return stress, self.ep + dp * flow, self.beta + 2 / 3 * self.K * dp * flow, self.p + dp

    def move(self, e2: np.ndarray) -> np.ndarray:
        ezz = 0.0
        if self.plane == "stress":
            ezz = brentq(lambda z: self.trial(e2, z)[0][2, 2], -2.0, 2.0, xtol=1e-15, rtol=1e-14)
        stress, self.ep, self.beta, self.p = self.trial(e2, ezz)
        self.ezz = ezz
        return stress


def hencky_cauchy(point: Point, F: np.ndarray) -> np.ndarray:
    """Cauchy stress xx, yy, zz, xy; the stress conjugate to ln U by differences of dE/dC."""
    C = F.T @ F
    T = point.move(strain_of(C))
    S = np.zeros((2, 2))
    for i in range(2):
        for j in range(i, 2):
            dC = np.zeros((2, 2))
            dC[i, j] = dC[j, i] = 1.0
            h = 1e-5
            dE = (strain_of(C + h * dC) - strain_of(C - h * dC)) / (2 * h)
            S[i, j] = S[j, i] = 2 * np.sum(T[:2, :2] * dE) / (1 if i == j else 2)
    J = np.linalg.det(F) * math.exp(point.ezz)
    sigma = F @ S @ F.T / J
    return np.array([sigma[0, 0], sigma[1, 1], T[2, 2] / J, sigma[0, 1]])


def frame_angle(X: np.ndarray, F: np.ndarray) -> float:
    """Rotation that fits the nodes of one element best."""
    X = X - X.mean(axis=0)
    x = X @ F.T
    return math.atan2(np.sum(X[:, 0] * x[:, 1] - X[:, 1] * x[:, 0]), np.sum(X * x))


def linear_cauchy(point: Point, F: np.ndarray, X: np.ndarray) -> np.ndarray:
    """Stress of the linear local strain, turned with the frame."""
    R = rotation(frame_angle(X, F))
    H = R.T @ F - np.eye(2)
    T = point.move((H + H.T) / 2)
    sigma = R @ T[:2, :2] @ R.T
    return np.array([sigma[0, 0], sigma[1, 1], T[2, 2], sigma[0, 1]])


def drive(
    element: str, material: Any, plane: str, strain: str, path: list[np.ndarray], **section: Any
) -> Any:
    """Prescribe homogeneous deformations at the boundary of 2 x 2 equal cells, a step each."""
    mesh = ct.mesh.rectangle(2.0, 1.6, nx=2, ny=2, cell=CELL[element])
    model = ct.Model(mesh)
    section = {"thickness": 0.7} | section
    model.section(
        "all", element=element, material=material, plane=plane, local_strain=strain, **section
    )
    nodes = boundary(mesh)
    steps = []
    turn = 0.0
    for F in path:
        u = mesh.points @ (F - np.eye(2)).T
        supports = [Fixed([int(n)], d, float(u[n, d])) for n in nodes for d in (0, 1)]
        if element in DRILLING:  # the rotation of the field, or the sides would bulge
            angle = frame_angle(mesh.points[mesh.cells[0].nodes[0]], F)
            turn += (angle - turn + math.pi) % (2 * math.pi) - math.pi
            local = rotation(turn).T @ F
            spin = turn + 0.5 * (local[1, 0] - local[0, 1])
            supports += [Fixed([int(n)], 2, spin) for n in nodes]
        steps.append(ct.Static(supports=supports, increments=1, tolerance=1e-11))
    return ct.solve(model, steps, threads=1)


PATH = [
    np.array([[1.004, 0.0], [0.0, 1.0]]),
    rotation(1.1) @ np.array([[1.03, 0.02], [0.0, 0.99]]),
    rotation(1.9) @ np.array([[1.005, -0.01], [0.01, 1.0]]),
    rotation(2.6) @ np.array([[0.97, 0.0], [0.03, 1.01]]),
    rotation(3.3) @ np.array([[1.0, 0.0], [0.0, 1.0]]),
]


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("strain", ["linear", "logarithmic"])
@pytest.mark.parametrize("element", CELL)
def test_yield_unload_reverse_while_turning(element: str, strain: str, plane: str) -> None:
    """Combined hardening in states that stretch, unload and reverse while the body turns.

    Reference: the point program above, one implicit increment a step as the element makes it.
    Under `linear` the frame is the best fit to the nodes of a cell.
    """
    steel = ct.Mises(E=2000.0, nu=0.3, yield_stress=10.0, isotropic=60.0, kinematic=90.0)
    results = drive(element, steel, plane, strain, PATH)
    last = {f.step: f for f in results.frames}
    point = Point(2000.0, 0.3, 10.0, 60.0, 90.0, plane)
    mesh = results.mesh
    cell = mesh.points[mesh.cells[0].nodes[0]]
    for k, F in enumerate(PATH):
        want = linear_cauchy(point, F, cell) if strain == "linear" else hencky_cauchy(point, F)
        got = last[k + 1].fields[0].values["S"]
        assert np.abs(got - want).max() < 2e-6 * np.abs(want).max() + 1e-6, (k, got[0, 0], want)
        peeq = last[k + 1].fields[0].values["PEEQ"]
        assert np.abs(peeq - point.p).max() < 1e-8


def svk_cauchy(F: np.ndarray, E: float, nu: float, plane: str) -> np.ndarray:
    """St. Venant-Kirchhoff; in plane stress the thickness follows from S33 = 0."""
    e = (F.T @ F - np.eye(2)) / 2
    e33 = -nu / (1 - nu) * np.trace(e) if plane == "stress" else 0.0
    lam, mu = E * nu / (1 + nu) / (1 - 2 * nu), E / (2 + 2 * nu)
    S = lam * (np.trace(e) + e33) * np.eye(2) + 2 * mu * e
    S33 = lam * (np.trace(e) + e33) + 2 * mu * e33
    third = math.sqrt(1 + 2 * e33)
    J = np.linalg.det(F) * third
    sigma = F @ S @ F.T / J
    return np.array([sigma[0, 0], sigma[1, 1], S33 * third**2 / J, sigma[0, 1]])


BIG = [
    rotation(2.5 * k / 4) @ (np.eye(2) + k / 4 * np.array([[0.4, 0.3], [0.1, -0.2]]))
    for k in range(1, 5)
] + [rotation(0.8) @ np.array([[0.7, -0.2], [0.0, 1.2]])]


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("strain", ["green_lagrange", "logarithmic"])
@pytest.mark.parametrize("element", CELL)
def test_large_elastic_strain_is_cauchy_stress(element: str, strain: str, plane: str) -> None:
    """Elastic strain of tens of per cent with rotation: closed forms of both hyperelastic laws.

    The Hencky law: S = 2 T : dE/dC and Cauchy by the push-forward, thickness stretch exp(E33).
    """
    results = drive(element, ct.Elastic(E=100.0, nu=0.25), plane, strain, BIG)
    last = {f.step: f for f in results.frames}
    for k, F in enumerate(BIG):
        point = Point(100.0, 0.25, 1e9, 0.0, 0.0, plane)
        want = (
            hencky_cauchy(point, F)
            if strain == "logarithmic"
            else svk_cauchy(F, 100.0, 0.25, plane)
        )
        got = last[k + 1].fields[0].values["S"]
        assert np.abs(got - want).max() < 2e-6 * np.abs(want).max(), (k, got[0, 0], want)


# --- Plasticity, temperature, initial stress ---


@pytest.mark.parametrize("kind", ["CPS4I", "CPS8R", "Q4D", "CPS8", "Q4S"])
def test_bar_between_walls_heated_beyond_yield_and_cooled(tmp_path: Path, kind: str) -> None:
    """Residual stress, reaction and every energy of a bar at 30 degrees, heated and cooled.

    One dimension: 0 = s/E + ep + alpha T; isotropic hardening, yield again in tension. Plastic
    work is sy p + H p^2/2; work of heat is -s alpha dT summed over both ways.
    """
    E, sy, H, alpha, T, t, L, h = 1000.0, 2.0, 100.0, 1e-5, 500.0, 2.5, 4.0, 1.0
    cell = {"CPS8R": "quad8", "CPS8": "quad8"}.get(kind, "quad4")
    mesh = ct.mesh.move(ct.mesh.rectangle(L, h, nx=4, ny=2, cell=cell), angle=30.0)
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    hold = "left, 6, 6\nright, 6, 6\n" if kind == "Q4D" else ""
    deck = (
        deck_mesh(mesh, kind)
        + f"""*NSET, NSET=every, ELSET=all
*TRANSFORM, NSET=every, TYPE=R
{c}, {s}, 0., {-s}, {c}, 0.
*MATERIAL, NAME=m
*ELASTIC
{E}, 0.3
*PLASTIC
{sy}, 0.
{sy + H}, 1.
*EXPANSION
{alpha}
*SOLID SECTION, ELSET=all, MATERIAL=m
{t}
*BOUNDARY
left, 1, 1
right, 1, 1
{mesh.node_labels[mesh.nodes_of("left")[0]]}, 2, 2
{hold}*STEP, NLGEOM, INC=400
*STATIC, DIRECT
0.01, 1.
*TEMPERATURE
every, {T}
*END STEP
*STEP, NLGEOM, INC=400
*STATIC, DIRECT
0.01, 1.
*TEMPERATURE, OP=NEW
*END STEP
"""
    )
    results = run(tmp_path / "bar.inp", deck)
    heat = E * alpha * T
    p1 = (heat - sy) / (E + H)
    s1 = -(sy + H * p1)
    trial = s1 + heat
    dp = max(0.0, (trial - sy - H * p1) / (E + H))
    s2 = trial - E * dp
    turn = rotation(math.pi / 6)
    V = L * h * t
    for step, stress, p in ((1, s1, p1), (2, s2, p1 + dp)):
        frame = [f for f in results.frames if f.step == step][-1]
        got = frame.fields[0].values
        want = stress * np.outer(turn[:, 0], turn[:, 0])
        assert np.allclose(got["S"][..., 0], want[0, 0], rtol=1e-5, atol=1e-6)
        assert np.allclose(got["S"][..., 3], want[0, 1], rtol=1e-5, atol=1e-6)
        assert np.allclose(got["PEEQ"], p, rtol=1e-5)
        force = frame.RF[mesh.nodes_of("right"), :2].sum(axis=0)
        assert np.allclose(force, stress * h * t * turn[:, 0], rtol=2e-5)
        assert frame.scalars["ALLSE"] == pytest.approx(stress**2 / (2 * E) * V, rel=1e-5)
        assert frame.scalars["ALLPD"] == pytest.approx((sy * p + H * p**2 / 2) * V, rel=1e-3)
        assert abs(frame.scalars["ALLWK"]) < 1e-9 * V
        assert frame.scalars["ALLTH"] == pytest.approx(
            frame.scalars["ALLSE"] + frame.scalars["ALLPD"], rel=3e-3
        )
    # First way, by hand: elastic part then hardening line, against ALLTH at its end.
    Te = sy / (E * alpha)
    by_hand = (0.5 * sy * alpha * Te + 0.5 * (sy - s1) * alpha * (T - Te)) * V
    first = [f for f in results.frames if f.step == 1][-1]
    assert first.scalars["ALLTH"] == pytest.approx(by_hand, rel=2e-4)


@pytest.mark.parametrize("element", ["Q4I", "Q8", "T3"])
def test_cyclic_chaboche_with_voce(element: str) -> None:
    """Uniaxial cycles with recall and saturating hardening, plane stress.

    One-dimensional backward Euler with the same increments: b = (b0 + C dp s)/(1 + gamma dp).
    """
    E, sy, Q, bv, C, g = 200e3, 250.0, 80.0, 30.0, [60e3, 4e3], [400.0, 10.0]
    material = ct.Mises(
        E=E,
        nu=0.3,
        yield_stress=sy,
        isotropic=ct.Voce(Q=Q, b=bv),
        chaboche=list(zip(C, g, strict=True)),
    )
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=material, thickness=3.0)
    model.fix("left", y=None)
    model.fix([0], x=None)
    ends = [0.01, -0.008, 0.012]
    steps = [
        ct.Static(
            nlgeom=False,
            supports=[Fixed("right", 0, 2.0 * e)],
            increments=20,
            fixed_increments=True,
        )
        for e in ends
    ]
    results = ct.solve(model, steps, threads=1)
    eps, ep, p, b = 0.0, 0.0, 0.0, np.zeros(2)
    frames = [f for f in results.frames if f.increment > 0]
    k = 0
    for start, end in zip([0.0, *ends], ends, strict=False):
        for j in range(1, 21):
            eps = start + (end - start) * j / 20
            sign = math.copysign(1.0, E * (eps - ep) - b.sum())

            def residual(
                dp: float,
                eps: float = eps,
                ep: float = ep,
                p: float = p,
                b: np.ndarray = b,
                sign: float = sign,
            ) -> float:
                back = sum((b[i] + C[i] * dp * sign) / (1 + g[i] * dp) for i in range(2))
                size = sy + Q * (1 - math.exp(-bv * (p + dp)))
                return sign * (E * (eps - ep - sign * dp) - back) - size

            dp = brentq(residual, 0.0, 1.0, xtol=1e-16) if residual(0.0) > 0 else 0.0
            b = np.array([(b[i] + C[i] * dp * sign) / (1 + g[i] * dp) for i in range(2)])
            ep, p = ep + sign * dp, p + dp
            stress = E * (eps - ep)
            got = frames[k].fields[0].values["S"][..., 0]
            assert np.abs(got - stress).max() < 1e-5 * abs(stress) + 1e-4, (k, got[0, 0], stress)
            assert frames[k].RF[mesh.nodes_of("right"), 0].sum() == pytest.approx(
                3.0 * stress, rel=1e-5, abs=1e-3
            )
            k += 1


@pytest.mark.parametrize("element", ["Q4I", "Q4S", "Q8R", "Q9", "T6"])
def test_necking_load_of_a_hardening_bar(element: str) -> None:
    """Arc length finds the largest dead load of a bar under logarithmic strain.

    Considere: nominal stress tau exp(-e) is largest where d tau/d e = tau, with
    d tau/d e = EH/(E + H) beyond yield; e = tau/E + (tau - sy)/H there.
    """
    E, sy, H, t = 1000.0, 10.0, 30.0, 0.5
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=1, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    steel = ct.Mises(E=E, nu=0.3, yield_stress=sy, isotropic=H)
    model.section("all", element=element, material=steel, thickness=t, local_strain="logarithmic")
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    model.traction("right", x=60.0)
    results = ct.solve(
        model, ct.Static(path=ct.ArcLength(stop_at_limit=True), max_increments=300), threads=1
    )
    tau = E * H / (E + H)
    e = tau / E + (tau - sy) / H
    largest = tau * math.exp(-e)
    point = next(c for c in results.critical_points if c.kind == "limit")
    assert point.factor * 60.0 == pytest.approx(largest, rel=1e-6)
    assert results.frames[-1].U[mesh.nodes_of("right")[0], 0] == pytest.approx(
        2.0 * (math.exp(e) - 1), rel=1e-4
    )


@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_fully_plastic_moment_through_a_rigid_end(plane: str) -> None:
    """Pure bending by a turned rigid end to half a turn: M = Mp (1 - (k_e/k)^2/3), then unloading.

    Mp = s t h^2/4 with s = sy in plane stress, 2 sy/sqrt(3) in plane strain (nu near 1/2, where
    the yield points of both kinds of flow agree). The first unloading takes E'I k off.
    """
    E, sy, t, h, L = 1000.0, 2.0, 1.5, 1.0, 20.0
    mesh = ct.mesh.rectangle(L, h, nx=10, ny=8, cell="quad8")
    end = ct.mesh.add_node(mesh, L, h / 2, "ref")
    model = ct.Model(mesh)
    nu = 0.0 if plane == "stress" else 0.49
    steel = ct.Mises(E=E, nu=nu, yield_stress=sy)
    model.section("all", element="Q8R", material=steel, thickness=t, plane=plane)
    middle = int(np.argmin(np.hypot(mesh.points[:-1, 0], mesh.points[:-1, 1] - h / 2)))
    model.fix("left", y=None)
    model.fix([middle], x=None)
    model.rigid("right", end)
    turn = 0.8
    steps = [
        ct.Static(supports=[Fixed([end], 2, turn)], increments=10),
        ct.Static(supports=[Fixed([end], 2, turn - 0.02)], increments=1),
    ]
    results = ct.solve(model, steps, threads=1)
    moment = [[f for f in results.frames if f.step == k][-1].RF[end, 2] for k in (1, 2)]
    first = E / (1 - nu**2)
    limit = sy if plane == "stress" else 2 / math.sqrt(3) * sy
    ke = 2 * limit / (first * h)
    k = turn / L
    want = limit * t * h**2 / 4 * (1 - (ke / k) ** 2 / 3)
    assert moment[0] == pytest.approx(want, rel=8e-3)
    EI = first * t * h**3 / 12
    assert moment[1] - moment[0] == pytest.approx(-EI * 0.02 / L, rel=1e-2)


@pytest.mark.parametrize("element", CELL)
def test_initial_stress_turns_with_the_body(element: str) -> None:
    """A held block with initial stress and heat, turned by 100 degrees: R s R^T of the sum.

    Plane stress, nothing deforms, so heat adds -E alpha dT/(1 - nu) to both normal stresses; the
    thickness grows, and Cauchy stress is force per current area.
    """
    mesh = ct.mesh.rectangle(2.0, 1.6, nx=2, ny=2, cell=CELL[element])
    model = ct.Model(mesh)
    elastic = ct.Elastic(E=100.0, nu=0.25, expansion=1e-4)
    model.section(
        "all", element=element, material=elastic, thickness=0.3, local_strain="logarithmic"
    )
    model.initial_stress(xx=0.5, yy=-0.2, xy=0.3)
    model.initial_temperature(20.0)
    nodes = boundary(mesh)
    angle = math.radians(100.0)
    steps = []
    for a in np.linspace(0.0, angle, 5)[1:]:
        u = mesh.points @ (rotation(a) - np.eye(2)).T
        supports = [Fixed([int(n)], d, float(u[n, d])) for n in nodes for d in (0, 1)]
        if element in DRILLING:
            supports += [Fixed([int(n)], 2, float(a)) for n in nodes]
        loads = [Temperature("", 20.0 + 30.0 * a / angle)]
        steps.append(ct.Static(supports=supports, loads=loads, increments=1))
    frame = ct.solve(model, steps, threads=1).frames[-1]
    local = np.array([[0.5, 0.3], [0.3, -0.2]]) - 100.0 * 1e-4 * 30.0 / 0.75 * np.eye(2)
    thicker = 1e-4 * 30.0 + 0.25 / 100.0 * 2 * 0.4  # heat, and the added stress, by Hencky's law
    want = rotation(angle) @ local @ rotation(angle).T * math.exp(-thicker)
    got = frame.fields[0].values["S"]
    assert np.allclose(got[..., 0], want[0, 0], atol=1e-9)
    assert np.allclose(got[..., 1], want[1, 1], atol=1e-9)
    assert np.allclose(got[..., 3], want[0, 1], atol=1e-9)
    assert np.allclose(got[..., 2], 0.0, atol=1e-9)


@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q9"])
def test_orthotropic_heat_in_plane_strain(element: str) -> None:
    """Free expansion of an orthotropic body in plane strain, material axes at 25 degrees.

    From the full compliance: s33 = -E3 a3 dT with all else free; strains a dT - nu s33/E.
    """
    E1, E2, E3, n12, n13, n23 = 120.0, 40.0, 60.0, 0.2, 0.3, 0.25
    a1, a2, a3, dT, angle = 1e-4, 3e-4, -2e-4, 40.0, math.radians(25.0)
    mesh = ct.mesh.distort(ct.mesh.rectangle(3.0, 2.0, nx=3, ny=2, cell=CELL[element]), 0.2)
    model = ct.Model(mesh)
    material = ct.Orthotropic(E1, E2, E3, n12, n13, n23, 30.0, expansion=(a1, a2, a3))
    model.section(
        "all", element=element, material=material, plane="strain", orientation=angle, thickness=2.0
    )
    model.fix([0])
    corner = int(np.argmax(mesh.points[:, 0] - mesh.points[:, 1]))
    model.fix([corner], x=None)
    model.initial_temperature(-10.0)
    model.temperature(-10.0 + dT)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    s33 = -E3 * a3 * dT
    e1 = a1 * dT - n13 / E1 * s33
    e2 = a2 * dT - n23 / E2 * s33
    R = rotation(angle)
    want = R @ np.diag([e1, e2]) @ R.T
    E = frame.fields[0].values["E"]
    assert np.allclose(E[..., 0], want[0, 0], rtol=1e-9)
    assert np.allclose(E[..., 1], want[1, 1], rtol=1e-9)
    assert np.allclose(E[..., 3], 2 * want[0, 1], rtol=1e-9)
    S = frame.fields[0].values["S"]
    assert np.allclose(S[..., 2], s33, rtol=1e-9)
    assert np.abs(S[..., [0, 1, 3]]).max() < 1e-9 * abs(s33) * 100


def test_expansion_table_with_start_and_zero(tmp_path: Path) -> None:
    """Mean coefficients from a zero of 20, start at 60, end at 140, beyond the table's last row.

    alpha(T)(T - 20) - alpha(60) 40, straight between rows and constant outside.
    """
    text = """*NODE
1, 0., 0.
2, 3., 0.
*ELEMENT, TYPE=T2D2, ELSET=all
1, 1, 2
*MATERIAL, NAME=m
*ELASTIC
100., 0.
*EXPANSION, ZERO=20.
1e-4, 0.
2e-4, 100.
*SOLID SECTION, ELSET=all, MATERIAL=m
0.2
*INITIAL CONDITIONS, TYPE=TEMPERATURE
1, 60.
2, 60.
*BOUNDARY
1, 1, 2
2, 2, 2
*STEP
*STATIC
0.5, 1., 0.5, 0.5
*TEMPERATURE
1, 140.
2, 140.
*END STEP
"""
    results = run(tmp_path / "t.inp", text)
    start = 1.6e-4 * 40.0
    assert results.frames[-1].U[1, 0] == pytest.approx(3 * (2e-4 * 120 - start), rel=1e-12)
    assert results.frames[1].U[1, 0] == pytest.approx(3 * (2e-4 * 80 - start), rel=1e-12)


@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_bimetal_strip_of_two_thicknesses(plane: str) -> None:
    """Curvature of two layers of unequal depth, stiffness and thickness, turned far.

    Timoshenko 1925: force and moment balance of two beams, widths b1 and b2; in plane strain
    E/(1-nu^2) and (1+nu) alpha.
    """
    E = [100.0, 250.0]
    b = [2.0, 0.8]
    a = [0.4, 0.6]
    alpha = [2e-4, 5e-5]
    dT, L = 25.0, 60.0
    low = ct.mesh.rectangle(L, a[0], nx=40, ny=2, cell="quad8")
    top = ct.mesh.rectangle(L, a[1], nx=40, ny=2, cell="quad8", origin=(0.0, a[0]))
    low.cell_sets["low"] = np.arange(low.n_cells)
    top.cell_sets["high"] = np.arange(top.n_cells)
    mesh = ct.mesh.merge(low, top)
    model = ct.Model(mesh)
    nu = 0.0 if plane == "stress" else 0.3
    for k, name in enumerate(("low", "high")):
        material = ct.Elastic(E=E[k], nu=nu, expansion=alpha[k])
        model.section(name, element="Q8R", material=material, thickness=b[k], plane=plane)
    left = mesh.nodes_of("left")
    model.fix(left, y=None)
    model.fix([int(left[np.argmin(mesh.points[left, 1])])], x=None)
    model.temperature(dT)
    frame = ct.solve(model, ct.Static(increments=5), threads=1).frames[-1]
    Ep = [e / (1 - nu**2) if plane == "strain" else e for e in E]
    ap = [x * (1 + nu) if plane == "strain" else x for x in alpha]
    A = [b[k] * a[k] for k in range(2)]
    EI = sum(Ep[k] * b[k] * a[k] ** 3 / 12 for k in range(2))
    d = (a[0] + a[1]) / 2
    # Layers share the strain at the joint (N in the lower layer, curvature k).
    compliance = 1 / (Ep[0] * A[0]) + 1 / (Ep[1] * A[1]) + d**2 / EI
    N = -(ap[0] - ap[1]) * dT / compliance
    curvature = -N * d / EI

    # angle between two sections, by the chords of their end nodes
    def angle(x: float) -> float:
        on = np.flatnonzero(np.abs(mesh.points[:, 0] - x) < 1e-9)
        on = on[np.argsort(mesh.points[on, 1])]
        v = (mesh.points + frame.U)[on[-1]] - (mesh.points + frame.U)[on[0]]
        return math.atan2(v[1], v[0])

    got = angle(40.5) - angle(19.5)
    assert got / 21.0 == pytest.approx(curvature, rel=5e-3)


# --- Loads, steps and amplitudes ---

BARS = """*NODE
1, 0., 0.
2, 2., 0.
3, 4., 0.
*ELEMENT, TYPE=T2D2, ELSET=all
1, 1, 2
2, 2, 3
*NSET, NSET=ends
1
*MATERIAL, NAME=m
*ELASTIC
100., 0.
*DENSITY
0.5
*EXPANSION
1e-3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.2
*AMPLITUDE, NAME=tri
0., 0., 0.5, 1., 1., 0.4
*AMPLITUDE, NAME=tot, TIME=TOTAL TIME
0., 0., 1., 1., 3., -1.
*BOUNDARY
1, 1, 2
2, 2, 2
3, 2, 2
"""


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
        "all", element="Q8", material=ct.Elastic(E=300.0, nu=0.3), thickness=0.8, plane="strain"
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


# --- Constraints ---


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q9", "Q4DI", "Q4S"])
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


# --- Output: the same numbers in every file ---


@pytest.mark.parametrize("kind", ["CPS8", "CPE4I", "Q4D", "CPS3"])
def test_every_file_tells_the_same(tmp_path: Path, kind: str) -> None:
    """U, RF, S, volumes and energies of .dat, .csv, .vtkhdf and memory are one set of numbers.

    EVOL sums to the volume t L h; ELSE sums to ALLSE; RF of .dat is reaction plus load; the sum
    of the reactions balances the load; E of .dat has half of the shear angle.
    """
    cell = {"CPS8": "quad8", "CPS3": "tri3"}.get(kind, "quad4")
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=cell)
    text = (
        deck_mesh(mesh, kind)
        + """*MATERIAL, NAME=m
*ELASTIC
400., 0.3
*PLASTIC
3., 0.
5., 0.1
*SOLID SECTION, ELSET=all, MATERIAL=m
0.35
*BOUNDARY
left, 1, 2
*STEP, NLGEOM
*STATIC
0.25, 1., 0.1, 0.25
*CLOAD
right, 2, -0.02
right, 1, 0.1
*NODE PRINT, NSET=left, TOTALS=YES
RF
*NODE PRINT, NSET=right
U, RF
*EL PRINT, ELSET=all, TOTALS=YES
S, E, PEEQ, ELSE, EVOL
*END STEP
"""
    )
    results = run(tmp_path / "job.inp", text)
    frame = results.frames[-1]
    found = tables(tmp_path / "job.dat")
    right, left = mesh.nodes_of("right"), mesh.nodes_of("left")
    order = {label: i for i, label in enumerate(mesh.node_labels)}

    def last(head: str, rows: int) -> np.ndarray:
        return [t for t in found[head] if len(t) == rows][-1]

    u = last("displacements", len(right))
    for row in u:
        assert np.allclose(row[1:3], frame.U[order[int(row[0])]], rtol=1e-5, atol=1e-9)
    n_cells, n_points = frame.fields[0].volume.shape
    S = last("stresses", n_cells * n_points)
    E = last("strains", n_cells * n_points)
    values = frame.fields[0].values
    label = {c: k for k, c in enumerate(mesh.cells[0].labels)}
    for a, b in zip(S, E, strict=True):
        c, q = label[int(a[0])], int(a[1]) - 1
        assert np.allclose(a[[2, 3, 4, 5]], values["S"][c, q], rtol=1e-5, atol=1e-6)
        assert np.allclose(b[[2, 3, 4]], values["E"][c, q, :3], rtol=1e-5, atol=1e-8)
        assert b[5] == pytest.approx(values["E"][c, q, 3] / 2, rel=1e-5, abs=1e-8)
    volume = last("volume", n_cells)
    assert volume[:, 1].sum() == pytest.approx(4.0 * 1.0 * 0.35, rel=1e-5)
    energy = last("internal energy", n_cells)
    allse = frame.scalars["ALLSE"] + frame.scalars["ALLAE"]
    stored = ct.read_results(tmp_path / "job.vtkhdf")
    with stored:
        assert len(stored.times) == len(results.frames)
        for name in ("U1", "U2", "RF1", "RF2"):
            assert np.allclose(stored.nodal(name), results.nodal(name), rtol=1e-12, atol=1e-14)
        assert np.allclose(stored.frame().fields[0].values["S"], values["S"], rtol=1e-12)
        assert stored.history("ALLPD")[-1] == pytest.approx(frame.scalars["ALLPD"], rel=1e-12)
    import csv

    with (tmp_path / "job.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert float(rows[-1]["ALLSE"]) == pytest.approx(frame.scalars["ALLSE"], rel=1e-9)
    assert float(rows[-1]["RF2 left"]) == pytest.approx(0.02 * len(right), rel=1e-8)
    moment = next(k for k in rows[-1] if k.startswith("RM3 left"))
    arm = mesh.points[left].mean(axis=0)
    x = mesh.points + frame.U - arm
    want = np.sum(
        x[left, 0] * frame.RF[left, 1] - x[left, 1] * frame.RF[left, 0] + frame.RF[left, 2]
    )
    assert float(rows[-1][moment]) == pytest.approx(want, rel=1e-8)
    applied = -np.sum(x[right, 0] * frame.F[right, 1] - x[right, 1] * frame.F[right, 0])
    assert want == pytest.approx(applied, rel=1e-6)
    assert np.isfinite(allse)
    assert energy[:, 1].sum() > 0


@pytest.mark.parametrize("kind", ["CPS8", "CPE4I", "Q4D", "OPT", "T6"])
def test_else_sums_to_the_account(tmp_path: Path, kind: str) -> None:
    """ELSE of all elements sums to ALLSE + ALLAE, elastic, with heat, NLGEOM, thickness 0.35.

    And by hand: the free part expands without energy, the held block has s^2/2E parts.
    """
    cell = {"CPS8": "quad8", "OPT": "tri3", "T6": "tri6"}.get(kind, "quad4")
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=cell)
    text = (
        deck_mesh(mesh, kind)
        + """*NSET, NSET=every, ELSET=all
*MATERIAL, NAME=m
*ELASTIC
400., 0.
*EXPANSION
1e-4
*SOLID SECTION, ELSET=all, MATERIAL=m
0.35
*BOUNDARY
left, 1, 1
right, 1, 1
left, 6, 6
right, 6, 6
1, 2, 2
*STEP, NLGEOM
*STATIC
0.25, 1., 0.1, 0.25
*TEMPERATURE
every, 50.
*EL PRINT, ELSET=all, TOTALS=ONLY
ELSE
*END STEP
"""
    )
    results = run(tmp_path / "job.inp", text)
    frame = results.frames[-1]
    V = 4.0 * 0.35
    stress = 400.0 * 1e-4 * 50.0
    # Plane strain with nu = 0: the direction across is held too.
    want = (2 if kind == "CPE4I" else 1) * stress**2 / 800.0 * V
    # The frame of a triangle turns by a second-order angle under pure stretch.
    tolerance = 5e-4 if kind in ("OPT", "T6") else 1e-5
    assert frame.scalars["ALLSE"] == pytest.approx(want, rel=tolerance)
    total = next(iter(tables(tmp_path / "job.dat").values()))[-1]
    assert float(total.ravel()[-1]) == pytest.approx(frame.scalars["ALLSE"], rel=1e-5)


# --- Invariance ---


def gripper(mesh: Any, angle: float, unit: tuple[float, float]) -> Any:
    """A plastic, heated, loaded strip, all of its data turned by an angle and in other units."""
    length, force = unit
    stress = force / length**2
    R = rotation(angle)
    model = ct.Model(mesh)
    steel = ct.Mises(
        E=2000.0 * stress, nu=0.3, yield_stress=8.0 * stress, isotropic=50.0 * stress,
        kinematic=80.0 * stress, rho=0.02 * force / length**3, expansion=1e-4,
    )  # fmt: skip
    model.section("all", element="Q8R", material=steel, thickness=0.6 * length)
    model.local_axes("left", angle=angle)
    model.fix("left", y=None)
    model.fix([int(mesh.nodes_of("left")[0])])
    model.initial_stress(
        **dict(zip(("xx", "yy", "xy"), (lambda s: (s[0, 0], s[1, 1], s[0, 1]))(
            R @ (np.array([[0.4, 0.1], [0.1, -0.2]]) * stress) @ R.T), strict=True))
    )  # fmt: skip
    model.temperature(20.0)
    g = R @ np.array([0.0, -0.2])
    model.gravity(*g)
    q = R @ np.array([0.2, -0.35]) * stress
    model.traction("right", x=q[0], y=q[1])
    model.pressure("top", 0.05 * stress)
    return model


@pytest.mark.parametrize("angle", [37.0, 90.0, 200.0])
def test_turned_model_gives_turned_results(angle: float) -> None:
    """All data of a plastic part turned: displacements, stresses and reactions turn too."""
    base = ct.mesh.rectangle(5.0, 1.0, nx=6, ny=2, cell="quad8")
    a = ct.solve(gripper(base, 0.0, (1.0, 1.0)), ct.Static(increments=6), threads=1)
    mesh = ct.mesh.move(base, angle=angle)
    b = ct.solve(gripper(mesh, math.radians(angle), (1.0, 1.0)), ct.Static(increments=6), threads=1)
    R = rotation(math.radians(angle))
    fa, fb = a.frames[-1], b.frames[-1]
    assert np.allclose(fb.U, fa.U @ R.T, atol=1e-8 * np.abs(fa.U).max())
    assert np.allclose(fb.RF[:, :2], fa.RF[:, :2] @ R.T, atol=1e-7 * np.abs(fa.RF).max())
    pa, pb = fa.fields[0].values, fb.fields[0].values
    assert pa["PEEQ"].max() > 0.005
    assert np.allclose(pa["PEEQ"], pb["PEEQ"], atol=1e-9)
    sa = pa["S"]
    full = np.empty((*sa.shape[:2], 2, 2))
    full[..., 0, 0], full[..., 1, 1] = sa[..., 0], sa[..., 1]
    full[..., 0, 1] = full[..., 1, 0] = sa[..., 3]
    turned = R @ full @ R.T
    assert np.allclose(pb["S"][..., 0], turned[..., 0, 0], atol=1e-6)
    assert np.allclose(pb["S"][..., 3], turned[..., 0, 1], atol=1e-6)
    for name in ("ALLSE", "ALLPD", "ALLWK", "ALLTH"):
        assert fb.scalars[name] == pytest.approx(fa.scalars[name], rel=1e-7, abs=1e-10)


def test_metres_and_millimetres() -> None:
    """The same part in SI and in micrometre-like units: factors of length, force, energy only."""
    base = ct.mesh.rectangle(5.0, 1.0, nx=6, ny=2, cell="quad8")
    a = ct.solve(gripper(base, 0.0, (1.0, 1.0)), ct.Static(increments=6), threads=1).frames[-1]
    for length, force in ((1e-3, 1.0), (1e6, 1e-3), (1e-6, 1e-9)):
        mesh = ct.mesh.move(base, scale=length)
        model = gripper(mesh, 0.0, (length, force))
        b = ct.solve(model, ct.Static(increments=6), threads=1).frames[-1]
        assert np.allclose(b.U / length, a.U, atol=1e-8)
        assert np.allclose(b.RF / force, a.RF, atol=1e-7)
        for name in ("ALLSE", "ALLPD", "ALLWK"):
            assert b.scalars[name] / (length * force) == pytest.approx(a.scalars[name], rel=1e-7)


def test_renumbered_model() -> None:
    """Shuffled numbers of nodes and cells: every field moves with its node."""
    base = ct.mesh.rectangle(5.0, 1.0, nx=6, ny=2, cell="quad8")
    a = ct.solve(gripper(base, 0.0, (1.0, 1.0)), ct.Static(increments=6), threads=1)
    mesh = ct.mesh.renumber(base, seed=11)
    b_model = gripper(mesh, 0.0, (1.0, 1.0))
    corner = int(np.argmin(np.hypot(*mesh.points.T)))
    b_model.supports.pop()
    b_model.supports.pop()
    b_model.fix([corner])
    b = ct.solve(b_model, ct.Static(increments=6), threads=1)
    order = [int(np.argmin(np.hypot(*(mesh.points - x).T))) for x in base.points]
    assert np.allclose(b.frames[-1].U[order], a.frames[-1].U, atol=1e-9)
    assert np.allclose(b.nodal("S11")[order], a.nodal("S11"), atol=1e-6)
    assert np.allclose(b.frames[-1].RF[order], a.frames[-1].RF, atol=1e-7)


@pytest.mark.parametrize("element", CELL)
def test_mirrored_model_gives_mirrored_results(element: str) -> None:
    """A mirror image (x to -x) with pressure, moment at a rigid end and orthotropy turned over."""
    frames = []
    for sign in (1.0, -1.0):
        mesh = ct.mesh.rectangle(5.0, 1.0, nx=5, ny=2, cell=CELL[element], diagonal="right")
        if sign < 0:
            mesh = ct.mesh.rectangle(
                5.0, 1.0, nx=5, ny=2, cell=CELL[element], diagonal="left", origin=(-5.0, 0.0)
            )
        near, far = ("left", "right") if sign > 0 else ("right", "left")
        end = ct.mesh.add_node(mesh, sign * 5.5, 0.5, "ref")
        model = ct.Model(mesh)
        wood = ct.Orthotropic(900.0, 300.0, 300.0, 0.3, 0.3, 0.3, 200.0)
        model.section(
            "all", element=element, material=wood, thickness=1.4, orientation=sign * 0.5,
            local_strain="green_lagrange",
        )  # fmt: skip
        model.fix(near, rotation=True if element in DRILLING else None)
        model.rigid(far, end)
        model.force([end], moment=sign * 4.0, y=0.3, x=-sign * 0.5)
        model.pressure("bottom", 0.2)
        frames.append((mesh, end, ct.solve(model, ct.Static(increments=6), threads=1).frames[-1]))
    (m0, e0, f0), (m1, e1, f1) = frames
    order = [int(np.argmin(np.hypot(*(m1.points - x * [-1, 1]).T))) for x in m0.points]
    assert np.allclose(f1.U[order] * [-1, 1], f0.U, atol=1e-8 * np.abs(f0.U).max() * 10)
    assert f1.UR[e1] == pytest.approx(-f0.UR[e0], rel=1e-7)
    assert np.abs(f0.U).max() > 0.5


# --- Zero, tiny and bad input ---


@pytest.mark.parametrize("element", CELL)
def test_nothing_applied_gives_nothing(element: str) -> None:
    """Zero force, pressure, heat and moves, elastic-plastic: zeros everywhere, and finite."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    steel = ct.Mises(E=2000.0, nu=0.3, yield_stress=8.0, expansion=1e-5)
    model.section("all", element=element, material=steel, local_strain="logarithmic")
    model.fix("left")
    model.force("right", y=0.0, per_node=True)
    model.pressure("top", 0.0)
    model.temperature(0.0)
    results = ct.solve(model, [ct.Static(), ct.Static(increments=2)], threads=1)
    for f in results.frames:
        assert not np.any(f.U)
        assert not np.any(f.fields[0].values["S"])
        assert np.abs(f.RF).max() < 1e-28
        assert all(np.isfinite(v) for v in f.scalars.values())


@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q4D", "OPT"])
@pytest.mark.parametrize("size", [1e-12, 1e-20])
def test_tiny_loads_are_linear(element: str, size: float) -> None:
    """Under NLGEOM a load of 1e-12 or 1e-20 gives the linear answer times it, to nine digits."""
    ends = []
    for load, nlgeom in ((1.0, False), (size, True)):
        mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=CELL[element])
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=2000.0, nu=0.3))
        model.fix("left")
        model.force("right", y=load, x=0.3 * load, per_node=True)
        f = ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1).frames[-1]
        ends.append((f.U / load, f.RF / load, f.fields[0].values["S"] / load))
    for a, b in zip(*ends, strict=True):
        assert np.allclose(a, b, rtol=1e-8, atol=1e-8 * np.abs(a).max())


BAD = [math.nan, math.inf, -math.inf]


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize(
    "what",
    [
        "force", "moment", "pressure", "traction", "gravity", "omega", "about", "fix", "rotation",
        "thickness", "E", "nu", "yield", "temperature", "initial temperature", "initial stress",
        "expansion", "equation", "rhs", "spring", "area", "amplitude", "curve",
        "beta0", "weights", "clearance", "friction", "period", "rho", "orientation", "local axes",
        "point",
    ],
)  # fmt: skip
def test_numbers_that_are_none_are_refused(what: str, bad: float) -> None:
    """NaN and infinity anywhere in the model end in an error of input, not in a result."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell="quad4")
    if what in ("spring", "area"):
        mesh.cells.append(Cells("line2", np.array([[0, 1]]), np.array([9])))

    def build(mesh: Any) -> None:
        if what == "point":
            mesh.points = np.where(mesh.points == 2.0, bad, mesh.points)
        model = ct.Model(mesh)
        options: dict[str, Any] = {"thickness": bad} if what == "thickness" else {}
        if what == "orientation":
            options["orientation"] = bad
        if what == "beta0":
            mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell="tri3")
            model = ct.Model(mesh)
            model.section("all", element="OPT", material=ct.Elastic(E=1.0), beta0=bad)
        material: Any = ct.Elastic(
            E=bad if what == "E" else 100.0,
            nu=bad if what == "nu" else 0.3,
            rho=bad if what == "rho" else 1.0,
            expansion=bad if what == "expansion" else 1e-5,
        )
        if what == "yield":
            material = ct.Mises(E=100.0, nu=0.3, yield_stress=bad)
        if what == "curve":
            material = ct.Mises(E=100.0, nu=0.3, yield_curve=[(1.0, 0.0), (2.0, bad)])
        cells: Any = [0, 1] if what in ("spring", "area") else "all"
        if what != "beta0":
            model.section(cells, element="Q4I", material=material, **options)
        model.fix("left", x=0.0)
        amplitude = ""
        if what == "amplitude":
            model.amplitudes["a"] = ct.Amplitude(np.array([0.0, 1.0]), np.array([0.0, bad]))
            amplitude = "a"
        model.force("right", y=bad if what == "force" else 0.1, amplitude=amplitude, per_node=True)
        apply: dict[str, Any] = {
            "moment": lambda: model.force([1], moment=bad),
            "pressure": lambda: model.pressure("top", bad),
            "traction": lambda: model.traction("top", y=bad),
            "gravity": lambda: model.gravity(y=bad),
            "omega": lambda: model.centrifugal(bad),
            "about": lambda: model.centrifugal(1.0, about=(bad, 0.0)),
            "fix": lambda: model.fix("right", x=bad),
            "rotation": lambda: model.fix("right", rotation=bad),
            "temperature": lambda: model.temperature(bad),
            "initial temperature": lambda: model.initial_temperature(bad),
            "initial stress": lambda: model.initial_stress(xx=bad),
            "equation": lambda: model.equation((2, "x", 1.0), (5, "x", bad)),
            "rhs": lambda: model.equation((2, "x", 1.0), (5, "x", 1.0), rhs=bad),
            "spring": lambda: model.spring([2], bad),
            "area": lambda: model.truss([2], material=ct.Elastic(E=1.0), area=bad),
            "local axes": lambda: model.local_axes("left", angle=bad),
            "weights": lambda: model.couple("right", 0, kind="distributing", weights=[1.0, bad]),
            "clearance": lambda: model.contact("top", "bottom", clearance=bad),
            "friction": lambda: model.contact("top", "bottom", friction=bad),
        }
        if what in apply:
            apply[what]()
        ct.solve(model, ct.Static(period=bad if what == "period" else 1.0), threads=1)

    with pytest.raises(ct.CorotaError) as caught:
        build(mesh)
    assert not isinstance(caught.value, ct.ConvergenceError), caught.value


@pytest.mark.parametrize(
    "what", ["force", "fix", "pressure", "section", "gravity", "temperature", "rigid"]
)
def test_empty_sets_are_refused(what: str) -> None:
    """A set without members in Python is an error, not a load that vanishes."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    mesh.node_sets["void"] = np.array([], dtype=int)
    mesh.edge_sets["voids"] = np.empty((0, 2), dtype=int)
    mesh.cell_sets["voidc"] = np.array([], dtype=int)
    model = ct.Model(mesh)

    def build() -> None:
        model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.3))
        if what == "section":
            model.section("voidc", element="Q4", material=ct.Elastic(E=100.0, nu=0.3))
        model.fix("left")
        model.force("right", y=0.1, per_node=True)
        if what == "force":
            model.force("void", y=1.0)
        if what == "fix":
            model.fix("void")
        if what == "pressure":
            model.pressure("voids", 1.0)
        if what == "gravity":
            model.gravity(y=1.0, cells="voidc")
        if what == "temperature":
            model.temperature(3.0, "void")
        if what == "rigid":
            model.rigid("void", 5)
        ct.solve(model, ct.Static(), threads=1)

    with pytest.raises(ct.CorotaError):
        build()


# --- Trusses, beams, springs ---


def line_mesh(points: np.ndarray, pairs: list[tuple[int, int]]) -> Any:
    from corota.mesh import Mesh

    cells = [Cells("line2", np.array(pairs), np.arange(1, len(pairs) + 1))]
    return Mesh(np.asarray(points, float), cells, np.arange(1, len(points) + 1))


def test_prestressed_string_with_a_large_load(tmp_path: Path) -> None:
    """Two bars with initial stress, a side load, heat: N = A s0 + EA (l/L - 1 - alpha T), exactly.

    Equilibrium in one unknown, P = 2 N v/l; solved by bracketing.
    """
    text = """*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
*ELEMENT, TYPE=T3D2, ELSET=all
1, 1, 2
2, 2, 3
*MATERIAL, NAME=m
*ELASTIC
1000., 0.
*EXPANSION
1e-3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.2
*INITIAL CONDITIONS, TYPE=STRESS
all, 30.
*NSET, NSET=every, ELSET=all
*BOUNDARY
1, 1, 2
3, 1, 2
*STEP, NLGEOM
*STATIC
0.25, 1.
*CLOAD
2, 2, 40.
*TEMPERATURE
every, 10.
*END STEP
"""
    frame = run(tmp_path / "s.inp", text).frames[-1]

    def gap(v: float) -> float:
        long = math.hypot(1.0, v)
        return 2 * (0.2 * 30.0 + 200.0 * (long - 1 - 0.01)) * v / long - 40.0

    v = brentq(gap, 0.01, 2.0)
    assert frame.U[1, 1] == pytest.approx(v, rel=1e-8)
    force = 6.0 + 200.0 * (math.hypot(1.0, v) - 1.01)
    values = frame.fields[0].values
    assert np.allclose(values["N"].ravel(), force, rtol=1e-7)
    assert np.allclose(values["S"][..., :2].sum(axis=-1), force / 0.2, rtol=1e-7)
    assert frame.RF[0, 0] == pytest.approx(-force / math.hypot(1, v), rel=1e-7)


def test_section_forces_of_a_far_bent_beam() -> None:
    """N, V, M1, M2 of beams in an elastica under a dead tip load, by statics of the free end.

    At each node the tip force through its current arm; N along, V across the chord of the beam.
    """
    n, L, _EI, P = 40, 2.0, 3.0, np.array([-1.5, 6.0])
    x = np.linspace(0, L, n + 1)
    mesh = line_mesh(np.column_stack([x, 0 * x]), [(i, i + 1) for i in range(n)])
    model = ct.Model(mesh)
    model.beam(list(range(n)), material=ct.Elastic(E=3e4), area=0.1, inertia=1e-4)
    model.fix([0], rotation=True)
    model.force([n], x=P[0], y=P[1])
    frame = ct.solve(model, ct.Static(increments=5), threads=1).frames[-1]
    pos = mesh.points + frame.U
    values = frame.fields[0].values
    N, V = values["N"].ravel(), values["V"].ravel()
    M1, M2 = values["M1"].ravel(), values["M2"].ravel()
    assert frame.U[n, 1] > 1.2
    for i in range(n):
        e = (pos[i + 1] - pos[i]) / np.linalg.norm(pos[i + 1] - pos[i])
        arm0, arm1 = pos[n] - pos[i], pos[n] - pos[i + 1]
        m0 = arm0[0] * P[1] - arm0[1] * P[0]
        m1 = arm1[0] * P[1] - arm1[1] * P[0]
        assert N[i] == pytest.approx(P @ e, rel=1e-6, abs=1e-6)
        # The load bends upwards and stretches the lower side, on the right of the way.
        assert M1[i] == pytest.approx(m0, rel=1e-5, abs=1e-6)
        assert M2[i] == pytest.approx(m1, rel=1e-5, abs=1e-6)
        across = -P[0] * e[1] + P[1] * e[0]
        assert abs(V[i]) == pytest.approx(abs(across), rel=1e-5, abs=1e-5)
    clamp = pos[n, 0] * P[1] - pos[n, 1] * P[0]
    assert frame.RF[0, 2] == pytest.approx(-clamp, rel=1e-7)


def test_nonlinear_springs_in_series_with_the_ground() -> None:
    """A table spring between two nodes and one to the ground; constant force outside the table."""
    from corota.mesh import Mesh

    cells = [
        Cells("line2", np.array([[0, 1]]), np.array([1])),
        Cells("point1", np.array([[0]]), np.array([2])),
    ]
    mesh = Mesh(np.array([[0.0, 0.0], [3.0, 0.0]]), cells, np.array([1, 2]))
    model = ct.Model(mesh)
    model.spring([0], [(-1.0, -5.0), (0.0, 0.0), (0.5, 4.0), (1.0, 5.0)])
    model.spring([1], 20.0, "x")
    model.fix([0], x=None)
    model.fix([1], x=2.0)
    results = ct.solve(model, ct.Static(increments=20), threads=1)
    for f in results.frames[1:]:
        u = f.U[1, 0]

        def balance(a: float, u: float = u) -> float:
            return float(np.interp(u - a, [-1, 0, 0.5, 1], [-5, 0, 4, 5])) - 20.0 * a

        a = brentq(balance, -1.0, 2.0)
        assert f.U[0, 0] == pytest.approx(a, rel=1e-8)
        assert f.RF[1, 0] == pytest.approx(20.0 * a, rel=1e-8)


# --- Paths, limit loads and buckling ---


@pytest.mark.parametrize("preload", [0.0, 1.5])
def test_shallow_truss_with_a_preload_kept(preload: float) -> None:
    """Snap-through of two bars with engineering strain; a dead preload of an earlier step stays.

    F(v) = 2 EA (L - l)/L (h - v)/l; a later load on the same node replaces the preload.
    """
    EA, a, h = 1000.0, 2.0, 0.5
    L = math.hypot(a, h)

    def force(v: float) -> float:
        long = math.hypot(a, h - v)
        return 2 * EA * (L - long) / L * (h - v) / long

    grid = np.linspace(0.0, h, 20001)
    peak = max(force(v) for v in grid)
    mesh = line_mesh([[-a, 0.0], [0.0, h], [a, 0.0]], [(0, 1), (1, 2)])
    model = ct.Model(mesh)
    model.truss([0, 1], material=ct.Elastic(E=EA / 0.5), area=0.5)
    model.fix([0, 2])
    from corota.model.loads import NodalForce

    steps = []
    if preload:
        steps.append(ct.Static(loads=[NodalForce([1], 1, -preload)]))
    path = ct.ArcLength(displacement=([1], "y", -1.2 * h))
    steps.append(
        ct.Static(loads=[NodalForce([1], 0, 0.0), NodalForce([1], 1, -4.0 - preload)], path=path)
    )
    results = ct.solve(model, steps, threads=1)
    first = next(c for c in results.critical_points if c.kind == "limit")
    # The factor leads from the old value to the new.
    assert preload + 4.0 * first.factor == pytest.approx(peak, rel=1e-6)
    for f in results.frames:
        v = -f.U[1, 1]
        if f.increment:
            total = preload * (f.factor if f.step == 1 and preload else 1.0)
            if f.step == len(steps):
                total = preload + 4.0 * f.factor
            assert total == pytest.approx(force(v), rel=1e-6, abs=1e-6)


def test_thermal_buckling_of_a_clamped_beam_with_preload() -> None:
    """alpha T EA + N0 = 4 pi^2 EI/L^2 for beams; a compressive preload lowers the factor.

    Preload by an earlier step that moves an end; the moved end is then held.
    """
    n, L, E, A, inertia, alpha = 80, 2.0, 2e4, 0.01, 1e-6, 1e-5
    x = np.linspace(0, L, n + 1)
    mesh = line_mesh(np.column_stack([x, 0 * x]), [(i, i + 1) for i in range(n)])
    critical = 4 * math.pi**2 * E * inertia / L**2
    for share in (0.0, 0.4):
        model = ct.Model(mesh)
        model.beam(
            list(range(n)), material=ct.Elastic(E=E, expansion=alpha), area=A, inertia=inertia
        )
        model.fix([0], rotation=True)
        model.fix([n], x=None, rotation=True)
        move = -share * critical * L / (E * A)
        steps = [
            ct.Static(supports=[Fixed([n], 0, move)], increments=1),
            ct.Buckle(loads=[Temperature("", 1.0)]),
        ]
        results = ct.solve(model, steps, threads=1)
        want = (1 - share) * critical / (E * A * alpha)
        assert results.modes[0].factors[0] == pytest.approx(want, rel=2e-3)


@pytest.mark.parametrize("element", ["Q8R", "Q4I", "Q4S"])
def test_yield_of_two_thicknesses_in_series_in_a_turned_frame(element: str) -> None:
    """A tension bar of two thicknesses at 55 degrees yields where it is thin.

    Small strain, hardening 1: elongation s1/E + p + s2/E with s1 = sy + p, s2 = s1 t1/t2.
    Equations in the turned axes join them along the bar only, so that both contract freely.
    """
    low = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell=CELL[element])
    high = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell=CELL[element], origin=(1.0, 0.0))
    mesh = ct.mesh.move(ct.mesh.assembly(low=low, high=high), angle=55.0)
    start, ends = mesh.nodes_of("low.left"), mesh.nodes_of("high.right")
    model = ct.Model(mesh)
    steel = ct.Mises(E=1000.0, nu=0.3, yield_stress=2.0, isotropic=1.0)
    model.section("low", element=element, material=steel, thickness=0.5)
    model.section("high", element=element, material=steel, thickness=0.8)
    model.local_axes(np.arange(mesh.n_nodes), angle=math.radians(55.0))
    for n, m in zip(mesh.nodes_of("low.right"), mesh.nodes_of("high.left"), strict=True):
        assert np.allclose(mesh.points[n], mesh.points[m])
        model.equation((int(n), "x", 1.0), (int(m), "x", -1.0))
    model.fix(start, y=None)
    model.fix([int(start[0])])
    model.fix([int(ends[0])], x=None)
    model.fix(ends, x=0.02, y=None)
    frame = ct.solve(model, ct.Static(nlgeom=False, increments=8), threads=1).frames[-1]
    p = (0.02 - 2.0 / 1000.0 * 1.625) / (1 + 1.625 / 1000.0)
    axis = rotation(math.radians(55.0))[:, 0]
    pull = axis @ frame.RF[ends, :2].sum(axis=0)
    assert pull == pytest.approx((2.0 + p) * 0.5, rel=1e-8)
    other = frame.fields[1].values["S"][0, 0]
    assert other[0] == pytest.approx((2.0 + p) * 0.5 / 0.8 * axis[0] ** 2, rel=1e-8)
    assert np.allclose(frame.fields[0].values["PEEQ"], p, rtol=1e-6)
    assert frame.scalars["ALLPD"] == pytest.approx((2.0 * p + p**2 / 2) * 0.5, rel=1e-6)


# --- Ties, contact, files in local axes ---


@pytest.mark.parametrize("pair", [("CPE8", "quad8"), ("T6", "tri6"), ("Q4I", "quad4")])
@pytest.mark.parametrize("angle", [0.0, 120.0])
def test_tied_halves_of_unlike_meshes_and_thickness(pair: tuple[str, str], angle: float) -> None:
    """Tension across a tie, thickness 1 and 2, nu = 0: the force passes, stress halves.

    Turned by 120 degrees through supports in turned axes.
    """
    name, cell = pair
    element = {"CPE8": "Q8"}.get(name, name)
    low = ct.mesh.rectangle(2.0, 1.0, nx=3, ny=2, cell=cell)
    high = ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2, cell=cell, origin=(0.0, 1.0))
    mesh = ct.mesh.move(ct.mesh.assembly(low=low, high=high), angle=angle)
    model = ct.Model(mesh)
    material = ct.Elastic(E=100.0, nu=0.0)
    model.section("low", element=element, material=material, thickness=1.0)
    model.section("high", element=element, material=material, thickness=2.0)
    model.tie("high.bottom", "low.top")
    a = math.radians(angle)
    for s in ("low.bottom", "high.top"):
        model.local_axes(s, angle=a)
    model.fix("low.bottom", x=None)
    model.fix([int(mesh.nodes_of("low.bottom")[0])])
    model.fix("high.top", x=None, y=0.03)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    # Springs in series: 100 * 2 * (1 | 2) / 1
    force = 0.03 / (1 / 200.0 + 1 / 400.0)
    n = rotation(a)[:, 1]
    assert n @ frame.RF[mesh.nodes_of("high.top"), :2].sum(axis=0) == pytest.approx(force, rel=1e-8)
    for k, stress in ((0, force / 2.0), (1, force / 4.0)):
        S = frame.fields[k].values["S"]
        assert np.allclose(S[..., 0], stress * n[0] ** 2, atol=1e-7)
        assert np.allclose(S[..., 3], stress * n[0] * n[1], atol=1e-7)


def test_contact_of_two_thicknesses(tmp_path: Path) -> None:
    """Two blocks pressed together: CF sums to the force, CPRESS is force over the smaller area.

    The supports carry the same; a straight interface, nu = 0.
    """
    low = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    high = ct.mesh.rectangle(2.0, 1.0, nx=3, ny=1, origin=(0.0, 1.0))
    mesh = ct.mesh.assembly(low=low, high=high)
    for thin in ("low", "high"):
        model = ct.Model(mesh)
        for body in ("low", "high"):
            model.section(
                body, element="Q4I", material=ct.Elastic(E=100.0, nu=0.0),
                thickness=1.0 if body == thin else 3.0,
            )  # fmt: skip
        model.contact("high.bottom", "low.top", name="joint")
        model.fix("low.bottom")
        model.fix("high.top", y=-0.03)
        model.fix("high", x=0.0, y=None)
        results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
        force = 0.03 / (1 / 200.0 + 1 / 600.0)
        slave = mesh.nodes_of("high.bottom")
        assert np.allclose(results.nodal("CPRESS")[slave], force / 2.0, rtol=1e-7)
        assert results.history("joint: force y")[-1] == pytest.approx(force, rel=1e-7)
        assert results.frames[-1].RF[mesh.nodes_of("low.bottom"), 1].sum() == pytest.approx(
            force, rel=1e-7
        )


# --- Beside CalculiX ---

TWO_CELLS = """*NODE, NSET=nall
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.2
7, .5, 0.
8, 1.5, 0.
9, 0., .5
10, 1., .5
11, 2., .6
12, .5, 1.
13, 1.5, 1.1
*ELEMENT, TYPE=CPE8R, ELSET=all
1, 1, 2, 5, 4, 7, 10, 12, 9
2, 2, 3, 6, 5, 8, 11, 13, 10
*NSET, NSET=left
1, 4, 9
*MATERIAL, NAME=m
*ELASTIC
1000., 0.3
*PLASTIC
2., 0.
3., 0.02
3.5, 0.1
*EXPANSION
1e-4
*SOLID SECTION, ELSET=all, MATERIAL=m
0.5
*INITIAL CONDITIONS, TYPE=TEMPERATURE
nall, 0.
"""


def test_plastic_steps_with_heat_beside_calculix(tmp_path: Path) -> None:
    """Pull beyond yield, then press while heating (OP=NEW), plane strain: CalculiX 2.20, CPE8R.

    Ten equal increments a step in both; its own tolerance leaves about 1e-4.
    """
    text = (
        TWO_CELLS
        + """*BOUNDARY
left, 1, 1
1, 2, 2
*STEP
*STATIC, DIRECT
0.1, 1.
*DLOAD
2, P2, -1.6
1, P3, 0.5
*END STEP
*STEP
*STATIC, DIRECT
0.1, 1.
*DLOAD, OP=NEW
2, P2, 1.9
*TEMPERATURE
nall, 15.
*END STEP
"""
    )
    results = run(tmp_path / "c.inp", text)
    reference: dict[int, Any] = {
        1: {
            "U": {
                3: (-0.004014733, -0.07244893),
                5: (0.03171075, -0.03562519),
                6: (0.04697514, -0.0763323),
                12: (0.02242482, -0.02334716),
            },
            "S": {
                (1, 1): (0.7162174, -0.7554172, -0.01620935, -0.9928418),
                (1, 3): (3.123783, -0.4505465, 1.324842, 0.2041658),
                (2, 1): (1.358197, 0.6458243, 0.6012064, -0.02440676),
                (2, 3): (2.326087, -0.07752677, 0.8887819, 0.02440677),
            },
            "PEEQ": {
                (1, 1): 0.002808864,
                (1, 2): 0,
                (1, 3): 0.03849852,
                (1, 4): 0.01297605,
                (2, 1): 0,
                (2, 2): 0,
                (2, 3): 0.001905923,
                (2, 4): 0,
            },
        },
        2: {
            "U": {
                3: (-0.003866604, -0.06047854),
                5: (0.02649996, -0.0269135),
                6: (0.03516075, -0.05854897),
                12: (0.01977381, -0.01754563),
            },
            "S": {
                (1, 1): (-1.490185, 0.2531232, -1.875568, -0.1915636),
                (1, 3): (-3.069815, 0.08643617, -1.872143, 0.1915636),
                (2, 1): (-1.612859, 0.3441812, -1.637797, 0.2702725),
                (2, 3): (-2.762169, -0.3319421, -1.910641, -0.2702878),
            },
            "PEEQ": {
                (1, 1): 0.002808864,
                (1, 2): 0,
                (1, 3): 0.03849852,
                (1, 4): 0.01342606,
                (2, 1): 0.0004898666,
                (2, 2): 4.674788e-05,
                (2, 3): 0.003730374,
                (2, 4): 0.001792295,
            },
        },
    }
    for step in (1, 2):
        frame = [f for f in results.frames if f.step == step][-1]
        for node, want in reference[step]["U"].items():
            assert np.allclose(frame.U[node - 1], want, atol=1e-5)
        values = frame.fields[0].values
        for (e, q), want in reference[step]["S"].items():
            assert np.allclose(values["S"][e - 1, q - 1], want, atol=8e-4)
        for (e, q), want in reference[step]["PEEQ"].items():
            assert values["PEEQ"][e - 1, q - 1] == pytest.approx(want, abs=4e-6)


# --- More of loads, materials and constraints ---


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
        "all", element=element, material=ct.Elastic(E=300.0, nu=0.2), thickness=0.2,
        plane="strain", local_strain="logarithmic",
    )  # fmt: skip
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


@pytest.mark.parametrize("angle", [0.0, 20.0, 45.0, 90.0])
@pytest.mark.parametrize("element", ["Q4I", "Q8", "T6", "Q9", "Q4S"])
def test_off_axis_tension_of_a_lamina(element: str, angle: float) -> None:
    """Strains of an orthotropic strip under traction at an angle: Jones eq. 2.91 and on.

    Thickness 0.3; both coupling coefficients from the rotated compliance.
    """
    E1, E2, n12, G = 130.0, 9.0, 0.28, 5.0
    mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 2.0, nx=4, ny=2, cell=CELL[element]), 0.15)
    model = ct.Model(mesh)
    lamina = ct.Orthotropic(E1, E2, E2, n12, n12, 0.4, G)
    a = math.radians(angle)
    model.section("all", element=element, material=lamina, orientation=a, thickness=0.3)
    corner = int(np.argmin(mesh.points.sum(axis=1)))
    other = int(np.argmin(mesh.points[:, 0] - mesh.points[:, 1]))
    model.fix([corner])
    model.fix([other], y=None)
    model.traction("right", x=0.02)
    model.traction("left", x=-0.02)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    c, s = math.cos(a), math.sin(a)
    local = 0.02 * np.array([c * c, s * s, -s * c])
    S = np.array([[1 / E1, -n12 / E1, 0], [-n12 / E1, 1 / E2, 0], [0, 0, 1 / G]])
    e1, e2, g = S @ local
    R = rotation(a)
    strain = R @ np.array([[e1, g / 2], [g / 2, e2]]) @ R.T
    E = frame.fields[0].values["E"]
    for k, want in ((0, strain[0, 0]), (1, strain[1, 1]), (3, 2 * strain[0, 1])):
        assert np.allclose(E[..., k], want, rtol=1e-8, atol=1e-12)
    assert np.allclose(
        frame.fields[0].values["E"][..., 2], -(n12 / E1 * local[0] + 0.4 / E2 * local[1]), rtol=1e-8
    )


def test_python_model_and_its_deck_agree(tmp_path: Path) -> None:
    """A written deck of an orthotropic, heated, loaded, turned part gives the results of Python."""
    from corota.io import formats

    mesh = ct.mesh.rectangle(5.0, 1.0, nx=5, ny=2, cell="quad8")
    model = ct.Model(mesh, name="part")
    wood = ct.Orthotropic(
        900.0, 300.0, 250.0, 0.3, 0.25, 0.2, 150.0, rho=0.1, expansion=(1e-4, 2e-4, 0.0)
    )
    model.section(
        "all", element="Q8R", material=wood, thickness=0.7, plane="strain", orientation=0.6,
        local_strain="logarithmic",
    )  # fmt: skip
    model.fix("left")
    model.initial_temperature(5.0)
    model.temperature(30.0)
    model.gravity(0.1, -0.5)
    model.pressure("top", 0.2)
    model.traction("right", x=0.3, y=0.1)
    model.force([int(mesh.nodes_of("right")[1])], y=0.05)
    want = ct.solve(model, ct.Static(increments=2), threads=1).frames[-1]
    path = tmp_path / "part.inp"
    formats.write(model, path)
    again = ct.read(path)
    got = ct.solve(again, None if again.steps else ct.Static(increments=2), threads=1).frames[-1]
    assert np.allclose(got.U, want.U, atol=1e-7)


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


@pytest.mark.parametrize("strain", ["linear", "logarithmic"])
@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_laws_that_must_agree(strain: str, plane: str) -> None:
    """Elastic, J2 below yield, orthotropic with equal constants and a Python law: one answer."""
    E, nu = 700.0, 0.3

    def law(strain: np.ndarray, state: np.ndarray, kind: str) -> tuple[Any, ...]:
        if kind == "stress":
            C = E / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
        else:
            k = E / (1 + nu) / (1 - 2 * nu)
            C = k * np.array([[1 - nu, nu, 0], [nu, 1 - nu, 0], [0, 0, 0.5 - nu]])
        extra = {"strain_zz": -nu / (1 - nu) * (strain[..., 0] + strain[..., 1])}
        if kind == "strain":
            extra = {"stress_zz": nu * ((strain @ C)[..., 0] + (strain @ C)[..., 1])}
        return strain @ C, np.broadcast_to(C, (*strain.shape, 3)), state, extra

    G = E / (2 + 2 * nu)
    laws = [
        ct.Elastic(E=E, nu=nu),
        ct.Mises(E=E, nu=nu, yield_stress=1e6),
        ct.Orthotropic(E, E, E, nu, nu, nu, G),
        ct.UserMaterial(law),
    ]
    ends = []
    for material in laws:
        mesh = ct.mesh.rectangle(6.0, 1.0, nx=6, ny=2, cell="quad4")
        model = ct.Model(mesh)
        model.section(
            "all", element="Q4I", material=material, thickness=1.3, plane=plane,
            local_strain=strain, orientation=0.4 if material is laws[2] else 0.0,
        )  # fmt: skip
        model.fix("left")
        model.force("right", y=0.9, x=-0.4, per_node=True)
        model.pressure("top", 0.2)
        ends.append(ct.solve(model, ct.Static(increments=5), threads=1))
    for other in ends[1:]:
        assert np.allclose(other.frames[-1].U, ends[0].frames[-1].U, atol=1e-6)
        a, b = (r.frames[-1].fields[0].values["S"] for r in (ends[0], other))
        assert np.allclose(a, b, atol=1e-5)
        assert other.history("ALLSE")[-1] == pytest.approx(ends[0].history("ALLSE")[-1], rel=1e-3)


def test_formats_hold_the_same_displacements(tmp_path: Path) -> None:
    """.vtkhdf, .npz, .vtu, .csv and .dat written from one result agree."""
    mesh = ct.mesh.rectangle(3.0, 1.0, nx=3, ny=1, cell="quad9")
    model = ct.Model(mesh)
    model.section("all", element="Q9", material=ct.Elastic(E=100.0, nu=0.3), thickness=2.0)
    model.fix("left")
    model.force("right", y=0.3, per_node=True)
    results = ct.solve(model, ct.Static(increments=3), threads=1)
    with ct.read_results(results.write(tmp_path / "a.vtkhdf", points=True)) as stored:
        assert np.allclose(stored.frame(2).U, results.frames[2].U, rtol=1e-14)
        assert np.allclose(stored.nodal("MISES"), results.nodal("MISES"), rtol=1e-10)
    archive = np.load(results.write(tmp_path / "a.npz"))
    want = results.frames[-1].U
    fields = [archive[k] for k in archive.files if archive[k].dtype.kind == "f"]
    shown = [f[-1][..., :2] for f in fields if f.ndim == 3 and f.shape[1] == mesh.n_nodes]
    assert any(np.allclose(f, want, rtol=1e-12) for f in shown if f.shape == want.shape)
    import csv

    with results.write(tmp_path / "a.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) in (3, 4)
    assert float(rows[-1]["ALLWK"]) == pytest.approx(results.history("ALLWK")[-1], rel=1e-9)


def test_reduced_integration_as_written(tmp_path: Path) -> None:
    """CPE4R is Q4I by default, Q4R as written; both bend an elastic rectangle exactly alike.

    Deflection of a cantilever under an end moment given by a couple of forces: M L^2/(2 E' I).
    """
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1)
    labels = [int(mesh.node_labels[n]) for n in mesh.nodes_of("right")]
    labels.sort(key=lambda k: mesh.points[k - 1, 1])
    text = (
        deck_mesh(mesh, "CPE4R")
        + f"""*MATERIAL, NAME=m
*ELASTIC
2000., 0.3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.25
*BOUNDARY
left, 1, 1
1, 2, 2
*STEP
*STATIC
*CLOAD
{labels[0]}, 1, 0.1
{labels[1]}, 1, -1.D-1
*END STEP
"""
    )
    want = 0.1 * 100.0 / (2 * 2000.0 / 0.91 * 0.25 / 12)
    for options, element in (({}, "Q4I"), ({"as_written": True}, "Q4R")):
        results = run(tmp_path / "r.inp", text, **options)
        assert results.frames[-1].fields[0].element == element
        n = labels[0] - 1
        assert results.frames[-1].U[n, 1] == pytest.approx(want, rel=1e-8)


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
        nx=5, ny=2, cell="quad8",
    )  # fmt: skip
    for strain in ("logarithmic", "green_lagrange"):
        model = ct.Model(mesh)
        model.section(
            "all", element="Q8", material=ct.Elastic(E=100.0, nu=0.25), plane="strain",
            thickness=0.7, local_strain=strain,
        )  # fmt: skip
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


# --- Less common results ---


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ["Q4I", "Q8", "T3", "Q4D"])
def test_internal_variables_turn_and_thickness_changes(element: str, plane: str) -> None:
    """PE, ALPHA, STH, YRATIO after a turned plastic path: the point program's, turned by the frame.

    PE is the plastic strain along the frame's axes, ALPHA the back-stress; STH = t exp(E33).
    """
    steel = ct.Mises(E=2000.0, nu=0.3, yield_stress=10.0, isotropic=60.0, kinematic=90.0)
    results = drive(element, steel, plane, "logarithmic", PATH[:4])
    frame = results.frames[-1]
    point = Point(2000.0, 0.3, 10.0, 60.0, 90.0, plane)
    for F in PATH[:4]:
        point.move(strain_of(F.T @ F))
    values = frame.fields[0].values
    R = rotation(float(frame.fields[0].frame_rotation[0]))
    pe = R @ point.ep[:2, :2] @ R.T
    assert np.allclose(values["PE"][..., 0], pe[0, 0], rtol=1e-5)
    assert np.allclose(values["PE"][..., 3], 2 * pe[0, 1], rtol=1e-5)
    back = R @ point.beta[:2, :2] @ R.T
    assert np.allclose(values["ALPHA"][..., 0], back[0, 0], rtol=1e-5, atol=1e-7)
    assert np.allclose(values["ALPHA"][..., 3], back[0, 1], rtol=1e-5, atol=1e-7)
    assert np.allclose(values["STH"], 0.7 * math.exp(point.ezz), rtol=1e-8)
    assert np.allclose(values["YRATIO"], 1.0, atol=1e-6)


@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q4S", "Q4R", "Q8", "Q9", "Q4DI"])
@pytest.mark.parametrize("strain", ["linear", "logarithmic"])
def test_heat_account_in_plane_strain(element: str, strain: str) -> None:
    """A free body heated in plane strain stores V (E alpha T)^2/2E by the held direction alone.

    ALLTH is what heat put in; ENER at the points sums to ALLSE; no work of loads.
    """
    E, alpha, T = 500.0, 1e-4, 30.0
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=2, cell=CELL[element])
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=E, nu=0.3, expansion=alpha), plane="strain",
        thickness=0.4, local_strain=strain,
    )  # fmt: skip
    model.fix("left", y=None, rotation=True if element in DRILLING else None)
    model.fix("bottom", x=None, rotation=True if element in DRILLING else None)
    model.temperature(T)
    frame = ct.solve(model, ct.Static(increments=4), threads=1).frames[-1]
    want = 2.0 * 0.4 * (E * alpha * T) ** 2 / (2 * E)
    assert frame.scalars["ALLSE"] == pytest.approx(want, rel=1e-6)
    assert frame.scalars["ALLTH"] == pytest.approx(want, rel=1e-6)
    assert abs(frame.scalars["ALLWK"]) < 1e-9 * want
    field = frame.fields[0]
    assert np.sum(field.values["ENER"] * field.volume) == pytest.approx(want, rel=1e-6)
    assert field.volume.sum() == pytest.approx(0.8, rel=1e-12)


@pytest.mark.parametrize("dead", [False, True])
def test_ring_buckles_under_pressure(dead: bool) -> None:
    """Thin ring: q = 3 E'I/R^3 for pressure that follows, 4 E'I/R^3 for radial dead load.

    Timoshenko and Gere, art. 7.3, and Bresse. A quarter with symmetry; plane strain, E/(1 - nu^2);
    the load is on the outer radius.
    """
    r, h, E, nu, t = 10.0, 0.2, 1e5, 0.3, 0.5
    a, b = r - h / 2, r + h / 2
    mesh = ct.mesh.annulus(a, b, 1, 16, angle=90.0, cell="quad8")
    model = ct.Model(mesh)
    model.section(
        "all", element="Q8R", material=ct.Elastic(E=E, nu=nu), plane="strain", thickness=t
    )
    model.fix("start", x=None)
    model.fix("end", y=None)
    inertia = h**3 / 12
    if dead:
        # Forces of a uniform pressure, fixed in space: read from a linear step with unit pressure.
        model.pressure("outer", 1.0)
        unit = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1].F
        model.loads.clear()
        for n in mesh.nodes_of("outer"):
            model.force([int(n)], x=float(unit[n, 0]), y=float(unit[n, 1]))
    else:
        model.pressure("outer", 1.0)
    factor = ct.solve(model, [ct.Buckle(modes=1)], threads=1).modes[0].factors[0]
    want = (4.0 if dead else 3.0) * E / (1 - nu**2) * inertia / r**3 * (r / b)
    assert factor == pytest.approx(want, rel=1.5e-2)


@pytest.mark.parametrize(
    ("section", "area", "inertia", "shear"),
    [
        ("RECT\n0.2, 0.6\n0., 0., -1.", 0.12, 0.6 * 0.2**3 / 12, 5 / 6),
        ("RECT\n0.2, 0.6\n0., 1., 0.", 0.12, 0.2**3 * 0.6 / 12, 5 / 6),
        ("CIRC\n0.4, 0.4\n0., 0., -1.", math.pi * 0.04, math.pi * 0.2**4 / 4, 0.9),
        (
            "PIPE\n0.3, 0.1\n0., 0., -1.",
            math.pi * (0.09 - 0.04),
            math.pi / 4 * (0.3**4 - 0.2**4),
            0.5,
        ),
    ],
)
def test_beam_sections(
    tmp_path: Path, section: str, area: float, inertia: float, shear: float
) -> None:
    """Tip of a Timoshenko cantilever, P L^3/3EI + P L/(k G A), and its stretch, at 30 degrees.

    RECT has the first size along the first axis: a depth in the plane of 0.6 if that is the normal.
    """
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    text = f"""*NODE
1, 0., 0.
2, {c}, {s}
3, {2 * c}, {2 * s}
*ELEMENT, TYPE=B31, ELSET=all
1, 1, 2
2, 2, 3
*MATERIAL, NAME=m
*ELASTIC
1000., 0.25
*BEAM SECTION, ELSET=all, MATERIAL=m, SECTION={section}
*BOUNDARY
1, 1, 6
*STEP
*STATIC
*CLOAD
3, 1, {-s}
3, 2, {c}
*END STEP
*STEP
*STATIC
*CLOAD, OP=NEW
3, 1, {c}
3, 2, {s}
*END STEP
"""
    results = run(tmp_path / "b.inp", text)
    one, two = ([f for f in results.frames if f.step == k][-1] for k in (1, 2))
    if section.startswith("RECT\n0.2, 0.6\n0., 0."):
        inertia = 0.2 * 0.6**3 / 12
    across = one.U[2] @ [-s, c]
    assert across == pytest.approx(
        8.0 / (3 * 1000.0 * inertia) + 2.0 / (shear * 400.0 * area), rel=1e-9
    )
    assert two.U[2] @ [c, s] == pytest.approx(2.0 / (1000.0 * area), rel=1e-9)
    assert one.RF[0, 2] == pytest.approx(-2.0, rel=1e-9)


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


@pytest.mark.parametrize("label", [999999999, 12345678901, 4500000000000000000])
def test_large_numbers_of_nodes_in_every_file(tmp_path: Path, label: int) -> None:
    """A node number beyond nine digits is whole in .dat, in .csv and in the result file."""
    text = (
        BARS.replace("3, 4., 0.", f"{label}, 4., 0.")
        .replace("2, 2, 3\n", f"2, 2, {label}\n")
        .replace("3, 2, 2", f"{label}, 2, 2")
        + f"""*NSET, NSET=tip
{label}
*STEP
*STATIC
*CLOAD
{label}, 1, 2.
*NODE PRINT, NSET=tip
U
*END STEP
"""
    )
    run(tmp_path / "n.inp", text)
    row = tables(tmp_path / "n.dat")["displacements"][-1]
    lines = (tmp_path / "n.dat").read_text().splitlines()
    assert any(line.split()[:1] == [str(label)] for line in lines)
    assert row[0, 1] == pytest.approx(0.4, rel=1e-6)
    with ct.read_results(tmp_path / "n.vtkhdf") as stored:
        assert int(stored.mesh.node_labels[2]) == label


def test_threads_do_not_matter() -> None:
    """One thread and two give the same numbers to the last digit."""
    mesh = ct.mesh.rectangle(8.0, 2.0, nx=40, ny=10)
    frames = []
    for threads in (1, 2):
        model = ct.Model(mesh)
        steel = ct.Mises(E=2000.0, nu=0.3, yield_stress=4.0, isotropic=50.0)
        model.section("all", element="Q4I", material=steel, local_strain="logarithmic")
        model.fix("left")
        model.pressure("top", 0.08)
        frames.append(ct.solve(model, ct.Static(increments=3), threads=threads).frames[-1])
    assert np.array_equal(frames[0].U, frames[1].U)
    assert np.array_equal(frames[0].fields[0].values["S"], frames[1].fields[0].values["S"])


def test_invariants_of_averages_at_a_joint() -> None:
    """MISES at a node is that of the averaged components; each section apart, or both together.

    Two blocks of unlike stiffness held to a uniform strain: components known in closed form.
    """
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    model = ct.Model(mesh)
    stress = []
    for k, E in enumerate((100.0, 300.0)):
        model.section([k], element="Q4", material=ct.Elastic(E=E, nu=0.25), thickness=1.0 + k)
        C = E / (1 - 0.25**2) * np.array([[1, 0.25, 0], [0.25, 1, 0], [0, 0, 0.375]])
        stress.append(C @ [0.01, -0.002, 0.004])
    for n, (x, y) in enumerate(mesh.points):
        model.fix([n], x=0.01 * x + 0.004 * y, y=-0.002 * y)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    joint = int(np.argmin(np.hypot(mesh.points[:, 0] - 1.0, mesh.points[:, 1])))

    def mises(s: np.ndarray) -> float:
        return math.sqrt(s[0] ** 2 - s[0] * s[1] + s[1] ** 2 + 3 * s[2] ** 2)

    group = results.sections()
    for k in range(2):
        assert results.nodal("MISES", section=int(group[k]))[joint] == pytest.approx(
            mises(stress[k]), rel=1e-9
        )
    mean = (stress[0] + stress[1]) / 2
    assert results.nodal("S11")[joint] == pytest.approx(mean[0], rel=1e-9)
    assert results.nodal("MISES")[joint] == pytest.approx(mises(mean), rel=1e-9)
    e1 = 0.004 + math.hypot(0.006, 0.002)
    assert results.nodal("EP1")[joint] == pytest.approx(e1, rel=1e-6)


def test_heat_drives_a_path_through_snap() -> None:
    """Arc length raises a temperature: two pinned bars rise against a dead load.

    At every increment 2 EA (l/L - 1 - alpha T) y/l balances the load.
    """
    EA, a, h, alpha = 1000.0, 2.0, 0.3, 1e-3
    L = math.hypot(a, h)
    mesh = line_mesh([[-a, 0.0], [0.0, h], [a, 0.0]], [(0, 1), (1, 2)])
    model = ct.Model(mesh)
    model.truss([0, 1], material=ct.Elastic(E=EA / 0.5, expansion=alpha), area=0.5)
    model.fix([0, 2])
    from corota.model.loads import NodalForce

    steps = [
        ct.Static(loads=[NodalForce([1], 1, -0.4)], increments=2),
        ct.Static(loads=[Temperature("", 50.0)], path=ct.ArcLength(factor=1.0)),
    ]
    results = ct.solve(model, steps, threads=1)
    for f in results.frames:
        if f.step == 2 and f.increment:
            y = h + f.U[1, 1]
            long = math.hypot(a, y)
            N = EA * ((long - L) / L - alpha * 50.0 * f.factor)
            assert 2 * N * y / long == pytest.approx(-0.4, rel=1e-6)
    assert results.frames[-1].factor == pytest.approx(1.0, rel=1e-9)


def test_pressure_on_a_line_of_load_control_and_path_agree() -> None:
    """A cantilever under follower pressure: load control and arc length end in one state."""
    ends = []
    for path in (None, ct.ArcLength(factor=1.0), ct.DisplacementControl("right", "y", -1.0)):
        mesh = ct.mesh.rectangle(8.0, 1.0, nx=8, ny=1, cell="quad8")
        model = ct.Model(mesh)
        model.section("all", element="Q8R", material=ct.Elastic(E=900.0, nu=0.3), thickness=0.6)
        model.fix("left")
        model.pressure("top", 0.3)
        step = ct.Static(path=path) if path else ct.Static(increments=4)
        results = ct.solve(model, step, threads=1)
        ends.append(results.frames[-1])
        if isinstance(path, ct.DisplacementControl):
            f = results.frames[-1]
            assert f.U[mesh.nodes_of("right"), 1].mean() == pytest.approx(-1.0, rel=1e-8)
            model.loads.clear()
            model.pressure("top", 0.3 * f.factor)
            again = ct.solve(model, ct.Static(increments=3), threads=1).frames[-1]
            assert np.allclose(again.U, f.U, atol=1e-7)
    assert np.allclose(ends[0].U, ends[1].U, atol=1e-7)


# --- Defects that these checks found, mended ---

TURNED = """*NODE, NSET=nall
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4I, ELSET=all
1, 1, 2, 3, 4
*MATERIAL, NAME=m
*ELASTIC
100., 0.3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.5
*TRANSFORM, NSET=t, TYPE=R
0.8, 0.6, 0., -0.6, 0.8, 0.
*NSET, NSET=t
2, 3
{equation}*BOUNDARY
1, 1, 2
2, 2, 2
4, 2, 2
*STEP
*STATIC
*CLOAD
3, 2, 1.
4, 1, 0.5
*NODE PRINT, NSET=nall, TOTALS=YES
U, RF
*NODE PRINT, NSET=nall, GLOBAL=YES
U, RF
*END STEP
"""


def rows_of(path: Path, head: str) -> list[list[str]]:
    """Rows of text below each heading of a .dat file."""
    found: list[list[str]] = []
    for line in path.read_text().splitlines():
        if line.strip().startswith(head):
            found.append([])
        elif found and line[:10].strip().isdigit():
            found[-1].append(line)
    return found


def test_dat_prints_nodes_in_their_axes(tmp_path: Path) -> None:
    """Rows of nodes with *TRANSFORM are along their axes and end with L, as CalculiX 2.20 writes.

    GLOBAL=YES gives global rows. The held direction has no displacement, the load is (0, 1).
    """
    frame = run(tmp_path / "t.inp", TURNED.format(equation="")).frames[-1]
    own, everywhere = rows_of(tmp_path / "t.dat", "displacements")[:2]
    R = np.array([[0.8, -0.6], [0.6, 0.8]])
    for node in range(4):
        first, second = own[node], everywhere[node]
        assert first.endswith(" L") is (node in (1, 2))
        assert not second.endswith("L")
        got = np.array([float(x) for x in first.split()[1:3]])
        want = frame.U[node] @ R if node in (1, 2) else frame.U[node]
        assert np.allclose(got, want, atol=1e-8)
        assert np.allclose([float(x) for x in second.split()[1:3]], frame.U[node], atol=1e-8)
    forces = rows_of(tmp_path / "t.dat", "forces")[0]
    assert np.allclose([float(x) for x in forces[2].split()[1:3]], [0.0, 1.0], atol=1e-9)
    assert abs(float(forces[1].split()[1])) < 1e-12


def test_dat_forces_hold_those_of_equations(tmp_path: Path) -> None:
    """RF of .dat is the internal force at nodes of an equation too; it sums to nothing.

    CalculiX 2.20 prints -0.0824, 1 (local) and 0.665, 0.241 at nodes 3 and 4 of this deck with its
    own element; internal forces of a body are in balance, whatever the equation adds.
    """
    text = TURNED.format(equation="*EQUATION\n2\n3, 1, 1., 4, 1, -2.\n")
    frame = run(tmp_path / "t.inp", text).frames[-1]
    rows = rows_of(tmp_path / "t.dat", "forces")[1]
    force = np.array([[float(x) for x in r.split()[1:3]] for r in rows])
    assert np.abs(force.sum(axis=0)).max() < 1e-6
    x = rows_of(tmp_path / "t.dat", "forces")[0][2].split()
    local = np.array([float(x[1]), float(x[2])])
    # The equation's force acts along local 1 of node 3 and, doubled, against x at node 4.
    assert local[1] == pytest.approx(1.0, rel=1e-6)
    assert force[3, 0] - 0.5 == pytest.approx(-2.0 * local[0], rel=1e-5)
    assert local[0] != 0.0
    assert np.allclose(frame.RF[2, :2], 0.0, atol=1e-9)


@pytest.mark.parametrize("thin", ["low", "high"])
def test_contact_area_in_dat_is_that_of_the_joint(tmp_path: Path, thin: str) -> None:
    """CF: the normal force over the area is the pressure, whichever side is the thinner."""
    from corota.model.steps import Output

    low = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    high = ct.mesh.rectangle(2.0, 1.0, nx=3, ny=1, origin=(0.0, 1.0))
    mesh = ct.mesh.assembly(low=low, high=high)
    model = ct.Model(mesh, name="joint")
    for body in ("low", "high"):
        model.section(
            body, element="Q4I", material=ct.Elastic(E=100.0, nu=0.0),
            thickness=1.0 if body == thin else 3.0,
        )  # fmt: skip
    model.contact("high.bottom", "low.top", name="joint")
    model.fix("low.bottom")
    model.fix("high.top", y=-0.03)
    model.fix("high", x=0.0, y=None)
    step = ct.Static(nlgeom=False, outputs=[Output("contact print", ("CF",), "joint")])
    results = ct.solve(model, step, observers=[ct.JobFiles(tmp_path)], threads=1)
    numbers = [
        [float(w) for w in line.split()]
        for line in (tmp_path / "joint.dat").read_text().splitlines()
        if (line.startswith("    ") and "E+" in line) or "E-" in line
    ]  # fmt: skip
    area, normal, _ = numbers[-1]
    pressure = results.nodal("CPRESS")[mesh.nodes_of("high.bottom")]
    assert area == pytest.approx(2.0, rel=1e-6)
    assert abs(normal) / area == pytest.approx(pressure[0], rel=1e-6)


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


# --- Rigid parts, gradients, constraints that do work ---


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


@pytest.mark.parametrize("element", ["Q4I", "Q4S", "Q8", "Q8R", "Q9", "Q4DI", "T6"])
def test_temperature_gradient_bends_without_stress(element: str) -> None:
    """Linear temperature over the depth: curvature alpha dT/h, no stress, plane stress.

    Thickness 2; the strip starts at 15 degrees and lies at 40 degrees.
    """
    L, h, alpha, dT = 6.0, 0.5, 1e-5, 60.0
    base = ct.mesh.rectangle(L, h, nx=6, ny=2, cell=CELL[element])
    mesh = ct.mesh.move(base, angle=40.0)
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=2e5, nu=0.3, expansion=alpha), thickness=2.0
    )
    model.local_axes("left", angle=math.radians(40.0))
    corner = int(np.argmin(np.hypot(*base.points.T)))
    top = int(np.argmin(np.hypot(base.points[:, 0], base.points[:, 1] - h)))
    model.fix([corner], rotation=None)
    model.fix([top], y=None)
    model.initial_temperature(15.0)
    model.temperature(15.0 - dT * (base.points[:, 1] / h - 0.5))
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    R = rotation(math.radians(40.0))
    u = frame.U @ R
    x, y = base.points.T
    k = alpha * dT / h
    want = k * x**2 / 2 + k * (y - h / 2) ** 2 / 2 * -1 + k * (h / 2) ** 2 / 2
    assert np.abs(u[:, 1] - want).max() < 1e-7 * np.abs(want).max() * 10
    assert np.abs(frame.fields[0].values["S"]).max() < 1e-7 * 2e5 * alpha * dT


@pytest.mark.parametrize("element", ["Q4I", "Q8", "T6", "Q4D"])
def test_tied_body_turned_far_then_heated(element: str) -> None:
    """Two tied blocks turned by 150 degrees stay without stress; heat in one then acts as at rest.

    The stresses of the heated, turned body are those of the body that was never turned, turned.
    """
    stresses = []
    for angle in (0.0, 150.0):
        cell = CELL[element]
        low = ct.mesh.rectangle(2.0, 1.0, nx=3, ny=2, cell=cell)
        high = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=2, cell=cell, origin=(0.0, 1.0))
        mesh = ct.mesh.assembly(low=low, high=high)
        model = ct.Model(mesh)
        elastic = ct.Elastic(E=100.0, nu=0.3, expansion=1e-3)
        model.section("low", element=element, material=elastic, local_strain="green_lagrange")
        model.section("high", element=element, material=elastic, local_strain="green_lagrange")
        model.tie("high.bottom", "low.top")
        bottom = mesh.nodes_of("low.bottom")
        steps = []
        a = math.radians(angle)
        for turn in np.linspace(0.0, a, 6)[1:] if angle else [0.0]:
            u = mesh.points @ (rotation(turn) - np.eye(2)).T
            held = [Fixed([int(n)], d, float(u[n, d])) for n in bottom for d in (0, 1)]
            if element in DRILLING:
                held += [Fixed([int(n)], 2, float(turn)) for n in bottom]
            steps.append(ct.Static(supports=held, increments=1))
        upper = mesh.nodes_of("high")
        steps.append(ct.Static(loads=[Temperature(upper, 8.0)], increments=2))
        results = ct.solve(model, steps, threads=1)
        before = [f for f in results.frames if f.step == len(steps) - 1][-1]
        assert max(np.abs(b.values["S"]).max() for b in before.fields) < 1e-7
        S = np.concatenate([b.values["S"].reshape(-1, 4) for b in results.frames[-1].fields])
        full = np.array([[[s[0], s[3]], [s[3], s[1]]] for s in S])
        R = rotation(a)
        stresses.append(R.T @ full @ R)
    assert np.abs(stresses[0]).max() > 0.05
    assert np.allclose(stresses[1], stresses[0], atol=1e-7)


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
