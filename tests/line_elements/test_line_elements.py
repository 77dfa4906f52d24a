"""Trusses, beams and springs: closed forms, joints with drilling elements, tangents."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import SOLVERS
from corota.mesh.data import Cells
from corota.model import elements
from corota.model.sections import Section
from support.lines import chain, lines

MATERIAL = ct.Elastic(E=1000.0, nu=0.25)
PROFILES = {"BEAM": (3.0, 0.7, 0.5), "SPRING1R": (3.0, 2.0, 2.0), "SPRING2R": (3.0, 2.0, 2.0)}


@pytest.mark.parametrize("shear_area", [0.0, 0.08])
def test_cantilever_of_timoshenko_beams_is_exact_at_its_nodes(shear_area: float) -> None:
    model = ct.Model(chain(3, 2.0))
    model.beam([0, 1, 2], material=MATERIAL, area=0.1, inertia=1e-3, shear_area=shear_area)
    model.fix([0], rotation=True)
    model.force([3], y=-1e-3)
    frame = ct.solve(model, ct.Static(nlgeom=False)).frames[-1]
    shear = 2.0 / (400.0 * shear_area) if shear_area else 0.0
    assert frame.U[3, 1] == pytest.approx(-1e-3 * (8.0 / 3.0 + shear), rel=1e-10)
    assert frame.UR[3] == pytest.approx(-2e-3, rel=1e-10)
    values = frame.fields[0].values
    # Moments are positive where they stretch the right (lower) side.
    assert values["M1"].ravel() == pytest.approx([-2e-3, -4e-3 / 3.0, -2e-3 / 3.0], rel=1e-9)
    assert values["M2"].ravel()[2] == pytest.approx(0.0, abs=1e-14)
    assert np.abs(values["V"]).ravel() == pytest.approx(1e-3, rel=1e-9)
    assert values["N"].ravel() == pytest.approx(0.0, abs=1e-12)


def test_beam_rolls_up_to_a_circle() -> None:
    n = 20
    model = ct.Model(chain(n, 2.0))
    model.beam(np.arange(n), material=MATERIAL, area=10.0, inertia=1e-3)
    model.fix([0], rotation=True)
    model.force([n], moment=np.pi)
    frame = ct.solve(model, ct.Static(increments=8)).frames[-1]
    assert frame.UR[n] == pytest.approx(2.0 * np.pi, rel=1e-10)
    assert frame.U[n] == pytest.approx([-2.0, 0.0], abs=1e-9)


def test_two_bar_truss_in_large_displacement() -> None:
    mesh = lines([(0.0, 0.0), (1.0, 0.2), (2.0, 0.0)], ("line2", [[0, 1], [1, 2]]))
    model = ct.Model(mesh)
    model.truss([0, 1], material=MATERIAL, area=1.0)
    model.fix([0, 2])
    model.force([1], y=-2.0)
    frame = ct.solve(model, ct.Static(increments=2)).frames[-1]
    height = 0.2 + frame.U[1, 1]
    before, now = np.hypot(1.0, 0.2), np.hypot(1.0, height)
    axial = 1000.0 * (now - before) / before
    assert 2.0 * axial * height / now == pytest.approx(-2.0, rel=1e-8)
    assert frame.fields[0].values["N"].ravel() == pytest.approx(axial, rel=1e-8)
    assert frame.scalars["strain energy"] == pytest.approx(
        0.5 * 1000.0 * (now - before) ** 2 / before * 2.0, rel=1e-8
    )


def test_springs_along_lines_and_to_the_ground() -> None:
    mesh = lines([(0.0, 0.0), (1.0, 0.0)], ("line2", [[0, 1]]), ("point1", [[1], [1]]))
    model = ct.Model(mesh)
    model.spring([0], 10.0)
    model.spring([1], 3.0, "y")
    model.spring([2], 5.0, "x")
    model.fix([0])
    model.force([1], x=1.5, y=0.3)
    frame = ct.solve(model, ct.Static(nlgeom=False)).frames[-1]
    assert frame.U[1] == pytest.approx([0.1, 0.1], rel=1e-12)
    assert frame.scalars["strain energy"] == pytest.approx(0.09, rel=1e-12)


def test_torsion_spring_between_two_beams() -> None:
    mesh = lines(
        [(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (2.0, 0.0)], ("line2", [[0, 1], [2, 3], [1, 2]])
    )
    model = ct.Model(mesh)
    model.beam([0, 1], material=MATERIAL, area=1.0, inertia=0.1)
    model.spring([2], 4.0, "rotation")
    model.equation((2, "x", 1.0), (1, "x", -1.0))
    model.equation((2, "y", 1.0), (1, "y", -1.0))
    model.fix([0], rotation=True)
    model.force([3], moment=0.5)
    frame = ct.solve(model, ct.Static(increments=2)).frames[-1]
    assert frame.UR[2] - frame.UR[1] == pytest.approx(0.5 / 4.0, rel=1e-9)


@pytest.mark.parametrize("element", ["Q4D", "OPT"])
def test_a_moment_passes_from_a_beam_into_drilling_elements(element: str) -> None:
    kind = "tri3" if element == "OPT" else "quad4"
    plate = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=2, cell=kind)
    middle = int(np.argmin(np.hypot(*(plate.points - [2.0, 0.5]).T)))
    points = np.vstack([plate.points, [[4.0, 0.5]]])
    beam = Cells("line2", np.array([[middle, len(points) - 1]]), np.array([1000]))
    mesh = replace(
        plate, points=points, cells=[*plate.cells, beam], node_labels=np.arange(1, len(points) + 1)
    )
    model = ct.Model(mesh)
    model.section(np.arange(plate.n_cells), element=element, material=MATERIAL)
    model.beam([plate.n_cells], material=MATERIAL, area=1.0, inertia=1.0 / 12.0)
    model.fix("left", rotation=True)
    model.force([len(points) - 1], moment=0.5)
    frame = ct.solve(model, ct.Static()).frames[-1]
    left = mesh.nodes_of("left")
    here = points[left] + frame.U[left]
    force = frame.RF[left]
    moment = force[:, 2] + force[:, 1] * here[:, 0] - force[:, 0] * here[:, 1]
    assert moment.sum() == pytest.approx(-0.5, rel=1e-9)
    assert np.abs(force[:, :2].sum(axis=0)).max() < 1e-9
    # The inner moment of the beam is the same at both ends.
    values = frame.fields[1].values
    assert values["M1"] == pytest.approx(0.5, rel=1e-9)
    assert values["M2"] == pytest.approx(0.5, rel=1e-9)


def alone(element: str) -> System:
    """The system of one element."""
    facts = elements.find(element)
    points = [(0.3, 0.1), (1.2, 0.9)][: facts.n_nodes]
    model = ct.Model(lines(points, (facts.cell, [list(range(facts.n_nodes))])))
    profile = PROFILES.get(element, (3.0, 1.0, 0.0))
    model.sections.append(Section(np.array([0]), element, MATERIAL, profile[0], profile=profile))
    return System(model, SOLVERS["multifrontal"](), 1)


def stiffness(system: System, values: np.ndarray) -> np.ndarray:
    n = system.n_dofs
    upper = sp.csc_array(
        (values, system.pattern.indices, system.pattern.indptr), shape=(n, n)
    ).toarray()
    return upper + np.triu(upper, 1).T


@pytest.mark.parametrize("element", elements.line_names())
def test_tangent_is_the_derivative_of_the_force(element: str) -> None:
    system = alone(element)
    u = 0.5 * np.random.default_rng(1).standard_normal(system.n_dofs)
    k = stiffness(system, system.evaluate(u, 0.0).values)
    h = 1e-6
    for column, step in enumerate(h * np.eye(system.n_dofs)):
        slope = (
            system.evaluate(u + step, 0.0).internal - system.evaluate(u - step, 0.0).internal
        ) / (2.0 * h)
        assert np.abs(slope - k[:, column]).max() < 1e-8 * np.abs(k).max()


@pytest.mark.parametrize("element", [e for e in elements.line_names() if elements.find(e).turns])
def test_rigid_motion_makes_no_force(element: str) -> None:
    system = alone(element)
    x = system.model.mesh.points
    for angle in (0.7, 2.9, -8.0):
        c, s = np.cos(angle), np.sin(angle)
        moved = x @ np.array([[c, s], [-s, c]]) + [3.0, -2.0] - x
        u = system.from_nodes(np.column_stack([moved, np.full(len(x), angle)]))
        at = system.evaluate(u, 0.0)
        assert np.abs(at.internal).max() < 1e-11 * np.abs(at.values).max()


@pytest.mark.parametrize(
    ("element", "zero"),
    [
        ("TRUSS", 3),
        ("BEAM", 3),
        ("SPRING", 3),
        ("SPRING1", 1),
        ("SPRING1R", 2),
        ("SPRING2", 3),
        ("SPRING2R", 5),
    ],
)
def test_zero_modes(element: str, zero: int) -> None:
    system = alone(element)
    k = stiffness(system, system.evaluate(np.zeros(system.n_dofs), 0.0).values)
    values = np.linalg.eigvalsh(k)
    assert (np.abs(values) < 1e-11 * np.abs(values).max()).sum() == zero
    assert values.min() > -1e-11 * values.max()


@pytest.mark.parametrize("kind", ["lumped", "constant", "consistent"])
def test_mass_of_beams(kind: str) -> None:
    mesh = chain(4, 2.0)
    model = ct.Model(mesh)
    heavy = ct.Elastic(E=1000.0, nu=0.25, rho=2.0)
    model.beam(np.arange(4), material=heavy, area=0.3, inertia=0.01)
    system = System(model, SOLVERS["multifrontal"](), 1)
    zero = np.zeros(system.n_dofs)
    spin = 0.4
    v = system.from_nodes(
        np.column_stack([-spin * mesh.points[:, 1], spin * mesh.points[:, 0], np.full(5, spin)])
    )
    kinetic, _, _, angular, mass = system.core.momenta(zero, v, kind, False)
    assert mass == pytest.approx(2.0 * 0.3 * 2.0, rel=1e-12)
    if kind != "lumped":
        inertia = 2.0 * (0.3 * 2.0**3 / 3.0 + 0.01 * 2.0)
        assert kinetic == pytest.approx(0.5 * inertia * spin**2, rel=1e-12)
        assert angular == pytest.approx(inertia * spin, rel=1e-12)


def test_a_line_without_length_is_named() -> None:
    model = ct.Model(lines([(0.0, 0.0), (0.0, 0.0)], ("line2", [[0, 1]])))
    model.truss([0], material=MATERIAL, area=1.0)
    with pytest.raises(ct.ModelError, match="element 1 has no length"):
        ct.solve(model)


@pytest.mark.parametrize(
    ("area", "inertia", "shear_area"), [(0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, -1.0)]
)
def test_numbers_of_a_beam_are_checked(area: float, inertia: float, shear_area: float) -> None:
    model = ct.Model(chain(1, 1.0))
    with pytest.raises(ct.InputError):
        model.beam([0], material=MATERIAL, area=area, inertia=inertia, shear_area=shear_area)


def test_picture_of_the_model_shows_lines_masses_and_links(tmp_path) -> None:
    pytest.importorskip("matplotlib")
    from corota import plots

    mesh = lines(
        [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (3.0, 0.0)],
        ("line2", [[0, 1], [1, 2], [2, 3], [2, 4]]),
        ("point1", [[2], [1]]),
    )
    model = ct.Model(mesh)
    model.beam([0], material=MATERIAL, area=1.0, inertia=0.1)
    model.truss([1], material=MATERIAL, area=1.0)
    model.spring([2], 3.0)
    model.spring([4], 3.0, "y")
    model.spring([5], 2.0, "rotation")
    model.dashpot(2, 4, c=1.0)
    model.point_mass([3], 2.0)
    model.rigid([4], 3)
    figure = plots.model(model, path=tmp_path / "model.png")
    drawn = [
        len(c.get_segments()) for c in figure.axes[0].collections if hasattr(c, "get_segments")
    ]
    # Beam, truss, both springs, dashpot, link; edges and outline of no cell.
    assert sorted(n for n in drawn if n) == [1, 1, 1, 1, 2]
    assert (tmp_path / "model.png").stat().st_size > 2_000
