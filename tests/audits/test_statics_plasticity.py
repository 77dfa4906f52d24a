"""Plastic histories with heat, turns and rigid ends, against small programs in the tests.

Every check names its claim; its docstring says where the reference comes from.
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
from corota.model.loads import Fixed, NodalForce, Temperature
from support.audits import (
    CELL,
    DRILLING,
    Bar,
    boundary,
    deck_mesh,
    ends,
    radial_return,
    rotation,
    run,
    virgin,
)
from support.pairs import cover, quickly

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


# --- A thick tube: a program of its own in one dimension ---


class Tube:
    """Rotationally symmetric small strain, quadratic elements along the radius, J2 flow."""

    def __init__(self, a: float, b: float, n: int, m: dict[str, float], plane: str) -> None:
        self.x = np.linspace(a, b, 2 * n + 1)
        self.m, self.plane, self.n = m, plane, n
        g = math.sqrt(0.6)
        xi, w = np.array([-g, 0, g]), np.array([5, 8, 5]) / 9
        h = (b - a) / n
        N = np.array([xi * (xi - 1) / 2, 1 - xi**2, xi * (xi + 1) / 2]).T
        dN = np.array([xi - 0.5, -2 * xi, xi + 0.5]).T * 2 / h
        self.B, self.r, self.w, self.dof = [], [], [], []
        for e in range(n):
            nodes = [2 * e, 2 * e + 1, 2 * e + 2]
            for q in range(3):
                r = N[q] @ self.x[nodes]
                self.r.append(r)
                self.w.append(w[q] * h / 2 * r)
                self.B.append([dN[q], N[q] / r])
                self.dof.append(nodes)
        self.r, self.w = np.array(self.r), np.array(self.w)
        self.B, self.dof = np.array(self.B), np.array(self.dof)
        self.state = virgin(len(self.r))
        self.u = np.zeros(2 * n + 1)
        self.ez = np.zeros(len(self.r))

    def local(self, e2: np.ndarray, free: np.ndarray) -> Any:
        """Stress r, t at given strains; through the thickness held, or free of stress."""
        if self.plane == "strain":
            e = np.column_stack([e2, np.zeros(len(e2))]) - free[:, None]
            return radial_return(e, self.state, self.m)
        z = self.ez.copy()
        for _ in range(60):
            e = np.column_stack([e2, z]) - free[:, None]
            s, new = radial_return(e, self.state, self.m)
            e[:, 2] += 1e-7
            slope = (radial_return(e, self.state, self.m)[0][:, 2] - s[:, 2]) / 1e-7
            if np.abs(s[:, 2]).max() < 1e-10 * self.m["sy"]:
                break
            z = z - s[:, 2] / slope
        self.trial_z = z
        return s, new

    def increment(self, pressure: float, free: np.ndarray) -> None:
        u = self.u.copy()
        for _ in range(40):
            e2 = np.einsum("qcn,qn->qc", self.B, u[self.dof])
            s, new = self.local(e2, free)
            D = np.zeros((len(e2), 2, 2))
            for c in range(2):
                d = e2.copy()
                d[:, c] += 1e-7
                D[:, :, c] = (self.local(d, free)[0][:, :2] - s[:, :2]) / 1e-7
            self.local(e2, free)
            f, K = np.zeros(len(u)), np.zeros((len(u), len(u)))
            for q, nodes in enumerate(self.dof):
                f[nodes] += self.w[q] * self.B[q].T @ s[q, :2]
                K[np.ix_(nodes, nodes)] += self.w[q] * self.B[q].T @ D[q] @ self.B[q]
            f[0] -= pressure * self.x[0]
            if np.abs(f).max() < 1e-9 * self.m["sy"]:
                break
            u -= np.linalg.solve(K, f)
        else:
            raise AssertionError("the reference did not converge")
        self.u, self.state, self.s = u, new, s
        if self.plane == "stress":
            self.ez = self.trial_z


@pytest.mark.parametrize(
    ("plane", "hardening"), cover(["strain", "stress"], ["kinematic", "combined"], strength=1)
)
def test_tube_with_pressure_and_heat_over_four_steps(plane: str, hardening: str) -> None:
    """Pressure beyond yield, a hot bore, cooling, relief: displacements, stress, residual stress.

    Reference: the program above, the same ten increments a step. Five elements.
    """
    a, b, t = 1.0, 2.0, 0.6
    m = {"E": 1000.0, "nu": 0.3, "sy": 1.0, "H": 0.0, "K": 60.0}
    if hardening == "combined":
        m |= {"H": 40.0, "K": 25.0}
    p, dT, alpha = 0.75, 1.6, 1e-3
    tube = Tube(a, b, 16, m, plane)
    profile = np.log(b / tube.r) / math.log(b / a)
    want = []
    for p0, p1, T0, T1 in ((0, p, 0, 0), (p, p, 0, dT), (p, p, dT, 0), (p, 0, 0, 0)):
        for k in range(1, 11):
            x = k / 10
            tube.increment(p0 + x * (p1 - p0), alpha * (T0 + x * (T1 - T0)) * profile)
        order = np.argsort(tube.r)
        want.append((tube.u[0], tube.u[-1], tube.r[order], tube.s[order], tube.state["p"].max()))
    for element in ("Q8", "Q8R", "Q9", "T6", "Q4I"):
        quad = element != "Q4I"
        mesh = ct.mesh.annulus(
            a, b, 8 if quad else 24, 4 if quad else 12, angle=90.0, cell=CELL[element]
        )
        model = ct.Model(mesh)
        steel = ct.Mises(
            E=m["E"],
            nu=0.3,
            yield_stress=1.0,
            isotropic=m["H"],
            kinematic=m["K"],
            expansion=alpha,
        )
        model.section("all", element=element, material=steel, plane=plane, thickness=t)
        model.fix("start", x=None)
        model.fix("end", y=None)
        radius = np.linalg.norm(mesh.points, axis=1)
        T = dT * np.log(b / radius) / math.log(b / a)
        steps = [ct.Static(nlgeom=False, increments=10, fixed_increments=True) for _ in range(4)]
        steps[0].pressure("inner", p)
        steps[1].temperature(T)
        steps[2].temperature(0.0)
        steps[3].pressure("inner", 0.0)
        got = ends(ct.solve(model, steps, threads=1))
        inner, outer = int(np.argmin(mesh.points[:, 1] + mesh.points[:, 0])), None
        inner = int(np.argmin(np.hypot(mesh.points[:, 0] - a, mesh.points[:, 1])))
        outer = int(np.argmin(np.hypot(mesh.points[:, 0] - b, mesh.points[:, 1])))
        scale = max(abs(w[0]) for w in want)
        for frame, (ui, uo, r, s, peeq) in zip(got, want, strict=True):
            assert frame.U[inner, 0] == pytest.approx(ui, abs=4e-3 * scale), element
            assert frame.U[outer, 0] == pytest.approx(uo, abs=4e-3 * scale), element
            block = frame.fields[0]
            x = block.points.reshape(-1, 2)
            S = block.values["S"].reshape(-1, 4)
            rr = np.hypot(*x.T)
            c, sn = x[:, 0] / rr, x[:, 1] / rr
            radial = S[:, 0] * c**2 + S[:, 1] * sn**2 + 2 * S[:, 3] * c * sn
            hoop = S[:, 0] + S[:, 1] - radial
            inside = (rr > a + 0.1) & (rr < b - 0.1)
            error = np.abs(radial - np.interp(rr, r, s[:, 0]))[inside]
            assert error.max() < 0.03, element
            error = np.abs(hoop - np.interp(rr, r, s[:, 1]))[inside]
            assert np.sqrt((error**2).mean()) < 0.02, element
            assert np.abs(S[:, 2] - np.interp(rr, r, s[:, 2]))[inside].mean() < 0.02, element
            assert block.values["PEEQ"].max() == pytest.approx(peeq, rel=0.08), element


# --- Sections of bars under force and moment ---


@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q8R", "Q9", "T6", "Q4S", "Q4DI"])
def test_axial_force_and_bending_beyond_yield(element: str) -> None:
    """N, then a turned end, N reversed with the turn held, then the moment taken away.

    Fibers with history at the rows of points; N/Np = 0.4 and M = Mp (1 - (N/Np)^2) - core.
    """
    E, sy, L, h, t, rows = 1000.0, 1.0, 4.0, 1.0, 0.5, 16
    mesh = ct.mesh.rectangle(L, h, nx=4, ny=rows, cell=CELL[element])
    end = ct.mesh.add_node(mesh, L, h / 2, "end")
    model = ct.Model(mesh)
    steel = ct.Mises(E=E, nu=0.0, yield_stress=sy, kinematic=2.0)
    model.section("all", element=element, material=steel, thickness=t)
    model.fix("left", y=None, rotation=True if element == "Q4DI" else None)
    model.fix([0], x=None)
    model.couple("right", end, dofs="x rotation" if element == "Q4DI" else "x")
    model.fix([end], x=None, rotation=None)
    N, k = 0.4 * sy * h * t, 6 * sy / E / (h / 2)
    held = [Fixed([end], 2, k * L)]
    common: dict[str, Any] = {"nlgeom": False, "increments": 20, "fixed_increments": True}
    steps = [
        ct.Static(loads=[NodalForce([end], 0, N)], supports=[Fixed([end], 2, 0.0)], **common),
        ct.Static(supports=held, **common),
        ct.Static(loads=[NodalForce([end], 0, -N)], **common),
    ]
    got = ends(ct.solve(model, steps, threads=1))
    three = element in ("Q8", "Q9", "Q4DI")
    xi, w = np.polynomial.legendre.leggauss(3 if three else 2)
    y = ((np.arange(rows)[:, None] + 0.5 + xi / 2) / rows - 0.5).ravel() * h
    bar = Bar(len(y), E, sy, 0.0, 2.0)
    dA = np.tile(w / 2 * h * t / rows, rows)
    e0 = 0.0
    answers = []
    for N0, N1, k0, k1 in ((0, N, 0, 0), (N, N, 0, k), (N, -N, k, k)):
        for i in range(1, 21):
            F, kk = N0 + (N1 - N0) * i / 20, k0 + (k1 - k0) * i / 20
            e0 = brentq(
                lambda e, kk=kk, F=F: bar.stress(e - kk * y) @ dA - F,
                e0 - 0.1,
                e0 + 0.1,
                xtol=1e-15,
            )
            bar.stress(e0 - kk * y, commit=True)
        s = bar.stress(e0 - kk * y)
        answers.append((e0, -(s * y) @ dA))
    for frame, (e0, M) in zip(got, answers, strict=True):
        assert frame.U[end, 0] == pytest.approx(e0 * L, rel=4e-3, abs=1e-5)
        assert frame.RF[end, 2] == pytest.approx(M, rel=4e-3, abs=1e-6)
    Mp = sy * h**2 / 4 * t
    assert answers[1][1] == pytest.approx(Mp * (1 - 0.16), rel=0.02)


@pytest.mark.parametrize(
    "kind",
    quickly(
        ["CPS4I", "CPS8R", "CPE8R", "CPE6", "Q4D", "OPT", "Q9", "CPE4R"], "CPS8R", "Q4D", "CPE6"
    ),
)
def test_two_bars_ratchet_under_cycles_of_heat(tmp_path: Path, kind: str) -> None:
    """Two parallel bars, one heated in cycles by an amplitude of total time, a constant force.

    Without hardening each cycle lengthens both by L (alpha T - 4 (sy - s)/E), s the mean stress;
    here it is 1/2000 of E. Else two points by hand, with the same increments.
    """
    E, sy, s, alpha, T, L, K = 1000.0, 1.0, 0.6, 1e-3, 2.4, 5.0, 0.5
    quad = kind in ("CPS8R", "CPE8R")
    cell = "quad8" if quad else {"CPE6": "tri6", "OPT": "tri3", "Q9": "quad9"}.get(kind, "quad4")
    one = ct.mesh.rectangle(L, 1.0, 2, 1, cell)
    both = ct.mesh.assembly(a=one, b=ct.mesh.move(one, (0.0, 3.0)))
    both = ct.Mesh(
        both.points,
        both.cells,
        node_sets={
            s: np.concatenate([both.nodes_of(f"a.{s}"), both.nodes_of(f"b.{s}")])
            for s in ("left", "right", "top", "bottom")
        },
    )
    n = len(both.points)
    first = ", ".join(str(k + 1) for k in one.nodes_of("left")[:1])
    hot = "\n".join(str(i + 1) for i in range(len(one.points)))
    text = (
        deck_mesh(both, kind)
        + f"""*NODE
{n + 1}, {L}, 2.
*NSET, NSET=hot
{hot}
*NSET, NSET=low
{first}, {int(first) + len(one.points)}
*MATERIAL, NAME=m
*ELASTIC
{E}, 0.
*PLASTIC, HARDENING=KINEMATIC
{sy}, 0.
{sy + K}, 1.
*EXPANSION
{alpha}
*SOLID SECTION, ELSET=all, MATERIAL=m
1.
*AMPLITUDE, NAME=cycle, TIME=TOTAL TIME
0., 0., 1., 0., 2., 1., 3., 0.
4., 1., 5., 0., 6., 1., 7., 0.
*COUPLING, REF NODE={n + 1}, SURFACE=ends, CONSTRAINT NAME=c
*KINEMATIC
1, 1
*SURFACE, NAME=ends, TYPE=NODE
right
*BOUNDARY
left, 1, 1
low, 2, 2
{n + 1}, 2, 2
{n + 1}, 6, 6
{"left, 6, 6" if kind in DRILLING else ""}
{"right, 6, 6" if kind in DRILLING else ""}
*STEP
*STATIC, DIRECT
1., 1.
*CLOAD
{n + 1}, 1, {2 * s}
*END STEP
*STEP, INC=300
*STATIC, DIRECT
0.1, 6.
*TEMPERATURE, AMPLITUDE=cycle
hot, {T}
*END STEP
""".replace("\n\n", "\n")
    )
    results = run(tmp_path / "bree.inp", text)
    end = results.mesh.n_nodes - 1
    u = {round(f.time, 6): f.U[end, 0] for f in results.frames}
    m = {"E": E, "nu": 0.0, "sy": sy, "H": 0.0, "K": K}
    want = two_strips(m, s, alpha, T, "strain" if kind.startswith("CPE") else "stress")
    for time, e in want.items():
        assert u[time] == pytest.approx(L * e, rel=2e-5), time
    if not kind.startswith("CPE"):
        growth = L * (alpha * T - 4 * (sy - s) / E)
        assert u[5.0] - u[3.0] == pytest.approx(growth, rel=5e-3)


def two_strips(
    m: dict[str, float], s: float, alpha: float, T: float, plane: str
) -> dict[float, float]:
    """The two bars: points with s_y = 0 and e_z = 0 or s_z = 0, one strain along x."""
    if plane == "stress":
        bars = [Bar(1, m["E"], m["sy"], 0.0, m["K"]) for _ in range(2)]
    states = [virgin(1), virgin(1)]

    def stress(i: int, e: float, free: float) -> tuple[float, Any]:
        def across(y: float) -> float:
            return float(radial_return(np.array([[e, y, 0.0]]) - free, states[i], m)[0][0, 1])

        if plane == "stress":
            a = bars[i].stress(np.array([e - free]))[0]
            return float(a), None
        y = brentq(across, -0.2, 0.2, xtol=1e-16)
        a, new = radial_return(np.array([[e, y, 0.0]]) - free, states[i], m)
        return float(a[0, 0]), new

    found = {}
    for k in range(61):
        time = 1 + k / 10
        heat = [alpha * T * np.interp(time, range(8), [0, 0, 1, 0, 1, 0, 1, 0]), 0.0]

        def balance(e: float, heat: list[float] = heat) -> float:
            return sum(stress(i, e, heat[i])[0] for i in (0, 1)) - 2 * s

        e = brentq(balance, -0.1, 0.1, xtol=1e-15)
        if plane == "stress":
            for i in (0, 1):
                bars[i].stress(np.array([e - heat[i]]), commit=True)
        states = [stress(i, e, heat[i])[1] for i in (0, 1)]
        found[round(time, 6)] = e
    return found


# --- States of a point ---


@pytest.mark.parametrize(
    ("element", "strain", "turned"),
    cover(
        ["T3", "Q4", "Q4I", "Q4S", "Q4R", "Q4D", "OPT", "Q8R", "Q9"],
        ["linear", "logarithmic"],
        [False, True],
    ),
)
def test_held_plate_heated_beyond_yield_and_cooled(element: str, strain: str, turned: bool) -> None:
    """All sides held, plane stress, heated and cooled, the body turned by 2 rad in between.

    Equal stress in both directions: one dimension with E/(1 - nu), and half the thickness strain.
    """
    E, nu, sy, H, K, alpha = 1000.0, 0.25, 1.0, 50.0, 100.0, 1e-3
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.5, 2, 2, CELL[element]), 0.2, seed=3)
    model = ct.Model(mesh)
    steel = ct.Mises(E=E, nu=nu, yield_stress=sy, isotropic=H, kinematic=K, expansion=alpha)
    model.section("all", element=element, material=steel, thickness=0.3, local_strain=strain)
    nodes = np.arange(mesh.n_nodes) if element in DRILLING else boundary(mesh)
    drill = element in DRILLING
    turn = rotation(2.0) - np.eye(2)
    u = mesh.points @ turn.T if turned else 0 * mesh.points
    held = [Fixed([int(n)], d, 0.0) for n in nodes for d in ((0, 1, 2) if drill else (0, 1))]
    away = [Fixed([int(n)], d, float(u[n, d])) for n in nodes for d in (0, 1)]
    if drill:
        away += [Fixed([int(n)], 2, 2.0 if turned else 0.0) for n in nodes]
    T = 4.0
    steps = [
        ct.Static(supports=held, loads=[Temperature("", T)], increments=4),
        ct.Static(supports=away, increments=1),
        ct.Static(loads=[Temperature("", -T / 2)], increments=4),
    ]
    got = ends(ct.solve(model, steps, threads=1))
    # s = -E/(1-nu) (alpha T + ep), with ep = -p/2 on one of the axes, thickness plastic strain p.
    bar = Bar(1, E, sy)
    for k, temperature in ((0, T), (2, -T / 2)):
        heat = alpha * temperature
        if strain == "logarithmic":  # of the free stretch 1 + alpha T
            heat = math.log1p(heat)
        s, p = biaxial(E, nu, sy, H, K, bar, heat)
        values = got[k].fields[0].values
        if strain == "logarithmic":  # true stress: over the change of volume, here of thickness
            s /= math.exp(-2 * nu * s / E + bar.ep[0] + heat)
        assert np.allclose(values["S"][..., 0], s, rtol=1e-6)
        assert np.allclose(values["S"][..., 1], s, rtol=1e-6)
        assert np.abs(values["S"][..., 3]).max() < 1e-6
        assert np.allclose(values["PEEQ"], p, rtol=1e-6)
    values = got[1].fields[0].values["S"]
    assert np.allclose(values, got[0].fields[0].values["S"], atol=1e-6)


def biaxial(
    E: float, nu: float, sy: float, H: float, K: float, bar: Bar, free: float
) -> tuple[float, float]:
    """Equal stress s along x and y at zero strain; bar.ep is the thickness plastic strain.

    Flow: (-1/2, -1/2, 1) p times -sign(xi); the back-stress is deviatoric, K times ep_z in
    uniaxial measure. s = E/(1-nu) (ep_z/2 - free).
    """
    c = E / (1 - nu)
    ep, beta, p = bar.ep[0], bar.beta[0], bar.p[0]
    s = c * (ep / 2 - free)
    xi = s + beta  # back-stress of thickness flow opposes: -s is the "stress" along z
    dp = max(0.0, (abs(xi) - sy - H * p) / (c / 2 + H + K))
    ep = ep - np.sign(xi) * dp
    beta = K * ep
    bar.ep, bar.beta, bar.p = np.array([ep]), np.array([beta]), np.array([p + dp])
    return c * (ep / 2 - free), p + dp


@pytest.mark.parametrize("element", CELL)
def test_strain_along_one_axis_in_plane_strain(element: str) -> None:
    """Perfect plasticity, e_x only: s_x = K e + 2/3 sy beyond yield, then reversal, then back.

    p = 2/3 |e - e_y| on the first way; energy by the areas under the curve.
    """
    E, nu, sy, t = 1000.0, 0.3, 2.0, 0.8
    G, bulk = E / (2 + 2 * nu), E / (3 - 6 * nu)
    ey = sy / (2 * G)
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 2, 2, CELL[element]), 0.15, seed=5)
    model = ct.Model(mesh)
    model.section(
        "all",
        element=element,
        material=ct.Mises(E=E, nu=nu, yield_stress=sy),
        plane="strain",
        thickness=t,
    )
    drill = element in DRILLING
    nodes = np.arange(mesh.n_nodes)
    steps = []
    path = [6 * ey, -4 * ey, 1 * ey]
    for e in path:
        supports = [Fixed([int(n)], 0, float(e * mesh.points[n, 0])) for n in boundary(mesh)]
        supports += [Fixed([int(n)], 1, 0.0) for n in boundary(mesh)]
        supports += [Fixed([int(n)], 2, 0.0) for n in nodes] if drill else []
        steps.append(ct.Static(nlgeom=False, supports=supports, increments=20))
    got = ends(ct.solve(model, steps, threads=1))
    ep = p = work = 0.0
    for frame, e in zip(got, path, strict=True):
        s = 2 * G * (2 / 3 * e - ep)  # deviator along x
        dp = max(0.0, abs(s) - 2 / 3 * sy) / (2 * G)
        ep += math.copysign(dp, s)
        p += dp
        work += sy * dp
        s = 2 * G * (2 / 3 * e - ep)
        values = frame.fields[0].values
        assert np.allclose(values["S"][..., 0], bulk * e + s, rtol=1e-7, atol=1e-7)
        assert np.allclose(values["S"][..., 1], bulk * e - s / 2, rtol=1e-7, atol=1e-7)
        assert np.allclose(values["S"][..., 2], bulk * e - s / 2, rtol=1e-7, atol=1e-7)
        assert np.allclose(values["PEEQ"], p, rtol=1e-7)
        assert np.allclose(values["PE"][..., 0], ep, rtol=1e-6, atol=1e-12)
        V = 2.0 * t
        assert frame.scalars["ALLPD"] == pytest.approx(work * V, rel=1e-6)
        stored = (bulk * e**2 + s**2 * 1.5 / (2 * G)) / 2 * V
        assert frame.scalars["ALLSE"] == pytest.approx(stored, rel=1e-6)


@pytest.mark.parametrize(
    ("element", "plane", "law"),
    cover(
        ["T6", "Q4I", "Q4D", "Q8R", "Q4R"], ["stress", "strain"], ["mixed", "chaboche", "perfect"]
    ),
)
def test_cycles_of_pure_shear(element: str, plane: str, law: str) -> None:
    """Six half cycles that grow: shear stress, back-stress, plastic strain, work, dissipation.

    One dimension: tau_y = (sy + H p)/sqrt(3), moduli H/3 and K/3. Work less what hardening
    stores, H p^2/2 + a^2/2K, is the dissipation.
    """
    E, nu, sy = 1000.0, 0.3, 1.0
    H, K, gamma = {"mixed": (30.0, 50.0, 0.0), "chaboche": (0.0, 80.0, 40.0), "perfect": (0,) * 3}[
        law
    ]
    G = E / (2 + 2 * nu)
    mesh = ct.mesh.rectangle(1.5, 1.0, 2, 1, CELL[element])
    model = ct.Model(mesh)
    options: dict[str, Any] = {"chaboche": [(K, gamma)]} if gamma else {"kinematic": K}
    steel = ct.Mises(E=E, nu=nu, yield_stress=sy, isotropic=H, **options)
    model.section("all", element=element, material=steel, plane=plane, thickness=2.0)
    steps = []
    turns = [0.004 * (1 + k) * (-1) ** k for k in range(6)]
    n = 25
    for g in turns:
        supports = [Fixed([int(i)], 0, float(g * mesh.points[i, 1])) for i in range(mesh.n_nodes)]
        supports += [Fixed([int(i)], 1, 0.0) for i in range(mesh.n_nodes)]
        if element == "Q4D":
            supports += [Fixed([int(i)], 2, -g / 2) for i in range(mesh.n_nodes)]
        steps.append(
            ct.Static(nlgeom=False, supports=supports, increments=n, fixed_increments=True)
        )
    got = ends(ct.solve(model, steps, threads=1))
    gp = back = p = work = 0.0
    before = 0.0
    r3 = math.sqrt(3)
    for frame, g in zip(got, turns, strict=True):
        for k in range(1, n + 1):
            tau = G * (before + (g - before) * k / n - gp)

            over = shear_yield(tau, back, p, (G, sy, H, K, gamma))
            if over(0.0) > 0:
                dp = brentq(over, 0.0, abs(tau - back) / (r3 * G), xtol=1e-17)
                sign = math.copysign(1.0, tau - back / (1 + gamma * dp))
                old = back
                back = (back + sign * K / r3 * dp) / (1 + gamma * dp)
                gp += sign * r3 * dp
                work += (sy + H * (p + dp / 2)) * dp + (old + back) / 2 * sign * r3 * dp
                p += dp
        before = g
        tau = G * (g - gp)
        values = frame.fields[0].values
        close = {"rtol": 1e-6, "atol": 1e-9}
        assert np.allclose(values["S"][..., 3], tau, **close)
        assert np.allclose(values["PE"][..., 3], gp, **close)
        assert np.allclose(values["PEEQ"], p, **close)
        if law != "perfect":
            assert np.allclose(values["ALPHA"][..., 3], back, **close)
        assert np.allclose(values["PWORK"], work, rtol=1e-5)
        if law == "mixed":
            stored = H * p**2 / 2 + (r3 * back) ** 2 / (2 * K)
            assert np.allclose(values["PDISS"], work - stored, rtol=1e-5)
        elif law == "perfect":
            assert np.allclose(values["PDISS"], work, rtol=1e-5)
        assert frame.scalars["ALLPD"] == pytest.approx(3.0 * work, rel=1e-5)


def shear_yield(tau: float, back: float, p: float, law: tuple[float, ...]) -> Any:
    """Yield condition after an implicit increment dp: b1 = (b0 + K/sqrt3 dp)/(1 + gamma dp)."""
    G, sy, H, K, gamma = law
    r3 = math.sqrt(3)

    def over(dp: float) -> float:
        sign = math.copysign(1.0, tau - back / (1 + gamma * dp))
        b1 = (back + sign * K / r3 * dp) / (1 + gamma * dp)
        return abs(tau - sign * r3 * G * dp - b1) - (sy + H * (p + dp)) / r3

    return over


@pytest.mark.parametrize("element", ["Q4I", "Q8R", "T6", "Q4D"])
def test_ratchet_of_armstrong_and_frederick(element: str) -> None:
    """A bar cycled between two stresses: plastic strain a cycle of Lemaitre and Chaboche.

    d = 1/gamma ln[(A^2 - (smin + sy)^2)/(A^2 - (smax - sy)^2)] with A = C/gamma, steady at once.
    """
    E, sy, C, gamma, smax, smin = 1000.0, 1.0, 100.0, 100.0, 1.5, -0.9
    mesh = ct.mesh.rectangle(2.0, 1.0, 2, 1, CELL[element])
    model = ct.Model(mesh)
    steel = ct.Mises(E=E, nu=0.3, yield_stress=sy, chaboche=[(C, gamma)])
    model.section("all", element=element, material=steel)
    drill = element == "Q4D"
    model.fix("left", y=None, rotation=True if drill else None)
    model.fix([0], x=None)
    if drill:
        model.fix("right", x=None, y=None, rotation=True)
    steps = []
    for s in [smax, smin] * 3 + [smax]:
        step = ct.Static(nlgeom=False, increments=150, fixed_increments=True)
        step.force("right", x=s)
        steps.append(step)
    got = ends(ct.solve(model, steps, threads=1, keep="all"))
    peak = [f.fields[0].values["PE"][..., 0].mean() for f in got][::2]
    A = C / gamma
    want = math.log((A**2 - (smin + sy) ** 2) / (A**2 - (smax - sy) ** 2)) / gamma
    steps_ = np.diff(peak)
    assert np.allclose(steps_, want, rtol=0.03)


@pytest.mark.parametrize("angle", [0.0, 37.0])
@pytest.mark.parametrize("element", ["Q4I", "Q8R", "T3", "Q4D", "OPT", "Q4S"])
def test_initial_stress_beside_yield(element: str, angle: float) -> None:
    """A bar with 0.6 sy of initial stress yields after 0.4 sy more; 1.5 sy relaxes to sy at once.

    One dimension, kinematic hardening; the bar lies at an angle, the rest is as in a straight one.
    """
    E, sy, L = 1000.0, 1.0, 3.0
    mesh = ct.mesh.move(ct.mesh.rectangle(L, 1.0, 3, 1, CELL[element]), angle=angle)
    R = rotation(math.radians(angle))
    axis = R[:, 0]
    outer = np.outer(axis, axis)
    for s0, stretch in ((0.6, 0.3 / E), (0.6, 0.4 / E), (0.6, 2 / E), (1.5, 0.0), (-0.6, 1.2 / E)):
        model = ct.Model(mesh)
        steel = ct.Mises(E=E, nu=0.0, yield_stress=sy, kinematic=50.0)
        model.section("all", element=element, material=steel, thickness=0.5)
        model.initial_stress(xx=s0 * outer[0, 0], yy=s0 * outer[1, 1], xy=s0 * outer[0, 1])
        model.local_axes("left", angle=math.radians(angle))
        model.local_axes("right", angle=math.radians(angle))
        drill = True if element in DRILLING else None
        model.fix("left", x=0.0, y=None, rotation=drill)
        model.fix("right", x=stretch * L, y=None, rotation=drill)
        model.fix([int(mesh.nodes_of("left")[0])], x=None, y=0.0)
        frame = ct.solve(model, ct.Static(increments=4, nlgeom=False), threads=1).frames[-1]
        want = float(Bar(1, E, sy, 0.0, 50.0).stress(np.array([s0 / E + stretch]))[0])
        S = frame.fields[0].values["S"]
        assert np.allclose(S[..., 0], want * outer[0, 0], atol=1e-7), (s0, stretch)
        assert np.allclose(S[..., 3], want * outer[0, 1], atol=1e-7), (s0, stretch)


# --- Whole parts ---


@pytest.mark.parametrize(
    ("element", "strain"),
    cover(["Q4I", "Q8R", "T6", "Q4D", "Q4S", "OPT"], ["linear", "logarithmic"], strength=1),
)
def test_a_turn_between_plastic_cycles_changes_nothing(element: str, strain: str) -> None:
    """A strip between two rigid grips is bent, turned as a whole by 80 degrees, bent back, pulled.

    The same without the turn; chained hardening of both kinds, so any error of turned tensors
    shows in reactions, plastic strain and back-stress.
    """
    L, angle = 4.0, math.radians(80.0)
    mesh = ct.mesh.distort(ct.mesh.rectangle(L, 1.0, 4, 2, CELL[element]), 0.1, seed=2)
    a = ct.mesh.add_node(mesh, 0.0, 0.5, "a")
    b = ct.mesh.add_node(mesh, L, 0.5, "b")
    xb = np.array([L, 0.0])  # from a to b

    def stage(u: np.ndarray, spin: float, turn: float) -> list[Fixed]:
        R = rotation(turn)
        place = R @ (xb + u) - xb
        return [
            Fixed([a], 0, 0.0),
            Fixed([a], 1, 0.0),
            Fixed([a], 2, turn),
            Fixed([b], 0, float(place[0])),
            Fixed([b], 1, float(place[1])),
            Fixed([b], 2, spin + turn),
        ]

    bends = [
        (np.array([-0.1, 0.5]), 0.25),
        (np.array([0.05, -0.2]), -0.1),
        (np.array([0.12, 0.0]), 0.0),
    ]
    runs = []
    for turned in (False, True):
        model = ct.Model(mesh)
        steel = ct.Mises(E=1000.0, nu=0.3, yield_stress=4.0, isotropic=20.0, kinematic=60.0)
        model.section("all", element=element, material=steel, thickness=0.7, local_strain=strain)
        model.rigid("left", a)
        model.rigid("right", b)
        steps = [ct.Static(supports=stage(*bends[0], 0.0), increments=8, fixed_increments=True)]
        turn = 0.0
        if turned:
            for k in range(1, 41):  # in parts: between them the way of b is a chord
                part = stage(*bends[0], angle * k / 40)
                steps.append(ct.Static(supports=part, increments=1, fixed_increments=True))
            turn = angle
        # A straight way of the supports would not be the turned one; equal increments are.
        for first, then in zip(bends[:-1], bends[1:], strict=True):
            for k in range(1, 17):
                x = k / 16
                u, spin = first[0] + x * (then[0] - first[0]), first[1] + x * (then[1] - first[1])
                part = stage(u, spin, turn)
                steps.append(ct.Static(supports=part, increments=1, fixed_increments=True))
        runs.append(ct.solve(model, steps, threads=1).frames[-1])
    plain, spun = runs
    R = rotation(angle)
    scale = np.abs(plain.RF).max()
    assert np.allclose(spun.RF[[a, b], :2], plain.RF[[a, b], :2] @ R.T, atol=2e-6 * scale)
    assert np.allclose(spun.RF[[a, b], 2], plain.RF[[a, b], 2], atol=2e-6 * scale)
    p, s = plain.fields[0].values, spun.fields[0].values
    assert p["PEEQ"].max() > 0.02
    assert np.allclose(s["PEEQ"], p["PEEQ"], atol=1e-7)
    back = p["ALPHA"]
    tensor = np.array([[back[..., 0], back[..., 3]], [back[..., 3], back[..., 1]]])
    want = np.einsum("ia,abeq,jb->ijeq", R, tensor, R)
    assert np.allclose(s["ALPHA"][..., 0], want[0, 0], atol=1e-5)
    assert np.allclose(s["ALPHA"][..., 3], want[0, 1], atol=1e-5)
    assert spun.scalars["ALLPD"] == pytest.approx(plain.scalars["ALLPD"], rel=1e-6)


def gripped_strip() -> tuple[ct.Model, ct.Static, int, int]:
    """A plastic strip between rigid grips, the step that bends it, and the nodes of the grips."""
    mesh = ct.mesh.rectangle(4.0, 1.0, 6, 2, "quad8")
    a = ct.mesh.add_node(mesh, 0.0, 0.5, "a")
    b = ct.mesh.add_node(mesh, 4.0, 0.5, "b")
    model = ct.Model(mesh)
    steel = ct.Mises(E=1000.0, nu=0.3, yield_stress=4.0, isotropic=20.0, kinematic=60.0)
    model.section("all", element="Q8R", material=steel)
    model.rigid("left", a)
    model.rigid("right", b)
    bent = ct.Static(increments=8, fixed_increments=True)
    bent.fix([a], rotation=0.0)
    bent.fix([b], x=-0.1, y=0.5, rotation=0.25)
    return model, bent, a, b


def test_grips_that_turn_a_plastic_strip_in_one_increment() -> None:
    """By 80 degrees: the same forces in the turned frame, and no more flow."""
    model, bent, a, b = gripped_strip()
    angle = math.radians(80.0)
    place = rotation(angle) @ np.array([3.9, 0.5]) - np.array([4.0, 0.0])
    turned = ct.Static(increments=1, fixed_increments=True)
    turned.fix([a], rotation=angle)
    turned.fix([b], x=float(place[0]), y=float(place[1]), rotation=0.25 + angle)
    results = ct.solve(model, [bent, turned], threads=1)
    before, after = results.frames[-2:]
    forces = after.RF[[a, b], :2] @ rotation(angle)
    np.testing.assert_allclose(forces, before.RF[[a, b], :2], rtol=1e-6)
    np.testing.assert_allclose(after.RF[[a, b], 2], before.RF[[a, b], 2], rtol=1e-6)
    assert after.scalars["ALLPD"] == pytest.approx(before.scalars["ALLPD"], rel=1e-6)


def test_fixed_increments_are_kept_or_the_run_stops() -> None:
    """Grips that bend a plastic strip by 80 degrees each at once: DIRECT stops, and does not go on
    along the path with increments of its own.
    """
    model, bent, a, b = gripped_strip()
    folded = ct.Static(increments=1, fixed_increments=True)
    folded.fix([a], rotation=-math.radians(80.0))
    folded.fix([b], x=-0.1, y=0.5, rotation=0.25 + math.radians(80.0))
    with pytest.raises(ct.ConvergenceError, match="fixed") as stopped:
        ct.solve(model, [bent, folded], threads=1)
    frames = stopped.value.results.frames
    assert [(f.step, f.increment) for f in frames if f.increment] == [(1, k) for k in range(1, 9)]
