"""Plasticity, heat, initial stress and orthotropy combined, against answers found apart."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import corota as ct
from corota.model.loads import Fixed, Temperature
from support.audits import CELL, DRILLING, boundary, deck_mesh, rotation, run
from support.homogeneous import PATH, Point, drive, strain_of
from support.pairs import quickly

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


@pytest.mark.parametrize("kind", quickly(["CPS4I", "CPS8R", "Q4D", "CPS8", "Q4S"], "CPS8R"))
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
*SOLID SECTION, ELSET=all, MATERIAL=m, LOCAL STRAIN=LINEAR
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
    heat = math.log1p(1e-4 * 30.0)  # of the free stretch
    local = np.array([[0.5, 0.3], [0.3, -0.2]]) - 100.0 * heat / 0.75 * np.eye(2)
    thicker = heat + 0.5 * heat / 0.75  # heat, and the added stress, by Hencky's law
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
            "all",
            element="Q4I",
            material=material,
            thickness=1.3,
            plane=plane,
            local_strain=strain,
            orientation=0.4 if material is laws[2] else 0.0,
        )
        model.fix("left")
        model.force("right", y=0.9, x=-0.4, per_node=True)
        model.pressure("top", 0.2)
        ends.append(ct.solve(model, ct.Static(increments=5), threads=1))
    for other in ends[1:]:
        assert np.allclose(other.frames[-1].U, ends[0].frames[-1].U, atol=1e-6)
        a, b = (r.frames[-1].fields[0].values["S"] for r in (ends[0], other))
        assert np.allclose(a, b, atol=1e-5)
        assert other.history("ALLSE")[-1] == pytest.approx(ends[0].history("ALLSE")[-1], rel=1e-3)


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


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ["Q4I", "Q8", "T3", "Q4D"])
def test_internal_variables_turn_and_thickness_changes(element: str, plane: str) -> None:
    """PE, ALPHA, STH, YRATIO after a turned plastic path: the point program's, turned as the body.

    PE is the plastic strain, ALPHA the back-stress, turned by R of F = R U, in every element alike;
    STH = t exp(E33).
    """
    steel = ct.Mises(E=2000.0, nu=0.3, yield_stress=10.0, isotropic=60.0, kinematic=90.0)
    results = drive(element, steel, plane, "logarithmic", PATH[:4])
    frame = results.frames[-1]
    point = Point(2000.0, 0.3, 10.0, 60.0, 90.0, plane)
    for F in PATH[:4]:
        point.move(strain_of(F.T @ F))
    values = frame.fields[0].values
    R = rotation(math.atan2(F[1, 0] - F[0, 1], F[0, 0] + F[1, 1]))
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
        "all",
        element=element,
        material=ct.Elastic(E=E, nu=0.3, expansion=alpha),
        plane="strain",
        thickness=0.4,
        local_strain=strain,
    )
    model.fix("left", y=None, rotation=True if element in DRILLING else None)
    model.fix("bottom", x=None, rotation=True if element in DRILLING else None)
    model.temperature(T)
    frame = ct.solve(model, ct.Static(increments=4), threads=1).frames[-1]
    heat = math.log1p(alpha * T) if strain == "logarithmic" else alpha * T
    want = 2.0 * 0.4 * (E * heat) ** 2 / (2 * E)
    assert frame.scalars["ALLSE"] == pytest.approx(want, rel=1e-6)
    assert frame.scalars["ALLTH"] == pytest.approx(want, rel=1e-6)
    assert abs(frame.scalars["ALLWK"]) < 1e-9 * want
    field = frame.fields[0]
    assert np.sum(field.values["ENER"] * field.volume) == pytest.approx(want, rel=1e-6)
    assert field.volume.sum() == pytest.approx(0.8, rel=1e-12)


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
