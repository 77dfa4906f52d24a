"""Loads per length, weight and spin of beams: consistent end moments, one element per member."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells

LAW = ct.Elastic(E=2.1e11, nu=0.3, rho=7850.0)


def beams(points: Any, ends: Any, **options: Any) -> ct.Model:
    cells = Cells("line2", np.array(ends), np.arange(1, len(ends) + 1))
    model = ct.Model(Mesh(np.array(points, float), [cells], np.arange(1, len(points) + 1)))
    given = {"material": LAW, "area": 0.02, "inertia": 0.1 * 0.2**3 / 12.0, **options}
    model.beam(range(len(ends)), **given)
    return model


def moments(frame: Any) -> np.ndarray:
    values = frame.fields[0].values
    return np.hstack([values["M1"], values["M2"]])


def portal() -> ct.Model:
    """Columns of 3 and a girder of 6, one element each, clamped at both feet."""
    model = beams([(0, 0), (0, 3), (6, 3), (6, 0)], [(0, 1), (1, 2), (2, 3)])
    model.fix([0, 3], rotation=True)
    return model


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("kind", ["line", "gravity", "volume"])
def test_portal_with_one_element_per_member(kind: str, nlgeom: bool) -> None:
    """Kleinlogel: corners q l^2 / (6 N1), feet half of it, N1 = k + 2, k = 3 / 6: 24 and 12 kNm.

    The formulas neglect axial strain, which moves the moments by 2 per thousand here.
    """
    model = portal()
    q = -1e4
    if kind == "line":
        model.line_load(y=q, cells=[1])
    elif kind == "gravity":
        model.gravity(y=q / (7850.0 * 0.02), cells=[1])
    else:
        load = ct.model.BodyForce(np.array([1]), "volume", (0.0, q / 0.02))
        model.loads.append(load)
    frame = ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1).frames[-1]
    found = moments(frame)
    rel = 4e-3
    np.testing.assert_allclose(np.abs(found[1]), [24e3, 24e3], rtol=rel)
    np.testing.assert_allclose(np.abs(found[0]), [12e3, 24e3], rtol=rel)
    np.testing.assert_allclose(np.abs(frame.RF[[0, 3], 2]), 12e3, rtol=rel)
    # Equilibrium of the girder: q l^2 / 8 less the corner's moment is the one at the middle.
    assert found[1].max() < 0.0


@pytest.mark.parametrize("angle", [0.0, 0.6, 2.0])
@pytest.mark.parametrize("shear", [0.0, 0.01])
def test_tip_of_a_cantilever(angle: float, shear: float) -> None:
    """q l^4 / (8 E I) + q l^2 / (2 G A_s) with one element, in every direction."""
    length, q = 2.0, -100.0
    c, s = np.cos(angle), np.sin(angle)
    model = beams([(0, 0), (length * c, length * s)], [(0, 1)], shear_area=shear)
    model.fix([0], rotation=True)
    model.line_load(x=-q * s, y=q * c)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    exact = q * length**4 / (8.0 * LAW.E * 0.1 * 0.2**3 / 12.0)
    if shear:
        exact += q * length**2 / (2.0 * LAW.E / 2.6 * shear)
    assert frame.U[1] @ [-s, c] == pytest.approx(exact, rel=1e-9)
    assert frame.RF[0, 2] == pytest.approx(-q * length**2 / 2.0, rel=1e-9)
    np.testing.assert_allclose(moments(frame)[0], [q * length**2 / 2.0, 0.0], atol=1e-7)


@pytest.mark.parametrize("element_count", [1, 2, 5])
def test_clamped_beam_has_its_moments_at_any_mesh(element_count: int) -> None:
    """q l^2 / 12 at both clamps, whatever the elements."""
    n = element_count
    x = np.linspace(0.0, 3.0, n + 1)
    model = beams(np.stack([x, 0 * x], 1), [(i, i + 1) for i in range(n)])
    model.fix([0, n], rotation=True)
    model.line_load(y=-50.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    found = moments(frame)
    np.testing.assert_allclose([found[0, 0], found[-1, 1]], -50.0 * 9.0 / 12.0, rtol=1e-9)
    np.testing.assert_allclose(np.abs(frame.RF[[0, n], 2]), 50.0 * 9.0 / 12.0, rtol=1e-9)


def test_tangent_is_the_derivative_of_the_load() -> None:
    """Newton's method converges quadratically at a large rotation of a loaded beam."""
    model = beams([(0, 0), (1, 0), (2, 0)], [(0, 1), (1, 2)])
    model.fix([0], rotation=True)
    model.line_load(y=-4e6)
    results = ct.solve(model, ct.Static(increments=4), threads=1)
    assert abs(results.frames[-1].UR[-1]) > 0.3
    assert results.info["iterations"] <= 4 * 6


@pytest.mark.parametrize("mass", ["consistent", "constant", "lumped"])
@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_free_fall_is_free_of_stress(mass: Any, scheme: str) -> None:
    model = beams([(0, 0), (1, 0.5), (2, 0.3)], [(0, 1), (1, 2)])
    model.gravity(y=-9.81)
    step = ct.Dynamic(period=0.2, increments=4, scheme=scheme, mass=mass)
    frame = ct.solve(model, step, threads=1).frames[-1]
    np.testing.assert_allclose(frame.U[:, 1], -0.5 * 9.81 * 0.04, rtol=2e-3)
    weight = 9.81 * 7850.0 * 0.02
    assert np.abs(moments(frame)).max() < 1e-6 * weight


def test_spinning_beam_across_its_axis() -> None:
    """Centrifugal load along a radial beam: N = rho A w^2 (l^2 - x^2) / 2, and no moments."""
    model = beams([(0, 0), (1, 0), (2, 0)], [(0, 1), (1, 2)])
    model.fix([0], rotation=True)
    model.centrifugal(10.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    assert frame.RF[0, 0] == pytest.approx(-7850.0 * 0.02 * 100.0 * 2.0, rel=1e-9)
    assert np.abs(moments(frame)).max() < 1e-6


DECK = """*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
*ELEMENT, TYPE={type}, ELSET=BEAM
1, 1, 2
*MATERIAL, NAME=M
*ELASTIC
2.1e11, 0.
{density}*BEAM SECTION, ELSET=BEAM, MATERIAL=M, SECTION=RECT
0.01, 0.02
0, 0, 1
*BOUNDARY
1, 1, 6
*STEP
*STATIC
*DLOAD
BEAM, PY, -100.
*END STEP
"""


@pytest.mark.parametrize("density", ["", "*DENSITY\n7850.\n"])
@pytest.mark.parametrize("type_", ["B23", "B33"])
def test_deck_with_a_load_per_length(type_: str, density: str, tmp_path: Path) -> None:
    """q l^4 / (8 E I) with one element, and no need for a density."""
    deck, again = tmp_path / "deck.inp", tmp_path / "again.inp"
    deck.write_text(DECK.format(type=type_, density=density))
    ct.write(ct.read(deck), again)
    exact = -100.0 * 2.0**4 / (8.0 * 2.1e11 * 0.01 * 0.02**3 / 12.0)  # -0.1429
    for path in (deck, again):
        frame = ct.solve(ct.read(path), threads=1).frames[-1]
        assert frame.U[1, 1] == pytest.approx(exact, rel=1e-9)
