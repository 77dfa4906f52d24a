"""Initial stress: equilibrium, prestressed vibration, trusses and beams."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import SOLVERS
from support.lines import chain, lines
from support.models import ELEMENTS, cell
from support.newton import solve_quadratically
from support.pairs import cover

E, NU = 1000.0, 0.3


def plate(element: str, plane: str = "stress", law: str = "elastic") -> ct.Model:
    """A plate of 2 x 2 cells with a node out of line."""
    mesh = ct.mesh.rectangle(2.0, 2.0, nx=2, ny=2, cell=cell(element))
    if cell(element) in ("tri3", "quad4"):
        mesh.points[np.hypot(*(mesh.points - 1.0).T) < 1e-9] += [0.2, -0.1]
    model = ct.Model(mesh)
    material = ct.Elastic(E, NU)
    if law == "mises":
        material = ct.Mises(E, NU, yield_stress=100.0)  # type: ignore[assignment]
    model.section("all", element=element, material=material, plane=plane)  # type: ignore[arg-type]
    return model


def stresses(frame: ct.results.Frame) -> np.ndarray:
    """Stresses of all points, (n, 4)."""
    return np.concatenate([f.values["S"].reshape(-1, 4) for f in frame.fields])


@pytest.mark.parametrize(
    ("element", "plane", "law"), cover(ELEMENTS, ["stress", "strain"], ["elastic", "mises"])
)
def test_held_plate_keeps_its_initial_stress(element: str, plane: str, law: str) -> None:
    model = plate(element, plane, law)
    zz = 4.0 if plane == "strain" else 0.0
    model.initial_stress(xx=3.0, yy=-2.0, zz=zz, xy=1.5)
    for side in ("left", "right", "bottom", "top"):
        model.fix(side, rotation=True)
    if element in ("OPT", "Q4D"):
        # Free rotations would answer the moments of normal tractions.
        model.fix(np.arange(model.mesh.n_nodes), rotation=True)
    frame = ct.solve(model, ct.Static(), threads=1).frames[-1]
    found = stresses(frame)
    assert found == pytest.approx(np.broadcast_to([3.0, -2.0, zz, 1.5], found.shape), abs=1e-9)
    assert np.abs(frame.U).max() < 1e-12
    own = np.linalg.solve(np.eye(4), ct.Elastic(E, NU).compliance() @ [3.0, -2.0, zz, 1.5])
    energy = 0.5 * 4.0 * float(own @ [3.0, -2.0, zz, 1.5])
    assert frame.scalars["strain energy"] == pytest.approx(energy, rel=1e-9)


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_free_plate_gives_its_stress_back(element: str, plane: str) -> None:
    """What nothing balances goes: the strain is the compliance times the stress lost."""
    model = plate(element, plane)
    model.initial_stress(xx=3.0, yy=-2.0)
    model.fix([0])
    corner = int(np.argmin(np.hypot(*(model.mesh.points - [2.0, 0.0]).T)))
    model.fix([corner], x=None)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    assert np.abs(stresses(frame)[:, [0, 1, 3]]).max() < 1e-9
    if plane == "stress":
        lost = [-(3.0 + 2.0 * NU) / E, (2.0 + 3.0 * NU) / E]
    else:
        lost = [
            -(1.0 + NU) * ((1.0 - NU) * 3.0 + NU * 2.0) / E,
            (1.0 + NU) * ((1.0 - NU) * 2.0 + NU * 3.0) / E,
        ]
    assert pytest.approx(np.array(lost) * model.mesh.points, abs=1e-11) == frame.U


def test_stress_in_balance_moves_nothing() -> None:
    """Shrink fit of two strips: tension in one, compression in the other."""
    mesh = ct.mesh.rectangle(4.0, 2.0, nx=4, ny=4, cell="quad9")
    model = ct.Model(mesh)
    model.section("all", element="Q9", material=ct.Elastic(E, NU))
    model.fix("left", y=None)
    model.fix([0])
    for side in ("right",):
        model.fix(side, y=None)
    middle = mesh.points[mesh.cells[0].nodes[:, :4], 1].mean(axis=1)
    inner = np.abs(middle - 1.0) < 0.5
    model.initial_stress(xx=np.where(inner, 5.0, -5.0)[:, None])
    frame = ct.solve(model, ct.Static(), threads=1).frames[-1]
    # Held ends balance each strip; across nothing acts.
    assert np.abs(frame.U).max() < 1e-12
    right = mesh.nodes_of("right")
    assert frame.RF[right, 0].sum() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("kind", ["BEAM", "Q8"])
def test_prestress_raises_the_frequency(kind: str) -> None:
    """f_n = n^2 pi / 2 L^2 sqrt(EI / m) sqrt(1 + T L^2 / (n^2 pi^2 EI)), hinged ends held."""
    length, depth, stress, young, rho = 100.0, 1.0, 4.0, 2e4, 1e-3
    if kind == "BEAM":
        n = 40
        model = ct.Model(chain(n, length))
        model.beam(
            np.arange(n),
            material=ct.Elastic(young, 0.0, rho=rho),
            area=depth,
            inertia=depth**3 / 12.0,
        )
        ends = [0, n]
    else:
        mesh = ct.mesh.rectangle(length, depth, nx=40, ny=1, cell="quad8", origin=(0.0, -0.5))
        model = ct.Model(mesh)
        model.section("all", element="Q8", material=ct.Elastic(young, 0.0, rho=rho))
        ends = [int(np.argmin(np.hypot(*(mesh.points - [x, 0.0]).T))) for x in (0.0, length)]
    model.fix(ends)
    model.initial_stress(xx=stress)
    steps = [ct.Static(), ct.Frequency(modes=2)]
    found = ct.solve(model, steps, threads=1).modes[-1].factors
    inertia, force = depth**3 / 12.0, stress * depth
    for k, value in enumerate(found, start=1):
        own = k * k * np.pi / (2.0 * length**2) * np.sqrt(young * inertia / (rho * depth))
        raised = np.sqrt(1.0 + force * length**2 / (k * k * np.pi**2 * young * inertia))
        assert raised > 1.2 or k > 1
        assert value == pytest.approx(own * raised, rel=3e-3)


def test_newton_is_quadratic_with_initial_stress() -> None:
    mesh = ct.mesh.rectangle(10.0, 0.5, nx=10, ny=2)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E, NU))
    model.fix("left")
    middle = mesh.points[mesh.cells[0].nodes, 1].mean(axis=1)
    model.initial_stress(xx=np.where(middle > 0.25, 30.0, -30.0)[:, None])
    results = solve_quadratically(model, ct.Static())
    # The unbalanced moment rolls the strip up: M = sigma b h^2 / 4 over EI.
    tip = int(np.argmin(np.hypot(*(mesh.points - [10.0, 0.25]).T)))
    curvature = 30.0 * 0.25 / 4.0 / (E * 0.5**3 / 12.0)
    assert results.frames[-1].U[tip, 1] == pytest.approx(
        (1.0 - np.cos(10.0 * curvature)) / curvature, rel=1e-2
    )


@pytest.mark.parametrize("kind", ["truss", "beam"])
def test_lines_expand_and_carry_initial_stress(kind: str) -> None:
    """Free end: alpha dT L less the stress given back; held end: -E alpha dT + s0."""
    material = ct.Elastic(E, NU, expansion=1e-3)
    for held in (False, True):
        mesh = lines([(0.0, 0.0), (3.0, 4.0)], ("line2", [[0, 1]]))
        model = ct.Model(mesh)
        if kind == "truss":
            model.truss([0], material=material, area=2.0)
        else:
            model.beam([0], material=material, area=2.0, inertia=0.1)
        model.fix([0], rotation=True)
        model.local_axes([1], angle=np.arctan2(4.0, 3.0))
        model.fix([1], x=0.0 if held else None, y=0.0)
        model.temperature([10.0, 30.0])
        model.initial_stress(xx=7.0)
        frame = ct.solve(model, ct.Static(), threads=1).frames[-1]
        axial = float(frame.fields[0].values["N"].squeeze())
        if held:
            assert axial == pytest.approx(2.0 * (7.0 - E * 1e-3 * 20.0), rel=1e-10)
        else:
            assert axial == pytest.approx(0.0, abs=1e-9)
            grown = 5.0 * (1e-3 * 20.0 - 7.0 / E)
            assert frame.U[1] == pytest.approx([0.6 * grown, 0.8 * grown], rel=1e-9)


def test_stress_through_the_thickness_is_refused_in_plane_stress() -> None:
    model = plate("Q4")
    model.initial_stress(zz=1.0)
    with pytest.raises(ct.ModelError, match="plane stress"):
        ct.solve(model)


def test_preload_then_actuation_follow_each_other() -> None:
    """A heated bar is loaded after: the steps add up, and the second starts where one ended."""
    model = plate("Q4I")
    model.sections[0].material.expansion = 1e-3
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    first = ct.Static(nlgeom=False)
    first.loads = [ct.model.Temperature("", 10.0)]
    second = ct.Static(nlgeom=False, increments=2)
    second.loads = [ct.model.EdgeLoad("right", "traction", (5.0, 0.0))]
    frames = ct.solve(model, [first, second], threads=1).frames
    right = model.mesh.nodes_of("right")
    moved = [f.U[right, 0].mean() for f in frames]
    assert moved == pytest.approx([0.0, 0.02, 0.025, 0.03], rel=1e-9)


@pytest.mark.parametrize("local_strain", ["linear", "green_lagrange", "logarithmic"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_tangent_is_the_derivative_with_free_strains(element: str, local_strain: str) -> None:
    """At any temperature, stress and rotation, by central differences."""
    model = plate(element)
    model.sections[0].local_strain = local_strain  # type: ignore[assignment]
    model.sections[0].material.expansion = 1e-3
    model.initial_stress(xx=20.0, yy=-10.0, xy=15.0)
    rng = np.random.default_rng(3)
    model.initial_temperature(rng.uniform(-30.0, 30.0, model.mesh.n_nodes))
    system = System(model, SOLVERS["multifrontal"](), 1)
    system.begin(ct.Static(), 0.0, np.zeros(system.n_dofs), None)
    x = model.mesh.points
    c, s = np.cos(0.8), np.sin(0.8)
    moved = x @ np.array([[c, s], [-s, c]]) - x + 0.03 * rng.standard_normal(x.shape)
    u = system.from_nodes(np.column_stack([moved, 0.8 + 0.05 * rng.standard_normal(len(x))]))
    upper = sp.csc_array(
        (system.evaluate(u, 0.0).values, system.pattern.indices, system.pattern.indptr)
    )
    k = (upper + sp.triu(upper, 1).T).toarray()
    h = 1e-6
    for column in rng.choice(system.n_dofs, 6, replace=False):
        step = np.zeros(system.n_dofs)
        step[column] = h
        ahead = system.evaluate(u + step, 0.0).internal
        behind = system.evaluate(u - step, 0.0).internal
        assert np.abs((ahead - behind) / (2.0 * h) - k[:, column]).max() < 1e-7 * np.abs(k).max()


@pytest.mark.parametrize("local_strain", ["linear", "green_lagrange"])
@pytest.mark.parametrize("element", ["Q4I", "Q4D"])
def test_internal_modes_settle_where_everything_is_held(element: str, local_strain: str) -> None:
    """Nodes without displacement give the modes no length; the free strain does."""
    model = plate(element)
    model.sections[0].local_strain = local_strain  # type: ignore[assignment]
    model.sections[0].material.expansion = 1e-3
    model.fix(np.arange(model.mesh.n_nodes), rotation=True)
    model.temperature(10.0 * model.mesh.points[:, 0] * model.mesh.points[:, 1])
    assert np.abs(stresses(ct.solve(model, threads=1).frames[-1])).max() > 1.0
