"""What must not change an answer: rotation, units, numbering, threads; and input of nothing."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh.data import Cells
from support.audits import CELL, DRILLING, rotation

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


def gripper(mesh: Any, angle: float, unit: tuple[float, float]) -> Any:
    """A plastic, heated, loaded strip, all of its data turned by an angle and in other units."""
    length, force = unit
    stress = force / length**2
    R = rotation(angle)
    model = ct.Model(mesh)
    steel = ct.Mises(
        E=2000.0 * stress,
        nu=0.3,
        yield_stress=8.0 * stress,
        isotropic=50.0 * stress,
        kinematic=80.0 * stress,
        rho=0.02 * force / length**3,
        expansion=1e-4,
    )
    model.section("all", element="Q8R", material=steel, thickness=0.6 * length)
    model.local_axes("left", angle=angle)
    model.fix("left", y=None)
    model.fix([int(mesh.nodes_of("left")[0])])
    model.initial_stress(
        **dict(
            zip(
                ("xx", "yy", "xy"),
                (lambda s: (s[0, 0], s[1, 1], s[0, 1]))(
                    R @ (np.array([[0.4, 0.1], [0.1, -0.2]]) * stress) @ R.T
                ),
                strict=True,
            )
        )
    )
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


def test_meters_and_millimeters() -> None:
    """The same part in SI and in micrometer-like units: factors of length, force, energy only."""
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
            "all",
            element=element,
            material=wood,
            thickness=1.4,
            orientation=sign * 0.5,
            local_strain="green_lagrange",
        )
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
        "force",
        "moment",
        "pressure",
        "traction",
        "gravity",
        "omega",
        "about",
        "fix",
        "rotation",
        "thickness",
        "E",
        "nu",
        "yield",
        "temperature",
        "initial temperature",
        "initial stress",
        "expansion",
        "equation",
        "rhs",
        "spring",
        "area",
        "amplitude",
        "curve",
        "beta0",
        "weights",
        "clearance",
        "friction",
        "period",
        "rho",
        "orientation",
        "local axes",
        "point",
    ],
)
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
        model.fix("left")
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
