"""Thermal strain: free parts stay free of stress, held ones carry the exact stress."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.model.materials import Expansion
from support.models import ELEMENTS, cell
from support.newton import solve_quadratically

E, NU, ALPHA = 1000.0, 0.3, 1e-3


def plate(element: str, material: ct.Elastic, **keys: object) -> ct.Model:
    """A distorted plate of 3 x 2 cells."""
    mesh = ct.mesh.rectangle(3.0, 2.0, nx=3, ny=2, cell=cell(element))
    inner = np.hypot(mesh.points[:, 0] - 1.0, mesh.points[:, 1] - 1.0) < 1e-9
    if cell(element) in ("tri3", "quad4"):
        mesh.points[inner] += [0.2, -0.15]
    model = ct.Model(mesh)
    model.section("all", element=element, material=material, **keys)  # type: ignore[arg-type]
    return model


def stresses(frame: ct.results.Frame) -> np.ndarray:
    """Stresses of all points, (n, 4)."""
    return np.concatenate([f.values["S"].reshape(-1, 4) for f in frame.fields])


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("element", ELEMENTS)
def test_free_expansion_is_free_of_stress(element: str, nlgeom: bool) -> None:
    model = plate(element, ct.Elastic(E, NU, expansion=ALPHA))
    model.fix([0])
    corner = int(np.argmin(np.hypot(*(model.mesh.points - [3.0, 0.0]).T)))
    model.fix([corner], x=None)
    model.initial_temperature(20.0)
    model.temperature(30.0)
    frame = ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1).frames[-1]
    assert pytest.approx(10.0 * ALPHA * model.mesh.points, abs=1e-9) == frame.U
    assert np.abs(stresses(frame)).max() < 1e-6 * E * 10.0 * ALPHA
    assert abs(frame.scalars["strain energy"]) < 1e-12 * E
    assert abs(frame.scalars["energy balance error"]) < 1e-3
    strain = np.concatenate([f.values["E"].reshape(-1, 4) for f in frame.fields])
    assert strain == pytest.approx(np.broadcast_to([0.01, 0.01, 0.01, 0.0], strain.shape), abs=1e-8)


@pytest.mark.parametrize("local_strain", ["green_lagrange", "logarithmic"])
@pytest.mark.parametrize("element", ["Q4I", "Q4D", "OPT", "Q9"])
def test_free_expansion_of_other_strains(element: str, local_strain: str) -> None:
    """The free stretch is 1 + a, as in CalculiX: E = a + a^2 / 2, or ln(1 + a)."""
    model = plate(element, ct.Elastic(E, NU, expansion=ALPHA), local_strain=local_strain)
    model.fix([0])
    corner = int(np.argmin(np.hypot(*(model.mesh.points - [3.0, 0.0]).T)))
    model.fix([corner], x=None)
    model.temperature(50.0)
    frame = ct.solve(model, ct.Static(), threads=1).frames[-1]
    assert pytest.approx(0.05 * model.mesh.points, abs=1e-8) == frame.U
    assert np.abs(stresses(frame)).max() < 1e-6 * E * 50.0 * ALPHA


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize(
    ("plane", "hold", "expected"),
    [
        ("stress", "x", (-E * ALPHA, 0.0, 0.0)),
        ("stress", "xy", (-E * ALPHA / (1.0 - NU), -E * ALPHA / (1.0 - NU), 0.0)),
        ("strain", "x", (-E * ALPHA / (1.0 - NU), 0.0, -E * ALPHA / (1.0 - NU))),
        ("strain", "xy", (-E * ALPHA / (1.0 - 2.0 * NU),) * 3),
    ],
)
def test_held_plate_carries_the_exact_stress(
    element: str, plane: str, hold: str, expected: tuple[float, float, float]
) -> None:
    """Hooke's law with the strains that are held at zero (Timoshenko and Goodier, ch. 13)."""
    model = plate(element, ct.Elastic(E, NU, expansion=ALPHA), plane=plane)
    for side in ("left", "right"):
        model.fix(side, y=None, rotation=True)
    model.fix("bottom", x=None, rotation=True)
    if hold == "xy":
        model.fix("top", x=None, rotation=True)
    model.temperature(1.0)
    # Frames of distorted elements turn by second order where lengths and heights part.
    frame = ct.solve(model, ct.Static(nlgeom=hold == "xy"), threads=1).frames[-1]
    found = stresses(frame)[:, :3]
    assert found == pytest.approx(np.broadcast_to(expected, found.shape), rel=1e-9, abs=1e-9)
    volume = sum(f.volume.sum() for f in frame.fields)
    # Elastic strains are the thermal ones of the held directions, with the other sign.
    energy = -0.5 * ALPHA * volume * sum(expected)
    assert frame.scalars["strain energy"] == pytest.approx(energy, rel=1e-9)


@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_plastic_law_below_yield_is_the_elastic_one(plane: str) -> None:
    """A uniform pressure does not make a metal yield, however hot it is held."""
    answers = []
    for material in (
        ct.Elastic(E, NU, expansion=ALPHA),
        ct.Mises(E, NU, yield_stress=2.0, isotropic=10.0, expansion=ALPHA),
    ):
        model = plate("Q4I", material, plane=plane)
        for side in ("left", "right"):
            model.fix(side, y=None)
        model.fix("bottom", x=None)
        if plane == "strain":
            model.fix("top", x=None)
        model.temperature(1.8 if plane == "stress" else 100.0)
        frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
        answers.append((stresses(frame), frame.scalars["strain energy"]))
    assert answers[1][0] == pytest.approx(answers[0][0], rel=1e-9, abs=1e-9)
    assert answers[1][1] == pytest.approx(answers[0][1], rel=1e-9)


def test_held_bar_yields_when_it_is_heated() -> None:
    """Plane strain, free across: sxx = szz, so that yield is at that stress itself."""
    model = plate(
        "Q4I", ct.Mises(E, NU, yield_stress=1.0, isotropic=0.0, expansion=ALPHA), plane="strain"
    )
    for side in ("left", "right"):
        model.fix(side, y=None)
    model.fix("bottom", x=None)
    model.temperature(3.0)
    frame = ct.solve(model, ct.Static(nlgeom=False, increments=4), threads=1).frames[-1]
    assert stresses(frame)[:, [0, 2]] == pytest.approx(-1.0, rel=1e-8)


def test_orthotropic_expansion_follows_the_fibers() -> None:
    angle = 0.4
    material = ct.Orthotropic(100.0, 10.0, 12.0, 0.3, 0.25, 0.4, 5.0, expansion=(1e-3, 3e-3, 2e-3))
    model = plate("Q4", material, orientation=angle)
    model.fix([0])
    corner = int(np.argmin(np.hypot(*(model.mesh.points - [3.0, 0.0]).T)))
    model.fix([corner], x=None)
    model.temperature(2.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    assert np.abs(stresses(frame)).max() < 1e-12
    c, s = np.cos(angle), np.sin(angle)
    strain = frame.fields[0].values["E"][0, 0]
    assert strain == pytest.approx(
        [2e-3 * c * c + 6e-3 * s * s, 2e-3 * s * s + 6e-3 * c * c, 4e-3, 2 * c * s * (2e-3 - 6e-3)]
    )


def test_orthotropic_plane_strain_against_the_inverted_compliance() -> None:
    angle = 0.4
    material = ct.Orthotropic(100.0, 10.0, 12.0, 0.3, 0.25, 0.4, 5.0, expansion=(1e-3, 3e-3, 2e-3))
    model = plate("Q4", material, orientation=angle, plane="strain")
    for side in ("left", "right", "bottom", "top"):
        model.fix(side)
    model.temperature(2.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    own = np.linalg.solve(material.compliance(), [-2e-3, -6e-3, -4e-3, 0.0])
    c, s = np.cos(angle), np.sin(angle)
    expected = [
        c * c * own[0] + s * s * own[1],
        s * s * own[0] + c * c * own[1],
        own[2],
        c * s * (own[0] - own[1]),
    ]
    found = stresses(frame)
    # The middle of the plate moves a little: it is not symmetric to the fibers.
    assert found.mean(axis=0) == pytest.approx(expected, rel=2e-2)
    assert found[:, 2].mean() == pytest.approx(expected[2], rel=2e-2)


@pytest.mark.parametrize("element", ["T6", "Q8", "Q9", "Q4I"])
def test_linear_temperature_bends_without_stress(element: str) -> None:
    """The strain alpha y is compatible: u = alpha x y, v = alpha (y^2 - x^2) / 2."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2, cell=cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E, NU, expansion=ALPHA))
    model.fix([0])
    corner = int(np.argmin(np.hypot(*(mesh.points - [2.0, 0.0]).T)))
    model.fix([corner], x=None, y=-2.0 * ALPHA)
    model.temperature(mesh.points[:, 1])
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    x, y = mesh.points.T
    exact = ALPHA * np.stack([x * y, 0.5 * (y * y - x * x)], axis=1)
    assert pytest.approx(exact, abs=1e-12) == frame.U
    if element != "Q4I":
        assert np.abs(stresses(frame)).max() < 1e-9 * E * ALPHA


def test_bimetal_strip_bends_as_timoshenko_says() -> None:
    """Curvature of two layers (Timoshenko 1925), plane stress, equal thickness and modulus."""
    mesh = ct.mesh.rectangle(20.0, 0.5, nx=60, ny=4, cell="quad8")
    upper = np.flatnonzero(mesh.points[mesh.cells[0].nodes[:, :4]].mean(axis=1)[:, 1] > 0.25)
    mesh.cell_sets["upper"] = upper
    mesh.cell_sets["lower"] = np.setdiff1d(np.arange(mesh.n_cells), upper)
    model = ct.Model(mesh)
    for name, alpha in (("upper", 2e-5), ("lower", 1e-5)):
        model.section(name, element="Q8", material=ct.Elastic(2e5, 0.0, expansion=alpha))
    model.fix("left", y=None)
    model.fix([0])
    model.temperature(200.0)
    frame = ct.solve(model, ct.Static()).frames[-1]
    curvature = 1.5 * 200.0 * 1e-5 / 0.5
    tip = int(np.argmin(np.hypot(*(mesh.points - [20.0, 0.0]).T)))
    radius = 1.0 / curvature
    assert -frame.U[tip, 1] == pytest.approx(radius * (1.0 - np.cos(20.0 / radius)), rel=3e-3)


def test_newton_stays_quadratic_in_a_heated_frame() -> None:
    mesh = ct.mesh.rectangle(10.0, 0.5, nx=10, ny=1)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E, NU, expansion=ALPHA))
    model.fix("left")
    model.temperature(60.0 * mesh.points[:, 1])
    model.force("right", y=0.1, per_node=True)
    solve_quadratically(model, ct.Static(increments=2))


def test_amplitude_and_steps_carry_the_temperature() -> None:
    model = plate("Q4", ct.Elastic(E, 0.0, expansion=ALPHA))
    for side in ("left", "right"):
        model.fix(side, y=None)
    model.fix("bottom", x=None)
    model.amplitudes["UP"] = ct.Amplitude(
        np.array([0.0, 0.5, 1.0]), np.array([0.0, 1.0, 0.5]), name="UP"
    )
    model.temperature(10.0, amplitude="UP")
    second = ct.Static(nlgeom=False, increments=2)
    steps = [ct.Static(nlgeom=False, increments=4), second]
    second.loads = [ct.model.Temperature("", 0.0)]
    frames = ct.solve(model, steps, threads=1).frames
    found = [stresses(f)[0, 0] / (-E * ALPHA) for f in frames]
    assert found == pytest.approx([0.0, 5.0, 10.0, 7.5, 5.0, 2.5, 0.0], abs=1e-9)


def test_coefficients_over_the_temperature() -> None:
    """Mean coefficients from ZERO on, as CalculiX and Abaqus define them."""
    expansion = Expansion((1e-3, 2e-3), (0.0, 100.0), zero=10.0)
    at = expansion.strain(60.0, 20.0)
    assert at == pytest.approx(np.full(3, 1.6e-3 * 50.0 - 1.2e-3 * 10.0))
    model = plate("Q4", ct.Elastic(E, NU, expansion=expansion))
    model.fix([0])
    corner = int(np.argmin(np.hypot(*(model.mesh.points - [3.0, 0.0]).T)))
    model.fix([corner], x=None)
    model.initial_temperature(20.0)
    model.temperature(60.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    assert pytest.approx(at[0] * model.mesh.points, abs=1e-10) == frame.U


def test_temperatures_without_expansion_are_refused() -> None:
    model = plate("Q4", ct.Elastic(E, NU))
    model.fix("left")
    model.temperature(5.0)
    with pytest.raises(ct.ModelError, match="coefficient of thermal expansion"):
        ct.solve(model)


@pytest.mark.parametrize("element", ["BEAM", "Q8"])
def test_heated_column_buckles(element: str) -> None:
    """Hinged and held at both ends: alpha dT = pi^2 I / (A L^2), by path and by eigenvalue."""
    length, depth = 100.0, 1.0
    critical = np.pi**2 * depth**2 / 12.0 / length**2 / ALPHA
    if element == "BEAM":
        from support.lines import chain

        model = ct.Model(chain(20, length))
        model.beam(
            np.arange(20),
            material=ct.Elastic(E, 0.0, expansion=ALPHA),
            area=depth,
            inertia=depth**3 / 12.0,
        )
        ends = [0, 20]
    else:
        mesh = ct.mesh.rectangle(length, depth, nx=40, ny=1, cell="quad8", origin=(0.0, -0.5))
        model = ct.Model(mesh)
        model.section("all", element="Q8", material=ct.Elastic(E, 0.0, expansion=ALPHA))
        ends = [int(np.argmin(np.hypot(*(mesh.points - [x, 0.0]).T))) for x in (0.0, length)]
    model.fix(ends)
    model.temperature(1.0)
    tolerance = 1e-4 if element == "BEAM" else 2e-3
    if element == "BEAM":
        # Chords of 20 beams stand for the sine: their geometric stiffness is larger by this.
        critical *= 1.0 + (np.pi / 20.0) ** 2 / 12.0
    factor = ct.solve(model, ct.Buckle(), threads=1).modes[0].factors[0]
    assert factor == pytest.approx(critical, rel=tolerance)
    path = ct.ArcLength(factor=1.5 * critical)
    found = ct.solve(model, ct.Static(path=path), threads=1).critical_points
    assert [p.kind for p in found] == ["bifurcation"]
    assert found[0].factor == pytest.approx(critical, rel=2.0 * tolerance)
