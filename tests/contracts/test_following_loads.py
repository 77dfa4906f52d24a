"""Loads that depend on the displacement: exact stiffness, current normals, potentials.

The class of defect: a load evaluated on the undeformed shape in a geometrically nonlinear
step, or a load stiffness that is not the derivative of the load.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.analysis.distributed_forces import LoadSum
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from corota.model.constraints import LocalAxes
from corota.model.loads import NodalForce
from corota.model.steps import Buckle, Static
from support.models import DRILLING, ELEMENTS, cell

LOADS = ("traction", "total", "pressure", "follow", "shear", "turning", "gravity", "centrifugal")
MASSES = ("consistent", "constant", "lumped")


def loaded(element: str, kind: str) -> ct.Model:
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 2, 2, cell(element)), 0.2)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(10.0, 0.3, rho=3.0), thickness=0.7)
    match kind:
        case "traction":
            model.traction("right", x=2.0, y=-1.0)
        case "total":
            mesh.edge_sets["end"] = mesh.edge_sets["right"]
            model.force("end", x=2.0, y=-1.0)
        case "pressure":
            model.pressure(mesh.boundary_edges(), 1.5)
        case "follow":
            model.traction(mesh.boundary_edges(), x=2.0, y=-1.0, follow=True)
        case "shear":
            model.shear(mesh.boundary_edges(), -1.5)
        case "turning":
            model.loads.append(NodalForce([1, 3], 1, np.array([2.0, -1.0]), follower=True))
        case "gravity":
            model.gravity(x=2.0, y=-3.0)
        case _:
            # On a part of the mass only, about a point outside.
            model.centrifugal(1.3, about=(-0.4, 0.7), cells=np.arange(mesh.n_cells // 2))
    return model


def dense(system: System, values: np.ndarray, triplets: object) -> np.ndarray:
    n = system.n_dofs
    upper = np.zeros((n, n))
    columns = np.repeat(np.arange(n), np.diff(system.pattern.indptr.astype(int)))
    np.add.at(upper, (system.pattern.indices, columns), values)
    full = upper + np.triu(upper, 1).T
    if triplets is not None:
        rows, cols, entries = triplets  # type: ignore[misc]
        np.add.at(full, (rows, cols), -entries)
    return full


def ready(model: ct.Model, mass: str = "consistent", nlgeom: bool = True) -> System:
    system = System(model, Multifrontal())
    zero = np.zeros(system.n_dofs)
    system.begin(Static(nlgeom=nlgeom), 0.0, zero, None)
    system.conditions.set_mass(mass)
    return system


def moved(system: System) -> np.ndarray:
    """A turn by 2 rad with large random displacements and rotations on top."""
    x = system.model.mesh.points
    c, s = np.cos(2.0), np.sin(2.0)
    turned = np.column_stack([x @ [[c, s], [-s, c]] - x, np.full(len(x), 2.0)])
    noise = 0.15 * np.random.default_rng(5).standard_normal(turned.shape)
    return system.from_nodes(turned + noise)


@pytest.mark.parametrize("kind", LOADS)
@pytest.mark.parametrize("element", ELEMENTS)
def test_load_stiffness_is_the_derivative_of_the_load(element: str, kind: str) -> None:
    """Against central differences of the force at a large displacement."""
    if kind == "turning" and element not in DRILLING:
        pytest.skip("no rotation to turn with")
    for mass in MASSES if kind in ("gravity", "centrifugal") else MASSES[:1]:
        system = ready(loaded(element, kind), mass)
        u = moved(system)
        values = np.zeros(len(system.pattern.indices))
        _, triplets = system.conditions.external(1.0, u, values)
        found = dense(system, values, triplets)
        h, load = 1e-6, system.conditions
        expected = np.empty_like(found)
        for column, one in enumerate(h * np.eye(system.n_dofs)):
            change = load.external(1.0, u + one)[0] - load.external(1.0, u - one)[0]
            expected[:, column] = -change / (2.0 * h)
        size = max(np.abs(expected).max(), 1.0)
        assert np.abs(found - expected).max() <= 1e-8 * size
        # Each has a potential, the pressure since the boundary is closed; what turns has none.
        if kind not in ("follow", "shear", "turning"):
            assert np.abs(found - found.T).max() <= 1e-12 * size


@pytest.mark.parametrize("kind", ["gravity", "centrifugal"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_what_is_worked_out_once_holds_at_every_displacement(element: str, kind: str) -> None:
    """Body loads against the core, evaluated for all elements at that displacement and mass.

    Masses and who carries them change after the first evaluation.
    """
    system = ready(loaded(element, kind))
    n, u = system.n_dofs, moved(system)
    light = np.arange(len(system.model.mesh.points)) % 5 == 0
    (load,) = (x.force for x in system.conditions.distributed.loads)
    for flags in (np.zeros(0, bool), light):
        for mass in MASSES:
            system.core.set_massless(flags)
            system.conditions.set_mass(mass)
            for scale, at, start in ((1.0, 0.3 * u, np.zeros(0)), (-0.7, u, 0.5 * u)):
                to = LoadSum(np.zeros(n), np.zeros(len(system.pattern.indices)), 0.4, start)
                load.add(scale, at, to)
                # A spin's scale is that of omega^2, the first value.
                value = [
                    scale * v if kind == "gravity" or i == 0 else v
                    for i, v in enumerate(load.item.value)
                ]
                force, stiffness = np.zeros(n), np.zeros_like(to.values)
                system.core.body_force(
                    kind, value, mass, load.masks, at, start, -0.4, force, stiffness
                )
                for found, expected in ((to.force, force), (to.values, stiffness)):
                    assert np.abs(found - expected).max() <= 1e-13 * np.abs(expected).max()


@pytest.mark.parametrize("kind", LOADS)
@pytest.mark.parametrize("element", DRILLING)
def test_moments_turn_with_the_body(element: str, kind: str) -> None:
    """The load on a body turned as a rigid one is that of the turned load on the body itself."""
    model = loaded(element, kind)
    if kind == "turning":
        model.axes.append(LocalAxes(np.array([3]), 0.4))
    system = ready(model)
    x, angle = system.model.mesh.points, 1.1
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    u = system.from_nodes(np.column_stack([x @ turn.T - x, np.full(len(x), angle)]))
    force = system.by_node(system.conditions.external(1.0, u)[0])
    other = ct.Model(system.model.mesh)
    other.sections, other.axes = system.model.sections, system.model.axes
    for load in system.model.loads:
        if isinstance(load, NodalForce):
            pass  # turns by itself
        elif load.kind in ("traction", "gravity"):
            load.value = tuple(turn.T @ load.value)
        elif load.kind == "centrifugal":
            load.value = (load.value[0], *(turn.T @ load.value[1:]))
        other.loads.append(load)
    system = ready(other)
    expected = system.by_node(system.conditions.external(1.0, np.zeros(system.n_dofs))[0])
    expected[:, :2] = expected[:, :2] @ turn.T
    assert np.abs(force - expected).max() <= 1e-12 * np.abs(expected).max()


@pytest.mark.filterwarnings("ignore:local strain")
@pytest.mark.parametrize("strain", ["linear", "logarithmic"])
@pytest.mark.parametrize("element", DRILLING)
def test_dead_traction_on_a_bar_turned_by_a_right_angle(element: str, strain: str) -> None:
    """Stress exactly 1 along the bar: equilibrium. With undeformed normals: .94 to 1.26."""
    mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 1.0, 8, 2, cell(element)), 0.1)
    model = ct.Model(mesh)
    material = ct.Elastic(1e7, 0.0)
    model.section("all", element=element, material=material, local_strain=strain)
    x = mesh.points
    left = mesh.nodes_of("left")
    model.fix(left, x=None, y=None, rotation=np.pi / 2.0)
    # The left edge turns about the origin into the x axis.
    for node in left:
        model.fix([int(node)], x=-x[node, 1] - x[node, 0], y=x[node, 0] - x[node, 1])
    pulled = ct.Model(mesh)
    pulled.traction("right", y=1.0)
    start = ct.solve(model, [Static(increments=8), Static(loads=pulled.loads)], fields=True)
    for block in start.frames[-1].fields:
        stress = block.values["S"].reshape(-1, 4)
        assert np.abs(stress - [0.0, 1.0, 0.0, 0.0]).max() <= 1e-5


@pytest.mark.filterwarnings("ignore:local strain")
@pytest.mark.parametrize("strain", ["linear", "logarithmic"])
@pytest.mark.parametrize("element", DRILLING)
def test_finite_pressure_all_round_scales_the_body(element: str, strain: str) -> None:
    """U = -c X with 10 % of shrinkage, no rotation, whatever the mesh.

    The moments must be those of the side as the element sees it, a bulge of the undeformed
    length: alpha p l0 l / 12, not alpha p l^2 / 12.
    """
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 3, 2, cell(element)), 0.2)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(10.0, 0.2), local_strain=strain)
    corner = int(np.argmax(mesh.points[:, 0] - mesh.points[:, 1]))
    model.fix([0])
    model.fix([corner], x=None)
    model.pressure(mesh.boundary_edges(), 1.25)
    frame = ct.solve(model, Static(), threads=1).frames[-1]
    shrink = -frame.U[corner, 0] / 2.0
    assert 0.08 < shrink < 0.12
    assert np.abs(frame.U + shrink * mesh.points).max() <= 1e-8
    assert np.abs(frame.UR).max() <= 1e-8


@pytest.mark.parametrize("element", ["Q4D", "OPT", "Q8"])
def test_a_ring_under_following_pressure_buckles_symmetrically(element: str) -> None:
    """p = 3 E I / R^3 for pressure that follows (Levy 1884; Timoshenko and Gere, 7.3).

    Q4D and OPT were refused as non-conservative: the partner force of the edge moment was
    missing.
    """
    radius, t, modulus = 10.0, 0.4, 1e5
    mesh = ct.mesh.annulus(
        radius - t / 2, radius + t / 2, n_radial=2, n_around=64, angle=360.0, cell=cell(element)
    )
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(modulus, 0.0))
    # Three dofs against rigid motion.
    x = mesh.points
    right, left, top = (int(np.argmax(x @ d)) for d in ([1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]))
    model.fix([right, left], x=None)
    model.fix([top], y=None)
    model.pressure("outer", 1.0)
    found = ct.solve(model, Buckle(modes=2)).modes[0].factors
    exact = 3.0 * modulus * t**3 / 12.0 / radius**3
    assert found == pytest.approx([exact, exact], rel=0.01)


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_following_traction_across_is_a_pressure(element: str) -> None:
    """And its resultant on an edge is along the current chord and the normal to it."""
    model = loaded(element, "")
    model.loads.clear()
    model.traction("right", x=-1.5, follow=True)
    other = loaded(element, "")
    other.loads.clear()
    other.pressure("right", 1.5)
    one, two = ready(model), ready(other)
    u = moved(one)
    force, expected = (s.conditions.external(1.0, u)[0] for s in (one, two))
    assert np.abs(force - expected).max() <= 1e-12 * np.abs(expected).max()
    shear = loaded(element, "")
    shear.loads.clear()
    shear.shear("right", 2.0)
    system = ready(shear)
    force = system.by_node(system.conditions.external(1.0, u)[0])[:, :2].sum(axis=0)
    here = system.model.mesh.points + system.by_node(u)[:, :2]
    ends = system.model.mesh.nodes_of("right")
    low, high = ends[np.argsort(system.model.mesh.points[ends, 1])[[0, -1]]]
    assert force == pytest.approx(0.7 * 2.0 * (here[high] - here[low]), rel=1e-10)


def test_a_beam_under_a_force_that_turns_with_its_tip() -> None:
    """A cantilever by finite rotation: Argyris and Symeonidis' follower column, by shooting."""
    from scipy.integrate import solve_ivp

    length, stiffness, force = 1.0, 1.0, 4.0
    # theta'' = -(P / EI) sin(theta - theta_tip + pi/2): force across the tip.
    n = 40
    points = np.column_stack([np.linspace(0.0, length, n + 1), np.zeros(n + 1)])
    lines = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    mesh = ct.Mesh(points, [ct.Cells("line2", lines, np.arange(1, n + 1))])
    model = ct.Model(mesh)
    model.beam(np.arange(n), material=ct.Elastic(1e4), area=1.0, inertia=stiffness / 1e4)
    model.fix([0], rotation=True)
    model.loads.append(NodalForce([n], 1, force, follower=True))
    frame = ct.solve(model, Static(increments=20), threads=1).frames[-1]

    def tip(angle: float) -> tuple[float, np.ndarray]:
        def slope(s: float, y: np.ndarray) -> list[float]:
            # Moment from the tip back: internal force is that at the tip, constant along.
            fx, fy = -force * np.sin(angle), force * np.cos(angle)
            return [
                y[1],
                -(fy * np.cos(y[0]) - fx * np.sin(y[0])) / stiffness,
                np.cos(y[0]),
                np.sin(y[0]),
            ]

        out = solve_ivp(slope, (length, 0.0), [angle, 0.0, 0.0, 0.0], rtol=1e-10, atol=1e-12)
        return float(out.y[0, -1]), out.y[:, -1]

    angles = (0.5, 3.0)
    from scipy.optimize import brentq

    angle = brentq(lambda a: tip(a)[0], *angles)
    end = -tip(angle)[1][2:]
    assert frame.UR[n] == pytest.approx(angle, rel=2e-3)
    assert frame.U[n] + points[n] == pytest.approx(end, abs=3e-3)
