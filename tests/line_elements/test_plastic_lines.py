"""Trusses and beams of plastic materials: closed forms, tangents, energy, histories.

Sources: W. F. Chen and D. J. Han, *Plasticity for Structural Engineers* (moment and
curvature, axial force and moment of a rectangle); R. Hill, *The Mathematical Theory of Plasticity*
(three bars).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.same_bits import Takes
from corota.analysis.equations import System
from corota.analysis.linear.solvers import SOLVERS
from support.lines import chain, lines

E, YIELD = 200e3, 250.0
IDEAL = ct.Mises(E=E, nu=0.3, yield_stress=YIELD)
B, H, L = 2.0, 10.0, 200.0
RECTANGLE = ct.profiles.rectangle(B, H)
INERTIA = B * H**3 / 12.0
FIRST, FULL = YIELD * B * H**2 / 6.0, YIELD * B * H**2 / 4.0
LAWS = {
    "ideal": IDEAL,
    "isotropic": ct.Mises(E=E, nu=0.3, yield_stress=YIELD, isotropic=5e3),
    "kinematic": ct.Mises(E=E, nu=0.3, yield_stress=YIELD, kinematic=5e3),
    "table, two back-stresses": ct.Mises(
        E=E,
        nu=0.3,
        yield_curve=[(250.0, 0.0), (300.0, 0.01), (320.0, 0.05)],
        chaboche=[(2e4, 200.0), (3e3, 10.0)],
    ),
    "rate": ct.Mises(E=E, nu=0.3, yield_stress=YIELD, rate=ct.CowperSymonds(D=40.0, n=5.0)),
    "creep": ct.Mises(E=E, nu=0.3, rate=ct.Norton(1e-12, 4.0)),
    "Johnson-Cook": ct.JohnsonCook(E=E, nu=0.3, A=250.0, B=300.0, n=0.4, C=0.02, rate=1.0),
}
CYCLE = np.concatenate(
    [np.linspace(0.001, 0.01, 7), np.linspace(0.008, -0.012, 9), np.linspace(-0.009, 0.02, 9)]
)


@pytest.mark.parametrize("name", LAWS)
def test_a_law_along_a_line_is_that_of_a_plane_whose_side_is_free(name: str) -> None:
    import corota._core as core

    law = LAWS[name]
    time = 0.1 * np.arange(1, len(CYCLE) + 1)
    strain = np.stack([CYCLE, 0 * CYCLE, 0 * CYCLE], axis=1)
    one = core.material_path(
        law.law, law.parameters(), "line", strain, np.zeros(0), time.tolist(), 0.0, True
    )
    stress = one["stress"].reshape(-1, 3)[:, 0]
    assert stress == pytest.approx(law.uniaxial(CYCLE, time), abs=1e-9 * np.abs(stress).max())
    rows = [one[key].reshape(-1, 3, 3)[:, 0, 0] for key in ("tangent", "derivative")]
    # The tangent of dynamic recovery is the exact one: in one dimension it is symmetric.
    assert rows[0] == pytest.approx(rows[1], abs=1e-9 * E)


def bar(law: Any, *path: float) -> list[float]:
    """Forces of a bar of unit area and length that is stretched, by one increment each."""
    model = ct.Model(chain(1, 1.0))
    model.truss([0], material=law, area=1.0)
    model.fix([0])
    model.fix([1], x=None, y=0.0)
    found, steps = [], []
    for value in path:
        step = ct.Static(nlgeom=False, increments=1)
        step.fix([1], x=value, y=None)
        steps.append(step)
    results = ct.solve(model, steps)
    for number in range(1, len(path) + 1):
        found.append([f for f in results.frames if f.step == number][-1].RF[1, 0])
    return found


def test_a_bar_of_kinematic_hardening_in_a_cycle() -> None:
    slope = E * 5e3 / (E + 5e3)
    first = YIELD + slope * (0.01 - YIELD / E)
    # Yields again after twice the yield stress.
    second = first - 2 * YIELD - slope * (0.02 - 2 * YIELD / E)
    third = second + 2 * YIELD + slope * (0.02 - 2 * YIELD / E)
    found = bar(LAWS["kinematic"], 0.01, -0.01, 0.01)
    assert found == pytest.approx([first, second, third], rel=1e-10)


def test_a_bar_of_isotropic_hardening_in_a_cycle() -> None:
    slope = E * 5e3 / (E + 5e3)
    expected, stress, limit, strain = [], 0.0, YIELD, 0.0
    for end in (0.01, -0.01, 0.01):
        sign = np.sign(end - strain)
        elastic = (sign * limit - stress) / E
        stress = sign * (limit + slope * abs(end - strain - elastic))
        limit, strain = abs(stress), end
        expected.append(stress)
    assert bar(LAWS["isotropic"], 0.01, -0.01, 0.01) == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("increments", [1, 5])
def test_three_bars_at_their_limit(increments: int) -> None:
    """The limit load `yield A (1 + 2 cos a)`, and the elastic share before it."""
    angle = np.pi / 4
    mesh = lines(
        [(-1.0, 1.0), (0.0, 1.0), (1.0, 1.0), (0.0, 0.0)], ("line2", [[0, 3], [1, 3], [2, 3]])
    )
    model = ct.Model(mesh)
    model.truss([0, 1, 2], material=IDEAL, area=2.0)
    model.fix([0, 1, 2])
    model.fix([3], x=None, y=-0.05)
    results = ct.solve(model, ct.Static(nlgeom=False, increments=increments))
    frame = results.frames[-1]
    limit = YIELD * 2.0 * (1 + 2 * np.cos(angle))
    assert -frame.RF[3, 1] == pytest.approx(limit, rel=1e-10)
    # The bars at an angle stretch by cos^2: the plastic work is that of the rest.
    strain = 0.05 * np.array([np.cos(angle) ** 2, 1.0, np.cos(angle) ** 2])
    volume = 2.0 * np.array([np.sqrt(2.0), 1.0, np.sqrt(2.0)])
    dissipated = YIELD * (volume * (strain - YIELD / E)).sum()
    assert frame.scalars["ALLPD"] == pytest.approx(dissipated, rel=1e-9)
    assert frame.fields[0].values["PEEQ"].ravel() == pytest.approx(strain - YIELD / E, rel=1e-9)


def test_a_plastic_toggle_snaps_through() -> None:
    """Two bars at a rise, pressed flat and beyond: an explicit history of the nominal strain."""
    rise, half = 1.0, 10.0
    length = np.hypot(half, rise)
    mesh = lines([(0.0, 0.0), (half, rise), (2 * half, 0.0)], ("line2", [[0, 1], [1, 2]]))
    model = ct.Model(mesh)
    model.truss([0, 1], material=IDEAL, area=1.0)
    model.fix([0, 2])
    model.fix([1], x=0.0, y=None)
    model.fix([1], x=None, y=-2.0 * rise)
    results = ct.solve(model, ct.Static(increments=20))
    plastic, worst = 0.0, 0.0
    for frame in results.frames[1:]:
        height = rise + frame.U[1, 1]
        now = np.hypot(half, height)
        strain = now / length - 1.0
        trial = E * (strain - plastic)
        stress = np.clip(trial, -YIELD, YIELD)
        plastic += (trial - stress) / E
        expected = 2.0 * stress * height / now
        worst = max(worst, abs(frame.RF[1, 1] - expected))
    assert len(results.frames) == 21
    assert plastic < -1e-3
    assert worst < 1e-9 * YIELD


@pytest.mark.parametrize("elements", [1, 3])
def test_moment_and_curvature_of_a_rectangle(elements: int) -> None:
    """`M = M_p - (M_p - M_y) (k_y / k)^2`, unloading along the elastic line to `M / EI`."""
    curvature = 3.0 * FIRST / (E * INERTIA)
    model = ct.Model(chain(elements, L))
    model.beam(np.arange(elements), material=IDEAL, profile=RECTANGLE)
    model.fix([0], rotation=True)
    turn, back = (ct.Static(nlgeom=False, increments=1) for _ in range(2))
    turn.fix([elements], rotation=curvature * L, x=None, y=None)
    back.fix([elements], rotation=0.5 * curvature * L, x=None, y=None)
    results = ct.solve(model, [turn, back])
    first, last = results.frames[1], results.frames[-1]
    moment = FULL - (FULL - FIRST) / 9.0
    # Half a layer of a tenth of the height stands for the edge of the elastic core.
    assert first.RF[elements, 2] == pytest.approx(moment, rel=2e-3)
    unloaded = first.RF[elements, 2] - 0.5 * curvature * E * INERTIA
    assert last.RF[elements, 2] == pytest.approx(unloaded, rel=1e-9)
    values = first.fields[0].values
    plastic = curvature - first.RF[elements, 2] / (E * INERTIA)
    halves = sum(float(values[name].sum()) for name in ("PR1", "PR2"))
    assert halves == pytest.approx(plastic * L, rel=1e-9)
    stress, strain, _ = first.fields[0].fibers[0, 0].T
    assert stress[[0, -1]] == pytest.approx([YIELD, -YIELD], rel=1e-9)
    assert strain[[0, -1]] == pytest.approx([0.5 * H * curvature, -0.5 * H * curvature], rel=1e-9)


@pytest.mark.parametrize("share", [0.1, 0.3, 0.6])
def test_axial_force_reduces_the_plastic_moment(share: float) -> None:
    """Of a rectangle: `M / M_p = 1 - (N / N_p)^2`."""
    model = ct.Model(chain(1, L))
    model.beam([0], material=IDEAL, profile=ct.profiles.rectangle(B, H, layers=40))
    model.fix([0], rotation=True)
    model.force([1], x=share * YIELD * B * H)
    pull, turn = ct.Static(nlgeom=False, increments=1), ct.Static(nlgeom=False, increments=1)
    turn.fix([1], rotation=100.0 * FIRST * L / (E * INERTIA), x=None, y=None)
    frame = ct.solve(model, [pull, turn]).frames[-1]
    assert frame.RF[1, 2] == pytest.approx(FULL * (1 - share**2), rel=1e-3)
    assert frame.fields[0].values["N"].item() == pytest.approx(share * YIELD * B * H, rel=1e-6)


def deformed(law: Any, angle: float = 0.0, profile: Any = RECTANGLE) -> tuple[System, np.ndarray]:
    """A system of one beam in a state that flows, turned by an angle."""
    points = np.array([(0.3, 0.1), (100.2, 60.9)])
    model = ct.Model(lines([tuple(p) for p in points], ("line2", [[0, 1]])))
    model.beam([0], material=law, profile=profile)
    system = System(model, SOLVERS["multifrontal"](), 1)
    system.core.set_clock(0.1, 0.1, True)
    u = np.array([[0.2, -0.1, 0.06], [0.9, 0.3, -0.05]])
    c, s = np.cos(angle), np.sin(angle)
    moved = (points + u[:, :2]) @ np.array([[c, s], [-s, c]]) - points
    state = np.column_stack([moved, u[:, 2] + angle])
    return system, system.from_nodes(state)


def stiffness(system: System, values: np.ndarray) -> np.ndarray:
    import scipy.sparse as sp

    n = system.n_dofs
    upper = sp.csc_array((values, system.pattern.indices, system.pattern.indptr), shape=(n, n))
    full = upper.toarray()
    return np.asarray(full + np.triu(full, 1).T)


@pytest.mark.parametrize("name", LAWS)
def test_tangent_is_the_derivative_of_the_force(name: str) -> None:
    """Against the same numbers with derivatives, and against differences."""
    system, u = deformed(LAWS[name])
    core = system.core
    top = np.abs(stiffness(system, system.evaluate(0.0 * u, 0.0).values)).max()
    k = stiffness(system, system.evaluate(u, 0.0).values)
    for row, weight in enumerate(np.eye(system.n_dofs)):
        exact = core.differentiate(u, True, weight, [], ["displacements"])["displacements"]
        # Ideal laws keep a share of 1e-9 of their stiffness.
        assert np.abs(exact - k[row]).max() < 1e-8 * top
    for column in range(system.n_dofs):
        step = np.zeros(system.n_dofs)
        step[column] = 1e-7
        slope = (
            system.evaluate(u + step, 0.0).internal - system.evaluate(u - step, 0.0).internal
        ) / 2e-7
        # A fiber may begin to flow within the step.
        assert np.abs(slope - k[:, column]).max() < 2e-3 * top


@pytest.mark.parametrize("name", LAWS)
def test_forces_turn_with_the_beam(name: str) -> None:
    base, u = deformed(LAWS[name])
    still = base.by_node(base.evaluate(u, 0.0).internal)
    for angle in (0.8, 3.0):
        system, turned = deformed(LAWS[name], angle)
        c, s = np.cos(angle), np.sin(angle)
        found = system.by_node(system.evaluate(turned, 0.0).internal)
        expected = still.copy()
        expected[:, :2] = still[:, :2] @ np.array([[c, s], [-s, c]])
        assert np.abs(found - expected).max() < 1e-9 * np.abs(still).max()


def test_numbers_in_lanes_agree_with_single_ones() -> None:
    n = 9
    forces = []
    for lanes in ("scalar", "best"):
        model = ct.Model(chain(n, L))
        model.beam(np.arange(n), material=LAWS["isotropic"], profile=RECTANGLE)
        system = System(model, SOLVERS["multifrontal"](), 1)
        system.core.set_lanes(lanes)
        u = 0.03 * np.random.default_rng(3).standard_normal(system.n_dofs)
        forces.append(system.evaluate(u, 0.0).internal)
    assert np.abs(forces[0] - forces[1]).max() < 1e-11 * np.abs(forces[0]).max()


def cantilever(law: Any, n: int = 4, **options: Any) -> ct.Model:
    model = ct.Model(chain(n, L))
    options = {"profile": RECTANGLE, **options}
    model.beam(np.arange(n), material=law, **options)
    model.fix([0], rotation=True)
    return model


def test_an_elastic_state_is_that_of_the_elastic_beam() -> None:
    found = []
    for law in (ct.Elastic(E=E, nu=0.3), LAWS["isotropic"]):
        model = cantilever(law)
        model.force([4], x=-20.0, y=0.4 * FIRST / L)
        frame = ct.solve(model, ct.Static(increments=2)).frames[-1]
        values = frame.fields[0].values
        found.append([*frame.U[4], frame.UR[4], *values["M1"].ravel(), *values["V"].ravel()])
    assert found[1] == pytest.approx(found[0], rel=1e-9)


def test_energy_account_closes_in_a_cycle_with_large_rotation() -> None:
    model = cantilever(LAWS["kinematic"])
    steps = []
    for value in (80.0, -60.0, 0.0):
        step = ct.Static(increments=80)
        step.fix([4], x=None, y=value)
        steps.append(step)
    frame = ct.solve(model, steps).frames[-1]
    assert frame.scalars["ALLPD"] > 0.5 * frame.scalars["ALLWK"] > 0.0
    assert abs(frame.scalars["energy balance error"]) < 2e-3


def test_self_stress_of_the_profile_moves_the_first_yield_and_keeps_the_limit() -> None:
    """Stress of rolling, `s (1 - 3 z^2)` with z over half the height, has no resultants; the
    compressed surfaces yield earlier, and the plastic moment stays."""
    rolled = RECTANGLE.with_stress(lambda y: 0.5 * YIELD * (1.0 - 3.0 * (2.0 * y / H) ** 2))
    assert rolled.fibers[:, 1] @ rolled.fibers[:, 2] == pytest.approx(0.0, abs=1e-9 * YIELD * B * H)
    alone = ct.solve(cantilever(IDEAL, profile=rolled), ct.Static(nlgeom=False)).frames[-1]
    assert np.abs(alone.U).max() < 1e-9
    assert alone.fields[0].fibers[0, 0, 0, 0] == pytest.approx(-YIELD, rel=1e-9)
    moments = []
    for profile in (RECTANGLE, rolled):
        model = cantilever(IDEAL, profile=profile, shear_area=0.0)
        early, late = (ct.Static(nlgeom=False, increments=1) for _ in range(2))
        early.fix([4], x=None, y=0.99 * FIRST / L * L**3 / (3 * E * INERTIA))
        late.fix([4], x=None, y=40.0 * FIRST / L * L**3 / (3 * E * INERTIA))
        results = ct.solve(model, [early, late])
        ends = [results.frames[1], results.frames[-1]]
        moments.append([f.fields[0].values["M1"][0, 0] for f in ends])
    assert moments[0][0] == pytest.approx(0.99 * FIRST, rel=1e-9)
    assert abs(moments[1][0]) < 0.98 * abs(moments[0][0])
    assert moments[1][1] == pytest.approx(moments[0][1], rel=1e-3)
    assert abs(moments[0][1]) == pytest.approx(FULL, rel=5e-3)


@pytest.mark.parametrize("kind", ["truss", "beam"])
def test_a_held_bar_that_was_heated_keeps_its_self_stress(kind: str) -> None:
    alpha, hot = 1.2e-5, 200.0
    law = ct.Mises(E=E, nu=0.3, yield_stress=YIELD, expansion=alpha)
    model = ct.Model(chain(1, L))
    if kind == "truss":
        model.truss([0], material=law, area=B * H)
        model.fix([0, 1])
    else:
        model.beam([0], material=law, profile=RECTANGLE)
        model.fix([0, 1], rotation=True)
    heat, cool = (ct.Static(nlgeom=False, increments=1) for _ in range(2))
    heat.temperature(hot)
    cool.temperature(0.0)
    results = ct.solve(model, [heat, cool])
    found = [f.fields[0].values["N"].item() / (B * H) for f in results.frames[1:]]
    # Heated it yields in compression; what flowed is missing when it is cold.
    flow = alpha * hot - YIELD / E
    assert found == pytest.approx([-YIELD, E * flow], rel=1e-9)
    scalars = results.frames[-1].scalars
    assert scalars["ALLPD"] == pytest.approx(YIELD * flow * B * H * L, rel=1e-9)


def test_a_checkpoint_goes_on_to_the_bit() -> None:
    step = ct.Static(increments=10)
    step.fix([4], x=None, y=70.0)
    takes = Takes()
    law = LAWS["table, two back-stresses"]
    whole = ct.solve(cantilever(law), step, observers=[takes], threads=1)
    again = ct.solve(cantilever(law), step, threads=1, start=takes.found[5])
    for key in ("fibers", "forces"):
        a, b = (getattr(r.frames[-1].fields[0], key) for r in (whole, again))
        np.testing.assert_array_equal(b, a)


@pytest.mark.parametrize("kind", ["truss", "beam"])
def test_the_energy_momentum_step_keeps_the_account(kind: str) -> None:
    law = ct.Mises(E=E, nu=0.3, yield_stress=YIELD, isotropic=2e3, rho=7.8e-9)
    if kind == "beam":
        model = cantilever(law)
        model.force([4], y=1.1 * FULL / L)
    else:
        points = [(0.0, 0.0), (100.0, 20.0), (200.0, 0.0)]
        model = ct.Model(lines(points, ("line2", [[0, 1], [1, 2]])))
        model.truss([0, 1], material=law, area=2.0)
        model.fix([0, 2])
        model.force([1], y=-150.0)
    step = ct.Dynamic(scheme="energy_momentum", period=0.01, increments=50)
    results = ct.solve(model, step)
    scalars = results.frames[-1].scalars
    assert scalars["ALLPD"] > 0.5 * scalars["ALLWK"] > 0.0
    assert max(abs(f.scalars["energy balance error"]) for f in results.frames) < 1e-6


def test_a_yield_stress_that_follows_the_temperature() -> None:
    cold, hot = (ct.Mises(E=E, nu=0.3, yield_stress=s) for s in (300.0, 120.0))
    law = ct.MaterialTable([(20.0, cold), (600.0, hot)])
    model = cantilever(law)
    step = ct.Static(nlgeom=False)
    step.temperature(310.0)
    step.fix([4], x=None, y=100.0)
    frame = ct.solve(model, step).frames[-1]
    moment = abs(frame.fields[0].values["M1"][0, 0])
    assert moment == pytest.approx(210.0 * RECTANGLE.plastic_modulus, rel=2e-3)


def test_a_hinge_stands_at_the_node() -> None:
    """A cantilever of one element: the hinge at the clamp turns, its moment is the plastic one."""
    model = cantilever(IDEAL, n=1)
    sink = 60.0
    model.fix([1], x=None, y=-sink)
    frame = ct.solve(model, ct.Static(nlgeom=False, increments=1)).frames[-1]
    force = -frame.RF[1, 1]
    assert force * L == pytest.approx(FULL, rel=5e-3)
    elastic = force * L**3 / (3 * E * INERTIA)
    hinge = frame.fields[0].values["PR1"].item()
    # The rest flows beside the hinge.
    assert abs(hinge) == pytest.approx((sink - elastic) / L, rel=2e-2)
    assert frame.fields[0].values["PR2"].item() == pytest.approx(0.0, abs=1e-12)


@pytest.mark.slow
def test_a_cantilever_in_large_rotation_follows_a_fine_mesh_of_solids() -> None:
    """Tip force in plane stress, hardening, a tip displacement of half the length: 16 x 0.25 % of
    solids beside beams, and beams in one quarter of the increments."""
    length, height, down = 100.0, 4.0, -50.0
    law = ct.Mises(E=E, nu=0.0, yield_stress=YIELD, isotropic=2000.0)
    found = []
    for n in (20, 40):
        model = ct.Model(chain(n, length))
        model.beam(np.arange(n), material=law, profile=ct.profiles.rectangle(1.0, height))
        model.fix([0], rotation=True)
        model.fix([n], x=None, y=down)
        frame = ct.solve(model, ct.Static(increments=40)).frames[-1]
        found.append([frame.RF[n, 1], frame.U[n, 0]])
    mesh = ct.mesh.rectangle(length, height, nx=100, ny=6, cell="quad8")
    solid = ct.Model(mesh)
    solid.section("all", element="Q8R", material=law)
    left = mesh.nodes_of("left")
    solid.fix(left, x=0.0, y=None)
    middle = left[np.argmin(np.abs(mesh.points[left, 1] - 0.5 * height))]
    solid.fix([middle], x=None, y=0.0)
    right = mesh.nodes_of("right")
    tip = right[np.argmin(np.abs(mesh.points[right, 1] - 0.5 * height))]
    solid.fix([tip], x=None, y=down)
    frame = ct.solve(solid, ct.Static(increments=40)).frames[-1]
    expected = [frame.RF[tip, 1], frame.U[tip, 0]]
    assert found[0] == pytest.approx(expected, rel=1e-2)
    assert found[1] == pytest.approx(found[0], rel=1e-2)


def test_what_a_plastic_line_lacks_is_named() -> None:
    model = ct.Model(chain(1, 1.0))
    with pytest.raises(ct.InputError, match="shape of its cross-section"):
        model.beam([0], material=IDEAL, area=1.0, inertia=1.0)
    with pytest.raises(ct.InputError, match="either a profile"):
        model.beam([0], material=IDEAL, profile=RECTANGLE, area=1.0)
    with pytest.raises(ct.InputError, match="a profile, or its area"):
        model.beam([0], material=ct.Elastic(E=E))
    hill = ct.Hill(E=E, nu=0.3, yield_stress=YIELD)
    model.truss([0], material=hill, area=1.0)
    model.fix([0, 1])
    with pytest.raises(ct.ModelError, match="von Mises"):
        ct.solve(model)
